# Errors in parts that an image does not need are warnings; errors in parts that it needs refuse the model.
expect 0 render "$case_dir/anim_node_oob.gltf" $small -o node.png
says "target.node: node 7 does not exist (there is 1); it animates nothing"
expect 0 render "$case_dir/parts.gltf" $small -o parts.png
says "nodes[0].camera: camera 9 does not exist (there are 2); the node has no camera"
says "nothing that is drawn uses it"
expect 0 convert "$case_dir/parts.gltf" parts.glb
expect 0 render parts.glb $small -o again.png
cmp -s parts.png again.png || failed "the converted model is another image"
sed 's/"POSITION": 0/"POSITION": 3/' "$case_dir/parts.gltf" >needed.gltf
expect 4 render needed.gltf $small -o needed.png
says "accessors[3].componentType: 1 is not one of"
