/* library_test.c - a library that is missing, broken, or does not fit into memory: each has its own reason. */
#define _GNU_SOURCE
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/library.h"

static const library_desc DESC = {
    .subject = "test", .advice = " is not installed", .missing = FACET_ERROR_UNSUPPORTED};

static void a_missing_library_is_reported(void **state)
{
    (void)state;
    void *handle;
    facet_error error;
    assert_int_equal(library_open("libfacet-is-missing.so.2", &DESC, &handle, &error),
                     FACET_ERROR_UNSUPPORTED);
    assert_null(handle);
    assert_string_equal(error.message, "test: libfacet-is-missing.so.2 is not installed");
}

static void versions_are_found(void **state)
{
    (void)state;
    char version[16] = "?";
    library_find_version("libfacet-is-missing.so.2", "version", version, sizeof version);
    assert_string_equal(version, "");
    library_find_version("libc.so.6", "facet_is_missing", version, sizeof version);
    assert_string_equal(version, "unknown");
    library_find_version("libc.so.6", "gnu_get_libc_version", version, sizeof version);
    assert_true(version[0] >= '0' && version[0] <= '9');
}

static void a_broken_library_is_not_missing(void **state)
{
    (void)state;
    char path[] = "/tmp/facet-library-XXXXXX";
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, "no library", 10), 10);
    close(fd);
    void *handle;
    facet_error error;
    facet_result result = library_open(path, &DESC, &handle, &error);
    unlink(path);
    assert_int_equal(result, FACET_ERROR_SYSTEM);
    assert_non_null(strstr(error.message, "cannot be opened"));
}

/* In a process of its own, whose address space has no room for it. */
static void a_library_that_cannot_be_mapped_is_out_of_memory(void **state)
{
    (void)state;
#ifdef FACET_QUICK_TESTS
    skip(); /* builds with sanitizers, whose shadow memory is larger than any such limit */
#endif
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        void *handle;
        facet_error error;
        struct rlimit none = {1 << 20, 1 << 20};
        setrlimit(RLIMIT_AS, &none);
        _exit(library_open("libz.so.1", &DESC, &handle, &error) == FACET_ERROR_MEMORY ? 0 : 1);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_missing_library_is_reported),
        cmocka_unit_test(a_broken_library_is_not_missing),
        cmocka_unit_test(versions_are_found),
        cmocka_unit_test(a_library_that_cannot_be_mapped_is_out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
