#!/usr/bin/env bash
# Installs Debian's packages where commands are missing, as root or by sudo. Where that cannot be, it says what is
# missing and why.
#
#   .ci/install.sh "COMMAND..." PACKAGE...
set -uo pipefail
PATH=$PATH:/usr/sbin:/sbin
read -r -a commands <<<"$1"
shift
packages=("$@")
missing() { for command in "${commands[@]}"; do command -v "$command" >/dev/null || printf '%s ' "$command"; done; }
[ -n "$(missing)" ] || exit 0
cannot() {
    echo "missing: $(missing)($1; Debian's packages: ${packages[*]})" >&2
    exit 1
}
command -v apt-get >/dev/null || cannot "there is no apt-get here"
if [ "$(id -u)" = 0 ]; then
    as_root=()
elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
    as_root=(sudo)
else
    cannot "apt-get needs root or sudo without a password"
fi
"${as_root[@]}" apt-get update -qq || cannot "apt-get update failed"
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends "${packages[@]}" \
    || cannot "apt-get install failed"
[ -z "$(missing)" ] || cannot "they are still missing"
