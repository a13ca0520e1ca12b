/* compare_flip.c - FLIP, see compare_metrics.h. Works on tiles: both images are filtered by the eye's
 * contrast sensitivity and by edge and point detectors, then compared. */
#include "compare/compare_metrics.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "base/simd.h"
#include "compare/compare_filter.h"
#include "compare/compare_math.h"

/* ---- color spaces and differences. Andersson et al. 2020, section 4.1 ---- */

/* YCxCz without its scale and offset, to which the filters are invariant: Y, X - Y, Y - Z, with XYZ relative
 * to white. */
typedef struct flip_opponent {
    float y, cx, cz;
} flip_opponent;

/* From linear sRGB, white D65; the rows of the matrix add up to 1. */
static inline __attribute__((always_inline)) flip_opponent flip_opponent_from_rgb(float r, float g, float b)
{
    float x = 0.433895389f * r + 0.376242373f * g + 0.189862239f * b;
    float y = 0.212636822f * r + 0.715182982f * g + 0.072180196f * b;
    float z = 0.017752423f * r + 0.109465629f * g + 0.872781948f * b;
    return (flip_opponent){y, x - y, y - z};
}

/* CIE L*a*b* with a* and b* times L* / 100: chroma counts for less in the dark (Hunt 1952). */
typedef struct flip_lab {
    float l, a, b;
} flip_lab;

static inline __attribute__((always_inline)) float flip_lab_curve(float t)
{
    float root = compare_pow(t, 1.0f / 3.0f);
    return compare_pick(t > 216.0f / 24389.0f, root, t * (841.0f / 108.0f) + 4.0f / 29.0f);
}

/* From the filtered color, clamped to the gamut of linear sRGB. */
static inline __attribute__((always_inline)) flip_lab flip_lab_from_opponent(flip_opponent o)
{
    float x = o.y + o.cx, z = o.y - o.cz;
    float r = compare_clamp(3.080341988f * x - 1.537398969f * o.y - 0.542943019f * z, 0.0f, 1.0f);
    float g = compare_clamp(-0.921178396f * x + 1.875929984f * o.y + 0.045248412f * z, 0.0f, 1.0f);
    float b = compare_clamp(0.052881293f * x - 0.204011206f * o.y + 1.151129913f * z, 0.0f, 1.0f);
    o = flip_opponent_from_rgb(r, g, b);
    float fx = flip_lab_curve(o.y + o.cx), fy = flip_lab_curve(o.y), fz = flip_lab_curve(o.y - o.cz);
    float l = 116.0f * fy - 16.0f, hunt = 0.01f * l;
    return (flip_lab){l, hunt * 500.0f * (fx - fy), hunt * 200.0f * (fy - fz)};
}

/* HyAB^0.7 of the most distant colors, green and blue: 203.30165^0.7. */
#define FLIP_LARGEST 41.2760984f

/* Color difference in [0, 1]: HyAB^0.7, of which the first 40 % map to [0, 0.95]. Equations 5 to 7. */
static inline __attribute__((always_inline)) float flip_color_difference(float dl, float da, float db)
{
    const float knee = 0.4f * FLIP_LARGEST;
    float hyab = fabsf(dl) + sqrtf(da * da + db * db);
    float power = compare_pow(hyab, 0.7f);
    float far_ = 0.95f + (power - knee) * (0.05f / (FLIP_LARGEST - knee));
    return compare_pick(power < knee, power * (0.95f / knee), far_);
}

/* The error from color and feature differences. Equations 10 to 12. */
static inline __attribute__((always_inline)) float flip_error(float color, float edges, float points)
{
    float feature = sqrtf(compare_pick(edges > points, edges, points) * 0.70710678f);
    return compare_pow(color, 1.0f - compare_clamp(feature, 0.0f, 1.0f));
}

/* Narkowicz's fit of ACES without its pre-exposure, of radiance times gain; in [0, 1]. Andersson et al. 2021,
 * section 4.1. */
static inline __attribute__((always_inline)) float flip_tonemap(float light, float gain)
{
    float x = compare_clamp(light * gain, 0.0f, 1e9f);
    float shown = (0.9036f * x + 0.018f) * x / ((0.8748f * x + 0.354f) * x + 0.14f);
    return compare_clamp(shown, 0.0f, 1.0f);
}
/* The radiance that it maps to 0.85: (0.9036 - 0.85 0.8748) x^2 + (0.018 - 0.85 0.354) x - 0.85 0.14 = 0. */
#define FLIP_BRIGHT 2.118872323987314

/* ---- filters ---- */

enum {
    FLIP_MAX_RADIUS = 136 /* at 1000 pixels per degree */
};

/* Half of a symmetric kernel: weights from the center to radius. */
typedef struct flip_kernel {
    int radius;
    float weights[FLIP_MAX_RADIUS + 1];
} flip_kernel;

typedef struct flip_kernels {
    int halo; /* the largest radius */
    /* Contrast sensitivity of the achromatic, red-green and blue-yellow channels, the last a sum of two
     * terms. All filters are separable: rows, then columns. */
    flip_kernel achromatic, red_green, blue_yellow[2];
    /* A Gaussian, its first derivative (odd: weights of the right half) and its second. */
    flip_kernel gaussian, first, second;
} flip_kernels;

#define PI 3.14159265358979323846

/* A term a sqrt(pi / b) exp(-pi^2 r^2 / b) of a filter, r in degrees: table 1 of the paper. */
typedef struct gauss_term {
    double a, b;
} gauss_term;
static const gauss_term achromatic = {1.0, 0.0047}, red_green = {1.0, 0.0053},
                        blue_yellow[2] = {{34.1, 0.04}, {13.5, 0.025}};
static const double widest = 0.04;         /* the largest b, which sets the radius of all kernels */
static const double feature_width = 0.082; /* degrees: peak to trough of the eye's edge detector */
static const double negligible = 1e-9;     /* weights below this share of a kernel's sum are cut off */

static double gauss(gauss_term t, double pixels_per_degree, int x)
{
    const double r = x / pixels_per_degree;
    return exp(-PI * PI * r * r / t.b);
}

/* Sum of the weights along one axis. */
static double row_sum(gauss_term t, double pixels_per_degree, int radius)
{
    double sum = 0.0;
    for (int x = -radius; x <= radius; x++)
        sum += gauss(t, pixels_per_degree, x);
    return sum;
}

/* The terms of a filter add up to 1 in two dimensions; the scale of each is split evenly between rows and
 * columns. */
static void make_sensitivity(const gauss_term *terms, int count, double pixels_per_degree, int radius,
                             flip_kernel *out)
{
    double total = 0.0, shares[2], sums[2];
    for (int k = 0; k < count; k++) {
        sums[k] = row_sum(terms[k], pixels_per_degree, radius);
        shares[k] = terms[k].a * sqrt(PI / terms[k].b) * sums[k] * sums[k];
        total += shares[k];
    }
    for (int k = 0; k < count; k++) {
        const double scale = sqrt(shares[k] / total) / sums[k];
        out[k].radius = 0;
        for (int x = 0; x <= radius; x++) {
            const double weight = gauss(terms[k], pixels_per_degree, x);
            if (weight >= negligible * sums[k])
                out[k].radius = x;
            out[k].weights[x] = (float)(scale * weight);
        }
    }
}

/* Positive weights add up to 1 and negative ones to -1 along one axis, hence in two dimensions as well. */
static void make_features(double pixels_per_degree, flip_kernels *out)
{
    const double sigma = 0.5 * feature_width * pixels_per_degree;
    const int radius = (int)ceil(3.0 * sigma);
    double sum = 0.0, slope = 0.0, positive = 0.0, negative = 0.0;
    for (int x = -radius; x <= radius; x++) {
        const double g = exp(-x * x / (2.0 * sigma * sigma)), curve = (x * x / (sigma * sigma) - 1.0) * g;
        sum += g;
        slope += x > 0 ? x * g : 0.0;
        positive += curve > 0.0 ? curve : 0.0;
        negative -= curve < 0.0 ? curve : 0.0;
    }
    out->gaussian.radius = out->first.radius = out->second.radius = radius;
    for (int x = 0; x <= radius; x++) {
        const double g = exp(-x * x / (2.0 * sigma * sigma)), curve = (x * x / (sigma * sigma) - 1.0) * g;
        out->gaussian.weights[x] = (float)(g / sum);
        out->first.weights[x] = (float)(x * g / slope);
        out->second.weights[x] = (float)(curve / (curve > 0.0 ? positive : negative));
    }
}

static void flip_kernels_make(double pixels_per_degree, flip_kernels *out)
{
    const int radius = (int)ceil(3.0 * sqrt(widest / (2.0 * PI * PI)) * pixels_per_degree);
    memset(out, 0, sizeof *out);
    make_sensitivity(&achromatic, 1, pixels_per_degree, radius, &out->achromatic);
    make_sensitivity(&red_green, 1, pixels_per_degree, radius, &out->red_green);
    make_sensitivity(blue_yellow, 2, pixels_per_degree, radius, out->blue_yellow);
    make_features(pixels_per_degree, out);
    out->halo = radius > out->first.radius ? radius : out->first.radius;
}

enum {
    MAX_EXPOSURES = 32,
    LINES = 7 /* results of filters along rows: see flip_filter_rows() */
};

typedef struct flip_sums {
    double sum;
    float largest;
} flip_sums;

typedef struct flip_job {
    const compare_source *source;
    flip_kernels kernels;
    size_t stride, rows; /* of planes, including the margins */
    bool is_hdr, has_opacity;
    uint32_t exposure_count;
    float gains[MAX_EXPOSURES];
    const facet_allocator *allocator;
    float *map; /* NULL: not wanted */
    flip_sums *tiles;
    atomic_bool has_no_memory;
} flip_job;

/* What the filters make of a tile: perceived colors, strength of edges and points. */
typedef struct flip_view {
    float l[TILE_HEIGHT][TILE_WIDTH], a[TILE_HEIGHT][TILE_WIDTH], b[TILE_HEIGHT][TILE_WIDTH];
    float edges[TILE_HEIGHT][TILE_WIDTH], points[TILE_HEIGHT][TILE_WIDTH];
} flip_view;

/* Scratch memory for a tile. */
typedef struct flip_work {
    float *light[2][3];  /* of both images, stride x rows */
    float *opponent[3];  /* y, cx, cz of one of them */
    float *lines[LINES]; /* TILE_WIDTH x rows */
    float *opacity[2];   /* opacities of a row, not used */
    unsigned char *flags;
    flip_view views[2];
    float errors[TILE_HEIGHT][TILE_WIDTH];
    float memory[]; /* the planes */
} flip_work;

static flip_work *create_work(const flip_job *job)
{
    const size_t plane = job->stride * job->rows, line = TILE_WIDTH * job->rows;
    const size_t floats = 9 * plane + LINES * line + 2 * job->stride;
    flip_work *w = mem_alloc(job->allocator, 1, sizeof *w + floats * sizeof(float) + plane);
    if (!w)
        return NULL;
    float *next = w->memory;
    for (int k = 0; k < 3; k++) {
        w->light[0][k] = next;
        w->light[1][k] = next + plane;
        w->opponent[k] = next + 2 * plane;
        next += 3 * plane;
    }
    for (int k = 0; k < LINES; k++, next += line)
        w->lines[k] = next;
    for (int k = 0; k < 2; k++, next += job->stride)
        w->opacity[k] = next;
    w->flags = (unsigned char *)next;
    /* lanes behind the last pixel are read but not used */
    for (size_t i = 0; i < floats; i++)
        w->memory[i] = 0.0f;
    return w;
}

/* ---- stages ---- */

static void load_tile(const flip_job *job, const compare_tile *t, const float *background, flip_work *w)
{
    const int halo = job->kernels.halo;
    const uint32_t width = t->width + 2 * (uint32_t)halo;
    for (size_t row = 0; row < t->height + 2 * (size_t)halo; row++) {
        const size_t at = row * job->stride;
        compare_row out = {.flags = w->flags + at};
        for (int k = 0; k < 3; k++) {
            out.a[k] = w->light[0][k] + at;
            out.b[k] = w->light[1][k] + at;
        }
        out.a[3] = w->opacity[0];
        out.b[3] = w->opacity[1];
        compare_source_load(job->source, COMPARE_LIGHT, background, (int64_t)t->x - halo,
                            (int64_t)t->y + (int64_t)row - halo, width, &out);
    }
}

static inline __attribute__((always_inline)) void
opponent_row(const float *restrict red, const float *restrict green, const float *restrict blue, bool is_hdr,
             float gain, uint32_t count, float *restrict y, float *restrict cx, float *restrict cz)
{
    for (uint32_t i = 0; i < count; i++) {
        float r = red[i], g = green[i], b = blue[i];
        if (is_hdr) { /* a constant at each call site */
            r = flip_tonemap(r, gain);
            g = flip_tonemap(g, gain);
            b = flip_tonemap(b, gain);
        }
        flip_opponent o = flip_opponent_from_rgb(r, g, b);
        y[i] = o.y;
        cx[i] = o.cx;
        cz[i] = o.cz;
    }
}

/* Opponent colors of one image, tone-mapped at an exposure if it is linear. */
DISPATCH_AVX2 static void flip_fill_opponent(const flip_job *job, flip_work *w, int side, float gain,
                                             uint32_t width, size_t height)
{
    float *const *light = w->light[side], *const *to = w->opponent;
    for (size_t row = 0; row < height; row++) {
        const size_t at = row * job->stride;
        if (job->is_hdr)
            opponent_row(light[0] + at, light[1] + at, light[2] + at, true, gain, width, to[0] + at,
                         to[1] + at, to[2] + at);
        else
            opponent_row(light[0] + at, light[1] + at, light[2] + at, false, gain, width, to[0] + at,
                         to[1] + at, to[2] + at);
    }
}

/* Along rows: contrast sensitivity of the opponent channels, feature detectors of Y. */
DISPATCH_AVX2 static void flip_filter_rows(const flip_job *job, flip_work *w, uint32_t width, size_t height)
{
    const flip_kernels *k = &job->kernels;
    for (size_t row = 0; row < height; row++) {
        const size_t from = row * job->stride + (size_t)k->halo, to = row * TILE_WIDTH;
        const float *y = w->opponent[0] + from, *cx = w->opponent[1] + from, *cz = w->opponent[2] + from;
        filter_line(y, 1, k->achromatic.weights, k->achromatic.radius, false, w->lines[0] + to, width);
        filter_line(cx, 1, k->red_green.weights, k->red_green.radius, false, w->lines[1] + to, width);
        for (int term = 0; term < 2; term++)
            filter_line(cz, 1, k->blue_yellow[term].weights, k->blue_yellow[term].radius, false,
                        w->lines[2 + term] + to, width);
        filter_line(y, 1, k->gaussian.weights, k->gaussian.radius, false, w->lines[4] + to, width);
        filter_line(y, 1, k->first.weights, k->first.radius, true, w->lines[5] + to, width);
        filter_line(y, 1, k->second.weights, k->second.radius, false, w->lines[6] + to, width);
    }
}

static inline __attribute__((always_inline)) void along_column(const float *line, const flip_kernel *kernel,
                                                               bool is_odd, float *out, uint32_t width)
{
    filter_line(line, TILE_WIDTH, kernel->weights, kernel->radius, is_odd, out, width);
}

/* Along columns, for one row of results: Lab colors with the Hunt effect, strength of edges and points. */
DISPATCH_AVX2 static void flip_filter_columns(const flip_job *job, const flip_work *w, uint32_t row,
                                              uint32_t width, flip_view *view)
{
    const flip_kernels *k = &job->kernels;
    const size_t at = (row + (size_t)k->halo) * TILE_WIDTH;
    float y[TILE_WIDTH], cx[TILE_WIDTH], cz[2][TILE_WIDTH], slope[2][TILE_WIDTH], curve[2][TILE_WIDTH];
    along_column(w->lines[0] + at, &k->achromatic, false, y, width);
    along_column(w->lines[1] + at, &k->red_green, false, cx, width);
    along_column(w->lines[2] + at, &k->blue_yellow[0], false, cz[0], width);
    along_column(w->lines[3] + at, &k->blue_yellow[1], false, cz[1], width);
    along_column(w->lines[5] + at, &k->gaussian, false, slope[0], width);
    along_column(w->lines[4] + at, &k->first, true, slope[1], width);
    along_column(w->lines[6] + at, &k->gaussian, false, curve[0], width);
    along_column(w->lines[4] + at, &k->second, false, curve[1], width);
    for (uint32_t i = 0; i < width; i++) {
        flip_lab lab = flip_lab_from_opponent((flip_opponent){y[i], cx[i], cz[0][i] + cz[1][i]});
        view->l[row][i] = lab.l;
        view->a[row][i] = lab.a;
        view->b[row][i] = lab.b;
        view->edges[row][i] = sqrtf(slope[0][i] * slope[0][i] + slope[1][i] * slope[1][i]);
        view->points[row][i] = sqrtf(curve[0][i] * curve[0][i] + curve[1][i] * curve[1][i]);
    }
}

/* Raises the errors of a row to those between the two views. */
DISPATCH_AVX2 static void flip_combine(flip_work *w, uint32_t row, uint32_t width)
{
    const flip_view *a = &w->views[0], *b = &w->views[1];
    for (uint32_t i = 0; i < width; i++) {
        float color = flip_color_difference(a->l[row][i] - b->l[row][i], a->a[row][i] - b->a[row][i],
                                            a->b[row][i] - b->b[row][i]);
        float error = flip_error(color, fabsf(a->edges[row][i] - b->edges[row][i]),
                                 fabsf(a->points[row][i] - b->points[row][i]));
        w->errors[row][i] = compare_pick(error > w->errors[row][i], error, w->errors[row][i]);
    }
}

/* ---- tiles ---- */

static void compare_at(const flip_job *job, const compare_tile *t, float gain, flip_work *w)
{
    const uint32_t width = t->width + 2 * (uint32_t)job->kernels.halo;
    const size_t height = t->height + 2 * (size_t)job->kernels.halo;
    for (int side = 0; side < 2; side++) {
        flip_fill_opponent(job, w, side, gain, width, height);
        flip_filter_rows(job, w, t->width, height);
        for (uint32_t row = 0; row < t->height; row++)
            flip_filter_columns(job, w, row, t->width, &w->views[side]);
    }
    for (uint32_t row = 0; row < t->height; row++)
        flip_combine(w, row, t->width);
}

static void finish_tile(const flip_job *job, const compare_tile *t, const flip_work *w, flip_sums *sums)
{
    const size_t halo = (size_t)job->kernels.halo;
    for (uint32_t row = 0; row < t->height; row++)
        for (uint32_t i = 0; i < t->width; i++) {
            const unsigned flags = w->flags[(row + halo) * job->stride + halo + i];
            const bool counts = flags & COMPARE_COUNTS;
            const float error = flags & COMPARE_INVALID ? 1.0f : counts ? w->errors[row][i] : 0.0f;
            sums->sum += (double)error;
            sums->largest = error > sums->largest ? error : sums->largest;
            if (job->map)
                job->map[(size_t)(t->y + row) * job->source->width + t->x + i] = error;
        }
}

static void flip_tiles(void *context, size_t begin, size_t end)
{
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    flip_job *job = context;
    flip_work *w = create_work(job);
    if (!w) {
        atomic_store(&job->has_no_memory, true);
        return;
    }
    for (size_t i = begin; i < end; i++) {
        const compare_tile t = compare_tile_at(job->source, i);
        for (uint32_t row = 0; row < t.height; row++)
            for (uint32_t x = 0; x < t.width; x++)
                w->errors[row][x] = 0.0f;
        for (int background = 0; background < (job->has_opacity ? 2 : 1); background++) {
            load_tile(job, &t, background ? white : NULL, w);
            for (uint32_t e = 0; e < job->exposure_count; e++)
                compare_at(job, &t, job->gains[e], w);
        }
        job->tiles[i] = (flip_sums){0};
        finish_tile(job, &t, w, &job->tiles[i]);
    }
    mem_free(w);
}

/* ---- exposures ---- */

/* Median and largest luminance. If at least half of the pixels are black, the median is that of the others. */
static facet_result find_levels(const float *luminance, size_t count, const facet_allocator *allocator,
                                double levels[2], facet_error *error)
{
    double all = 0.0, black = 0.0;
    for (size_t i = 0; i < count; i++) {
        all += luminance[i] >= 0.0f;
        black += luminance[i] >= 0.0f && luminance[i] <= 0.0f;
    }
    double shares[2] = {50.0, 100.0};
    if (black >= 0.5 * all && black < all)
        shares[0] = 50.0 * (all + black) / all;
    return compare_select(luminance, count, shares, 2, allocator, levels, error);
}

/* From the shortest exposure, at which nothing saturates, to the longest, at which half of the image does.
 * Andersson et al. 2021, section 4.2. */
static facet_result choose_exposures(flip_job *job, const facet_compare_desc *desc, const float *luminance,
                                     facet_comparison *out, facet_error *error)
{
    const size_t count = (size_t)job->source->width * job->source->height;
    double levels[2]; /* median, largest */
    TRY(find_levels(luminance, count, &desc->allocator, levels, error));
    double start = 0.0, stop = 0.0;
    if (levels[1] > 0.0) {
        start = log2(FLIP_BRIGHT / levels[1]);
        stop = log2(FLIP_BRIGHT / levels[0]);
        stop = stop < start + MAX_EXPOSURES ? stop : start + MAX_EXPOSURES;
    }
    const double steps = ceil(stop - start);
    job->exposure_count = steps < 2.0 ? 2 : (uint32_t)steps;
    for (uint32_t e = 0; e < job->exposure_count; e++)
        job->gains[e] = (float)exp2(start + (stop - start) * e / (job->exposure_count - 1));
    out->flip_start_ev = start;
    out->flip_stop_ev = stop;
    out->flip_exposure_count = job->exposure_count;
    return FACET_OK;
}

/* ---- images ---- */

facet_result compare_flip_make(const compare_source *s, const facet_compare_desc *desc,
                               const float *luminance, float *map, facet_comparison *out, facet_error *error)
{
    const size_t tile_count = compare_tile_count(s);
    flip_job job = {.source = s,
                    .is_hdr = !s->is_display,
                    .has_opacity = out->channel_count == 4,
                    .exposure_count = 1,
                    .gains = {1.0f},
                    .allocator = &desc->allocator,
                    .map = map};
    flip_kernels_make(desc->pixels_per_degree > 0.0f ? (double)desc->pixels_per_degree : 67.0, &job.kernels);
    job.stride = (TILE_WIDTH + 2 * (size_t)job.kernels.halo + 31) / 32 * 32 + 32;
    job.rows = TILE_HEIGHT + 2 * (size_t)job.kernels.halo;
    if (job.is_hdr) {
        facet_result result = choose_exposures(&job, desc, luminance, out, error);
        if (result != FACET_OK)
            return result;
    }
    job.tiles = mem_alloc(&desc->allocator, tile_count, sizeof *job.tiles);
    if (!job.tiles)
        return fail_memory(error, "sums of tiles", tile_count * sizeof *job.tiles);
    parallel_for(desc->thread_count, tile_count, TILE_GRAIN, flip_tiles, &job);
    flip_sums sums = {0};
    for (size_t i = 0; i < tile_count; i++) {
        sums.sum += job.tiles[i].sum;
        sums.largest = job.tiles[i].largest > sums.largest ? job.tiles[i].largest : sums.largest;
    }
    mem_free(job.tiles);
    if (atomic_load(&job.has_no_memory))
        return fail_memory(error, "tile", sizeof(flip_work));
    out->flip = sums.sum / (double)out->pixel_count;
    out->flip_max = (double)sums.largest;
    out->is_flip_hdr = job.is_hdr;
    return FACET_OK;
}
