/* gltf_meshes_test.c - primitives: modes, indices, attributes that are missing, broken or in need of
 * repair. */
#include "io/gltf/gltf_test_support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A mesh over the vertices (i, i^2, 0) with the given attributes and members; accessor 0 is POSITION,
 * followed by those of rest, over the views 1.. . */
static facet_result try_mesh(uint32_t vertex_count, const char *attributes, const char *members,
                             test_bin *bin, const char *views, const char *rest, facet_scene **scene,
                             facet_error *error)
{
    test_bin all = {0};
    for (uint32_t i = 0; i < vertex_count; i++) {
        const float p[3] = {(float)i, (float)(i * i), 0};
        bin_add(&all, p, sizeof p);
    }
    if (bin)
        bin_add(&all, bin->bytes, bin->size);
    char body[4096];
    snprintf(body, sizeof body,
             "'bufferViews':[{'buffer':0,'byteLength':%u}%s],'accessors':[{'bufferView':0,'componentType':"
             "5126,'count':%u,"
             "'type':'VEC3'}%s],'meshes':[{'primitives':[{'attributes':{'POSITION':0%s}%s}]}]",
             12 * vertex_count, views, vertex_count, rest, attributes, members);
    return try_load(body, &all, scene, error);
}

static facet_scene *load_mesh(uint32_t vertex_count, const char *attributes, const char *members,
                              test_bin *bin, const char *views, const char *rest)
{
    facet_scene *scene = NULL;
    facet_error error = {0};
    if (try_mesh(vertex_count, attributes, members, bin, views, rest, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return scene;
}

static void modes_become_lists(void **state)
{
    (void)state;
    static const uint32_t loop[] = {0, 1, 1, 2, 2, 3, 3, 4, 4, 0};
    static const uint32_t strip[] = {0, 1, 1, 2, 2, 3, 3, 4};
    /* Section 3.7.2.1: strip p_i = v_i, v_(i + 1 + i%2), v_(i + 2 - i%2); fan p_i = v_(i+1), v_(i+2), v_0. */
    static const uint32_t triangle_strip[] = {0, 1, 2, 1, 3, 2, 2, 3, 4};
    static const uint32_t fan[] = {1, 2, 0, 2, 3, 0, 3, 4, 0};
    static const uint32_t all[] = {0, 1, 2, 3, 4};
    static const struct {
        scene_mode mode;
        uint32_t count;
        const uint32_t *indices;
    } expected[7] = {{SCENE_POINTS, 5, all},    {SCENE_LINES, 4, all},
                     {SCENE_LINES, 10, loop},   {SCENE_LINES, 8, strip},
                     {SCENE_TRIANGLES, 3, all}, {SCENE_TRIANGLES, 9, triangle_strip},
                     {SCENE_TRIANGLES, 9, fan}};
    for (int mode = 0; mode < 7; mode++) {
        char members[32];
        snprintf(members, sizeof members, ",'mode':%d", mode);
        facet_scene *scene = load_mesh(5, ",'NORMAL':0", members, NULL, "", "");
        const scene_primitive *p = first_primitive(scene);
        assert_int_equal(p->mode, expected[mode].mode);
        assert_int_equal(p->index_count, expected[mode].count);
        assert_memory_equal(p->indices, expected[mode].indices, expected[mode].count * sizeof(uint32_t));
        assert_int_equal(p->vertex_count, 5);
        scene_destroy(scene);
    }
    facet_scene *scene = NULL;
    facet_error error;
    assert_int_equal(try_mesh(5, "", ",'mode':7", NULL, "", "", &scene, &error), FACET_ERROR_INVALID);
    assert_non_null(
        strstr(error.message, "meshes[0].primitives[0].mode: 7 is not a whole number from 0 to 6"));
}

static void too_few_vertices_draw_nothing(void **state)
{
    (void)state;
    for (int mode = 1; mode < 7; mode++) {
        char members[32];
        snprintf(members, sizeof members, ",'mode':%d", mode);
        facet_scene *scene = load_mesh(1, "", members, NULL, "", "");
        assert_int_equal(first_primitive(scene)->index_count, 0);
        assert_non_null(first_primitive(scene)->indices);
        assert_true(has_note(scene, "do not make whole"));
        scene_destroy(scene);
    }
}

/* A mesh of some vertices whose index list are bytes; members: of the primitive. */
static facet_scene *load_byte_indices(uint32_t vertex_count, const unsigned char *indices, size_t count,
                                      const char *members)
{
    test_bin bin = {0};
    char all[64];
    char view[96];
    char accessor[96];
    bin_add(&bin, indices, count);
    snprintf(all, sizeof all, ",'indices':1%s", members);
    snprintf(view, sizeof view, ",{'buffer':0,'byteOffset':%u,'byteLength':%zu}", 12 * vertex_count, count);
    snprintf(accessor, sizeof accessor, ",{'bufferView':1,'componentType':5121,'count':%zu,'type':'SCALAR'}",
             count);
    return load_mesh(vertex_count, "", all, &bin, view, accessor);
}

static void elements_with_missing_vertices_are_left_out(void **state)
{
    (void)state;
    facet_scene *scene = load_byte_indices(3, (const unsigned char[]){0, 1, 3, 0, 1, 2}, 6, "");
    assert_int_equal(first_primitive(scene)->index_count, 3);
    assert_true(has_warning(scene, "indices: index 2 is 3, but there are 3 vertices"));
    assert_int_equal(scene->warning_count, 1);
    scene_destroy(scene);

    scene = load_byte_indices(3, (const unsigned char[]){255, 1, 2, 0, 1, 2}, 6, "");
    assert_int_equal(first_primitive(scene)->index_count, 3);
    assert_true(has_warning(scene, "index 0 is 255, but there are 3 vertices"));
    scene_destroy(scene);

    scene = load_byte_indices(3, (const unsigned char[]){7, 8, 9}, 3, "");
    assert_int_equal(first_primitive(scene)->index_count, 0);
    scene_destroy(scene);
}

/* The bytes of test_bin are enough for 256 vertices. */
static void the_last_index_is_a_vertex_where_there_is_one(void **state)
{
    (void)state;
    const unsigned char indices[3] = {0, 1, 255};
    for (int mode = 0; mode < 7; mode++) {
        char members[32];
        snprintf(members, sizeof members, ",'mode':%d", mode);
        facet_scene *scene = load_byte_indices(256, indices, 3, members);
        const scene_primitive *p = first_primitive(scene);
        assert_true(has_warning(scene, "has the index 255, which glTF keeps for primitive restart"));
        static const uint32_t counts[7] = {3, 2, 6, 4, 3, 3, 3};
        assert_int_equal(p->index_count, counts[mode]);
        bool is_used = false;
        for (uint32_t i = 0; i < p->index_count; i++)
            is_used |= p->positions[3 * p->indices[i]] == 255.0f;
        assert_true(is_used == (mode != 1));
        scene_destroy(scene);
    }
}

/* Each strip restarts with the first triangle's winding, each fan with its own center. */
static void the_last_index_restarts_where_there_is_no_vertex(void **state)
{
    (void)state;
    static const unsigned char indices[] = {0, 1, 2, 3, 255, 4, 5, 6, 255, 255, 7};
    static const struct {
        int mode;
        uint32_t count, indices[16];
    } expected[] = {{2, 14, {0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 4}},
                    {3, 10, {0, 1, 1, 2, 2, 3, 4, 5, 5, 6}},
                    {5, 9, {0, 1, 2, 1, 3, 2, 4, 5, 6}},
                    {6, 9, {1, 2, 0, 2, 3, 0, 5, 6, 4}}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        char members[32];
        snprintf(members, sizeof members, ",'mode':%d", expected[i].mode);
        facet_scene *scene = load_byte_indices(8, indices, sizeof indices, members);
        const scene_primitive *p = first_primitive(scene);
        assert_true(has_warning(scene, "has the index 255, which is read as a primitive restart"));
        assert_int_equal(scene->warning_count, 1);
        assert_int_equal(p->index_count, expected[i].count);
        for (uint32_t k = 0; k < p->index_count; k++)
            assert_int_equal((int)p->positions[3 * p->indices[k]], expected[i].indices[k]);
        scene_destroy(scene);
    }
}

static void missing_normals_become_flat(void **state)
{
    (void)state;
    const unsigned char indices[6] = {0, 1, 2, 2, 1, 3};
    test_bin bin = {0};
    bin_add(&bin, indices, sizeof indices);
    facet_scene *scene = load_mesh(4, ",'TANGENT':2,'COLOR_0':3,'TEXCOORD_0':4", ",'indices':1", &bin,
                                   ",{'buffer':0,'byteOffset':48,'byteLength':6}",
                                   ",{'bufferView':1,'componentType':5121,'count':6,'type':'SCALAR'}"
                                   ",{'componentType':5126,'count':4,'type':'VEC4'}"
                                   ",{'componentType':5126,'count':4,'type':'VEC3'}"
                                   ",{'componentType':5126,'count':4,'type':'VEC2'}");
    const scene_primitive *p = first_primitive(scene);
    assert_true(p->has_flat_normals);
    assert_int_equal(p->vertex_count, 6);
    assert_null(p->tangents);
    assert_non_null(p->colors);
    assert_int_equal(p->texcoord_count, 1);
    for (uint32_t i = 0; i < 6; i++) {
        assert_int_equal(p->indices[i], i);
        assert_near(p->positions[3 * i], indices[i], 0);
        assert_near(p->colors[4 * i + 3], 1, 0);
        assert_near(p->normals[3 * i + 2], i < 3 ? 1 : -1, 1e-6);
    }
    scene_destroy(scene);
}

static void points_and_lines_stay_without_normals(void **state)
{
    (void)state;
    facet_scene *scene = load_mesh(4, "", ",'mode':1", NULL, "", "");
    assert_null(first_primitive(scene)->normals);
    assert_false(first_primitive(scene)->has_flat_normals);
    scene_destroy(scene);
}

static void normals_are_made_unit(void **state)
{
    (void)state;
    const float normals[9] = {0, 0, 4, 0, 0, 0, 1e-20f, 0, 0};
    test_bin bin = {0};
    bin_add(&bin, normals, sizeof normals);
    facet_scene *scene =
        load_mesh(3, ",'NORMAL':1", "", &bin, ",{'buffer':0,'byteOffset':36,'byteLength':36}",
                  ",{'bufferView':1,'componentType':5126,'count':3,'type':'VEC3'}");
    /* The second normal has no direction; it becomes the triangle's, +Z. */
    const float expected[9] = {0, 0, 1, 0, 0, 1, 1, 0, 0};
    assert_floats(first_primitive(scene)->normals, expected, 9, 1e-6);
    assert_true(has_note(scene, "3 normals of accessor 1 are not of length 1"));
    scene_destroy(scene);
}

static void quantized_normals_are_made_unit_silently(void **state)
{
    (void)state;
    const int8_t normals[12] = {0, 0, 127, 0, 90, 90, 0, 0, -128, 0, 0, 0};
    test_bin bin = {0};
    bin_add(&bin, normals, sizeof normals);
    facet_scene *scene = load_mesh(
        3, ",'NORMAL':1", "", &bin, ",{'buffer':0,'byteOffset':36,'byteLength':12,'byteStride':4}",
        ",{'bufferView':1,'componentType':5120,'normalized':true,'count':3,'type':'VEC3'}"
        "],'extensionsUsed':['KHR_mesh_quantization'],'extensionsRequired':['KHR_mesh_quantization'");
    const float half = 0.70710678f;
    const float expected[9] = {0, 0, 1, half, half, 0, -1, 0, 0};
    assert_floats(first_primitive(scene)->normals, expected, 9, 1e-6);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
}

static void triangles_with_non_finite_positions_are_left_out(void **state)
{
    (void)state;
    float positions[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5, 6, 5, 5, 5, NAN, 5};
    test_bin bin = {0};
    bin_add(&bin, positions, sizeof positions);
    facet_scene *scene =
        load("'bufferViews':[{'buffer':0,'byteLength':72}],'accessors':[{'bufferView':0,'componentType':"
             "5126,'count':6,'type':'VEC3'}],'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}]",
             &bin);
    const scene_primitive *p = first_primitive(scene);
    assert_int_equal(p->index_count, 3);
    assert_near(p->bounds_max[0], 1, 0);
    assert_true(has_warning(scene, "not finite"));
    scene_destroy(scene);
}

static void colors_are_linear_rgba_in_range(void **state)
{
    (void)state;
    const uint8_t u8[12] = {255, 0, 51, 0, 0, 255, 0, 0, 1, 2, 3, 0};
    const float f32[12] = {0.5f, 2, -1, NAN, 0, 0, 0, 0, 0.25f, 1, 1, 1};
    test_bin bin = {0};
    bin_add(&bin, u8, sizeof u8);
    facet_scene *scene =
        load_mesh(3, ",'COLOR_0':1,'NORMAL':0", "", &bin,
                  ",{'buffer':0,'byteOffset':36,'byteLength':12,'byteStride':4}",
                  ",{'bufferView':1,'componentType':5121,'normalized':true,'count':3,'type':'VEC3'}");
    const float expected_u8[4] = {1, 0, 0.2f, 1};
    assert_floats(first_primitive(scene)->colors, expected_u8, 4, 1e-7);
    scene_destroy(scene);
    bin.size = 0;
    bin_add(&bin, f32, sizeof f32);
    scene = load_mesh(3, ",'COLOR_0':1,'NORMAL':0", "", &bin, ",{'buffer':0,'byteOffset':36,'byteLength':48}",
                      ",{'bufferView':1,'componentType':5126,'count':3,'type':'VEC4'}");
    const float expected_f32[12] = {0.5f, 1, 0, 0, 0, 0, 0, 0, 0.25f, 1, 1, 1};
    assert_floats(first_primitive(scene)->colors, expected_f32, 12, 0);
    assert_true(has_warning(scene, "outside [0, 1]"));
    scene_destroy(scene);
}

static void tangents_without_use_are_dropped(void **state)
{
    (void)state;
    const float tangents[12] = {2, 0, 0, 1, 1, 0, 0, -0.5f, 1, 0, 0, 1};
    test_bin bin = {0};
    bin_add(&bin, tangents, sizeof tangents);
    const char *views = ",{'buffer':0,'byteOffset':36,'byteLength':48}";
    const char *accessor = ",{'bufferView':1,'componentType':5126,'count':3,'type':'VEC4'}"
                           ",{'componentType':5126,'count':3,'type':'VEC3'}";
    facet_scene *scene = load_mesh(3, ",'TANGENT':1,'NORMAL':2", "", &bin, views, accessor);
    const float expected[8] = {1, 0, 0, 1, 1, 0, 0, -1};
    assert_floats(first_primitive(scene)->tangents, expected, 8, 0);
    scene_destroy(scene);
    memset(bin.bytes, 0, 16);
    scene = load_mesh(3, ",'TANGENT':1,'NORMAL':2", "", &bin, views, accessor);
    assert_null(first_primitive(scene)->tangents);
    assert_true(has_note(scene, "computed instead"));
    scene_destroy(scene);
}

static void bounds_are_those_of_used_vertices(void **state)
{
    (void)state;
    const unsigned char indices[3] = {0, 1, 2};
    test_bin bin = {0};
    bin_add(&bin, indices, sizeof indices);
    facet_scene *scene =
        load_mesh(10, ",'NORMAL':0", ",'indices':1", &bin, ",{'buffer':0,'byteOffset':120,'byteLength':3}",
                  ",{'bufferView':1,'componentType':5121,'count':3,'type':'SCALAR'}");
    const float minimum[3] = {0, 0, 0};
    const float maximum[3] = {2, 4, 0};
    assert_floats(first_primitive(scene)->bounds_min, minimum, 3, 0);
    assert_floats(first_primitive(scene)->bounds_max, maximum, 3, 0);
    scene_destroy(scene);
}

static void attributes_must_fit_together(void **state)
{
    (void)state;
    static const struct {
        const char *attributes, *rest, *message;
    } cases[] = {
        {",'COLOR_0':1", ",{'componentType':5126,'count':2,'type':'VEC3'}",
         "COLOR_0: accessor 1 has 2 elements, but POSITION has 3"},
        {",'COLOR_0':1", ",{'componentType':5126,'count':3,'type':'VEC2'}",
         "accessor 1 has a type and componentType that are not allowed for COLOR_0"},
        {",'NORMAL':9", "", "attributes.NORMAL: accessor 9 does not exist"},
        {",'NORMAL':1", ",{'componentType':5125,'count':3,'type':'VEC3'}", "that are not allowed for NORMAL"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facet_scene *scene = NULL;
        facet_error error;
        assert_int_equal(try_mesh(3, cases[i].attributes, "", NULL, "", cases[i].rest, &scene, &error),
                         FACET_ERROR_INVALID);
        if (!strstr(error.message, cases[i].message))
            fail_msg("%s", error.message);
    }
}

static void unused_attributes_are_not_read(void **state)
{
    (void)state;
    static const char *const cases[][3] = {
        {",'_X':9", "", "attributes._X: accessor 9 does not exist (there is 1); nothing reads it"},
        {",'COLOR_1':'a'", "", "attributes.COLOR_1: must be a number, but is a string; nothing reads it"},
        {",'TEXCOORD_0':1", ",{'componentType':5126,'count':2,'type':'VEC2'}",
         "TEXCOORD_0: accessor 1 has 2 elements, but POSITION has 3; no texture reads it"},
        {",'NORMAL':0,'TANGENT':9", "",
         "TANGENT: accessor 9 does not exist (there is 1); tangents are computed"},
        {",'JOINTS_0':9,'WEIGHTS_0':9", "",
         "JOINTS_0: accessor 9 does not exist (there is 1); nothing that is drawn uses it"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facet_scene *scene = load_mesh(3, cases[i][0], "", NULL, "", cases[i][1]);
        assert_int_equal(first_primitive(scene)->index_count, 3);
        assert_null(first_primitive(scene)->tangents);
        if (!has_warning(scene, cases[i][2]))
            fail_msg("%s", scene->warning_count ? scene->warnings[0] : "no warning");
        scene_destroy(scene);
    }
}

static void all_texcoord_sets_are_read(void **state)
{
    (void)state;
    facet_scene *scene = load_mesh(3, ",'TEXCOORD_0':1,'TEXCOORD_1':1,'TEXCOORD_2':1,'TEXCOORD_4':1", "",
                                   NULL, "", ",{'componentType':5126,'count':3,'type':'VEC2'}");
    assert_int_equal(first_primitive(scene)->texcoord_count, 3);
    assert_true(has_warning(scene, "TEXCOORD_4: is present without TEXCOORD_3"));
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(modes_become_lists),
        cmocka_unit_test(too_few_vertices_draw_nothing),
        cmocka_unit_test(elements_with_missing_vertices_are_left_out),
        cmocka_unit_test(the_last_index_is_a_vertex_where_there_is_one),
        cmocka_unit_test(the_last_index_restarts_where_there_is_no_vertex),
        cmocka_unit_test(missing_normals_become_flat),
        cmocka_unit_test(points_and_lines_stay_without_normals),
        cmocka_unit_test(normals_are_made_unit),
        cmocka_unit_test(quantized_normals_are_made_unit_silently),
        cmocka_unit_test(triangles_with_non_finite_positions_are_left_out),
        cmocka_unit_test(colors_are_linear_rgba_in_range),
        cmocka_unit_test(tangents_without_use_are_dropped),
        cmocka_unit_test(bounds_are_those_of_used_vertices),
        cmocka_unit_test(attributes_must_fit_together),
        cmocka_unit_test(unused_attributes_are_not_read),
        cmocka_unit_test(all_texcoord_sets_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
