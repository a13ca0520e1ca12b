# glTF JSON in Latin-1 and in GBK: read, with one warning.
expect 0 render "$case_dir/latin1.gltf" $small -o latin1.png
says "has text that is not UTF-8; its bytes are taken as Latin-1"
printf '{"asset":{"version":"2.0"},"materials":[{"name":"\275\360\312\364"},{"name":"\225\\"}]}' >gbk.gltf
expect 0 render gbk.gltf $small -o gbk.png
says "has text that is not UTF-8; its bytes are taken as Latin-1"
expect 0 convert gbk.gltf gbk.glb
