/* gl_light_tables.h - the tables of directional albedo (ibl/dfg.h) as textures of half floats: 2^-11 of each value. */
#ifndef GL_GL_LIGHT_TABLES_H
#define GL_GL_LIGHT_TABLES_H

#include "gl/core/gl_context.h"

typedef struct gl_light_tables {
    uint32_t albedo; /* DFG and sheen's albedo */
    uint32_t glass;  /* 3D: a layer per ior */
} gl_light_tables;

/* FACET_ERROR_MEMORY. */
facet_result gl_light_tables_create(gl_light_tables *tables, gl_context *context,
                                    const facet_allocator *allocator, facet_error *error);
void gl_light_tables_destroy(gl_light_tables *tables); /* {0} is allowed; leaves {0} */

#endif
