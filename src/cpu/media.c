/* media.c - see media.h. A filter sees every candidate on a ray. */
#include "cpu/media.h"
#include "cpu/ray_trace.h"

enum { COINCIDENT = 8 };

typedef struct boundary {
    uint32_t geometry;
    float t;
    bool is_front;
} boundary;

typedef struct search {
    const shading_scene *scene;
    vec3 direction;
    const scene_material *material;   /* of the boundaries that are searched */
    const render_geometry *elsewhere; /* or, not NULL: boundaries of all other geometries than this */
    bool has_exit;
    float exit_t;
    float exit_normal[3];
    uint32_t count;
    boundary boundaries[COINCIDENT]; /* by geometry */
} search;

float media_tolerance_at(const surface_point *s)
{
    return media_tolerance(max3(max(abs(s->P), s->hit.farthest)));
}

static void trace(search *s, vec3 origin, vec3 direction, float near_t, float far_t, ray_filter filter)
{
    ray_segment ray = {.near_t = near_t, .far_t = far_t};
    visibility_hit hit;
    store3(origin, ray.origin);
    store3(direction, ray.direction);
    s->direction = direction;
    s->scene->rays->tracer->nearest_filtered(s->scene->rays->bvh, &ray, filter, s, &hit);
}

/* ---- the far side ---- */

/* A ray_filter: accepts back faces of the material, nearest first. */
static bool take_exit(void *context, const visibility_hit *hit)
{
    search *s = context;
    const render_geometry *g = &s->scene->geometries->items[hit->geometry];
    if (g->material != s->material || g->primitive->mode != SCENE_TRIANGLES ||
        surface_sees_front(g, hit, s->direction))
        return false;
    if (s->has_exit && s->exit_t <= hit->t)
        return true;
    s->has_exit = true;
    s->exit_t = hit->t;
    float sign = g->is_mirrored ? -1.0f : 1.0f;
    for (int i = 0; i < 3; i++)
        s->exit_normal[i] = hit->normal[i] * sign;
    return true;
}

bool media_find_exit(const shading_scene *scene, const surface_point *s, vec3 direction, media_exit *out)
{
    search w = {.scene = scene, .material = s->hit.geometry->material};
    trace(&w, s->P, direction, media_tolerance_at(s), INFINITY, take_exit);
    if (!w.has_exit)
        return false;
    vec3 n = load3(w.exit_normal);
    float n2 = dot(n, n);
    if (!(n2 > 0.0f))
        return false;
    out->distance_m = w.exit_t;
    out->normal = n * inversesqrt(n2);
    return true;
}

/* ---- boundaries in one place ---- */

/* A ray_filter: records the boundary of each volume. */
static bool note_boundary(void *context, const visibility_hit *hit)
{
    search *s = context;
    const render_geometry *g = &s->scene->geometries->items[hit->geometry];
    if (g->material == s->elsewhere->material || !s->scene->plans->items[hit->geometry].is_volume)
        return false;
    uint32_t place = s->count;
    while (place > 0 && s->boundaries[place - 1].geometry > hit->geometry)
        place--;
    if ((place > 0 && s->boundaries[place - 1].geometry == hit->geometry) || s->count == COINCIDENT)
        return false; /* a ray through an edge hits two triangles of one boundary */
    memmove(&s->boundaries[place + 1], &s->boundaries[place], (s->count - place) * sizeof *s->boundaries);
    s->boundaries[place] = (boundary){
        .geometry = hit->geometry, .t = hit->t, .is_front = surface_sees_front(g, hit, s->direction)};
    s->count++;
    return false;
}

static void cross_one(const render_geometry *g, bool is_front, media *m)
{
    if (is_front)
        media_enter(m, g->material, g->material->thickness * g->scale);
    else
        media_leave(m, g->material);
}

void media_cross(const shading_scene *scene, const visibility_hit *hit, const surface_point *s,
                 float tolerance, media *m)
{
    const render_geometry *g = &scene->geometries->items[hit->geometry];
    cross_one(g, s->is_front, m);
    if (!scene->plans->has_several_volumes)
        return;
    search w = {.scene = scene, .elsewhere = g};
    vec3 d = -s->V;
    trace(&w, s->P - d * tolerance, d, 0.0f, 2.0f * tolerance, note_boundary);
    for (uint32_t i = 0; i < w.count; i++)
        cross_one(&scene->geometries->items[w.boundaries[i].geometry], w.boundaries[i].is_front, m);
}

/* ---- the closed volumes around a point ---- */

typedef struct survey {
    const shading_scene *scene;
    vec3 direction;
    uint32_t count;
    struct {
        const render_geometry *geometry;
        int excess;         /* back faces hit, minus front faces */
    } volumes[MEDIA_DEPTH]; /* by material, in the order of hits */
} survey;

static void count_side(survey *s, const visibility_hit *hit)
{
    const render_geometry *g = &s->scene->geometries->items[hit->geometry];
    uint32_t i = 0;
    while (i < s->count && s->volumes[i].geometry->material != g->material)
        i++;
    if (i == MEDIA_DEPTH)
        return;
    if (i == s->count) {
        s->volumes[s->count].geometry = g;
        s->volumes[s->count++].excess = 0;
    }
    s->volumes[i].excess += surface_sees_front(g, hit, s->direction) ? -1 : 1;
}

/* A ray_filter. */
static bool note_side(void *context, const visibility_hit *hit)
{
    survey *s = context;
    if (s->scene->plans->items[hit->geometry].is_closed_volume)
        count_side(s, hit);
    return false;
}

static survey survey_from(const shading_scene *scene, const float P[3], vec3 direction)
{
    survey s = {.scene = scene, .direction = direction};
    ray_segment ray = {.origin = {P[0], P[1], P[2]}, .far_t = INFINITY};
    visibility_hit hit;
    store3(direction, ray.direction);
    scene->rays->tracer->nearest_filtered(scene->rays->bvh, &ray, note_side, &s, &hit);
    return s;
}

static int excess_of(const survey *s, const scene_material *material)
{
    for (uint32_t i = 0; i < s->count; i++)
        if (s->volumes[i].geometry->material == material)
            return s->volumes[i].excess;
    return 0;
}

static bool is_within_bounds(const shading_scene *scene, const float P[3])
{
    float low[3], high[3];
    scene->rays->tracer->bounds(scene->rays->bvh, low, high);
    return P[0] >= low[0] && P[0] <= high[0] && P[1] >= low[1] && P[1] <= high[1] && P[2] >= low[2] &&
           P[2] <= high[2];
}

/* Three directions that are not aligned to any model: an open mesh shows its back to one of them at most
 * by chance. */
uint32_t media_at(const shading_scene *scene, const float P[3], media *m)
{
    enum { DIRECTIONS = 3 };
    static const float directions[DIRECTIONS][3] = {
        {0.3015f, 0.9045f, 0.3015f}, {-0.8018f, -0.2673f, 0.5345f}, {0.4575f, -0.1525f, -0.8760f}};
    if (!scene->plans->has_closed_volumes || !is_within_bounds(scene, P))
        return 0;
    survey surveys[DIRECTIONS];
    for (uint32_t i = 0; i < DIRECTIONS; i++) {
        surveys[i] = survey_from(scene, P, load3(directions[i]));
        if (surveys[i].count == 0)
            return i + 1;
    }
    for (uint32_t i = surveys[0].count; i > 0; i--) {
        const render_geometry *g = surveys[0].volumes[i - 1].geometry;
        if (surveys[0].volumes[i - 1].excess > 0 && excess_of(&surveys[1], g->material) > 0 &&
            excess_of(&surveys[2], g->material) > 0)
            media_enter(m, g->material, g->material->thickness * g->scale);
    }
    return DIRECTIONS;
}
