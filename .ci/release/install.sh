#!/bin/sh
# Installs mbint for Linux and macOS:
#
#   curl --proto '=https' --tlsv1.2 -LsSf https://github.com/mbint/mbint/releases/latest/download/install.sh | sh
#
# MBINT_INSTALL_DIR is the folder of the program [~/.local/bin], MBINT_VERSION the version [the latest], MBINT_DOWNLOAD
# where archives are.
set -eu

folder=${MBINT_INSTALL_DIR:-$HOME/.local/bin}
if [ -n "${MBINT_VERSION:-}" ]; then release=download/v$MBINT_VERSION; else release=latest/download; fi
from=${MBINT_DOWNLOAD:-https://github.com/mbint/mbint/releases/$release}

fail() {
    echo "error: $1" >&2
    exit 1
}

case $(uname -m) in
x86_64 | amd64) processor=x86_64 ;;
aarch64 | arm64) processor=aarch64 ;;
*) fail "there is no program for the processor $(uname -m); cargo install mbint builds it" ;;
esac
case $(uname -s) in
Linux)
    # Where the C library is another one or older, the program without one.
    glibc=$(getconf GNU_LIBC_VERSION 2>/dev/null | cut -d' ' -f2 || true)
    minor=${glibc#2.}
    if [ "$glibc" != "$minor" ] && [ "${minor%%.*}" -ge 17 ]; then system=unknown-linux-gnu; else system=unknown-linux-musl; fi
    ;;
Darwin) system=apple-darwin ;;
*) fail "there is no program for $(uname -s); cargo install mbint builds it" ;;
esac

name=mbint-$processor-$system
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
for file in "$name.tar.gz" "$name.tar.gz.sha256"; do
    if command -v curl >/dev/null; then
        curl -LsSf "$from/$file" -o "$place/$file" || fail "cannot download $from/$file"
    elif command -v wget >/dev/null; then
        wget -qO "$place/$file" "$from/$file" || fail "cannot download $from/$file"
    else
        fail "curl or wget is needed"
    fi
done
cd "$place"
if command -v sha256sum >/dev/null; then
    sha256sum -c "$name.tar.gz.sha256" >/dev/null || fail "the checksum is not that of the archive"
else
    shasum -a 256 -c "$name.tar.gz.sha256" >/dev/null || fail "the checksum is not that of the archive"
fi
tar -xzf "$name.tar.gz"
mkdir -p "$folder"
mv -f "$name/mbint" "$folder/mbint"
"$folder/mbint" --version
case :$PATH: in *:"$folder":*) ;; *) echo "add $folder to PATH" ;; esac
