#!/bin/sh
# boundary_test.sh: the installed shade.h in programs that are not of its dialect: C11, C23, C++17 and C++20, gcc and clang,
# before and after other headers, with warnings as errors; definitions of programs and their headers are preserved; and the functions
# return the same numbers as in the dialect. Missing compilers are skipped.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
passed=0
skipped=0
pass() { passed=$((passed + 1)); }
fail() { echo "FAILED: $1"; head -20 "$tmp/log"; echo "$passed passed, 1 failed, $skipped skipped"; exit 1; }

# as it is installed
mkdir -p "$tmp/facet/shade/lang"
cp "$here"/*.h "$tmp/facet/shade/"
cp "$here"/lang/*.h "$tmp/facet/shade/lang/"
for part in begin end; do "$here/names.sh" $part >"$tmp/facet/shade/lang/names_$part.h"; done
cp "$here"/../include/facet/*.h "$tmp/facet/"

warnings="-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wdouble-promotion -Wundef -Werror -ffp-contract=off"
c_headers="math.h tgmath.h complex.h stdlib.h string.h stdbool.h stdint.h stdio.h ctype.h fenv.h time.h sys/types.h
    sys/sysmacros.h termios.h facet/facet.h"
cxx_headers="cmath complex algorithm numeric random valarray vector string functional cstdlib tgmath.h complex.h math.h stdlib.h
    sys/types.h sys/sysmacros.h termios.h facet/facet.h"

# ---- the same numbers ----

values() { # values PREFIX CONSTANT TYPE_SUFFIX: the body of main(), in C and C++
    cat <<END
    $1vec3 N = $1vec3(0.0f, 0.0f, 1.0f), V = $1normalize($1vec3(0.3f, -0.2f, 0.9f)), L = $1normalize($1vec3(-0.5f, 0.4f, 0.7f));
    $1Surface s = $1surface_from_metallic_roughness(N, $1vec3(0.8f, 0.5f, 0.2f), 0.4f, 0.35f);
    $1SurfaceLobes lobes = $1surface_lobes_cos(s, V, L, $2ENERGY_GLTF, $1vec2(0.0f));
    $1vec3 f = lobes.specular + lobes.diffuse;
    $1vec3 t = $1srgb_from_linear($1tonemap($2TONEMAP_AGX, f * 2.0f));
    $1vec3 w = $1phong_reflection(N, V, L, $1vec3(0.5f), $1vec3(0.7f), 20.0f);
    float d = $1dot(f, w) + $1D_GGX(0.9f, 0.3f) + $1V_SmithGGX(0.7f, 0.8f, 0.3f) + $2PI;
    printf("%a %a %a %a %a %a %a\n", (double)f[0], (double)f[1], (double)f[2], (double)t[0], (double)t[2], (double)w[1], (double)d);
END
}
{ echo '#include <stdio.h>'; echo '#include <facet/shade/shade.h>'; echo 'int main(void) {'; values "" ""; echo 'return 0; }'; } >"$tmp/dialect.c"
cc -std=c11 -O2 -ffp-contract=off -DFACET_SHADE_DIALECT -I"$tmp" "$tmp/dialect.c" -lm -o "$tmp/dialect" 2>"$tmp/log" || fail "the dialect"
"$tmp/dialect" >"$tmp/wanted"

# ---- definitions of programs and of their headers are preserved ----

{
    cat <<'END'
#include <stdio.h>
#include <math.h>
#define PI "mine"
#define min(a, b) "mine"
typedef double vec2[2];
static inline double luminance(double x) { return x; }
#include <facet/shade/shade.h>
typedef double vec3[3];
typedef struct Surface { int mine; } Surface;
static double clamp(double x) { return x; }
int main(void) {
END
    values shade_ SHADE_
    cat <<'END'
    vec2 pair = {1.0, 2.0};
    vec3 own = {sqrt(2.0), fabs(-1.5), sin(0.5)};
    Surface mine = {1};
    const char *texts[] = {PI, min(1, 2)};
    int (*callback)(const char *, ...) = printf;
    float (*root)(float) = sqrtf;
    return own[0] > 1.41421356 && own[1] > 1.4 && clamp(own[2]) < 0.5 && mine.mine == 1 && texts[0][0] == 'm' && texts[1][0] == 'm' &&
                   callback && root && luminance(pair[1]) > 1.5 && abs(-3) == 3
               ? 0
               : 1;
}
END
} | sed 's/#include <math.h>/#include <math.h>\n#include <stdlib.h>/' >"$tmp/own.c"
{
    cat <<'END'
#include <cstdio>
#define PI "mine"
#define min(a, b) "mine"
#include <facet/shade/shade.h>
#undef min
#include <algorithm>
#include <cmath>
typedef double vec3[3];
struct Surface { int mine; };
int main() {
END
    values facet:: SHADE_
    cat <<'END'
    vec3 own = {std::sqrt(2.0), std::min(1.5, 2.0), sin(0.5)};
    Surface mine = {1};
    return own[0] > 1.41421356 && own[1] > 1.4 && own[2] < 0.5 && mine.mine == 1 && PI[0] == 'm' ? 0 : 1;
}
END
} >"$tmp/own.cc"

# try COMPILER STANDARD FILE
try() {
    for level in 0 2; do
        $1 -std=$2 -O$level $warnings -I"$tmp" "$3" -lm -o "$tmp/own" 2>"$tmp/log" || fail "$1 -std=$2 -O$level: $3"
        "$tmp/own" >"$tmp/log" || fail "$1 -std=$2 -O$level: the program's own names"
        cmp -s "$tmp/log" "$tmp/wanted" || fail "$1 -std=$2 -O$level: other numbers than in the dialect"
        pass
    done
}

# orders COMPILER STANDARD SUFFIX HEADER...: all headers before and after; of the oldest standard also each by itself
orders() {
    compiler=$1 standard=$2 suffix=$3
    shift 3
    alone=$*
    case "$compiler $standard" in "gcc c11" | "g++ c++17") ;; *) alone= ;; esac
    for h in $alone; do
        printf '#include <%s>\n#include <facet/shade/shade.h>\n' "$h" >"$tmp/order.$suffix"
        $compiler -std="$standard" $warnings -I"$tmp" -fsyntax-only "$tmp/order.$suffix" 2>"$tmp/log" || fail "$compiler -std=$standard: after $h"
        printf '#include <facet/shade/shade.h>\n#include <%s>\n' "$h" >"$tmp/order.$suffix"
        $compiler -std="$standard" $warnings -I"$tmp" -fsyntax-only "$tmp/order.$suffix" 2>"$tmp/log" || fail "$compiler -std=$standard: before $h"
        pass
    done
    { printf '#include <%s>\n' "$@"; echo '#include <facet/shade/shade.h>'; printf '#include <%s>\n' "$@"; } >"$tmp/order.$suffix"
    $compiler -std="$standard" $warnings -I"$tmp" -fsyntax-only "$tmp/order.$suffix" 2>"$tmp/log" || fail "$compiler -std=$standard: between all"
    pass
}

for compiler in gcc clang; do
    if ! command -v $compiler >/dev/null; then skipped=$((skipped + 1)); continue; fi
    for standard in c11 c2x; do
        try $compiler $standard "$tmp/own.c"
        orders $compiler $standard c $c_headers
    done
done
for compiler in g++ clang++; do
    if ! command -v $compiler >/dev/null; then skipped=$((skipped + 1)); continue; fi
    for standard in c++17 c++20; do
        try $compiler $standard "$tmp/own.cc"
        orders $compiler $standard cc $cxx_headers
    done
done

# Type-generic mathematics and complex numbers of C work behind the header.
printf '#include <tgmath.h>\n#include <facet/shade/shade.h>\nint main(void) { double complex z = sqrt(-1.0 + 0.0 * I); return cimag(z) > 0.9 && (double)sqrt(4.0f) > 1.9 ? 0 : 1; }\n' >"$tmp/generic.c"
cc -std=c11 -I"$tmp" "$tmp/generic.c" -lm -o "$tmp/generic" 2>"$tmp/log" && "$tmp/generic" || fail "tgmath.h"
pass
# Every constant is an expression behind the header.
{ echo '#include <facet/shade/shade.h>'; echo 'double sum(void); double sum(void) { double x = 0;'
  sed -n 's/^#define \(SHADE_[A-Z_0-9]*\) .*/x += (double)\1;/p' "$tmp/facet/shade/lang/names_end.h"; echo 'return x; }'; } >"$tmp/constants.c"
cc -std=c11 -I"$tmp" -fsyntax-only "$tmp/constants.c" 2>"$tmp/log" || fail "constants"
pass
echo "$passed passed, 0 failed, $skipped skipped"
