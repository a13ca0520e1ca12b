/* path_vertex.c - see path_vertex.h. */
#include "cpu/boundary.h"
#include "cpu/shading_hit.h"
#include "cpu/surface_point.h"
#include "cpu/media.h"

#include "path/path_vertex.h"
#include "path/path_media.h"

/* ---- the surface ---- */

static vec3 geometric_normal(const visibility_hit *hit, vec3 V)
{
    vec3 n = load3(hit->normal);
    float n2 = dot(n, n);
    if (!(n2 > 0.0f) || !(n2 < INFINITY))
        return V;
    n *= inversesqrt(n2);
    return dot(n, V) < 0.0f ? -n : n;
}

/* Bends interpolated and mapped normals towards V until N.V >= NDOTV_MIN. */
static vec3 faced_normal(vec3 N, vec3 V)
{
    float c = dot(N, V);
    return c >= NDOTV_MIN ? N : normalize(N + V * (1.01f * NDOTV_MIN - c));
}

/* ---- boundaries of closed volumes ---- */

/* Sets N for refraction (boundary.h): smooth normals of a mesh may lean away from the surface that they
 * approximate. */
static void set_boundary_normal(const visibility_hit *hit, surface_point *s)
{
    Layers *m = &s->m;
    m->base.N = boundary_normal_at(s, hit).N;
    if (!(m->layers & LAYER_ANISOTROPY))
        return;
    vec3 T = m->anisotropy_T - m->base.N * dot(m->base.N, m->anisotropy_T);
    m->anisotropy_T = normalize_or(T, COL(basis_from_normal(m->base.N), 0));
    m->anisotropy_B = cross(m->base.N, m->anisotropy_T);
}

/* Converts F0 and F90 from those against air to those for the ior of both sides. Equal indices reflect
 * nothing. */
static void set_reflectance(float ior, Layers *m)
{
    float F0 = F0_from_ior(max(ior, 1.0f));
    float F0_here = F0_from_ior(m->eta);
    if (!(F0_here > 0.0f))
        m->base.F90 = 0.0f;
    m->base.F0 = F0 > 0.0f ? min(m->base.F0 * (F0_here / F0), 1.0f) : vec3(F0_here * m->base.F90);
}

static float relative_ior(const media *behind, const media *in, float wavelength_nm)
{
    return path_media_ior(behind, wavelength_nm) / path_media_ior(in, wavelength_nm);
}

/* Makes the surface a boundary between two media. Paths handle absorption and scattering in them: the
 * surface has none. */
static void set_boundary(const shading_scene *shading, const visibility_hit *hit, media *in,
                         float wavelength_nm, path_vertex *v)
{
    surface_point *s = &v->s;
    Layers *m = &s->m;
    const render_geometry *g = s->hit.geometry;
    if (m->layers & LAYER_TRANSMISSION)
        set_boundary_normal(hit, s);
    if (!s->is_front && !path_media_has(in, g->material))
        media_enter(in, g->material, g->material->thickness * g->scale);
    v->behind = *in;
    media_cross(shading, hit, s, v->tolerance_m, &v->behind);
    const medium *here = path_media_here(in);
    const medium *there = path_media_here(&v->behind);
    v->is_null_interface = here && there && here->material == there->material;
    v->disperses = !(wavelength_nm > 0.0f) && m->layers & LAYER_TRANSMISSION &&
                   (path_media_disperses(in) || path_media_disperses(&v->behind));
    m->eta = relative_ior(&v->behind, in, wavelength_nm);
    m->layers &= ~(LAYER_SCATTER | LAYER_DISPERSION);
    m->attenuation_distance = INFINITY;
    set_reflectance(g->material->ior, m);
}

void path_vertex_set_wavelength(path_vertex *v, const media *in, float wavelength_nm)
{
    v->s.m.eta = relative_ior(&v->behind, in, wavelength_nm);
    v->tables = surface_tables(v->s.m, v->s.V, ENERGY_CONSERVING);
    v->disperses = false;
}

/* Whether transmitted light keeps its direction. */
static bool transmits_straight(const Layers *m)
{
    if (!(m->layers & LAYER_TRANSMISSION) || !layers_transmission_is_delta(*m))
        return false;
    return !(m->layers & LAYER_VOLUME) || !(m->eta < 1.0f || m->eta > 1.0f);
}

static bool is_specular_only(const Layers *m, const LayersLobes *lobes)
{
    return !(lobes->diffuse + lobes->diffuse_back + lobes->sheen > 0.0f) && layers_scattering_lobes(*m) == 0u;
}

/* Twice the probability for the narrower lobes of a surface that also has diffuse ones. What light sampling finds
 * is most of the diffuse lobes' light, but of the narrow lobes' only part: BSDF samples carry their direct light as
 * well. Relative MSE of 16 samples with factors of 1, 1.5, 2, 3, 4: a glossy room .101, .097, .098, .098, .103;
 * glass on a glossy floor .0547, .0517, .0513, .0502, .0497. */
static LayersLobes with_more_narrow(LayersLobes p)
{
    const float favor = 2.0f;
    float wide = p.diffuse + p.diffuse_back + p.sheen;
    float narrow = p.specular + p.clearcoat;
    if (!(wide > 0.0f) || !(narrow > 0.0f))
        return p;
    float scale = (wide + narrow) / (wide + favor * narrow);
    p.diffuse *= scale;
    p.diffuse_back *= scale;
    p.sheen *= scale;
    p.specular *= favor * scale;
    p.clearcoat *= favor * scale;
    return p;
}

/* ---- a boundary that is no mesh's material ---- */

/* False: the hit is not on the surface. */
static bool intersect_surface(const path_surface *surface, const visibility_hit *hit, path_vertex *v)
{
    surface_point *s = &v->s;
    path_surface_point *on = &v->on;
    if (!surface || !surface->intersect(surface->self, &s->hit, hit->normal, s->V, on))
        return false;
    v->surface = surface;
    v->is_transmissive = true;
    v->lobes = (LayersLobes){.diffuse = 1.0f};
    v->Ng = on->Ng * on->side;
    s->m.base.N = on->N * on->side;
    s->m.base.base_color = vec3(on->albedo);
    s->m.base.alpha = 1.0f;
    return true;
}

/* ---- all ---- */

void path_vertex_make(const path_scene *scene, const visibility_hit *hit, const shading_ray *ray, media *in,
                      float wavelength_nm, path_vertex *v)
{
    const shading_scene *shading = &scene->setup->shading;
    shading_point point = {.hit = hit, .ray = ray};
    surface_point *s = &v->s;
    surface_point_make(shading, &point, s);
    v->is_transmissive = v->is_specular = v->is_null_interface = v->disperses = v->passes_straight = false;
    v->surface = NULL;
    if (!s->is_lit)
        return;
    v->Ng = geometric_normal(hit, s->V);
    v->tolerance_m = media_tolerance_at(s);
    v->delta_energy = surface_energy(shading);
    if (intersect_surface(scene->surface, hit, v))
        return;
    Layers *m = &s->m;
    if (s->plan->is_closed_volume && m->layers & LAYER_VOLUME)
        set_boundary(shading, hit, in, wavelength_nm, v);
    m->base.N = faced_normal(m->base.N, s->V);
    if (m->layers & LAYER_CLEARCOAT)
        m->clearcoat_N = faced_normal(m->clearcoat_N, s->V);
    v->is_transmissive = (m->layers & (LAYER_TRANSMISSION | LAYER_DIFFUSE_TRANSMISSION)) != 0;
    v->passes_straight = s->plan->may_pass_straight && transmits_straight(m);
    v->tables = surface_tables(*m, s->V, ENERGY_CONSERVING);
    v->lobes = with_more_narrow(layers_lobes(*m, s->V, ENERGY_CONSERVING, v->tables));
    v->is_specular = is_specular_only(m, &v->lobes);
    if (m->layers == 0u)
        v->plain = surface_lobes_at(m->base, s->V, v->lobes.specular, v->lobes.diffuse, ENERGY_CONSERVING,
                                    v->tables.dfg);
}

/* ---- emission ---- */

vec3 path_vertex_emission(const path_vertex *v)
{
    const surface_point *s = &v->s;
    const render_geometry *g = s->hit.geometry;
    if (!s->is_lit) {
        /* Points and lines without normals emit as well: glTF 2.0, 3.7.2.1. */
        bool is_unlit = (g->material->extensions & SCENE_UNLIT) != 0;
        return load3(s->base_color) + (is_unlit ? vec3(0.0f) : s->m.base.emissive);
    }
    if (!s->is_front && !g->is_double_sided && !s->plan->is_volume)
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

/* Whether L is on the same side of the shading normal and of the triangle; light leaks through it
 * otherwise. */
static bool is_on_one_side(const path_vertex *v, vec3 L)
{
    return dot(v->s.m.base.N, L) * dot(v->Ng, L) > 0.0f;
}

vec3 path_vertex_eval(const path_vertex *v, vec3 L, float *pdf)
{
    *pdf = 0.0f;
    if (v->surface)
        return v->surface->eval(v->surface->self, &v->on, v->s.V, L, pdf);
    if (!is_on_one_side(v, L))
        return vec3(0.0f);
    const Layers *m = &v->s.m;
    if (m->layers == 0u) {
        SurfaceValue x = surface_value(m->base, v->plain, L, ENERGY_CONSERVING);
        *pdf = x.pdf;
        return x.f;
    }
    *pdf = layers_pdf(*m, v->lobes, v->s.V, L);
    return layers_scatter_cos(*m, v->s.V, L, ENERGY_CONSERVING, v->tables, sheen_E(m, L));
}

vec3 path_vertex_eval_delta(const path_vertex *v, vec3 L)
{
    float pdf;
    if (v->surface)
        return v->surface->eval(v->surface->self, &v->on, v->s.V, L, &pdf);
    if (!is_on_one_side(v, L))
        return vec3(0.0f);
    Layers m = v->s.m;
    m.base.alpha = max(m.base.alpha, ALPHA_MIN);
    m.clearcoat_roughness = max(m.clearcoat_roughness, ROUGHNESS_MIN);
    return layers_brdf_cos(m, v->s.V, L, v->delta_energy, v->tables, sheen_E(&m, L));
}

/* A specular lobe follows the shading normal; where its direction is on the wrong side of the triangle it
 * is mirrored back, at grazing angle at least: a mesh that approximates a round shape reflects at its
 * silhouette as well. */
static vec3 keep_side(vec3 L, vec3 Ng, float side)
{
    float c = dot(L, Ng);
    return c * side > 0.0f ? L : normalize(L - Ng * (2.0f * c - side * 1e-4f));
}

/* path_vertex_sample() of a surface without layers, for its lobes that are not specular. */
static bool sample_plain(const path_vertex *v, float u_lobe, vec2 u, bsdf_sample *out)
{
    const Surface *s = &v->s.m.base;
    vec3 L = surface_draw(*s, v->plain, u_lobe, u);
    if (dot(L, L) < 0.5f || !is_on_one_side(v, L))
        return false;
    SurfaceValue x = surface_value(*s, v->plain, L, ENERGY_CONSERVING);
    if (!(x.pdf > 0.0f))
        return false;
    *out = (bsdf_sample){.L = L, .pdf = x.pdf, .weight = x.f * (1.0f / x.pdf)};
    return true;
}

bool path_vertex_sample(const path_vertex *v, float u_lobe, vec2 u, bsdf_sample *out)
{
    if (v->surface)
        return v->surface->sample(v->surface->self, &v->on, v->s.V, u_lobe, u, out);
    const Layers *m = &v->s.m;
    if (m->layers == 0u && !(v->plain.is_delta && u_lobe >= v->lobes.diffuse))
        return sample_plain(v, u_lobe, u, out);
    LayersSample s = layers_sample(*m, v->lobes, v->s.V, u_lobe, u, ENERGY_CONSERVING, v->tables);
    if (!s.is_valid)
        return false;
    *out = (bsdf_sample){.L = s.L, .pdf = s.pdf, .is_specular = s.is_delta, .is_transmission = s.is_through};
    if (s.is_delta) {
        out->L = keep_side(s.L, v->Ng, s.is_through ? -1.0f : 1.0f);
        out->weight = s.weight;
        return true;
    }
    if (!is_on_one_side(v, s.L) || !(s.pdf > 0.0f))
        return false;
    out->weight =
        layers_scatter_cos(*m, v->s.V, s.L, ENERGY_CONSERVING, v->tables, sheen_E(m, s.L)) * (1.0f / s.pdf);
    return true;
}

vec3 path_vertex_straight(const path_vertex *v)
{
    if (!v->passes_straight)
        return vec3(0.0f);
    LayersLobes only = {.transmission = 1.0f};
    LayersSample s =
        layers_sample(v->s.m, only, v->s.V, 0.0f, vec2(0.0f, 0.0f), ENERGY_CONSERVING, v->tables);
    return s.is_valid && s.is_delta ? s.weight : vec3(0.0f);
}
