/* text.c - see text.h. */
#include "base/text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/utf8.h"

void text_add_bytes(text *t, const void *bytes, size_t size)
{
    if (t->has_failed)
        return;
    if (!mem_reserve(&t->allocator, (void **)&t->data, &t->capacity, t->length + size + 1, 1)) {
        t->has_failed = true;
        return;
    }
    memcpy(t->data + t->length, bytes, size);
    t->length += size;
    t->data[t->length] = 0;
}

void text_add(text *t, const char *string)
{
    text_add_bytes(t, string, strlen(string));
}

void text_addf(text *t, const char *format, ...)
{
    char small[256];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(small, sizeof small, format, arguments);
    va_end(arguments);
    if (length < 0)
        return;
    if ((size_t)length < sizeof small) {
        text_add_bytes(t, small, (size_t)length);
        return;
    }
    char *large = malloc((size_t)length + 1);
    if (!large) {
        t->has_failed = true;
        return;
    }
    va_start(arguments, format);
    vsnprintf(large, (size_t)length + 1, format, arguments);
    va_end(arguments);
    text_add_bytes(t, large, (size_t)length);
    free(large);
}

void text_destroy(text *t)
{
    mem_free(t->data);
    *t = (text){0};
}

/* ---- JSON ---- */

static void add_quoted(text *t, const char *value)
{
    text_add(t, "\"");
    const unsigned char *s = (const unsigned char *)value;
    while (*s) {
        size_t length = utf8_length(s, SIZE_MAX);
        if (length == 0) {
            text_add(t, "\xef\xbf\xbd");
            length = 1;
        } else if (*s == '"' || *s == '\\') {
            text_addf(t, "\\%c", *s);
        } else if (*s < 0x20 || *s == 0x7f) {
            text_addf(t, "\\u%04x", *s);
        } else {
            text_add_bytes(t, s, length);
        }
        s += length;
    }
    text_add(t, "\"");
}

static void begin_value(text *t, const char *key)
{
    if (t->needs_comma)
        text_add(t, ",");
    t->needs_comma = true;
    if (key) {
        add_quoted(t, key);
        text_add(t, ":");
    }
}

void text_json_begin_object(text *t, const char *key)
{
    begin_value(t, key);
    text_add(t, "{");
    t->needs_comma = false;
}

void text_json_end_object(text *t)
{
    text_add(t, "}");
    t->needs_comma = true;
}

void text_json_begin_array(text *t, const char *key)
{
    begin_value(t, key);
    text_add(t, "[");
    t->needs_comma = false;
}

void text_json_end_array(text *t)
{
    text_add(t, "]");
    t->needs_comma = true;
}

void text_json_string(text *t, const char *key, const char *value)
{
    begin_value(t, key);
    if (value)
        add_quoted(t, value);
    else
        text_add(t, "null");
}

void text_json_bool(text *t, const char *key, bool value)
{
    begin_value(t, key);
    text_add(t, value ? "true" : "false");
}

void text_json_integer(text *t, const char *key, int64_t value)
{
    begin_value(t, key);
    text_addf(t, "%lld", (long long)value);
}

void text_json_float(text *t, const char *key, float value)
{
    begin_value(t, key);
    if (!isfinite(value)) {
        text_add(t, "null");
        return;
    }
    char digits[TEXT_FLOAT_SIZE];
    text_shortest_float(value, digits);
    text_add(t, digits);
}

void text_json_floats(text *t, const char *key, const float *values, size_t count)
{
    text_json_begin_array(t, key);
    for (size_t i = 0; i < count; i++)
        text_json_float(t, NULL, values[i]);
    text_json_end_array(t);
}

void text_json_doubles(text *t, const char *key, const double *values, size_t count)
{
    text_json_begin_array(t, key);
    for (size_t i = 0; i < count; i++) {
        char digits[TEXT_FLOAT_SIZE] = "null";
        if (isfinite(values[i]))
            text_shortest_double(values[i], digits);
        text_json_raw(t, NULL, digits);
    }
    text_json_end_array(t);
}

void text_json_place(text *t, const char *key, const float values[3], const double origin[3])
{
    text_json_begin_array(t, key);
    for (size_t i = 0; i < 3; i++) {
        char digits[TEXT_FLOAT_SIZE];
        text_shortest_place(values[i], origin[i], digits);
        text_json_raw(t, NULL, digits);
    }
    text_json_end_array(t);
}

void text_json_raw(text *t, const char *key, const char *json)
{
    begin_value(t, key);
    text_add(t, json ? json : "null");
}
