/* primaries.c - see primaries.h. */
#include "image/primaries.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "image/codec.h"

static const primaries rec709 = {{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}}};
static const primaries of_xyz = {{{1, 0}, {0, 1}, {0, 0}, {1.0 / 3, 1.0 / 3}}};

static const struct {
    const char *name;
    primaries primaries;
} known[] = {
    {"ACES2065-1 (AP0)", {{{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.077}, {0.32168, 0.33767}}}},
    {"ACEScg (AP1)", {{{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}}}},
    {"Rec.2020", {{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}}}},
    {"P3 with D65", {{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}}}},
    {"Radiance's standard primaries", {{{0.640, 0.330}, {0.290, 0.600}, {0.150, 0.060}, {1.0 / 3, 1.0 / 3}}}},
};

/* Equal to the precision that writers use. */
static bool is_same(const primaries *a, const primaries *b)
{
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 2; k++)
            if (!(fabs(a->xy[i][k] - b->xy[i][k]) < 1e-3))
                return false;
    return true;
}

/* ---- matrices of 3 x 3 ---- */

static void multiply(double a[3][3], double b[3][3], double out[3][3])
{
    double product[3][3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            product[i][k] = a[i][0] * b[0][k] + a[i][1] * b[1][k] + a[i][2] * b[2][k];
    memcpy(out, product, sizeof product);
}

static void multiply_vector(double m[3][3], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
}

/* False: missing or meaningless. */
static bool invert(double m[3][3], double out[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            const int a = (k + 1) % 3, b = (k + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            out[i][k] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
        }
    const double determinant = m[0][0] * out[0][0] + m[0][1] * out[1][0] + m[0][2] * out[2][0];
    if (!(fabs(determinant) > 1e-6 && fabs(determinant) < 1e6)) /* NaN too */
        return false;
    for (int i = 0; i < 9; i++)
        out[i / 3][i % 3] /= determinant;
    return true;
}

/* ---- color spaces ---- */

/* XYZ of white, Y = 1. False: not a color. */
static bool get_white(const primaries *p, double white[3])
{
    const double x = p->xy[3][0], y = p->xy[3][1];
    if (!(y > 1e-3 && y <= 1.0 && x >= 0.0 && x <= 1.0))
        return false;
    white[0] = x / y;
    white[1] = 1.0;
    white[2] = (1.0 - x - y) / y;
    return true;
}

/* SMPTE RP 177-1993, section 3: columns are the primaries, scaled so that (1, 1, 1) is white. */
static bool get_xyz_matrix(const primaries *p, double out[3][3])
{
    double columns[3][3], inverse[3][3], white[3], scale[3];
    for (int k = 0; k < 3; k++) {
        columns[0][k] = p->xy[k][0];
        columns[1][k] = p->xy[k][1];
        columns[2][k] = 1.0 - p->xy[k][0] - p->xy[k][1];
    }
    if (!get_white(p, white) || !invert(columns, inverse))
        return false;
    multiply_vector(inverse, white, scale);
    for (int k = 0; k < 3; k++) {
        if (!(scale[k] > 1e-6 && scale[k] < 1e6)) /* white is outside of the triangle */
            return false;
        for (int i = 0; i < 3; i++)
            out[i][k] = columns[i][k] * scale[k];
    }
    return true;
}

/* Lam 1985, "Metamerism and colour constancy": cone responses scaled from one white to the other. */
static bool get_adaptation(const double from[3], const double to[3], double out[3][3])
{
    double bradford[3][3] = {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}};
    double inverse[3][3], scaled[3][3], cones_from[3], cones_to[3];
    multiply_vector(bradford, from, cones_from);
    multiply_vector(bradford, to, cones_to);
    for (int i = 0; i < 3; i++) {
        if (!(cones_from[i] > 1e-3))
            return false;
        for (int k = 0; k < 3; k++)
            scaled[i][k] = bradford[i][k] * cones_to[i] / cones_from[i];
    }
    invert(bradford, inverse);
    multiply(inverse, scaled, out);
    return true;
}

bool primaries_to_rec709(const primaries *p, double matrix[3][3])
{
    double to_xyz[3][3], adaptation[3][3], from_rec709[3][3], to_rec709[3][3], white[3], d65[3];
    if (!get_xyz_matrix(p, to_xyz) || !get_white(p, white) || !get_white(&rec709, d65))
        return false;
    if (!is_same(p, &of_xyz)) {
        if (!get_adaptation(white, d65, adaptation))
            return false;
        multiply(adaptation, to_xyz, to_xyz);
    }
    get_xyz_matrix(&rec709, from_rec709);
    invert(from_rec709, to_rec709);
    multiply(to_rec709, to_xyz, matrix);
    return true;
}

/* ---- images ---- */

typedef struct conversion {
    const image *image;
    float matrix[3][3];
    bool keeps_nonfinite, clips_gamut;
} conversion;

static void convert_rows(void *context, size_t begin, size_t end)
{
    const conversion *c = context;
    const size_t channels = c->image->channel_count;
    float *p = (float *)c->image->pixels + begin * c->image->width * channels;
    const float *last = (const float *)c->image->pixels + end * c->image->width * channels;
    for (; p < last; p += channels) {
        if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2]))
            continue;
        const bool is_color = p[0] >= 0.0f && p[1] >= 0.0f && p[2] >= 0.0f;
        float rgb[3];
        for (int i = 0; i < 3; i++) {
            rgb[i] = c->matrix[i][0] * p[0] + c->matrix[i][1] * p[1] + c->matrix[i][2] * p[2];
            rgb[i] = c->keeps_nonfinite ? rgb[i] : codec_finite(rgb[i]);
            rgb[i] = c->clips_gamut && is_color && rgb[i] < 0.0f ? 0.0f : rgb[i];
        }
        memcpy(p, rgb, sizeof rgb);
    }
}

static const char *get_name(const primaries *p)
{
    if (is_same(p, &of_xyz))
        return "CIE XYZ";
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (is_same(p, &known[i].primaries))
            return known[i].name;
    return NULL;
}

void primaries_convert(image *i, const primaries *p, const image_decode_desc *desc)
{
    double matrix[3][3];
    if (is_same(p, &rec709))
        return;
    if (!primaries_to_rec709(p, matrix)) {
        image_note_set(
            desc->note, FACET_LOG_LEVEL_WARNING,
            "its primaries do not form a color space (x, y of red %g, %g, green %g, %g, blue %g, %g, white "
            "%g, %g): colors are taken as linear Rec.709",
            p->xy[0][0], p->xy[0][1], p->xy[1][0], p->xy[1][1], p->xy[2][0], p->xy[2][1], p->xy[3][0],
            p->xy[3][1]);
        return;
    }
    conversion c = {.image = i, .keeps_nonfinite = desc->keeps_nonfinite, .clips_gamut = desc->clips_gamut};
    for (int k = 0; k < 9; k++)
        c.matrix[k / 3][k % 3] = (float)matrix[k / 3][k % 3];
    parallel_for(desc->thread_count, i->height, 32768 / i->width + 1, convert_rows, &c);
    const char *name = get_name(p);
    if (name)
        image_note_set(desc->note, FACET_LOG_LEVEL_DETAIL, "colors of %s are converted to linear Rec.709",
                       name);
    else
        image_note_set(
            desc->note, FACET_LOG_LEVEL_DETAIL,
            "colors of the primaries red %g, %g, green %g, %g, blue %g, %g, white %g, %g are converted "
            "to linear Rec.709",
            p->xy[0][0], p->xy[0][1], p->xy[1][0], p->xy[1][1], p->xy[2][0], p->xy[2][1], p->xy[3][0],
            p->xy[3][1]);
}

/* ---- spectra ---- */

const double cie_d65[CIE_D65_COUNT] = {
    49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861, 115.923,
    108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.7880, 88.6856,
    90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091,
    74.3490, 61.6040, 69.8856, 75.0870, 63.5927, 46.4182, 66.8054, 63.3828};

/* A Gaussian with its own width on either side. */
static double lobe(double x, double mean, double below, double above)
{
    double t = (x - mean) / (x < mean ? below : above);
    return exp(-0.5 * t * t);
}

void cie_match_color(double nm, double xyz[3])
{
    xyz[0] = 1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) -
             0.065 * lobe(nm, 501.1, 20.4, 26.2);
    xyz[1] = 0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1);
    xyz[2] = 1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8);
}

void cie_rec709_from_xyz(const double xyz[3], double rgb[3])
{
    static const double m[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                   {-0.9692660, 1.8760108, 0.0415560},
                                   {0.0556434, -0.2040259, 1.0572252}};
    for (int i = 0; i < 3; i++)
        rgb[i] = m[i][0] * xyz[0] + m[i][1] * xyz[1] + m[i][2] * xyz[2];
}
