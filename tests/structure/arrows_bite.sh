#!/bin/sh
# arrows_bite.sh - arrows.sh notices a wrong include, and the name of a struct above: a copy of the sources with one added must fail.
set -eu
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
cp -r src shade "$copy/"
if ! sh tests/structure/arrows.sh "$copy" >/dev/null; then
    echo "the copy should pass"
    exit 1
fi
for wrong in 'src/base/result.c:"image/image.h"' 'src/scene/scene.c:"shade/shade.h"' 'src/io/gltf/gltf.c:<embree3/rtcore.h>' \
    'src/cli/main.c:"scene/scene.h"' 'shade/brdf.h:"shade/color.h"'; do
    file=$copy/${wrong%%:*}
    cp "$file" "$copy/saved"
    echo "#include ${wrong#*:}" >>"$file"
    if sh tests/structure/arrows.sh "$copy" >/dev/null; then
        echo "not noticed: $wrong"
        exit 1
    fi
    cp "$copy/saved" "$file"
done
# Names of upper modules are refused as well: a pointer in a struct, a forward declaration.
for wrong in 'src/scene/scene.h:struct path_surface;' 'src/ocean/sea.h:struct opaque { const struct gl_sea *gl; };'; do
    file=$copy/${wrong%%:*}
    cp "$file" "$copy/saved"
    echo "${wrong#*:}" >>"$file"
    if sh tests/structure/arrows.sh "$copy" >/dev/null; then
        echo "not noticed: $wrong"
        exit 1
    fi
    cp "$copy/saved" "$file"
done
echo "each wrong include and name was noticed"
