/* bake_pyramid.c - the pyramid of bake_sampling.h. */
#include <math.h>

#include "bake/bake_sampling.h"

#include "bake/bake_area.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

static const double pi = 3.14159265358979323846;

/* ---- means ---- */

typedef struct halving {
    const cube *from, *out;
} halving;

static void halve_rows(void *context, size_t begin, size_t end)
{
    const halving *job = context;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < (int)job->out->size; x++) {
            float weights[4]; /* the same on all faces */
            float whole = 0.0f;
            for (int k = 0; k < 4; k++) {
                weights[k] = (float)cube_texel_solid_angle(job->from->size, (uint32_t)(2 * x + (k & 1)),
                                                           (uint32_t)(2 * y + (k >> 1)));
                whole += weights[k];
            }
            for (uint32_t face = 0; face < 6; face++) {
                rgbx sum = {0};
                for (int k = 0; k < 4; k++)
                    sum += *cube_texel(job->from, face, 2 * x + (k & 1), 2 * y + (k >> 1)) *
                           (weights[k] / whole);
                *cube_texel(job->out, face, x, y) = sum;
            }
        }
}

void bake_halve(const cube *from, uint32_t thread_count, cube *out)
{
    halving job = {.from = from, .out = out};
    parallel_for(thread_count, out->size, 8, halve_rows, &job);
    cube_fill_borders(out);
}

/* ---- tents ---- */

/* s of a position in texels from the edge. */
static double position(uint32_t size, double texels)
{
    return tan(0.25 * pi * (2.0 * texels / size - 1.0));
}

/* Adds the solid angle of the squares between texel centers, weighted bilinearly, to the four texels around
 * each; squares are clipped at the face. tents is the bordered array of a face. */
static void add_row_of_squares(uint32_t size, int y, const double nodes[][2], double *tents)
{
    static const double node = 0.28867513459481287; /* Gauss-Legendre, two nodes in [-1/2, 1/2] */
    double stretch = 0.5 * pi / size;               /* ds / (1 + s^2) of a texel */
    int n = (int)size;
    size_t stride = (size_t)size + 2;
    for (int x = -1; x < n; x++) {
        double *to = tents + (size_t)(y + 1) * stride + (size_t)(x + 1);
        /* half squares at the edges, which lie half-way between texels */
        double width = x < 0 || x + 1 == n ? 0.5 : 1.0;
        double height = y < 0 || y + 1 == n ? 0.5 : 1.0;
        double left = x < 0 ? 0.75 : x + 1 == n ? 0.25 : 0.5;
        double top = y < 0 ? 0.75 : y + 1 == n ? 0.25 : 0.5;
        for (int k = 0; k < 4; k++) {
            double s = nodes[x + 1][k & 1];
            double t = nodes[y + 1][k >> 1];
            double r2 = 1.0 + s * s + t * t;
            double w =
                0.25 * width * height * stretch * (1.0 + s * s) * stretch * (1.0 + t * t) / (r2 * sqrt(r2));
            double wx = left + (k & 1 ? node : -node) * width;
            double wy = top + (k & 2 ? node : -node) * height;
            to[0] += w * (1.0 - wx) * (1.0 - wy);
            to[1] += w * wx * (1.0 - wy);
            to[stride] += w * (1.0 - wx) * wy;
            to[stride + 1] += w * wx * wy;
        }
    }
}

/* Positions of the two quadrature nodes of each square in a row. */
static void place_nodes(uint32_t size, double nodes[][2])
{
    static const double node = 0.28867513459481287;
    for (int x = -1; x < (int)size; x++) {
        double from = x < 0 ? 0.0 : x + 0.5;
        double to = x + 1 == (int)size ? size : x + 1.5;
        for (int k = 0; k < 2; k++)
            nodes[x + 1][k] = position(size, 0.5 * (from + to) + (k ? node : -node) * (to - from));
    }
}

/* All faces are alike: the share of a face's lookups in its border equals that of the adjacent faces in the
 * texels along this face's edge. scratch holds the tents of a face with its border and two nodes for each
 * row. */
static void divide_by_tents(cube *c, double *scratch)
{
    int n = (int)c->size;
    size_t stride = (size_t)c->size + 2;
    double *tents = scratch;
    double(*nodes)[2] = (double(*)[2])(scratch + stride * stride);
    place_nodes(c->size, nodes);
    for (size_t i = 0; i < stride * stride; i++)
        tents[i] = 0.0;
    for (int y = -1; y < n; y++)
        add_row_of_squares(c->size, y, (const double(*)[2])nodes, tents);
    for (int y = 0; y < n; y++)
        for (int x = 0; x < n; x++) {
            /* borders left, right, above, below; those at corners are means of three texels */
            const double *own = tents + (size_t)(y + 1) * stride + (size_t)(x + 1);
            double tent = *own;
            for (int side = 0; side < 4; side++) {
                bool is_at_x = side & 1 ? x == n - 1 : x == 0;
                bool is_at_y = side & 2 ? y == n - 1 : y == 0;
                const double *across = own + (side & 1 ? 1 : -1);
                const double *over = side & 2 ? own + stride : own - stride;
                if (is_at_x && side < 2)
                    tent += *across;
                if (is_at_y && !(side & 1))
                    tent += *over;
                if (is_at_x && is_at_y)
                    tent += *(over + (side & 1 ? 1 : -1));
            }
            for (uint32_t face = 0; face < 6; face++)
                *cube_texel(c, face, x, y) *= (float)(1.0 / tent);
        }
    cube_fill_borders(c);
}

static double corner_angle(double s, double t)
{
    return atan2(s * t, sqrt(s * s + t * t + 1.0));
}

/* Multiplies radiance by the solid angles of cube_texel_solid_angle(); division by the tents follows. */
static void weigh_base(void *context, size_t begin, size_t end)
{
    const cube *c = context;
    uint32_t size = c->size;
    for (size_t y = begin; y < end; y++) {
        double t0 = position(size, (double)y);
        double t1 = position(size, (double)y + 1.0);
        double left = corner_angle(-1.0, t1) - corner_angle(-1.0, t0);
        for (uint32_t x = 0; x < size; x++) {
            double s1 = position(size, x + 1.0);
            double right = corner_angle(s1, t1) - corner_angle(s1, t0);
            for (uint32_t face = 0; face < 6; face++) {
                rgbx *texel = cube_texel(c, face, (int)x, (int)y);
                (*texel)[3] = 1.0f;
                *texel *= (float)(right - left);
            }
            left = right;
        }
    }
}

static void spread_rows(void *context, size_t begin, size_t end)
{
    const halving *job = context;
    uint32_t size = job->out->size;
    for (size_t i = begin; i < end; i++) {
        uint32_t face = (uint32_t)(i / size);
        int y = (int)(i % size);
        for (int x = 0; x < (int)size; x++) {
            static const float share[4] = {0.25f, 0.75f, 0.75f, 0.25f};
            rgbx sum = {0};
            for (int k = 0; k < 16; k++)
                sum += *cube_texel(job->from, face, 2 * x - 1 + k % 4, 2 * y - 1 + k / 4) *
                       (share[k % 4] * share[k / 4]);
            *cube_texel(job->out, face, x, y) = sum;
        }
    }
}

static facet_result create_base(const bake_source *source, uint32_t size, const facet_allocator *allocator,
                                uint32_t thread_count, cube *out, facet_error *error)
{
    bake_area area = {0};
    facet_result result = cube_create(size, allocator, out, error);
    if (result == FACET_OK)
        result =
            bake_area_create(&source->panorama, source->rotation_rad, allocator, thread_count, &area, error);
    if (result == FACET_OK)
        bake_area_fill(&area, true, source->scale, thread_count, out);
    else
        cube_destroy(out);
    bake_area_destroy(&area);
    return result;
}

facet_result bake_pyramid_create(const bake_source *source, uint32_t base, const facet_allocator *allocator,
                                 uint32_t thread_count, bake_pyramid *out, facet_error *error)
{
    bake_pyramid p = {.level_count = 1};
    facet_result result = create_base(source, base, allocator, thread_count, &p.levels[0], error);
    if (result != FACET_OK)
        return result;
    parallel_for(thread_count, p.levels[0].size, 16, weigh_base, &p.levels[0]);
    cube_fill_borders(&p.levels[0]);
    for (uint32_t size = p.levels[0].size / 2; result == FACET_OK && size > 0; size /= 2) {
        cube *level = &p.levels[p.level_count];
        result = cube_create(size, allocator, level, error);
        if (result == FACET_OK) {
            halving job = {.from = &p.levels[p.level_count - 1], .out = level};
            parallel_for(thread_count, 6 * (size_t)size, 16, spread_rows, &job);
            cube_fill_borders(level);
            p.level_count++;
        }
    }
    size_t stride = (size_t)p.levels[0].size + 2;
    double *tents = result == FACET_OK ? mem_alloc(allocator, stride * (stride + 2), sizeof *tents) : NULL;
    if (result == FACET_OK && !tents)
        result = fail_memory(error, "cube map", stride * (stride + 2) * sizeof *tents);
    for (uint32_t i = 0; result == FACET_OK && i < p.level_count; i++)
        divide_by_tents(&p.levels[i], tents);
    mem_free(tents);
    if (result != FACET_OK) {
        bake_pyramid_destroy(&p);
        return result;
    }
    *out = p;
    return FACET_OK;
}

void bake_pyramid_destroy(bake_pyramid *p)
{
    for (uint32_t i = 0; i < p->level_count; i++)
        cube_destroy(&p->levels[i]);
    *p = (bake_pyramid){0};
}

uint32_t bake_pyramid_size(const bake_lobe *lobe, uint32_t sample_count, uint32_t image_height,
                           uint32_t max_texels)
{
    bake_lobe_shares shares;
    bake_lobe_share_init(lobe, &shares);
    double most = 0.0;
    for (uint32_t i = 0; i <= BAKE_LOBE_PANELS; i++)
        most = fmax(most, bake_lobe_pdf(&shares, shares.edges[i]));
    double solid = BAKE_OVERLAP / (sample_count * most);
    double wanted = sqrt(4.0 * pi / (6.0 * solid));
    uint32_t size = 1;
    while (size < max_texels && (size < image_height / 2 || (size < image_height * 2 && size < 2.0 * wanted)))
        size *= 2;
    return size;
}
