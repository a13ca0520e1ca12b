#!/bin/sh
# pack.sh [DIST] - packs the element that web/build.sh built as build/web/facet-viewer-VERSION.tgz, by npm pack: what npm would publish.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
dist=${1-$here/../build/web/dist}
package=$dist/facet-viewer
command -v npm >/dev/null || { echo "web: npm, which packs the element, is not installed" >&2; exit 1; }
[ -f "$package/viewer.wasm" ] || { echo "web: there is no $package/viewer.wasm: run ./run web --build first" >&2; exit 1; }
version=$(sh "$here/../packaging/version.sh")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -R "$package/." "$work"
rm -f "$work"/ocean.* # the page of seas, which no export of the package uses
cp "$here/../LICENSE" "$work"
sed "s/\"version\": \"0.0.0\"/\"version\": \"$version\"/" "$here/element/package.json" >"$work/package.json"
target=$(CDPATH= cd -- "$dist/.." && pwd)
(cd "$work" && npm pack --silent --ignore-scripts --pack-destination "$target" >/dev/null)
echo "$target/facet-viewer-$version.tgz"
