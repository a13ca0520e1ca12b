# The library was renamed with the model, but the mtllib statement has the old name.
expect 0 convert "$case_dir/chair.obj" chair.gltf
says 'there is no file "exported-name.mtl"; "chair.mtl", which is named like the model, is read instead'
grep -q baseColorFactor chair.gltf || failed "chair.gltf does not have the color of chair.mtl"
sed /mtllib/d "$case_dir/chair.obj" >chair.obj
cp "$case_dir/chair.mtl" .
expect 0 inspect chair.obj
grep -q 'names no library of materials; "chair.mtl"' out || failed "no warning names chair.mtl"
mv chair.mtl other.mtl
expect 0 inspect chair.obj
grep -q 'is in no library' out || failed "a library is read that is not the model's"
