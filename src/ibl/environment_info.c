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
