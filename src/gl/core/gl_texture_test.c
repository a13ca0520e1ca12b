/* gl_texture_test.c - uploaded textures hold the CPU's texels at every level, and samplers follow glTF.
 * Exits with 77 where there is no OpenGL. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <epoxy/gl.h>

#include "base/memory.h"
#include "draw/texture_store.h"
#include "gl/scene/gl_fixture_test.h"
#include "gl/core/gl_texture.h"
#include "image/half.h"
#include "image/image.h"
#include "tests/support/support.h"

static gl_fixture_contexts contexts;
static int warning_count;
static char warning[512];

static void note_warning(void *user, facet_log_level level, const char *text)
{
    (void)user;
    assert_int_equal(level, FACET_LOG_LEVEL_WARNING);
    snprintf(warning, sizeof warning, "%s", text);
    warning_count++;
}

static const facet_log test_log = {.message = note_warning};

/* ---- images ---- */

static unsigned char *encoded(uint32_t width, uint32_t height, uint32_t channel_count, image_type type,
                              size_t *size)
{
    image sample;
    assert_int_equal(image_create(NULL, width, height, channel_count, type, &sample, NULL), FACET_OK);
    uint32_t state = 12345 + channel_count;
    for (size_t i = 0; i < image_row_size(&sample) * height; i++) {
        lcg_next(&state);
        ((unsigned char *)sample.pixels)[i] = (unsigned char)(state >> 24);
    }
    sample.is_srgb = true;
    unsigned char *bytes;
    assert_int_equal(image_encode(&sample, IMAGE_CODEC_PNG, &(image_encode_desc){0}, &bytes, size, NULL),
                     FACET_OK);
    image_destroy(&sample);
    return bytes;
}

/* Returns the index of the texture and of its image. */
static uint32_t add(fixture *f, uint32_t width, uint32_t height, uint32_t channel_count, image_type type)
{
    static const unsigned char nothing[4] = {0};
    uint32_t texture = fixture_add_texture(f, 1, 1, nothing);
    size_t size;
    unsigned char *bytes = encoded(width, height, channel_count, type, &size);
    unsigned char *kept = arena_alloc(f->scene->arena, size, 1);
    memcpy(kept, bytes, size);
    mem_free(bytes);
    scene_image *i = &f->scene->images[f->scene->textures[texture].image];
    *i = (scene_image){
        .name = "", .mime_type = "image/png", .bytes = kept, .size = size, .width = width, .height = height};
    return texture;
}

/* ---- contents ---- */

/* The expected texel in the texture's format: 8-bit codes or 16-bit values. */
static void expected_texel(const texture_pyramid *p, const texture_level *l, size_t i, float out[4])
{
    uint32_t n = p->channel_count;
    for (uint32_t c = 0; c < 4; c++) {
        uint32_t from = c == 3 ? n - 1 : n < 3 ? 0 : c;
        float whole = p->type == IMAGE_U8 ? 255.0f : 1.0f;
        if (c == 3 && (n == 1 || n == 3))
            out[c] = whole;
        else if (p->type == IMAGE_U8)
            out[c] = l->texels[i * n + from];
        else
            out[c] = half_to_float(half_from_float(
                (float)((const uint16_t *)(const void *)l->texels)[i * n + from] * (1.0f / 65535.0f)));
    }
}

static void read_level(uint32_t name, int level, const texture_level *l, bool is_8, float *out)
{
    size_t count = 4 * (size_t)l->width * l->height;
    GLuint framebuffer;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, name, level);
    assert_int_equal(glCheckFramebufferStatus(GL_FRAMEBUFFER), GL_FRAMEBUFFER_COMPLETE);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    if (is_8) {
        unsigned char *codes = malloc(count);
        glReadPixels(0, 0, (GLsizei)l->width, (GLsizei)l->height, GL_RGBA, GL_UNSIGNED_BYTE, codes);
        for (size_t i = 0; i < count; i++)
            out[i] = codes[i];
        free(codes);
    } else {
        glReadPixels(0, 0, (GLsizei)l->width, (GLsizei)l->height, GL_RGBA, GL_FLOAT, out);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &framebuffer);
}

static void assert_uploaded(uint32_t name, const texture_pyramid *p, uint32_t first_level)
{
    assert_int_not_equal(name, 0);
    for (uint32_t level = first_level; level < p->level_count; level++) {
        const texture_level *l = &p->levels[level];
        float *texels = malloc(4 * (size_t)l->width * l->height * sizeof *texels);
        read_level(name, (int)(level - first_level), l, p->type == IMAGE_U8, texels);
        for (size_t i = 0; i < (size_t)l->width * l->height; i++) {
            float wanted[4];
            expected_texel(p, l, i, wanted);
            for (size_t c = 0; c < 4; c++)
                if (wanted[c] != texels[4 * i + c])
                    fail_msg("level %u, texel %zu, channel %zu: %g in place of %g", level, i, c,
                             (double)texels[4 * i + c], (double)wanted[c]);
        }
        free(texels);
    }
    glBindTexture(GL_TEXTURE_2D, name);
    GLint last;
    glGetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, &last);
    assert_int_equal(last, p->level_count - 1 - first_level);
}

static gl_texture_set *make_set(const fixture *f, gl_context *context)
{
    gl_texture_set *set;
    assert_int_equal(gl_context_make_current(context, NULL), FACET_OK);
    assert_int_equal(gl_texture_create(context, f->scene, NULL, &set, NULL), FACET_OK);
    return set;
}

/* Odd sizes, every number of channels, colors and data, 8 and 16 bits. */
static void texels_equal_the_decoded_image(void **state)
{
    (void)state;
    enum { COUNT = 8 };
    fixture f = fixture_create();
    texture_use uses[COUNT] = {{0}};
    texture_want wants[COUNT] = {{0}};
    for (uint32_t i = 0; i < COUNT; i++) {
        add(&f, 13 - i, 6 + i, 1 + i % 4, i < 4 ? IMAGE_U8 : IMAGE_U16);
        uses[i].is_read_as_color = true;
        uses[i].is_read_as_data = i != 2;
        wants[i] = (texture_want){.image = i, .is_read = {true, true}};
    }
    texture_store *store;
    uint64_t decoded = 0;
    assert_int_equal(texture_store_create(f.scene, NULL, &store, NULL), FACET_OK);
    assert_int_equal(texture_store_get(store, wants, COUNT, NULL, 2, &decoded, NULL), FACET_OK);
    for (int k = 0; k < contexts.count; k++) {
        gl_texture_set *set = make_set(&f, &contexts.items[k]);
        assert_int_equal(gl_texture_update(set, uses, &test_log, 2, NULL), FACET_OK);
        uint64_t texels = gl_texture_decoded_texels(set);
        assert_true(texels > 0);
        for (uint32_t i = 0; i < COUNT; i++) {
            /* OpenGL ES needs an extension to render to and read back half floats. */
            if (wants[i].pyramid[0]->type == IMAGE_U16 && contexts.items[k].is_es)
                continue;
            assert_uploaded(gl_texture_name(set, i, true), wants[i].pyramid[1], 0);
            if (i != 2)
                assert_uploaded(gl_texture_name(set, i, false), wants[i].pyramid[0], 0);
        }
        assert_int_equal(gl_texture_name(set, 2, false), 0); /* not requested yet */
        assert_int_equal(gl_texture_name(set, 1000, true), 0);
        uint32_t name = gl_texture_name(set, 0, true);
        uses[2].is_read_as_data = true; /* requested now: nothing else is decoded again */
        assert_int_equal(gl_texture_update(set, uses, &test_log, 2, NULL), FACET_OK);
        assert_uploaded(gl_texture_name(set, 2, false), wants[2].pyramid[0], 0);
        assert_int_equal(gl_texture_name(set, 0, true), name);
        assert_int_equal(gl_texture_decoded_texels(set) - texels, 11 * 8);
        uses[2].is_read_as_data = false;
        gl_texture_destroy(set);
        gl_context_release(&contexts.items[k]);
    }
    texture_store_destroy(store);
    fixture_destroy(&f);
}

/* An image beyond OpenGL's limit starts at a coarser level, with one warning. */
static void images_beyond_the_limit_start_at_a_coarser_level(void **state)
{
    (void)state;
    fixture f = fixture_create();
    add(&f, 37, 9, 3, IMAGE_U8);
    texture_want want = {.is_read = {true, true}};
    texture_use use = {.is_read_as_color = true, .is_read_as_data = true};
    texture_store *store;
    uint64_t decoded = 0;
    assert_int_equal(texture_store_create(f.scene, NULL, &store, NULL), FACET_OK);
    assert_int_equal(texture_store_get(store, &want, 1, NULL, 1, &decoded, NULL), FACET_OK);
    gl_context *context = &contexts.items[0];
    int most = context->max_texture_size;
    context->max_texture_size = 10;
    gl_texture_set *set = make_set(&f, context);
    warning_count = 0;
    assert_int_equal(gl_texture_update(set, &use, &test_log, 1, NULL), FACET_OK);
    assert_int_equal(gl_texture_update(set, &use, &test_log, 1, NULL), FACET_OK);
    assert_int_equal(warning_count, 1);
    assert_string_equal(
        warning, "fixture: image 0: 37 x 9 texels exceed OpenGL's maximum of 10; it is drawn with 9 x 2");
    assert_uploaded(gl_texture_name(set, 0, true), want.pyramid[1], 2);
    assert_uploaded(gl_texture_name(set, 0, false), want.pyramid[0], 2);
    gl_texture_destroy(set);
    context->max_texture_size = most;
    gl_context_release(context);
    texture_store_destroy(store);
    fixture_destroy(&f);
}

/* An image that cannot be decoded reads as white, with one warning. */
static void broken_images_are_white_with_one_warning(void **state)
{
    (void)state;
    fixture f = fixture_create();
    add(&f, 8, 8, 4, IMAGE_U8);
    f.scene->images[0].size = 60;
    f.scene->images[0].width = 0;
    texture_use use = {.is_read_as_color = true};
    gl_texture_set *set = make_set(&f, &contexts.items[0]);
    warning_count = 0;
    for (int i = 0; i < 2; i++)
        assert_int_equal(gl_texture_update(set, &use, &test_log, 1, NULL), FACET_OK);
    assert_int_equal(warning_count, 1);
    assert_int_equal(gl_texture_name(set, 0, true), 0);
    gl_texture_destroy(set);
    gl_context_release(&contexts.items[0]);
    fixture_destroy(&f);
}

static int sampler_parameter(uint32_t sampler, GLenum name)
{
    GLint value;
    glGetSamplerParameteriv(sampler, name, &value);
    return value;
}

static void samplers_follow_gltf(void **state)
{
    (void)state;
    fixture f = fixture_create();
    add(&f, 4, 4, 4, IMAGE_U8);
    scene_texture *t = f.scene->textures;
    t[1] = t[0];
    t[1].wrap_u = SCENE_WRAP_CLAMP;
    t[1].wrap_v = SCENE_WRAP_MIRROR;
    t[1].mag_filter = SCENE_FILTER_NEAREST;
    t[1].min_filter = SCENE_FILTER_NEAREST;
    t[1].mip_filter = SCENE_MIP_LINEAR;
    t[2] = t[0];
    t[2].mip_filter = SCENE_MIP_NONE;
    f.scene->texture_count = 3;
    texture_use uses[3] = {{.is_read_as_data = true}, {.is_read_as_data = true}, {.is_read_as_data = true}};
    for (int k = 0; k < contexts.count; k++) {
        gl_texture_set *set = make_set(&f, &contexts.items[k]);
        assert_int_equal(gl_texture_update(set, uses, &test_log, 1, NULL), FACET_OK);
        assert_int_equal(gl_texture_name(set, 0, false), gl_texture_name(set, 1, false)); /* one image */
        uint32_t plain = gl_texture_sampler(set, 0);
        uint32_t other = gl_texture_sampler(set, 1);
        assert_int_equal(plain, gl_texture_sampler(set, 0));
        assert_int_not_equal(plain, other);
        assert_int_equal(sampler_parameter(plain, GL_TEXTURE_WRAP_S), GL_REPEAT);
        assert_int_equal(sampler_parameter(plain, GL_TEXTURE_WRAP_T), GL_REPEAT);
        assert_int_equal(sampler_parameter(plain, GL_TEXTURE_MAG_FILTER), GL_LINEAR);
        assert_int_equal(sampler_parameter(plain, GL_TEXTURE_MIN_FILTER), GL_LINEAR_MIPMAP_LINEAR);
        assert_int_equal(sampler_parameter(other, GL_TEXTURE_WRAP_S), GL_CLAMP_TO_EDGE);
        assert_int_equal(sampler_parameter(other, GL_TEXTURE_WRAP_T), GL_MIRRORED_REPEAT);
        assert_int_equal(sampler_parameter(other, GL_TEXTURE_MAG_FILTER), GL_NEAREST);
        assert_int_equal(sampler_parameter(other, GL_TEXTURE_MIN_FILTER), GL_NEAREST_MIPMAP_LINEAR);
        assert_int_equal(sampler_parameter(gl_texture_sampler(set, 2), GL_TEXTURE_MIN_FILTER), GL_LINEAR);
        gl_texture_destroy(set);
        gl_context_release(&contexts.items[k]);
    }
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(texels_equal_the_decoded_image),
                                       cmocka_unit_test(images_beyond_the_limit_start_at_a_coarser_level),
                                       cmocka_unit_test(broken_images_are_white_with_one_warning),
                                       cmocka_unit_test(samplers_follow_gltf)};
    if (!gl_fixture_open(&contexts))
        return 77;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gl_fixture_close(&contexts);
    return failed;
}
