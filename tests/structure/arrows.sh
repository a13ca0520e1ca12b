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
    cpu) echo cpu film ibl scene image base shade facet ;;
    legacy) echo legacy scene image base shade facet ;;
    plot) echo plot legacy ibl scene image base shade facet ;;
    report) echo report plot legacy cpu film ibl scene image base facet ;;
    api) echo api report plot legacy io cpu ibl film scene image base facet ;;
    cli) echo cli facet ;;
    *) echo "" ;;
    esac
}

for file in $(git ls-files 'src/*.c' 'src/*.cc' 'src/*.h' 2>/dev/null || find src -name '*.[ch]' -o -name '*.cc'); do
    module=$(echo "$file" | cut -d/ -f2)
    may=$(allowed "$module")
    if [ -z "$may" ]; then
        echo "$file: module $module is not in the list of arrows"
        status=1
        continue
    fi
    # Tests may look at what they test with: any module below or beside, so only their own module's sources count.
    case $file in *_test.c | *_test.h) continue ;; esac
    for include in $(sed -n 's/^#include "\([^"]*\)".*/\1/p' "$file"); do
        case $include in
        */*) target=${include%%/*} ;;
        *) continue ;; # generated, or beside
        esac
        case " $may " in
        *" $target "*) ;;
        *)
            echo "$file: includes $include; $module may include only: $may"
            status=1
            ;;
        esac
    done
done

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
seen_only '(EGL|GL|GLES[0-9]?|epoxy)/' gl
seen_only '(spng|turbojpeg|webp/|openexr|OpenEXR/|Imf|Iex|zlib|zstd|avif/|astcenc)' image

# shade/ includes nothing but itself.
found=$(grep -nE '^#include' shade/*.h | grep -vE '^shade/shade\.h:' || true)
if [ -n "$found" ]; then
    echo "shared text must not include anything: $found"
    status=1
fi
[ $status = 0 ] && echo "include arrows: all point downwards"
exit $status
