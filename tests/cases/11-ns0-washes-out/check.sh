# A red sphere with Ns 0 and a bright Ks is red and matte; with --dialect spec it is nearly white.
expect 0 convert "$case_dir/ns0.obj" ball.gltf
says "Ns 0 spreads the highlight over the whole surface"
grep -q '"specularFactor": *0$' ball.gltf || failed "ball.gltf has a highlight"
tr -d ' \n' <ball.gltf | grep -qF '"baseColorFactor":[0.60382736,0.033104766,0.033104766,1]' || failed "the ball is not red"
expect 0 convert "$case_dir/ns0.obj" literal.gltf --dialect spec
if tr -d ' \n' <literal.gltf | grep -qF '"baseColorFactor":[0.60382736,'; then failed "--dialect spec is not literal"; fi
