/* gl_program.h - compiled programs, each made on first use. */
#ifndef GL_GL_PROGRAM_H
#define GL_GL_PROGRAM_H

#include "gl/core/gl_context.h"
#include "gl/core/gl_program_text.h"

typedef struct gl_programs gl_programs;

facet_result gl_programs_create(gl_context *context, const facet_allocator *allocator, const facet_log *log,
                                gl_programs **out, facet_error *error);
/* Sets the log of the next image; NULL: none. */
void gl_programs_set_log(gl_programs *programs, const facet_log *log);
/* Sets source that is inserted before the mains of programs compiled from now on; tests use it to break them.
 * NULL: none. */
void gl_programs_set_prelude(gl_programs *programs, const char *prelude);
void gl_programs_destroy(gl_programs *programs); /* NULL is allowed; the context is current */

/* Starts to compile, in the background where the driver can, so that several programs compile at once. */
facet_result gl_programs_request(gl_programs *programs, gl_program_key key, facet_error *error);
/* Waits for a compiled and linked program and returns its OpenGL name. Samplers and blocks are bound as in
 * gl_blocks.h. Fails with FACET_ERROR_SYSTEM and the compiler's message; the numbered source goes to the log. */
facet_result gl_programs_get(gl_programs *programs, gl_program_key key, uint32_t *name, facet_error *error);

#endif
