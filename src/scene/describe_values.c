/* describe_values.c - small things that the descriptions are made of. */
#include "scene/describe.h"

#include <string.h>

/* Levels of extras and metadata that a description shows. System.Text.Json reads 64 levels, other programs 100 to 1000; a
 * description adds at most 8 around them. */
enum { MAX_DEPTH = 32 };

void describe_index(text *t, const char *key, uint32_t index)
{
    if (index == SCENE_NONE)
        text_json_string(t, key, NULL);
    else
        text_json_integer(t, key, index);
}

void describe_indices(text *t, const char *key, const uint32_t *indices, uint32_t count)
{
    text_json_begin_array(t, key);
    for (uint32_t i = 0; i < count; i++)
        text_json_integer(t, NULL, indices[i]);
    text_json_end_array(t);
}

/* Behind the string that begins at json. */
static const char *skip_string(const char *json)
{
    for (json++; *json && *json != '"'; json++)
        if (*json == '\\' && json[1])
            json++;
    return *json ? json + 1 : json;
}

/* Behind the value at json, an array or object. */
static const char *skip_nested(const char *json)
{
    size_t depth = 0;
    do {
        if (*json == '"') {
            json = skip_string(json);
            continue;
        }
        depth += *json == '[' || *json == '{';
        depth -= *json == ']' || *json == '}';
        json++;
    } while (*json && depth);
    return json;
}

/* A valid value as it stands, but for what is nested deeper than MAX_DEPTH: a string takes its place. */
static void describe_json(text *t, const char *key, const char *json)
{
    text_json_raw(t, key, "");
    size_t depth = 0;
    const char *from = json;
    for (const char *at = json; *at;) {
        if (*at == '"') {
            at = skip_string(at);
        } else if ((*at == '[' || *at == '{') && depth == MAX_DEPTH) {
            text_add_bytes(t, from, (size_t)(at - from));
            text_add(t, "\"(nested too deep to show)\"");
            from = at = skip_nested(at);
        } else {
            depth += *at == '[' || *at == '{';
            depth -= *at == ']' || *at == '}';
            at++;
        }
    }
    text_add(t, from);
}

void describe_meta(text *t, const scene_meta *meta)
{
    if (meta->extras)
        describe_json(t, "extras", meta->extras);
    if (meta->extensions)
        describe_json(t, "metadata", meta->extensions);
}
