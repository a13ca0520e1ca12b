/* Tests of file_alike.h: names that are alike, and files that are found by them. */
#define _GNU_SOURCE
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

#include "base/file.h"
#include "base/memory.h"
#include "io/file_alike.h"
#include "tests/support/support.h"

static void names_differ_in_case_and_form_only(void **state)
{
    (void)state;
    static const char *const alike[][2] = {
        {"WOOD.PNG", "wood.png"},
        {"", ""},
        {"\xc3\x89t\xc3\xa9.png", "e\xcc\x81T\x45\xcc\x81.PNG"},  /* Été */
        {"caf\xe9.png", "caf\xc3\xa9.png"},                       /* Latin-1 */
        {"\xc5\x81\xc3\x98\xc3\x86", "\xc5\x82\xc3\xb8\xc3\xa6"}, /* letters without parts */
        {"vi\xe1\xbb\x87t", "VIe\xcc\xa3\xcc\x82T"},              /* Việt: marks in Unicode's order .. */
        {"vi\xe1\xbb\x87t", "vi\xc3\xaa\xcc\xa3t"},               /* .. and half composed */
        {"\xc7\x9a", "u\xcc\x88\xcc\x8c"},                        /* pinyin */
        {"\xce\x86\xce\xbb\xcf\x86\xce\xb1", "\xce\xb1\xcc\x81\xce\x9b\xce\xa6\xce\x91"}, /* Άλφα */
        {"\xd0\x99\xd1\x91", "\xd0\xb8\xcc\x86\xd0\xb5\xcc\x88"},                         /* Йё */
        {"\xe3\x81\x8c\xe3\x83\x91\xe3\x83\xb4",
         "\xe3\x81\x8b\xe3\x82\x99\xe3\x83\x8f\xe3\x82\x9a\xe3\x82\xa6\xe3\x82\x99"},
        {"\xed\x95\x9c\xea\xb8\x80",
         "\xe1\x84\x92\xe1\x85\xa1\xe1\x86\xab\xe1\x84\x80\xe1\x85\xb3\xe1\x86\xaf"}, /* 한글 */
    };
    static const char *const different[][2] = {
        {"a", "b"},
        {"a", "a "},
        {"e.png", "\xc3\xa9.png"},
        {"\xc3\xa8", "\xc3\xa9"},
        {"a.png", "a.pn"},
        {"\xe3\x81\x8b", "\xe3\x81\x8c"}, /* ka, ga */
        {"\xe3\x81\xa4", "\xe3\x81\xa3"}, /* tsu, small tsu */
    };
    for (size_t i = 0; i < sizeof alike / sizeof *alike; i++)
        if (!file_names_are_alike(alike[i][0], alike[i][1]) ||
            !file_names_are_alike(alike[i][1], alike[i][0]))
            fail_msg("%s and %s are alike", alike[i][0], alike[i][1]);
    for (size_t i = 0; i < sizeof different / sizeof *different; i++)
        if (file_names_are_alike(different[i][0], different[i][1]))
            fail_msg("%s and %s are different", different[i][0], different[i][1]);
    char longest[300];
    memset(longest, 'a', sizeof longest);
    longest[299] = 0;
    assert_false(file_names_are_alike(longest, longest)); /* no file has such a name */
}

static temporary_folder folder;

static int make_files(void **state)
{
    (void)state;
    static const char *const names[] = {"wood.png",       "Metal.PNG", "metal.png", "t\xc3\xa9te.png",
                                        "Textures/A.png", "x/b.png",   "X/c.png"};
    static const char *const folders[] = {"Textures", "x", "X", "Wood.PNG"};
    char path[256];
    temporary_folder_create(&folder);
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        snprintf(path, sizeof path, "%s/%s", folder.path, folders[i]);
        if (mkdir(path, 0700) != 0)
            return -1;
    }
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        snprintf(path, sizeof path, "%s/%s", folder.path, names[i]);
        if (file_write(path, "x", 1, NULL) != FACET_OK)
            return -1;
    }
    return 0;
}

static int remove_files(void **state)
{
    (void)state;
    temporary_folder_remove(&folder);
    return 0;
}

static void assert_found(const char *path, const char *wanted)
{
    size_t budget = 1000;
    bool has_failed;
    char *found = file_find_alike(NULL, folder.path, path, &budget, &has_failed);
    assert_false(has_failed);
    if ((found == NULL) != (wanted == NULL) || (found && strcmp(found, wanted) != 0))
        fail_msg("%s is %s", path, found ? found : "not found");
    mem_free(found);
}

static void unique_matches_are_found(void **state)
{
    (void)state;
    assert_found("wood.png", "wood.png");
    assert_found("WOOD.png", "wood.png"); /* Wood.PNG is a folder */
    assert_found("METAL.png", NULL);      /* two */
    assert_found("metal.png", "metal.png");
    assert_found("te\xcc\x81te.PNG", "t\xc3\xa9te.png");
    assert_found("textures/a.PNG", "Textures/A.png");
    assert_found("textures//../textures/a.PNG", "Textures/../Textures/A.png");
    assert_found("x/B.png", "x/b.png"); /* the folder is there */
    assert_found("x/C.png", NULL);      /* and its double is not looked into */
    assert_found("wood.png/a", NULL);
    assert_found("textures", NULL);
    assert_found("textures/", NULL);
    assert_found("/wood.png", NULL);
    assert_found("", NULL);
    assert_found("nothing.png", NULL);
}

static void the_budget_ends_a_search(void **state)
{
    (void)state;
    bool has_failed;
    size_t budget = 0;
    assert_null(file_find_alike(NULL, folder.path, "WOOD.png", &budget, &has_failed));
    assert_false(has_failed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_differ_in_case_and_form_only),
        cmocka_unit_test(unique_matches_are_found),
        cmocka_unit_test(the_budget_ends_a_search),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
