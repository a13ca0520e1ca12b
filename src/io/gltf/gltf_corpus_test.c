/* gltf_corpus_test.c - real models and broken ones from the shared test data: which load, which are
 * refused; cut off anywhere; out of memory anywhere. Skips where there is no test data. */
#define _XOPEN_SOURCE 700
#include "io/gltf/gltf_test_support.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/text.h"

static const char *data_folder(void)
{
    const char *folder = getenv("FACET_TEST_DATA");
    return folder && access(folder, R_OK) == 0 ? folder : NULL;
}

/* ---- lists of files ---- */

typedef struct file_list {
    char *paths[1024];
    size_t count;
} file_list;

static file_list *list; /* nftw() carries no context */

static int add_file(const char *path, const struct stat *status, int type, struct FTW *where)
{
    (void)status;
    (void)where;
    const char *extension = path_extension(path);
    if (type == FTW_F && (strcmp(extension, "glb") == 0 || strcmp(extension, "gltf") == 0) &&
        list->count < 1024)
        list->paths[list->count++] = strdup(path);
    return 0;
}

static int compare_paths(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* All models below a folder of the test data, by name. */
static file_list *find_files(const char *folder)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", data_folder(), folder);
    list = calloc(1, sizeof *list);
    assert_non_null(list);
    nftw(path, add_file, 16, FTW_PHYS);
    qsort(list->paths, list->count, sizeof *list->paths, compare_paths);
    if (list->count == 0)
        fail_msg("%s holds no models", path);
    return list;
}

static void free_files(file_list *files)
{
    for (size_t i = 0; i < files->count; i++)
        free(files->paths[i]);
    free(files);
}

/* ---- using a scene ---- */

/* Reads all data that a renderer reads. */
static void use(const facet_scene *scene)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++) {
            const scene_primitive *p = &scene->meshes[i].primitives[k];
            for (uint32_t j = 0; j < p->index_count; j++) {
                assert_true(p->indices[j] < p->vertex_count);
                size_t vertex = p->indices[j];
                sum += (double)p->positions[3 * vertex] +
                       (p->normals ? (double)p->normals[3 * vertex + 2] : 0.0) +
                       (p->tangents ? (double)p->tangents[4 * vertex + 3] : 0.0) +
                       (p->colors ? (double)p->colors[4 * vertex + 3] : 0.0);
                for (uint32_t set = 0; set < p->texcoord_count; set++)
                    sum += (double)p->texcoords[set][2 * vertex + 1];
                for (uint32_t n = 0; n < p->influence_count; n++)
                    sum += (double)p->weights[p->influence_count * vertex + n];
                for (uint32_t n = 0; n < p->target_count; n++)
                    sum += p->targets[n].positions ? (double)p->targets[n].positions[3 * vertex] : 0.0;
            }
            if (p->mode == SCENE_TRIANGLES && p->index_count)
                assert_non_null(p->normals);
        }
    assert_true(sum == sum);
    for (uint32_t i = 0; i < scene->animation_count; i++) {
        const facet_pose_desc desc = {
            .animation_count = 1, .animations = &i, .time_s = 0.3 * (double)scene->animations[i].end_s};
        scene_pose pose = {0};
        assert_int_equal(scene_pose_create(scene, &desc, NULL, 1, &pose, NULL), FACET_OK);
        scene_pose_destroy(&pose);
    }
    facet_camera camera;
    const facet_orbit orbit = {.polar_rad = 1.3f, .radius_scale = 1.05f, .fov_y_rad = 0.5f};
    assert_int_equal(scene_fit_orbit(scene, NULL, &orbit, 1.0f, &camera, NULL), FACET_OK);
    text t = {0};
    scene_describe_json(scene, &t);
    assert_false(t.has_failed);
    text_destroy(&t);
}

/* ---- good models ---- */

static void every_model_loads(void **state)
{
    (void)state;
    if (!data_folder())
        skip();
    file_list *files = find_files("models");
    for (size_t i = 0; i < files->count; i++) {
        facet_scene *scene = NULL;
        facet_error error = {0};
        facet_result result = gltf_load(files->paths[i], NULL, &scene, &error);
        if (strstr(files->paths[i], "/gltf1/")) {
            assert_int_equal(result, FACET_ERROR_UNSUPPORTED);
            assert_non_null(strstr(error.message, "is glTF 1.0"));
            continue;
        }
        if (result == FACET_ERROR_UNSUPPORTED && strstr(error.message, "draco")) /* not built in */
            continue;
        if (result != FACET_OK)
            fail_msg("%s", error.message);
        use(scene);
        if (scene->warning_count)
            fail_msg("a valid file has the warning \"%s\"", scene->warnings[0]);
        for (uint32_t k = 0; k < scene->note_count; k++)
            /* AnisotropyBarnLamp names uncompressed KTX2 files as the source of its textures. */
            if (!strstr(scene->notes[k], "KHR_texture_basisu"))
                fail_msg("a valid file has the note \"%s\"", scene->notes[k]);
        scene_destroy(scene);
    }
    free_files(files);
}

static void counts_are_those_of_the_files(void **state)
{
    (void)state;
    if (!data_folder())
        skip();
    /* Counted in the files' JSON by a script: accessors' counts by mode. */
    static const struct {
        const char *path;
        uint32_t nodes, instances, materials, textures, cameras, lights;
        uint64_t triangles, lines, points;
    } expected[] = {
        {"core/Box.glb", 2, 1, 1, 0, 0, 0, 12, 0, 0},
        {"core/Triangle.glb", 1, 1, 0, 0, 0, 0, 1, 0, 0},
        {"core/SimpleMeshes.glb", 2, 2, 0, 0, 0, 0, 1, 0, 0},
        {"core/Cameras.glb", 3, 1, 0, 0, 2, 0, 2, 0, 0},
        {"core/MeshPrimitiveModes.glb", 7, 7, 0, 0, 0, 0, 16, 19, 7},
        {"core/WaterBottle.glb", 1, 1, 1, 4, 0, 0, 4510, 0, 0},
        {"core/PrimitiveModeNormalsTest.glb", 28, 25, 2, 1, 0, 0, 2562, 524280, 524288},
        {"gltf/Suzanne/Suzanne.gltf", 1, 1, 1, 2, 0, 0, 3936, 0, 0},
        {"lights/DirectionalLight.glb", 5, 3, 3, 0, 1, 1, 31800, 0, 0},
        {"materials/IridescenceMetallicSpheres.glb", 346, 346, 344, 1, 0, 0, 617406, 0, 0},
        {"scenes/shaderball.glb", 2, 2, 1, 0, 0, 0, 88264, 0, 0},
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/models/%s", data_folder(), expected[i].path);
        facet_scene *scene = NULL;
        facet_error error = {0};
        if (gltf_load(path, NULL, &scene, &error) != FACET_OK)
            fail_msg("%s", error.message);
        facet_scene_counts counts = scene_count(scene);
        assert_int_equal(counts.nodes, expected[i].nodes);
        assert_int_equal(counts.instances, expected[i].instances);
        assert_int_equal(counts.materials, expected[i].materials);
        assert_int_equal(counts.textures, expected[i].textures);
        assert_int_equal(counts.cameras, expected[i].cameras);
        assert_int_equal(counts.lights, expected[i].lights);
        assert_int_equal(counts.triangles, expected[i].triangles);
        assert_int_equal(counts.lines, expected[i].lines);
        assert_int_equal(counts.points, expected[i].points);
        scene_destroy(scene);
    }
}

/* How many materials have each extension, by the order of their bits, and how many textures all of them
 * name; counted in the files' JSON by a script. */
static void materials_are_those_of_the_files(void **state)
{
    (void)state;
    if (!data_folder())
        skip();
    enum { EXTENSIONS = 14 };
    static const struct {
        const char *path;
        uint32_t counts[EXTENSIONS], textures;
    } expected[] = {
        {"materials/AnisotropyStrengthTest.glb", {[9] = 49}, 1},
        {"materials/AttenuationTest.glb", {[6] = 16, [7] = 11}, 3},
        {"materials/ClearCoatTest.glb", {[4] = 6}, 13},
        {"materials/CompareDispersion.glb", {[2] = 2, [6] = 2, [7] = 2, [10] = 1}, 3},
        {"materials/CompareEmissiveStrength.glb", {[1] = 1}, 2},
        {"materials/DiffuseTransmissionTest.glb", {[0] = 8, [11] = 20}, 18},
        {"materials/IridescenceMetallicSpheres.glb", {[8] = 343}, 1},
        {"materials/SheenChair.glb", {[5] = 2}, 15},
        {"materials/SpecularTest.glb", {[3] = 23}, 4},
        {"materials/SunglassesKhronos.glb", {[2] = 1, [6] = 3, [7] = 1, [8] = 1}, 1},
        {"materials/ToyCar.glb", {[4] = 1, [5] = 1, [6] = 1}, 9},
        {"materials/TransmissionRoughnessTest.glb", {[2] = 4, [6] = 5, [7] = 5}, 9},
        {"specgloss/Avocado-specgloss.glb", {[13] = 1}, 3}, /* without the two of the fallback */
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        facet_scene *scene = load_shared(expected[i].path);
        uint32_t counts[EXTENSIONS] = {0};
        uint32_t textures = 0;
        for (uint32_t k = 0; k < scene->material_count; k++) {
            const scene_material *m = &scene->materials[k];
            for (int bit = 0; bit < EXTENSIONS; bit++)
                counts[bit] += m->extensions >> bit & 1;
            for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
                textures += scene_material_has(m, (scene_texture_slot)slot);
        }
        assert_memory_equal(counts, expected[i].counts, sizeof counts);
        assert_int_equal(textures, expected[i].textures);
        scene_destroy(scene);
    }
}

/* ---- broken models ---- */

/* Khronos' validator wrote FILE.report.json beside each; "numErrors" is the count. */
static long count_errors(const char *path)
{
    char report[1100];
    snprintf(report, sizeof report, "%s.report.json", path);
    file_bytes file = {0};
    assert_int_equal(file_open(report, 0, NULL, &file, NULL), FACET_OK);
    const char *at = strstr((const char *)file.data, "\"numErrors\":");
    assert_non_null(at);
    long count = strtol(at + 12, NULL, 10);
    file_close(&file);
    return count;
}

/* Files with an error that facet neither refuses nor mentions: it does not read min and max. */
static bool is_silent(const char *path)
{
    return strstr(path, "/out_of_range_elements_") != NULL;
}

static void validator_errors_are_refused_or_reported(void **state)
{
    (void)state;
    if (!data_folder())
        skip();
    file_list *files = find_files("malformed/gltf-validator");
    assert_true(files->count > 150);
    for (size_t i = 0; i < files->count; i++) {
        const char *path = files->paths[i];
        facet_scene *scene = NULL;
        facet_error error = {0};
        facet_result result = gltf_load(path, NULL, &scene, &error);
        long errors = count_errors(path);
        if (result == FACET_OK)
            use(scene);
        if (errors > 0 && result == FACET_OK && scene->warning_count + scene->note_count == 0 &&
            !is_silent(path))
            fail_msg("%s has %ld errors and loads without a word", path, errors);
        /* A file that needs a reader of glTF 2.1 is valid, but not for us. */
        if (errors == 0 && result != FACET_OK && !strstr(path, "min_version_valid"))
            fail_msg("%s is valid, but %s", path, error.message);
        if (result != FACET_OK) {
            assert_true(strlen(error.message) > strlen(path));
            assert_null(strchr(error.message, '\n'));
        }
        scene_destroy(scene);
    }
    free_files(files);
}

static void broken_models_never_crash(void **state)
{
    (void)state;
    if (!data_folder())
        skip();
    static const char *const folders[] = {"malformed/glb-mutated", "malformed/assimp-gltf"};
    for (int folder = 0; folder < 2; folder++) {
        file_list *files = find_files(folders[folder]);
        for (size_t i = 0; i < files->count; i++) {
            facet_scene *scene = NULL;
            facet_error error = {0};
            facet_result result = gltf_load(files->paths[i], NULL, &scene, &error);
            if (result == FACET_OK)
                use(scene);
            else
                assert_null(scene);
            /* Two of these have indices beyond the vertices; all others must be refused. */
            if (folder == 1 && result == FACET_OK)
                assert_true(strstr(files->paths[i], "IndicesOutOfRange") ||
                            strstr(files->paths[i], "IndexOutOfRange"));
            if (folder == 1 && result == FACET_OK)
                assert_true(has_warning(scene, "but there are"));
            scene_destroy(scene);
        }
        free_files(files);
    }
}

/* ---- cut off ---- */

static void truncations_are_refused(void **state)
{
    (void)state;
    if (!data_folder())
        skip();
    enum { CUTS = 40, LARGEST = 200000 };
    file_list *files = find_files("models");
    for (size_t i = 0; i < files->count; i++) {
        file_bytes file = {0};
        if (file_open(files->paths[i], LARGEST, NULL, &file, NULL) != FACET_OK)
            continue;
        bool is_glb = memcmp(file.data, "glTF", 4) == 0;
        for (size_t cut = 0; cut < CUTS; cut++) {
            /* Spread over the file, and some right at its end. */
            size_t size = cut < 30 ? file.size * cut / 30 : file.size - (CUTS - cut);
            facet_scene *scene = NULL;
            facet_error error = {0};
            facet_result result = gltf_load_memory(file.data, size, "cut", NULL, &scene, &error);
            /* A .gltf may end in spaces. */
            if (result == FACET_OK && (is_glb || size + 8 < file.size))
                fail_msg("%s cut to %zu bytes loads", files->paths[i], size);
            scene_destroy(scene);
        }
        file_close(&file);
    }
    free_files(files);
}

/* ---- out of memory ---- */

typedef struct meter {
    size_t calls, fail_at;
    size_t blocks;
} meter;

static void *meter_allocate(void *user, size_t size)
{
    meter *m = user;
    if (m->calls++ == m->fail_at)
        return NULL;
    m->blocks++;
    return malloc(size);
}

static void meter_release(void *user, void *memory, size_t size)
{
    (void)size;
    ((meter *)user)->blocks--;
    free(memory);
}

static void every_failed_allocation_is_survived(void **state)
{
    (void)state;
    if (!data_folder())
        skip();
    static const char *const models[] = {"core/MeshPrimitiveModes.glb",
                                         "core/SimpleSparseAccessor.glb",
                                         "gltf/Box With Spaces/Box With Spaces.gltf",
                                         "gltf/TextureSettingsTest-embedded.gltf",
                                         "animation/SimpleSkin.glb",
                                         "animation/SimpleMorph.glb",
                                         "animation/AnimatedColorsCube.glb",
                                         "extensions/SimpleInstancing.glb"};
    for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/models/%s", data_folder(), models[i]);
        facet_result result = FACET_ERROR_MEMORY;
        for (size_t fail_at = 0; result != FACET_OK; fail_at++) {
            assert_true(fail_at < 2000);
            meter m = {.fail_at = fail_at};
            facet_scene_desc desc = {
                .allocator = {.user = &m, .allocate = meter_allocate, .release = meter_release},
                .thread_count = 1};
            facet_scene *scene = NULL;
            facet_error error = {0};
            result = gltf_load(path, &desc, &scene, &error);
            if (result != FACET_OK)
                assert_int_equal(result, FACET_ERROR_MEMORY);
            else if (m.calls > fail_at) /* it was survived: a warning was lost, say */
                result = FACET_ERROR_MEMORY;
            scene_destroy(scene);
            assert_int_equal(m.blocks, 0);
        }
    }
}

static void threads_do_not_change_a_scene(void **state)
{
    (void)state;
    if (!data_folder())
        skip();
    char path[1024];
    snprintf(path, sizeof path, "%s/models/scenes/shaderball.glb", data_folder());
    facet_scene *scenes[2] = {NULL, NULL};
    for (uint32_t i = 0; i < 2; i++) {
        facet_scene_desc desc = {.thread_count = i == 0 ? 1 : 7};
        assert_int_equal(gltf_load(path, &desc, &scenes[i], NULL), FACET_OK);
        assert_int_equal(scenes[i]->thread_count, desc.thread_count);
    }
    for (uint32_t i = 0; i < scenes[0]->mesh_count; i++) {
        const scene_primitive *a = &scenes[0]->meshes[i].primitives[0];
        const scene_primitive *b = &scenes[1]->meshes[i].primitives[0];
        assert_int_equal(a->vertex_count, b->vertex_count);
        assert_memory_equal(a->positions, b->positions, 12 * (size_t)a->vertex_count);
        assert_memory_equal(a->normals, b->normals, 12 * (size_t)a->vertex_count);
        assert_memory_equal(a->indices, b->indices, 4 * (size_t)a->index_count);
        assert_memory_equal(a->bounds_max, b->bounds_max, sizeof a->bounds_max);
    }
    scene_destroy(scenes[0]);
    scene_destroy(scenes[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_model_loads),
        cmocka_unit_test(counts_are_those_of_the_files),
        cmocka_unit_test(materials_are_those_of_the_files),
        cmocka_unit_test(validator_errors_are_refused_or_reported),
        cmocka_unit_test(broken_models_never_crash),
        cmocka_unit_test(truncations_are_refused),
        cmocka_unit_test(every_failed_allocation_is_survived),
        cmocka_unit_test(threads_do_not_change_a_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
