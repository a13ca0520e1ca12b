/* packed_table.h - tables of smooth functions, stored in few bytes that gzip and brotli make fewer still, without loss.
 *
 * A value is a decimal, mantissa / 10^decimals, as "%.6e" writes it. It is predicted from its neighbors that come before it, as
 * the polynomial through them continues, and only the difference of the mantissas is stored. The packed bytes are
 *     per row: the orders of the polynomial along x, y and z (x + 4 y + 16 z; at most 3 each), which the writer chose;
 *     runs of equal decimals: the number, then the count;
 *     per value: the difference d as 2 d or -2 d - 1.
 * Counts and differences are little-endian groups of seven bits. Rows come channel by channel, layer by layer. */
#ifndef BASE_PACKED_TABLE_H
#define BASE_PACKED_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Value (channel, x, y, z) is at ((z height + y) width + x) channels + channel. */
typedef struct packed_shape {
    uint32_t channels, width, height, depth;
} packed_shape;

/* packed: of packed_table_write(), for the same shape. */
void packed_table_read(const unsigned char *packed, packed_shape shape, float *values);

/* For generators: writes the bytes of an initializer. texts: each value as "%.6e" wrote it, or as an integer below 10^7, and
 * not negative. The values that packed_table_read() returns are those that a C compiler reads. False: they are not. */
bool packed_table_write(FILE *file, packed_shape shape, char (*texts)[16]);

/* ---- for both ---- */

enum { PACKED_ORDERS = 4, PACKED_DECIMALS = 48 };

/* Orders along x, y and z of a row's predictor. */
typedef struct packed_orders {
    uint32_t x, y, z;
} packed_orders;

/* The value that the neighbors before (x, y, z) predict; orders are reduced where there are fewer of them. at: the value's place. */
float packed_table_predict(const float *at, packed_shape shape, packed_orders orders, uint32_t x, uint32_t y,
                           uint32_t z);

/* 10^decimals, by multiplication: the same bits on every machine. */
double packed_table_power(uint32_t decimals);

/* The mantissa that a prediction stands for. */
int32_t packed_table_mantissa(float prediction, double power);

#endif
