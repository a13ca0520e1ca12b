/* gltf_quantization_test.c - KHR_mesh_quantization: each attribute in each component type, as the tables
 * of the extension allow them, and where the transforms that undo quantisation are found. */
#include "io/gltf/gltf_test_support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { BYTE = 5120, UBYTE = 5121, SHORT = 5122, USHORT = 5123, FLOAT = 5126 };

/* ---- values ---- */

/* Four numbers for each of three vertices, representable in every type. */
static const int NUMBERS[3][4] = {{0, 1, 2, 127}, {127, 0, 64, 127}, {3, 100, 50, 127}};

static size_t component_size(int component)
{
    return component == BYTE || component == UBYTE ? 1 : component == FLOAT ? 4 : 2;
}

/* Signed types hold the first number of each vertex negated. */
static int number(int component, int vertex, int k)
{
    bool is_signed = component == BYTE || component == SHORT;
    return is_signed && k == 0 ? -NUMBERS[vertex][k] : NUMBERS[vertex][k];
}

/* Values decoded by the extension's equations ("Encoding Quantized Data"). */
static double value(int component, bool is_normalized, int vertex, int k)
{
    const int c = number(component, vertex, k);
    if (!is_normalized || component == FLOAT)
        return c;
    return component == BYTE    ? fmax(c / 127.0, -1)
           : component == UBYTE ? c / 255.0
           : component == SHORT ? fmax(c / 32767.0, -1)
                                : c / 65535.0;
}

/* Appends three vertices of count components, each at a multiple of 4; returns where, and their stride. */
static size_t add_numbers(test_bin *bin, int component, int count, size_t *stride)
{
    const size_t size = component_size(component);
    unsigned char bytes[3 * 16] = {0};
    *stride = (size * (size_t)count + 3) / 4 * 4;
    for (int v = 0; v < 3; v++)
        for (int k = 0; k < count; k++) {
            const int c = number(component, v, k);
            const float as_float = (float)c;
            const uint16_t as_half = (uint16_t)c;
            const uint8_t as_byte = (uint8_t)c;
            memcpy(bytes + (size_t)v * *stride + size * (size_t)k,
                   size == 4   ? (const void *)&as_float
                   : size == 2 ? (const void *)&as_half
                               : (const void *)&as_byte,
                   size);
        }
    return bin_add(bin, bytes, 3 * *stride);
}

/* ---- models of three points with one attribute in question ---- */

typedef struct question {
    const char *name;
    bool is_target; /* an attribute of a morph target */
    int component;
    bool is_normalized, is_declared;
} question;

static facet_result try_attribute(const question *q, facet_scene **scene, facet_error *error)
{
    test_bin bin = {0};
    static const float plain[12] = {0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1};
    const bool is_tangent = strcmp(q->name, "TANGENT") == 0;
    const bool is_texcoord = strncmp(q->name, "TEXCOORD", 8) == 0;
    const int count = is_texcoord ? 2 : is_tangent && !q->is_target ? 4 : 3;
    const size_t plain_at = bin_add(&bin, plain, sizeof plain);
    size_t stride;
    const size_t at = add_numbers(&bin, q->component, count, &stride);
    char attributes[160];
    char target[64] = "";
    const bool is_position = strcmp(q->name, "POSITION") == 0;
    snprintf(attributes, sizeof attributes, "'POSITION':%d,'NORMAL':%d%s", is_position && !q->is_target,
             strcmp(q->name, "NORMAL") == 0 && !q->is_target,
             is_tangent && q->is_target ? ",'TANGENT':2" : "");
    if (q->is_target)
        snprintf(target, sizeof target, ",'targets':[{'%s':1}]", q->name);
    else if (is_tangent || is_texcoord)
        snprintf(attributes + strlen(attributes), 40, ",'%s':1", q->name);
    char body[2048];
    snprintf(
        body, sizeof body,
        "%s'bufferViews':[{'buffer':0,'byteOffset':%zu,'byteLength':48},{'buffer':0,'byteOffset':%zu,"
        "'byteLength':%zu,'byteStride':%zu}],'accessors':[{'bufferView':0,'componentType':5126,'count':3,"
        "'type':'VEC3'},{'bufferView':1,'componentType':%d,'normalized':%s,'count':3,'type':'VEC%d'},"
        "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC4'}],"
        "'meshes':[{'primitives':[{'attributes':{%s},'mode':0%s}]}]",
        q->is_declared ? "'extensionsUsed':['KHR_mesh_quantization'],"
                         "'extensionsRequired':['KHR_mesh_quantization'],"
                       : "",
        plain_at, at, 3 * stride, stride, q->component, q->is_normalized ? "true" : "false", count,
        attributes, target);
    return try_load(body, &bin, scene, error);
}

/* The array of the scene that the attribute became, and its components. */
static const float *find_array(const facet_scene *scene, const question *q, int *count)
{
    const scene_primitive *p = first_primitive(scene);
    *count = strcmp(q->name, "TANGENT") == 0 && !q->is_target ? 4 : q->name[1] == 'E' ? 2 : 3;
    if (q->is_target)
        return q->name[0] == 'P'   ? p->targets[0].positions
               : q->name[0] == 'N' ? p->targets[0].normals
                                   : p->targets[0].tangents;
    return q->name[0] == 'P'   ? p->positions
           : q->name[0] == 'N' ? p->normals
           : q->name[1] == 'A' ? p->tangents
                               : p->texcoords[0];
}

/* Whether the array holds the given values; normals and tangents are normalized. */
static void assert_values(const float *array, const question *q, int count)
{
    const bool is_unit = !q->is_target && (q->name[0] == 'N' || q->name[1] == 'A');
    assert_non_null(array);
    for (int v = 0; v < 3; v++) {
        double length = 1.0;
        if (is_unit) {
            length = 0.0;
            for (int k = 0; k < 3; k++)
                length += pow(value(q->component, q->is_normalized, v, k), 2);
            length = sqrt(length);
        }
        for (int k = 0; k < count; k++) {
            double expected = value(q->component, q->is_normalized, v, k) / (k < 3 ? length : 1.0);
            if (k == 3) /* the sign of the bitangent */
                expected = 1.0;
            assert_near(array[v * count + k], expected, 1e-6 * fmax(1.0, fabs(expected)));
        }
    }
}

/* One letter for each of BYTE, UBYTE, SHORT, USHORT: plain ones allowed 'p', normalised 'n', both 'b',
 * none '-'. The same without the extension. */
static const struct {
    const char *name;
    bool is_target;
    const char *allowed, *allowed_without;
} TABLE[] = {
    {"POSITION", false, "bbbb", "----"}, {"NORMAL", false, "n-n-", "----"},
    {"TANGENT", false, "n-n-", "----"},  {"TEXCOORD_0", false, "bbbb", "-n-n"},
    {"POSITION", true, "b-b-", "----"},  {"NORMAL", true, "n-n-", "----"},
    {"TANGENT", true, "n-n-", "----"},
};

static bool is_in(char letter, bool is_normalized)
{
    return letter == 'b' || letter == (is_normalized ? 'n' : 'p');
}

static void check(const char *name, bool is_target, int component, bool is_normalized, bool is_allowed,
                  bool needs_extension)
{
    for (int declared = 0; declared < 2; declared++) {
        const question q = {name, is_target, component, is_normalized, declared};
        facet_scene *scene = NULL;
        facet_error error = {0};
        facet_result result = try_attribute(&q, &scene, &error);
        if (!is_allowed) {
            const char *text = "has a type and componentType that"; /* what can be left out is */
            if (result == FACET_OK)
                assert_true(has_warning(scene, text));
            else
                assert_non_null(strstr(error.message, text));
            scene_destroy(scene);
            continue;
        }
        if (result != FACET_OK)
            fail_msg("%s", error.message);
        int count;
        const float *array = find_array(scene, &q, &count);
        assert_values(array, &q, count);
        assert_int_equal(has_note(scene, "that needs KHR_mesh_quantization"), needs_extension && !declared);
        scene_destroy(scene);
    }
}

static void every_type_of_every_attribute_is_read(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof TABLE / sizeof *TABLE; i++) {
        for (int c = 0; c < 4; c++)
            for (int n = 0; n < 2; n++) {
                const bool is_allowed = is_in(TABLE[i].allowed[c], n);
                check(TABLE[i].name, TABLE[i].is_target, BYTE + c, n, is_allowed,
                      !is_in(TABLE[i].allowed_without[c], n));
            }
        check(TABLE[i].name, TABLE[i].is_target, FLOAT, false, true, false);
    }
}

/* ---- where the transforms are ---- */

/* A box of 0 to 65535 under a node that scales it to 2 m and moves it: the extension's "dequantization
 * transform". */
static void nodes_undo_the_quantization_of_positions(void **state)
{
    (void)state;
    const uint16_t corners[3][4] = {{0, 0, 0}, {65535, 0, 0}, {0, 65535, 32768}};
    test_bin bin = {0};
    bin_add(&bin, corners, sizeof corners);
    facet_scene *scene =
        load("'extensionsUsed':['KHR_mesh_quantization'],'extensionsRequired':['KHR_mesh_quantization'],"
             "'bufferViews':[{'buffer':0,'byteLength':24,'byteStride':8}],'accessors':[{'bufferView':0,"
             "'componentType':5123,'count':3,'type':'VEC3'}],'meshes':[{'primitives':[{'attributes':"
             "{'POSITION':0}}]}],'nodes':[{'mesh':0,'scale':[3.0518044e-05,3.0518044e-05,3.0518044e-05],"
             "'translation':[-1,-1,5]}],'scenes':[{'nodes':[0]}],'scene':0",
             &bin);
    scene_pose pose = {0};
    assert_int_equal(scene_pose_create(scene, NULL, NULL, 1, &pose, NULL), FACET_OK);
    const float least[3] = {-1, -1, 5};
    const float most[3] = {1, 1, 6};
    assert_floats(pose.bounds_min, least, 3, 1e-4);
    assert_floats(pose.bounds_max, most, 3, 1e-4);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

/* Texture coordinates of 0 to 4095, which KHR_texture_transform scales to 0 to 1: the transform is the
 * texture's, and coordinates are not clamped or scaled before it. */
static void texture_transforms_undo_the_quantization_of_coordinates(void **state)
{
    (void)state;
    const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint16_t texcoords[6] = {0, 0, 4095, 0, 0, 4095};
    test_bin bin = {0};
    bin_add(&bin, positions, sizeof positions);
    bin_add(&bin, texcoords, sizeof texcoords);
    facet_scene *scene = load(
        "'extensionsUsed':['KHR_mesh_quantization','KHR_texture_transform'],"
        "'extensionsRequired':['KHR_mesh_quantization','KHR_texture_transform'],"
        "'bufferViews':[{'buffer':0,'byteLength':36},{'buffer':0,'byteOffset':36,'byteLength':12}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
        "{'bufferView':1,'componentType':5123,'count':3,'type':'VEC2'}],"
        "'images':[{'uri':'data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk"
        "+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=='}],'textures':[{'source':0}],"
        "'materials':[{'pbrMetallicRoughness':{'baseColorTexture':{'index':0,'extensions':"
        "{'KHR_texture_transform':{'scale':[0.0002442,0.0002442]}}}}}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':1},'material':0}]}]",
        &bin);
    const scene_primitive *p = first_primitive(scene);
    const scene_texture_ref *base = &scene->materials[0].textures[SCENE_BASE_COLOR_TEXTURE];
    for (size_t i = 0; i < p->vertex_count; i++) {
        const float *uv = p->texcoords[0] + 2 * i;
        assert_near(base->transform[0] * uv[0], p->positions[3 * i], 1e-4);
        assert_near(base->transform[4] * uv[1], p->positions[3 * i + 1], 1e-4);
    }
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_type_of_every_attribute_is_read),
        cmocka_unit_test(nodes_undo_the_quantization_of_positions),
        cmocka_unit_test(texture_transforms_undo_the_quantization_of_coordinates),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
