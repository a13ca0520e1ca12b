/* render_options.c - the options of facet render become descs. */
#include "cli/render/render_options.h"

#include "cli/render/aov_options.h"
#include "cli/render/camera_matrix.h"
#include "cli/shared/color.h"
#include "cli/shared/failure.h"
#include "cli/render/orbit.h"
#include "cli/render/path_options.h"
#include "cli/render/picture_options.h"
#include "cli/shared/value.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#define DEGREE 0.017453292519943295 /* pi / 180 */

/* ---- picture ---- */

static facet_result read_size(const command_line *c, render_options *out, facet_error *error)
{
    return picture_options_size(c, "1024x768", out, error);
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
    facet_result result = picture_options_exposure(c, out, error);
    if (result != FACET_OK)
        return result;
    d->shading = (facet_shading)option_choice(c, OPT_SHADING, FACET_SHADING_GLTF);
    static const option_id ogl1_only[] = {OPT_OGL1_VARIANT, OPT_OGL1_SPACE, OPT_FOG};
    for (size_t i = 0; i < sizeof ogl1_only / sizeof *ogl1_only; i++)
        if (is_given(c, ogl1_only[i]) && d->shading != FACET_SHADING_OGL1)
            return fail(error, FACET_ERROR_ARGUMENT, "--%s: it says something only with --shading ogl1",
                        option_find_id(c->verb, ogl1_only[i])->name);
    picture_options_look(c, d->shading == FACET_SHADING_OGL1 ? FACET_TONEMAP_NONE : FACET_TONEMAP_NEUTRAL,
                         out);
    d->ogl1 = (facet_ogl1_desc){.variant = (facet_ogl1_variant)option_choice(c, OPT_OGL1_VARIANT, 0),
                                .is_linear = option_choice(c, OPT_OGL1_SPACE, 0) == 1,
                                .ignores_fog = option_choice(c, OPT_FOG, 0) == 1};
    d->has_specular_antialiasing = is_given(c, OPT_SPECULAR_AA);
    d->ignores_scene_lights = option_choice(c, OPT_LIGHTS, 0) == 1;
    return FACET_OK;
}

/* ---- camera ---- */

static facet_result read_orbit(const command_line *c, render_options *out, facet_error *error)
{
    facet_orbit *orbit = &out->orbit;
    *orbit = facet_orbit_default();
    orbit->is_z_up = option_choice(c, OPT_UP, 0) == 1;
    orbit->is_orthographic = is_given(c, OPT_ORTHO);
    orbit->includes_far_parts = option_choice(c, OPT_FRAMING, 0) == 1;
    const char *text = option_text(c, OPT_ORBIT, NULL);
    if (text && !orbit_parse(text, orbit))
        return option_fail(
            c, OPT_ORBIT,
            "AZIMUTH,POLAR,RADIUS such as 30,75,105% or \"30deg 75deg 2m\" (polar: 0 to 180 degrees)", error);
    text = option_text(c, OPT_TARGET, "auto");
    if (!target_parse(text, out->target, out->has_target))
        return option_fail(c, OPT_TARGET, "X,Y,Z in metres, or auto", error);
    text = option_text(c, OPT_FOV, "auto");
    double fov = (double)orbit->fov_y_rad;
    if (strcasecmp(text, "auto") != 0 &&
        (!value_angle(text, &fov) || fov < 0.1 * DEGREE || fov > 179.0 * DEGREE))
        return option_fail(c, OPT_FOV, "an angle from 0.1 to 179 degrees", error);
    orbit->fov_y_rad = (float)fov;
    return FACET_OK;
}

static facet_result read_camera(const command_line *c, render_options *out, facet_error *error)
{
    static const option_id orbit_options[] = {OPT_ORBIT, OPT_TARGET, OPT_FOV,     OPT_EYE,
                                              OPT_UP,    OPT_ORTHO,  OPT_FRAMING, OPT_TURNTABLE};
    out->camera = option_text(c, OPT_CAMERA, NULL);
    for (size_t i = 0; out->camera && i < sizeof orbit_options / sizeof *orbit_options; i++)
        if (is_given(c, orbit_options[i]))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "--camera: a camera of the file does not go together with --%s; give one of them",
                        option_find_id(c->verb, orbit_options[i])->name);
    facet_result result = read_orbit(c, out, error);
    if (result != FACET_OK)
        return result;
    out->turntable = (uint32_t)option_number(c, OPT_TURNTABLE, 0.0);
    out->has_eye = is_given(c, OPT_EYE);
    if (!out->has_eye)
        return camera_matrix_read(c, out, error);
    if (!value_numbers(option_text(c, OPT_EYE, ""), 3, out->eye))
        return option_fail(c, OPT_EYE, "X,Y,Z in metres", error);
    if (is_given(c, OPT_ORBIT) || out->turntable)
        return fail(error, FACET_ERROR_ARGUMENT, "--eye: it does not go together with --%s; give one of them",
                    out->turntable ? "turntable" : "orbit");
    return FACET_OK;
}

/* ---- motion ---- */

static facet_result read_motion(const command_line *c, render_options *out, facet_error *error)
{
    out->animation = option_text(c, OPT_ANIMATION, NULL);
    facet_result result = picture_options_frames(c, out, error);
    if (result != FACET_OK)
        return result;
    bool plays_none = out->animation && strcmp(out->animation, "none") == 0;
    if (plays_none && (out->has_time || out->has_frames))
        return fail(error, FACET_ERROR_ARGUMENT, "--animation: none does not go together with --%s",
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
                                    facet_error *) = {picture_options_output,
                                                      picture_options_format,
                                                      read_size,
                                                      read_background,
                                                      read_look,
                                                      read_camera,
                                                      read_motion,
                                                      picture_options_environment,
                                                      path_options_read,
                                                      aov_options_read};
    facet_result result = limits_read(c, &out->limits, error);
    for (size_t i = 0; i < sizeof readers / sizeof *readers && result == FACET_OK; i++)
        result = readers[i](c, out, error);
    if (result != FACET_OK)
        return result;
    result = picture_options_check_sequence(c, out, error);
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
