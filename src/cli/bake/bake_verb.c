/* bake_verb.c - facet bake: its arguments, options and help. */
#include "cli/shared/commands.h"

const verb bake_verb = {
    .name = "bake",
    .summary = "filter an environment for real-time renderers: cube maps, irradiance, tables",
    .arguments = "ENVIRONMENT",
    .max_arguments = 6,
    .file_types = "hdr exr ktx2 png jpg jpeg pfm webp avif tga bmp gif dds",
    .output_types = "ktx2 exr hdr pfm png json h txt html raw",
    .words = OPTION_WORDS("neutral", "white", "sun:40,135", "preetham:40,135", "gradient:"),
    .description =
        "ENVIRONMENT is a picture (.hdr .exr .pfm .ktx2 .png .jpg .webp .avif .tga .bmp .gif .dds): "
        "equirectangular, a cross or strip of faces, or a KTX2 cube map; or six pictures, the faces "
        "+X -X +Y -Y +Z -Z; or one that needs no file: neutral (the built-in studio), white, "
        "#rrggbb, gradient:ZENITH,HORIZON[,NADIR], sun:ELEVATION[,AZIMUTH] or "
        "preetham:ELEVATION[,AZIMUTH], in degrees, for a clear sky (environments.md of facet help "
        "documents). - is standard input.\n\n"
        "The result is what image based lighting looks up: for each perceptual roughness a level of "
        "a cube map, the environment weighted with the lobe of GGX for a view along the normal (the "
        "split sum of Karis 2013). All levels are in one KTX2 file. Texels are linear Rec.709 "
        "radiance; what is at which direction, and which engine wants what, is in bake.md (facet "
        "help documents).\n\n"
        "three.js: -o FOLDER --layout three writes environment.hdr, which HDRLoader reads and "
        "scene.environment takes, and pmrem.ktx2, what PMREMGenerator would make of it (r187 or "
        "later): load it with KTX2Loader, make a CompressedCubeTexture of its six faces with "
        "isPMREMTexture = true, and give it to scene.environment; bake.md has the ten lines. "
        "MeshStandardMaterial does the rest.\n\n"
        "Texels of the input that are not a number, infinite or less than 0 are repaired and counted "
        "in a warning. The bytes do not depend on the number of threads. Every output is computed "
        "before the first one is written, and appears whole or not at all.",
    .examples =
        (const example[]){
            {"facet bake studio.hdr -o studio.ktx2", "reflections: prefiltered GGX, all levels, one file"},
            {"facet bake studio.hdr -o studio.ktx2 --diffuse studio_diffuse.ktx2 --sh studio_sh.json",
             "diffuse light beside them"},
            {"facet bake studio.hdr -o studio --layout three",
             "for three.js: new HDRLoader().load('studio/environment.hdr', t => { t.mapping = "
             "EquirectangularReflectionMapping; scene.environment = t; }); studio/pmrem.ktx2 is the same "
             "already filtered (r187 or later; bake.md has its loader)"},
            {"facet bake studio.hdr -o studio.ktx2 --preview sheet.png --verify", "and how good that is"},
            {"facet bake sun:40,135 -o sky.ktx2 --format rgb9e5 --zstd 9", "a clear sky, in a small file"},
            {"facet bake px.hdr nx.hdr py.hdr ny.hdr pz.hdr nz.hdr -o room.ktx2", "from six faces"},
            {"facet bake studio.hdr -o 'm{level}_{face}.hdr'", "a picture for each level and face"},
            {"facet bake studio.hdr -o studio/ --layout filament",
             "studio/studio_ibl.ktx, studio_skybox.ktx, sh.txt: what cmgen -x studio -f ktx writes"},
            {"facet bake --dfg -o dfg.ktx2", "the table for split-sum light"},
            {NULL, NULL}},
    .basics = OPTION_IDS(OPT_OUTPUT, OPT_FORMAT, OPT_LAYOUT, OPT_SIZE, OPT_LOBE, OPT_DIFFUSE, OPT_SH, OPT_DFG,
                         OPT_ROTATION, OPT_EXPOSURE, OPT_PREVIEW, OPT_VERIFY, OPT_JSON),
    .groups =
        (const option_group *const[]){
            OPTION_GROUP("Output", OPT_OUTPUT, OPT_DIFFUSE, OPT_SHEEN, OPT_SH, OPT_PREVIEW, OPT_LAYOUT,
                         OPT_NO_CLOBBER, OPT_FORMAT, OPT_ZSTD, OPT_PROJECTION, OPT_LEVEL, OPT_RGBM,
                         OPT_TONE_MAPPING),
            OPTION_GROUP("Filtering", OPT_SIZE, OPT_MIPS, OPT_MAPPING, OPT_LOBE, OPT_METHOD, OPT_REFERENCE,
                         OPT_SAMPLES, OPT_QUICK, OPT_VERIFY, OPT_MAX_ERROR),
            OPTION_GROUP("Environment", OPT_INPUT_LAYOUT, OPT_ROTATION, OPT_EXPOSURE, OPT_CLAMP,
                         OPT_SH_WINDOW),
            OPTION_GROUP("Tables", OPT_DFG, OPT_DISTRIBUTION),
            OPTION_GROUP("Running", OPT_PROGRESS, OPT_CONFIG), &limits_group, &messages_group, NULL},
};
