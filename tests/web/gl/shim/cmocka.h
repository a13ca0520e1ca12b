/* cmocka.h - the part of cmocka that tests of the renderer use, for browsers: same names, same meaning. gl_tests.c
 * runs the tests. */
#ifndef WEB_GL_CMOCKA_H
#define WEB_GL_CMOCKA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct CMUnitTest {
    const char *name;
    void (*test)(void **state);
};
#define cmocka_unit_test(function)                                                                           \
    {                                                                                                        \
#function, function                                                                                  \
    }

/* The number of tests that failed. setup and teardown, of the whole group, may be NULL. */
#define cmocka_run_group_tests(tests, setup, teardown)                                                       \
    run_group(tests, sizeof(tests) / sizeof *(tests), setup, teardown)
int run_group(const struct CMUnitTest *tests, size_t count, int (*setup)(void **), int (*teardown)(void **));

void print_message(const char *format, ...) __attribute__((format(printf, 1, 2)));
void print_error(const char *format, ...) __attribute__((format(printf, 1, 2))); /* the message of _fail() */
_Noreturn void _fail(const char *file, int line);
_Noreturn void fail_test_at(const char *file, int line, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
_Noreturn void skip_test(void);

#define skip() skip_test()
#define fail_msg(...) fail_test_at(__FILE__, __LINE__, __VA_ARGS__)

/* ---- assertions: the message has the text of the arguments and, of numbers, their values ---- */

#define assert_true(c) ((c) ? (void)0 : fail_test_at(__FILE__, __LINE__, "%s", #c))
#define assert_false(c) ((c) ? fail_test_at(__FILE__, __LINE__, "not %s", #c) : (void)0)
#define assert_null(p) assert_true((const void *)(p) == NULL)
#define assert_non_null(p) assert_true((const void *)(p) != NULL)
#define assert_ptr_equal(a, b) assert_true((const void *)(a) == (const void *)(b))
#define assert_ptr_not_equal(a, b) assert_true((const void *)(a) != (const void *)(b))
#define assert_int_equal(a, b)                                                                               \
    check_integer((uintmax_t)(a), (uintmax_t)(b), (uintmax_t)(b), true, #a " == " #b, __FILE__, __LINE__)
#define assert_int_not_equal(a, b)                                                                           \
    check_integer((uintmax_t)(a), (uintmax_t)(b), (uintmax_t)(b), false, #a " != " #b, __FILE__, __LINE__)
#define assert_in_range(a, least, most)                                                                      \
    check_integer((uintmax_t)(a), (uintmax_t)(least), (uintmax_t)(most), true,                               \
                  #a " in " #least " to " #most, __FILE__, __LINE__)
#define assert_string_equal(a, b) check_string(a, b, __FILE__, __LINE__)
#define assert_memory_equal(a, b, size) check_memory(a, b, size, true, #a ", " #b, __FILE__, __LINE__)
#define assert_memory_not_equal(a, b, size) check_memory(a, b, size, false, #a ", " #b, __FILE__, __LINE__)

/* Fails unless the value is in the range, or, where is_wanted is false, if it is. */
void check_integer(uintmax_t value, uintmax_t least, uintmax_t most, bool is_wanted, const char *what,
                   const char *file, int line);
void check_string(const char *a, const char *b, const char *file, int line);
void check_memory(const void *a, const void *b, size_t size, bool is_wanted, const char *what,
                  const char *file, int line);

#endif
