/* packed_table.c - see packed_table.h. */
#include "base/packed_table.h"

static uint32_t lesser(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

float packed_table_predict(const float *at, packed_shape shape, packed_orders orders, uint32_t x, uint32_t y,
                           uint32_t z)
{
    /* rows of Pascal's triangle with alternating signs: differences of each order */
    static const float steps[PACKED_ORDERS][PACKED_ORDERS] = {{1}, {1, -1}, {1, -2, 1}, {1, -3, 3, -1}};
    const uint32_t nx = lesser(orders.x, x), ny = lesser(orders.y, y), nz = lesser(orders.z, z);
    const uint32_t row = shape.width * shape.channels, layer = row * shape.height;
    float sum = 0.0f;
    for (uint32_t k = 0; k <= nz; k++)
        for (uint32_t j = 0; j <= ny; j++)
            for (uint32_t i = k + j == 0; i <= nx; i++)
                sum -= steps[nz][k] * steps[ny][j] * steps[nx][i] *
                       *(at - (k * layer + j * row + i * shape.channels));
    return sum;
}

double packed_table_power(uint32_t decimals)
{
    double power = 1.0;
    while (decimals-- > 0)
        power *= 10.0;
    return power;
}

int32_t packed_table_mantissa(float prediction, double power)
{
    double scaled = (double)prediction * power + 0.5;
    return scaled > 0.0 && scaled < 1e7 ? (int32_t)scaled : 0;
}

static uint32_t read_number(const unsigned char **at)
{
    uint32_t value = 0;
    for (uint32_t shift = 0;; shift += 7) {
        unsigned char byte = *(*at)++;
        value |= (uint32_t)(byte & 127) << shift;
        if (byte < 128)
            return value;
    }
}

/* The places of the sections, and the run of equal decimals. */
typedef struct reader {
    const unsigned char *orders, *runs, *differences;
    uint32_t left;
    double power;
} reader;

static reader open_sections(const unsigned char *packed, packed_shape shape)
{
    const uint32_t rows = shape.channels * shape.depth * shape.height;
    reader r = {.orders = packed, .runs = packed + rows, .differences = packed + rows};
    for (uint32_t count = 0; count < rows * shape.width;) {
        r.differences++;
        count += read_number(&r.differences);
    }
    return r;
}

static float read_value(reader *r, float prediction)
{
    if (r->left == 0) {
        r->power = packed_table_power(*r->runs++);
        r->left = read_number(&r->runs);
    }
    r->left--;
    uint32_t code = read_number(&r->differences);
    int32_t difference = (int32_t)(code >> 1) ^ -(int32_t)(code & 1);
    return (float)((double)(packed_table_mantissa(prediction, r->power) + difference) / r->power);
}

void packed_table_read(const unsigned char *packed, packed_shape shape, float *values)
{
    reader r = open_sections(packed, shape);
    for (uint32_t c = 0; c < shape.channels; c++)
        for (uint32_t row = 0; row < shape.depth * shape.height; row++) {
            packed_orders orders = {*r.orders & 3u, *r.orders >> 2 & 3u, (uint32_t)(*r.orders >> 4)};
            r.orders++;
            for (uint32_t x = 0; x < shape.width; x++) {
                float *at = values + ((size_t)row * shape.width + x) * shape.channels + c;
                *at = read_value(
                    &r, packed_table_predict(at, shape, orders, x, row % shape.height, row / shape.height));
            }
        }
}
