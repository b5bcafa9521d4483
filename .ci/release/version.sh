#!/usr/bin/env bash
# That a tag is the version of all crates, and that the changelog says what is new in it.
#
#   .ci/release/version.sh TAG
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
version=$(awk -F '"' '/^\[workspace.package\]/ { on = 1 } on && /^version/ { print $2; exit }' Cargo.toml)
[ "$1" = "v$version" ] || { echo "error: the tag is $1, and Cargo.toml has $version" >&2; exit 1; }
grep -nE '^mbint-(derive|symdiff) = ' Cargo.toml | grep -vF "version = \"$version\"" \
    && { echo "error: crates of another version" >&2; exit 1; }
[ -n "$(.ci/release/notes.sh "$version" | tr -d '[:space:]')" ] \
    || { echo "error: CHANGELOG.md has no section [$version]" >&2; exit 1; }
