# Kd 0 0 0 beside a map counts as white, whether or not the map can be read.
for model in there lost; do
    expect 0 convert "$case_dir/$model.obj" $model.gltf
    says 'counts as white'
    tr -d ' \n' <$model.gltf | grep -q '"pbrMetallicRoughness":{\("baseColorTexture":{[^}]*},\)\{0,1\}"metallicFactor":0}' ||
        failed "the material of $model.gltf is not white"
done
