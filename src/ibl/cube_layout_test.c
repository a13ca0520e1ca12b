/* cube_layout_test.c - cube maps as flat images and back, and resampling between spheres. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "base/memory.h"
#include "ibl/cube_layout.h"
#include "ibl/sphere.h"

static cube make_cube(uint32_t size)
{
    cube c;
    assert_int_equal(cube_create(size, NULL, &c, NULL), FACET_OK);
    return c;
}

/* Texels are halves of the unit vectors of their directions, and a half: radiance is not negative. */
static cube make_directions(uint32_t size)
{
    cube c = make_cube(size);
    for (uint32_t i = 0; i < 6 * size * size; i++) {
        double d[3];
        const uint32_t x = i % size, y = i / size % size;
        cube_direction(i / size / size, (2.0 * x + 1.0) / size - 1.0, (2.0 * y + 1.0) / size - 1.0, d);
        const double scale = 1.0 / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        *cube_texel(&c, i / size / size, (int)x, (int)y) =
            (rgbx){(float)(0.5 + 0.5 * d[0] * scale), (float)(0.5 + 0.5 * d[1] * scale),
                   (float)(0.5 + 0.5 * d[2] * scale), 0.0f};
    }
    cube_fill_borders(&c);
    return c;
}

static image write_layout(const cube *c, facet_layout layout, uint32_t height)
{
    image out;
    facet_error error;
    if (layout_write(c, layout, height, NULL, 2, &out, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return out;
}

static const float *texel_at(const image *i, uint32_t x, uint32_t y)
{
    return (const float *)i->pixels + i->channel_count * ((size_t)y * i->width + x);
}

static const facet_layout face_layouts[] = {FACET_LAYOUT_CROSS_HORIZONTAL, FACET_LAYOUT_CROSS_VERTICAL,
                                            FACET_LAYOUT_STRIP_HORIZONTAL, FACET_LAYOUT_STRIP_VERTICAL};

static void faces_round_trip(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {1, 2, 5, 16};
    for (int k = 0; k < 16; k++) {
        const uint32_t size = sizes[k / 4];
        cube c = make_cube(size);
        for (size_t i = 0; i < 24 * (size_t)size * size; i++) {
            const size_t t = i / 4;
            (*cube_texel(&c, (uint32_t)(t / size / size), (int)(t % size), (int)(t / size % size)))[i % 4] =
                i % 4 == 3 ? NAN : (float)(i * 2654435761u % 1000003) * 0.37f;
        }
        cube_fill_borders(&c);
        image panorama = write_layout(&c, face_layouts[k % 4], 0);
        image rgb;
        cube back;
        assert_int_equal(image_convert(&panorama, NULL, 1, 3, IMAGE_F32, false, &rgb, NULL), FACET_OK);
        assert_int_equal(layout_detect(rgb.width, rgb.height), face_layouts[k % 4]);
        for (int channels = 3; channels <= 4; channels++) {
            assert_int_equal(layout_read(channels == 3 ? &rgb : &panorama,
                                         channels == 3 ? FACET_LAYOUT_AUTO : face_layouts[k % 4], "made",
                                         NULL, 1, &back, NULL),
                             FACET_OK);
            assert_int_equal(back.size, size);
            for (uint32_t face = 0; face < 6; face++)
                for (int y = -1; y <= (int)size; y++)
                    for (int x = -1; x <= (int)size; x++)
                        assert_memory_equal(cube_texel(&back, face, x, y), cube_texel(&c, face, x, y), 12);
            cube_destroy(&back);
        }
        image_destroy(&rgb);
        image_destroy(&panorama);
        cube_destroy(&c);
    }
}

/* Faces of facet.h's description, cell by cell: a letter for the axis, lower case for its negative side;
 * v: -Z turned. */
static void faces_are_where_facet_h_says(void **state)
{
    (void)state;
    static const struct {
        facet_layout layout;
        uint32_t columns, rows;
        const char *cells;
    } cases[] = {
        {FACET_LAYOUT_CROSS_HORIZONTAL, 4, 3, ".Y..xZXz.y.."},
        {FACET_LAYOUT_CROSS_VERTICAL, 3, 4, ".Y.xZX.y..v."},
        {FACET_LAYOUT_STRIP_HORIZONTAL, 6, 1, "XxYyZz"},
        {FACET_LAYOUT_STRIP_VERTICAL, 1, 6, "XxYyZz"},
    };
    enum { SIZE = 8 };
    cube c = make_directions(SIZE);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        image panorama = write_layout(&c, cases[k].layout, 0);
        assert_int_equal(panorama.width, cases[k].columns * SIZE);
        assert_int_equal(panorama.height, cases[k].rows * SIZE);
        for (uint32_t cell = 0; cell < cases[k].columns * cases[k].rows; cell++) {
            const char letter = cases[k].cells[cell];
            const char *at = strchr("XxYyZzv", letter);
            const uint32_t x0 = cell % cases[k].columns * SIZE, y0 = cell / cases[k].columns * SIZE;
            for (uint32_t i = 0; i < SIZE * SIZE; i++) {
                const uint32_t x = i % SIZE, y = i / SIZE;
                const float *texel = texel_at(&panorama, x0 + x, y0 + y);
                assert_true(texel[3] == (letter == '.' ? 0.0f : 1.0f));
                if (letter == '.') {
                    assert_true(texel[0] == 0.0f && texel[1] == 0.0f && texel[2] == 0.0f);
                    continue;
                }
                const uint32_t face = letter == 'v' ? 5 : (uint32_t)(at - "XxYyZzv");
                const rgbx *wanted = letter == 'v'
                                         ? cube_texel(&c, face, SIZE - 1 - (int)x, SIZE - 1 - (int)y)
                                         : cube_texel(&c, face, (int)x, (int)y);
                assert_memory_equal(texel, wanted, 12);
            }
        }
        image_destroy(&panorama);
    }
    cube_destroy(&c);
}

/* Adjacent pixels of a cross, within a face or across faces, are adjacent on the sphere. */
static void neighboring_faces_of_crosses_are_continuous(void **state)
{
    (void)state;
    enum { SIZE = 16 };
    cube c = make_directions(SIZE);
    for (int k = 0; k < 2; k++) {
        image p = write_layout(&c, face_layouts[k], 0);
        uint32_t pairs = 0;
        for (uint32_t y = 0; y < p.height; y++)
            for (uint32_t x = 0; x < p.width; x++)
                for (uint32_t axis = 0; axis < 2; axis++) {
                    const uint32_t x1 = x + (axis == 0), y1 = y + (axis == 1);
                    if (x1 == p.width || y1 == p.height)
                        continue;
                    const float *a = texel_at(&p, x, y), *b = texel_at(&p, x1, y1);
                    if (a[3] == 0.0f || b[3] == 0.0f)
                        continue;
                    const float distance =
                        sqrtf((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                              (a[2] - b[2]) * (a[2] - b[2]));
                    assert_true(distance < 1.01f / SIZE);
                    pairs++;
                }
        assert_int_equal(pairs, 6 * 2 * SIZE * (SIZE - 1) + 5 * SIZE); /* five seams are closed on paper */
        image_destroy(&p);
    }
    cube_destroy(&c);
}

static void check_direction(const image *p, uint32_t x, uint32_t y, float dx, float dy, float dz)
{
    const float *texel = texel_at(p, x, y);
    const float t[3] = {2.0f * texel[0] - 1.0f, 2.0f * texel[1] - 1.0f, 2.0f * texel[2] - 1.0f};
    const float scale = 1.0f / sqrtf(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
    if (!((t[0] * dx + t[1] * dy + t[2] * dz) * scale > 0.99f))
        fail_msg("(%u, %u) of %u x %u is (%g %g %g), not (%g %g %g)", x, y, p->width, p->height, (double)t[0],
                 (double)t[1], (double)t[2], (double)dx, (double)dy, (double)dz);
}

static void directions_are_where_facet_h_says(void **state)
{
    (void)state;
    cube c = make_directions(32);
    image p = write_layout(&c, FACET_LAYOUT_EQUIRECTANGULAR, 0);
    assert_int_equal(p.width, 128);
    assert_int_equal(p.height, 64);
    check_direction(&p, 64, 32, 1, 0, 0);
    check_direction(&p, 96, 32, 0, 0, 1);
    check_direction(&p, 32, 32, 0, 0, -1);
    check_direction(&p, 0, 32, -1, 0, 0);
    check_direction(&p, 10, 0, 0, 1, 0);
    check_direction(&p, 70, 63, 0, -1, 0);
    image_destroy(&p);
    p = write_layout(&c, FACET_LAYOUT_OCTAHEDRAL, 0);
    assert_int_equal(p.width, 64);
    assert_int_equal(p.height, 64);
    check_direction(&p, 32, 32, 0, 1, 0);
    check_direction(&p, 63, 32, 1, 0, 0);
    check_direction(&p, 0, 31, -1, 0, 0);
    check_direction(&p, 31, 63, 0, 0, 1);
    check_direction(&p, 32, 0, 0, 0, -1);
    check_direction(&p, 0, 0, 0, -1, 0);
    check_direction(&p, 63, 0, 0, -1, 0);
    check_direction(&p, 0, 63, 0, -1, 0);
    check_direction(&p, 63, 63, 0, -1, 0);
    check_direction(&p, 63, 63, 0, -1, 0);
    check_direction(&p, 56, 56, 0.3333f * 1.0f, -0.8975f, 0.3333f * 1.0f);
    image_destroy(&p);
    cube_destroy(&c);
}

/* The mean of the directions in a texel, by 4 x 4 of them, and the texel's solid angle. */
static double mean_direction(const sphere *s, size_t texel, double mean[3])
{
    enum { PARTS = 4 };
    const sphere fine = {.kind = s->kind, .width = PARTS * s->width, .height = PARTS * s->height};
    const size_t row = texel / s->width, column = texel % s->width;
    double whole = 0.0;
    mean[0] = mean[1] = mean[2] = 0.0;
    for (size_t i = 0; i < PARTS * PARTS; i++) {
        const size_t part = (PARTS * row + i / PARTS) * fine.width + PARTS * column + i % PARTS;
        float d[3];
        sphere_direction(&fine, part, d);
        const double q = (double)(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        const double step = 2.0 / fine.width;
        const double w =
            s->kind == SPHERE_OCTAHEDRON ? step * step / (q * sqrt(q)) : sphere_solid_angle(&fine, part);
        whole += w;
        for (int k = 0; k < 3; k++)
            mean[k] += w * (double)d[k] / sqrt(q);
    }
    for (int k = 0; k < 3; k++)
        mean[k] /= whole;
    return whole;
}

/* Root mean square over the sphere of the distance between texels and the means of their directions. */
static double direction_error(const sphere *s)
{
    double sum = 0.0, whole = 0.0;
    for (size_t i = 0; i < sphere_texel_count(s); i++) {
        double mean[3];
        const rgbx c = sphere_texel(s, i);
        const double w = mean_direction(s, i, mean);
        whole += w;
        for (int k = 0; k < 3; k++)
            sum += w * pow(2.0 * (double)c[k] - 1.0 - mean[k], 2.0);
    }
    assert_true(fabs(whole / (4.0 * 3.14159265358979) - 1.0) < 5e-3);
    return sqrt(sum / whole);
}

/* A target of kind and height, with memory of its own. */
static sphere make_target(sphere_kind kind, uint32_t height, cube *c, image *panorama)
{
    *c = (cube){0};
    *panorama = (image){0};
    if (kind == SPHERE_CUBE) {
        *c = make_cube(height);
        return sphere_of_cube(c);
    }
    assert_int_equal(image_create(NULL, kind == SPHERE_EQUIRECT ? 2 * height : height, height, 3, IMAGE_F32,
                                  panorama, NULL),
                     FACET_OK);
    return sphere_of_image(kind, panorama);
}

/* From each kind to each, finer, equal and coarser. A smooth function is kept to the second order of the
 * source's texels, which are read bilinearly (the error is largest at the folds of octahedra), also across
 * edges. A shift by a twentieth of a texel would be 1.5e-3. */
static void smooth_functions_are_kept(void **state)
{
    (void)state;
    cube first = make_directions(64);
    sphere original = sphere_of_cube(&first);
    for (int k = 0; k < 27; k++) {
        static const uint32_t heights[3][3] = {{11, 64, 80}, {24, 96, 112}, {24, 128, 131}};
        cube c1, c2;
        image p1, p2;
        sphere source = make_target((sphere_kind)(k % 3), heights[k % 3][1], &c1, &p1);
        sphere target = make_target((sphere_kind)(k / 3 % 3), heights[k / 3 % 3][k / 9], &c2, &p2);
        assert_int_equal(sphere_resample(&original, NULL, NULL, 2, &source, NULL), FACET_OK);
        if (c1.texels)
            cube_fill_borders(&c1);
        assert_int_equal(sphere_resample(&source, NULL, NULL, 2, &target, NULL), FACET_OK);
        const double error = direction_error(&target);
        if (!(error < 8e-4))
            fail_msg("%u of height %u to %u of height %u: %g", source.kind, source.height, target.kind,
                     target.height, error);
        cube_destroy(&c1);
        cube_destroy(&c2);
        image_destroy(&p1);
        image_destroy(&p2);
    }
    cube_destroy(&first);
}

static void get_mean(const sphere *s, double mean[3])
{
    double whole = 0.0;
    mean[0] = mean[1] = mean[2] = 0.0;
    for (size_t i = 0; i < sphere_texel_count(s); i++) {
        const rgbx c = sphere_texel(s, i);
        const double w = sphere_solid_angle(s, i);
        whole += w;
        for (int k = 0; k < 3; k++)
            mean[k] += w * (double)c[k];
    }
    for (int k = 0; k < 3; k++)
        mean[k] /= whole;
}

/* Suns of one texel, a million times as bright as the sky: in the middle of a face, at an edge, in a
 * corner, and where nothing is special; noise everywhere. */
static void energy_is_kept(void **state)
{
    (void)state;
    static const int suns[][3] = {{2, 15, 15}, {0, 31, 7}, {3, 0, 0}};
    static const struct {
        sphere_kind kind;
        uint32_t height;
    } targets[] = {{SPHERE_EQUIRECT, 96},   {SPHERE_EQUIRECT, 64},  {SPHERE_EQUIRECT, 77},
                   {SPHERE_EQUIRECT, 9},    {SPHERE_EQUIRECT, 1},   {SPHERE_OCTAHEDRON, 64},
                   {SPHERE_OCTAHEDRON, 33}, {SPHERE_OCTAHEDRON, 7}, {SPHERE_OCTAHEDRON, 1},
                   {SPHERE_CUBE, 40},       {SPHERE_CUBE, 5},       {SPHERE_CUBE, 1}};
    for (size_t k = 0; k < sizeof suns / sizeof *suns; k++) {
        cube c = make_cube(32);
        for (uint32_t i = 0; i < 6 * 32 * 32; i++)
            *cube_texel(&c, i / 1024, (int)(i % 32), (int)(i / 32 % 32)) =
                rgbx_splat((float)(i * 2654435761u >> 16 & 255) / 255.0f);
        *cube_texel(&c, (uint32_t)suns[k][0], suns[k][1], suns[k][2]) = (rgbx){1e6f, 2e5f, 20.0f, 0.0f};
        cube_fill_borders(&c);
        double wanted[3];
        cube_mean(&c, wanted);
        for (size_t n = 0; n < sizeof targets / sizeof *targets; n++) {
            cube c2;
            image p2;
            sphere source = sphere_of_cube(&c);
            sphere target = make_target(targets[n].kind, targets[n].height, &c2, &p2);
            assert_int_equal(sphere_resample(&source, NULL, NULL, 2, &target, NULL), FACET_OK);
            double mean[3];
            get_mean(&target, mean);
            const double tolerance[3] = {5e-5, 5e-5,
                                         2e-3}; /* the third: noise of few texels, seen at other places */
            for (int i = 0; i < 3; i++)
                if (!(fabs(mean[i] / wanted[i] - 1.0) < tolerance[i]))
                    fail_msg("sun %zu, target %zu, channel %d: %.9g, not %.9g", k, n, i, mean[i], wanted[i]);
            cube_destroy(&c2);
            image_destroy(&p2);
        }
        cube_destroy(&c);
    }
}

/* A uniform patch much brighter than the mean stays uniform although few lookups hit each texel. */
static void bright_patches_stay_uniform(void **state)
{
    (void)state;
    static const uint32_t heights[] = {32, 57, 96};
    cube c = make_cube(32);
    for (uint32_t i = 0; i < 6 * 1024; i++)
        *cube_texel(&c, i / 1024, (int)(i % 32), (int)(i / 32 % 32)) = rgbx_splat(0.125f);
    for (int y = 20; y < 32; y++) /* in a corner of +X */
        for (int x = 20; x < 32; x++)
            *cube_texel(&c, 0, x, y) = (rgbx){1000.0f, 1.0f, 0.0f, 0.0f};
    cube_fill_borders(&c);
    for (int k = 0; k < 3; k++) {
        cube c2;
        image p2;
        sphere source = sphere_of_cube(&c);
        sphere target = make_target(SPHERE_EQUIRECT, heights[k], &c2, &p2);
        assert_int_equal(sphere_resample(&source, NULL, NULL, 2, &target, NULL), FACET_OK);
        uint32_t inside = 0;
        for (size_t i = 0; i < sphere_texel_count(&target); i++) {
            float d[3];
            sphere_direction(&target, i, d);
            cube_point p = cube_locate(d[0], d[1], d[2]);
            const float margin = 3.5f / (float)heights[k] + 1.5f / 16.0f;
            if (p.face != 0 || p.s < 0.25f + margin || p.t < 0.25f + margin || p.s > 1.0f - margin ||
                p.t > 1.0f - margin)
                continue;
            inside++;
            assert_true(fabsf(sphere_texel(&target, i)[0] / 1000.0f - 1.0f) < 0.015f);
            assert_true(fabsf(sphere_texel(&target, i)[1] - 1.0f) <
                        1e-5f); /* not much brighter than the mean */
        }
        assert_true(inside > 0);
        image_destroy(&p2);
    }
    cube_destroy(&c);
}

static void constants_are_kept(void **state)
{
    (void)state;
    static const uint32_t heights[] = {1, 3, 16, 50};
    cube c = make_cube(4);
    for (uint32_t i = 0; i < 6 * 16; i++)
        *cube_texel(&c, i / 16, (int)(i % 4), (int)(i / 4 % 4)) = (rgbx){0.3f, 7.0f, 0.0f, 0.0f};
    cube_fill_borders(&c);
    for (int k = 0; k < 12; k++) {
        cube c2;
        image p2;
        sphere source = sphere_of_cube(&c);
        sphere target = make_target((sphere_kind)(k % 3), heights[k / 3], &c2, &p2);
        assert_int_equal(sphere_resample(&source, &(sphere_turn){.scale = 2.0f}, NULL, 2, &target, NULL),
                         FACET_OK);
        for (size_t i = 0; i < sphere_texel_count(&target); i++) {
            const rgbx t = sphere_texel(&target, i);
            assert_true(fabsf(t[0] / 0.6f - 1.0f) < 3e-6f && fabsf(t[1] / 14.0f - 1.0f) < 3e-6f &&
                        t[2] == 0.0f);
        }
        cube_destroy(&c2);
        image_destroy(&p2);
    }
    cube_destroy(&c);
}

/* A rotation and its inverse; direction d of the target is rows d of the source. */
static void rotations_are_applied(void **state)
{
    (void)state;
    cube c = make_directions(32);
    *cube_texel(&c, 4, 16, 16) = rgbx_splat(1000.0f); /* much brighter than the mean, at +Z */
    cube_fill_borders(&c);
    cube c2;
    image p2;
    sphere source = sphere_of_cube(&c);
    sphere target = make_target(SPHERE_EQUIRECT, 64, &c2, &p2);
    const sphere_turn turn = {
        .is_turned = true, .rows = {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}, .scale = 1.0f}; /* x to z */
    assert_int_equal(sphere_resample(&source, &turn, NULL, 2, &target, NULL), FACET_OK);
    size_t brightest = 0;
    for (size_t i = 0; i < sphere_texel_count(&target); i++)
        brightest = sphere_texel(&target, i)[0] > sphere_texel(&target, brightest)[0] ? i : brightest;
    float d[3];
    sphere_direction(&target, brightest, d);
    assert_true(d[0] > 0.99f);
    const float left[3] = {0.0f, 0.0f, 1.0f};
    const rgbx t = sphere_texel(&target, sphere_locate(&target, left));
    assert_true(t[0] < 0.01f);
    image_destroy(&p2);
    cube_destroy(&c);
}

static void bits_do_not_depend_on_threads(void **state)
{
    (void)state;
    cube c = make_directions(64);
    *cube_texel(&c, 2, 5, 9) = rgbx_splat(1e5f);
    cube_fill_borders(&c);
    image one, many;
    assert_int_equal(layout_write(&c, FACET_LAYOUT_OCTAHEDRAL, 200, NULL, 1, &one, NULL), FACET_OK);
    assert_int_equal(layout_write(&c, FACET_LAYOUT_OCTAHEDRAL, 200, NULL, 7, &many, NULL), FACET_OK);
    assert_memory_equal(one.pixels, many.pixels, 200 * 200 * 16);
    image_destroy(&one);
    image_destroy(&many);
    cube_destroy(&c);
}

static void sizes_that_fit_no_layout_are_refused(void **state)
{
    (void)state;
    static const struct {
        facet_layout layout;
        uint32_t width, height;
        const char *message;
    } cases[] = {
        {FACET_LAYOUT_CROSS_HORIZONTAL, 12, 8, "x: 12 x 8 texels are not a horizontal cross (4:3)"},
        {FACET_LAYOUT_CROSS_VERTICAL, 8, 6, "a vertical cross (3:4)"},
        {FACET_LAYOUT_STRIP_HORIZONTAL, 6, 2, "a horizontal strip (6:1)"},
        {FACET_LAYOUT_STRIP_VERTICAL, 7, 42 + 1, "a vertical strip (1:6)"},
        {FACET_LAYOUT_OCTAHEDRAL, 6, 5, "an octahedral image (1:1)"},
        {FACET_LAYOUT_AUTO, 5, 5, "do not fit any layout of a cube map"},
        {FACET_LAYOUT_FACES, 6, 1, "do not fit any layout of a cube map"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        image panorama;
        cube c;
        facet_error error;
        assert_int_equal(image_create(NULL, cases[k].width, cases[k].height, 3, IMAGE_F32, &panorama, NULL),
                         FACET_OK);
        assert_int_equal(layout_read(&panorama, cases[k].layout, "x", NULL, 1, &c, &error),
                         FACET_ERROR_INVALID);
        assert_null(c.texels);
        assert_non_null(strstr(error.message, cases[k].message));
        image_destroy(&panorama);
    }
    cube c = make_directions(2);
    image out;
    assert_int_equal(layout_write(&c, FACET_LAYOUT_AUTO, 0, NULL, 1, &out, NULL), FACET_ERROR_ARGUMENT);
    assert_int_equal(layout_write(&c, FACET_LAYOUT_FACES, 0, NULL, 1, &out, NULL), FACET_ERROR_ARGUMENT);
    assert_int_equal(layout_write(&c, FACET_LAYOUT_EQUIRECTANGULAR, 0xffffffff, NULL, 1, &out, NULL),
                     FACET_ERROR_ARGUMENT);
    cube_destroy(&c);
    assert_int_equal(layout_detect(8, 4), FACET_LAYOUT_EQUIRECTANGULAR);
    assert_int_equal(layout_detect(8, 8), FACET_LAYOUT_AUTO);
    assert_int_equal(layout_detect(4000000000u, 3000000000u), FACET_LAYOUT_CROSS_HORIZONTAL);
    assert_int_equal(layout_detect(0xfffffffe, 0x7fffffff), FACET_LAYOUT_EQUIRECTANGULAR);
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    cube c = make_directions(8);
    *cube_texel(&c, 0, 0, 0) = rgbx_splat(1e5f);
    cube_fill_borders(&c);
    for (long fail_at = 0;; fail_at = next_failure(fail_at)) {
        failing_allocator f = {.fail_at = fail_at};
        facet_allocator allocator = failing_allocator_get(&f);
        image out;
        facet_result result = layout_write(&c, FACET_LAYOUT_EQUIRECTANGULAR, 16, &allocator, 1, &out, NULL);
        if (result == FACET_OK)
            image_destroy(&out);
        assert_int_equal(f.blocks, 0);
        if (result == FACET_OK)
            break;
        assert_int_equal(result, FACET_ERROR_MEMORY);
        assert_true(fail_at < 10);
    }
    cube_destroy(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faces_round_trip),
        cmocka_unit_test(faces_are_where_facet_h_says),
        cmocka_unit_test(neighboring_faces_of_crosses_are_continuous),
        cmocka_unit_test(directions_are_where_facet_h_says),
        cmocka_unit_test(smooth_functions_are_kept),
        cmocka_unit_test(energy_is_kept),
        cmocka_unit_test(bright_patches_stay_uniform),
        cmocka_unit_test(constants_are_kept),
        cmocka_unit_test(rotations_are_applied),
        cmocka_unit_test(bits_do_not_depend_on_threads),
        cmocka_unit_test(sizes_that_fit_no_layout_are_refused),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
