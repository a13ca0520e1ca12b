/* environment.c - reading and making environments. Preparing lights of them: light.c. */
#include "ibl/environment.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ibl/cache.h"
#include "ibl/studio.h"

enum { DEFAULT_MAX_SIZE = 32768 };
static const uint64_t default_max_file_bytes = 4ull << 30;
static const uint64_t default_cache_bytes = 256ull << 20;

static const facet_environment_desc default_desc;

facet_result environment_create(const facet_environment_desc *desc, facet_environment **environment,
                                facet_error *error)
{
    facet_environment *e = mem_zalloc(&desc->allocator, 1, sizeof *e);
    if (!e)
        return fail_memory(error, "environment", sizeof *e);
    if (desc->cache_folder) {
        size_t size = strlen(desc->cache_folder) + 1;
        e->cache_folder = mem_alloc(&desc->allocator, size, 1);
        if (!e->cache_folder) {
            mem_free(e);
            return fail_memory(error, "environment", size);
        }
        memcpy(e->cache_folder, desc->cache_folder, size);
    }
    if (pthread_mutex_init(&e->mutex, NULL) != 0) {
        mem_free(e->cache_folder);
        mem_free(e);
        return fail_memory(error, "environment", sizeof *e);
    }
    e->allocator = desc->allocator;
    e->log = desc->log;
    e->cache_bytes = desc->cache_bytes ? desc->cache_bytes : default_cache_bytes;
    e->reference_count = 1;
    *environment = e;
    return FACET_OK;
}

void environment_retain(facet_environment *environment)
{
    pthread_mutex_lock(&environment->mutex);
    environment->reference_count++;
    pthread_mutex_unlock(&environment->mutex);
}

void environment_release(facet_environment *environment)
{
    pthread_mutex_lock(&environment->mutex);
    bool is_last = --environment->reference_count == 0;
    pthread_mutex_unlock(&environment->mutex);
    if (!is_last)
        return;
    light_parts *parts = &environment->parts;
    for (int lobe = 0; lobe < PREFILTER_LOBE_COUNT; lobe++)
        for (int i = 0; i < PREFILTER_LEVEL_COUNT; i++)
            cube_destroy(&parts->levels[lobe][i]);
    for (int i = 0; i < PICTURE_COUNT; i++)
        image_destroy(&parts->pictures[i]);
    harmonics_destroy(&parts->harmonics);
    narrow_destroy(&parts->narrow);
    image_destroy(&environment->picture);
    cube_destroy(&environment->faces);
    cube_destroy(&environment->irradiance_over_pi);
    mem_free(environment->cache_folder);
    pthread_mutex_destroy(&environment->mutex);
    mem_free(environment);
}

void facet_environment_destroy(facet_environment *environment)
{
    if (environment)
        environment_release(environment);
}

/* ---- what is kept of a decoded picture ---- */

DISPATCH_AVX2 static void limit_rows(void *context, size_t begin, size_t end)
{
    const image *i = context;
    size_t row = (size_t)i->width * 3;
    float *p = i->pixels;
    for (size_t k = begin * row; k < end * row; k++) {
        float x = p[k];
        x = x > 0.0f ? x : 0.0f;
        p[k] = x < ENVIRONMENT_MAX_RADIANCE ? x : ENVIRONMENT_MAX_RADIANCE;
    }
}

void environment_limit(facet_environment *environment, uint32_t thread_count)
{
    parallel_for(thread_count, environment->picture.height, 16, limit_rows, &environment->picture);
}

static facet_result take_picture(facet_environment *e, image *decoded, const char *name,
                                 uint32_t thread_count, facet_error *error)
{
    if ((uint64_t)decoded->width != 2 * (uint64_t)decoded->height)
        log_warning(&e->log,
                    "%s: %u x %u texels: an equirectangular picture is twice as wide as high; this one is "
                    "stretched over the sphere",
                    name, decoded->width, decoded->height);
    if (decoded->type == IMAGE_F32 && decoded->channel_count == 3 && !decoded->is_srgb) {
        e->picture = *decoded;
        *decoded = (image){0};
    } else {
        facet_result result =
            image_convert(decoded, &e->allocator, thread_count, 3, IMAGE_F32, false, &e->picture, error);
        if (result != FACET_OK)
            return result;
    }
    environment_limit(e, thread_count);
    return FACET_OK;
}

void environment_identify(facet_environment *environment, const void *bytes, size_t size)
{
    if (environment->cache_folder)
        environment->hash = cache_hash(0, bytes, size);
}

/* ---- the functions of facet.h ---- */

facet_result facet_environment_load_memory(const void *bytes, size_t size, const char *name,
                                           const facet_environment_desc *desc,
                                           facet_environment **environment, facet_error *error)
{
    assert(environment && (bytes || size == 0));
    *environment = NULL;
    desc = desc ? desc : &default_desc;
    name = name ? name : "environment";
    uint64_t max_bytes = desc->max_file_bytes ? desc->max_file_bytes : default_max_file_bytes;
    if (size > max_bytes)
        return fail(error, FACET_ERROR_LIMIT, "%s: %zu bytes: at most %llu are read", name, size,
                    (unsigned long long)max_bytes);
    facet_environment *e = NULL;
    image decoded = {0};
    facet_result result = environment_create(desc, &e, error);
    if (result != FACET_OK)
        return result;
    image_decode_desc decode = {.allocator = desc->allocator,
                                .thread_count =
                                    desc->thread_count ? desc->thread_count : facet_thread_count(),
                                .max_size = desc->max_size ? desc->max_size : DEFAULT_MAX_SIZE};
    result = image_decode(bytes, size, name, &decode, &decoded, error);
    if (result == FACET_OK)
        result = take_picture(e, &decoded, name, desc->thread_count, error);
    image_destroy(&decoded);
    if (result != FACET_OK) {
        environment_release(e);
        return result;
    }
    environment_identify(e, bytes, size);
    *environment = e;
    return FACET_OK;
}

facet_result facet_environment_load(const char *path, const facet_environment_desc *desc,
                                    facet_environment **environment, facet_error *error)
{
    assert(path && environment);
    *environment = NULL;
    desc = desc ? desc : &default_desc;
    file_bytes file = {0};
    facet_result result =
        file_open(path, desc->max_file_bytes ? desc->max_file_bytes : default_max_file_bytes,
                  &desc->allocator, &file, error);
    if (result != FACET_OK)
        return result;
    result = facet_environment_load_memory(file.data, file.size, path, desc, environment, error);
    file_close(&file);
    return result;
}

facet_result facet_environment_create_studio(const facet_environment_desc *desc,
                                             facet_environment **environment, facet_error *error)
{
    assert(environment);
    *environment = NULL;
    desc = desc ? desc : &default_desc;
    facet_environment *e = NULL;
    facet_result result = environment_create(desc, &e, error);
    if (result != FACET_OK)
        return result;
    result = studio_create(&e->allocator, desc->thread_count, &e->picture, error);
    if (result != FACET_OK) {
        environment_release(e);
        return result;
    }
    environment_identify(e, e->picture.pixels, e->picture.height * image_row_size(&e->picture));
    *environment = e;
    return FACET_OK;
}

facet_result facet_environment_create_constant(const float radiance[3], const facet_environment_desc *desc,
                                               facet_environment **environment, facet_error *error)
{
    assert(radiance && environment);
    *environment = NULL;
    desc = desc ? desc : &default_desc;
    facet_environment *e = NULL;
    facet_result result = environment_create(desc, &e, error);
    if (result != FACET_OK)
        return result;
    result = image_create(&e->allocator, 2, 1, 3, IMAGE_F32, &e->picture, error);
    if (result != FACET_OK) {
        environment_release(e);
        return result;
    }
    float *p = e->picture.pixels;
    for (int i = 0; i < 6; i++)
        p[i] = radiance[i % 3];
    environment_limit(e, 1);
    environment_identify(e, e->picture.pixels, image_row_size(&e->picture));
    *environment = e;
    return FACET_OK;
}
