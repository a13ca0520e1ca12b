/* ogl1_names.h - which entry of a document speaks of which name. */
#ifndef IO_OGL1_NAMES_H
#define IO_OGL1_NAMES_H

#include "io/ogl1/ogl1_reader.h"

typedef struct ogl1_name {
    const char *name;
    uint32_t entry;
    bool is_met; /* was looked up */
} ogl1_name;

typedef struct ogl1_names {
    size_t count;
    ogl1_name *names; /* sorted; each once, with the last entry that has it */
} ogl1_names;

/* The names of the materials, or of the objects, of all entries. Warns about those that several entries have. False: no
 * memory. */
bool ogl1_names_create(ogl1_document *d, bool of_objects, ogl1_names *out);
void ogl1_names_destroy(ogl1_names *n);
/* The entry that speaks of name; SCENE_NONE: none. */
uint32_t ogl1_names_find(ogl1_names *n, const char *name);

#endif
