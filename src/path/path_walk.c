/* path_walk.c - path_walk(): unidirectional path tracing. At each vertex a light is sampled (next event
 * estimation) and the path goes on in a direction sampled from the BSDF, which may hit a light as well;
 * multiple importance sampling weighs both (Veach and Guibas 1995). Null interfaces and straight
 * transmission are no vertices: they count for neither depth nor weights, and shadow rays pass them too. */
#include "cpu/ray_trace.h"

#include "path/path.h"
#include "path/path_media.h"
#include "path/path_render.h"
#include "path/path_vertex.h"

enum {
    ROULETTE_DEPTH = 3,       /* surfaces before Russian roulette */
    MAX_FEATURE_VERTICES = 8, /* specular surfaces in a row, behind which albedo and normal are looked for */
    MAX_VERTICES = 2048       /* with null interfaces */
};

/* The random numbers of one vertex: always as many, so that each dimension keeps its meaning. */
typedef struct vertex_random {
    vec2 light, direction;
    float light_choice, lobe, roulette, wavelength;
} vertex_random;

static vertex_random draw_random(path *p)
{
    path_sampler_begin(&p->sampler, p->vertex);
    vec2 pairs[PATH_SAMPLER_PAIRS];
    path_sampler_vertex_pairs(&p->sampler, pairs);
    return (vertex_random){.light = pairs[0],
                           .direction = pairs[1],
                           .light_choice = pairs[2][0],
                           .lobe = pairs[2][1],
                           .roulette = pairs[3][0],
                           .wavelength = pairs[3][1]};
}

static bool is_finite(vec3 v)
{
    float sum = v[0] + v[1] + v[2];
    return sum - sum == 0.0f;
}

static bool has_depth_left(const path *p)
{
    uint32_t limit = p->scene->setup->desc->path.max_depth;
    return p->depth < (limit ? limit : PATH_DEFAULT_DEPTH);
}

/* ---- between vertices ---- */

/* What a ray ends at. */
typedef enum ray_end { AT_SURFACE, AT_PARTICLE, AT_INFINITY, TERMINATED } ray_end;

/* The medium below scene->surface: adds its emission along the ray, and attenuates what is behind. */
static void cross_surface_medium(path *p, float distance_m)
{
    const path_surface *surface = p->scene->surface;
    float length_m = distance_m + p->offset_m;
    path_add(p, p->beta * surface->emission(surface->self, p->P, p->D, length_m, p->is_indirect));
    p->beta *= surface->transmittance(surface->self, length_m);
    p->seen_through_m += p->is_indirect ? 0.0f : length_m;
}

/* Traces the ray to the next surface, or to a scattering event in the closed volume that it is in, where P
 * is then. */
static ray_end trace(path *p, visibility_hit *hit)
{
    const shading_scene *shading = &p->scene->setup->shading;
    if (!is_finite(p->P) || !is_finite(p->D))
        return TERMINATED;
    shading_ray ray = {.far_t = INFINITY};
    store3(p->P, ray.origin);
    store3(p->D, ray.direction);
    uint32_t random = 0;
    if (shading->plans->has_see_through)
        random = (uint32_t)(path_sampler_number(&p->sampler) * 4294967040.0f);
    p->out->rays++;
    bool is_hit = ray_trace_nearest(shading, &ray, random, hit);
    float distance_m = is_hit ? hit->t : INFINITY;
    if (p->is_in_medium) {
        cross_surface_medium(p, distance_m);
        return is_hit && max3(p->beta) > 0.0f ? AT_SURFACE : TERMINATED;
    }
    if (p->media.count) {
        vec2 u = path_sampler_pair(&p->sampler);
        path_flight f = path_media_sample_flight(&p->media, p->beta, distance_m + p->offset_m, u[0], u[1]);
        p->beta *= f.weight;
        if (f.is_scattered) {
            p->P += p->D * (f.distance_m - p->offset_m);
            p->offset_m = 0.0f;
            return AT_PARTICLE;
        }
    }
    return is_hit ? AT_SURFACE : AT_INFINITY;
}

/* The ray with the footprint by which the surface that it hits filters its textures: a cone. Textures of
 * emission are read at full resolution, as light sampling does. Normals are smoothed only for what the
 * camera and specular lobes see. */
static shading_ray ray_with_footprint(const path *p, const visibility_hit *hit, ray_spread *spread)
{
    const shading_scene *shading = &p->scene->setup->shading;
    const scene_material *m = shading->geometries->items[hit->geometry].material;
    bool is_emitter = scene_material_has(m, SCENE_EMISSIVE_TEXTURE) && max3(load3(m->emissive)) > 0.0f;
    bool is_point = is_emitter || (shading->has_specular_antialiasing && !p->specular_bounce);
    shading_ray ray = {.far_t = INFINITY, .spread = spread, .footprint = 2.0f};
    mat3 frame = basis_from_normal(p->D);
    float width = is_point ? 0.0f : p->cone_radius_m + p->cone_angle * hit->t;
    *spread = (ray_spread){.moves = true};
    store3(COL(frame, 0) * width, spread->origin_dx);
    store3(COL(frame, 1) * width, spread->origin_dy);
    store3(p->P, ray.origin);
    store3(p->D, ray.direction);
    return ray;
}

/* ---- light ---- */

/* Infinite light as seen through the medium below a surface; `sunless`: without the sun, of which only the
 * part is seen that the medium neither absorbs nor scatters: the rest is in its emission. */
static vec3 seen_through_medium(const path *p, vec3 radiance, vec3 sunless)
{
    const path_surface *surface = p->scene->surface;
    return sunless + (radiance - sunless) * surface->sun_transmittance(surface->self, p->seen_through_m);
}

/* The background of the image through glass: light from it is a lack of opacity. */
static vec3 light_of_backdrop(path *p)
{
    float transmittance[3];
    float unseen[3];
    float radiance[3] = {0.0f, 0.0f, 0.0f};
    store3(p->beta, transmittance);
    store3(p->beta * path_lights_infinite(p->scene->lights, p->D), unseen);
    p->out->opacity -= shading_show_backdrop(&p->scene->setup->shading, transmittance, unseen, radiance);
    return load3(radiance);
}

/* The contribution of environment and sun to a ray that hits nothing. */
static vec3 light_at_infinity(path *p)
{
    const path_lights *lights = p->scene->lights;
    if (p->sees_backdrop)
        return light_of_backdrop(p);
    if (p->excludes_sun)
        return p->beta * path_lights_environment(lights, p->D);
    float p_light = 0.0f;
    if (!p->specular_bounce)
        p_light = path_lights_infinite_pdf(lights, &p->views[p->view], p->D);
    vec3 radiance = path_lights_infinite(lights, p->D);
    if (p->seen_through_m > 0.0f)
        radiance = seen_through_medium(p, radiance, path_lights_environment(lights, p->D));
    return p->beta * radiance * path_weight_of_bsdf(p, p_light);
}

/* The contribution of the emission of a surface that the ray hit. */
static vec3 light_emitted(const path *p, const path_vertex *v, const visibility_hit *hit)
{
    vec3 radiance = path_vertex_emission(v);
    if (!(max3(radiance) > 0.0f))
        return vec3(0.0f);
    float p_light = 0.0f;
    if (!p->specular_bounce)
        p_light =
            path_lights_emitter_pdf(p->scene->lights, &p->views[p->view], hit, p->D, p->previous_m + hit->t);
    return p->beta * radiance * path_weight_of_bsdf(p, p_light);
}

/* BSDF |N.L| and its pdf for a light sample. Delta lights show as highlights in specular lobes; but light
 * that straight transmission lets pass was found by the shadow ray of the previous surface already. */
static vec3 eval_for_light(const path *p, const path_vertex *v, const path_light_sample *light, float *p_bsdf)
{
    bool is_transmission = dot(v->Ng, light->L) < 0.0f;
    *p_bsdf = 0.0f;
    if (is_transmission && !v->is_transmissive)
        return vec3(0.0f);
    if (is_transmission && !p->specular_bounce && v->s.m.layers & LAYER_TRANSMISSION &&
        path_has_straight_shadows(p->scene))
        return vec3(0.0f);
    if (light->is_delta && !(is_transmission && v->passes_straight && !p->specular_bounce))
        return path_vertex_eval_delta(v, light->L);
    return path_vertex_eval(v, light->L, p_bsdf);
}

/* Whether a ray from v in direction L is in the medium below scene->surface. */
static bool is_ray_in_medium(const path *p, const path_vertex *v, vec3 L)
{
    if (!v->surface)
        return p->is_in_medium;
    return (v->on.side < 0.0f) != (dot(v->Ng, L) < 0.0f);
}

/* Whether light that passes a surface keeps the view through it: glass, not paper. */
static bool is_clear_glass(const path_vertex *v)
{
    return (v->s.m.layers & (LAYER_TRANSMISSION | LAYER_DIFFUSE_TRANSMISSION)) == LAYER_TRANSMISSION;
}

/* The contribution of one light sample for a surface if nothing is in between. */
static vec3 light_unshadowed(const path *p, const path_vertex *v, float u_light, vec2 u,
                             path_light_sample *light)
{
    const path_scene *scene = p->scene;
    if (!path_lights_sample(scene->lights, &p->views[!p->view], u_light, u, light))
        return vec3(0.0f);
    if (p->sees_backdrop && light->is_infinite && dot(v->Ng, light->L) < 0.0f && is_clear_glass(v))
        return vec3(0.0f); /* the backdrop is there */
    if (v->surface && light->is_infinite && p->seen_through_m > 0.0f)
        light->radiance =
            seen_through_medium(p, light->radiance, path_lights_environment(scene->lights, light->L));
    float p_bsdf;
    vec3 f = eval_for_light(p, v, light, &p_bsdf);
    vec3 contribution =
        p->beta * f * light->radiance * (path_weight_of_light(scene, light, p_bsdf) / light->pdf);
    if (scene->surface && is_ray_in_medium(p, v, light->L))
        contribution *= scene->surface->transmittance(scene->surface->self, light->distance_m);
    return contribution;
}

/* Resampled importance sampling (Talbot, Cline and Egbert 2005): of several light samples the shadow ray goes
 * to one, chosen in proportion to what each would contribute; its weight is their mean contribution over its
 * own. The mean is unbiased for any weights of multiple importance sampling in the contributions, and for
 * samples that depend on one another: here they are one sample shifted over the unit cube by a lattice, so that
 * each is as well stratified over the pixel's samples as the first. */
static vec3 light_resampled(const path *p, const path_vertex *v, const vertex_random *u,
                            path_light_sample *light)
{
    static const float STEP_X = 0.754877666f; /* the lattice of Roberts 2018, by the plastic number */
    static const float STEP_Y = 0.569840291f;
    uint32_t count = path_lights_candidates(p->scene->lights, &p->views[!p->view]);
    if (count == 1)
        return light_unshadowed(p, v, u->light_choice, u->light, light);
    vec3 chosen = vec3(0.0f);
    float sum = 0.0f;
    float choice = u->wavelength; /* free: it only splits light that is transmitted */
    for (uint32_t i = 0; i < count; i++) {
        float step = (float)i;
        path_light_sample candidate;
        vec3 each = light_unshadowed(p, v, fract(u->light_choice + step / (float)count),
                                     fract(u->light + vec2(STEP_X, STEP_Y) * step), &candidate);
        float weight = max3(each);
        if (!(weight > 0.0f) || !(weight < INFINITY))
            continue;
        sum += weight;
        float share = weight / sum;
        if (choice < share) {
            *light = candidate;
            chosen = each / weight; /* whose reciprocal may be infinite */
            choice /= share;
        } else {
            choice = (choice - share) / (1.0f - share);
        }
    }
    return chosen * (sum / (float)count);
}

/* The contribution of one light, sampled for a surface: next event estimation. */
static vec3 light_sampled(path *p, const path_vertex *v, const vertex_random *u)
{
    const path_scene *scene = p->scene;
    if (v->is_specular && scene->setup->light.punctual_count == 0)
        return vec3(0.0f);
    path_lights_see(scene->lights, v->s.P, path_vertex_light_normal(v), &p->views[!p->view]);
    path_light_sample light;
    vec3 contribution = light_resampled(p, v, u, &light);
    if (!(max3(contribution) > 0.0f))
        return vec3(0.0f);
    bool is_inside = v->s.m.layers & LAYER_VOLUME && dot(v->Ng, light.L) < 0.0f;
    const media *in = is_inside ? &v->behind : &p->media;
    return contribution * path_shadow(scene, v->s.P, path_vertex_start(v, light.L), &light, in,
                                      p->wavelength_nm, &p->out->rays);
}

/* The same for a particle of the medium; g: the anisotropy of its phase function. */
static vec3 light_sampled_at_particle(path *p, float g, const vertex_random *u)
{
    path_light_sample light;
    path_lights_view *view = &p->views[!p->view];
    path_lights_see(p->scene->lights, p->P, vec3(0.0f), view);
    if (!path_lights_sample(p->scene->lights, view, u->light_choice, u->light, &light))
        return vec3(0.0f);
    float phase = phase_HG(dot(p->D, light.L), g);
    vec3 contribution =
        p->beta * light.radiance * (phase * path_weight_of_light(p->scene, &light, phase) / light.pdf);
    if (!(max3(contribution) > 0.0f))
        return vec3(0.0f);
    return contribution *
           path_shadow(p->scene, p->P, p->P, &light, &p->media, p->wavelength_nm, &p->out->rays);
}

/* ---- the next direction ---- */

/* In the medium below a surface half of the BSDF samples go towards the refracted sun. The two halves are
 * one strategy: each direction's pdf is the mean of both. */
static bool samples_sun(const path *p, const path_vertex *v)
{
    return p->is_in_medium && !v->surface && p->scene->surface->has_sun && !v->is_specular;
}

static bool sample_with_sun(const path *p, const path_vertex *v, float u_lobe, vec2 u, bsdf_sample *out)
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
    vec3 f = path_vertex_eval(v, out->L, &out->pdf);
    out->pdf = 0.5f * (out->pdf + surface->sun_pdf(surface->self, out->L));
    out->weight = out->pdf > 0.0f ? f * (1.0f / out->pdf) : vec3(0.0f);
    return max3(out->weight) > 0.0f;
}

/* Light that enters a dispersive volume goes on at one wavelength, weighted by the probabilities of all:
 * reflected light keeps its color. False: the path ends. */
static bool disperse(path *p, path_vertex *v, const vertex_random *u, bsdf_sample *out)
{
    WavelengthSample w = sample_wavelength(u->wavelength);
    p->wavelength_nm = w.wavelength_nm;
    p->beta *= w.weight;
    path_vertex_set_wavelength(v, &p->media, w.wavelength_nm);
    return path_vertex_sample(v, u->lobe, u->direction, out) && out->is_transmission;
}

static bool sample_direction(path *p, path_vertex *v, const vertex_random *u, bsdf_sample *out)
{
    bool is_any = samples_sun(p, v) ? sample_with_sun(p, v, u->lobe, u->direction, out)
                                    : path_vertex_sample(v, u->lobe, u->direction, out);
    if (is_any && out->is_transmission && v->disperses)
        return disperse(p, v, u, out);
    return is_any;
}

/* Starts the ray from a surface in direction L, and in the media behind it where it is transmitted. */
static void start_ray(path *p, const path_vertex *v, vec3 L, bool is_transmission)
{
    p->P = path_vertex_start(v, L);
    p->D = L;
    p->offset_m = path_skipped(p->P - v->s.P, L);
    if (is_transmission && v->s.m.layers & LAYER_VOLUME)
        p->media = v->behind;
}

/* Goes straight on through a surface that is no vertex. Where shadow rays are blocked (overlapping volumes
 * of one material), only BSDF sampling finds the light behind. False: the path ends. */
static bool pass_straight(path *p, const path_vertex *v, float distance_m, vec3 transmittance)
{
    p->beta *= transmittance;
    p->previous_m += distance_m;
    p->specular_bounce = p->specular_bounce || !v->s.plan->may_pass_straight;
    start_ray(p, v, p->D, true);
    return max3(p->beta) > 0.0f;
}

/* Goes on from a surface in a sampled direction. */
static void scatter(path *p, const path_vertex *v, const bsdf_sample *b)
{
    p->beta *= b->weight;
    start_ray(p, v, b->L, b->is_transmission);
    if (!b->is_specular)
        p->cone_angle = max(p->cone_angle, path_cone_angle(b->pdf));

    p->is_shadow_lit = b->is_transmission && !p->specular_bounce && v->s.m.layers & LAYER_TRANSMISSION &&
                       path_has_straight_shadows(p->scene);
    if (!p->is_shadow_lit) {
        p->view = !p->view;
        p->p_bsdf = b->pdf;
        p->specular_bounce = b->is_specular;
    }
    p->previous_m = 0.0f;
    p->excludes_sun = b->excludes_sun;
    p->sees_backdrop = p->sees_backdrop && b->is_transmission && is_clear_glass(v);

    p->is_indirect = p->is_indirect || (p->is_in_medium && !v->surface);
    p->seen_through_m = v->surface ? p->seen_through_m : 0.0f;
    if (v->surface && b->is_transmission)
        p->is_in_medium = !p->is_in_medium;
}

/* The same at a particle of the medium, in a direction sampled from its phase function. */
static void scatter_at_particle(path *p, float g, vec2 u)
{
    vec3 L = sample_phase_HG(u, p->D, g);
    float pdf = phase_HG(dot(p->D, L), g);
    p->D = L;
    p->cone_angle = max(p->cone_angle, path_cone_angle(pdf));
    p->view = !p->view;
    p->p_bsdf = pdf;
    p->specular_bounce = p->is_shadow_lit = p->sees_backdrop = false;
    p->previous_m = 0.0f;
}

/* Russian roulette. The survival probability is the fourth root of beta beside that after the first
 * surface: noise on a dark first surface is as visible as on a bright one, and the root waits a few
 * surfaces more, since light found behind glass is much brighter than beta suggests; in the long run as
 * many paths end at a surface as it absorbs of light. Relative MSE times seconds beside beta itself: .45
 * (glass), .68 (a glossy room); the square root: .51, .69. */
static bool survives(path *p, float u)
{
    float beta = max3(p->beta);
    if (!is_finite(p->beta)) {
        p->L += p->beta; /* makes the sample one that is dropped and counted */
        return false;
    }
    if (!(beta > 0.0f))
        return false;
    if (!(p->beta_first > 0.0f))
        p->beta_first = beta;
    float survival = sqrt(sqrt(beta / p->beta_first));
    if (p->depth < ROULETTE_DEPTH || survival >= 1.0f)
        return true;
    if (u >= survival)
        return false;
    p->beta *= 1.0f / survival;
    return true;
}

/* ---- denoiser ---- */

static bool is_specular_enough(const path_vertex *v)
{
    float diffuse = v->lobes.diffuse + v->lobes.diffuse_back + v->lobes.sheen;
    return diffuse < 0.1f && v->s.m.base.alpha < 0.01f;
}

/* Records albedo and normal of the first surface that is not specular, the albedo as it arrives through the specular
 * surfaces before it. Until then the normal is that of the first surface. A medium before the first surface, such as
 * water around the camera, leaves the albedo as it is. */
static void record_features(path *p, const path_vertex *v)
{
    if (p->vertex == 1)
        store3(v->s.m.base.N, p->out->normal);
    p->seeks_features = v->s.is_lit && is_specular_enough(v) && p->vertex < MAX_FEATURE_VERTICES;
    if (p->seeks_features)
        return;
    vec3 albedo = v->s.is_lit ? v->s.m.base.base_color : load3(v->s.base_color);
    store3(clamp(p->vertex == 1 ? albedo : albedo * p->beta, 0.0f, 1.0f), p->out->albedo);
    store3(v->s.m.base.N, p->out->normal);
}

/* The same where specular surfaces only show the environment, whose albedo is 1: the image over its albedo is
 * then as bright there as where the other samples of the pixel hit a surface. */
static void record_environment(path *p)
{
    if (p->seeks_features && p->vertex > 0)
        store3(clamp(p->beta, 0.0f, 1.0f), p->out->albedo);
}

/* ---- the walk ---- */

/* A scattering event in a closed volume. False: the path ends. */
static bool walk_particle(path *p, const vertex_random *u)
{
    if (!has_depth_left(p))
        return false;
    p->depth++;
    p->seeks_features = false;
    float g = path_media_here(&p->media)->material->scatter_anisotropy;
    path_add(p, light_sampled_at_particle(p, g, u));
    scatter_at_particle(p, g, u->direction);
    return survives(p, u->roulette);
}

/* The ray to the next vertex, with its footprint at a surface. */
static ray_end next_vertex(path *p, visibility_hit *hit, shading_ray *ray, ray_spread *spread)
{
    ray_end end = trace(p, hit);
    if (end == AT_SURFACE)
        *ray = ray_with_footprint(p, hit, spread);
    return end;
}

void path_walk(path *p, const visibility_hit *first_hit, const shading_ray *first_ray)
{
    visibility_hit hit = first_hit ? *first_hit : (visibility_hit){.geometry = VISIBILITY_NONE};
    shading_ray ray = first_ray ? *first_ray : (shading_ray){.far_t = INFINITY};
    ray_spread spread;
    ray_end end = first_hit ? AT_SURFACE : next_vertex(p, &hit, &ray, &spread);
    for (uint32_t i = 0; i < MAX_VERTICES && end != TERMINATED;
         i++, end = next_vertex(p, &hit, &ray, &spread)) {
        if (end == AT_INFINITY) {
            record_environment(p);
            path_add(p, light_at_infinity(p));
            return;
        }
        p->vertex++;
        const vertex_random u = draw_random(p);
        if (end == AT_PARTICLE) {
            if (walk_particle(p, &u))
                continue;
            return;
        }

        /* The surface, unless the media on both sides are the same. */
        path_vertex v;
        path_vertex_make(p->scene, &hit, &ray, &p->media, p->wavelength_nm, &v);
        p->cone_radius_m += p->cone_angle * hit.t;
        if (v.is_null_interface) {
            if (pass_straight(p, &v, hit.t, vec3(1.0f)))
                continue;
            return;
        }
        if (p->seeks_features)
            record_features(p, &v);

        /* Its emission: BSDF-sampled light. */
        path_add(p, light_emitted(p, &v, &hit));
        if (!v.s.is_lit)
            return;

        /* Next event estimation: light-sampled light. */
        if (!has_depth_left(p)) {
            if (v.passes_straight && pass_straight(p, &v, hit.t, path_vertex_straight(&v)))
                continue;
            return;
        }
        p->depth++;
        path_add(p, light_sampled(p, &v, &u));

        /* The next ray. Straight transmission makes no vertex of the surface. */
        bsdf_sample b;
        if (!sample_direction(p, &v, &u, &b))
            return;
        if (b.is_specular && b.is_transmission && v.passes_straight) {
            p->depth--;
            if (pass_straight(p, &v, hit.t, b.weight))
                continue;
            return;
        }
        scatter(p, &v, &b);
        if (!survives(p, u.roulette))
            return;
    }
}
