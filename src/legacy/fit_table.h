/* fit_table.h - integrals of the shapes of both models, computed when facet is built (fit_table_generate.c). For fit*.c only. */
#ifndef LEGACY_FIT_TABLE_H
#define LEGACY_FIT_TABLE_H

#include <stdio.h>

#include "legacy/fit_metric.h"

/* Products of shapes as in fit_closed.c, by the power of Schlick's weight: all but nn as logarithms. */
typedef struct fit_table {
    float nn[3];
    float nS[3][GRAM_R], SS[3][GRAM_R];
    float nP[2][GRAM_S], PP[GRAM_S];
    float nearest_r[GRAM_S],
        nearest_g[GRAM_S];        /* the lobe that is nearest to Blinn's: roughness and strength */
    float SP[2][GRAM_R * GRAM_S]; /* rows of roughness, columns of shininess */
} fit_table;

/* fit_table.c has the table as an array, fit_table_packed.c unpacks it. */
const fit_table *fit_table_get(void);

/* The table in a third of its bytes, without loss: each value is predicted as the cubic through its neighbors continues, and the
 * difference d is stored in units of the last place, as 2 d or -2 d - 1 in little-endian groups of seven bits. */
void fit_table_write(FILE *file, const fit_table *table); /* the bytes of an initializer */
void fit_table_read(const unsigned char *packed, fit_table *table);

#endif
