/* Tests of texture_store.c: textures of a store equal those of a separate set, and nothing is decoded twice. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "base/memory.h"
#include "draw/texture_set.h"

enum { IMAGE_COUNT = 4 };

typedef struct fixture {
    facet_scene scene;
    scene_image images[IMAGE_COUNT];
    scene_texture textures[IMAGE_COUNT];
    texture_use uses[IMAGE_COUNT];
    int warning_count;
    facet_log log;
} fixture;

static void note_warning(void *user, facet_log_level level, const char *text)
{
    (void)level;
    (void)text;
    ((fixture *)user)->warning_count++;
}

/* With noise, so that a reduced JPEG differs from the mips of the whole one. */
static void encode(scene_image *out, uint32_t width, uint32_t height, image_codec codec)
{
    image i;
    assert_int_equal(image_create(NULL, width, height, 3, IMAGE_U8, &i, NULL), FACET_OK);
    i.is_srgb = true;
    uint32_t noise = width;
    for (uint32_t k = 0; k < width * height * 3; k++) {
        lcg_next(&noise);
        ((uint8_t *)i.pixels)[k] = (uint8_t)(noise >> 24);
    }
    unsigned char *bytes;
    assert_int_equal(image_encode(&i, codec, &(image_encode_desc){.quality = 90}, &bytes, &out->size, NULL),
                     FACET_OK);
    out->bytes = bytes;
    out->name = "";
    image_destroy(&i);
}

/* Two JPEGs, one of which no decoder can reduce exactly, a PNG, and bytes that are not an image. */
static void set_up(fixture *f)
{
    static const unsigned char nothing[] = "no image";
    *f =
        (fixture){.scene = {.source = "model.glb", .image_count = IMAGE_COUNT, .texture_count = IMAGE_COUNT}};
    encode(&f->images[0], 256, 128, IMAGE_CODEC_JPEG);
    encode(&f->images[1], 100, 75, IMAGE_CODEC_JPEG);
    encode(&f->images[2], 128, 64, IMAGE_CODEC_PNG);
    f->images[3] = (scene_image){.name = "", .bytes = nothing, .size = sizeof nothing};
    f->scene.images = f->images;
    f->scene.textures = f->textures;
    for (uint32_t i = 0; i < IMAGE_COUNT; i++)
        f->textures[i].image = i;
    f->log = (facet_log){.user = f, .message = note_warning};
}

static void tear_down(fixture *f)
{
    for (int i = 0; i < 3; i++)
        mem_free((unsigned char *)(uintptr_t)f->images[i].bytes);
}

static void assert_same(const texture_pyramid *a, const texture_pyramid *b)
{
    assert_int_equal(a->level_count, b->level_count);
    assert_int_equal(a->first_level, b->first_level);
    for (uint32_t level = a->first_level; level < a->level_count; level++) {
        assert_int_equal(a->levels[level].width, b->levels[level].width);
        assert_int_equal(a->levels[level].height, b->levels[level].height);
        size_t size = (size_t)a->levels[level].width * a->levels[level].height * a->channel_count;
        assert_memory_equal(a->levels[level].texels, b->levels[level].texels, size);
    }
}

/* Uses of the n-th render, different for each texture. */
static void choose_uses(fixture *f, uint32_t n)
{
    for (uint32_t i = 0; i < IMAGE_COUNT; i++) {
        uint32_t noise = (n * IMAGE_COUNT + i) * 2654435761u >> 8;
        f->uses[i] = (texture_use){.is_read_as_color = noise & 1,
                                   .is_read_as_data = noise & 2,
                                   .min_lod = (float)(noise >> 2 & 63) / 10.0f};
    }
}

static void a_store_gives_what_a_set_of_its_own_has(void **state)
{
    (void)state;
    fixture f;
    set_up(&f);
    texture_store *store;
    assert_int_equal(texture_store_create(&f.scene, NULL, &store, NULL), FACET_OK);
    for (uint32_t n = 0; n < 64; n++) {
        choose_uses(&f, n);
        texture_set *kept;
        texture_set *fresh;
        assert_int_equal(
            texture_set_create_from(store, &f.scene, f.uses, NULL, &f.log, 1 + n % 3, &kept, NULL), FACET_OK);
        assert_int_equal(texture_set_create(&f.scene, f.uses, NULL, NULL, 1, &fresh, NULL), FACET_OK);
        for (uint32_t i = 0; i < 2 * IMAGE_COUNT; i++)
            assert_same(&kept->pyramids[i], &fresh->pyramids[i]);
        for (uint32_t i = 0; i < IMAGE_COUNT; i++) {
            assert_int_equal(!kept->bindings[i].color, !fresh->bindings[i].color);
            assert_int_equal(!kept->bindings[i].data, !fresh->bindings[i].data);
        }
        texture_set_destroy(kept);
        texture_set_destroy(fresh);
    }
    texture_store_destroy(store);
    assert_int_equal(f.warning_count, 1); /* once, not for each render */
    tear_down(&f);
}

/* Only what is wanted finer than ever before is decoded again. */
static void nothing_is_decoded_twice(void **state)
{
    (void)state;
    fixture f;
    set_up(&f);
    texture_store *store;
    assert_int_equal(texture_store_create(&f.scene, NULL, &store, NULL), FACET_OK);
    for (int round = 0; round < 3; round++)
        for (int lod = 6; lod >= 0; lod--) {
            for (int i = 0; i < IMAGE_COUNT; i++)
                f.uses[i] = (texture_use){.is_read_as_color = true, .min_lod = (float)lod};
            texture_set *set;
            assert_int_equal(texture_set_create_from(store, &f.scene, f.uses, NULL, NULL, 2, &set, NULL),
                             FACET_OK);
            if (round > 0)
                assert_int_equal(texture_set_decoded_texels(set), 0);
            else
                assert_true(texture_set_decoded_texels(set) > 0);
            texture_set_destroy(set);
        }
    texture_store_destroy(store);
    tear_down(&f);
}

/* After a failure the store has what it had, and stays usable. */
static void a_store_survives_running_out_of_memory(void **state)
{
    (void)state;
    fixture f;
    set_up(&f);
    f.scene.image_count = f.scene.texture_count = 3;
    for (long at = 0;; at = next_failure(at)) {
        failing_allocator memory = {.fail_at = -1};
        facet_allocator allocator = failing_allocator_get(&memory);
        texture_store *store;
        assert_int_equal(texture_store_create(&f.scene, &allocator, &store, NULL), FACET_OK);
        texture_set *set;
        choose_uses(&f, 3);
        assert_int_equal(texture_set_create_from(store, &f.scene, f.uses, &allocator, NULL, 1, &set, NULL),
                         FACET_OK);
        texture_set_destroy(set);
        for (int i = 0; i < 3; i++)
            f.uses[i] = (texture_use){.is_read_as_color = true, .is_read_as_data = true};
        memory.fail_at = atomic_load(&memory.calls) + at;
        facet_result result =
            texture_set_create_from(store, &f.scene, f.uses, &allocator, NULL, 1, &set, NULL);
        bool was_refused = atomic_load(&memory.calls) > memory.fail_at;
        if (result == FACET_OK)
            texture_set_destroy(set);
        memory.fail_at = -1;
        if (result == FACET_ERROR_MEMORY) {
            assert_int_equal(
                texture_set_create_from(store, &f.scene, f.uses, &allocator, NULL, 1, &set, NULL), FACET_OK);
            for (int i = 0; i < 3; i++)
                assert_true(set->bindings[i].color && set->bindings[i].data);
            texture_set_destroy(set);
        }
        texture_store_destroy(store);
        assert_int_equal(memory.blocks, 0);
        if (!was_refused) {
            assert_int_equal(result, FACET_OK);
            assert_true(at > 12);
            break;
        }
    }
    tear_down(&f);
}

/* A small render of a large PNG needs neither its texels nor its finest mips: 48 MiB here, 8 bits or 16. */
static void large_images_are_not_held_whole(void **state)
{
    (void)state;
    for (image_type type = IMAGE_U8; type <= IMAGE_U16; type++) {
        const uint32_t size = type == IMAGE_U8 ? 4096 : 2048;
        image i;
        assert_int_equal(image_create(NULL, size, size, type == IMAGE_U8 ? 3 : 4, type, &i, NULL), FACET_OK);
        memset(i.pixels, 100, image_row_size(&i) * size);
        unsigned char *bytes;
        scene_image source = {.name = ""};
        assert_int_equal(image_encode(&i, IMAGE_CODEC_PNG, NULL, &bytes, &source.size, NULL), FACET_OK);
        image_destroy(&i);
        source.bytes = bytes;
        scene_texture texture = {.image = 0};
        const facet_scene scene = {.source = "model.glb",
                                   .image_count = 1,
                                   .texture_count = 1,
                                   .images = &source,
                                   .textures = &texture};
        const texture_use use = {.is_read_as_color = true, .is_read_as_data = true, .min_lod = 4.0f};
        facet_budget *budget;
        assert_int_equal(facet_budget_create(4 << 20, &budget, NULL), FACET_OK);
        const facet_allocator allocator = facet_budget_allocator(budget);
        texture_set *set;
        facet_error error = {0};
        if (texture_set_create(&scene, &use, &allocator, NULL, 1, &set, &error) != FACET_OK)
            fail_msg("%s", error.message);
        assert_int_equal(texture_set_decoded_texels(set), (uint64_t)size * size);
        texture_set_destroy(set);
        facet_budget_destroy(budget);
        mem_free(bytes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_store_gives_what_a_set_of_its_own_has),
        cmocka_unit_test(nothing_is_decoded_twice),
        cmocka_unit_test(a_store_survives_running_out_of_memory),
        cmocka_unit_test(large_images_are_not_held_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
