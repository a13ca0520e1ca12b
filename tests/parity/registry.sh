#!/bin/sh
# registry.sh FILE... > cases.h: the table of the parity cases in these files, each with the header of its section.
set -eu
echo "static const parity_case parity_cases[] = {"
sed -n -e 's:^/\* ---- \([a-z_]*\)\.h ---- \*/$:#\1:p' -e 's/^FN vec3 case_\([A-Za-z0-9_]*\)(vec2 u)$/\1/p' "$@" |
    awk '/^#/ { header = substr($0, 2); next } { printf "    {\"%s\", \"%s\", case_%s},\n", header, $0, $0 }'
echo "};"
