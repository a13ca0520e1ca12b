#!/bin/sh
# convert.sh - conversion of models.
set -eu
. "$(dirname "$0")/lib.sh"

write_triangle in.gltf
expect 0 convert in.gltf out.glb
[ ! -s err ] || failed "unrequested messages"
[ "$(head -c 4 out.glb)" = glTF ] || failed "out.glb is no .glb file"
expect 0 convert out.glb again.gltf
only in.gltf out.glb again.gltf again.bin
expect 0 render in.gltf -o a.png $small
expect 0 render again.gltf -o b.png $small
cmp -s a.png b.png || failed "the model looks different after it was written"
expect 0 convert again.gltf -o third.glb
expect 0 convert out.glb fourth.glb
cmp -s third.glb fourth.glb || failed "two ways to the same model give different files"
expect 0 convert --no-clobber in.gltf out.glb
says "out.glb: kept"
expect 0 convert in.gltf out.glb --json
grep -qF '"output": "out.glb"' out || grep -qF '"output":"out.glb"' out || failed "--json does not name the output"
"$facet" convert - piped.glb <out.glb || failed "standard input is not read"
cmp -s piped.glb fourth.glb || failed "standard input gives another file"

# A failure leaves no file behind.
rm -f *.glb *.png again.*
expect 2 convert in.gltf
says "a model and the name of the new one were expected"
expect 2 convert in.gltf out.stl
says '"out.stl" does not end in .glb, .gltf, .obj, .json or .usdz'
expect 2 convert in.gltf out.glb --to gltf
says '--to: gltf is written to a .gltf file, but the output is "out.glb"'
expect 2 convert in.gltf out.glb --to ogl1
says "--to: ogl1 is written to a .json file of rgl's parameters (as MTL the same materials need an .obj file"
expect 2 convert in.gltf out.glb --to mtl
says 'mtl is written to an .obj file'
expect 2 convert in.gltf in.gltf -o out.glb
says "several models need a name with {stem}"
expect 2 convert in.gltf out.glb --report report.txt
says "--report"
expect 2 convert in.gltf in.gltf
says "this input would be overwritten"
expect 3 convert missing.glb out.glb
expect 6 convert in.gltf /dev/null/out.glb
says "/dev/null is not a folder"
printf 'glTF' >broken.glb
expect 4 convert broken.glb out.glb
expect 4 convert broken.glb out.glb --json
grep -qF '"exit_code": 4' out || grep -qF '"exit_code":4' out || failed "--json does not tell the failure"
rm broken.glb
only in.gltf
expect 7 convert in.gltf out.glb --max-memory 1K
says "in.gltf: out of memory"
says "(--max-memory)"
only in.gltf
expect 7 inspect in.gltf --max-memory 1K
says "in.gltf: out of memory"

# The files beside the output, and those found for a model by its name, are inputs as well.
cp in.gltf data.gltf
expect 0 convert data.gltf shoe.gltf
mv shoe.gltf old.gltf
cp shoe.bin before.bin
expect 2 convert old.gltf shoe.gltf
says "shoe.gltf: shoe.bin, which belongs to old.gltf, would be overwritten"
cmp -s shoe.bin before.bin || failed "an input was overwritten"
cp old.gltf noname
mv shoe.bin shoe.glb
sed -i 's/shoe\.bin/shoe.glb/' noname
expect 2 convert noname shoe.glb
says "it is an input, too"
# A .glb file may name files, too.
printf '{"asset":{"version":"2.0"},"images":[{"uri":"pic.png"}]}    ' >text
printf 'glTF\002\000\000\000\120\000\000\000\074\000\000\000JSON' | cat - text >pic.glb
expect 0 render $small in.gltf -o pic.png
expect 2 render $small pic.glb
says "pic.png: this input would be overwritten"
rm -f data.gltf old.gltf shoe.* before.bin noname text pic.*
only in.gltf

# Characters 0 and names that are not UTF-8
printf '{"asset":{"version":"2.0"},"extras":{"x":"a\\u0000b"}}' >zero.gltf
expect 0 convert zero.gltf zero2.gltf
grep -qF '\u0000' zero2.gltf || failed "a character 0 is lost"
expect 0 inspect zero2.gltf
odd=$(printf 'odd\377')
if cp in.gltf "$odd.gltf" 2>/dev/null; then
    expect 0 convert "$odd.gltf" "new$odd.gltf" --json
    grep -qF '"exit_code"' out || failed "no JSON for a name that is not UTF-8"
    expect 0 inspect "new$odd.gltf"
fi
rm -f zero* *odd*

# A full disk leaves nothing of several files.
if command -v unshare >/dev/null && unshare -rm true 2>/dev/null; then
    mkdir full
    unshare -rm sh -c 'mount -t tmpfs -o size=4k tmpfs full 2>/dev/null || exit 9
        "$1" convert in.gltf full/a.gltf 2>err; code=$?; ls -A full >left; exit $code' - "$facet" && code=0 || code=$?
    [ "$code" = 9 ] || [ "$code" = 6 ] || failed "exit code $code on a full disk"
    [ ! -s left ] || failed "a full disk keeps $(cat left)"
    rm -rf full left
fi
finish
