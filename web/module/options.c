/* options.c - the state of a viewer as options of facet render, and options as a change of the state. Both are the
 * command's own code: the writer of the command line that facet view copies, and the parser. Setting an option writes the
 * state as options, replaces one, parses all, and takes over what that option concerns. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/result.h"
#include "cli/render/sequence.h"
#include "cli/shared/suggest.h"
#include "scene/scene.h"
#include "view/view_camera.h"
#include "viewer.h"

/* ---- which options a viewer takes ---- */

/* What a change of an option concerns, beside the settings of the image. */
enum { OF_CAMERA = 1 << 0, OF_POSE = 1 << 1, OF_LIGHT = 1 << 2, OF_MATERIALS = 1 << 3, OF_METER = 1 << 4 };

static const struct {
    option_id id;
    unsigned concerns;
} known[] = {{OPT_ORBIT, OF_CAMERA},
             {OPT_TARGET, OF_CAMERA},
             {OPT_FOV, OF_CAMERA},
             {OPT_EYE, OF_CAMERA},
             {OPT_UP, OF_CAMERA},
             {OPT_ORTHO, OF_CAMERA},
             {OPT_FRAMING, OF_CAMERA},
             {OPT_CAMERA, OF_CAMERA},
             {OPT_CAMERA_MATRIX, OF_CAMERA},
             {OPT_VIEW_MATRIX, OF_CAMERA},
             {OPT_SCENE, OF_POSE | OF_LIGHT},
             {OPT_VARIANT, OF_POSE},
             {OPT_ANIMATION, OF_POSE},
             {OPT_TIME, OF_POSE},
             {OPT_ENV, OF_LIGHT},
             {OPT_LIGHTS, OF_LIGHT},
             {OPT_ENV_INTENSITY, OF_LIGHT},
             {OPT_ENV_ROTATION, 0},
             {OPT_SUN, 0},
             {OPT_GROUND, 0},
             {OPT_BACKGROUND, 0},
             {OPT_BACKGROUND_BLUR, 0},
             {OPT_EXPOSURE, OF_METER},
             {OPT_TONE_MAPPING, 0},
             {OPT_SAMPLES, 0},
             {OPT_QUALITY, 0},
             {OPT_ENERGY, 0},
             {OPT_SPECULAR_AA, 0},
             {OPT_CHANNEL, 0},
             {OPT_BRDF, 0},
             {OPT_TRANSPARENCY, 0},
             {OPT_SHADOWS, 0},
             {OPT_BLOOM, 0},
             {OPT_SHADING, OF_MATERIALS},
             {OPT_OGL1_VARIANT, 0},
             {OPT_OGL1_SPACE, 0},
             {OPT_FOG, 0}};

static facet_result find_option(const char *name, const option **out, unsigned *concerns, facet_error *error)
{
    const verb *render = verb_find("render");
    size_t length = strlen(name);
    *out = option_find(render, name, length);
    if (!*out)
        *out = option_find_attribute(render, name, length);
    if (!*out)
        return suggest_option(render, name, length, error);
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (known[i].id == (*out)->id) {
            *concerns = known[i].concerns;
            return FACET_OK;
        }
    return fail(error, FACET_ERROR_ARGUMENT, "--%s: it is an option of the command, not of a view", name);
}

/* Takes out what the new option replaces. */
static void remove_rivals(view_options *list, option_id id, unsigned concerns, const char *text)
{
    static const option_id of_orbit[] = {OPT_ORBIT, OPT_TARGET, OPT_FOV,     OPT_EYE,
                                         OPT_UP,    OPT_ORTHO,  OPT_FRAMING, OPT_CAMERA};
    bool is_whole = id == OPT_CAMERA || id == OPT_CAMERA_MATRIX || id == OPT_VIEW_MATRIX;
    for (size_t i = 0; is_whole && i < sizeof of_orbit / sizeof *of_orbit; i++)
        view_options_remove(list, of_orbit[i]);
    if (concerns & OF_CAMERA)
        view_options_remove(list, OPT_CAMERA);
    if (id == OPT_EYE)
        view_options_remove(list, OPT_ORBIT);
    if (id == OPT_ANIMATION)
        view_options_remove(list, OPT_TIME);
    if (id == OPT_SCENE && text) /* animations move another scene's nodes */
        view_options_remove(list, OPT_TIME);
    view_options_remove(list, id);
}

/* ---- writing ---- */

/* The orbit as it was before framing, if the state shows just what framing found. */
static const facet_orbit *find_framing(const view_state *s)
{
    if (s->needs_framing)
        return &s->orbit;
    bool is_same = s->is_framed && s->orbit.is_orthographic == s->framing.is_orthographic &&
                   s->orbit.fov_y_rad == s->framing.fov_y_rad;
    return is_same ? &s->framing : NULL;
}

void web_options_list(const viewer *v, uint32_t width, uint32_t height, bool is_whole, view_options *out)
{
    facet_camera camera;
    const view_state *s = &v->state;
    const facet_orbit *framing = is_whole ? NULL : find_framing(s);
    const facet_render_desc desc = view_state_desc(s, width, height, &camera);
    const facet_orbit orbit = framing ? *framing : view_camera_round(&s->orbit);
    facet_view_image image = {.model = v->path && *v->path ? v->path : NULL,
                              .render = &desc,
                              .orbit = s->camera == VIEW_NO_CAMERA ? &orbit : NULL,
                              .camera = s->camera == VIEW_NO_CAMERA ? 0 : (uint32_t)s->camera};
    if (v->scene)
        facet_scene_get_origin(v->scene, image.origin);
    view_options_of(&v->line, &v->options, &image, out);
}

char *web_options_command(const viewer *v, uint32_t width, uint32_t height)
{
    facet_camera camera;
    const view_state *s = &v->state;
    const facet_render_desc desc = view_state_desc(s, width, height, &camera);
    const facet_orbit orbit = view_camera_round(&s->orbit);
    facet_view_image image = {.model = v->path && *v->path ? v->path : NULL,
                              .render = &desc,
                              .orbit = s->camera == VIEW_NO_CAMERA ? &orbit : NULL,
                              .camera = s->camera == VIEW_NO_CAMERA ? 0 : (uint32_t)s->camera};
    if (v->scene)
        facet_scene_get_origin(v->scene, image.origin);
    return view_command(&v->line, &v->options, &image);
}

/* ---- parsing ---- */

/* A list of options, parsed. Texts of line and options are those of list. */
typedef struct parsed {
    view_options list;
    command_line line;
    render_options options;
} parsed;

static void destroy(parsed *p)
{
    command_line_destroy(&p->line);
    view_options_destroy(&p->list);
}

static facet_result parse(parsed *p, facet_error *error)
{
    const verb *render = verb_find("render");
    if (p->list.has_failed)
        return fail_memory(error, "options", p->list.count * sizeof *p->list.items);
    p->line = (command_line){.verb = render};
    view_options_remove(&p->list, OPT_RENDERER);
    for (size_t i = 0; i < p->list.count; i++) {
        const view_option *o = &p->list.items[i];
        TRY(command_line_set(&p->line, o->option, option_takes_value(o->option) ? o->value : NULL,
                             SOURCE_COMMAND_LINE, error));
    }
    TRY(command_line_set(&p->line, option_find_id(render, OPT_RENDERER), "gl", SOURCE_PRESET, error));
    return render_options_read(&p->line, &p->options, error);
}

/* ---- taking over ---- */

/* The settings of the image. */
static void take_render(viewer *v, const render_options *o)
{
    const facet_render_desc old = v->state.render;
    facet_render_desc *r = &v->state.render;
    *r = o->desc;
    r->allocator = old.allocator;
    r->log = old.log;
    r->width = r->height = 0; /* those of each image */
    memset(r->crop, 0, sizeof r->crop);
    r->aovs = 0;
}

static facet_result take_pose(viewer *v, const render_options *o, facet_error *error)
{
    view_state *s = &v->state;
    double before[3], after[3];
    sequence chosen;
    facet_scene_get_origin(v->scene, before);
    TRY(sequence_create(v->scene, v->path, o, &chosen, error));
    facet_scene_get_origin(v->scene, after);
    bool has_moved = memcmp(before, after, sizeof before) != 0;
    s->pose = chosen.pose;
    view_state_set_animations(s, chosen.pose.animations, chosen.pose.animation_count);
    s->is_playing = s->is_playing && chosen.pose.animation_count > 0;
    sequence_destroy(&chosen);
    view_state_follow_motion(s);
    if (!has_moved)
        return FACET_OK;
    s->needs_framing = true;
    return web_model_find_bounds(v, error);
}

static facet_result take_file_camera(viewer *v, const char *name, facet_error *error)
{
    view_state *s = &v->state;
    uint32_t index;
    TRY(facet_scene_find_camera(v->scene, name, &index, error));
    TRY(facet_camera_from_scene(v->scene, &s->pose, index, &s->file_camera, error));
    s->camera = (int)index;
    return FACET_OK;
}

static facet_result take_camera(viewer *v, const render_options *given, facet_error *error)
{
    view_state *s = &v->state;
    render_options o = *given;
    const render_view view = {.pose = &s->pose};
    facet_camera camera;
    float middle[3];
    if (o.camera)
        return take_file_camera(v, o.camera, error);
    o.desc.width = s->width ? s->width : 1;
    o.desc.height = s->height ? s->height : 1;
    bool aims = o.has_target[0] || o.has_target[1] || o.has_target[2];
    bool aims_fully = o.has_target[0] && o.has_target[1] && o.has_target[2];
    if (o.has_eye || (aims && !aims_fully))
        TRY(render_camera(v->scene, &view, &o, &camera, error));
    if (!o.has_eye && aims && !aims_fully)
        render_keep_framing(&o, v->scene, &camera);
    s->orbit = render_orbit(v->scene, &s->pose, &o);
    s->camera = VIEW_NO_CAMERA;
    s->is_framed = false;
    s->needs_framing = !o.has_eye && !(s->orbit.radius > 0.0f && s->orbit.has_target);
    for (int i = 0; i < 3; i++)
        middle[i] = 0.5f * s->low[i] + 0.5f * s->high[i];
    if (o.has_eye)
        s->orbit = view_camera_orbit(&camera, &s->orbit, middle);
    return FACET_OK;
}

static facet_result make_light(viewer *v, const parsed *p, web_light **out, facet_error *error)
{
    const facet_environment_desc desc = {.log = web_viewer_log(v)};
    const render_options *o = &p->options;
    *out = NULL;
    if (o->desc.shading == FACET_SHADING_OGL1) /* OpenGL 1 has no environment */
        return FACET_OK;
    if (v->scene && render_is_lit_by_scene(o, v->scene, &v->state.pose))
        return web_light_create_from_scene(v->scene, &v->state.pose, &desc, out, error);
    return web_light_create(option_text(&p->line, OPT_ENV, "neutral"), &o->environment, &desc, v->file_light,
                            out, error);
}

static void take_light(viewer *v, const parsed *p, web_light *light)
{
    v->file_light = web_light_keep_file(light, v->file_light, option_text(&p->line, OPT_ENV, "neutral"));
    web_light_release(v->light);
    v->light = light;
}

/* From now on the parsed options are the viewer's. */
static void keep(viewer *v, parsed *p)
{
    parsed old = {v->given, v->line, v->options};
    v->given = p->list;
    v->line = p->line;
    v->options = p->options;
    destroy(&old);
    *p = (parsed){.list = {0}};
}

static facet_result take(viewer *v, parsed *p, unsigned concerns, facet_error *error)
{
    const render_options *o = &p->options;
    web_light *light = NULL;
    if (concerns & (OF_POSE | OF_CAMERA) && !v->scene)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "there is no model yet for cameras, animations and variants");
    if (concerns & (OF_LIGHT | OF_MATERIALS))
        TRY(make_light(v, p, &light, error));
    facet_result result = FACET_OK;
    if (concerns & OF_MATERIALS && o->desc.shading != v->state.render.shading)
        result = web_model_reload(v, o->desc.shading, error);
    if (result == FACET_OK && concerns & OF_POSE)
        result = take_pose(v, o, error);
    if (result == FACET_OK && concerns & OF_CAMERA)
        result = take_camera(v, o, error);
    if (result != FACET_OK) {
        web_light_release(light);
        return result;
    }
    if (concerns & (OF_LIGHT | OF_MATERIALS))
        take_light(v, p, light);
    take_render(v, o);
    return FACET_OK;
}

/* ---- the interface ---- */

facet_result web_options_create(viewer *v, facet_error *error)
{
    parsed p = {.list = {0}};
    facet_result result = parse(&p, error);
    if (result == FACET_OK)
        result = take(v, &p, OF_LIGHT, error);
    if (result == FACET_OK)
        keep(v, &p);
    destroy(&p);
    return result;
}

void web_options_destroy(viewer *v)
{
    parsed old = {v->given, v->line, v->options};
    destroy(&old);
    web_light_release(v->light);
    web_light_release(v->file_light);
}

/* --exposure auto: what the meter reads becomes the exposure. */
static facet_result meter(viewer *v, facet_error *error)
{
    float stops;
    TRY(web_draw_meter(v, &stops, error));
    v->state.render.exposure_ev += stops;
    return FACET_OK;
}

static bool is_off(const option *o, const char *text)
{
    return !text || (!option_takes_value(o) && (strcmp(text, "false") == 0 || strcmp(text, "0") == 0));
}

facet_result web_options_set(viewer *v, const char *name, const char *text, facet_error *error)
{
    const option *o;
    unsigned concerns;
    parsed p = {.list = {0}};
    TRY(find_option(name, &o, &concerns, error));
    web_options_list(v, v->state.width, v->state.height, false, &p.list);
    remove_rivals(&p.list, o->id, concerns, text);
    if (!is_off(o, text))
        view_options_add(&p.list, o, option_takes_value(o) ? text : "");
    facet_result result = parse(&p, error);
    if (result == FACET_OK)
        result = take(v, &p, concerns, error);
    if (result == FACET_OK && p.options.meters_exposure)
        result = meter(v, error);
    if (result == FACET_OK)
        keep(v, &p);
    destroy(&p);
    return result;
}

facet_result web_options_open(viewer *v, facet_error *error)
{
    static const option_id of_models[] = {OPT_ANIMATION, OPT_TIME, OPT_SCENE, OPT_VARIANT};
    parsed p = {.list = {0}};
    web_options_list(v, v->state.width, v->state.height, false, &p.list);
    for (size_t i = 0; i < sizeof of_models / sizeof *of_models; i++)
        view_options_remove(&p.list, of_models[i]);
    facet_result result = parse(&p, error);
    if (result == FACET_OK)
        result = take(v, &p, OF_LIGHT, error);
    if (result == FACET_OK)
        keep(v, &p);
    destroy(&p);
    return result;
}
