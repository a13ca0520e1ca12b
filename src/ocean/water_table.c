/* water_table.c - fills the LUT with integrals of the shader library. */
#include "ocean/water_table.h"

#include "base/parallel.h"
#include "shade/shade.h"

enum { POINTS = 40, SKY_POINTS = 64 };

_Static_assert(WATER_TABLE_WIDTH == WATER_TABLE_COLUMNS && WATER_TABLE_HEIGHT == WATER_TABLE_ROWS,
               "the sizes that the shaders have");

typedef struct filling {
    water_table *table;
    int normals, masking;
} filling;

static void fill_row(const filling *f, size_t row)
{
    for (int column = 0; column < WATER_TABLE_WIDTH; column++) {
        vec2 pair = water_table_pair(vec2((float)column, (float)row));
        WaterMeans m = integrate_water_means(f->normals, f->masking, pair[0], pair[1], f->table->ior, POINTS);
        float *texel = f->table->texels[row][column];
        texel[0] = m.fresnel;
        texel[1] = m.escape;
        texel[2] = m.lift;
        texel[3] = m.spread;
    }
}

static void fill_rows(void *context, size_t begin, size_t end)
{
    for (size_t row = begin; row < end; row++)
        fill_row(context, row);
}

void water_table_create(int normals, int masking, float ior, uint32_t thread_count, water_table *out)
{
    out->ior = ior;
    filling f = {out, normals, masking};
    parallel_for(thread_count, WATER_TABLE_HEIGHT, 1, fill_rows, &f);
}

void water_table_at(const water_table *t, float mu, float sigma, float out[4])
{
    vec2 place = water_table_place(mu, sigma);
    int x = (int)place[0], y = (int)place[1];
    x = x > WATER_TABLE_WIDTH - 2 ? WATER_TABLE_WIDTH - 2 : x;
    y = y > WATER_TABLE_HEIGHT - 2 ? WATER_TABLE_HEIGHT - 2 : y;
    float s = place[0] - (float)x, r = place[1] - (float)y;
    for (int c = 0; c < 4; c++)
        out[c] = mix(mix(t->texels[y][x][c], t->texels[y][x + 1][c], s),
                     mix(t->texels[y + 1][x][c], t->texels[y + 1][x + 1][c], s), r);
}

float water_table_fresnel(const water_table *t, float mu, float sigma)
{
    float texel[4];
    water_table_at(t, mu, sigma, texel);
    return texel[0] * F_dielectric(clamp(mu, 1e-4f, 1.0f), t->ior);
}

/* With mu = x^3, which is dense where F is steep. */
float water_table_sky_reflectance(const water_table *t, float sigma)
{
    float sum = 0.0f;
    for (int i = 0; i < SKY_POINTS; i++) {
        float x = ((float)i + 0.5f) / SKY_POINTS, mu = x * x * x;
        sum += 6.0f * mu * x * x * water_table_fresnel(t, mu, sigma);
    }
    return sum / SKY_POINTS;
}
