# Surfaces before any usemtl are seen from both sides, like those after one: this triangle faces away from the camera.
for renderer in preview path; do
    for model in plain named; do
        expect 0 render "$case_dir/$model.obj" -o $model.png --size 64 --samples 4 --renderer $renderer
    done
    cmp -s plain.png named.png || failed "$renderer draws a surface without usemtl otherwise"
done
expect 0 convert "$case_dir/plain.obj" plain.gltf
grep -q '"doubleSided": *true' plain.gltf || failed "plain.gltf is one-sided"
