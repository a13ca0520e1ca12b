/* specular_glossiness.c - see specular_glossiness.h. */
#include "legacy/specular_glossiness.h"

#include <math.h>

#include "legacy/convert_surface.h"

static const float DIELECTRIC = 0.04f;

/* As in the sample code: root mean square with the weights of Rec.601 luma. */
static float perceived_brightness(const float c[3])
{
    return sqrtf(0.299f * c[0] * c[0] + 0.587f * c[1] * c[1] + 0.114f * c[2] * c[2]);
}

static float solve_metallic(float diffuse, float specular, float rest)
{
    if (specular < DIELECTRIC)
        return 0.0f;
    float b = diffuse * rest / (1.0f - DIELECTRIC) + specular - 2.0f * DIELECTRIC;
    float c = DIELECTRIC - specular;
    float discriminant = b * b - 4.0f * DIELECTRIC * c;
    return unit_of((-b + sqrtf(discriminant > 0.0f ? discriminant : 0.0f)) / (2.0f * DIELECTRIC));
}

void core_from_glossiness(const float diffuse[3], const float specular[3], float base_color[3],
                          float *metallic)
{
    const float epsilon = 1e-4f; /* each side of the mix vanishes with its divisor */
    float rest = 1.0f - unit_of(highest_of(specular));
    float m = solve_metallic(perceived_brightness(diffuse), perceived_brightness(specular), rest);
    for (int k = 0; k < 3; k++) {
        float from_diffuse = diffuse[k] * rest / (1.0f - DIELECTRIC) / fmaxf(1.0f - m, epsilon);
        float from_specular = (specular[k] - DIELECTRIC * (1.0f - m)) / fmaxf(m, epsilon);
        base_color[k] = unit_of(from_diffuse + m * m * (from_specular - from_diffuse));
    }
    *metallic = m;
}

bool glossiness_from_surface(const pbr_surface *in, float diffuse[3], float specular[3])
{
    /* KHR_materials_ior: 0 is an infinite index. */
    float root = in->ior == 0.0f ? 1.0f : (in->ior - 1.0f) / (in->ior + 1.0f);
    float dielectric[3];
    bool is_exact = in->specular == 1.0f || in->metallic == 1.0f;
    for (int k = 0; k < 3; k++) {
        dielectric[k] = unit_of(root * root * in->specular_color[k]) * in->specular;
        specular[k] = dielectric[k] + in->metallic * (in->base_color[k] - dielectric[k]);
    }
    float before = 1.0f - highest_of(dielectric);
    float after = 1.0f - highest_of(specular);
    for (int k = 0; k < 3; k++) {
        float wanted = (1.0f - in->metallic) * in->base_color[k] * before;
        /* The base below a mirror is invisible. */
        diffuse[k] = after > 0.0f ? wanted / after : 0.0f;
        is_exact &= diffuse[k] <= 1.0f;
        diffuse[k] = unit_of(diffuse[k]);
    }
    return is_exact;
}

/* ---- error ---- */

enum { NODES = 8, PANELS = 16 };
static const double NODE_AT[NODES] = {-0.9602898564975363, -0.7966664774136267, -0.5255324099163290,
                                      -0.1834346424956498, 0.1834346424956498,  0.5255324099163290,
                                      0.7966664774136267,  0.9602898564975363};
static const double NODE_WEIGHT[NODES] = {0.1012285362903763, 0.2223810344533745, 0.3137066458778873,
                                          0.3626837833783620, 0.3626837833783620, 0.3137066458778873,
                                          0.2223810344533745, 0.1012285362903763};
static const double PI = 3.14159265358979323846;

typedef struct sums {
    double difference, source, shown_difference, shown_source;
} sums;

static double shown(float radiance)
{
    return (double)unit_of(radiance);
}

static void add_direction(const pbr_surface *a, const pbr_surface *b, const float V[3], const float L[3],
                          double weight, sums *s)
{
    float T[3];
    float M[3];
    pbr_radiance(a, PBR_CORRELATED, V, L, T);
    pbr_radiance(b, PBR_CORRELATED, V, L, M);
    for (int k = 0; k < 3; k++) {
        double d = (double)M[k] - (double)T[k];
        double e = shown(M[k]) - shown(T[k]);
        s->difference += weight * d * d;
        s->source += weight * (double)T[k] * (double)T[k];
        s->shown_difference += weight * e * e;
        s->shown_source += weight * shown(T[k]) * shown(T[k]);
    }
}

/* A circle of half vectors around N; both halves are symmetric. dw_L = 4 (V.H) dw_H. */
static void add_ring(const pbr_surface *a, const pbr_surface *b, double view, double theta, double weight,
                     sums *s)
{
    const float V[3] = {(float)sin(view), 0, (float)cos(view)};
    double edge = view > 0.0
                      ? (cos(view) / (2.0 * cos(theta)) - cos(view) * cos(theta)) / (sin(view) * sin(theta))
                      : -1.0;
    /* At view 0 L.z = cos(2 theta). */
    if (view == 0.0 && theta > PI / 4)
        return;
    double most = edge <= -1.0 ? PI : edge >= 1.0 ? 0.0 : acos(edge);
    enum { PARTS = 3 };
    for (int part = 0; part < PARTS; part++)
        for (int i = 0; i < NODES; i++) {
            double half = 0.5 * most / PARTS;
            double phi = most * part / PARTS + half * (1.0 + NODE_AT[i]);
            double H[3] = {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
            double VdotH = H[0] * sin(view) + H[2] * cos(view);
            float L[3];
            for (int k = 0; k < 3; k++)
                L[k] = (float)(2.0 * VdotH * H[k] - (double)V[k]);
            if (L[2] > 0.0f && VdotH > 0.0)
                add_direction(a, b, V, L,
                              weight * 2.0 * half * NODE_WEIGHT[i] * sin(theta) * 4.0 * VdotH * (double)L[2],
                              s);
        }
}

/* Panels are short where lobes are narrow, and end where the horizon begins to cut the circles. */
static int panel_ends(double view, double ends[PANELS + 1])
{
    double cut = 0.5 * (PI / 2 - view);
    double last = 0.5 * (PI / 2 + view);
    int count = 0;
    ends[count++] = 0.0;
    for (int i = 0; i <= 9; i++) {
        double at = 1e-4 * pow(0.6 / 1e-4, (double)i / 9.0);
        double before = ends[count - 1];
        if (before < cut && at > cut)
            ends[count++] = cut;
        if (at < last)
            ends[count++] = at;
    }
    if (ends[count - 1] < cut && cut < last)
        ends[count++] = cut;
    double middle = 0.5 * (ends[count - 1] + last);
    ends[count++] = middle;
    ends[count++] = last;
    return count;
}

static double relative(double difference, double source)
{
    /* The same floor as in the metric of fit.h: a thousandth of white. */
    const double darkest = 1e-6 * PI * 3.0;
    return sqrt(difference / (source > darkest ? source : darkest));
}

fit_error compare_pbr(const pbr_surface *source, const pbr_surface *other)
{
    fit_error error;
    sums all = {0};
    for (int view = 0; view < 3; view++) {
        double angle = view * PI / 6.0;
        double ends[PANELS + 1];
        int count = panel_ends(angle, ends);
        sums s = {0};
        for (int panel = 0; panel + 1 < count; panel++)
            for (int i = 0; i < NODES; i++) {
                double half = 0.5 * (ends[panel + 1] - ends[panel]);
                add_ring(source, other, angle, ends[panel] + half * (1.0 + NODE_AT[i]), half * NODE_WEIGHT[i],
                         &s);
            }
        error.views[view] = relative(s.difference, s.source);
        all.difference += s.difference;
        all.source += s.source;
        all.shown_difference += s.shown_difference;
        all.shown_source += s.shown_source;
    }
    error.E = relative(all.difference, all.source);
    error.E_display = relative(all.shown_difference, all.shown_source);
    error.E_drawn = error.E_display;
    return error;
}
