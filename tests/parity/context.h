/* context.h - a context for parity_test.c: by EGL, and in a browser by tests/web/gl/parity_context_web.c. */
#ifndef PARITY_CONTEXT_H
#define PARITY_CONTEXT_H

#include <stdbool.h>

/* Makes a GLES 3 context without a window current; false: there is none. */
bool parity_context_create(void);
/* false: functions like sin() have 11 bits, which is all that Vulkan and OpenGL ES ask for. */
bool parity_context_is_precise(void);

#endif
