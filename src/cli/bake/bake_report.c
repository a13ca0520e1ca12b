/* bake_report.c - see bake_plan.h. */
#include "cli/bake/bake_plan.h"

#include "cli/bake/bake_names.h"
#include "cli/shared/failure.h"
#include "cli/shared/terminal.h"

#include <math.h>
#include <string.h>

const char *const bake_lobe_names[4] = {"ggx", "charlie", "lambert", "none"};
/* By facet_texel_format. */
static const char *const texel_names[] = {"rgba16f", "rgba32f", "rgb9e5", "b10g11r11",
                                          "rg16f",   "rg32f",   "r16f",   "r32f"};
static const char *const content_names[] = {"cube", "level", "face", "harmonics", "table", "sheet"};
/* By facet_layout. */
static const char *const layout_names[] = {
    "auto",       "equirect", "cross-horizontal", "cross-vertical", "strip-horizontal", "strip-vertical",
    "octahedral", "faces"};

static const char *shown_path(const bake_file *file)
{
    return strcmp(file->path, "-") == 0 ? "stdout" : file->path;
}

static void format_size(size_t size, char *text, size_t text_size)
{
    if (size < 10240)
        snprintf(text, text_size, "%zu bytes", size);
    else if (size < (size_t)10 << 20)
        snprintf(text, text_size, "%.4g KiB", (double)size / 1024.0);
    else
        snprintf(text, text_size, "%.4g MiB", (double)size / 1048576.0);
}

static void describe(const bake_plan *plan, const bake_file *file, char *text, size_t size)
{
    const bake_cube *baked = &plan->cubes[file->cube];
    switch (file->content) {
    case BAKE_CUBE:
        snprintf(text, size, "%s, %u x %u texels, %u level%s, %s", bake_lobe_names[baked->desc.lobe],
                 baked->desc.size, baked->desc.size, baked->desc.level_count,
                 baked->desc.level_count == 1 ? "" : "s", texel_names[file->texels]);
        break;
    case BAKE_LEVEL:
    case BAKE_FACE:
        snprintf(text, size, "%s, level %u, %s", bake_lobe_names[baked->desc.lobe], file->level,
                 file->content == BAKE_FACE ? bake_face_names[file->face] : layout_names[file->projection]);
        break;
    default:
        snprintf(text, size, "%s", content_names[file->content]);
    }
}

void bake_report_files(const messages *m, const bake_plan *plan, bool is_news, double seconds)
{
    const verbosity least = is_news || terminal_is(stderr) ? VERBOSITY_NORMAL : VERBOSITY_DETAILS;
    for (size_t i = 0; i < plan->file_count; i++) {
        const bake_file *file = &plan->files[i];
        char what[128], bytes[32];
        if (file->is_kept) {
            message_at(m, VERBOSITY_NORMAL, "%s: kept, since it exists", file->path);
            continue;
        }
        describe(plan, file, what, sizeof what);
        format_size(file->size, bytes, sizeof bytes);
        message_at(m, strcmp(file->path, "-") == 0 && !terminal_is(stderr) ? VERBOSITY_DETAILS : least,
                   "%s: %s, %s", shown_path(file), what, bytes);
    }
    for (uint32_t i = 0; i < plan->cube_count; i++) {
        const bake_cube *baked = &plan->cubes[i];
        if (!baked->cube)
            continue;
        const facet_bake_stats stats = facet_cube_get_stats(baked->cube);
        message_at(m, VERBOSITY_TIMINGS, "%s: baked in %.1f ms, %.4g M samples",
                   bake_lobe_names[baked->desc.lobe], 1e3 * stats.total_s, 1e-6 * (double)stats.samples);
    }
    message_at(m, VERBOSITY_DETAILS, "%s: %.2f s", bake_plan_subject(plan), seconds);
}

/* ---- errors ---- */

void bake_report_errors(FILE *stream, const bake_plan *plan)
{
    table t = {.column_count = 7};
    static const char *const titles[] = {"lobe", "level", "texels", "roughness", "rms", "max", "energy"};
    for (size_t i = 0; i < 7; i++)
        table_add(&t, "%s", titles[i]);
    for (uint32_t i = 0; i < plan->cube_count; i++) {
        const bake_cube *baked = &plan->cubes[i];
        for (uint32_t level = 0; baked->cube && baked->is_verified && level < baked->desc.level_count;
             level++) {
            const facet_cube_error *e = &baked->errors[level];
            uint32_t edge = facet_cube_get_size(baked->cube, level);
            table_add(&t, "%s", bake_lobe_names[baked->desc.lobe]);
            table_add(&t, "%u", level);
            table_add(&t, "%ux%u", edge, edge);
            table_add(&t, "%.4g", (double)facet_cube_get_roughness(baked->cube, level));
            table_add(&t, "%.2e", e->rms);
            table_add(&t, "%.2e", e->max);
            table_add(&t, "%.6f", e->energy);
        }
    }
    table_print(&t, stream, 0);
}

void bake_report_worst(const bake_plan *plan, double limit, char *text, size_t size)
{
    double worst = -1.0;
    *text = 0;
    for (uint32_t i = 0; i < plan->cube_count; i++) {
        const bake_cube *baked = &plan->cubes[i];
        for (uint32_t level = 0; baked->cube && baked->is_verified && level < baked->desc.level_count;
             level++) {
            double rms = baked->errors[level].rms;
            if (!(rms > limit || isnan(rms)) || !(rms > worst || isnan(rms)))
                continue;
            worst = isnan(rms) ? HUGE_VAL : rms;
            snprintf(text, size, "level %u of %s: RMS error %.3g", level, bake_lobe_names[baked->desc.lobe],
                     rms);
        }
    }
}

/* ---- JSON ---- */

static json_t *number_json(double number)
{
    return isfinite(number) ? json_real(number) : json_null();
}

static json_t *level_json(const bake_cube *baked, uint32_t level)
{
    json_t *one = json_pack("{s:I, s:f}", "size", (json_int_t)facet_cube_get_size(baked->cube, level),
                            "roughness", (double)facet_cube_get_roughness(baked->cube, level));
    if (baked->is_verified) {
        const facet_cube_error *e = &baked->errors[level];
        json_object_set_new(one, "rms", number_json(e->rms));
        json_object_set_new(one, "max", number_json(e->max));
        json_object_set_new(one, "energy", number_json(e->energy));
        json_object_set_new(one, "texels", json_integer((json_int_t)e->texels));
    }
    return one;
}

static json_t *cubes_json(const bake_plan *plan)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < plan->cube_count; i++) {
        const bake_cube *baked = &plan->cubes[i];
        json_t *levels = json_array();
        if (baked->cube) {
            const facet_bake_stats stats = facet_cube_get_stats(baked->cube);
            for (uint32_t level = 0; level < baked->desc.level_count; level++)
                json_array_append_new(levels, level_json(baked, level));
            json_array_append_new(list, json_pack("{s:s, s:I, s:I, s:f, s:f, s:O}", "lobe",
                                                  bake_lobe_names[baked->desc.lobe], "size",
                                                  (json_int_t)baked->desc.size, "samples",
                                                  (json_int_t)stats.samples, "seconds", stats.total_s,
                                                  "clamped_share", stats.clamped_share, "levels", levels));
        }
        json_decref(levels);
    }
    return list;
}

static json_t *files_json(const bake_plan *plan)
{
    json_t *list = json_array();
    for (size_t i = 0; i < plan->file_count; i++) {
        const bake_file *file = &plan->files[i];
        json_t *one = json_pack("{s:o, s:s}", "path", report_string_json(file->path), "content",
                                content_names[file->content]);
        if (file->is_kept)
            json_object_set_new(one, "kept", json_true());
        else
            json_object_set_new(one, "bytes", json_integer((json_int_t)file->size));
        if (file->content <= BAKE_FACE)
            json_object_set_new(one, "lobe", json_string(bake_lobe_names[plan->cubes[file->cube].desc.lobe]));
        if (file->container == CONTAINER_KTX2 || file->container == CONTAINER_KTX1)
            json_object_set_new(one, "texels", json_string(texel_names[file->texels]));
        if (file->content == BAKE_LEVEL || file->content == BAKE_FACE)
            json_object_set_new(one, "level", json_integer((json_int_t)file->level));
        json_array_append_new(list, one);
    }
    return list;
}

static json_t *inputs_json(const bake_options *o)
{
    json_t *list = json_array();
    if (!o->is_table)
        for (int i = 0; i < (o->has_faces ? 6 : 1); i++)
            json_array_append_new(list, report_string_json(o->has_faces ? o->faces[i] : o->word));
    return list;
}

json_t *bake_report_json(const bake_options *o, const bake_plan *plan, const facet_environment_info *info,
                         bool is_done)
{
    json_t *environment =
        info->width
            ? json_pack("{s:s, s:I, s:I, s:I, s:[f, f, f], s:o}", "layout", layout_names[info->layout],
                        "width", (json_int_t)info->width, "height", (json_int_t)info->height,
                        "repaired_texels", (json_int_t)info->repaired_texels, "mean", info->mean[0],
                        info->mean[1], info->mean[2], "max", number_json((double)info->max_radiance))
            : json_null();
    return json_pack("{s:o, s:o, s:o, s:o}", "inputs", inputs_json(o), "environment", environment, "outputs",
                     is_done ? files_json(plan) : json_array(), "cubes", cubes_json(plan));
}
