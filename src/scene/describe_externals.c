/* describe_externals.c - assets of other files as JSON. */
#include "scene/describe.h"

static void write_external(text *t, const scene_external *e)
{
    text_json_begin_object(t, NULL);
    text_json_string(t, "name", e->name);
    text_json_string(t, "file", e->file);
    text_json_integer(t, "node", e->node);
    text_json_integer(t, "depth", e->depth);
    text_json_integer(t, "nodes", e->node_count);
    text_json_end_object(t);
}

void describe_externals(text *t, const facet_scene *scene)
{
    if (scene->external_count)
        DESCRIBE_ARRAY("external_assets", scene->externals, scene->external_count, write_external);
}
