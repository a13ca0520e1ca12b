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
} search;

/* The candidate's opacity. */
static float candidate_opacity(const struct RTCFilterFunctionNArguments *arguments, visibility_hit *hit)
{
    const search *s = (const search *)(const void *)arguments->context;
    const struct RTCRay *ray = (const struct RTCRay *)(const void *)arguments->ray;
    const struct RTCHit *h = (const struct RTCHit *)(const void *)arguments->hit;
    *hit = visibility_hit_read(s->scene->geometries, ray->tfar, h);
    return opacity_of(s->scene, &s->ray, hit);
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
    visibility_hit hit;
    float opacity = candidate_opacity(arguments, &hit);
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

static void dim(const struct RTCFilterFunctionNArguments *arguments)
{
    if (arguments->valid[0] != -1)
        return;
    search *s = (search *)(void *)arguments->context;
    visibility_hit hit;
    float passes = 1.0f - candidate_opacity(arguments, &hit);
    s->opening *= max(passes, 0.0f);
    if (s->opening > 0.0f)
        arguments->valid[0] = 0;
}

float ray_trace_opening(const shading_scene *scene, const shading_ray *ray)
{
    struct RTCRay r = embree_ray(ray);
    if (!scene->plans->has_see_through)
        return embree_occluded1(scene->embree->scene, &r) ? 0.0f : 1.0f;
    search s = {.scene = scene, .ray = *ray, .opening = 1.0f};
    s.ray.spread = &NO_SPREAD;
    return embree_occluded1_filtered(scene->embree->scene, &r, &s.context, dim) ? 0.0f : s.opening;
}
