/* gltf_attributes.c - vertex attributes: the formats and names that glTF allows them (glTF 2.0 section
 * 3.7.2, KHR_mesh_quantization), and their values as scene_primitive promises them: finite positions, unit
 * normals, unit tangents with a sign, finite texture coordinates, colors in [0, 1] with alpha. Only values
 * that need repair are copied. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/parallel.h"
#include "io/gltf/gltf_components.h"

/* ---- formats ---- */

enum { /* or-ed: component types, each plain or normalized */
       F32 = 1,
       NORMALIZED_UNSIGNED = 2,
       NORMALIZED_SIGNED = 4,
       PLAIN_UNSIGNED = 8,
       PLAIN_SIGNED = 16,
       ANY_INTEGER = NORMALIZED_UNSIGNED | NORMALIZED_SIGNED | PLAIN_UNSIGNED | PLAIN_SIGNED
};

static const struct {
    gltf_type type, other_type;
    unsigned formats, quantized_formats;
} RULES[] = {
    [GLTF_POSITION] = {GLTF_VEC3, GLTF_VEC3, F32, ANY_INTEGER},
    [GLTF_NORMAL] = {GLTF_VEC3, GLTF_VEC3, F32, NORMALIZED_SIGNED},
    [GLTF_TANGENT] = {GLTF_VEC4, GLTF_VEC4, F32, NORMALIZED_SIGNED},
    [GLTF_TEXCOORD] = {GLTF_VEC2, GLTF_VEC2, F32 | NORMALIZED_UNSIGNED, ANY_INTEGER},
    [GLTF_COLOR] = {GLTF_VEC3, GLTF_VEC4, F32 | NORMALIZED_UNSIGNED, 0},
    [GLTF_JOINTS] = {GLTF_VEC4, GLTF_VEC4, PLAIN_UNSIGNED, 0},
    [GLTF_WEIGHTS] = {GLTF_VEC4, GLTF_VEC4, F32 | NORMALIZED_UNSIGNED, 0},
    [GLTF_POSITION_DELTA] = {GLTF_VEC3, GLTF_VEC3, F32, NORMALIZED_SIGNED | PLAIN_SIGNED},
    [GLTF_NORMAL_DELTA] = {GLTF_VEC3, GLTF_VEC3, F32, NORMALIZED_SIGNED},
    [GLTF_TANGENT_DELTA] = {GLTF_VEC3, GLTF_VEC3, F32, NORMALIZED_SIGNED},
};

static unsigned format_of(const gltf_accessor *a)
{
    switch (a->component) {
    case GLTF_F32:
    case GLTF_F64:
    case GLTF_F16:
        return F32;
    case GLTF_U8:
    case GLTF_U16:
        return a->is_normalized ? NORMALIZED_UNSIGNED : PLAIN_UNSIGNED;
    case GLTF_I8:
    case GLTF_I16:
        return a->is_normalized ? NORMALIZED_SIGNED : PLAIN_SIGNED;
    default:
        return 0;
    }
}

uint32_t gltf_get_attribute(io_reader *r, const json_place *attributes, const char *name,
                            gltf_attribute attribute, uint32_t vertex_count)
{
    uint32_t index = gltf_get_accessor(r, attributes, name);
    if (index == SCENE_NONE)
        return SCENE_NONE;
    gltf_accessor *a = &r->gltf->accessors[index];
    /* Colors as plain integers are a common mistake; they can only be meant as normalized. */
    if (attribute == GLTF_COLOR && format_of(a) == PLAIN_UNSIGNED && !a->floats) {
        io_warn(r, attributes, name, "accessor %u must be normalized; it is read as if it were", index);
        a->is_normalized = true;
    }
    unsigned format = format_of(a);
    if ((a->type != RULES[attribute].type && a->type != RULES[attribute].other_type) ||
        !(format & (RULES[attribute].formats | RULES[attribute].quantized_formats))) {
        io_fail(r, attributes, name, FACET_ERROR_INVALID,
                "accessor %u has a type and componentType that are not allowed for %s", index, name);
        return SCENE_NONE;
    }
    if (!(format & RULES[attribute].formats) && !r->gltf->has_quantization)
        io_note(r, attributes, name,
                "accessor %u has a componentType that needs KHR_mesh_quantization, which the file does not "
                "declare",
                index);
    if (a->count != vertex_count) {
        io_fail(r, attributes, name, FACET_ERROR_INVALID, "accessor %u has %u elements, but POSITION has %u",
                index, a->count, vertex_count);
        return SCENE_NONE;
    }
    return index;
}

uint32_t gltf_count_sets(const json_place *attributes, const char *prefix)
{
    enum { MAX = 64 };
    char name[32];
    for (uint32_t count = 0; count < MAX; count++) {
        snprintf(name, sizeof name, "%s%u", prefix, count);
        if (!io_has_member(attributes, name))
            return count;
    }
    return MAX;
}

/* ---- names ---- */

bool gltf_is_read_attribute(const char *name)
{
    static const char *const read[] = {"POSITION", "NORMAL", "TANGENT", "COLOR_0"};
    for (size_t i = 0; i < sizeof read / sizeof *read; i++)
        if (strcmp(name, read[i]) == 0)
            return true;
    return strncmp(name, "TEXCOORD_", 9) == 0 || strncmp(name, "JOINTS_", 7) == 0 ||
           strncmp(name, "WEIGHTS_", 8) == 0;
}

void gltf_check_attribute_names(io_reader *r, const json_place *attributes)
{
    static const char *const numbered[] = {"TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"};
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)attributes->value, name, value)
    {
        bool is_known = name[0] == '_' || strcmp(name, "POSITION") == 0 || strcmp(name, "NORMAL") == 0 ||
                        strcmp(name, "TANGENT") == 0;
        for (size_t i = 0; i < sizeof numbered / sizeof *numbered; i++) {
            size_t length = strlen(numbered[i]);
            if (strncmp(name, numbered[i], length) != 0)
                continue;
            unsigned number = 0;
            int used = 0;
            is_known = sscanf(name + length, "%3u%n", &number, &used) == 1 &&
                       name[length + (size_t)used] == 0 && (name[length] != '0' || used == 1);
            char previous[32];
            snprintf(previous, sizeof previous, "%s%u", numbered[i], number - 1);
            if (is_known && number > 0 && !io_has_member(attributes, previous))
                io_warn(r, attributes, name, "is present without %s", previous);
        }
        if (!is_known)
            io_note(r, attributes, name, "is not a glTF attribute and is ignored");
        if (!gltf_is_read_attribute(name) && io_is_ok(r)) {
            gltf_get_accessor(r, attributes, name);
            io_leave_out(r, "nothing reads it");
        }
        uint32_t accessor = io_peek_index(attributes, name, r->gltf->accessor_count);
        if (accessor != SCENE_NONE && r->gltf->accessors[accessor].component == GLTF_U32)
            io_note(r, attributes, name, "accessor %u has componentType 5125, which attributes cannot have",
                    accessor);
    }
}

/* ---- checks of all elements ---- */

enum { GRAIN = 1 << 15 };

/* A check of all elements; each work item counts separately. */
typedef struct check {
    const float *in;
    float *out;
    size_t *counts;         /* per item: elements to repair */
    size_t *warnings;       /* per item: those of them that deserve a warning */
    size_t width;           /* floats per element, where that varies */
    size_t repairs, warned; /* their sums */
} check;

/* Runs body over count elements and sums what it counts. False: no memory. */
static bool run_check(io_reader *r, check *c, size_t count, void (*body)(void *, size_t, size_t))
{
    size_t ranges = count / GRAIN + 1;
    c->counts = mem_zalloc(r->allocator, 2 * ranges, sizeof *c->counts);
    if (!c->counts)
        return io_fail_memory(r, "vertices", 2 * ranges * sizeof *c->counts);
    c->warnings = c->counts + ranges;
    parallel_for(r->thread_count, count, GRAIN, body, c);
    for (size_t i = 0; i < ranges; i++) {
        c->repairs += c->counts[i];
        c->warned += c->warnings[i];
    }
    mem_free(c->counts);
    return true;
}

static bool is_sane(float x)
{
    return fabsf(x) <= SCENE_FARTHEST; /* false for NaN */
}

/* ---- positions ---- */

static void check_finite(void *context, size_t begin, size_t end)
{
    check *c = context;
    size_t repairs = 0;
    for (size_t i = c->width * begin; i < c->width * end; i++)
        repairs += fabsf(c->in[i]) <= SCENE_FARTHEST ? 0u : 1u;
    c->counts[begin / GRAIN] = repairs;
}

static bool is_sane3(const float *p)
{
    return is_sane(p[0]) && is_sane(p[1]) && is_sane(p[2]);
}

const float *gltf_get_positions(io_reader *r, const json_place *at, uint32_t index, const uint8_t **is_lost)
{
    gltf_accessor *a = &r->gltf->accessors[index];
    *is_lost = a->is_lost;
    if (a->positions)
        return a->positions;
    const float *in = a->component == GLTF_F64 ? gltf_get_accessor_near(r, at, index)
                                               : gltf_get_accessor_floats(r, at, index);
    check c = {.in = in, .width = 3};
    if (!in || !run_check(r, &c, a->count, check_finite))
        return NULL;
    if (c.repairs == 0)
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
    io_warn(
        r, at, NULL,
        "accessor %u has positions that are not finite or beyond %g m; elements that use them are not drawn",
        index, (double)SCENE_FARTHEST);
    *is_lost = a->is_lost = flags;
    return a->positions = out;
}

/* ---- unit vectors ---- */

/* Tolerance within which vectors count as unit length and are used unchanged. */
static const float UNIT_TOLERANCE = 1e-4f;
/* Tolerance of the Khronos validator; a larger deviation is reported. */
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

/* Normalizes v, in double so that no length overflows or underflows. False: v has no direction and
 * becomes 0. */
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
    if (!in || !run_check(r, &c, a->count, check_normals))
        return NULL;
    if (c.repairs == 0)
        return a->normals = in;
    if (c.warned && gltf_is_float(a->component))
        io_note(r, at, NULL, "%zu normals of accessor %u are not of length 1", c.warned, index);
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
    if (!in || !run_check(r, &c, a->count, check_tangents))
        return NULL;
    a->has_tangents = true;
    if (c.repairs == 0)
        return a->tangents = in;
    if (c.warned && gltf_is_float(a->component))
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

/* ---- other values that must be finite ---- */

const float *gltf_get_finite(io_reader *r, const json_place *at, uint32_t index, const char *what)
{
    gltf_accessor *a = &r->gltf->accessors[index];
    if (a->finite)
        return a->finite;
    const float *in = gltf_get_accessor_floats(r, at, index);
    check c = {.in = in, .width = gltf_component_counts[a->type]};
    if (!in || !run_check(r, &c, a->count, check_finite))
        return NULL;
    if (c.repairs == 0)
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
    if (!run_check(r, &c, a->count, check_colors))
        return NULL;
    if (c.repairs == 0)
        return a->colors = c.in;
    io_warn(r, at, NULL, "accessor %u has colors outside [0, 1]; they are clamped", index);
    float *out = c.out ? c.out : io_alloc_raw(r, "colors", a->count, 4 * sizeof *out);
    if (!out)
        return NULL;
    for (size_t i = 0; i < 4 * (size_t)a->count; i++)
        out[i] = c.in[i] >= 0.0f ? fminf(c.in[i], 1.0f) : 0.0f; /* NaN: 0 */
    return a->colors = out;
}
