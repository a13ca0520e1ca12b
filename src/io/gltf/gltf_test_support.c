/* gltf_test_support.c - see gltf_test_support.h. */
#define _POSIX_C_SOURCE 200809L
#include "io/gltf/gltf_test_support.h"
#include "tests/support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

size_t bin_add(test_bin *bin, const void *bytes, size_t size)
{
    while (bin->size % 4)
        bin->bytes[bin->size++] = 0;
    size_t at = bin->size;
    assert_true(at + size <= sizeof bin->bytes);
    memcpy(bin->bytes + at, bytes, size);
    bin->size += size;
    return at;
}

static void put_u32(unsigned char *at, size_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (unsigned char)(value >> (8 * i));
}

static void double_quotes(char *text)
{
    for (; *text; text++)
        *text = *text == '\'' ? '"' : *text;
}

facet_result try_load(const char *body, const test_bin *bin, facet_scene **scene, facet_error *error)
{
    size_t room = strlen(body) + 256 + (bin ? bin->size : 0);
    unsigned char *file = calloc(1, room);
    assert_non_null(file);
    char *json = (char *)file + 20;
    int written =
        bin ? snprintf(json, room - 20, "{'asset':{'version':'2.0'},'buffers':[{'byteLength':%zu}]%s%s}",
                       bin->size, body[0] ? "," : "", body)
            : snprintf(json, room - 20, "{'asset':{'version':'2.0'}%s%s}", body[0] ? "," : "", body);
    double_quotes(json);
    size_t size = (size_t)written;
    while (size % 4)
        json[size++] = ' ';
    memcpy(file, "glTF\2\0\0\0", 8);
    put_u32(file + 12, size);
    memcpy(file + 16, "JSON", 4);
    size_t total = 20 + size;
    if (bin) {
        size_t padded = (bin->size + 3) / 4 * 4;
        put_u32(file + total, padded);
        memcpy(file + total + 4, "BIN\0", 4);
        memcpy(file + total + 8, bin->bytes, bin->size);
        memset(file + total + 8 + bin->size, 0, padded - bin->size);
        total += 8 + padded;
    }
    put_u32(file + 8, total);
    facet_result result = gltf_load_memory(file, total, "test.glb", NULL, scene, error);
    free(file);
    return result;
}

facet_scene *load(const char *body, const test_bin *bin)
{
    facet_scene *scene = NULL;
    facet_error error = {0};
    if (try_load(body, bin, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_non_null(scene);
    return scene;
}

/* Nodes that use the first mesh, or the first material, for a body without nodes. */
static const char *use_of(const char *body)
{
    if (strstr(body, "'nodes'"))
        return "";
    return strstr(body, "'meshes'")      ? ",'nodes':[{'mesh':0}]"
           : strstr(body, "'materials'") ? ",'nodes':[{'mesh':0}],'meshes':[{'primitives':[{'attributes':{},"
                                           "'material':0}]}]"
                                         : "";
}

void assert_left_out(const char *body, const test_bin *bin, const char *text)
{
    facet_scene *scene = load(body, bin);
    if (!has_warning(scene, text))
        fail_msg("no warning says \"%s\", but the first \"%s\"", text,
                 scene->warning_count ? scene->warnings[0] : "");
    scene_destroy(scene);
}

static void refuse(const char *body, const test_bin *bin, facet_result result, const char *text)
{
    facet_scene *scene = (facet_scene *)1;
    facet_error error = {0};
    assert_int_equal(try_load(body, bin, &scene, &error), result);
    assert_null(scene);
    assert_int_equal(error.result, result);
    if (!strstr(error.message, text))
        fail_msg("\"%s\" does not contain \"%s\"", error.message, text);
}

void assert_refused(const char *part, const test_bin *bin, facet_result result, const char *text)
{
    size_t size = strlen(part) + strlen(use_of(part)) + 1;
    char *body = malloc(size);
    assert_non_null(body);
    snprintf(body, size, "%s%s", part, use_of(part));
    refuse(body, bin, result, text);
    free(body);
}

bool has_warning(const facet_scene *scene, const char *text)
{
    for (uint32_t i = 0; i < scene->warning_count; i++)
        if (strstr(scene->warnings[i], text))
            return true;
    return false;
}

bool has_note(const facet_scene *scene, const char *text)
{
    for (uint32_t i = 0; i < scene->note_count; i++)
        if (strstr(scene->notes[i], text))
            return true;
    return false;
}

const scene_primitive *first_primitive(const facet_scene *scene)
{
    assert_true(scene->mesh_count > 0 && scene->meshes[0].primitive_count > 0);
    return &scene->meshes[0].primitives[0];
}

facet_result try_load_text(const char *json, facet_scene **scene, facet_error *error)
{
    char *copy = strdup(json);
    assert_non_null(copy);
    double_quotes(copy);
    facet_result result = gltf_load_memory(copy, strlen(copy), "test.gltf", NULL, scene, error);
    free(copy);
    return result;
}

/* ---- models with arrays ---- */

static size_t element_size(const char *type, unsigned component)
{
    static const struct {
        const char *type;
        size_t count;
    } types[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    size_t size = component < 5122                        ? 1
                  : component < 5124 || component == 5131 ? 2
                  : component == 5130                     ? 8
                                                          : 4;
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (strcmp(types[i].type, type) == 0)
            return types[i].count * size;
    fail_msg("%s is no type", type);
    return 0;
}

static void append(char *text, size_t room, const char *format, ...)
{
    size_t length = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    int written = vsnprintf(text + length, room - length, format, arguments);
    va_end(arguments);
    assert_true(written >= 0 && (size_t)written < room - length);
}

uint32_t model_add(test_model *model, const void *elements, size_t count, const char *type,
                   unsigned component, const char *members)
{
    size_t size = count * element_size(type, component);
    size_t at = bin_add(&model->bin, elements, size);
    const char *comma = model->count ? "," : "";
    append(model->views, sizeof model->views, "%s{'buffer':0,'byteOffset':%zu,'byteLength':%zu}", comma, at,
           size);
    append(model->accessors, sizeof model->accessors,
           "%s{'bufferView':%u,'componentType':%u,'count':%zu,'type':'%s'%s}", comma, model->count, component,
           count, type, members);
    return model->count++;
}

uint32_t model_add_floats(test_model *model, const float *floats, size_t count, const char *type)
{
    return model_add(model, floats, count, type, 5126, "");
}

/* The whole body: a block of malloc(). */
static char *model_body(const test_model *model, const char *format, va_list arguments)
{
    enum { ROOM = 1 << 16 };
    char *body = calloc(ROOM, 1);
    assert_non_null(body);
    append(body, ROOM, "'bufferViews':[%s],'accessors':[%s],", model->views, model->accessors);
    size_t length = strlen(body);
    int written = vsnprintf(body + length, ROOM - length, format, arguments);
    assert_true(written >= 0 && (size_t)written < ROOM - length);
    return body;
}

facet_scene *model_load(const test_model *model, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *body = model_body(model, format, arguments);
    va_end(arguments);
    facet_scene *scene = load(body, &model->bin);
    free(body);
    return scene;
}

void model_assert_refused(const test_model *model, const char *text, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *body = model_body(model, format, arguments);
    va_end(arguments);
    assert_refused(body, &model->bin, FACET_ERROR_INVALID, text);
    free(body);
}

void model_assert_left_out(const test_model *model, const char *text, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *body = model_body(model, format, arguments);
    va_end(arguments);
    assert_left_out(body, &model->bin, text);
    free(body);
}

facet_scene *load_shared(const char *path)
{
    char whole[1024];
    const char *folder = test_data();
    snprintf(whole, sizeof whole, "%s/models/%s", folder, path);
    facet_scene *scene = NULL;
    facet_error error = {0};
    if (gltf_load(whole, NULL, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_non_null(scene);
    return scene;
}
