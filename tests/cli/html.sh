#!/bin/sh
# html.sh - facet view --html: pages from templates of the viewer's package, which here is a small stand-in; tests/web/export.mjs opens
# real ones.
set -eu
. "$(dirname "$0")/lib.sh"
unset DISPLAY WAYLAND_DISPLAY
write_triangle tri.gltf
small="--size 48x32"
mkdir -p web/pages
cat >web/pages/single.html <<'END'
<title>{{title}}</title><p>{{nonce}} {{{{ {{version}}</p><img src="{{preview}}">
{{files}}{{decoders}}<script type="application/json">{{view}}</script>
END
cp web/pages/single.html web/pages/model.html
echo '<title>{{title}}</title>{{links}}' >web/pages/index.html
echo 'viewer' >web/pages/viewer.js
printf 'pages/viewer.js\n' >web/pages/files.txt

# without the package, nothing is written: a copy of the command is neither installed nor in a build tree
mkdir alone
cp "$facet" alone/facet
command=$facet
facet=$work/alone/facet
expect 8 view tri.gltf --html page.html
says "./run web --build"
facet=$command
rm -r alone
export FACET_WEB="$work/nowhere"
expect 8 view tri.gltf --html page.html
says "FACET_WEB names $work/nowhere"
[ ! -e page.html ] || failed "a page without a viewer"
export FACET_WEB="$work/web"

# one file: the same bytes again, without a display; all files of the model, the options of the view
expect 0 view tri.gltf $small --html page.html --orbit '30,60,105%' --shadows -q --title 'A <b> & "c"' --controls
cp page.html first.html
expect 0 view tri.gltf $small --html page.html --orbit '30,60,105%' --shadows --title 'A <b> & "c"' --controls --threads 1
cmp -s page.html first.html || failed "the same command gives another page"
has() {
    grep -qF -- "$1" page.html || failed "the page has no $1"
}
has '<title>A &lt;b&gt; &amp; &quot;c&quot;</title>'
has 'src="data:image/png;base64,iVBOR'
has '"title": "A \u003cb> & \"c\""'
has '"model": "tri.gltf"'
has '"options": {"orbit": "30,60,105%", "shadows": true}'
has '"controls": true'
has '{{{{ '
sed -n 's/.*data-path="tri.gltf">\(.*\)<\/script>.*/\1/p' page.html | base64 -d | gzip -dc | cmp -s - tri.gltf ||
    failed "the model in the page is not the model"
expect 0 view $small --html - -q
grep -q '"model": "", "files": \[\]' out || failed "the built-in scene has files"

# files in folders keep their places beside each other; the environment is a file of the page
mkdir -p models/textures light
printf 'newmtl m\nmap_Kd textures/a.ppm\n' >models/m.mtl
printf 'P6 1 1 255\nabc' >models/textures/a.ppm
printf 'mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >models/m.obj
"$facet" render --size 64x32 --quality draft -o light/sky.png -q
expect 0 view models/m.obj $small --env light/sky.png --html page.html -q
has '"model": "m.obj"'
has 'data-path="m.mtl"'
has '"env": "sky.png"'
has 'data-path="sky.png"'
(cd models && FACET_WEB="$work/web" "$facet" view ../models/./m.obj $small --env sun:45,135 --html ../page.html -q) || failed "relative names"
has '"model": "m.obj"'
has '"env": "sun:45,135"'

# a model that options read otherwise than the page would, and one of no file: as .glb, by way of a temporary folder
mkdir temporary
export TMPDIR="$work/temporary"
expect 0 view models/m.obj $small --method fit --mtl-colors linear --html page.html -q
has '"model": "m.glb", "files": [{"path": "m.glb"}], "options": {}'
expect 0 view - $small --html page.html -q <tri.gltf
has '"model": "model.glb"'
[ -z "$(ls temporary)" ] || failed "temporary files remain: $(ls temporary)"
export TMPDIR="$work/nowhere"
expect 6 view - $small --html page.html -q <tri.gltf
unset TMPDIR

# the decoder that a texture needs is in the page
if "$facet" render $small -o models/textures/a.webp -q 2>err; then
    mkdir web/facet-viewer
    echo decoder >web/facet-viewer/codec_webp.wasm
    sed 's/a.ppm/a.webp/' models/m.mtl >models/w.mtl
    sed 's/m.mtl/w.mtl/' models/m.obj >models/w.obj
    expect 0 view models/w.obj $small --html page.html -q
    sed -n 's/.*data-module="codec_webp.wasm">\(.*\)<\/script>.*/\1/p' page.html | base64 -d | gzip -dc | grep -qx decoder ||
        failed "the page has no decoder"
    expect 0 view models/m.obj $small --html page.html -q
    ! grep -q codec_webp page.html || failed "the page has a decoder that nothing needs"
fi

# a file may not leave the folder of the model, unless it may by --root
sed 's/data:[^"]*/..\/outside.bin/' tri.gltf >models/out.gltf
expect 3 view models/out.gltf $small --html out.html
says "leads out of the model's folder"
[ ! -e out.html ] || failed "a page of a model that cannot be read"
expect 4 view page.html $small --html out.html

# inputs are kept, and so are pages with --no-clobber
cp tri.gltf in.gltf
expect 2 view in.gltf $small --html in.gltf
says "this input would be overwritten"
cmp -s tri.gltf in.gltf || failed "the input was overwritten"
expect 2 view models/m.obj $small --html models/m.mtl
expect 2 view models/m.obj $small --env light/sky.png --html light/sky.png
echo old >page.html
expect 0 view tri.gltf $small --html page.html --no-clobber
says "page.html: kept, since it exists"
[ "$(cat page.html)" = old ] || failed "--no-clobber"
expect 6 view tri.gltf $small --html /dev/full
expect 6 view tri.gltf $small --html models/m.obj/page.html

# a folder: a page for each model, the viewer and the light once, an index
cp tri.gltf models/index.gltf
cp tri.gltf "models/a b.gltf"
expect 0 view tri.gltf models/m.obj models/index.gltf 'models/a b.gltf' in.gltf tri.gltf $small --env light/sky.png --html pages/ -q
for file in index.html tri.html m.html index-2.html 'a b.html' in.html tri-2.html previews/m.png models/m/m.obj models/m/textures/a.ppm \
    light/sky.png pages/viewer.js; do
    [ -s "pages/$file" ] || failed "there is no pages/$file"
done
grep -q '<a href="a%20b.html">' pages/index.html || failed "no link to a b.html"
grep -qF '"path": "textures/a.ppm", "url": "models/m/textures/a.ppm"' pages/m.html || failed "no address of the texture"
grep -qF '"path": "sky.png", "url": "light/sky.png"' pages/m.html || failed "no address of the light"
expect 2 view pages/models/m/m.obj $small --html pages
says "this input would be overwritten"

# a model that cannot be read: the others have their pages
expect 1 view models/out.gltf tri.gltf $small --html some/ --json
[ -s some/tri.html ] && [ ! -e some/out.html ] || failed "pages of the models that can be read"
! grep -q 'out.html' some/index.html || failed "a link to a page that is not there"
if command -v jq >/dev/null; then
    [ "$(jq -r '.pages[0].output, (.failures | length), .exit_code' out | tr '\n' ' ')" = "some/tri.html 1 1 " ] || failed "JSON: $(cat out)"
fi

# a file of the folder's name
expect 6 view tri.gltf --html in.gltf/
says "in.gltf is not a folder"
ln -s page.html link.html
expect 0 view tri.gltf $small --html link.html -q
[ ! -L link.html ] || failed "a link was followed"

# misuse
expect 2 view tri.gltf in.gltf --html page.html
says "holds one model"
expect 2 view tri.gltf --html page.html --exposure auto
expect 2 view tri.gltf --html page.html --renderer path
expect 2 view tri.gltf --html page.html --script x
expect 2 view tri.gltf --html ''
expect 2 view tri.gltf --title x
says "it needs --html"
echo '{"html": "page.html"}' >config.json
expect 2 view tri.gltf --config config.json
says "give it on the command line"
exit $status
