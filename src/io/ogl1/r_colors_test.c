/* r_colors_test.c - every color of R's colors() against col2rgb(); testdata/r_colors.txt was written by R
 * 4.2:
 *     n <- colors(); m <- col2rgb(n); writeLines(sprintf("%s #%02X%02X%02X", n, m[1,], m[2,], m[3,])) */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/ogl1/ogl1_json.h"

static void assert_color(const char *name, unsigned r, unsigned g, unsigned b, unsigned a)
{
    float rgba[4];
    const unsigned expected[4] = {r, g, b, a};
    if (!ogl1_find_r_color(name, rgba))
        fail_msg("\"%s\" is not found", name);
    for (int k = 0; k < 4; k++)
        if (rgba[k] != (float)expected[k] / 255.0f)
            fail_msg("\"%s\"[%d]: %g, not %u / 255", name, k, (double)rgba[k], expected[k]);
}

static void assert_none(const char *name)
{
    float rgba[4];
    if (ogl1_find_r_color(name, rgba))
        fail_msg("\"%s\" is found", name);
}

static void all_colors_of_r_are_known(void **state)
{
    (void)state;
    FILE *file = fopen("src/io/testdata/r_colors.txt", "r");
    char name[64];
    unsigned rgb;
    int count = 0;
    assert_non_null(file);
    for (; fscanf(file, "%63s #%6x", name, &rgb) == 2; count++)
        assert_color(name, rgb >> 16, rgb >> 8 & 255, rgb & 255, 255);
    fclose(file);
    assert_int_equal(count, 657);
}

static void spellings_of_r_are_accepted(void **state)
{
    (void)state;
    assert_color("Steel Blue", 70, 130, 180, 255);
    assert_color("STEELBLUE4", 54, 100, 139, 255);
    assert_color("Dark Slate Grey 3", 121, 205, 205, 255);
    assert_none("");
    assert_none("grey101");
    assert_none("gray05");
    assert_none("gray-1");
    assert_none("steelblue5");
    assert_none("steelblue0");
    assert_none("steelblu");
    assert_none("beige2"); /* has no shades */
    assert_none("5steelblue");
    assert_none("a name that is longer than any color has it");
}

static void hex_colors_are_read(void **state)
{
    (void)state;
    assert_color("#123456", 0x12, 0x34, 0x56, 255);
    assert_color("#abCDef80", 0xAB, 0xCD, 0xEF, 0x80);
    assert_none("#");
    assert_none("#123"); /* R does not take the short forms of style sheets either */
    assert_none("#1234");
    assert_none("#12345");
    assert_none("#1234567");
    assert_none("#123456789");
    assert_none("#12345g");
    assert_none("#-12345");
}

static void numbered_colors_are_read(void **state)
{
    (void)state;
    assert_color("1", 0, 0, 0, 255);
    assert_color("2", 223, 83, 107, 255);
    assert_color("8", 158, 158, 158, 255);
    assert_color("9", 0, 0, 0, 255);
    assert_color("12", 34, 151, 230, 255); /* col2rgb("12") */
    assert_color("0", 255, 255, 255, 0);
    assert_color("transparent", 255, 255, 255, 0);
    assert_color("NA", 255, 255, 255, 0);
    assert_none("-1");
    assert_none("1.5");
    assert_none("9999");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_colors_of_r_are_known),
        cmocka_unit_test(spellings_of_r_are_accepted),
        cmocka_unit_test(hex_colors_are_read),
        cmocka_unit_test(numbered_colors_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
