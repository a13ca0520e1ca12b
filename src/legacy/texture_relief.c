/* texture_relief.c - heights of a bump map to a normal map.
 *
 * MTL says nothing of the unit of a bump. Here the whole range of heights rises by slope times the width of the picture,
 * so that the relief does not change with the picture's resolution:
 *   n = normalize(-dh/dx, dh/dy, 1),  dh/dx = slope width (h(x+1) - h(x-1)) / 2   per texel
 * x to the right along +tangent; rows go down, so that green, which glTF has pointing up, takes the other sign. */
#include "legacy/texture_bench_state.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"

typedef struct relief_job {
    const texture_relief *relief;
    const scene_texture *texture;
    const image *in; /* float RGBA */
    const image *out;
} relief_job;

static int64_t neighbour(int64_t i, int64_t size, scene_wrap wrap)
{
    if (wrap == SCENE_WRAP_REPEAT)
        return (i + size) % size;
    return i < 0 ? 0 : i >= size ? size - 1 : i;
}

static double height_at(const relief_job *job, int64_t x, int64_t y)
{
    const float *texel = (const float *)job->in->pixels + ((size_t)y * job->in->width + (size_t)x) * 4;
    double sum = 0;
    for (int k = 0; k < 4; k++)
        sum += (double)(texel[k] * job->relief->weights[k]);
    return (double)job->relief->base + (double)job->relief->gain * sum;
}

static uint8_t normal_code(double value)
{
    return (uint8_t)floor((value * 0.5 + 0.5) * 255.0 + 0.5);
}

static void relief_rows(void *context, size_t begin, size_t end)
{
    const relief_job *job = context;
    int64_t width = job->in->width;
    int64_t height = job->in->height;
    double scale = (double)job->relief->slope * (double)width * 0.5;
    for (int64_t y = (int64_t)begin; y < (int64_t)end; y++) {
        int64_t above = neighbour(y - 1, height, job->texture->wrap_v);
        int64_t below = neighbour(y + 1, height, job->texture->wrap_v);
        uint8_t *out = (uint8_t *)job->out->pixels + (size_t)y * (size_t)width * 3;
        for (int64_t x = 0; x < width; x++, out += 3) {
            int64_t left = neighbour(x - 1, width, job->texture->wrap_u);
            int64_t right = neighbour(x + 1, width, job->texture->wrap_u);
            double nx = -scale * (height_at(job, right, y) - height_at(job, left, y));
            double ny = scale * (height_at(job, x, below) - height_at(job, x, above));
            double length = sqrt(nx * nx + ny * ny + 1.0);
            out[0] = normal_code(nx / length);
            out[1] = normal_code(ny / length);
            out[2] = normal_code(1.0 / length);
        }
    }
}

/* Floats as the file's codes say: heights carry no transfer function. */
static facet_result decode_heights(const texture_bench *bench, uint32_t index, image *out, facet_error *error)
{
    image raw;
    const facet_scene *scene = bench->scene;
    facet_result result = texels_decode_raw(scene, index, 0, scene->thread_count, &raw, error);
    if (result != FACET_OK)
        return result;
    raw.is_srgb = false;
    result = image_convert(&raw, &scene->allocator, scene->thread_count, 4, IMAGE_F32, false, out, error);
    image_destroy(&raw);
    return result;
}

facet_result texture_bench_relief(texture_bench *bench, const texture_relief *relief, uint32_t *texture,
                                  facet_error *error)
{
    *texture = SCENE_NONE;
    struct {
        char kind[8];
        texture_relief relief;
    } head;
    memset(&head, 0, sizeof head);
    memcpy(head.kind, "relief", 6);
    head.relief.texture = relief->texture;
    memcpy(head.relief.weights, relief->weights, sizeof relief->weights);
    head.relief.base = relief->base;
    head.relief.gain = relief->gain;
    head.relief.slope = relief->slope;
    *texture = bench_find(bench, &head, sizeof head);
    const scene_texture *like = &bench->scene->textures[relief->texture];
    if (*texture != SCENE_NONE || like->image == SCENE_NONE)
        return FACET_OK;
    image heights = {0};
    image normals = {0};
    void *key = mem_alloc(&bench->scene->allocator, 1, sizeof head);
    facet_result result = key ? decode_heights(bench, like->image, &heights, error)
                              : fail_memory(error, "textures", sizeof head);
    if (result == FACET_OK)
        result = image_create(&bench->scene->allocator, heights.width, heights.height, 3, IMAGE_U8, &normals,
                              error);
    if (result == FACET_OK) {
        memcpy(key, &head, sizeof head);
        relief_job job = {.relief = relief, .texture = like, .in = &heights, .out = &normals};
        parallel_for(bench->scene->thread_count, heights.height, 8, relief_rows, &job);
        result = bench_keep(bench, &normals, relief->name, relief->texture, key, sizeof head, texture, error);
        key = result == FACET_OK ? NULL : key;
    }
    image_destroy(&heights);
    image_destroy(&normals);
    mem_free(key);
    return result == FACET_ERROR_MEMORY ? result : FACET_OK;
}
