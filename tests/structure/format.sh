#!/bin/sh
# format.sh - every C file is as .clang-format has it. Skips without clang-format 14 (others differ).
set -eu
command -v clang-format >/dev/null 2>&1 || { echo "skip: no clang-format"; exit 77; }
clang-format --version | grep -q 'version 14\.' || { echo "skip: clang-format is not version 14"; exit 77; }
{ git ls-files '*.c' '*.cc' '*.h' 2>/dev/null || find src shade include tests bench -name '*.[ch]' -o -name '*.cc'; } |
    grep -v '^shade/lang/' | tr '\n' '\0' | xargs -0 clang-format --dry-run -Werror
echo "format: as .clang-format has it"
