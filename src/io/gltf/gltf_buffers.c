/* gltf_buffers.c - buffers and buffer views: where bytes are. A buffer is read when something needs its bytes. */
#include <string.h>

#include "io/gltf/gltf_reader.h"

void read_buffers(reader *r, const json_place *root)
{
    json_place array = get_array(r, root, "buffers");
    size_t count = get_count(&array);
    r->buffers = reader_alloc(r, "buffers", count, sizeof *r->buffers);
    for (size_t i = 0; i < count && reader_is_ok(r); i++) {
        json_place at = get_element_object(r, &array, i);
        gltf_buffer *buffer = &r->buffers[i];
        buffer->byte_length = get_uint(r, &at, "byteLength", (uint64_t)1 << 53, REQUIRED_UINT);
        buffer->uri = get_string(r, &at, "uri", NULL);
        buffer->is_fallback = is_meshopt_fallback(r, &at);
        if (reader_is_ok(r) && buffer->byte_length == 0)
            reader_note(r, &at, "byteLength", "must be at least 1, but is 0");
        reader_defer(r, &buffer->problem);
        r->buffer_count = (uint32_t)(i + 1);
    }
}

static void read_view(reader *r, const json_place *at, gltf_view *view)
{
    view->buffer = get_required_index(r, at, "buffer", r->buffer_count, "buffer");
    view->offset = get_uint(r, at, "byteOffset", (uint64_t)1 << 53, 0);
    view->length = get_uint(r, at, "byteLength", (uint64_t)1 << 53, REQUIRED_UINT);
    view->stride = get_uint(r, at, "byteStride", UINT32_MAX, 0);
    if (reader_is_ok(r) && r->buffers[view->buffer].problem.message)
        reader_fail_deferred(r, &r->buffers[view->buffer].problem);
    if (!reader_is_ok(r))
        return;
    size_t size = r->buffers[view->buffer].byte_length;
    if (view->offset > size) {
        reader_fail(r, at, "byteOffset", FACET_ERROR_INVALID, "%zu is past the end of buffer %u (%zu bytes)",
                    view->offset, view->buffer, size);
        return;
    }
    if (view->length > size - view->offset) {
        reader_warn(r, at, "byteLength",
                    "%zu from offset %zu goes past the end of buffer %u (%zu bytes); it ends there",
                    view->length, view->offset, view->buffer, size);
        view->length = size - view->offset;
    }
    if (view->stride && (view->stride < 4 || view->stride > 252 || view->stride % 4))
        reader_note(r, at, "byteStride", "%zu is not one of 4, 8, .. 252", view->stride);
    if (view->stride && get_uint(r, at, "target", UINT32_MAX, 0) == 34963)
        reader_note(r, at, "byteStride", "means nothing for indices");
    read_meshopt(r, at, view);
}

void read_views(reader *r, const json_place *root)
{
    json_place array = get_array(r, root, "bufferViews");
    size_t count = get_count(&array);
    r->views = reader_alloc(r, "buffer views", count, sizeof *r->views);
    for (size_t i = 0; i < count && reader_is_ok(r); i++) {
        json_place at = get_element_object(r, &array, i);
        gltf_view *view = &r->views[i];
        read_view(r, &at, view);
        if (reader_defer(r, &view->problem))
            view->compressed = NULL;
        r->view_count = (uint32_t)(i + 1);
    }
}

bool has_buffer_source(const reader *r, uint32_t buffer)
{
    return r->buffers[buffer].uri || (buffer == 0 && r->bin);
}

bool has_view_source(const reader *r, uint32_t view)
{
    const gltf_view *v = &r->views[view];
    return v->problem.message || /* reported when the bytes are requested */
           has_buffer_source(r, v->compressed ? get_meshopt_buffer(v->compressed) : v->buffer);
}

bool has_accessor_source(const reader *r, uint32_t accessor)
{
    const gltf_accessor *a = &r->accessors[accessor];
    if (a->problem.message) /* reported when the elements are requested */
        return true;
    return (a->decoded || a->indices || a->view == SCENE_NONE || has_view_source(r, a->view)) &&
           (a->sparse_count == 0 ||
            (has_view_source(r, a->sparse_index_view) && has_view_source(r, a->sparse_value_view)));
}

/* Makes the bytes of a buffer come to be. */
static bool load_buffer(reader *r, const json_place *at, uint32_t index)
{
    gltf_buffer *buffer = &r->buffers[index];
    if (buffer->data)
        return true;
    if (buffer->problem.message)
        return reader_fail_deferred(r, &buffer->problem);
    size_t size = 0;
    if (buffer->uri) {
        uri_bytes bytes;
        if (!load_uri(r, buffer->uri, &bytes)) { /* looked for once */
            reader_fail(r, at, "uri", bytes.result, "%s", bytes.message);
            return reader_defer(r, &buffer->problem) && reader_fail_deferred(r, &buffer->problem);
        }
        buffer->data = bytes.data;
        size = bytes.size;
    } else if (index == 0 && r->bin) {
        buffer->data = r->bin;
        size = r->bin_size;
    } else {
        return reader_fail(r, at, NULL, FACET_ERROR_INVALID, "has neither a uri nor a binary chunk");
    }
    buffer->available = size < buffer->byte_length ? size : buffer->byte_length;
    if (size > buffer->byte_length && size - buffer->byte_length > (buffer->uri ? 0u : 3u))
        reader_note(r, at, "byteLength", "says %zu bytes, but there are %zu; the rest is ignored",
                    buffer->byte_length, size);
    return true;
}

const unsigned char *get_buffer_bytes(reader *r, uint32_t index, size_t end)
{
    const json_place root = {.value = r->json};
    const json_place array = {.parent = &root, .key = "buffers"};
    const json_place at = {.parent = &array, .index = index};
    const gltf_buffer *buffer = &r->buffers[index];
    if (!reader_is_ok(r) || !load_buffer(r, &at, index))
        return NULL;
    if (end > buffer->available) {
        reader_fail(r, &at, "byteLength", FACET_ERROR_INVALID, "says %zu bytes, but there are %zu",
                    buffer->byte_length, buffer->available);
        return NULL;
    }
    if (buffer->available < buffer->byte_length)
        reader_warn(r, &at, NULL, "has %zu of its %zu bytes; what needs only those is drawn",
                    buffer->available, buffer->byte_length);
    return buffer->data;
}

const unsigned char *get_view_bytes(reader *r, const json_place *at, uint32_t index)
{
    gltf_view *view = &r->views[index];
    if (view->problem.message)
        reader_fail_deferred(r, &view->problem);
    if (!reader_is_ok(r))
        return NULL;
    if (view->compressed)
        return get_meshopt_bytes(r, at, index);
    const unsigned char *bytes = get_buffer_bytes(r, view->buffer, view->offset + view->length);
    return bytes ? bytes + view->offset : NULL;
}

static bool draws_meshes(const facet_scene *scene)
{
    uint32_t i = 0;
    while (i < scene->node_count && scene->nodes[i].mesh == SCENE_NONE)
        i++;
    return i < scene->node_count;
}

void check_unused_parts(reader *r)
{
    const json_place root = {.value = r->json};
    const json_place array = {.parent = &root, .key = "buffers"};
    for (uint32_t i = 0; i < r->buffer_count; i++) {
        const json_place at = {.parent = &array, .index = i};
        uri_bytes bytes;
        reader_warn_deferred(r, &r->buffers[i].problem);
        if (!r->buffers[i].data && r->buffers[i].uri && !r->buffers[i].is_fallback &&
            !load_uri(r, r->buffers[i].uri, &bytes))
            reader_note(r, &at, "uri", "%s; nothing uses it", bytes.message);
    }
    for (uint32_t i = 0; i < r->view_count; i++)
        reader_warn_deferred(r, &r->views[i].problem);
    for (uint32_t i = 0; i < r->accessor_count; i++)
        reader_warn_deferred(r, &r->accessors[i].problem);
    for (uint32_t i = 0; i < r->scene->mesh_count; i++) {
        if (r->meshes[i].problem.message && !draws_meshes(r->scene))
            reader_fail_deferred(r, &r->meshes[i].problem); /* rather than an empty image */
        reader_warn_deferred(r, &r->meshes[i].problem);
        reader_warn_deferred(r, &r->meshes[i].joints);
    }
    for (uint32_t i = 0; i < r->scene->material_count; i++)
        reader_warn_deferred(r, &r->material_problems[i]);
}
