/* fuzz_mtl.c - the MTL reader on arbitrary bytes; the result is written, read again, and must be equal. */
#include "fuzz_support.h"

#include <math.h>
#include <string.h>

#include "base/text.h"
#include "io/obj/mtl_parts.h"
#include "scene/legacy_extras.h"

/* Invariants of legacy_material. */
static void check_material(const legacy_material *m)
{
    for (int i = 0; i < LEGACY_PARAMETER_COUNT; i++) {
        const legacy_parameter *row = &legacy_parameters[i];
        for (uint32_t k = 0; k < row->count && legacy_has(m, row->field); k++) {
            float value = legacy_floats_const(m, row)[k];
            if (!(value >= row->minimum && value <= row->maximum))
                abort();
        }
    }
    for (int i = 0; i < LEGACY_MAP_COUNT; i++)
        for (int k = 0; k < 6; k++)
            if (!isfinite(m->maps[i].ref.transform[k]) || m->maps[i].ref.texture != SCENE_NONE)
                abort();
}

/* NULL: no memory. */
static facet_scene *read_library(const void *bytes, size_t size, const facet_scene_desc *desc)
{
    facet_scene *scene = NULL;
    mtl_reader *reader = NULL;
    facet_error error = {0};
    facet_result result = scene_create(&desc->allocator, "fuzz.obj", &scene, &error);
    if (result == FACET_OK)
        result = mtl_reader_create(scene, desc, NULL, &reader, &error);
    if (result == FACET_OK)
        result = mtl_reader_load_bytes(reader, "fuzz.mtl", bytes, size, &error);
    if (result == FACET_OK)
        result = mtl_reader_finish(reader, &error);
    mtl_reader_destroy(reader);
    if (result == FACET_OK)
        return scene;
    if (result != FACET_ERROR_MEMORY || error.message[0] == 0)
        abort();
    scene_destroy(scene);
    return NULL;
}

static void check_round_trip(const facet_scene *scene, const facet_scene_desc *desc)
{
    const facet_scene_save_desc save = {.allocator = desc->allocator,
                                        .has_flipped_texcoords = desc->has_flipped_texcoords};
    text first = {.allocator = desc->allocator};
    text second = {.allocator = desc->allocator};
    mtl_write(scene, "fuzz", NULL, &save, &first);
    facet_scene *again = first.has_failed ? NULL : read_library(first.data, first.length, desc);
    if (again) {
        if (again->material_count != scene->material_count)
            abort();
        for (uint32_t i = 0; i < scene->material_count; i++)
            if (scene->legacy->materials[i].is_gltf_restored && !again->legacy->materials[i].is_gltf_restored)
                abort();
        mtl_write(again, "fuzz", NULL, &save, &second);
        if (!second.has_failed && strcmp(first.data, second.data) != 0)
            abort();
    }
    scene_destroy(again);
    text_destroy(&first);
    text_destroy(&second);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size == 0)
        return 0;
    facet_budget *budget = fuzz_begin((uint64_t)64 << 20);
    facet_scene_desc desc = {
        .allocator = facet_budget_allocator(budget),
        .log = {.message = fuzz_ignore},
        .has_flipped_texcoords = size % 2,
        .legacy = {.colors = size % 3 == 0 ? FACET_LEGACY_COLORS_LINEAR : FACET_LEGACY_COLORS_DEFAULT}};
    facet_scene *scene = read_library(data, size, &desc);
    if (scene) {
        for (uint32_t i = 0; i < scene->material_count; i++)
            check_material(&scene->legacy->materials[i]);
        check_round_trip(scene, &desc);
    }
    scene_destroy(scene);
    fuzz_end(budget);
    return 0;
}
