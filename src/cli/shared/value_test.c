/* value_test.c - sizes, times, angles, orbits, colors, names. */
#include "cli/render/render_options.h"
#include "cli/shared/output.h"
#include "cli/shared/value.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h> /* after base/result.h, which has a function of the name of its macro fail() */

#include <math.h>
#include <stdio.h>
#include <string.h>

#define DEGREE 0.017453292519943295

/* In double: cmocka's own comparison is in float. */
static void expect_near(double got, double expected, double tolerance)
{
    if (!(fabs(got - expected) <= tolerance))
        fail_msg("%.9g is not within %g of %.9g", got, tolerance, expected);
}

static void test_numbers(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double number;
    } good[] = {{"1", 1},  {"-1", -1}, {"+.5", 0.5}, {" 2.5 ", 2.5}, {"1e3", 1000}, {"-1.5e-2", -0.015},
                {"5.", 5}, {"0", 0},   {"00012", 12}};
    double number;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        assert_true(value_number(good[i].text, &number));
        expect_near(number, good[i].number, 1e-12);
    }
    static const char *const bad[] = {"",    " ",     "x",   "nan", "inf", "-inf", "0x10",
                                      "1,5", "1e999", "--1", "1 2", ".",   "+",    "-."};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        number = 42.0;
        if (value_number(bad[i], &number))
            fail_msg("\"%s\" was read as %g", bad[i], number);
        expect_near(number, 42.0, 0.0);
    }
}

static void test_sizes(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        uint32_t width, height;
    } good[] = {{"640x480", 640, 480},
                {"640,480", 640, 480},
                {"640X480", 640, 480},
                {"512", 512, 512},
                {"1x65536", 1, 65536},
                {"640\xc3\x97"
                 "480",
                 640, 480},
                {"64 x 32", 64, 32}};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        uint32_t w = 0, h = 0;
        if (!value_size(good[i].text, &w, &h) || w != good[i].width || h != good[i].height)
            fail_msg("\"%s\" was read as %u, %u", good[i].text, w, h);
    }
    static const char *const bad[] = {"",     "0",   "x",     "640x",      "x480", "640x0",
                                      "-1x2", "1.5", "65537", "640x480x3", "1e9",  "0x480"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        uint32_t w = 7, h = 8;
        if (value_size(bad[i], &w, &h) || w != 7 || h != 8)
            fail_msg("\"%s\" was read as %u, %u", bad[i], w, h);
    }
    uint32_t r[4];
    assert_true(value_rectangle("10,20,30,40", r));
    assert_int_equal(r[3], 40);
    assert_false(value_rectangle("10,20,0,40", r));
    assert_false(value_rectangle("-1,20,3,40", r));
    assert_false(value_rectangle("1,2,3", r));
}

static void test_units(void **state)
{
    (void)state;
    uint64_t bytes;
    assert_true(value_bytes("2G", &bytes) && bytes == (uint64_t)2 << 30);
    assert_true(value_bytes("512MiB", &bytes) && bytes == (uint64_t)512 << 20);
    assert_true(value_bytes("1.5k", &bytes) && bytes == 1536);
    assert_true(value_bytes("0", &bytes) && bytes == 0);
    assert_false(value_bytes("2X", &bytes) || value_bytes("-1", &bytes) || value_bytes("1e30", &bytes));
    double x;
    assert_true(value_seconds("500ms", &x) && fabs(x - 0.5) < 1e-12);
    assert_true(value_seconds("5m", &x) && fabs(x - 300.0) < 1e-12);
    assert_true(value_seconds("2", &x) && fabs(x - 2.0) < 1e-12);
    assert_false(value_seconds("0", &x) || value_seconds("-1s", &x) || value_seconds("1d", &x));
    assert_true(value_exposure("+0.5", &x) && fabs(x - 0.5) < 1e-12);
    assert_true(value_exposure("2x", &x) && fabs(x - 1.0) < 1e-12);
    assert_true(value_exposure("0.5X", &x) && fabs(x + 1.0) < 1e-12);
    assert_true(value_exposure("-1 EV", &x) && fabs(x + 1.0) < 1e-12);
    bool is_metered;
    assert_true(value_metered_exposure("auto", &is_metered, &x) && is_metered && x == 0.0);
    assert_true(value_metered_exposure("auto-0.5", &is_metered, &x) && is_metered && x == -0.5);
    assert_true(value_metered_exposure("2x", &is_metered, &x) && !is_metered && fabs(x - 1.0) < 1e-12);
    assert_false(value_metered_exposure("automatic", &is_metered, &x) ||
                 value_metered_exposure("", &is_metered, &x));
    assert_false(value_exposure("0x", &x) || value_exposure("-2x", &x) || value_exposure("1y", &x));
    assert_true(value_angle("90", &x) && fabs(x - 90.0 * DEGREE) < 1e-12);
    assert_true(value_angle("-90deg", &x) && fabs(x + 90.0 * DEGREE) < 1e-12);
    assert_true(value_angle("1.5rad", &x) && fabs(x - 1.5) < 1e-12);
    assert_false(value_angle("90%", &x));
    assert_false(value_angle("1e300", &x));
}

static const facet_orbit start = {
    .polar_rad = 1.0f, .radius_scale = 1.05f, .azimuth_rad = 0.25f, .fov_y_rad = 0.5f};

static void test_orbits(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double azimuth_deg, polar_deg, radius, radius_scale;
    } good[] = {
        {"30,75,105%", 30, 75, 0, 1.05},
        {"0deg 75deg 105%", 0, 75, 0, 1.05},
        {"45deg 55deg 2.5m", 45, 55, 2.5, 1.05},
        {"-30 , 90 , 250cm", -30, 90, 2.5, 1.05},
        {"10,20,3", 10, 20, 3, 1.05},
        {"10,20,400mm", 10, 20, 0.4, 1.05},
        {"10deg, 0deg, 50%", 10, 0, 0, 0.5},
        {"0.5rad 180deg 80%", 0.5 / DEGREE, 180, 0, 0.8},
        {"370,20", 10, 20, 0, 1.05},
    };
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        facet_orbit o = start;
        if (!orbit_parse(good[i].text, &o))
            fail_msg("\"%s\" was refused", good[i].text);
        expect_near((double)o.azimuth_rad, good[i].azimuth_deg * DEGREE, 1e-5);
        expect_near((double)o.polar_rad, good[i].polar_deg * DEGREE, 1e-5);
        expect_near((double)o.radius, good[i].radius, 1e-6);
        expect_near((double)o.radius_scale, good[i].radius_scale, 1e-6);
    }
    facet_orbit o = start;
    assert_true(orbit_parse("auto auto auto", &o) && memcmp(&o, &start, sizeof o) == 0);
    assert_true(orbit_parse("auto,90,auto", &o));
    expect_near((double)o.azimuth_rad, 0.25, 1e-6);
    expect_near((double)o.polar_rad, 90.0 * DEGREE, 1e-6);
    static const char *const bad[] = {
        "",      ",",       "30,",       "30,75,", "30,75,105%,1", "30,200",
        "30,-1", "30,75,0", "30,75,-5%", "30m",    "30,75,5deg",   "30,75,5lightyears",
        "x",     "30;75",   "30,75%"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        facet_orbit untouched = start;
        if (orbit_parse(bad[i], &untouched) || memcmp(&untouched, &start, sizeof start) != 0)
            fail_msg("\"%s\" was accepted", bad[i]);
    }
}

static void test_targets(void **state)
{
    (void)state;
    double t[3] = {7, 7, 7};
    bool is_given[3];
    assert_true(target_parse("0m 1.5m -20cm", t, is_given));
    expect_near(t[1], 1.5, 1e-6);
    expect_near(t[2], -0.2, 1e-6);
    assert_true(is_given[0] && is_given[1] && is_given[2]);
    assert_true(target_parse("4526331.337,100000000.125,0", t, is_given));
    assert_true(t[0] == 4526331.337 && t[1] == 100000000.125);
    assert_true(target_parse("auto", t, is_given) && !is_given[0] && !is_given[2]);
    assert_true(target_parse("auto,1,auto", t, is_given) && !is_given[0] && is_given[1]);
    assert_false(target_parse("1,2", t, is_given) || target_parse("1,2,3,4", t, is_given) ||
                 target_parse("1,2,3deg", t, is_given) || target_parse("", t, is_given));
}

static void test_colors(void **state)
{
    (void)state;
    float c[3], d[3];
    assert_true(color_parse("#fff", c) && c[0] == 1.0f && c[1] == 1.0f && c[2] == 1.0f);
    assert_true(color_parse("#123", c) && color_parse("#112233", d) && memcmp(c, d, sizeof c) == 0);
    assert_true(color_parse("RebeccaPurple", c) && color_parse("#663399", d) && memcmp(c, d, sizeof c) == 0);
    assert_true(color_parse("grey", c) && color_parse("#808080", d) && memcmp(c, d, sizeof c) == 0);
    expect_near((double)c[0], 0.215861, 1e-5); /* IEC 61966-2-1 for 128 / 255 */
    assert_true(color_parse("aliceblue", c) && color_parse("yellowgreen", c)); /* both ends of the table */
    assert_true(color_parse("green", c) && c[0] == 0.0f && c[1] < 0.25f);      /* CSS, not X11 */
    static const char *const bad[] = {"", "#", "#12", "#1234", "#12345g", "#+12345", "notacolor", "#1234567"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_false(color_parse(bad[i], c));
}

static void test_output_names(void **state)
{
    (void)state;
    static const struct {
        const char *pattern, *name;
    } cases[] = {
        {"a.png", "a.png"},
        {"turn_####.png", "turn_0007.png"},
        {"turn_%04d.png", "turn_0007.png"},
        {"t%d.png", "t7.png"},
        {"part#2.png", "part#2.png"},
        {"out/{stem}.png", "out/helmet.v1.png"},
        {"{stem}_##.png", "helmet.v1_07.png"},
        {"out/{dir}/{name}.png", "out/old/helmet.v1.glb.png"},
        {"{dir}{index}.png", "old007.png"},
        {"100%.png", "100%.png"},
        {"%s%x.png", "%s%x.png"},
        {"{stem}/{stem}.png", "helmet.v1/helmet.v1.png"},
    };
    const model_name model = {"models/old/helmet.v1.glb", "old", 7, 120}, flat = {.path = "helmet.glb"};
    const uint32_t frame = 7, large = 123456, one = 1;
    char name[64];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_true(output_name_expand(cases[i].pattern, &model, &frame, name, sizeof name));
        assert_string_equal(name, cases[i].name);
    }
    assert_true(output_name_expand("####", &model, &large, name, sizeof name));
    assert_string_equal(name, "123456");
    assert_true(output_name_has_frame("a##") && output_name_has_frame("%04d") &&
                !output_name_has_frame("a#%s%%"));
    char small[8];
    assert_false(output_name_expand("12345678", &model, &one, small, sizeof small));
    assert_true(output_name_expand("1234567", &model, &one, small, sizeof small));
    assert_false(output_name_expand("12345{dir}", &model, &one, small, sizeof small));
    assert_true(output_name_expand("{dir}/{stem}_{index}_##.png", &flat, NULL, name, sizeof name));
    assert_string_equal(name, "helmet_1_##.png");
    assert_true(output_name_expand("{stem}{dir}", &(model_name){.path = NULL}, NULL, name, sizeof name));
    assert_string_equal(name, "facet");
    assert_true(output_name_has_model("a{dir}b") && !output_name_has_model("{}{stems"));
    assert_true(output_name_stem("dir.d/helmet.v2.glb", name, sizeof name));
    assert_string_equal(name, "helmet.v2");
    assert_true(output_name_stem("a/.hidden", name, sizeof name));
    assert_string_equal(name, ".hidden");
    assert_true(output_name_stem("a/", name, sizeof name));
    assert_string_equal(name, "model");
}

/* ---- lists of frame numbers ---- */

/* The numbers of a list, separated by blanks; "no" where text is none. */
static const char *frame_numbers(const char *text)
{
    static char out[256];
    frame_list list;
    size_t used = 0;
    out[0] = 0;
    if (!frame_list_parse(text, &list))
        return "no";
    for (uint32_t i = 0; i < list.frame_count && used < sizeof out - 12; i++)
        used +=
            (size_t)snprintf(out + used, sizeof out - used, "%s%u", i ? " " : "", frame_list_at(&list, i));
    return out;
}

static void lists_are_read(void **state)
{
    (void)state;
    assert_string_equal(frame_numbers("7"), "7");
    assert_string_equal(frame_numbers("1-3"), "1 2 3");
    assert_string_equal(frame_numbers("1-10x4"), "1 5 9");
    assert_string_equal(frame_numbers("1, 3,5..7"), "1 3 5 6 7");
    assert_string_equal(frame_numbers("5,1-2,5"), "5 1 2 5");
    assert_string_equal(frame_numbers("1-9x4,20"), "1 5 9 20");
}

static void what_is_no_list_is_refused(void **state)
{
    (void)state;
    const char *const wrong[] = {"",
                                 " ",
                                 "a",
                                 "1-",
                                 "3-1",
                                 "1-5x0",
                                 "1,,2",
                                 "1-5x",
                                 "-1",
                                 "0",
                                 "0-3",
                                 "1.5",
                                 "1-2000000",
                                 "1;2",
                                 "1 2",
                                 "1...3",
                                 "1-3,4-",
                                 "999999999",
                                 "1-600000,1-600000"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        if (strcmp(frame_numbers(wrong[i]), "no") != 0)
            fail_msg("\"%s\" was read as %s", wrong[i], frame_numbers(wrong[i]));
    assert_string_not_equal(frame_numbers("1-1000000"), "no");
}

static void all_frames_are_one_range(void **state)
{
    (void)state;
    frame_list list = frame_list_all(1, 48);
    assert_int_equal(list.frame_count, 48);
    assert_int_equal(frame_list_at(&list, 0), 1);
    assert_int_equal(frame_list_at(&list, 47), 48);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_units),
        cmocka_unit_test(test_orbits),
        cmocka_unit_test(test_targets),
        cmocka_unit_test(test_colors),
        cmocka_unit_test(lists_are_read),
        cmocka_unit_test(what_is_no_list_is_refused),
        cmocka_unit_test(all_frames_are_one_range),
        cmocka_unit_test(test_output_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
