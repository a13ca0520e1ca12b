/* gl_library.h - the module that draws with OpenGL, opened when it is asked for. */
#ifndef API_GL_LIBRARY_H
#define API_GL_LIBRARY_H

#include "gl/gl_entry.h"

/* Its functions; it stays open until the process ends. Safe from several threads. Fails with FACET_ERROR_SYSTEM: the
 * module is not there, or not this build's. */
facet_result gl_library_open(const gl_entry **entry, facet_error *error);
/* What the module was given of libfacet. */
const gl_host *gl_library_host(void);

#endif
