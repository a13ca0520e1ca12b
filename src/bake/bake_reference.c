/* bake_reference.c - see bake_reference.h. */
#include "bake/bake_reference.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "base/simd.h"
#include "ibl/equirect.h"
#include "ibl/gauss.h"

static const double pi = 3.14159265358979323846;

enum {
    SPAN = 64, /* texels that are summed in float */
    NEAR = 24, /* texels around R whose weight is integrated, */
    CLOSE = 6, /* and those with more quadrature points */
    TABLE = 4096
};

facet_result bake_reference_create(const bake_source *source, const facet_allocator *allocator,
                                   bake_reference *out, facet_error *error)
{
    size_t width = source->panorama.width;
    size_t height = source->panorama.height;
    bake_reference r = {.source = source, .stride = (width + SPAN - 1) / SPAN * SPAN};
    *out = (bake_reference){0};
    r.planes = mem_zalloc(allocator, height, 3 * r.stride * sizeof *r.planes);
    r.waves = mem_zalloc(allocator, r.stride, 2 * sizeof *r.waves);
    if (!r.planes || !r.waves) {
        bake_reference_destroy(&r);
        return fail_memory(error, "reference", height * 3 * r.stride * sizeof *r.planes);
    }
    for (size_t x = 0; x < width; x++) {
        double phi = 2.0 * pi * ((double)x + 0.5) / (double)width - pi;
        r.waves[x] = (float)cos(phi);
        r.waves[r.stride + x] = (float)sin(phi);
    }
    const float *p = source->panorama.pixels;
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++)
            for (size_t k = 0; k < 3; k++)
                r.planes[(3 * y + k) * r.stride + x] = *p++;
    *out = r;
    return FACET_OK;
}

void bake_reference_destroy(bake_reference *r)
{
    mem_free(r->planes);
    mem_free(r->waves);
    *r = (bake_reference){0};
}

void bake_reference_set_lobe(const bake_lobe *lobe, bake_reference_lobe *out)
{
    out->lobe = *lobe;
    for (int i = 0; i <= TABLE; i++)
        out->table[i] =
            lobe->kind == FACET_LOBE_CHARLIE ? (float)pow((double)i / TABLE, 0.5 / lobe->alpha) : 0.0f;
}

/* ---- one direction ---- */

typedef struct gathering {
    const bake_reference *r;
    const bake_reference_lobe *lobe;
    double d[3];            /* unit, in the panorama */
    double from, to, close; /* rad from R: zone of integration, and radius of that with more points */
    uint32_t parts, points; /* parts of a texel's edge, points in each part */
    double sum[3], weight;
} gathering;

/* Adds up to SPAN texels of a row from x on, weighted at their centers. sine, cosine: of the row's theta. */
static inline __attribute__((always_inline)) void add_span(gathering *g, uint32_t y, size_t x, float sine,
                                                           float cosine, double solid_angle)
{
    const bake_reference *r = g->r;
    const float *c = r->waves + x;
    const float *s = r->waves + r->stride + x;
    const float *p = r->planes + 3 * (size_t)y * r->stride + x;
    float dx = (float)g->d[0];
    float dz = (float)g->d[2];
    float dy = (float)g->d[1] - cosine;
    float dy2 = dy * dy;
    bool is_charlie = g->lobe->lobe.kind == FACET_LOBE_CHARLIE;
    float a2 = (float)(g->lobe->lobe.alpha * g->lobe->lobe.alpha);
    float weights[SPAN];
    size_t count = r->source->panorama.width - x < SPAN ? r->source->panorama.width - x : SPAN;
    for (size_t i = 0; i < SPAN; i++) {
        float ex = dx - sine * c[i];
        float ez = dz - sine * s[i];
        float s2 = 0.25f * (ex * ex + dy2 + ez * ez); /* |R - l|^2 / 4: no cancellation near R */
        float cosine_l = 1.0f - 2.0f * s2;
        float w = a2 + (1.0f - a2) * s2;
        w = cosine_l / (w * w);
        weights[i] = cosine_l > 0.0f ? w : 0.0f;
        if (is_charlie)
            weights[i] = s2;
    }
    if (is_charlie)
        for (size_t i = 0; i < SPAN; i++) {
            float at = 2.0f * weights[i];
            float cosine_l = 1.0f - at;
            at *= TABLE;
            int k = cosine_l > 0.0f ? (int)at : 0;
            float t = g->lobe->table[k] + (g->lobe->table[k + 1] - g->lobe->table[k]) * (at - (float)k);
            weights[i] = cosine_l > 0.0f ? t * cosine_l : 0.0f;
        }
    for (size_t i = count; i < SPAN; i++)
        weights[i] = 0.0f;
    float sums[4][8] = {{0.0f}};
    for (size_t i = 0; i < SPAN; i += 8)
        for (size_t k = 0; k < 8; k++) {
            sums[0][k] += weights[i + k] * p[i + k];
            sums[1][k] += weights[i + k] * p[r->stride + i + k];
            sums[2][k] += weights[i + k] * p[2 * r->stride + i + k];
            sums[3][k] += weights[i + k];
        }
    for (int k = 0; k < 8; k++) {
        for (int j = 0; j < 3; j++)
            g->sum[j] += solid_angle * (double)sums[j][k];
        g->weight += solid_angle * (double)sums[3][k];
    }
}

/* Position and weight (they add up to 1) of point i on a texel's edge: Gauss-Legendre with 8 or 2 points. */
static inline double edge_point(const gathering *g, uint32_t i, double *weight)
{
    uint32_t part = i / g->points;
    if (g->points == 8)
        return gauss_8((int)(i % 8), (double)part / g->parts, (part + 1.0) / g->parts, weight);
    *weight = 0.5 / g->parts;
    return (part + (i % 2 ? 0.78867513459481287 : 0.21132486540518713)) / g->parts;
}

/* Weight, for Charlie from a table whose steps are small compared to the ring. */
static inline double weigh(const bake_reference_lobe *lobe, double s2)
{
    if (s2 >= 0.5)
        return 0.0;
    if (lobe->lobe.kind != FACET_LOBE_CHARLIE)
        return bake_lobe_weight(&lobe->lobe, s2);
    double at = 2.0 * s2 * TABLE;
    int k = (int)at;
    double low = (double)lobe->table[k];
    return (1.0 - 2.0 * s2) * (low + ((double)lobe->table[k + 1] - low) * (at - k));
}

/* Adds one texel with its integrated weight. */
static void add_texel(gathering *g, uint32_t y, size_t x)
{
    const image *panorama = &g->r->source->panorama;
    double width = 2.0 * pi / panorama->width;
    double north = cos(pi * y / panorama->height);
    double south = y + 1 == panorama->height ? -1.0 : cos(pi * (y + 1.0) / panorama->height);
    double cosines[256], sines[256], weights[256];
    uint32_t count = g->points * g->parts;
    for (uint32_t i = 0; i < count; i++) {
        double phi = ((double)x + edge_point(g, i, &weights[i])) * width - pi;
        cosines[i] = cos(phi);
        sines[i] = sin(phi);
    }
    double sum = 0.0;
    for (uint32_t j = 0; j < count; j++) {
        double h_weight;
        double h = north + (south - north) * edge_point(g, j, &h_weight);
        double sine = sqrt(fmax(1.0 - h * h, 0.0));
        double ey = g->d[1] - h;
        for (uint32_t i = 0; i < count; i++) {
            double ex = g->d[0] - sine * cosines[i];
            double ez = g->d[2] - sine * sines[i];
            double s2 = 0.25 * (ex * ex + ey * ey + ez * ez);
            sum += h_weight * weights[i] * weigh(g->lobe, s2);
        }
    }
    sum *= (north - south) * width;
    const float *p = g->r->planes + 3 * (size_t)y * g->r->stride + x;
    for (size_t k = 0; k < 3; k++)
        g->sum[k] += sum * (double)p[k * g->r->stride];
    g->weight += sum;
}

static double cosine_at(const gathering *g, double theta, double x)
{
    double phi = 2.0 * pi * x / g->r->source->panorama.width - pi;
    return sin(theta) * (g->d[0] * cos(phi) + g->d[2] * sin(phi)) + g->d[1] * cos(theta);
}

/* Whether some texels of the row from x to x + SPAN - 1 may be in the zone of integration. */
static bool is_near(const gathering *g, double theta, size_t x)
{
    double angle = acos(fmax(-1.0, fmin(1.0, cosine_at(g, theta, (double)x + 0.5 * SPAN))));
    double reach = sin(theta) * pi * SPAN / g->r->source->panorama.width + 1e-3;
    return angle - reach < g->to && angle + reach > g->from;
}

static double angle_to(const gathering *g, double theta, size_t x)
{
    return acos(fmax(-1.0, fmin(1.0, cosine_at(g, theta, (double)x + 0.5))));
}

/* Adds a span with texels in the zone: these integrated, the others weighted at their centers. */
static void add_near_span(gathering *g, uint32_t y, size_t x, double theta, double solid_angle)
{
    const bake_reference *r = g->r;
    size_t width = r->source->panorama.width;
    for (size_t i = x; i < x + SPAN && i < width; i++) {
        double angle = angle_to(g, theta, i);
        if (angle < g->to && angle > g->from) {
            g->points = angle < g->close ? 8 : 2;
            add_texel(g, y, i);
            continue;
        }
        double ex = g->d[0] - sin(theta) * (double)r->waves[i];
        double ey = g->d[1] - cos(theta);
        double ez = g->d[2] - sin(theta) * (double)r->waves[r->stride + i];
        double s2 = 0.25 * (ex * ex + ey * ey + ez * ez);
        double w = solid_angle * weigh(g->lobe, s2);
        for (size_t k = 0; k < 3; k++)
            g->sum[k] += w * (double)r->planes[(3 * (size_t)y + k) * r->stride + i];
        g->weight += w;
    }
}

DISPATCH_AVX2 static void gather_rows(gathering *g)
{
    const image *panorama = &g->r->source->panorama;
    double across = sqrt(g->d[0] * g->d[0] + g->d[2] * g->d[2]);
    for (uint32_t y = 0; y < panorama->height; y++) {
        double theta = pi * (y + 0.5) / panorama->height;
        double sine = sin(theta);
        double cosine = cos(theta);
        if (across * sine + g->d[1] * cosine < -pi / panorama->height) /* the row is below the horizon */
            continue;
        double solid_angle = equirect_texel_solid_angle(panorama->width, panorama->height, y);
        for (size_t x = 0; x < panorama->width; x += SPAN)
            if (is_near(g, theta, x))
                add_near_span(g, y, x, theta, solid_angle);
            else
                add_span(g, y, x, (float)sine, (float)cosine, solid_angle);
    }
}

void bake_reference_gather(const bake_reference *r, const bake_reference_lobe *lobe, const double d[3],
                           double out[3])
{
    gathering g = {.r = r, .lobe = lobe};
    bake_source_turn(r->source, d, g.d);
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int k = 0; k < 3; k++)
        g.d[k] /= length;
    double texel = pi / fmin(r->source->panorama.height, 0.5 * r->source->panorama.width);
    double parts = ceil(texel / lobe->lobe.width);
    g.parts = parts < 32.0 ? (uint32_t)parts : 32;
    g.from = -1.0;
    g.to = NEAR * texel;
    g.close = CLOSE * texel;
    if (lobe->lobe.kind == FACET_LOBE_CHARLIE) { /* the ring with 8 times its width */
        g.close = 0.0;
        g.from = 0.5 * pi - 8.0 * lobe->lobe.width - texel;
        g.to = 0.5 * pi + texel;
    }
    gather_rows(&g);
    for (int k = 0; k < 3; k++)
        out[k] = (double)r->source->scale * g.sum[k] / g.weight;
}

/* ---- texels of sharp levels ---- */

/* Adds the radiance at (u, v), in texels from the corner, nearest or bilinear. */
static void look_up(const bake_reference *r, bool is_interpolated, double u, double v, double weight,
                    double sum[3])
{
    size_t width = r->source->panorama.width;
    size_t height = r->source->panorama.height;
    double x = is_interpolated ? u - 0.5 : floor(u);
    double y = is_interpolated ? fmin(fmax(v - 0.5, 0.0), (double)height - 1.0) : floor(v);
    for (int k = 0; k < 4; k++) {
        double fx = floor(x) + (k & 1);
        double fy = floor(y) + (k >> 1);
        double w = weight * (1.0 - fabs(x - fx)) * (1.0 - fabs(y - fy));
        size_t column = (size_t)(fx < 0.0 ? fx + (double)width : fx) % width;
        size_t row = fy < (double)height ? (size_t)fy : height - 1;
        for (size_t j = 0; j < 3 && w > 0.0; j++)
            sum[j] += w * (double)r->planes[(3 * row + j) * r->stride + column];
    }
}

void bake_reference_average(const bake_reference *r, bool is_interpolated, uint32_t size, uint32_t face,
                            uint32_t x, uint32_t y, double out[3])
{
    const image *panorama = &r->source->panorama;
    uint32_t across = panorama->height / (2 * size) + 1; /* texels of the panorama */
    uint32_t points = across < 8 ? 64 : across < 32 ? 8 * across : 256;
    double whole = 0.0;
    out[0] = out[1] = out[2] = 0.0;
    for (uint32_t i = 0; i < points * points; i++) {
        double s = 2.0 * (x + (i % points + 0.5) / points) / size - 1.0;
        double t = 2.0 * (y + (i / points + 0.5) / points) / size - 1.0;
        double r2 = 1.0 + s * s + t * t;
        double w = 1.0 / (r2 * sqrt(r2));
        double d[3], e[3];
        cube_direction(face, s, t, d);
        bake_source_turn(r->source, d, e);
        double u = (atan2(e[2], e[0]) / (2.0 * pi) + 0.5) * panorama->width;
        double v = acos(e[1] / sqrt(r2)) / pi * panorama->height;
        look_up(r, is_interpolated, u, v, w, out);
        whole += w;
    }
    for (int k = 0; k < 3; k++)
        out[k] *= (double)r->source->scale / whole;
}

/* ---- cube maps ---- */

typedef struct filling {
    const bake_reference *reference;
    bake_reference_lobe lobe;
    bake_watch *watch;
    cube *out;
} filling;

static void fill_texels(void *context, size_t begin, size_t end)
{
    const filling *job = context;
    uint32_t size = job->out->size;
    const image *panorama = &job->reference->source->panorama;
    for (size_t i = begin; i < end; i++) {
        uint32_t face = (uint32_t)(i / size / size);
        uint32_t y = (uint32_t)(i / size % size);
        uint32_t x = (uint32_t)(i % size);
        double d[3], light[3];
        cube_direction(face, (2.0 * x + 1.0) / size - 1.0, (2.0 * y + 1.0) / size - 1.0, d);
        if (!bake_watch_add(job->watch, (double)panorama->width * panorama->height))
            return;
        bake_reference_gather(job->reference, &job->lobe, d, light);
        *cube_texel(job->out, face, (int)x, (int)y) =
            (rgbx){(float)light[0], (float)light[1], (float)light[2], 0.0f};
    }
}

void bake_reference_fill(const bake_reference *r, const bake_lobe *lobe, uint32_t thread_count,
                         bake_watch *watch, cube *out)
{
    filling job = {.reference = r, .watch = watch, .out = out};
    bake_reference_set_lobe(lobe, &job.lobe);
    parallel_for(thread_count, 6 * (size_t)out->size * out->size, 8, fill_texels, &job);
    cube_fill_borders(out);
}
