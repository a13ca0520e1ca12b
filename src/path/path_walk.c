/* path_walk.c - see path_walk.h. At each vertex light is aimed at, and a direction is drawn in which it may be met as well;
 * both are weighted by multiple importance sampling (Veach and Guibas 1995). What light passes straight is no vertex: it
 * counts for neither depth nor weights, shadow rays pass it too. */
#include "cpu/ray_trace.h"

#include "path/path_shadow.h"
#include "path/path_vertex.h"
#include "path/path_volume.h"
#include "path/path_walk.h"

enum {
    DEFAULT_DEPTH = 64,  /* of facet_path_desc.max_depth */
    ROULETTE_DEPTH = 3,  /* surfaces before a path may be ended by chance */
    MIRRORS = 8,         /* in a row, behind which albedo and normal are looked for */
    MOST_VERTICES = 2048 /* with those that light passes straight */
};

typedef enum place { AT_SURFACE, IN_VOLUME, NOWHERE } place;

/* The numbers of one vertex: always as many, so that each dimension keeps its meaning. */
typedef struct numbers {
    vec2 light, direction;
    float which_light, which_lobe, roulette, wavelength;
} numbers;

static numbers draw_numbers(path *p)
{
    path_sampler_begin(&p->sampler, p->vertex);
    vec2 light = path_sampler_pair(&p->sampler);
    vec2 direction = path_sampler_pair(&p->sampler);
    vec2 which = path_sampler_pair(&p->sampler);
    vec2 rest = path_sampler_pair(&p->sampler);
    return (numbers){.light = light,
                     .direction = direction,
                     .which_light = which[0],
                     .which_lobe = which[1],
                     .roulette = rest[0],
                     .wavelength = rest[1]};
}

static bool is_finite(vec3 v)
{
    float sum = v[0] + v[1] + v[2];
    return sum - sum == 0.0f;
}

static bool has_depth_left(const path *p)
{
    uint32_t most = p->scene->setup->desc->path.max_depth;
    return p->depth < (most ? most : DEFAULT_DEPTH);
}

/* Half-angle of the cone that a direction stands for, of density pdf per sr: that of 1/32 of a sample's solid angle, so that
 * the cones of a pixel's samples overlap little. */
static float cone_angle(float pdf)
{
    return 0.1f * inversesqrt(max(pdf, 1e-3f));
}

/* Russian roulette: what carries little is ended with a probability that the others make up for. Little beside what left
 * the first surface: noise on a dark one is as visible as on a bright one. The fourth root waits a few surfaces more, since
 * light that is found behind glass is much more than throughput tells; in the long run as many paths end at a surface as it
 * takes of light. Relative MSE times seconds beside throughput itself: .45 (glass), .68 (a glossy room); the square root:
 * .51, .69. */
static bool survives(path *p, float u)
{
    float most = max3(p->throughput);
    if (!is_finite(p->throughput)) {
        p->radiance += p->throughput; /* to be counted as what it is */
        return false;
    }
    if (!(most > 0.0f))
        return false;
    if (!(p->at_first > 0.0f))
        p->at_first = most;
    float survival = sqrt(sqrt(most / p->at_first));
    if (p->depth < ROULETTE_DEPTH || survival >= 1.0f)
        return true;
    if (u >= survival)
        return false;
    p->throughput *= 1.0f / survival;
    return true;
}

/* ---- between vertices ---- */

/* The ray as the surface reads its textures by: a cone as wide as it is where it meets the surface. What textures let shine
 * is read as finely as where it is aimed at. Normals are smoothed for what the camera sees only, and mirrors. */
static shading_ray ray_of(const path *p, const visibility_hit *hit, ray_spread *spread)
{
    const scene_material *m = p->shading->geometries->items[hit->geometry].material;
    bool shines = scene_material_has(m, SCENE_EMISSIVE_TEXTURE) && max3(load3(m->emissive)) > 0.0f;
    bool is_fine = shines || (p->shading->has_specular_antialiasing && p->from.is_chosen);
    shading_ray ray = {.far_t = INFINITY, .spread = spread, .footprint = 2.0f};
    mat3 frame = basis_from_normal(p->D);
    float width = is_fine ? 0.0f : p->width_m + p->angle * hit->t;
    *spread = (ray_spread){.moves = true};
    store3(COL(frame, 0) * width, spread->origin_dx);
    store3(COL(frame, 1) * width, spread->origin_dy);
    store3(p->P, ray.origin);
    store3(p->D, ray.direction);
    return ray;
}

/* Environment radiance; `sunless`: the same without the sun. Of the sun, what the medium before it neither absorbs nor scatters is
 * seen: the rest is in its emission. */
static vec3 sun_through_medium(const path *p, vec3 radiance, vec3 sunless)
{
    const path_surface *surface = p->scene->surface;
    return sunless + (radiance - sunless) * surface->sun_transmittance(surface->self, p->seen_through_m);
}

static vec3 environment_radiance(const path *p)
{
    vec3 radiance = path_lights_surroundings(p->scene->lights, p->D);
    if (!(p->seen_through_m > 0.0f))
        return radiance;
    return sun_through_medium(p, radiance, path_lights_environment(p->scene->lights, p->D));
}

static void meet_surroundings(path *p)
{
    float pdf = 0.0f;
    if (p->excludes_sun) {
        path_add(p, p->throughput * path_lights_environment(p->scene->lights, p->D));
        return;
    }
    if (p->from.is_chosen)
        pdf = path_lights_surroundings_pdf(p->scene->lights, p->from.P, p->from.N, p->D);
    path_add(p, p->throughput * environment_radiance(p) * path_met_weight(p, pdf));
}

/* ---- the medium below a surface ---- */

/* Adds what the medium emits before the next vertex, and attenuates what is behind. */
static void cross_medium(path *p, float distance_m)
{
    const path_surface *surface = p->scene->surface;
    float length_m = distance_m + p->skipped_m;
    path_add(p, p->throughput * surface->emission(surface->self, p->P, p->D, length_m, p->is_indirect));
    p->throughput *= surface->transmittance(surface->self, length_m);
    p->seen_through_m += p->is_indirect ? 0.0f : length_m;
}

/* Whether a ray from v into L is in the medium. */
static bool is_ray_in_medium(const path *p, const path_vertex *v, vec3 L)
{
    if (!v->surface)
        return p->is_in_medium;
    return (v->on.side < 0.0f) != (dot(v->Ng, L) < 0.0f);
}

/* Inside of the medium the refracted sun is found by BSDF samples: half of them go towards it. They are one strategy with those of
 * the material itself: each direction's pdf is the mean of both. */
static bool guides_to_sun(const path *p, const path_vertex *v)
{
    return p->is_in_medium && !v->surface && p->scene->surface->has_sun && !v->is_mirror;
}

static bool sample_guided(const path *p, const path_vertex *v, float u_lobe, vec2 u, bsdf_sample *out)
{
    const path_surface *surface = p->scene->surface;
    bool is_sunward = u_lobe < 0.5f;
    float rest = is_sunward ? 2.0f * u_lobe : 2.0f * u_lobe - 1.0f;
    if (is_sunward) {
        *out = (bsdf_sample){.L = surface->sun_sample(surface->self, u)};
        out->is_transmission = dot(out->L, v->Ng) < 0.0f;
    } else if (!path_vertex_sample(v, rest, u, out))
        return false;
    if (out->is_specular) {
        out->weight *= 2.0f;
        return true;
    }
    vec3 f = path_vertex_scatter(v, out->L, &out->pdf);
    out->pdf = 0.5f * (out->pdf + surface->sun_pdf(surface->self, out->L));
    out->weight = out->pdf > 0.0f ? f * (1.0f / out->pdf) : vec3(0.0f);
    return max3(out->weight) > 0.0f;
}

/* To the next vertex. */
static place advance(path *p, visibility_hit *hit)
{
    if (!is_finite(p->P) || !is_finite(p->D))
        return NOWHERE;
    shading_ray ray = {.far_t = INFINITY};
    store3(p->P, ray.origin);
    store3(p->D, ray.direction);
    uint32_t random = 0;
    if (p->shading->plans->has_see_through)
        random = (uint32_t)(path_sampler_number(&p->sampler) * 4294967040.0f);
    p->out->rays++;
    bool is_met = ray_trace_nearest(p->shading, &ray, random, hit);
    if (p->is_in_medium) {
        cross_medium(p, is_met ? hit->t : INFINITY);
        return is_met && max3(p->throughput) > 0.0f ? AT_SURFACE : NOWHERE;
    }
    if (p->media.count) {
        vec2 u = path_sampler_pair(&p->sampler);
        if (path_fly(p, is_met ? hit->t : INFINITY, u[0], u[1]))
            return IN_VOLUME;
    }
    if (is_met)
        return AT_SURFACE;
    meet_surroundings(p);
    return NOWHERE;
}

/* ---- at a surface ---- */

static void add_emission(path *p, const path_vertex *v, const visibility_hit *hit)
{
    vec3 radiance = path_vertex_emission(v);
    if (!(max3(radiance) > 0.0f))
        return;
    float pdf = 0.0f;
    if (p->from.is_chosen)
        pdf =
            path_lights_emitter_pdf(p->scene->lights, p->from.P, p->from.N, hit, p->D, p->passed_m + hit->t);
    path_add(p, p->throughput * radiance * path_met_weight(p, pdf));
}

/* BSDF |N.L| and its pdf for a light that was chosen. Light without size shows in mirrors as spots; but what light passes
 * straight was passed by the shadow ray of the surface before already. */
static vec3 value_for(const path *p, const path_vertex *v, const path_light_sample *light, float *pdf)
{
    bool is_through = dot(v->Ng, light->L) < 0.0f;
    *pdf = 0.0f;
    if (is_through && !v->lets_through)
        return vec3(0.0f);
    if (is_through && p->from.is_chosen && v->s.m.layers & LAYER_TRANSMISSION && path_has_straight_shadows(p))
        return vec3(0.0f);
    if (light->is_point && !(is_through && v->is_straight && p->from.is_chosen))
        return path_vertex_scatter_punctual(v, light->L);
    return path_vertex_scatter(v, light->L, pdf);
}

/* Aims at a light. */
static void add_light(path *p, const path_vertex *v, const numbers *u)
{
    if (v->is_mirror && p->scene->setup->light.punctual_count == 0)
        return;
    path_light_sample light;
    if (!path_lights_sample(p->scene->lights, v->s.P, path_vertex_light_normal(v), u->which_light, u->light,
                            &light))
        return;
    if (v->surface && light.is_surroundings && p->seen_through_m > 0.0f)
        light.radiance =
            sun_through_medium(p, light.radiance, path_lights_environment(p->scene->lights, light.L));
    float pdf;
    vec3 f = value_for(p, v, &light, &pdf);
    vec3 contribution =
        p->throughput * f * light.radiance * (path_aimed_weight(p->scene, &light, pdf) / light.pdf);
    const path_surface *surface = p->scene->surface;
    if (surface && is_ray_in_medium(p, v, light.L))
        contribution *= surface->transmittance(surface->self, light.distance_m);
    if (!(max3(contribution) > 0.0f))
        return;
    bool is_inside = v->s.m.layers & LAYER_VOLUME && dot(v->Ng, light.L) < 0.0f;
    const media *in = is_inside ? &v->behind : &p->media;
    path_add(p, contribution * path_shadow(p, v->s.P, path_vertex_start(v, light.L), in, &light));
}

/* Goes on from a surface into L. */
static void leave(path *p, const path_vertex *v, vec3 L)
{
    p->P = path_vertex_start(v, L);
    p->D = L;
    p->skipped_m = path_skipped(p->P - v->s.P, L);
}

/* Straight on. Where shadow rays are stopped (bodies of one material that overlap), light is met only. */
static bool pass(path *p, const path_vertex *v, const visibility_hit *hit, vec3 share)
{
    p->throughput *= share;
    p->passed_m += hit->t;
    p->from.is_chosen = p->from.is_chosen && v->s.plan->may_pass_straight;
    leave(p, v, p->D);
    if (v->s.m.layers & LAYER_VOLUME)
        p->media = v->behind;
    return max3(p->throughput) > 0.0f;
}

/* One of many wavelengths goes on through a body that disperses, by the lobes' probabilities of them all: what is reflected
 * keeps its color. */
static bool disperse(path *p, path_vertex *v, const numbers *u, bsdf_sample *d)
{
    WavelengthSample w = sample_wavelength(u->wavelength);
    p->wavelength_nm = w.wavelength_nm;
    p->throughput *= w.weight;
    path_vertex_set_wavelength(p, v);
    return path_vertex_sample(v, u->which_lobe, u->direction, d) && d->is_transmission;
}

/* Goes on in a direction; false: the path ends. */
static bool scatter(path *p, path_vertex *v, const visibility_hit *hit, const numbers *u)
{
    bsdf_sample d;
    bool is_any = guides_to_sun(p, v) ? sample_guided(p, v, u->which_lobe, u->direction, &d)
                                      : path_vertex_sample(v, u->which_lobe, u->direction, &d);
    if (!is_any)
        return false;
    if (d.is_transmission && v->disperses && !disperse(p, v, u, &d))
        return false;
    if (d.is_specular && d.is_transmission && v->is_straight) {
        p->depth--;
        return pass(p, v, hit, d.weight);
    }
    p->throughput *= d.weight;
    leave(p, v, d.L);
    if (d.is_transmission && v->s.m.layers & LAYER_VOLUME)
        p->media = v->behind;
    p->is_indirect = p->is_indirect || (p->is_in_medium && !v->surface);
    p->seen_through_m = v->surface ? p->seen_through_m : 0.0f;
    if (v->surface && d.is_transmission)
        p->is_in_medium = !p->is_in_medium;
    p->excludes_sun = d.excludes_sun;
    p->has_crossed = d.is_transmission && p->from.is_chosen && v->s.m.layers & LAYER_TRANSMISSION &&
                     path_has_straight_shadows(p);
    if (!p->has_crossed)
        p->from = (path_origin){
            .P = v->s.P, .N = path_vertex_light_normal(v), .pdf = d.pdf, .is_chosen = !d.is_specular};
    p->passed_m = 0.0f;
    if (!d.is_specular)
        p->angle = max(p->angle, cone_angle(d.pdf));
    return survives(p, u->roulette);
}

static bool is_clear(const path_vertex *v)
{
    float rough = v->lobes.diffuse + v->lobes.diffuse_back + v->lobes.sheen;
    return rough < 0.1f && v->s.m.base.alpha < 0.01f;
}

/* Albedo and normal of what is seen, in mirrors as well. */
static void describe(path *p, const path_vertex *v)
{
    p->follows_mirrors = v->s.is_lit && is_clear(v) && p->vertex < MIRRORS;
    if (p->follows_mirrors)
        return;
    store3(clamp(v->s.is_lit ? v->s.m.base.base_color : load3(v->s.base_color), 0.0f, 1.0f), p->out->albedo);
    store3(v->s.m.base.N, p->out->normal);
}

/* False: the path ends. */
static bool meet_surface(path *p, const visibility_hit *hit, const shading_ray *ray)
{
    numbers u = draw_numbers(p);
    path_vertex v;
    path_vertex_make(p, hit, ray, &v);
    p->width_m += p->angle * hit->t;
    if (v.is_false)
        return pass(p, &v, hit, vec3(1.0f));
    if (p->follows_mirrors)
        describe(p, &v);
    add_emission(p, &v, hit);
    if (!v.s.is_lit)
        return false;
    if (!has_depth_left(p))
        return v.is_straight && pass(p, &v, hit, path_vertex_straight(&v));
    p->depth++;
    add_light(p, &v, &u);
    return scatter(p, &v, hit, &u);
}

/* ---- in a volume ---- */

static bool meet_particle(path *p)
{
    numbers u = draw_numbers(p);
    if (!has_depth_left(p))
        return false;
    p->depth++;
    p->follows_mirrors = false;
    float g = path_media_here(&p->media)->material->scatter_anisotropy;
    path_light_sample light;
    if (path_lights_sample(p->scene->lights, p->P, vec3(0.0f), u.which_light, u.light, &light)) {
        float phase = phase_HG(dot(p->D, light.L), g);
        vec3 contribution =
            p->throughput * light.radiance * (phase * path_aimed_weight(p->scene, &light, phase) / light.pdf);
        if (max3(contribution) > 0.0f)
            path_add(p, contribution * path_shadow(p, p->P, p->P, &p->media, &light));
    }
    vec3 L = sample_phase_HG(u.direction, p->D, g);
    float pdf = phase_HG(dot(p->D, L), g);
    p->D = L;
    p->from = (path_origin){.P = p->P, .N = vec3(0.0f), .pdf = pdf, .is_chosen = true};
    p->has_crossed = false;
    p->passed_m = 0.0f;
    p->angle = max(p->angle, cone_angle(pdf));
    return survives(p, u.roulette);
}

/* ---- all ---- */

static void walk(path *p, place where, visibility_hit hit, const shading_ray *first)
{
    ray_spread spread;
    shading_ray ray = *first;
    for (uint32_t i = 0; i < MOST_VERTICES && where != NOWHERE; i++) {
        p->vertex++;
        bool goes_on = where == AT_SURFACE ? meet_surface(p, &hit, &ray) : meet_particle(p);
        if (!goes_on)
            return;
        where = advance(p, &hit);
        if (where == AT_SURFACE)
            ray = ray_of(p, &hit, &spread);
    }
}

void path_walk(path *p)
{
    visibility_hit hit = {.geometry = VISIBILITY_NONE};
    ray_spread spread;
    shading_ray ray = {.far_t = INFINITY};
    place where = advance(p, &hit);
    if (where == AT_SURFACE)
        ray = ray_of(p, &hit, &spread);
    walk(p, where, hit, &ray);
}

void path_walk_from(path *p, const visibility_hit *hit, const shading_ray *ray)
{
    walk(p, AT_SURFACE, *hit, ray);
}
