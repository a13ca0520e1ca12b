/* water_caustics.c - see water_caustics.h. Points of still water whose light would fall on a regular grid
 * of the bed are displaced by the waves, weighted by the light on the water there; positions in between
 * are interpolated, and each point is splatted onto the four texels around it. Watt 1990 has the beams,
 * Yuksel and Keyser 2009 the grid. A model occludes each point by rays to a few places around it; by many,
 * where neighboring points differ. */
#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

#include "water/shadow_points.h"
#include "water/water_caustics.h"

enum {
    TEXELS_PER_NODE = 2,
    POINTS_PER_NODE = 4, /* along each axis */
    BAND = 64,           /* rows of a layer that are filled together */
    BANDS = CAUSTIC_SIZE / BAND,
    MAX_MARGIN = CAUSTIC_SIZE / TEXELS_PER_NODE / 2, /* nodes */
    MAX_NODES = CAUSTIC_SIZE / TEXELS_PER_NODE + 2 * MAX_MARGIN + 3,
    MAX_REACH = 8 /* nodes */
};

/* Landing position of each node's light, in texels from the layer's corner, and its weight: planes of count x
 * count. */
typedef struct nodes {
    int32_t margin; /* nodes before the layer begins */
    size_t count;   /* along an edge; one before the first that counts, two behind the last */
    float *u, *v, *weight;
    float *lowest, *highest; /* v of each row */
    double *sums;            /* weight of each row's light without a model */
    /* With a model: visibility at each node, and its minimum and maximum along the row within an edge's
     * reach. */
    float *open, *least, *most;
    int32_t reach; /* nodes from where the sun's center is hidden to where the whole disc is visible */
} nodes;

typedef struct making {
    const caustic_source *source;
    const caustic_plan *plans;
    caustic_map *map;
    nodes nodes[CAUSTIC_LAYERS];
    float *scratch[CAUSTIC_LAYERS]; /* CAUSTIC_SIZE^2 */
    float per_point;                /* contribution of a point of mean weight to a texel */
    vec3 still;                     /* direction of light below still water */
    shadow_point points[SHADOW_POINTS];
} making;

/* ---- rays ---- */

static double bed_at(const caustic_source *s, double X, double Z)
{
    return s->bed_height + s->bed_rise[0] * X + s->bed_rise[1] * Z;
}

/* Distance along d to the bed from a point `above` m above it. */
static double distance_to_bed(const caustic_source *s, vec3 d, double above)
{
    double closing = s->bed_rise[0] * (double)d[0] + s->bed_rise[1] * (double)d[2] - (double)d[1];
    return fmax(above, 0.0) / fmax(closing, 1e-3);
}

/* Light incident on a piece of the surface relative to still, non-reflecting water: (1 - F) L.A / L.y of the
 * area vector A. The mean of A over the sea is upright. */
static float light_on(const caustic_source *s, const wave_point *p, vec3 N)
{
    float J = wave_jacobian(vec3(p->Dxx, p->Dzz, p->Dxz));
    vec3 A = N * (max(J, 0.02f) / N[1]);
    float facing = dot(A, s->L) / s->L[1];
    return facing > 0.0f ? facing * (1.0f - water_fresnel(s->water, clamp(dot(N, s->L), 0.0f, 1.0f))) : 0.0f;
}

/* The path of light from a node through the surface to the bed. */
typedef struct node_ray {
    double from[3], length_m; /* m */
    vec3 d;
    float light; /* without a model */
} node_ray;

/* The node whose light falls on (X, Z) through still water. */
static node_ray trace_node(const making *m, double X, double Z, float footprint_m)
{
    const caustic_source *s = m->source;
    double back = fmax(-bed_at(s, X, Z), 0.0) / -(double)m->still[1];
    double rest[2] = {X - back * (double)m->still[0], Z - back * (double)m->still[2]};
    wave_point p = waves_at(s->waves, rest[0], rest[1], footprint_m);
    vec3 N = wave_normal(vec2(p.slope[0], p.slope[1]), vec3(p.Dxx, p.Dzz, p.Dxz));
    node_ray r = {.from = {rest[0] + (double)p.displacement[0], (double)p.height_m,
                           rest[1] + (double)p.displacement[1]}};
    r.d = water_refracted(s->water, -s->L, N);
    r.length_m = distance_to_bed(s, r.d, r.from[1] - bed_at(s, r.from[0], r.from[2]));
    r.light = light_on(s, &p, N);
    return r;
}

/* Node i of a row. */
static node_ray trace_at(const making *m, uint32_t l, size_t i, size_t row)
{
    const caustic_layer *layer = &m->map->layers[l];
    const float *axis = m->map->axis;
    double spacing = (double)(TEXELS_PER_NODE * layer->texel_m), half = 0.5 * CAUSTIC_SIZE / TEXELS_PER_NODE;
    double u = ((double)i - m->nodes[l].margin - 1 - half) * spacing;
    double v = ((double)row - m->nodes[l].margin - 1 - half) * spacing;
    return trace_node(m, layer->middle[0] + u * (double)axis[0] - v * (double)axis[1],
                      layer->middle[1] + u * (double)axis[1] + v * (double)axis[0], layer->texel_m);
}

/* ---- a model's shadow ---- */

/* Visibility of L past the model for a point (u, v) m beside a node, and from there to the bed. */
static float model_visibility(const making *m, const node_ray *r, double u, double v, vec3 L)
{
    const caustic_source *s = m->source;
    const double a = (double)m->map->axis[0], b = (double)m->map->axis[1];
    const double P[3] = {r->from[0] + u * a - v * b, r->from[1], r->from[2] + u * b + v * a};
    float above = water_model_visibility(s->model, P, L, HUGE_VAL);
    return above > 0.0f ? above * water_model_visibility(s->model, P, r->d, r->length_m) : 0.0f;
}

/* From the sun's center to four points of a node's area, one in each quadrant; different ones for each
 * node, so that a whole row of nodes cannot miss a thin occluder. */
static float passing_few(const making *m, const node_ray *r, size_t i, size_t row, double spacing_m)
{
    const float shift[2] = {fract(0.7548777f * (float)i + 0.5698403f * (float)row),
                            fract(0.5698403f * (float)i + 0.7548777f * (float)row)};
    float sum = 0.0f;
    for (int k = 0; k < 4; k++)
        sum += 0.25f * model_visibility(m, r, spacing_m * (double)(0.5f * ((float)(k % 2) + shift[0]) - 0.5f),
                                        spacing_m * (double)(0.5f * ((float)(k / 2) + shift[1]) - 0.5f),
                                        m->source->L);
    return sum;
}

static float passing_many(const making *m, const node_ray *r, double spacing_m)
{
    float sum = 0.0f;
    for (int k = 0; k < SHADOW_POINTS; k++)
        sum += model_visibility(m, r, spacing_m * (double)m->points[k].aside[0],
                                spacing_m * (double)m->points[k].aside[1], m->points[k].L);
    return sum / SHADOW_POINTS;
}

/* Minimum and maximum along a row, within an edge's reach on each side. */
static void range_along(const nodes *n, size_t row)
{
    const float *open = n->open + row * n->count;
    for (size_t i = 0; i < n->count; i++) {
        size_t reach = (size_t)n->reach, first = i > reach ? i - reach : 0;
        size_t last = i + reach < n->count ? i + reach : n->count - 1;
        float low = open[first], high = open[first];
        for (size_t k = first + 1; k <= last; k++) {
            low = fminf(low, open[k]);
            high = fmaxf(high, open[k]);
        }
        n->least[row * n->count + i] = low;
        n->most[row * n->count + i] = high;
    }
}

static bool is_at_edge(const nodes *n, size_t i, size_t row)
{
    size_t reach = (size_t)n->reach, last = row + reach < n->count ? row + reach : n->count - 1;
    float low = INFINITY, high = -INFINITY;
    for (size_t k = row > reach ? row - reach : 0; k <= last; k++) {
        low = fminf(low, n->least[k * n->count + i]);
        high = fmaxf(high, n->most[k * n->count + i]);
    }
    return low < high;
}

/* The model occludes a node's light; near shadow edges, by the mean over the node's area and the sun's disc. */
static void shade_row(const making *m, uint32_t l, size_t row)
{
    const nodes *n = &m->nodes[l];
    double spacing = (double)(TEXELS_PER_NODE * m->map->layers[l].texel_m);
    for (size_t i = 0; i < n->count; i++) {
        float *weight = &n->weight[row * n->count + i], open = n->open[row * n->count + i];
        if (*weight > 0.0f && is_at_edge(n, i, row)) {
            node_ray r = trace_at(m, l, i, row);
            open = passing_many(m, &r, spacing);
        }
        *weight *= open;
    }
}

static void shade_rows(void *context, size_t begin, size_t end)
{
    const making *m = context;
    for (size_t i = begin; i < end; i++)
        if (i / CAUSTIC_LAYERS < m->nodes[i % CAUSTIC_LAYERS].count)
            shade_row(m, (uint32_t)(i % CAUSTIC_LAYERS), i / CAUSTIC_LAYERS);
}

/* How far, in nodes, the size of the disc moves the shadow of the model's top on the water. */
static int32_t reach_of(const caustic_source *s, float spacing_m)
{
    float above = max(s->model->bounds_max[1], 0.0f), sine = max(s->L[1], 0.01f);
    return 1 + (int32_t)fminf(ceilf(SUN_RADIUS * above / (sine * sine * spacing_m)), MAX_REACH - 1);
}

/* ---- all nodes ---- */

/* Landing position of light, in texels. */
static void place_on_layer(const making *m, const caustic_layer *layer, const node_ray *r, float *u, float *v)
{
    float x = (float)(r->from[0] + r->length_m * (double)r->d[0] - layer->middle[0]);
    float z = (float)(r->from[2] + r->length_m * (double)r->d[2] - layer->middle[1]);
    const float *axis = m->map->axis;
    *u = (x * axis[0] + z * axis[1]) / layer->texel_m + 0.5f * CAUSTIC_SIZE;
    *v = (z * axis[0] - x * axis[1]) / layer->texel_m + 0.5f * CAUSTIC_SIZE;
}

static void trace_row(making *m, uint32_t l, size_t row)
{
    nodes *n = &m->nodes[l];
    const caustic_layer *layer = &m->map->layers[l];
    float *u = n->u + row * n->count, *v = n->v + row * n->count, *weight = n->weight + row * n->count;
    n->lowest[row] = INFINITY;
    n->highest[row] = -INFINITY;
    n->sums[row] = 0.0;
    for (size_t i = 0; i < n->count; i++) {
        node_ray r = trace_at(m, l, i, row);
        place_on_layer(m, layer, &r, &u[i], &v[i]);
        weight[i] = r.light;
        if (n->open)
            n->open[row * n->count + i] =
                passing_few(m, &r, i, row, (double)(TEXELS_PER_NODE * layer->texel_m));
        n->sums[row] += (double)r.light;
        n->lowest[row] = fminf(n->lowest[row], v[i]);
        n->highest[row] = fmaxf(n->highest[row], v[i]);
    }
    if (n->open)
        range_along(n, row);
}

static void trace_rows(void *context, size_t begin, size_t end)
{
    making *m = context;
    for (size_t i = begin; i < end; i++)
        if (i / CAUSTIC_LAYERS < m->nodes[i % CAUSTIC_LAYERS].count)
            trace_row(m, (uint32_t)(i % CAUSTIC_LAYERS), i / CAUSTIC_LAYERS);
}

/* ---- light on the bed ---- */

/* Positions are interpolated by cubics; weights linearly, so that none is negative. */
static void weights_at(float f, float w[4], float linear[4])
{
    linear[0] = linear[3] = 0.0f;
    linear[1] = 1.0f - f;
    linear[2] = f;
    vec3 first = wave_cubic_weights(f);
    for (int i = 0; i < 3; i++)
        w[i] = first[i];
    w[3] = 1.0f - first[0] - first[1] - first[2];
}

/* Interpolates a row between four others, count long, stride apart. */
static void between_rows(const float *rows, size_t count, const float w[4], float *out)
{
    for (size_t i = 0; i < count; i++)
        out[i] =
            w[0] * rows[i] + w[1] * rows[count + i] + w[2] * rows[2 * count + i] + w[3] * rows[3 * count + i];
}

static void between_columns(const float *row, size_t count, const float w[4], float *out)
{
    for (size_t i = 0; i + 3 < count; i++)
        out[i] = w[0] * row[i] + w[1] * row[i + 1] + w[2] * row[i + 2] + w[3] * row[i + 3];
}

/* Adds points to rows [first, first + BAND) of a layer. */
static void lay_points(float *texels, int first, const float *u, const float *v, const float *light,
                       size_t count, float scale)
{
    for (size_t i = 0; i < count; i++) {
        float x = u[i] - 0.5f, z = v[i] - 0.5f;
        if (!(x > -1.0f && x < CAUSTIC_SIZE && z > (float)(first - 1) && z < (float)(first + BAND)))
            continue;
        int ix = (int)(x + 1.0f) - 1, iz = (int)(z + 1.0f) - 1;
        float fx = x - (float)ix, fz = z - (float)iz, amount = scale * light[i];
        for (int k = 0; k < 2; k++) {
            if (iz + k < first || iz + k >= first + BAND)
                continue;
            float part = amount * (k ? fz : 1.0f - fz);
            float *row = texels + (ptrdiff_t)(iz + k) * CAUSTIC_SIZE;
            if (ix >= 0)
                row[ix] += part * (1.0f - fx);
            if (ix + 1 < CAUSTIC_SIZE)
                row[ix + 1] += part * fx;
        }
    }
}

/* All points between the nodes' rows row + 1 and row + 2. */
static void lay_row(const making *m, const nodes *n, size_t row, float *texels, int first)
{
    float between[3][MAX_NODES], points[3][MAX_NODES], cubic[4], linear[4];
    const float *planes[3] = {n->u, n->v, n->weight};
    const float *weights[3] = {cubic, cubic, linear};
    for (int j = 0; j < POINTS_PER_NODE; j++) {
        weights_at(((float)j + 0.5f) / POINTS_PER_NODE, cubic, linear);
        for (int p = 0; p < 3; p++)
            between_rows(planes[p] + row * n->count, n->count, weights[p], between[p]);
        for (int i = 0; i < POINTS_PER_NODE; i++) {
            weights_at(((float)i + 0.5f) / POINTS_PER_NODE, cubic, linear);
            for (int p = 0; p < 3; p++)
                between_columns(between[p], n->count, weights[p], points[p]);
            lay_points(texels, first, points[0], points[1], points[2], n->count - 3, m->per_point);
        }
    }
}

/* Whether light between those rows may reach the band: cubics exceed the range of their samples by at most a
 * quarter. */
static bool may_reach(const nodes *n, size_t row, int first)
{
    float low = INFINITY, high = -INFINITY;
    for (size_t k = row; k < row + 4; k++) {
        low = fminf(low, n->lowest[k]);
        high = fmaxf(high, n->highest[k]);
    }
    float beyond = 1.0f + 0.3f * (high - low);
    return high + beyond > (float)first && low - beyond < (float)(first + BAND);
}

static void fill_bands(void *context, size_t begin, size_t end)
{
    making *m = context;
    for (size_t item = begin; item < end; item++) {
        size_t l = item / BANDS;
        int first = (int)(item % BANDS) * BAND;
        const nodes *n = &m->nodes[l];
        float *texels = m->map->layers[l].mips[0];
        for (int i = first * CAUSTIC_SIZE; i < (first + BAND) * CAUSTIC_SIZE; i++)
            texels[i] = 0.0f;
        for (size_t row = 0; row + 3 < n->count; row++)
            if (may_reach(n, row, first))
                lay_row(m, n, row, texels, first);
    }
}

/* ---- blur ---- */

enum { MAX_RADIUS = 16 };

/* Gaussian weights of a standard deviation (texels) beside the center's; returns their number. */
static int gaussian(float sigma, float w[MAX_RADIUS + 1])
{
    if (sigma < 0.05f) {
        w[0] = 1.0f;
        return 0;
    }
    int radius = (int)fminf(ceilf(3.0f * sigma), MAX_RADIUS);
    double sum = 0.0;
    for (int i = 0; i <= radius; i++) {
        w[i] = (expf)(-0.5f * (float)(i * i) / (sigma * sigma));
        sum += (double)w[i] * (i ? 2.0 : 1.0);
    }
    for (int i = 0; i <= radius; i++)
        w[i] = (float)((double)w[i] / sum);
    return radius;
}

static int inside(int i)
{
    return i < 0 ? 0 : i >= CAUSTIC_SIZE ? CAUSTIC_SIZE - 1 : i;
}

/* Along rows, from the layer to the scratch. */
static void blur_rows(void *context, size_t begin, size_t end)
{
    making *m = context;
    for (size_t item = begin; item < end; item++) {
        size_t l = item / CAUSTIC_SIZE, row = item % CAUSTIC_SIZE;
        const float *from = m->map->layers[l].mips[0] + row * CAUSTIC_SIZE;
        float *to = m->scratch[l] + row * CAUSTIC_SIZE, w[MAX_RADIUS + 1];
        int radius = gaussian(m->plans[l].sigma_m[0] / m->plans[l].texel_m, w);
        float padded[CAUSTIC_SIZE + 2 * MAX_RADIUS];
        for (int i = -radius; i < CAUSTIC_SIZE + radius; i++)
            padded[MAX_RADIUS + i] = from[inside(i)];
        for (int i = 0; i < CAUSTIC_SIZE; i++)
            to[i] = w[0] * padded[MAX_RADIUS + i];
        for (int k = 1; k <= radius; k++)
            for (int i = 0; i < CAUSTIC_SIZE; i++)
                to[i] += w[k] * (padded[MAX_RADIUS + i - k] + padded[MAX_RADIUS + i + k]);
    }
}

/* Along columns, and back. */
static void blur_columns(void *context, size_t begin, size_t end)
{
    making *m = context;
    for (size_t item = begin; item < end; item++) {
        size_t l = item / CAUSTIC_SIZE;
        int row = (int)(item % CAUSTIC_SIZE);
        float *to = m->map->layers[l].mips[0] + (ptrdiff_t)row * CAUSTIC_SIZE, w[MAX_RADIUS + 1];
        int radius = gaussian(m->plans[l].sigma_m[1] / m->plans[l].texel_m, w);
        for (int i = 0; i < CAUSTIC_SIZE; i++)
            to[i] = w[0] * m->scratch[l][row * CAUSTIC_SIZE + i];
        for (int k = 1; k <= radius; k++) {
            const float *above = m->scratch[l] + (ptrdiff_t)inside(row - k) * CAUSTIC_SIZE;
            const float *under = m->scratch[l] + (ptrdiff_t)inside(row + k) * CAUSTIC_SIZE;
            for (int i = 0; i < CAUSTIC_SIZE; i++)
                to[i] += w[k] * (above[i] + under[i]);
        }
    }
}

/* ---- all ---- */

static facet_result take_memory(making *m, facet_error *error)
{
    const facet_allocator *allocator = &m->source->allocator;
    for (uint32_t l = 0; l < CAUSTIC_LAYERS; l++) {
        nodes *n = &m->nodes[l];
        float spacing = TEXELS_PER_NODE * m->plans[l].texel_m;
        n->margin = (int32_t)fminf(ceilf(m->plans[l].margin_m / spacing) + 1.0f, MAX_MARGIN);
        n->count = CAUSTIC_SIZE / TEXELS_PER_NODE + 2 * (size_t)n->margin + 3;
        size_t plane = n->count * n->count, floats = (m->source->model ? 6 : 3) * plane + 2 * n->count;
        n->u = mem_alloc(allocator, floats, sizeof(float));
        n->sums = mem_alloc(allocator, n->count, sizeof(double));
        m->scratch[l] = mem_alloc(allocator, (size_t)CAUSTIC_SIZE * CAUSTIC_SIZE, sizeof(float));
        if (!n->u || !n->sums || !m->scratch[l])
            return fail_memory(error, "sunlight on the bed", floats * sizeof(float));
        n->v = n->u + plane;
        n->weight = n->v + plane;
        n->lowest = n->weight + plane;
        n->highest = n->lowest + n->count;
        if (m->source->model) {
            n->open = n->highest + n->count;
            n->least = n->open + plane;
            n->most = n->least + plane;
            n->reach = reach_of(m->source, spacing);
        }
    }
    return FACET_OK;
}

/* Normalizes by the widest layer, which covers most of the sea. */
static double mean_light(const nodes *n)
{
    double sum = 0.0;
    for (size_t row = 0; row < n->count; row++)
        sum += n->sums[row];
    return sum / ((double)n->count * (double)n->count);
}

static void fill(making *m)
{
    uint32_t threads = m->source->thread_count;
    parallel_for(threads, (size_t)MAX_NODES * CAUSTIC_LAYERS, 8, trace_rows, m);
    double mean = mean_light(&m->nodes[CAUSTIC_LAYERS - 1]);
    if (!(mean > 0.0))
        return;
    if (m->source->model)
        parallel_for(threads, (size_t)MAX_NODES * CAUSTIC_LAYERS, 8, shade_rows, m);
    const float points = (float)POINTS_PER_NODE / TEXELS_PER_NODE; /* per texel, along each axis */
    m->per_point = (float)(1.0 / (mean * (double)(points * points)));
    parallel_for(threads, (size_t)CAUSTIC_LAYERS * BANDS, 1, fill_bands, m);
    parallel_for(threads, (size_t)CAUSTIC_LAYERS * CAUSTIC_SIZE, 32, blur_rows, m);
    parallel_for(threads, (size_t)CAUSTIC_LAYERS * CAUSTIC_SIZE, 32, blur_columns, m);
    for (uint32_t l = 0; l < CAUSTIC_LAYERS; l++)
        caustic_layer_reduce(&m->map->layers[l]);
    m->map->is_there = true;
}

facet_result water_caustics_fill(const caustic_source *source, const float axis[2],
                                 const caustic_plan plans[CAUSTIC_LAYERS], caustic_map *map,
                                 facet_error *error)
{
    making m = {.source = source, .plans = plans, .map = map};
    m.still = water_refracted(source->water, -source->L, vec3(0.0f, 1.0f, 0.0f));
    for (uint32_t k = 0; source->model && k < SHADOW_POINTS; k++)
        m.points[k] = shadow_point_at(k, source->L);
    facet_result result = caustic_map_create(&source->allocator, map, error);
    for (int i = 0; i < 2; i++)
        map->axis[i] = axis[i];
    for (uint32_t l = 0; l < CAUSTIC_LAYERS; l++) {
        map->layers[l].texel_m = plans[l].texel_m;
        for (int i = 0; i < 2; i++)
            map->layers[l].middle[i] = plans[l].middle[i];
    }
    if (result == FACET_OK)
        result = take_memory(&m, error);
    if (result == FACET_OK)
        fill(&m);
    for (uint32_t l = 0; l < CAUSTIC_LAYERS; l++) {
        mem_free(m.nodes[l].u);
        mem_free(m.nodes[l].sums);
        mem_free(m.scratch[l]);
    }
    return result;
}

vec2 water_caustics_shift(const caustic_source *source, const float axis[2], vec3 L, vec2 slope, float depth)
{
    vec3 d = water_refracted(source->water, -L, normalize(vec3(-slope[0], 1.0f, -slope[1])));
    float length_m = (float)distance_to_bed(source, d, (double)depth);
    return vec2(length_m * (d[0] * axis[0] + d[2] * axis[1]), length_m * (d[2] * axis[0] - d[0] * axis[1]));
}
