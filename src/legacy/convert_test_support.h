/* convert_test_support.h - scenes with legacy materials and images of a few texels, for tests. */
#ifndef LEGACY_CONVERT_TEST_SUPPORT_H
#define LEGACY_CONVERT_TEST_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "image/image.h"
#include "image/srgb.h"
#include "legacy/convert.h"
#include "legacy/convert_surface.h"
#include "legacy/fit.h"

enum { TEST_MAX = 32 };

/* A scene with one primitive per material; room for TEST_MAX images. */
static inline facet_scene *legacy_scene_in(const facet_allocator *allocator, uint32_t count)
{
    facet_scene *scene = NULL;
    if (scene_create(allocator, "test.obj", &scene, NULL) != FACET_OK)
        return NULL;
    arena *a = scene->arena;
    scene->materials = arena_zalloc(a, count + 1, sizeof *scene->materials);
    scene->images = arena_zalloc(a, TEST_MAX, sizeof *scene->images);
    scene->textures = arena_zalloc(a, TEST_MAX, sizeof *scene->textures);
    scene->legacy = arena_zalloc(a, 1, sizeof *scene->legacy);
    legacy_material *materials = arena_zalloc(a, count + 1, sizeof *materials);
    if (!scene->materials || !scene->images || !scene->textures || !scene->legacy || !materials) {
        scene_destroy(scene);
        return NULL;
    }
    *scene->legacy = (struct scene_legacy){.materials = materials,
                                           .fog = {.scale = 1},
                                           .colors = FACET_LEGACY_COLORS_LINEAR,
                                           .dialect = FACET_MTL_DIALECT_SPEC,
                                           .is_source = true};
    for (uint32_t i = 0; i < count; i++) {
        materials[i] = legacy_material_default();
        scene->materials[i] = scene_material_default();
        scene->materials[i].name = materials[i].name = "stuff";
    }
    scene->material_count = count;
    return scene;
}

static inline facet_scene *legacy_scene(uint32_t count)
{
    facet_scene *scene = legacy_scene_in(NULL, count);
    assert_non_null(scene);
    return scene;
}

/* The same with glTF materials only. */
static inline facet_scene *gltf_scene(uint32_t count)
{
    facet_scene *scene = legacy_scene(count);
    scene->legacy = NULL;
    scene->source = "test.glb";
    return scene;
}

/* A texture of those texels as a PNG. SCENE_NONE: out of memory. */
static inline uint32_t add_image_texture(facet_scene *scene, uint32_t width, uint32_t height,
                                         uint32_t channels, const void *texels, image_type type)
{
    image decoded = {
        .width = width, .height = height, .channel_count = channels, .type = type, .is_srgb = true};
    size_t size = (size_t)width * height * channels * image_type_size(type);
    unsigned char *bytes = NULL;
    size_t byte_count = 0;
    decoded.pixels = mem_alloc(NULL, size, 1);
    assert_non_null(decoded.pixels);
    memcpy(decoded.pixels, texels, size);
    assert_int_equal(
        image_encode(&decoded, IMAGE_CODEC_PNG, &(image_encode_desc){0}, &bytes, &byte_count, NULL),
        FACET_OK);
    unsigned char *kept = arena_alloc(scene->arena, byte_count, 1);
    image_destroy(&decoded);
    if (kept)
        memcpy(kept, bytes, byte_count);
    mem_free(bytes);
    if (!kept)
        return SCENE_NONE;
    assert_true(scene->image_count < TEST_MAX);
    scene->images[scene->image_count] =
        (scene_image){.name = "image.png", .mime_type = "image/png", .bytes = kept, .size = byte_count};
    scene->textures[scene->texture_count] = (scene_texture){.name = "", .image = scene->image_count++};
    return scene->texture_count++;
}

static inline uint32_t add_texels(facet_scene *scene, uint32_t width, uint32_t height, uint32_t channels,
                                  const uint8_t *texels)
{
    return add_image_texture(scene, width, height, channels, texels, IMAGE_U8);
}

static inline void set_map(legacy_material *m, legacy_map_slot slot, uint32_t texture)
{
    m->maps[slot].ref.texture = texture;
    m->maps[slot].path = "image.png";
}

static inline void set_color(float out[3], float r, float g, float b)
{
    out[0] = r;
    out[1] = g;
    out[2] = b;
}

static inline void convert_to(facet_scene *scene, facet_material_model to, const facet_legacy_desc *desc)
{
    facet_error error = {0};
    facet_result result = legacy_convert(scene, to, desc, &(facet_log){0}, &error);
    if (result != FACET_OK)
        fail_msg("%s", error.message);
    assert_non_null(scene->conversion);
    assert_int_equal(scene->conversion->material_count, scene->material_count);
}

static inline void convert(facet_scene *scene, const facet_legacy_desc *desc)
{
    convert_to(scene, FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS, desc);
}

/* Converts one material; the caller inspects the scene. */
static inline facet_scene *convert_one(legacy_material m, const facet_legacy_desc *desc)
{
    facet_scene *scene = legacy_scene(1);
    scene->legacy->materials[0] = m;
    convert(scene, desc);
    return scene;
}

/* material SCENE_NONE: the scene's. */
static inline bool has_warning(const facet_scene *scene, uint32_t material, const char *code)
{
    const struct scene_conversion *c = scene->conversion;
    const conversion_warning *warnings =
        material == SCENE_NONE ? c->warnings : c->materials[material].warnings;
    uint32_t count = material == SCENE_NONE ? c->warning_count : c->materials[material].warning_count;
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(warnings[i].code, code) == 0)
            return true;
    return false;
}

/* A scene's texture as RGBA of 8 bits; the caller destroys it. */
static inline image decode_texture(const facet_scene *scene, uint32_t texture)
{
    image raw;
    image out;
    assert_true(texture < scene->texture_count);
    const scene_image *source = &scene->images[scene->textures[texture].image];
    assert_int_equal(
        image_decode(source->bytes, source->size, source->name, &(image_decode_desc){0}, &raw, NULL),
        FACET_OK);
    assert_int_equal(image_convert(&raw, NULL, 1, 4, IMAGE_U8, raw.is_srgb, &out, NULL), FACET_OK);
    image_destroy(&raw);
    return out;
}

/* Texel number i of a texture, as codes. */
static inline void texel_at(const facet_scene *scene, uint32_t texture, size_t i, uint8_t out[4])
{
    image decoded = decode_texture(scene, texture);
    assert_true(i < (size_t)decoded.width * decoded.height);
    memcpy(out, (const uint8_t *)decoded.pixels + i * 4, 4);
    image_destroy(&decoded);
}

static inline float light_of(uint8_t code)
{
    return (float)srgb_decode((double)code / 255.0);
}

/* The surface of a converted material at a texel of its textures, all of which have the same size. */
static inline pbr_surface surface_at(const facet_scene *scene, uint32_t material, size_t i)
{
    const scene_material *m = &scene->materials[material];
    pbr_surface s;
    uint8_t t[4];
    legacy_surface_of_pbr(m, &s);
    if (scene_material_has(m, SCENE_BASE_COLOR_TEXTURE)) {
        texel_at(scene, m->textures[SCENE_BASE_COLOR_TEXTURE].texture, i, t);
        for (int k = 0; k < 3; k++)
            s.base_color[k] *= light_of(t[k]);
    }
    if (scene_material_has(m, SCENE_METALLIC_ROUGHNESS_TEXTURE)) {
        texel_at(scene, m->textures[SCENE_METALLIC_ROUGHNESS_TEXTURE].texture, i, t);
        s.perceptual_roughness *= (float)t[1] / 255.0f;
        s.metallic *= (float)t[2] / 255.0f;
    }
    if (scene_material_has(m, SCENE_SPECULAR_TEXTURE)) {
        texel_at(scene, m->textures[SCENE_SPECULAR_TEXTURE].texture, i, t);
        s.specular *= (float)t[3] / 255.0f;
    }
    if (scene_material_has(m, SCENE_SPECULAR_COLOR_TEXTURE)) {
        texel_at(scene, m->textures[SCENE_SPECULAR_COLOR_TEXTURE].texture, i, t);
        for (int k = 0; k < 3; k++)
            s.specular_color[k] *= light_of(t[k]);
    }
    return s;
}

static inline void assert_color(const float found[3], float r, float g, float b, double tolerance)
{
    const float wanted[3] = {r, g, b};
    for (int k = 0; k < 3; k++)
        assert_near(found[k], wanted[k], tolerance);
}

#endif
