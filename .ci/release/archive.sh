#!/usr/bin/env bash
# An archive of the program for one target, with licences, manual pages and completions, and its checksum.
#
#   .ci/release/archive.sh TARGET FOLDER_OF_PROGRAM DIR
set -euo pipefail
target=$1
from=$2
into=$3
case $target in *-windows-*) program=mbint.exe ;; *) program=mbint ;; esac
name=mbint-$target
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
mkdir -p "$place/$name" "$into"
cp "$from/$program" README.md CHANGELOG.md LICENSE-MIT LICENSE-APACHE "$place/$name/"
# Programs of other processors do not run here.
if "$from/$program" --version >/dev/null 2>&1; then
    "$from/$program" man --output "$place/$name/man" >/dev/null
    mkdir "$place/$name/completions"
    for shell in bash zsh fish powershell; do
        "$from/$program" completions "$shell" >"$place/$name/completions/mbint.$shell"
    done
fi
into=$(cd "$into" && pwd)
case $target in
*-windows-*) (cd "$place" && 7z a -bso0 "$into/$name.zip" "$name") && file=$name.zip ;;
*) tar -C "$place" -czf "$into/$name.tar.gz" "$name" && file=$name.tar.gz ;;
esac
cd "$into"
if command -v sha256sum >/dev/null; then sha256sum "$file" >"$file.sha256"; else shasum -a 256 "$file" >"$file.sha256"; fi
