/* gltf_test_support.c - see gltf_test_support.h. */
#define _POSIX_C_SOURCE 200809L
#include "io/gltf_test_support.h"

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

void assert_refused(const char *body, const test_bin *bin, facet_result result, const char *text)
{
    facet_scene *scene = (facet_scene *)1;
    facet_error error = {0};
    assert_int_equal(try_load(body, bin, &scene, &error), result);
    assert_null(scene);
    assert_int_equal(error.result, result);
    if (!strstr(error.message, text))
        fail_msg("\"%s\" does not contain \"%s\"", error.message, text);
}

bool has_warning(const facet_scene *scene, const char *text)
{
    for (uint32_t i = 0; i < scene->warning_count; i++)
        if (strstr(scene->warnings[i], text))
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
