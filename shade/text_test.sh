#!/bin/sh
# text_test.sh c COMPILER | glsl: the shader library by its compilers. C: every header compiles after those before it, in
# that order and in no other; GLSL: the same in each version; violations of the dialect that one language alone would
# accept are rejected. Exits with 77 where glslangValidator is missing.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
side=${1:?c or glsl}
compiler=${2:-cc}
strict="-DFACET_SHADE_DIALECT -std=c11 -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion -Wstrict-prototypes -Werror"
headers=$(sed -n 's/^#include "\([a-z_]*\.h\)"$/\1/p' "$here/shade.h")
passed=0

pass() { passed=$((passed + 1)); }
fail() { echo "FAILED: $1"; [ ! -f "$tmp/log" ] || head -20 "$tmp/log"; echo "$passed passed, 1 failed"; exit 1; }

# c_compiles HEADER...: these, in this order, between the two halves of the dialect
c_compiles() {
    { echo '#include "lang/lang_c.h"'; printf '#include "%s"\n' "$@"; echo '#include "lang/lang_c_end.h"'; } > "$tmp/part.c"
    $compiler $strict -I"$here" -fsyntax-only "$tmp/part.c" > "$tmp/log" 2>&1
}
# glsl_compiles VERSION HEADER...
glsl_compiles() {
    version=$1
    shift
    { echo "#version $version"; cat "$here/lang/lang_glsl.glsl"
      for h in "$@"; do grep -v '^#include' "$here/$h"; done
      echo 'void main() {}'; } > "$tmp/part.frag"
    glslangValidator "$tmp/part.frag" > "$tmp/log" 2>&1
}
compiles() { if [ "$side" = c ]; then c_compiles "$@"; else glsl_compiles "300 es" "$@"; fi; }

# slip TEXT: whether a function added to the whole text compiles
slip() {
    printf '%s\n' "$1" > "$tmp/slip.h"
    if [ "$side" = c ]; then
        { echo '#include "shade.h"'; echo '#include "lang/lang_c_begin.h"'; cat "$tmp/slip.h"; } > "$tmp/slip.c"
        $compiler $strict -I"$here" -fsyntax-only "$tmp/slip.c" > "$tmp/log" 2>&1
    else
        { "$here/glsl.sh" "300 es" "$tmp/slip.h"; echo 'void main() {}'; } > "$tmp/slip.frag"
        glslangValidator "$tmp/slip.frag" > "$tmp/log" 2>&1
    fi
}
accepted() { slip "$1" || fail "not accepted: $1"; pass; }
rejected() { ! slip "$1" || { rm "$tmp/log"; fail "not rejected: $1"; }; pass; }

if [ "$side" = glsl ] && ! command -v glslangValidator > /dev/null; then
    echo "0 passed, 0 failed, 1 skipped: glslangValidator is missing (Debian: glslang-tools)"
    exit 77
fi

# ---- every header after those before it, and not without them ----

before=
for h in $headers; do
    before="$before $h"
    compiles $before || fail "$side: $before"
    pass
done
for pair in "fresnel.h surface.h" "surface.h brdf.h" "constants.h sampling.h brdf.h" "constants.h brdf.h tonemap.h"; do
    ! compiles $pair || { rm "$tmp/log"; fail "$side: compiles out of order: $pair"; }
    pass
done

# ---- slips ----

accepted 'FN float good(float x, vec3 v) { return max(x * 0.1f, v[2]) + float(3u); }'
if [ "$side" = c ]; then
    rejected 'FN float bad(float x) { return x * 0.1; }'             # a double
    rejected 'FN float bad(float x) { return max(0.0, x); }'         # a double selects nothing
    rejected 'FN float bad(float x) { return sqrt(2); }'             # nor does an int
    rejected 'FN vec3 bad(vec3 v) { return v.zyx; }'                 # swizzle
    rejected 'FN vec3 bad(vec3 v) { v.x = 1.0f; return v; }'         # component by name
    rejected 'FN vec3 bad(vec2 v) { return mix(v, vec3(1.0f), 0.5f); }'
    rejected 'FN float bad(float x) { vec3 v = vec3(x, x); return v[0]; }'
else
    rejected 'FN float bad(float x) { float y = 1; return x * y; }'  # int to float
    rejected 'FN float bad(float x) { return pow(x, 2); }'
    rejected 'FN vec3 bad(vec3 v) { return pow(v, 2.0f); }'
    rejected 'FN float bad(float sample) { return sample; }'         # reserved word
    rejected 'FN float bad(const float *x) { return x[0]; }'         # pointer
    rejected 'FN vec3 bad(vec3 v) { return sel(v < v, v, v); }'      # comparison of vectors
    rejected 'FN float reflect(float x) { return x; }'               # redefines a built-in
    rejected 'FN Light bad(vec3 v) { Light l = {v}; return l; }'     # brace initialiser
fi

# ---- the whole ----

compositions="compose/surface_tables.h compose/surface_radiance.h compose/ogl1_light.h compose/ogl1_fragment.h compose/sea_radiance.h"

if [ "$side" = c ]; then
    for h in $headers; do
        grep -q "$h" "$here/CMakeLists.txt" || fail "CMakeLists.txt does not install $h"
    done
    for h in $headers $compositions; do
        # Some parity case calls every function, so that the parity test compares all of them.
        for f in $(sed -n 's/^FN [A-Za-z0-9]* \([A-Za-z_0-9]*\)(.*/\1/p' "$here/$h"); do
            grep -q "[^A-Za-z_0-9]$f(" "$here"/../tests/parity/*.h || fail "no parity case calls $f() of $h"
        done
        ! LC_ALL=C grep -n '[^ -~]' "$here/$h" || fail "$h: a byte that is not ASCII"
        pass
    done
else
    parity=$here/../tests/parity
    # ogl1.h uses functions of phong.h, and sea_radiance.h those of water.h.
    cases="$(ls "$parity"/*.h | grep -v -e common.h -e _host.h -e /ogl1.h -e /sea_radiance.h) $parity/ogl1.h $parity/sea_radiance.h"
    for version in "300 es" "330 core" "410 core"; do
        { "$here/glsl.sh" "$version" "$parity/common.h" "$parity"/*_host.h $(for c in $compositions; do echo "$here/$c"; done) $cases
          echo 'void main() {}'; } > "$tmp/parity.frag"
        glslangValidator "$tmp/parity.frag" > "$tmp/log" || fail "#version $version"
        pass
    done
fi
echo "$passed passed, 0 failed"
