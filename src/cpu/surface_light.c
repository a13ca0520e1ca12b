/* surface_light.c - see surface_light.h. The host of shade/compose/surface_radiance.h. */
#include "cpu/media.h"

#include "cpu/surface_light.h"
#include "cpu/surface_point.h"

typedef struct SurfaceHost {
    vec3 P, V;
    int energy;
    const shading_scene *scene;
    const surface_point *surface;
    uint64_t *rays; /* counts those that are traced */
} SurfaceHost;

/* ---- environment ---- */

static bool host_has_environment(SurfaceHost host)
{
    return host.scene->light->ibl != NULL;
}

static vec3 host_specular(SurfaceHost host, vec3 R, float perceptual_roughness)
{
    float d[3];
    float radiance[3];
    store3(R, d);
    light_specular(host.scene->light, d, perceptual_roughness, radiance);
    return load3(radiance);
}

static vec3 host_sheen(SurfaceHost host, vec3 N, float sheen_roughness)
{
    float d[3];
    float radiance[3];
    store3(N, d);
    light_sheen(host.scene->light, d, sheen_roughness, radiance);
    return load3(radiance);
}

static vec3 host_ambient(SurfaceHost host)
{
    return host.surface->ambient;
}

static vec3 host_unoccluded_irradiance_over_pi(SurfaceHost host, vec3 N)
{
    float d[3];
    float out[3];
    store3(N, d);
    light_irradiance_over_pi(host.scene->light, d, out);
    return load3(out);
}

static vec3 host_irradiance_over_pi(SurfaceHost host, vec3 N)
{
    vec3 irradiance = host_unoccluded_irradiance_over_pi(host, N);
    bool is_behind =
        dot(N, host.surface->m.base.N) < 0.0f; /* diffuse transmission, which the model has dimmed */
    return is_behind ? irradiance : irradiance * host_ambient(host);
}

/* ---- volumes ---- */

typedef media_exit VolumeExit;

/* Without a far side the material's thickness. */
static VolumeExit host_exit(SurfaceHost host, Layers m)
{
    VolumeExit e = {.distance_m = m.thickness, .normal = -m.base.N};
    media_find_exit(host.scene, host.surface, -m.base.N, &e);
    (*host.rays)++;
    return e;
}

/* Traced by refraction.c. */
static vec3 host_transmitted(SurfaceHost host, Layers m)
{
    (void)host;
    (void)m;
    return vec3(0.0f);
}

/* ---- punctual lights ---- */

typedef struct LightCursor {
    light_cursor rest;
    uint32_t light;
    bool has_light;
} LightCursor;

static LightCursor host_next_light(SurfaceHost host, LightCursor c)
{
    (void)host;
    c.has_light = light_cursor_next(&c.rest, &c.light);
    return c;
}

static LightCursor host_first_light(SurfaceHost host)
{
    LightCursor c = {.has_light = false};
    if (host.scene->light->punctual_count == 0)
        return c;
    float point[3];
    store3(host.P, point);
    c.rest = light_grid_at(&host.scene->light->grid, point);
    return host_next_light(host, c);
}

static Light host_punctual(SurfaceHost host, LightCursor c)
{
    return host.scene->light->punctual[c.light];
}

static vec3 host_reflected(SurfaceHost host, Layers m, Light l, LayerTables t, float sheen_E_L)
{
    return layers_punctual(m, host.P, host.V, l, host.energy, t, sheen_E_L);
}

#include "shade/compose/surface_radiance.h"

/* ---- surfaces ---- */

/* Transmitted radiance enters linearly: its factor is the result for radiance 1 without other light. */
static surface_light layered_light(SurfaceHost host, const surface_point *s)
{
    surface_light out = {.through = vec3(0.0f)};
    LayerTables tables = surface_tables(s->m, s->V, host.energy);
    host.rays = &out.rays;
    out.radiance = layered_radiance(host, s->m, tables);
    if (s->m.layers & LAYER_TRANSMISSION) {
        Layers m = s->m;
        LayerLight one = {.transmitted = vec3(1.0f)};
        m.base.occlusion = 1.0f;
        out.through = layers_ibl(m, s->V, tables, one, host.energy);
    }
    return out;
}

surface_light surface_light_at(const shading_scene *scene, const surface_point *s)
{
    SurfaceHost host = {.P = s->P, .V = s->V, .energy = surface_energy(scene), .scene = scene, .surface = s};
    if (s->is_lit && s->m.layers)
        return layered_light(host, s);
    surface_light out = {.through = vec3(0.0f)};
    if (s->is_lit) {
        out.radiance = plain_radiance(host, s->m.base);
    } else {
        /* Points and lines without normals emit as well: glTF 2.0, 3.7.2.1. */
        out.radiance = load3(s->base_color);
        if (!(s->hit.geometry->material->extensions & SCENE_UNLIT))
            out.radiance += s->m.base.emissive;
    }
    return out;
}
