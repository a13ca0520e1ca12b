#!/bin/sh
# symbols.sh LIBFACET - writes debian/libfacetN.symbols from what the library exports. New functions get the present version; those
# that are there keep theirs; a function that is gone needs a new FACET_ABI_VERSION (docs/packaging.md).
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
version=$(sh "$here/packaging/version.sh")
abi=$(sed -n 's/^#define FACET_ABI_VERSION //p' "$here/include/facet/base.h")
file=$here/debian/libfacet$abi.symbols
touch "$file"
{
    printf 'libfacet.so.%s libfacet%s #MINVER#\n* Build-Depends-Package: libfacet-dev\n FACET_%s@FACET_%s %s\n' "$abi" "$abi" "$abi" "$abi" \
        "$(sed -n "s/^ FACET_$abi@.* //p" "$file" | grep . || echo "$version")"
    nm -D --defined-only "$1" | awk '$2 ~ /[TDBRVW]/ {sub(/@.*/, "", $3); print $3}' | LC_ALL=C sort | while read -r symbol; do
        since=$(sed -n "s/^ $symbol@FACET_$abi //p" "$file")
        printf ' %s@FACET_%s %s\n' "$symbol" "$abi" "${since:-$version}"
    done
} >"$file.new"
mv "$file.new" "$file"
