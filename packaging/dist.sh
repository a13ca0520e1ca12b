#!/bin/sh
# dist.sh FACET - the files of a release of HEAD in build/dist: the sources, the change log, the list of libraries and their
# licences (SPDX), and checksums. FACET is the command of the same version.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
version=$(sh "$here/packaging/version.sh")
out=$here/build/dist
[ "$("$1" version)" = "facet $version" ] || { echo "dist: $1 is $("$1" version), not $version"; exit 1; }
grep -q "^## $version\$" "$here/CHANGELOG.md" || { echo "dist: CHANGELOG.md has no section $version"; exit 1; }
[ -z "$(git -C "$here" status --porcelain --untracked-files=no)" ] || echo "dist: there are changes that are not committed; HEAD is taken" >&2
SOURCE_DATE_EPOCH=$(git -C "$here" log -1 --format=%ct)
export SOURCE_DATE_EPOCH
rm -rf "$out"
mkdir -p "$out"
sh "$here/packaging/tarball.sh" "$out/facet-$version.tar.xz"
sh "$here/packaging/sbom.sh" "$1" >"$out/facet-$version.spdx.json"
cp "$here/CHANGELOG.md" "$out/"
(cd "$out" && sha256sum -- * >SHA256SUMS)
ls -l "$out" | awk 'NR > 1 {printf "%8.0f kB  %s\n", $5 / 1000, $NF}'
echo "dist: $out; sign it: gpg --detach-sign --armor $out/SHA256SUMS"
