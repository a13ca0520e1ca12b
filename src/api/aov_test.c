/* Tests of AOVs through the public headers only: IDs and Cryptomatte of all renderers beside
 * each other. */
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

/* A blended square before an opaque one that is wider, both in the plane of the image; no other node has
 * a mesh. */
static const char two_squares[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[1,2]}],\"nodes\":[{\"name\":"
    "\"empty\"},{\"name\":\"wall\",\"mesh\":0,\"scale\":[2,2,1]},{\"name\":\"glass\",\"mesh\":1,"
    "\"translation\":[0.5,0,1]}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":5,"
    "\"material\":0}]},{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":5,\"material\":1}]}],"
    "\"materials\":[{\"name\":\"brick\",\"extensions\":{\"KHR_materials_unlit\":{}}},{\"name\":\"film\","
    "\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0,0,0.25]},\"extensions\":"
    "{\"KHR_materials_unlit\":{}}}],\"extensionsUsed\":[\"KHR_materials_unlit\"],\"accessors\":[{"
    "\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48}],\"buffers\":[{\"byteLength\":48,\"uri\":"
    "\"data:application/octet-stream;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAACAPwAAgD8AAAAA\"}]}";

enum { WIDTH = 48, HEIGHT = 40, PIXELS = WIDTH * HEIGHT };
static const uint32_t every_renderer =
    FACET_AOV_MATERIAL_ID | FACET_AOV_OBJECT_ID | FACET_AOV_INSTANCE_ID | FACET_AOV_CRYPTOMATTE;
static const char *const kinds[] = {"CryptoObject", "CryptoMaterial", "CryptoInstance"};

/* NULL: there is no OpenGL. */
static facet_image *draw(const facet_scene *scene, facet_renderer_kind renderer, facet_filter filter)
{
    facet_camera camera = {
        .eye = {1.2f, 1.1f, 5}, .target = {1.2f, 1.1f, 0}, .up = {0, 1, 0}, .fov_y_rad = 0.6f};
    facet_image *image = NULL;
    facet_error error = {0};
    facet_render_desc desc = {.width = WIDTH,
                              .height = HEIGHT,
                              .camera = &camera,
                              .renderer = renderer,
                              .samples = 16,
                              .path = {.filter = filter},
                              .aovs = every_renderer};
    facet_result result = facet_render(scene, &desc, &image, &error);
    if (result == FACET_ERROR_SYSTEM && renderer == FACET_RENDERER_KIND_GL) {
        printf("without OpenGL: %s\n", error.message);
        return NULL;
    }
    if (result != FACET_OK)
        fail_msg("%s", error.message);
    return image;
}

/* ID and share of a rank. */
static const float *rank_of(const facet_image *image, const char *kind, uint32_t rank, size_t pixel)
{
    char name[32];
    snprintf(name, sizeof name, "%s%02u", kind, rank / 2);
    return layer_of(image, name, 4) + 4 * pixel + 2 * (rank % 2);
}

static float share_of_all(const facet_image *image, const char *kind, size_t pixel)
{
    float sum = 0.0f, last = 1.0f;
    for (uint32_t rank = 0; rank < 6; rank++) {
        const float *r = rank_of(image, kind, rank, pixel);
        assert_true(r[1] <= last && r[1] >= 0.0f && (r[1] > 0.0f || r[0] == 0.0f));
        sum += last = r[1];
    }
    return sum;
}

static facet_scene *load_squares(void)
{
    facet_scene *scene = NULL;
    facet_error error;
    if (facet_scene_load_memory(two_squares, sizeof two_squares - 1, "two.gltf", NULL, &scene, &error) !=
        FACET_OK)
        fail_msg("%s", error.message);
    return scene;
}

/* Of the CPU's renderers for every pixel; OpenGL has other samples, and sees no further than the nearest
 * surface. */
static void shares_add_up_to_the_opacity(void **state)
{
    (void)state;
    facet_scene *scene = load_squares();
    static const struct {
        facet_renderer_kind renderer;
        facet_filter filter;
    } cases[] = {{FACET_RENDERER_KIND_PREVIEW, FACET_FILTER_BOX},
                 {FACET_RENDERER_KIND_PATH, FACET_FILTER_BLACKMAN_HARRIS},
                 {FACET_RENDERER_KIND_PATH, FACET_FILTER_MITCHELL}}; /* with weights of its own */
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        facet_image *image = draw(scene, cases[k].renderer, cases[k].filter);
        const float *rgba = layer_of(image, "", 4);
        double covered = 0.0, difference = 0.0, largest = 0.0;
        for (size_t i = 0; i < PIXELS; i++) {
            covered += (double)rgba[4 * i + 3];
            for (int kind = 0; kind < 3; kind++) {
                double d = fabs((double)share_of_all(image, kinds[kind], i) - (double)rgba[4 * i + 3]);
                difference += d;
                largest = fmax(largest, d);
            }
        }
        bool is_positive = cases[k].filter != FACET_FILTER_MITCHELL; /* negative shares are cut off */
        assert_true(covered > 0.25 * PIXELS && covered < 0.95 * PIXELS);
        if (difference > 3e-3 * 3 * PIXELS || (is_positive && largest > 1e-5))
            fail_msg("case %zu: mean difference %g, largest %g", k, difference / (3 * PIXELS), largest);
        facet_image_destroy(image);
    }
    facet_scene_destroy(scene);
}

/* Where the blended square covers the other one it has a quarter of the pixel, in each renderer. */
static void what_blends_shares_pixels(void **state)
{
    (void)state;
    facet_scene *scene = load_squares();
    for (int renderer = FACET_RENDERER_KIND_PREVIEW; renderer <= (int)FACET_RENDERER_KIND_GL; renderer++) {
        facet_image *image = draw(scene, (facet_renderer_kind)renderer, FACET_FILTER_BLACKMAN_HARRIS);
        if (!image)
            continue;
        const float *object = layer_of(image, "object", 1), *material = layer_of(image, "material", 1),
                    *instance = layer_of(image, "instance", 1);
        size_t shared = 0, alone = 0;
        for (size_t i = 0; i < PIXELS; i++) {
            const float *most = rank_of(image, kinds[0], 0, i), *second = rank_of(image, kinds[0], 1, i);
            bool is_shared = object[i] == 3.0f && material[i] == 2.0f && instance[i] == 2.0f;
            bool is_alone = object[i] == 2.0f && material[i] == 1.0f && instance[i] == 1.0f;
            assert_true(is_shared || is_alone || object[i] + material[i] + instance[i] == 0.0f);
            bool is_gl = renderer == (int)FACET_RENDERER_KIND_GL;
            float share = is_gl ? most[1] : second[1];
            shared += is_shared && fabsf(share - 0.25f) < (renderer == 1 ? 0.25f : 1e-4f);
            alone += is_alone && most[1] == 1.0f && second[1] == 0.0f;
        }
        if (shared < 150 || alone < 300)
            fail_msg("renderer %d: %zu shared pixels, %zu of one object", renderer, shared, alone);
        facet_image_destroy(image);
    }
    facet_scene_destroy(scene);
}

/* The second object's color is 2 * 0x3779b1; each number has its own, and what is empty stays transparent. */
static void ids_have_colors(void **state)
{
    (void)state;
    facet_scene *scene = load_squares();
    facet_image *image = draw(scene, FACET_RENDERER_KIND_PREVIEW, FACET_FILTER_BOX), *colors = NULL;
    unsigned char *bytes = NULL;
    size_t size = 0, seen[3] = {0};
    facet_image_save_desc raw = {.format = FACET_IMAGE_FORMAT_RAW};
    assert_int_equal(facet_image_create_id_colors(image, "object", NULL, &colors, NULL), FACET_OK);
    assert_int_equal(facet_image_encode(colors, &raw, &bytes, &size, NULL), FACET_OK);
    assert_int_equal(size, 4 * PIXELS);
    const float *object = layer_of(image, "object", 1);
    static const unsigned char expected[3][4] = {
        {0, 0, 0, 0}, {0x6e, 0xf3, 0x62, 255}, {0xa6, 0x6d, 0x13, 255}};
    for (size_t i = 0; i < PIXELS; i++) {
        size_t which = object[i] > 0.0f ? (size_t)object[i] - 1 : 0; /* nothing, wall, glass */
        assert_memory_equal(bytes + 4 * i, expected[which], 4);
        seen[which]++;
    }
    assert_true(seen[0] > 100 && seen[1] > 100 && seen[2] > 100);
    facet_bytes_destroy(bytes);
    facet_image_destroy(colors);
    assert_int_equal(facet_image_create_id_colors(image, "", NULL, &colors, NULL), FACET_ERROR_ARGUMENT);
    assert_int_equal(facet_image_create_id_colors(image, "depth", NULL, &colors, NULL), FACET_ERROR_ARGUMENT);
    assert_null(colors);
    facet_image_destroy(image);
    facet_scene_destroy(scene);
}

static bool contains_bytes(const unsigned char *bytes, size_t size, const void *sought, size_t length)
{
    for (size_t i = 0; i + length <= size; i++)
        if (memcmp(bytes + i, sought, length) == 0)
            return true;
    return false;
}

static bool contains(const unsigned char *bytes, size_t size, const char *text)
{
    return contains_bytes(bytes, size, text, strlen(text));
}

/* A header of OpenEXR is not compressed. c17feb92 is MurmurHash3 of "glass". */
static void files_have_the_manifest(void **state)
{
    (void)state;
    facet_scene *scene = load_squares();
    facet_image *image = draw(scene, FACET_RENDERER_KIND_PREVIEW, FACET_FILTER_BOX);
    unsigned char *bytes = NULL;
    size_t size = 0;
    facet_error error;
    facet_result result = facet_image_encode(
        image, &(facet_image_save_desc){.format = FACET_IMAGE_FORMAT_EXR}, &bytes, &size, &error);
    if (result == FACET_ERROR_UNSUPPORTED) {
        printf("skipped: %s\n", error.message);
    } else {
        assert_int_equal(result, FACET_OK);
        assert_true(contains(bytes, size, "cryptomatte/3ae39a5/manifest"));
        assert_true(contains(bytes, size, "{\"glass\":\"c17feb92\",\"wall\":\""));
        assert_true(contains(bytes, size, "\"wall#1\":\""));
        assert_true(contains(bytes, size, "{\"brick\":\""));
        assert_true(contains(bytes, size, "CryptoInstance02.A"));
    }
    facet_bytes_destroy(bytes);
    facet_image_destroy(image);
    facet_scene_destroy(scene);
}

/* Channel names of the header are followed by the pixel type: 1 half, 2 float. */
static void depth_and_coordinates_stay_floats_in_half_files(void **state)
{
    (void)state;
    facet_scene *scene = load_squares();
    facet_image *image = NULL;
    unsigned char *bytes = NULL;
    size_t size = 0;
    facet_error error;
    facet_render_desc desc = {
        .width = 8, .height = 8, .aovs = FACET_AOV_DEPTH | FACET_AOV_UV | FACET_AOV_NORMAL};
    assert_int_equal(facet_render(scene, &desc, &image, NULL), FACET_OK);
    facet_image_save_desc exr = {.format = FACET_IMAGE_FORMAT_EXR};
    facet_result result = facet_image_encode(image, &exr, &bytes, &size, &error);
    if (result == FACET_ERROR_UNSUPPORTED) {
        printf("skipped: %s\n", error.message);
    } else {
        assert_int_equal(result, FACET_OK);
        assert_true(contains_bytes(bytes, size, "Z\0\2\0\0", 6));
        assert_true(contains_bytes(bytes, size, "uv.U\0\2\0\0", 9));
        assert_true(contains_bytes(bytes, size, "normal.X\0\1\0\0", 13));
    }
    facet_bytes_destroy(bytes);
    facet_image_destroy(image);
    facet_scene_destroy(scene);
}

static void checkpoints_keep_no_shares(void **state)
{
    (void)state;
    facet_scene *scene = load_squares();
    facet_image *image = NULL;
    facet_error error;
    facet_render_desc desc = {.width = 8,
                              .height = 8,
                              .renderer = FACET_RENDERER_KIND_PATH,
                              .path = {.checkpoint_path = "no.exr", .resumes = true},
                              .aovs = FACET_AOV_CRYPTO_MATERIAL};
    assert_int_equal(facet_render(scene, &desc, &image, &error), FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "checkpoint"));
    assert_null(image);
    facet_scene_destroy(scene);
}

/* What a renderer says that it renders is one layer or more per bit; all other bits are refused. */
static void bits_that_are_no_aov_are_refused(void **state)
{
    (void)state;
    facet_scene *scene = load_squares();
    for (int kind = 0; kind <= FACET_RENDERER_KIND_GL; kind++) {
        facet_image *image = NULL;
        facet_error error = {0};
        uint32_t aovs = facet_renderer_get_info((facet_renderer_kind)kind).aovs;
        assert_int_equal(aovs & every_renderer, every_renderer);
        assert_true(aovs < FACET_AOV_CRYPTO_INSTANCE << 1);
        assert_int_equal((aovs & FACET_AOV_SAMPLES) != 0, kind == FACET_RENDERER_KIND_PATH);
        facet_render_desc desc = {.width = 8, .height = 8, .samples = 1, .aovs = aovs};
        desc.renderer = (facet_renderer_kind)kind;
        if (kind != FACET_RENDERER_KIND_GL) {
            assert_int_equal(facet_render(scene, &desc, &image, &error), FACET_OK);
            assert_true(facet_image_get_layer_count(image) > 10);
            facet_image_destroy(image);
        }
        desc.aovs |= 1u << 20;
        assert_int_equal(facet_render(scene, &desc, &image, &error), FACET_ERROR_ARGUMENT);
        assert_non_null(strstr(error.message, "0x100000 "));
        assert_null(image);
    }
    facet_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shares_add_up_to_the_opacity),
        cmocka_unit_test(what_blends_shares_pixels),
        cmocka_unit_test(ids_have_colors),
        cmocka_unit_test(files_have_the_manifest),
        cmocka_unit_test(depth_and_coordinates_stay_floats_in_half_files),
        cmocka_unit_test(bits_that_are_no_aov_are_refused),
        cmocka_unit_test(checkpoints_keep_no_shares),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
