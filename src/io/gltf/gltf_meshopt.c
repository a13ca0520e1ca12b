/* gltf_meshopt.c - EXT_meshopt_compression and KHR_meshopt_compression: buffer views whose bytes are
 * decoded from others. They are checked when the table of views is read, and decoded in parallel, all at
 * once, when the bytes of the first one are requested. */
#include <string.h>

#include "base/parallel.h"
#include "io/gltf/gltf_reader.h"
#include "io/gltf/meshopt.h"

struct gltf_compressed_view {
    uint32_t buffer;
    size_t offset;
    meshopt_stream stream; /* bytes: NULL: not available */
    uint8_t *decoded;      /* NULL: not requested yet, or see problem */
    const char *problem;
    io_problem missing; /* why its stream is not available */
};

static const char *const NAMES[] = {"KHR_meshopt_compression", "EXT_meshopt_compression"};
enum { KHR, EXT, NAME_COUNT };

bool gltf_is_meshopt_fallback(io_reader *r, const json_place *buffer)
{
    bool is_fallback = false;
    for (int i = 0; i < NAME_COUNT; i++) {
        json_place at = io_get_extension(r, buffer, NAMES[i]);
        is_fallback |= io_get_bool(r, &at, "fallback", false);
    }
    return is_fallback;
}

/* ---- the table ---- */

/* The index of key's value among count words; 0 with the error recorded if it is not one of them. */
static int get_word(io_reader *r, const json_place *at, const char *key, const char *const *words, int count,
                    const char *fallback)
{
    const char *word = io_get_string(r, at, key, fallback);
    for (int i = 0; word && i < count; i++)
        if (strcmp(word, words[i]) == 0)
            return i;
    if (word)
        io_fail(r, at, key, FACET_ERROR_INVALID, "\"%.40s\" is not known", word);
    else if (io_is_ok(r))
        io_fail(r, at, key, FACET_ERROR_INVALID, "is missing");
    return 0;
}

static void read_stream(io_reader *r, const json_place *at, gltf_compressed_view *v)
{
    static const char *const modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
    static const char *const filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"};
    const uint64_t most = (uint64_t)1 << 53;
    v->buffer = io_get_required_index(r, at, "buffer", r->gltf->buffer_count, "buffer");
    v->offset = io_get_uint(r, at, "byteOffset", most, 0);
    v->stream.size = io_get_uint(r, at, "byteLength", most, IO_REQUIRED_UINT);
    v->stream.stride = io_get_uint(r, at, "byteStride", UINT32_MAX, IO_REQUIRED_UINT);
    v->stream.count = io_get_uint(r, at, "count", UINT32_MAX, IO_REQUIRED_UINT);
    v->stream.mode = (meshopt_mode)get_word(r, at, "mode", modes, 3, NULL);
    v->stream.filter = (meshopt_filter)get_word(r, at, "filter", filters, 5, "NONE");
}

/* Whether the numbers are consistent with each other, with the buffer of the stream, and with the view of
 * size bytes. */
static bool check_stream(io_reader *r, const json_place *at, const gltf_compressed_view *v, size_t size)
{
    const gltf_buffer *buffer = &r->gltf->buffers[v->buffer];
    const meshopt_stream *s = &v->stream;
    const char *problem = meshopt_check(s);
    if (problem)
        return io_fail(r, at, NULL, FACET_ERROR_INVALID, "%s", problem);
    if (buffer->is_fallback)
        return io_fail(r, at, "buffer", FACET_ERROR_INVALID,
                       "%u is there for readers without this extension and cannot hold its stream",
                       v->buffer);
    if (v->offset > buffer->byte_length || s->size > buffer->byte_length - v->offset)
        return io_fail(r, at, "byteLength", FACET_ERROR_INVALID,
                       "%zu from offset %zu goes past the end of buffer %u (%zu bytes)", s->size, v->offset,
                       v->buffer, buffer->byte_length);
    if (s->count * s->stride != size) /* below 2^40 */
        return io_fail(r, at, "count", FACET_ERROR_INVALID,
                       "%zu elements of %zu bytes are not the %zu bytes of the buffer view", s->count,
                       s->stride, size);
    return true;
}

void gltf_read_meshopt(io_reader *r, const json_place *view_place, gltf_view *view)
{
    for (int i = 0; i < NAME_COUNT && io_is_ok(r); i++) {
        json_place at = io_get_extension(r, view_place, NAMES[i]);
        if (!at.value)
            continue;
        if (view->compressed) {
            io_note(r, &at, NULL, "stands beside %s, which is read instead", NAMES[KHR]);
            return;
        }
        gltf_compressed_view *v = io_alloc(r, "buffer view", 1, sizeof *v);
        if (!v)
            return;
        read_stream(r, &at, v);
        if (!io_is_ok(r) || !check_stream(r, &at, v, view->length))
            return;
        if (i == EXT && v->stream.filter == MESHOPT_COLOR)
            io_note(r, &at, "filter", "COLOR belongs to %s", NAMES[KHR]);
        view->compressed = v;
    }
}

uint32_t gltf_get_meshopt_buffer(const gltf_compressed_view *view)
{
    return view->buffer;
}

/* ---- bytes ---- */

/* Finds the bytes of a stream and allocates memory for the decoded ones. Errors of a view are reported
 * when it is requested. */
static bool prepare(io_reader *r, const json_place *at, gltf_compressed_view *v)
{
    meshopt_stream *s = &v->stream;
    if (!gltf_has_buffer_source(r, v->buffer))
        return true;
    const unsigned char *bytes = gltf_get_buffer_bytes(r, v->buffer, v->offset + s->size);
    if (io_defer(r, &v->missing) || !bytes)
        return io_is_ok(r);
    s->bytes = bytes + v->offset;
    if (s->size < meshopt_smallest_size(s)) {
        v->problem = MESHOPT_TOO_SHORT;
        return true;
    }
    if (!io_spend(r, at, s->count * s->stride / 12)) /* at most that many floats of 3 components */
        return false;
    v->decoded = io_alloc_raw(r, "buffer view", s->count, s->stride);
    return v->decoded != NULL;
}

static void decode_views(void *context, size_t begin, size_t end)
{
    gltf_view *views = context;
    for (size_t i = begin; i < end; i++) {
        gltf_compressed_view *v = views[i].compressed;
        if (v && v->decoded)
            v->problem = meshopt_decode(&v->stream, v->decoded);
    }
}

const unsigned char *gltf_get_meshopt_bytes(io_reader *r, const json_place *at, uint32_t index)
{
    const json_place root = {.value = r->json};
    const json_place array = {.parent = &root, .key = "bufferViews"};
    const json_place view = {.parent = &array, .index = index};
    gltf_compressed_view *v = r->gltf->views[index].compressed;
    if (!r->gltf->has_decoded_views) {
        for (uint32_t i = 0; i < r->gltf->view_count; i++) {
            const json_place place = {.parent = &array, .index = i};
            if (r->gltf->views[i].compressed && !prepare(r, &place, r->gltf->views[i].compressed))
                return NULL;
        }
        parallel_for(r->thread_count, r->gltf->view_count, 1, decode_views, r->gltf->views);
        r->gltf->has_decoded_views = true;
    }
    if (v->problem)
        io_fail(r, &view, NULL, FACET_ERROR_INVALID, "has a compressed stream that %s", v->problem);
    else if (v->missing.message)
        io_fail_deferred(r, &v->missing);
    else if (!v->decoded)
        io_fail(r, at, NULL, FACET_ERROR_INVALID, "bufferViews[%u] has its stream in a buffer without bytes",
                index);
    return io_is_ok(r) ? v->decoded : NULL;
}
