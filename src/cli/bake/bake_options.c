/* bake_options.c - see bake_options.h. bake_plan.c checks the names of outputs. */
#include "cli/bake/bake_options.h"

#include "cli/shared/failure.h"
#include "cli/shared/output.h"
#include "cli/shared/terminal.h"
#include "cli/shared/value.h"

#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* Number of mip levels down to least texels, at least one. */
/* Number of mip levels down to size least, but five if there are as many. */
static uint32_t count_levels(uint32_t size, uint32_t least)
{
    uint32_t count = 1;
    while (size >> count && (size >> count >= least || count < 5))
        count++;
    return count;
}

const char *bake_input_name(const bake_options *o)
{
    return o->is_table ? "dfg" : o->has_faces ? o->faces[0] : environment_input_name(&o->environment);
}

static const char *name_of(const command_line *c, option_id id)
{
    return option_find_id(c->verb, id)->name;
}

/* FACET_ERROR_ARGUMENT for the first given option of ids: "--lobe: it has no effect WHY". */
static facet_result refuse(const command_line *c, const option_id *ids, size_t count, const char *why,
                           facet_error *error)
{
    for (size_t i = 0; i < count; i++)
        if (is_given(c, ids[i]))
            return fail(error, FACET_ERROR_ARGUMENT, "--%s: it has no effect %s", name_of(c, ids[i]), why);
    return FACET_OK;
}

/* ---- environment ---- */

static facet_result read_environment(const command_line *c, bake_options *out, facet_error *error)
{
    static const facet_layout layouts[] = {
        FACET_LAYOUT_AUTO,           FACET_LAYOUT_EQUIRECTANGULAR,  FACET_LAYOUT_CROSS_HORIZONTAL,
        FACET_LAYOUT_CROSS_VERTICAL, FACET_LAYOUT_STRIP_HORIZONTAL, FACET_LAYOUT_STRIP_VERTICAL,
        FACET_LAYOUT_OCTAHEDRAL};
    static const option_id faces_idle[] = {OPT_INPUT_LAYOUT};
    out->input_layout = layouts[option_choice(c, OPT_INPUT_LAYOUT, 0)];
    if (out->is_table)
        return FACET_OK;
    if (c->argument_count == 0)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "bake: which environment? facet bake studio.hdr -o studio.ktx2; or neutral, sun:40,135, "
                    "--dfg");
    bool is_output = c->argument_count == 2 && !out->output &&
                     output_name_has_type(c->arguments[1], c->verb->output_types);
    if (c->argument_count != 1 && c->argument_count != 6)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "bake: it takes one environment, or the six faces +X -X +Y -Y +Z -Z, not %zu files%s%s%s",
                    c->argument_count, is_output ? "; did you mean -o " : "",
                    is_output ? c->arguments[1] : "", is_output ? "?" : "");
    out->word = c->arguments[0];
    if (c->argument_count == 1)
        return environment_input_parse("bake", out->word, ENVIRONMENT_TAKES_STDIN, &out->environment, error);
    out->has_faces = true;
    for (int i = 0; i < 6; i++) {
        out->faces[i] = c->arguments[i];
        if (strcmp(out->faces[i], "-") == 0)
            return fail(error, FACET_ERROR_ARGUMENT, "bake: faces are not read from standard input");
    }
    return refuse(c, faces_idle, COUNT(faces_idle), "with six faces", error);
}

static facet_result read_light(const command_line *c, bake_options *out, facet_error *error)
{
    double rotation = 0.0, stops = 0.0;
    if (is_given(c, OPT_ROTATION) &&
        (!value_angle(option_text(c, OPT_ROTATION, ""), &rotation) || !(rotation > -1e4 && rotation < 1e4)))
        return option_fail(c, OPT_ROTATION, "an angle in degrees", error);
    if (is_given(c, OPT_EXPOSURE) && !value_exposure(option_text(c, OPT_EXPOSURE, ""), &stops))
        return option_fail(c, OPT_EXPOSURE, "stops such as +0.5, or a factor such as 2x", error);
    out->bake.rotation_rad = out->harmonics.rotation_rad = (float)rotation;
    out->bake.ev = out->harmonics.ev = (float)stops;
    out->bake.clamp = out->harmonics.clamp = (float)option_number(c, OPT_CLAMP, 0.0);
    out->has_sh_window = is_given(c, OPT_SH_WINDOW);
    out->harmonics.is_windowed = option_choice(c, OPT_SH_WINDOW, 0) == 1;
    return FACET_OK;
}

/* ---- filtering ---- */

static facet_result read_size(const command_line *c, bake_options *out, facet_error *error)
{
    const bool is_quick = is_given(c, OPT_QUICK);
    const bool is_lambert = out->bake.lobe == FACET_LOBE_LAMBERT;
    uint32_t size = (uint32_t)option_number(c, OPT_SIZE, is_lambert ? 64.0 : is_quick ? 128.0 : 256.0);
    uint32_t most = 1;
    if (out->is_table) {
        out->table_size = (uint32_t)option_number(c, OPT_SIZE, 0.0);
        if (out->table_size && (out->table_size < 16 || out->table_size > 1024))
            return option_fail(c, OPT_SIZE, "a whole number from 16 to 1024, which tables have", error);
        return FACET_OK;
    }
    if (size & (size - 1))
        return option_fail(c, OPT_SIZE, "a power of two from 1 to 8192: 128, 256, 512 ..", error);
    while (size >> most)
        most++;
    out->bake.size = size;
    out->bake.level_count = (uint32_t)option_number(
        c, OPT_MIPS, is_lambert ? 1.0 : count_levels(size, out->layout == BAKE_LAYOUT_THREE ? 8 : 16));
    if (out->bake.level_count > most)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--mips: a cube map of %u texels has at most %u levels, not %u", size, most,
                    out->bake.level_count);
    return FACET_OK;
}

static facet_result read_filter(const command_line *c, bake_options *out, facet_error *error)
{
    static const option_id idle_reference[] = {OPT_SAMPLES, OPT_QUICK};
    facet_bake_desc *d = &out->bake;
    d->lobe = (facet_lobe)option_choice(c, OPT_LOBE, FACET_LOBE_GGX);
    d->mapping = (facet_roughness_mapping)option_choice(c, OPT_MAPPING,
                                                        out->layout == BAKE_LAYOUT_FILAMENT ||
                                                                out->layout == BAKE_LAYOUT_THREE
                                                            ? FACET_ROUGHNESS_MAPPING_FILAMENT
                                                            : FACET_ROUGHNESS_MAPPING_LINEAR);
    d->method = (facet_bake_method)option_choice(c, OPT_METHOD, FACET_BAKE_METHOD_AUTO);
    if (is_given(c, OPT_REFERENCE)) {
        if (is_given(c, OPT_METHOD) && d->method != FACET_BAKE_METHOD_REFERENCE)
            return fail(error, FACET_ERROR_ARGUMENT, "--reference: it is not --method %s",
                        option_text(c, OPT_METHOD, ""));
        d->method = FACET_BAKE_METHOD_REFERENCE;
    }
    if (d->method == FACET_BAKE_METHOD_REFERENCE &&
        refuse(c, idle_reference, COUNT(idle_reference), "with --method reference, which takes no samples",
               error) != FACET_OK)
        return error->result;
    d->samples = (uint32_t)option_number(c, OPT_SAMPLES, is_given(c, OPT_QUICK) ? 64.0 : 0.0);
    out->has_max_error = is_given(c, OPT_MAX_ERROR);
    out->max_error = option_number(c, OPT_MAX_ERROR, 0.0);
    out->is_verified = is_given(c, OPT_VERIFY) || out->has_max_error;
    return read_size(c, out, error);
}

/* ---- tables ---- */

static facet_result read_table(const command_line *c, bake_options *out, facet_error *error)
{
    static const facet_dfg_kind kinds[] = {FACET_DFG_KIND_CORRELATED,  FACET_DFG_KIND_CORRELATED,
                                           FACET_DFG_KIND_SCHLICK,     FACET_DFG_KIND_MULTISCATTER,
                                           FACET_DFG_KIND_CHARLIE,     FACET_DFG_KIND_CHARLIE_NEUBELT,
                                           FACET_DFG_KIND_GGX_AVERAGE, FACET_DFG_KIND_FILAMENT};
    static const option_id idle[] = {
        OPT_DIFFUSE,   OPT_SHEEN,   OPT_SH,        OPT_PREVIEW,      OPT_LAYOUT,       OPT_PROJECTION,
        OPT_LEVEL,     OPT_RGBM,    OPT_MIPS,      OPT_MAPPING,      OPT_LOBE,         OPT_METHOD,
        OPT_REFERENCE, OPT_SAMPLES, OPT_QUICK,     OPT_VERIFY,       OPT_MAX_ERROR,    OPT_ROTATION,
        OPT_EXPOSURE,  OPT_CLAMP,   OPT_SH_WINDOW, OPT_INPUT_LAYOUT, OPT_TONE_MAPPING, OPT_PREVIEW_EXPOSURE};
    static const option_id tables_only[] = {OPT_DISTRIBUTION};
    out->is_table = is_given(c, OPT_DFG);
    out->table = kinds[option_choice(c, OPT_DISTRIBUTION, 0)];
    if (!out->is_table)
        return refuse(c, tables_only, COUNT(tables_only), "without --dfg; the lobe of cube maps is --lobe",
                      error);
    bool is_output =
        c->argument_count && !out->output && output_name_has_type(c->arguments[0], c->verb->output_types);
    if (c->argument_count)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--dfg: the table needs no environment, but got \"%s\"%s%s%s", c->arguments[0],
                    is_output ? "; did you mean -o " : "", is_output ? c->arguments[0] : "",
                    is_output ? "?" : "");
    return refuse(c, idle, COUNT(idle), "with --dfg", error);
}

/* ---- output ---- */

static facet_result read_format(const command_line *c, bake_options *out, facet_error *error)
{
    static const facet_texel_format texels[] = {FACET_TEXEL_FORMAT_RGBA16F,   FACET_TEXEL_FORMAT_RGB9E5,
                                                FACET_TEXEL_FORMAT_B10G11R11, FACET_TEXEL_FORMAT_RGBA32F,
                                                FACET_TEXEL_FORMAT_RG16F,     FACET_TEXEL_FORMAT_RG32F,
                                                FACET_TEXEL_FORMAT_R16F,      FACET_TEXEL_FORMAT_R32F};
    static const bake_container containers[] = {CONTAINER_KTX2,  CONTAINER_EXR, CONTAINER_EXR_FLOAT,
                                                CONTAINER_HDR,   CONTAINER_PFM, CONTAINER_PNG,
                                                CONTAINER_HEADER};
    const int format = option_choice(c, OPT_FORMAT, -1), texel_count = (int)COUNT(texels);
    if (format >= 0 && format < texel_count) {
        out->has_texels = true;
        out->texels = texels[format];
        if (!out->is_table && format > 3)
            return fail(error, FACET_ERROR_ARGUMENT, "--format: a cube map has three channels, more than %s",
                        option_text(c, OPT_FORMAT, ""));
    } else if (format >= 0) {
        out->container = containers[format - texel_count];
        if (!out->is_table && out->container == CONTAINER_HEADER)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "--format: h holds tables (--dfg); harmonics are --sh NAME.h");
    }
    out->zstd_level = (uint32_t)option_number(c, OPT_ZSTD, 0.0);
    return FACET_OK;
}

static facet_result read_sheet_exposure(const command_line *c, bake_options *out, facet_error *error)
{
    if (!value_metered_exposure(option_text(c, OPT_PREVIEW_EXPOSURE, "auto"), &out->meters_sheet,
                                &out->sheet_ev))
        return option_fail(c, OPT_PREVIEW_EXPOSURE,
                           "stops such as +0.5, a factor such as 2x, auto, or auto+0.5", error);
    return FACET_OK;
}

static facet_result read_image_layout(const command_line *c, bake_options *out, facet_error *error)
{
    static const facet_layout projections[] = {FACET_LAYOUT_EQUIRECTANGULAR,
                                               FACET_LAYOUT_CROSS_HORIZONTAL,
                                               FACET_LAYOUT_CROSS_VERTICAL,
                                               FACET_LAYOUT_STRIP_HORIZONTAL,
                                               FACET_LAYOUT_STRIP_VERTICAL,
                                               FACET_LAYOUT_OCTAHEDRAL,
                                               FACET_LAYOUT_FACES};
    static const option_id preview_only[] = {OPT_TONE_MAPPING, OPT_PREVIEW_EXPOSURE};
    out->has_projection = is_given(c, OPT_PROJECTION);
    out->projection = projections[option_choice(c, OPT_PROJECTION, 0)];
    out->level = (int)option_number(c, OPT_LEVEL, -1.0);
    out->rgbm_range = (float)option_number(c, OPT_RGBM, 0.0);
    out->tonemap = (facet_tonemap)option_choice(c, OPT_TONE_MAPPING, FACET_TONEMAP_NEUTRAL);
    if (out->level >= (int)out->bake.level_count)
        return fail(error, FACET_ERROR_ARGUMENT, "--level: there are %u levels, numbered from 0, and no %d",
                    out->bake.level_count, out->level);
    TRY(read_sheet_exposure(c, out, error));
    return out->preview ? FACET_OK : refuse(c, preview_only, COUNT(preview_only), "without --preview", error);
}

static facet_result check_layout(const command_line *c, const bake_options *o, facet_error *error)
{
    static const option_id idle[] = {OPT_PROJECTION, OPT_LEVEL, OPT_RGBM, OPT_LOBE};
    static const char *const why[] = {"", "with --layout filament", "with --layout khronos",
                                      "with --layout three"};
    if (o->layout == BAKE_LAYOUT_NONE)
        return FACET_OK;
    if (is_given(c, OPT_MAPPING) &&
        (o->bake.mapping == FACET_ROUGHNESS_MAPPING_LINEAR) != (o->layout == BAKE_LAYOUT_KHRONOS))
        return fail(error, FACET_ERROR_ARGUMENT, "--mapping: %s it is %s", why[o->layout],
                    o->layout == BAKE_LAYOUT_KHRONOS ? "linear" : "filament");
    const bool takes_texels = o->layout != BAKE_LAYOUT_FILAMENT;
    const bool takes_images = o->layout == BAKE_LAYOUT_FILAMENT;
    const bool is_image = o->container == CONTAINER_EXR || o->container == CONTAINER_HDR;
    if ((o->has_texels && !takes_texels) ||
        (o->container != CONTAINER_FROM_NAME && !(takes_images && is_image)))
        return fail(error, FACET_ERROR_ARGUMENT, "--format: %s is not loaded %s",
                    option_text(c, OPT_FORMAT, ""), why[o->layout]);
    if (o->zstd_level && o->layout != BAKE_LAYOUT_KHRONOS)
        return fail(error, FACET_ERROR_ARGUMENT, "--zstd: no file is compressed %s", why[o->layout]);
    return refuse(c, idle, COUNT(idle), why[o->layout], error);
}

/* Standard output takes one file, in the format of --format. */
static facet_result check_stdout(const command_line *c, const bake_options *o, facet_error *error)
{
    const char *const side[] = {o->diffuse, o->sheen, o->sh, o->preview};
    for (size_t i = 0; i < COUNT(side); i++)
        if (side[i] && strcmp(side[i], "-") == 0)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "bake: - is standard output for --output only; name a file");
    if (!o->output || strcmp(o->output, "-") != 0)
        return FACET_OK;
    if (o->layout != BAKE_LAYOUT_NONE)
        return fail(error, FACET_ERROR_ARGUMENT, "--output: --layout fills a folder, not standard output");
    if (!is_given(c, OPT_FORMAT))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--output: standard output has no file name; add --format ktx2");
    if (is_given(c, OPT_JSON))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--json: it writes to standard output, as --output - does; give one of them");
    if (terminal_is(stdout))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--output: standard output is a terminal; redirect it to a file or a program");
    return FACET_OK;
}

facet_result bake_options_read(const command_line *c, bake_options *out, facet_error *error)
{
    *out = (bake_options){.output = option_text(c, OPT_OUTPUT, NULL),
                          .diffuse = option_text(c, OPT_DIFFUSE, NULL),
                          .sheen = option_text(c, OPT_SHEEN, NULL),
                          .sh = option_text(c, OPT_SH, NULL),
                          .preview = option_text(c, OPT_PREVIEW, NULL),
                          .layout = (bake_layout)(option_choice(c, OPT_LAYOUT, -1) + 1),
                          .keeps_existing = is_given(c, OPT_NO_CLOBBER)};
    facet_result (*const readers[])(const command_line *, bake_options *, facet_error *) = {
        read_table, read_environment, read_light, read_filter, read_format, read_image_layout};
    facet_result result = limits_read(c, &out->limits, error);
    for (size_t i = 0; i < COUNT(readers) && result == FACET_OK; i++)
        result = readers[i](c, out, error);
    if (result == FACET_OK)
        result = check_layout(c, out, error);
    if (result == FACET_OK)
        result = check_stdout(c, out, error);
    out->bake.thread_count = out->harmonics.thread_count = out->limits.thread_count;
    return result;
}
