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

size_t gltf_accessor_stride(const io_reader *r, const gltf_accessor *a)
{
    size_t stride = a->decoded || a->view == SCENE_NONE ? 0 : r->gltf->views[a->view].stride;
    return stride ? stride : gltf_element_size(a->component, a->type);
}

/* ---- the table ---- */

static gltf_component get_component(io_reader *r, const json_place *at)
{
    uint64_t value = io_get_uint(r, at, "componentType", UINT32_MAX, IO_REQUIRED_UINT);
    bool is_known = (value >= GLTF_I8 && value <= GLTF_U16) || value == GLTF_U32 || value == GLTF_F32;
    if (!is_known && io_is_ok(r))
        io_fail(r, at, "componentType", FACET_ERROR_INVALID,
                "%llu is none of 5120, 5121, 5122, 5123, 5125, 5126", (unsigned long long)value);
    return is_known ? (gltf_component)value : GLTF_U8;
}

static gltf_type get_type(io_reader *r, const json_place *at)
{
    const char *name = io_get_string(r, at, "type", NULL);
    for (int i = 0; name && i < GLTF_TYPE_COUNT; i++)
        if (strcmp(name, TYPE_NAMES[i]) == 0)
            return (gltf_type)i;
    if (name)
        io_fail(r, at, "type", FACET_ERROR_INVALID, "\"%.40s\" is no type of accessor", name);
    else
        io_fail(r, at, "type", FACET_ERROR_INVALID, "is missing");
    return GLTF_SCALAR;
}

/* Whether count elements of size bytes every stride bytes from offset are inside the view. */
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
        io_fail(r, &indices, "componentType", FACET_ERROR_INVALID, "%d is none of 5121, 5123, 5125", (int)c);
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
    if (a->is_normalized && (a->component == GLTF_F32 || a->component == GLTF_U32)) {
        io_note(r, at, "normalized", "means nothing for this componentType and is ignored");
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
        check_extent(r, at, a->view, a->offset, a->count, gltf_accessor_stride(r, a), size);
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

bool gltf_check_claim(io_reader *r, const json_place *at, const gltf_accessor *a)
{
    const uint64_t free_count = 1 << 16; /* of elements, at most 4 MiB */
    const uint64_t per_value = 64;
    if (a->view != SCENE_NONE || a->decoded || a->count <= free_count || a->count <= r->gltf->backed_count ||
        a->count <= per_value * a->sparse_count)
        return true;
    return io_fail(r, at, "count", FACET_ERROR_LIMIT,
                   "%u elements are claimed without a buffer view; at most %llu are allowed here", a->count,
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
