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
#include "ibl/equirect.h"

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
    uint64_t max_bytes = file_limit(desc->max_file_bytes);
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
    facet_result result = file_open(path, file_limit(desc->max_file_bytes), &desc->allocator, &file, error);
    if (result != FACET_OK)
        return result;
    result = facet_environment_load_memory(file.data, file.size, path, desc, environment, error);
    file_close(&file);
    return result;
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

enum { GRADIENT_WIDTH = 2, GRADIENT_HEIGHT = 512 };

facet_result facet_environment_create_gradient(const float zenith[3], const float horizon[3],
                                               const float nadir[3], const facet_environment_desc *desc,
                                               facet_environment **environment, facet_error *error)
{
    assert(zenith && horizon && nadir && environment);
    *environment = NULL;
    desc = desc ? desc : &default_desc;
    facet_environment *e = NULL;
    facet_result result = environment_create(desc, &e, error);
    if (result != FACET_OK)
        return result;
    result = image_create(&e->allocator, GRADIENT_WIDTH, GRADIENT_HEIGHT, 3, IMAGE_F32, &e->picture, error);
    if (result != FACET_OK) {
        environment_release(e);
        return result;
    }
    float *p = e->picture.pixels;
    for (int y = 0; y < GRADIENT_HEIGHT; y++) {
        /* equal steps of d.y hold equal parts of the sphere: a row's mean is its middle's */
        double top = cos(3.14159265358979323846 * y / GRADIENT_HEIGHT);
        double bottom = cos(3.14159265358979323846 * (y + 1) / GRADIENT_HEIGHT);
        double height = 0.5 * (top + bottom);
        const float *end = height > 0.0 ? zenith : nadir;
        for (int i = 0; i < 3 * GRADIENT_WIDTH; i++)
            p[3 * GRADIENT_WIDTH * y + i] =
                (float)((double)horizon[i % 3] +
                        ((double)end[i % 3] - (double)horizon[i % 3]) * fabs(height));
    }
    environment_limit(e, desc->thread_count);
    environment_identify(e, e->picture.pixels, e->picture.height * image_row_size(&e->picture));
    *environment = e;
    return FACET_OK;
}

/* ---- figures ---- */

/* Of a row of texels: radiance times solid angle, the solid angle, the largest channel. */
typedef struct row_sum {
    double flux[3], solid_angle;
    float largest;
} row_sum;

typedef struct measuring {
    const facet_environment *environment;
    row_sum *rows;
} measuring;

static void add_texel(row_sum *r, const float *c, double solid_angle)
{
    for (int i = 0; i < 3; i++) {
        r->flux[i] += solid_angle * (double)c[i];
        r->largest = c[i] > r->largest ? c[i] : r->largest;
    }
    r->solid_angle += solid_angle;
}

/* Row y of all six faces, whose texels have the same solid angles: as cube_texel_solid_angle() has them, each corner
 * computed once in a row. */
static void measure_face_rows(void *context, size_t begin, size_t end)
{
    const measuring *m = context;
    const cube *c = &m->environment->faces;
    const double step = 2.0 / c->size;
    for (size_t y = begin; y < end; y++) {
        const double above = (double)y * step - 1.0, below = (double)(y + 1) * step - 1.0;
        double left_above = cube_corner_angle(-1.0, above), left_below = cube_corner_angle(-1.0, below);
        row_sum sums[6] = {{{0.0}, 0.0, 0.0f}};
        for (uint32_t x = 0; x < c->size; x++) {
            const double right = (x + 1) * step - 1.0;
            const double right_above = cube_corner_angle(right, above),
                         right_below = cube_corner_angle(right, below);
            const double solid_angle = right_below - left_below - right_above + left_above;
            for (uint32_t face = 0; face < 6; face++)
                add_texel(&sums[face], (const float *)cube_texel(c, face, (int)x, (int)y), solid_angle);
            left_above = right_above;
            left_below = right_below;
        }
        for (uint32_t face = 0; face < 6; face++)
            m->rows[face * c->size + y] = sums[face];
    }
}

static void measure_picture_rows(void *context, size_t begin, size_t end)
{
    const measuring *m = context;
    const image *p = &m->environment->picture;
    for (size_t row = begin; row < end; row++) {
        row_sum sum = {0};
        double solid_angle = equirect_texel_solid_angle(p->width, p->height, (uint32_t)row);
        for (size_t x = 0; x < p->width; x++)
            add_texel(&sum, (const float *)p->pixels + 3 * (row * p->width + x), solid_angle);
        m->rows[row] = sum;
    }
}

facet_result facet_environment_get_info(const facet_environment *environment, facet_environment_info *info,
                                        facet_error *error)
{
    assert(environment && info);
    const facet_environment *e = environment;
    *info = (facet_environment_info){.layout = e->layout ? e->layout : FACET_LAYOUT_EQUIRECTANGULAR,
                                     .width = e->source_width ? e->source_width : e->picture.width,
                                     .height = e->source_height ? e->source_height : e->picture.height,
                                     .repaired_texels = e->repaired_texels};
    size_t count = e->faces.texels ? 6 * (size_t)e->faces.size : e->picture.height;
    measuring m = {e, mem_alloc(&e->allocator, count, sizeof(row_sum))};
    if (!m.rows)
        return fail_memory(error, "environment", count * sizeof(row_sum));
    if (e->faces.texels) /* else the picture */
        parallel_for(0, e->faces.size, 16, measure_face_rows, &m);
    else
        parallel_for(0, count, 16, measure_picture_rows, &m);
    double solid_angle = 0.0;
    for (size_t row = 0; row < count; row++) {
        for (int i = 0; i < 3; i++)
            info->mean[i] += m.rows[row].flux[i];
        solid_angle += m.rows[row].solid_angle;
        info->max_radiance =
            m.rows[row].largest > info->max_radiance ? m.rows[row].largest : info->max_radiance;
    }
    for (int i = 0; i < 3; i++)
        info->mean[i] /= solid_angle;
    mem_free(m.rows);
    return FACET_OK;
}
