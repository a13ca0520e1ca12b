/* ray_trace.c - see ray_trace.h. The nearest hit is used where it is opaque, which is the usual case;
 * otherwise a filter function looks at every candidate. */
#include <math.h>
#include <string.h>

#include "cpu/ogl1_shade.h"
#include "cpu/ray_trace.h"

/* ---- a hit ---- */

bool ray_trace_is_visible_side(const shading_scene *scene, const visibility_hit *hit,
                               const float direction[3])
{
    const render_geometry *g = &scene->geometries->items[hit->geometry];
    return g->is_double_sided || surface_sees_front(g, hit, load3(direction)) ||
           scene->plans->items[hit->geometry].is_volume;
}

float ray_trace_opacity(const shading_scene *scene, const shading_point *point)
{
    if (scene->ogl1)
        return ogl1_opacity(scene, point);
    const render_geometry *g = &scene->geometries->items[point->hit->geometry];
    if (!g->is_see_through)
        return 1.0f;
    shading_hit h = shading_hit_make(scene, point);
    float base_color[4];
    surface_base_color(scene, &h, &scene->plans->items[point->hit->geometry], base_color);
    return surface_opacity(g->material, base_color[3]);
}

/* ---- all surfaces along a ray ---- */

/* One traversal per ray, with a filter that sees every candidate. A transparent one is recorded and
 * rejected, so that the ray continues; an opaque one is accepted, so that nothing behind it is looked for. */

/* From this opacity on, nothing behind is visible in 8 bits of color. */
static const float OPAQUE = 0.999f;
/* Distances that differ by less, relatively, are equal: rounding of the intersection. */
static const float SAME_DISTANCE = 2e-6f;
/* Weights below this are on an edge of the triangle. */
static const float ON_EDGE = 1e-4f;

typedef struct layer_search {
    const shading_scene *scene;
    const shading_ray *ray;
    bool has_opaque;
    visibility_hit opaque;
    uint32_t count;
    visibility_hit layers[RAY_TRACE_LAYERS]; /* nearest first */
} layer_search;

static bool has_smaller_number(const visibility_hit *a, const visibility_hit *b)
{
    return a->geometry != b->geometry ? a->geometry < b->geometry : a->primitive < b->primitive;
}

static bool is_nearer(const visibility_hit *a, const visibility_hit *b)
{
    if (a->t < b->t || a->t > b->t)
        return a->t < b->t;
    return has_smaller_number(a, b);
}

static bool is_same_distance(float a, float b)
{
    return fabsf(a - b) <= SAME_DISTANCE * fabsf(a);
}

static bool is_on_edge(const visibility_hit *hit)
{
    return hit->u < ON_EDGE || hit->v < ON_EDGE || hit->u + hit->v > 1.0f - ON_EDGE;
}

static bool have_common_edge(const render_geometry *g, const visibility_hit *a, const visibility_hit *b)
{
    const uint32_t *i = render_geometry_triangle(g, a->primitive);
    const uint32_t *k = render_geometry_triangle(g, b->primitive);
    int common = 0;
    for (int n = 0; n < 3; n++)
        for (int m = 0; m < 3; m++)
            common += memcmp(g->vertices + 3 * (size_t)i[n], g->vertices + 3 * (size_t)k[m],
                             3 * sizeof(float)) == 0;
    return common == 2;
}

/* A ray through an edge hits both triangles, which are one surface there. */
static bool is_same_surface(const layer_search *w, const visibility_hit *a, const visibility_hit *b)
{
    const render_geometry *g = &w->scene->geometries->items[a->geometry];
    return a->geometry == b->geometry && a->primitive != b->primitive &&
           g->primitive->mode == SCENE_TRIANGLES && is_same_distance(a->t, b->t) && is_on_edge(a) &&
           is_on_edge(b) && have_common_edge(g, a, b);
}

/* Records a layer; the farthest is dropped when there are too many, and nothing behind it matters. */
static void insert(layer_search *w, const visibility_hit *hit)
{
    uint32_t place = w->count;
    while (place > 0 && is_nearer(hit, &w->layers[place - 1]))
        place--;
    if (place == RAY_TRACE_LAYERS)
        return;
    uint32_t kept = w->count < RAY_TRACE_LAYERS ? w->count : RAY_TRACE_LAYERS - 1;
    memmove(&w->layers[place + 1], &w->layers[place], (kept - place) * sizeof *w->layers);
    w->layers[place] = *hit;
    w->count = kept + 1;
}

/* A ray_filter: whether the candidate ends the ray. */
static bool collect_layers(void *context, const visibility_hit *hit)
{
    layer_search *w = context;
    if (!ray_trace_is_visible_side(w->scene, hit, w->ray->direction))
        return false;
    shading_point point = {.hit = hit, .ray = w->ray};
    float opacity = ray_trace_opacity(w->scene, &point);
    if (opacity >= OPAQUE) {
        if (!w->has_opaque || is_nearer(hit, &w->opaque))
            w->opaque = *hit;
        w->has_opaque = true;
        return true;
    }
    if (opacity > 0.0f)
        insert(w, hit);
    return false;
}

/* Sorts layers at equal distances by index, and removes duplicates at edges. */
static void tidy(layer_search *w)
{
    for (uint32_t i = 1; i < w->count; i++)
        for (uint32_t k = i; k > 0 && is_same_distance(w->layers[k].t, w->layers[k - 1].t) &&
                             has_smaller_number(&w->layers[k], &w->layers[k - 1]);
             k--) {
            visibility_hit swap = w->layers[k];
            w->layers[k] = w->layers[k - 1];
            w->layers[k - 1] = swap;
        }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < w->count; i++) {
        bool repeats = false;
        for (uint32_t k = kept; k > 0 && is_same_distance(w->layers[i].t, w->layers[k - 1].t); k--)
            repeats = repeats || is_same_surface(w, &w->layers[i], &w->layers[k - 1]);
        if (!repeats)
            w->layers[kept++] = w->layers[i];
    }
    w->count = kept;
}

uint32_t ray_trace_layers(const shading_scene *scene, const shading_ray *ray,
                          visibility_hit hits[RAY_TRACE_LAYERS + 1])
{
    layer_search w; /* 2 kB of layers that need no initialisation */
    w.scene = scene;
    w.ray = ray;
    w.has_opaque = false;
    w.count = 0;
    const ray_segment segment = ray_trace_segment(ray);
    visibility_hit last;
    scene->rays->tracer->nearest_filtered(scene->rays->bvh, &segment, collect_layers, &w, &last);

    /* An opaque surface may have been found after layers behind it. */
    while (w.has_opaque && w.count > 0 && is_nearer(&w.opaque, &w.layers[w.count - 1]))
        w.count--;
    tidy(&w);
    memcpy(hits, w.layers, w.count * sizeof *hits);
    if (w.has_opaque)
        hits[w.count] = w.opaque;
    return w.count + w.has_opaque;
}

/* ---- single rays ---- */

static bool nearest_of_all(const shading_scene *scene, const shading_ray *ray, visibility_hit *hit)
{
    const ray_segment segment = ray_trace_segment(ray);
    return scene->rays->tracer->nearest(scene->rays->bvh, &segment, hit);
}

static bool is_see_through(const shading_scene *scene, const visibility_hit *hit)
{
    return scene->geometries->items[hit->geometry].is_see_through;
}

/* ---- rays of the camera ---- */

static float opacity_of(const shading_scene *scene, const shading_ray *ray, const visibility_hit *hit)
{
    shading_point point = {.hit = hit, .ray = ray};
    return is_see_through(scene, hit) ? ray_trace_opacity(scene, &point) : 1.0f;
}

/* Reservoir sampling: whether the next item, of the given weight, replaces the sample of those before it,
 * whose weights add up to sum; u is rescaled for the next item. */
static bool reservoir_takes(float weight, float sum, float *u)
{
    float share = weight / (sum + weight);
    if (*u < share) {
        *u = min(*u / share, 0.99999994f);
        return true;
    }
    *u = min((*u - share) / (1.0f - share), 0.99999994f);
    return false;
}

/* ray_trace_layers() stops after many layers, and at nearly opaque ones: the rest of the ray is traced
 * again. */
static void gather_layers(const shading_scene *scene, const shading_ray *ray, float u, ray_first *first)
{
    visibility_hit hits[RAY_TRACE_LAYERS + 1];
    shading_ray rest = *ray;
    float passes = 1.0f;
    uint32_t count;
    do {
        count = ray_trace_layers(scene, &rest, hits);
        first->rays++;
        float opacity = 0.0f;
        for (uint32_t i = 0; i < count; i++) {
            opacity = opacity_of(scene, ray, &hits[i]);
            float weight = passes * opacity;
            if (weight > 0.0f && reservoir_takes(weight, first->opacity, &u))
                first->hit = hits[i];
            first->opacity += weight;
            passes *= 1.0f - opacity;
        }
        bool goes_on = count >= RAY_TRACE_LAYERS || (opacity > 0.99f && opacity < 1.0f);
        if (!goes_on || !(passes > 0.0f))
            break;
        rest.near_t = nextafterf(hits[count - 1].t, INFINITY);
    } while (count > 0);
    first->opacity = passes > 0.0f ? min(first->opacity, 1.0f) : 1.0f;
}

ray_first ray_trace_first(const shading_scene *scene, const shading_ray *ray, float u)
{
    ray_first first = {.rays = 1};
    if (!nearest_of_all(scene, ray, &first.hit))
        return first;
    if (is_see_through(scene, &first.hit) || !ray_trace_is_visible_side(scene, &first.hit, ray->direction)) {
        gather_layers(scene, ray, u, &first);
        return first;
    }
    first.opacity = 1.0f;
    return first;
}

/* ---- other rays ---- */

static const ray_spread NO_SPREAD = {.moves = false, .turns = false};

typedef struct search {
    const shading_scene *scene;
    shading_ray ray; /* without spread */
    uint32_t random;
    float transmittance;
    ray_crossings *crossings;
} search;

static float uniform_of(uint32_t random, const visibility_hit *hit)
{
    uint32_t bits = hash_uint(hash_uint(random ^ hash_uint(hit->geometry)) + hit->primitive);
    return (float)(bits >> 8) * (1.0f / 16777216.0f);
}

/* A ray_filter. */
static bool accept_by_opacity(void *context, const visibility_hit *hit)
{
    const search *s = context;
    float opacity = opacity_of(s->scene, &s->ray, hit);
    return opacity >= 1.0f || uniform_of(s->random, hit) < opacity;
}

bool ray_trace_nearest(const shading_scene *scene, const shading_ray *ray, uint32_t random,
                       visibility_hit *hit)
{
    if (!nearest_of_all(scene, ray, hit))
        return false;
    if (!is_see_through(scene, hit))
        return true;
    search s = {.scene = scene, .ray = *ray, .random = random};
    s.ray.spread = &NO_SPREAD;
    ray_segment segment = ray_trace_segment(ray);
    segment.near_t = max(ray->near_t, hit->t);
    return scene->rays->tracer->nearest_filtered(scene->rays->bvh, &segment, accept_by_opacity, &s, hit);
}

/* Records a surface by distance; the farthest is dropped when there are too many. */
static void note(ray_crossings *c, const visibility_hit *hit)
{
    uint32_t place = c->count;
    while (place > 0 && hit->t < c->hits[place - 1].t)
        place--;
    c->is_cut = c->is_cut || c->count == RAY_CROSSINGS;
    if (place == RAY_CROSSINGS)
        return;
    uint32_t kept = c->count < RAY_CROSSINGS ? c->count : RAY_CROSSINGS - 1;
    memmove(&c->hits[place + 1], &c->hits[place], (kept - place) * sizeof *c->hits);
    c->hits[place] = *hit;
    c->count = kept + 1;
}

static bool is_crossed(const search *s, const visibility_hit *hit)
{
    const material_plan *plan = &s->scene->plans->items[hit->geometry];
    return s->crossings && (plan->may_pass_straight || (s->crossings->takes_all && plan->lets_rays_through));
}

/* A ray_filter: whether the ray is blocked. */
static bool dim(void *context, const visibility_hit *hit)
{
    search *s = context;
    if (is_crossed(s, hit)) {
        note(s->crossings, hit);
        return false;
    }
    s->transmittance *= max(1.0f - opacity_of(s->scene, &s->ray, hit), 0.0f);
    return !(s->transmittance > 0.0f);
}

float ray_trace_transmittance(const shading_scene *scene, const shading_ray *ray, ray_crossings *crossings)
{
    const ray_segment segment = ray_trace_segment(ray);
    const ray_tracer *tracer = scene->rays->tracer;
    if (crossings) {
        crossings->count = 0;
        crossings->is_cut = false;
    }
    if (!scene->plans->has_see_through && !crossings)
        return tracer->occluded(scene->rays->bvh, &segment) ? 0.0f : 1.0f;
    search s = {.scene = scene, .ray = *ray, .transmittance = 1.0f, .crossings = crossings};
    s.ray.spread = &NO_SPREAD;
    return tracer->occluded_filtered(scene->rays->bvh, &segment, dim, &s) ? 0.0f : s.transmittance;
}

static float pass_glass(const shading_scene *scene, const ray_crossings *crossings)
{
    float passes = 1.0f;
    for (uint32_t i = 0; i < crossings->count; i++) {
        const scene_material *m = scene->geometries->items[crossings->hits[i].geometry].material;
        passes *= m->transmission * luminance(load3(m->base_color)) * (1.0f - 0.04f);
    }
    return clamp(passes, 0.0f, 1.0f);
}

float ray_trace_daylight(const shading_scene *scene, const shading_ray *ray)
{
    if (!scene->plans->lets_rays_through)
        return ray_trace_transmittance(scene, ray, NULL);
    ray_crossings crossings = {.takes_all = true};
    return ray_trace_transmittance(scene, ray, &crossings) * pass_glass(scene, &crossings);
}
