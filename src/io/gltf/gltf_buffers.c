/* gltf_buffers.c - buffers and buffer views. The bytes of a buffer are loaded on first use. */
#include <string.h>

#include "io/gltf/gltf_reader.h"

void gltf_read_buffers(io_reader *r, const json_place *root)
{
    json_place array = io_get_array(r, root, "buffers");
    size_t count = io_get_count(&array);
    r->gltf->buffers = io_alloc(r, "buffers", count, sizeof *r->gltf->buffers);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        gltf_buffer *buffer = &r->gltf->buffers[i];
        buffer->byte_length = io_get_uint(r, &at, "byteLength", (uint64_t)1 << 53, IO_REQUIRED_UINT);
        buffer->uri = io_get_string(r, &at, "uri", NULL);
        buffer->is_fallback = gltf_is_meshopt_fallback(r, &at);
        if (io_is_ok(r) && buffer->byte_length == 0)
            io_note(r, &at, "byteLength", "must be at least 1, but is 0");
        io_defer(r, &buffer->problem);
        r->gltf->buffer_count = (uint32_t)(i + 1);
    }
}

static void read_view(io_reader *r, const json_place *at, gltf_view *view)
{
    view->buffer = io_get_required_index(r, at, "buffer", r->gltf->buffer_count, "buffer");
    view->offset = io_get_uint(r, at, "byteOffset", (uint64_t)1 << 53, 0);
    view->length = io_get_uint(r, at, "byteLength", (uint64_t)1 << 53, IO_REQUIRED_UINT);
    view->stride = io_get_uint(r, at, "byteStride", UINT32_MAX, 0);
    if (io_is_ok(r) && r->gltf->buffers[view->buffer].problem.message)
        io_fail_deferred(r, &r->gltf->buffers[view->buffer].problem);
    if (!io_is_ok(r))
        return;
    size_t size = r->gltf->buffers[view->buffer].byte_length;
    if (view->offset > size) {
        io_fail(r, at, "byteOffset", FACET_ERROR_INVALID, "%zu is past the end of buffer %u (%zu bytes)",
                view->offset, view->buffer, size);
        return;
    }
    if (view->length > size - view->offset) {
        io_warn(r, at, "byteLength",
                "%zu from offset %zu goes past the end of buffer %u (%zu bytes); it ends there", view->length,
                view->offset, view->buffer, size);
        view->length = size - view->offset;
    }
    if (view->stride && (view->stride < 4 || view->stride > 252 || view->stride % 4))
        io_note(r, at, "byteStride", "%zu is not one of 4, 8, .. 252", view->stride);
    if (view->stride && io_get_uint(r, at, "target", UINT32_MAX, 0) == 34963)
        io_note(r, at, "byteStride", "has no meaning for indices");
    gltf_read_meshopt(r, at, view);
}

void gltf_read_views(io_reader *r, const json_place *root)
{
    json_place array = io_get_array(r, root, "bufferViews");
    size_t count = io_get_count(&array);
    r->gltf->views = io_alloc(r, "buffer views", count, sizeof *r->gltf->views);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        gltf_view *view = &r->gltf->views[i];
        read_view(r, &at, view);
        if (io_defer(r, &view->problem))
            view->compressed = NULL;
        r->gltf->view_count = (uint32_t)(i + 1);
    }
}

bool gltf_has_buffer_source(const io_reader *r, uint32_t buffer)
{
    return r->gltf->buffers[buffer].uri || (buffer == 0 && r->gltf->bin);
}

bool gltf_has_view_source(const io_reader *r, uint32_t view)
{
    const gltf_view *v = &r->gltf->views[view];
    return v->problem.message || /* reported when the bytes are requested */
           gltf_has_buffer_source(r, v->compressed ? gltf_get_meshopt_buffer(v->compressed) : v->buffer);
}

bool gltf_has_accessor_source(const io_reader *r, uint32_t accessor)
{
    const gltf_accessor *a = &r->gltf->accessors[accessor];
    if (a->problem.message) /* reported when the elements are requested */
        return true;
    return (a->decoded || a->indices || a->view == SCENE_NONE || gltf_has_view_source(r, a->view)) &&
           (a->sparse_count == 0 ||
            (gltf_has_view_source(r, a->sparse_index_view) && gltf_has_view_source(r, a->sparse_value_view)));
}

/* Loads the bytes of a buffer. */
static bool load_buffer(io_reader *r, const json_place *at, uint32_t index)
{
    gltf_buffer *buffer = &r->gltf->buffers[index];
    if (buffer->data)
        return true;
    if (buffer->problem.message)
        return io_fail_deferred(r, &buffer->problem);
    size_t size = 0;
    if (buffer->uri) {
        uri_bytes bytes;
        if (!gltf_load_uri(r, buffer->uri, &bytes)) { /* searched for once only */
            io_fail(r, at, "uri", bytes.result, "%s", bytes.message);
            return io_defer(r, &buffer->problem) && io_fail_deferred(r, &buffer->problem);
        }
        buffer->data = bytes.data;
        size = bytes.size;
    } else if (index == 0 && r->gltf->bin) {
        buffer->data = r->gltf->bin;
        size = r->gltf->bin_size;
    } else {
        return io_fail(r, at, NULL, FACET_ERROR_INVALID, "has neither a uri nor a binary chunk");
    }
    buffer->available = size < buffer->byte_length ? size : buffer->byte_length;
    if (size > buffer->byte_length && size - buffer->byte_length > (buffer->uri ? 0u : 3u))
        io_note(r, at, "byteLength", "declares %zu bytes, but there are %zu; the rest is ignored",
                buffer->byte_length, size);
    return true;
}

const unsigned char *gltf_get_buffer_bytes(io_reader *r, uint32_t index, size_t end)
{
    const json_place root = {.value = r->json};
    const json_place array = {.parent = &root, .key = "buffers"};
    const json_place at = {.parent = &array, .index = index};
    const gltf_buffer *buffer = &r->gltf->buffers[index];
    if (!io_is_ok(r) || !load_buffer(r, &at, index))
        return NULL;
    if (end > buffer->available) {
        io_fail(r, &at, "byteLength", FACET_ERROR_INVALID, "declares %zu bytes, but there are %zu",
                buffer->byte_length, buffer->available);
        return NULL;
    }
    if (buffer->available < buffer->byte_length)
        io_warn(r, &at, NULL, "has %zu of its %zu bytes; parts that need only those are drawn",
                buffer->available, buffer->byte_length);
    return buffer->data;
}

const unsigned char *gltf_get_view_bytes(io_reader *r, const json_place *at, uint32_t index)
{
    gltf_view *view = &r->gltf->views[index];
    if (view->problem.message)
        io_fail_deferred(r, &view->problem);
    if (!io_is_ok(r))
        return NULL;
    if (view->compressed)
        return gltf_get_meshopt_bytes(r, at, index);
    const unsigned char *bytes = gltf_get_buffer_bytes(r, view->buffer, view->offset + view->length);
    return bytes ? bytes + view->offset : NULL;
}

static bool draws_meshes(const facet_scene *scene)
{
    uint32_t i = 0;
    while (i < scene->node_count && scene->nodes[i].mesh == SCENE_NONE)
        i++;
    return i < scene->node_count;
}

void gltf_check_unused_parts(io_reader *r)
{
    const json_place root = {.value = r->json};
    const json_place array = {.parent = &root, .key = "buffers"};
    for (uint32_t i = 0; i < r->gltf->buffer_count; i++) {
        const json_place at = {.parent = &array, .index = i};
        uri_bytes bytes;
        io_warn_deferred(r, &r->gltf->buffers[i].problem);
        if (!r->gltf->buffers[i].data && r->gltf->buffers[i].uri && !r->gltf->buffers[i].is_fallback &&
            !gltf_load_uri(r, r->gltf->buffers[i].uri, &bytes))
            io_note(r, &at, "uri", "%s; nothing uses it", bytes.message);
    }
    for (uint32_t i = 0; i < r->gltf->view_count; i++)
        io_warn_deferred(r, &r->gltf->views[i].problem);
    for (uint32_t i = 0; i < r->gltf->accessor_count; i++)
        io_warn_deferred(r, &r->gltf->accessors[i].problem);
    for (uint32_t i = 0; i < r->scene->mesh_count; i++) {
        if (r->gltf->meshes[i].problem.message && !draws_meshes(r->scene))
            io_fail_deferred(r, &r->gltf->meshes[i].problem); /* instead of rendering an empty image */
        io_warn_deferred(r, &r->gltf->meshes[i].problem);
        io_warn_deferred(r, &r->gltf->meshes[i].joints);
    }
    for (uint32_t i = 0; i < r->scene->material_count; i++)
        io_warn_deferred(r, &r->gltf->material_problems[i]);
}
