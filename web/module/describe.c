/* describe.c - the state of a viewer as JSON. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "scene/scene.h"
#include "viewer.h"

/* A copy in malloc() memory, which JavaScript frees; NULL: no memory. */
static char *finish(text *t)
{
    char *copy = t->has_failed || !t->data ? NULL : strdup(t->data);
    text_destroy(t);
    return copy;
}

char *web_describe_options(const viewer *v)
{
    static const option_id of_orbit[] = {OPT_ORBIT, OPT_TARGET, OPT_FOV};
    text t = {0};
    view_options list = {0};
    web_options_list(v, v->state.width, v->state.height, false, &list);
    for (size_t i = 0; web_camera_is_home(v) && i < sizeof of_orbit / sizeof *of_orbit; i++)
        view_options_remove(&list, of_orbit[i]);
    t.has_failed = list.has_failed;
    text_json_begin_object(&t, NULL);
    for (size_t i = 0; i < list.count; i++) {
        const view_option *o = &list.items[i];
        if (o->option->id != OPT_RENDERER)
            text_json_string(&t, o->option->name, option_takes_value(o->option) ? o->value : "true");
    }
    text_json_end_object(&t);
    view_options_destroy(&list);
    return finish(&t);
}

static void number(text *t, const char *key, double value)
{
    char digits[TEXT_FLOAT_SIZE];
    text_shortest_double(value, digits);
    text_json_raw(t, key, isfinite(value) ? digits : NULL);
}

static void index_or_null(text *t, const char *key, bool is_given, int64_t index)
{
    if (is_given)
        text_json_integer(t, key, index);
    else
        text_json_raw(t, key, NULL);
}

static void describe_bounds(text *t, const viewer *v)
{
    const view_state *s = &v->state;
    double low[3], high[3], size[3], origin[3];
    facet_scene_get_origin(v->scene, origin);
    for (int i = 0; i < 3; i++) {
        low[i] = origin[i] + (double)s->low[i];
        high[i] = origin[i] + (double)s->high[i];
        size[i] = (double)s->high[i] - (double)s->low[i];
    }
    text_json_begin_object(t, "bounds");
    text_json_doubles(t, "min", low, 3);
    text_json_doubles(t, "max", high, 3);
    text_json_end_object(t);
    text_json_doubles(t, "size", size, 3);
}

static void describe_orbit(text *t, const viewer *v)
{
    const double degree = 0.017453292519943295; /* pi / 180 */
    const facet_orbit *o = &v->state.orbit;
    double target[3], origin[3] = {0.0, 0.0, 0.0};
    if (v->scene)
        facet_scene_get_origin(v->scene, origin);
    for (int i = 0; i < 3; i++)
        target[i] = origin[i] + (double)o->target[i];
    text_json_begin_object(t, "orbit");
    number(t, "azimuth", (double)o->azimuth_rad / degree);
    number(t, "polar", (double)o->polar_rad / degree);
    number(t, "radius", (double)o->radius);
    text_json_doubles(t, "target", target, 3);
    number(t, "fov", (double)o->fov_y_rad / degree);
    text_json_bool(t, "isOrthographic", o->is_orthographic);
    text_json_bool(t, "isFramed", v->state.needs_framing || v->state.is_framed);
    text_json_end_object(t);
}

/* Names, and beside them when each begins and ends. */
static void describe_animations(text *t, const facet_scene *scene)
{
    text_json_begin_array(t, "animations");
    for (uint32_t i = 0; i < scene->animation_count; i++)
        text_json_string(t, NULL, scene->animations[i].name);
    text_json_end_array(t);
    text_json_begin_array(t, "animationTimes");
    for (uint32_t i = 0; i < scene->animation_count; i++) {
        const double times[] = {(double)scene->animations[i].begin_s, (double)scene->animations[i].end_s};
        text_json_doubles(t, NULL, times, 2);
    }
    text_json_end_array(t);
}

static void describe_names(text *t, const facet_scene *scene)
{
    describe_animations(t, scene);
    text_json_begin_array(t, "variants");
    for (uint32_t i = 0; i < scene->variant_count; i++)
        text_json_string(t, NULL, scene->variants[i]);
    text_json_end_array(t);
    text_json_begin_array(t, "cameras");
    for (uint32_t i = 0; i < scene->camera_count; i++)
        text_json_string(t, NULL, scene->cameras[i].name);
    text_json_end_array(t);
    text_json_begin_array(t, "scenes");
    for (uint32_t i = 0; i < scene->scene_count; i++)
        text_json_string(t, NULL, scene->scenes[i].name);
    text_json_end_array(t);
}

static void describe_motion(text *t, const view_state *s)
{
    bool moves = s->pose.animation_count > 0;
    text_json_bool(t, "isPlaying", s->is_playing);
    number(t, "time", s->pose.time_s);
    number(t, "begin", moves ? s->begin_s : 0.0);
    number(t, "end", moves ? s->end_s : 0.0);
    number(t, "speed", s->speed);
    index_or_null(t, "animation", moves, moves ? (int64_t)s->animations[0] : 0);
    index_or_null(t, "variant", s->pose.has_variant, (int64_t)s->pose.variant);
    index_or_null(t, "camera", s->camera != VIEW_NO_CAMERA, s->camera);
}

static void describe_stats(text *t, const viewer *v)
{
    text_json_begin_object(t, "stats");
    if (v->scene) {
        text_json_integer(t, "triangles", (int64_t)v->state.counts.drawn_triangles);
        text_json_integer(t, "draws", (int64_t)v->state.counts.instances);
        text_json_integer(t, "vertices", (int64_t)v->state.counts.vertices);
    }
    number(t, "seconds", v->stats.geometry_s + v->stats.light_s + v->stats.textures_s + v->stats.shade_s);
    number(t, "geometrySeconds", v->stats.geometry_s);
    number(t, "lightSeconds", v->stats.light_s);
    number(t, "textureSeconds", v->stats.textures_s);
    number(t, "drawSeconds", v->stats.shade_s);
    text_json_end_object(t);
}

static const char *const comparisons[VIEW_COMPARISON_COUNT] = {[VIEW_COMPARE_NOTHING] = "",
                                                               [VIEW_COMPARE_MASKING] = "masking",
                                                               [VIEW_COMPARE_SCATTERING] = "scattering",
                                                               [VIEW_COMPARE_RENDERER] = "",
                                                               [VIEW_COMPARE_TONEMAP] = "tone-mapping",
                                                               [VIEW_COMPARE_VARIANT] = "variant"};

bool web_comparison_find(const char *name, view_comparison *out)
{
    for (int i = 0; i < VIEW_COMPARISON_COUNT; i++)
        if (strcmp(comparisons[i], name) == 0) {
            *out = (view_comparison)i;
            return true;
        }
    return false;
}

static void describe_comparison(text *t, const view_state *s)
{
    facet_render_desc sides[2];
    const char *labels[2];
    view_divider_sides(&s->divider, &s->render, sides, labels);
    text_json_begin_object(t, "comparison");
    text_json_string(t, "name", comparisons[s->divider.comparison]);
    number(t, "position", s->divider.position);
    text_json_string(t, "left", labels[0]);
    text_json_string(t, "right", labels[1]);
    text_json_end_object(t);
}

char *web_describe_state(const viewer *v)
{
    text t = {0};
    const view_state *s = &v->state;
    text_json_begin_object(&t, NULL);
    text_json_string(&t, "message", s->message[0] ? s->message : v->message);
    text_json_string(&t, "model", v->path);
    if (v->scene) {
        describe_bounds(&t, v);
        describe_names(&t, v->scene);
    }
    describe_orbit(&t, v);
    describe_motion(&t, s);
    describe_comparison(&t, s);
    describe_stats(&t, v);
    text_json_end_object(&t);
    return finish(&t);
}
