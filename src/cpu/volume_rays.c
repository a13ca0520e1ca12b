/* volume_rays.c - see volume_rays.h. Embree asks a filter about every candidate on a ray. */
#include "cpu/volume_rays.h"

enum { COINCIDENT = 8 };

typedef struct boundary {
    uint32_t geometry;
    float t;
    bool is_front;
} boundary;

typedef struct search {
    embree_context context; /* first: what Embree hands to the filter */
    const shading_scene *scene;
    vec3 direction;
    const scene_material *material;   /* of the boundaries that are looked for, */
    const render_geometry *elsewhere; /* or NULL: all of other geometries than this */
    bool has_exit;
    float exit_t;
    float exit_normal[3];
    uint32_t count;
    boundary boundaries[COINCIDENT]; /* by geometry */
} search;

static float tolerance_at(const surface_point *s)
{
    vec3 most = abs(s->P);
    if (s->hit.geometry->primitive->mode == SCENE_TRIANGLES)
        for (int i = 0; i < 3; i++) {
            float corner[3];
            render_geometry_corner(s->hit.geometry, s->hit.corner[i], corner);
            most = max(most, abs(load3(corner)));
        }
    return volume_rays_tolerance_of(max3(most));
}

static void trace(search *s, vec3 origin, vec3 direction, float near_t, float far_t,
                  RTCFilterFunctionN filter)
{
    struct RTCRayHit ray = {.ray = {.org_x = origin[0],
                                    .org_y = origin[1],
                                    .org_z = origin[2],
                                    .tnear = near_t,
                                    .dir_x = direction[0],
                                    .dir_y = direction[1],
                                    .dir_z = direction[2],
                                    .tfar = far_t,
                                    .mask = UINT32_MAX},
                            .hit = {.geomID = RTC_INVALID_GEOMETRY_ID, .instID = {RTC_INVALID_GEOMETRY_ID}}};
    s->direction = direction;
    embree_intersect1_filtered(s->scene->embree->scene, &ray, &s->context, filter);
}

/* ---- the far side ---- */

/* Takes back faces of the material, nearest first; everything else is passed. */
static void take_exit(const struct RTCFilterFunctionNArguments *arguments)
{
    if (arguments->valid[0] != -1)
        return;
    search *s = (search *)(void *)arguments->context;
    const struct RTCRay *ray = (const struct RTCRay *)(const void *)arguments->ray;
    visibility_hit hit = visibility_hit_read(s->scene->geometries, ray->tfar,
                                             (const struct RTCHit *)(const void *)arguments->hit);
    const render_geometry *g = &s->scene->geometries->items[hit.geometry];
    if (g->material != s->material || g->primitive->mode != SCENE_TRIANGLES ||
        surface_sees_front(g, &hit, s->direction)) {
        arguments->valid[0] = 0;
        return;
    }
    if (s->has_exit && s->exit_t <= hit.t)
        return;
    s->has_exit = true;
    s->exit_t = hit.t;
    float sign = g->is_mirrored ? -1.0f : 1.0f;
    for (int i = 0; i < 3; i++)
        s->exit_normal[i] = hit.normal[i] * sign;
}

bool volume_rays_find_exit(const shading_scene *scene, const surface_point *s, vec3 direction,
                           volume_exit *out)
{
    search w = {.scene = scene, .material = s->hit.geometry->material};
    trace(&w, s->P, direction, tolerance_at(s), INFINITY, take_exit);
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

/* Notes each body's boundary, and goes on. */
static void note_boundary(const struct RTCFilterFunctionNArguments *arguments)
{
    if (arguments->valid[0] != -1)
        return;
    search *s = (search *)(void *)arguments->context;
    arguments->valid[0] = 0;
    const struct RTCRay *ray = (const struct RTCRay *)(const void *)arguments->ray;
    visibility_hit hit = visibility_hit_read(s->scene->geometries, ray->tfar,
                                             (const struct RTCHit *)(const void *)arguments->hit);
    const render_geometry *g = &s->scene->geometries->items[hit.geometry];
    if (g->material == s->elsewhere->material || !s->scene->plans->items[hit.geometry].is_volume)
        return;
    uint32_t place = s->count;
    while (place > 0 && s->boundaries[place - 1].geometry > hit.geometry)
        place--;
    if ((place > 0 && s->boundaries[place - 1].geometry == hit.geometry) || s->count == COINCIDENT)
        return; /* an edge meets two triangles of one boundary */
    memmove(&s->boundaries[place + 1], &s->boundaries[place], (s->count - place) * sizeof *s->boundaries);
    s->boundaries[place] = (boundary){
        .geometry = hit.geometry, .t = hit.t, .is_front = surface_sees_front(g, &hit, s->direction)};
    s->count++;
}

static void cross_one(const render_geometry *g, bool is_front, media *m)
{
    if (is_front)
        media_enter(m, g->material, g->material->thickness * g->scale);
    else
        media_leave(m, g->material);
}

void volume_rays_cross(const shading_scene *scene, const visibility_hit *hit, const surface_point *s,
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
