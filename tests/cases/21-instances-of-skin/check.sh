# A skinned mesh on a node with 0 instances: nothing is drawn, and no memory is written that was not counted.
for verb in "render $small -o x.png" "inspect" "convert -o y.glb"; do
    expect 0 $verb "$case_dir/inst0_skin.glb"
    grep -q "has instances of a skinned mesh, which its joints place; it is drawn nowhere" out err ||
        failed "$verb does not warn"
done
