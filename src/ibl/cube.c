/* cube.c - see cube.h. */
#include "ibl/cube.h"

#include "base/memory.h"
#include "base/result.h"

facet_result cube_create(uint32_t size, const facet_allocator *allocator, cube *out, facet_error *error)
{
    size_t stride = (size_t)size + 2;
    *out = (cube){.size = size, .texels = mem_alloc(allocator, 6 * stride * stride, sizeof(rgbx))};
    if (out->texels)
        return FACET_OK;
    *out = (cube){0};
    return fail_memory(error, "cube map", 6 * stride * stride * sizeof(rgbx));
}

void cube_destroy(cube *c)
{
    mem_free(c->texels);
    *c = (cube){0};
}

void cube_direction(uint32_t face, double s, double t, double d[3])
{
    /* d = middle + s right + t down */
    static const signed char middle[6][3] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                             {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    static const signed char right[6][3] = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0},
                                            {1, 0, 0},  {1, 0, 0}, {-1, 0, 0}};
    static const signed char down[6][3] = {{0, -1, 0}, {0, -1, 0}, {0, 0, 1},
                                           {0, 0, -1}, {0, -1, 0}, {0, -1, 0}};
    for (int i = 0; i < 3; i++)
        d[i] = middle[face][i] + s * right[face][i] + t * down[face][i];
}

/* The texel nearest to (s, t), just outside of a face, on the adjacent face. */
static rgbx across(const cube *c, uint32_t face, double s, double t)
{
    double d[3];
    cube_direction(face, s, t, d);
    cube_point p = cube_locate((float)d[0], (float)d[1], (float)d[2]);
    int n = (int)c->size;
    int x = (int)(((double)p.s + 1.0) * 0.5 * n);
    int y = (int)(((double)p.t + 1.0) * 0.5 * n);
    return *cube_texel(c, p.face, x < n ? x : n - 1, y < n ? y : n - 1);
}

void cube_fill_borders(cube *c)
{
    int n = (int)c->size;
    double outside = 1.0 + 0.25 / n;
    for (uint32_t face = 0; face < 6; face++) {
        for (int i = 0; i < n; i++) {
            double along = (2.0 * i + 1.0) / n - 1.0;
            *cube_texel(c, face, -1, i) = across(c, face, -outside, along);
            *cube_texel(c, face, n, i) = across(c, face, outside, along);
            *cube_texel(c, face, i, -1) = across(c, face, along, -outside);
            *cube_texel(c, face, i, n) = across(c, face, along, outside);
        }
        /* Three texels meet at a corner. Their mean as the fourth makes the lookup at the corner that mean on
         * every face. */
        for (int corner = 0; corner < 4; corner++) {
            int x = corner & 1 ? n : -1;
            int y = corner & 2 ? n : -1;
            int inner_x = corner & 1 ? n - 1 : 0;
            int inner_y = corner & 2 ? n - 1 : 0;
            *cube_texel(c, face, x, y) =
                (*cube_texel(c, face, inner_x, inner_y) + *cube_texel(c, face, x, inner_y) +
                 *cube_texel(c, face, inner_x, y)) *
                (1.0f / 3.0f);
        }
    }
}

double cube_corner_angle(double s, double t)
{
    return atan2(s * t, sqrt(s * s + t * t + 1.0));
}

double cube_texel_solid_angle(uint32_t size, uint32_t x, uint32_t y)
{
    double step = 2.0 / size;
    double s0 = x * step - 1.0;
    double t0 = y * step - 1.0;
    double s1 = (x + 1) * step - 1.0;
    double t1 = (y + 1) * step - 1.0;
    return cube_corner_angle(s1, t1) - cube_corner_angle(s0, t1) - cube_corner_angle(s1, t0) +
           cube_corner_angle(s0, t0);
}

void cube_mean(const cube *c, double mean[3])
{
    double sum[3] = {0.0, 0.0, 0.0};
    double whole = 0.0;
    for (uint32_t y = 0; y < c->size; y++)
        for (uint32_t x = 0; x < c->size; x++) {
            double weight = cube_texel_solid_angle(c->size, x, y);
            whole += 6.0 * weight;
            for (uint32_t face = 0; face < 6; face++)
                for (int i = 0; i < 3; i++)
                    sum[i] += weight * (double)(*cube_texel(c, face, (int)x, (int)y))[i];
        }
    for (int i = 0; i < 3; i++)
        mean[i] = sum[i] / whole;
}
