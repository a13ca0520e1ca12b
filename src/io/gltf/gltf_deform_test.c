/* gltf_deform_test.c - deformation of meshes: morph targets and their weights, joints and their weights,
 * skins. */
#include "io/gltf/gltf_test_support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const float CORNERS[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
static const float UP[9] = {0, 0, 1, 0, 0, 1, 0, 0, 1};

/* ---- morph targets ---- */

static void morph_targets_are_read(void **state)
{
    (void)state;
    const float tangents[12] = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
    const float deltas[9] = {0, 0, 1, 0, 0, 2, 0, 0, 3};
    const signed char bytes[12] = {127, 0, 0, 0,  -127, 0,
                                   0,   0, 0, 64, 0,    0}; /* elements of 4 bytes, 3 used */
    test_model m = {0};
    model_add_floats(&m, CORNERS, 3, "VEC3");
    model_add_floats(&m, UP, 3, "VEC3");
    model_add_floats(&m, tangents, 3, "VEC4");
    model_add_floats(&m, deltas, 3, "VEC3");
    size_t at = bin_add(&m.bin, bytes, sizeof bytes);
    char more[512];
    snprintf(more, sizeof more, ",{'buffer':0,'byteOffset':%zu,'byteLength':12,'byteStride':4}", at);
    strcat(m.views, more);
    strcat(m.accessors, ",{'bufferView':4,'componentType':5120,'normalized':true,'count':3,'type':'VEC3'}");
    facet_scene *scene = model_load(
        &m, "'extensionsUsed':['KHR_mesh_quantization'],'extensionsRequired':['KHR_mesh_quantization'],"
            "'meshes':[{'weights':[0.5,2],'extras':{'targetNames':['a','b']},'primitives':[{'attributes':"
            "{'POSITION':0,'NORMAL':1,'TANGENT':2},'targets':[{'POSITION':3,'TANGENT':3},{'NORMAL':4}]}]}],"
            "'nodes':[{'mesh':0,'weights':[1,0.25]},{'mesh':0}]");
    const scene_primitive *p = first_primitive(scene);
    const float normal_deltas[9] = {1, 0, 0, -1, 0, 0, 0, 64.0f / 127, 0};
    assert_int_equal(p->target_count, 2);
    assert_floats(p->targets[0].positions, deltas, 9, 0);
    assert_floats(p->targets[0].tangents, deltas, 9, 0);
    assert_null(p->targets[0].normals);
    assert_floats(p->targets[1].normals, normal_deltas, 9, 1e-7);
    assert_null(p->targets[1].positions);
    const scene_mesh *mesh = &scene->meshes[0];
    assert_int_equal(mesh->weight_count, 2);
    assert_near(mesh->weights[0], 0.5, 0);
    assert_near(mesh->weights[1], 2, 0);
    assert_string_equal(mesh->meta.extras, "{\"targetNames\":[\"a\",\"b\"]}");
    assert_near(scene->nodes[0].weights[1], 0.25, 0);
    assert_null(scene->nodes[1].weights);
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);
}

/* Sparse displacements without a base: the common form of exporters. */
static void sparse_displacements_are_zero_elsewhere(void **state)
{
    (void)state;
    const uint16_t places[2] = {2, 0};
    const float values[3] = {7, 8, 9};
    test_model m = {0};
    model_add_floats(&m, CORNERS, 3, "VEC3");
    model_add_floats(&m, UP, 3, "VEC3");
    model_add(&m, places, 1, "SCALAR", 5123, "");
    model_add_floats(&m, values, 1, "VEC3");
    strcat(m.accessors, ",{'componentType':5126,'count':3,'type':'VEC3','sparse':{'count':1,'indices':"
                        "{'bufferView':2,'componentType':5123},'values':{'bufferView':3}}}");
    facet_scene *scene = model_load(
        &m,
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1},'targets':[{'POSITION':4}]}]}]");
    const float expected[9] = {0, 0, 0, 0, 0, 0, 7, 8, 9};
    assert_floats(first_primitive(scene)->targets[0].positions, expected, 9, 0);
    assert_int_equal(scene->meshes[0].weight_count, 1);
    assert_near(scene->meshes[0].weights[0], 0, 0);
    scene_destroy(scene);
}

static void wrong_weight_counts_are_reported(void **state)
{
    (void)state;
    test_model m = {0};
    model_add_floats(&m, CORNERS, 3, "VEC3");
    model_add_floats(&m, UP, 3, "VEC3");
    facet_scene *scene = model_load(
        &m, "'meshes':[{'weights':[1,2,3],'primitives':[{'attributes':{'POSITION':0,'NORMAL':1},'targets':["
            "{'POSITION':1},{'POSITION':1}]},{'attributes':{'POSITION':0,'NORMAL':1},'targets':["
            "{'POSITION':1,'TEXCOORD_0':1}]}]},{'primitives':[{'attributes':{'POSITION':0},'targets':[{"
            "'NORMAL':1}]}]}],'nodes':[{'mesh':0,'weights':[5]}]");
    const scene_mesh *mesh = &scene->meshes[0];
    assert_int_equal(mesh->weight_count, 2);
    assert_near(mesh->weights[1], 2, 0);
    assert_int_equal(mesh->primitives[1].target_count, 1);
    assert_near(scene->nodes[0].weights[0], 5, 0);
    assert_near(scene->nodes[0].weights[1], 0, 0);
    assert_true(has_warning(scene, "meshes[0].weights: must be as many as there are morph targets, 2, but "
                                   "are 3 (2 times in all)"));
    assert_true(has_warning(scene, "must be as many as those of the other primitives"));
    assert_true(has_note(scene, "TEXCOORD_0: is not among the attributes of the primitive"));
    assert_null(scene->meshes[1].primitives[0].targets[0].normals); /* flat normals have no changes */
    scene_destroy(scene);
}

static void broken_targets_have_no_effect(void **state)
{
    (void)state;
    test_model m = {0};
    model_add_floats(&m, CORNERS, 3, "VEC3");
    model_add_floats(&m, CORNERS, 2, "VEC3");
    model_add_floats(&m, CORNERS, 3, "VEC2");
    static const char body[] =
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'targets':[{'POSITION':%d}]}]}]";
    model_assert_left_out(&m, "targets[0].POSITION: accessor 1 has 2 elements, but POSITION has 3", body, 1);
    model_assert_left_out(&m, "accessor 2 has a type and componentType that are not allowed for POSITION",
                          body, 2);
    model_assert_left_out(&m, "targets[0].POSITION: accessor 3 does not exist", body, 3);
}

static void non_finite_displacements_are_zero(void **state)
{
    (void)state;
    const float deltas[9] = {NAN, 0, 1, INFINITY, 0, 2, 0, 0, 3};
    const float expected[9] = {0, 0, 1, 0, 0, 2, 0, 0, 3};
    test_model m = {0};
    model_add_floats(&m, CORNERS, 3, "VEC3");
    model_add_floats(&m, UP, 3, "VEC3");
    model_add_floats(&m, deltas, 3, "VEC3");
    facet_scene *scene = model_load(
        &m,
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1},'targets':[{'POSITION':2}]}]}]");
    assert_floats(first_primitive(scene)->targets[0].positions, expected, 9, 0);
    assert_true(has_warning(scene, "accessor 2 has displacements of positions that are not finite"));
    scene_destroy(scene);
}

/* ---- joints ---- */

static const unsigned char JOINTS[12] = {1, 0, 0, 0, 0, 1, 0, 0, 2, 0, 9, 0};

static void influences_of_all_sets_are_contiguous_per_vertex(void **state)
{
    (void)state;
    const unsigned short more[12] = {3, 0, 0, 0, 300, 0, 0, 0, 0, 0, 0, 0};
    const float weights[12] = {0.5f, 0, 0, 0, 0.25f, 0.25f, 0, 0, 1, 0, 0, 0};
    const unsigned char bytes[12] = {127, 0, 0, 0, 128, 0, 0, 0, 0, 0, 0, 0};
    test_model m = {0};
    model_add_floats(&m, CORNERS, 3, "VEC3");
    model_add_floats(&m, UP, 3, "VEC3");
    model_add(&m, JOINTS, 3, "VEC4", 5121, "");
    model_add_floats(&m, weights, 3, "VEC4");
    model_add(&m, more, 3, "VEC4", 5123, "");
    model_add(&m, bytes, 3, "VEC4", 5121, ",'normalized':true");
    facet_scene *scene =
        model_load(&m, "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1,'JOINTS_0':2,"
                       "'WEIGHTS_0':3,'JOINTS_1':4,'WEIGHTS_1':5}}]}]");
    const scene_primitive *p = first_primitive(scene);
    static const uint16_t joints[24] = {1, 0, 0, 0, 3, 0, 0, 0, 0, 1, 0, 0, 300, 0, 0, 0, 2, 0, 0, 0};
    assert_int_equal(p->influence_count, 8);
    assert_memory_equal(p->joints, joints, sizeof joints); /* the 9 has no weight and is dropped */
    for (int vertex = 0; vertex < 3; vertex++) {
        double sum = 0;
        for (int i = 0; i < 8; i++)
            sum += (double)p->weights[8 * vertex + i];
        assert_near(sum, 1, 1e-6);
    }
    assert_near(p->weights[4], (127.0 / 255) / (0.5 + 127.0 / 255), 1e-6);
    assert_int_equal(scene->warning_count, 0); /* 0.998 is rounding */
    scene_destroy(scene);
}

static void weights_sum_to_one(void **state)
{
    (void)state;
    const float weights[12] = {1, 3, 0, 0, 0, 0, 0, 0, NAN, -1, 2, 0};
    test_model m = {0};
    model_add_floats(&m, CORNERS, 3, "VEC3");
    model_add_floats(&m, UP, 3, "VEC3");
    model_add(&m, JOINTS, 3, "VEC4", 5121, "");
    model_add_floats(&m, weights, 3, "VEC4");
    facet_scene *scene = model_load(
        &m,
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1,'JOINTS_0':2,'WEIGHTS_0':3}}]}]");
    const scene_primitive *p = first_primitive(scene);
    const float expected[12] = {0.25f, 0.75f, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0};
    assert_floats(p->weights, expected, 12, 0);
    assert_int_equal(p->joints[4], 0);  /* the first of vertex 1 */
    assert_int_equal(p->joints[10], 9); /* the third of vertex 2 */
    assert_true(has_warning(scene, "weights of 2 vertices do not sum to 1; they are scaled"));
    assert_true(has_warning(scene, "weights of 1 vertices are all 0; the first joint of each moves it"));
    scene_destroy(scene);
}

/* Flat normals give every corner a vertex of its own, in the order of the indices. */
static void flat_primitives_keep_all_attributes(void **state)
{
    (void)state;
    const float weights[12] = {1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0};
    const float deltas[9] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    const unsigned char indices[6] = {2, 0, 1, 1, 0, 2};
    test_model m = {0};
    model_add_floats(&m, CORNERS, 3, "VEC3");
    model_add(&m, JOINTS, 3, "VEC4", 5121, "");
    model_add_floats(&m, weights, 3, "VEC4");
    model_add_floats(&m, deltas, 3, "VEC3");
    model_add(&m, indices, 6, "SCALAR", 5121, "");
    facet_scene *scene =
        model_load(&m, "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'JOINTS_0':1,'WEIGHTS_0':2},"
                       "'indices':4,'targets':[{'POSITION':3},{}]}]}]");
    const scene_primitive *p = first_primitive(scene);
    assert_true(p->has_flat_normals);
    assert_int_equal(p->vertex_count, 6);
    assert_int_equal(p->influence_count, 4);
    assert_int_equal(p->target_count, 2);
    for (size_t i = 0; i < 6; i++) {
        assert_floats(p->positions + 3 * i, CORNERS + 3 * indices[i], 3, 0);
        assert_floats(p->weights + 4 * i, weights + 4 * indices[i], 4, 0);
        assert_floats(p->targets[0].positions + 3 * i, deltas + 3 * indices[i], 3, 0);
        assert_near(p->normals[3 * i + 2], i < 3 ? 1 : -1, 0);
    }
    assert_null(p->targets[1].positions);
    assert_int_equal(p->joints[0], 2);
    assert_int_equal(p->joints[4], 1);
    scene_destroy(scene);
}

static void broken_influences_are_refused(void **state)
{
    (void)state;
    const float weights[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    test_model m = {0};
    model_add_floats(&m, CORNERS, 3, "VEC3");
    model_add(&m, JOINTS, 3, "VEC4", 5121, "");
    model_add_floats(&m, weights, 3, "VEC4");
    model_add(&m, JOINTS, 2, "VEC4", 5121, "");
    static const char body[] =
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'JOINTS_0':%d,'WEIGHTS_0':%d}}]}],"
        "'nodes':[{'mesh':0,'skin':0},{}],'skins':[{'joints':[0,1]}]";
    model_assert_refused(&m, "accessor 2 has a type and componentType that are not allowed for JOINTS_0",
                         body, 2, 2);
    model_assert_refused(&m, "accessor 3 has 2 elements, but POSITION has 3", body, 3, 2);
    model_assert_refused(&m, "nodes[0].skin: a vertex of mesh 0 is moved by joint 2, but skin 0 has 2 joints",
                         body, 1, 2);
    facet_scene *scene =
        model_load(&m, "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'WEIGHTS_0':2}}]}],"
                       "'nodes':[{'mesh':0,'skin':0}],'skins':[{'joints':[0]}]");
    assert_int_equal(first_primitive(scene)->influence_count, 0);
    assert_true(has_warning(scene, "has 0 sets of JOINTS_n, but 1 of WEIGHTS_n"));
    assert_true(has_warning(scene, "nodes[0].skin: has no effect: mesh 0 has no JOINTS_0"));
    scene_destroy(scene);
}

/* ---- skins ---- */

static void skins_are_read(void **state)
{
    (void)state;
    float matrices[48] = {0};
    for (size_t i = 0; i < 3; i++)
        for (size_t k = 0; k < 4; k++)
            matrices[16 * i + 5 * k] = 1;
    matrices[12] = 5;
    matrices[16 + 15] = 2; /* a last row that is not 0 0 0 1 */
    matrices[32] = NAN;
    test_model m = {0};
    model_add_floats(&m, matrices, 3, "MAT4");
    facet_scene *scene =
        model_load(&m, "'nodes':[{'children':[1,2]},{},{}],'skins':[{'name':'s','joints':[2,1,0],"
                       "'inverseBindMatrices':0,'skeleton':0,'extras':7},{'joints':[1]}]");
    assert_int_equal(scene->skin_count, 2);
    const scene_skin *skin = &scene->skins[0];
    const mat4 identity = mat4_identity();
    assert_string_equal(skin->name, "s");
    assert_int_equal(skin->joint_count, 3);
    assert_int_equal(skin->joints[0], 2);
    assert_int_equal(skin->skeleton, 0);
    assert_string_equal(skin->meta.extras, "7");
    assert_near(skin->inverse_bind[0].m[12], 5, 0);
    assert_floats(skin->inverse_bind[1].m, identity.m, 16, 0);
    assert_floats(skin->inverse_bind[2].m, identity.m, 16, 0);
    assert_null(scene->skins[1].inverse_bind);
    assert_int_equal(scene->skins[1].skeleton, SCENE_NONE);
    assert_true(has_warning(scene, "1 are not finite; the identity is used"));
    assert_true(has_warning(scene, "1 have a last row other than 0 0 0 1"));
    scene_destroy(scene);
    model_assert_left_out(&m, "accessor 0 has 3 elements, but there are 4 joints",
                          "'nodes':[{},{},{},{}],'skins':[{'joints':[0,1,2,3],'inverseBindMatrices':0}]");
}

/* ---- real models ---- */

static void real_models_are_read(void **state)
{
    (void)state;
    facet_scene *scene = load_shared("animation/Fox.glb");
    const scene_primitive *p = first_primitive(scene);
    assert_int_equal(scene->skin_count, 1);
    assert_int_equal(scene->skins[0].joint_count, 24);
    assert_non_null(scene->skins[0].inverse_bind);
    assert_int_equal(p->influence_count, 4);
    assert_true(p->has_flat_normals); /* its vertices have no normals */
    assert_int_equal(scene->warning_count, 0);
    scene_destroy(scene);

    scene = load_shared("animation/MorphStressTest.glb");
    assert_int_equal(scene->meshes[0].weight_count, 8);
    assert_int_equal(first_primitive(scene)->target_count, 8);
    assert_non_null(first_primitive(scene)->targets[7].normals);
    assert_non_null(strstr(scene->meshes[0].meta.extras, "\"targetNames\":[\"Key 1\",\"Key 2\""));
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(morph_targets_are_read),
        cmocka_unit_test(sparse_displacements_are_zero_elsewhere),
        cmocka_unit_test(wrong_weight_counts_are_reported),
        cmocka_unit_test(broken_targets_have_no_effect),
        cmocka_unit_test(non_finite_displacements_are_zero),
        cmocka_unit_test(influences_of_all_sets_are_contiguous_per_vertex),
        cmocka_unit_test(weights_sum_to_one),
        cmocka_unit_test(flat_primitives_keep_all_attributes),
        cmocka_unit_test(broken_influences_are_refused),
        cmocka_unit_test(skins_are_read),
        cmocka_unit_test(real_models_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
