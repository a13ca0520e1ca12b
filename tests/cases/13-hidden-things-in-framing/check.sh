# Invisible geometry and a few distant triangles do not affect framing.
sed 's/"scenes": \[{"nodes": \[0, 1\]}\]/"scenes": [{"nodes": [0]}]/' "$case_dir/far_transparent.gltf" >quad.gltf
printf 'v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n' >quad.obj
(cat quad.obj && printf 'v 100000 5 3\nv 100000 5 3\nv 100000 5 3\nf 5 6 7\n') >point.obj
i=0
while [ $i -lt 40 ]; do # a fan of 40 triangles
    echo "v 0 0 0"
    awk "BEGIN { printf \"v %f %f 0\\nv %f %f 0\\n\", cos($i / 7), sin($i / 7), cos(($i + 1) / 7), sin(($i + 1) / 7) }"
    echo "f -3 -2 -1"
    i=$((i + 1))
done >fan.obj
(cat fan.obj && printf 'v 5000 0 0\nv 5001 0 0\nv 5000 1 0\nf -3 -2 -1\n') >stray.obj
# same A B OPTIONS: both files give the same image
same() {
    left=$1
    right=$2
    shift 2
    expect 0 render "$right" -o b.png --size 64 "$@"
    expect 0 render "$left" -o a.png --size 64 "$@"
    cmp -s a.png b.png || failed "$left is not framed as $right: $*"
}
for options in "" "--ortho" "--orbit 30,60" "--renderer path --samples 1"; do
    same "$case_dir/far_transparent.gltf" quad.gltf $options
    same point.obj quad.obj $options
    same stray.obj fan.obj $options
    says "--framing all"
done
expect 0 render stray.obj -o all.png --size 64 --framing all
! grep -q framing err || failed "a warning about what was asked for"
! cmp -s a.png all.png || failed "--framing all changes nothing"
expect 1 render stray.obj -o a.png --size 64 --strict
