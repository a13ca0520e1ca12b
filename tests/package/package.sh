#!/bin/sh
# package.sh BUILD - installs BUILD into a prefix and uses it from other projects: through CMake, through
# pkg-config with the shared library, and through pkg-config with the static one.
set -eu
build=$1
sources=$(cd "$(dirname -- "$0")" && pwd)
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
cmake --install "$build" --prefix "$prefix/usr" >/dev/null
for file in bin/facet include/facet/facet.h include/facet/base.h include/facet/sea.h share/man/man1/facet.1 share/man/man1/facet-render.1 \
    share/bash-completion/completions/facet share/zsh/site-functions/_facet \
    share/fish/vendor_completions.d/facet.fish include/facet/shade/brdf.h share/doc/facet/cli.md share/doc/facet/bake.md share/doc/facet/LICENSE \
    share/doc/facet/NOTICE share/doc/facet/CHANGELOG.md; do
    [ -e "$prefix/usr/$file" ] || { echo "not installed: $file"; exit 1; }
done
for header in "$prefix"/usr/include/facet/*.h; do # each as it is installed
    printf '#include <facet/%s>\n' "$(basename "$header")" | c++ -x c++ -std=c++17 -fsyntax-only -I"$prefix/usr/include" -
done
pc=$(dirname "$(find "$prefix/usr" -name facet.pc)")
lib=$(dirname "$pc")
export PKG_CONFIG_PATH="$pc"
foreign=$(nm --defined-only -g "$lib/libfacet.a" | awk 'NF == 3 {print $3}' | grep -v '^facet_' || true)
[ -z "$foreign" ] || { echo "libfacet.a defines names that are not facet_*: $foreign"; exit 1; }
if grep -rl "$PWD/src\|$build" "$pc" "$lib/cmake" >"$prefix/leaks" 2>/dev/null; then
    echo "a path of the build machine stands in: $(cat "$prefix/leaks")"
    exit 1
fi

# Uses the build tool of this build; others may be missing.
CMAKE_GENERATOR=$(sed -n 's/^CMAKE_GENERATOR:INTERNAL=//p' "$build/CMakeCache.txt")
export CMAKE_GENERATOR

cd "$prefix"
cc -std=c11 "$sources/consumer.c" $(pkg-config --cflags --libs facet) -o shared
LD_LIBRARY_PATH=$lib ./shared shared.png
cc -std=c11 "$sources/consumer.c" $(pkg-config --cflags --static facet) "$lib/libfacet.a" \
    $(pkg-config --libs --static facet | sed 's/-lfacet//') -o static
./static static.png
cmake -S "$sources" -B cmake -DCMAKE_PREFIX_PATH="$prefix/usr" >/dev/null
cmake --build cmake >/dev/null
LD_LIBRARY_PATH=$lib cmake/consumer cmake.png
cmake/consumer_static cmake_static.png
for image in static cmake cmake_static; do
    cmp shared.png $image.png
done
LD_LIBRARY_PATH=$lib usr/bin/facet version
LD_LIBRARY_PATH=$lib usr/bin/facet help documents >documents
for document in $(grep -oE '[^ ]*/share/doc/facet/[a-z-]*\.md' documents); do
    [ -r "$document" ] || { echo "help names $document, which is not installed"; exit 1; }
done
[ "$(grep -c '/share/doc/facet/[a-z0-9-]*\.md' documents)" -ge 20 ] || { echo "help documents: $(cat documents)"; exit 1; }
# The OpenGL module: found beside the installed library and command, and beside a program with the static library. It
# exports its entry only.
if grep -q 'FACET_HAS_GL 1' "$build/generated/build_config.h"; then
    module=$lib/facet/facet_gl.so
    [ -e "$module" ] || { echo "not installed: lib/facet/facet_gl.so"; exit 1; }
    foreign=$(nm -D --defined-only "$module" | awk '$2 ~ /[TDBRVW]/ {print $3}' | grep -vx 'facet_gl_entry' || true)
    [ -z "$foreign" ] || { echo "facet_gl.so exports more than its entry: $foreign"; exit 1; }
    if ldd "$lib/libfacet.so" usr/bin/facet | grep -E 'libepoxy|libGL|libEGL'; then
        echo "libfacet or facet is linked with OpenGL"
        exit 1
    fi
    cp "$module" .
    code=0
    ./static gl_static.png gl 2>"$prefix/why" || code=$?
    if [ "$code" = 0 ]; then
        LD_LIBRARY_PATH=$lib ./shared gl_shared.png gl
        cmp gl_static.png gl_shared.png
        LD_LIBRARY_PATH=$lib usr/bin/facet render -o gl_command.png --size 64x48 --renderer gl
        [ -s gl_command.png ]
    else
        [ "$code" = 77 ] && grep -q 'there is no driver' "$prefix/why" || { cat "$prefix/why"; exit 1; }
    fi
fi
# The sources of the shader library stand alone as well.
cc -std=c11 -I"$prefix/usr/include" "$sources/../../docs/examples/c/shade.c" -lm -o shade && ./shade
printf '#include <facet/shade/shade.h>\nint main() { return facet::D_GGX(1.0f, 1.0f) > 0.0f ? 0 : 1; }\n' >shade.cc
c++ -std=c++17 -I"$prefix/usr/include" shade.cc -o shade && ./shade
echo "package: shared, static and CMake consumers draw the same picture"
