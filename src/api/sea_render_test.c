/* sea_render_test.c - a sea in facet_render_desc: what a facet_renderer keeps changes no image, and what
 * holds of a scene holds in a sea for each renderer, or is refused by name. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "api/image_layer.h"
#include "facet/facet.h"

enum { WIDTH = 24, HEIGHT = 16 };

static facet_error failure;

static void done(facet_result result)
{
    if (result != FACET_OK)
        fail_msg("%s", failure.message);
}

static facet_sea *make_sea(float wind_mps)
{
    facet_sea_desc d = facet_sea_default();
    facet_sea *sea = NULL;
    d.wind_mps = wind_mps;
    d.resolution = 64;
    d.cascade_count = 2;
    d.thread_count = 1;
    done(facet_sea_create(&d, &sea, &failure));
    return sea;
}

static facet_render_desc desc_of(const facet_sea *sea, facet_renderer_kind renderer)
{
    return (facet_render_desc){.width = WIDTH,
                               .height = HEIGHT,
                               .samples = 1,
                               .thread_count = 1,
                               .exposure_ev = -14.0f,
                               .sea = sea,
                               .sky = {.sun_elevation_rad = 0.5f},
                               .renderer = renderer};
}

/* A white square of 2 x 2 m, 8 m before the eye and 2 to 4 m over the water, and a point light of 10^6 cd
 * 2 m before it; material: more of its base; nodes: further ones, of which `roots` are shown as well. */
static facet_scene *lit_square_and(const char *material, const char *roots, const char *nodes)
{
    static const char format[] =
        "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_lights_punctual\"],"
        "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\",\"intensity\":1000000}]}},"
        "\"scenes\":[{\"nodes\":[0,1%s]}],\"scene\":0,\"nodes\":[{\"mesh\":0,\"name\":\"square\"},"
        "{\"translation\":[0,3,-6],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}%s],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":2,"
        "\"material\":0}]}],\"materials\":[{\"doubleSided\":true,\"pbrMetallicRoughness\":{"
        "\"metallicFactor\":0%s}}],\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[-1,2,-8],"
        "\"max\":[1,4,-8]},{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":2,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}],\"bufferViews\":["
        "{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":48},"
        "{\"buffer\":0,\"byteOffset\":96,\"byteLength\":12}],\"buffers\":[{\"byteLength\":108,\"uri\":"
        "\"data:application/octet-stream;base64,"
        "AACAvwAAAEAAAADBAACAPwAAAEAAAADBAACAPwAAgEAAAADBAACAvwAAgEAAAADBAAAAAAAAAAAAAIA/"
        "AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAABAAIAAAACAAMA\"}]}";
    char file[2048];
    facet_scene *scene = NULL;
    int length = snprintf(file, sizeof file, format, roots, nodes, material);
    assert_true(length > 0 && (size_t)length < sizeof file);
    done(facet_scene_load_memory(file, (size_t)length, "square.gltf", NULL, &scene, &failure));
    return scene;
}

static facet_scene *lit_square(void)
{
    return lit_square_and("", "", "");
}

static const facet_camera at_square = {.eye = {0, 3, 0}, .target = {0, 3, -1}, .fov_y_rad = 0.4f};

static const char *const names[] = {"the preview", "path tracing", "OpenGL"};

/* Whether there is a driver; elsewhere OpenGL's share of a test is skipped, with a line. */
static bool has_gl(void)
{
    static int known = -1;
    facet_image *image = NULL;
    facet_sea *sea = make_sea(0.0f);
    const facet_render_desc desc = desc_of(sea, FACET_RENDERER_KIND_GL);
    if (known < 0) {
        facet_result result = facet_render(NULL, &desc, &image, &failure);
        known = result != FACET_ERROR_SYSTEM;
        if (!known)
            print_message("OpenGL: skipped: %s\n", failure.message);
    }
    facet_image_destroy(image);
    facet_sea_destroy(sea);
    return known;
}

static void assert_same(const facet_image *a, const facet_image *b)
{
    facet_image_view x = facet_image_get_layer(a, 0), y = facet_image_get_layer(b, 0);
    assert_int_equal(x.width, y.width);
    assert_memory_equal(x.pixels, y.pixels, sizeof(float) * 4 * x.width * x.height);
}

/* Frames of two seas by turns, forwards and back: those of facet_sea_render(). */
static void what_is_kept_changes_no_image(void **state)
{
    (void)state;
    facet_sea *seas[2] = {make_sea(9.0f), make_sea(14.0f)};
    for (int kind = 0; kind <= FACET_RENDERER_KIND_GL; kind++) {
        if (kind == FACET_RENDERER_KIND_GL && !has_gl())
            continue;
        facet_renderer *renderer = NULL;
        done(facet_renderer_create(NULL, NULL, &renderer, &failure));
        static const struct {
            int sea;
            double time_s;
        } frames[] = {{0, 0.0}, {0, 1.0}, {1, 1.0}, {0, 0.0}};
        for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) {
            facet_sea *sea = seas[frames[i].sea];
            facet_image *kept = NULL, *fresh = NULL;
            done(facet_sea_set_time(sea, frames[i].time_s, &failure));
            const facet_render_desc desc = desc_of(sea, (facet_renderer_kind)kind);
            const facet_sea_render_desc alone = {.render = desc, .sky = desc.sky};
            done(facet_renderer_render(renderer, &desc, &kept, &failure));
            done(facet_sea_render(sea, NULL, &alone, &fresh, &failure));
            assert_same(kept, fresh);
            facet_image_destroy(kept);
            facet_image_destroy(fresh);
        }
        facet_renderer_destroy(renderer);
    }
    facet_sea_destroy(seas[0]);
    facet_sea_destroy(seas[1]);
}

/* By turns in a sea and without one; each renderer sees the scene as it is. */
static void scenes_change_between_images(void **state)
{
    (void)state;
    facet_sea *sea = make_sea(9.0f);
    for (int kind = 0; kind <= FACET_RENDERER_KIND_GL; kind++) {
        if (kind == FACET_RENDERER_KIND_GL && !has_gl())
            continue;
        float matrix[16] = {[0] = 1, [5] = 1, [10] = 1, [15] = 1};
        facet_scene *scene = lit_square();
        facet_renderer *renderer = NULL;
        done(facet_renderer_create(scene, NULL, &renderer, &failure));
        for (int i = 0; i < 6; i++) {
            facet_render_desc desc = desc_of(sea, (facet_renderer_kind)kind);
            facet_image *kept = NULL, *fresh = NULL;
            desc.camera = &at_square;
            desc.sea = i % 2 ? NULL : sea;
            done(facet_renderer_render(renderer, &desc, &kept, &failure));
            done(facet_render(scene, &desc, &fresh, &failure));
            assert_same(kept, fresh);
            facet_image_destroy(kept);
            facet_image_destroy(fresh);
            matrix[12] += 0.2f;
            if (i == 2)
                done(facet_scene_append(scene, lit_square(), &failure));
            done(facet_scene_place_part(scene, i > 2, matrix, &failure));
        }
        facet_renderer_destroy(renderer);
        facet_scene_destroy(scene);
    }
    facet_sea_destroy(sea);
}

static void what_is_not_drawn_is_refused_by_name(void **state)
{
    (void)state;
    facet_sea *sea = make_sea(5.0f);
    for (int kind = 0; kind <= FACET_RENDERER_KIND_GL; kind++) {
        facet_render_desc cases[4];
        const char *words[] = {"ground", "shading", "only path tracing", "sea_shading"};
        for (int i = 0; i < 4; i++)
            cases[i] = desc_of(sea, (facet_renderer_kind)kind);
        cases[0].ground = FACET_GROUND_SHADOW;
        cases[1].shading = FACET_SHADING_OGL1;
        cases[2].aovs = FACET_AOV_DEPTH | FACET_AOV_VARIANCE;
        cases[3].sea_shading.stage = 6;
        for (int i = 0; i < 4; i++) {
            facet_image *image = NULL;
            if (i == (kind == FACET_RENDERER_KIND_PATH ? 2 : 1))
                continue; /* drawn */
            assert_int_equal(facet_render(NULL, &cases[i], &image, &failure), FACET_ERROR_ARGUMENT);
            assert_null(image);
            if (!strstr(failure.message, words[i]))
                fail_msg("%s, case %d: %s", names[kind], i, failure.message);
        }
    }
    facet_image *image = NULL;
    const facet_render_desc neither = {.width = WIDTH, .height = HEIGHT};
    assert_int_equal(facet_render(NULL, &neither, &image, &failure), FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(failure.message, "neither a scene nor a sea"));
    facet_sea_destroy(sea);
}

/* Water is in the layers, beside the model: the lowest row shows it, the middle the square. */
static void assert_water_and_model(facet_renderer_kind kind, facet_sea_style style, const facet_sea *sea,
                                   const facet_scene *scene)
{
    facet_image *image = NULL;
    facet_render_desc desc = desc_of(sea, kind);
    desc.camera = &at_square;
    desc.sea_shading.style = style;
    desc.aovs = FACET_AOV_DEPTH | FACET_AOV_NORMAL | FACET_AOV_OBJECT_ID | FACET_AOV_CRYPTOMATTE;
    done(facet_render(scene, &desc, &image, &failure));
    const size_t middle = (size_t)(HEIGHT / 2) * WIDTH + WIDTH / 2, low = (size_t)(HEIGHT - 1) * WIDTH;
    const float *depth = layer_of(image, "depth", 1), *object = layer_of(image, "object", 1);
    assert_true(fabsf(depth[middle] - 8.0f) < 0.01f);
    assert_true(object[middle] == 1.0f && object[low] > 1.0f);
    assert_true(depth[low] > 10.0f && depth[low] < 20.0f);          /* 3 m below the eye, 0.19 rad down */
    assert_true(layer_of(image, "normal", 3)[3 * low + 1] > 0.99f); /* still water */
    facet_image_destroy(image);
}

static void layers_show_water_and_model(void **state)
{
    (void)state;
    facet_sea *sea = make_sea(0.0f);
    facet_scene *scene = lit_square();
    assert_water_and_model(FACET_RENDERER_KIND_PREVIEW, FACET_SEA_STYLE_PHYSICAL, sea, scene);
    assert_water_and_model(FACET_RENDERER_KIND_PATH, FACET_SEA_STYLE_PHYSICAL, sea, scene);
    if (has_gl())
        assert_water_and_model(FACET_RENDERER_KIND_GL, FACET_SEA_STYLE_PHYSICAL, sea, scene);
    facet_scene_destroy(scene);
    facet_sea_destroy(sea);
}

/* The legacy style draws the model in front of its water, and its layers have both. */
static void layers_of_the_legacy_style_show_water_and_model(void **state)
{
    (void)state;
    facet_sea *sea = make_sea(0.0f);
    facet_scene *scene = lit_square();
    assert_water_and_model(FACET_RENDERER_KIND_PREVIEW, FACET_SEA_STYLE_LEGACY_WRITTEN, sea, scene);
    if (has_gl())
        assert_water_and_model(FACET_RENDERER_KIND_GL, FACET_SEA_STYLE_LEGACY_WRITTEN, sea, scene);
    facet_scene_destroy(scene);
    facet_sea_destroy(sea);
}

enum {
    LAYERS_WIDTH = 48,
    LAYERS_HEIGHT = 32,
    ALL_LAYERS = FACET_AOV_DEPTH | FACET_AOV_NORMAL | FACET_AOV_ALBEDO | FACET_AOV_MATERIAL_ID |
                 FACET_AOV_OBJECT_ID | FACET_AOV_INSTANCE_ID | FACET_AOV_UV | FACET_AOV_OCCLUSION |
                 FACET_AOV_CRYPTOMATTE
};

/* Whether a value lies between those of pixel (x, y) of the other image and of its neighbors. */
static bool is_within_a_pixel(float value, const float *other, int x, int y)
{
    float low = INFINITY, high = -INFINITY;
    for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < LAYERS_HEIGHT; v++)
        for (int u = x > 0 ? x - 1 : 0; u <= x + 1 && u < LAYERS_WIDTH; u++) {
            low = fminf(low, other[v * LAYERS_WIDTH + u]);
            high = fmaxf(high, other[v * LAYERS_WIDTH + u]);
        }
    return value >= 0.99f * low && value <= 1.01f * high;
}

/* Layers with one value: each within a pixel of the other renderer's; IDs differ at few edges. */
static void assert_like_values(const facet_image *a, const facet_image *b, const char *name, bool is_id)
{
    const float *x = layer_of(a, name, 1), *y = layer_of(b, name, 1);
    int different = 0;
    for (int i = 0; i < LAYERS_WIDTH * LAYERS_HEIGHT; i++) {
        if (!is_within_a_pixel(x[i], y, i % LAYERS_WIDTH, i / LAYERS_WIDTH))
            fail_msg("%s: pixel %d, %d: %g, not %g", name, i % LAYERS_WIDTH, i / LAYERS_WIDTH, (double)x[i],
                     (double)y[i]);
        different += fabsf(x[i] - y[i]) > 0.5f;
    }
    assert_true(!is_id || different < LAYERS_WIDTH * LAYERS_HEIGHT / 100);
}

/* The mean distance of two layers over the pixels with a surface. */
static double mean_distance(const facet_image *a, const facet_image *b, const char *name, uint32_t channels)
{
    const float *x = layer_of(a, name, channels), *y = layer_of(b, name, channels);
    const float *object = layer_of(a, "object", 1);
    double sum = 0.0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < LAYERS_WIDTH * LAYERS_HEIGHT; i++) {
        double square = 0.0;
        for (uint32_t c = 0; object[i] > 0.0f && c < channels; c++)
            square += pow((double)x[channels * i + c] - (double)y[channels * i + c], 2.0);
        sum += sqrt(square);
        count += object[i] > 0.0f;
    }
    return sum / count;
}

/* The share of the image that an object covers, of the two with the largest coverage of each pixel. */
static double covered(const facet_image *image, float id)
{
    const float *matte = layer_of(image, "CryptoObject00", 4);
    double sum = 0.0;
    for (size_t i = 0; i < LAYERS_WIDTH * LAYERS_HEIGHT; i++)
        for (int rank = 0; rank < 4; rank += 2)
            sum += fabsf(matte[4 * i + (size_t)rank] - id) > 0.0f ? 0.0
                                                                  : (double)matte[4 * i + (size_t)rank + 1];
    return sum / (LAYERS_WIDTH * LAYERS_HEIGHT);
}

static void assert_like_layers(const facet_image *a, const facet_image *b)
{
    static const char *const ids[] = {"object", "material", "instance"};
    for (int i = 0; i < 3; i++)
        assert_like_values(a, b, ids[i], true);
    assert_like_values(a, b, "depth", false);
    assert_like_values(a, b, "occlusion", false);
    assert_true(mean_distance(a, b, "normal", 3) < 0.04);
    assert_true(mean_distance(a, b, "albedo", 3) < 0.06);
    assert_true(mean_distance(a, b, "uv", 2) < 1e-4);
    const float *matte = layer_of(b, "CryptoObject00", 4);
    for (size_t i = 0; i < LAYERS_WIDTH * LAYERS_HEIGHT; i++)
        if (fabs(covered(a, matte[4 * i]) - covered(b, matte[4 * i])) >= 0.002)
            fail_msg("%g: %g of the image, not %g", (double)matte[4 * i], covered(a, matte[4 * i]),
                     covered(b, matte[4 * i]));
}

/* The names of the water and of the bed with their IDs, as a file has them. */
static void assert_names_water_and_bed(const facet_image *image)
{
    unsigned char *bytes = NULL;
    size_t size = 0, found = 0;
    const facet_image_save_desc desc = {.format = FACET_IMAGE_FORMAT_EXR};
    static const char *const entries[] = {"\"water\":\"", "\"bed\":\"", "\"water#4\":\"", "\"bed#5\":\""};
    done(facet_image_encode(image, &desc, &bytes, &size, &failure));
    for (size_t k = 0; k < sizeof entries / sizeof *entries; k++)
        for (size_t i = 0; i + strlen(entries[k]) <= size; i++)
            if (memcmp(bytes + i, entries[k], strlen(entries[k])) == 0) {
                found |= (size_t)1 << k;
                break;
            }
    assert_int_equal(found, 15);
    facet_bytes_destroy(bytes);
}

/* Three squares, over the water, half in it and below it, and land; from above and from below. */
static void layers_are_those_of_path_tracing(void **state)
{
    (void)state;
    static const facet_camera views[] = {{.eye = {0, 3, 0}, .target = {0, 1.5f, -8}, .fov_y_rad = 0.6f},
                                         {.eye = {0, 3, 0}, .target = {5, 2, -1}, .fov_y_rad = 0.6f},
                                         {.eye = {0, -1, 0}, .target = {0, -0.5f, -8}, .fov_y_rad = 0.9f}};
    facet_sea_desc d = facet_sea_default();
    facet_sea *sea = NULL;
    d.wind_mps = 6.0f;
    d.resolution = 64;
    d.cascade_count = 2;
    d.bed = (facet_sea_bed){.depth_m = 4.0f, .slope = 0.2f, .albedo = {0.6f, 0.5f, 0.4f}};
    done(facet_sea_create(&d, &sea, &failure));
    facet_scene *scene = lit_square_and(
        "", ",2,3", ",{\"mesh\":0,\"translation\":[-2,-3,0]},{\"mesh\":0,\"translation\":[2,-5.2,0]}");
    for (size_t v = 0; v < sizeof views / sizeof *views; v++) {
        facet_image *images[3] = {NULL, NULL, NULL};
        int count = has_gl() ? 3 : 2;
        for (int kind = 0; kind < count; kind++) {
            facet_render_desc desc = desc_of(sea, (facet_renderer_kind)kind);
            desc.camera = &views[v];
            desc.width = LAYERS_WIDTH;
            desc.height = LAYERS_HEIGHT;
            desc.samples = 16;
            desc.path.filter = FACET_FILTER_BOX; /* the preview's */
            desc.aovs = ALL_LAYERS;
            done(facet_render(scene, &desc, &images[kind], &failure));
        }
        for (int kind = 0; kind < count; kind++) {
            assert_like_layers(images[kind], images[FACET_RENDERER_KIND_PATH]);
            assert_names_water_and_bed(images[kind]);
        }
        for (int kind = 0; kind < 3; kind++)
            facet_image_destroy(images[kind]);
    }
    facet_scene_destroy(scene);
    facet_sea_destroy(sea);
}

static double middle_of(const facet_scene *scene, const facet_render_desc *desc)
{
    facet_image *image = NULL;
    done(facet_render(scene, desc, &image, &failure));
    double L = (double)facet_image_get_layer(image, 0).pixels[4 * (HEIGHT / 2 * WIDTH + WIDTH / 2) + 1];
    facet_image_destroy(image);
    return L;
}

/* The square, 2 m behind a light of 10^6 cd, sends back E / pi = 10^6 / 4 / pi cd/m^2 in the night, nearly
 * all of it. */
static void punctual_lights_light_the_model(void **state)
{
    (void)state;
    facet_sea *sea = make_sea(0.0f);
    facet_scene *scene = lit_square();
    for (int kind = 0; kind <= FACET_RENDERER_KIND_GL; kind++) {
        if (kind == FACET_RENDERER_KIND_GL && !has_gl())
            continue;
        facet_render_desc desc = desc_of(sea, (facet_renderer_kind)kind);
        desc.camera = &at_square;
        desc.sky.sun_elevation_rad = -0.6f;
        desc.samples = 16;
        double lit = middle_of(scene, &desc) * 16384.0; /* exposed by -14 EV */
        if (!(lit > 0.85 * 79577.0 && lit < 1.15 * 79577.0))
            fail_msg("%s: %g cd/m^2", names[kind], lit);
        desc.ignores_scene_lights = true;
        assert_true(middle_of(scene, &desc) * 16384.0 < 100.0);
    }
    facet_scene_destroy(scene);
    facet_sea_destroy(sea);
}

static void assert_colors_of_opengl1(facet_renderer_kind kind, const facet_sea *sea, const facet_scene *scene)
{
    facet_render_desc desc = desc_of(sea, kind);
    desc.camera = &at_square;
    desc.shading = FACET_SHADING_OGL1;
    desc.ignores_scene_lights = true;
    const double dark = middle_of(scene, &desc);
    desc.exposure_ev = -10.0f;
    const double bright = middle_of(scene, &desc);
    const facet_camera in_water = {.eye = {0, -2, 0}, .target = {0, -2, -1}, .fov_y_rad = 0.4f};
    desc.camera = &in_water;
    desc.exposure_ev = -30.0f; /* what the water scatters is black */
    const double behind = middle_of(scene, &desc);
    desc.sea = NULL;
    desc.exposure_ev = 0.0f;
    const double in_air = middle_of(scene, &desc);
    desc.camera = &at_square;
    const double alone = middle_of(scene, &desc);
    assert_true(alone > 0.05 && alone < 0.5);
    assert_true(fabs(dark - alone) < 0.005 && fabs(bright - alone) < 0.02); /* with 8 m of air */
    assert_true(behind > 0.1 * in_air && behind < 0.5 * in_air);
}

/* In front of the water a model shows the colors that OpenGL 1 gives it without a sea, whatever the
 * exposure; water in front of it attenuates them. */
static void models_show_colors_of_opengl1(void **state)
{
    (void)state;
    facet_sea *sea = make_sea(0.0f);
    facet_scene *scene = lit_square_and(",\"baseColorFactor\":[0.4,0.2,0.1,1]", ",2",
                                        ",{\"mesh\":0,\"translation\":[0,-5,0]}");
    done(facet_scene_convert_materials(scene, FACET_MATERIAL_MODEL_OGL1, NULL, NULL, &failure));
    assert_colors_of_opengl1(FACET_RENDERER_KIND_PREVIEW, sea, scene);
    if (has_gl())
        assert_colors_of_opengl1(FACET_RENDERER_KIND_GL, sea, scene);
    facet_scene_destroy(scene);
    facet_sea_destroy(sea);
}

/* A desc that meters exposes as facet_sea_meter() says. */
static void images_meter_themselves(void **state)
{
    (void)state;
    facet_sea *sea = make_sea(7.0f);
    facet_render_desc desc = desc_of(sea, FACET_RENDERER_KIND_PREVIEW);
    facet_image *metered = NULL, *exposed = NULL;
    double ev100 = 0.0;
    desc.exposure_ev = 1.0f;
    desc.meters_exposure = true;
    done(facet_render(NULL, &desc, &metered, &failure));
    desc.meters_exposure = false;
    const facet_sea_render_desc alone = {.render = desc, .sky = desc.sky};
    done(facet_sea_meter(sea, &alone, &ev100, &failure));
    desc.exposure_ev += facet_exposure_from_ev100(ev100);
    done(facet_render(NULL, &desc, &exposed, &failure));
    assert_same(metered, exposed);
    facet_image_destroy(metered);
    facet_image_destroy(exposed);
    facet_sea_destroy(sea);
}

static void count_warning(void *user, facet_log_level level, const char *text)
{
    if (level == FACET_LOG_LEVEL_WARNING && strstr(text, "default camera"))
        ++*(int *)user;
}

/* Looking from the origin towards an azimuth: how many warnings two images of the square cause. */
static int warnings_towards(float azimuth_rad, const facet_camera *camera)
{
    int warnings = 0;
    facet_sea *sea = make_sea(5.0f);
    facet_scene *scene = lit_square();
    facet_renderer *renderer = NULL;
    facet_render_desc desc = desc_of(sea, FACET_RENDERER_KIND_PREVIEW);
    desc.sky.sun_azimuth_rad = azimuth_rad;
    desc.camera = camera;
    desc.log = (facet_log){&warnings, count_warning};
    done(facet_renderer_create(scene, NULL, &renderer, &failure));
    for (int i = 0; i < 2; i++) {
        facet_image *image = NULL;
        done(facet_renderer_render(renderer, &desc, &image, &failure));
        facet_image_destroy(image);
    }
    facet_renderer_destroy(renderer);
    facet_scene_destroy(scene);
    facet_sea_destroy(sea);
    return warnings;
}

/* The square is at an azimuth of pi; only a default camera that looks away from it is warned of. */
static void a_default_camera_that_misses_the_model_warns_once(void **state)
{
    (void)state;
    const facet_camera away = {.eye = {0, 3, 0}, .target = {0, 3, 1}, .fov_y_rad = 0.4f};
    assert_int_equal(warnings_towards(0.0f, NULL), 1);
    assert_int_equal(warnings_towards(3.1415927f, NULL), 0);
    assert_int_equal(warnings_towards(0.0f, &away), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_kept_changes_no_image),
                                       cmocka_unit_test(scenes_change_between_images),
                                       cmocka_unit_test(what_is_not_drawn_is_refused_by_name),
                                       cmocka_unit_test(layers_show_water_and_model),
                                       cmocka_unit_test(layers_of_the_legacy_style_show_water_and_model),
                                       cmocka_unit_test(layers_are_those_of_path_tracing),
                                       cmocka_unit_test(punctual_lights_light_the_model),
                                       cmocka_unit_test(models_show_colors_of_opengl1),
                                       cmocka_unit_test(images_meter_themselves),
                                       cmocka_unit_test(a_default_camera_that_misses_the_model_warns_once)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
