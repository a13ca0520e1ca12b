/* light_environment_grid.h - how a sampled environment lies in memory. For light_environment.c and
 * light_environment_build.c. */
#ifndef PATH_LIGHT_ENVIRONMENT_GRID_H
#define PATH_LIGHT_ENVIRONMENT_GRID_H

#include "ibl/equirect.h"

#include "path/light_environment.h"

enum { BANDS = LIGHT_ENVIRONMENT_BANDS, BLOCKS = LIGHT_ENVIRONMENT_BLOCKS, CELLS = LIGHT_ENVIRONMENT_CELLS };

/* The grid's points are the middles of texels, and in small pictures points between them; what is between four points is a
 * patch, in which radiance is bilinear. Patch (x, y) has points x and x + 1 of rows y - 1 and y; beyond the first and the last
 * row there is the pole, up to which radiance is that of the row. */
struct light_environment {
    const image *picture;
    float scale, rotation_cos, rotation_sin;
    uint32_t width, height; /* patches: as many columns as points, one row more */
    bool is_finer;          /* than the picture */
    uint32_t *columns;      /* per row, per block: ends of counts, in proportion to the patches' radiance */
    uint32_t *rows;         /* per block, per band: ends of counts, in proportion to the light of the rows */
    float *half_sine2; /* sin^2 (theta / 2) of the upper edges of rows, down to the one below the middle */
    float *per_sr;     /* 1 / solid angle of a patch, by row */
    /* By cell: sum of radiance times solid angle, and its mean direction, which is shorter the more it spreads; how far it
     * spreads, and the farthest that a direction of the cell is from the mean one, as sines. */
    float power[CELLS], mean_x[CELLS], mean_y[CELLS], mean_z[CELLS], spread[CELLS], reach[CELLS];
};

static inline uint32_t block_begin(const light_environment *e, uint32_t block)
{
    return (uint32_t)((uint64_t)e->width * block / BLOCKS);
}

static inline uint32_t band_begin(const light_environment *e, uint32_t band)
{
    return (uint32_t)((uint64_t)e->height * band / BANDS);
}

static inline float mean_of_channels(const float *texel)
{
    return (texel[0] + texel[1] + texel[2]) * (1.0f / 3.0f);
}

/* Mean of the channels at point x of row y, unscaled. */
static inline float radiance_at(const light_environment *e, uint32_t x, uint32_t y)
{
    const image *p = e->picture;
    if (!e->is_finer)
        return mean_of_channels((const float *)p->pixels + 3 * ((size_t)p->width * y + x));
    equirect_point point = {((float)x + 0.5f) / (float)e->width - 0.5f,
                            ((float)y + 0.5f) / (float)(e->height - 1)};
    rgbx c = equirect_fetch(p, point);
    return mean_of_channels((float[3]){c[0], c[1], c[2]});
}

#endif
