#!/bin/sh
# bake.sh - baked environments: files and their names, conventions of engines, errors, and that a failure leaves no file.
set -eu
. "$(dirname "$0")/lib.sh"
tiny="--size 16 --mips 2"

# pfm NAME SIZE WORD...: SIZE^2 words, rows from the bottom, as PFM has them. Words: k black, w white, r g b y c m colors, n not
# a number, - less than 0.
pfm() {
    name=$1
    printf 'PF\n%s %s\n-1.0\n' "$2" "$2" >"$name"
    shift 2
    o='\000\000\000\000' l='\000\000\200\077' x='\000\000\300\177' s='\000\000\200\277'
    for word in "$@"; do
        case $word in
        k) printf "$o$o$o" ;; w) printf "$l$l$l" ;; r) printf "$l$o$o" ;; g) printf "$o$l$o" ;;
        b) printf "$o$o$l" ;; y) printf "$l$l$o" ;; c) printf "$o$l$l" ;; m) printf "$l$o$l" ;;
        n) printf "$x$x$x" ;; -) printf "$s$s$s" ;;
        esac
    done >>"$name"
}
# same A B LIMIT: the largest difference between two images is at most LIMIT.
same() {
    "$facet" compare "$1" "$2" --metric max --max "max=$3" >cmp 2>&1 || failed "$1 is not $2: $(cat cmp)"
    rm -f cmp
}
# bytes FILE OFFSET COUNT: in hexadecimal
bytes() {
    od -An -tx1 -j "$2" -N "$3" "$1" | tr -d ' \n'
}
# vk FILE FORMAT: the number of its texels' format in Vulkan
vk() {
    found=$(od -An -tu4 -j 12 -N 4 "$1" | tr -d ' ')
    [ "$(bytes "$1" 0 6)" = "ab4b54582032" ] || failed "$1 is no KTX2 file"
    [ "$found" = "$2" ] || failed "$1 has texels $found, not $2"
}
u32() {
    od -An -tu4 -j "$2" -N 4 "$1" | tr -d ' '
}
clean() {
    rm -rf ./*
}

# ---- impossible options ----
expect 2 bake
says "which environment?"
expect 2 bake a.hdr b.hdr
says "six faces"
expect 2 bake a b c d e f g
for words in "--size 3" "--size 0" "--size 100000" "--size nan" "--size 16x16" "--mips 0" "--mips 15" "--size 16 --mips 6" \
    "--samples 0" "--samples nan" "--clamp nan" "--clamp -1" "--exposure bright" "--rotation north" "--zstd 20" \
    "--level 5" "--level -1" "--max-error nan" "--rgbm 0" "--max-memory lots" "--time-limit 0" "--format bmp" \
    "--format rg16f" "--format h" "--lobe phong" "--layout unity" "--distribution ggx" "--tone-mapping agx" \
    "--reference --samples 9" "--reference --method sampling" "--dfg"; do
    expect 2 bake white $words -o x.ktx2
    [ "$(wc -l <err)" = 1 ] || failed "more than one line on $words"
done
expect 2 bake white --size 48
says '--size: "48" is not a power of two from 1 to 8192'
expect 2 bake white --size 16 --mips 6
says "a cube map of 16 texels has at most 5 levels, not 6"
for words in "-o x.bmp" "-o x" "-o x.png" "-o x.ktx" "-o x.json" "--sh x.png" "--preview x.exr" "--diffuse x.json" \
    "-o x.exr --format rgb9e5" "-o x.hdr --projection equirect -o {face}.hdr" "-o -" "-o - --format ktx2 --json" \
    "-o - --format exr" "--sh -" "-o a/ --layout khronos --lobe charlie" "-o a/ --layout filament --mapping linear" \
    "-o x.ktx2 --level 1" "-o x.ktx2 --projection faces" "-o x.exr --rgbm 9" "-o x.exr --zstd 1" "-o x.ktx2 --sh-window auto" \
    "--sheen x.ktx2 --lobe lambert" "-o a/ --layout three --format rgb9e5 --zstd 3" "-o a/ --layout filament --format rgba16f"; do
    expect 2 bake white $words
done
expect 2 bake --dfg --size 8
expect 2 bake --dfg -o t.hdr
expect 2 bake --dfg --sh sh.json
expect 2 bake white -o sun:hot.ktx2 sun:hot
for words in "-inputPath a.hdr" "-outCubeMap a.ktx2" "--deploy=x" "--dstFaceSize 64" "-sampleCount 9" "--env-rotation 90"; do
    expect 2 bake $words
    says "did you mean"
done
expect 2 bake -inputPath a.hdr
says "the environment is given without an option"
only

# ---- invalid inputs ----
expect 3 bake missing.hdr -o x.ktx2
says "missing.hdr: "
mkdir folder.hdr
expect 3 bake folder.hdr -o x.ktx2
echo "no image" >bad.hdr
expect 4 bake bad.hdr -o x.ktx2
pfm square.pfm 3 w w w w w w w w w
expect 1 bake square.pfm -o x.ktx2 --input-layout equirect $tiny --strict
says "square.pfm: 3 x 3 texels"
rm x.ktx2
expect 3 bake square.pfm square.pfm square.pfm square.pfm square.pfm missing.pfm -o x.ktx2
pfm two.pfm 2 w w w w
expect 4 bake square.pfm square.pfm square.pfm square.pfm square.pfm two.pfm -o x.ktx2
only folder.hdr bad.hdr square.pfm two.pfm
clean

# ---- names ----
expect 0 bake neutral $tiny
says "studio.ktx2: ggx, 16 x 16 texels, 2 levels, rgba16f"
expect 0 bake sun:40,135 $tiny
expect 0 bake white $tiny -o w.ktx2
[ ! -s err ] || failed "a named output is reported"
expect 0 bake white $tiny -o '{stem}.hdr'
expect 0 bake white $tiny -o '{face}{level}.hdr' --lobe none
expect 0 bake white $tiny --level 1 -o one.exr
expect 0 bake white $tiny --sh only.json
expect 0 bake --dfg --size 16
only studio.ktx2 sky.ktx2 w.ktx2 constant_m0.hdr constant_m1.hdr one.exr only.json dfg.ktx2 \
    px0.hdr nx0.hdr py0.hdr ny0.hdr pz0.hdr nz0.hdr px1.hdr nx1.hdr py1.hdr ny1.hdr pz1.hdr nz1.hdr
clean
expect 0 bake white $tiny -o x.ktx2 --diffuse d.exr --sheen s.ktx2 --sh sh.h
only x.ktx2 d.exr s.ktx2 sh.h
cp x.ktx2 before
expect 0 bake neutral $tiny -o x.ktx2 --sh new.txt --no-clobber
says "x.ktx2: kept, since it exists"
cmp -s x.ktx2 before || failed "--no-clobber replaces"
[ -s new.txt ] || failed "--no-clobber leaves out what was not there"
expect 0 bake missing.hdr -o x.ktx2 --no-clobber
expect 2 bake white -o x.ktx2 --diffuse ./x.ktx2
says "two outputs have the name x.ktx2"
expect 2 bake x.ktx2 -o ./x.ktx2
says "this input would be overwritten"
expect 0 bake x.ktx2 $tiny -o again.ktx2
cmp -s x.ktx2 before || failed "an input was replaced"
clean

# ---- formats ----
for pair in "rgba16f 97" "rgb9e5 123" "b10g11r11 122" "rgba32f 109"; do
    expect 0 bake neutral $tiny -o x.ktx2 --format ${pair% *}
    vk x.ktx2 ${pair#* }
done
[ "$(u32 x.ktx2 20) $(u32 x.ktx2 36) $(u32 x.ktx2 40) $(u32 x.ktx2 44)" = "16 6 2 0" ] || failed "header of a cube map"
expect 0 bake neutral $tiny -o - --format rgba32f
cmp -s x.ktx2 out || failed "standard output has other bytes"
expect 0 bake neutral $tiny -o x.ktx2 --zstd 3
[ "$(u32 x.ktx2 44)" = 2 ] || failed "--zstd does not compress"
expect 0 bake neutral $tiny -o x.exr --format exr32
is_type x_m1.exr "OpenEXR"
expect 0 bake neutral $tiny -o x.png --rgbm 16 --projection cross-vertical
is_type x_m0.png "PNG image data, 48 x 64, 8-bit/color RGBA"
for projection in equirect cross-horizontal strip-horizontal strip-vertical octahedral; do
    expect 0 bake neutral --size 16 --mips 1 -o $projection.pfm --projection $projection
done
[ "$(sed -n 2p equirect.pfm | tr -d '\0') $(sed -n 2p cross-horizontal.pfm | tr -d '\0')" = "64 32 64 48" ] || failed "sizes of images"
[ "$(sed -n 2p strip-vertical.pfm | tr -d '\0') $(sed -n 2p octahedral.pfm | tr -d '\0')" = "16 96 32 32" ] || failed "sizes of strips"
clean

# ---- threads and streams ----
expect 0 bake neutral --size 32 -o one.ktx2 -j 1 --sh one.json
expect 0 bake neutral --size 32 -o three.ktx2 -j 3 --sh three.json
cmp -s one.ktx2 three.ktx2 || failed "the cube map depends on threads"
cmp -s one.json three.json || failed "harmonics depend on threads"
expect 0 bake neutral --size 16 --mips 1 --lobe none -o e.hdr
expect 0 bake e.hdr --size 16 --mips 1 -o f.hdr
"$facet" bake - --size 16 --mips 1 -o - --format hdr <e.hdr >out 2>err || failed "no stream"
cmp -s out f.hdr || failed "stdin to stdout differs from file to file"
expect 3 bake - -o x.ktx2 </dev/null
expect 0 bake neutral --size 16 -o x.ktx2 --progress plain
grep -q '100 %\|90 %\| %' err || failed "--progress plain says nothing"
expect 0 bake neutral --size 16 -o x.ktx2 --progress json
grep -q '"progress"' err || failed "--progress json says nothing"
echo '{"size": 16, "mips": 1, "lobe": "none", "output": "c.ktx2"}' >c.json
expect 0 bake neutral --config c.json
[ "$(u32 c.ktx2 20)" = 16 ] || failed "--config is not read"
clean

# ---- directions: each face of the input is that face of the output ----
# Colors are 0 and 1, and a misplaced texel is wrong by 1; resampling blurs edges.
soft=0.3
i=0
for color in r g b y c m; do
    name=$(echo px nx py ny pz nz | cut -d' ' -f$((i + 1)))
    # a face of four quarters: color and black above, black and white below
    pfm in_$name.pfm 4 k k w w k k w w $color $color k k $color $color k k
    i=$((i + 1))
done
faces="in_px.pfm in_nx.pfm in_py.pfm in_ny.pfm in_pz.pfm in_nz.pfm"
expect 0 bake $faces --lobe none --size 4 --mips 1 -o '{face}.pfm'
for name in px nx py ny pz nz; do
    same in_$name.pfm $name.pfm $soft
done
expect 0 bake $faces --lobe none --size 4 --mips 1 -o cross.pfm --projection cross-horizontal
expect 0 bake cross.pfm --lobe none --size 4 --mips 1 -o 'back_{face}.pfm'
expect 0 bake 'faces:in_px.pfm,in_nx.pfm,in_py.pfm,in_ny.pfm,in_pz.pfm,in_nz.pfm' --lobe none --size 4 --mips 1 -o x.ktx2 --format rgba32f
expect 0 bake x.ktx2 --lobe none --size 4 --mips 1 -o 'k_{face}.pfm'
for name in px nx py ny pz nz; do
    same in_$name.pfm back_$name.pfm $soft
    same in_$name.pfm k_$name.pfm $soft
done
# a quarter of a turn from +Z towards +X
expect 0 bake $faces --lobe none --size 4 --mips 1 --rotation 90 -o 'turned_{face}.pfm'
same in_pz.pfm turned_px.pfm $soft
same in_nx.pfm turned_pz.pfm $soft
# three.js looks up -x: px and nx are swapped, and all faces are mirrored
expect 0 bake $faces --size 4 --layout three -o t --mips 1
pfm mirrored.pfm 4 w w k k w w k k k k r r k k r r
same mirrored.pfm t/nx.hdr $soft
pfm mirrored.pfm 4 w w k k w w k k k k c c k k c c
same mirrored.pfm t/pz.hdr $soft
[ "$(ls t 2>&1 | tr '\n' ' ')" = "environment.hdr nx.hdr ny.hdr nz.hdr pmrem.ktx2 px.hdr py.hdr pz.hdr sh.json " ] || failed "files for three.js: $(ls t)"
clean

# ---- a constant is preserved ----
pfm white.pfm 4 w w w w w w w w w w w w w w w w
for lobe in ggx charlie lambert none; do
    expect 0 bake white --lobe $lobe --size 4 --mips 1 -o 'w_{face}.pfm' --projection faces
    same white.pfm w_py.pfm 1e-5
    same white.pfm w_nz.pfm 1e-5
done
expect 0 bake white --lobe none --size 4 --mips 1 --exposure 2x -o 'bright_{face}.pfm'
"$facet" compare white.pfm bright_px.pfm --metric max >cmp
grep -q 'max *1$' cmp || failed "--exposure 2x: $(cat cmp)"
expect 0 bake white --size 16 --mips 3 -o 'w_{face}{level}.pfm'
same white.pfm w_nx2.pfm 1e-5
clean

# ---- layouts ----
expect 6 bake neutral --layout filament -o /dev/null/studio --size 32
says "/dev/null is not a folder"
only
mkdir made
expect 0 bake neutral --layout filament -o made/studio/ --size 32 --mips 2
[ "$(ls made/studio | tr '\n' ' ')" = "sh.txt studio_ibl.ktx studio_skybox.ktx " ] || failed "files for Filament: $(ls made/studio)"
[ "$(bytes made/studio/studio_ibl.ktx 0 12)" = "ab4b5458203131bb0d0a1a0a" ] || failed "no KTX 1 file"
[ "$(u32 made/studio/studio_ibl.ktx 16) $(u32 made/studio/studio_ibl.ktx 24) $(u32 made/studio/studio_ibl.ktx 28)" = "35898 6407 35898" ] ||
    failed "glType, glFormat, glInternalFormat"
[ "$(u32 made/studio/studio_ibl.ktx 36) $(u32 made/studio/studio_ibl.ktx 52) $(u32 made/studio/studio_ibl.ktx 56)" = "32 6 2" ] || failed "size, faces, levels"
pairs=$(u32 made/studio/studio_ibl.ktx 60)
[ "$(bytes made/studio/studio_ibl.ktx 68 3)" = "736800" ] || failed "no key sh"
[ "$(wc -c <made/studio/studio_ibl.ktx)" = $((64 + pairs + 8 + 6 * 4 * (32 * 32 + 16 * 16))) ] || failed "size of the KTX 1 file"
[ "$(wc -l <made/studio/sh.txt)" = 9 ] || failed "sh.txt is not 9 lines"
grep -q '^( *[-0-9.]*, *[-0-9.]*, *[-0-9.]*); // L00, irradiance, pre-scaled base$' made/studio/sh.txt || failed "sh.txt: $(head -1 made/studio/sh.txt)"
expect 0 bake neutral --layout filament --format hdr -o faces --size 32 --mips 2
[ "$(ls faces | wc -l)" = 19 ] && [ -s faces/m1_nz.hdr ] && [ -s faces/px.hdr ] || failed "faces for Filament: $(ls faces)"
expect 0 bake neutral --layout khronos -o k --size 32 --format rgb9e5
[ "$(cd k && find . -type f | sort | tr '\n' ' ')" = "./charlie/sheen.ktx2 ./ggx/specular.ktx2 ./lambertian/diffuse.ktx2 ./lut_charlie.png ./lut_ggx.png ./lut_sheen_E.png ./panorama.hdr " ] ||
    failed "files for Khronos' viewer: $(cd k && find . -type f)"
vk k/charlie/sheen.ktx2 123
is_type k/lut_charlie.png "16-bit/color RGB"
expect 0 bake neutral --layout three --size 32
[ -s studio/pmrem.ktx2 ] || failed "--layout without -o"
says "studio/pmrem.ktx2: "
touch file
expect 6 bake neutral --layout khronos -o file
says "file: it is not a folder"
clean
# The center of an equirectangular panorama is at +Z in Filament, at +X in facet.
expect 0 bake neutral --lobe none --size 64 --mips 1 -o e.pfm
expect 0 bake e.pfm --lobe none --size 16 --mips 1 -o 'plain_{face}.hdr'
expect 0 bake e.pfm --layout filament --format hdr --size 16 --mips 1 -o f
same plain_px.hdr f/pz.hdr 0.02
same plain_nz.hdr f/px.hdr 0.02
clean

# ---- tables ----
for pair in "ggx 83" "correlated 83" "schlick 83" "multiscatter 83" "charlie 76" "charlie-neubelt 76" "average 76" "filament 97"; do
    expect 0 bake --dfg --distribution ${pair% *} --size 16 -o t.ktx2
    vk t.ktx2 ${pair#* }
done
expect 0 bake --dfg --size 16 -o t.ktx2 --format rg32f
vk t.ktx2 103
expect 0 bake --dfg --size 16 -o t.exr --format exr32
expect 0 bake --dfg --size 16 -o t.pfm
same t.exr t.pfm 1e-6
expect 0 bake --dfg --size 16 -o t.png
is_type t.png "PNG image data, 16 x 16, 16-bit/color RGB"
expect 0 bake --dfg --size 16 -o 9-t.h
grep -q '^static const float _9_t\[16\]\[16\]\[2\] = {$' 9-t.h || failed "the array's declaration: $(grep static 9-t.h)"
if command -v cc >/dev/null; then
    printf '%s\n' '#include <stdio.h>' '#include "9-t.h"' '#include "sh.h"' \
        'int main(void) { printf("%.4f %.4f %d\n", _9_t[15][8][0] + _9_t[0][8][1], sh_radiance[0][0], (int)sizeof sh_folded); return 0; }' >use.c
    expect 0 bake white --sh sh.h
    # white: L00 = 2 sqrt(pi)
    cc -Wall -Werror -o use use.c 2>err && ./use >out || failed "the headers do not compile: $(cat err)"
    grep -q ' 3.5449 108$' out || failed "the headers' numbers: $(cat out)"
fi
clean

# ---- numbers ----
# A small panorama: the reference integrates all of it for each texel.
expect 0 bake neutral --lobe none --size 16 --mips 1 -o small.pfm
if command -v jq >/dev/null; then
    json() {
        [ "$(jq -r "$1" out 2>&1)" = "$2" ] || failed "JSON: $1 is $(jq -r "$1" out 2>&1), not $2"
    }
    expect 0 bake small.pfm --size 16 --mips 2 -o x.ktx2 --sh sh.json --diffuse d.ktx2 --verify --json
    json '.outputs | map(.path) | join(" ")' "x.ktx2 d.ktx2 sh.json"
    json '.outputs[0].bytes > 14000 and .outputs[0].texels == "rgba16f"' true
    json '.cubes[0].levels | map(.size) | join(" ")' "16 8"
    json '.cubes[0].levels | map(.roughness) == [0, 1]' true
    json '.cubes[0].levels[1].rms < 0.02 and .cubes[0].levels[1].max < 0.1' true
    json '.cubes[0].levels | map(.energy > 0.99 and .energy < 1.01) | all' true
    json '.environment.repaired_texels' 0
    json '.inputs[0]' small.pfm
    json '.exit_code' 0
    jq -e '.forms | map(.form) | join(" ") == "radiance irradiance folded"' sh.json >/dev/null || failed "forms of harmonics"
    jq -e '.forms[0].coefficients | length == 9' sh.json >/dev/null || failed "coefficients"
    expect 3 bake missing.hdr -o y.ktx2 --json
    json '.failures[0].exit_code' 3
    json '.outputs | length' 0
    expect 0 bake neutral $tiny -o y.ktx2 --json
    json '.inputs[0]' neutral
    expect 2 bake --json
    json '.exit_code' 2
fi
expect 1 bake small.pfm --size 8 --mips 2 -o x.ktx2 --verify --max-error 1e-12
grep -q '^lobe *level *texels *roughness *rms *max *energy$' out || failed "no table of errors: $(head -1 out)"
[ "$(wc -l <out)" = 3 ] || failed "not a line per level: $(cat out)"
says "is above --max-error 1e-12"
[ -s x.ktx2 ] || failed "--max-error keeps the file back"
expect 0 bake small.pfm --size 4 --mips 2 -o x.ktx2 --max-error 10
[ ! -s out ] || failed "--max-error alone prints a table"
expect 0 bake neutral --size 16 -o x.ktx2 --clamp 0.5
says "studio: --clamp 0.5 removes "
pfm nan.pfm 4 w w w w w n w w w w - w w w w w
expect 0 bake nan.pfm nan.pfm nan.pfm nan.pfm nan.pfm nan.pfm $tiny -o x.ktx2
says "12 texels"
expect 1 bake nan.pfm nan.pfm nan.pfm nan.pfm nan.pfm nan.pfm $tiny -o x.ktx2 --strict
expect 0 bake neutral --quick -o x.ktx2
[ "$(u32 x.ktx2 20)" = 128 ] || failed "--quick is not 128 texels"
expect 2 bake small.pfm $tiny -o x.ktx2 --preview-exposure 0
says "without --preview"
expect 2 bake small.pfm $tiny -o x.ktx2 --preview sheet.png --preview-exposure bright
says "stops such as"
if ! is_quick; then
    expect 0 bake small.pfm --size 16 --mips 2 --preview sheet.png -o x.ktx2
    is_type sheet.png "PNG image data"
    # The sheet exposes itself: it looks alike for light in another unit
    expect 0 bake small.pfm --size 16 --mips 2 --exposure -12 --preview dark.png -o dark.ktx2
    expect 0 compare sheet.png dark.png --max mae=0.004
    expect 0 bake small.pfm --size 16 --mips 2 --exposure -12 --preview dark.png --preview-exposure 0 -o y.ktx2
    cmp -s dark.ktx2 y.ktx2 || failed "--preview-exposure changes the cube map"
    expect 1 compare sheet.png dark.png --max mae=0.004
fi
clean

# ---- limits of file formats ----
pfm bright.pfm 4 w w w w w w w w w w w w w w w w
expect 0 bake bright.pfm bright.pfm bright.pfm bright.pfm bright.pfm bright.pfm $tiny --exposure 20 -o x.ktx2
says "which removes"
expect 1 bake bright.pfm bright.pfm bright.pfm bright.pfm bright.pfm bright.pfm $tiny --exposure 20 -o x.ktx2 --strict
expect 0 bake bright.pfm bright.pfm bright.pfm bright.pfm bright.pfm bright.pfm $tiny --exposure 20 -o x.ktx2 --format rgba32f --strict
expect 7 bake bright.pfm bright.pfm bright.pfm bright.pfm bright.pfm bright.pfm -o x.ktx2 --max-memory 1K
[ "$(grep -o max-memory err | wc -l)" = 1 ] || failed "the limit is reported twice"

# ---- levels ----
expect 0 bake white --size 32 -o x.ktx2
[ "$(u32 x.ktx2 40)" = 5 ] || failed "32 texels have not five levels"
expect 0 bake white --size 4 -o x.ktx2
[ "$(u32 x.ktx2 40)" = 3 ] || failed "4 texels have not three levels"
clean

# ---- impossible outputs ----
expect 2 bake white -o 'x_{lvl}.exr'
says "{lvl} is not a placeholder"
expect 2 bake white --layout khronos -o x.ktx2
says "fills a folder"
expect 6 bake white -o /dev/null/x.ktx2
says "/dev/null is not a folder"
expect 6 bake white -o x.ktx2 --diffuse /dev/null/x.ktx2
mkdir folder.ktx2
expect 6 bake white -o folder.ktx2
if [ "$(id -u)" != 0 ]; then
    mkdir closed
    chmod 555 closed
    expect 6 bake white -o closed/x.ktx2
    expect 6 bake white -o closed/x --layout khronos
    rmdir closed
fi
if [ -c /dev/full ]; then
    expect 6 bake white $tiny -o /dev/full --format ktx2
    code=0
    "$facet" bake white $tiny -o - --format ktx2 >/dev/full 2>err || code=$?
    [ $code = 6 ] || failed "exit code $code, not 6, on a full standard output"
fi
code=0
(ulimit -f 1 && exec "$facet" bake white -o big.ktx2 2>err) || code=$?
[ $code = 6 ] || failed "exit code $code, not 6, beyond the limit on file size"
only folder.ktx2
clean

# ---- limits, interruptions ----
expect 7 bake neutral --size 1024 -o x.ktx2 --max-memory 20M
says "--max-memory"
expect 7 bake neutral --reference --size 512 -o x.ktx2 --sh sh.json --time-limit 100ms
says "time limit"
for pair in "TERM 75" "HUP 129"; do
    "$facet" bake neutral --reference --size 512 -o x.ktx2 --sh sh.json 2>err &
    process=$!
    sleep 0.6
    kill -"${pair% *}" $process || failed "it is done already"
    code=0
    wait $process || code=$?
    [ $code = "${pair#* }" ] || failed "exit code $code, not ${pair#* }, after SIG${pair% *}"
done
only
finish
