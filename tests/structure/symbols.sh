#!/bin/sh
# symbols.sh LIBRARY - the shared library exports facet_ functions only, and every one that include/facet declares.
set -eu
exported=$(nm -D --defined-only "$1" | awk '$2 ~ /[A-Z]/ && $2 != "A" {sub(/@.*/, "", $3); print $3}' | sort -u)
declared=$(cat include/facet/*.h | tr '\n' ' ' | grep -oE 'FACET_API [a-z_0-9 *]*[ *](facet_[a-z0-9_]+)\(' | grep -oE 'facet_[a-z0-9_]+\(' |
    tr -d '(' | sort -u)
foreign=$(echo "$exported" | grep -v '^facet_' || true)
[ -z "$foreign" ] || { echo "exported and not facet_: $foreign"; exit 1; }
missing=$(echo "$declared" | grep -vxF "$exported" || true)
[ -n "$declared" ] || { echo "no declarations found in include/facet"; exit 1; }
[ -z "$missing" ] || { echo "declared and not exported: $missing"; exit 1; }
extra=$(echo "$exported" | grep -vxF "$declared" || true)
[ -z "$extra" ] || { echo "exported and not declared: $extra"; exit 1; }
echo "$(echo "$declared" | wc -l) functions, each declared and exported"
