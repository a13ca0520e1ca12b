/* glsl_compact_test.c - compact shader text has the tokens and the lines of the text that it was made of. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "glsl/glsl_compact.h"

static void check(const char *text, const char *expected)
{
    char buffer[512];
    snprintf(buffer, sizeof buffer, "%s", text);
    glsl_compact(buffer);
    assert_string_equal(buffer, expected);
}

static void comments_and_blank_lines_go(void **state)
{
    (void)state;
    check("/* a\n * b */\nfloat x;   // y\n\n   \nint/**/y; /* at\nthe end */ int z;\n",
          "float x;\nint y;int z;\n");
    check("a /* open", "a");
    check("", "");
}

static void tokens_stay_apart(void **state)
{
    (void)state;
    check("    return a - -b + +c;\n", "return a- -b+ +c;\n");
    check("x = y * ( 2.0f / z ) ;\n", "x=y*(2.0f/z);\n");
    check("const int i = 0x1fu & ~ 3u;", "const int i=0x1fu&~3u;");
    check("a < b && c >= ! d", "a<b&&c>= !d");
}

static void directives_keep_their_spaces(void **state)
{
    (void)state;
    check("#define A (b)   /* c */\n#define F(x)  ((x) * 2)\n  #ifdef A\n",
          "#define A (b)\n#define F(x) ((x) * 2)\n#ifdef A\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(comments_and_blank_lines_go),
        cmocka_unit_test(tokens_stay_apart),
        cmocka_unit_test(directives_keep_their_spaces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
