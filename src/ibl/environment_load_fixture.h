/* environment_load_fixture.h - for tests of environments from files: encoded images and cube maps of a smooth
 * radiance, loaded. Include after cmocka.h. */
#ifndef IBL_ENVIRONMENT_LOAD_FIXTURE_H
#define IBL_ENVIRONMENT_LOAD_FIXTURE_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "ibl/cube_layout.h"
#include "ibl/environment.h"
#include "image/image_test.h"
#include "image/ktx2_test_file.h"
#include "image/ktx_write.h"
#include "tests/support/support.h"

/* Encoded images. */
typedef struct bytes {
    unsigned char *data;
    size_t size;
} bytes;

enum { SIZE = 16 };

/* Radiance of a direction, smooth, above 0, other on all sides. */
static inline void get_radiance(const double d[3], float out[3])
{
    double scale = 1.0 / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int i = 0; i < 3; i++)
        out[i] = (float)(1.0 + 0.9 * d[i] * scale);
}

static inline cube make_cube(uint32_t size)
{
    cube c;
    assert_int_equal(cube_create(size, NULL, &c, NULL), FACET_OK);
    for (uint32_t i = 0; i < 6 * size * size; i++) {
        double d[3];
        float radiance[3];
        uint32_t x = i % size, y = i / size % size;
        cube_direction(i / size / size, (2.0 * x + 1.0) / size - 1.0, (2.0 * y + 1.0) / size - 1.0, d);
        get_radiance(d, radiance);
        *cube_texel(&c, i / size / size, (int)x, (int)y) =
            (rgbx){radiance[0], radiance[1], radiance[2], 0.0f};
    }
    cube_fill_borders(&c);
    return c;
}

static inline bytes encode_pfm(const image *rgb)
{
    bytes b;
    assert_int_equal(image_encode(rgb, IMAGE_CODEC_PFM, NULL, &b.data, &b.size, NULL), FACET_OK);
    return b;
}

static inline image uniform_image(uint32_t width, uint32_t height, float value)
{
    image i;
    assert_int_equal(image_create(NULL, width, height, 3, IMAGE_F32, &i, NULL), FACET_OK);
    for (size_t k = 0; k < 3 * (size_t)width * height; k++)
        ((float *)i.pixels)[k] = value;
    return i;
}

static inline bytes encode_layout(const cube *c, facet_layout layout)
{
    image rgba, rgb;
    assert_int_equal(layout_write(c, layout, 0, NULL, 1, &rgba, NULL), FACET_OK);
    assert_int_equal(image_convert(&rgba, NULL, 1, 3, IMAGE_F32, false, &rgb, NULL), FACET_OK);
    bytes b = encode_pfm(&rgb);
    image_destroy(&rgba);
    image_destroy(&rgb);
    return b;
}

static inline bytes encode_ktx2(const cube *c, facet_texel_format format, uint32_t zstd_level)
{
    facet_image_view faces[6];
    for (uint32_t i = 0; i < 6; i++)
        faces[i] = (facet_image_view){
            "", c->size, c->size, 4, (const float *)cube_texel(c, i, 0, 0), (c->size + 2) * sizeof(rgbx)};
    bytes b;
    if (ktx2_write(&(ktx2_write_desc){.format = format,
                                      .zstd_level = zstd_level,
                                      .level_count = 1,
                                      .face_count = 6,
                                      .images = faces,
                                      .is_opaque = true,
                                      .writer = "test"},
                   &b.data, &b.size, NULL) != FACET_OK)
        b = (bytes){NULL, 0}; /* without libzstd */
    return b;
}

static inline facet_environment *load(bytes b, facet_layout layout, captured_messages *m)
{
    facet_environment_desc desc = {.layout = layout, .log = m ? capture_log(m) : (facet_log){0}};
    facet_environment *e = NULL;
    facet_error error;
    if (facet_environment_load_memory(b.data, b.size, "made", &desc, &e, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return e;
}

static inline facet_environment_info get_info(const facet_environment *e)
{
    facet_environment_info info;
    assert_int_equal(facet_environment_get_info(e, &info, NULL), FACET_OK);
    return info;
}

static inline void check_refused(bytes b, const facet_environment_desc *desc, facet_result wanted,
                                 const char *words)
{
    facet_environment *e = (facet_environment *)8;
    facet_error error = {0};
    facet_result result = facet_environment_load_memory(b.data, b.size, "made", desc, &e, &error);
    if (result != wanted || !strstr(error.message, words) || strncmp(error.message, "made: ", 6) != 0)
        fail_msg("%d instead of %d: %s", (int)result, (int)wanted, error.message);
    assert_null(e);
}

static inline void set_texel(image *i, uint32_t x, uint32_t y, float r, float g, float b)
{
    float *p = (float *)i->pixels + 3 * ((size_t)y * i->width + x);
    p[0] = r;
    p[1] = g;
    p[2] = b;
}

#endif
