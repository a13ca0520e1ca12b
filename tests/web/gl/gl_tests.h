/* gl_tests.h - the contexts of the tests in browsers. */
#ifndef WEB_GL_TESTS_H
#define WEB_GL_TESTS_H

#include <stdbool.h>

/* Creates a WebGL 2 context on a canvas of its own and makes it current; the last one is lost. false: the browser
 * has none. */
bool gl_tests_renew_context(void);
/* Loses the current context, as browsers do when a driver is reset. */
void gl_tests_lose_context(void);

#endif
