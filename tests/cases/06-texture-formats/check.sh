# Textures in formats that glTF lacks are read from OBJ and written to glTF as PNG; the image is the same.
cp "$case_dir"/tga.* "$case_dir"/wood.tga .
red='\036\036\310' # BGR
for i in 1 2 3 4; do printf "$red$red"'\000\000'; done >rows # two texels and padding
{ printf 'BM\000\000\000\000\000\000\000\000\066\000\000\000\050\000\000\000\002\000\000\000\004\000\000\000\001\000\030\000'
    printf '\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000'; cat rows; } >wood.bmp
printf 'GIF89a\001\000\001\000\200\000\000\310\036\036\000\000\000,\000\000\000\000\001\000\001\000\000\002\002D\001\000;' >wood.gif
{ printf 'DDS \174\000\000\000\007\020\000\000\004\000\000\000\004\000\000\000'
    for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14; do printf '\000\000\000\000'; done
    printf '\040\000\000\000\004\000\000\000DXT1'
    for i in 1 2 3 4 5 6 7 8 9 10; do printf '\000\000\000\000'; done
    printf '\003\311\000\000\000\000\000\000'; } >wood.dds
for kind in tga bmp gif dds; do
    sed "s/wood\.tga/wood.$kind/" tga.mtl >$kind.mtl.new
    sed "s/tga\.mtl/$kind.mtl/" "$case_dir/tga.obj" >$kind.obj
    mv $kind.mtl.new $kind.mtl
    expect 0 render $kind.obj -o $kind.png --size 64 --strict
    expect 0 convert $kind.obj -o $kind.glb --strict
    grep -q image/png $kind.glb || failed "$kind.glb holds no PNG file"
    grep -q "image/$kind\|image/x-\|vnd-ms" $kind.glb && failed "$kind.glb holds a kind of image that glTF does not have"
    expect 0 render $kind.glb -o glb_$kind.png --size 64 --strict
    expect 0 compare $kind.png glb_$kind.png --max differing=0
done
expect 0 compare bmp.png gif.png --max differing=0 # red everywhere
expect 0 compare bmp.png dds.png --max max=0.07
expect 1 compare bmp.png tga.png --max max=0.07
# A damaged texture gives one warning, and the model is drawn.
head -c 40 wood.tga >cut.tga
sed "s/wood\.tga/cut.tga/" tga.mtl >cut.mtl
sed "s/tga\.mtl/cut.mtl/" tga.obj >cut.obj
expect 0 render cut.obj -o cut.png --size 64
says "cut.tga: TGA: 8 x 8 texels need"
