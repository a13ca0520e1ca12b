/* environment_info.c - what an environment says of itself. */
#include <assert.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ibl/environment.h"
#include "ibl/equirect.h"

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

/* The faces where there are any, else the picture. */
static void measure_rows(void *context, size_t begin, size_t end)
{
    const measuring *m = context;
    const cube *c = &m->environment->faces;
    const image *p = &m->environment->picture;
    for (size_t row = begin; row < end; row++) {
        row_sum sum = {0};
        if (c->texels) {
            uint32_t y = (uint32_t)(row % c->size);
            for (uint32_t x = 0; x < c->size; x++) {
                rgbx texel = *cube_texel(c, (uint32_t)(row / c->size), (int)x, (int)y);
                add_texel(&sum, (const float *)&texel, cube_texel_solid_angle(c->size, x, y));
            }
        } else {
            double solid_angle = equirect_texel_solid_angle(p->width, p->height, (uint32_t)row);
            for (size_t x = 0; x < p->width; x++)
                add_texel(&sum, (const float *)p->pixels + 3 * (row * p->width + x), solid_angle);
        }
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
    parallel_for(0, count, 16, measure_rows, &m);
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
