/* see_through.c - see see_through.h. One traversal per ray: Embree asks a filter about every candidate. What lets
 * light pass is noted and refused, so that Embree goes on; what is opaque is taken, so that Embree looks no farther. */
#include "cpu/see_through.h"

#include <math.h>
#include <string.h>

/* From this opacity on nothing behind can be seen in 8 bits of color. */
static const float OPAQUE = 0.999f;
/* Distances that differ by less, relatively, are the same: rounding of the intersection. */
static const float SAME_DISTANCE = 2e-6f;
/* Weights below this are on an edge of the triangle. */
static const float ON_EDGE = 1e-4f;

typedef struct walk {
    embree_context context; /* first: what Embree hands to the filter */
    const shading_scene *scene;
    const shading_ray *ray;
    bool has_opaque;
    visibility_hit opaque;
    uint32_t count;
    visibility_hit layers[SEE_THROUGH_LAYERS]; /* nearest first */
} walk;

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

/* A ray through an edge meets both triangles, which are one surface there. */
static bool is_twin(const walk *w, const visibility_hit *a, const visibility_hit *b)
{
    const render_geometry *g = &w->scene->geometries->items[a->geometry];
    return a->geometry == b->geometry && a->primitive != b->primitive &&
           g->primitive->mode == SCENE_TRIANGLES && is_same_distance(a->t, b->t) && is_on_edge(a) &&
           is_on_edge(b) && have_common_edge(g, a, b);
}

/* Notes a layer; when there are too many, the farthest goes, and nothing behind it is of interest. */
static void insert(walk *w, const visibility_hit *hit)
{
    uint32_t place = w->count;
    while (place > 0 && is_nearer(hit, &w->layers[place - 1]))
        place--;
    if (place == SEE_THROUGH_LAYERS)
        return;
    uint32_t kept = w->count < SEE_THROUGH_LAYERS ? w->count : SEE_THROUGH_LAYERS - 1;
    memmove(&w->layers[place + 1], &w->layers[place], (kept - place) * sizeof *w->layers);
    w->layers[place] = *hit;
    w->count = kept + 1;
}

/* Whether the candidate ends the ray. */
static bool consider(walk *w, const visibility_hit *hit)
{
    if (!shading_is_visible_side(w->scene, hit, w->ray->direction))
        return false;
    shading_point point = {.hit = hit, .ray = w->ray};
    float opacity = shading_opacity(w->scene, &point);
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

static void filter(const struct RTCFilterFunctionNArguments *arguments)
{
    if (arguments->valid[0] != -1)
        return;
    walk *w = (walk *)(void *)arguments->context;
    const struct RTCRay *ray = (const struct RTCRay *)(const void *)arguments->ray;
    const struct RTCHit *h = (const struct RTCHit *)(const void *)arguments->hit;
    visibility_hit hit = visibility_hit_read(w->scene->geometries, ray->tfar, h);
    if (!consider(w, &hit))
        arguments->valid[0] = 0;
}

/* Layers at the same distance by number, twins once. */
static void tidy(walk *w)
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
            repeats = repeats || is_twin(w, &w->layers[i], &w->layers[k - 1]);
        if (!repeats)
            w->layers[kept++] = w->layers[i];
    }
    w->count = kept;
}

uint32_t see_through(const shading_scene *scene, const shading_ray *ray,
                     visibility_hit hits[SEE_THROUGH_LAYERS + 1])
{
    walk w; /* 2 kB of layers that need no zeros */
    w.scene = scene;
    w.ray = ray;
    w.has_opaque = false;
    w.count = 0;
    struct RTCRayHit rayhit = {
        .ray = {.org_x = ray->origin[0],
                .org_y = ray->origin[1],
                .org_z = ray->origin[2],
                .tnear = ray->near_t,
                .dir_x = ray->direction[0],
                .dir_y = ray->direction[1],
                .dir_z = ray->direction[2],
                .tfar = ray->far_t,
                .mask = UINT32_MAX},
        .hit = {.geomID = RTC_INVALID_GEOMETRY_ID, .instID = {RTC_INVALID_GEOMETRY_ID}}};
    embree_intersect1_filtered(scene->embree->scene, &rayhit, &w.context, filter);

    /* An opaque surface may have been found after layers behind it. */
    while (w.has_opaque && w.count > 0 && is_nearer(&w.opaque, &w.layers[w.count - 1]))
        w.count--;
    tidy(&w);
    memcpy(hits, w.layers, w.count * sizeof *hits);
    if (w.has_opaque)
        hits[w.count] = w.opaque;
    return w.count + w.has_opaque;
}
