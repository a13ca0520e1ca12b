/* ray_trace.c - see ray_trace.h. Embree's own nearest hit is taken where it is opaque, which is nearly always; only where
 * it is not, a filter looks at every candidate. */
#include "cpu/see_through.h"

#include "cpu/ray_trace.h"

static struct RTCRay embree_ray(const shading_ray *ray)
{
    return (struct RTCRay){.org_x = ray->origin[0],
                           .org_y = ray->origin[1],
                           .org_z = ray->origin[2],
                           .tnear = ray->near_t,
                           .dir_x = ray->direction[0],
                           .dir_y = ray->direction[1],
                           .dir_z = ray->direction[2],
                           .tfar = ray->far_t,
                           .mask = UINT32_MAX};
}

static bool nearest_of_all(const shading_scene *scene, const shading_ray *ray, visibility_hit *hit)
{
    struct RTCRayHit rayhit = {
        .ray = embree_ray(ray),
        .hit = {.geomID = RTC_INVALID_GEOMETRY_ID, .instID = {RTC_INVALID_GEOMETRY_ID}}};
    embree_intersect1(scene->embree->scene, &rayhit);
    if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    *hit = visibility_hit_read(scene->geometries, rayhit.ray.tfar, &rayhit.hit);
    return true;
}

static bool is_see_through(const shading_scene *scene, const visibility_hit *hit)
{
    return scene->geometries->items[hit->geometry].is_see_through;
}

/* ---- rays of the camera ---- */

static float opacity_of(const shading_scene *scene, const shading_ray *ray, const visibility_hit *hit)
{
    shading_point point = {.hit = hit, .ray = ray};
    return is_see_through(scene, hit) ? shading_opacity(scene, &point) : 1.0f;
}

/* Takes the next of several things, of the given weight, in place of the one that was drawn among those before it, whose
 * weights add up to sum; what is left of u serves the next draw. */
static bool draws(float weight, float sum, float *u)
{
    float share = weight / (sum + weight);
    if (*u < share) {
        *u = min(*u / share, 0.99999994f);
        return true;
    }
    *u = min((*u - share) / (1.0f - share), 0.99999994f);
    return false;
}

/* see_through() gives up after many layers, and where hardly any light passes: the rest of the ray is a ray again. */
static void gather_layers(const shading_scene *scene, const shading_ray *ray, float u, ray_first *first)
{
    visibility_hit hits[SEE_THROUGH_LAYERS + 1];
    shading_ray rest = *ray;
    float passes = 1.0f;
    uint32_t count;
    do {
        count = see_through(scene, &rest, hits);
        first->rays++;
        float opacity = 0.0f;
        for (uint32_t i = 0; i < count; i++) {
            opacity = opacity_of(scene, ray, &hits[i]);
            float weight = passes * opacity;
            if (weight > 0.0f && draws(weight, first->opacity, &u))
                first->hit = hits[i];
            first->opacity += weight;
            passes *= 1.0f - opacity;
        }
        bool goes_on = count >= SEE_THROUGH_LAYERS || (opacity > 0.99f && opacity < 1.0f);
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
    if (is_see_through(scene, &first.hit) || !shading_is_visible_side(scene, &first.hit, ray->direction)) {
        gather_layers(scene, ray, u, &first);
        return first;
    }
    first.opacity = 1.0f;
    return first;
}

/* ---- other rays ---- */

static const ray_spread NO_SPREAD = {.moves = false, .turns = false};

typedef struct search {
    embree_context context; /* first: what Embree hands to the filter */
    const shading_scene *scene;
    shading_ray ray; /* without spread */
    uint32_t random;
    float opening;
    ray_crossings *crossings;
} search;

static visibility_hit candidate(const struct RTCFilterFunctionNArguments *arguments)
{
    const search *s = (const search *)(const void *)arguments->context;
    const struct RTCRay *ray = (const struct RTCRay *)(const void *)arguments->ray;
    const struct RTCHit *h = (const struct RTCHit *)(const void *)arguments->hit;
    return visibility_hit_read(s->scene->geometries, ray->tfar, h);
}

static float uniform_of(uint32_t random, const visibility_hit *hit)
{
    uint32_t bits = hash_uint(hash_uint(random ^ hash_uint(hit->geometry)) + hit->primitive);
    return (float)(bits >> 8) * (1.0f / 16777216.0f);
}

static void meet_by_chance(const struct RTCFilterFunctionNArguments *arguments)
{
    if (arguments->valid[0] != -1)
        return;
    const search *s = (const search *)(const void *)arguments->context;
    visibility_hit hit = candidate(arguments);
    float opacity = opacity_of(s->scene, &s->ray, &hit);
    if (!(opacity >= 1.0f) && !(uniform_of(s->random, &hit) < opacity))
        arguments->valid[0] = 0;
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
    struct RTCRayHit rayhit = {
        .ray = embree_ray(ray),
        .hit = {.geomID = RTC_INVALID_GEOMETRY_ID, .instID = {RTC_INVALID_GEOMETRY_ID}}};
    rayhit.ray.tnear = max(ray->near_t, hit->t);
    embree_intersect1_filtered(scene->embree->scene, &rayhit, &s.context, meet_by_chance);
    if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    *hit = visibility_hit_read(scene->geometries, rayhit.ray.tfar, &rayhit.hit);
    return true;
}

/* Notes a surface by its distance; when there are too many, the farthest goes. */
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

static void dim(const struct RTCFilterFunctionNArguments *arguments)
{
    if (arguments->valid[0] != -1)
        return;
    search *s = (search *)(void *)arguments->context;
    visibility_hit hit = candidate(arguments);
    if (is_crossed(s, &hit)) {
        note(s->crossings, &hit);
        arguments->valid[0] = 0;
        return;
    }
    s->opening *= max(1.0f - opacity_of(s->scene, &s->ray, &hit), 0.0f);
    if (s->opening > 0.0f)
        arguments->valid[0] = 0;
}

float ray_trace_opening(const shading_scene *scene, const shading_ray *ray, ray_crossings *crossings)
{
    struct RTCRay r = embree_ray(ray);
    if (crossings) {
        crossings->count = 0;
        crossings->is_cut = false;
    }
    if (!scene->plans->has_see_through && !crossings)
        return embree_occluded1(scene->embree->scene, &r) ? 0.0f : 1.0f;
    search s = {.scene = scene, .ray = *ray, .opening = 1.0f, .crossings = crossings};
    s.ray.spread = &NO_SPREAD;
    return embree_occluded1_filtered(scene->embree->scene, &r, &s.context, dim) ? 0.0f : s.opening;
}

/* ---- the bodies around a point ---- */

typedef struct survey {
    embree_context context; /* first: what Embree hands to the filter */
    const shading_scene *scene;
    vec3 direction;
    uint32_t count;
    struct {
        const render_geometry *geometry;
        int excess;        /* sides met from inside, less those from outside */
    } bodies[MEDIA_DEPTH]; /* by material, in the order in which they are met */
} survey;

static void count_side(survey *s, const visibility_hit *hit)
{
    const render_geometry *g = &s->scene->geometries->items[hit->geometry];
    uint32_t i = 0;
    while (i < s->count && s->bodies[i].geometry->material != g->material)
        i++;
    if (i == MEDIA_DEPTH)
        return;
    if (i == s->count) {
        s->bodies[s->count].geometry = g;
        s->bodies[s->count++].excess = 0;
    }
    s->bodies[i].excess += surface_sees_front(g, hit, s->direction) ? -1 : 1;
}

static void note_side(const struct RTCFilterFunctionNArguments *arguments)
{
    if (arguments->valid[0] != -1)
        return;
    survey *s = (survey *)(void *)arguments->context;
    const struct RTCRay *ray = (const struct RTCRay *)(const void *)arguments->ray;
    const struct RTCHit *h = (const struct RTCHit *)(const void *)arguments->hit;
    visibility_hit hit = visibility_hit_read(s->scene->geometries, ray->tfar, h);
    arguments->valid[0] = 0;
    if (s->scene->plans->items[hit.geometry].is_body)
        count_side(s, &hit);
}

static survey survey_from(const shading_scene *scene, const float P[3], vec3 direction)
{
    survey s = {.scene = scene, .direction = direction};
    shading_ray ray = {.origin = {P[0], P[1], P[2]}, .far_t = INFINITY};
    store3(direction, ray.direction);
    struct RTCRayHit rayhit = {
        .ray = embree_ray(&ray),
        .hit = {.geomID = RTC_INVALID_GEOMETRY_ID, .instID = {RTC_INVALID_GEOMETRY_ID}}};
    embree_intersect1_filtered(scene->embree->scene, &rayhit, &s.context, note_side);
    return s;
}

static int excess_of(const survey *s, const scene_material *material)
{
    for (uint32_t i = 0; i < s->count; i++)
        if (s->bodies[i].geometry->material == material)
            return s->bodies[i].excess;
    return 0;
}

static bool is_within_bounds(const shading_scene *scene, const float P[3])
{
    struct RTCBounds b;
    rtcGetSceneBounds(scene->embree->scene, &b);
    return P[0] >= b.lower_x && P[0] <= b.upper_x && P[1] >= b.lower_y && P[1] <= b.upper_y &&
           P[2] >= b.lower_z && P[2] <= b.upper_z;
}

/* Three ways out that no model is aligned to: an open mesh has its back turned to one of them at most by chance. */
uint32_t ray_trace_media_at(const shading_scene *scene, const float P[3], media *m)
{
    enum { WAYS = 3 };
    static const float ways[WAYS][3] = {
        {0.3015f, 0.9045f, 0.3015f}, {-0.8018f, -0.2673f, 0.5345f}, {0.4575f, -0.1525f, -0.8760f}};
    if (!scene->plans->has_bodies || !is_within_bounds(scene, P))
        return 0;
    survey surveys[WAYS];
    for (uint32_t i = 0; i < WAYS; i++) {
        surveys[i] = survey_from(scene, P, load3(ways[i]));
        if (surveys[i].count == 0)
            return i + 1;
    }
    for (uint32_t i = surveys[0].count; i > 0; i--) {
        const render_geometry *g = surveys[0].bodies[i - 1].geometry;
        if (surveys[0].bodies[i - 1].excess > 0 && excess_of(&surveys[1], g->material) > 0 &&
            excess_of(&surveys[2], g->material) > 0)
            media_enter(m, g->material, g->material->thickness * g->scale);
    }
    return WAYS;
}
