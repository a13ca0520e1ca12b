#!/bin/sh
# environment.sh - names of environments: the light of each, combinations, errors and their messages.
set -eu
. "$(dirname "$0")/lib.sh"

pixels() { # pixels FILE ENV WORD..: an image of the environment alone, 16 x 16, floats
    name=$1
    shift
    expect 0 render tri.gltf --size 16 --samples 1 --background env --tone-mapping none -o "$name.pfm" --env "$@"
}
same() { cmp -s "$1.pfm" "$2.pfm" || failed "not the same: $1 and $2"; }
differ() { ! cmp -s "$1.pfm" "$2.pfm" || failed "the same: $1 and $2"; }

write_triangle tri.gltf

# ---- colors ----
pixels white white
for word in constant:white constant:1 constant:1,1,1 constant:1/1/1 constant:#fff; do
    pixels other "$word"
    same white other
done
for word in gradient:1,1 gradient:white,1,#ffffff; do # another image, which rounds in other places
    pixels other "$word"
    expect 0 compare white.pfm other.pfm --space linear --max max=1e-4
done
pixels red constant:red
pixels other constant:1,0,0
same red other
differ red white
pixels ramp gradient:1,0
pixels other gradient:1,0,0
same ramp other
pixels other gradient:1,0,1
differ ramp other
pixels a neutral
pixels b studio
same a b

# ---- skies ----
pixels sun sun:40,135
for word in sun:40deg,135deg sun:40,135,2.5 sun:40,135,2.5,albedo=0.2 sun:40,135,altitude=0 sun:40,135,height=512; do
    pixels other "$word"
    same sun other
done
for word in sun:30,135 sun:40,180 sun:40,135,5 sun:40,135,albedo=#808080 sun:40,135,altitude=2000 sun:40,135,height=64 \
    preetham:40,135 sun:-5 sun:40,135,lux; do
    pixels other "$word"
    differ sun other
done
# rotating the environment rotates the sun: 45 degrees are 64 of 512 columns
pixels a sun:40,75,nodisc,height=256
pixels b sun:40,30,nodisc,height=256 --env-rotation 45
expect 0 compare a.pfm b.pfm --space linear --max max=1e-3
pixels b sun:40,30,nodisc,height=256 --env-rotation -45
expect 1 compare a.pfm b.pfm --space linear --max max=1e-3

# skies are exposed: a sunlit sheet is about white, neither black nor clipped; lux keeps absolute values
mean() { # mean of the image's first layer
    tail -c 3072 "$1" | od -An -v -t f4 | awk '{for (i = 1; i <= NF; i++) {s += $i; n++}} END {printf "%.9g", s / n}'
}
within() { # within VALUE LEAST MOST
    awk "BEGIN {exit !($1 >= $2 && $1 <= $3)}" || failed "$1 is not from $2 to $3: $4"
}
for word in sun:60 sun:20 sun:5 sun:0 sun:-4 preetham:30; do
    pixels other "$word,180,nodisc"
    within "$(mean other.pfm)" 0.02 20 "$word"
done
pixels other sun:60,0,nodisc,lux
within "$(mean other.pfm)" 500 20000 "lux"
pixels night sun:-30
within "$(mean night.pfm)" 0 0.01 "night"

# ---- faces ----
expect 0 render tri.gltf --size 8 --samples 1 --background env --tone-mapping none -o side.pfm --env constant:0.5
for face in px nx py ny pz nz; do cp side.pfm "sky_$face.pfm"; done
pixels a "sky_{face}.pfm"
pixels b "faces:sky_px.pfm,sky_nx.pfm,sky_py.pfm,sky_ny.pfm,sky_pz.pfm,sky_nz.pfm"
same a b
for face in right left top bottom front back; do cp side.pfm "room-$face.pfm"; done
pixels b "room-{face}.pfm"
same a b
rm sky_nz.pfm
expect 3 render tri.gltf $small -o x.png --env "sky_{face}.pfm"
says "sky_nz.pfm"

# an output does not replace its environment
expect 2 render tri.gltf --size 8 -o room-top.pfm --env "room-{face}.pfm"
says "room-top.pfm"
cmp -s room-top.pfm side.pfm || failed "room-top.pfm was replaced"

# ---- errors: each names the option, the value and the expectation ----
refused() { # refused ENV TEXT
    expect 2 render tri.gltf $small -o x.png --env "$1"
    says "--env"
    says "$2"
    [ ! -e x.png ] || failed "an image by --env $1"
}
refused sun "sun:ELEVATION"
refused sun: "sun:ELEVATION"
refused sun:abc "elevation first"
refused sun:135,40 "elevation first"
refused sun:91 "-90 to 90"
refused sun:40,135,0.5 "turbidity 1 to 10"
refused sun:40,135,11 "turbidity 1 to 10"
refused sun:40,bright "lux, nodisc"
refused sun:40,,3 "sun:ELEVATION"
refused sun:40,albedo=2 "albedo=X"
refused sun:40,altitude=60000 "altitude=M"
refused sun:40,height=1 "height=ROWS"
refused preetham:-1 "0 to 90"
refused preetham:40,0,1 "turbidity 1.7 to 10"
refused preetham:40,altitude=100 "preetham:ELEVATION"
refused constant:-1 "constant:COLOR"
refused constant:1,2 "constant:COLOR"
refused constant:chartreus "constant:COLOR"
refused gradient:1 "gradient:ZENITH"
refused gradient:1,2,3,4 "gradient:ZENITH"
refused gradient:1/2,3 "gradient:ZENITH"
refused faces:a,b "faces:PX"
refused faces:a,,b,c,d,e "faces:PX"
refused '#12345' "#rrggbb"
refused - "standard input"

# files may have such names
expect 0 render tri.gltf --size 8x4 --samples 1 -o sun.pfm
mv sun.pfm sun
expect 0 render tri.gltf $small -o x.png --env ./sun
expect 3 render tri.gltf $small -o y.png --env red
says "red"
finish
