#!/bin/sh
# arrows.sh - the include arrows of docs/architecture.md, enforced: a module may include what stands behind its
# colon, and a few third-party headers are seen in one module only. Prints each line that breaks a rule.
#     arrows.sh [ROOT]
set -eu
cd "${1:-.}"
status=0

# allowed MODULE DIRECTORY... : prints the modules that MODULE may include.
allowed() {
    case $1 in
    base) echo base facet ;;
    image) echo image base facet ;;
    scene) echo scene image base facet ;;
    io) echo io scene image base facet ;;
    ibl) echo ibl scene image base shade facet ;;
    film) echo film image base shade facet ;;
    bake) echo bake ibl scene image base shade facet ;;
    glsl) echo glsl base facet ;;
    draw) echo draw ibl scene image base shade facet ;;
    ocean) echo ocean scene image base shade facet ;;
    water) echo water path ocean cpu draw film ibl scene image base shade facet ;;
    cpu) echo cpu draw film ibl scene image base shade facet ;;
    gl) echo gl water ocean draw glsl film ibl scene image base shade facet ;;
    view) echo view gl plot draw film ibl scene image base shade facet ;;
    legacy) echo legacy scene image base shade facet ;;
    plot) echo plot legacy ibl scene image base shade facet ;;
    report) echo report bake plot legacy cpu draw film ibl scene image base facet ;;
    path) echo path cpu draw film ibl scene image base shade facet ;;
    compare) echo compare image base shade facet ;;
    render) echo render gl path water ocean cpu draw film ibl scene image base facet ;;
    api) echo api render gl ocean bake compare report plot legacy io cpu ibl film scene image base facet ;;
    cli) echo cli base facet ;;
    *) echo "" ;;
    esac
}

# Tests may include any module, so only sources of the product count.
files=$(git ls-files 'src/*.c' 'src/*.cc' 'src/*.h' 2>/dev/null || true)
[ -n "$files" ] || files=$(find src -name '*.[ch]' -o -name '*.cc')
rules=$(for module in $(echo "$files" | cut -d/ -f2 | sort -u); do echo "$module $(allowed "$module")"; done)
# /dev/null: grep prints the file name even for a single file
wrong=$(echo "$files" | grep -vE '_(test|fixture)[a-z_]*\.[ch]$' | xargs grep -E '^#include "[^"/]*/' /dev/null | awk -v rules="$rules" '
    BEGIN {
        count = split(rules, lines, "\n")
        for (i = 1; i <= count; i++) {
            words = split(lines[i], word, " ")
            if (words == 1)
                print word[1] ": the module is not in the list of arrows"
            may[word[1]] = " "
            for (k = 2; k <= words; k++)
                may[word[1]] = may[word[1]] word[k] " "
        }
    }
    {
        split($0, quoted, "\"")
        split(quoted[2], target, "/")
        split($0, place, ":")
        split(place[1], path, "/")
        if (index(may[path[2]], " " target[1] " ") == 0)
            print place[1] ": includes " quoted[2] "; " path[2] " may include only:" may[path[2]]
    }')
if [ -n "$wrong" ]; then
    echo "$wrong"
    status=1
fi

# Forward declarations count as includes: "struct NAME" of a module that may not be included is refused.
wrong=$(echo "$files" | grep -vE '_test\.[ch]$' | xargs grep -oE '(^|[^"[:alnum:]_])struct [[:alpha:]_][[:alnum:]_]*( *\{|)' /dev/null |
    awk -v rules="$rules" '
    BEGIN {
        count = split(rules, lines, "\n")
        for (i = 1; i <= count; i++) {
            words = split(lines[i], word, " ")
            may[word[1]] = " "
            for (k = 2; k <= words; k++)
                may[word[1]] = may[word[1]] word[k] " "
        }
    }
    {
        place = substr($0, 1, index($0, ":") - 1)
        split(place, path, "/")
        rest = substr($0, index($0, "struct ") + 7)
        name = rest
        sub(/[^A-Za-z0-9_].*/, "", name)
        if (rest ~ /\{/)
            defined[name] = defined[name] " " path[2]
        else if (!((place, name) in used)) {
            used[place, name] = 1
            uses[++use_count] = place " " path[2] " " name
        }
    }
    END {
        for (i = 1; i <= use_count; i++) {
            split(uses[i], use, " ")
            if (!(use[3] in defined))
                continue
            homes = split(defined[use[3]], home, " ")
            is_near = 0
            for (k = 1; k <= homes; k++)
                is_near = is_near || index(may[use[2]], " " home[k] " ") > 0
            if (!is_near)
                print use[1] ": names struct " use[3] " of" defined[use[3]] "; " use[2] " may know only:" may[use[2]]
        }
    }')
if [ -n "$wrong" ]; then
    echo "$wrong"
    status=1
fi

# seen_only PATTERN MODULE...: a third-party header and the modules that may see it.
seen_only() {
    pattern=$1
    shift
    found=$(grep -rlE "^#include <$pattern" src | grep -vE "^src/($(echo "$*" | tr ' ' '|'))/" || true)
    if [ -n "$found" ]; then
        echo "<$pattern..> belongs to $* only, but is included by: $found"
        status=1
    fi
}
seen_only 'embree' cpu
seen_only 'jansson' io cli
seen_only 'cminpack' legacy
seen_only 'cairo' plot
seen_only 'draco/' io
seen_only '(EGL|GL|GLES[0-9]?|epoxy)/' gl view
seen_only 'GLFW/' view
seen_only '(spng|libdeflate|turbojpeg|webp/|openexr|OpenEXR/|Imf|Iex|zstd|avif/|astcenc)' image
seen_only 'zlib' image cli
seen_only 'microhttpd' cli

# The command writes files in output.c and video.c only, which keep signals from ending it meanwhile (interrupt.h).
found=$(grep -nE '\<facet_(bytes|image|scene)_save\(|fopen\([^)]*"[wa]' src/cli/*/*.c src/cli/*.c |
    grep -vE '^src/cli/(shared/output|render/video)\.c:' || true)
if [ -n "$found" ]; then
    echo "files are written by output.c and video.c: $found"
    status=1
fi

# shade/ includes only its own headers.
found=$(grep -nE '^#include' shade/*.h | grep -vE '^shade/shade\.h:' || true)
if [ -n "$found" ]; then
    echo "the shader library must not include anything: $found"
    status=1
fi
[ $status = 0 ] && echo "include arrows: all point downwards"
exit $status
