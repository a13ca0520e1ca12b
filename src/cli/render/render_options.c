/* render_options.c - converts the options of facet render to descs. */
#include "cli/render/render_options.h"

#include "cli/shared/color.h"
#include "cli/shared/failure.h"
#include "cli/shared/value.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

static const struct aov_name {
    const char *name;
    uint32_t aovs;
} aov_names[] = {{"depth", FACET_AOV_DEPTH},
                 {"normal", FACET_AOV_NORMAL},
                 {"albedo", FACET_AOV_ALBEDO},
                 {"material", FACET_AOV_MATERIAL_ID},
                 {"object", FACET_AOV_OBJECT_ID},
                 {"instance", FACET_AOV_INSTANCE_ID},
                 {"uv", FACET_AOV_UV},
                 {"occlusion", FACET_AOV_OCCLUSION},
                 {"variance", FACET_AOV_VARIANCE},
                 {"samples", FACET_AOV_SAMPLES},
                 {"cryptomatte", FACET_AOV_CRYPTOMATTE},
                 {"crypto-object", FACET_AOV_CRYPTO_OBJECT},
                 {"crypto-material", FACET_AOV_CRYPTO_MATERIAL},
                 {"crypto-instance", FACET_AOV_CRYPTO_INSTANCE}};
enum { AOV_NAMES = sizeof aov_names / sizeof *aov_names };

static bool has_word(const char *list, const char *word)
{
    size_t length = strlen(word);
    for (; *list; list += *list == ',') {
        size_t here = strcspn(list, ",");
        if (here == length && memcmp(list, word, length) == 0)
            return true;
        list += here;
    }
    return false;
}

/* All layers of the renderer, without those that --resume excludes. */
static uint32_t all_aovs(const render_options *o)
{
    uint32_t all = 0;
    for (size_t i = 0; i < AOV_NAMES; i++)
        all |= aov_names[i].aovs;
    all &= o->renderer.aovs;
    if (o->desc.path.resumes)
        all &= ~(uint32_t)FACET_AOV_CRYPTOMATTE;
    return all;
}

/* Writes "depth, normal and uv" for the layers of a renderer. */
static void list_names(uint32_t aovs, char *list, size_t size)
{
    size_t used = 0;
    for (size_t i = 0; i < AOV_NAMES; i++)
        if ((aov_names[i].aovs & aovs) == aov_names[i].aovs && used < size)
            used += (size_t)snprintf(list + used, size - used, "%s%s", used ? ", " : "", aov_names[i].name);
}

static facet_result check_renderer(const char *text, const render_options *o, facet_error *error)
{
    uint32_t all = all_aovs(o);
    for (size_t i = 0; i < AOV_NAMES; i++) {
        if (!has_word(text, aov_names[i].name) || (aov_names[i].aovs & ~all) == 0)
            continue;
        if (o->desc.path.resumes && aov_names[i].aovs & FACET_AOV_CRYPTOMATTE)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "--aov: a checkpoint does not hold %s; render it without --resume",
                        aov_names[i].name);
        char list[256] = "";
        list_names(all, list, sizeof list);
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--aov: %s needs --renderer path; --renderer %s has %s, or all", aov_names[i].name,
                    o->renderer.name, list);
    }
    return FACET_OK;
}

/* A .png holds one layer of IDs in false color, which is lossless, instead of the image. */
static facet_result read_id_layer(const char *text, render_options *out, facet_error *error)
{
    static const uint32_t ids = FACET_AOV_OBJECT_ID | FACET_AOV_MATERIAL_ID | FACET_AOV_INSTANCE_ID;
    bool is_png = out->save.format == FACET_IMAGE_FORMAT_PNG && out->video == VIDEO_NONE;
    for (size_t i = 0; i < AOV_NAMES && is_png; i++)
        if (strcmp(text, aov_names[i].name) == 0 && aov_names[i].aovs & ids) {
            out->id_layer = aov_names[i].name;
            out->desc.aovs = aov_names[i].aovs | FACET_AOV_INSTANCE_ID;
            return FACET_OK;
        }
    return fail(error, FACET_ERROR_ARGUMENT,
                "--aov: layers need an .exr file, -o NAME.exr; a .png holds one of object, material and "
                "instance alone, in false color");
}

/* Sets desc.aovs; the format and the renderer are read before. FACET_ERROR_ARGUMENT: the renderer lacks a
 * layer, or the file has no room for one. */
static facet_result aov_options_read(const command_line *c, render_options *out, facet_error *error)
{
    const char *text = option_text(c, OPT_AOV, "");
    bool is_exr =
        out->save.format == FACET_IMAGE_FORMAT_EXR || out->save.format == FACET_IMAGE_FORMAT_EXR_FLOAT;
    if (*text && !is_exr)
        return read_id_layer(text, out, error);
    TRY(check_renderer(text, out, error));
    if (has_word(text, "all"))
        out->desc.aovs = all_aovs(out);
    for (size_t i = 0; i < AOV_NAMES; i++)
        if (has_word(text, aov_names[i].name))
            out->desc.aovs |= aov_names[i].aovs;
    return FACET_OK;
}

#define DEGREE 0.017453292519943295 /* pi / 180 */

/* ---- image ---- */

static facet_result read_size(const command_line *c, render_options *out, facet_error *error)
{
    return image_options_size(c, "1024x768", out, error);
}

static facet_result read_background(const command_line *c, render_options *out, facet_error *error)
{
    const char *text = option_text(c, OPT_BACKGROUND, "white");
    facet_render_desc *d = &out->desc;
    d->background_blur = (float)option_number(c, OPT_BACKGROUND_BLUR, 0.0);
    if (strcasecmp(text, "transparent") == 0 || strcasecmp(text, "none") == 0)
        d->background = FACET_BACKGROUND_TRANSPARENT;
    else if (strcasecmp(text, "env") == 0 || strcasecmp(text, "environment") == 0)
        d->background = FACET_BACKGROUND_ENVIRONMENT;
    else if (color_parse(text, d->background_color))
        d->background = FACET_BACKGROUND_COLOR;
    else
        return option_fail(c, OPT_BACKGROUND, "transparent, env, #rgb, #rrggbb or a CSS color name", error);
    return FACET_OK;
}

/* Color management, quality. */
static facet_result read_look(const command_line *c, render_options *out, facet_error *error)
{
    facet_render_desc *d = &out->desc;
    TRY(image_options_exposure(c, out, error));
    d->shading = (facet_shading)option_choice(c, OPT_SHADING, FACET_SHADING_GLTF);
    static const option_id ogl1_only[] = {OPT_OGL1_VARIANT, OPT_OGL1_SPACE, OPT_FOG};
    for (size_t i = 0; i < sizeof ogl1_only / sizeof *ogl1_only; i++)
        if (is_given(c, ogl1_only[i]) && d->shading != FACET_SHADING_OGL1)
            return fail(error, FACET_ERROR_ARGUMENT, "--%s: it needs --shading ogl1",
                        option_find_id(c->verb, ogl1_only[i])->name);
    if (out->meters_exposure && d->shading == FACET_SHADING_OGL1)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--exposure: --shading ogl1 produces display values, which auto cannot meter");
    image_options_quality(c, d->shading == FACET_SHADING_OGL1 ? FACET_TONEMAP_NONE : FACET_TONEMAP_NEUTRAL,
                          out);
    d->ogl1 = (facet_ogl1_desc){.variant = (facet_ogl1_variant)option_choice(c, OPT_OGL1_VARIANT, 0),
                                .is_linear = option_choice(c, OPT_OGL1_SPACE, 0) == 1,
                                .ignores_fog = option_choice(c, OPT_FOG, 0) == 1};
    d->has_specular_antialiasing = is_given(c, OPT_SPECULAR_AA);
    d->ignores_scene_lights = option_choice(c, OPT_LIGHTS, 0) == 1;
    return FACET_OK;
}

/* ---- motion ---- */

static facet_result read_motion(const command_line *c, render_options *out, facet_error *error)
{
    out->animation = option_text(c, OPT_ANIMATION, NULL);
    TRY(image_options_frames(c, out, error));
    bool plays_none = out->animation && strcmp(out->animation, "none") == 0;
    if (plays_none && (out->has_time || out->has_frames))
        return fail(error, FACET_ERROR_ARGUMENT, "--animation: none excludes --%s",
                    out->has_time ? "time" : "frames");
    bool is_still = out->has_time || plays_none;
    out->is_sequence = out->turntable || out->has_frames || (!is_still && (out->animation || out->has_fps));
    return FACET_OK;
}

facet_result render_options_read(const command_line *c, render_options *out, facet_error *error)
{
    *out = (render_options){.scene = option_text(c, OPT_SCENE, NULL),
                            .variant = option_text(c, OPT_VARIANT, NULL)};
    facet_result (*const readers[])(const command_line *, render_options *,
                                    facet_error *) = {image_options_output,
                                                      image_options_format,
                                                      read_size,
                                                      read_background,
                                                      read_look,
                                                      camera_options_read,
                                                      read_motion,
                                                      image_options_environment,
                                                      path_options_read,
                                                      aov_options_read};
    facet_result result = limits_read(c, &out->limits, error);
    for (size_t i = 0; i < sizeof readers / sizeof *readers && result == FACET_OK; i++)
        result = readers[i](c, out, error);
    if (result != FACET_OK)
        return result;
    result = image_options_check_sequence(c, out, error);
    if (result != FACET_OK)
        return result;
    out->desc.thread_count = out->save.thread_count = out->limits.thread_count;
    return FACET_OK;
}

bool render_is_lit_by_scene(const render_options *o, const facet_scene *scene, const facet_pose_desc *pose)
{
    return !o->has_environment && o->environment.kind != ENVIRONMENT_NONE && !o->desc.ignores_scene_lights &&
           facet_scene_has_environment(scene, pose);
}
