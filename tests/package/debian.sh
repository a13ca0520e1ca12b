#!/bin/sh
# debian.sh LIBFACET - files of debian/ that have to follow the sources: version, symbols, what is installed.
set -eu
here=$(cd "$(dirname -- "$0")/../.." && pwd)
fail() {
    echo "debian: $*"
    exit 1
}
[ -d "$here/debian" ] || { echo "debian: a release has no folder debian"; exit 77; }
version=$(sh "$here/packaging/version.sh")
revision=$(sed -n '1s/.*(\(.*\)).*/\1/p' "$here/debian/changelog")
[ "${revision%-*}" = "$version" ] || fail "debian/changelog begins with $revision, include/facet/base.h has $version"
grep -q "^## $version\$" "$here/CHANGELOG.md" || fail "CHANGELOG.md has no section $version"
abi=$(sed -n 's/^#define FACET_ABI_VERSION //p' "$here/include/facet/base.h")
grep -q "^Package: libfacet$abi\$" "$here/debian/control" || fail "debian/control has no package libfacet$abi"
exported=$(nm -D --defined-only "$1" | awk '$2 ~ /[TDBRVW]/ {sub(/@.*/, "", $3); print $3}' | sort)
listed=$(sed -n 's/^ \(facet_[a-z0-9_]*\)@FACET_[0-9]* .*/\1/p' "$here/debian/libfacet$abi.symbols" | sort)
[ "$exported" = "$listed" ] || {
    printf '%s\n' "$exported" >"${TMPDIR:-/tmp}/facet-exported.$$"
    printf '%s\n' "$listed" | diff - "${TMPDIR:-/tmp}/facet-exported.$$" || true
    rm -f "${TMPDIR:-/tmp}/facet-exported.$$"
    fail "debian/libfacet$abi.symbols is not what the library exports; packaging/symbols.sh LIBFACET writes it anew"
}
for package in $(sed -n 's/^Package: //p' "$here/debian/control"); do
    [ -s "$here/debian/$package.install" ] || fail "debian/$package.install is missing"
done
grep -q '^Exec=facet-thumbnailer -s %s %i %o$' "$here/packaging/thumbnailer/facet.thumbnailer" || fail "facet.thumbnailer"
echo "debian: version, symbols and packages agree with the sources"
