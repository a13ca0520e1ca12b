/* options_convert.c - facet convert. See options_table.h. */
#include "cli/options_table.h"

static const option convert_options[] = {
    {.id = OPT_OUTPUT,
     .name = "output",
     .letter = 'o',
     .kind = OPTION_FILE,
     .argument = "FILE",
     .help =
         "the new model, instead of a second name: .glb; .gltf with a .bin and the images beside it; .obj "
         "with a .mtl; .json, rgl's parameters. With {stem}, {name}, {dir} or {index}, as facet render has "
         "them, "
         "several models or a folder can be given"},
    {.id = OPT_NO_CLOBBER,
     .name = "no-clobber",
     .kind = OPTION_FLAG,
     .help = "keep a file that exists already, and say so (exit 0)"},
    {.id = OPT_TO,
     .name = "to",
     .kind = OPTION_CHOICE,
     .argument = "FORMAT",
     .default_text = "by the name of the output",
     .help = "what the output must be, checked against its name; mtl is obj, ogl1 is json",
     .choices = WORDS("glb", "gltf", "obj", "mtl", "ogl1")},
    {.id = OPT_MATERIALS,
     .name = "materials",
     .kind = OPTION_CHOICE,
     .argument = "MODEL",
     .default_text = "keep",
     .help = "keep: as they are (those of OBJ become metallic-roughness in glTF); specular-glossiness is "
             "KHR_materials_pbrSpecularGlossiness",
     .choices = WORDS("keep", "metallic-roughness", "specular-glossiness")},
    {.id = OPT_KEEP_SOURCES,
     .name = "keep-sources",
     .kind = OPTION_FLAG,
     .help = "pictures that only the old materials read stay in the file, for the way back"},
};

static const option to_legacy_options[] = {
    {.id = OPT_MTL_PBR,
     .name = "mtl-pbr",
     .kind = OPTION_CHOICE,
     .argument = "HOW",
     .default_text = "keep",
     .help =
         "keep: Pr, Pm and the other statements of MTL's PBR extension, and the glTF material as a comment, "
         "are written beside the old ones; none: they are not",
     .choices = WORDS("keep", "none")},
    {.id = OPT_MTL_SHININESS_SCALE,
     .name = "mtl-shininess-scale",
     .kind = OPTION_NUMBER,
     .argument = "X",
     .default_text = "1",
     .help = "factor for Ns: for programs that expect more than OpenGL's 128",
     .minimum = 0.001,
     .maximum = 1000},
    {.id = OPT_BAKE_OCCLUSION,
     .name = "bake-occlusion",
     .kind = OPTION_FLAG,
     .help = "the occlusion texture darkens the diffuse one"},
    {.id = OPT_REFIT,
     .name = "refit",
     .kind = OPTION_FLAG,
     .help = "fit anew where the old values are known from an earlier conversion"},
};

static const option report_options[] = {
    {.id = OPT_REPORT,
     .name = "report",
     .kind = OPTION_FILE,
     .argument = "FILE",
     .help =
         "what became of each material: values, errors, warnings; .json, or .html with pictures. {stem} as "
         "for --output"},
    {.id = OPT_MAX_ERROR,
     .name = "max-error",
     .kind = OPTION_NUMBER,
     .argument = "E",
     .help = "exit code 1, after writing, where the graded error of a material is larger (below 0.05 is "
             "good, above 0.3 is "
             "bad): as drawn where the fit's target is, else on a screen",
     .minimum = 0,
     .maximum = 1e9},
};

static const option_group convert_group = {"Output", convert_options, COUNT(convert_options)};
static const option_group to_legacy_group = {"To OBJ and rgl", to_legacy_options, COUNT(to_legacy_options)};
static const option_group report_group = {"Report", report_options, COUNT(report_options)};

const verb convert_verb = {
    .name = "convert",
    .summary = "write a model in another form: glTF, OBJ, rgl's parameters",
    .arguments = "MODEL NEW",
    .max_arguments = SIZE_MAX,
    .file_types = "glb gltf obj stl ply json",
    .output_types = "glb gltf obj json",
    .description =
        "Reads MODEL (.glb, .gltf, .obj with its .mtl, .stl, .ply, .json of rgl's parameters; - is standard "
        "input) and "
        "writes it as NEW (.glb, .gltf, .obj, .json).\n\n"
        "From glTF to glTF: meshes, materials with all their extensions, textures as they are, motion, "
        "cameras, "
        "lights, variants, metadata. What was compressed (Draco, meshopt, quantised) is written plainly.\n\n"
        "Materials of OpenGL 1 (MTL, rgl: ambient, diffuse, specular, shininess) become physically based "
        "ones "
        "and back, and facet says how near they come: E is the relative error of light over views and lights "
        "(legacy.md of facet help documents).\n\n"
        "The output appears whole or not at all; the files beside it come first.",
    .examples = (const example[]){{"facet convert scene.gltf scene.glb", "many files into one"},
                                  {"facet convert scene.glb scene.gltf", "to look at the JSON"},
                                  {"facet convert packed.glb plain.glb", "for a program that reads no Draco"},
                                  {"facet convert old.obj new.glb --report report.html",
                                   "old materials to new ones, and how well that went"},
                                  {"facet convert old.obj new.glb --method fit --profile core",
                                   "for viewers that know no extensions"},
                                  {"facet convert models/ -o 'new/{dir}/{stem}.glb' --max-error 0.3",
                                   "all in a folder and below it"},
                                  {"facet convert new.glb old.obj", "the way back"},
                                  {"facet convert scene.glb scene.json", "parameters for R's rgl"},
                                  {"facet convert specgloss.glb new.glb --materials metallic-roughness",
                                   "for viewers that dropped the old extension"},
                                  {NULL, NULL}},
    .basics = (const option_id[]){OPT_OUTPUT, OPT_MATERIALS, OPT_METHOD, OPT_PROFILE, OPT_GLASS, OPT_MIRRORS,
                                  OPT_FLIP_TEXTURES, OPT_REPORT, OPT_MAX_ERROR, OPT_FILES_FROM,
                                  OPT_NO_CLOBBER, OPT_JSON, OPT_STRICT, OPTION_ID_COUNT},
    .groups = (const option_group *const[]){&convert_group, &legacy_group, &to_legacy_group, &report_group,
                                            &model_group, &machine_group, &message_group, NULL},
};
