#!/usr/bin/env bash
# Checks the format of all source. Modules that `automod` declares are unknown to `cargo fmt`, so each file is checked.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
git ls-files -z '*.rs' | xargs -0 rustfmt --edition 2024 --check
