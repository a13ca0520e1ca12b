# Lights in real units: a warning names the exposure that shows the model, and --exposure auto finds it, alike by the preview and by paths for a model that hides no light from itself.
lit=$case_dir/sun-1W-blender.gltf
for renderer in preview path; do
    expect 0 render "$lit" -o burnt.png --size 64 --samples 4 --renderer $renderer
    says "most of the visible image is overexposed: --exposure -6."
    says "--lights none"
    expect 0 render "$lit" -o auto.png --size 64 --samples 4 --renderer $renderer --exposure auto --strict -v
    says "metered: --exposure -6.6"
    expect 0 render "$case_dir/sun-pi.gltf" -o control.png --size 64 --samples 4 --renderer $renderer --strict
done
expect 0 render "$lit" -o auto.png --size 64 --exposure auto --json
stops=$(sed -n 's/.*"exposure": *\(-[0-9.]*\).*/\1/p' out)
expect 0 render "$lit" -o given.png --size 64 --exposure "$stops"
cmp -s auto.png given.png || failed "--exposure auto is not --exposure $stops"
expect 0 render "$lit" -o brighter.png --size 64 --exposure auto+1
! cmp -s auto.png brighter.png || failed "auto+1 is auto"
expect 1 render "$lit" -o burnt.png --size 64 --strict
expect 0 render "$lit" -o light.exr --size 64 --strict # a format that keeps values above white
expect 2 render "$lit" -o x.png --exposure automatic
# All frames have one exposure, whichever of them are rendered.
expect 0 render "$lit" -o 'all_##.png' --size 32 --turntable 3 --exposure auto
expect 0 render "$lit" -o 'one_##.png' --size 32 --turntable 3 --frames 3 --exposure auto
cmp -s all_03.png one_03.png || failed "the exposure depends on which frames are drawn"
