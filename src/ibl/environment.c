/* environment.c - reading and making environments. Preparing lights of them: light.c. */
#include "ibl/environment.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ibl/cache.h"
#include "ibl/cube_layout.h"
#include "ibl/environment_source.h"
#include "ibl/studio.h"

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

/* The layout of a picture: as desc says, as an OpenEXR file says, or by its edges. */
static facet_result choose_layout(const facet_environment_desc *desc, image_envmap envmap,
                                  const image *picture, const char *name, facet_layout *layout,
                                  facet_error *error)
{
    uint32_t width = picture->width, height = picture->height;
    *layout = desc->layout                     ? desc->layout
              : envmap == IMAGE_ENVMAP_LATLONG ? FACET_LAYOUT_EQUIRECTANGULAR
                                               : layout_detect(width, height); /* of a cube, too: 1:6 */
    if (*layout == FACET_LAYOUT_FACES)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: six faces are six pictures, this is one", name);
    double ratio = width / (2.0 * height);
    if (*layout == FACET_LAYOUT_AUTO && fabs(ratio - 1.0) > 0.05)
        return fail(
            error, FACET_ERROR_INVALID,
            "%s: %u x %u texels: an environment is 2:1 (equirectangular), 4:3 or 3:4 (cross), 6:1 or 1:6 "
            "(strip of faces), or six files NAME{face}.EXT; for any other shape, or an octahedral map, name "
            "the "
            "layout (facet_environment_desc.layout; facet bake --input-layout)",
            name, width, height);
    if (*layout == FACET_LAYOUT_AUTO)
        *layout = FACET_LAYOUT_EQUIRECTANGULAR;
    if (*layout == FACET_LAYOUT_EQUIRECTANGULAR && width != 2 * (uint64_t)height)
        log_warning(&desc->log,
                    "%s: %u x %u texels: an equirectangular picture is twice as wide as high; this one is "
                    "stretched over the sphere",
                    name, width, height);
    return layout_check(*layout, width, height, name, error);
}

/* A picture of any layout. */
static facet_result load_picture(facet_environment *e, const void *bytes, size_t size, const char *name,
                                 const facet_environment_desc *desc, facet_error *error)
{
    float largest;
    image_note note;
    image header, decoded = {0}, rgb = {0};
    environment_repairs repairs = {.first = UINT64_MAX};
    facet_layout layout;
    const image_envmap envmap = image_get_envmap(bytes, size);
    image_decode_desc how = environment_decode_desc(desc, &largest);
    how.note = &note;
    facet_result result = image_probe(bytes, size, name, &header, NULL, error);
    if (result == FACET_OK) /* before memory is taken */
        result = choose_layout(desc, envmap, &header, name, &layout, error);
    if (result == FACET_OK)
        result = image_decode(bytes, size, name, &how, &decoded, error);
    if (result == FACET_OK) {
        image_note_log(&note, name, &e->log);
        result = environment_repair(&decoded, largest, 0, &e->allocator, desc->thread_count, &rgb, &repairs,
                                    error);
    }
    if (result == FACET_OK) {
        environment_report(e, &repairs, name, NULL, (uint32_t)(repairs.first % rgb.width),
                           (uint32_t)(repairs.first / rgb.width));
        if (envmap == IMAGE_ENVMAP_CUBE && layout == FACET_LAYOUT_STRIP_VERTICAL)
            layout_flip_seen_faces(&rgb);
        result = environment_take_picture(e, &rgb, layout, name, desc->thread_count, error);
    }
    image_destroy(&decoded);
    return result;
}

/* KTX2: a cube map, or a picture. */
static facet_result load_ktx2(facet_environment *e, const void *bytes, size_t size, const char *name,
                              const facet_environment_desc *desc, facet_error *error)
{
    ktx2 k;
    facet_result result = ktx2_open(bytes, size, name, &k, error);
    if (result != FACET_OK)
        return result;
    if (k.layer_count > 1)
        return fail(error, FACET_ERROR_UNSUPPORTED,
                    "%s: KTX2: an array of %u textures: one cube map or one picture was expected", name,
                    k.layer_count);
    return k.is_cube ? environment_load_ktx2(e, &k, desc, error)
                     : load_picture(e, bytes, size, name, desc, error);
}

/* To be raised whenever the same file is read to other texels than before: what a cache holds of it is then not used. */
enum { READER_VERSION = 1 };

void environment_identify(facet_environment *environment, const void *bytes, size_t size)
{
    if (environment->cache_folder)
        environment->hash =
            cache_hash(environment->hash + environment->layout + (READER_VERSION << 8), bytes, size);
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
    uint64_t max_bytes = desc->max_file_bytes ? desc->max_file_bytes : environment_default_max_file_bytes;
    if (size > max_bytes)
        return fail(error, FACET_ERROR_LIMIT, "%s: %zu bytes: at most %llu are read", name, size,
                    (unsigned long long)max_bytes);
    facet_environment *e = NULL;
    facet_result result = environment_create(desc, &e, error);
    if (result != FACET_OK)
        return result;
    bool is_ktx2 = image_codec_detect(bytes, size) == IMAGE_CODEC_KTX2;
    result = (is_ktx2 ? load_ktx2 : load_picture)(e, bytes, size, name, desc, error);
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
        file_open(path, desc->max_file_bytes ? desc->max_file_bytes : environment_default_max_file_bytes,
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
