#!/bin/sh
# path.sh - path tracing from the command line: samples, limits, checkpoints, the same bytes.
set -eu
. "$(dirname "$0")/lib.sh"

path="render --renderer path --size 48x32 --samples 8"

# The same bytes for any number of threads; another seed gives another image.
for options in "" "--filter mitchell --ground shadow --background transparent" "--aperture 4% --sun 30,40" \
    "--noise 0.05 --samples 64 --format exr32 --aov all"; do
    is_quick && [ -n "$options" ] && [ "$options" != "--aperture 4% --sun 30,40" ] && continue
    for threads in 1 2 5; do
        expect 0 $path $options -j $threads -o image.$threads --format png $options
    done
    for other in 2 5; do
        cmp -s image.1 image.$other || failed "-j $other differs from -j 1: $options"
    done
done
expect 0 $path -o a.png
expect 0 $path --seed 0 -o b.png
expect 0 $path --seed 1 -o c.png
cmp -s a.png b.png || failed "seed 0 is not the default"
cmp -s a.png c.png && failed "another seed gives the same noise"

# Options of one renderer are refused by the other.
expect 2 render --noise 0.1 -o x.png
says "it needs --renderer path"
expect 2 render --renderer path --specular-aa -o x.png
says "it needs --renderer preview or gl"
expect 2 render --aov variance -o x.exr
expect 2 render --renderer path --sun 30 -o x.png
says "AZIMUTH,ELEVATION"
expect 2 render --renderer path --sun 30,100 -o x.png
expect 2 render --renderer path --aperture -1 -o x.png
expect 2 render --renderer path --aperture 1% --focus 0 -o x.png
expect 2 render --renderer path --focus 2 -o x.png
says "--aperture"
expect 2 render --renderer path --shutter 1m -o x.png
expect 0 $path --samples 1 --aperture 0.1 --focus 1e-30 -o blurred.png
expect 2 render --renderer path --resume -o x.png
says "--checkpoint FILE"
expect 2 render --renderer path --checkpoint state.png -o x.png
expect 2 render --renderer path --checkpoint x.exr -o x.exr
expect 2 render --renderer path --checkpoint x.exr --turntable 3 -o 'x_##.png'
expect 2 render --renderer path --ground shadow --up z -o x.png
[ ! -e x.png ] || failed "x.png is there"

# The time limit writes the samples so far, with a message.
expect 0 render --renderer path --size 64 --samples 10000000 --time-limit 2s -o late.png
says "the time limit was reached after"
expect 0 render --renderer path --size 64 --samples 10000000 --time-limit 2s --json -o late.png
grep -q '"partial": true' out || failed "JSON does not say that it is partial"
grep -q '"samples_taken": [1-9]' out || failed "JSON does not say how many samples were taken"
grep -q '"warnings": .*the image is partial: the time limit was reached after' out || failed "JSON does not warn"
expect 1 render --renderer path --size 64 --samples 10000000 --time-limit 1s --strict -o late.png
expect 7 render --renderer path --size 8192 --time-limit 300ms -o never.png
says "the time limit"
[ ! -e never.png ] || failed "an image without a sample for each pixel was written"
# Images of a sequence share the time, and so do those of a sea.
for words in "render --turntable 3" "ocean --frames 1-3"; do
    for limit in 3s 30s; do # a busy machine under a sanitizer needs more than 3 s before the first sample
        "$facet" $words --renderer path --size 24 --samples 10000000 --time-limit $limit --json -o 'frame_##.png' >out 2>err && break
    done
    [ "$(grep -o '"partial": true' out | wc -l)" = 3 ] || failed "not all of three images are partial: $words"
    [ "$(grep -o '"text": "frame_0[123].png: the image is partial' out | wc -l)" = 3 ] || failed "warnings: $words"
    for i in 1 2 3; do is_type frame_0$i.png "PNG image data, 24 x 24"; done
    rm -f frame_*.png
done

# interrupt SIGNAL SECONDS ARGUMENTS...: sends the signal so long after sampling has begun; sets code.
interrupt() {
    signal=$1
    seconds=$2
    shift 2
    rm -f cut*.png
    : >err # the shell may look for a sample before the command has emptied it
    "$facet" "$@" --renderer path --size 24 --samples 16000000 --json --progress plain >out 2>err &
    process=$!
    waited=0
    until grep -q '% sample' err || [ $waited = 300 ]; do
        sleep 0.2
        waited=$((waited + 1))
    done
    sleep "$seconds"
    kill -"$signal" $process
    code=0
    wait $process || code=$?
}

# An interrupted image is written, too: exit code 75 after SIGTERM, the signal's own after others. A busy machine may
# need more time until every pixel has a sample; before that there is no image.
cut_off() {
    signal=$1
    wanted=$2
    shift 2
    for seconds in 1 5 25; do
        interrupt "$signal" $seconds "$@"
        grep -q 'interrupted before every pixel had a sample' err || break
    done
    [ $code = "$wanted" ] || failed "exit code $code, not $wanted, after SIG$signal: facet $*"
    grep -q '"partial": true' out || failed "JSON does not say that it is partial: facet $*"
    grep -q "\"exit_code\": $wanted}" out || failed "JSON says another exit code: facet $*"
    says "the image is partial: interrupted after"
}
cut_off TERM 75 render -o cut.png
is_type cut.png "PNG image data, 24 x 24"
cut_off HUP 129 render -o cut.png
is_type cut.png "PNG image data, 24 x 24"
cut_off TERM 75 render --turntable 3 -o 'cut_##.png'
is_type cut_01.png "PNG image data, 24 x 24"
[ ! -e cut_02.png ] || failed "images after the one that was cut off"
cut_off TERM 75 ocean -o cut.png
is_type cut.png "PNG image data, 24 x 24"

# A resumed render equals an uninterrupted one; more samples; another image.
if "$facet" version -v | grep -q 'OpenEXR [0-9]'; then
    expect 0 $path --format exr32 -o whole.exr
    expect 0 render --renderer path --size 48x32 --samples 3 --checkpoint state.exr -o part.exr
    expect 0 $path --format exr32 --checkpoint state.exr --resume -o resumed.exr
    cmp -s whole.exr resumed.exr || failed "a resumed image differs"
    cp state.exr before.exr
    expect 0 $path --format exr32 --checkpoint state.exr --resume -o again.exr
    cmp -s whole.exr again.exr || failed "an image that is done differs"
    expect 2 $path --seed 5 --checkpoint state.exr --resume -o other.exr
    says "state.exr"
    [ ! -e other.exr ] || failed "other.exr is there"
    cmp -s state.exr before.exr || failed "the checkpoint of another image was changed"
    head -c 700 state.exr >cut.exr
    expect 4 $path --checkpoint cut.exr --resume -o other.exr
    says "cut.exr"
    expect 6 $path --checkpoint /proc/no/such/folder/state.exr -o other.exr
    expect 0 $path --checkpoint new/folder/state.exr -o new/images/a.png
    is_type new/images/a.png "PNG image data"
    [ -s new/folder/state.exr ] || failed "no checkpoint in a new folder"
    expect 0 $path --checkpoint new.exr --resume -o first.exr
    expect 2 $path --checkpoint new.exr -o first.exr
    says "new.exr: the checkpoint exists"
    cp first.exr light.exr
    expect 2 $path --env light.exr --checkpoint ./light.exr --resume -o other.exr
    expect 2 $path --checkpoint ./first.exr --resume -o first.exr
    if command -v mkfifo >/dev/null; then
        mkfifo pipe.exr
        expect 6 $path --checkpoint pipe.exr --resume -o other.exr
        says "pipe.exr"
    fi
    if ! is_quick; then
        noisy="render --renderer path --size 48x32 --noise 0.02 --format exr32"
        expect 0 $noisy --samples 128 -o whole_noise.exr
        expect 0 $noisy --samples 64 --checkpoint noise.exr -o part.exr
        expect 0 $noisy --samples 128 --checkpoint noise.exr --resume -o resumed_noise.exr
        cmp -s whole_noise.exr resumed_noise.exr || failed "a resumed adaptive image differs"
        # A pass that a shorter image ended in, and what was judged there.
        expect 0 $noisy --samples 200 -o whole_noise.exr
        expect 0 $noisy --samples 70 --checkpoint cut_pass.exr -o part.exr
        expect 0 $noisy --samples 200 --checkpoint cut_pass.exr --resume -o resumed_noise.exr
        cmp -s whole_noise.exr resumed_noise.exr || failed "an adaptive image that a pass was cut off of differs"
    fi

    # Samples before an interruption are kept.
    "$facet" render --renderer path --size 48x32 --samples 10000000 --checkpoint cut_off.exr -o cut_off.png 2>err &
    sleep 1
    kill -TERM $!
    code=0
    wait $! || code=$?
    [ $code = 75 ] || failed "exit code $code after SIGTERM, not 75"
    is_type cut_off.png "PNG image data, 48 x 32"
    says "; --resume continues cut_off.exr"
    rm -f cut_off.png
    expect 0 render --renderer path --size 48x32 --samples 1 --checkpoint cut_off.exr --resume -o cut_off.png
    is_type cut_off.png "PNG image data, 48 x 32"
fi
finish
