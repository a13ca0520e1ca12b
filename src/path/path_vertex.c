/* path_vertex.c - see path_vertex.h. */
#include "cpu/surface_tables.h"
#include "cpu/volume_rays.h"

#include "path/path_vertex.h"

/* ---- the surface ---- */

/* Several times what rounding of the position is, which goes with the largest of the corners' coordinates. */
static float tolerance_at(const surface_point *s)
{
    vec3 most = abs(s->P);
    const render_geometry *g = s->hit.geometry;
    if (g->primitive->mode == SCENE_TRIANGLES)
        for (int i = 0; i < 3; i++) {
            float corner[3];
            render_geometry_corner(g, s->hit.corner[i], corner);
            most = max(most, abs(load3(corner)));
        }
    return volume_rays_tolerance_of(max3(most));
}

static vec3 geometric_normal(const visibility_hit *hit, vec3 V)
{
    vec3 n = load3(hit->normal);
    float n2 = dot(n, n);
    if (!(n2 > 0.0f) || !(n2 < INFINITY))
        return V;
    n *= inversesqrt(n2);
    return dot(n, V) < 0.0f ? -n : n;
}

/* Interpolated and mapped normals may turn away from V, where nothing is to be seen: they are turned back to where it sees
 * them at grazing angle. */
static vec3 seen_normal(vec3 N, vec3 V)
{
    float c = dot(N, V);
    return c >= NDOTV_MIN ? N : normalize(N + V * (1.01f * NDOTV_MIN - c));
}

void path_vertex_make(const path *p, const visibility_hit *hit, const shading_ray *ray, path_vertex *v)
{
    shading_point point = {.hit = hit, .ray = ray};
    surface_point *s = &v->s;
    surface_point_make(p->shading, &point, s);
    v->lets_through = false;
    if (!s->is_lit)
        return;
    v->Ng = geometric_normal(hit, s->V);
    v->tolerance = tolerance_at(s);
    v->energy = surface_energy(p->shading);
    Layers *m = &s->m;
    m->base.N = seen_normal(m->base.N, s->V);
    if (m->layers & LAYER_CLEARCOAT)
        m->clearcoat_N = seen_normal(m->clearcoat_N, s->V);
    v->lets_through = (m->layers & (LAYER_TRANSMISSION | LAYER_DIFFUSE_TRANSMISSION)) != 0;
    v->tables = surface_tables(m, s->V, v->energy);
    v->lobes = layers_lobes(*m, s->V, v->energy, v->tables);
}

/* ---- light of its own ---- */

vec3 path_vertex_emission(const path_vertex *v)
{
    const surface_point *s = &v->s;
    const render_geometry *g = s->hit.geometry;
    if (!s->is_lit) {
        /* Points and lines without normals emit as well: glTF 2.0, 3.7.2.1. */
        bool is_unlit = (g->material->extensions & SCENE_UNLIT) != 0;
        return load3(s->base_color) + (is_unlit ? vec3(0.0f) : s->m.base.emissive);
    }
    if (!s->is_front && !g->is_double_sided)
        return vec3(0.0f);
    return s->m.layers ? layers_emission(s->m, s->V) : s->m.base.emissive;
}

/* ---- scattering ---- */

static float sheen_E(const Layers *m, vec3 L)
{
    return m->layers & LAYER_SHEEN
               ? ibl_sheen_albedo(clamp(dot(m->base.N, L), 0.0f, 1.0f), m->sheen_roughness)
               : 0.0f;
}

/* Whether L is on the same side of the shading normal and of the triangle: what is not would shine through it. */
static bool is_on_one_side(const path_vertex *v, vec3 L)
{
    return dot(v->s.m.base.N, L) * dot(v->Ng, L) > 0.0f;
}

vec3 path_vertex_scatter(const path_vertex *v, vec3 L, float *pdf)
{
    *pdf = 0.0f;
    if (!is_on_one_side(v, L))
        return vec3(0.0f);
    const Layers *m = &v->s.m;
    *pdf = layers_pdf(*m, v->lobes, v->s.V, L);
    return layers_scatter_cos(*m, v->s.V, L, v->energy, v->tables, sheen_E(m, L));
}

vec3 path_vertex_scatter_punctual(const path_vertex *v, vec3 L)
{
    if (!is_on_one_side(v, L))
        return vec3(0.0f);
    Layers m = v->s.m;
    m.base.alpha = max(m.base.alpha, ALPHA_MIN);
    m.clearcoat_roughness = max(m.clearcoat_roughness, ROUGHNESS_MIN);
    return layers_brdf_cos(m, v->s.V, L, v->energy, v->tables, sheen_E(&m, L));
}

/* A mirror shows what its shading normal says; where that points to the triangle's other side, the direction is mirrored
 * back out of the triangle, at grazing angle at least: a mesh that stands for a round body reflects at its rim as well. */
static vec3 keep_side(vec3 L, vec3 Ng, float side)
{
    float c = dot(L, Ng);
    return c * side > 0.0f ? L : normalize(L - Ng * (2.0f * c - side * 1e-4f));
}

bool path_vertex_sample(const path_vertex *v, float u_lobe, vec2 u, path_direction *out)
{
    const Layers *m = &v->s.m;
    LayersSample s = layers_sample(*m, v->lobes, v->s.V, u_lobe, u, v->energy, v->tables);
    if (!s.is_valid)
        return false;
    *out = (path_direction){.L = s.L, .pdf = s.pdf, .is_mirror = s.is_mirror, .is_through = s.is_through};
    if (s.is_mirror) {
        out->L = keep_side(s.L, v->Ng, s.is_through ? -1.0f : 1.0f);
        out->weight = s.weight;
        return true;
    }
    if (!is_on_one_side(v, s.L) || !(s.pdf > 0.0f))
        return false;
    out->weight = layers_scatter_cos(*m, v->s.V, s.L, v->energy, v->tables, sheen_E(m, s.L)) * (1.0f / s.pdf);
    return true;
}
