#!/bin/sh
# package.sh - builds the Debian packages of HEAD into build/package (./run package installs what that needs):
#     ./run package              source and binary packages, checked by lintian
#     ./run package --twice      builds them again in another folder, time zone and umask, and compares every byte
# MAINTAINER="Name <address>" is written into the packages in place of facet's placeholder: whoever distributes them answers for them.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
out=$here/build/package
version=$(sh "$here/packaging/version.sh")
revision=$(sed -n '1s/.*(\(.*\)).*/\1/p' "$here/debian/changelog")
[ "${revision%-*}" = "$version" ] || { echo "package: debian/changelog has $revision, include/facet/base.h $version"; exit 1; }

case ${MAINTAINER:-facet <facet@example.org>} in
*?' <'*?@?*'>') ;;
*) echo "package: MAINTAINER is '$MAINTAINER'; a name and an address were expected, as in Jo Doe <jo@example.org>"; exit 1 ;;
esac

# build FOLDER: the tarball of HEAD, unpacked and built
build() {
    rm -rf "$1"
    mkdir -p "$1"
    sh "$here/packaging/tarball.sh" "$1/facet_$version.orig.tar.xz"
    tar -C "$1" -xf "$1/facet_$version.orig.tar.xz"
    git -C "$here" archive HEAD debian | tar -C "$1/facet-$version" -xf -
    if [ -n "${MAINTAINER:-}" ]; then
        name=$(printf '%s\n' "$MAINTAINER" | sed 's/[\\&|]/\\&/g')
        sed -i "s|^Maintainer: .*|Maintainer: $name|" "$1/facet-$version/debian/control"
        sed -i "s|^ -- .* <.*>  | -- $name  |" "$1/facet-$version/debian/changelog"
    fi
    (cd "$1/facet-$version" && dpkg-buildpackage -us -uc) >"$1/build.log" 2>&1 || {
        tail -n 40 "$1/build.log"
        echo "package: the build failed; the whole log is $1/build.log"
        exit 1
    }
    rm -rf "$1/facet-$version"
}

build "$out"
if command -v lintian >/dev/null 2>&1; then
    # a bug number is for the upload to Debian
    lintian --allow-root --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs "$out"/facet_*.changes || exit 1
    echo "package: lintian has nothing to say"
fi
if [ "${1-}" = --twice ]; then
    (
        umask 077
        TZ=Asia/Kathmandu
        LC_ALL=C
        export TZ LC_ALL
        build "$out/again"
    )
    for package in "$out"/*.deb "$out"/*.dsc "$out"/*.tar.xz; do
        cmp "$package" "$out/again/$(basename "$package")" || exit 1
    done
    echo "package: both builds are equal, byte for byte"
    rm -rf "$out/again"
fi
ls -l "$out"/*.deb | awk '{printf "%8.0f kB  %s\n", $5 / 1000, $NF}'
