/* convert_drop_test.c - images that only legacy materials use are dropped; conversions without them. */
#include "tests/support/support.h"
#include "legacy/convert_test_support.h"

#include "scene/legacy_extras.h"

static const facet_legacy_desc DROPS = {.drops_sources = true};
static const uint8_t WOOD[] = {200, 150, 100, 180, 120, 80, 90, 60, 30, 250, 240, 230};
static const uint8_t FADE[] = {255, 128, 64, 0};

enum { PLAIN_MAP, BAKED, UNTEXTURED, ONLY_DISPLACED, MATERIALS };

/* An image that stays, two that are baked, none, and one without counterpart. False: out of memory. */
static bool fill(facet_scene *scene)
{
    legacy_material *m = scene->legacy->materials;
    uint32_t specular = add_texels(scene, 2, 2, 3, WOOD);
    uint32_t color = add_texels(scene, 2, 2, 3, WOOD);
    uint32_t fade = add_texels(scene, 2, 2, 1, FADE);
    uint32_t height = add_texels(scene, 2, 2, 1, FADE);
    if (specular == SCENE_NONE || color == SCENE_NONE || fade == SCENE_NONE || height == SCENE_NONE)
        return false;
    scene->images[color].uri = "color.png";
    for (int i = 0; i < MATERIALS; i++) {
        m[i].fields = LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_SHININESS;
        set_color(m[i].diffuse, .6f, .5f, .4f);
        set_color(m[i].specular, .3f, .3f, .3f);
        m[i].shininess = 40;
    }
    set_map(&m[PLAIN_MAP], LEGACY_DIFFUSE_MAP, color);
    set_map(&m[BAKED], LEGACY_SPECULAR_MAP, specular);
    set_map(&m[BAKED], LEGACY_SHININESS_MAP, fade);
    set_map(&m[BAKED], LEGACY_DIFFUSE_MAP, color);
    set_map(&m[ONLY_DISPLACED], LEGACY_DISPLACEMENT_MAP, height);
    return true;
}

static facet_scene *dropped(void)
{
    facet_scene *scene = legacy_scene(MATERIALS);
    assert_true(fill(scene));
    convert(scene, &DROPS);
    return scene;
}

/* Every texture is used by a glTF material, every image by a texture; indices are in range. */
static void assert_all_used(const facet_scene *scene)
{
    bool textures[TEST_MAX] = {false};
    bool images[TEST_MAX] = {false};
    for (uint32_t i = 0; i < scene->material_count; i++) {
        for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++) {
            uint32_t texture = scene->materials[i].textures[slot].texture;
            assert_true(texture == SCENE_NONE || texture < scene->texture_count);
            if (texture != SCENE_NONE)
                textures[texture] = true;
        }
        for (int slot = 0; slot < LEGACY_MAP_COUNT; slot++) {
            uint32_t texture = scene->legacy->materials[i].maps[slot].ref.texture;
            assert_true(texture == SCENE_NONE || texture < scene->texture_count);
        }
    }
    for (uint32_t i = 0; i < scene->texture_count; i++) {
        assert_true(textures[i]);
        assert_true(scene->textures[i].image < scene->image_count);
        images[scene->textures[i].image] = true;
    }
    for (uint32_t i = 0; i < scene->image_count; i++)
        assert_true(images[i] && scene->images[i].size > 0);
}

static size_t size_of_images(const facet_scene *scene)
{
    size_t size = 0;
    for (uint32_t i = 0; i < scene->image_count; i++)
        size += scene->images[i].size;
    return size;
}

static void images_of_legacy_materials_alone_are_dropped(void **state)
{
    (void)state;
    facet_scene *kept = legacy_scene(MATERIALS);
    assert_true(fill(kept));
    convert(kept, &(facet_legacy_desc){0});
    facet_scene *scene = dropped();
    assert_int_equal(scene->image_count, kept->image_count - 3);
    assert_int_equal(scene->texture_count, kept->texture_count - 3);
    assert_true(size_of_images(scene) < size_of_images(kept));
    assert_null(kept->conversion->source);
    assert_all_used(scene);
    /* The image that is used unchanged, by two materials. */
    const legacy_material *m = scene->legacy->materials;
    uint32_t color = scene->materials[PLAIN_MAP].textures[SCENE_BASE_COLOR_TEXTURE].texture;
    assert_string_equal(scene->images[scene->textures[color].image].uri, "color.png");
    assert_int_equal(m[PLAIN_MAP].maps[LEGACY_DIFFUSE_MAP].ref.texture, color);
    assert_false(legacy_lacks_images(&m[PLAIN_MAP]));
    /* The baked ones. */
    assert_int_equal(m[BAKED].maps[LEGACY_SPECULAR_MAP].ref.texture, SCENE_NONE);
    assert_string_equal(m[BAKED].maps[LEGACY_SPECULAR_MAP].path, "image.png");
    assert_true(m[BAKED].maps[LEGACY_SPECULAR_MAP].is_left_out);
    assert_true(legacy_lacks_images(&m[BAKED]));
    assert_false(legacy_lacks_images(&m[UNTEXTURED]));
    /* The one without a counterpart. */
    assert_true(m[ONLY_DISPLACED].maps[LEGACY_DISPLACEMENT_MAP].is_left_out);
    assert_false(legacy_lacks_images(&m[ONLY_DISPLACED]));
    assert_non_null(strstr(scene->materials[BAKED].meta.extras, "left_out"));
    assert_null(strstr(scene->materials[PLAIN_MAP].meta.extras, "left_out"));
    /* The glTF materials are the same. */
    for (int i = 0; i < MATERIALS; i++) {
        pbr_surface a = surface_at(kept, (uint32_t)i, 2);
        pbr_surface b = surface_at(scene, (uint32_t)i, 2);
        assert_memory_equal(&a, &b, sizeof a);
    }
    scene_destroy(kept);
    scene_destroy(scene);
}

/* The report renders the source materials with the dropped images. */
static void the_report_renders_the_dropped_images(void **state)
{
    (void)state;
    facet_scene *scene = dropped();
    const scene_conversion_source *source = scene->conversion->source;
    assert_non_null(source);
    assert_true(source->image_count > scene->image_count);
    uint32_t texture = source->legacy[BAKED].maps[LEGACY_SPECULAR_MAP].ref.texture;
    assert_true(texture < source->texture_count);
    assert_non_null(source->images[source->textures[texture].image].bytes);
    texture = source->materials[BAKED].textures[SCENE_SPECULAR_TEXTURE].texture;
    assert_true(texture < source->texture_count);
    assert_int_equal(scene->conversion->materials[BAKED].pbr.textures[SCENE_SPECULAR_TEXTURE].texture,
                     scene->materials[BAKED].textures[SCENE_SPECULAR_TEXTURE].texture);
    scene_destroy(scene);
}

static void materials_with_dropped_images_are_fitted(void **state)
{
    (void)state;
    facet_scene *scene = dropped();
    const uint32_t images = scene->image_count;
    convert_to(scene, FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS, &DROPS); /* no second conversion */
    assert_int_equal(scene->image_count, images);
    assert_string_equal(scene->conversion->materials[BAKED].summary.method, "closed");
    assert_true(scene_material_has(&scene->materials[BAKED], SCENE_SPECULAR_TEXTURE));
    convert_to(scene, FACET_MATERIAL_MODEL_OGL1, &(facet_legacy_desc){0});
    const material_conversion *report = scene->conversion->materials;
    const legacy_material *m = scene->legacy->materials;
    assert_string_equal(report[PLAIN_MAP].summary.method, "source");
    assert_string_equal(report[UNTEXTURED].summary.method, "source");
    assert_string_equal(report[ONLY_DISPLACED].summary.method, "source");
    assert_near(m[UNTEXTURED].shininess, 40, 0);
    assert_string_not_equal(report[BAKED].summary.method, "source");
    assert_true(legacy_has_map(&m[BAKED], LEGACY_DIFFUSE_MAP));
    assert_true(report[BAKED].summary.error < .3);
    assert_false(legacy_lacks_images(&m[BAKED]));
    scene_destroy(scene);
}

static void nothing_is_dropped_where_all_is_used(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(1);
    uint32_t color = add_texels(scene, 2, 2, 3, WOOD);
    scene->legacy->materials[0].fields = LEGACY_DIFFUSE;
    set_map(&scene->legacy->materials[0], LEGACY_DIFFUSE_MAP, color);
    const scene_image *images = scene->images;
    convert(scene, &DROPS);
    assert_int_equal(scene->image_count, 1);
    assert_ptr_equal(scene->images, images);
    assert_null(scene->conversion->source);
    assert_int_equal(scene->materials[0].textures[SCENE_BASE_COLOR_TEXTURE].texture, color);
    scene_destroy(scene);
}

/* A glTF scene with rgl's parameters applied: its image-based light refers to images, too. */
static void images_of_image_lights_stay(void **state)
{
    (void)state;
    facet_scene *scene = legacy_scene(MATERIALS);
    assert_true(fill(scene));
    static const uint32_t faces[6] = {0, 1, 2, 3, 0, 1};
    scene_image_light light = {.name = "", .rotation = {0, 0, 0, 1}, .mip_count = 1, .images = faces};
    scene->image_lights = &light;
    scene->image_light_count = 1;
    const scene_image first = scene->images[0];
    convert(scene, &DROPS);
    assert_null(scene->conversion->source);
    assert_ptr_equal(scene->images[0].bytes, first.bytes);
    assert_false(legacy_lacks_images(&scene->legacy->materials[BAKED]));
    scene_destroy(scene);
}

static void failed_allocations_are_reported(void **state)
{
    (void)state;
    for (long at = 0;; at = next_failure(at)) {
        failing_allocator failing = {.fail_at = -1};
        facet_allocator allocator = failing_allocator_get(&failing);
        facet_scene *scene = legacy_scene_in(&allocator, MATERIALS);
        assert_non_null(scene);
        scene->thread_count = 1;
        assert_true(fill(scene));
        const scene_material *original = scene->materials;
        const struct scene_legacy *legacy = scene->legacy;
        const uint32_t images = scene->image_count;
        failing.fail_at = atomic_load(&failing.calls) + at;
        facet_result result =
            legacy_convert(scene, FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS, &DROPS, &(facet_log){0}, NULL);
        bool has_failed = atomic_load(&failing.calls) > failing.fail_at;
        if (result == FACET_OK) {
            assert_all_used(scene);
        } else {
            assert_int_equal(result, FACET_ERROR_MEMORY);
            assert_ptr_equal(scene->materials, original);
            assert_ptr_equal(scene->legacy, legacy);
            assert_false(legacy_lacks_images(&legacy->materials[BAKED]));
            assert_int_equal(scene->image_count, images);
        }
        failing.fail_at = -1;
        scene_destroy(scene);
        assert_int_equal(atomic_load(&failing.blocks), 0);
        if (!has_failed)
            break;
        assert_true(at < 10000);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_of_legacy_materials_alone_are_dropped),
        cmocka_unit_test(the_report_renders_the_dropped_images),
        cmocka_unit_test(materials_with_dropped_images_are_fitted),
        cmocka_unit_test(nothing_is_dropped_where_all_is_used),
        cmocka_unit_test(images_of_image_lights_stay),
        cmocka_unit_test(failed_allocations_are_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
