/* wave_transform_kiss.c - see wave_transform.h. One-dimensional transforms are kissfft's; rows without
 * waves, at least half of them, are left out.
 *
 * Two real fields share a complex transform: A + iB is read back as its real and imaginary part, and its
 * coefficient is Â + iB̂ at k and conj(Â) + i conj(B̂) at -k. */
#include "ocean/wave_transform.h"

#include <math.h>
#include <string.h>

#include <kiss_fft.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ocean/wave_amplitudes.h"

enum { TRANSFORMS = WAVE_FIELDS / 2, COLUMNS = 4, MAX_SIZE = 1 << (WAVES_MAX_LEVELS - 1) };

/* Of one tile: transforms along x of rows -reach .. reach. */
typedef struct tile_rows {
    kiss_fft_cpx *rows[TRANSFORMS];
} tile_rows;

struct wave_transform {
    kiss_fft_cfg plan; /* e^+i, unscaled; only read */
    tile_rows tiles[WAVES_MAX_TILES];
};

facet_result wave_transform_create(const waves *w, wave_transform **out, facet_error *error)
{
    wave_transform *t = mem_zalloc(&w->allocator, 1, sizeof *t);
    *out = t;
    if (!t)
        return fail_memory(error, "a transform", sizeof *t);
    uint32_t size = w->tiles[0].size;
    size_t plan_size = 0;
    kiss_fft_alloc((int)size, 1, NULL, &plan_size);
    void *plan = mem_alloc(&w->allocator, 1, plan_size);
    if (!plan)
        return fail_memory(error, "a transform", plan_size);
    t->plan = kiss_fft_alloc((int)size, 1, plan, &plan_size);
    for (uint32_t i = 0; i < w->tile_count; i++)
        for (uint32_t j = 0; j < TRANSFORMS; j++) {
            size_t row_count = 2 * (size_t)w->amplitudes[i]->reach + 1;
            t->tiles[i].rows[j] = mem_alloc(&w->allocator, row_count * size, sizeof(kiss_fft_cpx));
            if (!t->tiles[i].rows[j])
                return fail_memory(error, "a transform", row_count * size * sizeof(kiss_fft_cpx));
        }
    return FACET_OK;
}

void wave_transform_destroy(wave_transform *t)
{
    if (!t)
        return;
    mem_free(t->plan);
    for (uint32_t i = 0; i < WAVES_MAX_TILES; i++)
        for (uint32_t j = 0; j < TRANSFORMS; j++)
            mem_free(t->tiles[i].rows[j]);
    mem_free(t);
}

/* ---- coefficients ---- */

/* Factor of h for a field: real, or imaginary. With h = a e^ikx the displacement is i k/|k| h: water moves
 * towards crests. */
typedef struct factor {
    float value;
    bool is_imaginary;
} factor;

static factor factor_of(wave_field f, float k_x, float k_z, float stretch)
{
    switch (f) {
    case WAVE_DX:
        return (factor){stretch * k_x, true};
    case WAVE_DZ:
        return (factor){stretch * k_z, true};
    case WAVE_ETA_X:
        return (factor){k_x, true};
    case WAVE_ETA_Z:
        return (factor){k_z, true};
    case WAVE_DXX:
        return (factor){-stretch * k_x * k_x, false};
    case WAVE_DZZ:
        return (factor){-stretch * k_z * k_z, false};
    case WAVE_DXZ:
        return (factor){-stretch * k_x * k_z, false};
    case WAVE_ETA:
    case WAVE_FIELDS:
        break;
    }
    return (factor){1.0f, false};
}

static kiss_fft_cpx scaled(const float h[2], factor f)
{
    if (f.is_imaginary)
        return (kiss_fft_cpx){-f.value * h[1], f.value * h[0]};
    return (kiss_fft_cpx){f.value * h[0], f.value * h[1]};
}

/* Writes the buffer's rows, the first of which is n_z = -reach. */
static void put_mode(kiss_fft_cpx *rows, int32_t reach, int32_t size, const wave_mode *m, kiss_fft_cpx a,
                     kiss_fft_cpx b)
{
    ptrdiff_t there = (ptrdiff_t)(reach + m->n_z) * size + (m->n_x & (size - 1));
    ptrdiff_t back = (ptrdiff_t)(reach - m->n_z) * size + (-m->n_x & (size - 1));
    rows[there] = (kiss_fft_cpx){a.r - b.i, a.i + b.r};
    rows[back] = (kiss_fft_cpx){a.r + b.i, b.r - a.i};
}

/* ---- along x ---- */

typedef struct run {
    wave_transform *transform;
    waves *w;
} run;

static void transform_rows(void *context, size_t begin, size_t end)
{
    const run *r = context;
    for (size_t item = begin; item < end; item++) {
        size_t tile = item / TRANSFORMS, j = item % TRANSFORMS;
        const wave_amplitudes *a = r->w->amplitudes[tile];
        int32_t size = (int32_t)r->w->tiles[tile].size;
        kiss_fft_cpx *rows = r->transform->tiles[tile].rows[j];
        size_t row_count = 2 * (size_t)a->reach + 1;
        memset(rows, 0, row_count * (size_t)size * sizeof *rows);
        for (size_t i = 0; i < a->count; i++) {
            const wave_mode *m = &a->modes[i];
            float k_x = (float)(a->k_step * m->n_x), k_z = (float)(a->k_step * m->n_z);
            kiss_fft_cpx first = scaled(a->now[i], factor_of((wave_field)(2 * j), k_x, k_z, m->stretch));
            kiss_fft_cpx second = scaled(a->now[i], factor_of((wave_field)(2 * j + 1), k_x, k_z, m->stretch));
            put_mode(rows, a->reach, size, m, first, second);
        }
        kiss_fft_cpx in[MAX_SIZE];
        for (size_t row = 0; row < row_count; row++) {
            memcpy(in, rows + row * (size_t)size, (size_t)size * sizeof *in);
            kiss_fft(r->transform->plan, in, rows + row * (size_t)size);
        }
    }
}

/* ---- along z ---- */

/* Writes the pair of fields j of a few columns to the texels. */
static void transform_columns(const run *r, size_t tile, size_t j, size_t first)
{
    int32_t reach = r->w->amplitudes[tile]->reach;
    size_t size = r->w->tiles[tile].size;
    const kiss_fft_cpx *rows = r->transform->tiles[tile].rows[j];
    kiss_fft_cpx in[MAX_SIZE], out[COLUMNS][MAX_SIZE];
    memset(in, 0, size * sizeof *in);
    for (size_t c = 0; c < COLUMNS; c++) {
        for (int32_t n = -reach; n <= reach; n++)
            in[(size_t)n & (size - 1)] = rows[(size_t)(reach + n) * size + first + c];
        kiss_fft(r->transform->plan, in, out[c]);
    }
    float *texels = r->w->tiles[tile].levels[0];
    for (size_t z = 0; z < size; z++)
        for (size_t c = 0; c < COLUMNS; c++) {
            float *texel = texels + (z * size + first + c) * WAVE_FIELDS + 2 * j;
            texel[0] = out[c][z].r;
            texel[1] = out[c][z].i;
        }
}

static void transform_blocks(void *context, size_t begin, size_t end)
{
    const run *r = context;
    size_t blocks = r->w->tiles[0].size / COLUMNS;
    for (size_t item = begin; item < end; item++)
        for (size_t j = 0; j < TRANSFORMS; j++)
            transform_columns(r, item / blocks, j, item % blocks * COLUMNS);
}

void wave_transform_run(wave_transform *t, waves *w)
{
    run r = {t, w};
    parallel_for(w->thread_count, (size_t)w->tile_count * TRANSFORMS, 1, transform_rows, &r);
    size_t blocks = w->tiles[0].size / COLUMNS;
    parallel_for(w->thread_count, w->tile_count * blocks, 4, transform_blocks, &r);
}

/* ---- two fields alone ---- */

typedef struct pair_run {
    const wave_transform *transform;
    const waves *w;
    const wave_pair *p;
} pair_run;

static void transform_pair_rows(void *context, size_t begin, size_t end)
{
    const pair_run *r = context;
    size_t size = r->w->tiles[0].size;
    kiss_fft_cpx in[MAX_SIZE], *rows = (kiss_fft_cpx *)r->p->rows;
    for (size_t row = begin; row < end; row++) {
        memcpy(in, rows + row * size, size * sizeof *in);
        kiss_fft(r->transform->plan, in, rows + row * size);
    }
}

static void transform_pair_columns(void *context, size_t begin, size_t end)
{
    const pair_run *r = context;
    int32_t reach = r->w->amplitudes[r->p->tile]->reach;
    size_t size = r->w->tiles[0].size;
    const kiss_fft_cpx *rows = (const kiss_fft_cpx *)r->p->rows;
    kiss_fft_cpx in[MAX_SIZE], out[COLUMNS][MAX_SIZE];
    memset(in, 0, size * sizeof *in);
    for (size_t first = begin * COLUMNS; first < end * COLUMNS; first += COLUMNS) {
        for (size_t c = 0; c < COLUMNS; c++) {
            for (int32_t n = -reach; n <= reach; n++)
                in[(size_t)n & (size - 1)] = rows[(size_t)(reach + n) * size + first + c];
            kiss_fft(r->transform->plan, in, out[c]);
        }
        for (size_t z = 0; z < size; z++)
            for (size_t c = 0; c < COLUMNS; c++) {
                r->p->fields[0][z * size + first + c] = out[c][z].r;
                r->p->fields[1][z * size + first + c] = out[c][z].i;
            }
    }
}

void wave_transform_pair(const wave_transform *t, const waves *w, const wave_pair *p)
{
    const wave_amplitudes *a = w->amplitudes[p->tile];
    size_t size = w->tiles[0].size, row_count = 2 * (size_t)a->reach + 1;
    kiss_fft_cpx *rows = (kiss_fft_cpx *)p->rows;
    memset(rows, 0, row_count * size * sizeof *rows);
    for (size_t i = 0; i < a->count; i++) {
        const float(*c)[2] = (const float(*)[2])p->coefficients[i];
        put_mode(rows, a->reach, (int32_t)size, &a->modes[i], (kiss_fft_cpx){c[0][0], c[0][1]},
                 (kiss_fft_cpx){c[1][0], c[1][1]});
    }
    pair_run r = {t, w, p};
    parallel_for(w->thread_count, row_count, 64, transform_pair_rows, &r);
    parallel_for(w->thread_count, size / COLUMNS, 16, transform_pair_columns, &r);
}
