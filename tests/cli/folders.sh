#!/bin/sh
# folders.sh - folders and lists of models as input, and the placeholders {dir}, {name}, {stem} and {index} of outputs.
set -eu
. "$(dirname "$0")/lib.sh"
tiny="--size 16 --quality draft -q"
mkdir -p models/sub/deeper models/.hidden 'models/a b'
write_triangle models/zebra.gltf
cp models/zebra.gltf models/sub/chair.gltf
cp models/zebra.gltf models/sub/deeper/chair.gltf
cp models/zebra.gltf 'models/a b/Cup.GLTF'
cp models/zebra.gltf models/.hidden/no.gltf
echo '{"name":"no model"}' >models/package.json
echo text >models/readme.txt
ln -s ../models models/sub/loop

# tree FOLDER: what is below, one line.
tree() {
    (cd "$1" && find . -type f | sed 's|^\./||' | LC_ALL=C sort | tr '\n' ';')
}

# All models below a folder, in an order independent of the file system, into new folders.
expect 0 render models -o 'img/{dir}/{stem}.png' $tiny
[ "$(tree img)" = "a b/Cup.png;sub/chair.png;sub/deeper/chair.png;zebra.png;" ] || failed "the names are $(tree img)"
rm -r img
expect 0 render models/ -o 'img/{index}_{name}.png' $tiny --json
order=$(grep -oE '"model": "[^"]*"' out | cut -d'"' -f4 | tr '\n' ';')
[ "$order" = "models/a b/Cup.GLTF;models/sub/chair.gltf;models/sub/deeper/chair.gltf;models/zebra.gltf;" ] ||
    failed "the order is $order"
[ "$(tree img)" = "1_Cup.GLTF.png;2_chair.gltf.png;3_chair.gltf.png;4_zebra.gltf.png;" ] || failed "the names are $(tree img)"
rm -r img
# A file's own folder is {dir}, below the output's place.
expect 0 render models/zebra.gltf ./models/../models/sub/chair.gltf "$work/models/sub/deeper/chair.gltf" -o 'img/{dir}/{stem}.png' $tiny
[ -s img/models/zebra.png ] && [ -s img/models/models/sub/chair.png ] && [ -s "img$work/models/sub/deeper/chair.png" ] ||
    failed "the names are $(tree img)"
rm -r img

# A clash of names fails those two models only.
expect 1 render models -o 'img/{stem}.png' $tiny
says "models/sub/chair.gltf: it and models/sub/deeper/chair.gltf have the same output img/chair.png; put {dir}"
says "models/sub/deeper/chair.gltf: it and models/sub/chair.gltf have the same output img/chair.png"
[ "$(tree img)" = "Cup.png;zebra.png;" ] || failed "the names are $(tree img)"
rm -r img
expect 1 convert models -o 'new/{stem}.glb' -q
says "models/sub/chair.gltf: it and models/sub/deeper/chair.gltf have the same output new/chair.glb"
[ "$(tree new)" = "Cup.glb;zebra.glb;" ] || failed "the names are $(tree new)"
rm -r new
expect 0 convert models 'new/{dir}/{stem}.glb' -q
[ "$(tree new)" = "a b/Cup.glb;sub/chair.glb;sub/deeper/chair.glb;zebra.glb;" ] || failed "the names are $(tree new)"
rm -r new
expect 2 render models -o one.png $tiny
says "one name for 4 models"

# Lists
find models -name 'chair*' -type f | LC_ALL=C sort >list
expect 0 render --files-from list models/zebra.gltf -o 'img/{index}.png' $tiny --json
order=$(grep -oE '"model": "[^"]*"' out | cut -d'"' -f4 | tr '\n' ';')
[ "$order" = "models/zebra.gltf;models/sub/chair.gltf;models/sub/deeper/chair.gltf;" ] || failed "the order is $order"
rm -r img
printf 'models/sub\r\n\r\nmodels/zebra.gltf' | "$facet" inspect --files-from - >out 2>err || failed "a list on standard input"
[ "$(grep -c 'glTF *2.0' out)" = 3 ] || failed "not three models of a list"
find models -name 'C*' -print0 | "$facet" inspect --json --files-from - >out 2>err || failed "a list with zero bytes"
[ "$(wc -l <out)" = 1 ] || failed "not one model of a list with zero bytes"
: >empty
expect 2 inspect --files-from empty
says "--files-from: empty names no file"
expect 3 inspect --files-from missing
says "missing: "
expect 2 render - --files-from - -o '{stem}.png'
says "standard input is a model already"
expect 1 render --files-from list missing.glb -o 'img/{index}.png' $tiny
says "missing.glb: "
[ "$(tree img)" = "2.png;3.png;" ] || failed "the names are $(tree img)"
rm -r img

# A folder without models; outputs in folders that cannot be created
mkdir none
expect 3 render none -o x.png $tiny
says "none: there is no model in or below this folder"
expect 1 inspect none models/zebra.gltf
expect 6 render models/zebra.gltf -o models/zebra.gltf/a/b.png $tiny
[ ! -e x.png ] || failed "an image of nothing"
expect 3 render missing.glb -o new/folder/x.png $tiny
[ ! -e new ] || failed "a folder for an image that was not drawn"
finish
