/* options_plot.c - facet plot. See options_table.h. */
#include "cli/options_table.h"

#include "facet/facet.h"

static const option plot_options[] = {
    {.id = OPT_OUTPUT,
     .name = "output",
     .letter = 'o',
     .kind = OPTION_FILE,
     .argument = "FILE",
     .default_text = "the kind with .svg, in the current folder",
     .help = "the plot: .svg .pdf .png, or .csv for its numbers; - for standard output"},
    {.id = OPT_NO_CLOBBER,
     .name = "no-clobber",
     .kind = OPTION_FLAG,
     .help = "keep a file that exists already, and say so (exit 0)"},
    {.id = OPT_FORMAT,
     .name = "format",
     .kind = OPTION_CHOICE,
     .argument = "FORMAT",
     .default_text = "by the name of the output",
     .help = "csv has the numbers that the others draw",
     .choices = WORDS("svg", "pdf", "png", "csv")},
    {.id = OPT_SIZE,
     .name = "size",
     .letter = 's',
     .kind = OPTION_TEXT,
     .argument = "WxH",
     .default_text = "what suits the kind",
     .help = "width and height in pixels (svg, pdf: 96 to the inch)"},
    {.id = OPT_TITLE,
     .name = "title",
     .kind = OPTION_TEXT,
     .argument = "TEXT",
     .help = "another title; '' for none"},
    {.id = OPT_DARK, .name = "dark", .kind = OPTION_FLAG, .help = "light lines on dark"},
    {.id = OPT_LOG, .name = "log", .kind = OPTION_FLAG, .help = "a logarithmic axis of values"},
};

static const option material_options[] = {
    {.id = OPT_ROUGHNESS,
     .name = "roughness",
     .kind = OPTION_TEXT,
     .argument = "LIST",
     .help = "materials of these perceptual roughnesses, as 0.1,0.3,0.6"},
    {.id = OPT_METALLIC,
     .name = "metallic",
     .kind = OPTION_NUMBER,
     .argument = "X",
     .default_text = "0",
     .help = "of the materials of --roughness",
     .minimum = 0,
     .maximum = 1},
    {.id = OPT_BASE_COLOR,
     .name = "base-color",
     .kind = OPTION_TEXT,
     .argument = "COLOR",
     .default_text = "white",
     .help = "of the materials of --roughness: #rrggbb or a CSS name"},
    {.id = OPT_ANGLE,
     .name = "angle",
     .kind = OPTION_TEXT,
     .argument = "LIST",
     .default_text = "30, or what suits the kind",
     .help = "of the view from the normal in degrees: 30 or 0,30,60"},
    {.id = OPT_FIT,
     .name = "fit",
     .kind = OPTION_FLAG,
     .help = "beside each material its best fit by the other model, whose parameters and error are printed"},
    {.id = OPT_SCALE,
     .name = "scale",
     .kind = OPTION_CHOICE,
     .argument = "SCALE",
     .default_text = "own",
     .help = "brdf: own: each lobe over its own peak; shared: all lobes on one scale",
     .choices = WORDS("own", "shared")},
    {.id = OPT_COSINE,
     .name = "cosine",
     .kind = OPTION_FLAG,
     .help = "BRDF times the cosine of the light, which is what one sees"},
    {.id = OPT_ENERGY,
     .name = "energy",
     .kind = OPTION_CHOICE,
     .argument = "MODE",
     .default_text = "gltf",
     .help = "gltf: the formulas of the specification; conserving: with light scattered several times",
     .choices = WORDS("gltf", "conserving")},
    {.id = OPT_SMITH,
     .name = "smith",
     .kind = OPTION_CHOICE,
     .argument = "FORM",
     .default_text = "correlated; separable for legacy",
     .help = "masking and shadowing: height-correlated, or independent of each other",
     .choices = WORDS("correlated", "separable")},
    {.id = OPT_HEAVISIDE,
     .name = "heaviside",
     .kind = OPTION_CHOICE,
     .argument = "FORM",
     .default_text = "step",
     .help = "legacy: step as glTF has it; ramp, max(x, 0), for the vignette's own curve",
     .choices = WORDS("step", "ramp")},
};

static const option_group plot_group = {"Plot", plot_options, COUNT(plot_options)};
static const option_group material_group = {"Materials and views", material_options, COUNT(material_options)};

const verb plot_verb = {
    .name = "plot",
    .summary = "draw reflectance as curves, lobes and tables",
    .arguments = "KIND [MATERIAL...]",
    .max_arguments = FACET_PLOT_MAX_MATERIALS + 1,
    .file_types = "glb gltf obj json binary",
    .output_types = "svg pdf png csv",
    .words = WORDS("legacy", "brdf", "slice", "hemisphere", "lobe", "terms", "albedo", "furnace", "dfg",
                   "tone", "fresnel", "error"),
    .description =
        "KIND is one of these:\n\n"
        "legacy: PBR and OpenGL 1 over the angle of the light, with the best fit and the difference\n\n"
        "brdf: lobes in the plane of incidence, as polar slices; slice: the same as curves over the angle of "
        "the light\n\n"
        "hemisphere: all directions of the light in false color; lobe: the same as a surface in space\n\n"
        "terms: D, V and F over their cosines; dfg: the tables of split-sum light\n\n"
        "albedo: what returns over the angle of the view; furnace: of light from everywhere, over "
        "roughness\n\n"
        "tone: the tone mapping operators; fresnel: water, glass, metals, exact beside Schlick's "
        "approximation\n\n"
        "error: how near PBR and OpenGL 1 come to each other, over roughness\n\n"
        "A MATERIAL is a list of parameters (roughness=0.3,metallic=1,color=gold; or "
        "ogl1,diffuse=#808080,specular=white,shininess=50), the name of a model alone or before them (ggx, "
        "pbr; "
        "blinn-phong, phong, ogl1: the highlight of OpenGL 1, which is Blinn's), a model file, optionally "
        "with #NAME of one of "
        "its "
        "materials, or a measured BRDF in MERL's format (.binary). Several are drawn over one another.\n\n"
        "Parameters are color, metallic, roughness, ior, specular, specular-color, clearcoat, "
        "clearcoat-roughness, sheen-color, sheen-roughness, anisotropy, anisotropy-rotation (degrees), "
        "iridescence, iridescence-ior, iridescence-thickness (nm); after ogl1, diffuse, specular, shininess. "
        "A "
        "color is #rrggbb or a CSS name, one linear number for a grey, or three as r/g/b; the others are "
        "those of "
        "glTF, mostly from 0 to 1.",
    .examples =
        (const example[]){
            {"facet plot legacy -o vignette.svg",
             "the plots of \"Shininess in OpenGL 1 versus glTF PBR\", and what they lack"},
            {"facet plot brdf --roughness 0.1,0.3,0.6 --angle 45 -o ggx.svg", "three lobes"},
            {"facet plot slice helmet.glb#Leather roughness=0.5 -o slice.pdf",
             "a material of a model beside another"},
            {"facet plot slice gold-paint.binary --fit -o gold.png", "a measured BRDF and a model of it"},
            {"facet plot legacy ogl1,diffuse=gray,shininess=20 --fit -o fit.svg",
             "an old material and its PBR"},
            {"facet plot tone -o tone.csv", "the numbers"},
            {NULL, NULL}},
    .basics = (const option_id[]){OPT_OUTPUT, OPT_FORMAT, OPT_ROUGHNESS, OPT_METALLIC, OPT_BASE_COLOR,
                                  OPT_ANGLE, OPT_FIT, OPT_LOG, OPT_ENERGY, OPT_SIZE, OPT_TITLE, OPT_DARK,
                                  OPT_JSON, OPTION_ID_COUNT},
    .groups =
        (const option_group *const[]){&plot_group, &material_group, &machine_group, &message_group, NULL},
};
