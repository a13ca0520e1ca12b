/* visibility.c - see visibility.h. */
#include "cpu/visibility.h"

#include "draw/camera_rays.h"

void visibility_trace_block(const ray_scene *scene, const camera_rays *camera, uint32_t x, uint32_t y,
                            const visibility_pattern *pattern, visibility_hit *hits)
{
    scene->tracer->block(scene->bvh, camera, x, y, pattern, hits);
}

/* ---- patterns ---- */

bool visibility_pattern_create(const facet_allocator *allocator, uint32_t sample_count,
                               visibility_pattern *out)
{
    size_t ray_count = (size_t)VISIBILITY_BLOCK_PIXELS * sample_count;
    *out =
        (visibility_pattern){.sample_count = sample_count,
                             .points = mem_alloc(allocator, 2 * (sample_count + ray_count), sizeof(float))};
    if (!out->points)
        return false;
    out->offset_x = out->points + 2 * (size_t)sample_count;
    out->offset_y = out->offset_x + ray_count;
    sample_pattern(sample_count, out->points);
    for (uint32_t i = 0; i < 2 * sample_count; i++)
        out->middle[i % 2] += out->points[i];
    out->middle[0] /= (float)sample_count;
    out->middle[1] /= (float)sample_count;
    for (uint32_t pixel = 0; pixel < VISIBILITY_BLOCK_PIXELS; pixel++) {
        size_t first = visibility_first_hit(out, pixel);
        for (uint32_t i = 0; i < sample_count; i++) {
            out->offset_x[first + i] = (float)(pixel % VISIBILITY_BLOCK) + out->points[2 * i];
            out->offset_y[first + i] = (float)(pixel / VISIBILITY_BLOCK) + out->points[2 * i + 1];
        }
    }
    return true;
}

void visibility_pattern_destroy(visibility_pattern *pattern)
{
    mem_free(pattern->points);
    *pattern = (visibility_pattern){0};
}
