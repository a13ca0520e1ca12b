/* cmd_view.c - facet view: a window for models and environments, with the options of facet render. */
#include "cli/shared/options.h"

#include "cli/render/sequence.h"
#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/verb_run.h"
#include "cli/view/view_command.h"
#include "cli/view/view_export.h"

#include <stdio.h>
#include <string.h>

const verb view_verb = {
    .name = "view",
    .summary = "show models in a window",
    .arguments = "[MODEL|FOLDER...]",
    .max_arguments = SIZE_MAX,
    .file_types = "glb gltf obj stl ply json",
    .output_types = "png jpg jpeg webp exr hdr pfm y4m",
    .output_hint = "facet render MODEL -o",
    .description =
        "Opens a window that shows the MODEL; the arrow keys go through the other models of its "
        "folder, or through those that are named. Drag to orbit, right drag to pan, scroll to zoom; "
        "H lists the keys. Models, folders and environments can be dropped on the window, and a "
        "model is read again when its files change. Without a MODEL the built-in scene is shown.\n\n"
        "The window renders with OpenGL as facet render --renderer gl does; R switches to "
        "progressive path tracing. Ctrl+C copies the facet render command line of the view. Exit "
        "code 8: there is no display, GLFW or OpenGL.\n\n"
        "With --html there is no window: the view becomes a web page, which needs neither a display nor "
        "OpenGL "
        "to write. The options for light, camera, materials and animation mean the same there.",
    .examples = (const example[]){{"facet view helmet.glb", "one model, and the others of its folder"},
                                  {"facet view models/ --env studio.hdr --background env",
                                   "a folder, under another environment"},
                                  {"facet view ring.glb --renderer path --ground shadow", "path traced"},
                                  {"facet view ring.glb --env sun:45,135 --html ring.html",
                                   "one file that shows the model in any browser"},
                                  {"facet view models/ --html pages/", "a folder for a web server"},
                                  {NULL, NULL}},
    .basics = OPTION_IDS(OPT_ENV, OPT_BACKGROUND, OPT_EXPOSURE, OPT_TONE_MAPPING, OPT_ORBIT, OPT_RENDERER,
                         OPT_GROUND, OPT_ANIMATION, OPT_SIZE, OPT_SHADING, OPT_HTML),
    .groups =
        (const option_group *const[]){
            OPTION_GROUP("Window", OPT_SIZE, OPT_BACKGROUND, OPT_BACKGROUND_BLUR),
            OPTION_GROUP("Camera", OPT_ORBIT, OPT_TARGET, OPT_FOV, OPT_EYE, OPT_UP, OPT_ORTHO, OPT_FRAMING,
                         OPT_CAMERA),
            &light_group, &environment_group, &color_group, &quality_group, &gl_group,
            OPTION_GROUP("Path tracing (--renderer path)", PATH_OPTIONS), &shading_group,
            OPTION_GROUP("Motion", OPT_ANIMATION, OPT_TIME), &scene_group, OPTION_GROUP("Files", OPT_ROOT),
            &legacy_group, &limits_group,
            OPTION_GROUP("Web page (--html)", OPT_HTML, OPT_NO_CLOBBER, OPT_TITLE, OPT_CONTROLS),
            OPTION_GROUP("Messages", OPT_JSON, OPT_QUIET, OPT_VERBOSE, OPT_HELP, OPT_HELP_ALL),
            OPTION_GROUP("Running", OPT_SCRIPT, OPT_CONFIG), NULL},
};

typedef struct view_run {
    verb_run base;
    render_options options;
    bool has_model; /* the first one was read */
} view_run;

/* ---- models ---- */

/* Chooses scene, variant and animation. Names must exist in the first model; other models of the folder
 * are shown without them. */
static facet_result choose_pose(view_run *run, const char *path, facet_view_model *model, facet_error *error)
{
    const render_options *o = &run->options;
    sequence s;
    facet_result result = sequence_create(model->scene, input_name(path), o, &s, error);
    if (result != FACET_OK && run->has_model && result == FACET_ERROR_ARGUMENT)
        return FACET_OK;
    if (result != FACET_OK)
        return result;
    model->pose = s.pose;
    model->animation_count = s.pose.animation_count;
    model->first_animation = s.pose.animation_count ? s.pose.animations[0] : 0;
    model->is_playing = o->animation && !o->has_time;
    model->pose.animations = NULL;
    model->pose.animation_count = 0;
    sequence_destroy(&s);
    return FACET_OK;
}

static facet_result choose_camera(view_run *run, facet_view_model *model, facet_error *error)
{
    render_options o = run->options;
    const render_view view = {.pose = &model->pose};
    bool aims = o.has_target[0] || o.has_target[1] || o.has_target[2];
    bool aims_fully = o.has_target[0] && o.has_target[1] && o.has_target[2];
    facet_camera camera;
    facet_result result = FACET_OK;
    if (o.camera) {
        result = facet_scene_find_camera(model->scene, o.camera, &model->camera, error);
        model->has_camera = result == FACET_OK;
        if (result == FACET_ERROR_ARGUMENT && run->has_model)
            result = FACET_OK;
    } else if (o.has_eye) {
        result = render_camera(model->scene, &view, &o, &model->eye, error);
        model->has_eye = true;
    } else if (aims && !aims_fully) { /* the coordinates that are not given are the model's */
        result = render_camera(model->scene, &view, &o, &camera, error);
        if (result == FACET_OK)
            render_keep_framing(&o, model->scene, &camera);
    }
    model->orbit = render_orbit(model->scene, &model->pose, &o);
    /* without --orbit the user will turn the model first: the distance fits all azimuths */
    model->orbit.fits_all_azimuths = !is_given(run->base.line, OPT_ORBIT);
    return result;
}

static facet_result load_model(void *user, const char *path, facet_view_model *model, facet_error *error)
{
    view_run *run = user;
    const facet_scene_desc desc = verb_run_scene_desc(&run->base);
    *model = (facet_view_model){.scene = NULL};
    facet_result result = input_load_shaded(path, &desc, run->options.desc.shading, &model->scene, error);
    if (result == FACET_OK)
        result = choose_pose(run, path, model, error);
    if (result == FACET_OK)
        result = choose_camera(run, model, error);
    messages_flush(&run->base.messages);
    messages_clear(&run->base.messages);
    if (result == FACET_OK) {
        run->has_model = true;
        return FACET_OK;
    }
    failure_complete(error, input_name(path), run->options.limits.max_memory_bytes);
    facet_scene_destroy(model->scene);
    *model = (facet_view_model){.scene = NULL};
    return result;
}

/* ---- light ---- */

static facet_result load_environment(void *user, const char *name, const facet_view_model *model,
                                     facet_environment **environment, facet_error *error)
{
    view_run *run = user;
    const render_options *o = &run->options;
    const facet_environment_desc desc = verb_run_environment_desc(&run->base, o->environment_cache);
    environment_input input = o->environment;
    *environment = NULL;
    if (o->desc.shading == FACET_SHADING_OGL1) /* OpenGL 1 has no environment */
        return FACET_OK;
    facet_result result = FACET_OK;
    if (name)
        result = environment_input_parse("environment", name, ENVIRONMENT_TAKES_NONE, &input, error);
    bool is_own = !name && render_is_lit_by_scene(o, model->scene, &model->pose);
    if (result == FACET_OK && is_own)
        result = facet_environment_create_from_scene(model->scene, &model->pose, &desc, environment, error);
    else if (result == FACET_OK)
        result = environment_input_load(&input, &desc, environment, error);
    messages_flush(&run->base.messages);
    if (result != FACET_OK)
        failure_complete(error, environment_input_name(&input), run->options.limits.max_memory_bytes);
    return result;
}

/* ---- the run ---- */

static char *describe(void *user, const facet_view_image *image)
{
    const view_run *run = user;
    return view_command(run->base.line, &run->options, image);
}

static void print(void *user, const char *text)
{
    (void)user;
    printf("%s\n", text);
    fflush(stdout);
}

/* Refuses options of --html, which a window ignores. */
static facet_result check_window(const command_line *c, facet_error *error)
{
    static const option_id ids[] = {OPT_HTML, OPT_NO_CLOBBER, OPT_TITLE, OPT_CONTROLS, OPT_JSON};
    if (is_given(c, OPT_HTML))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--html: it is not read from %s; give it on the command line", c->config_name);
    for (size_t i = 0; i < sizeof ids / sizeof *ids; i++)
        if (is_given(c, ids[i]))
            return fail(error, FACET_ERROR_ARGUMENT, "--%s: it needs --html",
                        option_find_id(c->verb, ids[i])->name);
    return FACET_OK;
}

static facet_result read_line(verb_run *base, facet_error *error)
{
    command_line *c = base->line;
    render_options *o = &((view_run *)base)->options;
    TRY(command_line_set(c, option_find_id(c->verb, OPT_RENDERER), "gl", SOURCE_PRESET, error));
    TRY(render_options_read(c, o, error));
    base->limits = o->limits;
    TRY(check_window(c, error));
    if (o->meters_exposure)
        return option_fail(c, OPT_EXPOSURE,
                           "stops or a factor; the window has no light meter, + and - change its exposure",
                           error);
    if (!(o->renderer.features & FACET_RENDERER_FEATURE_VIEW))
        return option_fail(c, OPT_RENDERER, "gl or path; the preview is in facet render", error);
    return FACET_OK;
}

static facet_result show(verb_run *base, facet_error *error)
{
    view_run *run = (view_run *)base;
    static const char *const environments[] = {"neutral", "white", "sun:45,135", "sun:6,120", "none"};
    const command_line *c = run->base.line;
    const render_options *o = &run->options;
    bool is_path = o->renderer.features & FACET_RENDERER_FEATURE_PATH;
    const char *script = option_text(c, OPT_SCRIPT, NULL);
    facet_view_desc desc = {
        .allocator = run->base.allocator,
        .log = messages_log(&run->base.messages),
        .source = {.user = run,
                   .load_model = load_model,
                   .load_environment = load_environment,
                   .describe = describe,
                   .print = print},
        .paths = c->arguments,
        .path_count = (uint32_t)c->argument_count,
        .environments = environments,
        .environment_count = sizeof environments / sizeof *environments,
        .environment = o->environment.kind == ENVIRONMENT_NONE ? NULL : option_text(c, OPT_ENV, NULL),
        .render = o->desc,
        .script = script && strcmp(script, "-") == 0 ? "/dev/stdin" : script};
    if (is_path) {
        desc.path_samples = is_given(c, OPT_SAMPLES) ? o->desc.samples : 0;
        desc.render.samples = 4;
    }
    if (o->note[0])
        message_at(&run->base.messages, VERBOSITY_NORMAL, "%s", o->note);
    return facet_view(&desc, error);
}

static void destroy(verb_run *base)
{
    (void)base; /* the window has released its models */
}

int cmd_view(command_line *c)
{
    if (is_given(c, OPT_HTML))
        return view_export(c);
    static const verb_work parts = {read_line, show, NULL, destroy};
    view_run run = {.has_model = false};
    return verb_run_all(&run.base, c, &parts);
}
