/* gltf_write_arrays.c - accessors, buffer views and the bytes behind them. */
#include <string.h>

#include "base/result.h"
#include "io/gltf/gltf_writer.h"

/* Component types of glTF. */
enum { UNSIGNED_BYTE = 5121, UNSIGNED_SHORT = 5123, UNSIGNED_INT = 5125, FLOAT = 5126, DOUBLE = 5130 };

static const char DOUBLES[] = "KHR_accessor_float64";
static const char *const type_names[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT4"};
static const uint32_t component_counts[] = {1, 2, 3, 4, 16};

/* Appends size bytes at a multiple of alignment, a power of two from 4; NULL: no memory. */
static unsigned char *add_bytes(gltf_writer *w, size_t size, size_t alignment, size_t *offset)
{
    size_t begin = (w->bin_size + alignment - 1) & ~(alignment - 1);
    if (size > UINT32_MAX || begin + size > UINT32_MAX - 64) {
        if (gltf_writer_is_ok(w))
            w->result = fail(w->error, FACET_ERROR_LIMIT,
                             "%s: has more than 4 GiB of data, the most that a glTF "
                             "buffer of facet holds",
                             w->scene->source);
        return NULL;
    }
    if (!mem_reserve(w->allocator, (void **)&w->bin, &w->bin_capacity, begin + size + 4, 1)) {
        gltf_writer_fail_memory(w, begin + size + 4);
        return NULL;
    }
    memset(w->bin + w->bin_size, 0, begin - w->bin_size);
    w->bin_size = begin + size;
    *offset = begin;
    return w->bin + begin;
}

static uint32_t add_view(gltf_writer *w, size_t offset, size_t size, size_t stride, int target)
{
    json_t *view = json_object();
    gltf_put(w, view, "buffer", json_integer(0));
    if (offset)
        gltf_put(w, view, "byteOffset", json_integer((json_int_t)offset));
    gltf_put(w, view, "byteLength", json_integer((json_int_t)size));
    if (stride)
        gltf_put(w, view, "byteStride", json_integer((json_int_t)stride));
    if (target)
        gltf_put(w, view, "target", json_integer(target));
    gltf_append(w, w->views, view);
    return (uint32_t)json_array_size(w->views) - 1;
}

static uint32_t write_view(gltf_writer *w, const void *bytes, size_t size, size_t alignment, int target)
{
    size_t offset;
    unsigned char *at = add_bytes(w, size, alignment, &offset);
    if (!at)
        return 0;
    memcpy(at, bytes, size);
    return add_view(w, offset, size, 0, target);
}

uint32_t gltf_write_view(gltf_writer *w, const void *bytes, size_t size, int target)
{
    return write_view(w, bytes, size, 4, target);
}

/* view: SCENE_NONE: zeros. */
static json_t *add_accessor(gltf_writer *w, uint32_t view, int component, size_t count, write_type type)
{
    json_t *accessor = json_object();
    gltf_put_index(w, accessor, "bufferView", view);
    gltf_put(w, accessor, "componentType", json_integer(component));
    gltf_put(w, accessor, "count", json_integer((json_int_t)count));
    gltf_put(w, accessor, "type", json_string(type_names[type]));
    gltf_append(w, w->accessors, accessor);
    return accessor;
}

static uint32_t last_accessor(const gltf_writer *w)
{
    return (uint32_t)json_array_size(w->accessors) - 1;
}

/* ---- arrays that have an accessor ---- */

static uint32_t hash(const gltf_written_array *a)
{
    uint32_t h = index_table_hash(INDEX_TABLE_HASH, &a->data, sizeof a->data);
    return index_table_hash(index_table_hash(h, &a->size, sizeof a->size), &a->kind, sizeof a->kind);
}

/* The accessor of an array. SCENE_NONE: it has none yet; the next accessor is then recorded as its own. */
static uint32_t find_or_note(gltf_writer *w, const void *data, size_t size, uint32_t kind)
{
    const gltf_written_array a = {.data = data, .size = size, .kind = kind, .accessor = last_accessor(w) + 1};
    size_t cursor = 0;
    for (uint32_t i; (i = index_table_next(&w->written_table, hash(&a), &cursor)) != INDEX_TABLE_NONE;) {
        const gltf_written_array *there = &w->written[i];
        if (there->data == data && there->size == size && there->kind == kind)
            return there->accessor;
    }
    size_t count = w->written_table.count;
    if (mem_reserve(w->allocator, (void **)&w->written, &w->written_capacity, count + 1, sizeof a) &&
        index_table_add(&w->written_table, w->allocator, hash(&a), (uint32_t)count))
        w->written[count] = a;
    else
        gltf_writer_fail_memory(w, (count + 1) * sizeof a);
    return SCENE_NONE;
}

/* ---- arrays ---- */

static void put_bounds(gltf_writer *w, json_t *accessor, const float *values, size_t count,
                       uint32_t components)
{
    float low[16], high[16];
    for (size_t i = 0; i < count; i++)
        for (uint32_t c = 0; c < components; c++) {
            float value = values[components * i + c];
            low[c] = i == 0 || value < low[c] ? value : low[c];
            high[c] = i == 0 || value > high[c] ? value : high[c];
        }
    gltf_put(w, accessor, "min", gltf_json_floats(low, components));
    gltf_put(w, accessor, "max", gltf_json_floats(high, components));
}

uint32_t gltf_write_floats(gltf_writer *w, const float *values, size_t count, write_type type, int target,
                           bool bounds)
{
    uint32_t components = component_counts[type];
    size_t size = count * components * sizeof(float);
    uint32_t found = find_or_note(
        w, values, size, (uint32_t)type | (uint32_t)(target != 0) << 4 | (uint32_t)bounds << 5 | 1u << 8);
    if (found != SCENE_NONE)
        return found;
    json_t *accessor = add_accessor(w, gltf_write_view(w, values, size, target), FLOAT, count, type);
    if (bounds)
        put_bounds(w, accessor, values, count, components);
    return last_accessor(w);
}

/* Whether the file that the scene comes from has numbers in double. */
static bool has_doubles(const facet_scene *scene)
{
    for (uint32_t i = 0; i < scene->extension_count; i++)
        if (strcmp(scene->extensions[i].name, DOUBLES) == 0)
            return true;
    return false;
}

/* Positions relative to an origin, as numbers in double (KHR_accessor_float64). */
static uint32_t write_doubles(gltf_writer *w, const float *values, size_t count, const double origin[3])
{
    double *moved = mem_alloc(w->allocator, count, 3 * sizeof *moved), low[3], high[3];
    if (!moved) {
        gltf_writer_fail_memory(w, 3 * count * sizeof *moved);
        return 0;
    }
    for (size_t i = 0; i < 3 * count; i++) {
        const double value = origin[i % 3] + (double)values[i];
        low[i % 3] = i < 3 || value < low[i % 3] ? value : low[i % 3];
        high[i % 3] = i < 3 || value > high[i % 3] ? value : high[i % 3];
        moved[i] = value;
    }
    json_t *accessor = add_accessor(w, write_view(w, moved, 3 * count * sizeof *moved, 8, WRITE_VERTICES),
                                    DOUBLE, count, WRITE_VEC3);
    gltf_put(w, accessor, "min", gltf_json_doubles(low, 3));
    gltf_put(w, accessor, "max", gltf_json_doubles(high, 3));
    gltf_require_extension(w, DOUBLES);
    mem_free(moved);
    return last_accessor(w);
}

uint32_t gltf_write_positions(gltf_writer *w, const float *values, size_t count, const double origin[3])
{
    if (origin[0] == 0.0 && origin[1] == 0.0 && origin[2] == 0.0)
        return gltf_write_floats(w, values, count, WRITE_VEC3, WRITE_VERTICES, true);
    size_t size = 3 * count * sizeof(float);
    uint32_t found = find_or_note(w, values, size, 5u << 8);
    if (found != SCENE_NONE)
        return found;
    if (has_doubles(w->scene))
        return write_doubles(w, values, count, origin);
    float *moved = mem_alloc(w->allocator, count, 3 * sizeof *moved);
    if (!moved) {
        gltf_writer_fail_memory(w, size);
        return 0;
    }
    for (size_t i = 0; i < 3 * count; i++)
        moved[i] = (float)(origin[i % 3] + (double)values[i]);
    json_t *accessor =
        add_accessor(w, gltf_write_view(w, moved, size, WRITE_VERTICES), FLOAT, count, WRITE_VEC3);
    put_bounds(w, accessor, moved, count, 3);
    mem_free(moved);
    return last_accessor(w);
}

uint32_t gltf_write_zeros(gltf_writer *w, size_t count, write_type type)
{
    static const float zeros[16] = {0};
    uint32_t components = component_counts[type];
    json_t *accessor = add_accessor(w, SCENE_NONE, FLOAT, count, type);
    gltf_put(w, accessor, "min", gltf_json_floats(zeros, components));
    gltf_put(w, accessor, "max", gltf_json_floats(zeros, components));
    return last_accessor(w);
}

uint32_t gltf_write_indices(gltf_writer *w, const uint32_t *values, size_t count)
{
    uint32_t found = find_or_note(w, values, count, 2u << 8);
    if (found != SCENE_NONE)
        return found;
    uint32_t largest = 0;
    for (size_t i = 0; i < count; i++)
        largest = values[i] > largest ? values[i] : largest;
    bool is_short = largest < UINT16_MAX; /* the largest value is reserved for primitive restart */
    size_t size = count * (is_short ? sizeof(uint16_t) : sizeof(uint32_t));
    size_t offset;
    unsigned char *at = add_bytes(w, size, 4, &offset);
    for (size_t i = 0; at && i < count; i++) {
        uint16_t narrow = (uint16_t)values[i];
        memcpy(at + i * (is_short ? 2 : 4), is_short ? (const void *)&narrow : (const void *)&values[i],
               is_short ? 2 : 4);
    }
    uint32_t view = at ? add_view(w, offset, size, 0, WRITE_INDICES) : 0;
    add_accessor(w, view, is_short ? UNSIGNED_SHORT : UNSIGNED_INT, count, WRITE_SCALAR);
    return last_accessor(w);
}

uint32_t gltf_write_joints(gltf_writer *w, const uint16_t *joints, size_t count, size_t stride)
{
    uint32_t found = find_or_note(w, joints, count, 3u << 8);
    if (found != SCENE_NONE)
        return found;
    uint16_t largest = 0;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 4; k++)
            largest = joints[stride * i + k] > largest ? joints[stride * i + k] : largest;
    size_t width = largest > UINT8_MAX ? 2 : 1;
    size_t offset;
    unsigned char *at = add_bytes(w, 4 * width * count, 4, &offset);
    for (size_t i = 0; at && i < 4 * count; i++) {
        uint16_t joint = joints[stride * (i / 4) + i % 4];
        at[width * i] = (unsigned char)joint;
        if (width == 2)
            at[width * i + 1] = (unsigned char)(joint >> 8);
    }
    uint32_t view = at ? add_view(w, offset, 4 * width * count, 0, WRITE_VERTICES) : 0;
    add_accessor(w, view, width == 2 ? UNSIGNED_SHORT : UNSIGNED_BYTE, count, WRITE_VEC4);
    return last_accessor(w);
}

uint32_t gltf_write_weights(gltf_writer *w, const float *weights, size_t count, size_t stride)
{
    uint32_t found = find_or_note(w, weights, count, 4u << 8);
    if (found != SCENE_NONE)
        return found;
    size_t size = 4 * sizeof(float) * count;
    size_t offset;
    unsigned char *at = add_bytes(w, size, 4, &offset);
    for (size_t i = 0; at && i < count; i++)
        memcpy(at + 4 * sizeof(float) * i, weights + stride * i, 4 * sizeof(float));
    add_accessor(w, at ? add_view(w, offset, size, 0, WRITE_VERTICES) : 0, FLOAT, count, WRITE_VEC4);
    return last_accessor(w);
}

uint32_t gltf_write_bytes(gltf_writer *w, const unsigned char *values, size_t count)
{
    add_accessor(w, gltf_write_view(w, values, count, WRITE_NO_TARGET), UNSIGNED_BYTE, count, WRITE_SCALAR);
    return last_accessor(w);
}
