/* gltf_draco_test.c - primitives with geometry in a Draco bitstream: their JSON, and malformed bitstreams. */
#include "io/gltf/gltf_test_support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The unit square in z = 0 as two triangles with a color at each corner, by the npm package draco3dgltf
 * 1.5.7 without quantisation: attribute 0 positions (floats), 1 colors (4 bytes). The method is the only
 * difference; the order of vertices in the second is another. */
static const uint8_t SEQUENTIAL[] = {
    0x44, 0x52, 0x41, 0x43, 0x4f, 0x02, 0x02, 0x01, 0x00, 0x00, 0x00, 0x02, 0x04, 0x01, 0x00, 0x01,
    0x02, 0x02, 0x01, 0x03, 0x01, 0x02, 0x00, 0x09, 0x03, 0x00, 0x00, 0x02, 0x02, 0x04, 0x00, 0x01,
    0x00, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x80, 0x3f, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x80, 0x3f, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x80, 0x3f, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x01, 0x01, 0x00, 0x03, 0x03, 0x01, 0x20, 0x01, 0x20, 0x03, 0x00, 0xf0, 0x83,
    0x69, 0x80, 0x31, 0x00, 0x00, 0x00, 0x00, 0xff, 0x00, 0x00, 0x00};
static const uint8_t EDGEBREAKER[] = {
    0x44, 0x52, 0x41, 0x43, 0x4f, 0x02, 0x02, 0x01, 0x01, 0x00, 0x00, 0x00, 0x04, 0x02, 0x00, 0x02, 0x00,
    0x00, 0x01, 0x1f, 0xff, 0x01, 0x11, 0x01, 0xff, 0x00, 0x00, 0x02, 0x00, 0x09, 0x03, 0x00, 0x00, 0x02,
    0x02, 0x04, 0x00, 0x01, 0x00, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3f,
    0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x01, 0x01, 0x00, 0x03, 0x03, 0x01, 0x20, 0x01, 0x20, 0x03, 0x00, 0x10, 0x84,
    0x4c, 0x52, 0x28, 0x00, 0x00, 0x00, 0x00, 0xff, 0x00, 0x00, 0x00};
enum { FACE_COUNT_AT = 11 /* in SEQUENTIAL */ };

/* A model of one primitive of a bitstream, with one text replaced by another (NULL: none). */
static const char *make_body(size_t size, const char *text, const char *other)
{
    static char body[4096];
    char plain[2048];
    snprintf(plain, sizeof plain,
             "'extensionsUsed':['KHR_draco_mesh_compression'],'bufferViews':[{'buffer':0,'byteLength':%zu}],"
             "'accessors':[{'componentType':5126,'count':4,'type':'VEC3'},"
             "{'componentType':5121,'normalized':true,'count':4,'type':'VEC4'},"
             "{'componentType':5123,'count':6,'type':'SCALAR'}],"
             "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'COLOR_0':1},'indices':2,'extensions':"
             "{'KHR_draco_mesh_compression':{'bufferView':0,'attributes':{'POSITION':0,'COLOR_0':1}}}}]}]",
             size);
    const char *found = text ? strstr(plain, text) : NULL;
    if (text)
        assert_non_null(found);
    snprintf(body, sizeof body, "%.*s%s%s", found ? (int)(found - plain) : (int)strlen(plain), plain,
             found ? other : "", found ? found + strlen(text) : "");
    return body;
}

static test_bin make_bin(const uint8_t *bytes, size_t size)
{
    test_bin bin = {0};
    bin_add(&bin, bytes, size);
    return bin;
}

/* The square: its area, and at each corner the color that belongs there (red, green, blue, white). */
static void assert_square(const scene_primitive *p)
{
    double area = 0.0;
    assert_int_equal(p->mode, SCENE_TRIANGLES);
    assert_int_equal(p->index_count, 6);
    for (size_t i = 0; i < 6; i += 3) {
        const float *a = p->positions + 3 * (size_t)p->indices[i];
        const float *b = p->positions + 3 * (size_t)p->indices[i + 1];
        const float *c = p->positions + 3 * (size_t)p->indices[i + 2];
        area += 0.5 * (double)((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    }
    assert_near(area, 1, 0);
    for (size_t i = 0; i < p->vertex_count && p->colors; i++) {
        const float *at = p->positions + 3 * i;
        const float expected[4] = {at[0] == at[1], at[0] > 0, at[1] > 0, 1}; /* white has all */
        assert_floats(p->colors + 4 * i, expected, 4, 0);
    }
}

static void both_methods_are_decoded(void **state)
{
    (void)state;
    const test_bin bins[2] = {make_bin(SEQUENTIAL, sizeof SEQUENTIAL),
                              make_bin(EDGEBREAKER, sizeof EDGEBREAKER)};
    for (int i = 0; i < 2; i++) {
        facet_scene *scene = load(make_body(bins[i].size, NULL, NULL), &bins[i]);
        assert_non_null(first_primitive(scene)->colors);
        assert_square(first_primitive(scene));
        scene_destroy(scene);
    }
}

static void contradictory_counts_and_types_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *other, *message;
    } cases[] = {
        {"'count':4,'type':'VEC3'", "'count':5,'type':'VEC3'",
         "accessor 0 has 5 elements, but the bitstream in buffer view 0 has 4 vertices"},
        {"'count':6", "'count':9",
         "accessor 2 has 9 elements, but the bitstream in buffer view 0 has 2 triangles"},
        {"'count':6", "'count':3", "has a bitstream that has 2 triangles where 1 are expected"},
        {"'type':'VEC3'", "'type':'VEC2'",
         "accessor 0 has elements of 2 components, but those in buffer view 0 have 3"},
        {"'type':'VEC4'", "'type':'MAT2'", "accessor 1 has elements of 4 components"},
        {"{'bufferView':0,'attributes':{'POSITION':0", "{'bufferView':0,'attributes':{'POSITION':7",
         "7 is not an attribute of the bitstream"},
        {"'componentType':5126", "'componentType':5121",
         "the values in buffer view 0 do not have the componentType of accessor 0"},
        {"{'bufferView':0,'attributes'", "{'bufferView':1,'attributes'",
         "KHR_draco_mesh_compression.bufferView: buffer view 1"},
        {"{'bufferView':0,'attributes'", "{'attributes'",
         "KHR_draco_mesh_compression.bufferView: is missing"},
        {"'indices':2", "'indices':2,'mode':0", "mode: must be 4 or 5"},
    };
    const test_bin bin = make_bin(SEQUENTIAL, sizeof SEQUENTIAL);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_refused(make_body(bin.size, cases[i].text, cases[i].other), &bin, FACET_ERROR_INVALID,
                       cases[i].message);
    /* both counts are less than the bitstream's, which is not even decoded */
    char body[4096];
    snprintf(body, sizeof body, "%s",
             make_body(bin.size, "'count':4,'type':'VEC3'", "'count':3,'type':'VEC3'"));
    *strstr(body, "'count':4") = ' ';
    char *count = strstr(body, "count':4");
    memcpy(count - 1, "'count':3", 9);
    assert_refused(body, &bin, FACET_ERROR_INVALID,
                   "has a bitstream that has 4 vertices where 3 are expected");
}

/* Attributes stored as bytes may be read as floats, and may be mixed with uncompressed ones. */
static void integers_become_floats(void **state)
{
    (void)state;
    test_bin bin = make_bin(SEQUENTIAL, sizeof SEQUENTIAL);
    facet_scene *scene =
        load(make_body(bin.size, "{'componentType':5121,'normalized':true,", "{'componentType':5126,"), &bin);
    const scene_primitive *p = first_primitive(scene);
    for (size_t i = 0; i < 16; i++) /* colors are clamped to 1, so that 255 and 1 look alike here */
        assert_true(p->colors[i] == 0 || p->colors[i] == 1);
    scene_destroy(scene);
}

static void strips_become_their_triangles(void **state)
{
    (void)state;
    const test_bin bin = make_bin(SEQUENTIAL, sizeof SEQUENTIAL);
    char body[4096];
    snprintf(body, sizeof body, "%s", make_body(bin.size, "'indices':2", "'indices':2,'mode':5"));
    memcpy(strstr(body, "'count':6"), "'count':4", 9);
    facet_scene *scene = load(body, &bin);
    assert_square(first_primitive(scene));
    scene_destroy(scene);
}

static void oddities_are_warned_of(void **state)
{
    (void)state;
    const test_bin bin = make_bin(EDGEBREAKER, sizeof EDGEBREAKER);
    facet_scene *scene = load(make_body(bin.size, "'indices':2,", ""), &bin);
    assert_square(first_primitive(scene));
    assert_true(has_note(scene, "has no indices, but the bitstream in buffer view 0 has"));
    scene_destroy(scene);
    scene = load(make_body(bin.size, "{'POSITION':0,'COLOR_0':1},", "{'POSITION':0},"), &bin);
    assert_square(first_primitive(scene));
    assert_null(first_primitive(scene)->colors);
    assert_true(has_note(scene, "COLOR_0: is not among the attributes of the primitive"));
    scene_destroy(scene);
}

/* An attribute that is not in the bitstream is read as usual, and must have as many elements. */
static void other_attributes_are_read_as_usual(void **state)
{
    (void)state;
    static const float texcoords[10] = {0, 0, 1, 0, 0, 1, 1, 1, 5, 5};
    test_bin bin = make_bin(SEQUENTIAL, sizeof SEQUENTIAL);
    const size_t size = bin.size;
    const size_t at = bin_add(&bin, texcoords, sizeof texcoords);
    char body[4096];
    for (int count = 4; count <= 5; count++) {
        char changed[4096];
        snprintf(body, sizeof body, "%s",
                 make_body(size, "'COLOR_0':1},'indices'", "'TEXCOORD_0':3},'indices'"));
        char *place = strstr(body, "],'accessors'");
        snprintf(changed, sizeof changed, "%.*s,{'buffer':0,'byteOffset':%zu,'byteLength':40}%s",
                 (int)(place - body), body, at, place);
        place = strstr(changed, "],'meshes'");
        snprintf(body, sizeof body, "%.*s,{'bufferView':1,'componentType':5126,'count':%d,'type':'VEC2'}%s",
                 (int)(place - changed), changed, count, place);
        if (count == 5) {
            assert_refused(body, &bin, FACET_ERROR_INVALID, "TEXCOORD_0: accessor 3 has 5 elements");
            continue;
        }
        facet_scene *scene = load(body, &bin);
        assert_square(first_primitive(scene));
        const scene_primitive *p = first_primitive(scene);
        for (size_t i = 0; i < p->vertex_count; i++) /* they are the coordinates in the plane */
            assert_floats(p->texcoords[0] + 2 * i, p->positions + 3 * i, 2, 0);
        scene_destroy(scene);
    }
    /* also where it is the positions that are not in it */
    snprintf(body, sizeof body, "%s",
             make_body(size, "'attributes':{'POSITION':0,'COLOR_0':1}}}", "'attributes':{'COLOR_0':1}}}"));
    memcpy(strstr(body, "'count':4"), "'count':3", 9);
    assert_refused(body, &bin, FACET_ERROR_INVALID,
                   "POSITION: accessor 0 has 3 elements, but the bitstream in buffer view 0 has 4 vertices");
}

/* Accessors hold the bitstream of the current primitive, even if primitives of different bitstreams share
 * them. */
static void accessors_may_be_shared(void **state)
{
    (void)state;
    test_bin bin = make_bin(SEQUENTIAL, sizeof SEQUENTIAL);
    const size_t at = bin_add(&bin, EDGEBREAKER, sizeof EDGEBREAKER);
    char body[4096];
    char more[1024];
    snprintf(more, sizeof more, ",{'buffer':0,'byteOffset':%zu,'byteLength':%zu}],'accessors'", at,
             sizeof EDGEBREAKER);
    snprintf(body, sizeof body, "%s", make_body(sizeof SEQUENTIAL, "],'accessors'", more));
    body[strlen(body) - 3] = 0; /* the end of primitives, mesh and meshes */
    snprintf(
        body + strlen(body), 600,
        ",{'attributes':{'POSITION':0,'COLOR_0':1},'indices':2,'extensions':{'KHR_draco_mesh_compression':"
        "{'bufferView':1,'attributes':{'POSITION':0,'COLOR_0':1}}}},{'attributes':{'POSITION':0,'COLOR_0':1},"
        "'indices':2,'extensions':{'KHR_draco_mesh_compression':{'bufferView':0,'attributes':{'POSITION':0,"
        "'COLOR_0':1}}}}]}]");
    facet_scene *scene = load(body, &bin);
    assert_int_equal(scene->meshes[0].primitive_count, 3);
    const scene_primitive *p = scene->meshes[0].primitives;
    for (int i = 0; i < 3; i++)
        assert_square(&p[i]);
    assert_true(memcmp(p[0].positions, p[1].positions, 12 * sizeof(float)) != 0);
    assert_memory_equal(p[0].positions, p[2].positions, 12 * sizeof(float));
    scene_destroy(scene);
}

/* ---- bitstreams with false claims ---- */

static void try_bitstream(const uint8_t *bytes, size_t size, bool must_fail)
{
    const test_bin bin = make_bin(bytes, size);
    facet_scene *scene = NULL;
    facet_error error = {0};
    facet_result result = try_load(make_body(size, NULL, NULL), &bin, &scene, &error);
    if (must_fail)
        assert_int_not_equal(result, FACET_OK);
    assert_true(result == FACET_OK || strstr(error.message, "KHR_draco_mesh_compression"));
    scene_destroy(scene);
}

static void truncated_bitstreams_are_refused(void **state)
{
    (void)state;
    for (size_t size = 1; size < sizeof SEQUENTIAL - 8; size++) /* the last bytes may be padding */
        try_bitstream(SEQUENTIAL, size, true);
    for (size_t size = 1; size < sizeof EDGEBREAKER - 8; size++)
        try_bitstream(EDGEBREAKER, size, true);
}

static void damaged_bitstreams_do_no_harm(void **state)
{
    (void)state;
    static const uint8_t values[] = {0x00, 0x01, 0x7f, 0x80, 0xff};
    uint8_t copy[sizeof EDGEBREAKER];
    for (size_t i = 0; i < sizeof EDGEBREAKER; i++)
        for (size_t k = 0; k < sizeof values; k++) {
            memcpy(copy, EDGEBREAKER, sizeof EDGEBREAKER);
            copy[i] = values[k];
            try_bitstream(copy, sizeof EDGEBREAKER, i < 5 && copy[i] != EDGEBREAKER[i]);
            if (i >= sizeof SEQUENTIAL)
                continue;
            memcpy(copy, SEQUENTIAL, sizeof SEQUENTIAL);
            copy[i] = values[k];
            try_bitstream(copy, sizeof SEQUENTIAL, i < 5 && copy[i] != SEQUENTIAL[i]);
        }
}

/* 60 million triangles in a hundred bytes, with accessors that say so too. */
static void large_counts_take_no_memory(void **state)
{
    (void)state;
    uint8_t bytes[sizeof SEQUENTIAL + 3];
    memcpy(bytes, SEQUENTIAL, FACE_COUNT_AT);
    static const uint8_t count[4] = {0x80, 0x8e, 0xce, 0x1c}; /* 7 bits each, lowest first: 60000000 */
    memcpy(bytes + FACE_COUNT_AT, count, sizeof count);
    memcpy(bytes + FACE_COUNT_AT + 4, SEQUENTIAL + FACE_COUNT_AT + 1, sizeof SEQUENTIAL - FACE_COUNT_AT - 1);
    const test_bin bin = make_bin(bytes, sizeof bytes);
    assert_refused(make_body(sizeof bytes, "'count':6", "'count':180000000"), &bin, FACET_ERROR_LIMIT,
                   "has a bitstream that declares 180000000 values");
    assert_refused(make_body(sizeof bytes, NULL, NULL), &bin, FACET_ERROR_INVALID,
                   "has a bitstream that has 60000000 triangles where 2 are expected");
    assert_refused(make_body(sizeof bytes, "'count':6", "'count':900000000"), &bin, FACET_ERROR_LIMIT,
                   "elements of vertices and indices");
}

/* The library's memory counts against the caller's limit and is freed. */
static void memory_is_accounted(void **state)
{
    (void)state;
    const test_bin bin = make_bin(EDGEBREAKER, sizeof EDGEBREAKER);
    facet_scene *scene = load(make_body(bin.size, NULL, NULL), &bin);
    scene_destroy(scene);
    char path[] = "src/io/testdata/sail_draco_edgebreaker.glb";
    facet_result last = FACET_OK;
    bool has_failed = false;
    for (uint64_t limit = 1 << 12; limit <= 1 << 22; limit += limit / 8) {
        facet_budget *budget = NULL;
        assert_int_equal(facet_budget_create(limit, &budget, NULL), FACET_OK);
        const facet_scene_desc desc = {.allocator = facet_budget_allocator(budget)};
        facet_error error = {0};
        last = gltf_load(path, &desc, &scene, &error);
        assert_true(last == FACET_OK || last == FACET_ERROR_MEMORY || last == FACET_ERROR_UNSUPPORTED);
        has_failed |= last != FACET_OK;
        scene_destroy(scene);
        assert_int_equal(facet_budget_used_bytes(budget), 0);
        facet_budget_destroy(budget);
    }
    assert_true(has_failed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_methods_are_decoded),
        cmocka_unit_test(contradictory_counts_and_types_are_refused),
        cmocka_unit_test(integers_become_floats),
        cmocka_unit_test(strips_become_their_triangles),
        cmocka_unit_test(oddities_are_warned_of),
        cmocka_unit_test(other_attributes_are_read_as_usual),
        cmocka_unit_test(accessors_may_be_shared),
        cmocka_unit_test(truncated_bitstreams_are_refused),
        cmocka_unit_test(damaged_bitstreams_do_no_harm),
        cmocka_unit_test(large_counts_take_no_memory),
        cmocka_unit_test(memory_is_accounted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
