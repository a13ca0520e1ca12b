#!/bin/sh
# gl.sh - --renderer gl: its images against the preview, its options, its failures. Skips without OpenGL.
set -eu
. "$(dirname "$0")/lib.sh"

# ---- without OpenGL ----

# The command in a folder without its module, and with invalid modules.
mkdir -p bin
cp "$facet" bin/facet
alone="$work/bin/facet"
write_triangle model.gltf

# fails TEXT: exit code 8, one sentence, no image, and facet version -v says the same.
fails() {
    code=0
    "$alone" render model.gltf -o none.png $small --renderer gl >out 2>err || code=$?
    [ "$code" = 8 ] || failed "exit code $code, not 8: $1"
    says "$1"
    [ "$(wc -l <err)" = 1 ] || failed "more than one sentence: $1"
    [ ! -e none.png ] || failed "an image came of it: $1"
    "$alone" version -v >out 2>err || failed "facet version -v fails: $1"
    grep -q '^opengl ' out || failed "facet version -v has no line of OpenGL"
}
if [ ! -e /usr/lib/*/facet/facet_gl.so ] 2>/dev/null && [ ! -e /usr/local/lib/facet/facet_gl.so ]; then
    fails "OpenGL: "
    echo 'not a library' >bin/facet_gl.so
    fails "OpenGL: facet's module facet_gl.so cannot be opened ("
    if command -v cc >/dev/null && echo 'const void *facet_gl_entry(const char *build, const void *host)
        { (void)build; (void)host; return 0; }' | cc -shared -fPIC -x c - -o bin/facet_gl.so 2>/dev/null; then
        fails "it belongs to another build of facet"
    fi
    rm bin/facet_gl.so
    # The current folder is not searched.
    echo 'not a library' >facet_gl.so
    (PATH="$work/bin:$PATH" && facet version -v >out)
    grep -q 'cannot be opened (' out && failed "a module of the current folder was opened"
    rm facet_gl.so
fi
rm -r bin
rm -f none.png

# The preview does not load a driver, and works without one.
code=0
__EGL_VENDOR_LIBRARY_FILENAMES=/none "$facet" render model.gltf -o cpu.png $small >out 2>err || code=$?
[ "$code" = 0 ] || failed "the preview needs OpenGL"
rm cpu.png

# libEGL alone.
mkdir shadow
for library in libGL.so.1 libOpenGL.so.0; do
    echo 'not a library' >shadow/$library
done
code=0
LD_LIBRARY_PATH="$work/shadow${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" "$facet" render model.gltf -o none.png $small --renderer gl >out 2>err || code=$?
[ "$code" = 8 ] || failed "exit code $code, not 8, without libGL"
says "OpenGL: "
[ ! -e none.png ] || failed "an image without libGL"

# Its options are refused with another renderer, and vice versa.
for option in --shadows '--transparency peeled' '--bloom 0.1' '--channel normal' '--brdf schlick-ggx'; do
    expect 2 render model.gltf -o no.png $small $option
    says "it needs --renderer gl"
done
expect 2 render model.gltf -o no.png $small --renderer gl --bounces 2
says "--bounces: it needs --renderer path"
expect 2 render model.gltf -o no.png $small --renderer gl --channel colour
says "colour"
expect 2 render model.gltf -o no.png $small --renderer gl --bloom 2
expect 2 render model.gltf -o no.exr $small --renderer gl --aov variance

# ---- with it ----
code=0
"$facet" render model.gltf -o probe.png $small --renderer gl >out 2>err || code=$?
if [ "$code" = 8 ]; then
    echo "skipped: $(cat err)"
    [ $status = 0 ] && exit 77
    exit 1
fi
[ "$code" = 0 ] || failed "exit code $code, not 0"
is_type probe.png "PNG image data, 48 x 32"
says "the outline hardly shows on a background of nearly its own color; another --background or --ground shadow"
rm -f probe.png
"$facet" version -v >out
grep -q '^opengl .*[0-9]\.[0-9]' out || failed "facet version -v does not name the driver"

# near A B: within half a code of 8 bits on average.
near() {
    "$facet" compare "$1" "$2" --max mae=0.002 >out 2>err || failed "$1 and $2 differ: $(grep -m1 mae out)"
}

# The same image as the preview's, where both shade pixel centers; and the same edges.
for how in '' '--crop 30,25,60,50' '--background transparent' '--background env' '--sun 30,45' \
    '--ortho --exposure 1' '--energy gltf'; do
    expect 0 render -o cpu.exr --size 120x90 --quality draft $how
    expect 0 render -o gpu.exr --size 120x90 --quality draft $how --renderer gl
    near cpu.exr gpu.exr
done
for how in '' '--samples 16' '--samples 64' '--quality final' '--crop 30,25,60,50'; do
    expect 0 render model.gltf -o cpu.exr --size 120x90 --background '#345' $how
    expect 0 render model.gltf -o gpu.exr --size 120x90 --background '#345' $how --renderer gl
    near cpu.exr gpu.exr
done
expect 0 render -o cpu.exr --size 96x64 --aov all
expect 0 render -o gpu.exr --size 96x64 --aov all --renderer gl
for layer in normal albedo material occlusion uv; do
    "$facet" compare cpu.exr gpu.exr --layer $layer --max mae=0.005 >out 2>err || failed "layer $layer differs"
done
for layer in object instance; do # numbers of 32 balls: one pixel in two hundred may show another one at an edge
    "$facet" compare cpu.exr gpu.exr --layer $layer --max mae=0.1 >out 2>err || failed "layer $layer differs"
done

# Deterministic; every format; several models; a sequence is drawn by one renderer.
expect 0 render -o a.png $small --renderer gl
expect 0 render -o b.png $small --renderer gl --threads 1
cmp -s a.png b.png || failed "images of two runs differ"
expect 0 render model.gltf -o 'turn_##.png' $small --renderer gl --turntable 4
for i in 1 2 3 4; do [ -s turn_0$i.png ] || failed "frame $i is missing"; done
cmp -s turn_01.png turn_02.png && failed "the model does not turn"
expect 0 render model.gltf -o turn.y4m $small --renderer gl --turntable 4
[ "$(head -c 9 turn.y4m)" = YUV4MPEG2 ] || failed "no video"
expect 0 render model.gltf - -o '{stem}.webp' $small --renderer gl <model.gltf
rm -f ./*.png ./*.webp ./*.exr turn.y4m

# Each option changes the image.
expect 0 render -o plain.png $small --renderer gl --sun 30,45
for option in --shadows '--bloom 0.5' '--channel normal' '--channel furnace'; do
    expect 0 render -o other.png $small --renderer gl --sun 30,45 $option
    cmp -s plain.png other.png && failed "$option changes nothing"
done
for how in sorted peeled weighted; do
    expect 0 render -o other.png $small --renderer gl --transparency $how
done

# Limits, and the report.
expect 7 render model.gltf -o late.png --size 2000 --renderer gl --time-limit 0.000001s
says "the time limit (--time-limit) was reached"
[ ! -e late.png ] || failed "an image of no time"
long="render -o long.png --size 4000 --samples 4096 --renderer gl"
expect 7 $long --time-limit 1s
says "long.png: the time limit (--time-limit) was reached"
code=0
timeout --preserve-status -k 20 -s TERM 1 "$facet" $long >out 2>err || code=$?
[ "$code" = 75 ] || failed "exit code $code, not 75, by SIGTERM"
[ ! -e long.png ] || failed "a part of an image"
expect 0 render model.gltf -o one.png $small --renderer gl --json
grep -q '"width": 48' out || failed "no report"
expect 0 render model.gltf -o dark.png $small --renderer gl --env none
says "the image is black"

# OpenGL ES, where the driver is Mesa's and can be limited to it.
if MESA_GL_VERSION_OVERRIDE=3.0 "$facet" version -v | grep -q '^opengl .*OpenGL ES'; then
    expect 0 render -o gl.exr --size 96x64 --renderer gl
    code=0
    MESA_GL_VERSION_OVERRIDE=3.0 "$facet" render -o es.exr --size 96x64 --renderer gl >out 2>err || code=$?
    [ "$code" = 0 ] || failed "OpenGL ES: exit code $code"
    near gl.exr es.exr
fi
finish
