/* Tests of file.h: files are written completely or not at all; names. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
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
#include "tests/support/support.h"

static temporary_folder folder;

static int make_folder(void **state)
{
    (void)state;
    temporary_folder_create(&folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    temporary_folder_remove(&folder);
    return 0;
}

static char *in_folder(const char *name)
{
    return path_join(NULL, folder.path, name);
}

static void written_bytes_are_read_back(void **state)
{
    (void)state;
    static unsigned char data[3 * 4096 + 5];
    for (size_t i = 0; i < sizeof data; i++)
        data[i] = (unsigned char)(i * 7);
    char *path = in_folder("a.bin");
    const size_t sizes[] = {0, 1, 4095, 4096, 4097, 8192, sizeof data};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        facet_error error;
        assert_int_equal(file_write(path, data, sizes[i], &error), FACET_OK);
        file_bytes file;
        assert_int_equal(file_open(path, 0, NULL, &file, &error), FACET_OK);
        assert_int_equal(file.size, sizes[i]);
        assert_memory_equal(file.data, data, sizes[i]);
        assert_int_equal(file.data[file.size], 0);
        file_close(&file);
    }
    mem_free(path);
}

/* A model is displayed while another program exports it again. */
static void small_files_may_shrink_while_open(void **state)
{
    (void)state;
    char *path = in_folder("cut.bin");
    char bytes[9000];
    memset(bytes, 'x', sizeof bytes);
    assert_int_equal(file_write(path, bytes, sizeof bytes, NULL), FACET_OK);
    file_bytes file;
    facet_error error;
    assert_int_equal(file_open(path, 0, NULL, &file, &error), FACET_OK);
    assert_int_equal(truncate(path, 0), 0);
    assert_int_equal(file.size, sizeof bytes);
    assert_memory_equal(file.data, bytes, sizeof bytes);
    assert_int_equal(file.data[sizeof bytes], 0);
    file_close(&file);
    mem_free(path);
}

static void files_are_recognized_under_other_names(void **state)
{
    (void)state;
    char *path = in_folder("known.bin");
    char *other = in_folder("other.bin");
    char *name = in_folder("name.bin");
    facet_error error;
    assert_int_equal(file_write(path, "abc", 3, &error), FACET_OK);
    assert_int_equal(file_write(other, "abc", 3, &error), FACET_OK);
    assert_int_equal(symlink("known.bin", name), 0);
    file_bytes file;
    assert_int_equal(file_open(path, 0, NULL, &file, &error), FACET_OK);
    assert_true(file_is_at(&file, path));
    assert_true(file_is_at(&file, name));
    assert_false(file_is_at(&file, other));
    assert_false(file_is_at(&file, "/nowhere"));
    assert_int_equal(file_write(path, "abd", 3, &error), FACET_OK); /* another file in its place */
    assert_false(file_is_at(&file, path));
    file_close(&file);
    assert_false(file_is_at(&file, other));
    mem_free(path);
    mem_free(other);
    mem_free(name);
}

static void links_are_replaced_but_those_to_descriptors(void **state)
{
    (void)state;
    char *target = in_folder("target.bin");
    char *link = in_folder("link.bin");
    facet_error error;
    struct stat status;
    assert_int_equal(file_write(target, "kept", 4, &error), FACET_OK);
    assert_int_equal(symlink("target.bin", link), 0);
    assert_int_equal(file_write(link, "new", 3, &error), FACET_OK);
    assert_int_equal(lstat(link, &status), 0);
    assert_true(S_ISREG(status.st_mode));
    assert_int_equal(stat(target, &status), 0);
    assert_int_equal(status.st_size, 4);
    unlink(link);

    /* as /dev/stdout is, with a file behind it: one that has lost its name, even */
    int fd = open(target, O_RDWR);
    char name[64];
    snprintf(name, sizeof name, "/proc/self/fd/%d", fd);
    assert_int_equal(symlink(name, link), 0);
    unlink(target);
    if (access(name, F_OK) == 0) {
        assert_int_equal(file_write(link, "de", 2, &error), FACET_OK);
        assert_int_equal(lseek(fd, 0, SEEK_END), 2);
        assert_int_equal(lstat(link, &status), 0);
        assert_true(S_ISLNK(status.st_mode));
    }
    close(fd);
    unlink(link);
    mem_free(target);
    mem_free(link);
}

static void file_replace_follows_no_link(void **state)
{
    (void)state;
    char *victim = in_folder("victim.bin");
    char *link = in_folder("entry.bin");
    facet_error error;
    assert_int_equal(file_write(victim, "kept", 4, &error), FACET_OK);
    assert_int_equal(symlink("victim.bin", link), 0);
    assert_int_equal(file_replace(link, "new", 3, &error), FACET_OK);
    struct stat status;
    assert_int_equal(lstat(link, &status), 0);
    assert_true(S_ISREG(status.st_mode));
    assert_int_equal(stat(victim, &status), 0);
    assert_int_equal(status.st_size, 4);
    unlink(link);
    assert_int_equal(mkfifo(link, 0600), 0);
    assert_int_equal(file_replace(link, "new", 3, &error), FACET_OK);
    unlink(link);
    unlink(victim);
    mem_free(victim);
    mem_free(link);
}

static void the_longest_name_can_be_written(void **state)
{
    (void)state;
    char name[256];
    memset(name, 'n', sizeof name - 1);
    name[sizeof name - 1] = 0;
    char *path = in_folder(name);
    facet_error error;
    assert_int_equal(file_write(path, "abc", 3, &error), FACET_OK);
    assert_int_equal(unlink(path), 0);
    mem_free(path);
}

static void modes_follow_umask_and_stay(void **state)
{
    (void)state;
    char *path = in_folder("mode.bin");
    mode_t old = umask(027);
    assert_int_equal(file_write(path, "x", 1, NULL), FACET_OK);
    umask(old);
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(status.st_mode & 0777, 0640);
    chmod(path, 0604);
    assert_int_equal(file_write(path, "y", 1, NULL), FACET_OK);
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(status.st_mode & 0777, 0604);
    mem_free(path);
}

static void failures_name_the_file(void **state)
{
    (void)state;
    facet_error error;
    file_bytes file;
    char *missing = in_folder("missing");
    assert_int_equal(file_open(missing, 0, NULL, &file, &error), FACET_ERROR_READ);
    assert_non_null(strstr(error.message, missing));
    assert_int_equal(file_open(folder.path, 0, NULL, &file, &error), FACET_ERROR_READ);
    assert_int_equal(file_write(folder.path, "x", 1, &error), FACET_ERROR_WRITE);
    char *below_missing = in_folder("missing/x.png");
    assert_int_equal(file_write(below_missing, "x", 1, &error), FACET_ERROR_WRITE);
    assert_non_null(strstr(error.message, below_missing));
    char *small = in_folder("small");
    assert_int_equal(file_write(small, "12345", 5, &error), FACET_OK);
    assert_int_equal(file_open(small, 4, NULL, &file, &error), FACET_ERROR_LIMIT);
    assert_int_equal(file_open(small, 5, NULL, &file, &error), FACET_OK);
    file_close(&file);
    mem_free(missing);
    mem_free(below_missing);
    mem_free(small);
}

static void a_full_device_is_an_error(void **state)
{
    (void)state;
    if (access("/dev/full", W_OK) != 0)
        skip();
    facet_error error;
    assert_int_equal(file_write("/dev/full", "x", 1, &error), FACET_ERROR_WRITE);
    assert_non_null(strstr(error.message, "/dev/full"));
}

static void paths_split_into_folder_name_and_extension(void **state)
{
    (void)state;
    assert_string_equal(path_extension("a/b.tar.GZ"), "GZ");
    assert_string_equal(path_extension("a.b/c"), "");
    assert_string_equal(path_base_name("a/b/c.png"), "c.png");
    char *of[] = {path_folder(NULL, "a/b/c"), path_folder(NULL, "c"), path_folder(NULL, "/c")};
    assert_string_equal(of[0], "a/b");
    assert_string_equal(of[1], ".");
    assert_string_equal(of[2], "/");
    for (int i = 0; i < 3; i++)
        mem_free(of[i]);
}

static void links_out_of_a_folder_are_refused(void **state)
{
    (void)state;
    char *inner = in_folder("inner");
    char *file = in_folder("inner/file");
    char *link = in_folder("inner/link");
    char *outside = in_folder("outside");
    char *sibling = in_folder("inner2");
    assert_int_equal(mkdir(inner, 0777), 0);
    assert_int_equal(mkdir(sibling, 0777), 0);
    assert_int_equal(file_write(file, "x", 1, NULL), FACET_OK);
    assert_int_equal(file_write(outside, "x", 1, NULL), FACET_OK);
    assert_int_equal(symlink(outside, link), 0);
    char *deeper = in_folder("inner/deeper");
    char *back = in_folder("inner/deeper/back");
    char *through = in_folder("inner/deeper/back/file");
    assert_int_equal(mkdir(deeper, 0777), 0);
    assert_int_equal(symlink("..", back), 0);
    char *inside[] = {file, inner, through};
    for (int i = 0; i < 3; i++) {
        int fd = path_open_inside(inside[i], inner);
        assert_true(fd >= 0);
        close(fd);
    }
    char *refused[] = {link, sibling, outside};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(path_open_inside(refused[i], inner), -1);
        assert_int_equal(errno, EXDEV);
    }
    int fd = path_open_inside(file, "/");
    assert_true(fd >= 0);
    close(fd);
    char *all[] = {inner, file, link, outside, sibling, deeper, back, through};
    for (int i = 0; i < 8; i++)
        mem_free(all[i]);
}

/* A folder that is a link in turn to one with a file of one byte, 'i', and to one outside of the root with
 * 'o'. */
typedef struct swap {
    char *link, *spare, *targets[2];
    atomic_bool is_done;
} swap;

static void *keep_swapping(void *context)
{
    swap *s = context;
    for (unsigned i = 0; !atomic_load(&s->is_done); i++)
        if (symlink(s->targets[i % 2], s->spare) == 0)
            rename(s->spare, s->link);
    return NULL;
}

static void links_swapped_during_the_check_are_refused(void **state)
{
    (void)state;
    static const char *const folders[] = {"swap", "swap/real", "swapped_out"};
    char *paths[3];
    for (int i = 0; i < 3; i++) {
        paths[i] = in_folder(folders[i]);
        assert_int_equal(mkdir(paths[i], 0777), 0);
    }
    swap s = {
        .link = in_folder("swap/link"), .spare = in_folder("swap/spare"), .targets = {paths[1], paths[2]}};
    char *file = in_folder("swap/link/file");
    for (int i = 0; i < 2; i++) {
        char *target = path_join(NULL, s.targets[i], "file");
        assert_int_equal(file_write(target, i ? "o" : "i", 1, NULL), FACET_OK);
        mem_free(target);
    }
    assert_int_equal(symlink(s.targets[0], s.link), 0);
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, keep_swapping, &s), 0);
    int opened = 0;
    for (int i = 0; i < 20000; i++) {
        int fd = path_open_inside(file, paths[0]);
        if (fd < 0)
            continue;
        char byte = 0;
        assert_int_equal(read(fd, &byte, 1), 1);
        assert_int_equal(byte, 'i');
        opened++;
        close(fd);
    }
    atomic_store(&s.is_done, true);
    pthread_join(thread, NULL);
    assert_true(opened > 0);
    char *all[] = {paths[0], paths[1], paths[2], s.link, s.spare, file};
    for (int i = 0; i < 6; i++)
        mem_free(all[i]);
}

static void staged_files_appear_on_commit(void **state)
{
    (void)state;
    char path[300];
    file_stage stage, other;
    file_bytes file;
    snprintf(path, sizeof path, "%s/staged", folder.path);
    assert_int_equal(file_stage_write(path, "new", 3, &stage, NULL), FACET_OK);
    assert_int_not_equal(access(path, F_OK), 0);
    assert_int_equal(file_stage_write(path, "never", 5, &other, NULL), FACET_OK);
    assert_int_equal(file_stage_commit(&stage, NULL), FACET_OK);
    char temporary[600];
    snprintf(temporary, sizeof temporary, "%s", other.temporary);
    file_stage_discard(&other);
    file_stage_discard(&other);
    assert_int_not_equal(access(temporary, F_OK), 0);
    assert_int_equal(file_open(path, 0, NULL, &file, NULL), FACET_OK);
    assert_int_equal(file.size, 3);
    file_close(&file);
    unlink(path);
    facet_error error = {0};
    assert_int_equal(file_stage_write("/nowhere/at/all", "x", 1, &stage, &error), FACET_ERROR_WRITE);
    assert_non_null(strstr(error.message, "/nowhere/at/all"));
    file_stage_discard(&stage);
}

static void temporaries_have_their_names(void **state)
{
    (void)state;
    assert_true(file_is_temporary("a.png.0123abcd"));
    assert_true(file_is_temporary("x/y.z/a.ffffffff"));
    static const char *const others[] = {"a.png",     "a.0123abc", "a.0123abcde",  "a.0123abcg",
                                         ".0123abcd", "0123abcd",  "a.0123abcd/b", ""};
    for (size_t i = 0; i < COUNT_OF(others); i++)
        assert_false(file_is_temporary(others[i]));
}

/* Thumbnailing services create an empty file, hold it open, and read what was written through their descriptor. */
static void an_empty_file_is_filled_in_place(void **state)
{
    (void)state;
    char *path = in_folder("empty.bin");
    char *name = in_folder("second.bin");
    char text[8] = "";
    facet_error error;
    int held = open(path, O_RDWR | O_CREAT | O_EXCL, 0600);
    assert_true(held >= 0);
    assert_int_equal(file_write(path, "new", 3, &error), FACET_OK);
    assert_int_equal(read(held, text, sizeof text), 3);
    assert_string_equal(text, "new");
    struct stat before, after;
    assert_int_equal(fstat(held, &before), 0);
    assert_int_equal(before.st_mode & 0777, 0600);
    /* it has content now, and is replaced: readers see the old bytes or the new ones */
    assert_int_equal(file_write(path, "newer", 5, &error), FACET_OK);
    assert_int_equal(stat(path, &after), 0);
    assert_true(before.st_ino != after.st_ino);
    assert_int_equal(pread(held, text, sizeof text, 0), 3);
    close(held);
    /* an empty file under two names may be somebody else's: it is replaced */
    assert_int_equal(truncate(path, 0), 0);
    assert_int_equal(link(path, name), 0);
    assert_int_equal(file_write(name, "own", 3, &error), FACET_OK);
    assert_int_equal(stat(path, &after), 0);
    assert_int_equal(after.st_size, 0);
    mem_free(path);
    mem_free(name);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(temporaries_have_their_names),
        cmocka_unit_test(written_bytes_are_read_back),
        cmocka_unit_test(small_files_may_shrink_while_open),
        cmocka_unit_test(files_are_recognized_under_other_names),
        cmocka_unit_test(links_are_replaced_but_those_to_descriptors),
        cmocka_unit_test(file_replace_follows_no_link),
        cmocka_unit_test(the_longest_name_can_be_written),
        cmocka_unit_test(modes_follow_umask_and_stay),
        cmocka_unit_test(failures_name_the_file),
        cmocka_unit_test(a_full_device_is_an_error),
        cmocka_unit_test(staged_files_appear_on_commit),
        cmocka_unit_test(paths_split_into_folder_name_and_extension),
        cmocka_unit_test(links_out_of_a_folder_are_refused),
        cmocka_unit_test(an_empty_file_is_filled_in_place),
        cmocka_unit_test(links_swapped_during_the_check_are_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
