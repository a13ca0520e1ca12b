/* gl.h - libepoxy's header for tests in browsers: WebGL 2's functions. */
#ifndef WEB_GL_EPOXY_GL_H
#define WEB_GL_EPOXY_GL_H

#include "gl/core/gl_api.h"

#define GL_UNKNOWN_CONTEXT_RESET 0x8255

/* A function pointer of libepoxy that a test replaces; such tests do not run in browsers. */
extern GLenum (*epoxy_glGetError)(void);

#endif
