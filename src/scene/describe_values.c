/* describe_values.c - small things that the descriptions are made of. */
#include "scene/describe.h"

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

void describe_meta(text *t, const scene_meta *meta)
{
    if (meta->extras)
        text_json_raw(t, "extras", meta->extras);
    if (meta->extensions)
        text_json_raw(t, "metadata", meta->extensions);
}
