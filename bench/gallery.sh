#!/bin/sh
# gallery.sh - draws every model of a folder of glTF models and puts the pictures, small, on contact sheets.
#     bench/gallery.sh FACET DATA     FACET: the command; DATA: a folder with models/GROUP/*.glb and a README.md whose
#                                     tables say "| `models/GROUP/NAME` | what it exercises | .."
# Writes docs/pictures/gallery_GROUP.jpg and docs/gallery.md. Needs ImageMagick.
set -eu
facet=$(readlink -f "$1")
data=$(readlink -f "$2")
docs=$(cd "$(dirname "$0")/../docs" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
size=240
columns=6

# options MODEL: what shows the model best where the whole model from the front does not.
options() {
    case $1 in
    */animation/*) echo "--time 0.4" ;;
    *CompareDispersion* | *Transmission* | *GlassVase* | *ToyCar* | *Sunglasses* | *CompareVolume*) echo "--quality final" ;;
    */CornellBox*) echo "--exposure 1" ;;
    esac
}

page=$docs/gallery.md
cat >"$page" <<'END'
# Gallery

Every model of the test data, drawn by `facet render` with no options but the size (animated ones a moment after their
begin). `bench/gallery.sh` makes this page; the models are those of Khronos' sample assets and others, each with its
licence in the data's README.
END
for group in core materials animation lights extensions specgloss scenes gltf; do
    [ -d "$data/models/$group" ] || continue
    mkdir -p "$work/$group"
    printf '\n## %s\n\n![%s](pictures/gallery_%s.jpg)\n\n' "$group" "$group" "$group" >>"$page"
    find "$data/models/$group" \( -name '*.glb' -o -name '*.gltf' \) | LC_ALL=C sort >"$work/list"
    while read -r model; do
        name=$(basename "$model")
        name=${name%.*}
        # shellcheck disable=SC2046
        "$facet" render -q "$model" -o "$work/$group/$name.png" --size $size --background '#d8d8d8' \
            $(options "$model") || continue
        what=$(grep -F "models/$group/" "$data/README.md" | grep -F "/$name" | head -n 1 | cut -d '|' -f 3)
        printf -- '- **%s**:%s\n' "$name" "${what:- }" >>"$page"
    done <"$work/list"
    (cd "$work/$group" && montage -label '%t' ./*.png -tile ${columns}x -geometry ${size}x${size}+4+4 \
        -font DejaVu-Sans -pointsize 12 -background white -strip -quality 85 "$docs/pictures/gallery_$group.jpg")
done
