/* bake_area.c - see bake_area.h. */
#include "bake/bake_area.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ibl/equirect.h"

static const double pi = 3.14159265358979323846;

enum {
    MAX_SUMS = 1 << 21, /* column sums: 48 MiB */
    TILE_WIDTH = 128,
    TILE_HEIGHT = 32 /* texels per work item */
};

/* ---- sums ---- */

enum { SUM_COLUMNS = 32 };

static void sum_columns(void *context, size_t begin, size_t end)
{
    bake_area *a = context;
    uint32_t width = a->panorama->width;
    for (size_t group = begin; group < end; group++) {
        size_t first = group * SUM_COLUMNS;
        size_t count = width - first < SUM_COLUMNS ? width - first : SUM_COLUMNS;
        double sums[SUM_COLUMNS][3] = {{0.0}};
        for (uint32_t y = 0; y < a->panorama->height; y++) {
            if (y % a->step == 0)
                memcpy(a->sums + (size_t)(y / a->step) * width + first, sums, count * sizeof *sums);
            double height = a->heights[y] - a->heights[y + 1];
            const float *p = (const float *)a->panorama->pixels + 3 * ((size_t)y * width + first);
            for (size_t x = 0; x < count; x++)
                for (int k = 0; k < 3; k++)
                    sums[x][k] += height * (double)*p++;
        }
        memcpy(a->totals + first, sums, count * sizeof *sums);
    }
}

facet_result bake_area_create(const image *panorama, double rotation_rad, const facet_allocator *allocator,
                              uint32_t thread_count, bake_area *out, facet_error *error)
{
    size_t width = panorama->width;
    size_t height = panorama->height;
    bake_area a = {.panorama = panorama, .rotation_rad = rotation_rad, .step = 4};
    while (width * (height / a.step + 1) > MAX_SUMS && a.step < 64)
        a.step *= 2;
    size_t count = width * (height / a.step + 1);
    a.sums = mem_alloc(allocator, count, sizeof *a.sums);
    a.totals = mem_alloc(allocator, width, sizeof *a.totals);
    a.heights = mem_alloc(allocator, height + 1, sizeof *a.heights);
    a.tangents = mem_alloc(allocator, height + 1, sizeof *a.tangents);
    a.cosines = mem_alloc(allocator, width + 1, sizeof *a.cosines);
    a.sines = mem_alloc(allocator, width + 1, sizeof *a.sines);
    if (!a.sums || !a.totals || !a.heights || !a.tangents || !a.cosines || !a.sines) {
        bake_area_destroy(&a);
        *out = a;
        return fail_memory(error, "environment", count * sizeof *a.sums);
    }
    for (size_t y = 0; y <= height; y++) {
        double theta = pi * (double)y / (double)height;
        a.heights[y] = y == height ? -1.0 : cos(theta);
        a.tangents[y] = cos(theta) / sin(theta); /* not used at the poles */
    }
    for (size_t x = 0; x <= width; x++) {
        double phi = 2.0 * pi * (double)x / (double)width - pi;
        a.cosines[x] = cos(phi);
        a.sines[x] = sin(phi);
    }
    parallel_for(thread_count, (width + SUM_COLUMNS - 1) / SUM_COLUMNS, 1, sum_columns, &a);
    *out = a;
    return FACET_OK;
}

void bake_area_destroy(bake_area *a)
{
    mem_free(a->sums);
    mem_free(a->totals);
    mem_free(a->heights);
    mem_free(a->tangents);
    mem_free(a->cosines);
    mem_free(a->sines);
    *a = (bake_area){0};
}

/* ---- integrals along edges ---- */

/* A line on a face, part of a great circle: the points base + tau along, phi = phi0 + sign psi, with psi in
 * (-pi / 2, pi / 2) and tan(psi) = tau / radius. */
typedef struct area_line {
    double radius;             /* distance of base from the axis; 0: a meridian, whose integral is 0 */
    double slope;              /* T: of base, height over radius */
    double factor;             /* T / (1 + T^2) */
    double phi0, cosine, sine; /* of base, in the panorama */
    int sign;
} area_line;

/* A point on a line and the texel of the panorama that contains it. */
typedef struct area_point {
    double c, s; /* cos, sin of psi */
    double q;    /* sqrt(1 + T^2 c^2) */
    double h;
} area_point;

typedef struct area_cursor {
    area_point at;
    uint32_t column, row;
} area_cursor;

/* Integrals of radiance and, last, of 1. */
typedef struct area_sum {
    double of[4];
} area_sum;

static area_line make_line(const bake_area *a, const double base[3], const double along[3])
{
    area_line l = {.radius = sqrt(base[0] * base[0] + base[2] * base[2])};
    if (l.radius < 1e-12 || fabs(along[1]) > 0.5) {
        l.radius = 0.0;
        return l;
    }
    double x = base[0] / l.radius;
    double z = base[2] / l.radius;
    l.slope = base[1] / l.radius;
    l.factor = l.slope / (1.0 + l.slope * l.slope);
    l.phi0 = atan2(z, x) + a->rotation_rad;
    l.cosine = cos(l.phi0);
    l.sine = sin(l.phi0);
    l.sign = x * along[2] - z * along[0] > 0.0 ? 1 : -1;
    return l;
}

static inline void place(const area_line *l, double c, double s, area_point *p)
{
    p->c = c;
    p->s = s;
    p->q = sqrt(1.0 + l->slope * l->slope * c * c);
    p->h = l->slope * c / p->q;
}

static area_point point_at(const area_line *l, double tau)
{
    area_point p;
    double length = sqrt(l->radius * l->radius + tau * tau);
    place(l, l->radius / length, tau / length, &p);
    return p;
}

static area_cursor start_at(const bake_area *a, const area_line *l, double tau)
{
    area_cursor c = {.at = point_at(l, tau)};
    double turns = (l->phi0 + l->sign * atan2(c.at.s, c.at.c)) / (2.0 * pi) + 0.5;
    double column = floor((turns - floor(turns)) * a->panorama->width);
    c.column = column < a->panorama->width ? (uint32_t)column : a->panorama->width - 1;
    double row = floor(acos(c.at.h) / pi * a->panorama->height);
    c.row = row < a->panorama->height ? (uint32_t)row : a->panorama->height - 1;
    return c;
}

static inline double arc_sine(double x)
{
    double x2 = x * x;
    if (x2 > 1e-3)
        return asin(x < -1.0 ? -1.0 : x > 1.0 ? 1.0 : x);
    return x * (1.0 + x2 * (1.0 / 6.0 + x2 * (3.0 / 40.0 + x2 * (15.0 / 336.0 + x2 * (105.0 / 3456.0)))));
}

/* Adds the integral from the cursor to a point within the same texel of the panorama and moves the cursor
 * there. G is the integral over the meridian above (is_above) or minus that below. */
static inline void add_piece(const bake_area *a, const area_line *l, bool is_above, const area_point *to,
                             area_cursor *c, area_sum *sum)
{
    double turn = arc_sine(to->s * c->at.c - to->c * c->at.s);
    double height = arc_sine(l->factor * (to->s * c->at.q - c->at.s * to->q)); /* integral of h dpsi */
    c->at = *to;
    turn = l->sign > 0 ? turn : -turn;
    height = l->sign > 0 ? height : -height;
    size_t width = a->panorama->width;
    uint32_t y = c->row / a->step * a->step;
    const double *above = a->sums[(size_t)(c->row / a->step) * width + c->column];
    double over[3] = {above[0], above[1], above[2]};
    const float *p = (const float *)a->panorama->pixels + 3 * ((size_t)y * width + c->column);
    for (; y < c->row; y++, p += 3 * width) {
        double high = a->heights[y] - a->heights[y + 1];
        for (int k = 0; k < 3; k++)
            over[k] += high * (double)p[k];
    }
    double part = a->heights[c->row] * turn - height;
    for (int k = 0; k < 3; k++) {
        double value = over[k] * turn + (double)p[k] * part;
        sum->of[k] += is_above ? value : value - a->totals[c->column][k] * turn;
    }
    sum->of[3] += is_above ? turn - height : -turn - height;
}

/* Moves to a point within the column, across rows. */
static inline void cross_rows(const bake_area *a, const area_line *l, bool is_above, const area_point *to,
                              area_cursor *c, area_sum *sum)
{
    for (;;) {
        uint32_t edge;
        bool is_up = to->h > a->heights[c->row];
        if (is_up && c->row > 0)
            edge = c->row;
        else if (to->h < a->heights[c->row + 1] && c->row + 1 < a->panorama->height)
            edge = c->row + 1;
        else
            break;
        double cosine = a->tangents[edge] / l->slope;
        cosine = cosine < 1.0 ? cosine : 1.0;
        double sine = sqrt(1.0 - cosine * cosine);
        area_point p;
        place(l, cosine, c->at.s + to->s < 0.0 ? -sine : sine, &p);
        add_piece(a, l, is_above, &p, c, sum);
        c->row = is_up ? c->row - 1 : c->row + 1;
    }
    add_piece(a, l, is_above, to, c, sum);
}

/* Integral of G dphi from the cursor to tau, where the cursor stays. */
static area_sum integrate(const bake_area *a, const area_line *l, bool is_above, double tau, area_cursor *c)
{
    area_sum sum = {{0.0}};
    area_point end = point_at(l, tau);
    uint32_t width = a->panorama->width;
    for (;;) {
        uint32_t edge = l->sign > 0 ? c->column + 1 : c->column;
        double cosine = a->cosines[edge] * l->cosine + a->sines[edge] * l->sine;
        double sine = a->sines[edge] * l->cosine - a->cosines[edge] * l->sine;
        sine = l->sign > 0 ? sine : -sine;
        bool is_crossed = cosine > 0.0 && end.s * cosine - end.c * sine > 0.0;
        area_point next = end;
        if (is_crossed)
            place(l, cosine, sine, &next);
        if (c->at.s < 0.0 && next.s > 0.0) { /* the height has its extremum there */
            area_point top;
            place(l, 1.0, 0.0, &top);
            cross_rows(a, l, is_above, &top, c, &sum);
        }
        cross_rows(a, l, is_above, &next, c, &sum);
        if (!is_crossed)
            return sum;
        c->column = l->sign > 0 ? (c->column + 1 < width ? c->column + 1 : 0)
                                : (c->column > 0 ? c->column - 1 : width - 1);
    }
}

/* ---- texels ---- */

typedef struct area_job {
    const bake_area *area;
    bool is_equiangular;
    float scale;
    cube *out;
    uint32_t tiles_x, tiles_y;
} area_job;

typedef struct area_face {
    double middle[3], right[3], down[3];
    bool is_above;  /* sums above, 0 at the north pole; the face around the south pole sums below */
    bool has_poles; /* its vertical lines are not meridians */
} area_face;

/* Position of the edge before texel i. */
static double edge_at(const area_job *job, uint32_t i)
{
    double at = 2.0 * i / job->out->size - 1.0;
    return !job->is_equiangular || fabs(at) == 1.0 ? at : tan(0.25 * pi * at);
}

static void point_of(const area_face *f, double s, double t, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = f->middle[i] + s * f->right[i] + t * f->down[i];
}

/* Integrals along the edges at t of the texels from x0 on. */
static void integrate_row(const area_job *job, const area_face *f, double t, uint32_t x0, uint32_t count,
                          area_sum *out)
{
    double base[3];
    point_of(f, 0.0, t, base);
    area_line l = make_line(job->area, base, f->right);
    if (l.radius == 0.0) {
        memset(out, 0, count * sizeof *out);
        return;
    }
    area_cursor c = start_at(job->area, &l, edge_at(job, x0));
    for (uint32_t x = 0; x < count; x++)
        out[x] = integrate(job->area, &l, f->is_above, edge_at(job, x0 + x + 1), &c);
}

/* The edge at s from t to down_to. */
static area_sum integrate_down(const area_job *job, const area_face *f, double s, double t, double down_to)
{
    double base[3];
    point_of(f, s, 0.0, base);
    area_line l = make_line(job->area, base, f->down);
    if (!f->has_poles || l.radius == 0.0)
        return (area_sum){{0.0}};
    area_cursor c = start_at(job->area, &l, t);
    return integrate(job->area, &l, f->is_above, down_to, &c);
}

static void fill_tile(const area_job *job, const area_face *f, uint32_t face, uint32_t x0, uint32_t y0)
{
    uint32_t size = job->out->size;
    uint32_t width = size - x0 < TILE_WIDTH ? size - x0 : TILE_WIDTH;
    uint32_t height = size - y0 < TILE_HEIGHT ? size - y0 : TILE_HEIGHT;
    area_sum memory[2][TILE_WIDTH];
    area_sum *above = memory[0];
    area_sum *below = memory[1];
    integrate_row(job, f, edge_at(job, y0), x0, width, above);
    for (uint32_t y = y0; y < y0 + height; y++) {
        double t = edge_at(job, y);
        double next = edge_at(job, y + 1);
        integrate_row(job, f, next, x0, width, below);
        area_sum left = integrate_down(job, f, edge_at(job, x0), t, next);
        for (uint32_t x = 0; x < width; x++) {
            area_sum right = integrate_down(job, f, edge_at(job, x0 + x + 1), t, next);
            double sum[4];
            for (int k = 0; k < 4; k++)
                sum[k] = above[x].of[k] + right.of[k] - below[x].of[k] - left.of[k];
            left = right;
            double scale = (double)job->scale / sum[3];
            *cube_texel(job->out, face, (int)(x0 + x), (int)y) = rgbx_not_negative(
                (rgbx){(float)(sum[0] * scale), (float)(sum[1] * scale), (float)(sum[2] * scale), 0.0f});
        }
        area_sum *swap = above;
        above = below;
        below = swap;
    }
}

static void fill_tiles(void *context, size_t begin, size_t end)
{
    const area_job *job = context;
    uint32_t tiles = job->tiles_x * job->tiles_y;
    for (size_t i = begin; i < end; i++) {
        uint32_t face = (uint32_t)(i / tiles);
        uint32_t tile = (uint32_t)(i % tiles);
        double right[3], down[3];
        area_face f = {.is_above = face != 3, .has_poles = face == 2 || face == 3};
        cube_direction(face, 0.0, 0.0, f.middle);
        cube_direction(face, 1.0, 0.0, right);
        cube_direction(face, 0.0, 1.0, down);
        for (int k = 0; k < 3; k++) {
            f.right[k] = right[k] - f.middle[k];
            f.down[k] = down[k] - f.middle[k];
        }
        fill_tile(job, &f, face, tile % job->tiles_x * TILE_WIDTH, tile / job->tiles_x * TILE_HEIGHT);
    }
}

void bake_area_fill(const bake_area *a, bool is_equiangular, float scale, uint32_t thread_count, cube *out)
{
    area_job job = {.area = a,
                    .is_equiangular = is_equiangular,
                    .scale = scale,
                    .out = out,
                    .tiles_x = (out->size + TILE_WIDTH - 1) / TILE_WIDTH,
                    .tiles_y = (out->size + TILE_HEIGHT - 1) / TILE_HEIGHT};
    parallel_for(thread_count, 6 * (size_t)job.tiles_x * job.tiles_y, 1, fill_tiles, &job);
    cube_fill_borders(out);
}

/* ---- sharp levels ---- */

static bool bake_sharp_is_of_faces(const bake_source *source, uint32_t size)
{
    return source->faces && source->rotation_rad == 0.0 && source->faces->size % size == 0;
}

/* ---- from faces ---- */

typedef struct boxing {
    const cube *from;
    float limit, scale;
    cube *out;
} boxing;

static void box_rows(void *context, size_t begin, size_t end)
{
    const boxing *job = context;
    uint32_t size = job->out->size;
    uint32_t box = job->from->size / size;
    for (uint32_t y = (uint32_t)begin; y < end; y++)
        for (uint32_t x = 0; x < size; x++) {
            double sums[6][3] = {{0.0}};
            double whole = 0.0;
            for (uint32_t k = 0; k < box * box; k++) {
                uint32_t fx = x * box + k % box;
                uint32_t fy = y * box + k / box;
                double w = box > 1 ? cube_texel_solid_angle(job->from->size, fx, fy) : 1.0;
                whole += w;
                for (uint32_t face = 0; face < 6; face++) {
                    rgbx texel = *cube_texel(job->from, face, (int)fx, (int)fy);
                    for (int j = 0; j < 3; j++)
                        sums[face][j] += w * (double)(texel[j] < job->limit ? texel[j] : job->limit);
                }
            }
            double scale = (double)job->scale / whole;
            for (uint32_t face = 0; face < 6; face++)
                *cube_texel(job->out, face, (int)x, (int)y) =
                    (rgbx){(float)(sums[face][0] * scale), (float)(sums[face][1] * scale),
                           (float)(sums[face][2] * scale), 0.0f};
        }
}

/* ---- between texels ---- */

bool bake_sharp_is_interpolated(const bake_source *source, uint32_t size)
{
    return !bake_sharp_is_of_faces(source, size) && 2 * (uint64_t)size > source->panorama.height;
}

typedef struct interpolating {
    const bake_source *source;
    cube *out;
} interpolating;

enum { POINTS = 4 }; /* along a texel's edge, which is no longer than that of the panorama's texels */

DISPATCH_AVX2 static void interpolate_rows(void *context, size_t begin, size_t end)
{
    const interpolating *job = context;
    uint32_t size = job->out->size;
    float c = (float)cos(job->source->rotation_rad);
    float s = (float)sin(job->source->rotation_rad);
    for (size_t i = begin; i < end; i++) {
        uint32_t face = (uint32_t)(i / size);
        uint32_t y = (uint32_t)(i % size);
        for (uint32_t x = 0; x < size; x++) {
            rgbx sum = {0};
            float whole = 0.0f;
            for (uint32_t k = 0; k < POINTS * POINTS; k++) {
                double d[3];
                cube_direction(face, 2.0 * (x + (k % POINTS + 0.5) / POINTS) / size - 1.0,
                               2.0 * (y + (k / POINTS + 0.5) / POINTS) / size - 1.0, d);
                float r = (float)(1.0 / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
                const float e[3] = {((float)d[0] * c - (float)d[2] * s) * r, (float)d[1] * r,
                                    ((float)d[0] * s + (float)d[2] * c) * r};
                float w = r * r * r; /* weight: solid angle */
                sum += equirect_fetch(&job->source->panorama, equirect_locate(e)) * w;
                whole += w;
            }
            *cube_texel(job->out, face, (int)x, (int)y) = sum * (1.0f / whole);
        }
    }
}

/* Restores the mean: points sample a small sun slightly more or less often than its solid angle, and bilinear
 * weights do not integrate to exactly 1. */
static void scale_to_mean(const bake_source *source, float scale, cube *out)
{
    double mean[3];
    rgbx ratio = rgbx_splat(scale);
    cube_mean(out, mean);
    for (int k = 0; k < 3; k++)
        if (mean[k] > 0.0)
            ratio[k] = (float)((double)scale * source->mean[k] / mean[k]);
    size_t stride = (size_t)out->size + 2;
    for (size_t i = 0; i < 6 * stride * stride; i++)
        out->texels[i] *= ratio;
}

facet_result bake_sharp(const bake_source *source, float scale, const facet_allocator *allocator,
                        uint32_t thread_count, cube *out, facet_error *error)
{
    if (bake_sharp_is_of_faces(source, out->size)) {
        boxing job = {.from = source->faces, .limit = source->limit, .scale = scale, .out = out};
        parallel_for(thread_count, out->size, 4, box_rows, &job);
        cube_fill_borders(out);
        return FACET_OK;
    }
    if (bake_sharp_is_interpolated(source, out->size)) {
        interpolating job = {source, out};
        parallel_for(thread_count, 6 * (size_t)out->size, 16, interpolate_rows, &job);
        cube_fill_borders(out);
        scale_to_mean(source, scale, out);
        return FACET_OK;
    }
    bake_area area = {0};
    facet_result result =
        bake_area_create(&source->panorama, source->rotation_rad, allocator, thread_count, &area, error);
    if (result == FACET_OK)
        bake_area_fill(&area, false, scale, thread_count, out);
    bake_area_destroy(&area);
    return result;
}
