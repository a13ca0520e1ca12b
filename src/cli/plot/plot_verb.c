/* plot_verb.c - facet plot: its arguments, options and help. */
#include "cli/shared/commands.h"

const verb plot_verb = {
    .name = "plot",
    .summary = "draw reflectance as curves, lobes and tables",
    .arguments = "KIND [MATERIAL...]",
    .max_arguments = FACET_PLOT_MAX_MATERIALS + 1,
    .file_types = "glb gltf obj json binary",
    .output_types = "svg pdf png csv",
    .words = OPTION_WORDS("legacy", "brdf", "slice", "hemisphere", "lobe", "terms", "albedo", "furnace",
                          "dfg", "tone", "fresnel", "error"),
    .description =
        "KIND is one of these:\n\n"
        "legacy: PBR and OpenGL 1 over the angle of the light, with the best fit and the difference\n\n"
        "brdf: lobes in the plane of incidence, as polar slices; slice: the same as curves over the "
        "angle of the light\n\n"
        "hemisphere: all directions of the light in false color; lobe: the same as a surface in space\n\n"
        "terms: D, V and F over their cosines; dfg: the tables of split-sum light\n\n"
        "albedo: what returns over the angle of the view; furnace: of light from everywhere, over "
        "roughness\n\n"
        "tone: the tone mapping operators; fresnel: water, glass, metals, exact beside Schlick's "
        "approximation\n\n"
        "error: how near PBR and OpenGL 1 come to each other, over roughness\n\n"
        "A MATERIAL is a list of parameters (roughness=0.3,metallic=1,color=gold; or "
        "ogl1,diffuse=#808080,specular=white,shininess=50), the name of a model alone or before them "
        "(ggx, pbr; blinn-phong, phong, ogl1: the highlight of OpenGL 1, which is Blinn's), a model "
        "file, optionally with #NAME of one of its materials, or a measured BRDF in MERL's format "
        "(.binary). Several are drawn over one another.\n\n"
        "Parameters are color, metallic, roughness, ior, specular, specular-color, clearcoat, "
        "clearcoat-roughness, sheen-color, sheen-roughness, anisotropy, anisotropy-rotation "
        "(degrees), iridescence, iridescence-ior, iridescence-thickness (nm); after ogl1, diffuse, "
        "specular, shininess. A color is #rrggbb or a CSS name, one linear number for a grey, or "
        "three as r/g/b; the others are those of glTF, mostly from 0 to 1.",
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
    .basics = OPTION_IDS(OPT_OUTPUT, OPT_FORMAT, OPT_ROUGHNESS, OPT_METALLIC, OPT_BASE_COLOR, OPT_ANGLE,
                         OPT_FIT, OPT_LOG, OPT_ENERGY, OPT_SIZE, OPT_TITLE, OPT_DARK, OPT_JSON),
    .groups = (const option_group *const[]){OPTION_GROUP("Plot", OPT_OUTPUT, OPT_NO_CLOBBER, OPT_FORMAT,
                                                         OPT_SIZE, OPT_TITLE, OPT_DARK, OPT_LOG),
                                            OPTION_GROUP("Materials and views", OPT_ROUGHNESS, OPT_METALLIC,
                                                         OPT_BASE_COLOR, OPT_ANGLE, OPT_FIT, OPT_SCALE,
                                                         OPT_COSINE, OPT_ENERGY, OPT_SMITH, OPT_HEAVISIDE),
                                            &limits_group, &messages_group, NULL},
};
