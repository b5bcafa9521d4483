#!/usr/bin/env bash
# Bounds of all shipped models, to be compared between systems.
#
#   .ci/models.sh PROGRAM DIR
set -euo pipefail
program=$1
into=$2
mkdir -p "$into"
for model in models/*.yaml; do
    name=$(basename "$model" .yaml)
    status=0
    "$program" run "$model" --output "$into/$name" --quiet --yes --no-report || status=$?
    # 3: something is unresolved, 4: a requirement is violated. Both are results.
    case $status in 0 | 3 | 4) ;; *) echo "error: $model: exit status $status" >&2; exit 1 ;; esac
done
