/* gltf_accessors.c - typed arrays in the binary data (glTF 2.0 section 3.6.2): the table, which is checked
 * when it is read, and the elements as arrays of floats or indices. min and max are not read: they are
 * often wrong and never needed. */
#include <string.h>

#include "base/parallel.h"
#include "io/gltf/gltf_components.h"
#include "scene/origin.h"

const uint32_t gltf_component_counts[GLTF_TYPE_COUNT] = {1, 2, 3, 4, 4, 9, 16};

static const char *const TYPE_NAMES[GLTF_TYPE_COUNT] = {"SCALAR", "VEC2", "VEC3", "VEC4",
                                                        "MAT2",   "MAT3", "MAT4"};

/* ---- sizes ---- */

/* 1 for types other than matrices */
static size_t column_count(gltf_type type)
{
    return type == GLTF_MAT2 ? 2 : type == GLTF_MAT3 ? 3 : type == GLTF_MAT4 ? 4 : 1;
}

static size_t column_size(gltf_component component, gltf_type type)
{
    size_t columns = column_count(type);
    size_t size = gltf_component_counts[type] / columns * gltf_component_size(component);
    return columns == 1 ? size : (size + 3) / 4 * 4; /* section 3.6.2.4 */
}

size_t gltf_element_size(gltf_component component, gltf_type type)
{
    return column_count(type) * column_size(component, type);
}

/* Bytes between consecutive dense elements. */
static size_t accessor_stride(const io_reader *r, const gltf_accessor *a)
{
    size_t stride = a->decoded || a->view == SCENE_NONE ? 0 : r->gltf->views[a->view].stride;
    return stride ? stride : gltf_element_size(a->component, a->type);
}

/* ---- the table ---- */

static gltf_component get_component(io_reader *r, const json_place *at)
{
    uint64_t value = io_get_uint(r, at, "componentType", UINT32_MAX, IO_REQUIRED_UINT);
    bool is_known = (value >= GLTF_I8 && value <= GLTF_U16) || value == GLTF_U32 || value == GLTF_F32 ||
                    value == GLTF_F64 || value == GLTF_F16;
    const char *extension = value == GLTF_F64   ? "KHR_accessor_float64"
                            : value == GLTF_F16 ? "KHR_accessor_float16"
                                                : NULL;
    if (extension && !gltf_is_extension_listed(r, extension))
        io_note(r, at, "componentType", "%u needs %s, which the file does not list", (unsigned)value,
                extension);
    if (!is_known && io_is_ok(r))
        io_fail(r, at, "componentType", FACET_ERROR_INVALID,
                "%llu is not one of 5120, 5121, 5122, 5123, 5125, 5126", (unsigned long long)value);
    return is_known ? (gltf_component)value : GLTF_U8;
}

static gltf_type get_type(io_reader *r, const json_place *at)
{
    const char *name = io_get_string(r, at, "type", NULL);
    for (int i = 0; name && i < GLTF_TYPE_COUNT; i++)
        if (strcmp(name, TYPE_NAMES[i]) == 0)
            return (gltf_type)i;
    if (name)
        io_fail(r, at, "type", FACET_ERROR_INVALID, "\"%.40s\" is not an accessor type", name);
    else
        io_fail(r, at, "type", FACET_ERROR_INVALID, "is missing");
    return GLTF_SCALAR;
}

/* Whether count elements of size bytes, stride bytes apart from offset on, are inside the view. */
static bool check_extent(io_reader *r, const json_place *at, uint32_t index, size_t offset, size_t count,
                         size_t stride, size_t size)
{
    size_t length = r->gltf->views[index].length;
    if (count == 0)
        return true;
    if (offset > length)
        return io_fail(r, at, "byteOffset", FACET_ERROR_INVALID,
                       "%zu is past the end of buffer view %u (%zu bytes)", offset, index, length);
    size_t room = length - offset;
    if (size > room || (count - 1) > (room - size) / stride)
        return io_fail(r, at, "count", FACET_ERROR_INVALID,
                       "%zu elements of %zu bytes, %zu apart, from offset %zu go past the end of buffer view "
                       "%u (%zu bytes)",
                       count, size, stride, offset, index, length);
    return true;
}

static void read_sparse(io_reader *r, const json_place *accessor, gltf_accessor *a)
{
    json_place at = io_get_object(r, accessor, "sparse");
    if (!at.value)
        return;
    json_place indices = io_get_object(r, &at, "indices");
    json_place values = io_get_object(r, &at, "values");
    if (io_is_ok(r) && (!indices.value || !values.value))
        io_fail(r, &at, indices.value ? "values" : "indices", FACET_ERROR_INVALID, "is missing");
    a->sparse_count = (uint32_t)io_get_uint(r, &at, "count", SCENE_NONE - 1, IO_REQUIRED_UINT);
    a->sparse_index_view =
        io_get_required_index(r, &indices, "bufferView", r->gltf->view_count, "buffer view");
    a->sparse_index_offset = io_get_uint(r, &indices, "byteOffset", (uint64_t)1 << 53, 0);
    a->sparse_index_component = get_component(r, &indices);
    a->sparse_value_view =
        io_get_required_index(r, &values, "bufferView", r->gltf->view_count, "buffer view");
    a->sparse_value_offset = io_get_uint(r, &values, "byteOffset", (uint64_t)1 << 53, 0);
    if (!io_is_ok(r))
        return;
    gltf_component c = a->sparse_index_component;
    if (c != GLTF_U8 && c != GLTF_U16 && c != GLTF_U32) {
        io_fail(r, &indices, "componentType", FACET_ERROR_INVALID, "%d is not one of 5121, 5123, 5125",
                (int)c);
        return;
    }
    if (a->sparse_count > a->count) {
        io_fail(r, &at, "count", FACET_ERROR_INVALID, "%u is more than the %u elements of the accessor",
                a->sparse_count, a->count);
        return;
    }
    if (r->gltf->views[a->sparse_index_view].problem.message ||
        r->gltf->views[a->sparse_value_view].problem.message) {
        bool is_index = r->gltf->views[a->sparse_index_view].problem.message != NULL;
        io_fail_deferred(r, &r->gltf->views[is_index ? a->sparse_index_view : a->sparse_value_view].problem);
        return;
    }
    if (r->gltf->views[a->sparse_index_view].stride || r->gltf->views[a->sparse_value_view].stride)
        io_warn(r, &at, NULL, "uses a buffer view with byteStride, which is ignored");
    size_t size = gltf_component_size(c);
    check_extent(r, &indices, a->sparse_index_view, a->sparse_index_offset, a->sparse_count, size, size);
    size = gltf_element_size(a->component, a->type);
    check_extent(r, &values, a->sparse_value_view, a->sparse_value_offset, a->sparse_count, size, size);
}

static void read_accessor(io_reader *r, const json_place *at, gltf_accessor *a)
{
    a->component = get_component(r, at);
    a->type = get_type(r, at);
    a->count = (uint32_t)io_get_uint(r, at, "count", SCENE_NONE - 1, IO_REQUIRED_UINT);
    a->is_normalized = io_get_bool(r, at, "normalized", false);
    a->view = io_get_index(r, at, "bufferView", r->gltf->view_count, "buffer view");
    a->offset = io_get_uint(r, at, "byteOffset", (uint64_t)1 << 53, 0);
    if (io_is_ok(r) && a->view != SCENE_NONE && r->gltf->views[a->view].problem.message)
        io_fail_deferred(r, &r->gltf->views[a->view].problem);
    if (!io_is_ok(r))
        return;
    if (a->count == 0)
        io_note(r, at, "count", "must be at least 1, but is 0");
    if (a->is_normalized && (gltf_is_float(a->component) || a->component == GLTF_U32)) {
        io_note(r, at, "normalized", "has no meaning for this componentType and is ignored");
        a->is_normalized = false;
    }
    if (a->view != SCENE_NONE) {
        const gltf_view *view = &r->gltf->views[a->view];
        size_t size = gltf_element_size(a->component, a->type);
        if (view->stride && view->stride < size)
            io_fail(r, at, NULL, FACET_ERROR_INVALID,
                    "elements of %zu bytes overlap at the byteStride %zu of "
                    "buffer view %u",
                    size, view->stride, a->view);
        check_extent(r, at, a->view, a->offset, a->count, accessor_stride(r, a), size);
        if (io_is_ok(r) && (a->offset % gltf_component_size(a->component) ||
                            (a->offset + view->offset) % gltf_component_size(a->component)))
            io_note(r, at, "byteOffset", "%zu is not aligned to its components", a->offset);
    }
    read_sparse(r, at, a);
}

bool gltf_is_zero_accessor(const io_reader *r, uint32_t accessor)
{
    const gltf_accessor *a = &r->gltf->accessors[accessor];
    return a->view == SCENE_NONE && a->sparse_count == 0 && !a->decoded;
}

/* Refuses (FACET_ERROR_LIMIT) an accessor without a buffer view that has many more elements than any array
 * in the file and than its sparse values: a few bytes of JSON must not allocate gigabytes. */
static bool check_claim(io_reader *r, const json_place *at, const gltf_accessor *a)
{
    const uint64_t free_count = 1 << 16; /* elements, at most 4 MiB */
    const uint64_t per_value = 64;
    if (a->view != SCENE_NONE || a->decoded || a->count <= free_count || a->count <= r->gltf->backed_count ||
        a->count <= per_value * a->sparse_count)
        return true;
    return io_fail(r, at, "count", FACET_ERROR_LIMIT,
                   "%u elements are declared without a buffer view; at most %llu are allowed", a->count,
                   (unsigned long long)free_count);
}

void gltf_read_accessors(io_reader *r, const json_place *root)
{
    json_place array = io_get_array(r, root, "accessors");
    size_t count = io_get_count(&array);
    r->gltf->accessors = io_alloc(r, "accessors", count, sizeof *r->gltf->accessors);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        read_accessor(r, &at, &r->gltf->accessors[i]);
        io_defer(r, &r->gltf->accessors[i].problem);
        r->gltf->accessor_count = (uint32_t)(i + 1);
        if (!r->gltf->accessors[i].problem.message && r->gltf->accessors[i].view != SCENE_NONE &&
            r->gltf->accessors[i].count > r->gltf->backed_count)
            r->gltf->backed_count = r->gltf->accessors[i].count;
    }
}

uint32_t gltf_get_accessor(io_reader *r, const json_place *object, const char *key)
{
    uint32_t index = io_get_index(r, object, key, r->gltf->accessor_count, "accessor");
    if (index == SCENE_NONE || !r->gltf->accessors[index].problem.message)
        return index;
    io_fail_deferred(r, &r->gltf->accessors[index].problem);
    return SCENE_NONE;
}

uint32_t gltf_get_required_accessor(io_reader *r, const json_place *object, const char *key)
{
    if (object->value && !io_has_member(object, key))
        io_fail(r, object, key, FACET_ERROR_INVALID, "is missing");
    return gltf_get_accessor(r, object, key);
}

/* ---- elements ---- */

enum { GRAIN = 1 << 15 }; /* elements per work item */

/* ---- elements ---- */

typedef struct conversion {
    const unsigned char *bytes;
    size_t stride;
    gltf_component component;
    bool is_normalized;
    size_t component_count;
    size_t column_length; /* components per column; only matrices have several columns */
    size_t column_size;   /* bytes */
    float *floats;
    uint32_t *indices;
    uint32_t *largest; /* per work item */
} conversion;

static void convert_element(const conversion *c, const unsigned char *in, float *out)
{
    for (size_t done = 0; done < c->component_count; done += c->column_length, in += c->column_size)
        gltf_convert_components(in, c->component, c->is_normalized, c->column_length, out + done);
}

static void convert_floats(void *context, size_t begin, size_t end)
{
    const conversion *c = context;
    size_t size = gltf_component_size(c->component) * c->component_count;
    if (c->stride == size && c->column_length == c->component_count) { /* tight */
        gltf_convert_components(c->bytes + begin * size, c->component, c->is_normalized,
                                (end - begin) * c->component_count, c->floats + begin * c->component_count);
        return;
    }
    for (size_t i = begin; i < end; i++)
        convert_element(c, c->bytes + i * c->stride, c->floats + i * c->component_count);
}

static conversion make_conversion(const io_reader *r, const gltf_accessor *a, const unsigned char *bytes)
{
    size_t component_count = gltf_component_counts[a->type];
    return (conversion){.bytes = bytes,
                        .stride = accessor_stride(r, a),
                        .component = a->component,
                        .is_normalized = a->is_normalized,
                        .component_count = component_count,
                        .column_length = component_count / column_count(a->type),
                        .column_size = column_size(a->component, a->type)};
}

/* Writes the sparse elements into floats or indices. */
static bool apply_sparse(io_reader *r, const json_place *at, const gltf_accessor *a, float *floats,
                         uint32_t *indices)
{
    if (a->sparse_count == 0)
        return true;
    const unsigned char *places = gltf_get_view_bytes(r, at, a->sparse_index_view);
    const unsigned char *values = gltf_get_view_bytes(r, at, a->sparse_value_view);
    if (!places || !values)
        return false;
    places += a->sparse_index_offset;
    values += a->sparse_value_offset;
    size_t place_size = gltf_component_size(a->sparse_index_component);
    conversion c = make_conversion(r, a, values);
    c.stride = gltf_element_size(a->component, a->type);
    for (size_t i = 0; i < a->sparse_count; i++) {
        uint32_t place = gltf_load_unsigned(places + i * place_size, a->sparse_index_component);
        if (place >= a->count)
            return io_fail(r, at, NULL, FACET_ERROR_INVALID,
                           "sparse index %zu is %u, but the accessor has %u elements", i, place, a->count);
        const unsigned char *value = values + i * c.stride;
        if (floats)
            convert_element(&c, value, floats + place * c.component_count);
        else
            indices[place] = gltf_load_unsigned(value, a->component);
    }
    return true;
}

/* ---- whole accessors ---- */

/* The place of an accessor in messages. */
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

/* The first dense element; *bytes is NULL where there are none and all elements are 0. */
static bool get_dense_bytes(io_reader *r, const json_place *at, const gltf_accessor *a,
                            const unsigned char **bytes)
{
    *bytes = a->decoded;
    if (a->decoded || a->view == SCENE_NONE)
        return true;
    const unsigned char *view = gltf_get_view_bytes(r, at, a->view);
    if (!view)
        return false;
    *bytes = view + a->offset;
    return true;
}

/* Whether the bytes are already a tight array of this 4-byte component, which needs no copy. */
static bool is_plain_array(const io_reader *r, const gltf_accessor *a, const unsigned char *bytes,
                           gltf_component component)
{
    return bytes && a->component == component && a->sparse_count == 0 &&
           accessor_stride(r, a) == gltf_component_counts[a->type] * 4 && (uintptr_t)bytes % 4 == 0 &&
           is_little_endian();
}

const float *gltf_get_accessor_floats(io_reader *r, const json_place *at, uint32_t index)
{
    gltf_accessor *a = &r->gltf->accessors[index];
    if (a->floats || !io_is_ok(r))
        return a->floats;
    size_t components = gltf_component_counts[a->type];
    if (!io_spend(r, at, (uint64_t)a->count * components / 3))
        return NULL;
    ACCESSOR_PLACE(place, index);
    const unsigned char *bytes;
    if (!check_claim(r, &place, a) || !get_dense_bytes(r, &place, a, &bytes))
        return NULL;
    if (a->count > 0 && is_plain_array(r, a, bytes, GLTF_F32)) {
        a->floats = (const float *)(const void *)bytes;
        return a->floats;
    }
    size_t count = (size_t)a->count * components;
    float *floats = bytes ? io_alloc_raw(r, "accessor", count, sizeof *floats)
                          : io_alloc(r, "accessor", count, sizeof *floats);
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

/* A point near the accessor's positions, if these are too far from 0 for floats. False: an error is recorded. */
static bool find_origin(io_reader *r, const json_place *at, uint32_t index)
{
    gltf_accessor *a = &r->gltf->accessors[index];
    const float *rounded = gltf_get_accessor_floats(r, at, index);
    return rounded && (scene_find_origin(rounded, a->count, r->allocator, a->origin) || io_is_ok(r));
}

const float *gltf_get_accessor_near(io_reader *r, const json_place *at, uint32_t index)
{
    gltf_accessor *a = &r->gltf->accessors[index];
    ACCESSOR_PLACE(place, index);
    const unsigned char *bytes;
    if (a->sparse_count || a->type != GLTF_VEC3)
        return gltf_get_accessor_floats(r, at, index);
    if (!find_origin(r, at, index) || !get_dense_bytes(r, &place, a, &bytes))
        return NULL;
    if (!bytes || (a->origin[0] == 0.0 && a->origin[1] == 0.0 && a->origin[2] == 0.0))
        return a->floats;
    float *floats = io_alloc_raw(r, "accessor", 3 * (size_t)a->count, sizeof *floats);
    size_t stride = accessor_stride(r, a);
    for (size_t i = 0; floats && i < a->count; i++)
        for (size_t k = 0; k < 3; k++)
            floats[3 * i + k] = (float)(gltf_load_f64(bytes + i * stride + 8 * k) - a->origin[k]);
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
            out[i] = gltf_load_u16(c->bytes + i * c->stride);
    else
        for (size_t i = begin; i < end; i++)
            out[i] = gltf_load_u32(c->bytes + i * c->stride);
}

static void find_largest(void *context, size_t begin, size_t end)
{
    const conversion *c = context;
    uint32_t largest = 0;
    for (size_t i = begin; i < end; i++)
        largest = c->indices[i] > largest ? c->indices[i] : largest;
    c->largest[begin / GRAIN] = largest;
}

const uint32_t *gltf_get_accessor_indices(io_reader *r, const json_place *at, uint32_t index,
                                          uint32_t *largest)
{
    gltf_accessor *a = &r->gltf->accessors[index];
    *largest = a->largest_index;
    if (a->indices || !io_is_ok(r))
        return a->indices;
    ACCESSOR_PLACE(place, index);
    if (a->type != GLTF_SCALAR ||
        (a->component != GLTF_U8 && a->component != GLTF_U16 && a->component != GLTF_U32)) {
        io_fail(r, at, NULL, FACET_ERROR_INVALID,
                "accessor %u must have SCALAR elements of an unsigned type to be indices", index);
        return NULL;
    }
    if (!io_spend(r, at, a->count))
        return NULL;
    const unsigned char *bytes;
    if (!check_claim(r, &place, a) || !get_dense_bytes(r, &place, a, &bytes))
        return NULL;
    if (bytes && !a->decoded && r->gltf->views[a->view].stride)
        io_note(r, &place, NULL, "holds indices, but its buffer view has a byteStride");
    conversion c = make_conversion(r, a, bytes);
    const uint32_t *indices;
    if (is_plain_array(r, a, bytes, GLTF_U32)) {
        indices = (const uint32_t *)(const void *)bytes;
        c.indices = (uint32_t *)(uintptr_t)bytes; /* find_largest only reads */
    } else {
        c.indices = io_alloc(r, "indices", a->count, sizeof *c.indices);
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
        io_fail_memory(r, "indices", ranges * sizeof *c.largest);
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
