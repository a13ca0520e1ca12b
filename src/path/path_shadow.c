/* path_shadow.c - path_shadow(): see path.h. */
#include "cpu/ray_trace.h"
#include "cpu/media.h"

#include "path/path.h"
#include "path/path_media.h"
#include "path/path_vertex.h"

/* Rounding error of a point that was sampled on a light. */
static float tolerance_of(const shading_scene *shading, vec3 end, const path_light_sample *light)
{
    vec3 largest = abs(end);
    if (light->geometry != VISIBILITY_NONE) {
        const render_geometry *g = &shading->geometries->items[light->geometry];
        const uint32_t *corners = render_geometry_triangle(g, light->primitive);
        for (int i = 0; i < 3; i++) {
            float corner[3];
            render_geometry_corner(g, corners[i], corner);
            largest = max(largest, abs(load3(corner)));
        }
    }
    return media_tolerance(max3(largest));
}

/* From P to the light that was sampled for the point `at`; it ends shortly before an emissive surface. */
static shading_ray shadow_ray(const shading_scene *shading, vec3 at, vec3 P, const path_light_sample *light)
{
    shading_ray ray = {.far_t = INFINITY};
    store3(P, ray.origin);
    store3(light->L, ray.direction);
    if (light->is_infinite || !(light->distance_m < 1e30f))
        return ray;
    vec3 end = at + light->L * light->distance_m;
    vec3 to_light = end - P;
    float length_m = length(to_light);
    ray.far_t = length_m * (1.0f - 4e-6f) - 2.0f * tolerance_of(shading, end, light);
    if (length_m > 0.0f)
        store3(to_light * (1.0f / length_m), ray.direction);
    return ray;
}

/* Transmittance of one surface. Straight shadows ignore refraction, and take the surface as seen at normal
 * incidence. */
static vec3 surface_transmittance(const path_scene *scene, const path_vertex *v)
{
    const surface_point *s = &v->s;
    vec3 share = vec3(1.0f);
    if (!v->is_null_interface) {
        share = path_vertex_straight(v);
        if (!v->passes_straight && path_has_straight_shadows(scene) && s->m.layers & LAYER_TRANSMISSION)
            share = below_shares(s->m).specular * ((1.0f - s->m.base.metallic) * (1.0f - max3(s->m.base.F0)));
    }
    float opacity = surface_opacity(s->hit.geometry->material, s->base_color[3]);
    return mix(vec3(1.0f), share, opacity);
}

/* A shadow ray, done up to from_m, where it is in media. */
typedef struct shadow_walk {
    const path_scene *scene;
    float wavelength_nm;
    float from_m;
    media media;
    vec3 transmittance;
} shadow_walk;

/* Through all crossings, nearest first. False: no light passes. */
static bool pass_crossings(shadow_walk *w, const ray_crossings *c, const shading_ray *ray)
{
    for (uint32_t i = 0; i < c->count; i++) {
        path_vertex v;
        const visibility_hit *hit = &c->hits[i];
        media before = w->media;
        path_vertex_make(w->scene, hit, ray, &w->media, w->wavelength_nm, &v);
        /* Coincident boundaries were crossed together: media_cross(). */
        bool is_crossed =
            w->from_m > 0.0f && hit->t - w->from_m <= 2.0f * v.tolerance_m && v.s.plan->is_volume;
        if (is_crossed) {
            w->media = before;
            continue;
        }
        w->transmittance *=
            path_media_transmittance(&w->media, hit->t - w->from_m) * surface_transmittance(w->scene, &v);
        w->from_m = hit->t;
        if (v.s.m.layers & LAYER_VOLUME)
            w->media = v.behind;
        if (!(max3(w->transmittance) > 0.0f))
            return false;
    }
    return true;
}

static vec3 walk(shadow_walk *w, shading_ray *ray, uint64_t *rays)
{
    static const ray_spread none = {.moves = false, .turns = false};
    const shading_scene *shading = &w->scene->setup->shading;
    ray_crossings crossings = {.takes_all = path_has_straight_shadows(w->scene)};
    ray->spread = &none;
    w->transmittance = vec3(ray_trace_transmittance(shading, ray, &crossings));
    if (!(w->transmittance[0] > 0.0f) || !pass_crossings(w, &crossings, ray))
        return vec3(0.0f);
    while (crossings.is_cut) {
        ray->near_t = nextafterf(w->from_m, INFINITY);
        (*rays)++;
        ray_trace_transmittance(shading, ray, &crossings);
        if (!pass_crossings(w, &crossings, ray))
            return vec3(0.0f);
    }
    return w->transmittance * path_media_transmittance(&w->media, ray->far_t - w->from_m);
}

vec3 path_shadow(const path_scene *scene, vec3 at, vec3 P, const path_light_sample *light, const media *in,
                 float wavelength_nm, uint64_t *rays)
{
    const shading_scene *shading = &scene->setup->shading;
    shading_ray ray = shadow_ray(shading, at, P, light);
    if (!(ray.far_t > 0.0f))
        return vec3(1.0f);
    (*rays)++;
    float skipped_m = path_skipped(P - at, load3(ray.direction));
    if (shading->plans->may_pass_straight || path_has_straight_shadows(scene)) {
        shadow_walk w = {.scene = scene, .wavelength_nm = wavelength_nm, .from_m = -skipped_m, .media = *in};
        return walk(&w, &ray, rays);
    }
    vec3 share = vec3(ray_trace_transmittance(shading, &ray, NULL));
    return in->count && share[0] > 0.0f ? share * path_media_transmittance(in, ray.far_t + skipped_m) : share;
}
