/* ocean_path_test.c - path tracing of a sea against the preview: waves that both resolve, closed forms of
 * still water, rough water under a uniform sky and a bright horizon, a model with its reflection and
 * shadow, exhausted memory. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "facet/facet.h"

#include "tests/support/support.h"

static facet_error failure;

static void done(facet_result result)
{
    if (result != FACET_OK)
        fail_msg("%s", failure.message);
}

/* An image to be rendered by both renderers. */
typedef struct pair {
    facet_sea *sea;
    const facet_scene *scene;
    facet_sea_render_desc d;
    facet_camera camera;
    facet_image *preview, *path;
} pair;

static void begin(pair *p, const facet_sea_desc *desc, uint32_t width, uint32_t height, const float *radiance)
{
    *p = (pair){.d = {.render = {.width = width, .height = height}, .sky = {.sun_elevation_rad = 0.5f}}};
    done(facet_sea_create(desc, &p->sea, &failure));
    p->camera = facet_sea_camera(p->sea, 0.0f, 1.0f);
    if (radiance)
        done(facet_environment_create_constant(radiance, NULL, &p->d.render.environment, &failure));
}

static void draw(pair *p, uint32_t preview_samples, uint32_t path_samples)
{
    facet_image_destroy(p->preview);
    facet_image_destroy(p->path);
    p->d.render.camera = &p->camera;
    p->d.render.quality = FACET_QUALITY_FINAL;
    p->d.render.renderer = FACET_RENDERER_KIND_PREVIEW;
    p->d.render.samples = preview_samples;
    done(facet_sea_render(p->sea, p->scene, &p->d, &p->preview, &failure));
    bool omits_glints = p->d.shading.omits_glints; /* path tracing has no glints and refuses omits_glints */
    p->d.shading.omits_glints = false;
    p->d.render.renderer = FACET_RENDERER_KIND_PATH;
    p->d.render.samples = path_samples;
    done(facet_sea_render(p->sea, p->scene, &p->d, &p->path, &failure));
    p->d.shading.omits_glints = omits_glints;
}

static void end(pair *p)
{
    facet_image_destroy(p->preview);
    facet_image_destroy(p->path);
    facet_environment_destroy(p->d.render.environment);
    facet_sea_destroy(p->sea);
}

/* Mean of green over rows. */
static double rows_mean(const facet_image *image, uint32_t from, uint32_t to)
{
    facet_image_view v = facet_image_get_layer(image, 0);
    double sum = 0.0;
    for (uint32_t i = from * v.width; i < to * v.width; i++)
        sum += (double)v.pixels[4 * (size_t)i + 1];
    return sum / ((double)(to - from) * v.width);
}

static double rows_ratio(const pair *p, uint32_t from, uint32_t to)
{
    return rows_mean(p->path, from, to) / rows_mean(p->preview, from, to);
}

/* Paths over the preview, in bands of `step` rows, are 1. */
static void expect_bands(const pair *p, double wind_mps, uint32_t from, uint32_t to, uint32_t step,
                         double bound)
{
    for (uint32_t row = from; row < to; row += step) {
        double ratio = rows_ratio(p, row, row + step);
        if (!(fabs(ratio - 1.0) < bound))
            fail_msg("%g m/s, eye at %g m, rows %u to %u of %u: %g", wind_mps, (double)p->camera.eye[1], row,
                     row + step, to, ratio);
    }
}

static const float white[3] = {1.0f, 1.0f, 1.0f}, black[3] = {0.0f, 0.0f, 0.0f};

static facet_sea_desc sea_of(float wind_mps)
{
    facet_sea_desc d = facet_sea_default();
    d.wind_mps = wind_mps;
    d.resolution = 128;
    return d;
}

/* Without waves both renderers agree up to noise: sky, air, horizon, water, bed. */
static void still_water_is_the_same(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        facet_sea_desc desc = sea_of(0.0f);
        pair p;
        begin(&p, &desc, 24, 27, NULL);
        p.d.sky.omits_disc = true;
        p.d.sky.sun_azimuth_rad = 3.0f;
        if (k)
            p.camera.eye[1] = 300.0f, p.camera.target[1] += 297.0f;
        p.d.render.exposure_ev = -13.0f;
        draw(&p, 16, 48);
        expect_bands(&p, 0.0, 0, 9, 3, 2e-3);
        expect_bands(&p, 0.0, 9, 27, 3, 2e-2);
        end(&p);
    }
}

/* Without absorption, water over a white bed has the radiance of a uniform sky, n^2 times that below the surface;
 * also with an index of 1. */
static void a_furnace_is_even(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        facet_sea_desc desc = sea_of(4.0f);
        desc.water.kind = FACET_WATER_KIND_COEFFICIENTS;
        for (int i = 0; i < 3; i++) {
            desc.water.absorption[i] = 0.0f;
            desc.water.scattering[i] = 0.1f;
            desc.water.backscattering[i] = 0.02f;
            desc.bed.albedo[i] = 1.0f;
        }
        desc.water.ior = k == 2 ? 1.0f : 1.34f;
        desc.bed.depth_m = k == 2 ? 0.0f : 3.0f;
        pair p;
        begin(&p, &desc, 16, 18, white);
        p.d.shading.omits_foam = true;
        if (k == 1)
            p.camera.eye[1] = -1.0f, p.camera.target[1] = -0.9f;
        draw(&p, 4, IS_SLOW ? 16 : 64);
        double expected = k == 1 ? 1.34 * 1.34 : 1.0;
        for (uint32_t row = 0; row < 18; row += 6) {
            double preview = rows_mean(p.preview, row, row + 6), path = rows_mean(p.path, row, row + 6);
            if (!(fabs(preview / expected - 1.0) < 2e-3) ||
                !(fabs(path / expected - 1.0) < (IS_SLOW ? 0.03 : 0.015)))
                fail_msg("case %d, row %u: preview %g, paths %g, not %g", k, row, preview, path, expected);
        }
        end(&p);
    }
}

/* The surface seen from below: the reflected bed, and the sky through Snell's window. */
static void below_it_is_the_same(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        facet_sea_desc desc = sea_of(k ? 3.0f : 0.0f);
        if (k)
            desc.fetch_m = 1500.0f, desc.bed.depth_m = 3.0f;
        pair p;
        begin(&p, &desc, 24, 18, NULL);
        p.d.sky.omits_disc = true;
        p.d.render.exposure_ev = -11.0f;
        p.camera.eye[1] = -1.0f;
        p.camera.target[1] = -0.9f;
        draw(&p, 16, IS_SLOW ? 24 : 96);
        expect_bands(&p, 3.0 * k, 0, 18, 3, k ? 0.12 : 0.03);
        end(&p);
    }
}

/* The sun through waves, seen from 5 and 15 m below: the beam carries unscattered light, in-scattering the rest,
 * and nothing counts twice. */
static void the_sun_below_is_the_same(void **state)
{
    (void)state;
    facet_sea_desc desc = sea_of(5.0f);
    for (int k = 0; k < 2; k++) {
        pair p;
        begin(&p, &desc, 12, 12, NULL);
        float depth = k ? 15.0f : 5.0f;
        p.d.shading.omits_foam = true;
        p.d.sky = (facet_sky_desc){.sun_elevation_rad = 0.8727f};
        p.d.render.exposure_ev = -13.0f;
        p.camera = (facet_camera){
            .eye = {0.0f, -depth, 0.0f}, .target = {0.0f, 0.877f - depth, 0.48f}, .fov_y_rad = 0.3f};
        draw(&p, 32, IS_SLOW ? 60 : 250);
        expect_bands(&p, 5.0, 0, 12, 12, 0.08);
        end(&p);
    }
}

/* Under a uniform sky, seen from 10 m below, waves blur the rim of Snell's window: bands of 5 degrees, from 65
 * degrees above the horizon down. Beyond the rim only the steepest waves transmit the sky; the path tracer's mesh
 * has slightly more of them: at most 17 % more light, where 200 samples have an error of 2 %. */
static void the_window_is_the_same(void **state)
{
    (void)state;
    facet_sea_desc desc = sea_of(8.0f);
    pair p;
    begin(&p, &desc, 12, 60, white);
    p.d.shading.omits_foam = true;
    p.camera =
        (facet_camera){.eye = {0.0f, -10.0f, 0.0f}, .target = {0.0f, -9.3572f, 0.766f}, .fov_y_rad = 0.8727f};
    draw(&p, 8, 200);
    expect_bands(&p, 8.0, 0, 30, 6, 0.06);
    expect_bands(&p, 8.0, 30, 60, 6, 0.25);
    end(&p);
}

/* A swell without wind, with no slopes hidden and with hardly any interreflection: mean difference below 1 %, 95
 * of 100 pixels within 5 %, noise included. */
static void swell_is_where_it_is(void **state)
{
    (void)state;
    const uint32_t width = 64, height = 36;
    facet_sea_desc desc = sea_of(0.0f);
    desc.swell = (facet_swell){.height_m = 2.0f, .period_s = 12.0f, .direction_rad = 0.4f};
    pair p;
    begin(&p, &desc, width, height, white);
    draw(&p, 64, 160);
    assert_true(fabs(rows_ratio(&p, 0, height) - 1.0) < 0.01);
    const float *a = facet_image_get_layer(p.path, 0).pixels, *b = facet_image_get_layer(p.preview, 0).pixels;
    uint32_t off = 0;
    for (uint32_t i = 0; i < width * height; i++)
        if (!(fabsf(a[4 * i + 1] / b[4 * i + 1] - 1.0f) < 0.05f))
            off++;
    if (off > width * height / 20)
        fail_msg("%u of %u pixels are off by 5 %%", off, width * height);
    end(&p);
}

/* A uniform sky: the preview computes the occlusion between waves statistically, the path tracer by rays. */
static void rough_water_is_the_same(void **state)
{
    (void)state;
    static const float winds[] = {3.0f, 10.0f};
    for (int k = 0; k < 2; k++) {
        facet_sea_desc desc = sea_of(winds[k]);
        pair p;
        begin(&p, &desc, 80, 45, white);
        p.d.shading.omits_foam = true;
        draw(&p, 16, 24);
        expect_bands(&p, (double)winds[k], 18, 45, 9, 0.05);
        end(&p);
    }
}

/* The horizon is six times as bright as the zenith, so that the reflection in rough water depends on the
 * distribution of visible slopes. In bands from the horizon down, for two sizes of the image, which decide how
 * many waves are resolved. */
static void a_bright_horizon_is_reflected_alike(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{64, 36}, {192, 108}};
    double bands[2][3];
    facet_sea_desc desc = sea_of(10.0f);
    pair p;
    begin(&p, &desc, 0, 0, NULL);
    p.d.shading.omits_foam = true;
    p.d.sky.omits_disc = true;
    p.d.render.exposure_ev = -13.0f;
    for (int k = 0; k < 2; k++) {
        p.d.render.width = sizes[k][0];
        p.d.render.height = sizes[k][1];
        draw(&p, k ? 4 : 36, k ? 5 : 40);
        uint32_t rows = sizes[k][1] * 2 / 9, first = sizes[k][1] - 3 * rows;
        for (uint32_t band = 0; band < 3; band++) {
            double ratio = rows_ratio(&p, first + band * rows, first + (band + 1) * rows);
            bands[k][band] = rows_mean(p.preview, first + band * rows, first + (band + 1) * rows);
            if (!(fabs(ratio - 1.0) < 0.04))
                fail_msg("%u rows, band %u: %g", sizes[k][1], band, ratio);
        }
    }
    for (uint32_t band = 0; band < 3; band++)
        if (!(fabs(bands[1][band] / bands[0][band] - 1.0) < 0.05))
            fail_msg("band %u: %g at one size, %g at another", band, bands[0][band], bands[1][band]);
    end(&p);
}

/* From above, where masking and interreflection are small: with sun, sky and depth. Foam also lies in troughs,
 * which receive less skylight than a plane. */
static void a_gale_from_above_is_the_same(void **state)
{
    (void)state;
    facet_sea_desc desc = sea_of(20.0f);
    pair p;
    begin(&p, &desc, 32, 32, NULL);
    p.camera = (facet_camera){.eye = {0.0f, 300.0f, 0.0f}, .target = {150.0f, 0.0f, 0.0f}, .fov_y_rad = 0.5f};
    p.d.render.exposure_ev = -13.0f;
    p.d.sky.sun_elevation_rad = 0.9f;
    p.d.sky.sun_azimuth_rad = 4.0f;
    draw(&p, 16, 32);
    double with_foam = rows_mean(p.path, 0, 32), ratio = rows_ratio(&p, 0, 32);
    if (!(ratio > 0.92 && ratio < 1.02))
        fail_msg("with foam: %g", ratio);
    p.d.shading.omits_foam = true;
    draw(&p, 16, 32);
    ratio = rows_ratio(&p, 0, 32);
    if (!(fabs(ratio - 1.0) < 0.04))
        fail_msg("without foam: %g", ratio);
    assert_true(with_foam > 1.5 * rows_mean(p.path, 0, 32));
    end(&p);
}

/* Green over red of a block of 16 x 6 pixels. */
static double hue_of(const facet_image *image, uint32_t x, uint32_t y)
{
    facet_image_view v = facet_image_get_layer(image, 0);
    double red = 0.0, green = 0.0;
    for (uint32_t i = 0; i < 16 * 6; i++) {
        const float *at = v.pixels + 4 * ((size_t)(y + i / 16) * v.width + x + i % 16);
        red += (double)at[0];
        green += (double)at[1];
    }
    return green / red;
}

/* Backlit crests are at most as green as path traced. Towards a low sun, stronger glitter makes them redder. */
static void no_crest_shines_against_the_sun(void **state)
{
    (void)state;
    static const struct {
        const char *preset;
        float sun_deg;
    } cases[] = {{"gale", 6.0f}, {"gale", 20.0f}, {"breeze", 6.0f}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facet_sea_desc desc;
        pair p;
        done(facet_sea_preset(cases[i].preset, &desc, &failure));
        begin(&p, &desc, 96, 54, NULL);
        p.camera =
            (facet_camera){.eye = {0.0f, 3.0f, 0.0f}, .target = {0.0f, 0.0f, 30.0f}, .fov_y_rad = 0.7f};
        p.d.sky.sun_elevation_rad = cases[i].sun_deg * 0.017453293f;
        p.d.render.exposure_ev = -13.0f;
        p.d.shading = (facet_sea_shading){.omits_foam = true, .omits_glints = true};
        draw(&p, 16, 24);
        for (uint32_t y = 30; y + 6 <= 54; y += 6)
            for (uint32_t x = 0; x < 96; x += 16) {
                double ratio = hue_of(p.preview, x, y) / hue_of(p.path, x, y);
                if (!(ratio < 1.08))
                    fail_msg("case %zu, block %u, %u: %g", i, x, y, ratio);
            }
        end(&p);
    }
}

/* A square of 2 x 2 m, 8 m in front of the eye and 2 to 4 m above the water, emitting 1000 cd/m^2. */
static facet_scene *square(bool shines)
{
    static const char file[] =
        "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_materials_emissive_strength\"],"
        "\"scenes\":[{\"nodes\":[0]}],\"scene\":0,\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":2,"
        "\"material\":0}"
        "]}],\"materials\":[{\"doubleSided\":true,\"emissiveFactor\":[1,1,1],\"pbrMetallicRoughness\":{"
        "\"baseColorFactor\":[0,0,0,1],\"metallicFactor\":0},\"extensions\":{"
        "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":1000}}}],\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[-1,2,-8],\"max\":[1,"
        "4,-8]},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":2,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}],\"bufferViews\":["
        "{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":48},"
        "{\"buffer\":0,\"byteOffset\":96,\"byteLength\":12}],\"buffers\":[{\"byteLength\":108,\"uri\":"
        "\"data:application/octet-stream;base64,"
        "AACAvwAAAEAAAADBAACAPwAAAEAAAADBAACAPwAAgEAAAADBAACAvwAAgEAAAADBAAAAAAAAAAAAAIA/"
        "AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAABAAIAAAACAAMA\"}]}";
    char own[sizeof file];
    memcpy(own, file, sizeof file);
    if (!shines)
        memcpy(strstr(own, "1000"), "0   ", 4);
    facet_scene *scene = NULL;
    done(facet_scene_load_memory(own, strlen(own), "square.gltf", NULL, &scene, &failure));
    return scene;
}

static facet_scene *lit_model(void)
{
    return square(true);
}

/* Fresnel reflectance for unpolarised light: the mean of both polarisations. */
static double fresnel(double c, double n)
{
    double t = sqrt(1.0 - (1.0 - c * c) / (n * n));
    double s = (c - n * t) / (c + n * t), p = (n * c - t) / (n * c + t);
    return 0.5 * (s * s + p * p);
}

static float pixel(const facet_image *image, uint32_t x, uint32_t y)
{
    facet_image_view v = facet_image_get_layer(image, 0);
    return v.pixels[4 * ((size_t)y * v.width + x) + 1];
}

/* The eye, 3 m high, looks level: the middle of the square straight on, its image at a slope of 6 in 8. */
static void a_model_is_seen_and_reflected(void **state)
{
    (void)state;
    facet_scene *scene = lit_model();
    facet_sea_desc desc = sea_of(0.0f);
    pair p;
    begin(&p, &desc, 21, 21, black);
    p.scene = scene;
    p.camera = (facet_camera){.eye = {0.0f, 3.0f, 0.0f}, .target = {0.0f, 3.0f, -8.0f}, .fov_y_rad = 1.6f};
    draw(&p, 1, IS_SLOW ? 400 : 2000);
    double pixels_per_slope = 10.5 / tan(0.8);
    uint32_t row = (uint32_t)(10.5 + pixels_per_slope * 0.75);
    assert_true(fabsf(pixel(p.path, 10, 10) / 1000.0f - 1.0f) < 1e-2f);
    assert_true(fabsf(pixel(p.path, 10, 10) / pixel(p.preview, 10, 10) - 1.0f) < 1e-2f);
    double F = fresnel(0.6, (double)facet_sea_get_info(p.sea).ior);
    if (!(fabs((double)pixel(p.path, 10, row) / (1000.0 * F) - 1.0) < (IS_SLOW ? 0.3 : 0.15)))
        fail_msg("mirrored %g of %g", (double)pixel(p.path, 10, row), 1000.0 * F);
    assert_true(pixel(p.path, 1, 10) == 0.0f && pixel(p.path, 19, row) < 1.0f);
    end(&p);
    facet_scene_destroy(scene);
}

/* Mean difference between neighboring pixels of a row, relative to the mean. */
static double speckle(const facet_image *image, uint32_t from, uint32_t to)
{
    double sum = 0.0;
    uint32_t width = facet_image_get_layer(image, 0).width;
    for (uint32_t y = from; y < to; y++)
        for (uint32_t x = 1; x < width; x++)
            sum += fabs((double)pixel(image, x, y) - (double)pixel(image, x - 1, y));
    return sum / ((double)(to - from) * (width - 1)) / rows_mean(image, from, to);
}

/* Rough water stretches the reflection towards the eye: as bright and as smooth as path traced, although a single
 * slope reflects either the model or darkness. */
static void a_model_is_blurred_in_rough_water(void **state)
{
    (void)state;
    facet_scene *scene = lit_model();
    facet_sea_desc desc = sea_of(4.0f);
    pair p;
    begin(&p, &desc, 24, 24, black);
    p.scene = scene;
    p.camera = (facet_camera){.eye = {0.0f, 3.0f, 4.0f}, .target = {0.0f, 0.0f, -3.0f}, .fov_y_rad = 0.3f};
    draw(&p, 4, 400);
    double ratio = rows_ratio(&p, 0, 24), of_preview = speckle(p.preview, 0, 24),
           of_path = speckle(p.path, 0, 24);
    if (!(fabs(ratio - 1.0) < 0.1) || !(of_preview < 0.55))
        fail_msg("paths have %g of the light; speckle %g, of paths %g", ratio, of_preview, of_path);
    end(&p);
    facet_scene_destroy(scene);
}

/* Water that absorbs little and scatters hardly any light, since both renderers treat forward scattering
 * differently. */
static facet_water clear_water(float red, float green, float blue)
{
    return (facet_water){.kind = FACET_WATER_KIND_COEFFICIENTS,
                         .absorption = {red, green, blue},
                         .scattering = {1e-4f, 1e-4f, 1e-4f},
                         .backscattering = {5e-5f, 5e-5f, 5e-5f}};
}

/* From a depth of 3 m: the reflection of a submerged square, total beyond the critical angle, and a square above
 * the water through Snell's window, n^2 (1 - F) times as bright. Waves blur both. In still water one pixel gives
 * the square's radiance. */
static void a_model_is_seen_in_the_surface_from_below(void **state)
{
    (void)state;
    static const float lower[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -6, 0, 1};
    static const struct {
        float wind_mps, place_z; /* of the surface where still water shows the middle */
        bool is_mirrored;
        double seen; /* cd/m^2 in still water */
    } cases[] = {{0.0f, -2.0f, true, 1000.0},
                 {0.0f, 0.993f, false, 1000.0 * 1.34 * 1.34 * 0.8444},
                 {4.0f, -2.0f, true, 0.0},
                 {4.0f, 0.993f, false, 0.0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        facet_scene *scene = lit_model();
        if (cases[k].is_mirrored)
            done(facet_scene_place(scene, lower, &failure));
        facet_sea_desc desc = sea_of(cases[k].wind_mps);
        desc.water = clear_water(1e-4f, 1e-4f, 1e-4f);
        desc.water.ior = 1.34f;
        pair p;
        begin(&p, &desc, 25, 25, black);
        p.scene = scene;
        p.d.shading.omits_foam = true;
        p.camera = (facet_camera){
            .eye = {0.0f, -3.0f, 4.0f}, .target = {0.0f, 0.0f, cases[k].place_z}, .fov_y_rad = 0.3f};
        draw(&p, 4, IS_SLOW ? 100 : 400);
        double ratio = rows_ratio(&p, 0, 25), seen = (double)pixel(p.preview, 12, 12);
        if (!(fabs(ratio - 1.0) < 0.1))
            fail_msg("case %zu: paths have %g of the light", k, ratio);
        if (cases[k].seen > 0.0 && !(fabs(seen / cases[k].seen - 1.0) < 0.01))
            fail_msg("case %zu: the middle has %g of %g cd/m^2", k, seen, cases[k].seen);
        end(&p);
        facet_scene_destroy(scene);
    }
}

/* A square lies 30 cm above a lagoon of 2 m: its shadow on the bed is displaced by 1.4 m away from the sun. Seen
 * from the air and from the water, the shadow has a fifth of the light in both renderers. The water is clear, since
 * the path tracer scatters no light into shadows. The square also blocks the sky around the sun, and the surface
 * reflects a twentieth of the light back. */
static void a_model_shades_the_bed(void **state)
{
    (void)state;
    static const float lying[16] = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, -7.7f, -3, 1};
    facet_scene *scene = square(false);
    done(facet_scene_place(scene, lying, &failure));
    facet_sea_desc desc = sea_of(3.0f);
    desc.bed = (facet_sea_bed){.depth_m = 2.0f, .albedo = {0.15f, 0.15f, 0.15f}};
    desc.water = clear_water(0.33f, 0.06f, 0.02f);
    for (int k = 0; k < 2; k++) {
        pair p;
        begin(&p, &desc, 12, 12, NULL);
        p.d.shading.omits_foam = true;
        p.d.sky = (facet_sky_desc){.sun_elevation_rad = 0.7f};
        p.d.render.exposure_ev = -13.0f;
        p.camera =
            (facet_camera){.eye = {0.0f, 12.0f, -1.75f}, .target = {0.0f, 0.0f, -1.7f}, .fov_y_rad = 0.09f};
        if (k) {
            p.camera.eye[1] = -0.3f;
            p.camera.target[1] = -2.0f;
            p.camera.fov_y_rad = 0.6f;
        }
        draw(&p, 4, 1);
        double without = rows_mean(p.preview, 0, 12);
        p.scene = scene;
        draw(&p, 4, IS_SLOW ? 40 : 150);
        double share = rows_mean(p.preview, 0, 12) / without, ratio = rows_ratio(&p, 0, 12);
        if (!(fabs(ratio - 1.0) < (IS_SLOW ? 0.25 : 0.12)) || !(share < 0.3))
            fail_msg("eye %d: %g of the light, by paths %g of that", k, share, ratio);
        end(&p);
    }
    facet_scene_destroy(scene);
}

/* A wall over a bright bed under a uniform sky receives half of its light from the sea. Path traced it has 0.93 of
 * the preview's radiance, since the wall shades the bed; over deep water it would have a fifth less. */
static void a_bed_lights_a_model(void **state)
{
    (void)state;
    facet_scene *scene = square(false);
    facet_sea_desc desc = sea_of(3.0f);
    desc.bed = (facet_sea_bed){.depth_m = 2.0f, .albedo = {0.8f, 0.8f, 0.8f}};
    pair p;
    begin(&p, &desc, 8, 8, white);
    p.scene = scene;
    p.camera = (facet_camera){.eye = {0.0f, 3.0f, 0.0f}, .target = {0.0f, 3.0f, -8.0f}, .fov_y_rad = 0.1f};
    draw(&p, 1, 1000);
    expect_bands(&p, 3.0, 0, 8, 8, 0.1);
    end(&p);
    facet_scene_destroy(scene);
}

/* The path tracer refuses styles that it lacks; both renderers have foam, the choice of Fresnel's formula and the
 * roughness of waves that no tile resolves. */
static void styles_are_refused_or_followed(void **state)
{
    (void)state;
    facet_sea_desc desc = sea_of(10.0f);
    pair p;
    begin(&p, &desc, 16, 8, NULL);
    p.d.render.renderer = FACET_RENDERER_KIND_PATH;
    p.d.render.samples = 1;
    static const struct {
        facet_sea_shading shading;
        facet_result result;
    } cases[] = {{{.style = FACET_SEA_STYLE_LEGACY_INTENDED}, FACET_ERROR_ARGUMENT},
                 {{.stage = 3}, FACET_ERROR_ARGUMENT},
                 {{.normals = FACET_SEA_NORMALS_GGX}, FACET_ERROR_ARGUMENT},
                 {{.masking = FACET_SEA_MASKING_SCHLICK_KARIS}, FACET_ERROR_ARGUMENT},
                 {{.omits_glints = true}, FACET_ERROR_ARGUMENT},
                 {{.omits_caustics = true}, FACET_ERROR_ARGUMENT},
                 {{.clamp = 10.0f}, FACET_OK},
                 {{.omits_foam = true}, FACET_OK},
                 {{.has_schlick_fresnel = true}, FACET_OK},
                 {{.perceptual_roughness = 0.3f}, FACET_OK}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facet_image *made = NULL;
        p.d.shading = cases[i].shading;
        facet_result result = facet_sea_render(p.sea, NULL, &p.d, &made, &failure);
        assert_int_equal(result, cases[i].result);
        if (result != FACET_OK)
            assert_non_null(strstr(failure.message, "path tracing"));
        facet_image_destroy(made);
    }
    end(&p);
}

static float brightest(const facet_image *image)
{
    facet_image_view v = facet_image_get_layer(image, 0);
    float most = 0.0f;
    for (size_t i = 0; i < (size_t)4 * v.width * v.height; i++)
        most = i % 4 != 3 && v.pixels[i] > most ? v.pixels[i] : most;
    return most;
}

/* facet_sea_shading.clamp limits radiance times exposure in both renderers: of the sun's reflection nothing is
 * brighter, and where the image is darker it stays. */
static void bright_samples_are_clamped(void **state)
{
    (void)state;
    facet_sea_desc desc = sea_of(5.0f);
    pair p;
    begin(&p, &desc, 24, 18, NULL);
    p.camera = facet_sea_camera(p.sea, 0.0f, p.d.sky.sun_azimuth_rad);
    p.d.render.exposure_ev = -13.0f;
    draw(&p, 4, 8);
    assert_true(brightest(p.preview) > 2.0f && brightest(p.path) > 2.0f);
    p.d.shading.clamp = 2.0f;
    draw(&p, 4, 8);
    assert_true(brightest(p.preview) <= 2.0f && brightest(p.path) <= 2.0f + 1e-5f);
    p.d.shading.clamp = 1e9f;
    draw(&p, 4, 8);
    double unlimited = rows_mean(p.path, 0, 18);
    p.d.shading.clamp = 0.0f;
    draw(&p, 4, 8);
    assert_true(fabs(rows_mean(p.path, 0, 18) - unlimited) <= 1e-6 * unlimited);
    end(&p);
}

static void memory_runs_out(void **state)
{
    (void)state;
    facet_sea_desc desc = sea_of(8.0f);
    desc.resolution = 32;
    pair p;
    begin(&p, &desc, 8, 8, NULL);
    facet_scene *scene = lit_model();
    bool has_ended = false;
    for (long at = 0; at < 4000 && !has_ended; at += 1 + at / 2) {
        failing_allocator f = {.fail_at = at};
        facet_sea_render_desc d = p.d;
        facet_image *made = NULL;
        d.render.allocator = failing_allocator_get(&f);
        d.render.renderer = FACET_RENDERER_KIND_PATH;
        d.render.samples = 1;
        facet_result result = facet_sea_render(p.sea, scene, &d, &made, &failure);
        if (result != FACET_OK && result != FACET_ERROR_MEMORY)
            fail_msg("call %ld: %s", at, failure.message);
        assert_true((result == FACET_OK) == (made != NULL));
        has_ended = result == FACET_OK && atomic_load(&f.calls) <= at;
        facet_image_destroy(made);
        assert_int_equal(atomic_load(&f.blocks), 0);
    }
    assert_true(has_ended);
    facet_scene_destroy(scene);
    end(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(still_water_is_the_same),
                                       cmocka_unit_test(a_furnace_is_even),
                                       cmocka_unit_test(below_it_is_the_same),
                                       cmocka_unit_test(the_sun_below_is_the_same),
                                       cmocka_unit_test(the_window_is_the_same),
                                       cmocka_unit_test(a_model_is_seen_and_reflected),
                                       cmocka_unit_test(a_model_is_seen_in_the_surface_from_below),
                                       cmocka_unit_test(a_model_shades_the_bed),
                                       cmocka_unit_test(a_bed_lights_a_model),
                                       cmocka_unit_test(styles_are_refused_or_followed),
                                       cmocka_unit_test(bright_samples_are_clamped),
                                       cmocka_unit_test(memory_runs_out)};
    const struct CMUnitTest numbers[] = {cmocka_unit_test(swell_is_where_it_is),
                                         cmocka_unit_test(rough_water_is_the_same),
                                         cmocka_unit_test(a_bright_horizon_is_reflected_alike),
                                         cmocka_unit_test(a_gale_from_above_is_the_same),
                                         cmocka_unit_test(no_crest_shines_against_the_sun),
                                         cmocka_unit_test(a_model_is_blurred_in_rough_water)};
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    return IS_SLOW ? failed : failed + cmocka_run_group_tests(numbers, NULL, NULL);
}
