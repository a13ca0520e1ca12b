/* obj_write_test.c - OBJ files as they are written, and scenes that come back from them. */
#define _POSIX_C_SOURCE 200809L
#include "tests/support/support.h"
#include "io/obj/mtl_test_support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/text.h"
#include "image/srgb.h"
#include "io/obj/obj_write.h"
#include "scene/origin.h"

/* ---- a scene by hand ---- */

static const float CORNERS[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
static const float UVS[8] = {0, 1, 1, 1, 1, 0, 0, 0.25f};
static const float NORMALS[12] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
static const float COLORS[16] = {1, 0, 0, 1, 0, 0.5f, 0, 1, 0, 0, 1, 0.5f, 1, 1, 1, 1};
static const uint32_t QUAD[6] = {0, 1, 2, 0, 2, 3};

static void *add(facet_scene *scene, size_t count, size_t size)
{
    void *block = arena_zalloc(scene->arena, count, size);
    assert_non_null(block);
    return block;
}

/* Nodes of one mesh each; materials "m0", "m1", .. */
static facet_scene *make_scene(uint32_t node_count, uint32_t material_count)
{
    facet_scene *scene = NULL;
    assert_int_equal(scene_create(NULL, "by hand", &scene, NULL), FACET_OK);
    scene->nodes = add(scene, node_count, sizeof *scene->nodes);
    scene->meshes = add(scene, node_count, sizeof *scene->meshes);
    scene->node_count = scene->mesh_count = node_count;
    for (uint32_t i = 0; i < node_count; i++) {
        scene->meshes[i] = (scene_mesh){.name = ""};
        scene->nodes[i] = scene_node_default("");
        scene->nodes[i].mesh = i;
    }
    scene->material_count = material_count;
    scene->materials = add(scene, material_count, sizeof *scene->materials);
    scene->legacy = add(scene, 1, sizeof *scene->legacy);
    scene->legacy->materials = add(scene, material_count, sizeof *scene->legacy->materials);
    scene->legacy->is_source = true;
    scene->legacy->colors = FACET_LEGACY_COLORS_SRGB;
    for (uint32_t i = 0; i < material_count; i++) {
        char *name = add(scene, 16, 1);
        snprintf(name, 16, "m%u", i);
        scene->materials[i] = scene_material_default();
        scene->legacy->materials[i] = legacy_material_default();
        scene->materials[i].name = scene->legacy->materials[i].name = name;
    }
    return scene;
}

static scene_primitive *add_quad(facet_scene *scene, uint32_t mesh, uint32_t material)
{
    scene_mesh *m = &scene->meshes[mesh];
    scene_primitive *primitives = add(scene, m->primitive_count + 1, sizeof *primitives);
    if (m->primitive_count)
        memcpy(primitives, m->primitives, m->primitive_count * sizeof *primitives);
    const float **sets = add(scene, 1, sizeof *sets);
    sets[0] = UVS;
    primitives[m->primitive_count] = (scene_primitive){.mode = SCENE_TRIANGLES,
                                                       .vertex_count = 4,
                                                       .index_count = 6,
                                                       .indices = QUAD,
                                                       .positions = CORNERS,
                                                       .normals = NORMALS,
                                                       .texcoord_count = 1,
                                                       .texcoords = sets,
                                                       .material = material};
    m->primitives = primitives;
    return &primitives[m->primitive_count++];
}

/* Text of the OBJ file that a scene becomes; free() it. */
static char *save(const temporary_folder *folder, const facet_scene *scene, const facet_scene_save_desc *desc)
{
    facet_error error = {0};
    if (obj_save(scene, temporary_folder_file(folder, "out.obj"), "a test", desc, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return test_get(folder, "out.obj");
}

static void a_quad_is_written(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    facet_scene *scene = make_scene(1, 1);
    add_quad(scene, 0, 0);
    char *obj = save(&folder, scene, NULL);
    assert_string_equal(obj,
                        "# OBJ file written by a test\nmtllib out.mtl\nusemtl m0\n"
                        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 0.75\nvn 0 0 1\n"
                        "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\n");
    char *mtl = test_get(&folder, "out.mtl");
    assert_non_null(strstr(mtl, "newmtl m0\n"));
    free(obj);
    free(mtl);
    const facet_scene_save_desc flipped = {.has_flipped_texcoords = true};
    obj = save(&folder, scene, &flipped);
    assert_non_null(strstr(obj, "vt 0 1\nvt 1 1\nvt 1 0\nvt 0 0.25\n"));
    free(obj);
    scene_destroy(scene);
    temporary_folder_remove(&folder);
}

/* In the coordinates of the file, with the digits that floats lack. */
static void far_scenes_are_written_in_doubles(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    facet_scene *scene = make_scene(1, 1);
    scene_primitive *p = add_quad(scene, 0, 0);
    p->bounds_max[0] = p->bounds_max[1] = 1.0f;
    scene->nodes[0].translation[0] = 4526331.25;
    scene->nodes[0].translation[2] = -1e8 - 0.0625;
    assert_int_equal(scene_settle_origin(scene, NULL, NULL, NULL), FACET_OK);
    assert_true(scene->is_far);
    char *obj = save(&folder, scene, NULL);
    assert_non_null(strstr(obj, "\nv 4526331.25 0 -100000000.0625\nv 4526332.25 0 -100000000.0625\n"));
    assert_non_null(strstr(obj, "\nvt 0 0\n"));
    free(obj);
    scene_destroy(scene);
    temporary_folder_remove(&folder);
}

/* Names, transforms, reflections, lists of every mode, indices that continue from object to object, shared
 * values, unused vertices, primitives without a material. */
static void objects_follow_one_another(void **state)
{
    (void)state;
    static const uint32_t line[2] = {3, 0};
    static const uint32_t points[2] = {0, 2};
    temporary_folder folder;
    temporary_folder_create(&folder);
    facet_scene *scene = make_scene(4, 2);
    scene->nodes[0].name = "same";
    scene->nodes[1].name = "same";
    scene->nodes[2].name = "a\nb\\";
    scene->meshes[3].name = "of the mesh";
    scene->nodes[0].translation[1] = 0.1;
    scene->nodes[1].scale[0] = -2;
    add_quad(scene, 0, 1)->colors = COLORS;
    add_quad(scene, 1, 1);
    scene_primitive *p = add_quad(scene, 2, 0);
    p->mode = SCENE_LINES;
    p->indices = line;
    p->index_count = 2;
    p->normals = NULL;
    p = add_quad(scene, 3, SCENE_NONE);
    p->mode = SCENE_POINTS;
    p->indices = points;
    p->index_count = 2;
    p->texcoord_count = 0;
    p->normals = NULL;
    char *obj = save(&folder, scene, NULL);
    char green[TEXT_FLOAT_SIZE];
    text_shortest_float((float)srgb_encode(0.5), green);
    char expected[1024];
    snprintf(expected, sizeof expected,
             "# OBJ file written by a test\nmtllib out.mtl\no of the mesh\nv 0 0 0\nv 1 1 0\np 1\np 2\n"
             "o same\nusemtl m1\nv 0 0.1 0 1 0 0\nv 1 0.1 0 0 %s 0\nv 1 1.1 0 0 0 1\nv 0 1.1 0 1 1 1\n"
             "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 0.75\nvn 0 0 1\nf 3/1/1 4/2/1 5/3/1\nf 3/1/1 5/3/1 6/4/1\n"
             "o same_3\nv 0 0 0\nv -2 0 0\nv -2 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 0.75\nvn 0 0 1\n"
             "f 7/5/2 9/7/2 8/6/2\nf 7/5/2 10/8/2 9/7/2\n"
             "o a_b_\nusemtl m0\nv 0 0 0\nv 0 1 0\nvt 0 0\nvt 0 0.75\nl 12 11\n",
             green);
    assert_string_equal(obj, expected);
    free(obj);
    scene_destroy(scene);
    temporary_folder_remove(&folder);
}

/* Images in use are written by their own names where these are plain; existing files stay unchanged. */
static void images_are_written_beside_the_model(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    temporary_folder_put_png(&folder, "in/plain.png");
    temporary_folder_put_png(&folder, "in/not plain.png");
    temporary_folder_put_png(&folder, "in/taken.png");
    test_put_text(&folder, "taken.png", "another program's");
    test_put_text(
        &folder, "in/a.mtl",
        "newmtl m0\nmap_Kd plain.png\nmap_Ks not plain.png\nmap_Ke taken.png\nnewmtl m1\nmap_Kd gone.png\n");
    test_put_text(&folder, "in/a.obj", "mtllib a.mtl\nusemtl m0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    facet_scene *scene = NULL;
    assert_int_equal(obj_load(temporary_folder_file(&folder, "in/a.obj"), NULL, &scene, NULL), FACET_OK);
    const char *path = temporary_folder_file(&folder, "my model.obj");
    assert_int_equal(obj_save(scene, path, "a test", NULL, NULL), FACET_OK);
    char *mtl = test_get(&folder, "my model.mtl");
    assert_non_null(
        strstr(mtl, "map_Kd plain.png\nmap_Ks my model_image1.png\nmap_Ke my model_image2.png\n"));
    assert_non_null(strstr(mtl, "map_Kd gone.png\n"));
    free(mtl);
    char *taken = test_get(&folder, "taken.png");
    assert_string_equal(taken, "another program's");
    free(taken);
    /* Found again, in spite of the spaces; the existing image is not an input that would be replaced. */
    facet_scene *again = NULL;
    assert_int_equal(obj_load(path, NULL, &again, NULL), FACET_OK);
    assert_int_equal(again->image_count, 3);
    assert_int_equal(again->material_count, 2);
    assert_int_equal(mtl_count_warnings(again, "gone.png"), 1);
    const facet_scene_save_desc careful = {.keeps_inputs = true};
    assert_int_equal(obj_save(again, temporary_folder_file(&folder, "other.obj"), "a test", &careful, NULL),
                     FACET_OK);
    facet_error error = {0};
    assert_int_equal(obj_save(scene, temporary_folder_file(&folder, "in/a.obj"), "a test", &careful, &error),
                     FACET_ERROR_ARGUMENT); /* its MTL file is an input */
    char *mine = test_get(&folder, "in/a.mtl");
    assert_null(strstr(mine, "written by"));
    free(mine);
    scene_destroy(again);
    scene_destroy(scene);
    temporary_folder_remove(&folder);
}

/* Images of one texel each, all of them used: one material per image. */
static facet_scene *make_images(uint32_t count)
{
    static const unsigned char bytes[4] = {1, 2, 3, 4};
    facet_scene *scene = make_scene(1, count);
    add_quad(scene, 0, 0);
    scene->images = add(scene, count, sizeof *scene->images);
    scene->textures = add(scene, count, sizeof *scene->textures);
    scene->image_count = scene->texture_count = count;
    for (uint32_t i = 0; i < count; i++) {
        scene->images[i] = (scene_image){
            .name = "", .uri = "same.png", .mime_type = "image/png", .bytes = bytes, .size = sizeof bytes};
        scene->textures[i].name = "";
        scene->textures[i].image = i;
        scene->legacy->materials[i].maps[LEGACY_DIFFUSE_MAP].ref.texture = i;
    }
    return scene;
}

/* Pipes, which would never be read to their end, folders, links that lead nowhere: files of others. */
static void only_regular_files_are_opened(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    facet_scene *scene = make_images(3);
    scene->images[0].uri = "pipe.png";
    scene->images[1].uri = "link.png";
    scene->images[2].uri = "device.png";
    assert_int_equal(mkfifo(temporary_folder_file(&folder, "pipe.png"), 0600), 0);
    assert_int_equal(symlink("nowhere", temporary_folder_file(&folder, "link.png")), 0);
    assert_int_equal(symlink("/dev/zero", temporary_folder_file(&folder, "device.png")), 0);
    alarm(20); /* instead of waiting for ever */
    free(save(&folder, scene, NULL));
    alarm(0);
    char *mtl = test_get(&folder, "out.mtl");
    for (int i = 0; i < 3; i++) {
        char expected[64];
        snprintf(expected, sizeof expected, "map_Kd out_image%d.png\n", i);
        assert_non_null(strstr(mtl, expected));
    }
    free(mtl);
    scene_destroy(scene);
    for (const char *const *name = (const char *const[]){"pipe.png", "link.png", "device.png", NULL}; *name;
         name++)
        unlink(temporary_folder_file(&folder, *name));
    temporary_folder_remove(&folder);
}

static char *make_name(facet_scene *scene, const char *format, uint32_t number)
{
    char *name = add(scene, 48, 1);
    snprintf(name, 48, format, number);
    return name;
}

/* Names whose numbers are taken already: with all of them tried for each, this takes minutes. */
static void many_names_take_linear_time(void **state)
{
    (void)state;
    enum { HALF = 30000 };
    temporary_folder folder;
    temporary_folder_create(&folder);
    facet_scene *scene = make_scene(2 * HALF, 1);
    for (uint32_t i = 0; i < 2 * HALF; i++) {
        add_quad(scene, i, 0);
        scene->nodes[i].name = i < HALF ? make_name(scene, "a_%u", HALF + i) : "a";
    }
    facet_scene *images = make_images(2 * HALF);
    for (uint32_t i = 0; i < HALF; i++) /* "out_image0.png" .. and those that would take their place */
        images->images[i].uri = make_name(images, "OUT_image%u.png", i + HALF);
    clock_t start = clock();
    free(save(&folder, scene, NULL));
    obj_images named;
    const facet_scene_save_desc desc = {0};
    assert_true(obj_images_create(images, temporary_folder_file(&folder, "out.obj"), "out", &desc, &named));
    assert_true((double)(clock() - start) / CLOCKS_PER_SEC < 15.0);
    assert_string_equal(named.names[HALF], "same.png");
    char expected[48];
    snprintf(expected, sizeof expected, "out_image%d.png", 3 * HALF - 2);
    assert_string_equal(named.names[2 * HALF - 1], expected);
    obj_images_destroy(&named);
    scene_destroy(images);
    scene_destroy(scene);
    temporary_folder_remove(&folder);
}

/* The libraries and images of files whose names a statement cannot hold as they are. */
static void odd_names_round_trip(void **state)
{
    (void)state;
    static const char *const names[] = {" a.obj", "  .obj", "\"q\".obj", "\ta.obj", "a b.obj", ".obj"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        temporary_folder folder;
        temporary_folder_create(&folder);
        temporary_folder_put_png(&folder, "in.png");
        char *bytes = test_get(&folder, "in.png");
        struct stat status;
        assert_int_equal(stat(temporary_folder_file(&folder, "in.png"), &status), 0);
        facet_scene *scene = make_images(1);
        scene->images[0].uri = "not plain.png";
        scene->images[0].bytes = (const unsigned char *)bytes;
        scene->images[0].size = (size_t)status.st_size;
        facet_scene *again = NULL;
        assert_int_equal(obj_save(scene, temporary_folder_file(&folder, names[i]), "a test", NULL, NULL),
                         FACET_OK);
        assert_int_equal(obj_load(temporary_folder_file(&folder, names[i]), NULL, &again, NULL), FACET_OK);
        if (again->warning_count)
            fail_msg("%s: %s", names[i], again->warnings[0]);
        assert_int_equal(again->image_count, 1);
        scene_destroy(again);
        scene_destroy(scene);
        free(bytes);
        temporary_folder_remove(&folder);
    }
}

static void scenes_without_legacy_are_refused(void **state)
{
    (void)state;
    facet_scene *scene = make_scene(1, 0);
    scene->legacy = NULL;
    facet_error error = {0};
    assert_int_equal(obj_save(scene, "/tmp/never.obj", "a test", NULL, &error), FACET_ERROR_ARGUMENT);
    scene_destroy(scene);
}

static void failed_writes_leave_no_file(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    facet_scene *scene = make_scene(1, 1);
    add_quad(scene, 0, 0);
    assert_int_equal(obj_save(scene, temporary_folder_file(&folder, "none/out.obj"), "a test", NULL, NULL),
                     FACET_ERROR_WRITE);
    bool is_done = false;
    for (long fail_at = 0; !is_done; fail_at = next_failure(fail_at)) {
        assert_true(fail_at < 1000);
        failing_allocator f = {.fail_at = fail_at};
        const facet_scene_save_desc desc = {.allocator = failing_allocator_get(&f), .thread_count = 1};
        facet_result result =
            obj_save(scene, temporary_folder_file(&folder, "out.obj"), "a test", &desc, NULL);
        is_done = result == FACET_OK;
        assert_true(is_done || result == FACET_ERROR_MEMORY);
        assert_int_equal(atomic_load(&f.blocks), 0);
        FILE *file = fopen(temporary_folder_file(&folder, "out.obj"), "rb");
        assert_int_equal(file != NULL, is_done);
        if (file)
            fclose(file);
    }
    scene_destroy(scene);
    temporary_folder_remove(&folder);
}

/* ---- round trips ---- */

/* A v that came from an OBJ file, as 1 - v, is restored to the bit; others lose what 1 - v cannot represent:
 * v_tolerance. */
static void assert_same_primitive(const scene_primitive *a, const scene_primitive *b, double v_tolerance)
{
    assert_int_equal(a->mode, b->mode);
    assert_int_equal(a->index_count, b->index_count);
    assert_int_equal(a->material, b->material);
    assert_int_equal(a->texcoord_count, b->texcoord_count);
    assert_int_equal(a->normals != NULL, b->normals != NULL);
    assert_int_equal(a->colors != NULL, b->colors != NULL);
    /* Vertices may be numbered differently: the values at the corners are compared. */
    for (uint32_t i = 0; i < a->index_count; i++) {
        size_t m = a->indices[i];
        size_t n = b->indices[i];
        for (size_t k = 0; k < 3; k++)
            assert_near(a->positions[3 * m + k], b->positions[3 * n + k], 0);
        if (a->normals) /* the reader makes them unit once more, which moves them by units in the last place */
            for (size_t k = 0; k < 3; k++)
                assert_near(a->normals[3 * m + k], b->normals[3 * n + k], 2.5e-7);
        if (a->texcoord_count) {
            assert_near(a->texcoords[0][2 * m], b->texcoords[0][2 * n], 0);
            assert_near(a->texcoords[0][2 * m + 1], b->texcoords[0][2 * n + 1], v_tolerance);
        }
        for (size_t k = 0; k < 3 && a->colors; k++)
            assert_near(a->colors[4 * m + k], b->colors[4 * n + k], 1e-6);
    }
}

static void assert_same_scene(const facet_scene *a, const facet_scene *b)
{
    assert_int_equal(a->mesh_count, b->mesh_count);
    assert_int_equal(a->material_count, b->material_count);
    for (uint32_t i = 0; i < a->mesh_count; i++) {
        assert_int_equal(a->meshes[i].primitive_count, b->meshes[i].primitive_count);
        for (uint32_t k = 0; k < a->meshes[i].primitive_count; k++)
            assert_same_primitive(&a->meshes[i].primitives[k], &b->meshes[i].primitives[k], 0);
    }
    for (uint32_t i = 0; i < a->material_count; i++) {
        const legacy_material *m = &a->legacy->materials[i];
        const legacy_material *n = &b->legacy->materials[i];
        assert_string_equal(m->name[0] ? m->name : "material", n->name); /* faces without usemtl */
        assert_int_equal(m->fields | LEGACY_ILLUM, n->fields);
        assert_memory_equal(m->diffuse, n->diffuse, sizeof m->diffuse);
        assert_memory_equal(m->specular, n->specular, sizeof m->specular);
        assert_memory_equal(&m->shininess, &n->shininess, sizeof m->shininess);
        assert_memory_equal(&m->opacity, &n->opacity, sizeof m->opacity);
        for (int k = 0; k < LEGACY_MAP_COUNT; k++) {
            assert_int_equal(m->maps[k].path != NULL, n->maps[k].path != NULL);
            assert_int_equal(legacy_has_map(m, (legacy_map_slot)k), legacy_has_map(n, (legacy_map_slot)k));
            if (legacy_has_map(m, (legacy_map_slot)k)) { /* textures may have other numbers */
                const scene_image *x = &a->images[a->textures[m->maps[k].ref.texture].image];
                const scene_image *y = &b->images[b->textures[n->maps[k].ref.texture].image];
                assert_int_equal(x->size, y->size);
                assert_memory_equal(x->bytes, y->bytes, x->size);
            }
            assert_memory_equal(m->maps[k].ref.transform, n->maps[k].ref.transform, 6 * sizeof(float));
        }
    }
}

/* False: the file is one of those that cannot be read. */
static bool round_trip(const char *source, const char *name, void *context)
{
    const temporary_folder *folder = context;
    char path[1024];
    facet_scene *scene = NULL;
    facet_scene *again = NULL;
    facet_error error = {0};
    snprintf(path, sizeof path, "%s/%s", source, name);
    if (obj_load(path, NULL, &scene, NULL) != FACET_OK)
        return false;
    if (obj_save(scene, temporary_folder_file(folder, "out.obj"), "a test", NULL, &error) != FACET_OK ||
        obj_load(temporary_folder_file(folder, "out.obj"), NULL, &again, &error) != FACET_OK)
        fail_msg("%s: %s", path, error.message);
    assert_same_scene(scene, again);
    scene_destroy(again);
    scene_destroy(scene);
    return true;
}

static void real_files_round_trip(void **state)
{
    (void)state;
    const char *data = test_data();
    char path[1024];
    temporary_folder folder;
    temporary_folder_create(&folder);
    snprintf(path, sizeof path, "%s/obj", data);
    assert_true(test_visit_files(path, ".obj", round_trip, &folder) >= 35);
    temporary_folder_remove(&folder);
}

/* ---- speed and threads ---- */

/* A grid of many vertices: the same bytes from any number of threads. */
static void threads_change_nothing(void **state)
{
    (void)state;
    enum { EDGE = IS_SLOW ? 300 : 700 };
    temporary_folder folder;
    temporary_folder_create(&folder);
    facet_scene *scene = make_scene(1, 1);
    scene_primitive *p = add_quad(scene, 0, 0);
    float *positions = add(scene, EDGE * EDGE, 3 * sizeof *positions);
    float *normals = add(scene, EDGE * EDGE, 3 * sizeof *normals);
    float *uvs = add(scene, EDGE * EDGE, 2 * sizeof *uvs);
    uint32_t *indices = add(scene, (EDGE - 1) * (EDGE - 1) * 6, sizeof *indices);
    uint32_t *index = indices;
    for (uint32_t y = 0; y < EDGE; y++)
        for (uint32_t x = 0; x < EDGE; x++) {
            size_t i = y * EDGE + x;
            float u = (float)x / (EDGE - 1);
            float v = (float)y / (EDGE - 1);
            float h = 0.1f * sinf(20 * u) * cosf(15 * v);
            memcpy(positions + 3 * i, (const float[]){u, h, v}, 3 * sizeof(float));
            memcpy(uvs + 2 * i, (const float[]){u, v}, 2 * sizeof(float));
            float n[3] = {-2 * cosf(20 * u) * cosf(15 * v), 1, 1.5f * sinf(20 * u) * sinf(15 * v)};
            float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
            for (size_t k = 0; k < 3; k++)
                normals[3 * i + k] = n[k] / length;
            if (x + 1 < EDGE && y + 1 < EDGE) {
                const uint32_t at = y * EDGE + x;
                const uint32_t corners[6] = {at, at + EDGE, at + 1, at + 1, at + EDGE, at + EDGE + 1};
                memcpy(index, corners, sizeof corners);
                index += 6;
            }
        }
    const float **sets = add(scene, 1, sizeof *sets);
    sets[0] = uvs;
    p->positions = positions;
    p->normals = normals;
    p->texcoords = sets;
    p->indices = indices;
    p->vertex_count = EDGE * EDGE;
    p->index_count = (uint32_t)(index - indices);
    const facet_scene_save_desc one = {.thread_count = 1};
    const facet_scene_save_desc three = {.thread_count = 3};
    char *first = save(&folder, scene, &one);
    char *second = save(&folder, scene, &three);
    assert_string_equal(first, second);
    assert_true(strlen(first) > 100 * EDGE * EDGE);
    free(first);
    free(second);
    facet_scene *again = NULL;
    assert_int_equal(obj_load(temporary_folder_file(&folder, "out.obj"), NULL, &again, NULL), FACET_OK);
    assert_same_primitive(p, &again->meshes[0].primitives[0], 0x1p-24);
    scene_destroy(again);
    scene_destroy(scene);
    temporary_folder_remove(&folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_quad_is_written),
        cmocka_unit_test(far_scenes_are_written_in_doubles),
        cmocka_unit_test(objects_follow_one_another),
        cmocka_unit_test(images_are_written_beside_the_model),
        cmocka_unit_test(scenes_without_legacy_are_refused),
        cmocka_unit_test(failed_writes_leave_no_file),
        cmocka_unit_test(real_files_round_trip),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(only_regular_files_are_opened),
        cmocka_unit_test(many_names_take_linear_time),
        cmocka_unit_test(odd_names_round_trip),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
