/* water_table.h - LUT of means over the visible microfacets of a rough sea (shade/water_means.h), by
 * direction and roughness. */
#ifndef OCEAN_WATER_TABLE_H
#define OCEAN_WATER_TABLE_H

#include <stdint.h>

enum { WATER_TABLE_WIDTH = 32, WATER_TABLE_HEIGHT = 16 };

/* Rows are sigma, columns N.V, spaced by water_table_place(); a texel is WaterMeans.fresnel, escape, lift,
 * spread, interpolated linearly. In memory it is an RGBA32F texture of WATER_TABLE_WIDTH x
 * WATER_TABLE_HEIGHT. */
typedef struct water_table {
    float texels[WATER_TABLE_HEIGHT][WATER_TABLE_WIDTH][4];
    float ior;
} water_table;

/* normals: WATER_BECKMANN or WATER_GGX; masking: WATER_SCALES or WATER_SMITH, which also serves all
 * others; ior in (1, 2]. Takes about 50 ms of processor time. */
void water_table_create(int normals, int masking, float ior, uint32_t thread_count, water_table *out);

/* Lookup by cosine in [0, 1] and standard deviation of the slope along one axis. */
void water_table_at(const water_table *t, float mu, float sigma, float out[4]);

/* Mean reflectance of the sea at a cosine (for the sun's, WaterLight.sun_fresnel), and under a uniform sky:
 * Water.sky_reflectance = 2 int F mu dmu. */
float water_table_fresnel(const water_table *t, float mu, float sigma);
float water_table_sky_reflectance(const water_table *t, float sigma);

#endif
