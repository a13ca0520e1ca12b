#!/bin/sh
# interrupt.sh - commands interrupted at every stage of their work leave neither partial nor temporary files.
set -eu
. "$(dirname "$0")/lib.sh"
write_triangle tri.gltf
"$facet" render $small tri.gltf -o a.png -q
"$facet" render $small tri.gltf -o b.png -q --exposure 1
tries=40
is_quick && tries=10

# run_milliseconds WORD...: the time of facet WORD...
run_milliseconds() {
    began=$(date +%s%N)
    "$facet" "$@" >out 2>err
    ended=$(date +%s%N)
    echo $(((ended - began) / 1000000 + 1))
}

# interrupt OUTPUT WORD...: interrupts facet WORD... repeatedly, at moments spread over its run. The output is complete
# or absent. Exit code 143 is a signal before the first line of main().
interrupt() {
    output=$1
    shift
    length=$(run_milliseconds "$@")
    cp "$output" whole
    for try in $(seq 1 $tries); do
        rm -f "$output"
        signal=TERM
        [ $((try % 2)) = 0 ] || signal=HUP
        "$facet" "$@" >out 2>err &
        process=$!
        sleep "$(awk "BEGIN { print $length * $try / $tries / 1000 }")"
        kill -$signal $process 2>/dev/null || true
        code=0
        wait $process 2>/dev/null || code=$?
        case $code in 0 | 75 | 129 | 143) ;; *) failed "exit code $code after SIG$signal: facet $*" ;; esac
        [ ! -e "$output" ] || cmp -s "$output" whole || failed "a part of $output: facet $*"
        left=$(ls -A | grep -vx -e out -e err -e whole -e "$output" -e tri.gltf -e a.png -e b.png || true)
        [ -z "$left" ] || { failed "interrupted, it leaves $left: facet $*"; return; }
    done
    rm -f "$output" whole
}
interrupt p.csv plot brdf roughness=0.3 -o p.csv
interrupt p.png plot brdf roughness=0.3 -o p.png
interrupt c.glb convert tri.gltf c.glb
interrupt d.png compare a.png b.png -o d.png
interrupt n.ktx2 bake white --lobe none --size 64 -o n.ktx2
interrupt r.png render $small tri.gltf -o r.png
interrupt v.y4m render $small tri.gltf --turntable 3 -o v.y4m
interrupt s.glsl shaders -o s.glsl
finish
