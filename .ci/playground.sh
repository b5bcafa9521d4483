#!/usr/bin/env bash
# The playground: the engine as WebAssembly (target/wasm/mbint.wasm), tested in node and, beside the book, in Chromium.
# `.ci/playground.sh install` ends when all is installed, `.ci/playground.sh build` when the module is built,
# `.ci/playground.sh book` when it is in the book (target/book, by mdbook). MBINT is the program (target/release/mbint by default).
#
# A toolchain of rustup has the target by `rustup target add wasm32-unknown-unknown`. Else Debian's compiler and the
# source of its standard library are taken, which is built with the engine; its version is not that of rustup's.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
target=wasm32-unknown-unknown

has_target() { [ -d "$(rustc --print target-libdir --target $target)" ]; }
wanted=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)
is_enough() { [ -n "$1" ] && [ "$(printf '%s\n' "$wanted" "$1" | sort -V | sed -n 1p)" = "$wanted" ]; }
is_debian() {
    [ -d /usr/lib/rustlib/src/rust/library/std ] && is_enough "$(/usr/bin/rustc --version | cut -d ' ' -f 2)"
}
install() {
    .ci/install.sh "node npm" nodejs npm || return 1
    has_target || is_debian || { .ci/install.sh /usr/bin/rustc rustc-web rust-web-src && is_debian; }
}
if ! install; then
    # A system without a package of such a compiler is no fault.
    offered=$(apt-cache madison rustc-web 2>/dev/null | cut -d '|' -f 2 | tr -d ' ' | sort -V | tail -1)
    if [ "${CI:-}" = true ] && { ! command -v npm >/dev/null || is_enough "$offered"; }; then
        echo "error: node or a compiler for WebAssembly could not be installed" >&2
        exit 1
    fi
    echo "note: node or a compiler for WebAssembly could not be installed; the playground is left out"
    exit 0
fi
[ "${1:-}" != install ] || exit 0

# Frames of the solver and of the reader are deep; vectors of two numbers are in every browser since 2023.
export CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS="-Ctarget-feature=+simd128 -Clink-arg=-zstack-size=8388608 -Clink-arg=--max-memory=2147483648"
build=(cargo build --locked --package mbint-playground --profile playground --target $target --target-dir target/wasm)
if has_target; then
    "${build[@]}"
else
    # Options that are not stable are allowed for this command alone. The linker is that of rustup's toolchain.
    linker=$(find "$(rustc --print sysroot)/lib/rustlib" -name rust-lld -print -quit)
    env RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER="$linker" \
        "${build[@]}" -Zbuild-std=std,panic_abort
fi
cp target/wasm/$target/playground/mbint_playground.wasm target/wasm/mbint.wasm
[ "${1:-}" != build ] || exit 0

# The page's files, the texts of the shipped models, and the matrices that examples of the book name.
fill() {
    mkdir -p "$1"
    cp target/wasm/mbint.wasm crates/playground/page/*.js crates/playground/page/*.css "$1/"
    cp crates/studio/src/studio/page/{editor.js,overlay.js,editor.css} crates/export/src/export/report/data.js "$1/"
    node tests/browser/texts.mjs >"$1/models.json"
}
if [ "${1:-}" = book ]; then
    fill target/book/playground
    exit 0
fi

: "${MBINT:=target/release/mbint}"
export MBINT
[ -n "${CHROMIUM:-}" ] || .ci/install.sh chromium chromium fonts-dejavu-core
(cd tests/browser && npm ci --no-audit --no-fund --silent)
tests/browser/node_modules/.bin/tsc -p crates/playground/page
PLAYGROUND=$(mktemp -d)
export PLAYGROUND
trap 'rm -rf "$PLAYGROUND"' EXIT
if [ -e target/book/playground.html ]; then cp -r target/book/. "$PLAYGROUND/"; fi
fill "$PLAYGROUND/playground"
node --test --test-reporter=spec tests/browser/playground.test.mjs
