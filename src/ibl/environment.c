/* environment.c - the object facet_environment. environment_source.c reads files, light.c prepares lights. */
#include "ibl/environment.h"

#include <assert.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ibl/equirect.h"

static const uint64_t default_cache_bytes = 256ull << 20;

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
    for (int i = 0; i < REDUCED_COUNT; i++)
        image_destroy(&parts->reduced[i]);
    harmonics_destroy(&parts->harmonics);
    narrow_destroy(&parts->narrow);
    image_destroy(&environment->panorama);
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

/* ---- what is kept of a decoded image ---- */

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
    parallel_for(thread_count, environment->panorama.height, 16, limit_rows, &environment->panorama);
}

/* ---- figures ---- */

/* Sums of a row of texels: radiance times solid angle, solid angle, largest channel. */
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

/* Row y of all six faces, whose texels have the same solid angles: as in cube_texel_solid_angle(), each
 * corner computed once per row. */
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

static void measure_image_rows(void *context, size_t begin, size_t end)
{
    const measuring *m = context;
    const image *p = &m->environment->panorama;
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
                                     .width = e->source_width ? e->source_width : e->panorama.width,
                                     .height = e->source_height ? e->source_height : e->panorama.height,
                                     .repaired_texels = e->repaired_texels};
    size_t count = e->faces.texels ? 6 * (size_t)e->faces.size : e->panorama.height;
    measuring m = {e, mem_alloc(&e->allocator, count, sizeof(row_sum))};
    if (!m.rows)
        return fail_memory(error, "environment", count * sizeof(row_sum));
    if (e->faces.texels) /* else the panorama */
        parallel_for(0, e->faces.size, 16, measure_face_rows, &m);
    else
        parallel_for(0, count, 16, measure_image_rows, &m);
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
