/* inspect_verb.c - facet inspect: its arguments, options and help. */
#include "cli/shared/commands.h"

const verb inspect_verb = {
    .name = "inspect",
    .summary = "say what is in a model",
    .arguments = "MODEL|FOLDER...",
    .max_arguments = SIZE_MAX,
    .file_types = "glb gltf obj stl ply json",
    .output_types = "txt",
    .output_hint = ">",
    .description =
        "Reads each MODEL (.glb, .gltf, .obj with its .mtl, .stl, .ply, .json of rgl's parameters; - "
        "is standard input) and prints counts, bounds, materials, textures, images, cameras, lights, "
        "the extensions with what facet makes of them, and the warnings of reading. With -v lists "
        "are printed to their end.\n\n"
        "The exit code is 0 when the model can be read, also with warnings (--strict: 1).",
    .examples = (const example[]){{"facet inspect helmet.glb", "for reading"},
                                  {"facet inspect helmet.glb --json | jq .materials", "for a program"},
                                  {"facet inspect --strict models/", "check all in a folder and below it"},
                                  {NULL, NULL}},
    .basics = OPTION_IDS(OPT_JSON, OPT_VERBOSE, OPT_STRICT, OPT_FILES_FROM, OPT_ROOT, OPT_TIME_LIMIT,
                         OPT_MAX_MEMORY),
    .groups =
        (const option_group *const[]){&files_group, &legacy_group, &limits_group, &messages_group, NULL},
};
