/* gl_opaque_test.c - what glass shows of surfaces behind it in drafts, which look it up in the image: thin walls, volumes,
 * roughness, dispersion by closed forms, and energy conservation. gl_glass_test.c has the rays of other images. Exits with 77 where there is no OpenGL. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "gl/scene/gl_fixture_test.h"

static gl_fixture_contexts contexts;

/* Reflectance of clear glass of ior 1.5 at normal incidence. */
static const float F0 = 0.04f;

static scene_material glass(float roughness, float thickness)
{
    scene_material m = scene_material_default();
    m.extensions |= SCENE_TRANSMISSION | SCENE_IOR;
    m.transmission = 1.0f;
    m.metallic = 0.0f;
    m.perceptual_roughness = roughness;
    if (thickness > 0.0f) {
        m.extensions |= SCENE_VOLUME;
        m.thickness = thickness;
    }
    return m;
}

static fixture draft_fixture(void)
{
    fixture f = fixture_create();
    f.desc.quality = FACET_QUALITY_DRAFT;
    return f;
}

/* Unlit squares of two grays, `count` in a row, on a quad of edge 4 m at z = -1, with texels of 64 pixels
 * / count. */
static void add_board(fixture *f, uint32_t count, unsigned char dark, unsigned char bright)
{
    static unsigned char texels[32 * 32 * 4];
    for (uint32_t i = 0; i < count * count; i++) {
        unsigned char gray = (i % count + i / count) % 2 ? bright : dark;
        const unsigned char rgba[4] = {gray, gray, gray, 255};
        memcpy(texels + 4 * i, rgba, 4);
    }
    scene_material board = gl_fixture_unlit(1.0f, 1.0f, 1.0f, 1.0f);
    uint32_t texture = fixture_add_texture(f, count, count, texels);
    board.textures[SCENE_BASE_COLOR_TEXTURE].texture = texture;
    f->scene->textures[texture].mag_filter = SCENE_FILTER_NEAREST;
    f->scene->textures[texture].min_filter = SCENE_FILTER_NEAREST;
    f->scene->textures[texture].mip_filter = SCENE_MIP_NONE;
    fixture_place(f, fixture_add_quad(f, fixture_add_material(f, board)), 0, 0, -1.0f, 1.0f);
}

static scene_node *add_pane(fixture *f, scene_material m)
{
    return fixture_place(f, fixture_add_quad(f, fixture_add_material(f, m)), 0, 0, 0, 1.0f);
}

/* At normal incidence in uniform light: reflected radiance 1 plus the board. */
static void clear_glass_shows_the_opaque_image(void **state)
{
    (void)state;
    for (int c = 0; c < contexts.count; c++) {
        fixture f = draft_fixture();
        add_board(&f, 16, 0, 255);
        film board = gl_fixture_render(&f, &contexts.items[c]);
        add_pane(&f, glass(0.0f, 0.0f));
        film seen = gl_fixture_render(&f, &contexts.items[c]);
        for (uint32_t y = 1; y < 63; y++)
            for (uint32_t x = 1; x < 63; x++) {
                const float *b = fixture_pixel(&board, "", x, y);
                float wanted[4] = {0, 0, 0, 1.0f};
                for (int k = 0; k < 3; k++)
                    wanted[k] = F0 + (1.0f - F0) * b[k];
                gl_fixture_assert_pixel(&seen, x, y, wanted, 3e-3f);
            }
        film_destroy(&board);
        film_destroy(&seen);
        fixture_destroy(&f);
    }
}

/* The transmission lobe alone: the board shows behind it, although the board itself has no such lobe. */
static void the_transmission_lobe_shows_the_opaque_image(void **state)
{
    (void)state;
    for (int c = 0; c < contexts.count; c++) {
        fixture f = draft_fixture();
        add_board(&f, 2, 255, 255);
        add_pane(&f, glass(0.0f, 0.0f));
        f.desc.gl.channel = FACET_CHANNEL_TRANSMISSION;
        film seen = gl_fixture_render(&f, &contexts.items[c]);
        gl_fixture_assert_pixel(&seen, 20, 40, (const float[4]){1 - F0, 1 - F0, 1 - F0, 1}, 3e-3f);
        film_destroy(&seen);
        fixture_destroy(&f);
    }
}

/* color^(thickness / distance) of a white board, with the thickness as a factor and as a texture; the base
 * color tints at both boundaries. */
static void attenuation_follows_thickness(void **state)
{
    (void)state;
    for (int c = 0; c < contexts.count; c++)
        for (int k = 0; k < 3; k++) {
            fixture f = draft_fixture();
            add_board(&f, 2, 255, 255);
            scene_material m = glass(0.0f, 0.25f * (float)(k + 1));
            const float color[3] = {0.9f, 0.5f, 0.1f};
            memcpy(m.attenuation_color, color, sizeof color);
            m.attenuation_distance = 0.5f;
            m.base_color[1] = 0.8f;
            if (k == 2) { /* 0.75 m, by a texel of two thirds in green */
                const unsigned char texel[4] = {0, 170, 255, 255};
                m.textures[SCENE_THICKNESS_TEXTURE].texture = fixture_add_texture(&f, 1, 1, texel);
                m.thickness *= 1.5f;
            }
            add_pane(&f, m);
            m.thickness = 0.25f * (float)(k + 1);
            film seen = gl_fixture_render(&f, &contexts.items[c]);
            float wanted[4] = {0, 0, 0, 1.0f};
            for (int i = 0; i < 3; i++)
                wanted[i] =
                    F0 + (1.0f - F0) * powf(color[i], m.thickness / 0.5f) * powf(m.base_color[i], 2.0f);
            gl_fixture_assert_pixel(&seen, 20, 40, wanted, 3e-3f);
            film_destroy(&seen);
            fixture_destroy(&f);
        }
}

/* Standard deviation of the inner part of the image; *mean: its mean. */
static double contrast(const film *image, double *mean)
{
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (uint32_t y = 16; y < 48; y++)
        for (uint32_t x = 16; x < 48; x++) {
            double value = (double)fixture_pixel(image, "", x, y)[1];
            sum += value;
            squares += value * value;
            count += 1.0;
        }
    *mean = sum / count;
    return sqrt(fmax(squares / count - *mean * *mean, 0.0));
}

static void roughness_blurs_and_preserves_the_mean(void **state)
{
    (void)state;
    for (int c = 0; c < contexts.count; c++)
        for (int is_volume = 0; is_volume < 2; is_volume++) {
            double last = (double)INFINITY, first_mean = 0.0;
            for (int k = 0; k <= 6; k++) {
                fixture f = draft_fixture();
                add_board(&f, 16, 0, 255);
                add_pane(&f, glass((float)k / 6.0f, is_volume ? 0.001f : 0.0f));
                film seen = gl_fixture_render(&f, &contexts.items[c]);
                double mean, here = contrast(&seen, &mean);
                assert_true(k == 0 || here < last || here < 0.005);
                if (k == 0)
                    first_mean = mean;
                assert_true(fabs(mean - first_mean) < 0.03);
                last = here;
                film_destroy(&seen);
                fixture_destroy(&f);
            }
            assert_true(last < 0.02);
        }
}

/* A medium of ior 1 does not refract, so its roughness blurs nothing. */
static void ior_1_stays_sharp(void **state)
{
    (void)state;
    for (int c = 0; c < contexts.count; c++) {
        fixture f = draft_fixture();
        add_board(&f, 16, 0, 255);
        film board = gl_fixture_render(&f, &contexts.items[c]);
        scene_material m = glass(1.0f, 0.0f);
        m.ior = 1.0f;
        add_pane(&f, m);
        film seen = gl_fixture_render(&f, &contexts.items[c]);
        double mean;
        assert_true(fabs(contrast(&seen, &mean) - contrast(&board, &mean)) < 0.01);
        film_destroy(&board);
        film_destroy(&seen);
        fixture_destroy(&f);
    }
}

/* ---- refraction ---- */

/* Where a bright right half begins, in m from the center of the image, in one channel seen through the pane. */
static double edge_of(const film *image, int channel)
{
    double sum = 0.0;
    for (uint32_t x = 8; x < 56; x++)
        sum += (double)fixture_pixel(image, "", x, 32)[channel];
    double low = (double)fixture_pixel(image, "", 9, 32)[channel];
    double high = (double)fixture_pixel(image, "", 54, 32)[channel];
    return (56.0 - (sum - 48.0 * low) / (high - low)) / 32.0 - 1.0;
}

/* A pane rotated by 45 degrees about the upward axis shifts what is behind it by thickness sin(45 - t), with
 * Snell's sin t = sin 45 / n; each channel by its own n. Smooth transmission, so that reflections, equal
 * everywhere, do not matter. */
static void a_slab_shifts_rays_by_snells_law(void **state)
{
    (void)state;
    static const double iors[3] = {1.0, 1.5, 2.0};
    for (int c = 0; c < contexts.count; c++)
        for (int k = 0; k < 4; k++) {
            bool is_dispersive = k == 3;
            double ior = is_dispersive ? 1.5 : iors[k];
            fixture f = draft_fixture();
            static const unsigned char halves[16] = {0, 0, 0, 255, 255, 255, 255, 255,
                                                     0, 0, 0, 255, 255, 255, 255, 255};
            scene_material wall = gl_fixture_unlit(1.0f, 1.0f, 1.0f, 1.0f);
            uint32_t texture = fixture_add_texture(&f, 2, 2, halves);
            wall.textures[SCENE_BASE_COLOR_TEXTURE].texture = texture;
            f.scene->textures[texture].mag_filter = SCENE_FILTER_NEAREST;
            f.scene->textures[texture].min_filter = SCENE_FILTER_NEAREST;
            fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, wall)), 0, 0, -3.0f, 1.0f);
            scene_material m = glass(0.0f, 0.15f);
            m.ior = (float)ior;
            if (is_dispersive) {
                m.extensions |= SCENE_DISPERSION;
                m.dispersion = 8.0f;
            }
            gl_fixture_turn(add_pane(&f, m), 0.0f, 0.38268343f, 0.0f, 0.92387953f);
            for (int axis = 0; axis < 3; axis++)
                f.scene->nodes[1].scale[axis] = 2.0f; /* and twice as thick */
            film seen = gl_fixture_render(&f, &contexts.items[c]);
            for (int channel = 0; channel < 3; channel++) {
                double n = is_dispersive ? ior + (ior - 1.0) * 0.025 * 8.0 * (channel - 1) : ior;
                double t = asin(sqrt(0.5) / n);
                double shift = 0.3 * sin(0.78539816339744831 - t);
                assert_true(fabs(fabs(edge_of(&seen, channel)) - shift) < 0.003);
            }
            film_destroy(&seen);
            fixture_destroy(&f);
        }
}

/* ---- energy ---- */

/* White glass in uniform light, in front of and beside white objects, is invisible. */
static void white_glass_passes_the_furnace_test(void **state)
{
    (void)state;
    static const float white[4] = {1, 1, 1, 1};
    for (int c = 0; c < contexts.count; c++)
        for (int k = 0; k < 12; k++) {
            fixture f = draft_fixture();
            f.desc.energy = FACET_ENERGY_CONSERVING;
            scene_material m = glass(k % 3 == 2 ? 0.6f : 0.0f, k % 2 ? 0.5f : 0.0f);
            if (k >= 6) {
                m.extensions |= SCENE_DISPERSION;
                m.dispersion = 5.0f;
            }
            fixture_place(&f, fixture_add_sphere(&f, 64, fixture_add_material(&f, m)), 0, 0, 0, 0.9f);
            scene_material wall = gl_fixture_unlit(1.0f, 1.0f, 1.0f, 1.0f);
            fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, wall)), 0.5f, 0.5f, -2.0f, 0.5f);
            f.desc.background = FACET_BACKGROUND_ENVIRONMENT;
            film seen = gl_fixture_render(&f, &contexts.items[c]);
            for (uint32_t i = 0; i < 64; i++) {
                gl_fixture_assert_pixel(&seen, i, i, white, 6e-3f);
                gl_fixture_assert_pixel(&seen, i, 63 - i, white, 6e-3f);
            }
            film_destroy(&seen);
            fixture_destroy(&f);
        }
}

/* The opaque image has the size of the image; rays that leave it see the environment, without a step. A wide
 * sphere whose rays leave the image. */
static void rays_beyond_the_image_fade_to_the_environment(void **state)
{
    (void)state;
    for (int c = 0; c < contexts.count; c++) {
        fixture f = draft_fixture();
        scene_material wall = gl_fixture_unlit(0.2f, 0.2f, 0.2f, 1.0f);
        fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, wall)), 0, 0, -3.0f, 4.0f);
        fixture_place(&f, fixture_add_sphere(&f, 128, fixture_add_material(&f, glass(0.0f, 8.0f))), 0, 0, 0,
                      1.4f);
        f.desc.width = f.desc.height = 128;
        f.desc.background = FACET_BACKGROUND_ENVIRONMENT;
        film seen = gl_fixture_render(&f, &contexts.items[c]);
        float largest = 0.0f, least = 1.0f, most = 0.0f;
        for (uint32_t x = 1; x < 128; x++) {
            float here = fixture_pixel(&seen, "", x, 64)[0];
            largest = fmaxf(largest, fabsf(here - fixture_pixel(&seen, "", x - 1, 64)[0]));
            least = fminf(least, here);
            most = fmaxf(most, here);
        }
        assert_true(least < 0.3f && most > 0.8f); /* both are visible */
        assert_true(largest < 0.2f);
        film_destroy(&seen);
        fixture_destroy(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clear_glass_shows_the_opaque_image),
        cmocka_unit_test(the_transmission_lobe_shows_the_opaque_image),
        cmocka_unit_test(attenuation_follows_thickness),
        cmocka_unit_test(roughness_blurs_and_preserves_the_mean),
        cmocka_unit_test(ior_1_stays_sharp),
        cmocka_unit_test(a_slab_shifts_rays_by_snells_law),
        cmocka_unit_test(white_glass_passes_the_furnace_test),
        cmocka_unit_test(rays_beyond_the_image_fade_to_the_environment),
    };
    if (gl_fixture_open(&contexts) == 0)
        return 77;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gl_fixture_close(&contexts);
    return failed;
}
