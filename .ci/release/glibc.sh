#!/usr/bin/env bash
# That a program needs no symbol of the C library that is newer than a version.
#
#   .ci/release/glibc.sh PROGRAM 2.17
set -euo pipefail
newest=$(objdump -T "$1" | grep -o 'GLIBC_[0-9.]*' | sort -uV | tail -n 1)
echo "newest symbol: ${newest:-none}"
[ "$(printf '%s\n' "${newest#GLIBC_}" "$2" | sort -V | tail -n 1)" = "$2" ]
