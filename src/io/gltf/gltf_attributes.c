/* gltf_attributes.c - vertex attributes as scene_primitive promises them: finite positions, unit normals, unit
 * tangents with a sign, finite texture coordinates, colors in [0, 1] with alpha. What is already so is left where
 * it is; only what is not is copied. */
#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "io/gltf/gltf_reader.h"

enum { GRAIN = 1 << 15 };

/* A check of all elements: ranges count their offenders by themselves. */
typedef struct check {
    const float *in;
    float *out;
    size_t *counts;   /* per range: elements to repair */
    size_t *warnings; /* per range: those of them worth a word */
    size_t width;     /* of an element, where that is not fixed */
} check;

/* Sums what body counts over count elements. False: no memory. */
static bool run_check(io_reader *r, check *c, size_t count, void (*body)(void *, size_t, size_t),
                      size_t *to_repair, size_t *to_warn)
{
    size_t ranges = count / GRAIN + 1;
    c->counts = mem_zalloc(r->allocator, 2 * ranges, sizeof *c->counts);
    if (!c->counts)
        return io_fail_memory(r, "vertices", 2 * ranges * sizeof *c->counts);
    c->warnings = c->counts + ranges;
    parallel_for(r->thread_count, count, GRAIN, body, c);
    *to_repair = *to_warn = 0;
    for (size_t i = 0; i < ranges; i++) {
        *to_repair += c->counts[i];
        *to_warn += c->warnings[i];
    }
    mem_free(c->counts);
    return true;
}

static bool is_sane(float x)
{
    return fabsf(x) <= SCENE_FARTHEST; /* false for NaN */
}

/* ---- positions ---- */

static bool is_sane3(const float *p)
{
    return is_sane(p[0]) && is_sane(p[1]) && is_sane(p[2]);
}

static void check_positions(void *context, size_t begin, size_t end)
{
    check *c = context;
    size_t lost = 0;
    for (size_t i = 3 * begin; i < 3 * end; i++)
        lost += fabsf(c->in[i]) <= SCENE_FARTHEST ? 0u : 1u;
    c->counts[begin / GRAIN] = lost;
}

const float *gltf_get_positions(io_reader *r, const json_place *at, uint32_t index, const uint8_t **is_lost)
{
    gltf_accessor *a = &r->gltf->accessors[index];
    *is_lost = a->is_lost;
    if (a->positions)
        return a->positions;
    const float *in = gltf_get_accessor_floats(r, at, index);
    check c = {.in = in};
    size_t lost;
    size_t unused;
    if (!in || !run_check(r, &c, a->count, check_positions, &lost, &unused))
        return NULL;
    if (lost == 0)
        return a->positions = in;

    float *out = io_alloc_raw(r, "positions", a->count, 3 * sizeof *out);
    uint8_t *flags = io_alloc(r, "positions", a->count, sizeof *flags);
    if (!out || !flags)
        return NULL;
    for (size_t i = 0; i < a->count; i++) {
        flags[i] = !is_sane3(in + 3 * i);
        for (size_t k = 0; k < 3; k++)
            out[3 * i + k] = flags[i] ? 0.0f : in[3 * i + k];
    }
    io_warn(r, at, NULL,
            "accessor %u has positions that are not finite or beyond %g m; what uses them is not drawn",
            index, (double)SCENE_FARTHEST);
    *is_lost = a->is_lost = flags;
    return a->positions = out;
}

/* ---- unit vectors ---- */

/* A deviation from length 1 that floats from a file may have; within it they are used as they are. */
static const float UNIT_TOLERANCE = 1e-4f;
/* What Khronos' validator allows; beyond it is worth a warning. */
static const float VALIDATOR_TOLERANCE = 0.0135f;

static float deviation(const float *v)
{
    return fabsf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] - 1.0f); /* NaN for NaN */
}

static void check_units(void *context, size_t begin, size_t end, size_t width)
{
    check *c = context;
    size_t repairs = 0;
    size_t warnings = 0;
    for (size_t i = begin; i < end; i++) {
        float d = deviation(c->in + width * i);
        repairs += d <= UNIT_TOLERANCE ? 0u : 1u;
        warnings += d <= VALIDATOR_TOLERANCE ? 0u : 1u;
    }
    c->counts[begin / GRAIN] = repairs;
    c->warnings[begin / GRAIN] = warnings;
}

/* Makes v unit, in double so that no length over- or underflows. False: it has no direction, and is 0 then. */
static bool normalise(float v[3])
{
    double length =
        sqrt((double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + (double)v[2] * (double)v[2]);
    bool has_direction = length > 0.0 && length <= (double)INFINITY && isfinite(length);
    for (int k = 0; k < 3; k++)
        v[k] = has_direction ? (float)((double)v[k] / length) : 0.0f;
    return has_direction;
}

static void check_normals(void *context, size_t begin, size_t end)
{
    check_units(context, begin, end, 3);
}

const float *gltf_get_normals(io_reader *r, const json_place *at, uint32_t index, bool *has_missing)
{
    gltf_accessor *a = &r->gltf->accessors[index];
    *has_missing = a->has_missing_normals;
    if (a->normals)
        return a->normals;
    const float *in = gltf_get_accessor_floats(r, at, index);
    check c = {.in = in};
    size_t repairs;
    size_t warnings;
    if (!in || !run_check(r, &c, a->count, check_normals, &repairs, &warnings))
        return NULL;
    if (repairs == 0)
        return a->normals = in;
    if (warnings && a->component == GLTF_F32)
        io_note(r, at, NULL, "%zu normals of accessor %u are not of length 1", warnings, index);
    float *out = io_alloc_raw(r, "normals", a->count, 3 * sizeof *out);
    if (!out)
        return NULL;
    memcpy(out, in, (size_t)a->count * 3 * sizeof *out);
    for (size_t i = 0; i < a->count; i++)
        if (!(deviation(out + 3 * i) <= UNIT_TOLERANCE) && !normalise(out + 3 * i))
            a->has_missing_normals = true;
    *has_missing = a->has_missing_normals;
    return a->normals = out;
}

static void check_tangents(void *context, size_t begin, size_t end)
{
    check *c = context;
    check_units(context, begin, end, 4);
    size_t repairs = 0;
    for (size_t i = begin; i < end; i++)
        repairs += fabsf(c->in[4 * i + 3]) != 1.0f ? 1u : 0u;
    c->counts[begin / GRAIN] += repairs;
    c->warnings[begin / GRAIN] += repairs;
}

const float *gltf_get_tangents(io_reader *r, const json_place *at, uint32_t index)
{
    gltf_accessor *a = &r->gltf->accessors[index];
    if (a->tangents)
        return a->has_tangents ? a->tangents : NULL;
    const float *in = gltf_get_accessor_floats(r, at, index);
    check c = {.in = in};
    size_t repairs;
    size_t warnings;
    if (!in || !run_check(r, &c, a->count, check_tangents, &repairs, &warnings))
        return NULL;
    a->has_tangents = true;
    if (repairs == 0)
        return a->tangents = in;
    if (warnings && a->component == GLTF_F32)
        io_note(r, at, NULL, "tangents of accessor %u are not all of length 1 with w 1 or -1", index);
    float *out = io_alloc_raw(r, "tangents", a->count, 4 * sizeof *out);
    if (!out)
        return NULL;
    memcpy(out, in, (size_t)a->count * 4 * sizeof *out);
    for (size_t i = 0; i < a->count; i++) {
        float *tangent = out + 4 * i;
        if (!(deviation(tangent) <= UNIT_TOLERANCE) && !normalise(tangent))
            a->has_tangents = false;
        tangent[3] = tangent[3] < 0.0f ? -1.0f : 1.0f;
    }
    a->tangents = out;
    if (!a->has_tangents)
        io_note(r, at, NULL, "tangents of accessor %u have no direction; they are computed instead", index);
    return a->has_tangents ? out : NULL;
}

/* ---- finite numbers ---- */

static void check_finite(void *context, size_t begin, size_t end)
{
    check *c = context;
    size_t repairs = 0;
    for (size_t i = c->width * begin; i < c->width * end; i++)
        repairs += fabsf(c->in[i]) <= SCENE_FARTHEST ? 0u : 1u;
    c->counts[begin / GRAIN] = repairs;
}

const float *gltf_get_finite(io_reader *r, const json_place *at, uint32_t index, const char *what)
{
    gltf_accessor *a = &r->gltf->accessors[index];
    if (a->finite)
        return a->finite;
    const float *in = gltf_get_accessor_floats(r, at, index);
    check c = {.in = in, .width = gltf_component_counts[a->type]};
    size_t repairs;
    size_t unused;
    if (!in || !run_check(r, &c, a->count, check_finite, &repairs, &unused))
        return NULL;
    if (repairs == 0)
        return a->finite = in;
    float *out = io_alloc_raw(r, what, a->count, c.width * sizeof *out);
    if (!out)
        return NULL;
    for (size_t i = 0; i < c.width * a->count; i++)
        out[i] = is_sane(in[i]) ? in[i] : 0.0f;
    io_warn(r, at, NULL, "accessor %u has %s that are not finite or beyond %g; they are 0", index, what,
            (double)SCENE_FARTHEST);
    return a->finite = out;
}

/* ---- colors ---- */

static void check_colors(void *context, size_t begin, size_t end)
{
    check *c = context;
    size_t repairs = 0;
    for (size_t i = 4 * begin; i < 4 * end; i++)
        repairs += c->in[i] >= 0.0f && c->in[i] <= 1.0f ? 0u : 1u;
    c->counts[begin / GRAIN] = repairs;
}

static void add_alpha(void *context, size_t begin, size_t end)
{
    check *c = context;
    for (size_t i = begin; i < end; i++) {
        memcpy(c->out + 4 * i, c->in + 3 * i, 3 * sizeof *c->out);
        c->out[4 * i + 3] = 1.0f;
    }
}

const float *gltf_get_colors(io_reader *r, const json_place *at, uint32_t index)
{
    gltf_accessor *a = &r->gltf->accessors[index];
    if (a->colors)
        return a->colors;
    const float *in = gltf_get_accessor_floats(r, at, index);
    check c = {.in = in};
    if (!in)
        return NULL;
    if (a->type == GLTF_VEC3) {
        c.out = io_alloc_raw(r, "colors", a->count, 4 * sizeof *c.out);
        if (!c.out)
            return NULL;
        parallel_for(r->thread_count, a->count, GRAIN, add_alpha, &c);
        c.in = c.out;
    }
    size_t repairs;
    size_t unused;
    if (!run_check(r, &c, a->count, check_colors, &repairs, &unused))
        return NULL;
    if (repairs == 0)
        return a->colors = c.in;
    io_warn(r, at, NULL, "accessor %u has colors outside [0, 1]; they are clamped", index);
    float *out = c.out ? c.out : io_alloc_raw(r, "colors", a->count, 4 * sizeof *out);
    if (!out)
        return NULL;
    for (size_t i = 0; i < 4 * (size_t)a->count; i++)
        out[i] = c.in[i] >= 0.0f ? fminf(c.in[i], 1.0f) : 0.0f; /* NaN: 0 */
    return a->colors = out;
}
