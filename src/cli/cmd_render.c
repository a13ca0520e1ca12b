/* cmd_render.c - facet render: models to pictures, one after the other. */
#include "cli/commands.h"

#include "cli/failure.h"
#include "cli/input.h"
#include "cli/interrupt.h"
#include "cli/memory_limit.h"
#include "cli/output.h"
#include "cli/preset.h"
#include "cli/progress.h"
#include "cli/render_camera.h"
#include "cli/render_names.h"
#include "cli/render_options.h"
#include "cli/render_report.h"

#include <stdio.h>
#include <string.h>

/* All that a run shares. {0}. */
typedef struct render_run {
    const command_line *line;
    render_options options;
    messages messages;
    progress_mode progress;
    facet_budget *budget;
    facet_allocator allocator;
    facet_environment *environment; /* read once, for all models */
    bool has_environment;
    json_t *pictures, *failures; /* NULL: nobody asked for JSON */
    json_t *warnings;
    size_t warning_count, failure_count;
    int exit_code; /* of the last failure */
} render_run;

/* ---- reading ---- */

/* Sets what the process says when the time limit ends it while name is read. */
static void begin_reading(const char *name)
{
    static char sentence[512];
    snprintf(sentence, sizeof sentence, "%.400s: the time limit (--time-limit) was reached while reading\n",
             name);
    interrupt_set_safe(sentence);
}

static facet_result load_environment(render_run *run, facet_error *error)
{
    const render_options *o = &run->options;
    const facet_environment_desc desc = {.allocator = run->allocator,
                                         .log = messages_log(&run->messages),
                                         .thread_count = o->limits.thread_count,
                                         .cache_folder = o->environment_cache};
    facet_result result = FACET_OK;
    switch (o->environment) {
    case ENVIRONMENT_NONE:
        break;
    case ENVIRONMENT_STUDIO:
        result = facet_environment_create_studio(&desc, &run->environment, error);
        break;
    case ENVIRONMENT_CONSTANT:
        result = facet_environment_create_constant(o->environment_radiance, &desc, &run->environment, error);
        break;
    case ENVIRONMENT_FILE:
        if (!o->environment_cache) /* the cache writes files */
            begin_reading(o->environment_path);
        result = facet_environment_load(o->environment_path, &desc, &run->environment, error);
        interrupt_set_safe(NULL);
        break;
    }
    run->has_environment = result == FACET_OK;
    return result;
}

static facet_result load_model(render_run *run, const char *model, facet_scene **scene, facet_error *error)
{
    const render_options *o = &run->options;
    const facet_scene_desc desc = {.allocator = run->allocator,
                                   .log = messages_log(&run->messages),
                                   .thread_count = o->limits.thread_count,
                                   .root = o->root,
                                   .max_texture_size = o->limits.max_texture_size};
    begin_reading(input_name(model));
    facet_result result = input_load(model, &desc, scene, error);
    interrupt_set_safe(NULL);
    return result;
}

/* ---- pictures ---- */

static facet_result render_frame(render_run *run, const facet_scene *scene, const facet_pose_desc *pose,
                                 uint32_t frame, picture_report *report, facet_error *error)
{
    const render_options *o = &run->options;
    double start = interrupt_clock();
    uint32_t frame_count = o->turntable ? o->turntable : 1;
    facet_camera camera;
    facet_result result = render_camera(scene, pose, o, frame, &camera, error);
    if (result != FACET_OK)
        return result;
    progress shown = {.mode = run->progress,
                      .subject = report->output,
                      .start = start,
                      .done_before = (double)frame / frame_count,
                      .share = 1.0 / frame_count,
                      .last_percent = -10};
    double left = interrupt_seconds_left();
    if (left <= 0.0)
        return fail_with(error, FACET_ERROR_LIMIT, "%s: the time limit (--time-limit) was reached",
                         report->output);
    facet_render_desc desc = o->desc;
    desc.allocator = run->allocator;
    desc.log = messages_log(&run->messages);
    desc.progress = progress_callback(&shown);
    desc.pose = *pose;
    desc.camera = &camera;
    desc.environment = run->environment;
    desc.time_limit_s = left < 1e29 ? left : 0.0;
    facet_image *image = NULL;
    result = facet_render(scene, &desc, &image, error);
    progress_clear();
    if (result != FACET_OK)
        return result;
    double rendered = interrupt_clock();
    facet_save_desc save = o->save;
    save.allocator = run->allocator;
    result = output_write(image, report->output, &save, error);
    facet_image_view view = facet_image_get_layer(image, 0);
    report->width = view.width;
    report->height = view.height;
    report->samples = desc.samples;
    report->stats = facet_image_get_render_stats(image);
    report->save_s = interrupt_clock() - rendered;
    report->total_s = interrupt_clock() - start + report->load_s;
    facet_image_destroy(image);
    return result;
}

static void report_frame(render_run *run, const picture_report *report)
{
    report_picture(&run->messages, report, !run->options.output);
    if (run->pictures)
        json_array_append_new(run->pictures, report_picture_json(report));
}

/* All pictures of a model that is loaded. */
static facet_result render_frames(render_run *run, const char *model, const facet_scene *scene, double load_s,
                                  facet_error *error)
{
    const render_options *o = &run->options;
    facet_pose_desc pose = {0};
    facet_result result = FACET_OK;
    pose.has_scene_index = o->scene != NULL;
    if (o->scene)
        result = facet_scene_find_scene(scene, o->scene, &pose.scene_index, error);
    for (uint32_t frame = 0; frame < (o->turntable ? o->turntable : 1) && result == FACET_OK; frame++) {
        char name[RENDER_NAME_SIZE];
        result = render_name(&run->options, model, frame, name, sizeof name, error);
        if (result != FACET_OK)
            break;
        picture_report report = {.model = input_name(model), .output = name, .load_s = frame ? 0.0 : load_s};
        if (interrupt_signal())
            return fail_with(error, FACET_ERROR_CANCELLED, "%s: interrupted", name);
        report.is_kept = o->keeps_existing && !o->is_stdout && output_exists(name);
        if (!report.is_kept)
            result = render_frame(run, scene, &pose, frame, &report, error);
        messages_flush(&run->messages);
        if (result == FACET_OK)
            report_frame(run, &report);
    }
    return result;
}

/* --no-clobber for a still: nothing need be read. True: the picture was there, and that is reported. */
static bool is_kept(render_run *run, const char *model)
{
    char name[RENDER_NAME_SIZE];
    facet_error ignored;
    if (!run->options.keeps_existing || run->options.is_stdout || run->options.turntable ||
        render_name(&run->options, model, 0, name, sizeof name, &ignored) != FACET_OK || !output_exists(name))
        return false;
    report_frame(run, &(picture_report){.model = input_name(model), .output = name, .is_kept = true});
    return true;
}

static facet_result render_model(render_run *run, const char *model, facet_error *error)
{
    if (is_kept(run, model))
        return FACET_OK;
    double start = interrupt_clock();
    facet_scene *scene = NULL;
    facet_result result = load_model(run, model, &scene, error);
    if (result == FACET_OK && !run->has_environment)
        result = load_environment(run, error);
    messages_flush(&run->messages);
    if (result == FACET_OK)
        result = render_frames(run, model, scene, interrupt_clock() - start, error);
    facet_scene_destroy(scene);
    return result;
}

/* ---- the run ---- */

/* Says what went wrong with model, once, with what the user can do about it. */
static void report_failure(render_run *run, const char *model, facet_error *error)
{
    const char *name = input_name(model);
    char sentence[sizeof error->message + 256];
    size_t length = strlen(name);
    const char *environment = run->options.environment_path;
    bool is_about_model = (strncmp(error->message, name, length) == 0 && error->message[length] == ':') ||
                          (environment && strncmp(error->message, environment, strlen(environment)) == 0);
    bool is_general = error->result == FACET_ERROR_MEMORY || error->result == FACET_ERROR_LIMIT;
    uint64_t limit = run->options.limits.max_memory_bytes;
    int n = snprintf(sentence, sizeof sentence, "%s%s%s", is_general && !is_about_model ? name : "",
                     is_general && !is_about_model ? ": " : "", error->message);
    if (error->result == FACET_ERROR_MEMORY && limit && n > 0 && (size_t)n < sizeof sentence)
        snprintf(sentence + n, sizeof sentence - (size_t)n, "; the limit is %.3g MiB (--max-memory)",
                 (double)limit / 1048576.0);
    snprintf(error->message, sizeof error->message, "%.1000s", sentence);
    message_error("%s", error->message);
    run->failure_count++;
    run->exit_code = exit_code_of(error->result);
    if (run->failures)
        json_array_append_new(run->failures, report_error_json(error, name, run->exit_code));
}

/* Adds the warnings of a model to the totals and forgets them. */
static void end_model(render_run *run)
{
    messages_flush(&run->messages);
    run->warning_count += run->messages.warning_count;
    if (run->warnings) {
        json_t *warnings = report_warnings_json(&run->messages);
        json_array_extend(run->warnings, warnings);
        json_decref(warnings);
    }
    messages_clear(&run->messages);
}

static int render_all(render_run *run)
{
    const command_line *c = run->line;
    size_t count = c->argument_count ? c->argument_count : 1;
    for (size_t i = 0; i < count; i++) {
        const char *model = c->argument_count ? c->arguments[i] : NULL;
        facet_error error = {0};
        facet_result result = render_model(run, model, &error);
        if (result == FACET_ERROR_CANCELLED || interrupt_signal()) {
            end_model(run);
            return result == FACET_OK && i + 1 == count ? EXIT_DONE : interrupt_exit();
        }
        if (result != FACET_OK)
            report_failure(run, model, &error);
        end_model(run);
        if (result == FACET_ERROR_WRITE && run->options.is_stdout)
            break;
    }
    if (run->failure_count)
        return count == 1 ? run->exit_code : EXIT_NEGATIVE;
    return run->warning_count && is_given(c, OPT_STRICT) ? EXIT_NEGATIVE : EXIT_DONE;
}

static void print_json(const render_run *run, double start, int exit_code)
{
    json_t *root = json_pack(
        "{s:s, s:O, s:O, s:O, s:f, s:I, s:I, s:i}", "facet", facet_version(), "pictures", run->pictures,
        "failures", run->failures, "warnings", run->warnings, "seconds", interrupt_clock() - start,
        "peak_memory_bytes", (json_int_t)memory_peak(), "peak_data_bytes",
        (json_int_t)(run->budget ? facet_budget_peak_bytes(run->budget) : 0), "exit_code", exit_code);
    report_print_json(root);
    json_decref(root);
}

static facet_result begin(render_run *run, command_line *c, config *storage, facet_error *error)
{
    facet_result result = config_apply(c, storage, error);
    if (result == FACET_OK)
        result = preset_apply(c, error);
    if (result == FACET_OK)
        result = render_options_read(c, &run->options, error);
    if (result == FACET_OK)
        result = render_names_check(c, &run->options, error);
    if (result == FACET_OK)
        result = facet_budget_create(run->options.limits.max_memory_bytes, &run->budget, error);
    if (result != FACET_OK)
        return result;
    run->allocator = facet_budget_allocator(run->budget);
    run->messages.verbosity = is_given(c, OPT_QUIET)             ? VERBOSITY_QUIET
                              : c->values[OPT_VERBOSE].count > 1 ? VERBOSITY_TIMINGS
                              : is_given(c, OPT_VERBOSE)         ? VERBOSITY_DETAILS
                                                                 : VERBOSITY_NORMAL;
    run->progress = progress_choose(option_choice(c, OPT_PROGRESS, 0), is_given(c, OPT_QUIET));
    return FACET_OK;
}

int cmd_render(command_line *c)
{
    double start = interrupt_clock();
    render_run run = {.line = c};
    config storage = {0};
    facet_error error = {0};
    interrupt_install();
    if (is_given(c, OPT_JSON)) {
        run.pictures = json_array();
        run.failures = json_array();
        run.warnings = json_array();
    }
    facet_result result = begin(&run, c, &storage, &error);
    int exit_code;
    if (result == FACET_OK) {
        interrupt_set_deadline(run.options.limits.time_limit_s);
        exit_code = render_all(&run);
    } else {
        exit_code = exit_code_of(result);
        message_error(error.message[0] == '-' ? "facet: %s" : "%s", error.message);
        if (run.failures)
            json_array_append_new(run.failures, report_error_json(&error, NULL, exit_code));
    }
    if (run.pictures)
        print_json(&run, start, exit_code);
    json_decref(run.pictures);
    json_decref(run.failures);
    json_decref(run.warnings);
    facet_environment_destroy(run.environment);
    facet_budget_destroy(run.budget);
    config_destroy(&storage);
    return exit_code;
}
