# Names of materials in GBK and Latin-1: convert takes the bytes as Latin-1, with one warning, and names that differ still do.
expect 0 convert "$case_dir/material-utf8.obj" utf8.glb
! grep -q UTF-8 err || failed "the control has a warning"
expect 0 convert "$case_dir/material-gbk.obj" gbk.glb
says "is not UTF-8; its bytes are taken as Latin-1"
expect 0 inspect --json gbk.glb
grep -q '½ðÊô' out || failed "the name is not there"
printf 'newmtl caf\351\nKd 1 0 0\nnewmtl caf\352\nKd 0 1 0\n' >latin1.mtl
printf 'mtllib latin1.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nusemtl caf\351\nf 1 2 3\nusemtl caf\352\nf 2 4 3\n' >latin1.obj
expect 0 convert --json latin1.obj latin1.glb
grep -q '"worst": *"caf' out || failed "the report lacks a name"
expect 0 inspect --json latin1.glb
grep -q '"café"' out && grep -q '"cafê"' out || failed "two names are not two"
# The file of a texture has such a name, too.
image=$(printf 'bild\344.png')
expect 0 render latin1.obj --size 8 -o "$image"
printf 'newmtl a\nmap_Kd %s\n' "$image" >map.mtl
printf 'mtllib map.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n' >map.obj
expect 0 convert map.obj map.glb
says "is not UTF-8, which glTF needs; its bytes are taken as Latin-1"
expect 0 render --json map.obj --size 8 -o "x$image"
grep -q '"output": *"xbild' out || failed "the report lacks the file's name"
