#!/usr/bin/env bash
# The verification report of a release as PDF: docs/verification/ as a book of its own, printed by Chromium. Needs mdbook, and
# Chromium or another browser of its kind (CHROMIUM).
#
#   .ci/release/report.sh VERSION REPORT.pdf
set -euo pipefail
version=$1
into=$(cd "$(dirname "$2")" && pwd)/$(basename "$2")
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
PATH="$PATH:$PWD/target/tools/bin"
: "${CHROMIUM:=$(command -v chromium || command -v google-chrome)}"
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
mkdir "$place/src"
# Other pages are read where the release has them.
pages=https://github.com/mbint/mbint/blob/v$version/docs
for page in docs/verification/*.md; do
    sed -e "s|](\.\./|]($pages/|g" -e "s|](measured.json)|]($pages/verification/measured.json)|g" "$page" >"$place/src/${page##*/}"
done
{ printf '# Summary\n\n' && grep '(verification/' docs/SUMMARY.md | sed 's|(verification/|(|'; } >"$place/src/SUMMARY.md"
printf '[book]\ntitle = "Verification report of mbint %s"\n[output.html]\nno-section-label = true\nadditional-css = ["print.css"]\n' \
    "$version" >"$place/book.toml"
# Tables as wide as the paper.
cat >"$place/print.css" <<'CSS'
@page { size: A4 landscape; margin: 15mm }
html { font-size: 50% }
:root { --content-max-width: 100% }
.table-wrapper { overflow: visible }
table { font-size: 11px; margin: 8px 0 }
td, th { padding: 2px 6px !important }
CSS
mdbook build "$place" >"$place/log" 2>&1 || { cat "$place/log" >&2; exit 1; }
"$CHROMIUM" --headless --no-sandbox --disable-gpu --no-pdf-header-footer --user-data-dir="$place/browser" \
    --print-to-pdf="$into" "file://$place/book/print.html" 2>"$place/log" || { cat "$place/log" >&2; exit 1; }
[ "$(head -c 5 "$into")" = %PDF- ] || { echo "error: $into is no PDF" >&2; exit 1; }
