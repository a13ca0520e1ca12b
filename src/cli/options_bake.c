/* options_bake.c - facet bake. See options_table.h. */
#include "cli/options_table.h"

static const option bake_output_options[] = {
    {.id = OPT_OUTPUT,
     .name = "output",
     .letter = 'o',
     .kind = OPTION_FILE,
     .argument = "FILE",
     .default_text =
         "the environment's name with .ktx2, in the current folder, unless another output is named",
     .help =
         "the filtered cube map: .ktx2 with all levels; .exr .hdr .pfm, or .png with --rgbm, a picture for "
         "each level ({level} and {face} in the name become their number and px, nx, ..); with --dfg the "
         "table; with --layout a folder; - is standard output"},
    {.id = OPT_DIFFUSE,
     .name = "diffuse",
     .kind = OPTION_FILE,
     .argument = "FILE",
     .help = "also the irradiance divided by pi, a cube map of 64 texels, one level"},
    {.id = OPT_SHEEN,
     .name = "sheen",
     .kind = OPTION_FILE,
     .argument = "FILE",
     .help = "also the cube map for sheen (Charlie), as large as the main one"},
    {.id = OPT_SH,
     .name = "sh",
     .kind = OPTION_FILE,
     .argument = "FILE",
     .help = "also nine spherical harmonics: .json, .h for C, .txt as Filament's cmgen writes them"},
    {.id = OPT_PREVIEW,
     .name = "preview",
     .kind = OPTION_FILE,
     .argument = "FILE",
     .help = "also a sheet to look at (.png .jpg .webp): levels, spheres lit by them beside the reference"},
    {.id = OPT_LAYOUT,
     .name = "layout",
     .kind = OPTION_CHOICE,
     .argument = "ENGINE",
     .help = "fill the folder of -o with the files that this engine loads, by its names and conventions",
     .choices = WORDS("filament", "khronos", "three")},
    {.id = OPT_NO_CLOBBER,
     .name = "no-clobber",
     .kind = OPTION_FLAG,
     .help = "keep files that exist already, and say so (exit 0)"},
    {.id = OPT_FORMAT,
     .name = "format",
     .kind = OPTION_CHOICE,
     .argument = "FORMAT",
     .default_text = "by the name of the output; rgba16f in .ktx2 (tables: rg16f)",
     .help =
         "of the file, or of the texels of .ktx2; exr is half, exr32 full float; png of tables has 16 bits, "
         "linear; h is an array in C",
     .choices = WORDS("rgba16f", "rgb9e5", "b10g11r11", "rgba32f", "rg16f", "rg32f", "r16f", "r32f", "ktx2",
                      "exr", "exr32", "hdr", "pfm", "png", "h")},
    {.id = OPT_ZSTD,
     .name = "zstd",
     .kind = OPTION_INTEGER,
     .argument = "LEVEL",
     .default_text = "0",
     .help = "compress .ktx2 without loss, 1 (fast) to 19 (small); 0: not, which every program reads",
     .minimum = 0,
     .maximum = 19},
    {.id = OPT_PROJECTION,
     .name = "projection",
     .kind = OPTION_CHOICE,
     .argument = "HOW",
     .default_text = "equirect; faces where the name has {face}",
     .help = "how a picture holds the cube map",
     .choices = WORDS("equirect", "cross-horizontal", "cross-vertical", "strip-horizontal", "strip-vertical",
                      "octahedral", "faces")},
    {.id = OPT_LEVEL,
     .name = "level",
     .kind = OPTION_INTEGER,
     .argument = "N",
     .default_text = "all",
     .help = "write only this level, from 0, as pictures",
     .minimum = 0,
     .maximum = 13},
    {.id = OPT_RGBM,
     .name = "rgbm",
     .kind = OPTION_NUMBER,
     .argument = "RANGE",
     .help =
         "write .png as RGBM: radiance = RGB alpha RANGE, all linear; what is brighter than RANGE is cut off",
     .minimum = 1e-3,
     .maximum = 65536},
    {.id = OPT_TONE_MAPPING,
     .name = "tone-mapping",
     .kind = OPTION_CHOICE,
     .argument = "OPERATOR",
     .default_text = "neutral",
     .help = "of the sheet of --preview",
     .choices =
         WORDS("neutral", "aces", "aces-narkowicz", "agx", "reinhard", "reinhard-extended", "hable", "none")},
};

static const option bake_filter_options[] = {
    {.id = OPT_SIZE,
     .name = "size",
     .letter = 's',
     .kind = OPTION_INTEGER,
     .argument = "N",
     .default_text = "256; tables 128",
     .help = "texels along an edge of the largest level, a power of two up to 8192; tables: 16 to 1024",
     .minimum = 1,
     .maximum = 8192},
    {.id = OPT_MIPS,
     .name = "mips",
     .kind = OPTION_INTEGER,
     .argument = "N",
     .default_text = "down to 16 texels (8 for --layout three), but five where there are as many",
     .help = "number of levels, each half as large as the one before",
     .minimum = 1,
     .maximum = 14},
    {.id = OPT_MAPPING,
     .name = "mapping",
     .kind = OPTION_CHOICE,
     .argument = "HOW",
     .default_text = "linear; filament for --layout filament and three",
     .help =
         "which perceptual roughness r a level k of n is for: linear: k = (n - 1) r; filament: k = (n - 1) r "
         "(2 - r)",
     .choices = WORDS("linear", "filament")},
    {.id = OPT_LOBE,
     .name = "lobe",
     .kind = OPTION_CHOICE,
     .argument = "LOBE",
     .default_text = "ggx",
     .help = "of the main cube map: ggx (reflections), charlie (sheen), lambert (irradiance / pi), none (the "
             "environment itself)",
     .choices = WORDS("ggx", "charlie", "lambert", "none")},
    {.id = OPT_METHOD,
     .name = "method",
     .kind = OPTION_CHOICE,
     .argument = "HOW",
     .default_text = "auto",
     .help =
         "auto: spherical harmonics where the lobe is wide, filtered samples where it is narrow; sampling: "
         "samples alone; reference: every texel of the environment weighted, which takes long",
     .choices = WORDS("auto", "sampling", "reference")},
    {.id = OPT_REFERENCE, .name = "reference", .kind = OPTION_FLAG, .help = "short for --method reference"},
    {.id = OPT_SAMPLES,
     .name = "samples",
     .letter = 'n',
     .kind = OPTION_INTEGER,
     .argument = "N",
     .default_text = "1024",
     .help = "for each texel, where samples are taken",
     .minimum = 1,
     .maximum = 1048576},
    {.id = OPT_QUICK,
     .name = "quick",
     .kind = OPTION_FLAG,
     .help = "for a first look: --size 128 --samples 64, where these are not given"},
    {.id = OPT_VERIFY,
     .name = "verify",
     .kind = OPTION_FLAG,
     .help =
         "measure each level against the reference: RMS and largest error, relative to the reference's RMS, "
         "and the energy kept"},
    {.id = OPT_MAX_ERROR,
     .name = "max-error",
     .kind = OPTION_NUMBER,
     .argument = "E",
     .help = "--verify, and exit code 1, after writing, where the RMS error of a level is larger",
     .minimum = 0,
     .maximum = 1e9},
};

static const option bake_environment_options[] = {
    {.id = OPT_INPUT_LAYOUT,
     .name = "input-layout",
     .kind = OPTION_CHOICE,
     .argument = "HOW",
     .default_text = "auto: by the ratio of the edges",
     .help = "how the picture holds the environment",
     .choices = WORDS("auto", "equirect", "cross-horizontal", "cross-vertical", "strip-horizontal",
                      "strip-vertical", "octahedral")},
    {.id = OPT_ROTATION,
     .name = "rotation",
     .kind = OPTION_TEXT,
     .argument = "DEG",
     .default_text = "0",
     .help =
         "turn the environment around the vertical axis, from +Z towards +X, as --env-rotation of render"},
    {.id = OPT_EXPOSURE,
     .name = "exposure",
     .kind = OPTION_TEXT,
     .argument = "EV",
     .default_text = "0",
     .help = "stops; 2x is a factor. Scales everything that is written"},
    {.id = OPT_CLAMP,
     .name = "clamp",
     .kind = OPTION_NUMBER,
     .argument = "X",
     .help = "cut off radiance above X, before --exposure; how much light that takes is said",
     .minimum = 1e-6,
     .maximum = 1e12},
    {.id = OPT_SH_WINDOW,
     .name = "sh-window",
     .kind = OPTION_CHOICE,
     .argument = "HOW",
     .default_text = "none; auto for --layout filament",
     .help = "of --sh: auto damps the harmonics until no direction gets less than no light (around a sun)",
     .choices = WORDS("none", "auto")},
};

static const option bake_table_options[] = {
    {.id = OPT_DFG,
     .name = "dfg",
     .kind = OPTION_FLAG,
     .help = "bake the table of reflectance of split-sum light instead; it needs no environment"},
    {.id = OPT_DISTRIBUTION,
     .name = "distribution",
     .kind = OPTION_CHOICE,
     .argument = "KIND",
     .default_text = "ggx",
     .help =
         "of --dfg. ggx or correlated: scale and bias of F0, height-correlated Smith; schlick: Karis' "
         "masking; "
         "multiscatter: for energy compensation; charlie: albedo of sheen, charlie-neubelt with Neubelt's "
         "masking; average: albedo of GGX over the cosine; filament: multiscatter and charlie-neubelt",
     .choices = WORDS("ggx", "correlated", "schlick", "multiscatter", "charlie", "charlie-neubelt", "average",
                      "filament")},
};

static const option_group bake_output_group = {"Output", bake_output_options, COUNT(bake_output_options)};
static const option_group bake_filter_group = {"Filtering", bake_filter_options, COUNT(bake_filter_options)};
static const option_group bake_environment_group = {"Environment", bake_environment_options,
                                                    COUNT(bake_environment_options)};
static const option_group bake_table_group = {"Tables", bake_table_options, COUNT(bake_table_options)};

const verb bake_verb = {
    .name = "bake",
    .summary = "filter an environment for real-time renderers: cube maps, irradiance, tables",
    .arguments = "ENVIRONMENT",
    .max_arguments = 6,
    .file_types = "hdr exr ktx2 png jpg jpeg pfm webp avif tga bmp gif dds",
    .output_types = "ktx2 exr hdr pfm png json h txt html raw",
    .words = WORDS("neutral", "white", "sun:40,135", "preetham:40,135", "gradient:"),
    .description =
        "ENVIRONMENT is a picture (.hdr .exr .pfm .ktx2 .png .jpg .webp .avif .tga .bmp .gif .dds): "
        "equirectangular, a cross or strip of faces, or a KTX2 cube map; or six pictures, the faces +X -X +Y "
        "-Y +Z -Z; or one that needs no "
        "file: "
        "neutral (the built-in studio), white, #rrggbb, gradient:ZENITH,HORIZON[,NADIR], "
        "sun:ELEVATION[,AZIMUTH] or preetham:ELEVATION[,AZIMUTH], in degrees, for a clear sky "
        "(environments.md of facet help documents). - is standard input.\n\n"
        "The result is what image based lighting looks up: for each perceptual roughness a level of a cube "
        "map, the "
        "environment weighted with the lobe of GGX for a view along the normal (the split sum of Karis "
        "2013). All "
        "levels are in one KTX2 file. Texels are linear Rec.709 radiance; what is at which direction, and "
        "which "
        "engine wants what, is in bake.md (facet help documents).\n\n"
        "three.js: -o FOLDER --layout three writes environment.hdr, which HDRLoader reads and "
        "scene.environment "
        "takes, and pmrem.ktx2, what PMREMGenerator would make of it (r187 or later): load it with "
        "KTX2Loader, make a "
        "CompressedCubeTexture of its six faces with isPMREMTexture = true, and give it to "
        "scene.environment; "
        "bake.md has the ten lines. MeshStandardMaterial does the rest.\n\n"
        "Texels of the input that are not a number, infinite or less than 0 are repaired and counted in a "
        "warning. "
        "The bytes do not depend on the number of threads. Every output is computed before the first one is "
        "written, and appears whole or not at all.",
    .examples =
        (const example[]){
            {"facet bake studio.hdr -o studio.ktx2", "reflections: prefiltered GGX, all levels, one file"},
            {"facet bake studio.hdr -o studio.ktx2 --diffuse studio_diffuse.ktx2 --sh studio_sh.json",
             "diffuse light beside them"},
            {"facet bake studio.hdr -o studio --layout three",
             "for three.js: new HDRLoader().load('studio/environment.hdr', t => { t.mapping = "
             "EquirectangularReflectionMapping; scene.environment = t; }); studio/pmrem.ktx2 is the same "
             "already "
             "filtered (r187 or later; bake.md has its loader)"},
            {"facet bake studio.hdr -o studio.ktx2 --preview sheet.png --verify", "and how good that is"},
            {"facet bake sun:40,135 -o sky.ktx2 --format rgb9e5 --zstd 9", "a clear sky, in a small file"},
            {"facet bake px.hdr nx.hdr py.hdr ny.hdr pz.hdr nz.hdr -o room.ktx2", "from six faces"},
            {"facet bake studio.hdr -o 'm{level}_{face}.hdr'", "a picture for each level and face"},
            {"facet bake studio.hdr -o studio/ --layout filament",
             "studio/studio_ibl.ktx, studio_skybox.ktx, sh.txt: what cmgen -x studio -f ktx writes"},
            {"facet bake --dfg -o dfg.ktx2", "the table for split-sum light"},
            {NULL, NULL}},
    .basics = (const option_id[]){OPT_OUTPUT, OPT_FORMAT, OPT_LAYOUT, OPT_SIZE, OPT_LOBE, OPT_DIFFUSE, OPT_SH,
                                  OPT_DFG, OPT_ROTATION, OPT_EXPOSURE, OPT_PREVIEW, OPT_VERIFY, OPT_JSON,
                                  OPTION_ID_COUNT},
    .groups = (const option_group *const[]){&bake_output_group, &bake_filter_group, &bake_environment_group,
                                            &bake_table_group, &working_group, &machine_group, &message_group,
                                            NULL},
};
