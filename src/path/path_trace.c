/* path_trace.c - path_trace(): one sample of a pixel, from the camera's ray to the radiance that it
 * contributes. */
#include <string.h>

#include "cpu/ray_trace.h"
#include "cpu/media.h"

#include "path/path.h"
#include "path/path_surface.h"

/* ---- camera rays ---- */

/* Side of the square of pixels whose texels a sample reads: with 16 samples a pixel they cover it once. */
static const float CAMERA_FOOTPRINT = 0.25f;

/* Uniform on the unit disk. Shirley and Chiu 1997, the concentric map. */
static vec2 sample_disk(vec2 u)
{
    vec2 s = u * 2.0f - 1.0f;
    if (!(abs(s[0]) > 0.0f || abs(s[1]) > 0.0f))
        return vec2(0.0f, 0.0f);
    bool is_wide = abs(s[0]) > abs(s[1]);
    float r = is_wide ? s[0] : s[1];
    float phi = is_wide ? 0.25f * PI * (s[1] / s[0]) : 0.5f * PI - 0.25f * PI * (s[0] / s[1]);
    return vec2(r * cos(phi), r * sin(phi));
}

static float focus_of(const facet_camera *camera)
{
    if (camera->focus_m > 0.0f)
        return camera->focus_m;
    vec3 to_target = load3(camera->target) - load3(camera->eye);
    return length(to_target);
}

/* Moves the origin of the ray to a point of the lens, such that points at the focus distance stay where
 * they are. direction has the length 1 along the axis. */
static void put_on_lens(const camera_rays *rays, const facet_camera *camera, vec2 u, shading_ray *ray)
{
    float focus = focus_of(camera);
    if (!(focus > 0.0f))
        return;
    vec2 point = sample_disk(u) * camera->lens_radius_m;
    vec3 right = normalize(load3(rays->is_orthographic ? rays->origin_dx : rays->direction_dx));
    vec3 down = normalize(load3(rays->is_orthographic ? rays->origin_dy : rays->direction_dy));
    vec3 offset = right * point[0] + down * point[1];
    store3(load3(ray->origin) + offset, ray->origin);
    /* At least a millionth of the lens' radius: the square of the direction stays finite. */
    store3(load3(ray->direction) - offset * (1.0f / max(focus, 1e-6f * camera->lens_radius_m)),
           ray->direction);
}

/* Normalizes the direction; near and far planes stay where they are. */
static void normalize_ray(path_camera_ray *r)
{
    shading_ray *ray = &r->ray;
    float scale = length(load3(ray->direction));
    store3(load3(ray->direction) * (1.0f / scale), ray->direction);
    ray->near_t *= scale;
    ray->far_t *= scale;
    r->spread.turns = r->spread.turns && scale > 0.0f;
    for (int i = 0; i < 3; i++) {
        r->spread.direction_dx[i] /= scale;
        r->spread.direction_dy[i] /= scale;
    }
}

void path_sample_camera_ray(const path_scene *scene, vec2 u_pixel, vec2 u_lens, uint32_t x, uint32_t y,
                            path_camera_ray *out)
{
    const render_setup *setup = scene->setup;
    const facet_camera *camera = setup->desc->camera;
    FilterSample f = sample_pixel_filter((int)setup->desc->path.filter, u_pixel);
    out->weight = f.weight;
    out->spread = setup->shading.camera_spread;
    out->ray = shading_ray_of_camera(&setup->camera, &out->spread, (float)x + 0.5f + f.offset[0],
                                     (float)y + 0.5f + f.offset[1], CAMERA_FOOTPRINT);
    if (camera && camera->lens_radius_m > 0.0f)
        put_on_lens(&setup->camera, camera, u_lens, &out->ray);
    normalize_ray(out);
}

/* ---- the shadow-catching ground ---- */

/* The ground is visible to the camera only, from above, and lit as a white diffuser. It is the first
 * vertex of a path of its own, so that light which arrives by way of the model, through its glass or off
 * its walls, counts as well. */

static const float UP[3] = {0.0f, 1.0f, 0.0f};

/* Whether the ray from P in direction D (unit) hits the ground from above, and where. */
static bool hits_ground(const path_scene *scene, vec3 P, vec3 D, vec3 *out)
{
    float height = P[1] - scene->ground_y;
    if (!scene->has_ground || !(height > 0.0f) || !(D[1] < 0.0f))
        return false;
    *out = P - D * (height / D[1]);
    (*out)[1] = scene->ground_y;
    return max3(abs(*out)) < 1e15f;
}

/* Radiance that arrives, and that would arrive without the model. */
typedef struct ground_light {
    vec3 lit, open;
} ground_light;

/* Light-sampled. Emissive triangles are part of the model. */
static ground_light sample_ground_light(path *p, vec2 u, float u_light)
{
    ground_light g = {.lit = vec3(0.0f), .open = vec3(0.0f)};
    path_light_sample light;
    if (!path_lights_sample(p->scene->lights, &p->views[p->view], u_light, u, &light))
        return g;
    float cosine = max(light.L[1], 0.0f);
    float p_bsdf = pdf_cosine(cosine);
    vec3 radiance =
        light.radiance * (INV_PI * cosine * path_weight_of_light(p->scene, &light, p_bsdf) / light.pdf);
    if (!(max3(radiance) > 0.0f))
        return g;
    if (light.geometry == VISIBILITY_NONE)
        g.open = radiance;
    g.lit = radiance * path_shadow(p->scene, p->views[p->view].P, p->P, &light, &p->media, p->wavelength_nm,
                                   &p->out->rays);
    return g;
}

/* BSDF-sampled, with the pdf cosine / pi, the weight of light here: beta stays 1. */
static ground_light sample_ground_bsdf(path *p, vec2 u)
{
    p->D = mul(basis_from_normal(load3(UP)), sample_cosine(u));
    p->p_bsdf = pdf_cosine(p->D[1]);
    p->specular_bounce = false;
    p->cone_angle = path_cone_angle(p->p_bsdf);
    float p_light = path_lights_infinite_pdf(p->scene->lights, &p->views[p->view], p->D);
    vec3 open = path_lights_infinite(p->scene->lights, p->D) * path_weight_of_bsdf(p, p_light);
    path_walk(p, NULL, NULL);
    return (ground_light){.lit = p->L, .open = open};
}

static void add3(vec3 light, float share, float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] += light[i] * share;
}

/* Adds share times the light on the ground at P to out: ground_lit, and ground_open as it would be if the
 * environment, the sun and punctual lights were all there is. Both use the same directions, so that they
 * are equal where no model is near. */
static void light_ground(const path_scene *scene, path_sampler sampler, vec3 P, float share, path_sample *out)
{
    path_lights_view views[2];
    path p = {.scene = scene,
              .sampler = sampler,
              .beta = vec3(1.0f),
              .P = P,
              .depth = 1,
              .vertex = 1,
              .views = views,
              .out = out};
    path_lights_see(scene->lights, P, load3(UP), &p.views[p.view]);
    /* The model may stand on the plane: its points of contact cast their shadow from there. */
    p.P[1] += media_tolerance(max3(abs(P)));
    path_sampler_begin(&p.sampler, p.vertex);
    vec2 u_light = path_sampler_pair(&p.sampler);
    vec2 u_direction = path_sampler_pair(&p.sampler);
    float u_choice = path_sampler_number(&p.sampler);
    ground_light by_light = sample_ground_light(&p, u_light, u_choice);
    ground_light by_bsdf = sample_ground_bsdf(&p, u_direction);
    add3(by_light.lit + by_bsdf.lit, share, out->ground_lit);
    add3(by_light.open + by_bsdf.open, share, out->ground_open);
}

/* Towards the border of the image the ground is lit as if there were no model. */
static void fade_shadow(const facet_render_desc *desc, uint32_t x, uint32_t y, path_sample *out)
{
    vec2 place = vec2(((float)x + 0.5f) / (float)desc->width, ((float)y + 0.5f) / (float)desc->height);
    float fade = ground_fade(place);
    for (int c = 0; c < 3; c++)
        out->ground_lit[c] = mix(out->ground_open[c], out->ground_lit[c], fade);
}

/* ---- a sample ---- */

/* Radiance where no surface covers the pixel. */
static vec3 background(const path_scene *scene, vec3 D)
{
    const path_surface *surface = scene->surface;
    if (surface)
        return surface->background(surface->self, D);
    float blur = scene->setup->desc->background_blur;
    if (!(blur > 0.0f))
        return path_lights_infinite(scene->lights, D);
    float d[3];
    float radiance[3];
    store3(D, d);
    light_specular(&scene->setup->light, d, blur, radiance);
    return load3(radiance);
}

static path start(const path_scene *scene, const path_camera_ray *camera, path_sampler sampler,
                  path_lights_view views[2], path_sample *out)
{
    const camera_rays *rays = &scene->setup->camera;
    float size = 0.5f * CAMERA_FOOTPRINT * rays->pixel_size;
    return (path){.scene = scene,
                  .sampler = sampler,
                  .beta = vec3(1.0f),
                  .P = load3(camera->ray.origin),
                  .D = load3(camera->ray.direction),
                  .cone_radius_m = rays->is_orthographic ? size : 0.0f,
                  .cone_angle = rays->is_orthographic ? 0.0f : size,
                  .specular_bounce = true,
                  .seeks_features = true,
                  .sees_backdrop =
                      !scene->surface && scene->setup->shading.backdrop != SHADING_BACKDROP_ENVIRONMENT,
                  .views = views,
                  .out = out};
}

static ray_first trace_first(path *p, const path_camera_ray *camera, float u_opacity)
{
    ray_first first = ray_trace_first(&p->scene->setup->shading, &camera->ray, u_opacity);
    p->out->rays += first.rays;
    p->out->first_geometry = first.hit.geometry;
    p->out->first_share = first.opacity * camera->weight;
    return first;
}

/* A camera inside of a medium: all that it sees is seen through the medium. */
static void trace_inside(path *p, const path_camera_ray *camera, float u_opacity)
{
    if (p->scene->finds_first)
        trace_first(p, camera, u_opacity);
    p->out->opacity = 1.0f;
    path_walk(p, NULL, NULL);
}

/* The air between the camera and the first surface. */
static void add_air(path *p, const path_camera_ray *camera, const ray_first *first)
{
    const path_surface *surface = p->scene->surface;
    const float *d = camera->ray.direction;
    float height = camera->ray.origin[1] + d[1] * first->hit.t;
    vec3 radiance = p->L * (1.0f / first->opacity);
    p->L = surface->through_air(surface->self, load3(d), first->hit.t, height, radiance) * first->opacity;
}

static void trace_outside(path *p, const path_camera_ray *camera, float u_opacity)
{
    ray_first first = trace_first(p, camera, u_opacity);
    p->out->opacity = first.opacity;
    p->beta = vec3(first.opacity);
    if (!(first.opacity > 0.0f))
        return;
    path_walk(p, &first.hit, &camera->ray);
    if (p->scene->surface)
        add_air(p, camera, &first);
}

void path_trace(const path_scene *scene, uint32_t x, uint32_t y, uint32_t index, path_sample *out)
{
    memset(out, 0, sizeof *out);
    path_sampler sampler = path_sampler_start(scene->setup->desc->path.seed, x, y, index);
    path_sampler_begin(&sampler, 0);
    vec2 pairs[PATH_SAMPLER_PAIRS];
    path_sampler_vertex_pairs(&sampler, pairs); /* of the pixel, of the lens, one for opacity */
    path_camera_ray camera;
    path_sample_camera_ray(scene, pairs[0], pairs[1], x, y, &camera);
    path_lights_view views[2];
    path p = start(scene, &camera, sampler, views, out);
    out->rays += media_at(&scene->setup->shading, camera.ray.origin, &p.media);
    p.is_in_medium = scene->surface && scene->surface->has_camera;
    if (p.media.count || p.is_in_medium)
        trace_inside(&p, &camera, pairs[2][0]);
    else
        trace_outside(&p, &camera, pairs[2][0]);
    vec3 ground;
    if (out->opacity < 1.0f &&
        hits_ground(scene, load3(camera.ray.origin), load3(camera.ray.direction), &ground)) {
        light_ground(scene, sampler, ground, (1.0f - out->opacity) * camera.weight, out);
        fade_shadow(scene->setup->desc, x, y, out);
    }
    if (scene->draws_background) {
        p.L += background(scene, load3(camera.ray.direction)) * (1.0f - out->opacity);
        out->opacity = 1.0f;
    }
    if (scene->max_radiance > 0.0f)
        p.L = min(p.L, scene->max_radiance);
    out->filter_excess = camera.weight - 1.0f;
    out->opacity *= camera.weight;
    store3(p.L * camera.weight, out->radiance);
}
