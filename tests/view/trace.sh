#!/bin/sh
# trace.sh - facet view: path tracing converges to the image of facet render --renderer path; the divider shows both sides.
set -eu
. "$(dirname "$0")/lib.sh"
write_triangle rough.gltf
# a roughness at which the split sum and the traced image differ
sed 's/"attributes":{"POSITION":0}/&,"material":0/; s/^"meshes"/"materials":[{"pbrMetallicRoughness":{"roughnessFactor":0.4}}],\n&/' \
    rough.gltf >triangle.gltf
size="--size 96x72"

cat >script <<'END'
load
trace
picture path.png
print
drag left 40 40 46 45
trace
picture turned.png
key r
picture gl.png
key r
trace 1
END
view triangle.gltf --renderer path --samples 8
rendered_command=$(tail -1 out)
case $rendered_command in *"--renderer path"*"--samples 8"*) ;; *) failed "no path tracing in $rendered_command" ;; esac
rendered path.png triangle.png
differ path.png turned.png
differ turned.png gl.png

# both sides of the divider equal their own images: energy of glTF, and conserving
cat >script <<'END'
load
picture left.png
key Tab
key Tab
picture both.png
drag left 48 30 500 30
picture dragged.png
key 0
key Shift+F
picture right.png
END
view --orbit 0,75,105% --energy gltf # near, so that both differ in many pixels
differ left.png right.png
# columns 47 and 48 belong to the border
for side in left:0,0,46,72:both left:0,0,90,72:dragged right:50,0,46,72:both; do
    crop=${side#*:}
    "$facet" compare "${side%%:*}.png" "${side##*:}.png" --crop "${crop%:*}" --max max=0.004 -q >compared 2>&1 ||
        failed "the $side side differs: $(cat compared)"
done

# The divider does not stop path tracing: both sides are traced like their own images, and moving the border does not restart
# them. (Holding it: window.sh.)
cat >script <<'END'
load
key Tab
trace
picture sides.png
drag left 48 30 70 30
trace 32 0.5
picture moved.png
key 0
key Shift+F
trace
picture alone.png
END
view triangle.gltf --renderer path --energy gltf --samples 32
"$facet" compare sides.png alone.png --crop 50,0,46,72 --max max=0.004 -q >compared 2>&1 ||
    failed "the right side is not what is traced alone: $(cat compared)"
"$facet" compare sides.png moved.png --crop 72,0,24,72 --max max=0 -q >compared 2>&1 ||
    failed "dragging the border changes what is traced: $(cat compared)"

# The window counts the samples; the hint at the start goes with the first input, or in time.
cat >script <<'END'
load
window hint.png
key z
key z
window none.png
key r
key r
key r
trace 8
wait 20
window counted.png
picture traced.png
END
view triangle.gltf --samples 8
differ hint.png none.png
differ traced.png counted.png
printf 'load\nwait 20\nwindow later.png\n' >script
view triangle.gltf
same later.png none.png 0

# a timeout ends the script, and so does a failure to write
cat >script <<'END'
load
key r
trace 0 1.5
close
END
expect 7 view triangle.gltf --script script $size
says "script: line 3: the path traced image ("
says "of 4096 samples) did not come within 1.5 s"
cat >script <<'END'
load
picture nowhere/picture.png
close
END
expect 6 view triangle.gltf --script script $size
says "nowhere/picture.png"

finish
