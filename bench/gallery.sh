#!/bin/sh
# gallery.sh - renders every model of a folder of glTF models to thumbnails on contact sheets.
#     bench/gallery.sh FACET DATA     FACET: the command; DATA: a folder with models/GROUP/*.glb and a README.md whose
#                                     tables say "| `models/GROUP/NAME` | what it exercises | source | licence | size |"
# Writes docs/pictures/gallery_GROUP.jpg and docs/gallery.md. Needs ImageMagick.
set -eu
facet=$(readlink -f "$1")
data=$(readlink -f "$2")
docs=$(cd "$(dirname "$0")/../docs" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
size=220
columns=6
quality=76 # of the sheets
dark='--background #707070'

# options MODEL: options for models that are not shown best at rest, as a whole, from the front.
options() {
    case $1 in
    */Fox.glb) echo "--time 0.5 --orbit 50,75,105%" ;;
    */AnimatedColorsCube.glb | */BoxAnimated.glb) echo "--time 1" ;;
    */AnimatedMorphCube.glb) echo "--time 1.2 --orbit 35,60,105% $dark" ;;
    */SimpleMorph.glb | */SimpleSkin.glb | */AnimatedTriangle.glb) echo "--time 0.8 $dark" ;;
    */RiggedSimple.glb) echo "--time 1.2" ;;
    */MorphStressTest.glb) echo "--animation 1 --time 0.8" ;;
    */LightVisibility.glb) echo "--time 0.5 --env-intensity 0.1" ;;
    */PointLightIntensityTest.glb | */04_lights.glb) echo "--env-intensity 0.2" ;;
    */SimpleInstancing.glb | */MeshPrimitiveModes.glb | */SimpleMeshes.glb | */Cameras.glb | */Triangle*.glb | \
        */MultipleScenes.glb | */SimpleSparseAccessor.glb | */SimpleMorph-embedded.gltf) echo "$dark" ;;
    */OrientationTest.glb | */12_orm_two_uvmaps.glb | */Box*.gl* | */MultiUVTest.glb) echo "--orbit 30,65,105%" ;;
    */17_ior.glb) echo "--orbit 20,70,105% --quality final $dark" ;;
    */TwoSidedPlane.glb) echo "--orbit 30,45,105%" ;;
    */ToyCar.glb) echo "--orbit 35,70,95% --quality final" ;;
    */SunglassesKhronos.glb) echo "--orbit 30,75,105% --quality final" ;;
    */TransmissionRoughnessTest.glb) echo "--orbit 0,90,102% --quality final" ;;
    */IridescenceMetallicSpheres.glb | */SheenTestGrid.glb | *Test.glb) echo "--orbit 0,90,102%" ;;
    */CompareDispersion.glb | */CompareVolume.glb | */CompareTransmission.glb | */CompareIor.glb | \
        */GlassVaseFlowers.glb) echo "--quality final" ;;
    esac
}

# about FILE COLUMN: a cell of the README's row for the model in that file.
about() {
    row=$(dirname "$1")
    case $row in */models/*/*) ;; *) row=$1 ;; esac
    grep -F "| \`${row#"$data"/}\` |" "$data/README.md" | cut -d '|' -f "$2" | sed 's/^ *//; s/ *$//'
}

page=$docs/gallery.md
cat >"$page" <<'END'
# Gallery

How does facet render each model of the test data? In its built-in studio, with Khronos PBR Neutral tone mapping. `bench/gallery.sh
FACET DATA` makes this page, with options for a few models (a time, a side, a darker background).

The tables name author and licence of each model; textures of some were made smaller. glTF-Sample-Assets are Khronos'. CC0:
<https://creativecommons.org/publicdomain/zero/1.0/>, CC-BY: <https://creativecommons.org/licenses/by/4.0/>.
END
for group in core materials animation lights extensions specgloss scenes gltf; do
    [ -d "$data/models/$group" ] || continue
    mkdir -p "$work/$group"
    printf '\n## %s\n\n![%s](pictures/gallery_%s.jpg)\n\n' "$group" "$group" "$group" >>"$page"
    printf '| model | what it is for | licence, by | from |\n| --- | --- | --- | --- |\n' >>"$page"
    find "$data/models/$group" \( -name '*.glb' -o -name '*.gltf' \) | LC_ALL=C sort >"$work/list"
    while read -r model; do
        name=$(basename "$model")
        name=${name%.*}
        # shellcheck disable=SC2046
        "$facet" render -q "$model" -o "$work/$group/$name.png" --size $((2 * size)) --background '#d8d8d8' \
            $(options "$model")
        printf '| %s | %s | %s | %s |\n' "$name" "$(about "$model" 3)" "$(about "$model" 5)" \
            "$(about "$model" 4 | cut -d : -f 1)" >>"$page"
    done <"$work/list"
    (cd "$work/$group" && montage -label '%t' ./*.png -tile ${columns}x -geometry ${size}x${size}+4+4 \
        -font DejaVu-Sans -pointsize 11 -background white -strip -quality $quality "$docs/pictures/gallery_$group.jpg")
done
