/* environment_load_test.c - environments from every layout, cube maps of KTX2 and six files, what is
 * repaired in them, what is refused, and what they say of themselves. */
#define _DEFAULT_SOURCE
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "base/file.h"
#include "base/memory.h"
#include "ibl/cube_layout.h"
#include "ibl/environment.h"
#include "ibl/equirect.h"
#include "image/codec.h"
#include "image/exr_test_file.h"
#include "image/ktx2_test_file.h"
#include "image/ktx_write.h"

typedef struct messages {
    int count;
    char last[1024];
} messages;

static void keep_message(void *user, facet_log_level level, const char *text)
{
    messages *m = user;
    (void)level;
    m->count++;
    snprintf(m->last, sizeof m->last, "%s", text);
}

/* Encoded images. */
typedef struct bytes {
    unsigned char *data;
    size_t size;
} bytes;

enum { SIZE = 16 };

/* Radiance of a direction, smooth, above 0, other on all sides. */
static void get_radiance(const double d[3], float out[3])
{
    double scale = 1.0 / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int i = 0; i < 3; i++)
        out[i] = (float)(1.0 + 0.9 * d[i] * scale);
}

static cube make_cube(uint32_t size)
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

static bytes encode_pfm(const image *rgb)
{
    bytes b;
    assert_int_equal(image_encode(rgb, IMAGE_CODEC_PFM, NULL, &b.data, &b.size, NULL), FACET_OK);
    return b;
}

static image make_image(uint32_t width, uint32_t height, float value)
{
    image i;
    assert_int_equal(image_create(NULL, width, height, 3, IMAGE_F32, &i, NULL), FACET_OK);
    for (size_t k = 0; k < 3 * (size_t)width * height; k++)
        ((float *)i.pixels)[k] = value;
    return i;
}

static bytes encode_layout(const cube *c, facet_layout layout)
{
    image rgba, rgb;
    assert_int_equal(layout_write(c, layout, 0, NULL, 1, &rgba, NULL), FACET_OK);
    assert_int_equal(image_convert(&rgba, NULL, 1, 3, IMAGE_F32, false, &rgb, NULL), FACET_OK);
    bytes b = encode_pfm(&rgb);
    image_destroy(&rgba);
    image_destroy(&rgb);
    return b;
}

static bytes encode_ktx2(const cube *c, facet_texel_format format, uint32_t zstd_level)
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

static facet_environment *load(bytes b, facet_layout layout, messages *m)
{
    facet_environment_desc desc = {.layout = layout, .log = {m, m ? keep_message : NULL}};
    facet_environment *e = NULL;
    facet_error error;
    if (facet_environment_load_memory(b.data, b.size, "made", &desc, &e, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return e;
}

static facet_environment_info get_info(const facet_environment *e)
{
    facet_environment_info info;
    assert_int_equal(facet_environment_get_info(e, &info, NULL), FACET_OK);
    return info;
}

/* The image that is rendered with shows get_radiance(), to tolerance. */
static void check_image(const facet_environment *e, double tolerance)
{
    for (uint32_t i = 0; i < 2048; i++) {
        float d[3], got[3], wanted[3];
        equirect_direction(64, 32, i % 64, i / 64, d);
        equirect_lookup(&e->panorama, d, got);
        get_radiance((const double[3]){(double)d[0], (double)d[1], (double)d[2]}, wanted);
        for (int k = 0; k < 3; k++)
            if (!(fabs((double)(got[k] - wanted[k])) < tolerance))
                fail_msg("(%g %g %g): channel %d is %g, not %g", (double)d[0], (double)d[1], (double)d[2], k,
                         (double)got[k], (double)wanted[k]);
    }
}

static void check_faces(const facet_environment *e, const cube *c)
{
    assert_int_equal(e->faces.size, c->size);
    for (uint32_t face = 0; face < 6; face++)
        for (int y = -1; y <= (int)c->size; y++)
            for (int x = -1; x <= (int)c->size; x++)
                assert_memory_equal(cube_texel(&e->faces, face, x, y), cube_texel(c, face, x, y), 12);
}

static void check_mean(const facet_environment *e, const cube *c, double tolerance)
{
    double mean[3], panorama[3] = {0.0, 0.0, 0.0}, whole = 0.0;
    const facet_environment_info info = get_info(e);
    cube_mean(c, mean);
    const float *p = e->panorama.pixels;
    for (uint32_t y = 0; y < e->panorama.height; y++)
        for (uint32_t x = 0; x < e->panorama.width; x++, p += 3) {
            double w = equirect_texel_solid_angle(e->panorama.width, e->panorama.height, y);
            whole += w;
            for (int k = 0; k < 3; k++)
                panorama[k] += w * (double)p[k];
        }
    for (int k = 0; k < 3; k++) {
        assert_true(fabs(info.mean[k] / mean[k] - 1.0) < tolerance);
        assert_true(fabs(panorama[k] / whole / mean[k] - 1.0) < tolerance);
    }
}

/* An image as an OpenEXR file with the attribute envmap. */
static bytes encode_exr(const image *rgb, unsigned char envmap)
{
    static const char *const names[3] = {"R", "G", "B"};
    const image_layer layer = {.channel_names = names,
                               .channel_count = 3,
                               .pixels = rgb->pixels,
                               .row_stride_bytes = image_row_size(rgb)};
    bytes plain, b;
    assert_int_equal(
        image_encode_exr(rgb->width, rgb->height, &layer, 1, false, NULL, &plain.data, &plain.size, NULL),
        FACET_OK);
    b.data = exr_with_attribute(plain.data, plain.size, (rgb->height + 15) / 16, "envmap", "envmap", &envmap,
                                1, &b.size);
    mem_free(plain.data);
    return b;
}

/* CubeMap::direction() and CubeMap::pixelPosition() of OpenEXR's ImfEnvmap.cpp: column and row of a face
 * grow with these axes, 1 to 3 for x to z, negative against them; texels at their centres, as everywhere
 * in facet. */
static void openexr_cubes_are_not_mirrored(void **state)
{
    (void)state;
    if (!image_codec_is_built(IMAGE_CODEC_EXR))
        skip();
    static const signed char column[6] = {3, -3, 1, 1, -1, 1}, row[6] = {-2, -2, -3, 3, -2, -2};
    image strip = make_image(SIZE, 6 * SIZE, 0.0f);
    for (uint32_t i = 0; i < 6 * SIZE * SIZE; i++) {
        const uint32_t face = i / SIZE / SIZE;
        const double u = (2.0 * (i % SIZE) + 1.0) / SIZE - 1.0,
                     v = (2.0 * (i / SIZE % SIZE) + 1.0) / SIZE - 1.0;
        double d[3];
        d[face / 2] = face % 2 ? -1.0 : 1.0;
        d[abs(column[face]) - 1] = column[face] > 0 ? u : -u;
        d[abs(row[face]) - 1] = row[face] > 0 ? v : -v;
        get_radiance(d, (float *)strip.pixels + 3 * (size_t)i);
    }
    cube c = make_cube(SIZE);
    bytes b = encode_exr(&strip, 1);
    messages m = {0};
    facet_environment *e = load(b, FACET_LAYOUT_AUTO, &m);
    assert_int_equal(get_info(e).layout, FACET_LAYOUT_STRIP_VERTICAL);
    assert_int_equal(m.count, 0);
    check_image(e, 0.006);
    check_mean(e, &c, 1e-5);
    facet_environment_destroy(e);
    cube_destroy(&c);
    free(b.data);
    image_destroy(&strip);
}

/* A panorama that says so is none of a cross, whatever its edges. */
static void openexr_panoramas_are_detected_by_their_attribute(void **state)
{
    (void)state;
    if (!image_codec_is_built(IMAGE_CODEC_EXR))
        skip();
    image i = make_image(16, 12, 1.0f);
    for (unsigned char envmap = 0; envmap < 3; envmap++) { /* lat-long, a cube that is none, unknown */
        bytes b = encode_exr(&i, envmap);
        facet_environment *e = load(b, FACET_LAYOUT_AUTO, NULL);
        assert_int_equal(get_info(e).layout,
                         envmap == 0 ? FACET_LAYOUT_EQUIRECTANGULAR : FACET_LAYOUT_CROSS_HORIZONTAL);
        facet_environment_destroy(e);
        free(b.data);
    }
    image_destroy(&i);
}

static void layouts_are_detected_by_their_edges(void **state)
{
    (void)state;
    cube c = make_cube(SIZE);
    for (int layout = FACET_LAYOUT_CROSS_HORIZONTAL; layout <= FACET_LAYOUT_STRIP_VERTICAL; layout++)
        for (int is_stated = 0; is_stated < 2; is_stated++) {
            messages m = {0};
            bytes b = encode_layout(&c, (facet_layout)layout);
            facet_environment *e = load(b, is_stated ? (facet_layout)layout : FACET_LAYOUT_AUTO, &m);
            facet_environment_info info = get_info(e);
            assert_int_equal(info.layout, layout);
            assert_int_equal(info.width, SIZE);
            assert_int_equal(info.height, SIZE);
            assert_int_equal(info.repaired_texels, 0);
            assert_int_equal(m.count, 0);
            check_faces(e, &c);
            check_image(e, 0.006);
            check_mean(e, &c, 1e-5);
            facet_environment_destroy(e);
            mem_free(b.data);
        }
    bytes b = encode_layout(&c, FACET_LAYOUT_EQUIRECTANGULAR);
    facet_environment *e = load(b, FACET_LAYOUT_AUTO, NULL);
    facet_environment_info info = get_info(e);
    assert_int_equal(info.layout, FACET_LAYOUT_EQUIRECTANGULAR);
    assert_int_equal(info.width, 4 * SIZE);
    assert_int_equal(info.height, 2 * SIZE);
    assert_null(e->faces.texels);
    check_image(e, 0.02);
    facet_environment_destroy(e);
    mem_free(b.data);
    b = encode_layout(&c, FACET_LAYOUT_OCTAHEDRAL);
    e = load(b, FACET_LAYOUT_OCTAHEDRAL, NULL);
    info = get_info(e);
    assert_int_equal(info.layout, FACET_LAYOUT_OCTAHEDRAL);
    assert_int_equal(info.width, 2 * SIZE);
    assert_int_equal(info.height, 2 * SIZE);
    check_image(e, 0.03);
    check_mean(e, &c, 1e-3);
    facet_environment_destroy(e);
    mem_free(b.data);
    cube_destroy(&c);
}

/* A sun of one texel in a cube map: all of its light is in the image, and the sharp faces are kept. */
static void suns_keep_their_energy(void **state)
{
    (void)state;
    cube c = make_cube(SIZE);
    *cube_texel(&c, 2, 3, 12) = (rgbx){1e6f, 9e5f, 5e5f, 0.0f};
    cube_fill_borders(&c);
    bytes b = encode_layout(&c, FACET_LAYOUT_CROSS_VERTICAL);
    facet_environment *e = load(b, FACET_LAYOUT_AUTO, NULL);
    check_faces(e, &c);
    check_mean(e, &c, 1e-5);
    assert_true(get_info(e).max_radiance == 1e6f);
    facet_environment_destroy(e);
    mem_free(b.data);
    cube_destroy(&c);
}

static void cubes_of_ktx2(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        cube c = make_cube(SIZE);
        bytes b =
            encode_ktx2(&c, k < 2 ? FACET_TEXEL_FORMAT_RGBA32F : FACET_TEXEL_FORMAT_RGB9E5, k % 2 ? 3 : 0);
        messages m = {0};
        if (b.data) {
            facet_environment *e = load(b, k == 1 ? FACET_LAYOUT_CROSS_VERTICAL : FACET_LAYOUT_AUTO, &m);
            facet_environment_info info = get_info(e);
            assert_int_equal(info.layout, FACET_LAYOUT_FACES);
            assert_int_equal(info.width, SIZE);
            assert_int_equal(m.count, 0);
            if (k < 2)
                check_faces(e, &c);
            check_image(e, 0.01);
            check_mean(e, &c, k < 2 ? 1e-5 : 1e-3);
            facet_environment_destroy(e);
        }
        mem_free(b.data);
        cube_destroy(&c);
    }
}

static void check_refused(bytes b, const facet_environment_desc *desc, facet_result wanted, const char *words)
{
    facet_environment *e = (facet_environment *)8;
    facet_error error = {0};
    facet_result result = facet_environment_load_memory(b.data, b.size, "made", desc, &e, &error);
    if (result != wanted || !strstr(error.message, words) || strncmp(error.message, "made: ", 6) != 0)
        fail_msg("%d instead of %d: %s", (int)result, (int)wanted, error.message);
    assert_null(e);
}

static void ktx2_that_is_no_environment(void **state)
{
    (void)state;
    static const unsigned char texels[12 * 4 * 4 * 4] = {0};
    static const struct {
        uint32_t width, height, layers, faces, levels;
        facet_result result;
        const char *words;
    } cases[] = {
        {4, 4, 2, 6, 1, FACET_ERROR_UNSUPPORTED, "KTX2: an array of 2 textures"},
        {4, 2, 3, 1, 1, FACET_ERROR_UNSUPPORTED, "KTX2: an array of 3 textures"},
        {4, 3, 0, 6, 1, FACET_ERROR_INVALID,
         "faceCount: 1, or 6 of a square image, was expected, not 6 of 4 x 3"},
        {4, 4, 0, 5, 1, FACET_ERROR_INVALID,
         "faceCount: 1, or 6 of a square image, was expected, not 5 of 4 x 4"},
        {4, 4, 0, 6, 9, FACET_ERROR_INVALID, "levelCount: 4 x 4 texels do not have 9 levels"},
        {4, 4, 0, 1, 1, FACET_ERROR_INVALID,
         "4 x 4 texels: an environment is 2:1 (equirectangular), 4:3 or 3:4"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        ktx2_test_file f = {.vk_format = 37,
                            .width = cases[k].width,
                            .height = cases[k].height,
                            .layers = cases[k].layers,
                            .faces = cases[k].faces,
                            .levels = cases[k].levels,
                            .model = 1,
                            .transfer = 1};
        f.bytes[0] = texels;
        f.sizes[0] = (size_t)4 * f.width * f.height * f.faces * (f.layers ? f.layers : 1);
        for (uint32_t i = 1; i < f.levels; i++)
            f.bytes[i] = texels;
        bytes b;
        b.data = ktx2_test_write(&f, &b.size);
        check_refused(b, NULL, cases[k].result, cases[k].words);
        free(b.data);
    }
    /* levels that are to be made of level 0: it is there */
    ktx2_test_file f = {.vk_format = 37, .width = 4, .height = 4, .faces = 6, .model = 1, .transfer = 1};
    f.bytes[0] = texels;
    f.sizes[0] = 6 * 64;
    bytes b;
    b.data = ktx2_test_write(&f, &b.size);
    facet_environment *e = load(b, FACET_LAYOUT_AUTO, NULL);
    assert_int_equal(get_info(e).width, 4);
    facet_environment_destroy(e);
    check_refused(b, &(facet_environment_desc){.max_size = 3}, FACET_ERROR_LIMIT,
                  "more than 3 along an edge");
    free(b.data);
}

/* Any end of a file is an error or an image, never a crash. */
static void files_that_end_early(void **state)
{
    (void)state;
    cube c = make_cube(4);
    for (int k = 0; k < 3; k++) {
        bytes b = k == 0 ? encode_layout(&c, FACET_LAYOUT_CROSS_HORIZONTAL)
                         : encode_ktx2(&c, FACET_TEXEL_FORMAT_B10G11R11, k == 1 ? 0 : 3);
        for (size_t cut = 0; cut < b.size; cut++) {
            facet_environment *e = NULL;
            if (facet_environment_load_memory(b.data, cut, "cut", NULL, &e, NULL) == FACET_OK)
                facet_environment_destroy(e);
            else
                assert_null(e);
        }
        mem_free(b.data);
    }
    cube_destroy(&c);
}

/* ---- six files ---- */

typedef struct folder {
    char path[64], names[6][96];
    const char *paths[6];
} folder;

static folder *make_folder(const cube *c, const uint32_t edges[6][2])
{
    folder *f = calloc(1, sizeof *f);
    snprintf(f->path, sizeof f->path, "/tmp/facet-faces-XXXXXX");
    assert_non_null(mkdtemp(f->path));
    for (uint32_t face = 0; face < 6; face++) {
        image i = make_image(edges ? edges[face][0] : c->size, edges ? edges[face][1] : c->size, 1.0f);
        for (uint32_t k = 0; k < i.width * i.height && !edges; k++)
            memcpy((float *)i.pixels + 3 * (size_t)k,
                   cube_texel(c, face, (int)(k % i.width), (int)(k / i.width)), 12);
        bytes b = encode_pfm(&i);
        snprintf(f->names[face], sizeof f->names[face], "%s/%u.pfm", f->path, face);
        f->paths[face] = f->names[face];
        assert_int_equal(file_write(f->names[face], b.data, b.size, NULL), FACET_OK);
        mem_free(b.data);
        image_destroy(&i);
    }
    return f;
}

static void remove_folder(folder *f)
{
    for (int i = 0; i < 6; i++)
        unlink(f->names[i]);
    rmdir(f->path);
    free(f);
}

static void six_files(void **state)
{
    (void)state;
    cube c = make_cube(SIZE);
    (*cube_texel(&c, 3, 5, 2))[1] = -1.0f;
    folder *f = make_folder(&c, NULL);
    (*cube_texel(&c, 3, 5, 2))[1] = 0.0f;
    cube_fill_borders(&c);
    messages m = {0};
    facet_environment_desc desc = {.log = {&m, keep_message}};
    facet_environment *e = NULL;
    facet_error error;
    assert_int_equal(facet_environment_load_faces(f->paths, &desc, &e, &error), FACET_OK);
    check_faces(e, &c);
    check_mean(e, &c, 1e-5);
    facet_environment_info info = get_info(e);
    assert_int_equal(info.layout, FACET_LAYOUT_FACES);
    assert_int_equal(info.width, SIZE);
    assert_int_equal(info.repaired_texels, 1);
    assert_int_equal(m.count, 1);
    assert_non_null(
        strstr(m.last, "faces: 1 texel is NaN, infinity or less than 0, the first at (5, 2) of "));
    assert_non_null(strstr(m.last, f->names[3]));
    facet_environment_destroy(e);
    f->paths[4] = "/does/not/exist.hdr";
    assert_int_equal(facet_environment_load_faces(f->paths, NULL, &e, &error), FACET_ERROR_READ);
    assert_null(e);
    assert_non_null(strstr(error.message, "/does/not/exist.hdr"));
    remove_folder(f);
    f = make_folder(NULL, (const uint32_t[6][2]){{4, 4}, {4, 4}, {4, 4}, {8, 8}, {4, 4}, {4, 4}});
    assert_int_equal(facet_environment_load_faces(f->paths, NULL, &e, &error), FACET_ERROR_INVALID);
    assert_non_null(strstr(error.message, "3.pfm has 8 texels along an edge, face +X has 4"));
    remove_folder(f);
    f = make_folder(NULL, (const uint32_t[6][2]){{4, 4}, {4, 4}, {4, 5}, {4, 4}, {4, 4}, {4, 4}});
    assert_int_equal(facet_environment_load_faces(f->paths, NULL, &e, &error), FACET_ERROR_INVALID);
    assert_non_null(strstr(error.message, "2.pfm: 4 x 5 texels: faces of a cube are square"));
    remove_folder(f);
    cube_destroy(&c);
}

/* ---- repairs ---- */

static void set_texel(image *i, uint32_t x, uint32_t y, float r, float g, float b)
{
    float *p = (float *)i->pixels + 3 * ((size_t)y * i->width + x);
    p[0] = r;
    p[1] = g;
    p[2] = b;
}

/* Invalid texels are counted, reported once, and replaced. */
static void what_is_no_radiance(void **state)
{
    (void)state;
    image i = make_image(64, 32, 1.0f);
    set_texel(&i, 40, 20, INFINITY, -INFINITY, NAN); /* one texel, three times */
    set_texel(&i, 13, 9, 0.5f, -1e-20f, 2.0f);
    set_texel(&i, 14, 9, -0.0f, 0.0f, 2.0f); /* nothing wrong */
    set_texel(&i, 3, 31, 1e30f, 1.0f, 1.0f); /* finite */
    for (int k = 0; k < 2; k++) {
        bytes b;
        const char *const names[] = {"R", "G", "B"};
        const image_layer layer = {names, 3, i.pixels, image_row_size(&i), false};
        b = encode_pfm(&i);
        if (k == 1) {
            mem_free(b.data);
            if (image_encode_exr(64, 32, &layer, 1, true, NULL, &b.data, &b.size, NULL) != FACET_OK)
                break; /* without OpenEXR */
        }
        messages m = {0};
        facet_environment *e = load(b, FACET_LAYOUT_AUTO, &m);
        const float *p = e->panorama.pixels;
        assert_int_equal(get_info(e).repaired_texels, 2); /* as half, 1e30 is infinity as well */
        assert_int_equal(m.count, 1);
        assert_non_null(strstr(m.last, "made: 2 texels are NaN, infinity or less than 0"));
        if (k == 0)
            assert_non_null(strstr(m.last, "the first at (13, 9)"));
        else /* as half, -1e-20 is -0 */
            assert_non_null(strstr(m.last, "the first at (40, 20)"));
        const float *bad = p + 3 * (20 * 64 + 40);
        assert_true(bad[0] == (k ? 65504.0f : ENVIRONMENT_MAX_RADIANCE) && bad[1] == 0.0f && bad[2] == 0.0f);
        assert_true(p[3 * (9 * 64 + 13) + 1] == 0.0f);
        assert_true(p[3 * 31 * 64 + 9] == (k ? 65504.0f : ENVIRONMENT_MAX_RADIANCE));
        facet_environment_destroy(e);
        mem_free(b.data);
    }
    image_destroy(&i);
}

/* Numbers of a KTX2 file are looked at before its reader repairs them. */
static void what_is_no_radiance_in_ktx2(void **state)
{
    (void)state;
    static unsigned char texels[6 * 4 * 8];
    ktx2_test_file f = {
        .vk_format = 97, .width = 2, .height = 2, .faces = 6, .levels = 1, .model = 1, .transfer = 1};
    f.bytes[0] = texels;
    f.sizes[0] = sizeof texels;
    texels[4 * 8 * 2 + 2 * 8 + 1] = 0x7c; /* face +Y, texel (0, 1): red is infinite */
    texels[4 * 8 * 5 + 3 * 8 + 2] = 1;    /* face -Z, texel (1, 1): green is NaN */
    texels[4 * 8 * 5 + 3 * 8 + 3] = 0x7c;
    bytes b;
    b.data = ktx2_test_write(&f, &b.size);
    messages m = {0};
    facet_environment *e = load(b, FACET_LAYOUT_AUTO, &m);
    assert_int_equal(get_info(e).repaired_texels, 2);
    assert_int_equal(m.count, 1);
    assert_non_null(
        strstr(m.last, "made: 2 texels are NaN, infinity or less than 0, the first at (0, 1) of face +Y"));
    assert_true((*cube_texel(&e->faces, 2, 0, 1))[0] == 65504.0f);
    assert_true((*cube_texel(&e->faces, 5, 1, 1))[1] == 0.0f);
    facet_environment_destroy(e);
    free(b.data);
}

/* ---- images that are no layout ---- */

static void other_ratios(void **state)
{
    (void)state;
    static const struct {
        uint32_t width, height;
        facet_layout layout;
        facet_result result;
        int warnings;
        const char *words;
    } cases[] = {
        {7, 5, FACET_LAYOUT_AUTO, FACET_ERROR_INVALID, 0,
         "7 x 5 texels: an environment is 2:1 (equirectangular), 4:3 or 3:4 (cross), 6:1 or 1:6 (strip of "
         "faces)"},
        {1, 1, FACET_LAYOUT_AUTO, FACET_ERROR_INVALID, 0, "NAME{face}.EXT; for any other shape"},
        {19, 9, FACET_LAYOUT_AUTO, FACET_ERROR_INVALID, 0, "19 x 9"},
        {41, 20, FACET_LAYOUT_AUTO, FACET_OK, 1, "41 x 20 texels: an equirectangular image is twice as wide"},
        {7, 5, FACET_LAYOUT_EQUIRECTANGULAR, FACET_OK, 1, "stretched over the sphere"},
        {1, 1, FACET_LAYOUT_EQUIRECTANGULAR, FACET_OK, 1, "stretched over the sphere"},
        {1, 1, FACET_LAYOUT_OCTAHEDRAL, FACET_OK, 0, ""},
        {2, 1, FACET_LAYOUT_AUTO, FACET_OK, 0, ""},
        {4, 3, FACET_LAYOUT_AUTO, FACET_OK, 0, ""},
        {4, 3, FACET_LAYOUT_EQUIRECTANGULAR, FACET_OK, 1, "stretched over the sphere"},
        {4, 4, FACET_LAYOUT_CROSS_VERTICAL, FACET_ERROR_INVALID, 0,
         "4 x 4 texels are not a vertical cross (3:4)"},
        {4, 3, FACET_LAYOUT_FACES, FACET_ERROR_ARGUMENT, 0,
         "the layout of six faces needs six images; this is one"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        image i = make_image(cases[k].width, cases[k].height, 2.0f);
        bytes b = encode_pfm(&i);
        messages m = {0};
        facet_environment_desc desc = {.layout = cases[k].layout, .log = {&m, keep_message}};
        if (cases[k].result != FACET_OK) {
            check_refused(b, &desc, cases[k].result, cases[k].words);
        } else {
            facet_environment *e = load(b, cases[k].layout, &m);
            facet_environment_info info = get_info(e);
            for (int c = 0; c < 3; c++)
                assert_true(fabs(info.mean[c] - 2.0) < 1e-5);
            assert_true(fabsf(info.max_radiance - 2.0f) < 1e-5f);
            facet_environment_destroy(e);
            if (cases[k].warnings)
                assert_non_null(strstr(m.last, cases[k].words));
        }
        assert_int_equal(m.count, cases[k].warnings);
        mem_free(b.data);
        image_destroy(&i);
    }
}

/* Headers that claim much: refused for their edges, or when a budget ends, before the memory is there. */
static void large_claims(void **state)
{
    (void)state;
    static const char *const heads[] = {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16384 +X 32768\n",
                                        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 24576 +X 32768\n",
                                        "PF\n32768 16384\n-1.0\n"};
    facet_budget *budget;
    assert_int_equal(facet_budget_create(64u << 20, &budget, NULL), FACET_OK);
    for (int k = 0; k < 3; k++) {
        bytes b = {malloc(4096), 4096};
        memset(b.data, 2, b.size);
        memcpy(b.data, heads[k], strlen(heads[k]));
        facet_environment *e = NULL;
        facet_environment_desc desc = {.allocator = facet_budget_allocator(budget)};
        facet_result result = facet_environment_load_memory(b.data, b.size, "huge", &desc, &e, NULL);
        assert_true(result == FACET_ERROR_MEMORY || result == FACET_ERROR_INVALID);
        assert_null(e);
        check_refused(b, &(facet_environment_desc){.max_size = 16384}, FACET_ERROR_LIMIT,
                      "more than 16384 along an edge");
        free(b.data);
    }
    assert_int_equal(facet_budget_used_bytes(budget), 0);
    facet_budget_destroy(budget);
}

static void memory_runs_out(void **state)
{
    (void)state;
    cube c = make_cube(4);
    *cube_texel(&c, 1, 1, 1) = rgbx_splat(1e4f);
    for (int k = 0; k < 4; k++) {
        bytes b = k == 0   ? encode_layout(&c, FACET_LAYOUT_CROSS_HORIZONTAL)
                  : k == 1 ? encode_layout(&c, FACET_LAYOUT_OCTAHEDRAL)
                           : encode_ktx2(&c, FACET_TEXEL_FORMAT_RGBA16F, k == 2 ? 0 : 1);
        for (long fail_at = 0; b.data; fail_at = next_failure(fail_at)) {
            failing_allocator f = {.fail_at = fail_at};
            facet_environment_desc desc = {.allocator = failing_allocator_get(&f),
                                           .thread_count = 1,
                                           .layout = k == 1 ? FACET_LAYOUT_OCTAHEDRAL : FACET_LAYOUT_AUTO};
            facet_environment *e = NULL;
            facet_result result = facet_environment_load_memory(b.data, b.size, "made", &desc, &e, NULL);
            facet_environment_destroy(e);
            assert_int_equal(f.blocks, 0);
            if (result == FACET_OK)
                break;
            assert_int_equal(result, FACET_ERROR_MEMORY);
            assert_true(fail_at < 60);
        }
        mem_free(b.data);
    }
    cube_destroy(&c);
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    cube c = make_cube(40);
    *cube_texel(&c, 1, 1, 1) = rgbx_splat(1e4f);
    bytes b = encode_ktx2(&c, FACET_TEXEL_FORMAT_RGBA32F, 0);
    facet_environment *e[2];
    for (uint32_t k = 0; k < 2; k++)
        assert_int_equal(facet_environment_load_memory(b.data, b.size, "made",
                                                       &(facet_environment_desc){.thread_count = 1 + 4 * k},
                                                       &e[k], NULL),
                         FACET_OK);
    assert_memory_equal(e[0]->panorama.pixels, e[1]->panorama.pixels, mem_size(e[0]->panorama.pixels));
    facet_environment_info a = get_info(e[0]), z = get_info(e[1]);
    assert_memory_equal(a.mean, z.mean, sizeof a.mean);
    for (int k = 0; k < 2; k++)
        facet_environment_destroy(e[k]);
    mem_free(b.data);
    cube_destroy(&c);
}

/* The mean is over solid angles, which rows of an image do not share evenly. */
static void what_an_environment_says(void **state)
{
    (void)state;
    image i = make_image(64, 32, 0.0f);
    for (uint32_t k = 0; k < 64 * 16; k++)
        set_texel(&i, k % 64, k / 64, 3.0f, k / 64 < 8 ? 4.0f : 0.0f, 0.0f);
    bytes b = encode_pfm(&i);
    facet_environment *e = load(b, FACET_LAYOUT_AUTO, NULL);
    facet_environment_info info = get_info(e);
    assert_true(fabs(info.mean[0] - 1.5) < 1e-6);
    assert_true(fabs(info.mean[1] - 4.0 * 0.5 * (1.0 - sqrt(0.5))) < 1e-6); /* a cap of 45 degrees */
    assert_true(info.mean[2] == 0.0 && info.max_radiance == 4.0f);
    facet_environment_destroy(e);
    mem_free(b.data);
    image_destroy(&i);
    assert_int_equal(facet_environment_create_constant((const float[3]){1.0f, 2.0f, 3.0f}, NULL, &e, NULL),
                     FACET_OK);
    info = get_info(e);
    assert_int_equal(info.layout, FACET_LAYOUT_EQUIRECTANGULAR);
    assert_int_equal(info.width, 2);
    assert_int_equal(info.height, 1);
    assert_true(fabs(info.mean[2] - 3.0) < 1e-6);
    facet_environment_destroy(e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layouts_are_detected_by_their_edges),
        cmocka_unit_test(openexr_cubes_are_not_mirrored),
        cmocka_unit_test(openexr_panoramas_are_detected_by_their_attribute),
        cmocka_unit_test(suns_keep_their_energy),
        cmocka_unit_test(cubes_of_ktx2),
        cmocka_unit_test(ktx2_that_is_no_environment),
        cmocka_unit_test(files_that_end_early),
        cmocka_unit_test(six_files),
        cmocka_unit_test(what_is_no_radiance),
        cmocka_unit_test(what_is_no_radiance_in_ktx2),
        cmocka_unit_test(other_ratios),
        cmocka_unit_test(large_claims),
        cmocka_unit_test(memory_runs_out),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(what_an_environment_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
