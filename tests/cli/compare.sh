#!/bin/sh
# compare.sh - comparison of images: metrics, limits with their exit codes, difference images, and errors of inputs.
set -eu
. "$(dirname "$0")/lib.sh"

# ppm of 2 x 2 would do, but facet reads none: PFM with floats of which the bytes are known. pfm NAME WORD...: 16 words.
# Words: o 0, h 0.5, l 1, n not a number, i infinity.
pfm() {
    name=$1
    shift
    printf 'PF\n4 4\n-1.0\n' >"$name"
    for word in "$@"; do
        case $word in
        o) bytes='\000\000\000\000' ;;
        h) bytes='\000\000\000\077' ;;
        l) bytes='\000\000\200\077' ;;
        n) bytes='\000\000\300\177' ;;
        i) bytes='\000\000\200\177' ;;
        esac
        printf "$bytes$bytes$bytes" >>"$name"
    done
}
# value MEMBER: a number of the JSON in ./out
value() {
    tr ',{}' '\n\n\n' <out | sed -n "s/^ *\"$1\": *//p" | head -1
}
# is MEMBER VALUE: the member starts with VALUE
is() {
    case $(value "$1") in
    "$2"*) ;;
    *) failed "$1 is $(value "$1"), not $2" ;;
    esac
}
valid_json() {
    command -v python3 >/dev/null || return 0
    python3 -c 'import json, sys; json.load(sys.stdin)' <out 2>err || failed "the JSON is not valid"
}

pfm half.pfm h h h h h h h h h h h h h h h h
pfm ones.pfm l l l l l l l l l l l l l l l l
pfm spot.pfm h h h h h h h h h h h h h h l h
pfm nan.pfm h h h h n h h h h h h h h h h h
pfm inf.pfm h h h h i h h h h h h h h h h h

# ---- numbers ----
expect 0 compare half.pfm half.pfm
grep -q 'as light, equal' out || failed "equal images are not called equal"
grep -qE '^  psnr +inf ' out || failed "psnr of equal images is not inf"
expect 0 compare half.pfm ones.pfm
grep -qE '^  rmse +0\.5 ' out || failed "rmse is not 0.5"
grep -q '^psnr and ssim: for a peak of 0.5$' out || failed "the peak is not reported"
grep -q '^flip: the largest of 2 exposures from +2.08 to +2.08 stops$' out || failed "exposures are not reported: $(cat out)"
grep -q 'different' out || failed "different images are not called so"
expect 0 compare half.pfm ones.pfm --metric mse,max
[ "$(tr -s ' ' <out | tr '\n' '|')" = "mse 0.25|max 0.5|" ] || failed "--metric mse,max prints $(cat out)"
expect 0 compare half.pfm spot.pfm --json --percentile 90
valid_json
is mse 0.015625
is mae 0.03125
is bias 0.03125
is max 0.5
is p50 0.0
is p95 0.5
is percentile 0.0
is differing 1
is differing-share 0.0625
is nrmse 0.25
is psnr 12.04
is ssim null
is equal false
is space '"linear"'
is passed null
grep -q '"max_at": \[2, 0\]' out || failed "the largest error is not found: $(cat out)"
expect 0 compare half.pfm ones.pfm --json --peak 1
is psnr 6.02
expect 0 compare half.pfm ones.pfm --json --space display
is bias 0.264
expect 0 compare half.pfm ones.pfm --json --epsilon 1
is mse-relative 0.2
expect 0 compare half.pfm ones.pfm --json --exposure 2x
is mse 1.0
expect 0 compare half.pfm spot.pfm --json --threshold 0.5
is differing 0
expect 0 compare half.pfm spot.pfm --json --crop 0,1,4,3
is equal true
expect 0 compare half.pfm ones.pfm --json
one=$(value flip)
expect 0 compare half.pfm ones.pfm --json -j 3
[ "$(value flip)" = "$one" ] || failed "FLIP depends on the threads"
cat half.pfm >piped
"$facet" compare - ones.pfm --metric max <piped >out 2>err || failed "standard input is not read"
grep -q '0.5' out || failed "standard input is another image"
rm piped

# ---- limits ----
expect 0 compare half.pfm ones.pfm --max max=0.5,mse=0.25
[ ! -s out ] && [ ! -s err ] || failed "limits that hold say something"
expect 1 compare half.pfm ones.pfm --max max=0.4
says "ones.pfm: max 0.5 is more than 0.4 (reference half.pfm)"
[ "$(wc -l <err)" = 1 ] || failed "more than one line on a limit"
expect 1 compare half.pfm ones.pfm --metric rmse --max 0.1 --min psnr=90
says "psnr 0 is less than 90, rmse 0.5 is more than 0.1"
grep -q '^rmse  0.5' out || failed "--metric with --max prints no number"
expect 1 compare ones.pfm half.pfm --max bias=0.4
expect 0 compare ones.pfm half.pfm --max bias=0.5
expect 0 compare half.pfm half.pfm --min psnr=100 -q
expect 1 compare half.pfm ones.pfm --max flip=0.01 --json
valid_json
is passed false
is holds false
is exit_code 1
expect 0 compare half.pfm half.pfm --max flip=0,differing=0 --json
is passed true
expect 1 compare half.pfm half.pfm --min ssim=0.5
says "ssim cannot be measured"
expect 2 compare half.pfm ones.pfm --max 0.1
says "the limit 0.1 names no metric"
expect 2 compare half.pfm ones.pfm --max psnr=40
says "write --min psnr=40"
expect 2 compare half.pfm ones.pfm --min flip=0.1
says "write --max flip=0.1"
expect 2 compare half.pfm ones.pfm --max flop=1
says 'there is no metric "flop"'
expect 2 compare half.pfm ones.pfm --max flip=much
says '"much" is not a number'
expect 2 compare half.pfm ones.pfm --metric flib
says "did you mean flip?"
expect 2 compare half.pfm ones.pfm --metric percentile
says "needs --percentile"

# ---- NaN and infinity ----
expect 0 compare half.pfm nan.pfm --json
grep -q '"nonfinite": {"a": 0, "b": 1, "invalid": 1}' out || failed "what is not finite is not counted: $(cat out)"
is max null
is differing 1
is mse 0.0
valid_json
expect 0 compare half.pfm nan.pfm
says "nan.pfm: 1 pixel is not finite"
expect 1 compare half.pfm nan.pfm --strict
expect 1 compare half.pfm nan.pfm --max mse=1 -q
says "1 pixel is not finite in one image"
expect 0 compare inf.pfm inf.pfm --max max=0 -q
expect 1 compare inf.pfm nan.pfm --max max=9 -q

# ---- opacity, masks ----
expect 0 render $small -o a.png --background transparent
expect 0 render $small -o b.png
expect 0 compare a.png b.png --json
is channels 4
expect 0 compare a.png b.png --json --background white
is channels 3
is differing-share 0.0
expect 0 compare a.png b.png --json --background black --alpha background
[ "$(value differing)" -gt 100 ] || failed "--background black does not tell transparent from white"
expect 2 compare a.png b.png --alpha background
expect 2 compare a.png b.png --background white --alpha ignore
expect 2 compare a.png b.png --background nocolor
expect 0 compare a.png b.png --json --alpha ignore
is channels 3
pfm mask.pfm l l l l l l l l l l l l l l o l
expect 0 compare half.pfm spot.pfm --mask mask.pfm --json
is equal true
is pixels 15
pfm none.pfm o o o o o o o o o o o o o o o o
expect 2 compare half.pfm spot.pfm --mask none.pfm
says "the mask leaves no pixel"
expect 4 compare half.pfm spot.pfm --mask a.png
says "a.png: 48 x 32 pixels, but half.pfm has 4 x 4"

# ---- light and displays ----
expect 0 render $small -o light.exr --background transparent
expect 0 compare light.exr a.png --tone-mapping neutral --max max=0.004,flip=0.01
says "it is scene-linear, and a.png is for displays"
expect 1 compare light.exr a.png --tone-mapping agx --max flip=0.01
expect 0 compare light.exr a.png --space display --max differing=0 --threshold 1
[ ! -s err ] || failed "--space display is asked for, and still explained"
expect 2 compare light.pfm light.pfm --space linear --tone-mapping agx

# ---- layers ----
expect 0 render $small -o layers.exr --aov depth,normal,uv,albedo
expect 0 render $small -o bright.exr --aov depth,normal,uv,albedo --exposure 1
expect 0 render $small -o turned.exr --aov depth,normal,uv,albedo --orbit 60
expect 1 compare layers.exr bright.exr --max max=0
for layer in depth normal uv albedo Z normal.X albedo.R; do
    expect 0 compare layers.exr bright.exr --layer $layer --max max=0,flip=0 # depth: infinity in both
    expect 1 compare layers.exr turned.exr --layer $layer --max mae=0.001
done
expect 4 compare layers.exr bright.exr --layer albodo
says 'there is no layer "albodo"; it has A, B, G, R, Z, albedo, normal, uv'
expect 4 compare a.png a.png --layer albedo
says "a.png: only OpenEXR files have layers"

# ---- difference images ----
expect 0 compare half.pfm spot.pfm -o d.pfm -q
expect 0 compare none.pfm d.pfm --json
is max 0.5
is differing 1
expect 0 compare half.pfm spot.pfm -o d.pfm --gain 2 -q
expect 0 compare none.pfm d.pfm --metric max
grep -q '  1$' out || failed "--gain 2 does not double: $(cat out)"
for format in png jpg webp exr hdr pfm; do
    expect 0 compare b.png a.png -o "d.$format" --heat-map -q
    [ -s "d.$format" ] || failed "there is no d.$format"
done
is_type d.png "PNG image data, 48 x 32"
expect 0 compare b.png a.png -o d.png --sheet -q
is_type d.png "PNG image data, 144 x 32"
expect 0 compare b.png a.png -o - --format png --metric flip
cp out piped.png
is_type piped.png "PNG image data, 48 x 32"
grep -q '^flip' err || failed "numbers beside an image on standard output do not go to standard error"
cp d.png saved.png
expect 0 compare b.png a.png -o d.png --no-clobber -q
cmp -s d.png saved.png || failed "--no-clobber replaced an image"
expect 2 compare b.png a.png -o d.gif
says "does not end in .png"
expect 2 compare b.png a.png -o -
says "needs --format"
expect 2 compare b.png a.png -o - --format png --json
expect 2 compare b.png a.png -o a.png
says "this input would be overwritten"
expect 2 compare b.png a.png --heat-map
says "it needs a difference image"
expect 6 compare b.png a.png -o /dev/null/d.png
rm -f d.* piped.png saved.png

# ---- inputs ----
expect 2 compare
says "which images?"
expect 2 compare a.png
says "compare: a.png with what?"
expect 2 compare a.png b.png c.png
expect 2 compare - -
says "standard input is one image"
expect 3 compare a.png missing.png
says "missing.png"
expect 3 compare a.png missing.png --json
valid_json
is exit_code 3
expect 4 compare a.png half.pfm
says "half.pfm: 4 x 4 pixels, but a.png has 48 x 32"
head -c 300 a.png >cut.png
expect 4 compare cut.png a.png
says "cut.png"
printf 'not an image' >text
expect 4 compare a.png text
says "text: first bytes"
: >empty
expect 4 compare empty a.png
expect 2 compare half.pfm ones.pfm --crop 0,0,5,1
says "crop"
expect 2 compare half.pfm ones.pfm --pixels-per-degree 0
expect 7 compare a.png b.png --max-texture 40
expect 7 compare a.png b.png --max-memory 20K
says "--max-memory"
[ "$(grep -o 'max-memory' err | wc -l)" = 1 ] || failed "the limit is reported twice"
finish
