/* fit_hue.c - OpenGL 1 to PBR with the hue of the diffuse color kept.
 *
 * A broad white highlight is nearly a second, white diffuse term: the PBR material of least error is white, whatever its
 * diffuse color was. Kept, the base color is proportional to Cd, and the specular reflectance is limited such that most of
 * the hue is left in the light that the material reflects of white surroundings. */
#include <math.h>

#include "legacy/fit_metric.h"
#include "legacy/fit_minimize.h"

#include "shade/shade.h"

/* Where a color lies beside gray of the same sum. */
static void chromaticity(const float color[3], double out[3])
{
    double sum = (double)color[0] + (double)color[1] + (double)color[2];
    for (int k = 0; k < 3; k++)
        out[k] = sum > 0.0 ? (double)color[k] / sum - 1.0 / 3.0 : 0.0;
}

double fit_hue_share(const ogl1_surface *in, const pbr_surface *out)
{
    static const double gray = 0.02; /* less has no hue to lose */
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

typedef struct search {
    const fit_metric *metric;
    const ogl1_surface *in;
    facet_legacy_target target;
    float brightest; /* of Cd */
    pbr_surface out;
} search;

static double figure_of(const search *s)
{
    fit_error e = fit_compare(s->metric, s->in, &s->out, FIT_FROM_OGL1);
    return s->target == FACET_LEGACY_TARGET_LINEAR    ? e.E
           : s->target == FACET_LEGACY_TARGET_DISPLAY ? e.E_display
                                                      : e.E_drawn;
}

/* x: roughness, the brightest channel of the base color, specular where the material has it. */
static double error_at(void *context, const double *x)
{
    search *s = context;
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
    static const double least = 0.04; /* what an ordinary dielectric reflects */
    search s = {.metric = metric, .in = in, .target = target, .out = *out};
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
