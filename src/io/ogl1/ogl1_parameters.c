/* ogl1_parameters.c - see ogl1_parameters.h. */
#include "io/ogl1/ogl1_parameters.h"

#include <stddef.h>
#include <string.h>

const ogl1_parameter OGL1_PARAMETERS[OGL1_PARAMETER_COUNT] = {
    {"lit", OGL1_BOOLEAN, offsetof(legacy_material, is_lit), 0, 0},
    {"ambient", OGL1_COLOR, offsetof(legacy_material, ambient), 0, 0},
    {"specular", OGL1_COLOR, offsetof(legacy_material, specular), 0, 0},
    {"emission", OGL1_COLOR, offsetof(legacy_material, emission), 0, 0},
    {"shininess", OGL1_NUMBER, offsetof(legacy_material, shininess), 0, 1e6},
    {"smooth", OGL1_BOOLEAN, offsetof(legacy_material, is_smooth), 0, 0},
    {"fog", OGL1_BOOLEAN, offsetof(legacy_material, has_fog), 0, 0},
};

const ogl1_statement OGL1_STATEMENTS[OGL1_STATEMENT_COUNT] = {
    {"Ni", LEGACY_IOR, offsetof(legacy_material, ior), 0.001, 100},
    {"sharpness", LEGACY_SHARPNESS, offsetof(legacy_material, sharpness), 0, 1000},
    {"Pr", LEGACY_ROUGHNESS, offsetof(legacy_material, roughness), 0, 1},
    {"Pm", LEGACY_METALLIC, offsetof(legacy_material, metallic), 0, 1},
    {"Ps", LEGACY_SHEEN, offsetof(legacy_material, sheen), 0, 1},
    {"Pc", LEGACY_CLEARCOAT, offsetof(legacy_material, clearcoat), 0, 1},
    {"Pcr", LEGACY_CLEARCOAT_ROUGHNESS, offsetof(legacy_material, clearcoat_roughness), 0, 1},
    {"aniso", LEGACY_ANISOTROPY, offsetof(legacy_material, anisotropy), -1, 1},
    {"anisor", LEGACY_ANISOTROPY_ROTATION, offsetof(legacy_material, anisotropy_rotation), -1, 1},
};

const char *const OGL1_TEXTYPES[] = {"rgb", "rgba", "alpha", "luminance", "luminance.alpha", NULL};
const char *const OGL1_TEXMODES[] = {"modulate", "replace", "decal", "blend", "add", NULL};
const char *const OGL1_MAG_FILTERS[] = {"linear", "nearest", NULL};
const char *const OGL1_SIDES[] = {"filled", "lines", "points", "culled", NULL};

const ogl1_min_filter OGL1_MIN_FILTERS[OGL1_MIN_FILTER_COUNT] = {
    {"linear", SCENE_FILTER_LINEAR, SCENE_MIP_NONE},
    {"nearest", SCENE_FILTER_NEAREST, SCENE_MIP_NONE},
    {"linear.mipmap.linear", SCENE_FILTER_LINEAR, SCENE_MIP_LINEAR},
    {"linear.mipmap.nearest", SCENE_FILTER_LINEAR, SCENE_MIP_NEAREST},
    {"nearest.mipmap.linear", SCENE_FILTER_NEAREST, SCENE_MIP_LINEAR},
    {"nearest.mipmap.nearest", SCENE_FILTER_NEAREST, SCENE_MIP_NEAREST},
};

static bool is_among(const char *key, const char *const *names, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(key, names[i]) == 0)
            return true;
    return false;
}

bool ogl1_is_parameter(const char *key)
{
    static const char *const others[] = {"color",     "col",          "alpha",        "front",
                                         "back",      "texture",      "textype",      "texmode",
                                         "texmipmap", "texminfilter", "texmagfilter", "texenvmap"};
    for (int i = 0; i < OGL1_PARAMETER_COUNT; i++)
        if (strcmp(key, OGL1_PARAMETERS[i].name) == 0)
            return true;
    return is_among(key, others, sizeof others / sizeof *others);
}

bool ogl1_is_kept(const char *key)
{
    static const char *const kept[] = {
        "size",       "lwd",           "point_antialias", "line_antialias", "depth_mask",
        "depth_test", "isTransparent", "polygon_offset",  "margin",         "floating",
        "tag",        "blend"};
    return is_among(key, kept, sizeof kept / sizeof *kept);
}
