#!/bin/sh
# build.sh GENERATED - builds facet for browsers into build/web/dist, with Debian's emscripten and Debian's sources of the
# libraries. GENERATED: build/*/generated of a native build, where facet_gl was built.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
generated=$(CDPATH= cd -- "$1" && pwd)
build=$here/../build/web
mkdir -p "$build"
build=$(cd "$build" && pwd)
step() {
    echo "web: $*"
}
[ -f "$generated/compact/gl_text.h" ] || { echo "web: there is no compact/gl_text.h in $generated: libepoxy-dev was missing" >&2; exit 1; }
step "sources of the libraries, from Debian: 68 MB the first time, into ${build#"$PWD/"}/sources"
sh "$here/sources.sh" "$build/sources" zlib libspng jansson libjpeg-turbo libzstd kissfft
# the modules of codecs (codecs.cmake), without which the rest works
sh "$here/sources.sh" "$build/sources" libwebp openexr imath draco || [ -z "${CI_REQUIRES_ALL-}" ] || exit 1
version=$(sh "$here/../packaging/version.sh")
toolchain="-G Ninja -DCMAKE_TOOLCHAIN_FILE=$here/toolchain.cmake -DCMAKE_BUILD_TYPE=Release"
log=$build/build.log
run() {
    "$@" >>"$log" 2>&1 || {
        tail -n 30 "$log" >&2
        echo "web: the build failed; the whole log is $log" >&2
        exit 1
    }
}
: >"$log"
if [ ! -f "$build/jpeg/libturbojpeg.a" ]; then
    step "libjpeg-turbo"
    # shellcheck disable=SC2086
    run cmake -S "$build/sources/libjpeg-turbo" -B "$build/jpeg" $toolchain -DWITH_SIMD=0 -DENABLE_SHARED=0 -DWITH_ARITH_ENC=0 \
        -DHAVE_SIZE_T=1 -DSIZE_T=4 # it cannot measure types there
    run cmake --build "$build/jpeg" --target turbojpeg-static
fi
step "facet and its libraries for WebAssembly: several minutes the first time, later what has changed; log in ${log#"$PWD/"}"
# shellcheck disable=SC2086
run cmake -S "$here" -B "$build" $toolchain -DFACET_SOURCES="$build/sources" -DFACET_JPEG="$build/jpeg" \
    -DFACET_GENERATED="$generated" -DFACET_VERSION="$version"
run cmake --build "$build"
step "models and pictures of the gallery"
sh "$here/gallery/make.sh" "$generated/../src/cli/facet" "$build/dist"
for file in "$build"/dist/facet-viewer/*.wasm "$build"/dist/facet-viewer/*.js; do
    echo "web: ${file##*/} $(wc -c <"$file") bytes, $(gzip -9c "$file" | wc -c) with gzip"
done
