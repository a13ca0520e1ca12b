/* equirect.c - see equirect.h. */
#include "ibl/equirect.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

static const double pi = 3.14159265358979323846;

double equirect_texel_solid_angle(uint32_t width, uint32_t height, uint32_t y)
{
    /* cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2): no cancellation at the poles */
    return 2.0 * pi / width * 2.0 * sin(pi * (y + 0.5) / height) * sin(0.5 * pi / height);
}

void equirect_direction(uint32_t width, uint32_t height, double x, double y, float d[3])
{
    double phi = 2.0 * pi * ((x + 0.5) / width - 0.5);
    double theta = pi * (y + 0.5) / height;
    d[0] = (float)(sin(theta) * cos(phi));
    d[1] = (float)cos(theta);
    d[2] = (float)(sin(theta) * sin(phi));
}

void equirect_lookup(const image *panorama, const float d[3], float out[3])
{
    rgbx c = equirect_fetch(panorama, equirect_locate(d));
    for (int i = 0; i < 3; i++)
        out[i] = c[i];
}

typedef struct averaging {
    const image *panorama;
    double (*rows)[3]; /* sums */
} averaging;

enum { SUM_SPAN = 32 }; /* texels that are summed in float */

DISPATCH_AVX2 static void average_rows(void *context, size_t begin, size_t end)
{
    const averaging *job = context;
    size_t count = 3 * (size_t)job->panorama->width;
    for (size_t y = begin; y < end; y++) {
        const float *row = (const float *)job->panorama->pixels + y * count;
        double *sum = job->rows[y];
        sum[0] = sum[1] = sum[2] = 0.0;
        size_t i = 0;
        for (; i + 3 * SUM_SPAN <= count; i += 3 * SUM_SPAN) {
            float lanes[24] = {0};
            for (size_t j = 0; j < 3 * SUM_SPAN; j += 24)
                for (size_t k = 0; k < 24; k++)
                    lanes[k] += row[i + j + k];
            for (int k = 0; k < 24; k++)
                sum[k % 3] += (double)lanes[k];
        }
        for (; i < count; i++)
            sum[i % 3] += (double)row[i];
    }
}

facet_result equirect_mean(const image *panorama, const facet_allocator *allocator, uint32_t thread_count,
                           double mean[3], facet_error *error)
{
    averaging job = {panorama, mem_alloc(allocator, panorama->height, sizeof *job.rows)};
    if (!job.rows)
        return fail_memory(error, "environment", panorama->height * sizeof *job.rows);
    parallel_for(thread_count, panorama->height, 16, average_rows, &job);
    mean[0] = mean[1] = mean[2] = 0.0;
    for (uint32_t y = 0; y < panorama->height; y++)
        for (int k = 0; k < 3; k++)
            mean[k] += job.rows[y][k] * equirect_texel_solid_angle(panorama->width, panorama->height, y);
    for (int k = 0; k < 3; k++)
        mean[k] /= 4.0 * pi;
    mem_free(job.rows);
    return FACET_OK;
}

/* ---- resampling ---- */

/* The input samples of an output sample and their weights. */
typedef struct equirect_span {
    uint32_t first, count; /* samples first .. first + count - 1, wrapped at the end of the axis */
    size_t weight;         /* index of the first weight; they add up to 1 */
} equirect_span;

/* Measure of the axis between a and b, in samples of in: length, or for latitudes the height of the zone on
 * the unit sphere. */
static double axis_measure(double a, double b, uint32_t in, bool is_latitude)
{
    return is_latitude ? cos(pi * a / in) - cos(pi * b / in) : b - a;
}

static bool axis_create(uint32_t in, uint32_t out, bool is_latitude, bool is_smooth,
                        const facet_allocator *allocator, equirect_axis *axis)
{
    double step = (double)in / out;
    size_t taps = (size_t)ceil(step) + 2;
    axis->spans = mem_alloc(allocator, out, sizeof *axis->spans);
    axis->weights = mem_alloc(allocator, out, taps * sizeof *axis->weights);
    if (!axis->spans || !axis->weights)
        return false;
    for (uint32_t o = 0; o < out; o++) {
        equirect_span *span = &axis->spans[o];
        float *w = axis->weights + o * taps;
        span->weight = o * taps;
        if (in < out && is_smooth) { /* between the two nearest */
            double x = (o + 0.5) * step - 0.5;
            double x0 = floor(x);
            bool is_at_pole = is_latitude && (x0 < 0.0 || x0 + 1.0 >= in);
            span->first = x0 >= 0.0 ? (uint32_t)x0 : is_latitude ? 0 : in - 1;
            span->count = is_at_pole ? 1 : 2;
            w[0] = is_at_pole ? 1.0f : (float)(1.0 - (x - x0));
            w[1] = (float)(x - x0);
            continue;
        }
        double a = (double)o * in / out; /* integers stay exact */
        double b = (double)(o + 1) * in / out;
        double whole = axis_measure(a, b, in, is_latitude);
        span->first = (uint32_t)a;
        span->count = (uint32_t)ceil(b) - span->first;
        for (uint32_t k = 0; k < span->count; k++) {
            double from = fmax(a, span->first + k);
            double to = fmin(b, span->first + k + 1.0);
            w[k] = (float)(axis_measure(from, to, in, is_latitude) / whole);
        }
    }
    return true;
}

static void axis_destroy(equirect_axis *axis)
{
    mem_free(axis->spans);
    mem_free(axis->weights);
}

bool equirect_view_create(const image *panorama, uint32_t width, uint32_t height, bool is_smooth,
                          const facet_allocator *allocator, equirect_view *view)
{
    *view = (equirect_view){.panorama = panorama, .width = width, .height = height, .is_smooth = is_smooth};
    if (axis_create(panorama->width, width, false, is_smooth, allocator, &view->columns) &&
        axis_create(panorama->height, height, true, is_smooth, allocator, &view->rows))
        return true;
    equirect_view_destroy(view);
    return false;
}

void equirect_view_destroy(equirect_view *view)
{
    axis_destroy(&view->columns);
    axis_destroy(&view->rows);
    *view = (equirect_view){0};
}

/* Adds resampled columns x0 .. x0 + count - 1 of a row, times weight, to out. */
static inline void add_row(const equirect_view *view, uint32_t y, uint32_t x0, uint32_t count, float weight,
                           rgbx *out)
{
    uint32_t in_width = view->panorama->width;
    const float *row = (const float *)view->panorama->pixels + (size_t)y * in_width * 3;
    if (in_width == view->width) { /* the common cases need no table */
        const float *p = row + 3 * (size_t)x0;
        for (uint32_t x = 0; x < count; x++, p += 3)
            out[x] += (rgbx){p[0], p[1], p[2], 0.0f} * weight;
        return;
    }
    if (in_width == 2 * view->width) {
        const float *p = row + 6 * (size_t)x0;
        for (uint32_t x = 0; x < count; x++, p += 6)
            out[x] += (rgbx){p[0] + p[3], p[1] + p[4], p[2] + p[5], 0.0f} * (0.5f * weight);
        return;
    }
    for (uint32_t x = 0; x < count; x++) {
        equirect_span span = view->columns.spans[x0 + x];
        const float *w = view->columns.weights + span.weight;
        rgbx sum = {0};
        for (uint32_t k = 0; k < span.count; k++) {
            uint32_t i = span.first + k;
            const float *p = row + 3 * (size_t)(i < in_width ? i : i - in_width);
            sum += (rgbx){p[0], p[1], p[2], 0.0f} * w[k];
        }
        out[x] += sum * weight;
    }
}

void equirect_view_texels(const equirect_view *view, uint32_t y, uint32_t x0, uint32_t count, rgbx *out)
{
    equirect_span span = view->rows.spans[y];
    memset(out, 0, count * sizeof *out);
    for (uint32_t k = 0; k < span.count; k++)
        add_row(view, span.first + k, x0, count, view->rows.weights[span.weight + k], out);
}

typedef struct resizing {
    const equirect_view *view;
    image *out;
} resizing;

enum { CHUNK = 256 }; /* texels on the stack */

static void resize_rows(void *context, size_t begin, size_t end)
{
    const resizing *r = context;
    uint32_t width = r->out->width;
    for (size_t y = begin; y < end; y++)
        for (uint32_t x0 = 0; x0 < width; x0 += CHUNK) {
            rgbx texels[CHUNK];
            uint32_t count = width - x0 < CHUNK ? width - x0 : CHUNK;
            equirect_view_texels(r->view, (uint32_t)y, x0, count, texels);
            float *out = (float *)r->out->pixels + 3 * (y * width + x0);
            for (uint32_t x = 0; x < count; x++, out += 3) {
                out[0] = texels[x][0];
                out[1] = texels[x][1];
                out[2] = texels[x][2];
            }
        }
}

facet_result equirect_resize(const image *panorama, uint32_t width, uint32_t height,
                             const facet_allocator *allocator, uint32_t thread_count, image *out,
                             facet_error *error)
{
    *out = (image){0};
    equirect_view view;
    if (!equirect_view_create(panorama, width, height, true, allocator, &view))
        return fail_memory(error, "environment", (size_t)width * sizeof(float));
    facet_result result = image_create(allocator, width, height, 3, IMAGE_F32, out, error);
    if (result == FACET_OK) {
        resizing r = {&view, out};
        parallel_for(thread_count, height, 8, resize_rows, &r);
    }
    equirect_view_destroy(&view);
    return result;
}
