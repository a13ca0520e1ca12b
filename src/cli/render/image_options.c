/* image_options.c - options of images that facet render and facet ocean share. */
#include "cli/render/render_options.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "cli/shared/failure.h"
#include "cli/shared/output.h"
#include "cli/shared/terminal.h"
#include "cli/shared/value.h"

/* ---- renderer ---- */

/* "path or gl": the renderers with layers and a feature. */
static void renderers_with(uint32_t aovs, uint32_t feature, char *text, size_t size)
{
    const char *found[16];
    size_t count = 0, used = 0;
    facet_renderer_info info;
    for (int kind = 0; (info = facet_renderer_get_info((facet_renderer_kind)kind)).name && count < 16; kind++)
        if ((info.features & feature) == feature && (info.aovs & aovs) == aovs)
            found[count++] = info.name;
    *text = 0;
    for (size_t i = 0; i < count && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%s",
                                 i == 0           ? ""
                                 : i + 1 == count ? " or "
                                                  : ", ",
                                 found[i]);
}

facet_result image_options_renderer(const command_line *c, render_options *out, facet_error *error)
{
    const char *wanted = option_text(c, OPT_RENDERER, "preview");
    facet_renderer_info info;
    for (int kind = 0; (info = facet_renderer_get_info((facet_renderer_kind)kind)).name; kind++)
        if (strcmp(info.name, wanted) == 0) {
            out->desc.renderer = (facet_renderer_kind)kind;
            out->renderer = info;
            return FACET_OK;
        }
    char names[128];
    renderers_with(0, 0, names, sizeof names);
    return option_fail(c, OPT_RENDERER, names, error);
}

facet_result image_options_need(const command_line *c, const option_id *options, facet_renderer_feature need,
                                const render_options *o, facet_error *error)
{
    char names[128];
    if (o->renderer.features & need)
        return FACET_OK;
    renderers_with(0, need, names, sizeof names);
    for (; *options != OPTION_ID_COUNT; options++)
        if (is_given(c, *options))
            return fail(error, FACET_ERROR_ARGUMENT, "--%s: it needs --renderer %s",
                        option_find_id(c->verb, *options)->name, names);
    return FACET_OK;
}

/* ---- layers ---- */

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
    if (o->desc.path.resumes || o->desc.part.split == FACET_PART_SPLIT_SAMPLES)
        all &= ~(uint32_t)FACET_AOV_CRYPTOMATTE;
    return all;
}

/* Writes "depth, normal, uv" for layers. */
static void list_names(uint32_t aovs, char *list, size_t size)
{
    size_t used = 0;
    for (size_t i = 0; i < AOV_NAMES; i++)
        if ((aov_names[i].aovs & aovs) == aov_names[i].aovs && used < size)
            used += (size_t)snprintf(list + used, size - used, "%s%s", used ? ", " : "", aov_names[i].name);
}

static facet_result check_aovs(const char *text, const render_options *o, facet_error *error)
{
    uint32_t all = all_aovs(o);
    for (size_t i = 0; i < AOV_NAMES; i++) {
        if (!has_word(text, aov_names[i].name) || (aov_names[i].aovs & ~all) == 0)
            continue;
        if (o->desc.part.split == FACET_PART_SPLIT_SAMPLES && aov_names[i].aovs & FACET_AOV_CRYPTOMATTE)
            continue; /* part_options_check() */
        if (o->desc.path.resumes && aov_names[i].aovs & FACET_AOV_CRYPTOMATTE)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "--aov: a checkpoint does not hold %s; render it without --resume",
                        aov_names[i].name);
        char list[256] = "", names[128];
        list_names(all, list, sizeof list);
        renderers_with(aov_names[i].aovs, 0, names, sizeof names);
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--aov: %s needs --renderer %s; --renderer %s has %s, or all", aov_names[i].name, names,
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

facet_result image_options_aov(const command_line *c, render_options *out, facet_error *error)
{
    const char *text = option_text(c, OPT_AOV, "");
    bool is_exr =
        out->save.format == FACET_IMAGE_FORMAT_EXR || out->save.format == FACET_IMAGE_FORMAT_EXR_FLOAT;
    if (*text && !is_exr)
        return read_id_layer(text, out, error);
    TRY(check_aovs(text, out, error));
    if (has_word(text, "all"))
        out->desc.aovs = all_aovs(out);
    for (size_t i = 0; i < AOV_NAMES; i++)
        if (has_word(text, aov_names[i].name))
            out->desc.aovs |= aov_names[i].aovs;
    return FACET_OK;
}

/* ---- output ---- */

facet_result image_options_output(const command_line *c, render_options *out, facet_error *error)
{
    out->output = option_text(c, OPT_OUTPUT, NULL);
    out->is_stdout = out->output && strcmp(out->output, "-") == 0;
    out->keeps_existing = is_given(c, OPT_NO_CLOBBER);
    TRY(part_options_name(c, out, error));
    if (!out->output)
        return FACET_OK;
    TRY(output_name_check("--output", out->output, OUTPUT_NAME_WORDS, error));
    if (out->is_stdout) {
        if (terminal_is(stdout))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "--output: standard output is a terminal; redirect it to a file or a program");
        if (is_given(c, OPT_JSON))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "--json: it writes to standard output, as --output - does; give one of them");
    } else if (c->argument_count > 1 && !output_name_has_model(out->output)) {
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--output: \"%s\" is one name for %zu models; put {stem} in it, as in {stem}.png",
                    out->output, c->argument_count);
    }
    return FACET_OK;
}

/* In the order of --format's choices, then synonyms. */
static const struct {
    const char *extension;
    facet_image_format format;
} formats[] = {{"png", FACET_IMAGE_FORMAT_PNG},  {"png", FACET_IMAGE_FORMAT_PNG16},
               {"jpg", FACET_IMAGE_FORMAT_JPEG}, {"webp", FACET_IMAGE_FORMAT_WEBP},
               {"exr", FACET_IMAGE_FORMAT_EXR},  {"exr", FACET_IMAGE_FORMAT_EXR_FLOAT},
               {"hdr", FACET_IMAGE_FORMAT_HDR},  {"pfm", FACET_IMAGE_FORMAT_PFM},
               {"y4m", FACET_IMAGE_FORMAT_RAW},  {"raw", FACET_IMAGE_FORMAT_RAW},
               {"jpeg", FACET_IMAGE_FORMAT_JPEG}};
enum { Y4M = 8, RAW = 9 }; /* indices in formats */

const char *render_extension(facet_image_format format)
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

static bool is_linear(facet_image_format format)
{
    return format == FACET_IMAGE_FORMAT_EXR || format == FACET_IMAGE_FORMAT_EXR_FLOAT ||
           format == FACET_IMAGE_FORMAT_HDR || format == FACET_IMAGE_FORMAT_PFM;
}

/* A part keeps floats; the format of the image is that of facet merge. */
static facet_result check_part_format(bool is_given, render_options *out, facet_error *error)
{
    const char *dot = out->output ? strrchr(out->output, '.') : NULL;
    bool is_exr = is_given ? strcmp(render_extension(out->save.format), "exr") == 0
                           : dot && strcasecmp(dot, ".exr") == 0;
    if (!is_exr || out->video)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--shard: a part of an image is an .exr file, as in -o part_{shard}.exr, of which facet "
                    "merge makes "
                    "the image (several models are divided by facet batch)");
    out->save.format = FACET_IMAGE_FORMAT_EXR_FLOAT;
    return FACET_OK;
}

/* Whether text is at most 200 printable ASCII characters. */
static bool is_plain(const char *text)
{
    size_t length = 0;
    while (text[length] >= ' ' && text[length] <= '~')
        length++;
    return text[length] == 0 && length <= 200;
}

facet_result image_options_format(const command_line *c, render_options *out, facet_error *error)
{
    if (!is_plain(option_text(c, OPT_TAG, "")))
        return option_fail(c, OPT_TAG, "at most 200 printable ASCII characters", error);
    int choice = option_choice(c, OPT_FORMAT, -1);
    if (choice >= 0)
        set_format(out, (size_t)choice);
    if (out->desc.part.count)
        return check_part_format(choice >= 0, out, error);
    if (choice >= 0)
        return FACET_OK;
    if (!out->output) {
        out->save.format = FACET_IMAGE_FORMAT_PNG;
        return FACET_OK;
    }
    if (out->is_stdout)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--output: standard output has no file name; add --format png");
    const char *slash = strrchr(out->output, '/'), *dot = strrchr(slash ? slash : out->output, '.');
    for (size_t i = 0; dot && i < sizeof formats / sizeof *formats; i++)
        if (strcasecmp(dot + 1, formats[i].extension) == 0) {
            set_format(out, i);
            return FACET_OK;
        }
    return option_fail(c, OPT_OUTPUT,
                       "a name that ends in .png, .jpg, .webp, .exr, .hdr, .pfm or .y4m (for other video "
                       "formats send --format y4m to ffmpeg)",
                       error);
}

/* ---- size ---- */

facet_result image_options_size(const command_line *c, const char *otherwise, render_options *out,
                                facet_error *error)
{
    facet_render_desc *d = &out->desc;
    if (!value_size(option_text(c, OPT_SIZE, otherwise), &d->width, &d->height))
        return option_fail(c, OPT_SIZE,
                           "WIDTHxHEIGHT in pixels such as 640x480, or one number for a square, up to 65536",
                           error);
    if (!is_given(c, OPT_CROP))
        return FACET_OK;
    if (!value_rectangle(option_text(c, OPT_CROP, ""), d->crop))
        return option_fail(c, OPT_CROP, "X,Y,WIDTH,HEIGHT in pixels", error);
    if (d->crop[0] + d->crop[2] > d->width || d->crop[1] + d->crop[3] > d->height)
        return option_fail(c, OPT_CROP, "inside the image of --size", error);
    return FACET_OK;
}

/* ---- color, quality ---- */

facet_result image_options_exposure(const command_line *c, render_options *out, facet_error *error)
{
    double stops = 0.0;
    const char *text = option_text(c, OPT_EXPOSURE, "+0");
    if (!value_metered_exposure(text, &out->meters_exposure, &stops))
        return option_fail(c, OPT_EXPOSURE, "stops such as +0.5, a factor such as 2x, auto, or auto+0.5",
                           error);
    double plain;
    if (c->has_attributes && text[0] != '+' && text[0] != '-' && value_number(text, &plain))
        snprintf(out->note, sizeof out->note,
                 "--exposure %s: read as stops, a factor of %.4g; model-viewer's exposure is a factor, which "
                 "is written --exposure %sx",
                 text, exp2(stops), text);
    out->desc.exposure_ev = (float)stops;
    return FACET_OK;
}

void image_options_quality(const command_line *c, facet_tonemap otherwise, render_options *out)
{
    static const facet_quality qualities[] = {FACET_QUALITY_DRAFT, FACET_QUALITY_NORMAL, FACET_QUALITY_FINAL};
    if (is_linear(out->save.format) &&
        !out->desc.part.count) /* that of a part is chosen with the image's format */
        otherwise = FACET_TONEMAP_NONE;
    out->desc.tonemap = (facet_tonemap)option_choice(c, OPT_TONE_MAPPING, (int)otherwise);
    out->desc.quality = qualities[option_choice(c, OPT_QUALITY, 1)];
    out->save.jpeg_quality = (uint32_t)option_number(c, OPT_JPEG_QUALITY, 0.0);
    out->save.png_compression = (uint32_t)option_number(c, OPT_PNG_COMPRESSION, 0.0);
    out->save.tag = option_text(c, OPT_TAG, NULL);
}

facet_result image_options_shading(const command_line *c, render_options *out, facet_error *error)
{
    facet_render_desc *d = &out->desc;
    d->shading = (facet_shading)option_choice(c, OPT_SHADING, FACET_SHADING_GLTF);
    static const option_id ogl1_only[] = {OPT_OGL1_VARIANT, OPT_OGL1_SPACE, OPT_FOG};
    for (size_t i = 0; i < sizeof ogl1_only / sizeof *ogl1_only; i++)
        if (is_given(c, ogl1_only[i]) && d->shading != FACET_SHADING_OGL1)
            return fail(error, FACET_ERROR_ARGUMENT, "--%s: it needs --shading ogl1",
                        option_find_id(c->verb, ogl1_only[i])->name);
    d->ogl1 = (facet_ogl1_desc){.variant = (facet_ogl1_variant)option_choice(c, OPT_OGL1_VARIANT, 0),
                                .is_linear = option_choice(c, OPT_OGL1_SPACE, 0) == 1,
                                .ignores_fog = option_choice(c, OPT_FOG, 0) == 1};
    return FACET_OK;
}

/* ---- light ---- */

facet_result image_options_environment(const command_line *c, render_options *out, facet_error *error)
{
    out->has_environment = is_given(c, OPT_ENV);
    out->environment_cache = option_text(c, OPT_ENV_CACHE, NULL);
    TRY(environment_input_parse("--env", option_text(c, OPT_ENV, "neutral"), ENVIRONMENT_TAKES_NONE,
                                &out->environment, error));
    double rotation = 0.0;
    if (is_given(c, OPT_ENV_ROTATION) && !value_angle(option_text(c, OPT_ENV_ROTATION, ""), &rotation))
        return option_fail(c, OPT_ENV_ROTATION, "an angle in degrees, such as 90", error);
    out->desc.environment_rotation_rad = (float)rotation;
    double intensity = option_number(c, OPT_ENV_INTENSITY, 1.0);
    if (intensity > 0.0)
        out->desc.environment_ev = (float)log2(intensity);
    else
        out->environment.kind = ENVIRONMENT_NONE;
    return FACET_OK;
}

/* ---- sequences ---- */

facet_result image_options_frames(const command_line *c, render_options *out, facet_error *error)
{
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
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--time: it is one moment and excludes --frames; give one of them");
    return FACET_OK;
}

facet_result image_options_check_sequence(const command_line *c, const render_options *o, facet_error *error)
{
    bool has_mark = o->output && output_name_has_frame(o->output);
    if (o->video && has_mark)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--output: \"%s\" contains a frame number (####), but a video holds all frames",
                    o->output);
    if (o->video && o->keeps_existing)
        return FACET_OK;
    if (o->video && o->is_stdout && c->argument_count > 1)
        return fail(error, FACET_ERROR_ARGUMENT, "--output: standard output takes the video of one model");
    bool is_one = o->has_frames ? o->frames.frame_count == 1 : !o->is_sequence;
    if (is_one || o->video || !o->output || o->is_stdout || has_mark)
        return FACET_OK;
    if (o->turntable)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--output: \"%s\" is one name for %u images; put #### in it, as in turn_####.png",
                    o->output, o->turntable);
    return fail(error, FACET_ERROR_ARGUMENT,
                "--output: \"%s\" is one name for the frames of an animation; put #### in it, as in "
                "walk_####.png, or give --time for one image",
                o->output);
}
