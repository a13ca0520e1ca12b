/* sphere_resample.c - see sphere.h. The first pass clamps bright texels of the source to a limit and marks the
 * spans of the target that they reach. The lookups that cover each bright texel then add up their solid angles,
 * by which its excess over the limit is scaled, and a second pass resamples the marked spans with it. */
#include "ibl/sphere.h"

#include <stdatomic.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

static const double pi = 3.14159265358979323846;

/* A texel is bright if it is brighter than this many times the mean. */
static const double bright_contrast = 16.0;

/* Solid angles are counted in integer units per steradian, so that sums do not depend on the order of
 * threads. */
static const double parts_per_sr = 0x1p50;

/* A bright texel of the source. */
typedef struct bright_texel {
    size_t texel;
    _Atomic uint64_t covered; /* solid angle covered by lookups */
    rgbx excess;              /* over the limit; from the second pass on scaled to its lookups */
} bright_texel;

typedef struct resampling {
    const sphere *source, *target;
    const sphere_turn *turn;
    uint32_t parts;      /* a texel of the target is looked up parts x parts times */
    float (*columns)[2]; /* equirectangular target: cosine and sine of the longitude of each part of a row */
    float limit;         /* limit of texels that are not bright */
    uint32_t *bright_indices; /* indices of the bright texels by source texel, from 1 on; NULL: none */
    bright_texel *bright;
    size_t bright_count;
    uint32_t span;        /* texels of a row that are resampled at a time */
    uint32_t span_count;  /* of a row */
    bool *is_near_bright; /* per row and span of the target: lookups hit bright texels, or may do so */
    bool is_second_pass;  /* excesses are scaled; only spans near bright texels are resampled */
} resampling;

/* ---- the parts of a target's texels ---- */

/* Constants of the directions in a row of parts. */
typedef struct part_row {
    float base[3], right[3]; /* of a cube: d = base + s right */
    float v, step;           /* of an octahedron */
    float radius, height;    /* of latitudes */
    float weight;            /* solid angle at a latitude, sr; for a cube the factor of 1 / |d|^3 */
} part_row;

static part_row start_row(const resampling *r, uint32_t face, uint32_t row)
{
    const sphere *t = r->target;
    part_row p = {0};
    uint32_t rows = t->height * r->parts;
    if (t->kind == SPHERE_EQUIRECT) {
        double theta = pi * (row + 0.5) / rows;
        p.radius = (float)sin(theta);
        p.height = (float)cos(theta);
        p.weight = (float)equirect_texel_solid_angle(t->width * r->parts, rows, row);
        return p;
    }
    double step = 2.0 / rows;
    double v = (row + 0.5) * step - 1.0;
    p.weight = (float)(step * step);
    p.v = (float)v;
    p.step = (float)step;
    if (t->kind == SPHERE_CUBE) {
        double base[3], end[3];
        cube_direction(face, 0.0, v, base);
        cube_direction(face, 1.0, v, end);
        for (int i = 0; i < 3; i++) {
            p.base[i] = (float)base[i];
            p.right[i] = (float)(end[i] - base[i]);
        }
    }
    return p;
}

static void get_latitude_parts(const resampling *r, const part_row *p, uint32_t first, uint32_t count,
                               sphere_batch *out)
{
    for (uint32_t i = 0; i < count; i++) {
        out->x[i] = r->columns[first + i][0] * p->radius;
        out->y[i] = p->height;
        out->z[i] = r->columns[first + i][1] * p->radius;
        out->weight[i] = p->weight;
    }
}

static void get_cube_parts(const resampling *r, const part_row *p, uint32_t first, uint32_t count,
                           sphere_batch *out)
{
    float columns = (float)(r->target->width * r->parts);
    for (uint32_t i = 0; i < count; i++) {
        float u = (2.0f * (float)(first + i) + 1.0f) / columns - 1.0f;
        float x = p->base[0] + u * p->right[0];
        float y = p->base[1] + u * p->right[1];
        float z = p->base[2] + u * p->right[2];
        float q = x * x + y * y + z * z;
        out->x[i] = x;
        out->y[i] = y;
        out->z[i] = z;
        out->weight[i] = p->weight / (q * sqrtf(q));
    }
}

static void get_octahedron_parts(const resampling *r, const part_row *p, uint32_t first, uint32_t count,
                                 sphere_batch *out)
{
    float columns = (float)(r->target->width * r->parts);
    for (uint32_t i = 0; i < count; i++) {
        float u = (2.0f * (float)(first + i) + 1.0f) / columns - 1.0f;
        float d[3];
        octahedron_direction(u, p->v, d);
        out->x[i] = d[0];
        out->y[i] = d[1];
        out->z[i] = d[2];
        out->weight[i] = octahedron_solid_angle(u, p->v, p->step);
    }
}

static void rotate_to_source(const sphere_turn *turn, uint32_t count, sphere_batch *b)
{
    const float(*m)[3] = turn->rows;
    for (uint32_t i = 0; i < count; i++) {
        float x = b->x[i], y = b->y[i], z = b->z[i];
        b->x[i] = m[0][0] * x + m[0][1] * y + m[0][2] * z;
        b->y[i] = m[1][0] * x + m[1][1] * y + m[1][2] * z;
        b->z[i] = m[2][0] * x + m[2][1] * y + m[2][2] * z;
    }
}

/* Looks up count parts of a row from column first on: directions in the source, solid angles, radiance
 * clamped to the limit. */
static void look_up_parts(const resampling *r, const part_row *p, uint32_t first, uint32_t count,
                          sphere_batch *out)
{
    switch (r->target->kind) {
    case SPHERE_EQUIRECT:
        get_latitude_parts(r, p, first, count, out);
        break;
    case SPHERE_CUBE:
        get_cube_parts(r, p, first, count, out);
        break;
    case SPHERE_OCTAHEDRON:
        get_octahedron_parts(r, p, first, count, out);
        break;
    }
    if (r->turn->is_turned)
        rotate_to_source(r->turn, count, out);
    sphere_look_up(r->source, out, count, r->limit);
}

static bool make_columns(resampling *r, const facet_allocator *allocator)
{
    uint32_t count = r->target->width * r->parts;
    if (r->target->kind != SPHERE_EQUIRECT)
        return true;
    r->columns = mem_alloc(allocator, count, sizeof *r->columns);
    for (uint32_t i = 0; r->columns && i < count; i++) {
        double phi = 2.0 * pi * ((i + 0.5) / count - 0.5);
        r->columns[i][0] = (float)cos(phi);
        r->columns[i][1] = (float)sin(phi);
    }
    return r->columns != NULL;
}

/* Approximate least width of a texel, rad. */
static double finest_angle(const sphere *s)
{
    return s->kind == SPHERE_EQUIRECT ? pi / s->height
           : s->kind == SPHERE_CUBE   ? 0.94 / s->width
                                      : 1.4 / s->width;
}

static double coarsest_angle(const sphere *s)
{
    return s->kind == SPHERE_EQUIRECT ? pi / s->height
           : s->kind == SPHERE_CUBE   ? 2.0 / s->width
                                      : 3.5 / s->width;
}

/* 1.8 lookups per texel of the source and at least 2 in each direction; more in small targets, whose solid
 * angles are sums over lookups. */
static uint32_t choose_parts(const sphere *source, const sphere *target)
{
    double ratio = coarsest_angle(target) / finest_angle(source);
    uint32_t parts = ratio < 1.0 ? 2 : (uint32_t)ceil(1.8 * ratio);
    uint32_t rows = target->kind == SPHERE_EQUIRECT ? 64 : 256;
    uint32_t least = (rows - 1 + target->height) / target->height;
    parts = parts > least ? parts : least;
    return target->kind == SPHERE_OCTAHEDRON ? parts + parts * target->width % 2
                                             : parts; /* folds through corners */
}

/* ---- bright texels ---- */

/* Sums of a row of the source. */
typedef struct row_survey {
    double sum;            /* sum of all channels, clamped to the limit */
    uint32_t bright_count; /* texels above the limit */
} row_survey;

typedef struct survey {
    const sphere *source;
    float limit;
    row_survey *rows;
} survey;

/* The first texel of a row, and the floats from one texel to the next. */
static const float *get_row(const sphere *s, size_t row, size_t *step)
{
    if (s->kind == SPHERE_CUBE) {
        *step = sizeof(rgbx) / sizeof(float);
        return (const float *)cube_texel(s->cube, (uint32_t)(row / s->height), 0, (int)(row % s->height));
    }
    *step = s->channel_count;
    return s->pixels + row * s->width * s->channel_count;
}

static bool is_bright(const float *c, float limit)
{
    return (c[0] > limit) | (c[1] > limit) | (c[2] > limit);
}

static void survey_rows(void *context, size_t begin, size_t end)
{
    const survey *v = context;
    const float limit = v->limit;
    for (size_t row = begin; row < end; row++) {
        double sums[3] = {0.0, 0.0, 0.0};
        uint32_t bright_count = 0;
        size_t step;
        const float *c = get_row(v->source, row, &step);
        for (uint32_t x = 0; x < v->source->width; x++, c += step) {
            for (int k = 0; k < 3; k++)
                sums[k] += (double)(c[k] < limit ? c[k] : limit);
            bright_count += is_bright(c, limit);
        }
        v->rows[row] = (row_survey){sums[0] + sums[1] + sums[2], bright_count};
    }
}

static size_t count_rows(const sphere *s)
{
    return (size_t)s->height * (s->kind == SPHERE_CUBE ? 6 : 1);
}

/* The limit: about bright_contrast times the mean of the texels that are not bright, so that a dominant sun hardly
 * raises it; infinite in the dark. At most 1 / bright_contrast of all texels are above it. The mean is not
 * weighted by solid angle, since it affects accuracy only. Leaves the number of bright texels of each row in
 * v->rows. */
static void choose_limit(survey *v, uint32_t thread_count)
{
    enum { ROUNDS = 4 };
    const size_t rows = count_rows(v->source);
    v->limit = INFINITY;
    for (int round = 0; round <= ROUNDS; round++) {
        parallel_for(thread_count, rows, 16, survey_rows, v);
        double sum = 0.0;
        for (size_t row = 0; row < rows; row++)
            sum += v->rows[row].sum;
        const double limit = bright_contrast * sum / (3.0 * (double)sphere_texel_count(v->source));
        if (round < ROUNDS)
            v->limit = limit > 0.0 ? (float)limit : INFINITY;
    }
}

/* Lists the bright texels. */
static void list_bright(resampling *r, const row_survey *rows)
{
    uint32_t number = 0;
    for (size_t row = 0; number < r->bright_count; row++) {
        size_t step;
        const float *c = get_row(r->source, row, &step);
        for (uint32_t x = 0; x < r->source->width && rows[row].bright_count > 0; x++, c += step) {
            if (!is_bright(c, r->limit))
                continue;
            bright_texel *h = &r->bright[number];
            h->texel = row * r->source->width + x;
            h->excess = rgbx_not_negative((rgbx){c[0], c[1], c[2], 0.0f} - rgbx_splat(r->limit));
            atomic_init(&h->covered, 0);
            r->bright_indices[h->texel] = ++number;
        }
    }
}

/* Indexes the bright texels. False: out of memory. */
static bool find_bright(resampling *r, const facet_allocator *allocator, uint32_t thread_count)
{
    const size_t rows = count_rows(r->source);
    survey v = {.source = r->source, .rows = mem_alloc(allocator, rows, sizeof *v.rows)};
    if (!v.rows)
        return false;
    choose_limit(&v, thread_count);
    for (size_t row = 0; row < rows; row++)
        r->bright_count += v.rows[row].bright_count;
    r->limit = r->bright_count ? v.limit : INFINITY;
    if (r->bright_count) {
        r->bright_indices = mem_zalloc(allocator, sphere_texel_count(r->source), sizeof *r->bright_indices);
        r->bright = mem_alloc(allocator, r->bright_count, sizeof *r->bright);
        if (r->bright_indices && r->bright)
            list_bright(r, v.rows);
    }
    mem_free(v.rows);
    return r->bright_count == 0 || (r->bright_indices && r->bright);
}

/* The bright texel at an index of the source; NULL: it is not bright. */
static bright_texel *bright_at(const resampling *r, size_t texel)
{
    uint32_t number = r->bright_indices[texel];
    return number ? &r->bright[number - 1] : NULL;
}

static void find_part(const resampling *r, const sphere_batch *b, uint32_t i, sphere_footprint *out)
{
    sphere_find(r->source, (const float[3]){b->x[i], b->y[i], b->z[i]}, out);
}

/* Adds the solid angle of bright texels covered by a lookup. */
static void cover(const resampling *r, const sphere_footprint *f, double solid_angle)
{
    for (uint32_t k = 0; k < f->count; k++) {
        bright_texel *h = bright_at(r, f->texels[k]);
        if (h)
            atomic_fetch_add_explicit(&h->covered,
                                      (uint64_t)(solid_angle * (double)f->weights[k] * parts_per_sr),
                                      memory_order_relaxed);
    }
}

/* Adds the solid angles of bright texels covered by the lookups of a span. */
static void cover_span(const resampling *r, uint32_t face, uint32_t y, uint32_t x, uint32_t count)
{
    const uint32_t end = (x + count) * r->parts;
    for (uint32_t row = 0; row < r->parts; row++) {
        part_row p = start_row(r, face, y * r->parts + row);
        for (uint32_t i = x * r->parts; i < end; i += SPHERE_BATCH) {
            sphere_batch b;
            const uint32_t parts = end - i < SPHERE_BATCH ? end - i : SPHERE_BATCH;
            look_up_parts(r, &p, i, parts, &b);
            for (uint32_t k = 0; k < parts; k++) {
                sphere_footprint f;
                if (!b.is_cut[k])
                    continue;
                find_part(r, &b, k, &f);
                cover(r, &f, (double)b.weight[k]);
            }
        }
    }
}

static void cover_rows(void *context, size_t begin, size_t end)
{
    const resampling *r = context;
    const sphere *t = r->target;
    for (size_t i = begin; i < end; i++)
        for (uint32_t s = 0, x = 0; s < r->span_count; s++, x += r->span)
            if (r->is_near_bright[i * r->span_count + s])
                cover_span(r, (uint32_t)(i / t->height), (uint32_t)(i % t->height), x,
                           t->width - x < r->span ? t->width - x : r->span);
}

/* Scales excess radiance so that all lookups together have the texel's energy. */
static void scale_excesses(resampling *r)
{
    for (size_t i = 0; i < r->bright_count; i++) {
        bright_texel *h = &r->bright[i];
        double covered = (double)atomic_load(&h->covered) / parts_per_sr;
        if (covered > 0.0)
            h->excess *= rgbx_splat((float)(sphere_solid_angle(r->source, h->texel) / covered));
    }
}

/* ---- texels ---- */

static void store_texel(const sphere *t, uint32_t face, uint32_t x, uint32_t y, rgbx c)
{
    if (t->kind == SPHERE_CUBE) {
        *cube_texel(t->cube, face, (int)x, (int)y) = c;
        return;
    }
    float *to = t->pixels + ((size_t)y * t->width + x) * t->channel_count;
    for (int i = 0; i < 3; i++)
        to[i] = c[i];
    if (t->channel_count == 4)
        to[3] = 1.0f;
}

/* Radiance of a lookup near bright texels. */
static rgbx look_up_bright(const resampling *r, const sphere_footprint *f)
{
    rgbx sum = {0};
    for (uint32_t k = 0; k < f->count; k++) {
        rgbx c = sphere_texel(r->source, f->texels[k]);
        const bright_texel *h = bright_at(r, f->texels[k]);
        if (h)
            c = c - rgbx_not_negative(c - rgbx_splat(r->limit)) + h->excess;
        sum += c * rgbx_splat(f->weights[k]);
    }
    return sum;
}

/* Sums of a texel: radiance times solid angle, and solid angle. */
typedef struct texel_sum {
    rgbx flux;
    float solid_angle;
} texel_sum;

/* Adds a row of lookups, from column first on, to the sums of their texels; each row is summed separately
 * first, which keeps rounding errors small. True: a bright texel was clamped. */
static bool add_parts(const resampling *r, const part_row *p, uint32_t first, uint32_t count, texel_sum *sums)
{
    sphere_batch b;
    bool is_any_cut = false;
    look_up_parts(r, p, first, count, &b);
    for (uint32_t k = 0; k < count; k++) {
        sphere_footprint f;
        is_any_cut |= b.is_cut[k];
        if (!b.is_cut[k] || !r->is_second_pass)
            continue;
        find_part(r, &b, k, &f);
        b.radiance[k] = look_up_bright(r, &f);
    }
    for (uint32_t k = 0; k < count;) {
        uint32_t end = (first + k) / r->parts * r->parts + r->parts - first; /* of the texel */
        rgbx flux = {0};
        float solid_angle = 0.0f;
        for (end = end < count ? end : count; k < end; k++) {
            flux += b.radiance[k] * b.weight[k];
            solid_angle += b.weight[k];
        }
        texel_sum *s = &sums[(first + k - 1) / r->parts - first / r->parts];
        s->flux += flux;
        s->solid_angle += solid_angle;
    }
    return is_any_cut;
}

/* Texels x .. x + count - 1 of a row, in one batch per row of lookups, or several per texel. True: a bright
 * texel was clamped. */
static bool resample_span(const resampling *r, uint32_t face, uint32_t y, uint32_t x, uint32_t count)
{
    texel_sum sums[SPHERE_BATCH];
    bool is_any_cut = false;
    for (uint32_t i = 0; i < count; i++)
        sums[i] = (texel_sum){{0.0f, 0.0f, 0.0f, 0.0f}, 0.0f};
    for (uint32_t row = 0; row < r->parts; row++) {
        part_row p = start_row(r, face, y * r->parts + row);
        uint32_t parts = count * r->parts;
        for (uint32_t k = 0; k < parts; k += SPHERE_BATCH)
            is_any_cut |=
                add_parts(r, &p, x * r->parts + k, parts - k < SPHERE_BATCH ? parts - k : SPHERE_BATCH, sums);
    }
    for (uint32_t i = 0; i < count; i++)
        store_texel(r->target, face, x + i, y,
                    sums[i].flux * rgbx_splat(r->turn->scale / sums[i].solid_angle));
    return is_any_cut;
}

static void resample_rows(void *context, size_t begin, size_t end)
{
    const resampling *r = context;
    const sphere *t = r->target;
    for (size_t i = begin; i < end; i++)
        for (uint32_t s = 0, x = 0; s < r->span_count; s++, x += r->span) {
            bool *is_near_bright = &r->is_near_bright[i * r->span_count + s];
            if (*is_near_bright || !r->is_second_pass)
                *is_near_bright = resample_span(r, (uint32_t)(i / t->height), (uint32_t)(i % t->height), x,
                                                t->width - x < r->span ? t->width - x : r->span);
        }
}

facet_result sphere_resample(const sphere *source, const sphere_turn *turn, const facet_allocator *allocator,
                             uint32_t thread_count, const sphere *target, facet_error *error)
{
    static const sphere_turn as_it_is = {.scale = 1.0f};
    resampling r = {.source = source,
                    .target = target,
                    .turn = turn ? turn : &as_it_is,
                    .parts = turn && turn->parts ? turn->parts : choose_parts(source, target)};
    const size_t rows = count_rows(target);
    facet_result result = FACET_OK;
    r.span = r.parts < SPHERE_BATCH ? SPHERE_BATCH / r.parts : 1;
    r.span_count = (target->width - 1) / r.span + 1;
    r.is_near_bright = mem_zalloc(allocator, rows, r.span_count);
    if (!r.is_near_bright || !make_columns(&r, allocator) || !find_bright(&r, allocator, thread_count)) {
        result = fail_memory(error, "resampling", sphere_texel_count(source) * sizeof *r.bright_indices);
    } else {
        parallel_for(thread_count, rows, 2, resample_rows, &r);
        if (r.bright) { /* spans near bright texels, once more */
            parallel_for(thread_count, rows, 2, cover_rows, &r);
            scale_excesses(&r);
            r.is_second_pass = true;
            parallel_for(thread_count, rows, 2, resample_rows, &r);
        }
    }
    mem_free(r.is_near_bright);
    mem_free(r.columns);
    mem_free(r.bright_indices);
    mem_free(r.bright);
    return result;
}
