/* legacy_options.c - see legacy_options.h. The choices of the table stand in the order of the enums. */
#include "cli/legacy_options.h"

void legacy_options_read(const command_line *c, facet_scene_desc *out)
{
    facet_legacy_desc *l = &out->legacy;
    l->method = (facet_legacy_method)option_choice(c, OPT_METHOD, FACET_LEGACY_METHOD_CLOSED);
    l->profile = (facet_legacy_profile)option_choice(c, OPT_PROFILE, FACET_LEGACY_PROFILE_SPECULAR_IOR);
    l->target = (facet_legacy_target)option_choice(c, OPT_FIT_TARGET, FACET_LEGACY_TARGET_AUTO);
    l->colors = option_choice(c, OPT_MTL_COLORS, 0) ? FACET_LEGACY_COLORS_LINEAR : FACET_LEGACY_COLORS_SRGB;
    l->dialect = (facet_mtl_dialect)option_choice(c, OPT_DIALECT, FACET_MTL_DIALECT_AUTO);
    l->illum = (facet_mtl_illum)option_choice(c, OPT_ILLUM, FACET_MTL_ILLUM_AUTO);
    l->ambient = (facet_legacy_ambient)option_choice(c, OPT_AMBIENT, FACET_LEGACY_AMBIENT_DROP);
    l->keeps_hue = is_given(c, OPT_KEEP_HUE);
    l->has_glass = is_given(c, OPT_GLASS);
    l->has_mirrors = is_given(c, OPT_MIRRORS);
    l->keeps_light = option_choice(c, OPT_LIGHT_SCALE, 0) == 1;
    l->bakes_occlusion = is_given(c, OPT_BAKE_OCCLUSION);
    l->ignores_source = is_given(c, OPT_REFIT);
    out->obj_normals = (facet_obj_normals)option_choice(c, OPT_NORMALS, FACET_OBJ_NORMALS_AUTO);
    out->has_flipped_texcoords = is_given(c, OPT_FLIP_TEXTURES);
    out->parameters = option_text(c, OPT_PARAMETERS, NULL);
}
