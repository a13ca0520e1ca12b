/* texture_baker.c - surveys, bakes and normal maps. See texture_baker.h. */
#include "legacy/texture_baker.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"
#include "image/image.h"
#include "legacy/texture_texels.h"

/* A texture that is not yet in the scene. */
typedef struct made_texture {
    const char *name;     /* in the arena of the scene */
    uint32_t like;        /* the texture whose sampler it has */
    unsigned char *bytes; /* a PNG file */
    size_t byte_count;
    uint32_t width, height;
    void *key; /* of its input */
    size_t key_size;
} made_texture;

struct texture_baker {
    facet_scene *scene;
    srgb_tables srgb;
    texels_cache *cache;
    uint32_t image_count;            /* of the scene before the conversion */
    texture_statistics **statistics; /* per image; NULL: not read */
    made_texture *made;
    uint32_t made_count, shared_count;
    size_t made_capacity;
};

facet_result texture_baker_create(facet_scene *scene, texture_baker **out, facet_error *error)
{
    *out = NULL;
    texture_baker *baker = mem_zalloc(&scene->allocator, 1, sizeof *baker);
    if (!baker)
        return fail_memory(error, "textures", sizeof *baker);
    baker->scene = scene;
    baker->image_count = scene->image_count;
    baker->cache = texels_cache_create(scene);
    baker->statistics =
        mem_zalloc(&scene->allocator, (size_t)scene->image_count + 1, sizeof *baker->statistics);
    if (!baker->cache || !baker->statistics) {
        texture_baker_destroy(baker);
        return fail_memory(error, "textures", sizeof *baker);
    }
    srgb_tables_prepare(&baker->srgb);
    *out = baker;
    return FACET_OK;
}

void texture_baker_destroy(texture_baker *baker)
{
    if (!baker)
        return;
    for (uint32_t i = 0; baker->statistics && i < baker->image_count; i++)
        mem_free(baker->statistics[i]);
    for (uint32_t i = 0; i < baker->made_count; i++) {
        mem_free(baker->made[i].bytes);
        mem_free(baker->made[i].key);
    }
    mem_free(baker->statistics);
    mem_free(baker->made);
    texels_cache_destroy(baker->cache);
    mem_free(baker);
}

const srgb_tables *texture_baker_srgb(const texture_baker *baker)
{
    return &baker->srgb;
}

uint32_t texture_baker_made(const texture_baker *baker)
{
    return baker->made_count;
}

uint32_t texture_baker_shared(const texture_baker *baker)
{
    return baker->shared_count;
}

/* ---- survey ---- */

static uint32_t image_of(const texture_baker *baker, uint32_t texture)
{
    if (texture >= baker->scene->texture_count)
        return SCENE_NONE;
    return baker->scene->textures[texture].image;
}

typedef struct survey {
    const texture_baker *baker;
    const uint32_t *images;
    facet_error *errors; /* one per image; .result FACET_OK: none */
} survey;

/* One thread per image, since decoders use several threads differently. */
static void survey_images(void *context, size_t begin, size_t end)
{
    const survey *s = context;
    for (size_t i = begin; i < end; i++) {
        texture_statistics *out = s->baker->statistics[s->images[i]];
        texels_count(s->baker->scene, s->images[i], 3, 1, out, &s->errors[i]);
    }
}

/* The first failure that ends the conversion; others are warnings. The reader has warned about images without
 * bytes. */
static facet_result judge_survey(const survey *s, size_t count, const facet_log *log, facet_error *error)
{
    facet_scene *scene = s->baker->scene;
    for (size_t i = 0; i < count; i++) {
        const facet_error *e = &s->errors[i];
        if (e->result == FACET_ERROR_MEMORY || e->result == FACET_ERROR_LIMIT)
            return fail(error, e->result, "%s", e->message);
        if (e->result != FACET_OK && scene->images[s->images[i]].bytes)
            scene_warn(scene, log, "%s: %s; the map is left out", scene->source, e->message);
    }
    return FACET_OK;
}

facet_result texture_baker_survey(texture_baker *baker, const bool *is_wanted, const facet_log *log,
                                  facet_error *error)
{
    facet_scene *scene = baker->scene;
    size_t count = 0;
    facet_result result = FACET_OK;
    uint32_t *images = mem_alloc(&scene->allocator, (size_t)scene->image_count + 1, sizeof *images);
    facet_error *errors = NULL;
    if (!images)
        result = FACET_ERROR_MEMORY;
    for (uint32_t i = 0; i < scene->texture_count && result == FACET_OK; i++) {
        uint32_t index = is_wanted[i] ? image_of(baker, i) : SCENE_NONE;
        if (index >= scene->image_count || baker->statistics[index])
            continue;
        baker->statistics[index] = mem_zalloc(&scene->allocator, 1, sizeof **baker->statistics);
        if (!baker->statistics[index])
            result = FACET_ERROR_MEMORY;
        else
            images[count++] = index;
    }
    if (result == FACET_OK && !(errors = mem_zalloc(&scene->allocator, count + 1, sizeof *errors)))
        result = FACET_ERROR_MEMORY;
    if (result == FACET_OK) {
        survey s = {.baker = baker, .images = images, .errors = errors};
        parallel_for(scene->thread_count, count, 1, survey_images, &s);
        result = judge_survey(&s, count, log, error);
    } else {
        result = fail_memory(error, "textures", sizeof(texture_statistics));
    }
    mem_free(images);
    mem_free(errors);
    return result;
}

const texture_statistics *texture_baker_statistics(const texture_baker *baker, uint32_t texture)
{
    uint32_t index = image_of(baker, texture);
    const texture_statistics *s = index < baker->image_count ? baker->statistics[index] : NULL;
    return s && s->is_readable ? s : NULL;
}

/* ---- new textures ---- */

/* The texture with an equal key; SCENE_NONE: none. */
static uint32_t find_made(texture_baker *baker, const void *key, size_t size)
{
    for (uint32_t i = 0; i < baker->made_count; i++)
        if (baker->made[i].key_size == size && memcmp(baker->made[i].key, key, size) == 0) {
            baker->shared_count++;
            return baker->scene->texture_count + i;
        }
    return SCENE_NONE;
}

/* Encodes an image and keeps it; takes over key if it succeeds. */
static facet_result keep_made(texture_baker *baker, const struct image *texels, const char *name,
                              uint32_t like, void *key, size_t key_size, uint32_t *texture,
                              facet_error *error)
{
    facet_scene *scene = baker->scene;
    made_texture made = {.like = like, .key = key, .key_size = key_size};
    image_encode_desc desc = {.allocator = scene->allocator, .thread_count = scene->thread_count};
    if (!mem_reserve(&scene->allocator, (void **)&baker->made, &baker->made_capacity,
                     (size_t)baker->made_count + 1, sizeof *baker->made))
        return fail_memory(error, "textures", sizeof *baker->made);
    made.name = arena_strdup(scene->arena, name);
    if (!made.name)
        return fail_memory(error, "textures", strlen(name));
    TRY(image_encode_png(texels, &desc, &made.bytes, &made.byte_count, error));
    made.width = texels->width;
    made.height = texels->height;
    *texture = scene->texture_count + baker->made_count;
    baker->made[baker->made_count++] = made;
    return FACET_OK;
}

facet_result texture_baker_finish(texture_baker *baker, facet_error *error)
{
    facet_scene *scene = baker->scene;
    uint32_t count = baker->made_count;
    if (count == 0)
        return FACET_OK;
    scene_image *images = arena_alloc(scene->arena, (size_t)scene->image_count + count, sizeof *images);
    scene_texture *textures =
        arena_alloc(scene->arena, (size_t)scene->texture_count + count, sizeof *textures);
    if (!images || !textures)
        return fail_memory(error, "textures", count * sizeof *textures);
    if (scene->image_count > 0)
        memcpy(images, scene->images, scene->image_count * sizeof *images);
    if (scene->texture_count > 0)
        memcpy(textures, scene->textures, scene->texture_count * sizeof *textures);
    for (uint32_t i = 0; i < count; i++) {
        made_texture *made = &baker->made[i];
        unsigned char *bytes = arena_alloc(scene->arena, made->byte_count, 1);
        if (!bytes)
            return fail_memory(error, "textures", made->byte_count);
        memcpy(bytes, made->bytes, made->byte_count);
        mem_free(made->bytes);
        made->bytes = NULL;
        images[scene->image_count + i] = (scene_image){.name = made->name,
                                                       .mime_type = "image/png",
                                                       .bytes = bytes,
                                                       .size = made->byte_count,
                                                       .width = made->width,
                                                       .height = made->height};
        scene_texture *texture = &textures[scene->texture_count + i];
        *texture = scene->textures[made->like];
        texture->name = made->name;
        texture->image = scene->image_count + i;
        texture->meta = (scene_meta){0};
    }
    scene->images = images;
    scene->textures = textures;
    scene->image_count += count;
    scene->texture_count += count;
    return FACET_OK;
}

/* ---- bakes ---- */

/* The texels of the inputs of a bake, resized to one size. */
typedef struct bake_inputs {
    uint32_t count, width, height;
    const image *texels[TEXTURE_INPUTS]; /* NULL: none */
    image resized[TEXTURE_INPUTS];
} bake_inputs;

static facet_result gather(texture_baker *baker, const texture_bake *bake, bake_inputs *in,
                           facet_error *error)
{
    const facet_scene *scene = baker->scene;
    in->count = bake->input_count;
    for (uint32_t i = 0; i < bake->input_count; i++) {
        uint32_t index = image_of(baker, bake->inputs[i]);
        if (index == SCENE_NONE)
            continue;
        TRY(texels_cache_get(baker->cache, index, &in->texels[i], error));
        in->width = in->texels[i]->width > in->width ? in->texels[i]->width : in->width;
        in->height = in->texels[i]->height > in->height ? in->texels[i]->height : in->height;
    }
    for (uint32_t i = 0; i < bake->input_count; i++) {
        const image *texels = in->texels[i];
        if (!texels || (texels->width == in->width && texels->height == in->height))
            continue;
        TRY(texels_resize(texels, &scene->textures[bake->inputs[i]], in->width, in->height,
                          scene->thread_count, &scene->allocator, &in->resized[i], error));
        in->texels[i] = &in->resized[i];
    }
    return FACET_OK;
}

typedef struct bake_job {
    const texture_bake *bake;
    const bake_inputs *in;
    const image *out;
} bake_job;

static void bake_rows(void *context, size_t begin, size_t end)
{
    const bake_job *job = context;
    const uint8_t *rows[TEXTURE_INPUTS] = {NULL};
    for (size_t y = begin; y < end; y++) {
        for (uint32_t i = 0; i < job->in->count; i++)
            if (job->in->texels[i])
                rows[i] = (const uint8_t *)job->in->texels[i]->pixels + y * job->in->width * 4;
        job->bake->row(job->bake->parameters, job->in->width, rows,
                       (uint8_t *)job->out->pixels + y * image_row_size(job->out));
    }
}

/* The key of a bake: inputs, function and parameters. */
static void *key_of(const texture_baker *baker, const texture_bake *bake, size_t *size)
{
    struct {
        uint32_t inputs[TEXTURE_INPUTS];
        uint32_t input_count, channel_count;
        texture_row *row;
    } head;
    memset(&head, 0, sizeof head);
    for (uint32_t i = 0; i < bake->input_count; i++)
        head.inputs[i] = bake->inputs[i];
    head.input_count = bake->input_count;
    head.channel_count = bake->channel_count;
    head.row = bake->row;
    *size = sizeof head + bake->parameter_size;
    unsigned char *key = mem_alloc(&baker->scene->allocator, *size, 1);
    if (!key)
        return NULL;
    memcpy(key, &head, sizeof head);
    if (bake->parameter_size > 0)
        memcpy(key + sizeof head, bake->parameters, bake->parameter_size);
    return key;
}

static uint32_t first_input(const texture_baker *baker, const texture_bake *bake)
{
    for (uint32_t i = 0; i < bake->input_count; i++)
        if (image_of(baker, bake->inputs[i]) != SCENE_NONE)
            return bake->inputs[i];
    return SCENE_NONE;
}

facet_result texture_baker_bake(texture_baker *baker, const texture_bake *bake, uint32_t *texture,
                                facet_error *error)
{
    *texture = SCENE_NONE;
    uint32_t like = first_input(baker, bake);
    if (like == SCENE_NONE)
        return FACET_OK;
    size_t key_size;
    void *key = key_of(baker, bake, &key_size);
    if (!key)
        return fail_memory(error, "textures", bake->parameter_size);
    *texture = find_made(baker, key, key_size);
    if (*texture != SCENE_NONE) {
        mem_free(key);
        return FACET_OK;
    }
    bake_inputs in = {0};
    image out = {0};
    facet_result result = gather(baker, bake, &in, error);
    if (result == FACET_OK)
        result = image_create(&baker->scene->allocator, in.width, in.height, bake->channel_count, IMAGE_U8,
                              &out, error);
    if (result == FACET_OK) {
        out.is_srgb = true;
        bake_job job = {.bake = bake, .in = &in, .out = &out};
        parallel_for(baker->scene->thread_count, in.height, 8, bake_rows, &job);
        result = keep_made(baker, &out, bake->name, like, key, key_size, texture, error);
        key = result == FACET_OK ? NULL : key;
    }
    for (int i = 0; i < TEXTURE_INPUTS; i++)
        image_destroy(&in.resized[i]);
    image_destroy(&out);
    mem_free(key);
    /* Only running out of memory ends a conversion; an image that cannot be decoded counts as absent. */
    return result == FACET_ERROR_MEMORY ? result : FACET_OK;
}

/* ---- normal maps of heights ----
 *
 * MTL states no unit of a bump. Here the whole range of heights rises by slope times the width of the image, so that the
 * relief does not depend on the resolution:
 *   n = normalize(-dh/dx, dh/dy, 1),  dh/dx = slope width (h(x+1) - h(x-1)) / 2   per texel
 * x to the right along +tangent; rows go down, so that green, which points up in glTF, has the other sign. */

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

/* Floats proportional to the stored codes: heights have no transfer function. */
static facet_result decode_heights(const texture_baker *baker, uint32_t index, image *out, facet_error *error)
{
    image raw;
    const facet_scene *scene = baker->scene;
    facet_result result = texels_decode_raw(scene, index, 0, scene->thread_count, &raw, error);
    if (result != FACET_OK)
        return result;
    raw.is_srgb = false;
    result = image_convert(&raw, &scene->allocator, scene->thread_count, 4, IMAGE_F32, false, out, error);
    image_destroy(&raw);
    return result;
}

facet_result texture_baker_relief(texture_baker *baker, const texture_relief *relief, uint32_t *texture,
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
    *texture = find_made(baker, &head, sizeof head);
    const scene_texture *like = &baker->scene->textures[relief->texture];
    if (*texture != SCENE_NONE || like->image == SCENE_NONE)
        return FACET_OK;
    image heights = {0};
    image normals = {0};
    void *key = mem_alloc(&baker->scene->allocator, 1, sizeof head);
    facet_result result = key ? decode_heights(baker, like->image, &heights, error)
                              : fail_memory(error, "textures", sizeof head);
    if (result == FACET_OK)
        result = image_create(&baker->scene->allocator, heights.width, heights.height, 3, IMAGE_U8, &normals,
                              error);
    if (result == FACET_OK) {
        memcpy(key, &head, sizeof head);
        relief_job job = {.relief = relief, .texture = like, .in = &heights, .out = &normals};
        parallel_for(baker->scene->thread_count, heights.height, 8, relief_rows, &job);
        result = keep_made(baker, &normals, relief->name, relief->texture, key, sizeof head, texture, error);
        key = result == FACET_OK ? NULL : key;
    }
    image_destroy(&heights);
    image_destroy(&normals);
    mem_free(key);
    return result == FACET_ERROR_MEMORY ? result : FACET_OK;
}
