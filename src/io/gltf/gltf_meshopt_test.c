/* gltf_meshopt_test.c - buffer views compressed with meshopt: their JSON, and the source of their bytes. */
#include "io/gltf/gltf_test_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const float POSITIONS[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0.5f};

/* Appends a stream of mode ATTRIBUTES, version 0, with each group of 16 bytes stored uncompressed; returns
 * its offset. */
static size_t add_attributes(test_bin *bin, const void *elements, size_t count, size_t stride, size_t *size)
{
    uint8_t stream[2048] = {0xa0};
    const uint8_t *bytes = elements;
    size_t at = 1;
    for (size_t k = 0; k < stride; k++) {
        uint8_t last = 0;
        stream[at++] = 3; /* one group */
        for (size_t i = 0; i < 16; i++) {
            uint8_t value = i < count ? bytes[i * stride + k] : last;
            uint8_t delta = (uint8_t)(value - last);
            stream[at++] = (uint8_t)(delta << 1 ^ (delta & 0x80 ? 0xff : 0));
            last = value;
        }
    }
    *size = at + 32;
    return bin_add(bin, stream, *size);
}

/* Two streams: positions of a triangle, and its indices. The second begins at OFFSET. */
typedef struct parts {
    test_bin bin;
    size_t attributes_size, triangles_at;
} parts;

static parts make_parts(void)
{
    static const uint8_t triangle[18] = {0xe1, 0xf0};
    parts p = {0};
    add_attributes(&p.bin, POSITIONS, 3, 12, &p.attributes_size);
    p.triangles_at = bin_add(&p.bin, triangle, sizeof triangle);
    return p;
}

/* The model of the parts, with one text replaced by another (NULL: none). */
static const char *make_body(const parts *p, const char *text, const char *other)
{
    static char body[4096];
    char plain[2048];
    snprintf(plain, sizeof plain,
             "'extensionsUsed':['KHR_meshopt_compression'],'buffers':[{'byteLength':%zu},{'byteLength':44,"
             "'extensions':{'KHR_meshopt_compression':{'fallback':true}}},{'byteLength':1000}],"
             "'bufferViews':[{'buffer':1,'byteLength':36,'extensions':{'KHR_meshopt_compression':"
             "{'buffer':0,'byteLength':%zu,'byteStride':12,'count':3,'mode':'ATTRIBUTES'}}},"
             "{'buffer':1,'byteOffset':36,'byteLength':6,'extensions':{'KHR_meshopt_compression':"
             "{'buffer':0,'byteOffset':%zu,'byteLength':18,'byteStride':2,'count':3,'mode':'TRIANGLES'}}}],"
             "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
             "{'bufferView':1,'componentType':5123,'count':3,'type':'SCALAR'}],"
             "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1}]}]",
             p->bin.size, p->attributes_size, p->triangles_at);
    const char *found = text ? strstr(plain, text) : NULL;
    if (text)
        assert_non_null(found);
    snprintf(body, sizeof body, "%.*s%s%s", found ? (int)(found - plain) : (int)strlen(plain), plain,
             found ? other : "", found ? found + strlen(text) : "");
    return body;
}

static void assert_drawn(const facet_scene *scene)
{
    static const uint32_t indices[3] = {0, 1, 2};
    const scene_primitive *p = first_primitive(scene);
    assert_int_equal(p->index_count, 3);
    assert_memory_equal(p->indices, indices, sizeof indices);
    assert_memory_equal(p->positions, POSITIONS, sizeof POSITIONS);
}

static void views_are_decoded(void **state)
{
    (void)state;
    const parts p = make_parts();
    facet_scene *scene = load(make_body(&p, NULL, NULL), &p.bin);
    assert_drawn(scene);
    scene_destroy(scene);
    /* a placeholder need not be marked */
    scene = load(make_body(&p, ",'extensions':{'KHR_meshopt_compression':{'fallback':true}}", ""), &p.bin);
    assert_drawn(scene);
    scene_destroy(scene);
}

static void contradictory_sizes_and_modes_are_refused(void **state)
{
    (void)state;
    const parts p = make_parts();
    static const struct {
        const char *text, *other, *message;
    } cases[] = {
        {"'count':3,'mode':'ATT", "'count':4,'mode':'ATT", "4 elements of 12 bytes are not the 36 bytes"},
        {"'count':3,'mode':'ATT", "'mode':'ATT", "KHR_meshopt_compression.count: is missing"},
        {"'byteStride':12", "'byteStride':10", "byteStride must be one of 4, 8, .. 256"},
        {"'byteStride':12", "'byteStride':0", "byteStride must be one of 4, 8, .. 256"},
        {"'mode':'ATTRIBUTES'", "'mode':'LINES'", "mode: \"LINES\" is not known"},
        {"'mode':'ATTRIBUTES'", "'filter':'NONE'", "mode: is missing"},
        {"'mode':'ATTRIBUTES'", "'mode':'TRIANGLES'", "byteStride must be 2 or 4"},
        {"'mode':'ATTRIBUTES'", "'mode':'ATTRIBUTES','filter':'SOBEL'", "filter: \"SOBEL\" is not known"},
        {"'mode':'ATTRIBUTES'", "'mode':'ATTRIBUTES','filter':'QUATERNION'", "byteStride must be 8"},
        {"'mode':'TRIANGLES'", "'mode':'TRIANGLES','filter':'COLOR'", "this mode allows no filter"},
        {"{'buffer':0,'byteLength':", "{'buffer':1,'byteLength':", "buffer: 1 is there for readers without"},
        {"{'buffer':0,'byteLength':", "{'buffer':3,'byteLength':", "buffer: buffer 3"},
        {"'byteLength':18", "'byteLength':180", "180 from offset"},
        {"'byteLength':18", "'byteLength':17", "bufferViews[1]: has a compressed stream that ends too early"},
        {"'byteLength':18,", "'byteLength':16,",
         "bufferViews[1]: has a compressed stream that ends too early"},
        {"{'buffer':0,'byteLength':", "{'buffer':0,'byteOffset':1,'byteLength':",
         "bufferViews[0]: has a compressed stream that does not begin"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_refused(make_body(&p, cases[i].text, cases[i].other), &p.bin, FACET_ERROR_INVALID,
                       cases[i].message);
}

/* A count that is impossible for the stream's size is detected before memory is allocated. */
static void large_counts_take_no_memory(void **state)
{
    (void)state;
    const parts p = make_parts();
    char body[4096];
    snprintf(body, sizeof body,
             "'buffers':[{'byteLength':%zu},{'byteLength':1000000000000,'extensions':"
             "{'EXT_meshopt_compression':{'fallback':true}}}],'bufferViews':[{'buffer':1,"
             "'byteLength':1000000000000,'extensions':{'EXT_meshopt_compression':{'buffer':0,"
             "'byteLength':%zu,'byteStride':256,'count':3906250000,'mode':'ATTRIBUTES'}}}],"
             "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}],"
             "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}]",
             p.bin.size, p.attributes_size);
    assert_refused(body, &p.bin, FACET_ERROR_INVALID, "ends too early");
}

static void unused_streams_may_be_broken(void **state)
{
    (void)state;
    const parts p = make_parts();
    facet_scene *scene =
        load(make_body(&p, "],'accessors'",
                       ",{'buffer':1,'byteLength':36,'extensions':{'KHR_meshopt_compression':{'buffer':0,"
                       "'byteOffset':3,'byteLength':60,'byteStride':12,'count':3,'mode':'ATTRIBUTES'}}}],"
                       "'accessors'"),
             &p.bin);
    assert_drawn(scene);
    scene_destroy(scene);
}

static void buffers_without_bytes_are_not_drawn(void **state)
{
    (void)state;
    const parts p = make_parts();
    facet_scene *scene =
        load(make_body(&p, "{'buffer':0,'byteLength':", "{'buffer':2,'byteLength':"), &p.bin);
    assert_int_equal(first_primitive(scene)->index_count, 0);
    assert_true(has_warning(scene, "is in a buffer without bytes and is not drawn"));
    scene_destroy(scene);
}

/* Fallbacks are for other readers: they are neither read nor searched for. */
static void fallback_buffers_are_not_read(void **state)
{
    (void)state;
    const parts p = make_parts();
    facet_scene *scene =
        load(make_body(&p, "{'byteLength':44,", "{'byteLength':44,'uri':'not_there.bin',"), &p.bin);
    assert_drawn(scene);
    assert_false(has_warning(scene, "not_there"));
    scene_destroy(scene);
}

static void oddities_are_warned_of(void **state)
{
    (void)state;
    const parts p = make_parts();
    char twice[512];
    snprintf(twice, sizeof twice,
             "{'EXT_meshopt_compression':{'buffer':0,'byteLength':%zu,'byteStride':12,'count':3,"
             "'mode':'ATTRIBUTES'},'KHR_meshopt_compression':{'buffer':0,'byteLength':%zu",
             p.attributes_size, p.attributes_size);
    char one[128];
    snprintf(one, sizeof one, "{'KHR_meshopt_compression':{'buffer':0,'byteLength':%zu", p.attributes_size);
    facet_scene *scene = load(make_body(&p, one, twice), &p.bin);
    assert_drawn(scene);
    assert_true(has_note(scene, "stands beside KHR_meshopt_compression"));
    scene_destroy(scene);
}

/* Sparse accessors find both their parts in compressed views. */
static void sparse_parts_are_decoded(void **state)
{
    (void)state;
    parts p = make_parts();
    static const uint8_t places[] = {0xd1, 4 << 1, 0, 0, 0, 0}; /* +2 of the first position: 2 */
    static const float value[3] = {7, 8, 9};
    size_t places_at = bin_add(&p.bin, places, sizeof places);
    size_t value_size;
    size_t value_at = add_attributes(&p.bin, value, 1, 12, &value_size);
    char body[4096];
    char views[512];
    snprintf(
        views, sizeof views,
        ",{'buffer':1,'byteLength':4,'extensions':{'KHR_meshopt_compression':{'buffer':0,"
        "'byteOffset':%zu,'byteLength':6,'byteStride':4,'count':1,'mode':'INDICES'}}},"
        "{'buffer':1,'byteLength':12,'extensions':{'KHR_meshopt_compression':{'buffer':0,"
        "'byteOffset':%zu,'byteLength':%zu,'byteStride':12,'count':1,'mode':'ATTRIBUTES'}}}],'accessors'",
        places_at, value_at, value_size);
    snprintf(body, sizeof body, "%s", make_body(&p, "],'accessors'", views));
    char *accessor = strstr(body, "'count':3,'type':'VEC3'}");
    assert_non_null(accessor);
    char changed[4096];
    snprintf(
        changed, sizeof changed,
        "%.*s'count':3,'type':'VEC3','sparse':{'count':1,'indices':{'bufferView':2,'componentType':5125},"
        "'values':{'bufferView':3}}}%s",
        (int)(accessor - body), body, accessor + strlen("'count':3,'type':'VEC3'}"));
    facet_scene *scene = load(changed, &p.bin);
    assert_floats(first_primitive(scene)->positions, POSITIONS, 6, 0);
    assert_floats(first_primitive(scene)->positions + 6, value, 3, 0);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(views_are_decoded),
        cmocka_unit_test(contradictory_sizes_and_modes_are_refused),
        cmocka_unit_test(large_counts_take_no_memory),
        cmocka_unit_test(unused_streams_may_be_broken),
        cmocka_unit_test(buffers_without_bytes_are_not_drawn),
        cmocka_unit_test(fallback_buffers_are_not_read),
        cmocka_unit_test(oddities_are_warned_of),
        cmocka_unit_test(sparse_parts_are_decoded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
