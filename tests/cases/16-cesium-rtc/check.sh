# CESIUM_RTC moves the model to its center, near or far: the image is the same.
expect 0 render --strict "$case_dir/unitCubeWithCesiumRtc.gltf" $small -o near.png
expect 0 inspect "$case_dir/unitCubeWithCesiumRtc.gltf"
grep -qF "from (2, 3, 4) to (3, 4, 5)" out || failed "the cube is not at its center"
cp "$case_dir/unitCubeWithCesiumRtc_data.bin" .
sed 's/^        2,$/        6378137,/' "$case_dir/unitCubeWithCesiumRtc.gltf" >far.gltf
expect 0 render far.gltf $small -o far.png
expect 0 compare near.png far.png --max flip=0.001
expect 0 convert far.gltf far.glb
expect 0 render --strict far.glb $small -o again.png
cmp -s far.png again.png || failed "the converted model is another image"
