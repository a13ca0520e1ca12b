/* gl_program.h - compiled programs, each made on first use. */
#ifndef GL_GL_PROGRAM_H
#define GL_GL_PROGRAM_H

#include "gl/core/gl_context.h"
#include "gl/core/gl_program_text.h"

typedef struct gl_programs gl_programs;

facet_result gl_programs_create(gl_context *context, const facet_allocator *allocator, const facet_log *log,
                                gl_programs **out, facet_error *error);
/* What the next picture's warnings go to; log NULL: nowhere. */
void gl_programs_set_log(gl_programs *programs, const facet_log *log);
/* Text before the mains of all programs that are made from now on, which tests break them with; NULL: none. */
void gl_programs_set_prelude(gl_programs *programs, const char *prelude);
void gl_programs_destroy(gl_programs *programs); /* NULL is allowed; the context is current */

/* Starts to compile, in the background where the driver does that, so that several programs compile at once. */
facet_result gl_programs_request(gl_programs *programs, gl_program_key key, facet_error *error);
/* Compiled and linked: its OpenGL name. Samplers are bound to the units of gl_units.h, blocks to those of gl_blocks.h. Fails
 * with FACET_ERROR_SYSTEM: what the compiler says; the assembled text, with line numbers, goes to the log. */
facet_result gl_programs_get(gl_programs *programs, gl_program_key key, uint32_t *name, facet_error *error);

#endif
