/* gltf_twins_test.c - compressed models draw the very triangles of their uncompressed twins. */
#include "io/gltf/gltf_test_support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "io/gltf/meshopt.h"

/* ---- files ---- */

/* The whole of a file; NULL: it is not there. */
static unsigned char *read_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    const size_t room = 1 << 20;
    if (!file)
        return NULL;
    unsigned char *bytes = malloc(room);
    assert_non_null(bytes);
    assert_true(fread(bytes, 1, room, file) < room);
    fclose(file);
    return bytes;
}

static facet_scene *load_file(const char *path)
{
    facet_scene *scene = NULL;
    facet_error error = {0};
    if (gltf_load(path, NULL, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return scene;
}

static facet_scene *load_sail(const char *kind)
{
    char path[128];
    snprintf(path, sizeof path, "src/io/testdata/sail%s.glb", kind);
    return load_file(path);
}

/* A model of the shared data, or NULL. */
static const char *data_path(char *out, size_t size, const char *name)
{
    const char *data = getenv("FACET_TEST_DATA");
    snprintf(out, size, "%s/models/%s", data ? data : "", name);
    FILE *file = data ? fopen(out, "rb") : NULL;
    if (!file) {
        printf("skip: no FACET_TEST_DATA with models/%s\n", name);
        return NULL;
    }
    fclose(file);
    return out;
}

/* ---- triangles, whatever the order of vertices and faces ---- */

enum { MAX_VALUES = 64 };

typedef struct triangle_list {
    float *values; /* per triangle three times value_count */
    size_t triangle_count, value_count;
} triangle_list;

static size_t put_values(float *out, size_t at, const float *array, size_t vertex, size_t count)
{
    assert_true(at + count <= MAX_VALUES);
    for (size_t k = 0; array && k < count; k++)
        out[at + k] = array[vertex * count + k];
    return at + (array ? count : 0);
}

/* Writes all attributes of a vertex; returns their number of floats. */
static size_t vertex_values(const scene_primitive *p, size_t vertex, float out[MAX_VALUES])
{
    size_t count = put_values(out, 0, p->positions, vertex, 3);
    count = put_values(out, count, p->normals, vertex, 3);
    count = put_values(out, count, p->tangents, vertex, 4);
    count = put_values(out, count, p->colors, vertex, 4);
    for (uint32_t i = 0; i < p->texcoord_count; i++)
        count = put_values(out, count, p->texcoords[i], vertex, 2);
    for (uint32_t i = 0; i < p->influence_count; i++) {
        assert_true(count + 2 <= MAX_VALUES);
        out[count++] = p->joints[vertex * p->influence_count + i];
        out[count++] = p->weights[vertex * p->influence_count + i];
    }
    return count;
}

static size_t compared_bytes; /* of a triangle, for qsort() */

static int compare_triangles(const void *a, const void *b)
{
    return memcmp(a, b, compared_bytes);
}

static int compare_vertices(const void *a, const void *b)
{
    return memcmp(a, b, compared_bytes / 3);
}

/* The triangles of a primitive, each turned so that its least vertex is first, sorted. */
static triangle_list list_triangles(const scene_primitive *p)
{
    float vertex[MAX_VALUES];
    triangle_list t = {.triangle_count = p->index_count / 3, .value_count = vertex_values(p, 0, vertex)};
    const size_t n = t.value_count;
    t.values = malloc(3 * n * t.triangle_count * sizeof *t.values);
    assert_non_null(t.values);
    compared_bytes = 3 * n * sizeof(float);
    for (size_t i = 0; i < t.triangle_count; i++) {
        float corners[3][MAX_VALUES];
        for (int k = 0; k < 3; k++)
            vertex_values(p, p->indices[3 * i + (size_t)k], corners[k]);
        int first = 0;
        for (int k = 1; k < 3; k++)
            first = compare_vertices(corners[k], corners[first]) < 0 ? k : first;
        for (int k = 0; k < 3; k++)
            memcpy(t.values + (3 * i + (size_t)k) * n, corners[(first + k) % 3], n * sizeof(float));
    }
    qsort(t.values, t.triangle_count, compared_bytes, compare_triangles);
    return t;
}

static void assert_same_triangles(const scene_primitive *a, const scene_primitive *b)
{
    triangle_list first = list_triangles(a);
    triangle_list second = list_triangles(b);
    assert_int_equal(first.triangle_count, second.triangle_count);
    assert_int_equal(first.value_count, second.value_count);
    assert_true(first.triangle_count > 0);
    assert_memory_equal(first.values, second.values,
                        3 * first.value_count * first.triangle_count * sizeof(float));
    free(first.values);
    free(second.values);
}

static void assert_same_meshes(const facet_scene *a, const facet_scene *b)
{
    assert_int_equal(a->mesh_count, b->mesh_count);
    for (uint32_t i = 0; i < a->mesh_count; i++) {
        assert_int_equal(a->meshes[i].primitive_count, b->meshes[i].primitive_count);
        for (uint32_t k = 0; k < a->meshes[i].primitive_count; k++)
            assert_same_triangles(&a->meshes[i].primitives[k], &b->meshes[i].primitives[k]);
    }
}

/* ---- twins ---- */

/* has_targets: morph targets are outside of the bitstream, and vertices in their order. */
static void check_sail(const char *kind, bool has_targets)
{
    facet_scene *plain = load_sail("");
    facet_scene *twin = load_sail(kind);
    assert_int_equal(plain->meshes[0].primitives[0].index_count, 6 * 36);
    assert_int_equal(plain->meshes[0].primitives[1].index_count, 3 * 12);
    assert_same_meshes(plain, twin);
    assert_int_equal(plain->meshes[0].primitives[0].influence_count, 4);
    const scene_primitive *a = first_primitive(plain);
    const scene_primitive *b = first_primitive(twin);
    assert_int_equal(b->target_count, has_targets);
    if (has_targets)
        assert_memory_equal(a->targets[0].positions, b->targets[0].positions,
                            3 * a->vertex_count * sizeof(float));
    for (uint32_t i = 0; i < twin->warning_count; i++)
        fail_msg("%s", twin->warnings[i]);
    scene_destroy(plain);
    scene_destroy(twin);
}

static void sail_by_ext_meshopt(void **state)
{
    (void)state;
    check_sail("_meshopt_ext", true);
}

static void sail_by_khr_meshopt(void **state)
{
    (void)state;
    check_sail("_meshopt_khr", true);
}

#ifdef HAVE_DRACO
static void sail_by_draco_in_order(void **state)
{
    (void)state;
    check_sail("_draco_sequential", true);
}

static void sail_by_draco_edgebreaker(void **state)
{
    (void)state;
    check_sail("_draco_edgebreaker", false);
}

/* Primitives of two meshes that name one bitstream share its arrays. */
static void a_bitstream_is_decoded_once(void **state)
{
    (void)state;
    facet_scene *scene = load_sail("_draco_sequential");
    const scene_primitive *a = &scene->meshes[0].primitives[0];
    const scene_primitive *b = &scene->meshes[1].primitives[0];
    assert_ptr_equal(a->positions, b->positions);
    assert_ptr_equal(a->indices, b->indices);
    scene_destroy(scene);
}

static void the_box_of_draco(void **state)
{
    (void)state;
    char plain_path[512];
    char path[512];
    if (!data_path(path, sizeof path, "extensions/Box_Draco.glb") ||
        !data_path(plain_path, sizeof plain_path, "core/Box.glb"))
        skip();
    facet_scene *plain = load_file(plain_path);
    facet_scene *twin = load_file(path);
    /* positions in 11 or more bits: the corners of a cube are whole steps; normals octahedral, exact on
     * the axes */
    const scene_primitive *a = first_primitive(plain);
    const scene_primitive *b = first_primitive(twin);
    assert_int_equal(a->index_count, b->index_count);
    assert_int_equal(a->vertex_count, b->vertex_count);
    for (uint32_t i = 0; i < a->index_count; i++) { /* each corner of one is a corner of the other */
        bool is_found = false;
        for (uint32_t k = 0; k < b->index_count; k++) {
            float distance = 0.0f;
            for (uint32_t c = 0; c < 3; c++)
                distance += fabsf(a->positions[3 * a->indices[i] + c] - b->positions[3 * b->indices[k] + c]) +
                            fabsf(a->normals[3 * a->indices[i] + c] - b->normals[3 * b->indices[k] + c]);
            is_found |= distance < 2e-3f;
        }
        assert_true(is_found);
    }
    scene_destroy(plain);
    scene_destroy(twin);
}
#endif

static void the_box_of_meshopt(void **state)
{
    (void)state;
    char plain_path[512];
    char path[512];
    if (!data_path(path, sizeof path, "extensions/BoxMeshopt.glb") ||
        !data_path(plain_path, sizeof plain_path, "core/Box.glb"))
        skip();
    facet_scene *plain = load_file(plain_path);
    facet_scene *twin = load_file(path);
    const scene_primitive *p = first_primitive(twin);
    assert_int_equal(p->index_count, first_primitive(plain)->index_count);
    assert_int_equal(p->vertex_count, first_primitive(plain)->vertex_count);
    scene_pose plain_pose = {0};
    scene_pose pose = {0};
    assert_int_equal(scene_pose_create(plain, NULL, NULL, 1, &plain_pose, NULL), FACET_OK);
    assert_int_equal(scene_pose_create(twin, NULL, NULL, 1, &pose, NULL), FACET_OK);
    /* quantised to 14 bits of the box */
    assert_floats(pose.bounds_min, plain_pose.bounds_min, 3, 1.0 / 8192);
    assert_floats(pose.bounds_max, plain_pose.bounds_max, 3, 1.0 / 8192);
    scene_pose_destroy(&plain_pose);
    scene_pose_destroy(&pose);
    scene_destroy(plain);
    scene_destroy(twin);
}

/* ---- the streams of MeshoptCubeTest, all modes and filters, beside their uncompressed fallback ---- */

static const char EXTENSION[] = "KHR_meshopt_compression";

static size_t get_size(const json_t *object, const char *key)
{
    return (size_t)json_integer_value(json_object_get(object, key));
}

static int find_word(const char *word, const char *const *words)
{
    int i = 0;
    while (words[i] && word && strcmp(words[i], word) != 0)
        i++;
    return word ? i : 0;
}

/* Whether two views of size bytes are the same, but for the 1 that rounding in filters may change (units:
 * bytes of a component; 4: exact). */
static bool are_close(const uint8_t *a, const uint8_t *b, size_t size, size_t unit)
{
    bool is_close = unit < 4 || memcmp(a, b, size) == 0;
    for (size_t i = 0; unit < 4 && i < size; i += unit) {
        int difference = unit == 1 ? a[i] - b[i] : (a[i] | a[i + 1] << 8) - (b[i] | b[i + 1] << 8);
        is_close &= abs(difference) <= 1 || abs(difference) == (unit == 1 ? 255 : 65535);
    }
    return is_close;
}

/* Whether the triangles are the same, though they may begin at other corners. */
static bool are_turned(const uint8_t *a, const uint8_t *b, size_t triangle_count, size_t stride)
{
    bool is_same = true;
    for (size_t i = 0; i < triangle_count; i++) {
        const uint8_t *of_a = a + 3 * stride * i;
        uint8_t twice[2 * 3 * 4];
        bool is_found = false;
        memcpy(twice, b + 3 * stride * i, 3 * stride);
        memcpy(twice + 3 * stride, b + 3 * stride * i, 3 * stride);
        for (size_t k = 0; k < 3; k++)
            is_found |= memcmp(of_a, twice + k * stride, 3 * stride) == 0;
        is_same &= is_found;
    }
    return is_same;
}

static void check_view(const json_t *view, const uint8_t *const *buffers)
{
    static const char *const modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES", NULL};
    static const char *const filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR", NULL};
    const json_t *e = json_object_get(json_object_get(view, "extensions"), EXTENSION);
    if (!e)
        return;
    meshopt_stream s = {
        .bytes = buffers[get_size(e, "buffer")] + get_size(e, "byteOffset"),
        .size = get_size(e, "byteLength"),
        .mode = (meshopt_mode)find_word(json_string_value(json_object_get(e, "mode")), modes),
        .filter = (meshopt_filter)find_word(json_string_value(json_object_get(e, "filter")), filters),
        .count = get_size(e, "count"),
        .stride = get_size(e, "byteStride")};
    uint8_t *decoded = malloc(s.count * s.stride);
    assert_non_null(decoded);
    assert_null(meshopt_check(&s));
    assert_null(meshopt_decode(&s, decoded));
    const uint8_t *fallback = buffers[get_size(view, "buffer")] + get_size(view, "byteOffset");
    const bool is_rounded = s.filter != MESHOPT_NONE && s.filter != MESHOPT_EXPONENTIAL;
    if (s.mode == MESHOPT_TRIANGLES)
        assert_true(are_turned(decoded, fallback, s.count / 3, s.stride));
    else
        assert_true(are_close(decoded, fallback, s.count * s.stride, is_rounded ? s.stride / 4 : 4));
    free(decoded);
}

static void streams_decode_to_their_fallback(void **state)
{
    (void)state;
    char path[512];
    if (!data_path(path, sizeof path, "extensions/MeshoptCubeTest/MeshoptCubeTest.gltf"))
        skip();
    facet_scene *scene = NULL;
    assert_int_equal(gltf_load(path, NULL, &scene, NULL), FACET_OK); /* all its streams are in use */
    scene_destroy(scene);
    json_t *json = json_load_file(path, 0, NULL);
    unsigned char *buffers[2];
    data_path(path, sizeof path, "extensions/MeshoptCubeTest/MeshoptCubeTest.bin");
    buffers[0] = read_file(path);
    data_path(path, sizeof path, "extensions/MeshoptCubeTest/MeshoptCubeTestFallback.bin");
    buffers[1] = read_file(path);
    size_t i;
    json_t *view;
    json_array_foreach(json_object_get(json, "bufferViews"), i, view)
        check_view(view, (const uint8_t *const *)buffers);
    free(buffers[0]);
    free(buffers[1]);
    json_decref(json);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sail_by_ext_meshopt),         cmocka_unit_test(sail_by_khr_meshopt),
#ifdef HAVE_DRACO
        cmocka_unit_test(sail_by_draco_in_order),      cmocka_unit_test(sail_by_draco_edgebreaker),
        cmocka_unit_test(a_bitstream_is_decoded_once), cmocka_unit_test(the_box_of_draco),
#endif
        cmocka_unit_test(the_box_of_meshopt),          cmocka_unit_test(streams_decode_to_their_fallback),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
