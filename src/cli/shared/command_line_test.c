/* command_line_test.c - options in every notation, suggestions, and the table itself. */
#define _POSIX_C_SOURCE 200809L
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "cli/shared/command_line.h"
#include "cli/shared/suggest.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static command_line line;
static facet_error error;

/* Parses the words of a NULL-terminated list for facet render. */
static facet_result parse(const char *const *words)
{
    static char *argv[32];
    int argc = 0;
    for (; words[argc]; argc++)
        argv[argc] = (char *)(uintptr_t)words[argc];
    command_line_destroy(&line);
    error = (facet_error){0};
    return command_line_parse(verb_find("render"), argc, argv, &line, &error);
}
#define PARSE(...) parse((const char *const[]){__VA_ARGS__, NULL})

static void test_notations(void **state)
{
    (void)state;
    static const char *const same[][3] = {{"--output=a.png", NULL},
                                          {"--output", "a.png", NULL},
                                          {"-oa.png", NULL},
                                          {"-o", "a.png", NULL},
                                          {"-o=a.png", NULL}};
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        assert_int_equal(parse(same[i]), FACET_OK);
        assert_string_equal(option_text(&line, OPT_OUTPUT, ""), "a.png");
        assert_int_equal(line.argument_count, 0);
    }
}

static void test_order_and_end(void **state)
{
    (void)state;
    assert_int_equal(PARSE("a.glb", "-s", "64", "b.glb", "--json", "-", "--", "-c.glb", "--size"), FACET_OK);
    static const char *const expected[] = {"a.glb", "b.glb", "-", "-c.glb", "--size"};
    assert_int_equal(line.argument_count, 5);
    for (size_t i = 0; i < 5; i++)
        assert_string_equal(line.arguments[i], expected[i]);
    assert_string_equal(option_text(&line, OPT_SIZE, ""), "64");
    assert_true(is_given(&line, OPT_JSON));
}

static void test_last_wins_and_counts(void **state)
{
    (void)state;
    assert_int_equal(PARSE("-n", "2", "-vv", "-n16", "-v"), FACET_OK);
    assert_true(option_number(&line, OPT_SAMPLES, 0.0) == 16.0);
    assert_int_equal(line.values[OPT_VERBOSE].count, 3);
    assert_true(option_number(&line, OPT_FOV, 7.0) == 7.0);
}

static void test_negative_values(void **state)
{
    (void)state;
    assert_int_equal(PARSE("--exposure", "-1", "--orbit", "-30,75,105%", "--target", "-.5,0,0", "-o", "-"),
                     FACET_OK);
    assert_string_equal(option_text(&line, OPT_EXPOSURE, ""), "-1");
    assert_string_equal(option_text(&line, OPT_ORBIT, ""), "-30,75,105%");
    assert_string_equal(option_text(&line, OPT_TARGET, ""), "-.5,0,0");
    assert_string_equal(option_text(&line, OPT_OUTPUT, ""), "-");
}

/* Attributes of <model-viewer> as they stand in a page. */
static void test_attributes(void **state)
{
    (void)state;
    assert_int_equal(PARSE("--camera-orbit", "45deg 55deg 4m", "--camera-target=0m 1m auto",
                           "--field-of-view", "30deg", "--environment-image", "x.hdr", "--variant-name",
                           "Beach", "--animation-name=Walk"),
                     FACET_OK);
    assert_string_equal(option_text(&line, OPT_ORBIT, ""), "45deg 55deg 4m");
    assert_string_equal(option_text(&line, OPT_TARGET, ""), "0m 1m auto");
    assert_string_equal(option_text(&line, OPT_FOV, ""), "30deg");
    assert_string_equal(option_text(&line, OPT_ENV, ""), "x.hdr");
    assert_string_equal(option_text(&line, OPT_VARIANT, ""), "Beach");
    assert_string_equal(option_text(&line, OPT_ANIMATION, ""), "Walk");
    assert_true(line.has_attributes);
    assert_int_equal(PARSE("--orbit", "45deg 55deg 4m"), FACET_OK);
    assert_false(line.has_attributes);
}

static void test_choices(void **state)
{
    (void)state;
    assert_int_equal(PARSE("--tone-mapping", "agx", "--aov", "depth,normal"), FACET_OK);
    assert_int_equal(option_choice(&line, OPT_TONE_MAPPING, -1), FACET_TONEMAP_AGX);
    assert_int_equal(option_choice(&line, OPT_LIGHTS, -1), -1);
}

/* The sentence must contain every given part. */
static void expect_sentence(facet_result result, const char *part)
{
    assert_int_equal(result, FACET_ERROR_ARGUMENT);
    if (!strstr(error.message, part))
        fail_msg("\"%s\" lacks \"%s\"", error.message, part);
}

static void test_mistakes(void **state)
{
    (void)state;
    expect_sentence(PARSE("--resolution=640,480"), "did you mean --size 640x480?");
    expect_sentence(PARSE("--hdri-file", "x.hdr"), "did you mean --env FILE?");
    expect_sentence(PARSE("--skybox-image=x"), "--background env");
    expect_sentence(PARSE("--shadow-intensity", "1"), "--renderer path --ground shadow?");
    expect_sentence(PARSE("--tone-mapping", "commerce"), "did you mean neutral?");
    expect_sentence(PARSE("--width", "3"), "--size");
    expect_sentence(PARSE("--no-background"), "--background transparent");
    expect_sentence(PARSE("--out", "x"), "--output");
    expect_sentence(PARSE("--ouptut", "x"), "unknown option --ouptut; did you mean --output?");
    expect_sentence(PARSE("--expos", "1"), "did you mean --exposure?");
    expect_sentence(PARSE("--wind", "5"), "--wind is an option of facet ocean, not of facet render");
    expect_sentence(PARSE("--zzzzzz"), "facet help render");
    expect_sentence(PARSE("--material-override"), "does not have it yet");
    expect_sentence(PARSE("-w640"), "--size 640x480");
    expect_sentence(PARSE("-Z"), "unknown option -Z");
    expect_sentence(PARSE("-size", "64"), "did you mean --size?");
    expect_sentence(PARSE("-o"), "-o: the FILE is missing");
    expect_sentence(PARSE("--output", "--size"), "--output=--size");
    expect_sentence(PARSE("--output="), "is empty");
    expect_sentence(PARSE("--json=1"), "takes no value");
    expect_sentence(PARSE("--lights=sceen"), "did you mean scene?");
    expect_sentence(PARSE("-n", "0"), "whole number from 1");
    expect_sentence(PARSE("-n", "1.5"), "whole number");
    expect_sentence(PARSE("--background-blur", "nan"), "number from 0 to 1");
    expect_sentence(PARSE("--background-blur", "2"), "number from 0 to 1");
    expect_sentence(PARSE("--aov=depth,,normal"), "--aov");
    expect_sentence(PARSE("--aov=depth,"), "--aov");
}

static void test_edit_distance(void **state)
{
    (void)state;
    assert_int_equal(edit_distance("", ""), 0);
    assert_int_equal(edit_distance("size", "size"), 0);
    assert_int_equal(edit_distance("siez", "size"), 1);
    assert_int_equal(edit_distance("kitten", "sitting"), 3);
    assert_int_equal(edit_distance("Tone_Mapping", "tone-mapping"), 0);
    assert_int_equal(edit_distance("abc", ""), 3);
    char long_word[300];
    memset(long_word, 'x', sizeof long_word - 1);
    long_word[sizeof long_word - 1] = 0;
    assert_int_equal(edit_distance(long_word, ""), 63);
    assert_int_equal(edit_distance(long_word, long_word), 0);
}

/* Names and letters are unique within a verb, choices have lists, every text is there. */
static void test_table(void **state)
{
    (void)state;
    for (const verb *const *v = verbs; *v; v++) {
        bool seen_letters[128] = {false};
        assert_non_null(option_find_id(*v, OPT_HELP));
        const option *o;
        for (size_t i = 0; (o = option_at(*v, i)); i++) {
            assert_ptr_equal(option_find(*v, o->name, strlen(o->name)), o);
            assert_ptr_equal(option_find_id(*v, o->id), o);
            assert_int_equal(option_takes_value(o), o->argument != NULL);
            assert_true(*o->help && o->help[strlen(o->help) - 1] != '.');
            if (o->kind == OPTION_CHOICE || o->kind == OPTION_CHOICES)
                assert_non_null(o->choices);
            if (o->kind == OPTION_NUMBER || o->kind == OPTION_INTEGER)
                assert_true(o->maximum > o->minimum);
            if (o->letter) {
                assert_false(seen_letters[(int)o->letter]);
                seen_letters[(int)o->letter] = true;
            }
            assert_false(option_is_planned(o->name));
        }
    }
}

/* ---- presets and files ---- */

/* Writes text to a file and reads it with the words of the command line after "--config FILE". */
static facet_result configure(const char *text, const char *size, config *storage)
{
    char path[] = "/tmp/facet_config_XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, text, strlen(text)), (ssize_t)strlen(text));
    close(file);
    assert_int_equal(size ? PARSE("--config", path, "--size", size) : PARSE("--config", path), FACET_OK);
    facet_result result = config_apply(&line, storage, &error);
    unlink(path);
    return result;
}

static void test_config(void **state)
{
    (void)state;
    config storage = {0};
    assert_int_equal(
        configure("{\"size\": \"640x480\", \"orbit\": [30, 75.5, \"105%\"], \"json\": true, \"strict\": "
                  "false, \"verbose\": 2, \"samples\": 8, \"background\": \"#102030\"}",
                  "32", &storage),
        FACET_OK);
    assert_string_equal(option_text(&line, OPT_SIZE, ""), "32"); /* the command line wins */
    assert_string_equal(option_text(&line, OPT_ORBIT, ""), "30,75.5,105%");
    assert_string_equal(option_text(&line, OPT_BACKGROUND, ""), "#102030");
    assert_true(option_number(&line, OPT_SAMPLES, 0.0) == 8.0);
    assert_true(is_given(&line, OPT_JSON));
    assert_false(is_given(&line, OPT_STRICT));
    assert_int_equal(line.values[OPT_VERBOSE].count, 2);
    config_destroy(&storage);
}

static void test_bad_config(void **state)
{
    (void)state;
    static const struct {
        const char *text, *part;
        facet_result result;
    } cases[] = {
        {"{\"siez\": 3}", "did you mean --size", FACET_ERROR_ARGUMENT},
        {"{\"samples\": 0}", "whole number", FACET_ERROR_ARGUMENT},
        {"{\"samples\": {}}", "must be text", FACET_ERROR_ARGUMENT},
        {"{\"json\": \"yes\"}", "true or false", FACET_ERROR_ARGUMENT},
        {"{\"config\": \"x\"}", "cannot be given", FACET_ERROR_ARGUMENT},
        {"{\"output\": [[1]]}", "must be text", FACET_ERROR_ARGUMENT},
        {"[]", "one JSON object", FACET_ERROR_ARGUMENT},
        {"{\"size\": 1,\n \"size\": 2}", "line 2", FACET_ERROR_ARGUMENT},
        {"{", "line 1", FACET_ERROR_ARGUMENT},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        config storage = {0};
        assert_int_equal(configure(cases[i].text, NULL, &storage), cases[i].result);
        if (!strstr(error.message, cases[i].part))
            fail_msg("\"%s\" lacks \"%s\"", error.message, cases[i].part);
        config_destroy(&storage);
    }
}

static void test_preset(void **state)
{
    (void)state;
    assert_int_equal(PARSE("--preset", "thumbnail", "--size", "128"), FACET_OK);
    assert_int_equal(preset_apply(&line, &error), FACET_OK);
    assert_string_equal(option_text(&line, OPT_SIZE, ""), "128");
    assert_string_equal(option_text(&line, OPT_BACKGROUND, ""), "transparent");
    assert_true(is_given(&line, OPT_QUIET));
    assert_string_equal(option_text(&line, OPT_TIME_LIMIT, ""),
                        "15s"); /* no model here, which counts as one */
    assert_int_equal(option_choice(&line, OPT_GROUND, 0), 1);
    assert_true(strncmp(option_text(&line, OPT_ORBIT, ""), "30,", 3) == 0);
}

static void test_preset_of_products(void **state)
{
    (void)state;
    assert_int_equal(PARSE("--preset", "product", "--ground", "none"), FACET_OK);
    assert_int_equal(preset_apply(&line, &error), FACET_OK);
    assert_string_equal(option_text(&line, OPT_SIZE, ""), "1600");
    assert_int_equal(option_choice(&line, OPT_GROUND, 1), 0);
    assert_false(is_given(&line, OPT_QUIET));
}

/* A preset's view and ground give way to options that exclude them. */
static void test_preset_beside_exclusive_options(void **state)
{
    (void)state;
    assert_int_equal(PARSE("--preset", "thumbnail", "--eye", "0,0,1", "--up", "z"), FACET_OK);
    assert_int_equal(preset_apply(&line, &error), FACET_OK);
    assert_false(is_given(&line, OPT_ORBIT));
    assert_false(is_given(&line, OPT_GROUND));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_notations),
        cmocka_unit_test(test_order_and_end),
        cmocka_unit_test(test_last_wins_and_counts),
        cmocka_unit_test(test_negative_values),
        cmocka_unit_test(test_choices),
        cmocka_unit_test(test_attributes),
        cmocka_unit_test(test_mistakes),
        cmocka_unit_test(test_edit_distance),
        cmocka_unit_test(test_table),
        cmocka_unit_test(test_config),
        cmocka_unit_test(test_bad_config),
        cmocka_unit_test(test_preset),
        cmocka_unit_test(test_preset_of_products),
        cmocka_unit_test(test_preset_beside_exclusive_options),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    command_line_destroy(&line);
    return failed;
}
