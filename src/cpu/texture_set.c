/* texture_set.c - decodes the images that a render reads, each once, and builds their mips. See texture.h. */
#include "cpu/texture_set.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

/* An image to be decoded. */
typedef struct job {
    uint32_t image;
    bool is_read_as_color, is_read_as_data;
    float min_lod;        /* of all textures that show it */
    uint64_t texel_count; /* of the full image, as its header says */
    uint64_t decoded_texels;
    facet_result result;
    facet_error error;
} job;

typedef struct batch {
    const facet_scene *scene;
    const facet_allocator *allocator;
    texture_set *set;
    job *jobs;
} batch;

/* ---- one image ---- */

static void name_image(const facet_scene *scene, uint32_t index, char *text, size_t size)
{
    const char *name = scene->images[index].name;
    if (name && name[0])
        snprintf(text, size, "%s: image %u \"%s\"", scene->source, index, name);
    else
        snprintf(text, size, "%s: image %u", scene->source, index);
}

/* The reduction that the decoder chose: full and decoded sizes differ by a power of two. False: they do not. */
static bool find_reduction(const image *header, const image *decoded, uint32_t *reduction)
{
    for (uint32_t r = 0; r < 4; r++)
        if (header->width >> r == decoded->width && header->height >> r == decoded->height) {
            *reduction = r;
            return true;
        }
    return false;
}

/* The largest reduction up to wanted that divides both edges: only then the reduced picture shows the same part
 * of the plane as the full one, and its texels stand where the mips' texels stand. */
static uint32_t get_exact_reduction(const image *header, uint32_t wanted)
{
    uint32_t r = 0;
    while (r < wanted && r < 31 && ((header->width | header->height) & ((2u << r) - 1)) == 0)
        r++;
    return r;
}

static facet_result copy_image(const image *in, const facet_allocator *allocator, image *out,
                               facet_error *error)
{
    facet_result result =
        image_create(allocator, in->width, in->height, in->channel_count, in->type, out, error);
    if (result != FACET_OK)
        return result;
    out->is_srgb = in->is_srgb;
    memcpy(out->pixels, in->pixels, image_row_size(in) * in->height);
    return FACET_OK;
}

static facet_result decode(const batch *b, job *j, const char *name, image *header, image *out,
                           uint32_t *level)
{
    const scene_image *i = &b->scene->images[j->image];
    image_codec codec;
    facet_result result = image_probe(i->bytes, i->size, name, header, &codec, &j->error);
    if (result != FACET_OK)
        return result;
    uint32_t last_level = texture_level_count(header->width, header->height) - 1;
    uint32_t first_level = j->min_lod >= (float)last_level ? last_level : (uint32_t)j->min_lod;
    image_decode_desc desc = {.allocator = b->allocator ? *b->allocator : (facet_allocator){0},
                              .thread_count = 1,
                              .max_size = b->scene->max_texture_size,
                              .max_reduction = get_exact_reduction(header, first_level)};
    result = image_decode(i->bytes, i->size, name, &desc, out, &j->error);
    if (result != FACET_OK)
        return result;
    j->decoded_texels = (uint64_t)out->width * out->height;
    *level = first_level;
    if (out->type == IMAGE_U8 || out->type == IMAGE_U16)
        return FACET_OK;
    return fail(&j->error, FACET_ERROR_UNSUPPORTED, "%s: expected a PNG, JPEG or WebP picture, this is %s",
                name, image_codec_name(codec));
}

static void run_job(batch *b, job *j)
{
    char name[512];
    name_image(b->scene, j->image, name, sizeof name);
    image header = {0};
    image color = {0};
    image data = {0};
    uint32_t first_level = 0;
    uint32_t source_level = 0;
    texture_pyramid *pyramids = &b->set->pyramids[2 * (size_t)j->image];
    j->result = decode(b, j, name, &header, &color, &first_level);
    if (j->result == FACET_OK && !find_reduction(&header, &color, &source_level))
        j->result = fail(&j->error, FACET_ERROR_INVALID, "%s: expected %u x %u texels, decoded %u x %u", name,
                         header.width, header.height, color.width, color.height);
    if (j->result == FACET_OK && j->is_read_as_data) {
        if (j->is_read_as_color) {
            j->result = copy_image(&color, b->allocator, &data, &j->error);
        } else {
            data = color;
            color = (image){0};
        }
    }
    if (j->result == FACET_OK && j->is_read_as_data)
        j->result = texture_pyramid_create(&data, source_level, header.width, header.height, first_level,
                                           false, b->set->tables, b->allocator, &pyramids[1], &j->error);
    if (j->result == FACET_OK && j->is_read_as_color)
        j->result = texture_pyramid_create(&color, source_level, header.width, header.height, first_level,
                                           true, b->set->tables, b->allocator, &pyramids[0], &j->error);
    image_destroy(&color);
    image_destroy(&data);
}

static void run_jobs(void *context, size_t begin, size_t end)
{
    batch *b = context;
    for (size_t i = begin; i < end; i++)
        run_job(b, &b->jobs[i]);
}

/* ---- all images ---- */

static int compare_jobs(const void *a, const void *b) /* the largest first: it must not come last */
{
    const job *first = a;
    const job *second = b;
    if (first->texel_count != second->texel_count)
        return first->texel_count > second->texel_count ? -1 : 1;
    return first->image < second->image ? -1 : 1;
}

static int compare_images(const void *a, const void *b)
{
    return ((const job *)a)->image < ((const job *)b)->image ? -1 : 1;
}

/* Collects what textures want of their images; returns the number of jobs, one per image that is read. jobs:
 * scene->image_count of them, zero. */
static size_t collect_jobs(const facet_scene *scene, const texture_use *uses, job *jobs)
{
    for (uint32_t t = 0; t < scene->texture_count; t++) {
        const scene_texture *texture = &scene->textures[t];
        if (!(uses[t].is_read_as_color || uses[t].is_read_as_data) || texture->image >= scene->image_count ||
            !scene->images[texture->image].bytes)
            continue;
        job *j = &jobs[texture->image];
        bool is_new = !j->is_read_as_color && !j->is_read_as_data;
        /* Without mips the full image is looked up, however small it is seen. */
        float min_lod = texture->mip_filter == SCENE_MIP_NONE ? 0.0f : uses[t].min_lod;
        if (!(min_lod > 0.0f))
            min_lod = 0.0f;
        j->min_lod = is_new || min_lod < j->min_lod ? min_lod : j->min_lod;
        j->is_read_as_color |= uses[t].is_read_as_color;
        j->is_read_as_data |= uses[t].is_read_as_data;
    }
    size_t count = 0;
    for (uint32_t i = 0; i < scene->image_count; i++) {
        if (!jobs[i].is_read_as_color && !jobs[i].is_read_as_data)
            continue;
        job j = jobs[i];
        j.image = i;
        image header;
        image_codec codec;
        if (image_probe(scene->images[i].bytes, scene->images[i].size, "", &header, &codec, NULL) == FACET_OK)
            j.texel_count = (uint64_t)header.width * header.height;
        jobs[count++] = j;
    }
    return count;
}

/* Connects textures with what was built. */
static void bind(texture_set *set, const facet_scene *scene)
{
    for (uint32_t t = 0; t < scene->texture_count; t++) {
        const scene_texture *texture = &scene->textures[t];
        texture_binding *b = &set->bindings[t];
        *b = (texture_binding){.wrap_u = texture->wrap_u,
                               .wrap_v = texture->wrap_v,
                               .mag_filter = texture->mag_filter,
                               .min_filter = texture->min_filter,
                               .mip_filter = texture->mip_filter};
        if (texture->image >= scene->image_count)
            continue;
        const texture_pyramid *pyramids = &set->pyramids[2 * (size_t)texture->image];
        b->color = pyramids[0].level_count ? &pyramids[0] : NULL;
        b->data = pyramids[1].level_count ? &pyramids[1] : NULL;
    }
}

/* Warns of images that cannot be decoded; fails for those that say more of the machine than of the image. */
static facet_result judge(const job *jobs, size_t job_count, const facet_log *log, facet_error *error)
{
    for (size_t i = 0; i < job_count; i++) {
        const job *j = &jobs[i];
        if (j->result == FACET_ERROR_LIMIT || j->result == FACET_ERROR_MEMORY) {
            if (error)
                *error = j->error;
            return j->result;
        }
    }
    for (size_t i = 0; i < job_count; i++)
        if (jobs[i].result != FACET_OK)
            log_warning(log, "%s; it reads as white", jobs[i].error.message);
    return FACET_OK;
}

facet_result texture_set_create(const facet_scene *scene, const texture_use *uses,
                                const facet_allocator *allocator, const facet_log *log, uint32_t thread_count,
                                texture_set **out, facet_error *error)
{
    *out = NULL;
    facet_result result = FACET_OK;
    job *jobs = mem_zalloc(allocator, scene->image_count, sizeof *jobs);
    texture_set *set = mem_zalloc(allocator, 1, sizeof *set);
    if (set) {
        set->binding_count = scene->texture_count;
        set->image_count = scene->image_count;
        set->bindings = mem_zalloc(allocator, scene->texture_count, sizeof *set->bindings);
        set->pyramids = mem_zalloc(allocator, scene->image_count, 2 * sizeof *set->pyramids);
        set->tables = mem_alloc(allocator, 1, sizeof *set->tables);
    }
    if (!jobs || !set || !set->bindings || !set->pyramids || !set->tables) {
        result = fail_memory(error, "textures", sizeof *set->tables);
        goto done;
    }
    size_t job_count = collect_jobs(scene, uses, jobs);
    if (job_count)
        texture_tables_fill(set->tables);
    qsort(jobs, job_count, sizeof *jobs, compare_jobs);
    batch b = {.scene = scene, .allocator = allocator, .set = set, .jobs = jobs};
    parallel_for(thread_count, job_count, 1, run_jobs, &b);
    qsort(jobs, job_count, sizeof *jobs, compare_images);
    for (size_t i = 0; i < job_count; i++)
        set->decoded_texels += jobs[i].decoded_texels;
    result = judge(jobs, job_count, log, error);
    if (result != FACET_OK)
        goto done;
    bind(set, scene);
    *out = set;
    set = NULL;

done:
    texture_set_destroy(set);
    mem_free(jobs);
    return result;
}

void texture_set_destroy(texture_set *set)
{
    if (!set)
        return;
    if (set->pyramids)
        for (size_t i = 0; i < 2 * (size_t)set->image_count; i++)
            texture_pyramid_destroy(&set->pyramids[i]);
    mem_free(set->pyramids);
    mem_free(set->bindings);
    mem_free(set->tables);
    mem_free(set);
}

uint64_t texture_set_decoded_texels(const texture_set *set)
{
    return set->decoded_texels;
}

bool texture_full_size(const facet_scene *scene, uint32_t texture, float size[2])
{
    uint32_t index = texture < scene->texture_count ? scene->textures[texture].image : SCENE_NONE;
    if (index >= scene->image_count || !scene->images[index].bytes)
        return false;
    const scene_image *i = &scene->images[index];
    image header = {.width = i->width, .height = i->height};
    image_codec codec;
    if ((header.width == 0 || header.height == 0) &&
        image_probe(i->bytes, i->size, "", &header, &codec, NULL) != FACET_OK)
        return false;
    size[0] = (float)header.width;
    size[1] = (float)header.height;
    return true;
}
