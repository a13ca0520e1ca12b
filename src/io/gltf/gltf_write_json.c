/* gltf_write_json.c - helpers for the JSON of the glTF writer. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/result.h"
#include "base/text.h"
#include "base/utf8.h"
#include "io/gltf/gltf_writer.h"

bool gltf_writer_is_ok(const gltf_writer *w)
{
    return w->result == FACET_OK;
}

void gltf_writer_fail_memory(gltf_writer *w, size_t size)
{
    if (gltf_writer_is_ok(w))
        w->result = fail_memory(w->error, "glTF", size);
}

void gltf_put(gltf_writer *w, json_t *object, const char *key, json_t *value)
{
    if (json_object_set_new(object, key, value) != 0)
        gltf_writer_fail_memory(w, 0);
}

void gltf_append(gltf_writer *w, json_t *array, json_t *value)
{
    if (json_array_append_new(array, value) != 0)
        gltf_writer_fail_memory(w, 0);
}

json_t *gltf_json_text(gltf_writer *w, const char *words)
{
    size_t size = strlen(words);
    if (utf8_is_valid(words, size))
        return json_stringn(words, size);
    if (!w->has_other_text)
        log_warning(w->log, "%s: \"%.200s\" is not UTF-8, which glTF needs; its bytes are taken as Latin-1",
                    w->scene->source, words);
    w->has_other_text = true;
    char *copy = mem_alloc(w->allocator, size, 2);
    json_t *string = copy ? json_stringn(copy, utf8_from_latin1(words, size, copy)) : NULL;
    mem_free(copy);
    return string;
}

json_t *gltf_put_object(gltf_writer *w, json_t *object, const char *key)
{
    json_t *there = json_object_get(object, key);
    if (there)
        return there;
    gltf_put(w, object, key, json_object());
    return json_object_get(object, key);
}

json_t *gltf_put_array(gltf_writer *w, json_t *object, const char *key)
{
    json_t *there = json_object_get(object, key);
    if (there)
        return there;
    gltf_put(w, object, key, json_array());
    return json_object_get(object, key);
}

/* JSON has neither infinities, which become the largest portable number, nor NaN, which becomes 0. */
static json_t *json_decimal(const char digits[TEXT_FLOAT_SIZE])
{
    double number = strtod(digits, NULL);
    number = isnan(number) ? 0.0 : fmax(-(double)FLT_MAX, fmin(number, (double)FLT_MAX));
    if (number >= -1e9 && number <= 1e9 && number == (double)(json_int_t)number &&
        !(number == 0.0 && digits[0] == '-'))
        return json_integer((json_int_t)number);
    return json_real(number);
}

/* The double nearest to the shortest decimal of the float, which prints with 9 digits. */
json_t *gltf_json_float(float value)
{
    char digits[TEXT_FLOAT_SIZE];
    text_shortest_float(value, digits);
    return json_decimal(digits);
}

json_t *gltf_json_floats(const float *values, size_t count)
{
    json_t *array = json_array();
    for (size_t i = 0; i < count; i++)
        if (json_array_append_new(array, gltf_json_float(values[i])) != 0) {
            json_decref(array);
            return NULL;
        }
    return array;
}

json_t *gltf_json_doubles(const double *values, size_t count)
{
    json_t *array = json_array();
    for (size_t i = 0; i < count; i++) {
        char digits[TEXT_FLOAT_SIZE];
        text_shortest_double(values[i], digits);
        if (json_array_append_new(array, json_decimal(digits)) != 0) {
            json_decref(array);
            return NULL;
        }
    }
    return array;
}

json_t *gltf_json_indices(const uint32_t *indices, size_t count)
{
    json_t *array = json_array();
    for (size_t i = 0; i < count; i++)
        if (json_array_append_new(array, json_integer(indices[i])) != 0) {
            json_decref(array);
            return NULL;
        }
    return array;
}

void gltf_put_name(gltf_writer *w, json_t *object, const char *name)
{
    if (name && name[0])
        gltf_put(w, object, "name", gltf_json_text(w, name));
}

void gltf_put_index(gltf_writer *w, json_t *object, const char *key, uint32_t index)
{
    if (index != SCENE_NONE)
        gltf_put(w, object, key, json_integer(index));
}

void gltf_put_floats(gltf_writer *w, json_t *object, const char *key, const float *values,
                     const float *defaults, size_t count)
{
    bool differs = false;
    for (size_t i = 0; i < count; i++)
        differs = differs || values[i] != (defaults ? defaults[i] : 0.0f);
    if (differs)
        gltf_put(w, object, key, count == 1 ? gltf_json_float(values[0]) : gltf_json_floats(values, count));
}

void gltf_put_float(gltf_writer *w, json_t *object, const char *key, float value, float default_value)
{
    gltf_put_floats(w, object, key, &value, &default_value, 1);
}

static void use_extension(gltf_writer *w, const char *name)
{
    if (!json_object_get(w->extensions_used, name))
        gltf_put(w, w->extensions_used, name, json_false());
}

void gltf_require_extension(gltf_writer *w, const char *name)
{
    gltf_put(w, w->extensions_used, name, json_true());
}

json_t *gltf_put_extension(gltf_writer *w, json_t *object, const char *name)
{
    use_extension(w, name);
    return gltf_put_object(w, gltf_put_object(w, object, "extensions"), name);
}

static bool has_many_digits(const json_t *value)
{
    size_t index;
    const char *key;
    json_t *element;
    bool found = false;
    if (json_is_real(value)) {
        char digits[40];
        snprintf(digits, sizeof digits, "%.15g", json_real_value(value));
        return strtod(digits, NULL) != json_real_value(value);
    }
    if (json_is_array(value))
        json_array_foreach(value, index, element) found = found || has_many_digits(element);
    else
        json_object_foreach((json_t *)(uintptr_t)value, key, element) found =
            found || has_many_digits(element);
    return found;
}

/* Parses JSON text of the original file, whose nesting the reader limited. */
static json_t *parse(gltf_writer *w, const char *json)
{
    json_t *value = json_loads(json, JSON_DECODE_ANY | JSON_ALLOW_NUL, NULL);
    if (!value) {
        gltf_writer_fail_memory(w, 0);
        return NULL;
    }
    w->needs_all_digits = w->needs_all_digits || has_many_digits(value);
    return value;
}

/* RFC 3986: escapes bytes that are neither unreserved nor UTF-8; in a name that is not UTF-8, all bytes
 * beyond ASCII. */
void gltf_put_uri(gltf_writer *w, json_t *object, const char *name)
{
    const bool has_characters = utf8_is_valid(name, strlen(name));
    char *uri = mem_alloc(w->allocator, 3 * strlen(name) + 1, 1);
    char *at = uri;
    if (!uri) {
        gltf_writer_fail_memory(w, 3 * strlen(name) + 1);
        return;
    }
    for (; *name; name++) {
        unsigned char c = (unsigned char)*name;
        bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                        strchr("-._~", c) || (c >= 0x80 && has_characters);
        if (is_plain)
            *at++ = (char)c;
        else
            at += snprintf(at, 4, "%%%02X", c);
    }
    *at = 0;
    gltf_put(w, object, "uri", json_string(uri));
    mem_free(uri);
}

void gltf_put_meta(gltf_writer *w, json_t *object, const scene_meta *meta)
{
    if (meta->extensions) {
        json_t *extensions = parse(w, meta->extensions);
        const char *name;
        json_t *value;
        json_object_foreach(extensions, name, value)
        {
            use_extension(w, name);
            gltf_put(w, gltf_put_object(w, object, "extensions"), name, json_incref(value));
        }
        json_decref(extensions);
    }
    if (meta->extras)
        gltf_put(w, object, "extras", parse(w, meta->extras));
}
