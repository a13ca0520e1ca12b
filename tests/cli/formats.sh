#!/bin/sh
# formats.sh FACET - STL and PLY through every command, other formats with what to do, and addresses.
set -eu
. "$(dirname "$0")/lib.sh"

cat >cube.stl <<'END'
solid roof
facet normal 0 0 1
 outer loop
  vertex -1 -1 0
  vertex 1 -1 0
  vertex 0 1 0
 endloop
endfacet
endsolid roof
END
cat >square.ply <<'END'
ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
element face 1
property list uchar int vertex_indices
end_header
-1 -1 0 255 0 0
1 -1 0 0 255 0
1 1 0 0 0 255
-1 1 0 255 255 255
4 0 1 2 3
END
sed -e /face/d -e /list/d -e /^4/d square.ply >points.ply
for model in cube.stl square.ply points.ply; do
    expect 0 render $model -o file.png $small --strict
    "$facet" render - -o stdin.png $small <$model 2>err || failed "$model from standard input"
    cmp -s file.png stdin.png || failed "$model from standard input is drawn otherwise"
    expect 0 render $model -o path.png $small --renderer path --samples 2
    expect 0 convert $model converted.glb
    expect 0 render converted.glb -o converted.png $small
    expect 0 compare file.png converted.png --max flip=0.001
    expect 0 inspect $model --json
done
expect 0 convert square.ply square.obj
expect 2 render https://example.com/model.glb -o x.png
says 'curl -sL https://example.com/model.glb | facet render - -o out.png'
printf 'Kaydara FBX Binary  ' >model.fbx
expect 5 render model.fbx -o x.png
says 'model.fbx: FBX files are not read; import it in Blender and export it as glTF 2.0'
expect 5 convert model.fbx x.glb
[ ! -e x.png ] && [ ! -e x.glb ] || failed "something was written for a model that is not read"
finish
