/* merl.c - see merl.h. */
#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/result.h"
#include "plot/merl.h"

#define HALF_PI 1.57079632679489661923

struct merl {
    file_bytes file;
    const unsigned char *cells; /* doubles, at 12 bytes from the start: not aligned */
};

enum { HEADER_SIZE = 3 * 4, LARGEST_FILE = 1 << 26 }; /* the size of the format is 35 MB */

double merl_scale(int channel)
{
    static const double scale[3] = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};
    return scale[channel];
}

double merl_theta_h(double cell)
{
    double root = cell / MERL_THETA_H;
    return HALF_PI * root * root;
}

/* The inverse of merl_theta_h(). */
static double merl_cell_of_theta_h(double theta_h)
{
    return sqrt(fmax(theta_h, 0.0) / HALF_PI) * MERL_THETA_H;
}

/* ---- the file ---- */

/* Little-endian on any machine. */
static int32_t int_at(const unsigned char *b)
{
    uint32_t u = (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
    return (int32_t)u;
}
static double double_at(const unsigned char *b)
{
    uint64_t u = 0;
    for (int i = 0; i < 8; i++)
        u |= (uint64_t)b[i] << (8 * i);
    double x;
    memcpy(&x, &u, sizeof x);
    return x;
}

/* Value of a cell in 1/sr; NAN: not measured. */
static double cell_value(const merl *m, int channel, size_t index)
{
    double x = double_at(m->cells + ((size_t)channel * MERL_CELLS + index) * sizeof(double));
    return x >= 0.0 && x < HUGE_VAL ? x * merl_scale(channel) : (double)NAN;
}

static facet_result check(const merl *m, const char *path, facet_error *error)
{
    const size_t expected = HEADER_SIZE + 3 * MERL_CELLS * sizeof(double);
    if (m->file.size < HEADER_SIZE)
        return fail(error, FACET_ERROR_INVALID,
                    "%s: %zu bytes are no measured BRDF; three dimensions and %zu values expected", path,
                    m->file.size, 3 * MERL_CELLS);
    int32_t size[3];
    for (int i = 0; i < 3; i++)
        size[i] = int_at(m->file.data + 4 * i);
    if (size[0] != MERL_THETA_H || size[1] != MERL_THETA_D || size[2] != MERL_PHI_D)
        return fail(
            error, FACET_ERROR_INVALID,
            "%s: a measured BRDF of %d x %d x %d cells; %d x %d x %d expected, as the MERL database has them",
            path, size[0], size[1], size[2], MERL_THETA_H, MERL_THETA_D, MERL_PHI_D);
    if (m->file.size != expected)
        return fail(error, FACET_ERROR_INVALID, "%s: %zu bytes; %zu expected for a measured BRDF", path,
                    m->file.size, expected);
    for (size_t i = 0; i < MERL_CELLS; i++)
        if (cell_value(m, 0, i) >= 0.0)
            return FACET_OK;
    return fail(error, FACET_ERROR_INVALID, "%s: no cell of the measured BRDF has a value of 0 or more",
                path);
}

facet_result merl_open(const char *path, const facet_allocator *allocator, merl **out, facet_error *error)
{
    *out = NULL;
    merl *m = mem_zalloc(allocator, 1, sizeof *m);
    if (!m)
        return fail_memory(error, "measured BRDF", sizeof *m);
    facet_result result = file_open(path, LARGEST_FILE, allocator, &m->file, error);
    if (result == FACET_OK) {
        m->cells = m->file.data + HEADER_SIZE;
        result = check(m, path, error);
    }
    if (result != FACET_OK) {
        merl_close(m);
        return result;
    }
    *out = m;
    return FACET_OK;
}

void merl_close(merl *m)
{
    if (!m)
        return;
    file_close(&m->file);
    mem_free(m);
}

/* ---- half and difference angles ---- */

static void turn(double a, double *x, double *y)
{
    double c = cos(a);
    double s = sin(a);
    double turned = c * *x - s * *y;
    *y = s * *x + c * *y;
    *x = turned;
}

void merl_directions(double theta_h, double theta_d, double phi_d, float V[3], float L[3])
{
    for (int i = 0; i < 2; i++) { /* L is at the difference angles from H, V opposite to it */
        double sign = i ? -1.0 : 1.0;
        double x = sign * sin(theta_d) * cos(phi_d);
        double y = sign * sin(theta_d) * sin(phi_d);
        double z = cos(theta_d);
        turn(theta_h, &z, &x); /* about y, from z towards x */
        float *out = i ? V : L;
        out[0] = (float)x;
        out[1] = (float)y;
        out[2] = (float)z;
    }
}

typedef struct half_angles {
    double theta_h, theta_d, phi_d; /* phi_d in [0, pi) by reciprocity */
} half_angles;

static half_angles half_angles_of(const float V[3], const float L[3])
{
    double h[3], d[3], length = 0.0;
    for (int i = 0; i < 3; i++) {
        h[i] = (double)V[i] + (double)L[i];
        d[i] = (double)L[i] - (double)V[i]; /* tangent at H, of length 2 sin theta_d */
        length += h[i] * h[i];
    }
    length = sqrt(length);
    double across = hypot(h[0], h[1]);
    half_angles a = {.theta_h = atan2(across, h[2]),
                     .theta_d = atan2(sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), length)};
    if (across > 0.0) { /* rotates H to z: about z into the plane of x, then about y */
        turn(-atan2(h[1], h[0]), &d[0], &d[1]);
        turn(-a.theta_h, &d[2], &d[0]);
    }
    a.phi_d = atan2(d[1], d[0]);
    if (a.phi_d < 0.0)
        a.phi_d += 2.0 * HALF_PI;
    return a;
}

/* ---- interpolation ---- */

/* The two cells whose centers enclose x, and the second one's weight. Ends are clamped; phi_d wraps. */
typedef struct neighbours {
    int cell[2];
    double weight;
} neighbours;
static neighbours around(double x, int count, bool is_round)
{
    double from_middle = x - 0.5;
    double low = floor(from_middle);
    neighbours n = {.weight = from_middle - low};
    for (int i = 0; i < 2; i++) {
        int cell = (int)low + i;
        if (is_round)
            cell = (cell + count) % count;
        n.cell[i] = cell < 0 ? 0 : cell >= count ? count - 1 : cell;
    }
    return n;
}

void merl_brdf(const merl *m, const float V[3], const float L[3], double out[3])
{
    half_angles a = half_angles_of(V, L);
    neighbours h = around(merl_cell_of_theta_h(a.theta_h), MERL_THETA_H, false);
    neighbours d = around(a.theta_d / HALF_PI * MERL_THETA_D, MERL_THETA_D, false);
    neighbours p = around(a.phi_d / (2.0 * HALF_PI) * MERL_PHI_D, MERL_PHI_D, true);
    for (int c = 0; c < 3; c++) {
        double sum = 0.0, weights = 0.0;
        for (int corner = 0; corner < 8; corner++) {
            int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
            size_t index =
                ((size_t)h.cell[i] * MERL_THETA_D + (size_t)d.cell[j]) * MERL_PHI_D + (size_t)p.cell[k];
            double w = (i ? h.weight : 1.0 - h.weight) * (j ? d.weight : 1.0 - d.weight) *
                       (k ? p.weight : 1.0 - p.weight);
            double value = cell_value(m, c, index);
            if (value >= 0.0 && w > 0.0) {
                sum += w * value;
                weights += w;
            }
        }
        out[c] = weights > 0.0 ? sum / weights : (double)NAN;
    }
}
