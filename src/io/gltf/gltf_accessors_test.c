/* gltf_accessors_test.c - every form of accessor, through the attributes of a primitive. */
#include "io/gltf/gltf_test_support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define QUANTIZED "'extensionsUsed':['KHR_mesh_quantization'],'extensionsRequired':['KHR_mesh_quantization'],"

/* One primitive of 3 points whose POSITION is an accessor of the given component type over values. */
static facet_scene *load_positions(const void *values, size_t size, int component, const char *options)
{
    test_bin bin = {0};
    bin_add(&bin, values, size);
    char body[1024];
    snprintf(
        body, sizeof body,
        QUANTIZED
        "'bufferViews':[{'buffer':0,'byteLength':%zu%s}],'accessors':[{'bufferView':0,'componentType':%d,"
        "'count':3,'type':'VEC3'%s}],'meshes':[{'primitives':[{'attributes':{'POSITION':0},'mode':0}]}]",
        size, component == 5126 || component == 5120 || component == 5121 ? "" : ",'byteStride':8", component,
        options);
    return load(body, &bin);
}

static void component_types_convert_as_the_specification_says(void **state)
{
    (void)state;
    const int8_t i8[9] = {-128, -127, 0, 1, 64, 127, 3, 4, 5};
    const uint8_t u8[9] = {0, 1, 2, 127, 128, 255, 3, 4, 5};
    const int16_t i16[12] = {-32768, -32767, 0, 0, 1, 16384, 32767, 0, 3, 4, 5, 0};
    const uint16_t u16[12] = {0, 1, 2, 0, 32768, 65535, 3, 0, 4, 5, 6, 0};
    const float f32[9] = {-1.5f, 2, 3, 4, 5, 6, 7, 8, 1e10f};

    facet_scene *scene = load_positions(i8, sizeof i8, 5120, "");
    for (int i = 0; i < 9; i++)
        assert_near(first_primitive(scene)->positions[i], i8[i], 0);
    scene_destroy(scene);
    scene = load_positions(i8, sizeof i8, 5120, ",'normalized':true");
    for (int i = 0; i < 9; i++)
        assert_near(first_primitive(scene)->positions[i], fmax(i8[i] / 127.0, -1.0), 1e-7);
    scene_destroy(scene);
    scene = load_positions(u8, sizeof u8, 5121, ",'normalized':true");
    for (int i = 0; i < 9; i++)
        assert_near(first_primitive(scene)->positions[i], u8[i] / 255.0, 1e-7);
    scene_destroy(scene);
    scene = load_positions(i16, sizeof i16, 5122, ",'normalized':true");
    for (int i = 0; i < 9; i++)
        assert_near(first_primitive(scene)->positions[i], fmax(i16[i / 3 * 4 + i % 3] / 32767.0, -1.0), 1e-7);
    scene_destroy(scene);
    scene = load_positions(u16, sizeof u16, 5123, ",'normalized':true");
    for (int i = 0; i < 9; i++)
        assert_near(first_primitive(scene)->positions[i], u16[i / 3 * 4 + i % 3] / 65535.0, 1e-7);
    scene_destroy(scene);
    scene = load_positions(u16, sizeof u16, 5123, "");
    for (int i = 0; i < 9; i++)
        assert_near(first_primitive(scene)->positions[i], u16[i / 3 * 4 + i % 3], 0);
    scene_destroy(scene);
    scene = load_positions(f32, sizeof f32, 5126, "");
    assert_memory_equal(first_primitive(scene)->positions, f32, sizeof f32);
    scene_destroy(scene);
}

#define WIDE "'extensionsUsed':['KHR_accessor_float64'],'extensionsRequired':['KHR_accessor_float64'],"

static void halves_are_read(void **state)
{
    (void)state;
    /* 1, -2, 2^-24, 65504, 0.333.., 0, in two more elements; strides of 8 bytes */
    const uint16_t halves[12] = {0x3c00, 0xc000, 0x0001, 0, 0x7bff, 0x3555, 0x8000, 0, 0, 0x3c00, 0x4000, 0};
    const float expected[9] = {1, -2, 0x1p-24f, 65504, 0.333251953125f, -0.0f, 0, 1, 2};
    facet_scene *scene = load_positions(halves, sizeof halves, 5131, "");
    assert_floats(first_primitive(scene)->positions, expected, 9, 0);
    assert_true(has_note(scene, "5131 needs KHR_accessor_float16, which the file does not list"));
    scene_destroy(scene);
}

/* The triangle is near the equator, at the radius of the earth; floats are 0.5 m apart there. */
static const double far_triangle[9] = {6378137.125, 0.25, -3, 6378137.25, 0.5, -2, 6378138.0, 1, -1};

static void distant_doubles_keep_their_detail(void **state)
{
    (void)state;
    test_model m = {0};
    double other[9];
    for (int i = 0; i < 9; i++)
        other[i] = far_triangle[i] + (i % 3 == 0 ? 100.0625 : 0.0);
    model_add(&m, far_triangle, 3, "VEC3", 5130, "");
    model_add(&m, other, 3, "VEC3", 5130, "");
    facet_scene *scene = model_load(&m, "%s",
                                    WIDE "'meshes':[{'primitives':[{'attributes':{'POSITION':0}},"
                                         "{'attributes':{'POSITION':1}}]},"
                                         "{'primitives':[{'attributes':{'POSITION':1}}]}]");
    assert_int_equal(scene->note_count, 0);
    assert_int_equal(scene->warning_count, 0);
    for (uint32_t i = 0; i < 2; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++) {
            const scene_primitive *p = &scene->meshes[i].primitives[k];
            const double *expected = i + k ? other : far_triangle, *origin = scene->meshes[i].origin;
            for (int c = 0; c < 9; c++)
                assert_true(origin[c % 3] + (double)p->positions[c] == expected[c]);
            assert_true(fabsf(p->bounds_min[0]) < 200.0f);
            assert_true(origin[0] + (double)p->bounds_max[0] == expected[6]);
            /* normals of triangles this small and far need the detail */
            assert_near(p->normals[1] * p->normals[1] + p->normals[2] * p->normals[2] +
                            p->normals[0] * p->normals[0],
                        1, 1e-5);
        }
    scene_destroy(scene);
}

static void near_doubles_become_floats(void **state)
{
    (void)state;
    const double values[9] = {1, 2, 3, 4, 5, 0.1, 7, 8, 9};
    test_model m = {0};
    model_add(&m, values, 3, "VEC3", 5130, "");
    facet_scene *scene =
        model_load(&m, "%s", WIDE "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'mode':0}]}]");
    for (int i = 0; i < 9; i++)
        assert_true(first_primitive(scene)->positions[i] == (float)values[i]);
    assert_true(scene->meshes[0].origin[0] == 0.0);
    scene_destroy(scene);
}

static void doubles_that_break_rules_are_reported(void **state)
{
    (void)state;
    const double broken[9] = {(double)NAN, 2, 3, 1e300, 5, 6, 7, 8, 9};
    test_model m = {0};
    model_add(&m, broken, 3, "VEC3", 5130, "");
    facet_scene *scene =
        model_load(&m, "%s", WIDE "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'mode':0}]}]");
    assert_true(has_warning(scene, "accessor 0 has positions that are not finite"));
    assert_int_equal(first_primitive(scene)->index_count, 1);
    scene_destroy(scene);
    model_assert_refused(&m, "must have SCALAR elements of an unsigned type to be indices", "%s",
                         WIDE "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':0}]}]");
    /* fewer bytes than elements of 24 bytes need */
    test_bin bin = {0};
    bin_add(&bin, broken, 71);
    assert_refused("'bufferViews':[{'buffer':0,'byteLength':71}],'accessors':[{'bufferView':0,"
                   "'componentType':5130,'count':3,'type':'VEC3'}],"
                   "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}]",
                   &bin, FACET_ERROR_INVALID, "3 elements of 24 bytes, 24 apart");
}

static void tight_floats_stay_in_the_file(void **state)
{
    (void)state;
    const float values[9] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    facet_scene *scene = load_positions(values, sizeof values, 5126, "");
    const unsigned char *at = (const unsigned char *)first_primitive(scene)->positions;
    assert_true(at >= scene->files[0].data && at < scene->files[0].data + scene->files[0].size);
    scene_destroy(scene);
}

static void interleaved_attributes_are_separated(void **state)
{
    (void)state;
    const float vertices[3][8] = {
        {1, 2, 3, 0, 0, 1, 0.1f, 0.2f}, {4, 5, 6, 0, 1, 0, 0.3f, 0.4f}, {7, 8, 9, 1, 0, 0, 0.5f, 0.6f}};
    test_bin bin = {0};
    bin_add(&bin, vertices, sizeof vertices);
    facet_scene *scene =
        load("'bufferViews':[{'buffer':0,'byteLength':96,'byteStride':32}],'accessors':["
             "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
             "{'bufferView':0,'byteOffset':12,'componentType':5126,'count':3,'type':'VEC3'},"
             "{'bufferView':0,'byteOffset':24,'componentType':5126,'count':3,'type':'VEC2'}],"
             "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1,'TEXCOORD_0':2}}]}]",
             &bin);
    const scene_primitive *p = first_primitive(scene);
    for (size_t i = 0; i < 3; i++) {
        assert_floats(p->positions + 3 * i, vertices[i], 3, 0);
        assert_floats(p->normals + 3 * i, vertices[i] + 3, 3, 0);
        assert_floats(p->texcoords[0] + 2 * i, vertices[i] + 6, 2, 0);
    }
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
}

static void misaligned_floats_are_read_with_a_warning(void **state)
{
    (void)state;
    const float values[9] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    test_bin bin = {.size = 1};
    memcpy(bin.bytes + 1, values, sizeof values);
    bin.size += sizeof values;
    facet_scene *scene =
        load("'bufferViews':[{'buffer':0,'byteOffset':1,'byteLength':36}],'accessors':[{'bufferView':0,"
             "'componentType':5126,'count':3,'type':'VEC3'}],"
             "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'mode':0}]}]",
             &bin);
    assert_floats(first_primitive(scene)->positions, values, 9, 0);
    assert_true(has_note(scene, "accessors[0].byteOffset: 0 is not aligned"));
    scene_destroy(scene);
}

static void sparse_elements_replace(void **state)
{
    (void)state;
    const float base[9] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    const float value[3] = {-1, -2, -3};
    const struct {
        int component;
        size_t size;
        unsigned char bytes[4];
    } indices[3] = {{5121, 1, {1}}, {5123, 2, {1, 0}}, {5125, 4, {1, 0, 0, 0}}};
    for (int with_view = 0; with_view < 2; with_view++)
        for (int i = 0; i < 3; i++) {
            test_bin bin = {0};
            bin_add(&bin, base, sizeof base);
            bin_add(&bin, value, sizeof value);
            bin_add(&bin, indices[i].bytes, indices[i].size);
            char body[1024];
            snprintf(body, sizeof body,
                     "'bufferViews':[{'buffer':0,'byteLength':36},{'buffer':0,'byteOffset':36,'byteLength':"
                     "12},{'buffer':0,"
                     "'byteOffset':48,'byteLength':%zu}],'accessors':[{%s'componentType':5126,'count':3,'"
                     "type':'VEC3',"
                     "'sparse':{'count':1,'indices':{'bufferView':2,'componentType':%d},'values':{'"
                     "bufferView':1}}}],"
                     "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'mode':0}]}]",
                     indices[i].size, with_view ? "'bufferView':0," : "", indices[i].component);
            facet_scene *scene = load(body, &bin);
            const float *p = first_primitive(scene)->positions;
            assert_floats(p + 3, value, 3, 0);
            for (int k = 0; k < 3; k++) {
                assert_near(p[k], with_view ? base[k] : 0, 0);
                assert_near(p[6 + k], with_view ? base[6 + k] : 0, 0);
            }
            scene_destroy(scene);
        }
}

static void sparse_indices_are_checked(void **state)
{
    (void)state;
    const float value[3] = {0};
    const unsigned char index = 3;
    test_bin bin = {0};
    bin_add(&bin, value, sizeof value);
    bin_add(&bin, &index, 1);
    assert_refused(
        "'bufferViews':[{'buffer':0,'byteLength':12},{'buffer':0,'byteOffset':12,'byteLength':1}],'accessors'"
        ":"
        "[{'componentType':5126,'count':3,'type':'VEC3','sparse':{'count':1,'indices':{'bufferView':1,"
        "'componentType':5121},'values':{'bufferView':0}}}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'mode':0}]}]",
        &bin, FACET_ERROR_INVALID, "accessors[0]: sparse index 0 is 3, but the accessor has 3 elements");
}

static void counts_without_data_are_limited(void **state)
{
    (void)state;
    const float value[3] = {1, 2, 3};
    const unsigned char index = 3;
    test_bin bin = {0};
    bin_add(&bin, value, sizeof value);
    bin_add(&bin, &index, 1);
    static const char format[] =
        "'bufferViews':[{'buffer':0,'byteLength':12},{'buffer':0,'byteOffset':12,'byteLength':1}],'accessors'"
        ":[{'componentType':5126,'count':%u,'type':'VEC3'%s}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'mode':0}]}]";
    static const char sparse[] = ",'sparse':{'count':1,'indices':{'bufferView':1,'componentType':5121},"
                                 "'values':{'bufferView':0}}";
    char body[1024];
    /* Vertices without data are all at 0: nothing is drawn, and no memory is taken. */
    snprintf(body, sizeof body, format, 30000000u, "");
    facet_scene *scene = load(body, &bin);
    assert_int_equal(first_primitive(scene)->index_count, 0);
    assert_true(has_warning(scene, "POSITION: is without data"));
    scene_destroy(scene);
    /* With one sparse value the other elements exist as well, up to a limit. */
    snprintf(body, sizeof body, format, 65536u, sparse);
    scene = load(body, &bin);
    assert_int_equal(first_primitive(scene)->vertex_count, 65536);
    assert_near(first_primitive(scene)->positions[11], 3, 0);
    scene_destroy(scene);
    snprintf(body, sizeof body, format, 65537u, sparse);
    assert_refused(body, &bin, FACET_ERROR_LIMIT,
                   "accessors[0].count: 65537 elements are declared without a buffer view");
}

static void accessors_beyond_their_buffer_are_left_out(void **state)
{
    (void)state;
    test_bin bin = {.size = 64};
    assert_left_out(
        "'bufferViews':[{'buffer':0,'byteLength':64}],'accessors':[{'bufferView':0,'byteOffset':65,"
        "'componentType':5121,'count':1,'type':'SCALAR'}]",
        &bin, "test.glb: accessors[0].byteOffset: 65 is past the end of buffer view 0 (64 bytes)");
    assert_left_out(
        "'bufferViews':[{'buffer':0,'byteLength':64}],'accessors':[{'bufferView':0,'componentType':5126,"
        "'count':6,'type':'VEC3'}]",
        &bin, "accessors[0].count: 6 elements of 12 bytes, 12 apart, from offset 0");
    assert_left_out(
        "'bufferViews':[{'buffer':0,'byteLength':64,'byteStride':252}],'accessors':[{'bufferView':0,"
        "'componentType':5126,'count':4294967294,'type':'VEC3'}]",
        &bin, "go past the end");
    assert_left_out("'bufferViews':[{'buffer':0,'byteLength':65}]", &bin,
                    "bufferViews[0].byteLength: 65 from offset 0 goes past the end of buffer 0 (64 bytes)");
    assert_left_out(
        "'bufferViews':[{'buffer':0,'byteOffset':9007199254740992,'byteLength':9007199254740992}]", &bin,
        "bufferViews[0].byteOffset");
    assert_left_out("'bufferViews':[{'buffer':1,'byteLength':1}]", &bin,
                    "bufferViews[0].buffer: buffer 1 does not exist (there is 1)");
    /* The last element may end with the view, its stride may not be there. */
    facet_scene *scene =
        load("'bufferViews':[{'buffer':0,'byteLength':64,'byteStride':52}],'accessors':[{'bufferView':0,"
             "'componentType':5126,'count':2,'type':'VEC3'}]",
             &bin);
    scene_destroy(scene);
}

static void wrong_types_are_refused_where_they_are_used(void **state)
{
    (void)state;
    test_bin bin = {.size = 64};
    const char *views = "'bufferViews':[{'buffer':0,'byteLength':64}],'accessors':[{'bufferView':0,%s}]";
    static const char *const cases[][2] = {
        {"'componentType':5124,'count':1,'type':'SCALAR'", "5124 is not one of"},
        {"'componentType':'x','count':1,'type':'SCALAR'", "must be a number, but is a string"},
        {"'count':1,'type':'SCALAR'", "componentType: is missing"},
        {"'componentType':5121,'count':1,'type':'VEC5'", "\"VEC5\" is not an accessor type"},
        {"'componentType':5121,'count':1", "type: is missing"},
        {"'componentType':5121,'type':'SCALAR'", "count: is missing"},
        {"'componentType':5121,'count':-1,'type':'SCALAR'", "-1 is not a whole number"},
        {"'componentType':5121,'count':1.5,'type':'SCALAR'", "1.5 is not a whole number"},
        {"'componentType':5121,'count':1e30,'type':'SCALAR'", "is not a whole number"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char body[512];
        snprintf(body, sizeof body, views, cases[i][0]);
        assert_left_out(body, &bin, cases[i][1]);
        strcat(body, ",'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}]");
        assert_refused(body, &bin, FACET_ERROR_INVALID, cases[i][1]);
    }
}

/* Many primitives that use the same few bytes add up. */
static void work_beyond_the_bytes_is_limited(void **state)
{
    (void)state;
    const float value[3] = {1, 2, 3};
    const unsigned char index = 3;
    test_bin bin = {0};
    bin_add(&bin, value, sizeof value);
    bin_add(&bin, &index, 1);
    static char body[400000];
    size_t length = (size_t)snprintf(
        body, sizeof body,
        "'bufferViews':[{'buffer':0,'byteLength':12},{'buffer':0,'byteOffset':12,'byteLength':1}],'accessors'"
        ":"
        "[{'componentType':5126,'count':65536,'type':'VEC3','sparse':{'count':1,'indices':{'bufferView':1,"
        "'componentType':5121},'values':{'bufferView':0}}}],'meshes':[{'primitives':[{'attributes':{'"
        "POSITION'"
        ":0},'mode':0}");
    for (int i = 0; i < 5000; i++)
        length +=
            (size_t)snprintf(body + length, sizeof body - length, ",{'attributes':{'POSITION':0},'mode':0}");
    snprintf(body + length, sizeof body - length, "]}]");
    assert_refused(body, &bin, FACET_ERROR_LIMIT, "more than 268435456 elements");
}

static void index_types_are_equal(void **state)
{
    (void)state;
    const float positions[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    const unsigned char u8[6] = {0, 1, 2, 1, 3, 2};
    const uint16_t u16[6] = {0, 1, 2, 1, 3, 2};
    const uint32_t u32[6] = {0, 1, 2, 1, 3, 2};
    const void *bytes[3] = {u8, u16, u32};
    const size_t sizes[3] = {6, 12, 24};
    const int components[3] = {5121, 5123, 5125};
    for (int i = 0; i < 3; i++) {
        test_bin bin = {0};
        bin_add(&bin, positions, sizeof positions);
        bin_add(&bin, bytes[i], sizes[i]);
        char body[1024];
        snprintf(body, sizeof body,
                 "'bufferViews':[{'buffer':0,'byteLength':48},{'buffer':0,'byteOffset':48,'byteLength':%zu}],"
                 "'accessors':[{"
                 "'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},{'bufferView':1,'"
                 "componentType':%d,'count':6,"
                 "'type':'SCALAR'}],'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':0},'"
                 "indices':1}]}]",
                 sizes[i], components[i]);
        facet_scene *scene = load(body, &bin);
        assert_int_equal(first_primitive(scene)->index_count, 6);
        assert_memory_equal(first_primitive(scene)->indices, u32, sizeof u32);
        scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(component_types_convert_as_the_specification_says),
        cmocka_unit_test(halves_are_read),
        cmocka_unit_test(distant_doubles_keep_their_detail),
        cmocka_unit_test(near_doubles_become_floats),
        cmocka_unit_test(doubles_that_break_rules_are_reported),
        cmocka_unit_test(tight_floats_stay_in_the_file),
        cmocka_unit_test(interleaved_attributes_are_separated),
        cmocka_unit_test(misaligned_floats_are_read_with_a_warning),
        cmocka_unit_test(sparse_elements_replace),
        cmocka_unit_test(sparse_indices_are_checked),
        cmocka_unit_test(counts_without_data_are_limited),
        cmocka_unit_test(accessors_beyond_their_buffer_are_left_out),
        cmocka_unit_test(wrong_types_are_refused_where_they_are_used),
        cmocka_unit_test(work_beyond_the_bytes_is_limited),
        cmocka_unit_test(index_types_are_equal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
