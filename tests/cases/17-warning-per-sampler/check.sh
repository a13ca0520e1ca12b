# Samplers whose data have a byteStride, as Sketchfab writes them: nothing comes of it, so --strict passes; -v has a line. (The
# row of quads is thin: small images of it miss it, which is a warning.)
expect 0 render --strict "$case_dir/forty.gltf" --size 256x64 -o forty.png --background grey
[ ! -s err ] || failed "there is a warning"
expect 0 render -v "$case_dir/forty.gltf" --size 256x64 -o forty.png
says "is in a buffer view with byteStride (40 times in all)"
[ "$(grep -c byteStride err)" = 1 ] || failed "more than one line says so"
