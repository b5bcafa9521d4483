#!/usr/bin/env bash
# The extension for Visual Studio Code: its types, its tests with the real program and a mocked editor, and its package.
# `.ci/editors.sh install` ends when all is installed. Needs node and npm. MBINT is the program
# (target/release/mbint, built here, by default).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

install() {
    .ci/install.sh "node npm" nodejs npm || return 1
    (cd editors/vscode && npm ci --no-audit --no-fund --silent)
}
if ! install; then
    [ "${CI:-}" != true ] || { echo "error: node or packages of npm could not be installed" >&2; exit 1; }
    echo "note: node or packages of npm could not be installed; the extension is left out"
    exit 0
fi
[ "${1:-}" != install ] || exit 0

if [ -z "${MBINT:-}" ]; then
    cargo build --locked --release
    MBINT=$PWD/target/release/mbint
fi
export MBINT
cd editors/vscode
npm test
npx vsce package --out "${PACKAGE:-$(mktemp -d)/mbint.vsix}"
