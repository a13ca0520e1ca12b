/* parity_context_web.c - tests/parity in a browser: its context, and its main function with the file of its argument,
 * which gl.mjs puts there. */
#include <emscripten/html5.h>

#include "tests/parity/context.h"

bool parity_context_create(void)
{
    EMSCRIPTEN_WEBGL_CONTEXT_HANDLE current = emscripten_webgl_get_current_context();
    return current > 0 && emscripten_webgl_enable_extension(current, "EXT_color_buffer_float");
}

bool parity_context_is_precise(void)
{
    return false; /* SwiftShader */
}

int parity_with_arguments(int argc, char **argv);
int parity_tests(void)
{
    char *arguments[] = {"parity", "/parity.glsl"};
    return parity_with_arguments(2, arguments);
}
