/* sphere.c - see sphere.h. */
#include "ibl/sphere.h"

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

static inline rgbx cut_off(rgbx c, float limit)
{
    return (rgbx){c[0] < limit ? c[0] : limit, c[1] < limit ? c[1] : limit, c[2] < limit ? c[2] : limit,
                  0.0f};
}

static inline rgbx interpolate(rgbx a, rgbx b, rgbx c, rgbx d, float wx, float wy, float limit)
{
    a = cut_off(a, limit);
    c = cut_off(c, limit);
    rgbx top = a + (cut_off(b, limit) - a) * wx;
    rgbx bottom = c + (cut_off(d, limit) - c) * wx;
    return top + (bottom - top) * wy;
}

static rgbx lookup_cube(const cube *c, const float d[3], float limit)
{
    cube_point p = cube_locate(d[0], d[1], d[2]);
    float half = 0.5f * (float)c->size;
    float x = p.s * half + (half + 0.5f); /* in the bordered face */
    float y = p.t * half + (half + 0.5f);
    int x0 = (int)x;
    int y0 = (int)y;
    const rgbx *a = cube_texel(c, p.face, x0 - 1, y0 - 1);
    const rgbx *b = a + c->size + 2;
    return interpolate(a[0], a[1], b[0], b[1], x - (float)x0, y - (float)y0, limit);
}

static rgbx lookup_equirect(const sphere *s, const float d[3], float limit)
{
    equirect_point p = equirect_locate(d);
    float width = (float)s->width;
    float x = p.turns * width + (0.5f * width - 0.5f);
    float y = p.half_turns * (float)s->height - 0.5f;
    x = x < 0.0f ? x + width : x;
    y = y < 0.0f ? 0.0f : y > (float)s->height - 1.0f ? (float)s->height - 1.0f : y;
    uint32_t x0 = (uint32_t)x;
    uint32_t y0 = (uint32_t)y;
    float wx = x - (float)x0;
    float wy = y - (float)y0;
    x0 = x0 < s->width ? x0 : s->width - 1; /* rounded up */
    uint32_t x1 = x0 + 1 < s->width ? x0 + 1 : 0;
    size_t row0 = (size_t)s->width * y0;
    size_t row1 = y0 + 1 < s->height ? row0 + s->width : row0;
    return interpolate(picture_texel(s, row0 + x0), picture_texel(s, row0 + x1), picture_texel(s, row1 + x0),
                       picture_texel(s, row1 + x1), wx, wy, limit);
}

static rgbx lookup_octahedron(const sphere *s, const float d[3], float limit)
{
    float uv[2];
    octahedron_locate(d, uv);
    float half = 0.5f * (float)s->width;
    float x = uv[0] * half + (half + 0.5f); /* one more than the texel's column */
    float y = uv[1] * half + (half + 0.5f);
    int x0 = (int)x;
    int y0 = (int)y;
    rgbx texels[4];
    for (int i = 0; i < 4; i++)
        texels[i] = picture_texel(s, octahedron_texel(s->width, x0 - 1 + (i & 1), y0 - 1 + (i >> 1)));
    return interpolate(texels[0], texels[1], texels[2], texels[3], x - (float)x0, y - (float)y0, limit);
}

rgbx sphere_lookup(const sphere *s, const float d[3], float limit)
{
    return s->kind == SPHERE_CUBE       ? lookup_cube(s->cube, d, limit)
           : s->kind == SPHERE_EQUIRECT ? lookup_equirect(s, d, limit)
                                        : lookup_octahedron(s, d, limit);
}
