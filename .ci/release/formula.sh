#!/usr/bin/env bash
# The formula of a release for Homebrew.
#
#   .ci/release/formula.sh VERSION SHA256SUMS
set -euo pipefail
version=$1
sums=$2

# archive TARGET: its address and checksum.
archive() {
    local file=mbint-$1.tar.gz sum
    sum=$(awk -v file="$file" '$2 == file { print $1 }' "$sums")
    [ -n "$sum" ] || { echo "error: no checksum of $file" >&2; exit 1; }
    printf '      url "https://github.com/mbint/mbint/releases/download/v%s/%s"\n      sha256 "%s"\n' "$version" "$file" "$sum"
}

cat <<FORMULA
class Mbint < Formula
  desc "Bounds of a mechanism's motion under parameter tolerances"
  homepage "https://github.com/mbint/mbint"
  version "$version"
  license any_of: ["MIT", "Apache-2.0"]

  on_macos do
    on_arm do
$(archive aarch64-apple-darwin)
    end
    on_intel do
$(archive x86_64-apple-darwin)
    end
  end

  on_linux do
    on_arm do
$(archive aarch64-unknown-linux-gnu)
    end
    on_intel do
$(archive x86_64-unknown-linux-gnu)
    end
  end

  def install
    bin.install "mbint"
    generate_completions_from_executable(bin/"mbint", "completions")
    system bin/"mbint", "man", "--output", "man"
    man1.install Dir["man/*.1"]
  end

  test do
    assert_match version.to_s, shell_output("#{bin}/mbint --version")
    system bin/"mbint", "new", "pendulum"
    system bin/"mbint", "check", "pendulum.yaml"
  end
end
FORMULA
