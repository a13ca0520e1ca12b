/* render_options.c - converts the options of facet render to descs. */
#include "cli/render/render_options.h"

#include "cli/shared/failure.h"
#include "cli/shared/value.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

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
static facet_result read_color(const command_line *c, render_options *out, facet_error *error)
{
    facet_render_desc *d = &out->desc;
    TRY(image_options_exposure(c, out, error));
    TRY(image_options_shading(c, out, error));
    if (out->meters_exposure && d->shading == FACET_SHADING_OGL1)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--exposure: --shading ogl1 produces display values, which auto cannot meter");
    image_options_quality(c, d->shading == FACET_SHADING_OGL1 ? FACET_TONEMAP_NONE : FACET_TONEMAP_NEUTRAL,
                          out);
    d->has_specular_antialiasing = is_given(c, OPT_SPECULAR_AA);
    if (is_given(c, OPT_AO))
        d->ambient_occlusion = strcmp(option_text(c, OPT_AO, "on"), "off") == 0 ? FACET_AMBIENT_OCCLUSION_OFF
                                                                                : FACET_AMBIENT_OCCLUSION_ON;
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
    facet_result (*const readers[])(const command_line *, render_options *, facet_error *) = {
        part_options_read,         image_options_output, image_options_format, read_size,
        read_background,           read_color,           camera_options_read,  read_motion,
        image_options_environment, path_options_read,    image_options_aov};
    facet_result result = limits_read(c, &out->limits, error);
    for (size_t i = 0; i < sizeof readers / sizeof *readers && result == FACET_OK; i++)
        result = readers[i](c, out, error);
    if (result != FACET_OK)
        return result;
    TRY(image_options_check_sequence(c, out, error));
    TRY(part_options_check(out, error));
    out->desc.thread_count = out->save.thread_count = out->limits.thread_count;
    return FACET_OK;
}

bool render_is_lit_by_scene(const render_options *o, const facet_scene *scene, const facet_pose_desc *pose)
{
    return !o->has_environment && o->environment.kind != ENVIRONMENT_NONE && !o->desc.ignores_scene_lights &&
           facet_scene_has_environment(scene, pose);
}
