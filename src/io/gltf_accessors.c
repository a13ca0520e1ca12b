/* gltf_accessors.c - typed arrays in the binary data (glTF 2.0 section 3.6.2): checked when the table is read, made
 * into plain arrays when something asks. min and max are not read: they are often wrong and never needed. */
#include <string.h>

#include "base/parallel.h"
#include "io/gltf_reader.h"

const uint32_t gltf_component_counts[GLTF_TYPE_COUNT] = {1, 2, 3, 4, 4, 9, 16};

static const char *const TYPE_NAMES[GLTF_TYPE_COUNT] = {"SCALAR", "VEC2", "VEC3", "VEC4",
                                                        "MAT2",   "MAT3", "MAT4"};

enum { GRAIN = 1 << 15 }; /* elements that one thread converts at once */

/* ---- the table ---- */

static size_t component_size(gltf_component component)
{
    return component == GLTF_I8 || component == GLTF_U8     ? 1
           : component == GLTF_I16 || component == GLTF_U16 ? 2
                                                            : 4;
}

/* Bytes of an element. Columns of matrices begin at multiples of 4 (section 3.6.2.4). */
static size_t element_size(gltf_component component, gltf_type type)
{
    size_t size = component_size(component);
    size_t rows = type == GLTF_MAT2 ? 2 : type == GLTF_MAT3 ? 3 : type == GLTF_MAT4 ? 4 : 0;
    return rows ? rows * ((rows * size + 3) / 4 * 4) : gltf_component_counts[type] * size;
}

static gltf_component get_component(reader *r, const json_place *at)
{
    uint64_t value = get_uint(r, at, "componentType", UINT32_MAX, REQUIRED_UINT);
    bool is_known = (value >= GLTF_I8 && value <= GLTF_U16) || value == GLTF_U32 || value == GLTF_F32;
    if (!is_known && reader_is_ok(r))
        reader_fail(r, at, "componentType", FACET_ERROR_INVALID,
                    "%llu is none of 5120, 5121, 5122, 5123, 5125, 5126", (unsigned long long)value);
    return is_known ? (gltf_component)value : GLTF_U8;
}

static gltf_type get_type(reader *r, const json_place *at)
{
    const char *name = get_string(r, at, "type", NULL);
    for (int i = 0; name && i < GLTF_TYPE_COUNT; i++)
        if (strcmp(name, TYPE_NAMES[i]) == 0)
            return (gltf_type)i;
    if (name)
        reader_fail(r, at, "type", FACET_ERROR_INVALID, "\"%.40s\" is no type of accessor", name);
    else
        reader_fail(r, at, "type", FACET_ERROR_INVALID, "is missing");
    return GLTF_SCALAR;
}

/* Whether count elements of size bytes every stride bytes from offset are inside the view. */
static bool check_extent(reader *r, const json_place *at, uint32_t index, size_t offset, size_t count,
                         size_t stride, size_t size)
{
    size_t length = r->views[index].length;
    if (count == 0)
        return true;
    if (offset > length)
        return reader_fail(r, at, "byteOffset", FACET_ERROR_INVALID,
                           "%zu is past the end of buffer view %u (%zu bytes)", offset, index, length);
    size_t room = length - offset;
    if (size > room || (count - 1) > (room - size) / stride)
        return reader_fail(
            r, at, "count", FACET_ERROR_INVALID,
            "%zu elements of %zu bytes, %zu apart, from offset %zu go past the end of buffer view "
            "%u (%zu bytes)",
            count, size, stride, offset, index, length);
    return true;
}

static size_t view_stride(const reader *r, const gltf_accessor *a)
{
    size_t stride = a->view == SCENE_NONE ? 0 : r->views[a->view].stride;
    return stride ? stride : element_size(a->component, a->type);
}

static void read_sparse(reader *r, const json_place *accessor, gltf_accessor *a)
{
    json_place at = get_object(r, accessor, "sparse");
    if (!at.value)
        return;
    json_place indices = get_object(r, &at, "indices");
    json_place values = get_object(r, &at, "values");
    if (reader_is_ok(r) && (!indices.value || !values.value))
        reader_fail(r, &at, indices.value ? "values" : "indices", FACET_ERROR_INVALID, "is missing");
    a->sparse_count = (uint32_t)get_uint(r, &at, "count", SCENE_NONE - 1, REQUIRED_UINT);
    a->sparse_index_view = get_required_index(r, &indices, "bufferView", r->view_count, "buffer view");
    a->sparse_index_offset = get_uint(r, &indices, "byteOffset", (uint64_t)1 << 53, 0);
    a->sparse_index_component = get_component(r, &indices);
    a->sparse_value_view = get_required_index(r, &values, "bufferView", r->view_count, "buffer view");
    a->sparse_value_offset = get_uint(r, &values, "byteOffset", (uint64_t)1 << 53, 0);
    if (!reader_is_ok(r))
        return;
    gltf_component c = a->sparse_index_component;
    if (c != GLTF_U8 && c != GLTF_U16 && c != GLTF_U32) {
        reader_fail(r, &indices, "componentType", FACET_ERROR_INVALID, "%d is none of 5121, 5123, 5125",
                    (int)c);
        return;
    }
    if (a->sparse_count > a->count) {
        reader_fail(r, &at, "count", FACET_ERROR_INVALID, "%u is more than the %u elements of the accessor",
                    a->sparse_count, a->count);
        return;
    }
    if (r->views[a->sparse_index_view].stride || r->views[a->sparse_value_view].stride)
        reader_warn(r, &at, NULL, "uses a buffer view with byteStride, which is ignored");
    size_t size = component_size(c);
    check_extent(r, &indices, a->sparse_index_view, a->sparse_index_offset, a->sparse_count, size, size);
    size = element_size(a->component, a->type);
    check_extent(r, &values, a->sparse_value_view, a->sparse_value_offset, a->sparse_count, size, size);
}

static void read_accessor(reader *r, const json_place *at, gltf_accessor *a)
{
    a->component = get_component(r, at);
    a->type = get_type(r, at);
    a->count = (uint32_t)get_uint(r, at, "count", SCENE_NONE - 1, REQUIRED_UINT);
    a->is_normalized = get_bool(r, at, "normalized", false);
    a->view = get_index(r, at, "bufferView", r->view_count, "buffer view");
    a->offset = get_uint(r, at, "byteOffset", (uint64_t)1 << 53, 0);
    if (!reader_is_ok(r))
        return;
    if (a->count == 0)
        reader_warn(r, at, "count", "must be at least 1, but is 0");
    if (a->is_normalized && (a->component == GLTF_F32 || a->component == GLTF_U32)) {
        reader_warn(r, at, "normalized", "means nothing for this componentType and is ignored");
        a->is_normalized = false;
    }
    if (a->view != SCENE_NONE) {
        const gltf_view *view = &r->views[a->view];
        size_t size = element_size(a->component, a->type);
        if (view->stride && view->stride < size)
            reader_fail(r, at, NULL, FACET_ERROR_INVALID,
                        "elements of %zu bytes overlap at the byteStride %zu of "
                        "buffer view %u",
                        size, view->stride, a->view);
        check_extent(r, at, a->view, a->offset, a->count, view_stride(r, a), size);
        if (reader_is_ok(r) && (a->offset % component_size(a->component) ||
                                (a->offset + view->offset) % component_size(a->component)))
            reader_warn(r, at, "byteOffset", "%zu is not aligned to its components", a->offset);
    }
    read_sparse(r, at, a);
}

void read_accessors(reader *r, const json_place *root)
{
    json_place array = get_array(r, root, "accessors");
    size_t count = get_count(&array);
    r->accessors = reader_alloc(r, "accessors", count, sizeof *r->accessors);
    for (size_t i = 0; i < count && reader_is_ok(r); i++) {
        json_place at = get_element_object(r, &array, i);
        read_accessor(r, &at, &r->accessors[i]);
        r->accessor_count = (uint32_t)(i + 1);
    }
}

/* ---- elements ---- */

/* Little-endian loads from any address. */
static uint16_t load_u16(const unsigned char *p)
{
    return (uint16_t)(p[0] | p[1] << 8);
}

static uint32_t load_u32(const unsigned char *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

/* One row of components (section 3.6.2.2 and, for normalised ones, 3.11). The compiler makes each case a loop. */
static void convert_row(const unsigned char *in, gltf_component component, bool is_normalized, size_t count,
                        float *out)
{
    switch (component) {
    case GLTF_I8:
        for (size_t i = 0; i < count; i++) {
            float value = (float)(int8_t)in[i];
            out[i] = !is_normalized ? value : value < -127.0f ? -1.0f : value / 127.0f;
        }
        break;
    case GLTF_U8:
        for (size_t i = 0; i < count; i++)
            out[i] = is_normalized ? (float)in[i] / 255.0f : (float)in[i];
        break;
    case GLTF_I16:
        for (size_t i = 0; i < count; i++) {
            float value = (float)(int16_t)load_u16(in + 2 * i);
            out[i] = !is_normalized ? value : value < -32767.0f ? -1.0f : value / 32767.0f;
        }
        break;
    case GLTF_U16:
        for (size_t i = 0; i < count; i++) {
            float value = (float)load_u16(in + 2 * i);
            out[i] = is_normalized ? value / 65535.0f : value;
        }
        break;
    case GLTF_U32:
        for (size_t i = 0; i < count; i++)
            out[i] = (float)load_u32(in + 4 * i);
        break;
    case GLTF_F32:
        for (size_t i = 0; i < count; i++) {
            uint32_t bits = load_u32(in + 4 * i);
            memcpy(&out[i], &bits, sizeof bits);
        }
        break;
    }
}

typedef struct conversion {
    const unsigned char *bytes;
    size_t stride;
    gltf_component component;
    bool is_normalized;
    size_t component_count;
    size_t row_length, row_stride; /* components, bytes; matrices have several rows (columns) in an element */
    float *floats;
    uint32_t *indices;
    uint32_t *largest; /* per GRAIN */
} conversion;

static void convert_element(const conversion *c, const unsigned char *in, float *out)
{
    for (size_t done = 0; done < c->component_count; done += c->row_length, in += c->row_stride)
        convert_row(in, c->component, c->is_normalized, c->row_length, out + done);
}

static void convert_floats(void *context, size_t begin, size_t end)
{
    const conversion *c = context;
    size_t size = component_size(c->component) * c->component_count;
    if (c->stride == size && c->row_length == c->component_count) { /* tight: one long row */
        convert_row(c->bytes + begin * size, c->component, c->is_normalized,
                    (end - begin) * c->component_count, c->floats + begin * c->component_count);
        return;
    }
    for (size_t i = begin; i < end; i++)
        convert_element(c, c->bytes + i * c->stride, c->floats + i * c->component_count);
}

static conversion make_conversion(const reader *r, const gltf_accessor *a, const unsigned char *bytes)
{
    size_t rows = a->type == GLTF_MAT2 ? 2 : a->type == GLTF_MAT3 ? 3 : a->type == GLTF_MAT4 ? 4 : 1;
    conversion c = {.bytes = bytes,
                    .stride = view_stride(r, a),
                    .component = a->component,
                    .is_normalized = a->is_normalized,
                    .component_count = gltf_component_counts[a->type]};
    c.row_length = c.component_count / rows;
    c.row_stride = rows == 1 ? 0 : (c.row_length * component_size(a->component) + 3) / 4 * 4;
    return c;
}

/* Index number i of the sparse elements. */
static uint32_t sparse_index(const gltf_accessor *a, const unsigned char *bytes, size_t i)
{
    return a->sparse_index_component == GLTF_U8    ? bytes[i]
           : a->sparse_index_component == GLTF_U16 ? load_u16(bytes + 2 * i)
                                                   : load_u32(bytes + 4 * i);
}

/* Puts the sparse elements over what is there: into floats, or into indices. */
static bool apply_sparse(reader *r, const json_place *at, const gltf_accessor *a, float *floats,
                         uint32_t *indices)
{
    if (a->sparse_count == 0)
        return true;
    const unsigned char *places = get_view_bytes(r, at, a->sparse_index_view);
    const unsigned char *values = get_view_bytes(r, at, a->sparse_value_view);
    if (!places || !values)
        return false;
    places += a->sparse_index_offset;
    values += a->sparse_value_offset;
    conversion c = make_conversion(r, a, values);
    c.stride = element_size(a->component, a->type);
    for (size_t i = 0; i < a->sparse_count; i++) {
        uint32_t place = sparse_index(a, places, i);
        if (place >= a->count)
            return reader_fail(r, at, NULL, FACET_ERROR_INVALID,
                               "sparse index %zu is %u, but the accessor has %u elements", i, place,
                               a->count);
        const unsigned char *value = values + i * c.stride;
        if (floats)
            convert_element(&c, value, floats + place * c.component_count);
        else
            indices[place] = a->component == GLTF_U8    ? value[0]
                             : a->component == GLTF_U16 ? load_u16(value)
                                                        : load_u32(value);
    }
    return true;
}

/* The place of an accessor, for messages. */
#define ACCESSOR_PLACE(name, number)                                                                         \
    const json_place name##_root = {0};                                                                      \
    const json_place name##_array = {.parent = &name##_root, .key = "accessors"};                            \
    const json_place name = {.parent = &name##_array, .index = (number)}

static bool is_little_endian(void)
{
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 1;
}

const float *get_accessor_floats(reader *r, const json_place *at, uint32_t index)
{
    gltf_accessor *a = &r->accessors[index];
    if (a->floats || !reader_is_ok(r))
        return a->floats;
    size_t components = gltf_component_counts[a->type];
    if (!reader_spend(r, at, (uint64_t)a->count * components / 3))
        return NULL;
    ACCESSOR_PLACE(place, index);
    const unsigned char *bytes = NULL;
    if (a->view != SCENE_NONE) {
        bytes = get_view_bytes(r, &place, a->view);
        if (!bytes)
            return NULL;
        bytes += a->offset;
    }
    bool is_plain = bytes && a->component == GLTF_F32 && a->sparse_count == 0 && a->count > 0 &&
                    view_stride(r, a) == components * sizeof(float) && (uintptr_t)bytes % sizeof(float) == 0;
    if (is_plain && is_little_endian()) {
        a->floats = (const float *)(const void *)bytes;
        return a->floats;
    }
    size_t count = (size_t)a->count * components;
    float *floats = bytes ? reader_alloc_raw(r, "accessor", count, sizeof *floats)
                          : reader_alloc(r, "accessor", count, sizeof *floats);
    if (!floats)
        return NULL;
    if (bytes) {
        conversion c = make_conversion(r, a, bytes);
        c.floats = floats;
        parallel_for(r->thread_count, a->count, GRAIN, convert_floats, &c);
    }
    if (!apply_sparse(r, &place, a, floats, NULL))
        return NULL;
    a->floats = floats;
    return floats;
}

/* ---- indices ---- */

static void convert_indices(void *context, size_t begin, size_t end)
{
    const conversion *c = context;
    uint32_t *out = c->indices;
    if (c->component == GLTF_U8)
        for (size_t i = begin; i < end; i++)
            out[i] = c->bytes[i * c->stride];
    else if (c->component == GLTF_U16)
        for (size_t i = begin; i < end; i++)
            out[i] = load_u16(c->bytes + i * c->stride);
    else
        for (size_t i = begin; i < end; i++)
            out[i] = load_u32(c->bytes + i * c->stride);
}

static void find_largest(void *context, size_t begin, size_t end)
{
    const conversion *c = context;
    uint32_t largest = 0;
    for (size_t i = begin; i < end; i++)
        largest = c->indices[i] > largest ? c->indices[i] : largest;
    c->largest[begin / GRAIN] = largest;
}

const uint32_t *get_accessor_indices(reader *r, const json_place *at, uint32_t index, uint32_t *largest)
{
    gltf_accessor *a = &r->accessors[index];
    *largest = a->largest_index;
    if (a->indices || !reader_is_ok(r))
        return a->indices;
    ACCESSOR_PLACE(place, index);
    if (a->type != GLTF_SCALAR ||
        (a->component != GLTF_U8 && a->component != GLTF_U16 && a->component != GLTF_U32)) {
        reader_fail(r, at, NULL, FACET_ERROR_INVALID,
                    "accessor %u must have SCALAR elements of an unsigned type to be indices", index);
        return NULL;
    }
    if (!reader_spend(r, at, a->count))
        return NULL;
    const unsigned char *bytes = NULL;
    if (a->view != SCENE_NONE) {
        bytes = get_view_bytes(r, &place, a->view);
        if (!bytes)
            return NULL;
        bytes += a->offset;
        if (r->views[a->view].stride)
            reader_warn(r, &place, NULL, "holds indices, but its buffer view has a byteStride");
    }
    conversion c = make_conversion(r, a, bytes);
    const uint32_t *indices;
    if (bytes && a->component == GLTF_U32 && c.stride == 4 && a->sparse_count == 0 &&
        (uintptr_t)bytes % 4 == 0 && is_little_endian()) {
        indices = (const uint32_t *)(const void *)bytes;
        c.indices = (uint32_t *)(uintptr_t)bytes; /* find_largest only reads */
    } else {
        c.indices = reader_alloc(r, "indices", a->count, sizeof *c.indices);
        if (!c.indices)
            return NULL;
        if (bytes)
            parallel_for(r->thread_count, a->count, GRAIN, convert_indices, &c);
        if (!apply_sparse(r, &place, a, NULL, c.indices))
            return NULL;
        indices = c.indices;
    }
    size_t ranges = a->count / GRAIN + 1;
    c.largest = mem_zalloc(r->allocator, ranges, sizeof *c.largest);
    if (!c.largest) {
        reader_fail_memory(r, "indices", ranges * sizeof *c.largest);
        return NULL;
    }
    parallel_for(r->thread_count, a->count, GRAIN, find_largest, &c);
    for (size_t i = 0; i < ranges; i++)
        a->largest_index = c.largest[i] > a->largest_index ? c.largest[i] : a->largest_index;
    mem_free(c.largest);
    *largest = a->largest_index;
    a->indices = indices;
    return indices;
}
