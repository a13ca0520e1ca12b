/* material_albedo.c - directional albedo of any material by sampling all its lobes. See material.h. */
#include <math.h>

#include "plot/material.h"

#include "shade/shade.h"

enum { MAX_LOBES = 6, BATCH = 256, FIRST_COUNT = 1024, LAST_COUNT = 65536 };

/* A density of directions to light: cosine, GGX by visible normals, or Charlie's fibres. */
typedef struct lobe {
    enum { LOBE_COSINE, LOBE_GGX, LOBE_CHARLIE } kind;
    float alpha_x, alpha_y;
    vec2 along; /* of alpha_x, in the plane */
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
    float a = clamp(alpha, ALPHA_MIRROR, 1.0f);
    add_lobe(set, (lobe){.kind = LOBE_GGX, .alpha_x = a, .alpha_y = a, .along = vec2(1.0f, 0.0f)});
}

static lobe_set lobes_of(const material *m)
{
    const facet_plot_material *p = &m->parameters;
    lobe_set set = {0};
    add_lobe(&set, (lobe){.kind = LOBE_COSINE});
    if (p->model == FACET_PLOT_MODEL_MERL) { /* whatever was measured: mirrors to velvet */
        add_ggx(&set, 0.02f);
        add_ggx(&set, 0.1f);
        add_ggx(&set, 0.4f);
    } else if (p->model == FACET_PLOT_MODEL_OGL1) {
        add_ggx(&set, alpha_from_roughness(perceptual_roughness_from_shininess(p->shininess)));
        add_ggx(&set,
                1.0f); /* its highlight reaches the horizon undiminished, where the cosine's density is 0 */
    } else {
        vec2 a = anisotropic_alpha(alpha_from_roughness(p->perceptual_roughness), p->anisotropy);
        vec2 along = anisotropy_direction(vec2(1.0f, 0.0f), p->anisotropy_rotation_rad);
        a = max(a, ALPHA_MIRROR);
        add_lobe(&set, (lobe){.kind = LOBE_GGX, .alpha_x = a[0], .alpha_y = a[1], .along = along});
        if (p->clearcoat > 0.0f)
            add_ggx(&set, alpha_from_roughness(p->clearcoat_roughness));
        float sheen = sheen_alpha(p->sheen_roughness);
        if (max(p->sheen_color[0], max(p->sheen_color[1], p->sheen_color[2])) > 0.0f)
            add_lobe(&set, (lobe){.kind = LOBE_CHARLIE, .alpha_x = sheen, .alpha_y = sheen});
    }
    return set;
}

static vec3 into_grain(const lobe *l, vec3 v)
{
    return vec3(l->along[0] * v[0] + l->along[1] * v[1], l->along[0] * v[1] - l->along[1] * v[0], v[2]);
}
static vec3 out_of_grain(const lobe *l, vec3 v)
{
    return vec3(l->along[0] * v[0] - l->along[1] * v[1], l->along[1] * v[0] + l->along[0] * v[1], v[2]);
}

static vec3 sample_lobe(const lobe *l, vec2 u, vec3 V)
{
    if (l->kind == LOBE_COSINE)
        return sample_cosine(u);
    if (l->kind == LOBE_CHARLIE)
        return reflect(-V, sample_D_Charlie(u, l->alpha_x));
    vec3 H = sample_VNDF_GGX(u, into_grain(l, V), l->alpha_x, l->alpha_y);
    return reflect(-V, out_of_grain(l, H));
}

/* Density of L per sr, of all lobes together. */
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
            sum += pdf_VNDF_GGX(into_grain(l, V), into_grain(l, H), l->alpha_x, l->alpha_y) * jacobian;
    }
    return sum;
}

/* Adds the terms of samples begin .. begin + BATCH of n of one lobe: the balance heuristic, Veach and Guibas 1995. */
static void add_batch(const material *m, const lobe_set *set, const lobe *l, const float V_[3],
                      uint32_t begin, uint32_t n, double sum[3])
{
    vec3 V = vec3(V_[0], V_[1], V_[2]);
    float L[BATCH][3];
    double f[BATCH][3];
    for (uint32_t i = 0; i < BATCH; i++) {
        vec3 d = sample_lobe(l, hammersley(begin + i, n), V);
        L[i][0] = d[0];
        L[i][1] = d[1];
        L[i][2] = d[2];
    }
    material_brdf_cos(m, V_, BATCH, (const float(*)[3])L, f);
    for (uint32_t i = 0; i < BATCH; i++) {
        if (!(L[i][2] > 0.0f))
            continue;
        double pdf = (double)pdf_lobes(set, V, vec3(L[i][0], L[i][1], L[i][2]));
        for (int c = 0; c < 3; c++)
            if (f[i][c] > 0.0) /* not NAN: measured */
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
