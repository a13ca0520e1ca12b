# File names that differ in case or Unicode form: the only match is read, with a warning.
expect 0 convert "$case_dir/table.obj" table.gltf
says 'there is no file "Table.MTL"; "table.mtl" is read instead'
says '"textures/wood.png" is read instead'
grep -q baseColorTexture table.gltf || failed "table.gltf has no texture"
mkdir textures
cp "$case_dir/table.obj" "$case_dir/table.mtl" .
cp "$case_dir/textures/wood.png" textures/wood.png
cp "$case_dir/textures/wood.png" textures/Wood.png
expect 0 convert table.obj two.gltf
says 'there is no file "Textures\WOOD.PNG"'
if grep -q baseColorTexture two.gltf; then failed "one of two files was guessed"; fi
cp textures/wood.png "$(printf 'te\314\201te.png')"
write_triangle plain.gltf
for uri in "$(printf 'T\303\211te.PNG')" 'TEXTURES\wood.png' 'textures/wood.png?v=1' 'table.png'; do
    sed 's|"meshes"|"images":[{"uri":"@"}],"meshes"|' plain.gltf >image.gltf
    printf '%s\n' "$uri" | sed 's/[\\&|]/\\&/g' >uri
    sed "s|@|$(sed 's/\\\\/\\\\\\\\/g' uri)|" image.gltf >uri.gltf
    expect 0 inspect uri.gltf
    case $uri in
    table.png) wanted='is no file' ;;
    *) wanted='is read instead' ;;
    esac
    grep -q "$wanted" out || failed "no warning for $uri"
done
