/* sphere.c - see sphere.h. */
#include "ibl/sphere.h"

sphere sphere_of_cube(cube *c)
{
    return (sphere){.kind = SPHERE_CUBE, .width = c->size, .height = c->size, .cube = c};
}

sphere sphere_of_image(sphere_kind kind, const image *panorama)
{
    return (sphere){.kind = kind,
                    .width = panorama->width,
                    .height = panorama->height,
                    .pixels = panorama->pixels,
                    .channel_count = panorama->channel_count};
}

static inline rgbx image_texel(const sphere *s, size_t texel)
{
    return equirect_texel(s->pixels + texel * s->channel_count);
}

rgbx sphere_texel(const sphere *s, size_t texel)
{
    if (s->kind != SPHERE_CUBE)
        return image_texel(s, texel);
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
    uint32_t parts = 2 + 2 * (512 / size); /* even, so that folds go through corners */
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

/* Bilinear footprint: column and row of the first of four texels, which may be -1, and the weights of the
 * second ones. */
typedef struct between {
    int face, x, y;
    float wx, wy;
} between;

/* Footprint of position (u, v), both in [-1, 1], on a face. */
static inline between find_between(float width, float height, int face, float u, float v)
{
    float x = 0.5f * width * (u + 1.0f) + 0.5f; /* one more than the column, and positive */
    float y = 0.5f * height * (v + 1.0f) + 0.5f;
    int x1 = (int)x;
    int y1 = (int)y;
    return (between){face, x1 - 1, y1 - 1, x - (float)x1, y - (float)y1};
}

/* cube_locate() without branches, for loops that vectorise. */
static inline between find_in_cube(float size, float x, float y, float z)
{
    float ax = fabsf(x), ay = fabsf(y), az = fabsf(z);
    int is_x = (ax >= ay) & (ax >= az);
    int is_y = !is_x & (ay >= az);
    float major = is_x ? x : is_y ? y : z;
    float u = is_x ? -z : x; /* of the positive face */
    float v = is_y ? z : -y;
    int is_negative = major < 0.0f;
    float q = 1.0f / fabsf(major);
    u = (is_negative & !is_y) ? -u : u;
    v = (is_negative & is_y) ? -v : v;
    int face = (is_x ? 0 : is_y ? 2 : 4) + is_negative;
    return find_between(size, size, face, u * q, v * q);
}

static inline between find_in_image(const sphere *s, float x, float y, float z)
{
    const float d[3] = {x, y, z};
    float uv[2];
    if (s->kind == SPHERE_OCTAHEDRON) {
        octahedron_locate(d, uv);
    } else {
        equirect_point p = equirect_locate(d);
        uv[0] = 2.0f * p.turns;
        uv[1] = 2.0f * p.half_turns - 1.0f;
    }
    return find_between((float)s->width, (float)s->height, 0, uv[0], uv[1]);
}

/* Index of the texel at column x in [-1, width], row y in [-1, height] of an image: columns wrap around, rows
 * are clamped at the poles. */
static size_t wrap(const sphere *s, int x, int y)
{
    if (s->kind == SPHERE_OCTAHEDRON)
        return octahedron_texel(s->width, x, y);
    int width = (int)s->width, height = (int)s->height;
    x = x < 0 ? width - 1 : x < width ? x : 0;
    y = y < 0 ? 0 : y < height ? y : height - 1;
    return (size_t)y * s->width + (size_t)x;
}

static inline rgbx interpolate(const rgbx c[4], float wx, float wy)
{
    rgbx top = c[0] + (c[1] - c[0]) * wx;
    rgbx bottom = c[2] + (c[3] - c[2]) * wx;
    return top + (bottom - top) * wy;
}

typedef int32_t rgbx_mask __attribute__((vector_size(16)));

typedef int64_t rgbx_halves __attribute__((vector_size(16)));

/* Clamps four texels to limit, whose fourth lane is infinite; true if any was above. */
static inline bool cut_off(rgbx c[4], rgbx limit)
{
    const rgbx_halves is_above =
        (rgbx_halves)((c[0] > limit) | (c[1] > limit) | (c[2] > limit) | (c[3] > limit));
    if (!(is_above[0] | is_above[1]))
        return false;
    for (int i = 0; i < 4; i++) {
        rgbx_mask m = c[i] > limit;
        c[i] = (rgbx)((m & (rgbx_mask)limit) | (~m & (rgbx_mask)c[i]));
    }
    return true;
}

/* Bilinear lookups of a batch. */
typedef struct places {
    int face[SPHERE_BATCH], x[SPHERE_BATCH], y[SPHERE_BATCH];
    float wx[SPHERE_BATCH], wy[SPHERE_BATCH];
} places;

DISPATCH_AVX2 static void sphere_find_places(float size, const sphere_batch *batch, uint32_t count, places *p)
{
    for (uint32_t i = 0; i < count; i++) {
        between b = find_in_cube(size, batch->x[i], batch->y[i], batch->z[i]);
        p->face[i] = b.face;
        p->x[i] = b.x;
        p->y[i] = b.y;
        p->wx[i] = b.wx;
        p->wy[i] = b.wy;
    }
}

DISPATCH_AVX2 static void sphere_look_up_places(const sphere *s, const places *p, uint32_t count,
                                                bool is_limited, const float limits[4], sphere_batch *batch)
{
    const int last = (int)s->width - 1;
    const size_t pitch = s->width + 2;
    const rgbx *const first = cube_texel(s->cube, 0, 0, 0);
    const rgbx limit = {limits[0], limits[1], limits[2], limits[3]};
    for (uint32_t i = 0; i < count; i++) {
        const int x = p->x[i], y = p->y[i];
        const rgbx *row = first + ((ptrdiff_t)((size_t)p->face[i] * pitch) + y) * (ptrdiff_t)pitch + x;
        const rgbx *next = row + pitch;
        rgbx c[4] = {row[0], row[1], next[0], next[1]};
        /* the border's corner is a mean, which may be below the limit although one of the three texels is not */
        batch->is_cut[i] =
            is_limited && (cut_off(c, limit) | (((x < 0) | (x == last)) & ((y < 0) | (y == last))));
        batch->radiance[i] = interpolate(c, p->wx[i], p->wy[i]);
    }
}

static void look_up_cube(const sphere *s, sphere_batch *batch, uint32_t count, float limit)
{
    places p;
    sphere_find_places((float)s->width, batch, count, &p);
    sphere_look_up_places(s, &p, count, limit < INFINITY, (const float[4]){limit, limit, limit, INFINITY},
                          batch);
}

static void look_up_image(const sphere *s, sphere_batch *batch, uint32_t count, rgbx limit)
{
    for (uint32_t i = 0; i < count; i++) {
        between b = find_in_image(s, batch->x[i], batch->y[i], batch->z[i]);
        rgbx c[4];
        for (int k = 0; k < 4; k++)
            c[k] = image_texel(s, wrap(s, b.x + (k & 1), b.y + (k >> 1)));
        batch->is_cut[i] = cut_off(c, limit);
        batch->radiance[i] = interpolate(c, b.wx, b.wy);
    }
}

void sphere_look_up(const sphere *s, sphere_batch *batch, uint32_t count, float limit)
{
    const rgbx limits = {limit, limit, limit, INFINITY};
    if (s->kind == SPHERE_CUBE)
        look_up_cube(s, batch, count, limit);
    else
        look_up_image(s, batch, count, limits);
}

/* ---- footprints ---- */

static void add_texel(sphere_footprint *f, size_t texel, float weight)
{
    f->texels[f->count] = texel;
    f->weights[f->count++] = weight;
}

/* Index of the texel of a cube at (x, y) of a face or across one of its edges. */
static size_t across(const sphere *s, uint32_t face, int x, int y)
{
    int last = (int)s->width - 1;
    if (x >= 0 && x <= last && y >= 0 && y <= last)
        return ((size_t)face * s->height + (size_t)y) * s->width + (size_t)x;
    double step = 2.0 / s->width, outside = 1.0 + 0.125 * step;
    double u = x < 0 ? -outside : x > last ? outside : (x + 0.5) * step - 1.0;
    double v = y < 0 ? -outside : y > last ? outside : (y + 0.5) * step - 1.0;
    double p[3];
    cube_direction(face, u, v, p);
    const float d[3] = {(float)p[0], (float)p[1], (float)p[2]};
    return sphere_locate(s, d);
}

/* Adds a texel of a face or its border as cube_fill_borders() defines it: a mean of three at corners. */
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
    between b = s->kind == SPHERE_CUBE ? find_in_cube((float)s->width, d[0], d[1], d[2])
                                       : find_in_image(s, d[0], d[1], d[2]);
    out->count = 0;
    for (int i = 0; i < 4; i++) {
        int x = b.x + (i & 1), y = b.y + (i >> 1);
        float weight = (i & 1 ? b.wx : 1.0f - b.wx) * (i >> 1 ? b.wy : 1.0f - b.wy);
        if (s->kind == SPHERE_CUBE)
            add_bordered(s, (uint32_t)b.face, x, y, weight, out);
        else
            add_texel(out, wrap(s, x, y), weight);
    }
}
