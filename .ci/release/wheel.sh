#!/usr/bin/env bash
# That a wheel has what it should, and that its package works in an environment of its own.
#
#   .ci/release/wheel.sh WHEEL [GLIBC]
set -euo pipefail
wheel=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
python3 -m venv "$place/python"
python="$place/python/bin/python"
"$python" -m zipfile -e "$wheel" "$place/wheel"
[ -f "$place/wheel/mbint/py.typed" ]
program=$(echo "$place"/wheel/mbint-*.data/scripts/mbint*)
echo "size: $(stat -c %s "$wheel") bytes, the program $(stat -c %s "$program")"
[ -z "${2:-}" ] || "$here/glibc.sh" "$program" "$2"
"$python" -m pip install --quiet "$wheel"
cp "$here/../../models/slider_crank.yaml" "$place/"
cd "$place"
"$place/python/bin/mbint" check slider_crank.yaml
"$python" -c '
import mbint
print("mbint", mbint.version(), "from", mbint.command())
study = mbint.run("slider_crank.yaml", methods=["chebyshev"])
assert study.bounds.chebyshev.dims == ("time", "output", "bound") and study.units == {"x3": "m"}
'
