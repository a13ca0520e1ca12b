/* path_shadow.c - see path_shadow.h. */
#include "cpu/ray_trace.h"
#include "cpu/volume_rays.h"

#include "path/path_shadow.h"
#include "path/path_vertex.h"
#include "path/path_volume.h"

/* By what rounding may move a point that was chosen on a light. */
static float tolerance_of(const path *p, vec3 end, const path_light_sample *light)
{
    vec3 most = abs(end);
    if (light->geometry != VISIBILITY_NONE) {
        const render_geometry *g = &p->shading->geometries->items[light->geometry];
        const uint32_t *corners = render_geometry_triangle(g, light->primitive);
        for (int i = 0; i < 3; i++) {
            float corner[3];
            render_geometry_corner(g, corners[i], corner);
            most = max(most, abs(load3(corner)));
        }
    }
    return volume_rays_tolerance_of(max3(most));
}

/* From P to the light that was chosen for the point `at`, or to shortly before it where it is a surface. */
static shading_ray ray_to(const path *p, vec3 at, vec3 P, const path_light_sample *light)
{
    shading_ray ray = {.far_t = INFINITY};
    store3(P, ray.origin);
    store3(light->L, ray.direction);
    if (light->is_surroundings || !(light->distance_m < 1e30f))
        return ray;
    vec3 end = at + light->L * light->distance_m;
    vec3 way = end - P;
    float length_m = length(way);
    ray.far_t = length_m * (1.0f - 4e-6f) - 2.0f * tolerance_of(p, end, light);
    if (length_m > 0.0f)
        store3(way * (1.0f / length_m), ray.direction);
    return ray;
}

/* What a surface that transmits lets pass. has_straight_shadows: as if it did not refract, and looked at face to face. */
static vec3 share_passed(const path *p, const path_vertex *v)
{
    const surface_point *s = &v->s;
    vec3 share = vec3(1.0f);
    if (!v->is_false) {
        share = path_vertex_straight(v);
        if (!v->is_straight && path_has_straight_shadows(p) && s->m.layers & LAYER_TRANSMISSION)
            share = below_shares(s->m).specular * ((1.0f - s->m.base.metallic) * (1.0f - max3(s->m.base.F0)));
    }
    float opacity = surface_opacity(s->hit.geometry->material, s->base_color[3]);
    return mix(vec3(1.0f), share, opacity);
}

/* Through all crossings, nearest first; w: a path that goes along the ray. False: nothing passes. */
static bool go_through(path *w, const ray_crossings *c, const shading_ray *ray, float *from, vec3 *share)
{
    for (uint32_t i = 0; i < c->count; i++) {
        path_vertex v;
        const visibility_hit *hit = &c->hits[i];
        media before = w->media;
        path_vertex_make(w, hit, ray, &v);
        /* Boundaries in one place were crossed together: volume_rays_cross(). */
        bool is_crossed = *from > 0.0f && hit->t - *from <= 2.0f * v.tolerance && v.s.plan->is_volume;
        if (is_crossed) {
            w->media = before;
            continue;
        }
        *share *= path_media_transmittance(&w->media, hit->t - *from) * share_passed(w, &v);
        *from = hit->t;
        if (v.s.m.layers & LAYER_VOLUME)
            w->media = v.behind;
        if (!(max3(*share) > 0.0f))
            return false;
    }
    return true;
}

static vec3 walk(path *p, shading_ray *ray, const media *in, float skipped_m)
{
    static const ray_spread none = {.moves = false, .turns = false};
    ray_crossings crossings = {.takes_all = path_has_straight_shadows(p)};
    path w = *p;
    w.media = *in;
    ray->spread = &none;
    float from = -skipped_m;
    vec3 share = vec3(ray_trace_opening(p->shading, ray, &crossings));
    if (!(share[0] > 0.0f) || !go_through(&w, &crossings, ray, &from, &share))
        return vec3(0.0f);
    while (crossings.is_cut) {
        ray->near_t = nextafterf(from, INFINITY);
        p->out->rays++;
        ray_trace_opening(p->shading, ray, &crossings);
        if (!go_through(&w, &crossings, ray, &from, &share))
            return vec3(0.0f);
    }
    return share * path_media_transmittance(&w.media, ray->far_t - from);
}

vec3 path_shadow(path *p, vec3 at, vec3 P, const media *in, const path_light_sample *light)
{
    shading_ray ray = ray_to(p, at, P, light);
    if (!(ray.far_t > 0.0f))
        return vec3(1.0f);
    p->out->rays++;
    float skipped_m = path_skipped(P - at, load3(ray.direction));
    if (p->shading->plans->may_pass_straight || path_has_straight_shadows(p))
        return walk(p, &ray, in, skipped_m);
    vec3 share = vec3(ray_trace_opening(p->shading, &ray, NULL));
    return in->count && share[0] > 0.0f ? share * path_media_transmittance(in, ray.far_t + skipped_m) : share;
}
