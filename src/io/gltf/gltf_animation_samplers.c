/* gltf_animation_samplers.c - keys over time (glTF 2.0 section 5.8): their times in order, their values finite, those of
 * rotations unit. What is right in the file is not copied. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/gltf/gltf_reader.h"

/* ---- times ---- */

typedef struct key {
    float time;
    uint32_t index;
} key;

static int compare_keys(const void *a, const void *b)
{
    const key *x = a;
    const key *y = b;
    return x->time != y->time ? (x->time < y->time ? -1 : 1) : x->index < y->index ? -1 : 1;
}

static bool is_increasing(const float *times, size_t count)
{
    bool is_right = fabsf(times[0]) <= FLT_MAX;
    for (size_t i = 1; i < count; i++)
        is_right &= times[i] > times[i - 1] && times[i] <= FLT_MAX; /* false for NaN */
    return is_right;
}

/* Sorts keys by time; of several at the same time the last one stays. Those without a finite time go. Returns how many
 * are left. */
static uint32_t order_keys(const float *times, uint32_t count, key *out)
{
    uint32_t finite = 0;
    for (uint32_t i = 0; i < count; i++)
        if (fabsf(times[i]) <= FLT_MAX)
            out[finite++] = (key){times[i], i};
    qsort(out, finite, sizeof *out, compare_keys);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < finite; i++)
        if (i + 1 == finite || out[i + 1].time > out[i].time)
            out[kept++] = out[i];
    return kept;
}

/* Replaces the keys of a sampler, which do not increase, by those of them that do. */
static bool repair_times(io_reader *r, const json_place *at, scene_sampler *s)
{
    size_t width = (size_t)s->width * (s->interpolation == SCENE_CUBIC_SPLINE ? 3 : 1);
    key *keys = mem_alloc(r->allocator, s->key_count, sizeof *keys);
    if (!keys)
        return io_fail_memory(r, "animation", s->key_count * sizeof *keys);
    uint32_t count = order_keys(s->times, s->key_count, keys);
    io_warn(r, at, "input", "does not increase strictly; %u of %u keys are used in their order", count,
            s->key_count);
    float *times = io_alloc_raw(r, "animation", count, sizeof *times);
    float *values = io_alloc_raw(r, "animation", count, width * sizeof *values);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        times[i] = keys[i].time;
        memcpy(values + width * i, s->values + width * keys[i].index, width * sizeof *values);
    }
    mem_free(keys);
    s->key_count = count;
    s->times = times;
    s->values = values;
    return io_is_ok(r) && count > 0;
}

/* ---- rotations ---- */

/* Beyond this a quaternion is made unit; rounded ones of the file stay. */
static const double UNIT_TOLERANCE = 1e-5;
static const double FAR_OFF = 0.01; /* worth a warning */

static double length_of(const float q[4])
{
    return sqrt((double)q[0] * (double)q[0] + (double)q[1] * (double)q[1] + (double)q[2] * (double)q[2] +
                (double)q[3] * (double)q[3]);
}

/* Makes the rotations of a sampler unit; tangents of splines shrink with them. */
static bool repair_rotations(io_reader *r, const json_place *at, scene_sampler *s)
{
    bool is_cubic = s->interpolation == SCENE_CUBIC_SPLINE;
    size_t step = is_cubic ? 12 : 4;
    bool is_unit = true;
    for (size_t i = 0; i < s->key_count; i++)
        is_unit &= fabs(length_of(s->values + step * i + (is_cubic ? 4 : 0)) - 1.0) <= UNIT_TOLERANCE;
    if (is_unit)
        return true;
    float *values = io_alloc_raw(r, "animation", s->key_count, step * sizeof *values);
    if (!values)
        return false;
    memcpy(values, s->values, s->key_count * step * sizeof *values);
    size_t far_off = 0;
    for (size_t i = 0; i < s->key_count; i++) {
        float *q = values + step * i + (is_cubic ? 4 : 0);
        double length = gltf_normalize_rotation(q);
        far_off += fabs(length - 1.0) <= FAR_OFF ? 0u : 1u;
        for (int k = 0; is_cubic && length > 0.0 && k < 4; k++) {
            q[k - 4] = (float)((double)q[k - 4] / length);
            q[k + 4] = (float)((double)q[k + 4] / length);
        }
    }
    if (far_off)
        io_warn(r, at, "output", "has %zu rotations that are not of length 1", far_off);
    s->values = values;
    return true;
}

/* ---- samplers ---- */

void gltf_check_animation_sampler(io_reader *r, const json_place *at)
{
    static const char *const keys[2] = {"input", "output"};
    for (int i = 0; i < 2; i++) {
        uint32_t index = gltf_get_required_accessor(r, at, keys[i]);
        if (index == SCENE_NONE)
            return;
        const gltf_accessor *a = &r->gltf->accessors[index];
        if (a->view != SCENE_NONE && r->gltf->views[a->view].stride)
            io_note(r, at, keys[i], "accessor %u is in a buffer view with byteStride", index);
    }
}

static scene_interpolation get_interpolation(io_reader *r, const json_place *at)
{
    static const char *const names[] = {
        [SCENE_STEP] = "STEP", [SCENE_LINEAR] = "LINEAR", [SCENE_CUBIC_SPLINE] = "CUBICSPLINE"};
    const char *name = io_get_string(r, at, "interpolation", "LINEAR");
    if (io_leave_out(r, "LINEAR is used"))
        return SCENE_LINEAR;
    for (int i = 0; i < 3; i++)
        if (strcmp(name, names[i]) == 0)
            return (scene_interpolation)i;
    io_warn(r, at, "interpolation", "\"%.40s\" is none of LINEAR, STEP, CUBICSPLINE; LINEAR is used", name);
    return SCENE_LINEAR;
}

/* The keys as the file has them. False: an error is recorded, or a warning says what is wrong with them. */
static bool read_sampler(io_reader *r, const json_place *at, scene_sampler *out)
{
    uint32_t input = gltf_get_required_accessor(r, at, "input");
    uint32_t output = gltf_get_required_accessor(r, at, "output");
    if (!io_is_ok(r))
        return false;
    const gltf_accessor *times = &r->gltf->accessors[input];
    const gltf_accessor *values = &r->gltf->accessors[output];
    if (times->type != GLTF_SCALAR || times->component != GLTF_F32) {
        io_warn(r, at, "input", "accessor %u must have SCALAR elements of floats; nothing moves by it",
                input);
        return false;
    }
    if (!gltf_has_accessor_source(r, input) || !gltf_has_accessor_source(r, output)) {
        io_warn(r, at, NULL, "is in a buffer without bytes; nothing moves by it");
        return false;
    }
    *out = (scene_sampler){.interpolation = get_interpolation(r, at), .key_count = times->count};
    /* Several elements make a value of an array: as many of them per key as there are weights. */
    uint64_t per_element = out->interpolation == SCENE_CUBIC_SPLINE ? 3 : 1;
    uint64_t keys = per_element * out->key_count;
    if (keys == 0 || values->count < keys || values->count % keys != 0) {
        io_warn(r, at, "output",
                "accessor %u has %u elements, which is no multiple of %llu as %u keys need it; nothing "
                "moves by it",
                output, values->count, (unsigned long long)keys, out->key_count);
        return false;
    }
    if (!io_spend(r, at, out->key_count + (uint64_t)values->count))
        return false;
    out->times = gltf_get_accessor_floats(r, at, input);
    out->values = gltf_get_finite(r, at, output, "values");
    out->width =
        (uint32_t)(values->count / keys) * gltf_component_counts[values->type]; /* below 2^30 by now */
    return out->times && out->values;
}

bool gltf_read_animation_sampler(io_reader *r, const json_place *at, bool is_rotation, scene_sampler *out)
{
    if (!read_sampler(r, at, out))
        return false;
    if (!is_increasing(out->times, out->key_count) && !repair_times(r, at, out))
        return false;
    if (out->times[0] < 0.0f)
        io_note(r, at, "input", "begins before 0 s");
    return !is_rotation || out->width != 4 || repair_rotations(r, at, out);
}
