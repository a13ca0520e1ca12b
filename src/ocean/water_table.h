/* water_table.h - means over the facets of a rough sea that an eye sees (shade/water_means.h), for every direction and roughness. */
#ifndef OCEAN_WATER_TABLE_H
#define OCEAN_WATER_TABLE_H

#include <stdint.h>

enum { WATER_TABLE_WIDTH = 32, WATER_TABLE_HEIGHT = 16 };

/* Rows are sigma, columns N.V, at the places of water_table_place(); a texel is WaterMeans.fresnel, escape, lift, spread, linear in between. As it
 * stands in memory it is a texture RGBA32F of WATER_TABLE_WIDTH x WATER_TABLE_HEIGHT. */
typedef struct water_table {
    float texels[WATER_TABLE_HEIGHT][WATER_TABLE_WIDTH][4];
    float ior;
} water_table;

/* normals: WATER_BECKMANN or WATER_GGX; masking: WATER_SCALES or WATER_SMITH, which the others have, too; ior in (1, 2]. Takes some 50 ms of processor time. */
void water_table_create(int normals, int masking, float ior, uint32_t thread_count, water_table *out);

/* The texel of a cosine in [0, 1] and a root of slope variance along one axis. */
void water_table_at(const water_table *t, float mu, float sigma, float out[4]);

/* Mean reflectance of the sea seen at a cosine, what WaterLight.sun_fresnel is for that of the sun; and for light from all of the sky,
 * Water.sky_reflectance: 2 int F mu dmu. */
float water_table_fresnel(const water_table *t, float mu, float sigma);
float water_table_sky_reflectance(const water_table *t, float sigma);

#endif
