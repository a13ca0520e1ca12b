/* Tests of result.h: any input yields one sentence on one line. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/result.h"

static void fail_returns_its_code_and_writes_a_sentence(void **state)
{
    (void)state;
    facet_error error;
    assert_int_equal(fail(&error, FACET_ERROR_INVALID, "%s: accessor %d", "a.gltf", 3), FACET_ERROR_INVALID);
    assert_int_equal(error.result, FACET_ERROR_INVALID);
    assert_string_equal(error.message, "a.gltf: accessor 3");
    assert_int_equal(fail(NULL, FACET_ERROR_READ, "no error is wanted"), FACET_ERROR_READ);
}

static void fail_memory_names_the_size_if_known(void **state)
{
    (void)state;
    facet_error error;
    assert_int_equal(fail_memory(&error, "a sea", 4096), FACET_ERROR_MEMORY);
    assert_string_equal(error.message, "out of memory: a sea (4096 bytes)");
    assert_int_equal(fail_memory(&error, "JPEG decoder", 0), FACET_ERROR_MEMORY);
    assert_string_equal(error.message, "out of memory: JPEG decoder");
}

static void messages_stay_one_line_and_in_bounds(void **state)
{
    (void)state;
    facet_error error;
    fail(&error, FACET_ERROR_INVALID, "name \"a\nb\x1b[31m\"");
    assert_string_equal(error.message, "name \"a?b?[31m\"");
    char longer[4000];
    memset(longer, 'x', sizeof longer - 1);
    longer[sizeof longer - 1] = 0;
    fail(&error, FACET_ERROR_INVALID, "%s", longer);
    assert_int_equal(strlen(error.message), sizeof error.message - 1);
}

static facet_result add_twice(int *sum, facet_result first)
{
    *sum += 1;
    TRY(first);
    *sum += 1;
    return FACET_OK;
}

static void try_returns_the_first_failure(void **state)
{
    (void)state;
    int sum = 0;
    assert_int_equal(add_twice(&sum, FACET_OK), FACET_OK);
    assert_int_equal(sum, 2);
    assert_int_equal(add_twice(&sum, FACET_ERROR_READ), FACET_ERROR_READ);
    assert_int_equal(sum, 3);
}

static void keep_message(void *user, facet_log_level level, const char *text)
{
    (void)level;
    strcpy(user, text);
}

static void log_sends_formatted_text(void **state)
{
    (void)state;
    char kept[1024] = "";
    facet_log log = {.user = kept, .message = keep_message};
    log_warning(&log, "%d of %d", 2, 3);
    assert_string_equal(kept, "2 of 3");
    log_warning(&(facet_log){0}, "silent");
    log_warning(NULL, "silent");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fail_returns_its_code_and_writes_a_sentence),
        cmocka_unit_test(fail_memory_names_the_size_if_known),
        cmocka_unit_test(messages_stay_one_line_and_in_bounds),
        cmocka_unit_test(try_returns_the_first_failure),
        cmocka_unit_test(log_sends_formatted_text),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
