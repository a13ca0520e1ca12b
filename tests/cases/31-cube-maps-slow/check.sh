# A cube map takes about the processor time of a panorama of as many texels, with one thread. It once took 10 times as much.
milliseconds() { # of the last command that was run in a subshell, from the output of times
    tail -1 times | sed 's/m/ /g; s/s//g' | awk '{ printf "%d", 1000 * ($1 * 60 + $2 + $3 * 60 + $4) }'
}
expect 0 bake sun:40,135 -o cube.ktx2 --lobe none --mips 1 --size 512
expect 0 bake sun:40,135 -o panorama.exr --lobe none --mips 1 --size 512 --projection equirect
for file in cube.ktx2 panorama.exr; do
    (expect 0 bake $file -o out_$file.ktx2 --size 16 -j 1; times >times; exit $status) || status=1
    milliseconds >$file.ms
done
[ "$(cat cube.ktx2.ms)" -lt $((5 * $(cat panorama.exr.ms) + 100)) ] ||
    failed "the cube map takes $(cat cube.ktx2.ms) ms, the panorama $(cat panorama.exr.ms) ms"
