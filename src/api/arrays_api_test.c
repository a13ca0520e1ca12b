/* Tests of scenes from arrays: the image of a scene from arrays is that of the same model in a file, arrays are copied, and bad
 * ones get one sentence. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"

enum { SIZE = 48, GRID = 5, VERTICES = GRID * GRID, INDICES = 6 * (GRID - 1) * (GRID - 1) };

/* ---- a model with a bit of everything ---- */

typedef struct model {
    float positions[VERTICES][3], normals[VERTICES][3], texcoords[VERTICES][2], colors[VERTICES][4];
    uint32_t indices[INDICES];
    uint8_t texels[8][8][4], bumps[4][4][3];
    facet_texture_desc textures[2];
    facet_material materials[3];
    uint32_t variant_materials[1];
    const char *variants[1];
    facet_primitive_desc hill[1], shapes[3];
    facet_mesh_desc meshes[2];
    facet_camera_desc cameras[2];
    facet_light_desc lights[2];
    float places[2][3], turns[2][4];
    double matrix[16];
    facet_node_desc nodes[5];
    facet_arrays_desc arrays;
} model;

static void make_hill(model *m)
{
    uint32_t *index = m->indices;
    for (int i = 0; i < VERTICES; i++) {
        float x = (float)(i % GRID) / (GRID - 1), z = (float)(i / GRID) / (GRID - 1);
        const float slope_x = 0.3f * cosf(3.0f * x), slope_z = 0.2f * cosf(2.0f * z);
        const float position[3] = {x, 0.1f * sinf(3.0f * x) + 0.1f * sinf(2.0f * z), z};
        const float normal[3] = {-slope_x, 1.0f, -slope_z}; /* not of length 1 */
        memcpy(m->positions[i], position, sizeof position);
        memcpy(m->normals[i], normal, sizeof normal);
        m->texcoords[i][0] = 2.0f * x;
        m->texcoords[i][1] = z;
        m->colors[i][0] = x;
        m->colors[i][1] = 0.5f;
        m->colors[i][2] = m->colors[i][3] = 1.0f;
    }
    for (uint32_t row = 0; row + 1 < GRID; row++)
        for (uint32_t column = 0; column + 1 < GRID; column++) {
            uint32_t a = row * GRID + column, b = a + GRID;
            const uint32_t corners[6] = {a, b, a + 1, a + 1, b, b + 1};
            memcpy(index, corners, sizeof corners);
            index += 6;
        }
    memset(m->normals[7], 0, sizeof m->normals[7]); /* to be filled from the triangles */
}

static void make_materials(model *m)
{
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++) {
            const uint8_t texel[4] = {(uint8_t)(30 * x), (uint8_t)(30 * y), 90, (uint8_t)(x % 2 ? 255 : 120)};
            memcpy(m->texels[y][x], texel, sizeof texel);
        }
    for (int i = 0; i < 16; i++) {
        const uint8_t bump[3] = {(uint8_t)(100 + 3 * i), (uint8_t)(140 - 2 * i), 250};
        memcpy(m->bumps[i / 4][i % 4], bump, sizeof bump);
    }
    m->textures[0] = (facet_texture_desc){.name = "checks",
                                          .pixels = m->texels,
                                          .width = 7, /* of 8: rows with padding */
                                          .height = 8,
                                          .channel_count = 4,
                                          .row_stride_bytes = sizeof m->texels[0],
                                          .wrap_u = FACET_WRAP_MIRROR,
                                          .wrap_v = FACET_WRAP_CLAMP,
                                          .mag_filter = FACET_TEXTURE_FILTER_NEAREST};
    m->textures[1] = (facet_texture_desc){.pixels = m->bumps, .width = 4, .height = 4, .channel_count = 3};
    for (int i = 0; i < 3; i++)
        m->materials[i] = facet_material_default();
    facet_material *first = &m->materials[0];
    first->name = "painted";
    first->metallic = 0.2f;
    first->perceptual_roughness = 0.4f;
    first->clearcoat = 0.7f;
    first->alpha_mode = FACET_ALPHA_MODE_BLEND;
    first->is_double_sided = true;
    first->textures[FACET_TEXTURE_SLOT_BASE_COLOR] =
        (facet_texture_use){.is_used = true, .offset = {0.1f, 0.2f}, .rotation_rad = 0.3f, .scale = {2, 1}};
    first->textures[FACET_TEXTURE_SLOT_NORMAL] = (facet_texture_use){.is_used = true, .texture = 1};
    m->materials[1].metallic = 0.0f;
    m->materials[1].transmission = 0.5f;
    m->materials[1].thickness = 0.2f;
    m->materials[1].attenuation_distance = 0.5f;
    m->materials[2].is_unlit = true;
    m->materials[2].base_color[1] = 0.2f;
}

static void make_meshes(model *m)
{
    const facet_primitive_desc whole = {.vertex_count = VERTICES,
                                        .positions = m->positions[0],
                                        .normals = m->normals[0],
                                        .texcoords = {m->texcoords[0]},
                                        .index_count = INDICES,
                                        .indices = m->indices,
                                        .has_material = true,
                                        .variant_materials = m->variant_materials};
    m->variant_materials[0] = 2;
    m->variants[0] = "flat color";
    m->hill[0] = whole;
    m->shapes[0] = whole; /* flat triangles with vertex colors */
    m->shapes[0].normals = NULL;
    m->shapes[0].colors = m->colors[0];
    m->shapes[0].material = 1;
    m->shapes[0].variant_materials = NULL;
    m->shapes[1] = (facet_primitive_desc){.mode = FACET_PRIMITIVE_MODE_LINES,
                                          .vertex_count = VERTICES - 1,
                                          .positions = m->positions[0],
                                          .has_material = true,
                                          .material = 2};
    m->shapes[2] = (facet_primitive_desc){
        .mode = FACET_PRIMITIVE_MODE_POINTS, .vertex_count = VERTICES, .positions = m->positions[0]};
    m->meshes[0] = (facet_mesh_desc){"hill", 1, m->hill};
    m->meshes[1] = (facet_mesh_desc){"shapes", 3, m->shapes};
}

static void make_nodes(model *m)
{
    const double matrix[16] = {0.8, 0.1, 0, 0, 0, 1, 0, 0, 0, 0.2, 1.2, 0, -1.5, 0.3, 0.2, 1};
    const float places[2][3] = {{0.2f, 0.4f, 0}, {1.3f, 0, 0.4f}},
                turns[2][4] = {{0, 2, 0, 2}, {0.1f, 0, 0, 1}};
    memcpy(m->matrix, matrix, sizeof matrix);
    memcpy(m->places, places, sizeof places);
    memcpy(m->turns, turns, sizeof turns);
    m->cameras[0] = (facet_camera_desc){.name = "front", .fov_y_rad = 0.7f, .near_m = 0.1f, .far_m = 100};
    m->cameras[1] = (facet_camera_desc){.ortho_height = 3.0f, .aspect = 1.5f, .near_m = 0.1f, .far_m = 9};
    m->lights[0] = (facet_light_desc){.intensity = 2.0f};
    m->lights[1] = (facet_light_desc){
        .type = FACET_LIGHT_TYPE_SPOT, .color = {1, 0.5f, 0.2f}, .intensity = 9.0f, .outer_cone_rad = 0.6f};
    m->nodes[0] = (facet_node_desc){.name = "root", .rotation = {0, 0.3f, 0, 1}, .has_light = true};
    m->nodes[1] =
        (facet_node_desc){.name = "hill", .has_parent = true, .matrix = m->matrix, .has_mesh = true};
    m->nodes[2] = (facet_node_desc){.name = "shapes",
                                    .has_parent = true,
                                    .scale = {1, 1.5f, 1},
                                    .has_mesh = true,
                                    .mesh = 1,
                                    .instance_count = 2,
                                    .instance_translations = m->places[0],
                                    .instance_rotations = m->turns[0]};
    m->nodes[3] = (facet_node_desc){
        .name = "eye", .translation = {0.2, 1, 4}, .has_camera = true, .has_light = true, .light = 1};
    m->nodes[4] = (facet_node_desc){.name = "hidden", .is_hidden = true, .has_mesh = true};
}

static void make_model(model *m)
{
    memset(m, 0, sizeof *m);
    make_hill(m);
    make_materials(m);
    make_meshes(m);
    make_nodes(m);
    m->arrays = (facet_arrays_desc){.name = "model",
                                    .texture_count = 2,
                                    .material_count = 3,
                                    .variant_count = 1,
                                    .mesh_count = 2,
                                    .camera_count = 2,
                                    .light_count = 2,
                                    .node_count = 5,
                                    .textures = m->textures,
                                    .materials = m->materials,
                                    .variants = m->variants,
                                    .meshes = m->meshes,
                                    .cameras = m->cameras,
                                    .lights = m->lights,
                                    .nodes = m->nodes};
}

/* ---- images ---- */

static void draw(const facet_scene *scene, bool has_variant, facet_renderer_kind renderer, float *pixels)
{
    facet_image *image = NULL;
    facet_environment *light = NULL;
    const float white[3] = {1, 1, 1};
    assert_int_equal(facet_environment_create_constant(white, NULL, &light, NULL), FACET_OK);
    facet_camera camera;
    assert_int_equal(facet_camera_from_scene(scene, NULL, 0, &camera, NULL), FACET_OK);
    const facet_render_desc desc = {.width = SIZE,
                                    .height = SIZE,
                                    .camera = &camera,
                                    .environment = light,
                                    .pose = {.has_variant = has_variant},
                                    .renderer = renderer,
                                    .samples = 2};
    assert_int_equal(facet_render(scene, &desc, &image, NULL), FACET_OK);
    memcpy(pixels, facet_image_get_layer(image, 0).pixels, sizeof(float[SIZE][SIZE][4]));
    facet_image_destroy(image);
    facet_environment_destroy(light);
}

static void check_equal_images(const facet_scene *a, const facet_scene *b)
{
    static float first[SIZE * SIZE * 4], second[SIZE * SIZE * 4];
    for (int i = 0; i < 3; i++) {
        facet_renderer_kind kind = i == 2 ? FACET_RENDERER_KIND_PATH : FACET_RENDERER_KIND_PREVIEW;
        draw(a, i == 1, kind, first);
        draw(b, i == 1, kind, second);
        assert_memory_equal(first, second, sizeof first);
    }
}

static void an_image_is_that_of_the_same_file(void **state)
{
    (void)state;
    static model m;
    temporary_folder folder;
    temporary_folder_create(&folder);
    facet_scene *scene = NULL, *read = NULL;
    facet_error error;
    make_model(&m);
    if (facet_scene_create(&m.arrays, NULL, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    const char *path = temporary_folder_file(&folder, "model.glb");
    assert_int_equal(facet_scene_save(scene, path, NULL, NULL), FACET_OK);
    assert_int_equal(facet_scene_load(path, NULL, &read, NULL), FACET_OK);
    check_equal_images(scene, read);

    facet_scene_counts counts = facet_scene_get_counts(scene), others = facet_scene_get_counts(read);
    assert_memory_equal(&counts, &others, sizeof counts);
    float low[3], high[3], other_low[3], other_high[3];
    assert_true(facet_scene_get_bounds(scene, NULL, low, high));
    assert_true(facet_scene_get_bounds(read, NULL, other_low, other_high));
    assert_memory_equal(low, other_low, sizeof low);
    assert_memory_equal(high, other_high, sizeof high);
    facet_scene_destroy(read);
    facet_scene_destroy(scene);
    temporary_folder_remove(&folder);
}

static void arrays_are_copied(void **state)
{
    (void)state;
    static model m, again;
    facet_scene *scene = NULL, *other = NULL;
    make_model(&m);
    make_model(&again);
    assert_int_equal(facet_scene_create(&m.arrays, NULL, &scene, NULL), FACET_OK);
    memset(&m, 0xff, sizeof m);
    assert_int_equal(facet_scene_create(&again.arrays, NULL, &other, NULL), FACET_OK);
    check_equal_images(scene, other);
    facet_scene_destroy(scene);
    facet_scene_destroy(other);
}

static void meshes_without_nodes_are_at_the_origin(void **state)
{
    (void)state;
    static model m;
    make_model(&m);
    facet_scene *scene = NULL;
    m.arrays.node_count = 0;
    assert_int_equal(facet_scene_create(&m.arrays, NULL, &scene, NULL), FACET_OK);
    assert_int_equal(facet_scene_get_counts(scene).instances, 4);
    facet_scene_destroy(scene);
    assert_int_equal(facet_scene_create(&(facet_arrays_desc){0}, NULL, &scene, NULL), FACET_OK);
    assert_int_equal(facet_scene_get_counts(scene).instances, 0);
    facet_scene_destroy(scene);
}

/* ---- bad arrays ---- */

/* facet_scene_create() fails with result and a message that has both words. */
static void check_refused(const model *m, facet_result result, const char *place, const char *reason)
{
    facet_scene *scene = NULL;
    facet_error error = {0};
    assert_int_equal(facet_scene_create(&m->arrays, NULL, &scene, &error), result);
    assert_null(scene);
    if (!strstr(error.message, place) || !strstr(error.message, reason))
        fail_msg("\"%s\" has no \"%s\" or no \"%s\"", error.message, place, reason);
}

#define REFUSED(change, result, place, reason)                                                               \
    do {                                                                                                     \
        make_model(&m);                                                                                      \
        change;                                                                                              \
        check_refused(&m, result, place, reason);                                                            \
    } while (0)

static void bad_meshes_are_refused(void **state)
{
    (void)state;
    static model m;
    const facet_result bad = FACET_ERROR_ARGUMENT;
    REFUSED(m.positions[3][1] = NAN, bad, "model: meshes[0].primitives[0].positions", "number 10 is nan");
    REFUSED(m.positions[3][1] = 1e30f, bad, "positions", "1e+30");
    REFUSED(m.normals[0][0] = INFINITY, bad, "normals", "inf");
    REFUSED(m.texcoords[1][0] = NAN, bad, "texcoords[0]", "nan");
    REFUSED(m.colors[1][0] = NAN, bad, "meshes[1].primitives[0].colors", "nan");
    REFUSED(m.indices[4] = VERTICES, bad, "indices", "number 4 is 25, but there are 25 vertices");
    REFUSED(m.hill[0].index_count -= 1, bad, "index_count", "a multiple of 3");
    REFUSED(m.hill[0].indices = NULL, bad, "indices", "is NULL");
    REFUSED(m.hill[0].positions = NULL, bad, "positions", "is NULL");
    REFUSED(m.hill[0].vertex_count = 0, bad, "positions", "empty");
    REFUSED(m.hill[0].index_count = 0, bad, "indices", "is empty");
    REFUSED(m.shapes[1].vertex_count = 7, bad, "meshes[1].primitives[1].vertex_count", "a multiple of 2");
    REFUSED(m.shapes[1].mode = (facet_primitive_mode)7, bad, "mode", "7");
    REFUSED(m.hill[0].material = 3, bad, "material", "is 3, but there are 3 materials");
    REFUSED(m.variant_materials[0] = 9, bad, "variant_materials", "is 9");
    REFUSED(m.arrays.meshes = NULL, bad, "meshes", "is NULL, but its count is 2");
    REFUSED(m.meshes[1].primitives = NULL, bad, "meshes[1].primitives", "is NULL");
}

static void bad_materials_are_refused(void **state)
{
    (void)state;
    static model m;
    const facet_result bad = FACET_ERROR_ARGUMENT;
    REFUSED(m.materials[1].metallic = 2, bad, "materials[1].metallic", "is 2, but must lie in [0, 1]");
    REFUSED(m.materials[1].base_color[2] = NAN, bad, "base_color", "nan");
    REFUSED(m.materials[1].ior = 0.5f, bad, "ior", "0.5");
    REFUSED(m.materials[1].attenuation_distance = 0, bad, "attenuation_distance", "above 0");
    REFUSED(m.materials[0].textures[0].texture = 5, bad, "textures[0].texture", "is 5");
    REFUSED(m.materials[0].textures[0].offset[1] = NAN, bad, "offset", "nan");
    REFUSED(m.materials[0].alpha_mode = (facet_alpha_mode)5, bad, "alpha_mode", "5");
    REFUSED(m.textures[0].channel_count = 5, bad, "textures[0].channel_count", "1 to 4");
    REFUSED(m.textures[0].width = 0, bad, "textures[0]", "0 x 8");
    REFUSED(m.textures[0].row_stride_bytes = 8, bad, "row_stride_bytes", "28 bytes");
    REFUSED(m.textures[0].pixels = NULL, bad, "textures[0]", "neither bytes nor pixels");
    REFUSED(m.textures[1].wrap_v = (facet_wrap)4, bad, "textures[1]", "wrap mode");
    REFUSED((m.textures[1].bytes = "text", m.textures[1].size = 4), FACET_ERROR_INVALID, "textures[1].bytes",
            "is no PNG");
}

static void bad_nodes_are_refused(void **state)
{
    (void)state;
    static model m;
    const facet_result bad = FACET_ERROR_ARGUMENT;
    REFUSED(m.nodes[1].parent = 1, bad, "nodes[1].parent", "before their children");
    REFUSED(m.nodes[1].mesh = 2, bad, "nodes[1].mesh", "is 2, but there are 2 meshes");
    REFUSED(m.nodes[3].camera = 2, bad, "nodes[3].camera", "cameras");
    REFUSED(m.nodes[3].light = 2, bad, "nodes[3].light", "lights");
    REFUSED(m.matrix[3] = 1, bad, "nodes[1].matrix", "0 0 0 1");
    REFUSED(m.matrix[5] = (double)NAN, bad, "nodes[1].matrix", "nan");
    REFUSED(m.nodes[0].translation[2] = (double)INFINITY, bad, "translation", "inf");
    REFUSED(m.places[1][0] = NAN, bad, "instance_translations", "number 3 is nan");
    REFUSED(m.turns[1][0] = NAN, bad, "instance_rotations", "nan");
    REFUSED(m.cameras[0].fov_y_rad = 4, bad, "cameras[0].fov_y_rad", "3.14");
    REFUSED(m.cameras[1].ortho_height = 0, bad, "cameras[1]", "ortho_height");
    REFUSED(m.cameras[1].far_m = 0.05f, bad, "cameras[1].far_m", "near_m");
    REFUSED(m.lights[1].intensity = -1, bad, "lights[1]", "-1");
    REFUSED(m.lights[1].inner_cone_rad = 1, bad, "lights[1].inner_cone_rad", "in order");
    REFUSED(m.lights[1].type = (facet_light_type)3, bad, "lights[1].type", "3");
}

static void lack_of_memory_leaks_nothing(void **state)
{
    (void)state;
    static model m;
    facet_result result = FACET_ERROR_MEMORY;
    make_model(&m);
    for (long n = 0; result == FACET_ERROR_MEMORY; n = next_failure(n)) {
        failing_allocator memory = {.fail_at = n};
        facet_scene *scene = NULL;
        facet_error error;
        const facet_scene_desc desc = {.allocator = failing_allocator_get(&memory), .thread_count = 1};
        result = facet_scene_create(&m.arrays, &desc, &scene, &error);
        assert_true(result == FACET_OK || result == FACET_ERROR_MEMORY);
        facet_scene_destroy(scene);
        assert_int_equal(memory.blocks, 0);
    }
}

static void limits_and_missing_texcoords_are_reported(void **state)
{
    (void)state;
    static model m;
    facet_scene *scene = NULL;
    facet_error error;
    captured_messages messages = {0};
    make_model(&m);
    const facet_scene_desc small = {.max_texture_size = 4};
    assert_int_equal(facet_scene_create(&m.arrays, &small, &scene, &error), FACET_ERROR_LIMIT);
    assert_non_null(strstr(error.message, "model: textures[0]"));
    assert_non_null(strstr(error.message, "7 x 8 texels; at most 4"));
    m.hill[0].texcoords[0] = NULL;
    const facet_scene_desc loud = {.log = capture_log(&messages)};
    assert_int_equal(facet_scene_create(&m.arrays, &loud, &scene, &error), FACET_OK);
    assert_non_null(strstr(messages.text, "meshes[0].primitives[0]"));
    facet_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_image_is_that_of_the_same_file),
        cmocka_unit_test(arrays_are_copied),
        cmocka_unit_test(meshes_without_nodes_are_at_the_origin),
        cmocka_unit_test(bad_meshes_are_refused),
        cmocka_unit_test(bad_materials_are_refused),
        cmocka_unit_test(bad_nodes_are_refused),
        cmocka_unit_test(lack_of_memory_leaks_nothing),
        cmocka_unit_test(limits_and_missing_texcoords_are_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
