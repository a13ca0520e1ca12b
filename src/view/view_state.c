/* view_state.c - see view_state.h. The keys: view_actions.c. */
#include "view/view_state.h"

#include <math.h>
#include <string.h>

#include "base/result.h"
#include "scene/scene.h"
#include "view/view_camera.h"

void view_state_create(view_state *s, const facet_view_desc *desc)
{
    *s = (view_state){.render = desc->render,
                      .path_samples = desc->path_samples,
                      .camera = VIEW_NO_CAMERA,
                      .speed = 1.0,
                      .help_pages = 1,
                      .scale = 1.0f,
                      .divider = {.position = 0.5},
                      .orbit = scene_orbit_default()};
    facet_render_desc *r = &s->render; /* settings of the window */
    r->allocator = desc->allocator;
    r->log = desc->log;
    r->progress = (facet_progress){0};
    r->camera = NULL;
    r->environment = NULL;
    r->pose = (facet_pose_desc){0};
    memset(r->crop, 0, sizeof r->crop);
    r->aovs = 0;
}

/* ---- the model ---- */

void view_state_set_animations(view_state *s, const uint32_t *animations, uint32_t count)
{
    count = count < VIEW_MAX_ANIMATIONS ? count : VIEW_MAX_ANIMATIONS;
    s->begin_s = HUGE_VAL;
    s->end_s = -HUGE_VAL;
    for (uint32_t i = 0; i < count; i++) {
        const scene_animation *a = &s->scene->animations[animations[i]];
        s->animations[i] = animations[i];
        s->begin_s = fmin(s->begin_s, (double)a->begin_s);
        s->end_s = fmax(s->end_s, (double)a->end_s);
    }
    s->pose.animation_count = count;
    s->pose.animations = s->animations;
}

/* The pose of the previously shown model, as far as the newly read one has what it refers to. */
static void keep_pose(view_state *s, const facet_pose_desc *old)
{
    const facet_scene_counts *c = &s->counts;
    uint32_t kept[VIEW_MAX_ANIMATIONS];
    uint32_t count = 0;
    for (uint32_t i = 0; i < old->animation_count; i++)
        if (s->animations[i] < c->animations)
            kept[count++] = s->animations[i];
    s->pose = *old;
    s->pose.has_variant = old->has_variant && old->variant < c->variants;
    s->pose.has_scene_index = old->has_scene_index && old->scene_index < c->scenes;
    view_state_set_animations(s, kept, count);
    s->is_playing = s->is_playing && count > 0;
    if (s->camera >= (int)c->cameras)
        s->camera = VIEW_NO_CAMERA;
}

void view_state_set_model(view_state *s, const facet_view_model *model, const float low[3],
                          const float high[3], bool keeps_view)
{
    facet_pose_desc old = s->pose;
    s->scene = model->scene;
    s->counts = scene_count(model->scene);
    memcpy(s->low, low, sizeof s->low);
    memcpy(s->high, high, sizeof s->high);
    if (keeps_view) {
        keep_pose(s, &old);
        return;
    }
    uint32_t animations[VIEW_MAX_ANIMATIONS];
    uint32_t count =
        model->animation_count < VIEW_MAX_ANIMATIONS ? model->animation_count : VIEW_MAX_ANIMATIONS;
    for (uint32_t i = 0; i < count; i++)
        animations[i] = model->first_animation + i;
    s->pose = model->pose;
    view_state_set_animations(s, animations, count);
    s->is_playing = model->is_playing && count > 0;
    s->orbit = s->home = model->orbit;
    s->camera = model->has_camera ? (int)model->camera : VIEW_NO_CAMERA;
    if (model->has_eye) {
        float middle[3];
        for (int i = 0; i < 3; i++)
            middle[i] = 0.5f * low[i] + 0.5f * high[i];
        s->orbit = view_camera_orbit(&model->eye, &model->orbit, middle);
        s->needs_framing = s->is_framed = false;
        return;
    }
    s->needs_framing = true;
}

/* ---- time, and the image ---- */

bool view_state_advance(view_state *s, double seconds)
{
    if (!s->is_playing || !(seconds > 0.0))
        return false;
    double length = s->end_s - s->begin_s;
    double time = s->pose.time_s - s->begin_s + seconds * s->speed;
    s->pose.time_s = s->begin_s + (length > 0.0 ? fmod(time, length) : 0.0);
    return true;
}

facet_render_desc view_state_desc(const view_state *s, uint32_t width, uint32_t height, facet_camera *camera)
{
    facet_render_desc desc = s->render;
    desc.width = desc.crop[2] = width;
    desc.height = desc.crop[3] = height;
    desc.pose = s->pose;
    desc.pose.time_s = round(s->pose.time_s * 1e4) / 1e4;
    facet_orbit orbit = view_camera_round(&s->orbit);
    *camera = s->camera == VIEW_NO_CAMERA
                  ? view_camera_of(&orbit, (float)width / (float)height, s->low, s->high)
                  : s->file_camera;
    desc.camera = camera;
    return desc;
}

/* ---- framing: the whole model, in all of its motion ---- */

facet_result view_state_frame(view_state *s, float aspect, facet_error *error)
{
    if (!s->needs_framing || s->camera != VIEW_NO_CAMERA)
        return FACET_OK;
    facet_camera camera;
    facet_orbit wanted = s->orbit;
    wanted.fits_all_times = s->pose.animation_count > 0;
    TRY(scene_fit_orbit(s->scene, &s->pose, &wanted, aspect, &camera, error));
    s->framing = s->orbit;
    facet_orbit *o = &s->orbit;
    double distance2 = 0.0;
    for (int i = 0; i < 3; i++) {
        double d = (double)camera.eye[i] - (double)camera.target[i];
        o->target[i] = camera.target[i];
        distance2 += d * d;
    }
    o->radius = o->is_orthographic
                    ? (float)(0.5 * (double)camera.ortho_height / tan(0.5 * (double)o->fov_y_rad))
                    : (float)sqrt(distance2);
    o->has_target = true;
    s->needs_framing = false;
    s->is_framed = true;
    return FACET_OK;
}

void view_state_show_whole(view_state *s)
{
    facet_orbit whole = scene_orbit_default();
    view_state_leave_file_camera(s);
    whole.azimuth_rad = s->orbit.azimuth_rad;
    whole.polar_rad = s->orbit.polar_rad;
    whole.is_orthographic = s->orbit.is_orthographic;
    whole.is_z_up = s->orbit.is_z_up;
    whole.fov_y_rad = s->orbit.fov_y_rad;
    s->orbit = whole;
    s->needs_framing = true;
}

void view_state_follow_motion(view_state *s)
{
    if (!s->is_framed || s->needs_framing)
        return;
    bool is_orthographic = s->orbit.is_orthographic;
    s->orbit = s->framing;
    s->orbit.is_orthographic = is_orthographic;
    s->needs_framing = true;
}

/* ---- renderers ---- */

/* In the order of the key. OpenGL is first: it draws what moves, and channels and specular lobes are its own. */
static const struct {
    facet_renderer_kind kind;
    bool accumulates;
    const char *title;
} renderers[] = {{FACET_RENDERER_KIND_GL, false, "OpenGL"}, {FACET_RENDERER_KIND_PATH, true, "Path tracing"}};
enum { RENDERER_COUNT = sizeof renderers / sizeof *renderers };

static size_t find_renderer(facet_renderer_kind kind)
{
    size_t i = RENDERER_COUNT - 1;
    while (i > 0 && renderers[i].kind != kind)
        i--;
    return i;
}

bool view_renderer_accumulates(facet_renderer_kind kind)
{
    return renderers[find_renderer(kind)].accumulates;
}

facet_renderer_kind view_renderer_next(facet_renderer_kind kind)
{
    return renderers[(find_renderer(kind) + 1) % RENDERER_COUNT].kind;
}

const char *view_renderer_title(facet_renderer_kind kind)
{
    return renderers[find_renderer(kind)].title;
}

/* ---- the divider ---- */

void view_divider_sides(const view_divider *d, const facet_render_desc *base, facet_render_desc sides[2],
                        const char *labels[2])
{
    static const char *const names[][2] = {
        [VIEW_COMPARE_NOTHING] = {"", ""},
        [VIEW_COMPARE_MASKING] = {"Schlick-GGX, separable", "Smith, height-correlated"},
        [VIEW_COMPARE_SCATTERING] = {"Single scattering", "Multiple scattering"},
        [VIEW_COMPARE_RENDERER] = {"", ""}, /* their titles */
        [VIEW_COMPARE_TONEMAP] = {"Linear", "Tone-mapped"},
        [VIEW_COMPARE_VARIANT] = {"Materials of the file", "Variant"}};
    sides[0] = sides[1] = *base;
    labels[0] = names[d->comparison][0];
    labels[1] = names[d->comparison][1];
    switch (d->comparison) {
    case VIEW_COMPARE_MASKING:
        sides[0].renderer = sides[1].renderer = renderers[0].kind;
        sides[0].gl.brdf = FACET_BRDF_SCHLICK_GGX;
        sides[1].gl.brdf = FACET_BRDF_ENERGY;
        break;
    case VIEW_COMPARE_SCATTERING:
        sides[0].gl.brdf = sides[1].gl.brdf = FACET_BRDF_ENERGY;
        sides[0].energy = FACET_ENERGY_GLTF;
        sides[1].energy = FACET_ENERGY_CONSERVING;
        break;
    case VIEW_COMPARE_RENDERER:
        sides[0].renderer = renderers[0].kind;
        if (!view_renderer_accumulates(base->renderer))
            sides[1].renderer = renderers[1].kind;
        for (int i = 0; i < 2; i++)
            labels[i] = view_renderer_title(sides[i].renderer);
        break;
    case VIEW_COMPARE_TONEMAP:
        sides[0].tonemap = FACET_TONEMAP_NONE;
        if (base->tonemap == FACET_TONEMAP_NONE)
            sides[1].tonemap = FACET_TONEMAP_NEUTRAL;
        break;
    case VIEW_COMPARE_VARIANT:
        sides[0].pose.has_variant = false;
        if (!base->pose.has_variant)
            sides[1].pose.variant = d->variant;
        sides[1].pose.has_variant = true;
        break;
    default:
        break;
    }
}

/* Whether the pointer at x can grab it. reach: px to either side. */
static bool divider_is_at(const view_divider *d, double x, uint32_t width, double reach)
{
    return d->comparison != VIEW_COMPARE_NOTHING && fabs(x - d->position * width) <= reach;
}

static void drag_divider(view_divider *d, double x, uint32_t width)
{
    d->position = width ? fmin(fmax(x / width, 0.02), 0.98) : 0.5;
}

static view_comparison step(view_comparison from, int steps, int count)
{
    return (view_comparison)((((int)from + steps) % count + count) % count);
}

void view_divider_step(view_divider *d, int steps, bool has_variants, facet_renderer_kind renderer)
{
    int count = has_variants ? VIEW_COMPARISON_COUNT : VIEW_COMPARE_VARIANT;
    d->comparison = step(d->comparison, steps, count);
    if (renderer != renderers[0].kind && d->comparison == VIEW_COMPARE_MASKING)
        d->comparison = step(d->comparison, steps, count);
}

unsigned view_state_accumulating_sides(const view_state *s)
{
    facet_render_desc sides[2];
    const char *labels[2];
    view_divider_sides(&s->divider, &s->render, sides, labels);
    bool is_divided = s->divider.comparison != VIEW_COMPARE_NOTHING;
    return (is_divided && view_renderer_accumulates(sides[0].renderer) ? VIEW_SIDE_LEFT : 0u) |
           (view_renderer_accumulates(sides[1].renderer) ? VIEW_SIDE_RIGHT : 0u);
}

bool view_divider_labels(int border, int width, int margin, const int widths[2], int x[2])
{
    int first = margin;
    int last = width - margin - widths[1];
    x[0] = border - margin - widths[0];
    x[1] = border + margin;
    bool is_narrow = x[0] < first || x[1] > last;
    x[0] = x[0] < first ? first : x[0];
    x[1] = x[1] > last ? last : x[1];
    return is_narrow;
}

/* ---- the pointer ---- */

/* Habits from model-viewer and Blender: left and middle button orbit; right, or either with Shift, pans;
 * with Ctrl zooms. */
static void drag(view_state *s, double dx, double dy, unsigned modifiers)
{
    view_state_leave_file_camera(s);
    s->is_framed = false;
    if (modifiers & VIEW_CONTROL)
        view_camera_dolly(&s->orbit, -dy * 40.0 / (s->height ? s->height : 1), (double)view_state_size(s));
    else if (s->button == VIEW_RIGHT_BUTTON || modifiers & VIEW_SHIFT)
        view_camera_pan(&s->orbit, dx, dy, s->height);
    else
        view_camera_turn(&s->orbit, dx, dy, s->height);
}

static void scroll(view_state *s, const view_event *e)
{
    const double pixels = 40.0 * (double)s->scale; /* per step, of two fingers or a wheel */
    view_state_leave_file_camera(s);
    s->is_framed = false;
    if (e->modifiers & VIEW_SHIFT)
        view_camera_pan(&s->orbit, pixels * e->x, pixels * e->y, s->height);
    else if (e->modifiers & VIEW_ALT)
        view_camera_turn(&s->orbit, pixels * e->x, pixels * e->y, s->height);
    else
        view_camera_dolly(&s->orbit, e->y, (double)view_state_size(s));
}

bool view_state_point(view_state *s, const view_event *e)
{
    double dx = e->x - s->x;
    double dy = e->y - s->y;
    switch (e->kind) {
    case VIEW_PRESS:
        s->x = e->x;
        s->y = e->y;
        s->is_held = true;
        s->button = e->button;
        s->held_modifiers = e->modifiers;
        s->divider.is_dragged = e->button == VIEW_LEFT_BUTTON &&
                                divider_is_at(&s->divider, e->x, s->width, 8.0 * (double)s->scale);
        return false;
    case VIEW_RELEASE:
        s->is_held = s->is_held && e->button != s->button;
        s->divider.is_dragged = s->divider.is_dragged && s->is_held;
        return false;
    case VIEW_MOVE:
        s->x = e->x;
        s->y = e->y;
        if (!s->is_held || !s->scene || (dx == 0.0 && dy == 0.0))
            return false;
        if (s->divider.is_dragged)
            drag_divider(&s->divider, e->x, s->width);
        else
            drag(s, dx, dy, s->held_modifiers);
        return true;
    case VIEW_SCROLL:
        if (s->scene)
            scroll(s, e);
        return s->scene != NULL;
    default:
        return false;
    }
}

/* ---- quality while something moves ---- */

static const double slow_s = 0.05, draft_s = 0.02;

bool view_pace_drafts(view_pace *p, bool is_moving)
{
    p->is_draft = is_moving && (p->is_draft || p->full_s > draft_s);
    return p->is_draft;
}

uint32_t view_pace_divisor(const view_pace *p, bool is_moving)
{
    if (!is_moving || p->full_s <= slow_s)
        return 1;
    return p->full_s <= 4.0 * slow_s ? 2 : 4;
}

/* No frame takes more than its pixel count times the time per pixel of a coarse one. This corrects the first
 * frame, in which the driver compiles. */
void view_pace_measure(view_pace *p, uint32_t divisor, double seconds)
{
    double most = seconds * divisor * divisor;
    p->full_s = divisor == 1 ? seconds : fmin(p->full_s, most);
}
