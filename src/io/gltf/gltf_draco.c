/* gltf_draco.c - KHR_draco_mesh_compression: primitives whose attributes and faces are in a bitstream. All
 * bitstreams of the file are decoded in parallel when the first such primitive is read. */
#include <string.h>

#include "base/parallel.h"
#include "io/gltf/draco_shim.h"
#include "io/gltf/gltf_reader.h"

/* A buffer view with a bitstream, which primitives may share. */
typedef struct bitstream {
    const unsigned char *bytes; /* NULL: not available */
    io_problem missing;         /* the reason */
    size_t size;
    draco_limits limits;
    uint32_t user_count; /* primitives that are still to be read */
    draco_mesh *mesh;    /* NULL: not decoded, or result and message give the reason */
    facet_result result;
    char message[DRACO_MESSAGE];
    const uint32_t *corners; /* indices of its faces; NULL: not requested yet */
} bitstream;

struct gltf_draco_state {
    bitstream *streams; /* of the arena */
    uint32_t stream_count;
    uint32_t *stream_of_view; /* SCENE_NONE: the view is not a bitstream */
    const facet_allocator *allocator;
};

static const char NAME[] = "KHR_draco_mesh_compression";

/* Limits on the number of values that a bitstream may decode to, per byte and in total. A flat grid of 2
 * million triangles in 50 kB, with 20 constant components per vertex, needs 600 per byte. */
enum { VALUES_PER_BYTE = 4096, VALUES_OF_NOTHING = 1 << 20 };

/* ---- all bitstreams at once ---- */

/* Calls visit for each primitive of the file that has the extension, until it returns false. Errors in other
 * primitives are reported when they are read. */
static bool for_each_primitive(io_reader *r, bool (*visit)(io_reader *, const json_place *primitive,
                                                           const json_place *extension))
{
    const json_place meshes = {.key = "meshes", .value = json_object_get(r->json, "meshes")};
    for (size_t i = 0; i < io_get_count(&meshes); i++) {
        const json_place mesh = io_get_element(&meshes, i);
        const json_place primitives = {
            .parent = &mesh, .key = "primitives", .value = json_object_get(mesh.value, "primitives")};
        for (size_t k = 0; k < io_get_count(&primitives); k++) {
            const json_place primitive = io_get_element(&primitives, k);
            json_place extension = io_get_extension(r, &primitive, NAME);
            if (extension.value && !visit(r, &primitive, &extension))
                return false;
        }
    }
    return io_is_ok(r);
}

/* The bitstream of a primitive; NULL: an error is recorded. */
static bitstream *find_stream(io_reader *r, const json_place *extension)
{
    uint32_t view = io_get_required_index(r, extension, "bufferView", r->gltf->view_count, "buffer view");
    return io_is_ok(r) ? &r->gltf->draco->streams[r->gltf->draco->stream_of_view[view]] : NULL;
}

static bool list_stream(io_reader *r, const json_place *primitive, const json_place *extension)
{
    (void)primitive;
    gltf_draco_state *d = r->gltf->draco;
    uint32_t view = io_peek_index(extension, "bufferView", r->gltf->view_count);
    if (view != SCENE_NONE && d->stream_of_view[view] == SCENE_NONE)
        d->stream_of_view[view] = d->stream_count++;
    return io_is_ok(r);
}

/* Counts a primitive among the users of its bitstream, and adds the counts of its accessors to the limits. */
static bool note_user(io_reader *r, const json_place *primitive, const json_place *extension)
{
    uint32_t view = io_peek_index(extension, "bufferView", r->gltf->view_count);
    const json_place attributes = {.value = json_object_get(primitive->value, "attributes")};
    const char *name;
    json_t *value;
    uint32_t points = 0;
    if (view == SCENE_NONE)
        return true;
    bitstream *s = &r->gltf->draco->streams[r->gltf->draco->stream_of_view[view]];
    json_object_foreach((json_t *)(uintptr_t)attributes.value, name, value)
    {
        uint32_t accessor = io_peek_index(&attributes, name, r->gltf->accessor_count);
        if (accessor != SCENE_NONE && r->gltf->accessors[accessor].count > points)
            points = r->gltf->accessors[accessor].count;
    }
    uint32_t indices = io_peek_index(primitive, "indices", r->gltf->accessor_count);
    uint32_t mode = io_has_member(primitive, "mode") ? io_peek_index(primitive, "mode", 7) : 4;
    /* each index of a strip may complete a triangle; without indices there may be any number of faces */
    uint32_t faces = indices == SCENE_NONE ? points : r->gltf->accessors[indices].count;
    faces = mode == 5 || indices == SCENE_NONE ? faces : faces / 3;
    s->limits.point_count = points > s->limits.point_count ? points : s->limits.point_count;
    s->limits.face_count = faces > s->limits.face_count ? faces : s->limits.face_count;
    s->user_count++;
    return io_is_ok(r);
}

/* Finds the bytes of all bitstreams; a missing buffer is an error of the primitives that use it. */
static bool find_bytes(io_reader *r)
{
    const json_place root = {.value = r->json};
    const json_place array = {.parent = &root, .key = "bufferViews"};
    gltf_draco_state *d = r->gltf->draco;
    for (uint32_t view = 0; view < r->gltf->view_count; view++) {
        const json_place at = {.parent = &array, .index = view};
        if (d->stream_of_view[view] == SCENE_NONE)
            continue;
        bitstream *s = &d->streams[d->stream_of_view[view]];
        s->size = r->gltf->views[view].length;
        s->limits.value_count = VALUES_OF_NOTHING + VALUES_PER_BYTE * (uint64_t)s->size;
        if (!gltf_has_view_source(r, view))
            continue;
        if (!io_spend(r, &at, (uint64_t)s->limits.point_count + s->limits.face_count))
            return false;
        s->bytes = gltf_get_view_bytes(r, &at, view);
        if (!io_defer(r, &s->missing) && !s->bytes)
            return false;
    }
    return true;
}

static void decode_streams(void *context, size_t begin, size_t end)
{
    const gltf_draco_state *d = context;
    for (size_t i = begin; i < end; i++) {
        bitstream *s = &d->streams[i];
        if (s->bytes)
            s->result = draco_shim_decode(s->bytes, s->size, &s->limits, d->allocator, &s->mesh, s->message);
    }
}

/* Creates r->gltf->draco and decodes all bitstreams. */
static bool decode_all(io_reader *r)
{
    gltf_draco_state *d = io_alloc(r, NAME, 1, sizeof *d);
    if (!d)
        return false;
    d->allocator = r->allocator;
    d->stream_of_view = io_alloc_raw(r, NAME, r->gltf->view_count, sizeof *d->stream_of_view);
    if (!d->stream_of_view)
        return false;
    for (uint32_t i = 0; i < r->gltf->view_count; i++)
        d->stream_of_view[i] = SCENE_NONE;
    r->gltf->draco = d;
    if (!for_each_primitive(r, list_stream))
        return false;
    d->streams = io_alloc(r, NAME, d->stream_count, sizeof *d->streams);
    if (!d->streams || !for_each_primitive(r, note_user) || !find_bytes(r))
        return false;
    parallel_for(r->thread_count, d->stream_count, 1, decode_streams, d);
    return true;
}

void gltf_release_draco(io_reader *r)
{
    for (uint32_t i = 0; r->gltf->draco && r->gltf->draco->streams && i < r->gltf->draco->stream_count; i++)
        draco_shim_destroy(r->gltf->draco->streams[i].mesh);
    r->gltf->draco = NULL;
}

/* ---- one primitive ---- */

static draco_type type_of(gltf_component component)
{
    switch (component) {
    case GLTF_I8:
        return DRACO_I8;
    case GLTF_U8:
        return DRACO_U8;
    case GLTF_I16:
        return DRACO_I16;
    case GLTF_U16:
        return DRACO_U16;
    case GLTF_U32:
        return DRACO_U32;
    default:
        return DRACO_F32;
    }
}

/* Discards arrays that were converted from other elements of the accessor. */
static void replace_elements(gltf_accessor *a, const unsigned char *elements, uint32_t view, uint32_t id)
{
    *a = (gltf_accessor){.view = a->view,
                         .offset = a->offset,
                         .component = a->component,
                         .type = a->type,
                         .is_normalized = a->is_normalized,
                         .count = a->count,
                         .decoded = elements,
                         .draco_view = view,
                         .draco_attribute = id};
}

/* Replaces the elements of an attribute's accessor by the attribute `id` of the bitstream. at: the
 * attribute in the extension. */
static bool bind_attribute(io_reader *r, const json_place *at, const bitstream *s, uint32_t view, uint32_t id,
                           uint32_t accessor)
{
    gltf_accessor *a = &r->gltf->accessors[accessor];
    uint32_t points = draco_shim_point_count(s->mesh);
    uint32_t components = draco_shim_component_count(s->mesh, id);
    if (a->decoded && a->draco_view == view && a->draco_attribute == id)
        return true;
    if (components == 0)
        return io_fail(r, at, NULL, FACET_ERROR_INVALID,
                       "%u is not an attribute of the bitstream in buffer view %u", id, view);
    if (a->count != points)
        return io_fail(r, at, NULL, FACET_ERROR_INVALID,
                       "accessor %u has %u elements, but the bitstream in buffer view %u has %u vertices",
                       accessor, a->count, view, points);
    if (a->type > GLTF_VEC4 || gltf_component_counts[a->type] != components)
        return io_fail(r, at, NULL, FACET_ERROR_INVALID,
                       "accessor %u has elements of %u components, but those in buffer view %u have %u",
                       accessor, gltf_component_counts[a->type], view, components);
    if (!io_spend(r, at, (uint64_t)points * components / 3))
        return false;
    void *elements = io_alloc_raw(r, "accessor", points, gltf_element_size(a->component, a->type));
    if (!elements)
        return false;
    if (!draco_shim_copy_attribute(s->mesh, id, type_of(a->component), elements))
        return io_fail(r, at, NULL, FACET_ERROR_INVALID,
                       "the values in buffer view %u do not have the componentType of accessor %u", view,
                       accessor);
    replace_elements(a, elements, view, id);
    return true;
}

/* Makes the faces the indices of the primitive, after a check against the count of its index accessor. */
static bool bind_faces(io_reader *r, const json_place *primitive, bitstream *s, uint32_t view, uint64_t mode)
{
    uint32_t faces = draco_shim_face_count(s->mesh);
    uint32_t accessor = gltf_get_accessor(r, primitive, "indices");
    if (accessor == SCENE_NONE)
        io_note(r, primitive, NULL, "has no indices, but the bitstream in buffer view %u has", view);
    else if (mode == 4 && r->gltf->accessors[accessor].count != (uint64_t)faces * 3)
        return io_fail(r, primitive, "indices", FACET_ERROR_INVALID,
                       "accessor %u has %u elements, but the bitstream in buffer view %u has %u triangles",
                       accessor, r->gltf->accessors[accessor].count, view, faces);
    if (!s->corners) {
        uint32_t *corners = io_alloc_raw(r, "indices", (size_t)faces * 3, sizeof *corners);
        if (!corners || !io_spend(r, primitive, (uint64_t)faces * 3))
            return false;
        draco_shim_copy_faces(s->mesh, corners);
        s->corners = corners;
    }
    if (accessor != SCENE_NONE && mode == 4) {
        r->gltf->accessors[accessor].indices = s->corners;
        r->gltf->accessors[accessor].largest_index = draco_shim_point_count(s->mesh) - 1;
    }
    r->gltf->faces = s->corners;
    r->gltf->face_count = faces;
    return true;
}

static bool bind(io_reader *r, const json_place *primitive, const json_place *extension, bitstream *s,
                 uint64_t mode)
{
    json_place ids = io_get_object(r, extension, "attributes");
    json_place attributes = io_get_object(r, primitive, "attributes");
    uint32_t view = io_get_index(r, extension, "bufferView", r->gltf->view_count, "buffer view");
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)ids.value, name, value)
    {
        json_place at = {.parent = &ids, .key = name, .value = value};
        uint32_t id = (uint32_t)io_get_uint(r, &ids, name, UINT32_MAX, 0);
        uint32_t accessor = gltf_get_accessor(r, &attributes, name);
        if (accessor == SCENE_NONE)
            io_note(r, &at, NULL, "is not among the attributes of the primitive");
        else if (!io_is_ok(r) || !bind_attribute(r, &at, s, view, id, accessor))
            return false;
    }
    uint32_t position = gltf_get_accessor(r, &attributes, "POSITION");
    if (position != SCENE_NONE && r->gltf->accessors[position].count != draco_shim_point_count(s->mesh))
        return io_fail(r, &attributes, "POSITION", FACET_ERROR_INVALID,
                       "accessor %u has %u elements, but the bitstream in buffer view %u has %u vertices",
                       position, r->gltf->accessors[position].count, view, draco_shim_point_count(s->mesh));
    return io_is_ok(r) && bind_faces(r, primitive, s, view, mode);
}

bool gltf_prepare_draco(io_reader *r, const json_place *primitive)
{
    r->gltf->faces = NULL;
    json_place extension = io_get_extension(r, primitive, NAME);
    if (!extension.value || !io_is_ok(r))
        return io_is_ok(r);
    uint64_t mode = io_get_uint(r, primitive, "mode", 6, 4);
    if (mode != 4 && mode != 5)
        return io_fail(r, primitive, "mode", FACET_ERROR_INVALID,
                       "must be 4 or 5, triangles or strips of them, with %s", NAME);
    if (!r->gltf->draco && !decode_all(r))
        return false;
    bitstream *s = find_stream(r, &extension);
    if (!s)
        return false;
    if (s->missing.message)
        return io_fail_deferred(r, &s->missing);
    if (!s->bytes)
        return io_fail(r, &extension, "bufferView", FACET_ERROR_INVALID, "is in a buffer without bytes");
    if (!s->mesh)
        return s->result == FACET_ERROR_MEMORY
                   ? io_fail(r, &extension, NULL, s->result, "out of memory: its bitstream %s", s->message)
                   : io_fail(r, &extension, NULL, s->result, "has a bitstream that %s", s->message);
    if (!bind(r, primitive, &extension, s, mode))
        return false;
    if (--s->user_count == 0) {
        draco_shim_destroy(s->mesh);
        s->mesh = NULL;
    }
    return true;
}
