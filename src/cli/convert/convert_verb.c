/* convert_verb.c - facet convert: its arguments, options and help. */
#include "cli/shared/commands.h"

const verb convert_verb = {
    .name = "convert",
    .summary = "write a model in another form: glTF, OBJ, rgl's parameters",
    .arguments = "MODEL NEW",
    .max_arguments = SIZE_MAX,
    .file_types = "glb gltf obj stl ply json",
    .output_types = "glb gltf obj json",
    .description =
        "Reads MODEL (.glb, .gltf, .obj with its .mtl, .stl, .ply, .json of rgl's parameters; - is "
        "standard input) and writes it as NEW (.glb, .gltf, .obj, .json).\n\n"
        "From glTF to glTF: meshes, materials with all their extensions, textures as they are, "
        "motion, cameras, lights, variants, metadata. What was compressed (Draco, meshopt, "
        "quantised) is written plainly.\n\n"
        "Materials of OpenGL 1 (MTL, rgl: ambient, diffuse, specular, shininess) become physically "
        "based ones and back, and facet says how near they come: E is the relative error of light "
        "over views and lights (legacy.md of facet help documents).\n\n"
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
    .basics = OPTION_IDS(OPT_OUTPUT, OPT_MATERIALS, OPT_METHOD, OPT_PROFILE, OPT_GLASS, OPT_MIRRORS,
                         OPT_FLIP_TEXTURES, OPT_REPORT, OPT_MAX_ERROR, OPT_FILES_FROM, OPT_NO_CLOBBER,
                         OPT_JSON, OPT_STRICT),
    .groups =
        (const option_group *const[]){
            OPTION_GROUP("Output", OPT_OUTPUT, OPT_NO_CLOBBER, OPT_TO, OPT_MATERIALS, OPT_KEEP_SOURCES),
            &legacy_group,
            OPTION_GROUP("To OBJ and rgl", OPT_MTL_PBR, OPT_MTL_SHININESS_SCALE, OPT_BAKE_OCCLUSION,
                         OPT_REFIT),
            OPTION_GROUP("Report", OPT_REPORT, OPT_MAX_ERROR), &files_group, &limits_group, &messages_group,
            NULL},
};
