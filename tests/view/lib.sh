# lib.sh - for the tests of the viewer: sourced with the path of facet as $1, followed by the test's arguments. Starts an X server
# without a screen, and skips without one, GLFW or OpenGL.
. "$(dirname "$0")/../cli/lib.sh"


# GLFW unloads Mesa's driver at the end, and the leak checker reports its memory; a driver that is preloaded stays.
driver=$(ls /usr/lib/*/dri/swrast_dri.so 2>/dev/null | head -1)
if [ -n "$driver" ] && grep -q __lsan_do_leak_check "$facet"; then
    printf '#!/bin/sh\nLD_PRELOAD=%s exec "%s" "$@"\n' "$driver" "$facet" >"$work/facet.sh"
    chmod +x "$work/facet.sh"
    facet=$work/facet.sh
fi
program=$facet

skip() {
    echo "skipped: $*"
    exit 77
}

command -v Xvfb >/dev/null || skip "there is no Xvfb"
# A number that no other test has: an exiting server removes the socket of its number, even if another server has just taken it.
# It stays when its last client exits. </dev/null etc.: a reader of the test's output does not wait for the server.
Xvfb ":$((100 + $$ % 50000))" -displayfd 3 -noreset -screen 0 1024x768x24 -nolisten tcp 3>display >/dev/null 2>&1 </dev/null &
server=$!
trap 'kill $server 2>/dev/null; wait $server 2>/dev/null; rm -rf "$work"' EXIT
tries=0
while [ ! -s display ] && [ $tries -lt 100 ]; do
    sleep 0.1
    tries=$((tries + 1))
done
[ -s display ] || skip "Xvfb does not start"
DISPLAY=:$(cat display)
export DISPLAY
unset WAYLAND_DISPLAY
rm -f display
size="--size 160x120"

# Opens and closes a window: skips with a message if something is missing.
printf 'close\n' >close.txt
code=0
"$facet" view --script close.txt $size >out 2>err || code=$?
[ $code != 8 ] || skip "$(cat err)"
[ $code = 0 ] || failed "exit code $code where a window opens and closes"

# view WORD...: plays ./script; messages are in ./err, output in ./out.
view() {
    expect 0 view --script script $size "$@"
}

# same A B [MOST]: the images differ by at most one code, or MOST, anywhere.
same() {
    "$facet" compare "$1" "$2" --max "max=${3:-0.0040}" -q >compared 2>&1 ||
        failed "$1 and $2 differ: $(cat compared)"
}

# differ A B: the images differ visibly.
differ() {
    ! "$facet" compare "$1" "$2" --max mae=0.002 -q >/dev/null 2>&1 || failed "$1 and $2 are alike"
}

# rendered IMAGE FILE [MOST]: the last printed command, run by a shell, writes FILE, equal to the last bit, or within MOST.
rendered() {
    tail -1 out | grep '^facet render ' >command || {
        failed "no command was printed"
        return
    }
    rm -f "$2"
    (
        facet() { "$program" "$@"; }
        . ./command
    ) >/dev/null 2>err || failed "the printed command fails: $(cat command)"
    same "$1" "$2" "${3:-0}"
}
