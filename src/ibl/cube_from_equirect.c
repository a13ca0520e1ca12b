/* cube_from_equirect.c - samples an environment picture into a cube map.
 *
 * A texel is the mean of samples_per_edge^2 bilinear lookups; where the picture has a light that outshines its
 * surroundings by far (equirect.tiles), of HOT_SAMPLES^2, so that a sun of one texel keeps its energy.
 * Where samples lie in the picture is worked out once for the four faces around the horizon, which differ by a
 * shift in u, and once for the upper and the lower face, which mirror each other. */
#include <math.h>

#include "base/parallel.h"
#include "ibl/cube.h"

enum {
    CHUNK_TEXELS = 32, /* worked on at a time */
    MAX_SAMPLES = 8,   /* along an edge of a texel */
    HOT_SAMPLES = 8,   /* the same, where there is a hot tile */
    SIDE_FACE_COUNT = 4
};

typedef struct sampling {
    const equirect *source;
    cube *out;
    uint32_t samples_per_edge;
} sampling;

/* The faces around the horizon and the u of their middle, in turns. */
static const struct {
    uint32_t face;
    float u;
} side_faces[SIDE_FACE_COUNT] = {{0, 0.5f}, {1, 1.0f}, {4, 0.75f}, {5, 0.25f}};

static float face_position(size_t i, uint32_t size, uint32_t sub, uint32_t samples)
{
    return ((float)i + ((float)sub + 0.5f) / (float)samples) * (2.0f / (float)size) - 1.0f;
}

/* Position in the picture, in texels, u relative to the middle of the face, of count samples at s on row t. */
static inline void locate_side(const equirect *e, const float *s, float t, uint32_t count, float *x, float *y)
{
    float x_scale = (float)e->width * 0.159154943f;
    float y_scale = (float)e->height * 0.318309886f;
    for (uint32_t i = 0; i < count; i++) {
        x[i] = -equirect_atan2(s[i], 1.0f) * x_scale;
        y[i] = equirect_atan2(sqrtf(1.0f + s[i] * s[i]), -t) * y_scale;
    }
}

/* The same for +Y; u is absolute. */
static inline void locate_top(const equirect *e, const float *s, float t, uint32_t count, float *x, float *y)
{
    float x_scale = (float)e->width * 0.159154943f;
    float y_scale = (float)e->height * 0.318309886f;
    for (uint32_t i = 0; i < count; i++) {
        x[i] = equirect_atan2(t, s[i]) * x_scale + 0.5f * (float)e->width;
        y[i] = equirect_atan2(sqrtf(s[i] * s[i] + t * t), 1.0f) * y_scale;
    }
}

static inline float wrap(float x, float width)
{
    x = x < 0.0f ? x + width : x;
    return x >= width ? x - width : x;
}

static bool is_hot(const equirect *e, float x, float y)
{
    uint32_t columns = (e->width + EQUIRECT_TILE - 1) / EQUIRECT_TILE;
    uint32_t rows = (e->height + EQUIRECT_TILE - 1) / EQUIRECT_TILE;
    uint32_t tile_x = (uint32_t)x / EQUIRECT_TILE;
    uint32_t tile_y = (uint32_t)y / EQUIRECT_TILE;
    tile_x = tile_x < columns ? tile_x : columns - 1;
    tile_y = tile_y < rows ? tile_y : rows - 1;
    return e->tiles[(size_t)tile_y * columns + tile_x] != 0;
}

/* The mean over texel (x, y) of the face of samples^2 lookups, each located by itself. */
static rgbx sample_hot(const sampling *job, uint32_t face, size_t x, size_t y)
{
    rgbx sum = {0};
    for (uint32_t j = 0; j < HOT_SAMPLES; j++)
        for (uint32_t i = 0; i < HOT_SAMPLES; i++) {
            double d[3];
            cube_direction(face, (double)face_position(x, job->out->size, i, HOT_SAMPLES),
                           (double)face_position(y, job->out->size, j, HOT_SAMPLES), d);
            float f[3] = {(float)d[0], (float)d[1], (float)d[2]};
            sum += equirect_lookup(job->source, f);
        }
    return sum * (1.0f / (HOT_SAMPLES * HOT_SAMPLES));
}

typedef struct chunk {
    uint32_t texel_count, sample_count; /* samples of a texel stand side by side */
    float x[MAX_SAMPLES][CHUNK_TEXELS * MAX_SAMPLES];
    float y[MAX_SAMPLES][CHUNK_TEXELS * MAX_SAMPLES];
} chunk;

/* Writes texels (x0 .., y) of a face. Samples are at (x + shift, y), or mirrored from pole to pole. */
static inline void sample_chunk(const sampling *job, const chunk *c, uint32_t face, size_t x0, size_t y,
                                float shift, bool is_mirrored)
{
    const equirect *e = job->source;
    uint32_t samples = job->samples_per_edge;
    float width = (float)e->width;
    float height = (float)e->height;
    rgbx *out = cube_texel(job->out, face, (int)x0, (int)y);
    float scale = 1.0f / (float)(samples * samples);
    for (uint32_t i = 0; i < c->texel_count; i++) {
        rgbx sum = {0};
        float u = 0.0f;
        float v = 0.0f;
        for (uint32_t b = 0; b < samples; b++)
            for (uint32_t a = 0; a < samples; a++) {
                u = wrap(c->x[b][i * samples + a] + shift, width);
                v = c->y[b][i * samples + a];
                v = is_mirrored ? height - v : v;
                sum += equirect_fetch(e, u, v);
            }
        out[i] = is_hot(e, u, v) ? sample_hot(job, face, x0 + i, y) : sum * scale;
    }
}

/* Rows y of all six faces. */
IBL_DISPATCH static void sample_rows(void *context, size_t begin, size_t end)
{
    const sampling *job = context;
    uint32_t size = job->out->size;
    uint32_t samples = job->samples_per_edge;
    float width = (float)job->source->width;
    for (size_t y = begin; y < end; y++)
        for (uint32_t x0 = 0; x0 < size; x0 += CHUNK_TEXELS) {
            chunk c; /* 16 KB, written as far as read */
            c.texel_count = size - x0 < CHUNK_TEXELS ? size - x0 : CHUNK_TEXELS;
            c.sample_count = c.texel_count * samples;
            float s[CHUNK_TEXELS * MAX_SAMPLES];
            for (uint32_t i = 0; i < c.sample_count; i++)
                s[i] = face_position(x0 + i / samples, size, i % samples, samples);

            for (uint32_t b = 0; b < samples; b++)
                locate_side(job->source, s, face_position(y, size, b, samples), c.sample_count, c.x[b],
                            c.y[b]);
            for (int f = 0; f < SIDE_FACE_COUNT; f++)
                sample_chunk(job, &c, side_faces[f].face, x0, y, side_faces[f].u * width, false);

            for (uint32_t b = 0; b < samples; b++)
                locate_top(job->source, s, face_position(y, size, b, samples), c.sample_count, c.x[b],
                           c.y[b]);
            sample_chunk(job, &c, 2, x0, y, 0.0f, false);
            sample_chunk(job, &c, 3, x0, size - 1 - y, 0.0f, true);
        }
}

facet_result cube_from_equirect(const equirect *e, uint32_t size, const facet_allocator *allocator,
                                uint32_t thread_count, cube *out, facet_error *error)
{
    facet_result result = cube_create(size, allocator, out, error);
    if (result != FACET_OK)
        return result;
    /* texels of the picture in one of the cube, in the middle of a face: two lookups to each are enough */
    double ratio = (double)e->width / (3.14159265358979 * size);
    uint32_t samples = (uint32_t)ceil(1.5 * ratio);
    sampling job = {e, out, samples < 1 ? 1 : samples > MAX_SAMPLES ? MAX_SAMPLES : samples};
    parallel_for(thread_count, size, 4, sample_rows, &job);
    cube_fill_borders(out);
    return FACET_OK;
}
