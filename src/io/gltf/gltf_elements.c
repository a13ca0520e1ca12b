/* gltf_elements.c - the elements of an accessor, dense and sparse, made into plain arrays when something asks. */
#include <string.h>

#include "base/parallel.h"
#include "io/gltf/gltf_reader.h"

enum { GRAIN = 1 << 15 }; /* elements that one thread converts at once */

/* ---- components ---- */

/* Little-endian loads from any address. */
static uint16_t load_u16(const unsigned char *p)
{
    return (uint16_t)(p[0] | p[1] << 8);
}

static uint32_t load_u32(const unsigned char *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

/* An unsigned component that is not normalised. */
static uint32_t load_unsigned(const unsigned char *p, gltf_component component)
{
    return component == GLTF_U8 ? p[0] : component == GLTF_U16 ? load_u16(p) : load_u32(p);
}

/* Components one after another (section 3.6.2.2 and, for normalised ones, 3.11). The compiler makes each case a
 * loop. */
static void convert_components(const unsigned char *in, gltf_component component, bool is_normalized,
                               size_t count, float *out)
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

/* ---- elements ---- */

typedef struct conversion {
    const unsigned char *bytes;
    size_t stride;
    gltf_component component;
    bool is_normalized;
    size_t component_count;
    size_t column_length; /* components; only matrices have several columns in an element */
    size_t column_size;   /* bytes */
    float *floats;
    uint32_t *indices;
    uint32_t *largest; /* per GRAIN */
} conversion;

static void convert_element(const conversion *c, const unsigned char *in, float *out)
{
    for (size_t done = 0; done < c->component_count; done += c->column_length, in += c->column_size)
        convert_components(in, c->component, c->is_normalized, c->column_length, out + done);
}

static void convert_floats(void *context, size_t begin, size_t end)
{
    const conversion *c = context;
    size_t size = gltf_component_size(c->component) * c->component_count;
    if (c->stride == size && c->column_length == c->component_count) { /* tight */
        convert_components(c->bytes + begin * size, c->component, c->is_normalized,
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
                        .stride = gltf_accessor_stride(r, a),
                        .component = a->component,
                        .is_normalized = a->is_normalized,
                        .component_count = component_count,
                        .column_length = component_count / gltf_column_count(a->type),
                        .column_size = gltf_column_size(a->component, a->type)};
}

/* Puts the sparse elements over what is there: into floats, or into indices. */
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
        uint32_t place = load_unsigned(places + i * place_size, a->sparse_index_component);
        if (place >= a->count)
            return io_fail(r, at, NULL, FACET_ERROR_INVALID,
                           "sparse index %zu is %u, but the accessor has %u elements", i, place, a->count);
        const unsigned char *value = values + i * c.stride;
        if (floats)
            convert_element(&c, value, floats + place * c.component_count);
        else
            indices[place] = load_unsigned(value, a->component);
    }
    return true;
}

/* ---- whole accessors ---- */

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

/* The first dense element; *bytes is NULL where there are none, which stand for zeros. */
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

/* Whether the bytes are an array of this component (of 4 bytes) already, so that nothing has to be copied. */
static bool is_plain_array(const io_reader *r, const gltf_accessor *a, const unsigned char *bytes,
                           gltf_component component)
{
    return bytes && a->component == component && a->sparse_count == 0 &&
           gltf_accessor_stride(r, a) == gltf_component_counts[a->type] * 4 && (uintptr_t)bytes % 4 == 0 &&
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
    if (!gltf_check_claim(r, &place, a) || !get_dense_bytes(r, &place, a, &bytes))
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
    if (!gltf_check_claim(r, &place, a) || !get_dense_bytes(r, &place, a, &bytes))
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
