/* path_options.c - --renderer, and the options of the renderers. */
#include "cli/render/render_options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/shared/failure.h"
#include "cli/shared/output.h"
#include "cli/shared/value.h"

#define DEGREE 0.017453292519943295 /* pi / 180 */

/* Refuses options without effect on the renderer. */
static facet_result check_renderer(const command_line *c, const render_options *o, facet_error *error)
{
    static const struct {
        facet_renderer_feature need;
        option_id options[16]; /* ends with OPTION_ID_COUNT */
    } rules[] = {{FACET_RENDERER_FEATURE_PATH, {PATH_OPTIONS, OPT_CHECKPOINT, OPT_RESUME, OPTION_ID_COUNT}},
                 {FACET_RENDERER_FEATURE_GL, {GL_OPTIONS, OPTION_ID_COUNT}},
                 {FACET_RENDERER_FEATURE_SPECULAR_AA, {OPT_SPECULAR_AA, OPTION_ID_COUNT}},
                 {FACET_RENDERER_FEATURE_OGL1, {OPT_SHADING, OPTION_ID_COUNT}}};
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++)
        TRY(image_options_need(c, rules[i].options, rules[i].need, o, error));
    static const option_id occlusion[] = {OPT_AO, OPTION_ID_COUNT};
    if (o->desc.ambient_occlusion == FACET_AMBIENT_OCCLUSION_ON)
        TRY(image_options_need(c, occlusion, FACET_RENDERER_FEATURE_AMBIENT_OCCLUSION, o, error));
    return FACET_OK;
}

/* ---- light ---- */

/* Parses AZ,EL[,LUX[,DIAMETER]]. By default the sun lights a facing surface as a white sky of radiance 1
 * does. */
static facet_result read_sun(const command_line *c, render_options *out, facet_error *error)
{
    if (!is_given(c, OPT_SUN))
        return FACET_OK;
    const char *text = option_text(c, OPT_SUN, "");
    double numbers[4] = {0.0, 0.0, 3.14159265, 0.53};
    bool is_read = false;
    for (size_t count = 2; count <= 4 && !is_read; count++)
        is_read = value_numbers(text, count, numbers);
    if (!is_read || fabs(numbers[1]) > 90.0 || !(numbers[2] >= 0.0) || numbers[2] > 1e9 ||
        !(numbers[3] > 0.0) || numbers[3] > 90.0)
        return option_fail(c, OPT_SUN,
                           "AZIMUTH,ELEVATION[,LUX[,DIAMETER]] in degrees, -90 to 90 above the horizon, lux "
                           "from 0, and a diameter up to 90 degrees, such as 30,45 or 30,45,3,0.53",
                           error);
    facet_sun *sun = &out->desc.sun;
    sun->azimuth_rad = (float)(numbers[0] * DEGREE);
    sun->elevation_rad = (float)(numbers[1] * DEGREE);
    sun->diameter_rad = (float)(numbers[3] * DEGREE);
    for (int i = 0; i < 3; i++)
        sun->illuminance_lux[i] = (float)numbers[2];
    return FACET_OK;
}

static facet_result read_ground(const command_line *c, render_options *out, facet_error *error)
{
    out->desc.ground = option_choice(c, OPT_GROUND, 0) == 1 ? FACET_GROUND_SHADOW : FACET_GROUND_NONE;
    if (out->desc.ground == FACET_GROUND_SHADOW && option_choice(c, OPT_UP, 0) == 1)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--ground: the ground lies below models with +Y up; it excludes --up z");
    return FACET_OK;
}

/* ---- lens and shutter ---- */

static facet_result read_lens(const command_line *c, render_options *out, facet_error *error)
{
    const char *text = option_text(c, OPT_APERTURE, "0");
    double diameter = 0.0;
    out->aperture_is_relative = scan_number(&text, &diameter) && strcmp(text, "%") == 0;
    if ((!out->aperture_is_relative && *text) || diameter < 0.0 || diameter > 1e9)
        return option_fail(c, OPT_APERTURE, "a diameter in m, or in % of the focus distance, as 2%", error);
    out->aperture = (float)(out->aperture_is_relative ? 0.01 * diameter : diameter);
    if (is_given(c, OPT_FOCUS) && !(out->aperture > 0.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "--focus: it needs a lens, as --aperture 2%%");
    text = option_text(c, OPT_FOCUS, "auto");
    double focus = 0.0;
    if (strcmp(text, "auto") != 0 && (!value_number(text, &focus) || !(focus > 0.0)))
        return option_fail(c, OPT_FOCUS, "a distance in m, or auto", error);
    out->focus_m = (float)focus;
    return FACET_OK;
}

static facet_result read_shutter(const command_line *c, render_options *out, facet_error *error)
{
    const char *text = option_text(c, OPT_SHUTTER, "0");
    double open = 0.0;
    bool is_read = scan_number(&text, &open);
    bool is_angle = is_read && strcmp(text, "deg") == 0;
    if (!is_read || !(is_angle || *text == 0 || strcmp(text, "s") == 0) || open < 0.0 || open > 1e9)
        return option_fail(c, OPT_SHUTTER, "a time in s, or an angle of the shutter, as 180deg", error);
    out->desc.path.shutter_s = (float)(is_angle ? open / 360.0 / out->fps : open);
    return FACET_OK;
}

/* Distance along the optical axis to the center of the model, for cameras of the file, which have no target. */
static float distance_to_middle(const facet_scene *scene, const facet_pose_desc *pose, const facet_camera *c)
{
    float low[3];
    float high[3];
    facet_scene_get_bounds(scene, pose, low, high);
    float axis2 = 0.0f;
    float along = 0.0f;
    for (int i = 0; i < 3; i++) {
        float axis = c->target[i] - c->eye[i];
        axis2 += axis * axis;
        along += axis * (0.5f * low[i] + 0.5f * high[i] - c->eye[i]);
    }
    return along > 0.0f && axis2 > 0.0f ? along / sqrtf(axis2) : 0.0f;
}

static float distance_to_target(const facet_camera *c)
{
    return hypotf(hypotf(c->target[0] - c->eye[0], c->target[1] - c->eye[1]), c->target[2] - c->eye[2]);
}

void path_options_set_lens(const render_options *o, const facet_scene *scene, const facet_pose_desc *pose,
                           facet_camera *camera)
{
    if (!(o->aperture > 0.0f))
        return;
    camera->focus_m = o->focus_m;
    if (!(camera->focus_m > 0.0f) && o->camera)
        camera->focus_m = distance_to_middle(scene, pose, camera);
    if (!(camera->focus_m > 0.0f))
        camera->focus_m = distance_to_target(camera);
    camera->lens_radius_m = 0.5f * o->aperture * (o->aperture_is_relative ? camera->focus_m : 1.0f);
}

/* ---- sampling ---- */

static facet_result read_checkpoint(const command_line *c, render_options *out, facet_error *error)
{
    out->checkpoint = option_text(c, OPT_CHECKPOINT, NULL);
    out->desc.path.resumes = is_given(c, OPT_RESUME);
    if (!out->checkpoint)
        return out->desc.path.resumes
                   ? fail(error, FACET_ERROR_ARGUMENT, "--resume: it needs --checkpoint FILE")
                   : FACET_OK;
    TRY(output_name_check("--checkpoint", out->checkpoint, OUTPUT_NAME_WORDS, error));
    const char *dot = strrchr(out->checkpoint, '.');
    if (!dot || strcmp(dot, ".exr") != 0)
        return option_fail(c, OPT_CHECKPOINT, "a name that ends in .exr", error);
    if (c->argument_count > 1 && !output_name_has_model(out->checkpoint))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--checkpoint: \"%s\" is one name for %zu models; put {stem} in it", out->checkpoint,
                    c->argument_count);
    if (out->is_sequence && !output_name_has_frame(out->checkpoint))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--checkpoint: \"%s\" is one name for several images; put #### in it", out->checkpoint);
    if (out->output && strcmp(out->output, out->checkpoint) == 0)
        return fail(error, FACET_ERROR_ARGUMENT, "--checkpoint: this is also the name of the image");
    return FACET_OK;
}

static void read_sampling(const command_line *c, render_options *out)
{
    facet_path_desc *p = &out->desc.path;
    p->max_depth = 1 + (uint32_t)option_number(c, OPT_BOUNCES, 63.0);
    p->seed = (uint32_t)option_number(c, OPT_SEED, 0.0);
    p->filter = (facet_filter)option_choice(c, OPT_FILTER, FACET_FILTER_BLACKMAN_HARRIS);
    p->light_sampling = (facet_light_sampling)option_choice(c, OPT_LIGHT_SAMPLING, FACET_LIGHT_SAMPLING_MIS);
    p->noise = (float)option_number(c, OPT_NOISE, 0.0);
    p->clamp = (float)option_number(c, OPT_CLAMP, 0.0);
    p->has_straight_shadows = option_choice(c, OPT_GLASS_SHADOWS, 0) == 1;
    p->denoises = is_given(c, OPT_DENOISE);
}

static void read_gl(const command_line *c, render_options *out)
{
    facet_gl_desc *gl = &out->desc.gl;
    gl->has_shadows = is_given(c, OPT_SHADOWS);
    gl->transparency = (facet_transparency)option_choice(c, OPT_TRANSPARENCY, FACET_TRANSPARENCY_SORTED);
    gl->bloom = (float)option_number(c, OPT_BLOOM, 0.0);
    gl->channel = (facet_channel)option_choice(c, OPT_CHANNEL, FACET_CHANNEL_LIGHT);
    gl->brdf = (facet_brdf)option_choice(c, OPT_BRDF, FACET_BRDF_ENERGY);
}

/* Defaults that depend on the renderer. */
static void read_defaults(const command_line *c, render_options *out)
{
    out->desc.samples =
        (uint32_t)option_number(c, OPT_SAMPLES, (double)out->renderer.samples[out->desc.quality]);
    out->desc.isa = (facet_isa)option_choice(c, OPT_ISA, FACET_ISA_PORTABLE);
    out->desc.energy = (facet_energy)option_choice(c, OPT_ENERGY, FACET_ENERGY_CONSERVING);
}

facet_result path_options_read(const command_line *c, render_options *out, facet_error *error)
{
    TRY(image_options_renderer(c, out, error));
    TRY(check_renderer(c, out, error));
    TRY(read_sun(c, out, error));
    read_defaults(c, out);
    if (out->desc.samples > out->renderer.max_samples) {
        char expected[96];
        snprintf(expected, sizeof expected, "a number from 1 to %u (--renderer path takes more)",
                 out->renderer.max_samples);
        return option_fail(c, OPT_SAMPLES, expected, error);
    }
    TRY(read_ground(c, out, error));
    if (out->renderer.features & FACET_RENDERER_FEATURE_GL)
        read_gl(c, out);
    if (!(out->renderer.features & FACET_RENDERER_FEATURE_PATH))
        return FACET_OK;
    read_sampling(c, out);
    TRY(read_lens(c, out, error));
    TRY(read_shutter(c, out, error));
    return read_checkpoint(c, out, error);
}
