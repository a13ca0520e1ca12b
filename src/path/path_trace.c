/* path_trace.c - see path_trace.h: what a pixel sees of the paths that start in it. */
#include <string.h>

#include "cpu/ray_trace.h"

#include "path/path_camera.h"
#include "path/path_ground.h"
#include "path/path_surface.h"
#include "path/path_trace.h"
#include "path/path_walk.h"

/* What is seen where nothing covers it. */
static vec3 background(const path_scene *scene, vec3 D)
{
    const path_surface *surface = scene->surface;
    if (surface)
        return surface->background(surface->self, D);
    float blur = scene->setup->desc->background_blur;
    if (!(blur > 0.0f))
        return path_lights_surroundings(scene->lights, D);
    float d[3];
    float radiance[3];
    store3(D, d);
    light_specular(&scene->setup->light, d, blur, radiance);
    return load3(radiance);
}

static path start(const path_scene *scene, const path_camera_ray *camera, path_sampler sampler,
                  path_sample *out)
{
    const camera_rays *rays = &scene->setup->camera;
    float size = 0.5f * PATH_CAMERA_FOOTPRINT * rays->pixel_size;
    return (path){.scene = scene,
                  .shading = &scene->setup->shading,
                  .sampler = sampler,
                  .throughput = vec3(1.0f),
                  .P = load3(camera->ray.origin),
                  .D = load3(camera->ray.direction),
                  .width_m = rays->is_orthographic ? size : 0.0f,
                  .angle = rays->is_orthographic ? 0.0f : size,
                  .follows_mirrors = true,
                  .out = out};
}

static ray_first find_first(path *p, const path_camera_ray *camera)
{
    ray_first first = ray_trace_first(p->shading, &camera->ray, path_sampler_number(&p->sampler));
    p->out->rays += first.rays;
    p->out->first_geometry = first.hit.geometry;
    p->out->first_share = first.opacity * camera->weight;
    return first;
}

/* A camera in a body sees through it, and all beyond is seen through something. */
static void trace_inside(path *p, const path_camera_ray *camera)
{
    path_sampler sampler = p->sampler;
    if (p->scene->finds_first)
        find_first(p, camera);
    p->sampler = sampler; /* the path is the same one */
    path_walk(p);
    p->out->opacity = 1.0f;
}

/* Between the eye and the first surface. */
static void add_air(path *p, const path_camera_ray *camera, const ray_first *first)
{
    const path_surface *surface = p->scene->surface;
    const float *d = camera->ray.direction;
    float height = camera->ray.origin[1] + d[1] * first->hit.t;
    vec3 radiance = p->radiance * (1.0f / first->opacity);
    p->radiance =
        surface->through_air(surface->self, load3(d), first->hit.t, height, radiance) * first->opacity;
}

static void trace_outside(path *p, const path_camera_ray *camera)
{
    ray_first first = find_first(p, camera);
    p->out->opacity = first.opacity;
    p->throughput = vec3(first.opacity);
    if (!(first.opacity > 0.0f))
        return;
    path_walk_from(p, &first.hit, &camera->ray);
    if (p->scene->surface)
        add_air(p, camera, &first);
}

void path_trace(const path_scene *scene, uint32_t x, uint32_t y, uint32_t index, path_sample *out)
{
    memset(out, 0, sizeof *out);
    path_sampler sampler = path_sampler_start(scene->setup->desc->path.seed, x, y, index);
    path_sampler_begin(&sampler, 0);
    path_camera_ray camera;
    path_camera_ray_at(scene, &sampler, x, y, &camera);
    path p = start(scene, &camera, sampler, out);
    out->rays += ray_trace_media_at(p.shading, camera.ray.origin, &p.media);
    p.is_in_medium = scene->surface && scene->surface->has_camera;
    if (p.media.count || p.is_in_medium)
        trace_inside(&p, &camera);
    else
        trace_outside(&p, &camera);
    vec3 ground;
    if (out->opacity < 1.0f &&
        path_ground_is_met(scene, load3(camera.ray.origin), load3(camera.ray.direction), &ground))
        path_ground_light(scene, sampler, ground, (1.0f - out->opacity) * camera.weight, out);
    if (scene->draws_background) {
        p.radiance += background(scene, load3(camera.ray.direction)) * (1.0f - out->opacity);
        out->opacity = 1.0f;
    }
    out->filter_excess = camera.weight - 1.0f;
    out->opacity *= camera.weight;
    store3(p.radiance * camera.weight, out->radiance);
}
