#!/bin/sh
# run_all.sh - builds facet in four ways and runs every test in one ctest, whose summary comes last:
#     gcc     optimised, gcc, warnings are errors: all tests
#     clang   optimised, clang, warnings are errors: the tests labelled threads, the most computational
#     asan    clang with address and undefined behaviour sanitizers, and the fuzz targets: all tests
#     tsan    clang with the thread sanitizer: the tests labelled threads
# Arguments go to ctest, for example: ./run test -R brdf
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
build=$here/build/test
mkdir -p "$build"
jobs=$(nproc)

# clang's programs are many and large, and lld links them in a third of the time.
lld=
if command -v ld.lld >/dev/null 2>&1; then
    for kind in EXE SHARED MODULE; do
        lld="$lld -DCMAKE_${kind}_LINKER_FLAGS=-fuse-ld=lld"
    done
fi

# configure NAME TARGET CMAKE_OPTIONS...
configure() {
    name=$1
    target=$2
    shift 2
    cmake -S "$here" -B "$build/$name" -G Ninja -DFACET_WERROR=ON -DFACET_TEST_PREFIX="$name." "$@" \
        >"$build/$name.log" 2>&1 && cmake --build "$build/$name" -j "$jobs" -t "$target" >>"$build/$name.log" 2>&1 || {
        tail -n 60 "$build/$name.log"
        echo "build $name failed"
        exit 1
    }
    echo "built $name"
}

# Khronos' glTF validator, programs that read baked environments, and what the element is compared with; their tests are skipped
# without npm or network access.
# Some of tests/clients need a browser, too, which ./run test installs.
for folder in validator clients web serve; do
    if command -v npm >/dev/null 2>&1 && [ ! -d "$here/tests/$folder/node_modules" ]; then
        (cd "$here/tests/$folder" && npm ci --no-audit --no-fund >"$build/npm.log" 2>&1) ||
            {
                echo "npm ci failed in tests/$folder: $(tail -n 1 "$build/npm.log")"
                [ -z "${CI_REQUIRES_ALL-}" ] || exit 1
            }
    fi
done

configure gcc all -DCMAKE_C_COMPILER=gcc -DCMAKE_BUILD_TYPE=Release
# The modules for browsers. Their tests are skipped without emscripten, or where Debian's sources cannot be downloaded (77),
# unless CI_REQUIRES_ALL is set.
if command -v emcc >/dev/null 2>&1; then
    status=0
    sh "$here/web/build.sh" "$build/gcc/generated" || status=$?
    [ "$status" = 0 ] || { [ "$status" = 77 ] && [ -z "${CI_REQUIRES_ALL-}" ]; } || exit 1
fi
configure clang facet_tested -DCMAKE_C_COMPILER=clang $lld -DCMAKE_BUILD_TYPE=Release -DFACET_TRUTH=OFF -DFACET_BENCH=OFF \
    -DFACET_TEST_LABEL=threads
# A sanitizer's report needs line numbers only.
sanitized="-DCMAKE_C_COMPILER=clang $lld -DCMAKE_BUILD_TYPE=RelWithDebInfo -DFACET_BENCH=OFF"
configure asan all $sanitized -DCMAKE_C_FLAGS_RELWITHDEBINFO="-O2 -g1 -DNDEBUG" -DFACET_SANITIZE=address,undefined -DFACET_FUZZ=ON \
    -DFACET_FUZZ_GUIDED=OFF
configure tsan facet_tested $sanitized -DCMAKE_C_FLAGS_RELWITHDEBINFO="-O2 -g1 -DNDEBUG" -DFACET_SANITIZE=thread -DFACET_TEST_LABEL=threads

# One ctest over all builds: one summary.
printf 'subdirs("gcc" "clang" "asan" "tsan")\n' >"$build/CTestTestfile.cmake"
cd "$build"
# One test more than there are cores, as some wait for a window, a browser, a time limit.
exec ctest -j "$((jobs + 1))" --output-on-failure "$@"
