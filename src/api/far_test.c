/* Tests of models far from the origin of their file: the same image by every renderer wherever the model
 * is, as far as the file can say what it is (scene/origin.h). */
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

enum { SIZE = 48, SIDES = 16, RINGS = 9, VERTICES = SIDES * RINGS, INDICES = 6 * (SIDES - 1) * (RINGS - 1) };

static const float PI = 3.14159265f;

/* A ball with dents, per vertex position, normal, texture coordinate; then weights and a morph target's
 * changes. */
typedef struct ball {
    float positions[VERTICES][3], normals[VERTICES][3], texcoords[VERTICES][2], weights[VERTICES][4],
        changes[VERTICES][3];
    uint8_t joints[VERTICES][4];
    uint16_t indices[INDICES];
} ball;

static void make_ball(ball *b)
{
    uint16_t *out = b->indices;
    memset(b, 0, sizeof *b);
    for (int ring = 0; ring < RINGS; ring++)
        for (int side = 0; side < SIDES; side++) {
            int i = ring * SIDES + side;
            float a = 2.0f * PI * (float)side / (SIDES - 1), p = PI * (float)ring / (RINGS - 1);
            float n[3] = {sinf(p) * cosf(a), cosf(p), -sinf(p) * sinf(a)};
            float radius = 0.5f + 0.05f * sinf(3.0f * a) * sinf(p);
            for (int k = 0; k < 3; k++) {
                b->normals[i][k] = n[k];
                b->positions[i][k] = radius * n[k];
                b->changes[i][k] = 0.2f * n[k] * n[1];
            }
            b->texcoords[i][0] = (float)side / (SIDES - 1);
            b->texcoords[i][1] = (float)ring / (RINGS - 1);
            b->weights[i][0] = 1.0f;
        }
    for (int ring = 0; ring + 1 < RINGS; ring++)
        for (int side = 0; side + 1 < SIDES; side++) {
            int i = ring * SIDES + side;
            const int corners[6] = {i, i + SIDES, i + 1, i + 1, i + SIDES, i + SIDES + 1};
            for (int k = 0; k < 6; k++)
                *out++ = (uint16_t)corners[k];
        }
}

/* ---- models as text ---- */

typedef struct model {
    char *text;
    size_t size, capacity;
} model;

static void add(model *m, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void add(model *m, const char *format, ...)
{
    for (;;) {
        va_list arguments;
        va_start(arguments, format);
        int length = vsnprintf(m->text ? m->text + m->size : NULL, m->capacity - m->size, format, arguments);
        va_end(arguments);
        if (m->text && m->size + (size_t)length < m->capacity) {
            m->size += (size_t)length;
            return;
        }
        m->capacity = 2 * m->capacity + (size_t)length + 1;
        m->text = realloc(m->text, m->capacity);
        assert_non_null(m->text);
    }
}

static void add_base64(model *m, const void *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const uint8_t *p = bytes;
    assert_int_equal(size % 3, 0);
    for (size_t i = 0; i < size; i += 3) {
        uint32_t word = (uint32_t)p[i] << 16 | (uint32_t)p[i + 1] << 8 | p[i + 2];
        add(m, "%c%c%c%c", digits[word >> 18], digits[word >> 12 & 63], digits[word >> 6 & 63],
            digits[word & 63]);
    }
}

/* What moves a model. */
typedef enum how { BY_TRANSLATION, BY_MATRIX, BY_ANIMATION, BY_VERTICES } how;

/* Four balls: with a normal map and a morph target, of glass, on a joint, hung upside down; a light and a
 * camera. */
static const char NODES[] =
    "\"scenes\":[{\"nodes\":[%s]}],\"nodes\":[{\"children\":[%s]%s},"
    "{\"mesh\":0,\"weights\":[0.5]},"
    "{\"mesh\":1,\"translation\":[1.1,0.1,0.2]},"
    "{\"mesh\":2,\"skin\":0},{\"translation\":[0.2,1.1,0.1],\"rotation\":[0,0,0.6,0.8]},"
    "{\"mesh\":3,\"translation\":[1.2,1.2,-0.3],\"rotation\":[0.28,0,0,-0.96],\"scale\":[0.7,0.7,0.7]},"
    "{\"translation\":[2,3,2],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}},"
    "{\"camera\":0,\"translation\":[0.5,0.6,4]}],"
    "\"skins\":[{\"joints\":[4]}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.7,"
    "\"znear\":0.01}}],";

static const char MATERIALS[] =
    "\"extensionsUsed\":[\"KHR_lights_punctual\",\"KHR_materials_transmission\",\"KHR_materials_volume\"],"
    "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\","
    "\"intensity\":20}]}},\"images\":[{\"uri\":\"data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAQAAAAECAIAAAAm"
    "kwkpAAAAHUlEQVR42mNwiXi2Z8UzCMmwJ+KZy4pnEJIBpwwADAEeYbMO2SwAAAAASUVORK5CYII=\"}],\"textures\":[{"
    "\"source\""
    ":0}],\"materials\":[{\"normalTexture\":{\"index\":0},\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.8,"
    "0.3,"
    "0.1,1],\"metallicFactor\":0.5,\"roughnessFactor\":0.5}},{\"pbrMetallicRoughness\":{\"metallicFactor\":0,"
    "\"roughnessFactor\":0.1},\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1},"
    "\"KHR_materials_volume\":{\"thicknessFactor\":0.4}}}],";

static const char MESHES[] =
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},\"indices\":"
    "3,"
    "\"material\":0,\"targets\":[{\"POSITION\":4}]}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":3,\"material\":1}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"JOINTS_0\":5,\"WEIGHTS_0\":6},"
    "\"indices\":3}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":2},\"indices\":3,\"material\":0}]}],";

static void add_arrays(model *m, const ball *b)
{
    static const struct {
        size_t offset, size;
        int component;
        uint32_t count;
        const char *type;
    } arrays[] = {{offsetof(ball, positions), sizeof b->positions, 5126, VERTICES, "VEC3"},
                  {offsetof(ball, normals), sizeof b->normals, 5126, VERTICES, "VEC3"},
                  {offsetof(ball, texcoords), sizeof b->texcoords, 5126, VERTICES, "VEC2"},
                  {offsetof(ball, indices), sizeof b->indices, 5123, INDICES, "SCALAR"},
                  {offsetof(ball, changes), sizeof b->changes, 5126, VERTICES, "VEC3"},
                  {offsetof(ball, joints), sizeof b->joints, 5121, VERTICES, "VEC4"},
                  {offsetof(ball, weights), sizeof b->weights, 5126, VERTICES, "VEC4"}};
    const size_t count = sizeof arrays / sizeof *arrays;
    add(m, "\"accessors\":[");
    for (size_t i = 0; i < count; i++)
        add(m, "%s{\"bufferView\":%zu,\"componentType\":%d,\"count\":%u,\"type\":\"%s\"}", i ? "," : "", i,
            arrays[i].component, arrays[i].count, arrays[i].type);
    add(m, ",{\"bufferView\":7,\"componentType\":5126,\"count\":1,\"type\":\"VEC3\"},"
           "{\"bufferView\":8,\"componentType\":5126,\"count\":1,\"type\":\"SCALAR\"}],\"bufferViews\":[");
    for (size_t i = 0; i < count; i++)
        add(m, "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu},", arrays[i].offset, arrays[i].size);
    add(m, "{\"buffer\":1,\"byteLength\":12},{\"buffer\":2,\"byteLength\":4}],");
}

/* All is below one node that is moved; or (BY_VERTICES) light and camera are, and the vertices of two balls. */
static model make_gltf(const ball *b, const double move[3], how h)
{
    model m = {0};
    char root[256];
    ball moved = *b;
    const float floats[3] = {(float)move[0], (float)move[1], (float)move[2]};
    for (int i = 0; i < VERTICES && h == BY_VERTICES; i++)
        for (int k = 0; k < 3; k++)
            moved.positions[i][k] += floats[k];
    snprintf(root, sizeof root,
             h == BY_MATRIX ? ",\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,%.17g,%.17g,%.17g,1]"
                            : ",\"translation\":[%.17g,%.17g,%.17g]",
             move[0], move[1], move[2]);
    add(&m, "{\"asset\":{\"version\":\"2.0\"},");
    if (h == BY_VERTICES)
        add(&m, NODES, "0,1,2", "6,7", root);
    else
        add(&m, NODES, "0", "1,2,3,4,5,6,7", root);
    if (h == BY_ANIMATION)
        add(&m, "\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":"
                "\"translation\"}}],"
                "\"samplers\":[{\"input\":8,\"output\":7}]}],");
    add(&m, "%s%s", MATERIALS, MESHES);
    add_arrays(&m, b);
    add(&m, "\"buffers\":[{\"byteLength\":%zu,\"uri\":\"data:application/octet-stream;base64,", sizeof moved);
    add_base64(&m, &moved, sizeof moved);
    add(&m, "\"},{\"byteLength\":12,\"uri\":\"data:application/octet-stream;base64,");
    add_base64(&m, floats, sizeof floats);
    add(&m, "\"},{\"byteLength\":4,\"uri\":\"data:application/octet-stream;base64,AAAAAA==\"}]}");
    return m;
}

static model make_obj(const ball *b, const double move[3])
{
    model m = {0};
    for (int i = 0; i < VERTICES; i++)
        add(&m, "v %.9f %.9f %.9f\n", (double)b->positions[i][0] + move[0],
            (double)b->positions[i][1] + move[1], (double)b->positions[i][2] + move[2]);
    for (int i = 0; i < INDICES; i += 3)
        add(&m, "f %d %d %d\n", b->indices[i] + 1, b->indices[i + 1] + 1, b->indices[i + 2] + 1);
    return m;
}

/* ---- images ---- */

/* Takes m. */
static facet_scene *load(model m)
{
    facet_scene *scene = NULL;
    facet_error error = {0};
    if (facet_scene_load_memory(m.text, m.size, "far", NULL, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    free(m.text);
    return scene;
}

static facet_environment *studio;

static int make_studio(void **state)
{
    (void)state;
    return facet_environment_create_studio(NULL, &studio, NULL) == FACET_OK ? 0 : -1;
}

static int end_studio(void **state)
{
    (void)state;
    facet_environment_destroy(studio);
    return 0;
}

/* By the camera of the file, if it has one. NULL: there is no OpenGL. */
static facet_image *draw(const facet_scene *scene, facet_renderer_kind renderer, bool is_animated)
{
    static const uint32_t first = 0;
    facet_camera camera;
    facet_image *image = NULL;
    facet_error error = {0};
    facet_render_desc desc = {.width = SIZE,
                              .height = SIZE,
                              .renderer = renderer,
                              .environment = studio,
                              .samples = 4,
                              .pose = {.animation_count = is_animated, .animations = &first}};
    if (facet_scene_get_counts(scene).cameras > 0) {
        assert_int_equal(facet_camera_from_scene(scene, &desc.pose, 0, &camera, NULL), FACET_OK);
        desc.camera = &camera;
    }
    facet_result result = facet_render(scene, &desc, &image, &error);
    if (result == FACET_ERROR_SYSTEM && renderer == FACET_RENDERER_KIND_GL)
        printf("without OpenGL: %s\n", error.message);
    else if (result != FACET_OK)
        fail_msg("%s", error.message);
    return image;
}

/* Rounding decides about few pixels: which of two triangles an edge's ray meets, which way a path goes;
 * and glass with dents makes much of little. */
static void assert_alike(const facet_image *a, const facet_image *b, const double move[3], int renderer)
{
    facet_image_view x = facet_image_get_layer(a, 0), y = facet_image_get_layer(b, 0);
    int covered = 0, apart = 0;
    for (uint32_t row = 0; row < SIZE; row++)
        for (uint32_t i = 0; i < SIZE; i++) {
            const float *p = x.pixels + row * (x.row_stride_bytes / sizeof(float)) + i * x.channel_count;
            const float *q = y.pixels + row * (y.row_stride_bytes / sizeof(float)) + i * y.channel_count;
            float most = 0.0f, highest = 0.0f;
            for (uint32_t c = 0; c < 3; c++) {
                most = fmaxf(most, fabsf(p[c] - q[c]));
                highest = fmaxf(highest, p[c]);
            }
            covered += highest > 0.0f;
            apart += most > 0.01f * fmaxf(highest, 1.0f);
        }
    assert_true(covered > SIZE * SIZE / 8);
    if (apart > SIZE * SIZE / 100)
        fail_msg("%d pixels of renderer %d are others at (%g, %g, %g)", apart, renderer, move[0], move[1],
                 move[2]);
}

static void compare(const ball *b, how h, const double move[3], bool is_obj)
{
    const double nowhere[3] = {0, 0, 0};
    facet_scene *near_scene = load(is_obj ? make_obj(b, nowhere) : make_gltf(b, nowhere, h));
    facet_scene *far_scene = load(is_obj ? make_obj(b, move) : make_gltf(b, move, h));
    for (int renderer = 0; renderer <= (int)FACET_RENDERER_KIND_GL; renderer++) {
        facet_image *a = draw(near_scene, (facet_renderer_kind)renderer, h == BY_ANIMATION);
        facet_image *c = draw(far_scene, (facet_renderer_kind)renderer, h == BY_ANIMATION);
        if (a && c)
            assert_alike(a, c, move, renderer);
        facet_image_destroy(a);
        facet_image_destroy(c);
    }
    facet_scene_destroy(near_scene);
    facet_scene_destroy(far_scene);
}

static void moved_nodes_and_text_look_the_same(void **state)
{
    ball b;
    make_ball(&b);
    (void)state;
    for (int power = 0; power <= 8; power++) {
        double move[3] = {0, 0, 0};
        move[power % 3] = (power % 2 ? -1.0 : 1.0) * pow(10.0, power);
        compare(&b, power % 2 ? BY_TRANSLATION : BY_MATRIX, move, false);
        compare(&b, BY_TRANSLATION, move, true);
    }
    const double everywhere[3] = {1e8 + 0.125, -1e7 - 0.5, 4526331.25};
    compare(&b, BY_TRANSLATION, everywhere, false);
    compare(&b, BY_TRANSLATION, everywhere, true);
}

/* Keys are floats: this place is one. */
static void moved_keys_look_the_same(void **state)
{
    ball b;
    const double move[3] = {1048576.0, 0.0, -8388608.0};
    make_ball(&b);
    (void)state;
    compare(&b, BY_ANIMATION, move, false);
}

/* Vertices that floats hold there. */
static void moved_vertices_look_the_same(void **state)
{
    ball b;
    const double move[3] = {131072.0, 0.0, -131072.0};
    make_ball(&b);
    (void)state;
    for (int i = 0; i < VERTICES; i++)
        for (int k = 0; k < 3; k++)
            b.positions[i][k] = roundf(64.0f * b.positions[i][k]) / 64.0f;
    compare(&b, BY_VERTICES, move, false);
}

/* Coordinates of the file, and what the library makes of them. */
static void places_are_relative_to_the_origin(void **state)
{
    ball b;
    const double move[3] = {4526331.25, 0.0, -1e8};
    float low[3], high[3], near_low[3], near_high[3];
    double origin[3], none[3];
    facet_camera camera;
    make_ball(&b);
    (void)state;
    facet_scene *far_scene = load(make_gltf(&b, move, BY_TRANSLATION));
    facet_scene *near_scene = load(make_gltf(&b, (double[3]){0, 0, 0}, BY_TRANSLATION));
    facet_scene_get_origin(near_scene, none);
    facet_scene_get_origin(far_scene, origin);
    assert_true(none[0] == 0.0 && none[1] == 0.0 && none[2] == 0.0);
    assert_true(facet_scene_get_bounds(far_scene, NULL, low, high));
    assert_true(facet_scene_get_bounds(near_scene, NULL, near_low, near_high));
    assert_int_equal(facet_camera_from_scene(far_scene, NULL, 0, &camera, NULL), FACET_OK);
    const double eye[3] = {0.5, 0.6, 4.0};
    for (int i = 0; i < 3; i++) {
        assert_true(fabs(origin[i] + (double)low[i] - move[i] - (double)near_low[i]) < 1e-6);
        assert_true(fabs(origin[i] + (double)high[i] - move[i] - (double)near_high[i]) < 1e-6);
        assert_true(fabs(origin[i] + (double)camera.eye[i] - move[i] - eye[i]) < 1e-6);
        assert_true(origin[i] == floor(origin[i]));
    }
    facet_scene_destroy(far_scene);
    facet_scene_destroy(near_scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(moved_nodes_and_text_look_the_same),
        cmocka_unit_test(moved_keys_look_the_same),
        cmocka_unit_test(moved_vertices_look_the_same),
        cmocka_unit_test(places_are_relative_to_the_origin),
    };
    return cmocka_run_group_tests(tests, make_studio, end_studio);
}
