/* ogl1_writer.h - what the files of the writer of rgl's parameters share. */
#ifndef IO_OGL1_WRITER_H
#define IO_OGL1_WRITER_H

#include "base/text.h"
#include "scene/legacy.h"

/* An object that is made of one material. */
typedef struct ogl1_object {
    const char *name;
    uint32_t material, node;
} ogl1_object;

/* ogl1_objects.c: the objects that say of which material they are when they are named: nodes without nodes below them
 * whose name no other material's object has; of nodes without name their meshes. Sorted by material, then node. *out is
 * one block of mem_alloc(). False: no memory. */
bool ogl1_objects_create(const facet_scene *scene, const facet_allocator *allocator, ogl1_object **out,
                         size_t *count);

/* ogl1_lights_write.c: the members "lights" and "background". */
void ogl1_write_lights(const scene_legacy *legacy, text *out);
/* "#rrggbb" where the color has 8 bits, else three numbers; key as for text_json_string(). */
void ogl1_write_color(text *out, const char *key, const float rgb[3]);

/* A new line in front of the next value. */
void ogl1_write_line(text *out);

#endif
