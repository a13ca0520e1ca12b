#!/bin/sh
# legacy.sh - OBJ files, rgl's parameters, and materials of OpenGL 1, from and to glTF.
set -eu
. "$(dirname "$0")/lib.sh"

write_old() { # write_old STEM
    cat >"$1.mtl" <<'END'
newmtl gold
Kd 0.75164 0.60648 0.22648
Ks 0.628281 0.555802 0.366065
Ns 51.2
illum 2
newmtl matte
Kd 0.8 0.2 0.2
illum 1
END
    cat >"$1.obj" <<END
mtllib $1.mtl
o plate
v -1 0 0
v 1 0 0
v 1 1 0
v -1 1 0
vn 0 0 1
usemtl gold
f 1//1 2//1 3//1 4//1
o roof
v -1 1 0
v 1 1 0
v 0 2 -1
usemtl matte
f 5 6 7
END
}

write_old old
expect 0 convert old.obj new.glb
says "new.glb: 2 materials converted: "
says "mean error E 0.0"
grep -q "on a screen [0-9.]* (graded)" err || failed "the line does not say which error is graded"
[ "$(head -c 4 new.glb)" = glTF ] || failed "new.glb is no .glb file"
expect 0 inspect new.glb
grep -q gold out || failed "the material has lost its name"
expect 0 inspect old.obj --json
grep -q '"shininess": *51.2' out || failed "the description lacks the old values"
expect 0 convert old.obj quiet.glb -q
[ ! -s err ] || failed "messages in spite of --quiet"
cmp -s new.glb quiet.glb || failed "the same command gives other bytes"
expect 0 convert old.obj one.glb -j 1
cmp -s new.glb one.glb || failed "the file depends on the threads"
for how in "--method fit" "--profile core" "--mtl-colors linear" "--method fit --fit-target display" "--fit-target drawn"; do
    # shellcheck disable=SC2086
    expect 0 convert old.obj other.glb $how
    cmp -s new.glb other.glb && failed "$how changes nothing"
done

# The drawn figure: a metal is converted for OpenGL 1 display by default, and the report has both figures.
cat >metal.gltf <<'END'
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"materials":[{"name":"metal","pbrMetallicRoughness":{"roughnessFactor":0.4}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}]}
END
expect 0 convert metal.gltf metal.obj --report metal.json
says "on a screen 0.252, as drawn 0.158 (graded)"
grep -q '"graded":"E_drawn"' metal.json || failed "the grade of a metal is not of what is drawn"
expect 0 convert metal.gltf metal.obj --fit-target display
says "on a screen 0.219"
expect 0 convert metal.gltf metal.obj --max-error 0.2
expect 1 convert metal.gltf metal.obj --max-error 0.1

# The hue under a broad white highlight.
printf 'newmtl steelblue\nKd .2745 .5098 .7059\nKs 1 1 1\nNs 5\nillum 2\n' >hue.mtl
printf 'mtllib hue.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl steelblue\nf 1 2 3\n' >hue.obj
expect 0 convert hue.obj hue.glb
says "keep-hue keeps it"
expect 0 convert hue.obj hue.glb --keep-hue --report hue.json
grep -q '"code":"hue-kept"' hue.json || failed "the report does not say what keeping the hue costs"
grep -q '"baseColor":\[0.13' hue.json || failed "--keep-hue loses the hue"

# Round trips preserve parameters.
expect 0 convert new.glb back.obj
grep -q '^Ns 51.2$' back.mtl || failed "shininess did not come back"
grep -q '^Ks 0.628281 0.555802 0.366065$' back.mtl || failed "the highlight did not come back"
expect 0 convert back.obj again.glb
expect 0 convert old.obj same.obj --max-error 0
grep -q "source\|clamped" err && failed "OBJ to OBJ speaks of glTF"
expect 0 convert new.glb exact.obj --max-error 0
grep -q '^Kd 0.75164 0.60648 0.22648$' same.mtl || failed "OBJ to OBJ changes a color"
expect 0 convert new.glb refit.obj --refit
grep -q '^Ns 51.2$' refit.mtl && failed "--refit changes nothing"
expect 0 convert new.glb plain.obj --mtl-pbr none
grep -qE '^P[rm] ' plain.mtl && failed "--mtl-pbr none writes Pr or Pm"
write_triangle pure.gltf
expect 0 convert pure.gltf pure.obj
expect 0 convert pure.obj pure.glb

# Parameters of rgl
expect 0 convert new.glb new.json --to ogl1
grep -q '"shininess": *51.2' new.json || failed "the parameters lack the shininess"
expect 0 convert new.json balls.glb
expect 0 render new.json -o balls.png $small
expect 0 render new.json -o balls1.png $small --shading ogl1
printf '{"facet":"ogl1","version":1,"materials":[{"name":"matte","color":"steelblue","shininess":5}]}' >over.json
expect 0 convert old.obj over.glb --parameters over.json
cmp -s over.glb new.glb && failed "--parameters changes nothing"
expect 3 convert old.obj over.glb --parameters missing.json

# The encoding of colors is the file's unless the option says otherwise
printf '{"facet":"ogl1","version":1,"colors":"linear","materials":[{"name":"matte","color":"steelblue"}]}' >light.json
expect 0 convert old.obj light.glb --parameters light.json
expect 0 convert light.json light2.json --to ogl1
grep -q '"colors": *"linear"' light2.json || failed "the colors of the parameters are no longer linear"

# A light above 1 is one of a path tracer, whose colors are mostly linear
sed 's/^newmtl matte/&\nKe 17 12 4/' old.mtl >lamp.mtl
sed 's/old.mtl/lamp.mtl/' old.obj >lamp.obj
expect 0 convert lamp.obj lamp.glb
says 'material "matte": Ke of 17 is a light for path tracing'
for space in srgb linear; do
    expect 0 convert lamp.obj "$space.glb" --mtl-colors $space
    grep -q "Ke of 17" err && failed "--mtl-colors $space does not silence the note"
done
cmp -s lamp.glb srgb.glb || failed "colors of MTL files are not sRGB by default"

# Images
expect 0 render old.obj -o a.png $small
expect 0 render new.glb -o b.png $small
cmp -s a.png b.png || failed "OBJ and the glTF that was made of it look different"
expect 0 render old.obj -o c.png $small --shading ogl1
cmp -s a.png c.png && failed "--shading ogl1 changes nothing"
expect 0 render new.glb -o d.png $small --shading ogl1
cmp -s c.png d.png || failed "OBJ and the glTF that was made of it look different in OpenGL 1"
expect 0 render pure.gltf -o e.png $small --shading ogl1
for how in "--ogl1-variant webgl" "--ogl1-variant fixed" "--ogl1-space linear"; do
    # shellcheck disable=SC2086
    expect 0 render old.obj -o f.png $small --shading ogl1 $how
done
"$facet" render - -o g.png $small --root . <old.obj 2>err || failed "OBJ from standard input"
cmp -s a.png g.png || failed "OBJ from standard input looks different"

# Images read by legacy materials only
cp a.png map.png
cat >mapped.mtl <<'END'
newmtl mapped
Kd 0.5 0.4 0.3
Ks 0.5 0.5 0.5
Ns 60
map_Ks map.png
map_Ns map.png
END
cat >mapped.obj <<'END'
mtllib mapped.mtl
v 0 0 0
v 1 0 0
v 0 1 0
vt 0 0
vt 1 0
vt 0 1
usemtl mapped
f 1/1 2/2 3/3
END
expect 0 convert mapped.obj mapped.glb
expect 0 convert mapped.obj kept.glb --keep-sources
[ "$(($(wc -c <kept.glb) - $(wc -c <mapped.glb)))" -gt "$(wc -c <map.png)" ] || failed "the image of the map stayed"
expect 0 convert mapped.obj same.glb --materials metallic-roughness
cmp -s mapped.glb same.glb || failed "--materials metallic-roughness converts twice"
expect 0 convert kept.glb way.obj -v
says "(source, ogl1)"
expect 0 convert mapped.glb way.obj -v
says "(fit, ogl1)"
expect 0 render mapped.obj -o h.png $small --shading ogl1
expect 0 render kept.glb -o i.png $small --shading ogl1
cmp -s h.png i.png || failed "a kept image is not drawn in OpenGL 1"

# Mirrors
sed 's/^illum 2/illum 5/' old.mtl >shiny.mtl
sed 's/old.mtl/shiny.mtl/' old.obj >shiny.obj
expect 0 convert shiny.obj shiny.glb
says "illum 5 makes Ks a mirror of the environment"
expect 0 convert shiny.obj mirror.glb --mirrors
grep -q "illum 5" err && failed "--mirrors is not heard"
cmp -s shiny.glb mirror.glb && failed "--mirrors changes nothing"

expect 2 render old.obj -o f.png --ogl1-variant fixed
says "--ogl1-variant: it needs --shading ogl1"
expect 2 plot slice old.obj#blue -o f.csv
says 'there is no material "blue"; there are "gold", "matte"'
expect 0 plot slice old.obj#gold new.glb#matte -o f.csv

# Reports
expect 0 convert old.obj r.glb --report r.json
grep -q '"material": *"gold"' r.json || failed "the report lacks a material"
expect 0 convert old.obj r.glb --report r.html
grep -q '<h2>gold' r.html || failed "the page lacks a material"
grep -q 'data:image/png' r.html || failed "the page lacks its spheres"
expect 0 convert old.obj r2.glb --report r2.html
cmp -s r.html r2.html || failed "two runs give different pages"
expect 1 convert old.obj r.glb --max-error 0.0001
says "an error above --max-error"
expect 0 convert old.obj r.glb --json
grep -qE '"count": ?2' out || failed "--json does not count the materials"
expect 0 convert pure.gltf r.glb --report r.json
grep -qE '"materials": ?\[\]' r.json || failed "a report of nothing is not empty"
expect 0 convert pure.gltf r.glb --report r.html

expect 2 convert old.obj x.json --report ./x.json
says "it and its report have the same output x.json"

# To standard output
"$facet" convert old.obj -o - 2>err | cat >piped.glb
cmp -s piped.glb new.glb || failed "standard output has another model than the file"
"$facet" convert old.obj -o - -q | "$facet" render - -o piped.png $small || failed "a model cannot be piped"
cmp -s piped.png a.png || failed "a piped model looks different"
expect 2 convert old.obj -o - --to obj
says "standard output takes a .glb file"

# Several
mkdir in made
(cd in && write_old a && write_old b)
expect 0 convert in/a.obj in/b.obj -o 'made/{stem}.glb' --report 'made/{stem}.json'
[ -s made/a.glb ] && [ -s made/b.glb ] && [ -s made/a.json ] && [ -s made/b.json ] || failed "files are missing"
rm in/b.mtl
expect 0 convert in/b.obj -o 'made/{stem}.gltf'
says "b.mtl"
expect 1 convert in/b.obj --strict -o 'made/{stem}.gltf'
expect 1 convert in/a.obj in/missing.obj -o 'made/{stem}.glb'
rm -rf in made

# Inputs are not overwritten.
cp old.mtl keep.mtl
expect 2 convert old.obj old.obj
says "this input would be overwritten"
sed 's/old.mtl/new.mtl/' old.obj >source.obj
cp old.mtl new.mtl
expect 2 convert source.obj new.obj
says "new.mtl, which belongs to source.obj, would be overwritten"
cmp -s new.mtl keep.mtl || failed "an input was overwritten"
[ ! -e new.obj ] || failed "something half was written"
printf 'newmtl t\nKd 1 1 1\nmap_Kd tex.png\n' >tex.mtl
cp a.png tex.png
printf 'mtllib tex.mtl\nusemtl t\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >tex.obj
expect 2 render tex.obj
says "tex.png: this input would be overwritten"
cmp -s a.png tex.png || failed "a texture was overwritten"

cp old.obj link.obj
ln -s link.obj other.obj
expect 2 convert link.obj other.obj
says "this input would be overwritten"
cp new.json params.json
expect 2 convert old.obj params.json --parameters params.json
says "it is an input, too"

# Spec-gloss
cat >sg.gltf <<'END'
{"asset":{"version":"2.0"},"extensionsUsed":["KHR_materials_pbrSpecularGlossiness"],
"materials":[{"name":"sg","extensions":{"KHR_materials_pbrSpecularGlossiness":
{"diffuseFactor":[0.5,0.4,0.3,1],"specularFactor":[0.2,0.1,0.05],"glossinessFactor":0.7}}}]}
END
expect 0 convert sg.gltf mr.gltf --materials metallic-roughness
grep -q pbrSpecularGlossiness mr.gltf && failed "the old extension is still there"
grep -q KHR_materials_specular mr.gltf || failed "the highlight is lost"
expect 0 convert mr.gltf sg2.gltf --materials specular-glossiness
grep -q pbrSpecularGlossiness sg2.gltf || failed "the old extension was not written"
expect 0 convert sg.gltf core.gltf --materials metallic-roughness --profile core
grep -q KHR_materials_specular core.gltf && failed "the core profile has an extension"

# Broken inputs are reported in one sentence, and nothing is written.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 1000000000\n' >bad.obj
code=0
"$facet" convert bad.obj bad.glb 2>err >out || code=$?
[ $code = 0 ] || [ $code = 4 ] || failed "exit code $code for an index that is too large"
says "line 4"
printf 'v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >nan.obj
code=0
"$facet" convert nan.obj nan.glb 2>err >out || code=$?
says "line 1"
# Parameters for every object leave no default material behind.
printf 'o ball\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >unnamed.obj
printf '{"materials":[{"name":"red","objects":["ball"],"color":"#FF0000"}]}' >unnamed.json
expect 0 inspect --json --parameters unnamed.json unnamed.obj
[ "$(jq -c '[.. | .materials? | arrays | map(.name)] | first' out)" = '["red"]' ] ||
    failed "the materials are $(jq -c '[.. | .materials? | arrays | map(.name)] | first' out)"
finish
