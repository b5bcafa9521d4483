#!/usr/bin/env bash
# That a static program needs nothing beside it: it is alone in a root of its own, and in an image, where something here
# builds images.
#
#   .ci/release/image.sh PROGRAM
set -euo pipefail
program=$1
place=$(mktemp -d)
# An engine's files may be of root.
trap 'rm -rf "$place" 2>/dev/null || sudo rm -rf "$place"' EXIT
sources=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
if readelf -l "$program" | grep -q INTERP; then
    echo "error: $program is not static" >&2
    exit 1
fi
mkdir -p "$place/root/models" "$place/image"
cp "$program" "$place/root/mbint"
cp "$sources/models/slider_crank.yaml" "$place/root/models/"
# Not every system lets everybody have a root of their own.
if [ "$(id -u)" = 0 ]; then as_root=(); elif unshare --map-root-user true 2>/dev/null; then as_root=(unshare --map-root-user); else as_root=(sudo); fi
alone() { "${as_root[@]}" chroot "$place/root" /mbint "$@"; }
alone --version
alone run /models/slider_crank.yaml --method chebyshev --output /models/alone --quiet
[ -s "$place/root/models/alone/bounds.csv" ]
echo "size: $(stat -c %s "$program") bytes"

case $(uname -m) in x86_64) architecture=amd64 ;; *) architecture=arm64 ;; esac
mkdir "$place/image/$architecture"
cp "$program" "$place/image/$architecture/mbint"
for engine in docker podman buildah; do
    "$engine" info >/dev/null 2>&1 || continue
    inside=(run --method chebyshev --output image --quiet slider_crank.yaml)
    case $engine in
    buildah)
        buildah build --isolation chroot --platform "linux/$architecture" --file "$sources/Dockerfile" --tag mbint:try "$place/image"
        container=$(buildah from mbint:try)
        buildah run --isolation chroot --volume "$place/root/models:/models" "$container" -- /usr/bin/mbint "${inside[@]}"
        buildah rm "$container" >/dev/null
        ;;
    *)
        "$engine" build --build-arg "TARGETARCH=$architecture" --file "$sources/Dockerfile" --tag mbint:try "$place/image"
        "$engine" run --rm --volume "$place/root/models:/models" mbint:try "${inside[@]}"
        ;;
    esac
    diff -r "$place/root/models/alone" "$place/root/models/image"
    echo "the image of $engine has the same results"
    exit 0
done
[ "${CI:-}" != true ] || { echo "error: nothing here builds images" >&2; exit 1; }
echo "note: nothing here builds images (docker, podman, buildah); the program was tried without"
