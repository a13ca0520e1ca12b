/* glsl_compact.h - shader text without what only people read. */
#ifndef GLSL_GLSL_COMPACT_H
#define GLSL_GLSL_COMPACT_H

/* Removes comments, blank lines, and the spaces that no token needs, in place. Every line that has a token stays a line,
 * so that a compiler's message still leads to it; directives keep single spaces. */
void glsl_compact(char *text);

#endif
