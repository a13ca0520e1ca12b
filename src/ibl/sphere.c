/* sphere.c - see sphere.h. */
#include "ibl/sphere.h"

#include <string.h>

sphere sphere_of_cube(cube *c)
{
    return (sphere){.kind = SPHERE_CUBE, .width = c->size, .height = c->size, .cube = c};
}

sphere sphere_of_picture(sphere_kind kind, const image *picture)
{
    return (sphere){.kind = kind,
                    .width = picture->width,
                    .height = picture->height,
                    .pixels = picture->pixels,
                    .channel_count = picture->channel_count};
}

static inline rgbx picture_texel(const sphere *s, size_t texel)
{
    return equirect_texel(s->pixels + texel * s->channel_count);
}

rgbx sphere_texel(const sphere *s, size_t texel)
{
    if (s->kind != SPHERE_CUBE)
        return picture_texel(s, texel);
    size_t row = texel / s->width;
    return *cube_texel(s->cube, (uint32_t)(row / s->height), (int)(texel % s->width), (int)(row % s->height));
}

void sphere_direction(const sphere *s, size_t texel, float d[3])
{
    uint32_t x = (uint32_t)(texel % s->width);
    uint32_t y = (uint32_t)(texel / s->width % s->height);
    double u = (2.0 * x + 1.0) / s->width - 1.0;
    double v = (2.0 * y + 1.0) / s->height - 1.0;
    if (s->kind == SPHERE_CUBE) {
        double p[3];
        cube_direction((uint32_t)(texel / s->width / s->height), u, v, p);
        for (int i = 0; i < 3; i++)
            d[i] = (float)p[i];
    } else if (s->kind == SPHERE_EQUIRECT) {
        equirect_direction(s->width, s->height, x, y, d);
    } else {
        octahedron_direction((float)u, (float)v, d);
    }
}

static double octahedron_texel_solid_angle(uint32_t size, uint32_t x, uint32_t y)
{
    uint32_t parts = 2 + 2 * (512 / size); /* even: then folds go through corners */
    double step = 2.0 / size / parts;
    double sum = 0.0;
    for (uint32_t i = 0; i < parts * parts; i++)
        sum += (double)octahedron_solid_angle((float)(2.0 * x / size - 1.0 + (i % parts + 0.5) * step),
                                              (float)(2.0 * y / size - 1.0 + (i / parts + 0.5) * step),
                                              (float)step);
    return sum;
}

double sphere_solid_angle(const sphere *s, size_t texel)
{
    uint32_t x = (uint32_t)(texel % s->width);
    uint32_t y = (uint32_t)(texel / s->width % s->height);
    if (s->kind == SPHERE_CUBE)
        return cube_texel_solid_angle(s->width, x, y);
    if (s->kind == SPHERE_EQUIRECT)
        return equirect_texel_solid_angle(s->width, s->height, y);
    return octahedron_texel_solid_angle(s->width, x, y);
}

/* ---- lookup ---- */

/* Where a lookup is between texels: the first of four by column and row, which may be -1, and weights of the second. */
typedef struct between {
    uint32_t face;
    int x, y;
    float wx, wy;
} between;

static between find_between(const sphere *s, const float d[3])
{
    float x, y;
    between b = {0};
    if (s->kind == SPHERE_CUBE) {
        cube_point p = cube_locate(d[0], d[1], d[2]);
        b.face = p.face;
        x = p.s;
        y = p.t;
    } else if (s->kind == SPHERE_OCTAHEDRON) {
        float uv[2];
        octahedron_locate(d, uv);
        x = uv[0];
        y = uv[1];
    } else {
        equirect_point p = equirect_locate(d);
        x = 2.0f * p.turns;
        y = 2.0f * p.half_turns - 1.0f;
    }
    x = 0.5f * (float)s->width * (x + 1.0f) + 0.5f; /* one more than the column, and positive */
    y = 0.5f * (float)s->height * (y + 1.0f) + 0.5f;
    b.x = (int)x;
    b.y = (int)y;
    b.wx = x - (float)b.x;
    b.wy = y - (float)b.y;
    b.x--;
    b.y--;
    return b;
}

/* The texel at column x in [-1, width], row y in [-1, height] of a picture: around the circle, at the pole the last row. */
static size_t wrap(const sphere *s, int x, int y)
{
    if (s->kind == SPHERE_OCTAHEDRON)
        return octahedron_texel(s->width, x, y);
    int width = (int)s->width, height = (int)s->height;
    x = x < 0 ? width - 1 : x < width ? x : 0;
    y = y < 0 ? 0 : y < height ? y : height - 1;
    return (size_t)y * s->width + (size_t)x;
}

static inline rgbx cut_off(rgbx c, float limit, bool *is_cut)
{
    *is_cut |= c[0] > limit || c[1] > limit || c[2] > limit;
    return (rgbx){c[0] < limit ? c[0] : limit, c[1] < limit ? c[1] : limit, c[2] < limit ? c[2] : limit,
                  0.0f};
}

rgbx sphere_lookup(const sphere *s, const float d[3], float limit, bool *is_cut)
{
    between b = find_between(s, d);
    rgbx c[4];
    *is_cut = false;
    if (s->kind == SPHERE_CUBE) {
        int last = (int)s->width - 1;
        const rgbx *row = cube_texel(s->cube, b.face, b.x, b.y);
        memcpy(c, row, 2 * sizeof *c);
        memcpy(c + 2, row + s->width + 2, 2 * sizeof *c);
        /* the border's corner is a mean, which may be below the limit where one of three texels is not */
        *is_cut = (b.x < 0 || b.x == last) && (b.y < 0 || b.y == last);
    } else {
        for (int i = 0; i < 4; i++)
            c[i] = picture_texel(s, wrap(s, b.x + (i & 1), b.y + (i >> 1)));
    }
    for (int i = 0; i < 4; i++)
        c[i] = cut_off(c[i], limit, is_cut);
    rgbx top = c[0] + (c[1] - c[0]) * b.wx;
    rgbx bottom = c[2] + (c[3] - c[2]) * b.wx;
    return top + (bottom - top) * b.wy;
}

static void add_texel(sphere_footprint *f, size_t texel, float weight)
{
    f->texels[f->count] = texel;
    f->weights[f->count++] = weight;
}

/* The texel of a cube at (x, y) of a face or across one of its edges. */
static size_t across(const sphere *s, uint32_t face, int x, int y)
{
    int last = (int)s->width - 1;
    double step = 2.0 / s->width, outside = 1.0 + 0.125 * step;
    double u = x < 0 ? -outside : x > last ? outside : (x + 0.5) * step - 1.0;
    double v = y < 0 ? -outside : y > last ? outside : (y + 0.5) * step - 1.0;
    double p[3];
    cube_direction(face, u, v, p);
    const float d[3] = {(float)p[0], (float)p[1], (float)p[2]};
    return sphere_locate(s, d);
}

/* A texel of a face or its border, as cube_fill_borders() makes it: at a corner the mean of three. */
static void add_bordered(const sphere *s, uint32_t face, int x, int y, float weight, sphere_footprint *f)
{
    int last = (int)s->width - 1;
    if ((x >= 0 && x <= last) || (y >= 0 && y <= last)) {
        add_texel(f, across(s, face, x, y), weight);
        return;
    }
    int inner_x = x < 0 ? 0 : last;
    int inner_y = y < 0 ? 0 : last;
    add_texel(f, across(s, face, inner_x, inner_y), weight / 3.0f);
    add_texel(f, across(s, face, x, inner_y), weight / 3.0f);
    add_texel(f, across(s, face, inner_x, y), weight / 3.0f);
}

void sphere_find(const sphere *s, const float d[3], sphere_footprint *out)
{
    between b = find_between(s, d);
    out->count = 0;
    for (int i = 0; i < 4; i++) {
        int x = b.x + (i & 1), y = b.y + (i >> 1);
        float weight = (i & 1 ? b.wx : 1.0f - b.wx) * (i >> 1 ? b.wy : 1.0f - b.wy);
        if (s->kind == SPHERE_CUBE)
            add_bordered(s, b.face, x, y, weight, out);
        else
            add_texel(out, wrap(s, x, y), weight);
    }
}
