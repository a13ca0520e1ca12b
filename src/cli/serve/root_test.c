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

typedef bool root_function(const root *r, const char *path, char below[ROOT_PATH_SIZE], answer *refusal);

/* below NULL: a refusal, which has a message. */
static void check(root_function *find, const char *path, answer_kind kind, const char *below)
{
    char found[ROOT_PATH_SIZE] = "";
    answer refusal = {0};
    assert_int_equal(find(&test_root, path, found, &refusal), kind == ANSWER_DONE);
    assert_int_equal(refusal.kind, kind);
    if (below)
        assert_string_equal(found, below);
    else
        assert_true(refusal.message[0]);
}

static void inputs_stay_inside(void **state)
{
    (void)state;
    char path[2 * ROOT_PATH_SIZE];
    check(root_find, "a.glb", ANSWER_DONE, "a.glb");
    check(root_find, "./sub/../a.glb", ANSWER_DONE, "a.glb");
    check(root_find, "sub//b.glb", ANSWER_DONE, "sub/b.glb");
    check(root_find, "good", ANSWER_DONE, "sub/b.glb");
    check(root_find, "-x.glb", ANSWER_DONE, "./-x.glb");
    check(root_find, ".", ANSWER_DONE, ".");
    snprintf(path, sizeof path, "%s/in/a.glb", outer);
    check(root_find, path, ANSWER_DONE, "a.glb");
    check(root_find, "missing.glb", ANSWER_MISSING, NULL);
    check(root_find, "", ANSWER_USAGE, NULL);
    check(root_find, "../secret", ANSWER_FORBIDDEN, NULL);
    check(root_find, "../nothing", ANSWER_FORBIDDEN, NULL);
    check(root_find, "sub/../../secret", ANSWER_FORBIDDEN, NULL);
    check(root_find, "link", ANSWER_FORBIDDEN, NULL);
    check(root_find, "up/secret", ANSWER_FORBIDDEN, NULL);
    check(root_find, "up/nothing", ANSWER_FORBIDDEN, NULL);
    check(root_find, "sub/nothing/a.glb", ANSWER_MISSING, NULL);
    check(root_find, "/etc/passwd", ANSWER_FORBIDDEN, NULL);
    check(root_find, "/nothing", ANSWER_FORBIDDEN, NULL);
    snprintf(path, sizeof path, "%s/inside/secret", outer);
    check(root_find, path, ANSWER_FORBIDDEN, NULL);
    snprintf(path, sizeof path, "%s/in/../secret", outer);
    check(root_find, path, ANSWER_FORBIDDEN, NULL);
    memset(path, 'a', 5000);
    path[5000] = 0;
    check(root_find, path, ANSWER_USAGE, NULL);
}

static void outputs_stay_inside(void **state)
{
    (void)state;
    char path[2 * ROOT_PATH_SIZE];
    check(root_place, "new.png", ANSWER_DONE, "new.png");
    check(root_place, "a.glb", ANSWER_DONE, "a.glb");
    check(root_place, "x/y/z.png", ANSWER_DONE, "x/y/z.png");
    check(root_place, "sub/new/z.png", ANSWER_DONE, "sub/new/z.png");
    check(root_place, "folder/", ANSWER_DONE, "folder/");
    check(root_place, "-o.png", ANSWER_DONE, "./-o.png");
    snprintf(path, sizeof path, "%s/in/new/a.png", outer);
    check(root_place, path, ANSWER_DONE, "new/a.png");
    check(root_place, "../new.png", ANSWER_FORBIDDEN, NULL);
    check(root_place, "x/../y.png", ANSWER_FORBIDDEN, NULL);
    check(root_place, "up/new.png", ANSWER_FORBIDDEN, NULL);
    check(root_place, "up/new/new.png", ANSWER_FORBIDDEN, NULL);
    check(root_place, "/tmp/new.png", ANSWER_FORBIDDEN, NULL);
    check(root_place, "", ANSWER_USAGE, NULL);
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
