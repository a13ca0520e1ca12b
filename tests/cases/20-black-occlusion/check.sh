# An occlusion texture of zeros is ignored, with one warning, in the preview and with OpenGL.
sed 's/"occlusionTexture": *{[^}]*}, *//; s/, *"occlusionTexture": *{[^}]*}//' "$case_dir/orm-red-0.gltf" >without.gltf
grep -q occlusionTexture without.gltf && failed "the control has the texture"
expect 0 render without.gltf $small -o without.png
[ ! -s err ] || failed "the control has a warning"
expect 0 render "$case_dir/orm-red-0.gltf" $small -o preview.png
says "the occlusion texture of material 0 is black throughout: environment light does not reach it"
[ "$(wc -l <err)" = 1 ] || failed "there is not one warning"
cmp -s without.png preview.png || failed "the image is not that without the texture"
expect 0 render "$case_dir/orm-red-0.gltf" --renderer path $small --samples 4 -o path.png
[ ! -s err ] || failed "paths need no occlusion, but there is a warning"
code=0
"$facet" render "$case_dir/orm-red-0.gltf" --renderer gl $small -o gl.png >out 2>err || code=$?
case $code in
0) says "the occlusion texture of material 0 is black throughout" ;;
8) ;; # no OpenGL here
*) failed "exit code $code of the OpenGL renderer" ;;
esac
