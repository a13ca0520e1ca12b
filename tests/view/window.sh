#!/bin/sh
# window.sh - facet view in use: keys and the pointer through the X server, idling, exit; and machines without a display.
set -eu
. "$(dirname "$0")/lib.sh"
write_triangle triangle.gltf

(
    unset DISPLAY
    expect 8 view triangle.gltf
    says "window: there is no display"
    grep -q ' )' err && failed "a stray blank: $(cat err)"
    [ "$(wc -l <err)" = 1 ] || failed "more than a sentence: $(cat err)"
    exit $status
) || status=1

command -v xdotool >/dev/null || {
    echo "xdotool is not there: no keys through the X server"
    finish
}

# until_it COMMAND: repeats it until it succeeds.
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

# Keys are pressed until they have an effect: work after the first image arrives in order, at some time.
last_has() {
    xdotool key question
    sleep 0.2
    tail -n 1 shown | grep -q -- "$1"
}

"$program" view triangle.gltf $size >shown 2>err &
viewer=$!
until_it 'xdotool search --onlyvisible --name "^triangle.gltf - facet" >/dev/null 2>&1'
xdotool mousemove 80 60
until_it 'last_has "^facet render"'
xdotool mousedown 1 mousemove 90 64 mousemove 100 66 mouseup 1 key plus key --delay 50 shift+t
until_it 'last_has "--tone-mapping"'
tail -n 1 shown >last
grep -q -- '--exposure 0.33' last || failed "a key did nothing: $(cat last)"
grep -q -- '--orbit 0,' last && failed "the pointer turned nothing: $(cat last)"

# idling takes no CPU time: hundredths of a second in one second, once messages have faded
ticks() {
    sed 's/.*) //' /proc/$viewer/stat | awk '{print $12 + $13}'
}
rests() {
    before=$(ticks)
    sleep 1
    after=$(ticks)
    [ $((after - before)) -le 2 ]
}
if [ -r /proc/$viewer/stat ]; then
    tries=0
    until rests; do
        tries=$((tries + 1))
        [ $tries -lt 20 ] || {
            failed "it took $((after - before)) hundredths of an idle second"
            break
        }
    done
fi

xdotool key q
code=0
wait $viewer || code=$?
[ $code = 0 ] || failed "exit code $code at the end: $(cat err)"

# Holding the border of a divider does not stop path tracing: the printed command has the current number of samples, which
# increases, while without any it would have the requested number.
"$program" view triangle.gltf $size --renderer path --samples 16000000 >shown 2>err &
viewer=$!
until_it 'xdotool search --onlyvisible --name "^triangle.gltf - facet" >/dev/null 2>&1'
xdotool mousemove 80 60
until_it 'last_has "^facet render"'
xdotool key Tab
samples() {
    xdotool key question
    sleep 0.3
    tail -n 1 shown | sed -n 's/.*--samples \([0-9]*\).*/\1/p'
}
until_it 'before=$(samples) && [ "${before:-16000000}" -lt 16000000 ]'
xdotool mousemove 80 60 mousedown 1 mousemove 84 60 mousemove 90 62
sleep 0.5
held=$(samples)
[ "${held:-16000000}" -lt 16000000 ] && [ "$held" -gt "$before" ] ||
    failed "holding the border stops path tracing: $before, then $held samples"
xdotool mouseup 1 key q
code=0
wait $viewer || code=$?
[ $code = 0 ] || failed "exit code $code at the end: $(cat err)"

finish
