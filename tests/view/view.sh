#!/bin/sh
# view.sh - facet view: the window shows the image that the copied command line renders, after any input.
set -eu
. "$(dirname "$0")/lib.sh"
write_triangle triangle.gltf

# ---- the same image as the copied command's ----
cat >script <<'END'
load
picture first.png
print
END
view
rendered first.png facet.png

cat >script <<'END'
load
picture first.png
drag left 40 40 52 48
picture orbit.png
drag Shift+left 40 40 60 50
scroll 0 -3
key 5
key +
key t
key e
load
key Ctrl+Left
key l
key j
picture all.png
print
END
view triangle.gltf
differ first.png orbit.png
differ orbit.png all.png
rendered all.png triangle.png
grep -q -- '--ortho' command || failed "the parallel view is not in $(cat command)"
grep -q -- '--env white' command || failed "the next environment is not in $(cat command)"
grep -q -- '--tone-mapping' command || failed "the tone mapping is not in $(cat command)"

# far from the origin: the window is the same, and the command has the coordinates of the file
sed 's/"mesh":0/"translation":[1e8,-4526331.25,1000000],"mesh":0/; s/\[0.3,0.3,3\]/[100000000.3,-4526330.95,1000003]/' triangle.gltf >far.gltf
cat >script <<'END'
load
picture far_first.png
drag left 40 40 52 48
drag Shift+left 40 40 60 50
picture far_moved.png
print
END
view far.gltf
rendered far_moved.png far.png
grep -q -- '--target [0-9]*[.]*[0-9]*,-45263[0-9.]*,' command || failed "the target is not the file's in $(cat command)"
sed 's/far/near/' script >script.near
mv script.near script
view triangle.gltf
rendered near_moved.png triangle.png
same near_moved.png far_moved.png 0.01

# options of OpenGL only
cat >script <<'END'
load
key n
key n
picture base_color.png
print
key 0
key f
key f
key Shift+f
key p
key s
key b
key g
picture gl.png
print
END
view --sun 30,45
differ base_color.png gl.png
grep -q -- '--channel base-color' out || failed "no channel in $(cat out)"
rendered gl.png facet.png
for word in '--brdf multiscatter' '--energy gltf' '--transparency peeled' --shadows '--bloom 0.04' '--ground shadow'; do
    grep -qF -- "$word" command || failed "no $word in $(cat command)"
done
head -1 out >channel
mv channel out
rendered base_color.png facet.png

# options without a key are copied as well; names need quotes
cp triangle.gltf "it's a triangle.gltf"
cat >script <<'END'
load
picture sun.png
print
END
view "it's a triangle.gltf" --sun 30,45 --background transparent --root . --camera Hero
rendered sun.png "it's a triangle.png"
grep -q -- "--sun 30,45" command || failed "the sun is not in $(cat command)"
grep -q -- "--camera 0" command || failed "the camera is not in $(cat command)"

# ---- overlays ----
cat >script <<'END'
load
window hint.png
size 1000 800
wait 20
window bare.png
key h
window help.png
picture under.png
key h
window again.png
key z
window values.png
key z
size 480 360
key h
window page1.png
key h
window page2.png
size 160 120
wait 20
window tiny.png
END
view triangle.gltf
if "$facet" plot -o plot.png >/dev/null 2>&1; then # cairo renders text
    differ bare.png help.png
    differ bare.png values.png
    differ page1.png page2.png # letters stay as large as they can be read
    "$facet" compare page1.png page2.png --max mae=0.5 -q >/dev/null 2>&1 || failed "the second page is no help"
fi
same bare.png under.png
same bare.png again.png

# environments cycle, each with its name; a missing one is reported in the window only
cat >script <<'END'
load
wait 20
window neutral.png
key e
load
window white.png
wait 20
key Shift+e
load
key Shift+e
load
wait 1
window none.png
wait 20
window dark.png
print
END
view triangle.gltf
grep -q -- '--env none' out || failed "none is not the last environment: $(cat out)"
[ ! -s err ] || failed "what the window says stands elsewhere, too: $(cat err)"
if "$facet" plot -o plot.png >/dev/null 2>&1; then
    differ neutral.png white.png
    differ none.png dark.png
fi

# ---- files ----
mkdir models
cp triangle.gltf models/b.gltf
"$facet" convert triangle.gltf -o models/a2.glb -q 2>/dev/null
cp models/a2.glb models/a10.glb
echo no >bad.glb
cat >script <<'END'
load
print
key Right
load
print
key Left
load
key Left
load
print
picture before.png
drop bad.glb
load
print
picture after.png
drop triangle.gltf
load
print
END
view models/
grep -o '^facet render [^ ]*' out | sed 's/.* //' | tr '\n' ' ' >order
[ "$(cat order)" = "models/a2.glb models/a10.glb models/b.gltf models/b.gltf triangle.gltf " ] ||
    failed "models in another order: $(cat order)"
same before.png after.png

# reloaded when its file changes, with the same view
cp triangle.gltf changing.gltf
cat >script <<'END'
load
drag left 40 40 52 48
picture old.png
print
reload
picture new.png
print
END
(
    sleep 2
    sed 's/"max":\[1,1,0\]/"max":[1,1,0],"name":"x"/; s/"mesh":0/"mesh":0,"scale":[0.5,0.5,0.5]/' triangle.gltf >new.gltf
    mv new.gltf changing.gltf
) &
view changing.gltf
wait $!
differ old.png new.png
[ "$(grep -c '^facet render' out)" = 2 ] && [ "$(sort -u out | wc -l)" = 1 ] || failed "the view changed with the file"
rendered new.png changing.png

expect 3 view none.glb --script close.txt
expect 4 view bad.glb --script close.txt
mkdir empty
expect 3 view empty --script close.txt
says "there is no .glb, .gltf or .obj file in it"
echo "dance" >wrong
expect 2 view --script wrong
says 'wrong: line 1: there is no "dance"'
expect 2 view --script - <wrong
says 'line 1: there is no "dance"'
echo close | expect 0 view --script - $size
expect 2 render -n 4097 -o many.png
says "--samples"
expect 0 render $small --renderer gl -o driver.png -v
says "OpenGL: "
expect 2 view --renderer preview
says "gl or path"

# ---- the window ----
cat >script <<'END'
load
size 200 90
picture wide.png
print
minimise
key h
drag left 10 10 20 20
wait 1
restore
key h
drag left 20 20 10 10
picture same.png
END
view triangle.gltf
rendered wide.png triangle.png
same wide.png same.png

# ---- the frame holds the whole animation, chosen at the start or later ----
sed 's/"scene":0,/"scene":0,"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],"samplers":[{"input":1,"output":2}]}],/
    s/"max":.1,1,0.}\],/"max":[1,1,0]},{"bufferView":1,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]},{"bufferView":2,"componentType":5126,"count":2,"type":"VEC3"}],/
    s/"byteLength":36}\],/"byteLength":36},{"buffer":1,"byteLength":8},{"buffer":1,"byteOffset":8,"byteLength":24}],/
    s/"buffers":\[/&{},/' triangle.gltf >moving.gltf
sed -i 's/{},\(.*\)}\]}$/\1},{"byteLength":32,"uri":"data:application\/octet-stream;base64,AAAAAAAAgD8AAAAAAAAAAAAAAAAAAEBAAAAAAAAAAAA="}]}/' moving.gltf
cat >script <<'END'
load
print
key w
key Space
print
key w
print
key 9
print
wait 1
key Enter
print
END
view moving.gltf
sed -n 's/.*--orbit \([^ ]*\).*/\1/p' out >orbits
[ "$(sed -n 1p orbits)" = "$(sed -n 3p orbits)" ] && [ "$(sed -n 4p orbits)" = "$(sed -n 5p orbits)" ] &&
    [ "$(sed -n 1p orbits)" != "$(sed -n 2p orbits)" ] || failed "distances: $(cat orbits)"
sed -n 2p orbits >moving
printf 'load\nprint\n' >script
view moving.gltf --animation 0
grep -q -- "--orbit $(cat moving) " out || failed "another distance with --animation than with a key: $(cat out)"

# An image never replaces its model; an empty script is valid.
cp triangle.gltf shown.gltf
printf 'load\npicture shown.gltf\n' >script
code=0
timeout 60 "$program" view shown.gltf $size --script script >out 2>err || code=$?
[ "$code" = 2 ] || failed "exit code $code, not 2, of a picture over its model"
cmp -s triangle.gltf shown.gltf || failed "the model was overwritten"
printf '# nothing\n' >script
code=0
timeout 60 "$program" view shown.gltf $size --script script >out 2>err || code=$?
[ "$code" = 0 ] || failed "exit code $code of a script without steps"

# ---- animations, variants and lights of models ----
if [ -d "$data/models" ]; then
    cat >script <<'END'
load
key w
key w
wait 0.4
key Space
picture fox.png
print
END
    view "$data/models/animation/Fox.glb"
    rendered fox.png Fox.png
    grep -q -- '--animation 1 --time ' command || failed "no moment of the second animation in $(cat command)"
    cat >script <<'END'
load
picture first.png
key v
key v
picture shoe.png
print
END
    view "$data/models/materials/MaterialsVariantsShoe.glb"
    rendered shoe.png MaterialsVariantsShoe.png
    differ first.png shoe.png
    grep -q -- '--variant 1' command || failed "no variant in $(cat command)"
    printf 'load\nkey Shift+Tab\nprint\n' >script
    view "$data/models/materials/MaterialsVariantsShoe.glb" # whose variant 0 is its default
    grep -q -- '--variant 1' out || failed "the sides are alike: $(cat out)"
else
    echo "FACET_TEST_DATA names no folder with models: animations and variants were not looked at"
fi

finish
