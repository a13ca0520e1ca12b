/* Tests of root.h: no path leads out, however it is written. */
#define _DEFAULT_SOURCE
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "cli/serve/root.h"

static root test_root;
static char outer[ROOT_PATH_SIZE];

static void touch(const char *path)
{
    int fd = open(path, O_WRONLY | O_CREAT, 0600);
    assert_true(fd >= 0);
    close(fd);
}

/* OUTER/secret, and OUTER/in with files, folders and links, as the root. */
static int make_folders(void **state)
{
    (void)state;
    char folder[] = "/tmp/facet-root-XXXXXX";
    if (!mkdtemp(folder) || chdir(folder) != 0 || !getcwd(outer, sizeof outer))
        return 1;
    mkdir("in", 0700);
    mkdir("in/sub", 0700);
    mkdir("inside", 0700); /* begins like the root */
    touch("secret");
    touch("inside/secret");
    touch("in/a.glb");
    touch("in/-x.glb");
    touch("in/sub/b.glb");
    return symlink("../secret", "in/link") || symlink("..", "in/up") || symlink("sub/b.glb", "in/good") ||
           root_enter("in", &test_root, NULL) != FACET_OK;
}

static void check(const char *path, answer_kind kind, const char *below)
{
    char found[ROOT_PATH_SIZE] = "";
    answer refusal = {0};
    bool is_found = root_find(&test_root, path, found, &refusal);
    assert_int_equal(refusal.kind, kind);
    assert_int_equal(is_found, kind == ANSWER_DONE);
    if (below)
        assert_string_equal(found, below);
    else
        assert_true(refusal.message[0]);
}

static void inputs_stay_inside(void **state)
{
    (void)state;
    char path[2 * ROOT_PATH_SIZE];
    check("a.glb", ANSWER_DONE, "a.glb");
    check("./sub/../a.glb", ANSWER_DONE, "a.glb");
    check("sub//b.glb", ANSWER_DONE, "sub/b.glb");
    check("good", ANSWER_DONE, "sub/b.glb");
    check("-x.glb", ANSWER_DONE, "./-x.glb");
    check(".", ANSWER_DONE, ".");
    snprintf(path, sizeof path, "%s/in/a.glb", outer);
    check(path, ANSWER_DONE, "a.glb");
    check("missing.glb", ANSWER_MISSING, NULL);
    check("", ANSWER_USAGE, NULL);
    check("../secret", ANSWER_FORBIDDEN, NULL);
    check("../nothing", ANSWER_FORBIDDEN, NULL);
    check("sub/../../secret", ANSWER_FORBIDDEN, NULL);
    check("link", ANSWER_FORBIDDEN, NULL);
    check("up/secret", ANSWER_FORBIDDEN, NULL);
    check("up/nothing", ANSWER_FORBIDDEN, NULL);
    check("sub/nothing/a.glb", ANSWER_MISSING, NULL);
    check("/etc/passwd", ANSWER_FORBIDDEN, NULL);
    check("/nothing", ANSWER_FORBIDDEN, NULL);
    snprintf(path, sizeof path, "%s/inside/secret", outer);
    check(path, ANSWER_FORBIDDEN, NULL);
    snprintf(path, sizeof path, "%s/in/../secret", outer);
    check(path, ANSWER_FORBIDDEN, NULL);
    memset(path, 'a', 5000);
    path[5000] = 0;
    check(path, ANSWER_USAGE, NULL);
}

static void check_place(const char *path, answer_kind kind, const char *below)
{
    char found[ROOT_PATH_SIZE] = "";
    answer refusal = {0};
    assert_int_equal(root_place(&test_root, path, found, &refusal), kind == ANSWER_DONE);
    assert_int_equal(refusal.kind, kind);
    if (below)
        assert_string_equal(found, below);
}

static void outputs_stay_inside(void **state)
{
    (void)state;
    char path[2 * ROOT_PATH_SIZE];
    check_place("new.png", ANSWER_DONE, "new.png");
    check_place("a.glb", ANSWER_DONE, "a.glb");
    check_place("x/y/z.png", ANSWER_DONE, "x/y/z.png");
    check_place("sub/new/z.png", ANSWER_DONE, "sub/new/z.png");
    check_place("folder/", ANSWER_DONE, "folder/");
    check_place("-o.png", ANSWER_DONE, "./-o.png");
    snprintf(path, sizeof path, "%s/in/new/a.png", outer);
    check_place(path, ANSWER_DONE, "new/a.png");
    check_place("../new.png", ANSWER_FORBIDDEN, NULL);
    check_place("x/../y.png", ANSWER_FORBIDDEN, NULL);
    check_place("up/new.png", ANSWER_FORBIDDEN, NULL);
    check_place("up/new/new.png", ANSWER_FORBIDDEN, NULL);
    check_place("/tmp/new.png", ANSWER_FORBIDDEN, NULL);
    check_place("", ANSWER_USAGE, NULL);
}

static int remove_folders(void **state)
{
    (void)state;
    char command[ROOT_PATH_SIZE + 16];
    snprintf(command, sizeof command, "rm -r %s", outer);
    return chdir("/") || system(command);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inputs_stay_inside),
        cmocka_unit_test(outputs_stay_inside),
    };
    return cmocka_run_group_tests(tests, make_folders, remove_folders);
}
