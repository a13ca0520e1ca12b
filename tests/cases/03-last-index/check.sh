# The largest index of a component type may be a vertex, not a restart: it is drawn, with one warning.
expect 0 render "$case_dir/byte-254.glb" $small -o 254.png --background grey
[ ! -s err ] || failed "the control has a warning"
expect 0 render "$case_dir/byte-255.glb" $small -o 255.png
says "has the index 255, which glTF keeps for primitive restart; it is drawn as that vertex"
expect 0 inspect --json "$case_dir/byte-255.glb"
grep -qE '"triangles": *254' out || failed "not all 254 triangles are drawn"
