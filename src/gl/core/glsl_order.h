/* glsl_order.h - for tests: whether a GLSL text defines its functions and structures before it uses them. Compilers say so
 * too, but only those of the machine at hand, and each in the configurations that it is shown. */
#ifndef GL_GLSL_ORDER_H
#define GL_GLSL_ORDER_H

#include <stdbool.h>
#include <stddef.h>

/* Reads a whole text as a preprocessor does: lines that #if leaves out do not count, what stands in a macro counts where the
 * macro is used. False: complaint says in which line what is used that is not defined there, or what is not understood. */
bool glsl_order_check(const char *text, char *complaint, size_t size);

#endif
