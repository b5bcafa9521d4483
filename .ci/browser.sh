#!/usr/bin/env bash
# Reports and the studio in a browser: their scripts' types, then tests in Chromium. `.ci/browser.sh pictures` makes the book's
# pictures of reports again instead, `.ci/browser.sh studio` tests the studio, and `.ci/browser.sh install` ends when
# all is installed. Needs node and npm; Chromium and two packages of npm are installed where they are missing. MBINT is the program (target/release/mbint, built here,
# by default), CHROMIUM the browser.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

install() {
    .ci/install.sh "node npm" nodejs npm || return 1
    [ -n "${CHROMIUM:-}" ] || .ci/install.sh chromium chromium fonts-dejavu-core || return 1
    (cd tests/browser && npm ci --no-audit --no-fund --silent)
}
if ! install; then
    [ "${CI:-}" != true ] || { echo "error: node, Chromium or packages of npm could not be installed" >&2; exit 1; }
    echo "note: node, Chromium or packages of npm could not be installed; reports are not opened in a browser"
    exit 0
fi
[ "${1:-}" != install ] || exit 0
: "${CHROMIUM:=$(command -v chromium)}"
export CHROMIUM

for scripts in crates/export/src/export/report crates/studio/src/studio/page; do
    tests/browser/node_modules/.bin/tsc -p "$scripts"
done
if [ -z "${MBINT:-}" ]; then
    cargo build --locked --release
    MBINT=target/release/mbint
fi
export MBINT
if [ "${1:-}" = studio ]; then
    # Alone: beside other browsers a drag of a pointer takes a minute.
    node --test --test-reporter=spec tests/browser/studio.test.mjs
    exit 0
fi
REPORTS=$(mktemp -d)
export REPORTS
trap 'rm -rf "$REPORTS"' EXIT
for model in four_bar six_axis_arm door; do
    "$MBINT" run "models/$model.yaml" --quiet --output "$REPORTS/$model" 2>/dev/null || [ $? -eq 3 ]
done
if [ "${1:-}" = pictures ]; then
    PICTURES=docs/images node tests/browser/pictures.mjs
    exit 0
fi
"$MBINT" run tests/browser/hostile.yaml --quiet --output "$REPORTS/hostile"
"$MBINT" run tests/browser/shapes.yaml --quiet --output "$REPORTS/shapes"
"$MBINT" run tests/browser/bouncing_ball.yaml --quiet --output "$REPORTS/bouncing_ball"
# Every shipped model and every example of the book, with few simulations.
cp -r models docs/examples "$REPORTS/"
for model in "$REPORTS"/{models,examples}/*.yaml; do
    node tests/browser/shorter.mjs "$model"
    "$MBINT" run "$model" --yes --quiet --output "$REPORTS/all/$(basename "$model" .yaml)" 2>/dev/null || [[ $? == [34] ]]
done
node --test --test-reporter=spec tests/browser/report.test.mjs
