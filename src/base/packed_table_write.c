/* packed_table_write.c - the writer of packed_table.h, for generators that run when facet is built. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/packed_table.h"

typedef struct decimal {
    int32_t mantissa;
    uint32_t decimals;
} decimal;

typedef struct writer {
    packed_shape shape;
    decimal *decimals;
    float *values;
    int32_t *differences; /* of a row */
    FILE *file;
} writer;

static decimal decimal_of(const char *text)
{
    if (!strchr(text, 'e'))
        return (decimal){(int32_t)strtol(text, NULL, 10), 0};
    return (decimal){
        (int32_t)lround(strtod(text, NULL) * 1e6 / pow(10.0, strtod(strchr(text, 'e') + 1, NULL))),
        (uint32_t)(6 - strtol(strchr(text, 'e') + 1, NULL, 10))};
}

static size_t place_of(const writer *w, uint32_t c, uint32_t row, uint32_t x)
{
    return ((size_t)row * w->shape.width + x) * w->shape.channels + c;
}

/* Fills differences; returns about how many bits they need. */
static double measure(writer *w, packed_orders orders, uint32_t c, uint32_t row)
{
    double bits = 0.0;
    for (uint32_t x = 0; x < w->shape.width; x++) {
        size_t place = place_of(w, c, row, x);
        float prediction = packed_table_predict(w->values + place, w->shape, orders, x, row % w->shape.height,
                                                row / w->shape.height);
        const decimal *d = w->decimals + place;
        w->differences[x] = d->mantissa - packed_table_mantissa(prediction, packed_table_power(d->decimals));
        bits += log2(1.0 + 2.0 * fabs((double)w->differences[x]));
    }
    return bits;
}

static packed_orders best_orders(writer *w, uint32_t c, uint32_t row)
{
    packed_orders best = {0, 0, 0};
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < PACKED_ORDERS * PACKED_ORDERS * PACKED_ORDERS; i++) {
        packed_orders orders = {i & 3u, i >> 2 & 3u, i >> 4};
        if (orders.y > row % w->shape.height || orders.z > row / w->shape.height)
            continue; /* the same as a lower order */
        double bits = measure(w, orders, c, row);
        if (bits < least) {
            least = bits;
            best = orders;
        }
    }
    return best;
}

static void put_number(FILE *file, uint32_t value)
{
    for (; value >= 128; value >>= 7)
        fprintf(file, "%u,", (value & 127u) | 128u);
    fprintf(file, "%u,", value);
}

static void put_orders(writer *w, packed_orders *orders)
{
    const uint32_t rows = w->shape.depth * w->shape.height;
    for (uint32_t i = 0; i < w->shape.channels * rows; i++) {
        orders[i] = best_orders(w, i / rows, i % rows);
        fprintf(w->file, "%u,", orders[i].x + 4 * orders[i].y + 16 * orders[i].z);
    }
    fprintf(w->file, "\n");
}

static void put_runs(const writer *w)
{
    const uint32_t plane = w->shape.depth * w->shape.height * w->shape.width;
    const uint32_t count = plane * w->shape.channels;
    for (uint32_t i = 0, run = 1; i < count; i++, run++) {
        uint32_t decimals = w->decimals[i % plane * w->shape.channels + i / plane].decimals;
        uint32_t j = i + 1;
        if (j < count && w->decimals[j % plane * w->shape.channels + j / plane].decimals == decimals)
            continue;
        fprintf(w->file, "%u,", decimals);
        put_number(w->file, run);
        run = 0;
    }
    fprintf(w->file, "\n");
}

static void put_differences(writer *w, const packed_orders *orders)
{
    const uint32_t rows = w->shape.depth * w->shape.height;
    for (uint32_t i = 0; i < w->shape.channels * rows; i++) {
        measure(w, orders[i], i / rows, i % rows);
        for (uint32_t x = 0; x < w->shape.width; x++) {
            uint32_t twice = 2u * (uint32_t)abs(w->differences[x]);
            put_number(w->file, w->differences[x] < 0 ? twice - 1u : twice);
        }
        fprintf(w->file, "\n");
    }
}

/* Whether a value is read as the compiler reads its text. */
static bool set_values(writer *w, char (*texts)[16], size_t count)
{
    for (size_t i = 0; i < count; i++) {
        w->decimals[i] = decimal_of(texts[i]);
        w->values[i] = strtof(texts[i], NULL);
        const decimal *d = w->decimals + i;
        if (d->mantissa < 0 || d->mantissa >= 10000000 || d->decimals >= PACKED_DECIMALS ||
            (float)(d->mantissa / packed_table_power(d->decimals)) != w->values[i])
            return false;
    }
    return true;
}

bool packed_table_write(FILE *file, packed_shape shape, char (*texts)[16])
{
    const size_t rows = (size_t)shape.channels * shape.depth * shape.height;
    writer w = {.shape = shape, .file = file};
    w.decimals = malloc(rows * shape.width * sizeof *w.decimals);
    w.values = malloc(rows * shape.width * sizeof *w.values);
    w.differences = malloc(shape.width * sizeof *w.differences);
    packed_orders *orders = malloc(rows * sizeof *orders);
    bool is_exact =
        w.decimals && w.values && w.differences && orders && set_values(&w, texts, rows * shape.width);
    if (is_exact) {
        put_orders(&w, orders);
        put_runs(&w);
        put_differences(&w, orders);
    }
    free(w.decimals);
    free(w.values);
    free(w.differences);
    free(orders);
    return is_exact;
}
