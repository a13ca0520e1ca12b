#!/bin/sh
# headers.sh - each header of include/facet compiles alone, as C11 and as C++17, with every compiler that is there; the
# umbrella includes all of them; and enum constants begin with the name of their type.
set -eu
headers=$(cd include/facet && ls ./*.h | sed 's|^\./||')
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
status=0
fail() {
    echo "$1"
    status=1
}

compile() { # compile FILE LANGUAGE COMPILER STANDARD
    "$3" -x "$2" -std="$4" -Wall -Wextra -Wpedantic -Wshadow -Werror -fsyntax-only -Iinclude "$1" 2>"$tmp/log" ||
        fail "$(basename "$1" .src): $3 -std=$4: $(head -5 "$tmp/log")"
}
count=0
for header in $headers; do
    [ "$header" = facet.h ] || grep -qx "#include \"$header\"" include/facet/facet.h || fail "facet.h lacks $header"
    echo "#include <facet/$header>" >"$tmp/$header.src"
    for compiler in gcc clang; do
        command -v $compiler >/dev/null 2>&1 || continue
        compile "$tmp/$header.src" c $compiler c11
        count=$((count + 1))
    done
    for compiler in g++ clang++; do
        command -v $compiler >/dev/null 2>&1 || continue
        compile "$tmp/$header.src" c++ $compiler c++17
        count=$((count + 1))
    done
done

# {0} is a valid desc in both languages.
printf '#include <facet/facet.h>\nfacet_render_desc desc = {};\nint main() { return facet_version()[0] ? 0 : 1; }\n' >"$tmp/cxx.src"
printf '#include <facet/facet.h>\nfacet_render_desc desc = {0};\nint main(void) { return facet_version()[0] ? 0 : 1; }\n' >"$tmp/c.src"
compile "$tmp/c.src" c cc c11
compile "$tmp/cxx.src" c++ c++ c++17

# facet_result's are FACET_OK and FACET_ERROR_*.
wrong=$(for header in $headers; do
    gcc -w -fpreprocessed -dD -E -P "include/facet/$header" | tr '\n' ' ' | grep -oE 'typedef enum [a-z0-9_]+ \{[^}]*' |
        awk '{ prefix = toupper($3) "_"; count = split($0, words, /[^A-Za-z0-9_]+/) }
            prefix != "FACET_RESULT_" { for (i = 4; i <= count; i++)
                if (words[i] ~ /^FACET_/ && index(words[i], prefix) != 1)
                    print words[i] " should begin with " prefix }'
done)
[ -z "$wrong" ] || fail "$wrong"
[ $status = 0 ] && echo "$(echo "$headers" | wc -l) headers, $count compilations"
exit $status
