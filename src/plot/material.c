/* material.c - the reflectance of a material. See material.h. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "ibl/ibl.h"
#include "plot/material.h"
#include "plot/merl.h"

#include "shade/shade.h"

facet_plot_material material_default(void)
{
    return (facet_plot_material){
        .model = FACET_PLOT_MODEL_PBR,
        .base_color = {1, 1, 1},
        .perceptual_roughness = 0.5f,
        .ior = 1.5f,
        .specular = 1.0f,
        .specular_color = {1, 1, 1},
        .iridescence_ior = 1.3f,
        .iridescence_thickness_nm = 400.0f,
        .diffuse = {0.8f, 0.8f, 0.8f},
        .ogl1_specular = {1, 1, 1},
        .shininess = 50.0f,
    };
}

/* ---- PBR ---- */

_Static_assert((int)FACET_ENERGY_GLTF == ENERGY_GLTF && (int)FACET_ENERGY_CONSERVING == ENERGY_CONSERVING,
               "the modes of the interface are those of shade");

static vec3 load3(const float *p)
{
    return vec3(p[0], p[1], p[2]);
}

static Layers layers_of(const facet_plot_material *p)
{
    vec3 N = vec3(0.0f, 0.0f, 1.0f);
    Layers m = layers_from_surface(surface_from_gltf(N, load3(p->base_color), p->metallic,
                                                     p->perceptual_roughness, p->ior, p->specular,
                                                     load3(p->specular_color), 1.0f, vec3(0.0f)));
    m.ior = m.eta = p->ior;
    if (p->clearcoat > 0.0f) {
        m.layers |= LAYER_CLEARCOAT;
        m.clearcoat = p->clearcoat;
        m.clearcoat_roughness = p->clearcoat_roughness;
    }
    if (max3(load3(p->sheen_color)) > 0.0f) {
        m.layers |= LAYER_SHEEN;
        m.sheen_color = load3(p->sheen_color);
        m.sheen_roughness = p->sheen_roughness;
    }
    if (p->anisotropy > 0.0f) {
        vec2 along = anisotropy_direction(vec2(1.0f, 0.0f), p->anisotropy_rotation_rad);
        m.layers |= LAYER_ANISOTROPY;
        m.anisotropy = p->anisotropy;
        m.anisotropy_T = vec3(along[0], along[1], 0.0f);
        m.anisotropy_B = cross(N, m.anisotropy_T);
    }
    if (p->iridescence > 0.0f && p->iridescence_thickness_nm > 0.0f) {
        m.layers |= LAYER_IRIDESCENCE;
        m.iridescence = p->iridescence;
        m.iridescence_ior = p->iridescence_ior;
        m.iridescence_thickness_nm = p->iridescence_thickness_nm;
    }
    return m;
}

static vec2 dfg_at(vec2 point)
{
    float terms[2];
    ibl_dfg(point[0], point[1], terms);
    return vec2(terms[0], terms[1]);
}

static LayerTables tables_of(Layers m, vec3 V, int energy)
{
    vec2 coat = vec2(0.0f);
    float sheen_E = 0.0f;
    if (has_layer(m, LAYER_CLEARCOAT))
        coat = dfg_at(vec2(layers_clearcoat_NdotV(m, V), m.clearcoat_roughness));
    if (has_layer(m, LAYER_SHEEN))
        sheen_E = ibl_sheen_albedo(surface_NdotV(m.base, V), m.sheen_roughness);
    return layer_tables(m, V, energy, dfg_at(layers_dfg_point(m, V, energy)), coat[0] + coat[1], 0.0f,
                        sheen_E, vec3(0.0f));
}

/* Visibility with masking and shadowing independent over the height-correlated one. */
static float separable_ratio(Layers m, vec3 V, vec3 L)
{
    vec2 a = layers_alpha(m, m.base.alpha);
    if (!has_layer(m, LAYER_ANISOTROPY))
        return V_SmithGGX_separable(L[2], V[2], a[1]) / V_SmithGGX(L[2], V[2], a[1]);
    vec3 v = layers_to_frame(m, V);
    vec3 l = layers_to_frame(m, L);
    float G = G1_SmithGGX_anisotropic(l, a[0], a[1]) * G1_SmithGGX_anisotropic(v, a[0], a[1]);
    return G / (4.0f * L[2] * V[2] * V_SmithGGX_anisotropic(l, v, a[0], a[1]));
}

/* What is below sheen and coat with the separable term: the interface's part is put in again, scaled. The tables of
 * ENERGY_CONSERVING remain those of the correlated one. */
static vec3 base_cos_separable(Layers m, vec3 V, vec3 L, int energy, LayerTables t)
{
    vec3 sum = V + L;
    float inverse = inversesqrt(max(dot(sum, sum), 1e-12f));
    float VdotH = min(0.5f * dot(sum, sum) * inverse, 1.0f);
    float NdotV = surface_NdotV(m.base, V);
    BoundaryWeights w = boundary_weights(m, NdotV, VdotH, energy, t);
    vec3 specular = w.specular * (layers_DV(m, V, L, sum * inverse, L[2], NdotV) * L[2]);
    return layers_base_cos(m, V, L, energy, t, LOBES_ALL) + specular * (separable_ratio(m, V, L) - 1.0f);
}

static vec3 pbr_brdf_cos(Layers m, vec3 V, vec3 L, int energy, LayerTables t, bool is_separable)
{
    float sheen_E_L = has_layer(m, LAYER_SHEEN) ? ibl_sheen_albedo(L[2], m.sheen_roughness) : 0.0f;
    if (!is_separable)
        return layers_brdf_cos(m, V, L, energy, t, sheen_E_L);
    vec3 f = base_cos_separable(m, V, L, energy, t);
    if (has_layer(m, LAYER_SHEEN))
        f = layers_sheen_cos(m, V, L, energy, t, sheen_E_L, f);
    if (has_layer(m, LAYER_CLEARCOAT))
        f = layers_clearcoat_cos(m, V, L, energy, t, f, LOBES_ALL);
    return f;
}

static void pbr_slice(const material *m, const float V_[3], size_t count, const float (*L)[3],
                      double (*out)[3])
{
    Layers layers = layers_of(&m->parameters);
    int energy = (int)m->energy;
    vec3 V = load3(V_);
    LayerTables tables = tables_of(layers, V, energy);
    for (size_t i = 0; i < count; i++) {
        vec3 f = vec3(0.0f);
        if (L[i][2] > 0.0f)
            f = pbr_brdf_cos(layers, V, load3(L[i]), energy, tables, m->has_separable_smith);
        for (int c = 0; c < 3; c++)
            out[i][c] = (double)f[c];
    }
}

void material_albedo_image_based(const material *m, const float V_[3], double out[3])
{
    Layers layers = layers_of(&m->parameters);
    vec3 V = load3(V_);
    vec3 one = vec3(1.0f);
    LayerLight light = {.specular = one,
                        .irradiance_over_pi = one,
                        .irradiance_back_over_pi = one,
                        .clearcoat = one,
                        .sheen = one,
                        .transmitted = one};
    vec3 radiance = layers_ibl(layers, V, tables_of(layers, V, (int)m->energy), light, (int)m->energy);
    for (int c = 0; c < 3; c++)
        out[c] = (double)radiance[c];
}

/* ---- all models ---- */

void material_brdf_cos(const material *m, const float V[3], size_t count, const float (*L)[3],
                       double (*out)[3])
{
    if (m->parameters.model == FACET_PLOT_MODEL_PBR) {
        pbr_slice(m, V, count, L, out);
        return;
    }
    ogl1_surface legacy = material_ogl1_surface(&m->parameters);
    for (size_t i = 0; i < count; i++) {
        memset(out[i], 0, sizeof out[i]);
        if (!(L[i][2] > 0.0f))
            continue;
        if (m->measured) {
            merl_brdf(m->measured, V, L[i], out[i]);
            for (int c = 0; c < 3; c++)
                out[i][c] *= (double)L[i][2];
        } else {
            float radiance[3];
            ogl1_radiance(&legacy, V, L[i], radiance);
            for (int c = 0; c < 3; c++)
                out[i][c] = (double)(radiance[c] * INV_PI);
        }
    }
}

double material_luminance(const double rgb[3])
{
    return (double)luminance(vec3((float)rgb[0], (float)rgb[1], (float)rgb[2]));
}

double material_width(const material *m)
{
    const facet_plot_material *p = &m->parameters;
    float alpha = 1.0f;
    if (p->model == FACET_PLOT_MODEL_PBR) {
        alpha = alpha_from_roughness(p->perceptual_roughness);
        if (p->clearcoat > 0.0f)
            alpha = min(alpha, alpha_from_roughness(p->clearcoat_roughness));
    } else if (p->model == FACET_PLOT_MODEL_OGL1)
        alpha = alpha_from_roughness(perceptual_roughness_from_shininess(p->shininess));
    else
        alpha =
            0.01f; /* the cells of a measured BRDF are 0.01 degrees wide at the mirror direction, and 2 at 45 */
    return (double)max(alpha, ALPHA_MIRROR);
}

/* ---- conversions ---- */

pbr_surface material_pbr_surface(const facet_plot_material *p)
{
    pbr_surface s = {.metallic = p->metallic,
                     .perceptual_roughness = p->perceptual_roughness,
                     .ior = p->ior,
                     .specular = p->specular};
    memcpy(s.base_color, p->base_color, sizeof s.base_color);
    memcpy(s.specular_color, p->specular_color, sizeof s.specular_color);
    return s;
}

ogl1_surface material_ogl1_surface(const facet_plot_material *p)
{
    ogl1_surface s = {.shininess = p->shininess};
    memcpy(s.diffuse, p->diffuse, sizeof s.diffuse);
    memcpy(s.specular, p->ogl1_specular, sizeof s.specular);
    return s;
}

facet_plot_material material_from_pbr(const pbr_surface *s)
{
    facet_plot_material p = material_default();
    p.metallic = s->metallic;
    p.perceptual_roughness = s->perceptual_roughness;
    p.ior = s->ior;
    p.specular = s->specular;
    memcpy(p.base_color, s->base_color, sizeof p.base_color);
    memcpy(p.specular_color, s->specular_color, sizeof p.specular_color);
    return p;
}

facet_plot_material material_from_ogl1(const ogl1_surface *s)
{
    facet_plot_material p = material_default();
    p.model = FACET_PLOT_MODEL_OGL1;
    p.shininess = s->shininess;
    memcpy(p.diffuse, s->diffuse, sizeof p.diffuse);
    memcpy(p.ogl1_specular, s->specular, sizeof p.ogl1_specular);
    return p;
}

bool material_has_layers(const facet_plot_material *p)
{
    return layers_of(p).layers != 0u;
}
