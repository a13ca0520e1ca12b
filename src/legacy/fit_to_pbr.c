/* fit_to_pbr.c - OpenGL 1 to PBR by fitting, with KHR_materials_specular and KHR_materials_ior and without.
 *
 * With ior 0, F0 is the specular color times specular and F90 is specular: Fresnel is constant for a
 * white one, as Blinn's highlight is. For given roughness, F90 and largest F0, radiance is linear in base
 * color and the other F0; the search is along those three, starting from the best constant Fresnel along
 * roughness. Without the extensions it is along roughness and metallic, and linear in base color. */
#include <math.h>
#include <string.h>

#include "legacy/fit_linear.h"
#include "legacy/fit_metric.h"
#include "legacy/fit_minimize.h"

#include "shade/shade.h"

typedef struct search {
    fit_problem problem;
    bool is_brightest[3]; /* channels of the largest Cs, which have the largest F0 */
    double roughness;     /* of problem.lobe */
    double F0, F90;
    double factor[3][2]; /* base color, F0 */
} search;

static void set_roughness(search *s, double roughness)
{
    if (roughness != s->roughness)
        fit_specular_lobe(s->problem.metric, (float)roughness, s->problem.lobe);
    s->roughness = roughness;
}

/* ---- with extensions ---- */

static void specular_shapes(fit_problem *p, float F0, float F90)
{
    const fit_metric *m = p->metric;
    for (size_t i = 0; i < m->node_begin[FIT_VIEWS]; i++) {
        float w = m->fresnel[i];
        p->shape[0][i] = m->NdotL[i] * (1.0f - mix(F0, F90, w));
        p->shape[1][i] = p->lobe[i] * mix(1.0f, 0.0f, w);
        p->rest[i] = p->lobe[i] * mix(0.0f, F90, w);
    }
}

/* x: roughness, largest F0, position of F90 between it and 1. (These rather than F90: the error changes
 * little along the last, and a simplex takes many steps along diagonal valleys.) */
static double specular_error(void *context, const double *x)
{
    search *s = context;
    double F0 = x[1];
    double F90 = F0 + x[2] * (1.0 - F0);
    fit_bounds bounds[3];
    for (int k = 0; k < 3; k++)
        bounds[k] = (fit_bounds){{0.0, s->is_brightest[k] ? F0 : 0.0}, {1.0, F0}};
    set_roughness(s, x[0]);
    s->F0 = F0;
    s->F90 = F90;
    specular_shapes(&s->problem, (float)F0, (float)F90);
    return fit_factors(&s->problem, bounds, s->factor);
}

/* x: roughness. F is the largest factor of the lobe beside an uncoupled Lambert term. */
static double flat_error(void *context, const double *x)
{
    search *s = context;
    fit_problem *p = &s->problem;
    static const fit_bounds bounds[3] = {
        {{0.0, 0.0}, {1.0, 1.0}}, {{0.0, 0.0}, {1.0, 1.0}}, {{0.0, 0.0}, {1.0, 1.0}}};
    set_roughness(s, x[0]);
    memcpy(p->shape[0], p->metric->NdotL, sizeof p->shape[0]);
    memcpy(p->shape[1], p->lobe, sizeof p->shape[1]);
    memset(p->rest, 0, sizeof p->rest);
    fit_factors(p, bounds, s->factor);
    double F0 = 0.0;
    for (int k = 0; k < 3; k++)
        F0 = fmax(F0, s->factor[k][1]);
    return specular_error(s, (const double[3]){x[0], F0, 0.0});
}

static void set_target(search *s, const fit_metric *metric, const ogl1_surface *in,
                       facet_legacy_target target)
{
    float brightest = max(in->specular[0], max(in->specular[1], in->specular[2]));
    fit_problem_from_ogl1(&s->problem, metric, target, in);
    float most = 0.0f;
    for (int k = 0; k < 3; k++) {
        s->is_brightest[k] = in->specular[k] == brightest;
        if (s->is_brightest[k])
            most = max(most, in->diffuse[k]);
    }
    /* In display values a white highlight adds more light to a bright channel. */
    for (int k = 0; k < 3 && target == FACET_LEGACY_TARGET_DRAWN; k++)
        s->is_brightest[k] = s->is_brightest[k] && in->diffuse[k] == most;
    s->roughness = -1.0;
}

/* A first fast search is linear: of the radiance of the source, or of the displayed light. */
static void begin_linear(search *s, const fit_metric *metric, const ogl1_surface *in,
                         facet_legacy_target target)
{
    bool is_drawn = target == FACET_LEGACY_TARGET_DRAWN;
    set_target(s, metric, in, is_drawn ? target : FACET_LEGACY_TARGET_LINEAR);
    s->problem.target = FACET_LEGACY_TARGET_LINEAR;
}

/* From x, from an ordinary dielectric and from the closed form: a broad highlight resembles a second
 * diffuse term, for which the first search may have lost its lobe, or kept one where grazing sheen is
 * better. Narrow highlights have a single valley. */
static void search_specular(search *s, const ogl1_surface *in, facet_legacy_target target, double x[3])
{
    static const double step[3] = {0.05, 0.05, 0.1};
    static const float broad = 8.0f; /* of 300 random materials none with a larger exponent gained 1 % */
    pbr_surface closed;
    ogl1_to_pbr_closed(in, &closed);
    double starts[3][3] = {
        {0.5, (double)dielectric_F0(1.5f, 1.0f, vec3(1.0f))[0], 1.0},
        {(double)closed.perceptual_roughness, (double)closed.specular, 0.0},
        {0.7 * (double)closed.perceptual_roughness, fmin(4.0 * (double)closed.specular, 1.0), 0.0}};
    int count =
        target == FACET_LEGACY_TARGET_DRAWN ? 3 : 2; /* a sum that clamps early has a small bright core */
    double error = fit_minimize_n(specular_error, s, 3, x, step, 1e-5, 120);
    for (int i = 0; i < count; i++) {
        if (i < 2 && in->shininess > broad && specular_error(s, starts[i]) >= error)
            continue;
        double other = fit_minimize_n(specular_error, s, 3, starts[i], step, 1e-5, 120);
        if (other < error) {
            error = other;
            memcpy(x, starts[i], sizeof starts[i]);
        }
    }
    specular_error(s, x); /* its factors */
}

uint32_t ogl1_to_pbr_fit(const fit_metric *metric, const ogl1_surface *in, facet_legacy_target target,
                         pbr_surface *out)
{
    search s;
    double x[3];
    begin_linear(&s, metric, in, target);
    fit_minimize_1(flat_error, &s, 0.0, 1.0, 21, 1e-3, x);
    x[1] = s.F0;
    x[2] = 0.0;
    if (target != FACET_LEGACY_TARGET_LINEAR)
        set_target(&s, metric, in, target);
    search_specular(&s, in, target, x);
    *out = pbr_surface_default();
    out->perceptual_roughness = (float)x[0];
    out->ior = 0.0f;
    out->specular = (float)s.F90;
    for (int k = 0; k < 3; k++) {
        out->base_color[k] = (float)s.factor[k][0];
        out->specular_color[k] = s.F90 > 0.0 ? clamp((float)(s.factor[k][1] / s.F90), 0.0f, 1.0f) : 1.0f;
    }
    return fit_remarks_to_pbr(in, out);
}

/* ---- without ---- */

/* x: roughness, metallic. */
static double core_error(void *context, const double *x)
{
    static const fit_bounds bounds[3] = {
        {{0.0, 0.0}, {1.0, 0.0}}, {{0.0, 0.0}, {1.0, 0.0}}, {{0.0, 0.0}, {1.0, 0.0}}};
    search *s = context;
    fit_problem *p = &s->problem;
    const fit_metric *m = p->metric;
    float F0 = dielectric_F0(1.5f, 1.0f, vec3(1.0f))[0];
    float metallic = (float)x[1];
    set_roughness(s, x[0]);
    for (size_t i = 0; i < m->node_begin[FIT_VIEWS]; i++) {
        float F = mix(F0, 1.0f, m->fresnel[i]);
        p->shape[0][i] = mix(m->NdotL[i] * (1.0f - F), p->lobe[i] * mix(1.0f, 0.0f, m->fresnel[i]), metallic);
        p->rest[i] = p->lobe[i] * mix(F, m->fresnel[i], metallic);
    }
    return fit_factors(p, bounds, s->factor);
}

typedef struct line {
    search *search;
    double roughness, metallic;
} line;

static double core_error_along_metallic(void *context, const double *x)
{
    line *l = context;
    return core_error(l->search, (const double[2]){l->roughness, *x});
}

static double core_error_along_roughness(void *context, const double *x)
{
    line *l = context;
    l->roughness = *x;
    return fit_minimize_1(core_error_along_metallic, l, 0.0, 1.0, 7, 0.1, &l->metallic);
}

/* From x, and from another start if that is better already or requested. */
static void search_core(search *s, const double other[2], bool is_other_tried, double x[2])
{
    static const double step[2] = {0.05, 0.05};
    double error = fit_minimize_n(core_error, s, 2, x, step, 1e-5, 100);
    double start[2] = {other[0], other[1]};
    if ((is_other_tried || core_error(s, start) < error) &&
        fit_minimize_n(core_error, s, 2, start, step, 1e-5, 100) < error)
        memcpy(x, start, sizeof start);
    core_error(s, x); /* its factors */
}

uint32_t ogl1_to_pbr_core_fit(const fit_metric *metric, const ogl1_surface *in, facet_legacy_target target,
                              pbr_surface *out)
{
    search s;
    line l = {.search = &s};
    double x[2];
    begin_linear(&s, metric, in, target);
    memset(s.problem.shape[1], 0, sizeof s.problem.shape[1]);
    fit_minimize_1(core_error_along_roughness, &l, 0.0, 1.0, 15, 0.05, x);
    x[1] = l.metallic;
    ogl1_to_pbr_core_closed(in, out);
    search_core(&s, (const double[2]){(double)out->perceptual_roughness, (double)out->metallic}, false, x);
    if (target != FACET_LEGACY_TARGET_LINEAR) { /* with a clamped peak a narrower lobe may be better */
        set_target(&s, metric, in, target);
        search_core(&s, (const double[2]){0.75 * x[0], x[1]}, true, x);
    }
    *out = pbr_surface_default();
    out->perceptual_roughness = (float)x[0];
    out->metallic = (float)x[1];
    for (int k = 0; k < 3; k++)
        out->base_color[k] = (float)s.factor[k][0];
    return fit_remarks_to_pbr(in, out);
}

/* ---- the hue kept ----
 *
 * A broad white highlight is nearly a second, white diffuse term: the PBR material of least error is white, whatever its
 * diffuse color was. With the hue kept, the base color is proportional to Cd, and the specular reflectance is limited such that
 * most of the hue remains in the reflection of a white environment. */

/* Chromaticity relative to gray. */
static void chromaticity(const float color[3], double out[3])
{
    double sum = (double)color[0] + (double)color[1] + (double)color[2];
    for (int k = 0; k < 3; k++)
        out[k] = sum > 0.0 ? (double)color[k] / sum - 1.0 / 3.0 : 0.0;
}

double fit_hue_share(const ogl1_surface *in, const pbr_surface *out)
{
    static const double gray = 0.02; /* below this there is no hue */
    fit_lobes lobes = fit_lobes_of(out);
    float reflected[3];
    double wanted[3], found[3];
    double product = 0.0, square = 0.0;
    for (int k = 0; k < 3; k++)
        reflected[k] = lobes.diffuse[k] * (1.0f - lobes.shade[0]) + lobes.F0[k];
    chromaticity(in->diffuse, wanted);
    chromaticity(reflected, found);
    for (int k = 0; k < 3; k++) {
        product += wanted[k] * found[k];
        square += wanted[k] * wanted[k];
    }
    return square > gray * gray ? product / square : 1.0;
}

typedef struct hue_search {
    const fit_metric *metric;
    const ogl1_surface *in;
    facet_legacy_target target;
    float brightest; /* of Cd */
    pbr_surface out;
} hue_search;

static double figure_of(const hue_search *s)
{
    fit_error e = fit_compare(s->metric, s->in, &s->out, FIT_FROM_OGL1);
    return s->target == FACET_LEGACY_TARGET_LINEAR    ? e.E
           : s->target == FACET_LEGACY_TARGET_DISPLAY ? e.E_display
                                                      : e.E_drawn;
}

/* x: roughness, the brightest channel of the base color, specular where the material has it. */
static double error_at(void *context, const double *x)
{
    hue_search *s = context;
    s->out.perceptual_roughness = (float)x[0];
    for (int k = 0; k < 3; k++)
        s->out.base_color[k] = min((float)x[1] * s->in->diffuse[k] / s->brightest, 1.0f);
    if (s->out.ior == 0.0f)
        s->out.specular = (float)x[2];
    double missing = fmax(FIT_HUE_KEPT - fit_hue_share(s->in, &s->out), 0.0);
    return figure_of(s) + 10.0 * missing;
}

bool fit_keep_hue(const fit_metric *metric, const ogl1_surface *in, facet_legacy_target target,
                  pbr_surface *out)
{
    static const double step[3] = {0.05, 0.05, 0.02};
    static const double least = 0.04; /* reflectance of an ordinary dielectric */
    hue_search s = {.metric = metric, .in = in, .target = target, .out = *out};
    s.brightest = max(in->diffuse[0], max(in->diffuse[1], in->diffuse[2]));
    if (s.brightest <= 0.0f || fit_hue_share(in, out) >= FIT_HUE_KEPT)
        return false;
    s.out.metallic = 0.0f;
    float most = max(in->specular[0], max(in->specular[1], in->specular[2]));
    for (int k = 0; k < 3 && s.out.ior == 0.0f; k++)
        s.out.specular_color[k] = most > 0.0f ? in->specular[k] / most : 1.0f;
    double x[3] = {(double)out->perceptual_roughness,
                   (double)max(out->base_color[0], max(out->base_color[1], out->base_color[2])), least};
    fit_minimize_n(error_at, &s, out->ior == 0.0f ? 3 : 2, x, step, 1e-4, 150);
    *out = s.out;
    return true;
}
