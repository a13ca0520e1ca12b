# lib.sh - for the tests of the command: sourced with the path of facet as $1. Each runs in its own empty folder.
facet=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
status=0
data=${FACET_TEST_DATA:-}
unset NO_COLOR COLUMNS
small="--size 48x32 --quality draft"

failed() {
    echo "FAILED: $*"
    sed 's/^/    err: /' err 2>/dev/null | head -5
    status=1
}

# expect CODE WORD...: runs facet WORD... with output in ./out and messages in ./err, and compares its exit code.
expect() {
    wanted=$1
    shift
    code=0
    "$facet" "$@" >out 2>err || code=$?
    [ "$code" = "$wanted" ] || failed "exit code $code, not $wanted: facet $*"
}

# says TEXT: the last messages contain it.
says() {
    grep -qF -- "$1" err || failed "no message says: $1"
}

# is_type FILE TEXT: the type by file(1); not checked without file(1).
is_type() {
    [ -s "$1" ] || { failed "$1 is missing or empty"; return; }
    command -v file >/dev/null || return 0
    file -b "$1" | grep -qF -- "$2" || failed "$1 is $(file -b "$1"), not $2"
}

# only NAME...: the folder holds these (besides out and err) and nothing else.
only() {
    found=$(ls -A | grep -vx -e out -e err | sort | tr '\n' ' ')
    wanted=$(for name in "$@"; do echo "$name"; done | sort | tr '\n' ' ')
    [ "$found" = "$wanted" ] || failed "the folder holds: $found; expected: $wanted"
}

# is_quick: whether long tests run a part of their cases, as another build of the same run does all (tests/support/support.h).
is_quick() {
    [ "${FACET_QUICK_TESTS:-0}" = 1 ]
}

# needs_data: skips the test without the shared models.
needs_data() {
    [ -n "$data" ] && [ -d "$data/models" ] || {
        echo "skipped: FACET_TEST_DATA names no folder with models"
        exit 77
    }
}

# write_triangle FILE: a self-contained glTF file of one triangle.
write_triangle() {
    cat >"$1" <<'END'
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
"nodes":[{"mesh":0},{"name":"Eye","camera":0,"translation":[0.3,0.3,3]}],
"cameras":[{"name":"Hero","type":"perspective","perspective":{"yfov":0.6,"znear":0.1}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}
END
}

finish() {
    [ $status = 0 ] && echo "$0: all as expected"
    exit $status
}
