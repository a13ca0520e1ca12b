/* ocean_verb.c - facet ocean: its arguments, options and help. */
#include "cli/shared/commands.h"

const verb ocean_verb = {
    .name = "ocean",
    .summary = "draw the sea, or write it as maps and meshes",
    .arguments = "",
    .output_types = "png jpg jpeg webp exr hdr pfm y4m glb gltf obj",
    .description =
        "Draws a sea by what is known of seas: waves by wind and fetch, water by what is in it, "
        "under a sky or an environment, exposed as a light meter has it. --preset begins with a sea "
        "that has a name; all other options change it. Directions are degrees from +Z towards +X, "
        "and for wind and waves where they go to.\n\n"
        "With .glb, .gltf or .obj as output the surface is written as a mesh with the water's "
        "material; with --maps the tiles of waves, for programs that draw by themselves; with --info "
        "or --json what is known of the sea is printed.",
    .examples =
        (const example[]){
            {"facet ocean -o sea.png", "a fresh breeze, the sun at the right"},
            {"facet ocean --preset gale --sun 12 -o gale.jpg --size 1920x1080", "a gale at low sun"},
            {"facet ocean --preset lagoon --height-of-eye 20 -o lagoon.png", "sand below clear water"},
            {"facet ocean --wind 7,45 --swell 2,12,90 --chl 1 -o 'sea_####.png' --loop 24", "a loop of 24 s"},
            {"facet ocean --before-after -o compare.png", "before and now"},
            {"facet ocean --sweep roughness=0.01:0.1:5,ior=1.3:1.4:5 -s 320x180 -o sweep.png",
             "a sheet of 25"},
            {"facet ocean --preset harbour --info", "heights, periods, colors"},
            {"facet ocean --wind 8 -o sea.glb --maps maps", "a mesh, and maps in a folder that exists"},
            {NULL, NULL}},
    .basics = OPTION_IDS(OPT_OUTPUT, OPT_SIZE, OPT_PRESET, OPT_WIND, OPT_WATER, OPT_DEPTH, OPT_SUN,
                         OPT_HEADING, OPT_EYE_HEIGHT, OPT_FRAMES, OPT_LOOP, OPT_EXPOSURE, OPT_RENDERER,
                         OPT_WITH, OPT_MAPS, OPT_JSON),
    .groups =
        (const option_group *const[]){
            OPTION_GROUP("Output", OPT_OUTPUT, OPT_NO_CLOBBER, OPT_FORMAT, OPT_SIZE, OPT_CROP, OPT_INFO,
                         OPT_MAPS, OPT_MESH_SIZE, OPT_MESH_SAMPLES, OPT_JPEG_QUALITY),
            OPTION_GROUP("Waves", OPT_PRESET, OPT_WIND, OPT_FETCH, OPT_SWELL, OPT_SPECTRUM, OPT_SPREADING,
                         OPT_CHOPPINESS, OPT_SEED, OPT_TILE_SAMPLES, OPT_CASCADES),
            OPTION_GROUP("Water and bed", OPT_WATER, OPT_CHLOROPHYLL, OPT_ABSORPTION, OPT_SALINITY,
                         OPT_TEMPERATURE, OPT_IOR, OPT_DEPTH, OPT_BED_SLOPE, OPT_BED_COLOR),
            OPTION_GROUP("Light and exposure", OPT_SUN, OPT_TURBIDITY, OPT_ENV, OPT_EXPOSURE, OPT_EV100,
                         OPT_TONE_MAPPING),
            &environment_group,
            OPTION_GROUP("Camera", OPT_EYE_HEIGHT, OPT_HEADING, OPT_EYE, OPT_TARGET, OPT_FOV),
            OPTION_GROUP("Look", OPT_BEFORE, OPT_BEFORE_AFTER, OPT_STAGE, OPT_ROUGHNESS, OPT_NORMALS,
                         OPT_MASKING, OPT_FRESNEL, OPT_NO_GLINTS, OPT_NO_FOAM, OPT_NO_CAUSTICS, OPT_CLAMP,
                         OPT_SWEEP, OPT_WITH),
            OPTION_GROUP("Quality", OPT_QUALITY, OPT_SAMPLES, OPT_RENDERER, OPT_DENOISE),
            OPTION_GROUP("Motion", OPT_TIME, OPT_FRAMES, OPT_FPS, OPT_LOOP), &limits_group, &messages_group,
            OPTION_GROUP("Running", OPT_PROGRESS, OPT_CONFIG), NULL},
};
