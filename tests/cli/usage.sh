#!/bin/sh
# usage.sh - help, suggestions, and wrong command lines (exit code 2).
set -eu
. "$(dirname "$0")/lib.sh"

expect 2
says "facet COMMAND"
expect 0 --help
expect 0 -h
expect 0 help
expect 0 --version
expect 0 version
grep -qE '^facet [0-9]+\.[0-9]+\.[0-9]+$' out || failed "version prints $(cat out)"
expect 0 version -v
[ "$(wc -l <out)" -gt 4 ] || failed "version -v is short"
expect 0 version --json
if command -v jq >/dev/null; then # every library is found with a version, or missing and opened when it is needed
    jq -e '.libraries | length > 3 and all(.[]; (.name | length > 0) and (.license | length > 0) and (.found or .file))' out >/dev/null ||
        failed "version --json: $(cat out)"
    jq -r '.libraries[] | select(.found and .file and .name != "GLFW") | .name, .file' out >opened
    mkdir broken
    while read -r name && read -r file; do
        ! ldd "$facet" | grep -q "$file" || continue # builds with sanitizers link Embree
        : >"broken/$file"
        LD_LIBRARY_PATH=$PWD/broken "$facet" version -v >out
        grep -q "$name missing: $file is not installed" out || failed "version -v does not say that $file is missing"
    done <opened
    rm -r opened broken
fi
expect 0 help exit-codes
grep -q '75' out || failed "help exit-codes lacks 75"

expect 2 model.glb
says "facet: which command? For an image: facet render model.glb -o model.png; to see what is in it: facet inspect"
expect 2 studio.hdr
says "facet bake studio.hdr -o studio.ktx2"
expect 2 cmgen
says "did you mean bake?"
expect 2 help raytrace
says "did you mean facet help render?"
expect 2 rendr
says "did you mean render?"
expect 2 batch
says "batch: which models?"
expect 2 -v render
says "the command comes first"

expect 2 render --resolution=640,480
says "did you mean --size 640x480?"
for option in --hdri-file --output-file --width --skybox-image --no-background --tonemap --spp; do
    expect 2 render $option x
    says "did you mean --"
done
expect 2 ocean --orbit 0
says "--orbit is an option of facet render"
expect 2 render --wind 5
says "--wind is an option of facet ocean, not of facet render"
expect 2 render --exposure auto --shading ogl1 -o x.png
says "--exposure: --shading ogl1 produces display values, which auto cannot meter"
expect 2 render --material-override x.json
says "does not have it yet"
expect 2 render --size 12y
says "--size: \"12y\" is not WIDTHxHEIGHT"
expect 2 render --crop 0,0,2000,10
expect 2 render --background nocolor
expect 2 render --orbit 1,2,3,4
expect 2 render --fov 200
expect 2 render --camera 0 --orbit 30
expect 2 render --eye 0,0,1 --turntable 3
expect 2 render --renderer opengl
says "is not preview, path or gl"
expect 2 render -o x.bmp
says ".png, .jpg, .webp, .exr, .hdr, .pfm or .y4m"
expect 2 render --aov depth -o x.png
says "layers need an .exr file"
says "a .png holds one of object, material and instance alone, in false color"
expect 2 render --aov object,material -o x.png
expect 2 render --aov object -o x.jpg
expect 2 render --aov depth,variance -o x.exr
says "--renderer preview has depth, normal, albedo, material, object, instance, uv, occlusion, cryptomatte"
expect 2 render --aov samples -o x.exr --renderer gl
says "--renderer gl has depth, normal"
expect 2 render --aov cryptomatte -o x.exr --renderer path --checkpoint y.exr --resume
says "a checkpoint does not hold cryptomatte"
expect 2 render --max-memory lots
expect 2 render --time-limit 0
expect 2 render --turntable 3 -o a.png
says "put #### in it"
expect 2 render a.glb b.glb -o a.png
says "put {stem} in it"
expect 1 render a/x.glb b/x.glb
says "a/x.glb: it and b/x.glb have the same output x.png"
says "b/x.glb: it and a/x.glb have the same output x.png"
expect 2 render -o - </dev/null
says "add --format png"
expect 2 render -o - --format png --json
expect 2 version word
expect 2 inspect

# A plural finds the same topics as its singular.
expect 0 help thumbnails
grep -q "preset thumbnail" out || failed "help thumbnails does not find the preset"

# An address is a wrong command line, not a missing file.
for words in "render https://example.org/a.glb" "inspect http://example.org/a.glb" "compare https://example.org/a.png b.png" \
    "bake https://example.org/a.hdr -o a.ktx2" "convert HTTPS://example.org/a.glb a.gltf"; do
    expect 2 $words
    says "facet reads files, not addresses"
done

# A word in braces that is not a placeholder is refused.
expect 2 render -o '{nope}.png'
says "facet: --output: {nope} is not a placeholder; the placeholders are {stem}, {name}, {dir}, {index}"
expect 2 ocean -o 'sea_{level}.png'
says "{level} is not a placeholder"
expect 2 bake neutral -o '{name}.hdr'
says "{name} is not a placeholder; the placeholders are {stem}, {level}, {face}"
expect 2 convert a.glb '{dirname}.gltf'
says "facet: convert: {dirname} is not a placeholder"
expect 2 convert a.glb b.glb --report '{Stem}.json'
says "--report: {Stem} is not a placeholder"
expect 2 render --renderer path -o a.exr --checkpoint '{face}.exr'
says "--checkpoint: {face} is not a placeholder"
expect 0 render --size 8 -q -o '{}{1}.png'
only '{}{1}.png'
rm '{}{1}.png'

# With --json a wrong command line is reported as JSON, too, in one shape: found while parsing or later.
fails_json() {
    wanted=$1
    shift
    expect "$wanted" "$@"
    [ "$(wc -l <out)" = 1 ] && grep -q "^{\"facet\": \"[^\"]*\", \"failures\": \[{\"message\": .*, \"exit_code\": $wanted}\], \"exit_code\": $wanted}\$" out ||
        failed "facet $* prints $(cat out)"
}
for verb in render bake convert inspect plot compare ocean version; do
    fails_json 2 $verb --json --no-such-option
done
fails_json 2 rendr --json
fails_json 2 render --json --size 12y
fails_json 2 inspect --json
fails_json 2 compare --json a.png
fails_json 2 convert --json a.glb
fails_json 2 render --json in.glb out.png
fails_json 2 bake --json neutral --size 100
fails_json 2 ocean --json --wind x
fails_json 2 plot --json brdf --angle 95
fails_json 2 plot --json brdf shine=3
fails_json 2 compare --json a.png b.png --crop 1
fails_json 3 render --json --config missing.json
fails_json 3 inspect --json missing.glb
expect 2 render --no-such-option -- --json
[ ! -s out ] || failed "--json behind -- is an argument"

# An output without -o is refused before any work, rather than taken for an input.
write_triangle tri.gltf
misplaced() {
    hint=$1
    shift
    expect 2 "$@"
    says "$hint"
    [ ! -s out ] || failed "facet $* printed something"
    [ "$(wc -l <err)" = 1 ] || failed "facet $* says more than one sentence"
}
misplaced "did you mean -o out.png?" render tri.gltf out.png
misplaced "did you mean -o out.PNG?" render out.PNG
misplaced "did you mean -o out.y4m?" render tri.gltf --turntable 3 out.y4m
touch out.exr
misplaced "did you mean -o out.exr?" render tri.gltf out.exr
misplaced "did you mean -o sea.png?" ocean sea.png
misplaced "did you mean -o out.ktx2?" bake neutral out.ktx2
misplaced "did you mean -o out.ktx2?" bake --dfg out.ktx2
misplaced "did you mean -o out.svg?" plot brdf roughness=0.5 out.svg
misplaced "did you mean -o d.png?" compare a.png b.png d.png
misplaced "did you mean -o out.glsl?" shaders brdf out.glsl
misplaced "did you mean > out.txt?" inspect tri.gltf out.txt
misplaced "did you mean facet render MODEL -o out.png?" view tri.gltf out.png
only tri.gltf out.exr
rm tri.gltf out.exr
only

# Help by word: an option in all commands that have it, another tool's name for it, and any mention of a word.
expect 0 help orbit
grep -q -- '--orbit AZ,POLAR,RADIUS' out && grep -q 'in facet render, facet view' out || failed "help orbit: $(cat out)"
expect 0 help --orbit
expect 0 help hdri-file
grep -q 'hdri-file is, in facet render: --env FILE' out || failed "help hdri-file: $(cat out)"
expect 0 help --search ground
grep -q -- '--ground WHAT' out || failed "help --search ground lacks --ground"
! grep -q -- '--background-blur' out || failed "help --search ground has --background-blur"
expect 0 help three.js
grep -q 'bake.md' out || failed "help three.js names no document"
expect 2 help --search xyzzy
says 'mentions "xyzzy"'
expect 2 help xyzzy
expect 0 help documents
grep -q 'not installed beside this command' out || failed "help documents names documents that are not there"

expect 0 bake --help
grep -q "HDRLoader().load('studio/environment.hdr'" out || failed "bake --help does not say how three.js loads its files"

# --help is short, --help-all is complete.
for verb in render ocean bake convert compare plot view inspect; do
    expect 0 help $verb
    [ "$(wc -l <out)" -le 80 ] || failed "help $verb has $(wc -l <out) lines"
    grep -q "facet $verb --help-all lists all" out || failed "help $verb does not name --help-all"
    expect 0 $verb --help-all
    cp out all
    grep -q '^Messages' all && grep -q -- '--help-all' all || failed "$verb --help-all is not all"
    expect 0 help $verb --help-all
    cmp -s out all || failed "help $verb --help-all differs from $verb --help-all"
done
rm all

# help of a verb mentions all its options, and fits its width
for verb in render inspect compare version help; do
    expect 0 $verb --help
    cp out help.$verb
    expect 0 help $verb
    cmp -s out help.$verb || failed "help $verb differs from $verb --help"
    [ "$(awk '{ if (length($0) > w) w = length($0) } END { print w }' out)" -le 104 ] || failed "help $verb is wide"
    rm help.$verb
done
"$facet" --generate-completion bash | awk '/^    render\)/, /^        ;;/' | grep -oE -- '--[a-z0-9-]+' | sort -u >names
[ "$(wc -l <names)" -gt 30 ] || failed "few options in the completion"
expect 0 help render --help-all
while read -r name; do
    grep -qE -- "(^ .*)$name( |$)" out || failed "help render lacks $name"
done <names
COLUMNS=60 "$facet" help render --help-all >out
[ "$(sed -n '/^Image/,$p' out | awk '{ if (length($0) > w) w = length($0) } END { print w }')" -le 60 ] ||
    failed "help does not wrap to 60 columns"
finish
