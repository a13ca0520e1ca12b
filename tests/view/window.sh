#!/bin/sh
# window.sh - facet view as a person has it: keys and the pointer through the X server, sleep, the end; and machines without
# a display.
set -eu
. "$(dirname "$0")/lib.sh"
write_triangle triangle.gltf

(
    unset DISPLAY
    expect 8 view triangle.gltf
    says "window: there is no display"
    [ "$(wc -l <err)" = 1 ] || failed "more than a sentence: $(cat err)"
    exit $status
) || status=1

command -v xdotool >/dev/null || {
    echo "xdotool is not there: no keys through the X server"
    finish
}

# until COMMAND: it succeeds at last.
until_it() {
    tries=0
    until eval "$1"; do
        tries=$((tries + 1))
        [ $tries -lt 100 ] || {
            failed "this never came: $1"
            return
        }
        sleep 0.1
    done
}

printed() {
    grep -c '^facet render' shown || true
}

"$program" view triangle.gltf $size >shown 2>err &
viewer=$!
until_it 'xdotool search --name "^triangle.gltf - facet" >/dev/null 2>&1'
# keys that come before the first picture wait for it
until_it 'xdotool mousemove 80 60 key question; sleep 0.1; [ "$(printed)" -ge 1 ]'
xdotool mousedown 1 mousemove 90 64 mousemove 100 66 mouseup 1 key plus key --delay 50 shift+t
count=$(printed)
xdotool key question
until_it '[ "$(printed)" -gt $count ]'
tail -1 shown >last
grep -q -- '--exposure 0.33' last || failed "a key did nothing: $(cat last)"
grep -q -- '--tone-mapping' last || failed "a key with shift did nothing: $(cat last)"
grep -q -- '--orbit 0,' last && failed "the pointer turned nothing: $(cat last)"

# who waits for events takes no time: hundredths of a second in one second, once messages are gone
ticks() {
    sed 's/.*) //' /proc/$viewer/stat | awk '{print $12 + $13}'
}
if [ -r /proc/$viewer/stat ]; then
    sleep 2.5
    before=$(ticks)
    sleep 1
    after=$(ticks)
    [ $((after - before)) -le 2 ] || failed "it took $((after - before)) hundredths of an idle second"
fi

xdotool key q
code=0
wait $viewer || code=$?
[ $code = 0 ] || failed "exit code $code at the end: $(cat err)"

finish
