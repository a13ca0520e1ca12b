#define _POSIX_C_SOURCE 200809L /* stat(), getpid() */
/* convert_corpus_test.c - converts every model of the test data in every direction: values are in range,
 * textures exist, errors are finite, and originals are restored. */
#include "tests/support/support.h"
#include "legacy/convert_test_support.h"

#include <dirent.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/gltf/gltf.h"
#include "io/model_file.h"
#include "scene/material_table.h"

static void check_pbr(const facet_scene *scene, const char *path)
{
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const scene_material *m = &scene->materials[i];
        /* Unconverted parameters are as in the file. */
        const char *method = scene->conversion->materials[i].summary.method;
        bool is_made = strcmp(method, "none") != 0 && strcmp(method, "source") != 0;
        for (int row = 0; row < MATERIAL_PARAMETER_COUNT && is_made; row++) {
            const material_parameter *p = &material_parameters[row];
            const float *values = material_floats_const(m, p);
            /* An ior of 0 is a value of its own; the attenuation distance is infinite where there is none. */
            for (uint32_t k = 0; k < p->count; k++)
                if (!(values[k] >= p->minimum && values[k] <= p->maximum) && !isinf(values[k]))
                    fail_msg("%s: material %u: %s is %g", path, i, p->key, (double)values[k]);
        }
        for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++) {
            uint32_t texture = m->textures[slot].texture;
            assert_true(texture == SCENE_NONE || texture < scene->texture_count);
        }
    }
}

static void check_legacy(const facet_scene *scene, const char *path)
{
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const legacy_material *m = &scene->legacy->materials[i];
        for (int k = 0; k < 3; k++)
            if (!(m->diffuse[k] >= 0 && m->specular[k] >= 0 && m->emission[k] >= 0 && m->diffuse[k] < 1e9f))
                fail_msg("%s: material %u has no colors", path, i);
        assert_true(m->shininess >= 0 && m->opacity >= 0 && m->opacity <= 1);
        for (int slot = 0; slot < LEGACY_MAP_COUNT; slot++) {
            uint32_t texture = m->maps[slot].ref.texture;
            assert_true(texture == SCENE_NONE || texture < scene->texture_count);
        }
    }
}

static void check_report(const facet_scene *scene, const char *path)
{
    for (uint32_t i = 0; i < scene->conversion->material_count; i++) {
        const material_conversion *m = &scene->conversion->materials[i];
        const facet_conversion *c = &m->summary;
        assert_true(c->name && c->source && c->method && c->profile);
        bool is_compared = strcmp(c->method, "fit") == 0;
        if (is_compared &&
            !(c->error >= 0 && c->error < 100 && c->error_display >= 0 && c->error_display < 100))
            fail_msg("%s: material %u: E %g, E_display %g", path, i, c->error, c->error_display);
        assert_int_equal(c->warning_count, m->warning_count);
    }
    text t = {.allocator = scene->allocator};
    legacy_report_json(scene, &t);
    assert_false(t.has_failed);
    assert_true(t.length > 2 && t.data[0] == '{' && t.data[t.length - 1] == '}');
    text_destroy(&t);
}

/* Written as glTF and read again: the originals are known. */
static void check_round_trip(const facet_scene *scene, const char *path)
{
    const char *folder = getenv("TMPDIR");
    char name[1024];
    facet_scene *again = NULL;
    facet_error error;
    snprintf(name, sizeof name, "%s/facet_corpus_%ld.glb", folder ? folder : "/tmp", (long)getpid());
    if (gltf_save(scene, name, "test", &(facet_scene_save_desc){0}, &error) != FACET_OK ||
        gltf_load(name, &(facet_scene_desc){.thread_count = 2}, &again, &error) != FACET_OK)
        fail_msg("%s: %s", path, error.message);
    remove(name);
    assert_int_equal(again->material_count, scene->material_count);
    convert_to(again, FACET_MATERIAL_MODEL_OGL1, &(facet_legacy_desc){0});
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const legacy_material *before = &scene->legacy->materials[i];
        const legacy_material *after = &again->legacy->materials[i];
        if (before->is_gltf_restored || before->fields == 0)
            continue;
        assert_near(after->shininess, before->shininess, 0);
        for (int k = 0; k < 3; k++) {
            assert_near(after->diffuse[k], before->diffuse[k], 0);
            assert_near(after->specular[k], before->specular[k], 0);
        }
        assert_string_equal(again->conversion->materials[i].summary.method, "source");
    }
    scene_destroy(again);
}

static void check_model(const char *path)
{
    const facet_legacy_desc descs[] = {{0}, {.profile = FACET_LEGACY_PROFILE_CORE, .has_glass = true}};
    facet_scene *scene = NULL;
    facet_error error;
    if (model_file_load(path, &(facet_scene_desc){.thread_count = 2}, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    bool is_legacy = scene->legacy && scene->legacy->is_source;
    for (int i = 0; i < 2; i++) {
        convert(scene, &descs[i]);
        check_pbr(scene, path);
        check_report(scene, path);
        if (is_legacy)
            check_round_trip(scene, path);
    }
    legacy_material *read = NULL;
    if (is_legacy) {
        read = test_malloc(((size_t)scene->material_count + 1) * sizeof *read);
        memcpy(read, scene->legacy->materials, scene->material_count * sizeof *read);
    }
    convert_to(scene, FACET_MATERIAL_MODEL_OGL1, &(facet_legacy_desc){0});
    check_legacy(scene, path);
    check_report(scene, path);
    for (uint32_t i = 0; i < scene->material_count && is_legacy; i++)
        assert_memory_equal(&scene->legacy->materials[i].diffuse, read[i].diffuse, sizeof read[i].diffuse);
    if (read)
        test_free(read);
    convert_to(scene, FACET_MATERIAL_MODEL_SPECULAR_GLOSSINESS, &(facet_legacy_desc){0});
    check_pbr(scene, path);
    check_report(scene, path);
    scene_destroy(scene);
}

/* Larger models add only the texels that a sanitizer is slow on. */
enum { MAX_BYTES = IS_SLOW ? 50000 : 300000 };

/* Models below a folder with that extension. */
static int check_folder(const char *folder, const char *const *ends)
{
    int count = 0;
    DIR *d = opendir(folder);
    if (!d)
        return 0;
    for (struct dirent *e = readdir(d); e; e = readdir(d)) {
        char path[1024];
        struct stat status;
        snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        if (e->d_name[0] == '.' || stat(path, &status) != 0)
            continue;
        if (S_ISDIR(status.st_mode)) {
            count += check_folder(path, ends);
            continue;
        }
        for (const char *const *end = ends; *end && status.st_size < MAX_BYTES; end++) {
            size_t length = strlen(path);
            if (length > strlen(*end) && strcmp(path + length - strlen(*end), *end) == 0) {
                check_model(path);
                count++;
            }
        }
    }
    closedir(d);
    return count;
}

static int check_data(const char *folder, const char *const *ends)
{
    char path[1024];
    const char *data = test_data();
    snprintf(path, sizeof path, "%s/%s", data, folder);
    int count = check_folder(path, ends);
    print_message("%d models of %s\n", count, folder);
    return count;
}

static void gltf_models_convert(void **state)
{
    (void)state;
    const char *const ends[] = {".glb", NULL};
    assert_true(check_data("models/materials", ends) > (IS_SLOW ? 0 : 15));
    assert_true(check_data("models/specgloss", ends) > (IS_SLOW ? -1 : 0));
    assert_true(check_data("models/lights", ends) > (IS_SLOW ? 0 : 1));
}

static void obj_models_convert(void **state)
{
    (void)state;
    const char *const ends[] = {".obj", NULL};
    assert_true(check_data("obj", ends) > (IS_SLOW ? 10 : 40));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(gltf_models_convert),
                                       cmocka_unit_test(obj_models_convert)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
