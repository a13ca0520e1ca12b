/* material.c - reflectance, directional albedo and label of a material. See material.h. */
#include "plot/material.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "ibl/ibl.h"
#include "plot/merl.h"

#include "shade/lang/lang_c_load.h"
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
    return with_diffuse_roughness(m, p->diffuse_roughness, vec3(1.0f));
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

/* Ratio of separable to height-correlated visibility. */
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

/* The layers below sheen and clearcoat with separable visibility: the specular lobe is exchanged. The LUTs of
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
    LayerTables tables = tables_of(layers, V, (int)m->energy);
    vec3 radiance = layers_ibl(layers, V, tables, layer_light_of(vec3(1.0f)), (int)m->energy);
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
        alpha = 0.01f; /* cells of a measured BRDF are 0.01 degrees wide at the mirror direction, 2 at 45 */
    return (double)max(alpha, ALPHA_DELTA);
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

/* ---- directional albedo ---- */

enum { MAX_LOBES = 6, BATCH = 256, FIRST_COUNT = 1024, LAST_COUNT = 65536 };

/* A pdf of light directions: cosine, GGX visible normals, or Charlie. */
typedef struct lobe {
    enum { LOBE_COSINE, LOBE_GGX, LOBE_CHARLIE } kind;
    float alpha_x, alpha_y;
    vec2 along; /* tangent of alpha_x */
} lobe;

typedef struct lobe_set {
    uint32_t count;
    lobe lobes[MAX_LOBES];
} lobe_set;

static void add_lobe(lobe_set *set, lobe l)
{
    set->lobes[set->count++] = l;
}
static void add_ggx(lobe_set *set, float alpha)
{
    float a = clamp(alpha, ALPHA_DELTA, 1.0f);
    add_lobe(set, (lobe){.kind = LOBE_GGX, .alpha_x = a, .alpha_y = a, .along = vec2(1.0f, 0.0f)});
}

static lobe_set lobes_of(const material *m)
{
    const facet_plot_material *p = &m->parameters;
    lobe_set set = {0};
    add_lobe(&set, (lobe){.kind = LOBE_COSINE});
    if (p->model == FACET_PLOT_MODEL_MERL) { /* unknown: mirrors to velvet */
        add_ggx(&set, 0.02f);
        add_ggx(&set, 0.1f);
        add_ggx(&set, 0.4f);
    } else if (p->model == FACET_PLOT_MODEL_OGL1) {
        add_ggx(&set, alpha_from_roughness(perceptual_roughness_from_shininess(p->shininess)));
        add_ggx(&set, 1.0f); /* its highlight does not vanish at the horizon, where the cosine pdf is 0 */
    } else {
        vec2 a = anisotropic_alpha(alpha_from_roughness(p->perceptual_roughness), p->anisotropy);
        vec2 along = anisotropy_direction(vec2(1.0f, 0.0f), p->anisotropy_rotation_rad);
        a = max(a, ALPHA_DELTA);
        add_lobe(&set, (lobe){.kind = LOBE_GGX, .alpha_x = a[0], .alpha_y = a[1], .along = along});
        if (p->clearcoat > 0.0f)
            add_ggx(&set, alpha_from_roughness(p->clearcoat_roughness));
        float sheen = sheen_alpha(p->sheen_roughness);
        if (max(p->sheen_color[0], max(p->sheen_color[1], p->sheen_color[2])) > 0.0f)
            add_lobe(&set, (lobe){.kind = LOBE_CHARLIE, .alpha_x = sheen, .alpha_y = sheen});
    }
    return set;
}

static vec3 to_tangent_frame(const lobe *l, vec3 v)
{
    return vec3(l->along[0] * v[0] + l->along[1] * v[1], l->along[0] * v[1] - l->along[1] * v[0], v[2]);
}
static vec3 from_tangent_frame(const lobe *l, vec3 v)
{
    return vec3(l->along[0] * v[0] - l->along[1] * v[1], l->along[1] * v[0] + l->along[0] * v[1], v[2]);
}

static vec3 sample_lobe(const lobe *l, vec2 u, vec3 V)
{
    if (l->kind == LOBE_COSINE)
        return sample_cosine(u);
    if (l->kind == LOBE_CHARLIE)
        return reflect(-V, sample_D_Charlie(u, l->alpha_x));
    vec3 H = sample_VNDF_GGX(u, to_tangent_frame(l, V), l->alpha_x, l->alpha_y);
    return reflect(-V, from_tangent_frame(l, H));
}

/* Combined pdf of L of all lobes, 1/sr. */
static float pdf_lobes(const lobe_set *set, vec3 V, vec3 L)
{
    vec3 H = normalize(V + L);
    float jacobian = 1.0f / (4.0f * max(dot(V, H), 1e-7f));
    float sum = 0.0f;
    for (uint32_t i = 0; i < set->count; i++) {
        const lobe *l = &set->lobes[i];
        if (l->kind == LOBE_COSINE)
            sum += pdf_cosine(L[2]);
        else if (l->kind == LOBE_CHARLIE)
            sum += pdf_D_Charlie(H[2], l->alpha_x) * jacobian;
        else
            sum += pdf_VNDF_GGX(to_tangent_frame(l, V), to_tangent_frame(l, H), l->alpha_x, l->alpha_y) *
                   jacobian;
    }
    return sum;
}

/* Adds samples begin to begin + BATCH of n of one lobe, weighted by the balance heuristic (Veach and
 * Guibas 1995). */
static void add_batch(const material *m, const lobe_set *set, const lobe *l, const float V_[3],
                      uint32_t begin, uint32_t n, double sum[3])
{
    vec3 V = load3(V_);
    float L[BATCH][3];
    double f[BATCH][3];
    for (uint32_t i = 0; i < BATCH; i++) {
        vec3 d = sample_lobe(l, hammersley(begin + i, n), V);
        store3(d, L[i]);
    }
    material_brdf_cos(m, V_, BATCH, (const float(*)[3])L, f);
    for (uint32_t i = 0; i < BATCH; i++) {
        if (!(L[i][2] > 0.0f))
            continue;
        double pdf = (double)pdf_lobes(set, V, vec3(L[i][0], L[i][1], L[i][2]));
        for (int c = 0; c < 3; c++)
            if (f[i][c] > 0.0) /* false for NAN: not measured */
                sum[c] += f[i][c] / (pdf * (double)n);
    }
}

static void estimate(const material *m, const lobe_set *set, const float V[3], uint32_t n, double out[3])
{
    out[0] = out[1] = out[2] = 0.0;
    for (uint32_t i = 0; i < set->count; i++)
        for (uint32_t begin = 0; begin < n; begin += BATCH)
            add_batch(m, set, &set->lobes[i], V, begin, n, out);
}

void material_albedo(const material *m, const float V[3], double out[3])
{
    lobe_set set = lobes_of(m);
    estimate(m, &set, V, FIRST_COUNT, out);
    for (uint32_t n = 2 * FIRST_COUNT; n <= LAST_COUNT; n *= 2) {
        double before[3] = {out[0], out[1], out[2]};
        estimate(m, &set, V, n, out);
        double change = 0.0;
        for (int c = 0; c < 3; c++)
            change = fmax(change, fabs(out[c] - before[c]));
        if (change < 5e-4)
            return;
    }
}

/* ---- labels ---- */

static bool is_gray(const float c[3])
{
    return !(c[0] < c[1]) && !(c[0] > c[1]) && !(c[1] < c[2]) && !(c[1] > c[2]);
}

/* " name 0.3" or " name (0.8, 0.1, 0.1)" with few digits. */
static void add_number(text *t, const char *before, float value)
{
    text_addf(t, "%s%.3g", before, (double)value);
}
static void add_color(text *t, const char *before, const float c[3])
{
    if (is_gray(c))
        add_number(t, before, c[0]);
    else
        text_addf(t, "%s(%.3g, %.3g, %.3g)", before, (double)c[0], (double)c[1], (double)c[2]);
}

/* "white metal", "metal, color 0.5", "metal (0.8, 0.1, 0.1)". */
static void add_colored(text *t, const char *what, const float c[3])
{
    bool is_white = is_gray(c) && c[0] >= 1.0f, is_black = is_gray(c) && c[0] <= 0.0f;
    if (is_white || is_black)
        text_addf(t, "%s %s", is_white ? "white" : "black", what);
    else {
        text_add(t, what);
        add_color(t, is_gray(c) ? ", color " : " ", c);
    }
}

/* F0 of diamond, the largest of a dielectric. */
static const float MAX_DIELECTRIC_F0 = 0.17f;

/* A surface with free F0 (ior 0), as the fits make: a metal if its F0 is above any dielectric's and most
 * of its albedo. Linear luminance of Rec.709. */
static void describe_free_F0(const facet_plot_material *p, text *t)
{
    static const double weights[3] = {0.2126, 0.7152, 0.0722};
    double reflected = 0.0, diffuse = 0.0;
    float F0[3];
    for (int c = 0; c < 3; c++) {
        float scaled = p->specular * p->specular_color[c];
        F0[c] = scaled < 1.0f ? scaled : 1.0f;
        reflected += weights[c] * (double)F0[c];
        diffuse += weights[c] * (double)p->base_color[c];
    }
    bool is_metal = reflected > (double)MAX_DIELECTRIC_F0 && reflected > 2.0 * diffuse;
    add_colored(t, is_metal ? "metal" : "dielectric", is_metal ? F0 : p->base_color);
    add_color(t, is_metal ? ", diffuse " : ", F0 ", is_metal ? p->base_color : F0);
}

static void describe_pbr(const facet_plot_material *p, text *t)
{
    bool is_metal = p->metallic >= 0.5f;
    if (p->metallic <= 0.0f && p->ior <= 0.0f) {
        describe_free_F0(p, t);
    } else {
        add_colored(t, is_metal ? "metal" : "dielectric", p->base_color);
        if (p->metallic > 0.0f && p->metallic < 1.0f)
            add_number(t, ", metallic ", p->metallic);
        if (p->metallic < 1.0f && (p->ior < 1.5f || p->ior > 1.5f))
            add_number(t, ", ior ", p->ior);
        if (p->metallic < 1.0f && p->specular < 1.0f)
            add_number(t, ", specular ", p->specular);
    }
    add_number(t, ", roughness ", p->perceptual_roughness);
    if (p->clearcoat > 0.0f)
        add_number(t, ", clearcoat ", p->clearcoat);
    if (p->sheen_color[0] > 0.0f || p->sheen_color[1] > 0.0f || p->sheen_color[2] > 0.0f)
        add_number(t, ", sheen of roughness ", p->sheen_roughness);
    if (p->anisotropy > 0.0f)
        add_number(t, ", anisotropy ", p->anisotropy);
    if (p->iridescence > 0.0f)
        text_addf(t, ", film of %.4g nm", (double)p->iridescence_thickness_nm);
    if (p->diffuse_roughness > 0.0f)
        add_number(t, ", diffuse roughness ", p->diffuse_roughness);
}

const char *material_describe(const facet_plot_material *p, const facet_allocator *allocator, arena *memory)
{
    text t = {.allocator = *allocator};
    if (p->model == FACET_PLOT_MODEL_PBR)
        describe_pbr(p, &t);
    else if (p->model == FACET_PLOT_MODEL_OGL1) {
        add_color(&t, "OpenGL 1, diffuse ", p->diffuse);
        add_color(&t, ", specular ", p->ogl1_specular);
        add_number(&t, ", shininess ", p->shininess);
    } else
        text_add(&t, path_base_name(p->path));
    const char *label = t.has_failed ? NULL : arena_strdup(memory, t.data);
    text_destroy(&t);
    return label;
}
