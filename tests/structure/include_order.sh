#!/bin/sh
# include_order.sh BUILD [COMPILER] - no header needs to be included last: after shade/shade.h, whose names are short, the
# headers of the system, of other libraries and of facet still compile.
set -eu
build=${1:?build folder}
compiler=${2:-cc}
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
paths=$(grep -oE '(-I|-isystem )[^ "]+' "$build/compile_commands.json" | sort -u)
headers=$(git ls-files 'src/*.h' 2>/dev/null || true)
[ -n "$headers" ] || headers=$(find src -name '*.h')

# libraries FOLDER: those that its sources include, where they are installed, but for a browser's
libraries() {
    cat "$1"/*.[ch] | sed -n 's/^ *# *include \(<[^>]*>\).*/\1/p' | sort -u | grep -vE 'cmocka|facet/|GLES|emscripten' |
        sed 's/.*/#if __has_include(&)\n#include &\n#endif/'
}
# compiles FOLDER HEADER...
compiles() {
    { printf '#define _GNU_SOURCE\n#define GLFW_INCLUDE_NONE\n#include "shade/shade.h"\n'; libraries "$1"; shift; printf '#include "%s"\n' "$@"; } >"$tmp/all.c"
    # shellcheck disable=SC2086
    $compiler -std=c11 -w -DFACET_SHADE_DIALECT $paths -fsyntax-only "$tmp/all.c" >"$tmp/log" 2>&1
}

for folder in $(echo "$headers" | xargs -n 1 dirname | sort -u); do
    own=$(echo "$headers" | grep "^$folder/[^/]*$" | grep -vE 'test|fixture')
    # All at once, or one by one where two of them declare the same name.
    # shellcheck disable=SC2086
    compiles "$folder" $own || for header in $own; do
        compiles "$folder" "$header" || {
            echo "$header does not compile after shade/shade.h"
            grep -m 5 error "$tmp/log"
            exit 1
        }
    done
done
echo "include order: $(echo "$headers" | wc -l) headers compile after shade/shade.h"
