# A node that is a child of two nodes is drawn under each, with one warning.
expect 0 render "$case_dir/node_two_parents.gltf" $small -o two.png
says "node 0 is a child of node 1 already; it is drawn under each parent"
expect 0 inspect --json "$case_dir/node_two_parents.gltf"
grep -q '"instances": *2' out || failed "it is not drawn twice"
expect 0 convert "$case_dir/node_two_parents.gltf" two.glb
expect 0 render --strict two.glb $small -o again.png
cmp -s two.png again.png || failed "the converted model is another image"
