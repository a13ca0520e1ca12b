/* job_pool_test.c - jobs in child processes: results, outputs through a pipe, limits, crashes, cancelling. */
#define _GNU_SOURCE
#include "cli/jobs/job_options.h"
#include "cli/jobs/job_pool.h"
#include "cli/jobs/job_warm.h"
#include "cli/shared/failure.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "tests/support/support.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static const char triangle[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"meshes\":[{"
    "\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":"
    "5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}],\"bufferViews\":[{\"buffer\":0,"
    "\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/"
    "octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";

static job_result run(const job_request *request)
{
    facet_error error;
    job_result result = {.user = NULL};
    job_pool *pool = job_pool_create(1);
    assert_non_null(pool);
    if (job_pool_start(pool, request, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_int_equal(job_pool_running(pool), 1);
    assert_false(job_pool_has_slot(pool));
    assert_true(job_pool_wait(pool, NULL, 0, 60.0, &result));
    assert_int_equal(job_pool_running(pool), 0);
    job_pool_destroy(pool);
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1); /* no zombie */
    return result;
}

/* Data: a model on standard input, an image through the pipe, the report. */
static void images_come_through_a_pipe(void **state)
{
    (void)state;
    const char *const words[] = {"render", "-", "-o", JOB_OUTPUT, "--format", "png", "--size", "32", NULL};
    int user;
    job_result r = run(&(job_request){.words = words,
                                      .input = triangle,
                                      .input_size = sizeof triangle - 1,
                                      .max_output_bytes = 1 << 20,
                                      .user = &user});
    assert_int_equal(r.end, JOB_EXITED);
    assert_int_equal(r.exit_code, EXIT_DONE);
    assert_null(r.message);
    assert_ptr_equal(r.user, &user);
    assert_true(r.output_size > 60 && memcmp(r.output, "\x89PNG\r\n", 6) == 0);
    assert_int_equal(json_array_size(json_object_get(r.report, "pictures")), 1);
    assert_true(r.seconds > 0.0 && r.seconds < 60.0 && r.peak_memory_bytes > 1 << 20);
    job_result_destroy(&r);
}

static void failures_have_their_sentence(void **state)
{
    (void)state;
    const char *const words[] = {"inspect", "missing.glb", NULL};
    job_result r = run(&(job_request){.words = words});
    assert_int_equal(r.exit_code, EXIT_READ);
    assert_string_equal(r.message, "missing.glb: cannot be opened: No such file or directory");
    job_result_destroy(&r);
    const char *const wrong[] = {"render", "--size", "0", NULL};
    r = run(&(job_request){.words = wrong});
    assert_int_equal(r.exit_code, EXIT_USAGE);
    assert_non_null(strstr(r.message, "--size"));
    job_result_destroy(&r);
}

static void long_outputs_end_the_job(void **state)
{
    (void)state;
    const char *const words[] = {"render", "-o", JOB_OUTPUT, "--format", "pfm", "--size", "256", NULL};
    job_result r = run(&(job_request){.words = words, .max_output_bytes = 1000});
    assert_int_equal(r.end, JOB_OVERFLOWED);
    assert_int_equal(r.exit_code, EXIT_LIMIT);
    assert_non_null(strstr(r.message, "its output is larger than 1000 bytes"));
    job_result_destroy(&r);
}

/* A pipe without a writer: reading it hangs. */
static void hanging_jobs_are_ended(void **state)
{
    const char *fifo = *state;
    const char *const words[] = {"render", fifo, "-o", "/dev/null", "--format", "png", NULL};
    job_result r = run(&(job_request){.words = words, .name = "hang.glb", .time_limit_s = 0.2});
    assert_int_equal(r.end, JOB_TIMED_OUT);
    assert_int_equal(r.exit_code, EXIT_LIMIT);
    assert_string_equal(r.message, "hang.glb: it was ended after its time limit of 0.2 s");
    assert_true(r.seconds < 3.0);
    job_result_destroy(&r);
}

/* The process of the only child, by ps of Linux. */
static pid_t find_child(void)
{
    char path[64];
    int process = 0;
    snprintf(path, sizeof path, "/proc/self/task/%d/children", (int)getpid());
    FILE *file = fopen(path, "r");
    if (!file)
        return 0;
    if (fscanf(file, "%d", &process) != 1)
        process = 0;
    fclose(file);
    return process;
}

static void crashes_are_results(void **state)
{
    const char *fifo = *state;
    const char *const words[] = {"inspect", fifo, NULL};
    facet_error error;
    job_result r = {.user = NULL};
    job_pool *pool = job_pool_create(2);
    assert_int_equal(job_pool_start(pool, &(job_request){.words = words, .name = "bad.glb"}, &error),
                     FACET_OK);
    assert_false(job_pool_wait(pool, NULL, 0, 0.1, &r));
    pid_t child = find_child();
    if (child <= 0) {
        job_pool_destroy(pool);
        skip();
    }
    kill(child, SIGSEGV);
    assert_true(job_pool_wait(pool, NULL, 0, 10.0, &r));
    assert_int_equal(r.end, JOB_KILLED);
    assert_int_equal(r.signal, SIGSEGV);
    assert_int_equal(r.exit_code, 128 + SIGSEGV);
    assert_string_equal(r.message,
                        "bad.glb: its process crashed and was ended by signal 11 (Segmentation fault)");
    job_result_destroy(&r);
    job_pool_destroy(pool);
}

static void jobs_can_be_cancelled(void **state)
{
    const char *fifo = *state;
    const char *const words[] = {"inspect", fifo, NULL};
    facet_error error;
    int users[2];
    job_result r = {.user = NULL};
    job_pool *pool = job_pool_create(3);
    for (int i = 0; i < 2; i++)
        assert_int_equal(job_pool_start(pool, &(job_request){.words = words, .user = &users[i]}, &error),
                         FACET_OK);
    job_pool_cancel(pool, &users[1]);
    assert_true(job_pool_wait(pool, NULL, 0, 10.0, &r));
    assert_int_equal(r.end, JOB_CANCELLED);
    assert_int_equal(r.exit_code, EXIT_AGAIN);
    assert_ptr_equal(r.user, &users[1]);
    job_result_destroy(&r);
    /* a descriptor of the caller ends the wait */
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    assert_int_equal(write(ends[1], "x", 1), 1);
    struct pollfd other = {.fd = ends[0], .events = POLLIN};
    assert_false(job_pool_wait(pool, &other, 1, 10.0, &r));
    assert_int_equal(other.revents, POLLIN);
    close(ends[0]);
    close(ends[1]);
    assert_int_equal(job_pool_running(pool), 1);
    job_pool_destroy(pool); /* and kills the other */
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1);
}

/* Warm and cold jobs give the same bytes. */
static void shared_environments_change_nothing(void **state)
{
    (void)state;
    const char *const words[] = {"render", "-o",    JOB_OUTPUT, "--format",     "png", "--size",
                                 "48",     "--env", "sun:30",   "--background", "env", NULL};
    facet_error error;
    job_words line = {.words = NULL};
    job_result cold = run(&(job_request){.words = words, .max_output_bytes = 1 << 20});
    job_words_add_all(&line, words);
    if (job_warm(&line, &error) != FACET_OK)
        fail_msg("%s", error.message);
    job_words_destroy(&line);
    job_result warm = run(&(job_request){.words = words, .max_output_bytes = 1 << 20});
    assert_int_equal(cold.exit_code, EXIT_DONE);
    assert_int_equal(cold.output_size, warm.output_size);
    assert_memory_equal(cold.output, warm.output, cold.output_size);
    job_result_destroy(&cold);
    job_result_destroy(&warm);
}

/* ---- options of JSON objects ---- */

static facet_result words_of(const char *json, job_words *w, facet_error *error)
{
    static const char *const skipped[] = {"id", NULL};
    json_t *object = json_loads(json, 0, NULL);
    assert_non_null(object);
    *w = (job_words){.words = NULL};
    job_words_add(w, "render");
    facet_result result = job_options_add(w, verb_find("render"), object, skipped, "line 3", error);
    json_decref(object);
    return result == FACET_OK ? job_words_check(w, error) : result;
}

static void members_are_options(void **state)
{
    (void)state;
    facet_error error;
    job_words w;
    assert_int_equal(words_of("{\"id\":7,\"size\":[256,128],\"ortho\":true,\"exposure\":0.5,\"verbose\":2,"
                              "\"denoise\":false,\"env\":\"sun:30\"}",
                              &w, &error),
                     FACET_OK);
    const char *const wanted[] = {"render",    "--size=256,128", "--ortho",     "--exposure=0.5",
                                  "--verbose", "--verbose",      "--env=sun:30"};
    assert_int_equal(w.count, COUNT_OF(wanted));
    for (size_t i = 0; i < w.count; i++)
        assert_string_equal(w.words[i], wanted[i]);
    job_words_destroy(&w);
    static const struct {
        const char *json, *message;
    } wrong[] = {{"{\"sise\":1}", "line 3: unknown option --sise; did you mean --size?"},
                 {"{\"ortho\":1}", "line 3: ortho: it must be true or false"},
                 {"{\"size\":{}}", "line 3: size: it must be text, a number or an array of these"},
                 {"{\"config\":\"a.json\"}", "line 3: config: it cannot be an option of a single item"},
                 {"{\"up\":\"x\"}", "--up: \"x\" is none of y, z"}};
    for (size_t i = 0; i < COUNT_OF(wrong); i++) {
        assert_int_equal(words_of(wrong[i].json, &w, &error), FACET_ERROR_ARGUMENT);
        assert_non_null(strstr(error.message, wrong[i].message));
        job_words_destroy(&w);
    }
}

static int make_fifo(void **state)
{
    static char name[64];
    snprintf(name, sizeof name, "/tmp/facet_job_pool_test.%d.glb", (int)getpid());
    *state = name;
    return mkfifo(name, 0600);
}

static int remove_fifo(void **state)
{
    return unlink(*state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_come_through_a_pipe),
        cmocka_unit_test(failures_have_their_sentence),
        cmocka_unit_test(long_outputs_end_the_job),
        cmocka_unit_test(hanging_jobs_are_ended),
        cmocka_unit_test(crashes_are_results),
        cmocka_unit_test(jobs_can_be_cancelled),
        cmocka_unit_test(shared_environments_change_nothing),
        cmocka_unit_test(members_are_options),
    };
    return cmocka_run_group_tests(tests, make_fifo, remove_fifo);
}
