# Spaces in file names may be escaped as in a shell.
for model in plain escaped; do
    expect 0 convert "$case_dir/$model.obj" $model.gltf
    grep -q baseColorTexture $model.gltf || failed "$model.gltf has no texture"
    grep -qF 'is read instead' err || [ $model = plain ] || failed "no warning names the file"
done
