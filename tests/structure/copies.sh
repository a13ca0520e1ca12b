#!/bin/sh
# copies.sh [ROOT] - no run of eight identical lines of code occurs twice in the product. Blank lines, comments, #include lines
# and indentation do not count; a run of table rows (no statement among the eight lines) is no code.
set -eu
cd "${1:-.}"
files=$(git ls-files 'src/*.[ch]' 'src/*.cc' 'shade/*.h' 'src/*.glsl' 2>/dev/null || true)
[ -n "$files" ] || files=$(find src shade -name '*.[ch]' -o -name '*.cc' -o -name '*.glsl')
# shellcheck disable=SC2086
found=$(awk '
    function is_code(first,    i, statements) {
        for (i = first; i < first + RUN; i++)
            statements += text[i] ~ /;$/
        return statements >= 3
    }
    BEGIN { RUN = 8 }
    FNR == 1 { count += RUN; comment = 0 } # no run crosses from one file into the next
    {
        line = $0
        gsub(/\/\*.*\*\//, "", line)
        gsub(/[ \t]+/, " ", line)
        sub(/^ /, "", line)
        sub(/ $/, "", line)
        if (comment) {
            if (line !~ /\*\//)
                next
            sub(/^.*\*\/ ?/, "", line)
            comment = 0
        }
        if (line ~ /\/\*/) {
            comment = 1
            sub(/ ?\/\*.*/, "", line)
        }
        if (line == "" || line ~ /^# *include/ || line ~ /^\/\//)
            next
        text[++count] = line
        place[count] = FILENAME ":" FNR
    }
    END {
        for (i = 1; i + RUN - 1 <= count; i++) {
            if (!(i in place) || !(i + RUN - 1 in place))
                continue
            run = ""
            for (k = 0; k < RUN && (i + k in place); k++)
                run = run text[i + k] "\n"
            if (k < RUN)
                continue
            if (!(run in seen)) {
                seen[run] = i
                continue
            }
            j = seen[run]
            if (i - 1 == last_i && j - 1 == last_j) { # one row for a longer run
                last_i = i
                last_j = j
                continue
            }
            if (!is_code(i))
                continue
            last_i = i
            last_j = j
            print place[j] " and " place[i] ": " text[i]
        }
    }' $(echo "$files" | grep -vE 'test|fixture|^src/[a-z]*/[a-z_]*bench'))
if [ -n "$found" ]; then
    echo "eight or more identical lines; let one function serve both:"
    echo "$found"
    exit 1
fi
echo "copies: no run of eight identical lines of code"
