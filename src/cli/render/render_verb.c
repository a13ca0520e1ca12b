/* render_verb.c - the options and the help of facet render. */
#include "cli/shared/options.h"

const verb render_verb = {
    .name = "render",
    .summary = "render a model to an image",
    .arguments = "[MODEL|FOLDER...]",
    .max_arguments = SIZE_MAX,
    .file_types = "glb gltf obj stl ply json",
    .output_types = "png png16 jpg jpeg webp exr hdr pfm y4m",
#ifndef FACET_WITHOUT_HELP
    .description =
        "Reads each MODEL (.glb, .gltf, .obj with its .mtl, .stl, .ply, .json of rgl's parameters; - "
        "is standard input) and renders it on the CPU, or with --renderer gl on a GPU; no GPU, "
        "display or network is needed. The whole model is in the image unless --orbit, --eye or "
        "--camera say otherwise. A FOLDER stands for the models in it and below it. Without a MODEL "
        "the built-in scene is rendered.\n\n"
        "The output appears whole or not at all. The same command gives the same bytes for every "
        "number of threads.",
    .examples =
        (const example[]){
            {"facet render helmet.glb -o helmet.png", "the whole model, on white"},
            {"facet render helmet.glb -o helmet.png --size 1920x1080 --env studio.hdr --background "
             "transparent",
             "larger, under another environment, for compositing"},
            {"facet render shoe.glb -o shoe.png --orbit 30,75,105% --exposure +0.5 --tone-mapping agx",
             "from the right, a little brighter"},
            {"facet render scene.gltf -o beauty.exr --aov depth,normal --camera Hero",
             "linear radiance and layers, from a camera of the file"},
            {"facet render shoe.glb -o 'turn_####.png' --turntable 72", "once around the model"},
            {"facet render walk.glb -o 'walk_####.png' --animation Walk", "the frames of an animation"},
            {"facet render fox.glb -o - --format y4m --animation Run | ffmpeg -i - -pix_fmt yuv420p fox.mp4",
             "a video; with --turntable 120 seen from all around"},
            {"facet render *.glb -o 'thumbs/{stem}.png' --preset thumbnail", "thumbnails of many models"},
            {"facet render shoe.glb -o shoe.png --preset product", "large, with its shadow"},
            {"facet render models/ -o 'thumbs/{dir}/{stem}.png' --size 256",
             "all models in a folder and below it, in the same folders"},
            {"facet render ring.glb -o ring.png --renderer path --samples 256 --ground shadow --denoise",
             "path traced, with its shadow"},
            {"facet render shoe.glb -o 'turn_####.png' --turntable 360 --renderer gl",
             "the same images, on a GPU"},
            {"facet render old.obj -o old.png --shading ogl1", "as an OpenGL 1 program rendered it"},
            {"facet render huge.glb -o part_03.exr --size 32768x16384 --shard 3/40",
             "part 3 of 40 of one image, for facet merge; of a sequence --shard takes frames"},
            {"curl -sL URL | facet render - -o - --format png > out.png", "without files"},
            {NULL, NULL}},
#endif
    .basics = OPTION_IDS(OPT_OUTPUT, OPT_SIZE, OPT_BACKGROUND, OPT_ORBIT, OPT_CAMERA, OPT_TURNTABLE,
                         OPT_ANIMATION, OPT_ENV, OPT_SUN, OPT_EXPOSURE, OPT_TONE_MAPPING, OPT_RENDERER,
                         OPT_SAMPLES, OPT_DENOISE, OPT_GROUND, OPT_TIME_LIMIT, OPT_JSON),
    .groups =
        (const option_group *const[]){
            OPTION_GROUP("Image", OPT_OUTPUT, OPT_NO_CLOBBER, OPT_FORMAT, OPT_SIZE, OPT_BACKGROUND,
                         OPT_BACKGROUND_BLUR, OPT_CROP, OPT_AOV, OPT_JPEG_QUALITY, OPT_PNG_COMPRESSION,
                         OPT_TAG),
            OPTION_GROUP("Camera", OPT_ORBIT, OPT_TARGET, OPT_FOV, OPT_EYE, OPT_UP, OPT_ORTHO, OPT_FRAMING,
                         OPT_CAMERA, OPT_TURNTABLE, OPT_CAMERA_MATRIX, OPT_VIEW_MATRIX),
            &light_group, &environment_group, &color_group, &quality_group,
            OPTION_GROUP("Preview (--renderer preview)", OPT_AO),
            OPTION_GROUP("Path tracing (--renderer path)", PATH_OPTIONS, OPT_CHECKPOINT, OPT_RESUME),
            &gl_group, &shading_group, OPTION_GROUP("Motion", OPT_ANIMATION, OPT_TIME, OPT_FRAMES, OPT_FPS),
            &scene_group, &files_group, &legacy_group, &limits_group, &messages_group,
            OPTION_GROUP("Several machines", OPT_SHARD, OPT_SHARD_BY),
            OPTION_GROUP("Running", OPT_PROGRESS, OPT_CONFIG, OPT_PRESET), NULL},
};
