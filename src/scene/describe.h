/* describe.h - what the files that describe a scene as JSON share; docs/inspect.md lists the members. */
#ifndef SCENE_DESCRIBE_H
#define SCENE_DESCRIBE_H

#include "base/text.h"
#include "scene/scene.h"

void describe_index(text *t, const char *key, uint32_t index); /* SCENE_NONE: null */
/* "extras" and "metadata", if any. */
void describe_meta(text *t, const scene_meta *meta);

/* An array of objects, each written by write(t, &items[i]). */
#define DESCRIBE_ARRAY(key, items, count, write)                                                             \
    do {                                                                                                     \
        text_json_begin_array(t, key);                                                                       \
        for (uint32_t index_ = 0; index_ < (count); index_++)                                                \
            write(t, &(items)[index_]);                                                                      \
        text_json_end_array(t);                                                                              \
    } while (0)

void describe_materials(text *t, const facet_scene *scene); /* "materials" */
void describe_images(text *t, const facet_scene *scene);    /* "textures", "images" */
void describe_externals(text *t, const facet_scene *scene); /* "external_assets", if any */
void describe_legacy(text *t, const facet_scene *scene);    /* "legacy", if any */

#endif
