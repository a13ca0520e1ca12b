/* ibl_sheet_draw.c - see ibl_sheet_draw.h. */
#include "report/ibl_sheet_draw.h"

#include <math.h>

#include "base/parallel.h"
#include "ibl/equirect.h"

/* ---- crosses ---- */

typedef struct cross_job {
    const sheet_canvas *canvas;
    sheet_place place;
    const cube *level;
} cross_job;

static void draw_cross_rows(void *context, size_t begin, size_t end)
{
    static const int faces[3][4] = {{-1, 2, -1, -1}, {1, 4, 0, 5}, {-1, 3, -1, -1}};
    enum { MAX_SAMPLES = 16 };
    const cross_job *job = context;
    const film *f = job->canvas->film;
    uint32_t edge = job->place.width / 4;
    /* as many samples as a pixel covers texels; one where a texel covers pixels */
    uint32_t samples = (job->level->size + edge - 1) / edge;
    samples = samples < MAX_SAMPLES ? samples : MAX_SAMPLES;
    for (size_t y = begin; y < end; y++)
        for (uint32_t x = 0; x < 4 * edge; x++) {
            int face = faces[y / edge][x / edge];
            if (face < 0)
                continue;
            rgbx sum = rgbx_splat(0.0f);
            for (uint32_t v = 0; v < samples; v++)
                for (uint32_t u = 0; u < samples; u++) {
                    float s = ((float)(x % edge) + ((float)u + 0.5f) / (float)samples) / (float)edge;
                    float t = ((float)(y % edge) + ((float)v + 0.5f) / (float)samples) / (float)edge;
                    sum += cube_fetch(job->level,
                                      (cube_point){(uint32_t)face, 2.0f * s - 1.0f, 2.0f * t - 1.0f});
                }
            sum *= job->canvas->scale / (float)(samples * samples);
            float *pixel = f->layers[0].pixels + 4 * ((job->place.y + y) * f->width + job->place.x + x);
            for (int c = 0; c < 3; c++)
                pixel[c] = sum[c];
            pixel[3] = 1.0f;
        }
}

void sheet_draw_cross(const sheet_canvas *canvas, sheet_place place, const cube *level)
{
    cross_job job = {canvas, place, level};
    parallel_for(canvas->thread_count, (size_t)place.width / 4 * 3, 4, draw_cross_rows, &job);
}

/* ---- spheres ---- */

/* Trilinear lookup at lod. */
static rgbx read_cube(const facet_cube *c, float lod, const float d[3])
{
    float last = (float)(c->level_count - 1);
    lod = lod < 0.0f ? 0.0f : lod > last ? last : lod;
    uint32_t level = (uint32_t)lod;
    float fraction = lod - (float)level;
    cube_point p = cube_locate(d[0], d[1], d[2]);
    rgbx a = cube_fetch(&c->levels[level], p);
    if (fraction == 0.0f)
        return a;
    return a + (cube_fetch(&c->levels[level + 1], p) - a) * fraction;
}

static rgbx light_along(const sheet_ball *b, const float d[3])
{
    const float e[3] = {d[0] * b->rotation_cos - d[2] * b->rotation_sin, d[1],
                        d[0] * b->rotation_sin + d[2] * b->rotation_cos};
    float out[3];
    if (b->kind == BALL_CUBE)
        return read_cube(b->cube_map, b->lod, d);
    if (b->kind == BALL_PICTURE)
        return equirect_fetch(b->picture, equirect_locate(e)) * b->environment_scale;
    sh_evaluate(b->harmonics, d, out);
    return (rgbx){out[0], out[1], out[2], 0.0f};
}

typedef struct ball_job {
    const sheet_ball *ball;
    uint32_t width;
    float *values;
} ball_job;

/* Distance from the center, 1 on the rim; u to the right, v up. */
static float ball_radius(uint32_t width, float x, float y, float *u, float *v)
{
    *u = 2.0f * x / (float)width - 1.0f;
    *v = 1.0f - 2.0f * y / (float)width;
    return sqrtf(*u * *u + *v * *v);
}

/* A pixel on the rim gets the light of the nearest point of the sphere. */
static void ball_direction(const sheet_ball *b, float u, float v, float radius, float d[3])
{
    const float most = 0.9999f;
    if (radius > most) {
        u *= most / radius;
        v *= most / radius;
    }
    float z = sqrtf(1.0f - u * u - v * v);
    d[0] = b->is_diffuse ? u : 2.0f * z * u; /* V = +Z: R = 2 (N.V) N - V */
    d[1] = b->is_diffuse ? v : 2.0f * z * v;
    d[2] = b->is_diffuse ? z : 2.0f * z * z - 1.0f;
}

static void shade_rows(void *context, size_t begin, size_t end)
{
    const ball_job *job = context;
    const sheet_ball *b = job->ball;
    uint32_t samples = b->samples ? b->samples : 1;
    float rim = 1.0f + 2.0f / (float)job->width;
    for (size_t y = begin; y < end; y++)
        for (uint32_t x = 0; x < job->width; x++) {
            float u, v, d[3];
            float *out = job->values + 3 * (y * job->width + x);
            out[0] = out[1] = out[2] = 0.0f;
            if (ball_radius(job->width, (float)x + 0.5f, (float)y + 0.5f, &u, &v) > rim)
                continue;
            rgbx sum = rgbx_splat(0.0f);
            for (uint32_t k = 0; k < samples * samples; k++) {
                float px = (float)x + ((float)(k % samples) + 0.5f) / (float)samples;
                float py = (float)y + ((float)(k / samples) + 0.5f) / (float)samples;
                float radius = ball_radius(job->width, px, py, &u, &v);
                ball_direction(b, u, v, radius, d);
                sum += light_along(b, d);
            }
            sum *= 1.0f / (float)(samples * samples);
            for (int c = 0; c < 3; c++)
                out[c] = sum[c];
        }
}

void sheet_shade_ball(const sheet_ball *ball, uint32_t width, uint32_t thread_count, float *values)
{
    ball_job job = {ball, width, values};
    parallel_for(thread_count, width, 2, shade_rows, &job);
}

void sheet_draw_ball(const sheet_canvas *canvas, sheet_place place, const float *values)
{
    const film *f = canvas->film;
    uint32_t width = place.width;
    for (uint32_t y = 0; y < width; y++)
        for (uint32_t x = 0; x < width; x++) {
            float u, v;
            float radius = ball_radius(width, (float)x + 0.5f, (float)y + 0.5f, &u, &v);
            float opacity = (1.0f - radius) * 0.5f * (float)width + 0.5f;
            opacity = opacity < 0.0f ? 0.0f : opacity > 1.0f ? 1.0f : opacity;
            const float *value = values + 3 * ((size_t)y * width + x);
            float *pixel = f->layers[0].pixels + 4 * ((size_t)(place.y + y) * f->width + place.x + x);
            for (int c = 0; c < 3; c++)
                pixel[c] = value[c] * canvas->scale * opacity;
            pixel[3] = opacity;
        }
}

double sheet_compare_balls(const float *values, const float *reference, uint32_t width)
{
    double difference = 0.0;
    double whole = 0.0;
    for (uint32_t y = 0; y < width; y++)
        for (uint32_t x = 0; x < width; x++) {
            float u, v;
            if (ball_radius(width, (float)x + 0.5f, (float)y + 0.5f, &u, &v) >= 1.0f)
                continue;
            size_t k = 3 * ((size_t)y * width + x);
            for (int c = 0; c < 3; c++) {
                double a = (double)values[k + (size_t)c];
                double b = (double)reference[k + (size_t)c];
                difference += (a - b) * (a - b);
                whole += b * b;
            }
        }
    return whole > 0.0 ? sqrt(difference / whole) : difference > 0.0 ? (double)INFINITY : 0.0;
}
