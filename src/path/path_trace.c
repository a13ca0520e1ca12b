/* path_trace.c - see path_trace.h: the walk from the camera, vertex after vertex. At each, light is aimed at and a
 * direction is drawn in which it may be met as well; both are weighted by multiple importance sampling (Veach and Guibas
 * 1995). */
#include <string.h>

#include "cpu/ray_trace.h"

#include "path/path_camera.h"
#include "path/path_shadow.h"
#include "path/path_trace.h"
#include "path/path_vertex.h"

enum {
    DEFAULT_DEPTH = 64,  /* of facet_path_desc.max_depth */
    ROULETTE_DEPTH = 3,  /* surfaces before a path may be ended by chance */
    MOST_VERTICES = 1024 /* with those that light passes straight */
};

/* Half-angle of the cone that a direction stands for, of density pdf per sr: that of 1/32 of a sample's solid angle, so that
 * the cones of a pixel's samples overlap little. */
static float cone_angle(float pdf)
{
    return 0.1f * inversesqrt(max(pdf, 1e-3f));
}

/* ---- along the ray ---- */

/* The ray as the surface reads its textures by: a cone as wide as it is where it meets the surface. */
static shading_ray ray_of(const path *p, float t, ray_spread *spread)
{
    shading_ray ray = {.far_t = INFINITY, .spread = spread, .footprint = 2.0f};
    mat3 frame = basis_from_normal(p->D);
    float width = p->width_m + p->angle * t;
    *spread = (ray_spread){.moves = true};
    store3(COL(frame, 0) * width, spread->origin_dx);
    store3(COL(frame, 1) * width, spread->origin_dy);
    store3(p->P, ray.origin);
    store3(p->D, ray.direction);
    return ray;
}

static bool is_finite(vec3 v)
{
    float sum = v[0] + v[1] + v[2];
    return sum - sum == 0.0f;
}

static void meet_surroundings(path *p)
{
    float pdf = 0.0f;
    if (p->from.is_chosen)
        pdf = path_lights_surroundings_pdf(p->scene->lights, p->from.P, p->from.N, p->D);
    path_add(p, p->throughput * path_lights_surroundings(p->scene->lights, p->D) * path_met_weight(p, pdf));
}

/* The next surface; false: the path has left. */
static bool find_next(path *p, visibility_hit *hit)
{
    shading_ray ray = {.far_t = INFINITY};
    store3(p->P, ray.origin);
    store3(p->D, ray.direction);
    uint32_t random = 0;
    if (p->shading->plans->has_see_through)
        random = (uint32_t)(path_sampler_number(&p->sampler) * 4294967040.0f);
    p->out->rays++;
    return ray_trace_nearest(p->shading, &ray, random, hit);
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

/* Aims at a light. */
static void add_light(path *p, const path_vertex *v)
{
    vec2 u = path_sampler_pair(&p->sampler);
    float u_light = path_sampler_number(&p->sampler);
    path_light_sample light;
    if (!path_lights_sample(p->scene->lights, v->s.P, path_vertex_light_normal(v), u_light, u, &light))
        return;
    vec3 f;
    float pdf = 0.0f;
    if (light.is_point)
        f = path_vertex_scatter_punctual(v, light.L);
    else
        f = path_vertex_scatter(v, light.L, &pdf);
    float weight = path_aimed_weight(p->scene, &light, pdf) / light.pdf;
    vec3 contribution = p->throughput * f * light.radiance * weight;
    if (max3(contribution) > 0.0f)
        path_add(p, contribution * path_shadow(p, path_vertex_start(v, light.L), &light));
}

/* Goes on in a direction; false: the path ends. */
static bool scatter(path *p, const path_vertex *v)
{
    vec2 u = path_sampler_pair(&p->sampler);
    float u_lobe = path_sampler_number(&p->sampler);
    path_direction d;
    if (!path_vertex_sample(v, u_lobe, u, &d))
        return false;
    p->throughput *= d.weight;
    p->P = path_vertex_start(v, d.L);
    p->D = d.L;
    p->passed_m = 0.0f;
    p->from =
        (path_origin){.P = v->s.P, .N = path_vertex_light_normal(v), .pdf = d.pdf, .is_chosen = !d.is_mirror};
    if (!d.is_mirror)
        p->angle = max(p->angle, cone_angle(d.pdf));
    return true;
}

/* Russian roulette: what carries little is ended with a probability that the others make up for. */
static bool survives(path *p)
{
    float most = max3(p->throughput);
    if (!(most > 0.0f) || !is_finite(p->throughput))
        return false;
    if (p->depth < ROULETTE_DEPTH || most >= 1.0f)
        return true;
    if (path_sampler_number(&p->sampler) >= most)
        return false;
    p->throughput *= 1.0f / most;
    return true;
}

static bool is_clear(const path_vertex *v)
{
    float rough = v->lobes.diffuse + v->lobes.diffuse_back + v->lobes.sheen;
    return rough < 0.1f && v->s.m.base.alpha < 0.01f;
}

/* Albedo and normal of what is seen, in mirrors as well. */
static void describe(path *p, const path_vertex *v)
{
    p->follows_mirrors = v->s.is_lit && is_clear(v) && p->vertex < 8;
    if (p->follows_mirrors)
        return;
    store3(clamp(v->s.is_lit ? v->s.m.base.base_color : load3(v->s.base_color), 0.0f, 1.0f), p->out->albedo);
    store3(v->s.m.base.N, p->out->normal);
}

/* All that happens at a surface; false: the path ends. */
static bool meet(path *p, const visibility_hit *hit, const shading_ray *ray)
{
    path_vertex v;
    path_vertex_make(p, hit, ray, &v);
    if (p->follows_mirrors)
        describe(p, &v);
    add_emission(p, &v, hit);
    uint32_t most = p->scene->setup->desc->path.max_depth;
    if (!v.s.is_lit || p->depth >= (most ? most : DEFAULT_DEPTH))
        return false;
    p->depth++;
    p->width_m += p->angle * hit->t;
    add_light(p, &v);
    return scatter(p, &v) && survives(p);
}

/* From the first surface on. */
static void follow(path *p, visibility_hit *hit, const shading_ray *first)
{
    ray_spread spread;
    shading_ray ray = *first;
    for (p->vertex = 1; p->vertex < MOST_VERTICES; p->vertex++) {
        path_sampler_begin(&p->sampler, p->vertex);
        if (!meet(p, hit, &ray) || !is_finite(p->P) || !is_finite(p->D))
            return;
        if (!find_next(p, hit)) {
            meet_surroundings(p);
            return;
        }
        ray = ray_of(p, hit->t, &spread);
    }
}

/* ---- from the camera ---- */

/* What is seen where nothing covers it. */
static vec3 background(const path_scene *scene, vec3 D)
{
    float blur = scene->setup->desc->background_blur;
    if (!(blur > 0.0f))
        return path_lights_surroundings(scene->lights, D);
    float d[3];
    float radiance[3];
    store3(D, d);
    light_specular(&scene->setup->light, d, blur, radiance);
    return load3(radiance);
}

void path_trace(const path_scene *scene, uint32_t x, uint32_t y, uint32_t index, path_sample *out)
{
    memset(out, 0, sizeof *out);
    const facet_render_desc *desc = scene->setup->desc;
    path p = {.scene = scene,
              .shading = &scene->setup->shading,
              .sampler = path_sampler_start(desc->path.seed, x, y, index),
              .follows_mirrors = true,
              .out = out};
    path_sampler_begin(&p.sampler, 0);
    path_camera_ray camera;
    path_camera_ray_at(scene, &p.sampler, x, y, &camera);
    ray_first first = ray_trace_first(p.shading, &camera.ray, path_sampler_number(&p.sampler));
    out->rays = first.rays;
    p.P = load3(camera.ray.origin);
    p.D = load3(camera.ray.direction);
    p.throughput = vec3(first.opacity);
    const camera_rays *rays = &scene->setup->camera;
    p.width_m = rays->is_orthographic ? 0.5f * PATH_CAMERA_FOOTPRINT * rays->pixel_size : 0.0f;
    p.angle = rays->is_orthographic ? 0.0f : 0.5f * PATH_CAMERA_FOOTPRINT * rays->pixel_size;
    if (first.opacity > 0.0f)
        follow(&p, &first.hit, &camera.ray);
    out->opacity = first.opacity;
    if (scene->draws_background) {
        p.radiance += background(scene, load3(camera.ray.direction)) * (1.0f - first.opacity);
        out->opacity = 1.0f;
    }
    out->opacity *= camera.weight;
    store3(p.radiance * camera.weight, out->radiance);
}
