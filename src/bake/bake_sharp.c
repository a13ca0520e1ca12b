/* bake_sharp.c - see bake_sharp.h. */
#include "bake/bake_sharp.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "bake/bake_area.h"
#include "ibl/equirect.h"

bool bake_sharp_is_of_faces(const bake_source *source, uint32_t size)
{
    return source->faces && source->rotation_rad == 0.0 && source->faces->size % size == 0;
}

/* ---- from faces ---- */

typedef struct boxing {
    const cube *from;
    float limit, scale;
    cube *out;
} boxing;

static void box_rows(void *context, size_t begin, size_t end)
{
    const boxing *job = context;
    uint32_t size = job->out->size;
    uint32_t box = job->from->size / size;
    for (uint32_t y = (uint32_t)begin; y < end; y++)
        for (uint32_t x = 0; x < size; x++) {
            double sums[6][3] = {{0.0}};
            double whole = 0.0;
            for (uint32_t k = 0; k < box * box; k++) {
                uint32_t fx = x * box + k % box;
                uint32_t fy = y * box + k / box;
                double w = box > 1 ? cube_texel_solid_angle(job->from->size, fx, fy) : 1.0;
                whole += w;
                for (uint32_t face = 0; face < 6; face++) {
                    rgbx texel = *cube_texel(job->from, face, (int)fx, (int)fy);
                    for (int j = 0; j < 3; j++)
                        sums[face][j] += w * (double)(texel[j] < job->limit ? texel[j] : job->limit);
                }
            }
            double scale = (double)job->scale / whole;
            for (uint32_t face = 0; face < 6; face++)
                *cube_texel(job->out, face, (int)x, (int)y) =
                    (rgbx){(float)(sums[face][0] * scale), (float)(sums[face][1] * scale),
                           (float)(sums[face][2] * scale), 0.0f};
        }
}

/* ---- between texels ---- */

bool bake_sharp_is_interpolated(const bake_source *source, uint32_t size)
{
    return !bake_sharp_is_of_faces(source, size) && 2 * (uint64_t)size > source->picture.height;
}

typedef struct interpolating {
    const bake_source *source;
    cube *out;
} interpolating;

enum { POINTS = 4 }; /* along a texel's edge; it is at most as large as the picture's */

DISPATCH_AVX2 static void interpolate_rows(void *context, size_t begin, size_t end)
{
    const interpolating *job = context;
    uint32_t size = job->out->size;
    float c = (float)cos(job->source->rotation_rad);
    float s = (float)sin(job->source->rotation_rad);
    for (size_t i = begin; i < end; i++) {
        uint32_t face = (uint32_t)(i / size);
        uint32_t y = (uint32_t)(i % size);
        for (uint32_t x = 0; x < size; x++) {
            rgbx sum = {0};
            float whole = 0.0f;
            for (uint32_t k = 0; k < POINTS * POINTS; k++) {
                double d[3];
                cube_direction(face, 2.0 * (x + (k % POINTS + 0.5) / POINTS) / size - 1.0,
                               2.0 * (y + (k / POINTS + 0.5) / POINTS) / size - 1.0, d);
                float r = (float)(1.0 / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
                const float e[3] = {((float)d[0] * c - (float)d[2] * s) * r, (float)d[1] * r,
                                    ((float)d[0] * s + (float)d[2] * c) * r};
                float w = r * r * r; /* of solid angle */
                sum += equirect_fetch(&job->source->picture, equirect_locate(e)) * w;
                whole += w;
            }
            *cube_texel(job->out, face, (int)x, (int)y) = sum * (1.0f / whole);
        }
    }
}

/* Points hit a small sun a little more or less often than its solid angle says, and tents around texels' middles are not quite
 * these. */
static void scale_to_mean(const bake_source *source, float scale, cube *out)
{
    double mean[3];
    rgbx ratio = rgbx_splat(scale);
    cube_mean(out, mean);
    for (int k = 0; k < 3; k++)
        if (mean[k] > 0.0)
            ratio[k] = (float)((double)scale * source->mean[k] / mean[k]);
    size_t stride = (size_t)out->size + 2;
    for (size_t i = 0; i < 6 * stride * stride; i++)
        out->texels[i] *= ratio;
}

facet_result bake_sharp(const bake_source *source, float scale, const facet_allocator *allocator,
                        uint32_t thread_count, cube *out, facet_error *error)
{
    if (bake_sharp_is_of_faces(source, out->size)) {
        boxing job = {.from = source->faces, .limit = source->limit, .scale = scale, .out = out};
        parallel_for(thread_count, out->size, 4, box_rows, &job);
        cube_fill_borders(out);
        return FACET_OK;
    }
    if (bake_sharp_is_interpolated(source, out->size)) {
        interpolating job = {source, out};
        parallel_for(thread_count, 6 * (size_t)out->size, 16, interpolate_rows, &job);
        cube_fill_borders(out);
        scale_to_mean(source, scale, out);
        return FACET_OK;
    }
    bake_area area = {0};
    facet_result result =
        bake_area_create(&source->picture, source->rotation_rad, allocator, thread_count, &area, error);
    if (result == FACET_OK)
        bake_area_fill(&area, false, scale, thread_count, out);
    bake_area_destroy(&area);
    return result;
}
