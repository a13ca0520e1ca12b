/* environment_load_test.c - environments from every layout, from cube maps of KTX2 and from six files, and
 * their information. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/file.h"
#include "ibl/environment_load_fixture.h"
#include "ibl/equirect.h"
#include "image/codec.h"

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
    image strip = uniform_image(SIZE, 6 * SIZE, 0.0f);
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
    captured_messages m = {0};
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

/* A panorama with that attribute is not a cross, whatever its edges. */
static void openexr_panoramas_are_detected_by_their_attribute(void **state)
{
    (void)state;
    if (!image_codec_is_built(IMAGE_CODEC_EXR))
        skip();
    image i = uniform_image(16, 12, 1.0f);
    for (unsigned char envmap = 0; envmap < 3; envmap++) { /* panorama, cube map, unknown */
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
            captured_messages m = {0};
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

static void cube_maps_of_ktx2_are_read(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        cube c = make_cube(SIZE);
        bytes b =
            encode_ktx2(&c, k < 2 ? FACET_TEXEL_FORMAT_RGBA32F : FACET_TEXEL_FORMAT_RGB9E5, k % 2 ? 3 : 0);
        captured_messages m = {0};
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

/* ---- six files ---- */

typedef struct folder {
    temporary_folder place;
    char names[6][96];
    const char *paths[6];
} folder;

static folder *make_folder(const cube *c, const uint32_t edges[6][2])
{
    folder *f = calloc(1, sizeof *f);
    temporary_folder_create(&f->place);
    for (uint32_t face = 0; face < 6; face++) {
        image i = uniform_image(edges ? edges[face][0] : c->size, edges ? edges[face][1] : c->size, 1.0f);
        for (uint32_t k = 0; k < i.width * i.height && !edges; k++)
            memcpy((float *)i.pixels + 3 * (size_t)k,
                   cube_texel(c, face, (int)(k % i.width), (int)(k / i.width)), 12);
        bytes b = encode_pfm(&i);
        snprintf(f->names[face], sizeof f->names[face], "%s/%u.pfm", f->place.path, face);
        f->paths[face] = f->names[face];
        assert_int_equal(file_write(f->names[face], b.data, b.size, NULL), FACET_OK);
        mem_free(b.data);
        image_destroy(&i);
    }
    return f;
}

static void remove_folder(folder *f)
{
    temporary_folder_remove(&f->place);
    free(f);
}

static void six_files_make_a_cube_map(void **state)
{
    (void)state;
    cube c = make_cube(SIZE);
    (*cube_texel(&c, 3, 5, 2))[1] = -1.0f;
    folder *f = make_folder(&c, NULL);
    (*cube_texel(&c, 3, 5, 2))[1] = 0.0f;
    cube_fill_borders(&c);
    captured_messages m = {0};
    facet_environment_desc desc = {.log = capture_log(&m)};
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
        strstr(m.text, "faces: 1 texel is NaN, infinity or less than 0, the first at (5, 2) of "));
    assert_non_null(strstr(m.text, f->names[3]));
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

/* ---- the same for all ---- */

static void environments_do_not_depend_on_threads(void **state)
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
static void means_are_over_solid_angle(void **state)
{
    (void)state;
    image i = uniform_image(64, 32, 0.0f);
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
        cmocka_unit_test(cube_maps_of_ktx2_are_read),
        cmocka_unit_test(six_files_make_a_cube_map),
        cmocka_unit_test(environments_do_not_depend_on_threads),
        cmocka_unit_test(means_are_over_solid_angle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
