#!/usr/bin/env bash
# That a program needs no symbol of the C library that is newer than a version, and has no symbols of its own.
#
#   .ci/release/glibc.sh PROGRAM 2.17
set -euo pipefail
if readelf --sections --wide "$1" | grep -q '\.symtab'; then
    echo "error: $1 is not stripped" >&2
    exit 1
fi
newest=$(objdump -T "$1" | grep -o 'GLIBC_[0-9.]*' | sort -uV | tail -n 1)
echo "newest symbol: ${newest:-none}"
[ "$(printf '%s\n' "${newest#GLIBC_}" "$2" | sort -V | tail -n 1)" = "$2" ]
