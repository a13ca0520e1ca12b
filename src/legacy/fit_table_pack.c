/* fit_table_pack.c - the packed form of fit_table.h, in integers: the same bits on every machine. */
#include <stdint.h>
#include <string.h>

#include "legacy/fit_table.h"

/* The arrays of a fit_table, one after another. */
typedef struct plane {
    int width, height;
} plane;

enum { ORDER = 3 };

static const plane planes[] = {
    {3, 1},      {GRAM_R, 1}, {GRAM_R, 1}, {GRAM_R, 1}, {GRAM_R, 1}, {GRAM_R, 1},      {GRAM_R, 1},
    {GRAM_S, 1}, {GRAM_S, 1}, {GRAM_S, 1}, {GRAM_S, 1}, {GRAM_S, 1}, {GRAM_S, GRAM_R}, {GRAM_S, GRAM_R},
};

/* What neighbors before (x, y) predict. Multiples of 2^-30, which values below 2^20 are rounded to. */
static float predict(const float *at, int width, int x, int y)
{
    /* rows of Pascal's triangle with alternating signs: differences of each order */
    static const int steps[ORDER + 1][ORDER + 1] = {{1}, {1, -1}, {1, -2, 1}, {1, -3, 3, -1}};
    static const double unit = 1 << 30;
    const int nx = x < ORDER ? x : ORDER, ny = y < ORDER ? y : ORDER;
    int64_t sum = 0;
    for (int j = 0; j <= ny; j++)
        for (int i = j == 0; i <= nx; i++)
            sum -= (int64_t)((double)*(at - (j * width + i)) * unit) * (steps[ny][j] * steps[nx][i]);
    return (float)((double)sum / unit);
}

/* Neighboring floats are neighboring integers. */
static int32_t order_of(float x)
{
    int32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits < 0 ? -(bits & INT32_MAX) : bits;
}

static float float_of(int32_t order)
{
    const int32_t bits = order < 0 ? -order | INT32_MIN : order;
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static void put_difference(FILE *file, int32_t d)
{
    uint32_t code = d < 0 ? 2u * (uint32_t)-d - 1u : 2u * (uint32_t)d;
    for (; code >= 128; code >>= 7)
        fprintf(file, "%u,", (code & 127u) | 128u);
    fprintf(file, "%u,", code);
}

static int32_t take_difference(const unsigned char **at)
{
    uint32_t code = 0, byte = 128;
    for (uint32_t shift = 0; byte >= 128; shift += 7) {
        byte = *(*at)++;
        code |= (byte & 127u) << shift;
    }
    return (int32_t)(code >> 1) ^ -(int32_t)(code & 1);
}

void fit_table_write(FILE *file, const fit_table *table)
{
    const float *at = table->nn;
    for (size_t p = 0; p < sizeof planes / sizeof *planes; p++) {
        for (int i = 0; i < planes[p].width * planes[p].height; i++, at++)
            put_difference(file, order_of(*at) - order_of(predict(at, planes[p].width, i % planes[p].width,
                                                                  i / planes[p].width)));
        fprintf(file, "\n");
    }
}

void fit_table_read(const unsigned char *packed, fit_table *table)
{
    float *at = table->nn;
    for (size_t p = 0; p < sizeof planes / sizeof *planes; p++)
        for (int i = 0; i < planes[p].width * planes[p].height; i++, at++)
            *at = float_of(order_of(predict(at, planes[p].width, i % planes[p].width, i / planes[p].width)) +
                           take_difference(&packed));
}
