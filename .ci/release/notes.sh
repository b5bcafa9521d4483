#!/usr/bin/env bash
# What the changelog says of a version.
#
#   .ci/release/notes.sh VERSION
set -euo pipefail
awk -v version="$1" '/^## / { on = index($0, "[" version "]") > 0; next } on' CHANGELOG.md
