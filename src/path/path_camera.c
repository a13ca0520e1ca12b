/* path_camera.c - see path_camera.h. */
#include "path/path_camera.h"

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

/* Moves the start of the ray to a point of the lens, such that what is at the distance of focus stays where it is.
 * direction has the length 1 along the axis. */
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
    /* What is nearer than a millionth of the lens' radius is not told apart: the square of the direction stays finite. */
    store3(load3(ray->direction) - offset * (1.0f / max(focus, 1e-6f * camera->lens_radius_m)),
           ray->direction);
}

/* Makes the direction one of unit length; the planes near and far stay where they are. */
static void make_unit(path_camera_ray *r)
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

void path_camera_ray_at(const path_scene *scene, path_sampler *sampler, uint32_t x, uint32_t y,
                        path_camera_ray *out)
{
    const render_setup *setup = scene->setup;
    const facet_camera *camera = setup->desc->camera;
    vec2 u_pixel = path_sampler_pair(sampler);
    vec2 u_lens = path_sampler_pair(sampler);
    FilterSample f = sample_pixel_filter((int)setup->desc->path.filter, u_pixel);
    out->weight = f.weight;
    out->spread = setup->shading.camera_spread;
    out->ray = shading_ray_of_camera(&setup->camera, &out->spread, (float)x + 0.5f + f.offset[0],
                                     (float)y + 0.5f + f.offset[1], PATH_CAMERA_FOOTPRINT);
    if (camera && camera->lens_radius_m > 0.0f)
        put_on_lens(&setup->camera, camera, u_lens, &out->ray);
    make_unit(out);
}
