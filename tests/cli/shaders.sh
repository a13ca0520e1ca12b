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
says 'the shader library has no part "radiosity"'
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
# The calls of a viewer that includes the text unchanged.
expect 0 shaders --names khronos --glsl none
grep -q 'vec3 BRDF_lambertian(' out || failed "--names khronos lacks BRDF_lambertian"
! grep -q 'tonemap' out || failed "--names khronos brings parts that its names do not use"
cat >viewer.frag <<'END'
const float M_PI = 3.141592653589793;
float PI = 3.14159265358979323846;
float max3(vec3 v) { return max(max(v.x, v.y), v.z); }
uniform vec3 f0, f90, base, n, v, l, t, b;
uniform float alphaRoughness, sheenRoughness, weight, anisotropy;
out vec4 color;
void main()
{
    vec3 h = normalize(l + v);
    float NdotL = clamp(dot(n, l), 0.0, 1.0), NdotV = clamp(dot(n, v), 0.0, 1.0);
    float NdotH = clamp(dot(n, h), 0.0, 1.0), VdotH = clamp(dot(v, h), 0.0, 1.0);
    vec3 F = F_Schlick(f0, f90, VdotH) + F_Schlick(f0, 1.0, VdotH) + F_Schlick(f0, VdotH);
    F += vec3(F_Schlick(0.04, 1.0, VdotH) + F_Schlick(0.04, VdotH));
    F += Schlick_to_F0(F, f90, VdotH) + Schlick_to_F0(F, VdotH);
    F += vec3(Schlick_to_F0(0.5, 1.0, VdotH) + Schlick_to_F0(0.5, VdotH));
    float D = D_GGX(NdotH, alphaRoughness) * V_GGX(NdotL, NdotV, alphaRoughness);
    vec3 sum = BRDF_lambertian(base) + BRDF_lambertian(f0, f90, base, weight, VdotH);
    sum += BRDF_specularGGX(alphaRoughness, NdotL, NdotV, NdotH);
    sum += BRDF_specularGGX(f0, f90, alphaRoughness, weight, VdotH, NdotL, NdotV, NdotH);
    sum += BRDF_specularGGXAnisotropy(alphaRoughness, anisotropy, n, v, l, h, t, b);
    sum += BRDF_specularGGXAnisotropy(f0, f90, alphaRoughness, anisotropy, n, v, l, h, t, b);
    sum += vec3(D_GGX_anisotropic(NdotH, dot(t, h), dot(b, h), anisotropy, 0.3, 0.1));
    sum += vec3(V_GGX_anisotropic(NdotL, NdotV, dot(b, v), dot(t, v), dot(t, l), dot(b, l), 0.3, 0.1));
    sum += BRDF_specularSheen(base, sheenRoughness, NdotL, NdotV, NdotH);
    sum += vec3(D_Charlie(sheenRoughness, NdotH) * V_Sheen(NdotL, NdotV, sheenRoughness));
    sum += vec3(lambdaSheen(NdotV, sheenRoughness) + lambdaSheenNumericHelper(NdotL, sheenRoughness));
    sum += BRDF_lambertianIridescence(f0, f90, F, 0.5, base, weight, VdotH);
    sum += BRDF_specularGGXIridescence(f0, f90, F, alphaRoughness, 0.5, weight, VdotH, NdotL, NdotV, NdotH);
    color = vec4((F * D + sum) * max3(base) * M_PI / PI, 1.0);
}
END
if command -v glslangValidator >/dev/null; then
    for version in 300es 310es 320es 330 460; do
        { "$facet" shaders --names khronos --glsl $version; cat viewer.frag; } >khronos.frag
        glslangValidator khronos.frag >log || failed "--names khronos, $version: $(head -5 log)"
    done
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
        { "$facet" shaders --glsl $version water ibl tonemap; cat "$root/docs/examples/glsl/ocean.frag"; } >ocean.frag
        glslangValidator ocean.frag >log || failed "docs/examples/glsl/ocean.frag, $version: $(head -5 log)"
    done
else
    echo "glslangValidator is missing (Debian: glslang-tools): GLSL was not compiled"
fi
finish
