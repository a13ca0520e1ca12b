/* cmd_bake.c - facet bake: an environment filtered for real-time renderers. */
#include "cli/shared/options.h"

#include "cli/bake/bake_plan.h"
#include "cli/shared/failure.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/output.h"
#include "cli/shared/verb_run.h"

#include <stdio.h>
#include <string.h>

const verb bake_verb = {
    .name = "bake",
    .summary = "filter an environment for real-time renderers: cube maps, irradiance, tables",
    .arguments = "ENVIRONMENT",
    .max_arguments = 6,
    .file_types = "hdr exr ktx2 png jpg jpeg pfm webp avif tga bmp gif dds",
    .output_types = "ktx2 exr hdr pfm png json h txt html raw",
    .words = OPTION_WORDS("neutral", "white", "sun:40,135", "preetham:40,135", "gradient:"),
    .description =
        "ENVIRONMENT is an image (.hdr .exr .pfm .ktx2 .png .jpg .webp .avif .tga .bmp .gif .dds): "
        "equirectangular, a cross or strip of faces, or a KTX2 cube map; or six images, the faces +X "
        "-X +Y -Y +Z -Z; or one that needs no file: neutral (the built-in studio), white, #rrggbb, "
        "gradient:ZENITH,HORIZON[,NADIR], or a clear sky, sun:ELEVATION[,AZIMUTH] or "
        "preetham:ELEVATION[,AZIMUTH] in degrees (environments.md of facet help documents). - is "
        "standard input.\n\n"
        "The result is what image-based lighting looks up: one mip level of a cube map per "
        "perceptual roughness, the environment convolved with the GGX lobe for a view along the "
        "normal (the split sum of Karis 2013). All levels are in one KTX2 file. Texels are linear "
        "Rec.709 radiance; bake.md (facet help documents) has the orientation and what each engine "
        "expects.\n\n"
        "three.js: -o FOLDER --layout three writes environment.hdr for HDRLoader and "
        "scene.environment, and pmrem.ktx2, the result of PMREMGenerator (r187 or later): load it "
        "with KTX2Loader, make a CompressedCubeTexture of its six faces with isPMREMTexture = true, "
        "and assign it to scene.environment; bake.md has the ten lines. MeshStandardMaterial does "
        "the rest.\n\n"
        "Input texels that are NaN, infinite or negative are repaired and counted in a warning. The "
        "bytes do not depend on the number of threads. All outputs are computed before the first one "
        "is written, and each appears whole or not at all.",
    .examples =
        (const example[]){
            {"facet bake studio.hdr -o studio.ktx2", "reflections: prefiltered GGX, all levels, one file"},
            {"facet bake studio.hdr -o studio.ktx2 --diffuse studio_diffuse.ktx2 --sh studio_sh.json",
             "with diffuse irradiance beside it"},
            {"facet bake studio.hdr -o studio --layout three",
             "for three.js: new HDRLoader().load('studio/environment.hdr', t => { t.mapping = "
             "EquirectangularReflectionMapping; scene.environment = t; }); studio/pmrem.ktx2 is the same "
             "already filtered (r187 or later; bake.md has its loader)"},
            {"facet bake studio.hdr -o studio.ktx2 --preview sheet.png --verify",
             "with a preview, and verified against the reference"},
            {"facet bake sun:40,135 -o sky.ktx2 --format rgb9e5 --zstd 9", "a clear sky, in a small file"},
            {"facet bake px.hdr nx.hdr py.hdr ny.hdr pz.hdr nz.hdr -o room.ktx2", "from six faces"},
            {"facet bake studio.hdr -o 'm{level}_{face}.hdr'", "an image per level and face"},
            {"facet bake studio.hdr -o studio/ --layout filament",
             "studio/studio_ibl.ktx, studio_skybox.ktx, sh.txt: what cmgen -x studio -f ktx writes"},
            {"facet bake --dfg -o dfg.ktx2", "the DFG table of the split sum"},
            {NULL, NULL}},
    .basics = OPTION_IDS(OPT_OUTPUT, OPT_FORMAT, OPT_LAYOUT, OPT_SIZE, OPT_LOBE, OPT_DIFFUSE, OPT_SH, OPT_DFG,
                         OPT_ROTATION, OPT_EXPOSURE, OPT_PREVIEW, OPT_VERIFY, OPT_JSON),
    .groups =
        (const option_group *const[]){
            OPTION_GROUP("Output", OPT_OUTPUT, OPT_DIFFUSE, OPT_SHEEN, OPT_SH, OPT_PREVIEW, OPT_LAYOUT,
                         OPT_NO_CLOBBER, OPT_FORMAT, OPT_ZSTD, OPT_PROJECTION, OPT_LEVEL, OPT_RGBM,
                         OPT_TONE_MAPPING, OPT_PREVIEW_EXPOSURE),
            OPTION_GROUP("Filtering", OPT_SIZE, OPT_MIPS, OPT_MAPPING, OPT_LOBE, OPT_METHOD, OPT_REFERENCE,
                         OPT_SAMPLES, OPT_QUICK, OPT_VERIFY, OPT_MAX_ERROR),
            OPTION_GROUP("Environment", OPT_INPUT_LAYOUT, OPT_ROTATION, OPT_EXPOSURE, OPT_CLAMP,
                         OPT_SH_WINDOW),
            OPTION_GROUP("Tables", OPT_DFG, OPT_DISTRIBUTION),
            OPTION_GROUP("Running", OPT_PROGRESS, OPT_CONFIG), &limits_group, &messages_group, NULL},
};

typedef struct bake_run {
    verb_run base;
    bake_options options;
    bake_plan plan;
    facet_environment *environment;
    facet_environment_info info; /* .width 0: none was read */
    progress shown;
    bool is_written;
} bake_run;

/* ---- reading ---- */

static void report_environment(bake_run *run)
{
    const char *name = bake_input_name(&run->options);
    const facet_environment_info *info = &run->info;
    message_at(&run->base.messages, VERBOSITY_DETAILS,
               "%s: %u x %u texels, mean %.4g %.4g %.4g, largest %.4g", name, info->width, info->height,
               info->mean[0], info->mean[1], info->mean[2], (double)info->max_radiance);
}

static facet_result load(bake_run *run, facet_error *error)
{
    const bake_options *o = &run->options;
    facet_environment_desc desc = verb_run_environment_desc(&run->base, NULL);
    desc.max_size = o->limits.max_texture_size;
    desc.layout = o->input_layout;
    facet_result result = o->has_faces
                              ? facet_environment_load_faces(o->faces, &desc, &run->environment, error)
                              : environment_input_load(&o->environment, &desc, &run->environment, error);
    if (result == FACET_OK)
        result = facet_environment_get_info(run->environment, &run->info, error);
    if (result != FACET_OK) {
        failure_complete(error, bake_input_name(o), o->limits.max_memory_bytes);
        return result;
    }
    const float turn = bake_layout_turn(o, &run->info);
    for (uint32_t i = 0; i < run->plan.cube_count; i++)
        run->plan.cubes[i].desc.rotation_rad += turn;
    run->options.harmonics.rotation_rad += turn;
    report_environment(run);
    return FACET_OK;
}

/* ---- baking ---- */

/* Approximate relative times of the steps, for the progress bar. */
typedef enum bake_step { STEP_BAKE, STEP_VERIFY, STEP_TABLE, STEP_SHEET } bake_step;

static double cost_of(bake_step step, const facet_bake_desc *desc)
{
    static const double costs[] = {
        [STEP_BAKE] = 1.0, [STEP_VERIFY] = 3.0, [STEP_TABLE] = 0.5, [STEP_SHEET] = 4.0};
    double cost = costs[step];
    if (desc && (desc->lobe == FACET_LOBE_LAMBERT || desc->lobe == FACET_LOBE_NONE))
        cost *= 0.1;
    if (step == STEP_BAKE && desc && desc->method == FACET_BAKE_METHOD_REFERENCE)
        cost *= 100.0;
    return cost;
}

static double whole_cost(const bake_plan *plan)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < plan->cube_count; i++)
        if (plan->cubes[i].desc.size)
            sum += cost_of(STEP_BAKE, &plan->cubes[i].desc) +
                   (plan->cubes[i].is_verified ? cost_of(STEP_VERIFY, &plan->cubes[i].desc) : 0.0);
    for (size_t i = 0; i < plan->file_count; i++)
        if (!plan->files[i].is_kept && plan->files[i].content >= BAKE_TABLE)
            sum += cost_of(plan->files[i].content == BAKE_TABLE ? STEP_TABLE : STEP_SHEET, NULL);
    return sum > 0.0 ? sum : 1.0;
}

/* Advances the progress to the next step. */
static facet_progress next_step(bake_run *run, bake_step step, const facet_bake_desc *desc)
{
    run->shown.done_before += run->shown.share;
    run->shown.share = cost_of(step, desc) / whole_cost(&run->plan);
    return progress_callback(&run->shown);
}

static void report_clamped(bake_run *run, const bake_cube *baked)
{
    const facet_bake_stats stats = facet_cube_get_stats(baked->cube);
    if (baked->desc.clamp > 0.0f)
        message_at(&run->base.messages, VERBOSITY_NORMAL, "%s: --clamp %g removes %.3g %% of the light",
                   bake_input_name(&run->options), (double)baked->desc.clamp, 100.0 * stats.clamped_share);
}

/* Warns of light that exceeds a file's format: a sun in physical units is most of the light. */
static void warn_of_cut(bake_run *run, const bake_file *file)
{
    const float limit = bake_file_limit(file);
    bake_cube *baked = &run->plan.cubes[file->cube];
    if (file->content > BAKE_FACE || !(limit > 0.0f) || baked->is_cut)
        return;
    const double share = bake_cut_share(baked->cube, file->level, limit);
    if (share < 0.0005)
        return;
    baked->is_cut = true;
    const facet_log log = messages_log(&run->base.messages);
    log_warning(&log,
                "%.800s: the format ends at %g, which removes %.3g %% of the light; full floats (--format "
                "rgba32f or exr32) keep it, or scale it down with --exposure",
                file->path, (double)limit, 100.0 * share);
}

static bool needs_mirrored(const bake_plan *plan, uint32_t cube_index)
{
    for (size_t i = 0; i < plan->file_count; i++)
        if (plan->files[i].is_mirrored && plan->files[i].cube == cube_index && !plan->files[i].is_kept)
            return true;
    return false;
}

static facet_result bake_cubes(bake_run *run, facet_error *error)
{
    facet_result result = FACET_OK;
    bool has_reported = false;
    for (uint32_t i = 0; i < run->plan.cube_count && result == FACET_OK; i++) {
        bake_cube *baked = &run->plan.cubes[i];
        if (!baked->desc.size) /* its files are kept */
            continue;
        baked->desc.allocator = run->base.allocator;
        baked->desc.progress = next_step(run, STEP_BAKE, &baked->desc);
        result = facet_cube_bake(run->environment, &baked->desc, &baked->cube, error);
        if (result == FACET_OK && !has_reported)
            report_clamped(run, baked);
        has_reported = true;
        if (result == FACET_OK && baked->is_verified) {
            baked->desc.progress = next_step(run, STEP_VERIFY, &baked->desc);
            result = facet_cube_verify(baked->cube, run->environment, &baked->desc, baked->errors, error);
        }
        baked->desc.progress = (facet_progress){0};
        if (result == FACET_OK && needs_mirrored(&run->plan, i))
            result = facet_cube_create_mirrored(baked->cube, &run->base.allocator, &baked->mirrored, error);
    }
    return result;
}

static facet_result project(bake_run *run, facet_error *error)
{
    facet_sh_desc desc = run->options.harmonics;
    facet_result result = FACET_OK;
    desc.allocator = run->base.allocator;
    for (int form = 0; form < 3 && run->plan.has_sh && result == FACET_OK; form++) {
        desc.form = (facet_sh_form)form;
        result = facet_environment_project_sh(run->environment, &desc, run->plan.sh[form], error);
    }
    return result;
}

static facet_result make_files(bake_run *run, facet_error *error)
{
    bake_making making = {.options = &run->options,
                          .plan = &run->plan,
                          .environment = run->environment,
                          .allocator = run->base.allocator};
    facet_result result = FACET_OK;
    for (size_t i = 0; i < run->plan.file_count && result == FACET_OK; i++) {
        bake_file *file = &run->plan.files[i];
        if (file->is_kept)
            continue;
        making.progress = (facet_progress){0};
        if (file->content >= BAKE_TABLE)
            making.progress = next_step(run, file->content == BAKE_TABLE ? STEP_TABLE : STEP_SHEET, NULL);
        result = bake_file_make(&making, file, error);
        if (result == FACET_OK)
            warn_of_cut(run, file);
    }
    return result;
}

/* Bakes and encodes all files in memory; nothing is written until all are complete. */
static facet_result bake(bake_run *run, facet_error *error)
{
    const bool has_bar = run->shown.mode == PROGRESS_BAR;
    facet_result result = run->options.is_table ? FACET_OK : load(run, error);
    messages_flush(&run->base.messages);
    interrupt_begin("facet", "baking", has_bar);
    if (result == FACET_OK)
        result = bake_cubes(run, error);
    if (result == FACET_OK)
        result = project(run, error);
    if (result == FACET_OK)
        result = make_files(run, error);
    interrupt_end();
    progress_clear();
    if (result != FACET_OK)
        failure_complete(error, bake_plan_subject(&run->plan), run->options.limits.max_memory_bytes);
    if (result == FACET_OK && interrupt_signal())
        result = fail(error, FACET_ERROR_CANCELLED, "%s: interrupted", bake_plan_subject(&run->plan));
    if (result == FACET_OK && interrupt_seconds_left() <= 0.0)
        result = fail(error, FACET_ERROR_LIMIT, "%s: the time limit (--time-limit) was reached",
                      bake_plan_subject(&run->plan));
    return result;
}

/* ---- writing ---- */

static facet_result write_files(bake_run *run, facet_error *error)
{
    facet_result result = FACET_OK;
    for (size_t i = 0; i < run->plan.file_count && result == FACET_OK; i++) {
        const bake_file *file = &run->plan.files[i];
        if (!file->is_kept)
            result = output_write_bytes(file->bytes, file->size, file->path, error);
        if (result == FACET_OK && interrupt_signal() && i + 1 < run->plan.file_count)
            result = fail(error, FACET_ERROR_CANCELLED, "%s: interrupted", bake_plan_subject(&run->plan));
    }
    run->is_written = result == FACET_OK;
    return result;
}

static bool is_all_kept(const bake_plan *plan)
{
    for (size_t i = 0; i < plan->file_count; i++)
        if (!plan->files[i].is_kept)
            return false;
    return true;
}

static void add_json(const verb_run *base, json_t *root)
{
    const bake_run *run = (const bake_run *)base;
    json_t *report = bake_report_json(&run->options, &run->plan, &run->info, run->is_written);
    json_object_update(root, report);
    json_decref(report);
}

/* Prints the table of --verify and checks --max-error. */
static bool report_errors(const bake_run *run)
{
    const bake_options *o = &run->options;
    const command_line *c = run->base.line;
    char worst[128];
    const bool is_wanted = is_given(c, OPT_VERIFY) || is_given(c, OPT_VERBOSE);
    if (!o->is_verified || !run->is_written || is_all_kept(&run->plan))
        return true;
    if (is_wanted && !is_given(c, OPT_JSON) && !is_given(c, OPT_QUIET))
        bake_report_errors(o->output && strcmp(o->output, "-") == 0 ? stderr : stdout, &run->plan);
    bake_report_worst(&run->plan, o->has_max_error ? o->max_error : 1e300, worst, sizeof worst);
    if (!worst[0])
        return true;
    message_error("%s: %s is above --max-error %g", bake_plan_subject(&run->plan), worst, o->max_error);
    return false;
}

static facet_result read_line(verb_run *base, facet_error *error)
{
    bake_run *run = (bake_run *)base;
    TRY(bake_options_read(base->line, &run->options, error));
    base->limits = run->options.limits;
    if (run->options.layout == BAKE_LAYOUT_FILAMENT && !run->options.has_sh_window)
        run->options.harmonics.is_windowed = true; /* as cmgen does */
    TRY(bake_plan_make(&run->options, &run->plan, error));
    return bake_plan_check(base->line, &run->options, &run->plan, error);
}

static facet_result work(verb_run *base, facet_error *error)
{
    bake_run *run = (bake_run *)base;
    run->shown = (progress){.mode = base->progress,
                            .subject = bake_plan_subject(&run->plan),
                            .start = interrupt_clock(),
                            .last_percent = -10};
    if (!is_all_kept(&run->plan))
        TRY(bake(run, error));
    messages_flush(&base->messages);
    TRY(write_files(run, error));
    bake_report_files(&base->messages, &run->plan, run->plan.has_own_name, interrupt_clock() - base->start_s);
    base->is_negative = !report_errors(run);
    return FACET_OK;
}

static void destroy(verb_run *base)
{
    bake_run *run = (bake_run *)base;
    bake_plan_destroy(&run->plan);
    facet_environment_destroy(run->environment);
}

int cmd_bake(command_line *c)
{
    static const verb_work parts = {read_line, work, add_json, destroy};
    bake_run run = {.is_written = false};
    return verb_run_all(&run.base, c, &parts);
}
