/* gl_tests.c - the renderer's test programs as functions of one module for browsers: a context for each, their tests
 * one after the other (shim/cmocka.h), and the lines that gl.mjs reads: "passed|FAILED|skipped|excluded
 * PROGRAM.TEST: message". */
#include "gl_tests.h"

#include <emscripten/em_js.h>
#include <emscripten/html5.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include "base/text.h"

/* See shim/epoxy. */
GLenum (*epoxy_glGetError)(void);
EGLBoolean (*epoxy_eglMakeCurrent)(EGLDisplay, EGLSurface, EGLSurface, EGLContext);

/* ---- contexts ---- */

EM_JS(void, add_canvas, (void), {
    const old = document.querySelector("canvas");
    if (old)
        old.remove();
    document.body.append(document.createElement("canvas"));
})

EM_JS(void, lose, (void), { GLctx.getExtension("WEBGL_lose_context").loseContext(); })

void gl_tests_lose_context(void)
{
    lose();
}

bool gl_tests_renew_context(void)
{
    EMSCRIPTEN_WEBGL_CONTEXT_HANDLE old = emscripten_webgl_get_current_context();
    if (old > 0) {
        if (!emscripten_is_webgl_context_lost(old))
            lose();
        emscripten_webgl_destroy_context(old);
    }
    EmscriptenWebGLContextAttributes attributes;
    emscripten_webgl_init_context_attributes(&attributes);
    attributes.majorVersion = 2;
    attributes.antialias = attributes.depth = false;
    add_canvas();
    EMSCRIPTEN_WEBGL_CONTEXT_HANDLE made = emscripten_webgl_create_context("canvas", &attributes);
    return made > 0 && emscripten_webgl_make_context_current(made) == EMSCRIPTEN_RESULT_SUCCESS;
}

/* ---- a test ---- */

static const char *program;
static jmp_buf leave;
static enum { PASSED, FAILED, SKIPPED } outcome;
static char message[2000];

static void say(const char *format, va_list arguments)
{
    size_t length = strlen(message);
    vsnprintf(message + length, sizeof message - length, format, arguments);
}

void print_message(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    say(format, arguments);
    va_end(arguments);
}

void print_error(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    say(format, arguments);
    va_end(arguments);
}

void _fail(const char *file, int line)
{
    print_message(" (%s:%d)", file, line);
    outcome = FAILED;
    longjmp(leave, 1);
}

void fail_test_at(const char *file, int line, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    say(format, arguments);
    va_end(arguments);
    _fail(file, line);
}

void skip_test(void)
{
    outcome = SKIPPED;
    longjmp(leave, 1);
}

void check_integer(uintmax_t value, uintmax_t least, uintmax_t most, bool is_wanted, const char *what,
                   const char *file, int line)
{
    if ((value >= least && value <= most) != is_wanted)
        fail_test_at(file, line, "%s: %jd, %jd", what, (intmax_t)value, (intmax_t)least);
}

void check_string(const char *a, const char *b, const char *file, int line)
{
    if (strcmp(a, b) != 0)
        fail_test_at(file, line, "\"%s\" in place of \"%s\"", a, b);
}

void check_memory(const void *a, const void *b, size_t size, bool is_wanted, const char *what,
                  const char *file, int line)
{
    size_t at = 0;
    while (at < size && ((const char *)a)[at] == ((const char *)b)[at])
        at++;
    if ((at == size) != is_wanted)
        fail_test_at(file, line, "%s: of %zu bytes, the first %zu are equal", what, size, at);
}

/* ---- a program ---- */

EM_JS(int, is_excluded, (const char *name), { return Module["isExcluded"](UTF8ToString(name)); })

static void report(const char *result, const char *test)
{
    for (char *c = message; *c; c++)
        *c = *c == '\n' ? ' ' : *c;
    printf("%s %s.%s: %s\n", result, program, test, message);
    message[0] = 0;
}

static void run_test(const struct CMUnitTest *test, void **state)
{
    static const char *const names[] = {"passed", "FAILED", "skipped"};
    char name[200];
    snprintf(name, sizeof name, "%s.%s", program, test->name);
    message[0] = 0;
    if (is_excluded(name)) {
        report("excluded", test->name);
        return;
    }
    outcome = PASSED;
    if (setjmp(leave) == 0)
        test->test(state);
    report(names[outcome], test->name);
}

int run_group(const struct CMUnitTest *tests, size_t count, int (*setup)(void **), int (*teardown)(void **))
{
    void *state = NULL;
    int failed = 0;
    outcome = PASSED;
    if (setjmp(leave) != 0 || (setup && setup(&state) != 0)) {
        report("FAILED", "setup");
        return 1;
    }
    for (size_t i = 0; i < count; i++) {
        run_test(&tests[i], &state);
        failed += outcome == FAILED;
    }
    if (teardown && setjmp(leave) == 0)
        teardown(&state);
    return failed;
}

/* ---- the programs: the main function of NAME_test.c is NAME_tests ---- */

#define GL_TEST(name) int name##_tests(void);
#include "gl_tests.def"
#undef GL_TEST

static const struct {
    const char *name;
    int (*run)(void);
} programs[] = {
#define GL_TEST(name) {#name, name##_tests},
#include "gl_tests.def"
#undef GL_TEST
};

EMSCRIPTEN_KEEPALIVE int gl_tests_count(void)
{
    return (int)(sizeof programs / sizeof *programs);
}

EMSCRIPTEN_KEEPALIVE const char *gl_tests_name(int index)
{
    return programs[index].name;
}

/* Runs a program with a context of its own; returns the number of failures. */
EMSCRIPTEN_KEEPALIVE int gl_tests_run(int index)
{
    program = programs[index].name;
    if (!gl_tests_renew_context()) {
        print_message("the browser has no WebGL 2");
        report("FAILED", "context");
        return 1;
    }
    int result = programs[index].run();
    if (result == 77)
        report("FAILED", "context");
    return result;
}
