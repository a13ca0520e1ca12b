/* gltf_textures_test.c - image files that extensions bring, and which of a texture's sources is taken. */
#include "io/gltf/gltf_test_support.h"

#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "image/ktx2.h"
#include "image/ktx2_test_file.h"

/* A model of images, one per file, each a view of the binary chunk. */
typedef struct image_files {
    test_bin bin;
    char views[2048], images[2048];
} image_files;

static void add_bytes(image_files *m, const char *mime_type, const void *bytes, size_t size)
{
    const size_t at = bin_add(&m->bin, bytes, size);
    char *views = m->views + strlen(m->views), *images = m->images + strlen(m->images);
    const char *comma = m->images[0] ? "," : "";
    int number = 0;
    for (const char *c = m->images; *c; c++)
        number += *c == '{';
    snprintf(views, 256, "%s{'buffer':0,'byteOffset':%zu,'byteLength':%zu}", comma, at, size);
    snprintf(images, 256, "%s{'bufferView':%d,'mimeType':'%s'}", comma, number, mime_type);
}

static void add_file(image_files *m, const char *mime_type, const char *name)
{
    char path[256];
    snprintf(path, sizeof path, "src/image/testdata/%s", name);
    file_bytes file;
    assert_int_equal(file_open(path, 0, NULL, &file, NULL), FACET_OK);
    add_bytes(m, mime_type, file.data, file.size);
    file_close(&file);
}

static facet_scene *load_model(const image_files *m, const char *used, const char *textures)
{
    char body[8192];
    snprintf(body, sizeof body, "'extensionsUsed':[%s],'bufferViews':[%s],'images':[%s],'textures':[%s]",
             used, m->views, m->images, textures);
    return load(body, &m->bin);
}

static const unsigned char white_png[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0,    0,    0,    0x0d, 0x49, 0x48, 0x44, 0x52, 0,
    0,    0,    1,    0,    0,    0,    1,    8,    0,    0,    0,    0,    0x3a, 0x7e, 0x9b, 0x55, 0,
    0,    0,    0x0a, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0xf8, 0x0f, 0,    1,    1,    1,    0,
    0x1c, 0xb0, 0x8c, 0x99, 0,    0,    0,    0,    0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

static bool has_avif(void)
{
    image header;
    file_bytes file;
    assert_int_equal(file_open("src/image/testdata/rgba_lossless.avif", 0, NULL, &file, NULL), FACET_OK);
    facet_result result = image_probe(file.data, file.size, "avif", &header, NULL, NULL);
    file_close(&file);
    return result == FACET_OK;
}

#define SOURCE(extension, index) "'" extension "':{'source':" index "}"

static void the_first_source_that_can_be_read_wins(void **state)
{
    (void)state;
    image_files m = {0};
    unsigned char dds[128] = "DDS |", block[136] = {0};
    dds[76 + 4] = 4; /* an unknown four-character code */
    memcpy(block, dds, 128);
    memcpy(block + 84, "DXT1", 4);
    block[12] = block[16] = 4;
    add_bytes(&m, "image/png", white_png, sizeof white_png);     /* 0 */
    add_file(&m, "image/ktx2", "etc1s_alpha.ktx2");              /* 1 */
    add_bytes(&m, "image/ktx2", "\xabKTX 20\xbb\r\n\x1a\n", 12); /* 2: broken */
    add_file(&m, "image/avif", "rgba_lossless.avif");            /* 3 */
    add_bytes(&m, "image/vnd-ms.dds", dds, sizeof dds);          /* 4 */
    add_bytes(&m, "image/vnd-ms.dds", block, sizeof block);      /* 5 */
    facet_scene *scene = load_model(
        &m, "'KHR_texture_basisu','EXT_texture_avif','MSFT_texture_dds'",
        "{'source':0,'extensions':{" SOURCE(
            "KHR_texture_basisu",
            "1") "}},"
                 "{'source':0,'extensions':{" SOURCE(
                     "KHR_texture_basisu",
                     "2") "}},"
                          "{'extensions':{" SOURCE("KHR_texture_basisu", "1") "," SOURCE(
                              "EXT_texture_avif",
                              "3") "}},"
                                   "{'source':0,'extensions':{" SOURCE(
                                       "EXT_texture_avif",
                                       "3") "}},"
                                            "{'source':0,'extensions':{" SOURCE(
                                                "MSFT_texture_dds",
                                                "4") "}},"
                                                     "{'extensions':{" SOURCE(
                                                         "MSFT_texture_dds",
                                                         "4") "}},"
                                                              "{'extensions':{" SOURCE(
                                                                  "KHR_texture_basisu",
                                                                  "2") "}},"
                                                                       "{'extensions':{" SOURCE(
                                                                           "MSFT_texture_dds", "5") "}}");
    const uint32_t expected[] = {1, 0, 1, has_avif() ? 3 : 0, 0, SCENE_NONE, SCENE_NONE, 5};
    for (size_t t = 0; t < sizeof expected / sizeof *expected; t++)
        assert_int_equal(scene->textures[t].image, expected[t]);
    assert_string_equal(scene->images[1].mime_type, "image/ktx2");
    assert_int_equal(scene->images[1].width, 60);
    assert_int_equal(scene->images[1].height, 44);
    assert_string_equal(scene->images[3].mime_type, "image/avif");
    assert_string_equal(scene->images[5].mime_type, "image/vnd-ms.dds");
    assert_int_equal(scene->images[5].width, 4);
    assert_true(has_warning(scene, "images[2]: the image: KTX2: the file ends in its header"));
    assert_true(has_warning(scene, "images[4]: the image: DDS: texels of the kind"));
    assert_false(has_warning(scene, "images[1]"));
    assert_false(has_warning(scene, "textures[4]"));
    scene_destroy(scene);
}

static void ktx2_files_are_read_without_the_extension(void **state)
{
    (void)state;
    static const unsigned char texels[6 * 4] = {0};
    static const struct {
        uint32_t layers, faces;
        const char *key, *value, *warning;
    } cases[] = {
        {0, 1, NULL, NULL, "images[0]: holds RGBA8, where KHR_texture_basisu has ETC1S or UASTC"},
        {0, 6, NULL, NULL, "images[0]: is a cube; its first face is used"},
        {2, 1, NULL, NULL, "images[0]: is an array; its first layer is used"},
        {0, 1, "KTXorientation", "ru",
         "images[0]: has a KTXorientation other than \"rd\"; it is flipped to that"},
        {0, 1, "KTXswizzle", "rrr1", "images[0]: has a KTXswizzle other than \"rgba\"; it is applied"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        ktx2_test_file f = {.vk_format = 37,
                            .width = 1,
                            .height = 1,
                            .layers = cases[k].layers,
                            .faces = cases[k].faces,
                            .levels = 1,
                            .transfer = 1,
                            .key = cases[k].key,
                            .value = cases[k].value};
        f.bytes[0] = texels;
        f.sizes[0] = (size_t)4 * f.faces * (f.layers ? f.layers : 1);
        size_t size;
        unsigned char *bytes = ktx2_test_write(&f, &size);
        image_files m = {0};
        add_bytes(&m, "image/ktx2", bytes, size);
        free(bytes);
        facet_scene *scene = load_model(&m, k ? "'KHR_texture_basisu'" : "'KHR_texture_transform'",
                                        "{'extensions':{" SOURCE("KHR_texture_basisu", "0") "}}");
        assert_int_equal(scene->textures[0].image, 0);
        assert_int_equal(scene->images[0].width, 1);
        if (!(k ? has_warning : has_note)(scene, cases[k].warning))
            fail_msg("%s", cases[k].warning);
        assert_int_equal(has_note(scene, "images[0]: is a KTX2 file, which needs KHR_texture_basisu"),
                         k == 0);
        scene_destroy(scene);
    }
}

/* ASTC blocks are KHR_texture_basisu's in no file; EXT_texture_astc is theirs. */
static void astc_has_an_extension_of_its_own(void **state)
{
    (void)state;
    /* a void-extent block: one color, 16 bits per channel */
    static const unsigned char block[16] = {0xfc, 0xfd, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff,
                                            0xff, 0xff, 0,    0x80, 0,    0,    0xff, 0xff};
    for (int is_listed = 0; is_listed < 2; is_listed++) {
        ktx2_test_file f = {.vk_format = 157,
                            .width = 4,
                            .height = 4,
                            .faces = 1,
                            .levels = 1,
                            .transfer = 1,
                            .model = 162,
                            .bytes = {block},
                            .sizes = {sizeof block}};
        size_t size;
        unsigned char *bytes = ktx2_test_write(&f, &size);
        image_files m = {0};
        add_bytes(&m, "image/png", white_png, sizeof white_png);
        add_bytes(&m, "image/ktx2", bytes, size);
        free(bytes);
        facet_scene *scene = load_model(&m, is_listed ? "'EXT_texture_astc'" : "'KHR_texture_basisu'",
                                        "{'source':0,'extensions':{" SOURCE("EXT_texture_astc", "1") "}}");
        const bool is_built = ktx2_is_astc_built();
        assert_int_equal(scene->textures[0].image, is_built ? 1 : 0);
        assert_int_equal(scene->warning_count, is_built ? 0 : 1 + is_listed);
        assert_int_equal(has_note(scene, "images[1]: holds ASTC 4x4, where KHR_texture_basisu has"),
                         is_built && !is_listed);
        assert_int_equal(has_note(scene, "images[1]: is a KTX2 file, which needs EXT_texture_astc"),
                         is_built && !is_listed);
        scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_source_that_can_be_read_wins),
        cmocka_unit_test(astc_has_an_extension_of_its_own),
        cmocka_unit_test(ktx2_files_are_read_without_the_extension),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
