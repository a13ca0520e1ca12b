/* cmd_render.c - facet render: renders models to images, in order. */
#include "cli/shared/options.h"

#include "cli/render/picture.h"
#include "cli/render/render_options.h"
#include "cli/render/render_output.h"
#include "cli/render/sequence.h"
#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/output.h"
#include "cli/shared/command_line.h"
#include "cli/shared/verb_run.h"

#include <stdio.h>
#include <string.h>

typedef struct render_run {
    verb_run base;
    render_options options;
    model_list models;
    facet_environment *environment; /* read once, for all models */
    bool has_environment, environment_failed;
    json_t *images;     /* NULL without --json */
    size_t models_left; /* including the current one */
} render_run;

/* ---- reading ---- */

static facet_result load_environment(render_run *run, facet_error *error)
{
    const render_options *o = &run->options;
    const facet_environment_desc desc = verb_run_environment_desc(&run->base, o->environment_cache);
    const environment_input *input = &o->environment;
    facet_result result = environment_input_load(input, &desc, &run->environment, error);
    run->has_environment = result == FACET_OK;
    run->environment_failed = result != FACET_OK;
    return result;
}

static facet_result load_model(render_run *run, const char *model, facet_scene **scene, facet_error *error)
{
    const facet_scene_desc desc = verb_run_scene_desc(&run->base);
    interrupt_begin_reading(input_name(model));
    facet_result result = input_load_shaded(model, &desc, run->options.desc.shading, scene, error);
    interrupt_end();
    return result;
}

/* ---- images ---- */

/* The state of one model. */
typedef struct model_run {
    render_run *run;
    render_options options; /* the first image sets the framing of a sequence */
    const model_name *model;
    facet_scene *scene;
    facet_renderer *renderer;
    facet_environment *environment, *own_environment; /* of the render; the model's own, or NULL */
    sequence sequence;
    video *video; /* NULL: files */
    double load_s;
    bool has_lost_checkpoint;
    uint32_t frame_count, frames_done; /* of this process */
    bool is_framed;                    /* the camera is framed, and its warnings are reported */
} model_run;

static facet_result frame_camera(model_run *m, uint32_t index, const sequence_frame *frame,
                                 facet_camera *camera, facet_error *error)
{
    const sequence *s = &m->sequence;
    bool is_sequence = s->frames.frame_count > 1;
    const render_view view = {
        .pose = &s->pose, .turn = frame->turn, .turns = s->turns > 0, .moves = s->moves};
    m->options.orbit.log = m->is_framed ? (facet_log){0} : messages_log(&m->run->base.messages);
    m->is_framed = true;
    interrupt_begin(input_name(m->model->path), "framing the camera", m->run->base.progress == PROGRESS_BAR);
    facet_result result = render_camera(m->scene, &view, &m->options, camera, error);
    interrupt_end();
    if (result == FACET_OK && index == 0 && is_sequence)
        render_keep_framing(&m->options, m->scene, camera);
    if (result == FACET_OK)
        path_options_set_lens(&m->options, m->scene, &s->pose, camera);
    return result;
}

static bool is_thumbnail(const render_run *run)
{
    return strcmp(option_text(run->base.line, OPT_PRESET, ""), "thumbnail") == 0;
}

/* Refuses the thumbnail of a model in which nothing can be drawn: file managers would keep an empty image. An
 * image of several frames may begin with nothing. */
static facet_result check_thumbnail(const model_run *m, facet_error *error)
{
    float low[3], high[3];
    if (!is_thumbnail(m->run) || m->frame_count != 1 ||
        facet_scene_get_bounds(m->scene, &m->sequence.pose, low, high))
        return FACET_OK;
    return fail(error, FACET_ERROR_INVALID,
                "%s: nothing of the model can be drawn; facet inspect lists what there is",
                input_name(m->model->path));
}

/* Refuses an output that is a file of the model: helmet.gltf often has a texture helmet.png, the default
 * name of the image. */
static facet_result check_inputs(const model_run *m, const char *name, facet_error *error)
{
    const render_options *o = &m->options;
    if (o->is_stdout || o->keeps_existing || !facet_scene_has_file(m->scene, name))
        return FACET_OK;
    return fail(error, FACET_ERROR_ARGUMENT,
                "%s: this input would be overwritten; name another output with -o", name);
}

/* Time limit of an image, s; 0: none. Path tracing uses all of its time, so that images share the rest
 * evenly. */
static double time_for_frame(const model_run *m, double left)
{
    if (!(left < 1e29))
        return 0.0;
    if (!(m->options.renderer.features & FACET_RENDERER_FEATURE_PATH))
        return left;
    double frames_left = (double)(m->frame_count - m->frames_done);
    return left / (frames_left * (double)m->run->models_left);
}

/* Renders a frame. checkpoint receives the name of its checkpoint (RENDER_NAME_SIZE bytes), "" for none. */
static facet_result draw_frame(model_run *m, uint32_t index, const sequence_frame *frame, const char *output,
                               char *checkpoint, facet_image **image, facet_error *error)
{
    render_run *run = m->run;
    const render_options *o = &m->options;
    uint32_t frame_count = m->frame_count;
    progress shown = {.mode = run->base.progress,
                      .subject = output,
                      .start = interrupt_clock(),
                      .done_before = (double)m->frames_done / frame_count,
                      .share = 1.0 / frame_count,
                      .last_percent = -10};
    facet_camera camera;
    facet_result result = frame_camera(m, index, frame, &camera, error);
    if (result == FACET_OK)
        result = check_thumbnail(m, error);
    double left = interrupt_seconds_left();
    if (result == FACET_OK && left <= 0.0)
        result = fail(error, FACET_ERROR_LIMIT, "%s: the time limit (--time-limit) was reached", output);
    if (result == FACET_OK)
        result = render_checkpoint_name(o, m->model, frame->number, checkpoint, RENDER_NAME_SIZE, error);
    if (result != FACET_OK)
        return result;
    facet_render_desc desc = o->desc;
    desc.allocator = run->base.allocator;
    desc.log = messages_log(&run->base.messages);
    desc.progress = progress_callback(&shown);
    desc.pose = m->sequence.pose;
    desc.camera = &camera;
    desc.environment = m->environment;
    desc.time_limit_s = time_for_frame(m, left);
    if (o->checkpoint && output_make_folders(checkpoint, error) != FACET_OK)
        return FACET_ERROR_WRITE;
    desc.path.checkpoint_path = o->checkpoint ? checkpoint : NULL;
    desc.path.keeps_cancelled = true;
    bool has_bar = shown.mode == PROGRESS_BAR;
    /* an OpenGL driver may compile and render for half a minute without polling */
    if (o->renderer.features & FACET_RENDERER_FEATURE_GL)
        interrupt_begin(output, "OpenGL drew", has_bar);
    else
        interrupt_begin_polling(output, "drawing", has_bar);
    result = facet_renderer_render(m->renderer, &desc, image, error);
    interrupt_end();
    progress_clear();
    return result;
}

static facet_result render_frame(model_run *m, uint32_t index, const sequence_frame *frame,
                                 image_report *report, facet_error *error)
{
    render_run *run = m->run;
    const render_options *o = &m->options;
    double start = interrupt_clock();
    char checkpoint[RENDER_NAME_SIZE] = "";
    facet_image *image = NULL;
    facet_result result = draw_frame(m, index, frame, report->output, checkpoint, &image, error);
    if (result == FACET_ERROR_CANCELLED)
        return fail(error, result, "%.400s: interrupted before there was an image%s%.400s", report->output,
                    *checkpoint ? "; --resume continues " : "", checkpoint);
    if (result != FACET_OK)
        return result;
    double rendered = interrupt_clock();
    result = render_write(o, image, report->output, &run->base.allocator, m->video, error);
    facet_image_view view = facet_image_get_layer(image, 0);
    report->width = view.width;
    report->height = view.height;
    report->exposure_ev = (double)o->desc.exposure_ev;
    report->samples = o->desc.samples;
    report->stats = facet_image_get_render_stats(image);
    report->save_s = interrupt_clock() - rendered;
    report->total_s = interrupt_clock() - start + report->load_s;
    report_partial(&run->base.messages, report, checkpoint);
    run->base.is_interrupted = report->stats.is_partial && interrupt_signal();
    facet_image_destroy(image);
    return result;
}

static void report_frame(render_run *run, const image_report *report)
{
    report_image(&run->base.messages, report, !run->options.output);
    if (run->images)
        json_array_append_new(run->images, report_image_json(report));
}

/* Frames the camera for all images by the first one, which another process renders. */
static facet_result keep_framing_of_first(model_run *m, facet_error *error)
{
    facet_camera camera;
    const sequence_frame first = sequence_at(&m->sequence, 0);
    return frame_camera(m, 0, &first, &camera, error);
}

static facet_result render_frames(model_run *m, facet_error *error)
{
    const render_options *o = &m->options;
    facet_result result = FACET_OK;
    m->frame_count = part_options_frame_count(o, m->sequence.frames.frame_count);
    if (!part_options_has_frame(o, 0))
        TRY(keep_framing_of_first(m, error));
    for (uint32_t i = 0; i < m->sequence.frames.frame_count && result == FACET_OK; i++) {
        if (!part_options_has_frame(o, i))
            continue;
        char name[RENDER_NAME_SIZE];
        sequence_frame frame = sequence_at(&m->sequence, i);
        result = render_name(o, m->model, frame.number, name, sizeof name, error);
        if (result != FACET_OK)
            break;
        image_report report = {
            .model = input_name(m->model->path), .output = name, .load_s = m->frames_done ? 0.0 : m->load_s};
        if (interrupt_signal())
            return fail(error, FACET_ERROR_CANCELLED, "%s: interrupted", name);
        result = check_inputs(m, name, error);
        if (result != FACET_OK)
            return result;
        report.is_kept = o->keeps_existing && !m->video && !o->is_stdout && output_exists(name);
        if (!report.is_kept)
            result = render_frame(m, i, &frame, &report, error);
        messages_flush(&m->run->base.messages);
        if (result == FACET_OK)
            report_frame(m->run, &report);
        m->frames_done++;
        m->has_lost_checkpoint = m->has_lost_checkpoint || report.stats.has_lost_checkpoint;
    }
    if (result == FACET_OK && m->has_lost_checkpoint)
        return fail(error, FACET_ERROR_WRITE, "--checkpoint: %s could not be written; the image is complete",
                    o->checkpoint);
    return result;
}

/* Chooses the environment: that of --env, else the model's own, else the studio. */
static facet_result choose_environment(model_run *m, facet_error *error)
{
    render_run *run = m->run;
    const render_options *o = &m->options;
    facet_result result = FACET_OK;
    if (o->desc.shading == FACET_SHADING_OGL1) /* OpenGL 1 has no environment */
        return FACET_OK;
    if (render_is_lit_by_scene(o, m->scene, &m->sequence.pose)) {
        const facet_environment_desc desc = verb_run_environment_desc(&run->base, o->environment_cache);
        result = facet_environment_create_from_scene(m->scene, &m->sequence.pose, &desc, &m->own_environment,
                                                     error);
        m->environment = m->own_environment;
        return result;
    }
    if (!run->has_environment)
        result = load_environment(run, error);
    m->environment = run->environment;
    return result;
}

/* Frames past the last keyframe repeat its pose; warns, since that is rarely intended. */
static void warn_of_late_frames(const model_run *m)
{
    const sequence *s = &m->sequence;
    uint32_t last = 0;
    for (uint32_t i = 0; i < s->frames.range_count; i++)
        last = s->frames.ranges[i].last > last ? s->frames.ranges[i].last : last;
    if (s->frame_count_there && last > s->frame_count_there + 1)
        message_at(&m->run->base.messages, VERBOSITY_NORMAL,
                   "%s: frame %u is after the end of the animation, which has %u frames at %g a second",
                   input_name(m->model->path), last, s->frame_count_there, m->options.fps);
}

static facet_result open_video(model_run *m, facet_error *error)
{
    char name[RENDER_NAME_SIZE];
    TRY(render_name(&m->options, m->model, 1, name, sizeof name, error));
    TRY(check_inputs(m, name, error));
    return video_open(name, m->options.video, m->options.fps, &m->video, error);
}

/* Meters --exposure auto: one exposure for all frames, against flicker, by the first frame of the whole
 * sequence, so that it does not depend on --frames. */
static facet_result meter(model_run *m, facet_error *error)
{
    render_run *run = m->run;
    const sequence_frame first = sequence_first(&m->sequence);
    facet_camera camera;
    double ev100 = 0.0;
    facet_result result = frame_camera(m, 0, &first, &camera, error);
    if (result != FACET_OK)
        return result;
    facet_render_desc desc = m->options.desc;
    desc.allocator = run->base.allocator;
    desc.log = messages_log(&run->base.messages);
    desc.pose = m->sequence.pose;
    desc.camera = &camera;
    desc.environment = m->environment;
    interrupt_begin(input_name(m->model->path), "metering its light", run->base.progress == PROGRESS_BAR);
    result = facet_renderer_meter(m->renderer, &desc, &ev100, error);
    interrupt_end();
    m->options.desc.exposure_ev += facet_exposure_from_ev100(ev100);
    message_at(&run->base.messages, VERBOSITY_DETAILS, "%s: metered: --exposure %+.2f",
               input_name(m->model->path), (double)m->options.desc.exposure_ev);
    return result;
}

/* Renders all images of a loaded model. */
static facet_result render_scene(render_run *run, const model_name *model, facet_scene *scene, double start,
                                 facet_error *error)
{
    model_run m = {.run = run, .options = run->options, .model = model, .scene = scene};
    interrupt_begin(input_name(model->path), "finding its frames", run->base.progress == PROGRESS_BAR);
    facet_result result = sequence_create(scene, input_name(model->path), &m.options, &m.sequence, error);
    interrupt_end();
    if (result == FACET_OK)
        warn_of_late_frames(&m);
    if (result == FACET_OK)
        result = choose_environment(&m, error);
    messages_flush(&run->base.messages);
    m.load_s = interrupt_clock() - start;
    if (result == FACET_OK)
        result = facet_renderer_create(scene, &run->base.allocator, &m.renderer, error);
    if (result == FACET_OK && m.options.meters_exposure)
        result = meter(&m, error);
    if (result == FACET_OK && m.options.video)
        result = open_video(&m, error);
    if (result == FACET_OK)
        result = render_frames(&m, error);
    facet_result closed = video_close(m.video, result == FACET_OK, error);
    facet_renderer_destroy(m.renderer);
    facet_environment_destroy(m.own_environment);
    sequence_destroy(&m.sequence);
    return result == FACET_OK ? closed : result;
}

/* Whether --no-clobber keeps the only output of model, which is then reported; the model need not be loaded. */
static bool is_kept(render_run *run, const model_name *model)
{
    char name[RENDER_NAME_SIZE];
    facet_error ignored;
    if (!run->options.keeps_existing || run->options.is_stdout ||
        (run->options.is_sequence && !run->options.video) ||
        render_name(&run->options, model, 1, name, sizeof name, &ignored) != FACET_OK || !output_exists(name))
        return false;
    report_frame(run, &(image_report){.model = input_name(model->path), .output = name, .is_kept = true});
    return true;
}

/* The thumbnail of an image. False: the file is none; one that is called so is a broken image. */
static bool render_picture(render_run *run, const model_name *model, double start, facet_result *result,
                           facet_error *error)
{
    char name[RENDER_NAME_SIZE];
    facet_error unread;
    facet_image *image = NULL;
    facet_result loaded = picture_load(model->path, &run->options, &run->base.allocator, &image, &unread);
    if (loaded != FACET_OK && !output_name_has_type(model->path, "hdr exr ktx2"))
        return false;
    if (loaded != FACET_OK) {
        *result = loaded;
        *error = unread;
        return true;
    }
    *result = render_name(&run->options, model, 1, name, sizeof name, error);
    if (*result == FACET_OK && input_is_same_file(model->path, name))
        *result = fail(error, FACET_ERROR_ARGUMENT,
                       "%s: this input would be overwritten; name another output with -o", name);
    if (*result == FACET_OK)
        *result = render_write(&run->options, image, name, &run->base.allocator, NULL, error);
    if (*result == FACET_OK) {
        facet_image_view view = facet_image_get_layer(image, 0);
        report_frame(run, &(image_report){.model = input_name(model->path),
                                          .output = name,
                                          .width = view.width,
                                          .height = view.height,
                                          .total_s = interrupt_clock() - start});
    }
    facet_image_destroy(image);
    return true;
}

static facet_result render_model(render_run *run, const model_name *model, facet_error *error)
{
    if (is_kept(run, model))
        return FACET_OK;
    double start = interrupt_clock();
    facet_scene *scene = NULL;
    facet_result result = load_model(run, model->path, &scene, error);
    messages_flush(&run->base.messages);
    bool may_be_picture = result == FACET_ERROR_UNSUPPORTED || result == FACET_ERROR_INVALID;
    if (may_be_picture && model->path && is_thumbnail(run) && strcmp(model->path, "-") != 0 &&
        render_picture(run, model, start, &result, error))
        return result;
    if (result == FACET_OK)
        result = render_scene(run, model, scene, start, error);
    facet_scene_destroy(scene);
    return result;
}

/* ---- the run ---- */

/* Fails if another model has the same output: neither is rendered. */
static facet_result check_clash(const render_run *run, size_t i, facet_error *error)
{
    char name[RENDER_NAME_SIZE];
    facet_result result = render_name(&run->options, &run->models.models[i], 1, name, sizeof name, error);
    return result == FACET_OK ? model_list_check_clash(&run->models, i, name, error) : result;
}

static facet_result render_one(verb_run *base, size_t i, facet_error *error)
{
    render_run *run = (render_run *)base;
    const model_name *model = &run->models.models[i];
    run->models_left = run->models.count - i;
    run->environment_failed = false;
    facet_result result = check_clash(run, i, error);
    if (result == FACET_OK)
        result = render_model(run, model, error);
    if (result != FACET_OK)
        failure_complete(error,
                         run->environment_failed ? environment_input_name(&run->options.environment)
                                                 : input_name(model->path),
                         base->limits.max_memory_bytes);
    return result;
}

static facet_result read_line(verb_run *base, facet_error *error)
{
    render_run *run = (render_run *)base;
    command_line *c = base->line;
    TRY(model_list_create(c, c->argument_count, &run->models, error));
    TRY(preset_apply(c, error));
    TRY(render_options_read(c, &run->options, error));
    base->limits = run->options.limits;
    return render_names_check(c, &run->options, &run->models, error);
}

static facet_result render(verb_run *base, facet_error *error)
{
    render_run *run = (render_run *)base;
    (void)error;
    run->images = is_given(base->line, OPT_JSON) ? json_array() : NULL;
    if (run->options.note[0])
        message_at(&base->messages, VERBOSITY_NORMAL, "%s", run->options.note);
    verb_run_models(base, &run->models, render_one);
    return FACET_OK;
}

static void add_json(const verb_run *base, json_t *root)
{
    json_object_set(root, "pictures", ((const render_run *)base)->images);
}

static void destroy(verb_run *base)
{
    render_run *run = (render_run *)base;
    json_decref(run->images);
    facet_environment_destroy(run->environment);
    model_list_destroy(&run->models);
}

int cmd_render(command_line *c)
{
    static const verb_work work = {read_line, render, add_json, destroy};
    render_run run = {.options = {.output = NULL}};
    return verb_run_all(&run.base, c, &work);
}
