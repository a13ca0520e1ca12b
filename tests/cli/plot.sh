#!/bin/sh
# plot.sh - plots: kinds, formats, materials, and errors.
set -eu
. "$(dirname "$0")/lib.sh"

kinds="legacy brdf slice hemisphere lobe terms albedo furnace dfg tone fresnel error"

# CSV needs no graphics library.
for kind in $kinds; do
    expect 0 plot "$kind" -o "$kind.csv"
    [ -s "$kind.csv" ] || failed "$kind.csv is empty"
    [ "$(wc -l <"$kind.csv")" -gt 3 ] || failed "$kind.csv has no numbers"
    grep -qiE '(^|,)-?(nan|inf)' "$kind.csv" && failed "$kind.csv has numbers that are none"
done
expect 0 plot tone -o - --format csv
cmp -s out tone.csv || failed "standard output has other numbers than the file"
expect 0 plot tone -o tone.json
grep -q '"panels":\[{"kind":"xy","title":".*"curves":\[{"name":"' tone.json || failed "tone.json is no chart"
expect 0 plot tone -o none.csv --title ''
expect 0 plot legacy -o again.csv -j 1
cmp -s again.csv legacy.csv || failed "the numbers depend on the threads"
expect 0 plot legacy -o ramp.csv --heaviside ramp
cmp -s ramp.csv legacy.csv && failed "--heaviside ramp changes nothing"
rm -f ./*.csv

# Graphics, if cairo is installed.
if "$facet" plot tone -o tone.svg 2>err; then
    head -c 5 tone.svg | grep -q '<?xml' || failed "tone.svg is no SVG file"
    expect 0 plot tone -o tone.pdf
    [ "$(head -c 4 tone.pdf)" = %PDF ] || failed "tone.pdf is no PDF file"
    expect 0 plot tone -o tone.png --size 400x300
    for format in svg pdf png; do
        expect 0 plot slice --roughness 0.2,0.5 --angle 0,60 -o "a.$format"
        expect 0 plot slice --roughness 0.2,0.5 --angle 0,60 -o "b.$format"
        cmp -s "a.$format" "b.$format" || failed "two runs give different $format files"
    done
    expect 0 plot tone --no-clobber -o tone.svg
    says "tone.svg: kept"
    expect 0 plot dfg
    [ -s dfg.svg ] || failed "without a name there is no dfg.svg"
else
    [ $? = 8 ] || failed "without cairo the exit code is another than 8"
    says "csv"
fi
rm -f ./*.svg ./*.pdf ./*.png

# Materials
write_triangle in.gltf
expect 0 plot slice roughness=0.3,metallic=1,color=gold ogl1,diffuse=0.5,specular=1,shininess=20 -o a.csv
expect 0 plot slice ogl1,diffuse=#808080,specular=0.1/0.2/0.3 --fit -o b.csv
# Fits report their parameters and error in text, in JSON and in the chart; the parameters are a MATERIAL.
expect 0 plot slice ogl1,diffuse=0.05,specular=gold,shininess=20 --fit -o fit.csv
says "fit: metal ("
says "E_display "
grep -q 'fit (E 0\.[0-9]*): metal' fit.csv || failed "the chart has no error"
fitted=$(sed -n 's/.*): \(pbr,[^ ]*\)$/\1/p' err)
expect 0 plot slice "$fitted" -o again.csv
expect 0 plot slice metallic=1,roughness=0.4 --fit -o fit.csv --json
grep -q '"model": *"ogl1"' out && grep -q '"parameters": *"ogl1,' out && grep -q '"E_display"' out ||
    failed "the JSON lacks the fit"
expect 0 plot slice metallic=1,roughness=0.4 -o fit.csv --json
grep -q '"fits": *\[\]' out || failed "a fit that was not asked for"
expect 0 plot slice metallic=1,roughness=0.4 --fit --energy gltf -o fit.csv
expect 2 plot slice metallic=1,roughness=0.4 --fit --energy conserving -o fit.csv
says '"conserving" is not gltf'
for name in ggx phong blinn-phong; do
    expect 0 plot brdf $name -o $name.csv
done
expect 2 plot brdf ogl1:shininess=30
says 'write a comma after ogl1: ogl1,shininess=30'
expect 2 plot ggx -o c.csv
says "the kind of plot comes first, as in facet plot brdf ggx"
cmp -s phong.csv blinn-phong.csv || failed "phong is another model than blinn-phong"
expect 0 plot brdf GGX,roughness=0.3 Phong,shininess=9 -o lobes.csv
# One scale: the lobe of roughness 0.2 is beyond 1, that of 0.6 below it.
expect 0 plot brdf --roughness 0.2,0.6 --metallic 1 --angle 0 --scale shared -o shared.csv
grep -q 'over its peak' shared.csv && failed "a shared scale has peaks of its own"
expect 0 plot brdf --roughness 0.2,0.6 --metallic 1 --angle 0 -o own.csv
cmp -s own.csv shared.csv && failed "--scale shared changes nothing"
expect 2 plot brdf --scale both -o c.csv

expect 2 plot slice roughness=2 -o c.csv
says 'roughness: "2" is not a number from 0 to 1'
expect 2 plot slice rougness=.2 -o c.csv
says 'there is no parameter "rougness"'
expect 2 plot slice color=nocolor -o c.csv
says "is not a color"
expect 2 plot slice ogl1,shiny -o c.csv
says "NAME=VALUE was expected"
expect 3 plot slice missing.glb -o c.csv
expect 3 plot slice missing.binary -o c.csv
printf 'abc' >short.binary
expect 4 plot slice short.binary -o c.csv
says "short.binary"
expect 2 plot slice --angle 95 -o c.csv
expect 2 plot slice --roughness 0.1,x -o c.csv
expect 2 plot slice --size 0x1 -o c.csv

printf '{"asset":{"version":"2.0"},"materials":[{"name":"m"}]}' >mat.gltf
cp mat.gltf saved.gltf
expect 2 plot slice mat.gltf roughness=0.5 -o mat.gltf --format csv
says "this input would be overwritten"
cmp -s mat.gltf saved.gltf || failed "an input was overwritten"

# Invalid requests
expect 2 plot
says "which plot? One of legacy, brdf"
expect 2 plot pie -o a.svg
says 'there is no plot "pie"'
expect 2 plot tone -o tone.gif
says "does not end in .svg, .pdf, .png, .csv or .json"
expect 2 plot tone -o -
says "needs --format"
expect 6 plot tone -o /dev/null/tone.csv
expect 0 plot tone -o t.csv --json
grep -qE '"kind": ?"tone"' out || failed "--json does not name the kind"
finish
