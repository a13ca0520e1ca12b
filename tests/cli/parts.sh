#!/bin/sh
# parts.sh - images in parts: facet merge makes the bytes of the whole image, refuses parts of other images, and says how
# to make what is missing.
set -eu
. "$(dirname "$0")/lib.sh"

# parts COUNT EXTENSION WORD..: the image of `facet WORD..` equals that of its parts, rendered with other numbers of threads.
# $by: what they divide.
by=tiles
parts() {
    count=$1 extension=$2
    shift 2
    rm -f part_*.exr
    expect 0 "$@" -o whole.$extension
    i=0
    while [ $i -lt $count ]; do
        expect 0 "$@" -o 'part_{shard}.exr' --shard $i/$count --shard-by $by -j $((1 + i % 3))
        i=$((i + 1))
    done
    expect 0 merge $(ls -r part_*.exr) -o merged.$extension
    cmp -s whole.$extension merged.$extension || failed "$count parts by $by differ from the whole image: $*"
}

# ---- tiles ----

for count in 1 2 3 7; do
    parts $count png render --size 61x47
done
parts 3 exr render --size 64x48 --aov all --exposure auto+1 --crop 3,5,50,40
parts 2 jpg render --size 48x32 --background '#8af' --tone-mapping agx
parts 2 exr render --size 48x32 --tone-mapping aces --env-rotation 30
parts 3 webp render --size 48x64 --background transparent --energy conserving
parts 7 png render --size 64x48 --renderer path --samples 8 --denoise --ground shadow --filter mitchell
parts 3 exr render --size 48x48 --renderer path --samples 6 --aov all --denoise --exposure auto --crop 5,5,40,33
parts 2 png render --size 48x32 --renderer path --samples 4 --background env --aperture 0.02 --shutter 0.5
if "$facet" ocean --info >/dev/null 2>&1; then
    parts 3 png ocean --size 64x48 --time 2
    parts 2 exr ocean --size 40x32 --renderer path --samples 2 --aov all
    parts 2 png ocean --size 40x32 --env constant:0.5 --sun 30,40,3
fi

# ---- samples ----

by=samples
for count in 1 2 3 7; do
    parts $count png render --size 33x21 --renderer path --samples 7
done
parts 3 exr render --size 40x32 --renderer path --samples 10 --aov variance,samples,albedo,depth --ground shadow --denoise
parts 2 png render --size 40x32 --renderer path --samples 9 --shutter 0.5 --filter mitchell --exposure auto
if "$facet" ocean --info >/dev/null 2>&1; then
    parts 2 exr ocean --size 32x24 --renderer path --samples 3
fi
expect 0 render --size 33x21 --renderer path --samples 7 -o tile_1.exr --shard 1/6
expect 0 render --size 33x21 --renderer path --samples 7 -o part_1.exr --shard 1/7 --shard-by samples
expect 2 merge part_1.exr tile_1.exr -o merged.png
says "tile_1.exr: it is a tile, and part_1.exr a range of samples"
expect 2 render --size 32 -o part_1.exr --shard 1/2 --shard-by samples
says "--shard-by: samples need --renderer path"
expect 2 render --size 32 --renderer path --samples 4 -o part_1.exr --shard 1/5 --shard-by samples
says "an image of 4 samples per pixel has at most that many parts, not 5"
expect 2 render --size 32 --renderer path --aov cryptomatte -o part_1.exr --shard 1/2 --shard-by samples
says "the ranks of Cryptomatte depend on all samples of a pixel"

# ---- what is missing ----

size="--size 64x48 --renderer path --samples 4"
expect 0 render $size -o whole.png
expect 0 render $size -o 'a part_2.exr' --shard 2/4 -j 1 -q
expect 1 merge a*.exr -o merged.png
says "merged.png: 3 of 4 parts are missing (0, 1, 3)"
[ "$(wc -l <out)" = 3 ] || failed "$(wc -l <out) commands for 3 parts"
mkdir bin
ln -s "$facet" bin/facet
PATH="$PWD/bin:$PATH" sh -e out 2>err || failed "the commands for missing parts fail"
expect 0 merge a*.exr -o merged.png
cmp -s whole.png merged.png || failed "parts by the printed commands differ from the whole image"
expect 1 merge 'a part_1.exr' --json -o merged.png
grep -qF '"missing": [{"part": 0, "command": "facet render --size 64x48' out || failed "--json lacks what is missing"
grep -qF -- "-o 'a part_3.exr' --shard 3/4" out || failed "--json lacks the command of part 3"

# ---- what is refused ----

cp 'a part_1.exr' twice.exr
expect 0 merge twice.exr a*.exr -o merged.png -v
says "it is the same part as"
cmp -s whole.png merged.png || failed "a part that is there twice changes the image"
expect 0 render $size --seed 5 -o other_1.exr --shard 1/4
expect 2 merge a*.exr other_1.exr -o merged.png
says "other_1.exr: it is part of another image than a part_0.exr"
expect 0 render $size -o five_1.exr --shard 1/5
expect 2 merge a*.exr five_1.exr -o merged.png
says "five_1.exr: it is one of 5 parts, and a part_0.exr one of 4"
if "$facet" render $size --isa avx2 -o isa_1.exr --shard 1/4 2>err; then
    expect 2 merge a*.exr isa_1.exr -o merged.png
    says "isa_1.exr: it was rendered with another instruction set (--isa) than a part_0.exr: avx2, not portable"
fi
expect 0 render --size 8 -o image.exr
expect 4 merge a*.exr image.exr -o merged.png
says "image.exr: is an OpenEXR image, but not a part of one"
expect 4 merge a*.exr whole.png -o merged.png
says "whole.png: not a part of an image: an OpenEXR file was expected"
expect 3 merge a*.exr none.exr -o merged.png
expect 3 merge a*.exr /dev/zero -o merged.png
says "/dev/zero: it is a pipe or a device; the file of a part was expected"
expect 2 merge a*.exr -o 'a part_0.exr'
says "this part would be overwritten"
expect 2 merge -o merged.png
expect 2 merge a*.exr
expect 2 merge a*.exr -o merged.y4m
for bytes in 0 8 300 1500 20000; do # cut off
    mkdir -p cut
    cp a*.exr cut
    head -c $bytes 'a part_3.exr' >'cut/a part_3.exr'
    expect 4 merge cut/*.exr -o merged.png
done
printf 'x' | dd of='cut/a part_3.exr' bs=1 seek=15000 conv=notrunc 2>/dev/null
cp 'a part_3.exr' cut
printf 'x' | dd of='cut/a part_3.exr' bs=1 seek=15000 conv=notrunc 2>/dev/null
expect 4 merge cut/*.exr -o merged.png
says "a part_3.exr: the part is damaged: its values differ from those that were written"

# ---- what cannot be divided ----

expect 2 render --size 64 -o part.exr --shard 1/4
says '"part.exr" is one name for all parts; put {shard} in it'
expect 2 render --size 64 -o part_1.png --shard 1/4
says "a part of an image is an .exr file"
expect 2 render $size --noise 0.1 -o part_1.exr --shard 1/4
says "--noise: which pixels get more samples depends on pixels of other parts"
expect 2 render --renderer gl -o part_1.exr --shard 1/4
says "--renderer gl is divided by frames only"
expect 2 render --size 32 -o part_1.exr --shard 1/5
says "an image of 32 x 32 pixels has at most 4 parts"
expect 2 render --shard-by tiles -o part_1.exr
expect 2 render --shard-by frames --shard 1/4 -o part_1.png
expect 7 render --size 512 --renderer path --samples 4096 --time-limit 1s -o late_1.exr --shard 1/4
[ ! -e late_1.exr ] || failed "a part with less than all of its samples was written"

# ---- frames ----

expect 0 render $small -o 'whole_##.png' --turntable 7
for i in 2 0 1; do
    expect 0 render $small -o 'frame_##.png' --turntable 7 --shard $i/3
done
for i in 1 2 3 4 5 6 7; do
    cmp -s whole_0$i.png frame_0$i.png || failed "frame $i of a turntable differs"
done
rm whole_*.png frame_*.png
expect 0 render $small -o 'whole_##.exr' --turntable 3 --exposure auto --frames 2-3
for i in 0 1; do
    expect 0 render $small -o 'frame_##.exr' --turntable 3 --exposure auto --frames 2-3 --shard $i/2
done
for i in 2 3; do
    cmp -s whole_0$i.exr frame_0$i.exr || failed "frame $i of a metered turntable differs"
done
expect 2 render $small -o turn.y4m --turntable 7 --shard 0/3
says "a video has all frames in one file"
finish
