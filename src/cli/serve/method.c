/* method.c - see method.h. */
#include "cli/serve/method.h"

#include <string.h>

const method methods[] = {
    {&render_verb, {"model", NULL}, "the model: .glb .gltf .obj .stl .ply", true, false},
    {&inspect_verb, {"model", NULL}, "the model: .glb .gltf .obj .stl .ply", false, false},
    {&convert_verb, {"model", NULL}, "the model: .glb .gltf .obj .stl .ply", true, false},
    {&compare_verb, {"a", "b", NULL}, "the images: a is the reference, b is compared with it", false, false},
    {&bake_verb,
     {"environment", NULL},
     "the environment: .hdr .exr .png .jpg .ktx2, or sun:40,135",
     true,
     true},
    {NULL, {NULL}, NULL, false, false},
};

const method *method_find(const char *name)
{
    for (const method *m = methods; m->verb; m++)
        if (strcmp(m->verb->name, name) == 0)
            return m;
    return NULL;
}

size_t method_index(const method *m)
{
    return (size_t)(m - methods);
}

/* Files and folders that are not known here are refused, so that a new option opens nothing. */
parameter_use parameter_use_of(const option *o)
{
    static const option_id inputs[] = {OPT_PARAMETERS, OPT_MASK, OPT_ROOT, OPTION_ID_COUNT};
    static const option_id outputs[] = {OPT_OUTPUT, OPT_REPORT,  OPT_DIFFUSE,    OPT_SHEEN,
                                        OPT_SH,     OPT_PREVIEW, OPTION_ID_COUNT};
    static const option_id refused[] = {OPT_RESUME,   OPT_JSON, OPT_QUIET,    OPT_VERBOSE,
                                        OPT_PROGRESS, OPT_HELP, OPT_HELP_ALL, OPTION_ID_COUNT};
    if (o->id == OPT_ENV)
        return PARAMETER_ENVIRONMENT;
    if (option_is_among(o->id, inputs))
        return PARAMETER_INPUT;
    if (option_is_among(o->id, outputs))
        return PARAMETER_OUTPUT;
    if (o->kind == OPTION_FILE || o->kind == OPTION_FOLDER || option_is_among(o->id, refused))
        return PARAMETER_REFUSED;
    return PARAMETER_VALUE;
}
