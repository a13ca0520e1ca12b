#!/bin/sh
# shaders.sh - facet shaders: GLSL that compiles, in every version, whole and in parts.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
. "$(dirname "$0")/lib.sh"

expect 0 shaders
[ "$(head -1 out)" = "#version 300 es" ] || failed "the first line is $(head -1 out)"
mv out whole
expect 0 shaders -o facet.glsl
cmp -s whole facet.glsl || failed "-o writes something else"
expect 0 shaders --glsl none fresnel -o part.glsl
! grep -q '^#version' part.glsl || failed "--glsl none has a version"
grep -q 'F_Schlick(' part.glsl || failed "fresnel lacks F_Schlick"
! grep -q 'tonemap' part.glsl || failed "fresnel brings tone mapping"
expect 0 shaders shade/fresnel.h --glsl none -o again.glsl
cmp -s part.glsl again.glsl || failed "a name of a file is no name of a part"
echo mine >facet.glsl
expect 0 shaders --no-clobber -o facet.glsl
[ "$(cat facet.glsl)" = mine ] || failed "--no-clobber wrote"

expect 2 shaders radiosity
says 'the shading text has no part "radiosity"'
expect 2 shaders --glsl 120
expect 6 shaders -o /dev/null/folder.glsl
[ ! -c /dev/full ] || expect 6 shaders -o /dev/full

expect 0 shaders --list
mv out parts
[ "$(wc -l <parts)" -gt 20 ] || failed "few parts: $(tr '\n' ' ' <parts)"
expect 0 --generate-completion bash
for part in $(cat parts); do
    grep -qw "$part" out || failed "completion does not know $part"
done

# compiles VERSION PART...: with a main() behind it
compiles() {
    version=$1
    shift
    "$facet" shaders --glsl "$version" "$@" >shader.frag
    printf 'out vec4 color;\nvoid main() { color = vec4(1.0); }\n' >>shader.frag
    glslangValidator shader.frag >log || failed "$version $*: $(head -5 log)"
}
if command -v glslangValidator >/dev/null; then
    for version in 300es 310es 320es 330 410 450 460; do
        compiles $version
    done
    for part in $(cat parts); do
        compiles 300es $part
    done
    compiles 460 fresnel tonemap
    for version in 300es 330 460; do
        { "$facet" shaders --glsl $version light ibl tonemap; cat "$root/docs/examples/glsl/lit.frag"; } >lit.frag
        glslangValidator lit.frag >log || failed "docs/examples/glsl/lit.frag, $version: $(head -5 log)"
    done
else
    echo "glslangValidator is missing (Debian: glslang-tools): GLSL was not compiled"
fi
finish
