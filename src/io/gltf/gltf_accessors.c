/* gltf_accessors.c - the table of typed arrays in the binary data (glTF 2.0 section 3.6.2), checked when it is read;
 * gltf_elements.c then trusts it. min and max are not read: they are often wrong and never needed. */
#include <string.h>

#include "io/gltf/gltf_reader.h"

const uint32_t gltf_component_counts[GLTF_TYPE_COUNT] = {1, 2, 3, 4, 4, 9, 16};

static const char *const TYPE_NAMES[GLTF_TYPE_COUNT] = {"SCALAR", "VEC2", "VEC3", "VEC4",
                                                        "MAT2",   "MAT3", "MAT4"};

/* ---- sizes ---- */

size_t gltf_component_size(gltf_component component)
{
    return component == GLTF_I8 || component == GLTF_U8     ? 1
           : component == GLTF_I16 || component == GLTF_U16 ? 2
                                                            : 4;
}

size_t gltf_column_count(gltf_type type)
{
    return type == GLTF_MAT2 ? 2 : type == GLTF_MAT3 ? 3 : type == GLTF_MAT4 ? 4 : 1;
}

size_t gltf_column_size(gltf_component component, gltf_type type)
{
    size_t columns = gltf_column_count(type);
    size_t size = gltf_component_counts[type] / columns * gltf_component_size(component);
    return columns == 1 ? size : (size + 3) / 4 * 4; /* section 3.6.2.4 */
}

size_t gltf_element_size(gltf_component component, gltf_type type)
{
    return gltf_column_count(type) * gltf_column_size(component, type);
}

size_t gltf_accessor_stride(const reader *r, const gltf_accessor *a)
{
    size_t stride = a->decoded || a->view == SCENE_NONE ? 0 : r->views[a->view].stride;
    return stride ? stride : gltf_element_size(a->component, a->type);
}

/* ---- the table ---- */

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
    if (r->views[a->sparse_index_view].problem.message || r->views[a->sparse_value_view].problem.message) {
        bool is_index = r->views[a->sparse_index_view].problem.message != NULL;
        reader_fail_deferred(r, &r->views[is_index ? a->sparse_index_view : a->sparse_value_view].problem);
        return;
    }
    if (r->views[a->sparse_index_view].stride || r->views[a->sparse_value_view].stride)
        reader_warn(r, &at, NULL, "uses a buffer view with byteStride, which is ignored");
    size_t size = gltf_component_size(c);
    check_extent(r, &indices, a->sparse_index_view, a->sparse_index_offset, a->sparse_count, size, size);
    size = gltf_element_size(a->component, a->type);
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
    if (reader_is_ok(r) && a->view != SCENE_NONE && r->views[a->view].problem.message)
        reader_fail_deferred(r, &r->views[a->view].problem);
    if (!reader_is_ok(r))
        return;
    if (a->count == 0)
        reader_note(r, at, "count", "must be at least 1, but is 0");
    if (a->is_normalized && (a->component == GLTF_F32 || a->component == GLTF_U32)) {
        reader_note(r, at, "normalized", "means nothing for this componentType and is ignored");
        a->is_normalized = false;
    }
    if (a->view != SCENE_NONE) {
        const gltf_view *view = &r->views[a->view];
        size_t size = gltf_element_size(a->component, a->type);
        if (view->stride && view->stride < size)
            reader_fail(r, at, NULL, FACET_ERROR_INVALID,
                        "elements of %zu bytes overlap at the byteStride %zu of "
                        "buffer view %u",
                        size, view->stride, a->view);
        check_extent(r, at, a->view, a->offset, a->count, gltf_accessor_stride(r, a), size);
        if (reader_is_ok(r) && (a->offset % gltf_component_size(a->component) ||
                                (a->offset + view->offset) % gltf_component_size(a->component)))
            reader_note(r, at, "byteOffset", "%zu is not aligned to its components", a->offset);
    }
    read_sparse(r, at, a);
}

bool is_zero_accessor(const reader *r, uint32_t accessor)
{
    const gltf_accessor *a = &r->accessors[accessor];
    return a->view == SCENE_NONE && a->sparse_count == 0 && !a->decoded;
}

bool check_claim(reader *r, const json_place *at, const gltf_accessor *a)
{
    const uint64_t free_count = 1 << 16; /* of elements, at most 4 MiB */
    const uint64_t per_value = 64;
    if (a->view != SCENE_NONE || a->decoded || a->count <= free_count || a->count <= r->backed_count ||
        a->count <= per_value * a->sparse_count)
        return true;
    return reader_fail(r, at, "count", FACET_ERROR_LIMIT,
                       "%u elements are claimed without a buffer view; at most %llu are allowed here",
                       a->count, (unsigned long long)free_count);
}

void read_accessors(reader *r, const json_place *root)
{
    json_place array = get_array(r, root, "accessors");
    size_t count = get_count(&array);
    r->accessors = reader_alloc(r, "accessors", count, sizeof *r->accessors);
    for (size_t i = 0; i < count && reader_is_ok(r); i++) {
        json_place at = get_element_object(r, &array, i);
        read_accessor(r, &at, &r->accessors[i]);
        reader_defer(r, &r->accessors[i].problem);
        r->accessor_count = (uint32_t)(i + 1);
        if (!r->accessors[i].problem.message && r->accessors[i].view != SCENE_NONE &&
            r->accessors[i].count > r->backed_count)
            r->backed_count = r->accessors[i].count;
    }
}
