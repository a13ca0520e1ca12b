/* render_options.c - the options of facet render become descs. */
#include "cli/render_options.h"

#include "cli/legacy_options.h"

#include "cli/color.h"
#include "cli/failure.h"
#include "cli/orbit.h"
#include "cli/output_name.h"
#include "cli/path_options.h"
#include "cli/terminal.h"
#include "cli/value.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#define DEGREE 0.017453292519943295 /* pi / 180 */

/* ---- picture ---- */

/* In the order of --format's choices; then other names of the same. */
static const struct {
    const char *extension;
    facet_file_format format;
} formats[] = {{"png", FACET_FORMAT_PNG},   {"png", FACET_FORMAT_PNG16}, {"jpg", FACET_FORMAT_JPEG},
               {"webp", FACET_FORMAT_WEBP}, {"exr", FACET_FORMAT_EXR},   {"exr", FACET_FORMAT_EXR_FLOAT},
               {"hdr", FACET_FORMAT_HDR},   {"pfm", FACET_FORMAT_PFM},   {"y4m", FACET_FORMAT_RAW},
               {"raw", FACET_FORMAT_RAW},   {"jpeg", FACET_FORMAT_JPEG}};
enum { Y4M = 8, RAW = 9 }; /* in formats */

const char *render_extension(facet_file_format format)
{
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (formats[i].format == format)
            return formats[i].extension;
    return "png";
}

static void set_format(render_options *out, size_t number)
{
    out->save.format = formats[number].format;
    out->video = number == Y4M ? VIDEO_Y4M : number == RAW ? VIDEO_RAW : VIDEO_NONE;
}

static bool is_linear(facet_file_format format)
{
    return format == FACET_FORMAT_EXR || format == FACET_FORMAT_EXR_FLOAT || format == FACET_FORMAT_HDR ||
           format == FACET_FORMAT_PFM;
}

static facet_result read_format(const command_line *c, render_options *out, facet_error *error)
{
    int choice = option_choice(c, OPT_FORMAT, -1);
    if (choice >= 0) {
        set_format(out, (size_t)choice);
        return FACET_OK;
    }
    if (!out->output) {
        out->save.format = FACET_FORMAT_PNG;
        return FACET_OK;
    }
    if (out->is_stdout)
        return fail_with(
            error, FACET_ERROR_ARGUMENT,
            "--output: - is standard output, which has no name to tell the format; add --format png");
    const char *slash = strrchr(out->output, '/'), *dot = strrchr(slash ? slash : out->output, '.');
    for (size_t i = 0; dot && i < sizeof formats / sizeof *formats; i++)
        if (strcasecmp(dot + 1, formats[i].extension) == 0) {
            set_format(out, i);
            return FACET_OK;
        }
    return option_fail(c, OPT_OUTPUT,
                       "a name that ends in .png, .jpg, .webp, .exr, .hdr, .pfm or .y4m (videos in other "
                       "forms: send --format y4m to ffmpeg)",
                       error);
}

static facet_result read_size(const command_line *c, render_options *out, facet_error *error)
{
    facet_render_desc *d = &out->desc;
    if (!value_size(option_text(c, OPT_SIZE, "1024x768"), &d->width, &d->height))
        return option_fail(
            c, OPT_SIZE,
            "WIDTHxHEIGHT in pixels such as 640x480, or one number for a square; the most are 65536", error);
    if (!is_given(c, OPT_CROP))
        return FACET_OK;
    if (!value_rectangle(option_text(c, OPT_CROP, ""), d->crop))
        return option_fail(c, OPT_CROP, "X,Y,WIDTH,HEIGHT in pixels", error);
    if (d->crop[0] + d->crop[2] > d->width || d->crop[1] + d->crop[3] > d->height)
        return option_fail(c, OPT_CROP, "inside the picture that --size gives", error);
    return FACET_OK;
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

static facet_result read_aovs(const command_line *c, render_options *out, facet_error *error)
{
    static const struct {
        const char *name;
        facet_aov bit;
    } aovs[] = {{"depth", FACET_AOV_DEPTH},
                {"normal", FACET_AOV_NORMAL},
                {"albedo", FACET_AOV_ALBEDO},
                {"material", FACET_AOV_MATERIAL_ID},
                {"uv", FACET_AOV_UV},
                {"occlusion", FACET_AOV_OCCLUSION},
                {"variance", FACET_AOV_VARIANCE},
                {"samples", FACET_AOV_SAMPLES}};
    const char *text = option_text(c, OPT_AOV, "");
    while (*text) {
        size_t length = strcspn(text, ",");
        for (size_t i = 0; i < sizeof aovs / sizeof *aovs; i++)
            if (strlen(aovs[i].name) == length && memcmp(aovs[i].name, text, length) == 0)
                out->desc.aovs |= aovs[i].bit;
        text += length;
        text += *text == ',';
    }
    bool is_exr = out->save.format == FACET_FORMAT_EXR || out->save.format == FACET_FORMAT_EXR_FLOAT;
    if (out->desc.aovs && !is_exr)
        return fail_with(error, FACET_ERROR_ARGUMENT,
                         "--aov: only .exr files have layers; write -o NAME.exr");
    return FACET_OK;
}

/* Color management, quality. */
static facet_result read_look(const command_line *c, render_options *out, facet_error *error)
{
    static const facet_tonemap tonemaps[] = {FACET_TONEMAP_NEUTRAL,        FACET_TONEMAP_ACES,
                                             FACET_TONEMAP_ACES_NARKOWICZ, FACET_TONEMAP_AGX,
                                             FACET_TONEMAP_REINHARD,       FACET_TONEMAP_REINHARD_EXTENDED,
                                             FACET_TONEMAP_HABLE,          FACET_TONEMAP_NONE};
    static const facet_quality qualities[] = {FACET_QUALITY_DRAFT, FACET_QUALITY_NORMAL, FACET_QUALITY_FINAL};
    facet_render_desc *d = &out->desc;
    double stops = 0.0;
    if (is_given(c, OPT_EXPOSURE) && !value_exposure(option_text(c, OPT_EXPOSURE, ""), &stops))
        return option_fail(c, OPT_EXPOSURE, "stops such as +0.5, or a factor such as 2x", error);
    d->exposure_ev = (float)stops;
    d->shading = (facet_shading)option_choice(c, OPT_SHADING, FACET_SHADING_GLTF);
    static const option_id ogl1_only[] = {OPT_OGL1_VARIANT, OPT_OGL1_SPACE, OPT_FOG};
    for (size_t i = 0; i < sizeof ogl1_only / sizeof *ogl1_only; i++)
        if (is_given(c, ogl1_only[i]) && d->shading != FACET_SHADING_OGL1)
            return fail_with(error, FACET_ERROR_ARGUMENT, "--%s: it says something only with --shading ogl1",
                             option_find_id(c->verb, ogl1_only[i])->name);
    int tonemap = option_choice(c, OPT_TONE_MAPPING, -1);
    bool is_plain = is_linear(out->save.format) || d->shading == FACET_SHADING_OGL1;
    d->tonemap = tonemap >= 0 ? tonemaps[tonemap] : is_plain ? FACET_TONEMAP_NONE : FACET_TONEMAP_NEUTRAL;
    d->ogl1 = (facet_ogl1_desc){.variant = (facet_ogl1_variant)option_choice(c, OPT_OGL1_VARIANT, 0),
                                .is_linear = option_choice(c, OPT_OGL1_SPACE, 0) == 1,
                                .ignores_fog = option_choice(c, OPT_FOG, 0) == 1};
    d->quality = qualities[option_choice(c, OPT_QUALITY, 1)];
    d->specular_antialiasing = is_given(c, OPT_SPECULAR_AA);
    d->ignore_scene_lights = option_choice(c, OPT_LIGHTS, 0) == 1;
    out->save.jpeg_quality = (uint32_t)option_number(c, OPT_JPEG_QUALITY, 0.0);
    out->save.png_compression = (uint32_t)option_number(c, OPT_PNG_COMPRESSION, 0.0);
    return FACET_OK;
}

/* ---- camera ---- */

static facet_result read_orbit(const command_line *c, render_options *out, facet_error *error)
{
    facet_orbit *orbit = &out->orbit;
    *orbit = facet_orbit_default();
    orbit->is_z_up = option_choice(c, OPT_UP, 0) == 1;
    orbit->orthographic = is_given(c, OPT_ORTHO);
    const char *text = option_text(c, OPT_ORBIT, NULL);
    if (text && !orbit_parse(text, orbit))
        return option_fail(
            c, OPT_ORBIT,
            "AZIMUTH,POLAR,RADIUS such as 30,75,105% or \"30deg 75deg 2m\" (polar: 0 to 180 degrees)", error);
    text = option_text(c, OPT_TARGET, "auto");
    if (!target_parse(text, orbit->target, out->has_target))
        return option_fail(c, OPT_TARGET, "X,Y,Z in metres, or auto", error);
    orbit->has_target = out->has_target[0] && out->has_target[1] && out->has_target[2];
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
    static const option_id orbit_options[] = {OPT_ORBIT, OPT_TARGET, OPT_FOV,      OPT_EYE,
                                              OPT_UP,    OPT_ORTHO,  OPT_TURNTABLE};
    out->camera = option_text(c, OPT_CAMERA, NULL);
    for (size_t i = 0; out->camera && i < sizeof orbit_options / sizeof *orbit_options; i++)
        if (is_given(c, orbit_options[i]))
            return fail_with(
                error, FACET_ERROR_ARGUMENT,
                "--camera: a camera of the file does not go together with --%s; give one of them",
                option_find_id(c->verb, orbit_options[i])->name);
    facet_result result = read_orbit(c, out, error);
    if (result != FACET_OK)
        return result;
    out->turntable = (uint32_t)option_number(c, OPT_TURNTABLE, 0.0);
    out->has_eye = is_given(c, OPT_EYE);
    if (!out->has_eye)
        return FACET_OK;
    double eye[3];
    if (!value_numbers(option_text(c, OPT_EYE, ""), 3, eye))
        return option_fail(c, OPT_EYE, "X,Y,Z in metres", error);
    for (int i = 0; i < 3; i++)
        out->eye[i] = (float)eye[i];
    if (is_given(c, OPT_ORBIT) || out->turntable)
        return fail_with(error, FACET_ERROR_ARGUMENT,
                         "--eye: it does not go together with --%s; give one of them",
                         out->turntable ? "turntable" : "orbit");
    return FACET_OK;
}

/* ---- motion ---- */

static facet_result read_motion(const command_line *c, render_options *out, facet_error *error)
{
    out->animation = option_text(c, OPT_ANIMATION, NULL);
    out->has_time = is_given(c, OPT_TIME);
    out->has_frames = is_given(c, OPT_FRAMES);
    out->has_fps = is_given(c, OPT_FPS);
    out->time_s = option_number(c, OPT_TIME, 0.0);
    out->fps = option_number(c, OPT_FPS, 24.0);
    if (out->has_frames && !frame_list_parse(option_text(c, OPT_FRAMES, ""), &out->frames))
        return option_fail(c, OPT_FRAMES,
                           "a list of at most a million frames, from 1, such as 1-48, 1-48x2 or 1,3,5..10",
                           error);
    if (out->has_time && out->has_frames)
        return fail_with(error, FACET_ERROR_ARGUMENT,
                         "--time: it is one moment and does not go together with --frames; give one of them");
    bool plays_none = out->animation && strcmp(out->animation, "none") == 0;
    if (plays_none && (out->has_time || out->has_frames))
        return fail_with(error, FACET_ERROR_ARGUMENT, "--animation: none does not go together with --%s",
                         out->has_time ? "time" : "frames");
    bool is_still = out->has_time || plays_none;
    out->is_sequence = out->turntable || out->has_frames || (!is_still && (out->animation || out->has_fps));
    return FACET_OK;
}

/* ---- light ---- */

static facet_result read_environment(const command_line *c, render_options *out, facet_error *error)
{
    out->has_environment = is_given(c, OPT_ENV);
    out->environment_cache = option_text(c, OPT_ENV_CACHE, NULL);
    facet_result result = environment_input_parse("--env", option_text(c, OPT_ENV, "neutral"),
                                                  ENVIRONMENT_TAKES_NONE, &out->environment, error);
    if (result != FACET_OK)
        return result;
    double rotation = 0.0;
    if (is_given(c, OPT_ENV_ROTATION) && !value_angle(option_text(c, OPT_ENV_ROTATION, ""), &rotation))
        return option_fail(c, OPT_ENV_ROTATION, "an angle in degrees", error);
    out->desc.environment_rotation_rad = (float)rotation;
    double intensity = option_number(c, OPT_ENV_INTENSITY, 1.0);
    if (intensity > 0.0)
        out->desc.environment_ev = (float)log2(intensity);
    else
        out->environment.kind = ENVIRONMENT_NONE;
    return FACET_OK;
}

/* ---- output ---- */

static facet_result read_output(const command_line *c, render_options *out, facet_error *error)
{
    out->output = option_text(c, OPT_OUTPUT, NULL);
    out->is_stdout = out->output && strcmp(out->output, "-") == 0;
    out->keeps_existing = is_given(c, OPT_NO_CLOBBER);
    if (!out->output)
        return FACET_OK;
    if (out->is_stdout) {
        if (terminal_is(stdout))
            return fail_with(
                error, FACET_ERROR_ARGUMENT,
                "--output: - is standard output, which is a terminal; send it to a file or a program");
        if (is_given(c, OPT_JSON))
            return fail_with(
                error, FACET_ERROR_ARGUMENT,
                "--json: it writes to standard output, and so does --output -; give one of them");
    } else if (c->argument_count > 1 && !output_name_has_stem(out->output)) {
        return fail_with(error, FACET_ERROR_ARGUMENT,
                         "--output: \"%s\" is one name for %zu models; put {stem} in it, as in {stem}.png",
                         out->output, c->argument_count);
    }
    return FACET_OK;
}

/* Whether all pictures have a place to go. */
static facet_result check_sequence(const command_line *c, const render_options *o, facet_error *error)
{
    bool has_mark = o->output && output_name_has_frame(o->output);
    if (o->video && has_mark)
        return fail_with(error, FACET_ERROR_ARGUMENT,
                         "--output: \"%s\" has a place for a number, but a video holds all frames",
                         o->output);
    if (o->video && o->keeps_existing)
        return FACET_OK;
    if (o->video && o->is_stdout && c->argument_count > 1)
        return fail_with(error, FACET_ERROR_ARGUMENT,
                         "--output: standard output takes the video of one model");
    bool is_one = o->has_frames ? o->frames.frame_count == 1 : !o->is_sequence;
    if (is_one || o->video || !o->output || o->is_stdout || has_mark)
        return FACET_OK;
    if (o->turntable)
        return fail_with(error, FACET_ERROR_ARGUMENT,
                         "--output: \"%s\" is one name for %u pictures; put #### in it, as in turn_####.png",
                         o->output, o->turntable);
    return fail_with(error, FACET_ERROR_ARGUMENT,
                     "--output: \"%s\" is one name for the frames of an animation; put #### in it, as in "
                     "walk_####.png, or give --time for one picture",
                     o->output);
}

facet_result render_options_read(const command_line *c, render_options *out, facet_error *error)
{
    *out = (render_options){.scene = option_text(c, OPT_SCENE, NULL),
                            .variant = option_text(c, OPT_VARIANT, NULL)};
    facet_result (*const readers[])(const command_line *, render_options *, facet_error *) = {
        read_output, read_format, read_size,   read_background,  read_aovs,
        read_look,   read_camera, read_motion, read_environment, path_options_read};
    facet_result result = limits_read(c, &out->limits, error);
    for (size_t i = 0; i < sizeof readers / sizeof *readers && result == FACET_OK; i++)
        result = readers[i](c, out, error);
    if (result != FACET_OK)
        return result;
    result = check_sequence(c, out, error);
    if (result != FACET_OK)
        return result;
    out->desc.thread_count = out->save.thread_count = out->limits.thread_count;
    out->scene_desc = (facet_scene_desc){.thread_count = out->limits.thread_count,
                                         .root = option_text(c, OPT_ROOT, NULL),
                                         .max_texture_size = out->limits.max_texture_size};
    legacy_options_read(c, &out->scene_desc);
    return FACET_OK;
}
