/* view_actions.c - what keys change in a view_state. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "scene/scene.h"
#include "view/view_camera.h"
#include "view/view_state.h"

/* ---- names of settings ---- */

const char *view_tonemap_name(facet_tonemap tonemap)
{
    static const char *const names[] = {[FACET_TONEMAP_NONE] = "none",
                                        [FACET_TONEMAP_NEUTRAL] = "Khronos PBR Neutral",
                                        [FACET_TONEMAP_ACES] = "ACES (Hill)",
                                        [FACET_TONEMAP_ACES_NARKOWICZ] = "ACES (Narkowicz)",
                                        [FACET_TONEMAP_AGX] = "AgX",
                                        [FACET_TONEMAP_REINHARD] = "Reinhard",
                                        [FACET_TONEMAP_REINHARD_EXTENDED] = "Reinhard, extended",
                                        [FACET_TONEMAP_HABLE] = "Hable"};
    return names[tonemap];
}

const char *view_channel_name(facet_channel channel)
{
    static const char *const names[FACET_CHANNEL_COUNT] = {[FACET_CHANNEL_LIGHT] = "all light",
                                                           [FACET_CHANNEL_NORMAL] = "normal",
                                                           [FACET_CHANNEL_BASE_COLOR] = "base color",
                                                           [FACET_CHANNEL_ROUGHNESS] = "roughness",
                                                           [FACET_CHANNEL_METALLIC] = "metallic",
                                                           [FACET_CHANNEL_OCCLUSION] = "occlusion",
                                                           [FACET_CHANNEL_OPACITY] = "opacity",
                                                           [FACET_CHANNEL_NDOTV] = "N.V",
                                                           [FACET_CHANNEL_DIFFUSE] = "diffuse light",
                                                           [FACET_CHANNEL_SPECULAR] = "specular light",
                                                           [FACET_CHANNEL_CLEARCOAT] = "clearcoat",
                                                           [FACET_CHANNEL_SHEEN] = "sheen",
                                                           [FACET_CHANNEL_TRANSMISSION] = "transmission",
                                                           [FACET_CHANNEL_EMISSION] = "emission",
                                                           [FACET_CHANNEL_FURNACE] = "furnace"};
    return names[channel];
}

const char *view_brdf_name(facet_brdf brdf)
{
    static const char *const names[] = {[FACET_BRDF_ENERGY] = "Smith, height-correlated",
                                        [FACET_BRDF_SCHLICK_GGX] = "Schlick-GGX, separable",
                                        [FACET_BRDF_MULTISCATTER] = "Smith, with multiple scattering"};
    return names[brdf];
}

const char *view_energy_name(facet_energy energy)
{
    return energy == FACET_ENERGY_CONSERVING ? "conserving" : "as glTF has it";
}

const char *view_transparency_name(facet_transparency transparency)
{
    static const char *const names[] = {[FACET_TRANSPARENCY_SORTED] = "sorted",
                                        [FACET_TRANSPARENCY_PEELED] = "depth peeling",
                                        [FACET_TRANSPARENCY_WEIGHTED] = "weighted"};
    return names[transparency];
}

static const char *background_name(facet_background background)
{
    static const char *const names[] = {[FACET_BACKGROUND_TRANSPARENT] = "transparent",
                                        [FACET_BACKGROUND_COLOR] = "color",
                                        [FACET_BACKGROUND_ENVIRONMENT] = "environment"};
    return names[background];
}

/* ---- actions ---- */

static const double degree = 0.017453292519943295; /* pi / 180 */

static int wrap(int value, int count)
{
    return count > 0 ? (value % count + count) % count : 0;
}

static void say(view_state *s, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void say(view_state *s, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(s->message, sizeof s->message, format, arguments);
    va_end(arguments);
}

/* "Camera 1 of 2: Hero"; not every file has names. */
static void say_which(view_state *s, const char *what, int index, int count, const char *name)
{
    say(s, "%s %d of %d%s%s", what, index + 1, count, *name ? ": " : "", name);
}

static void step_animation(view_state *s, int steps)
{
    int count = (int)s->counts.animations;
    if (count == 0) {
        say(s, "The model has no animation");
        return;
    }
    int now = s->pose.animation_count ? (int)s->animations[0] : VIEW_NO_ANIMATION;
    int next = wrap(now + 1 + steps, count + 1) - 1;
    uint32_t index = (uint32_t)next;
    view_state_set_animations(s, &index, next == VIEW_NO_ANIMATION ? 0 : 1);
    s->pose.time_s = next == VIEW_NO_ANIMATION ? 0.0 : s->begin_s;
    s->is_playing = next != VIEW_NO_ANIMATION;
    view_state_follow_motion(s);
    if (next == VIEW_NO_ANIMATION)
        say(s, "Animation: none");
    else
        say_which(s, "Animation", next, count, s->scene->animations[next].name);
}

static void play(view_state *s)
{
    if (s->counts.animations && !s->pose.animation_count) {
        step_animation(s, 1);
        return;
    }
    if (!s->counts.animations) {
        say(s, "The model has no animation");
        return;
    }
    s->is_playing = !s->is_playing;
    say(s, s->is_playing ? "Playing" : "Paused at %.2f s", s->pose.time_s);
}

static void scrub(view_state *s, int frames)
{
    if (!s->pose.animation_count)
        step_animation(s, 1);
    if (!s->pose.animation_count)
        return;
    s->is_playing = false;
    s->pose.time_s = fmin(fmax(s->pose.time_s + frames / 24.0, s->begin_s), s->end_s);
    say(s, "%.2f of %.2f s", s->pose.time_s - s->begin_s, s->end_s - s->begin_s);
}

static void step_variant(view_state *s, int steps)
{
    int count = (int)s->counts.variants;
    if (count == 0) {
        say(s, "The model has no variants of its materials");
        return;
    }
    int next = wrap((s->pose.has_variant ? (int)s->pose.variant + 1 : 0) + steps, count + 1);
    s->pose.has_variant = next > 0;
    s->pose.variant = next > 0 ? (uint32_t)next - 1 : 0;
    say(s, "Variant: %s", next > 0 ? s->scene->variants[next - 1] : "none");
}

static void step_camera(view_state *s, int steps)
{
    int count = (int)s->counts.cameras;
    if (count == 0) {
        say(s, "The model has no camera");
        return;
    }
    s->camera = wrap(s->camera + 1 + steps, count + 1) - 1;
    if (s->camera == VIEW_NO_CAMERA) {
        s->orbit = s->home;
        s->needs_framing = true;
        say(s, "Camera: none of the file");
    } else {
        say_which(s, "Camera", s->camera, count, s->scene->cameras[s->camera].name);
    }
}

float view_state_size(const view_state *s)
{
    float size = 0.0f;
    for (int i = 0; i < 3; i++)
        size = fmaxf(size, s->high[i] - s->low[i]);
    return size > 0.0f ? size : 1.0f;
}

void view_state_leave_file_camera(view_state *s)
{
    if (s->camera == VIEW_NO_CAMERA)
        return;
    float middle[3];
    for (int i = 0; i < 3; i++)
        middle[i] = 0.5f * s->low[i] + 0.5f * s->high[i];
    s->orbit = view_camera_orbit(&s->file_camera, &s->orbit, middle);
    s->camera = VIEW_NO_CAMERA;
    s->needs_framing = s->is_framed = false;
}

static void step_background(view_state *s)
{
    facet_render_desc *r = &s->render;
    r->background = r->background == FACET_BACKGROUND_COLOR         ? FACET_BACKGROUND_ENVIRONMENT
                    : r->background == FACET_BACKGROUND_ENVIRONMENT ? FACET_BACKGROUND_TRANSPARENT
                                                                    : FACET_BACKGROUND_COLOR;
    say(s, "Background: %s", background_name(r->background));
}

static void step_blur(view_state *s)
{
    facet_render_desc *r = &s->render;
    r->background_blur = r->background_blur < 0.1f ? 0.2f : r->background_blur < 0.3f ? 0.5f : 0.0f;
    r->background = FACET_BACKGROUND_ENVIRONMENT;
    say(s, "Blur of the background: %.1f", (double)r->background_blur);
}

static void step_tonemap(view_state *s, int steps)
{
    facet_render_desc *r = &s->render;
    r->tonemap = (facet_tonemap)wrap((int)r->tonemap + steps, FACET_TONEMAP_HABLE + 1);
    say(s, "Tone mapping: %s", view_tonemap_name(r->tonemap));
}

static void step_channel(view_state *s, int steps)
{
    facet_gl_desc *gl = &s->render.gl;
    gl->channel = (facet_channel)wrap((int)gl->channel + steps, FACET_CHANNEL_COUNT);
    if (gl->channel != FACET_CHANNEL_LIGHT)
        s->render.renderer = FACET_RENDERER_KIND_GL; /* the others draw light only */
    say(s, "Channel: %s", view_channel_name(gl->channel));
}

static void step_renderer(view_state *s)
{
    s->render.renderer = view_renderer_next(s->render.renderer);
    if (s->render.renderer != FACET_RENDERER_KIND_GL) {
        s->render.gl.channel = FACET_CHANNEL_LIGHT;
        if (s->divider.comparison == VIEW_COMPARE_MASKING)
            s->divider.comparison = VIEW_COMPARE_NOTHING;
    }
    say(s, "Renderer: %s", view_renderer_title(s->render.renderer));
}

bool view_state_has_casters(const view_state *s)
{
    const float *sun = s->render.sun.illuminance_lux;
    return (s->counts.lights && !s->render.ignores_scene_lights) || sun[0] + sun[1] + sun[2] > 0.0f;
}

uint32_t view_state_find_variant(const view_state *s)
{
    const facet_scene *scene = s->scene;
    if (!scene)
        return 0;
    for (uint32_t v = 0; v < scene->variant_count; v++)
        for (uint32_t m = 0; m < scene->mesh_count; m++)
            for (uint32_t i = 0; i < scene->meshes[m].primitive_count; i++) {
                const scene_primitive *p = &scene->meshes[m].primitives[i];
                uint32_t material = p->variant_materials ? p->variant_materials[v] : SCENE_NONE;
                if (material != SCENE_NONE && material != p->material)
                    return v;
            }
    return 0;
}

static void step_divider(view_state *s, int steps)
{
    view_divider_step(&s->divider, steps, s->counts.variants > 0, s->render.renderer);
    s->divider.variant = view_state_find_variant(s);
    if (s->divider.comparison == VIEW_COMPARE_NOTHING) /* otherwise the sides have labels */
        say(s, "No comparison");
}

static bool apply_camera(view_state *s, view_action action, int amount)
{
    switch (action) {
    case VIEW_ACTION_FRAME:
        view_state_show_whole(s);
        break;
    case VIEW_ACTION_LOOK:
        view_state_show_whole(s);
        view_camera_look(&s->orbit, (view_direction)amount);
        break;
    case VIEW_ACTION_PROJECTION:
        view_state_leave_file_camera(s);
        s->orbit.is_orthographic = !s->orbit.is_orthographic;
        say(s, "Projection: %s", s->orbit.is_orthographic ? "parallel" : "perspective");
        break;
    case VIEW_ACTION_CAMERA:
        step_camera(s, amount);
        break;
    default:
        return false;
    }
    return true;
}

static bool apply_motion(view_state *s, view_action action, int amount)
{
    switch (action) {
    case VIEW_ACTION_PLAY:
        play(s);
        break;
    case VIEW_ACTION_ANIMATION:
        step_animation(s, amount);
        break;
    case VIEW_ACTION_SCRUB:
        scrub(s, amount);
        break;
    case VIEW_ACTION_SPEED:
        s->speed = fmin(fmax(ldexp(s->speed, amount), 1.0 / 64.0), 64.0);
        say(s, "Speed: %g", s->speed);
        break;
    case VIEW_ACTION_VARIANT:
        step_variant(s, amount);
        break;
    default:
        return false;
    }
    return true;
}

/* Rounds to short decimals: degrees to thousandths, as options are read; stops to ten thousandths; factors
 * to five digits. */
static float turn(float radians, double degrees)
{
    double turned = round(((double)radians / degree + degrees) * 1e3) / 1e3;
    return (float)((remainder(turned, 360.0) + 0.0) * degree);
}

/* Keeps thirds of a stop exact. */
static double step_third(float stops, int steps)
{
    double thirds = 3.0 * (double)stops;
    if (fabs(thirds - round(thirds)) < 0.01)
        thirds = round(thirds);
    return (thirds + steps) / 3.0;
}

static float step_intensity(float stops, int steps)
{
    double factor = exp2(step_third(stops, steps));
    double unit = pow(10.0, 4.0 - floor(log10(factor)));
    return (float)log2(round(factor * unit) / unit);
}

static bool apply_light(view_state *s, view_action action, int amount)
{
    facet_render_desc *r = &s->render;
    switch (action) {
    case VIEW_ACTION_ENVIRONMENT_ROTATION:
        r->environment_rotation_rad = turn(r->environment_rotation_rad, 15.0 * amount);
        say(s, "Environment turned by %.0f degrees", (double)r->environment_rotation_rad / degree);
        break;
    case VIEW_ACTION_ENVIRONMENT_INTENSITY:
        r->environment_ev = step_intensity(r->environment_ev, amount);
        say(s, "Light of the environment: %.2f", exp2((double)r->environment_ev));
        break;
    case VIEW_ACTION_LIGHTS:
        r->ignores_scene_lights = !r->ignores_scene_lights;
        say(s, "Lights of the file: %s%s", r->ignores_scene_lights ? "off" : "on",
            s->counts.lights || s->counts.image_lights ? "" : "; it has none");
        break;
    case VIEW_ACTION_SHADOWS:
        r->gl.has_shadows = !r->gl.has_shadows;
        say(s, "Shadows of lights: %s%s", r->gl.has_shadows ? "on" : "off",
            view_state_has_casters(s) ? "" : "; there is no light of the file and no sun to cast any");
        break;
    case VIEW_ACTION_GROUND:
        r->ground = r->ground == FACET_GROUND_NONE ? FACET_GROUND_SHADOW : FACET_GROUND_NONE;
        say(s, "Shadow on the ground: %s", r->ground == FACET_GROUND_SHADOW ? "on" : "off");
        break;
    default:
        return false;
    }
    return true;
}

static bool apply_image(view_state *s, view_action action, int amount)
{
    facet_render_desc *r = &s->render;
    switch (action) {
    case VIEW_ACTION_BACKGROUND:
        step_background(s);
        break;
    case VIEW_ACTION_BLUR:
        step_blur(s);
        break;
    case VIEW_ACTION_EXPOSURE:
        r->exposure_ev = (float)(round(step_third(r->exposure_ev, amount) * 1e4) / 1e4);
        say(s, "Exposure: %+.2f stops", (double)r->exposure_ev);
        break;
    case VIEW_ACTION_TONEMAP:
        step_tonemap(s, amount);
        break;
    case VIEW_ACTION_BLOOM:
        r->gl.bloom = r->gl.bloom > 0.0f ? 0.0f : 0.04f;
        say(s, "Bloom: %s", r->gl.bloom > 0.0f ? "on" : "off");
        break;
    default:
        return false;
    }
    return true;
}

static bool apply_rendering(view_state *s, view_action action, int amount)
{
    facet_render_desc *r = &s->render;
    switch (action) {
    case VIEW_ACTION_RENDERER:
        step_renderer(s);
        break;
    case VIEW_ACTION_DENOISE:
        r->path.denoises = !r->path.denoises;
        say(s, "Denoising of path tracing: %s", r->path.denoises ? "on" : "off");
        break;
    case VIEW_ACTION_CHANNEL:
        step_channel(s, amount);
        break;
    case VIEW_ACTION_WHOLE:
        r->gl.channel = FACET_CHANNEL_LIGHT;
        s->divider.comparison = VIEW_COMPARE_NOTHING;
        say(s, "Channel: %s", view_channel_name(r->gl.channel));
        break;
    case VIEW_ACTION_BRDF:
        r->gl.brdf = (facet_brdf)wrap((int)r->gl.brdf + 1, FACET_BRDF_MULTISCATTER + 1);
        say(s, "Specular lobe: %s", view_brdf_name(r->gl.brdf));
        break;
    case VIEW_ACTION_ENERGY:
        r->energy = r->energy == FACET_ENERGY_GLTF ? FACET_ENERGY_CONSERVING : FACET_ENERGY_GLTF;
        say(s, "Energy: %s", view_energy_name(r->energy));
        break;
    case VIEW_ACTION_DIVIDER:
        step_divider(s, amount);
        break;
    case VIEW_ACTION_TRANSPARENCY:
        r->gl.transparency =
            (facet_transparency)wrap((int)r->gl.transparency + 1, FACET_TRANSPARENCY_WEIGHTED + 1);
        say(s, "Transparency: %s", view_transparency_name(r->gl.transparency));
        break;
    default:
        return false;
    }
    return true;
}

bool view_state_apply(view_state *s, view_action action, int amount)
{
    s->message[0] = 0;
    if (action == VIEW_ACTION_HELP) {
        s->help_page = s->help_page < s->help_pages ? s->help_page + 1 : 0;
        return true;
    }
    if (action == VIEW_ACTION_VALUES) {
        s->shows_values = !s->shows_values;
        return true;
    }
    if (apply_image(s, action, amount) || apply_light(s, action, amount) ||
        apply_rendering(s, action, amount))
        return true;
    bool is_about_model = action >= VIEW_ACTION_VARIANT && action <= VIEW_ACTION_SPEED;
    if (!s->scene && is_about_model)
        return true;
    return apply_camera(s, action, amount) || apply_motion(s, action, amount);
}
