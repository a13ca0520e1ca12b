/* shard_test.c - notation, the variables of each engine, and the partition. */
#define _POSIX_C_SOURCE 200809L
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "cli/shared/shard.h"

#include <stdlib.h>
#include <string.h>

static const char *const variables[] = {"FACET_SHARD",
                                        "FACET_SHARD_COUNT",
                                        "SLURM_ARRAY_TASK_ID",
                                        "SLURM_ARRAY_TASK_MIN",
                                        "SLURM_ARRAY_TASK_MAX",
                                        "SLURM_ARRAY_TASK_STEP",
                                        "SLURM_ARRAY_TASK_COUNT",
                                        "JOB_COMPLETION_INDEX",
                                        "AWS_BATCH_JOB_ARRAY_INDEX",
                                        "PBS_ARRAY_INDEX",
                                        "SGE_TASK_ID",
                                        "SGE_TASK_FIRST",
                                        "SGE_TASK_LAST",
                                        "SGE_TASK_STEPSIZE",
                                        "CLOUD_RUN_TASK_INDEX",
                                        "CLOUD_RUN_TASK_COUNT",
                                        "OMPI_COMM_WORLD_RANK",
                                        "OMPI_COMM_WORLD_SIZE"};

/* Parses text with exactly these variables, "A=1 B=2", of the engines. */
static facet_result parse(const char *environment, const char *text, shard *out, facet_error *error)
{
    char words[512];
    for (size_t i = 0; i < sizeof variables / sizeof *variables; i++)
        unsetenv(variables[i]);
    strncpy(words, environment, sizeof words - 1);
    words[sizeof words - 1] = 0;
    for (char *word = strtok(words, " "); word; word = strtok(NULL, " ")) {
        char *equals = strchr(word, '=');
        *equals = 0;
        setenv(word, equals + 1, 1);
    }
    return shard_parse(text, out, error);
}

static void shards_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *environment, *text;
        uint32_t index, count;
    } cases[] = {
        {"", "0/1", 0, 1},
        {"", "3/40", 3, 40},
        {"", "39/40", 39, 40},
        {"", "999999/1000000", 999999, 1000000},
        {"FACET_SHARD=2/5", "auto", 2, 5},
        {"FACET_SHARD=2/5 SLURM_ARRAY_TASK_ID=9", "auto", 2, 5},
        {"SLURM_ARRAY_TASK_ID=7 SLURM_ARRAY_TASK_MIN=0 SLURM_ARRAY_TASK_MAX=9 SLURM_ARRAY_TASK_STEP=1 "
         "SLURM_ARRAY_TASK_COUNT=10",
         "auto", 7, 10},
        {"SLURM_ARRAY_TASK_ID=17 SLURM_ARRAY_TASK_MIN=3 SLURM_ARRAY_TASK_MAX=17 SLURM_ARRAY_TASK_COUNT=2",
         "auto/400", 17, 400},
        {"SLURM_ARRAY_TASK_ID=0 SLURM_ARRAY_TASK_MIN=0 SLURM_ARRAY_TASK_MAX=1 JOB_COMPLETION_INDEX=5", "auto",
         0, 2},
        {"JOB_COMPLETION_INDEX=5", "auto/8", 5, 8},
        {"JOB_COMPLETION_INDEX=5 FACET_SHARD_COUNT=6", "auto", 5, 6},
        {"JOB_COMPLETION_INDEX=5 FACET_SHARD_COUNT=6", "auto/7", 5, 7},
        {"AWS_BATCH_JOB_ARRAY_INDEX=0 FACET_SHARD_COUNT=2", "auto", 0, 2},
        {"PBS_ARRAY_INDEX=1", "auto/2", 1, 2},
        {"SGE_TASK_ID=1 SGE_TASK_FIRST=1 SGE_TASK_LAST=4 SGE_TASK_STEPSIZE=1", "auto", 0, 4},
        {"SGE_TASK_ID=4 SGE_TASK_FIRST=1 SGE_TASK_LAST=4 SGE_TASK_STEPSIZE=1", "auto", 3, 4},
        {"SGE_TASK_ID=4 SGE_TASK_FIRST=4 SGE_TASK_LAST=4 SGE_TASK_STEPSIZE=1", "auto/9", 3, 9},
        {"SGE_TASK_ID=undefined CLOUD_RUN_TASK_INDEX=2 CLOUD_RUN_TASK_COUNT=3", "auto", 2, 3},
        {"OMPI_COMM_WORLD_RANK=1 OMPI_COMM_WORLD_SIZE=4", "auto", 1, 4},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        shard s = {77, 77};
        facet_error error;
        if (parse(cases[i].environment, cases[i].text, &s, &error) != FACET_OK)
            fail_msg("%s with %s: %s", cases[i].text, cases[i].environment, error.message);
        assert_int_equal(s.index, cases[i].index);
        assert_int_equal(s.count, cases[i].count);
    }
}

static void what_is_no_shard_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *environment, *text, *part;
    } cases[] = {
        {"", "4/4", "\"4/4\" is not I/N"},
        {"", "1", "is not I/N"},
        {"", "-1/4", "is not I/N"},
        {"", "1/0", "is not I/N"},
        {"", "1/2/3", "is not I/N"},
        {"", "1 /2", "is not I/N"},
        {"", "0/1000001", "is not I/N"},
        {"", "4294967296/4294967297", "is not I/N"},
        {"", "automatic", "is not I/N"},
        {"", "auto", "OMPI_COMM_WORLD_RANK; write --shard I/N"},
        {"", "auto/4", "none of FACET_SHARD=I/N, SLURM_ARRAY_TASK_ID, JOB_COMPLETION_INDEX"},
        {"FACET_SHARD=5/5", "auto", "FACET_SHARD is \"5/5\""},
        {"JOB_COMPLETION_INDEX=5", "auto", "number of shards is not in the environment"},
        {"JOB_COMPLETION_INDEX=5", "auto/5", "JOB_COMPLETION_INDEX is 5, not a number from 0 to 4"},
        {"JOB_COMPLETION_INDEX=5", "auto/x", "\"x\" is not a number of shards"},
        {"JOB_COMPLETION_INDEX=x", "auto/5", "JOB_COMPLETION_INDEX is \"x\", not a whole number"},
        {"JOB_COMPLETION_INDEX=1 FACET_SHARD_COUNT=0", "auto", "FACET_SHARD_COUNT is \"0\""},
        {"AWS_BATCH_JOB_ARRAY_INDEX=3", "auto", "number of shards"},
        {"PBS_ARRAY_INDEX=3", "auto", "number of shards"},
        {"CLOUD_RUN_TASK_INDEX=3", "auto", "number of shards"},
        {"OMPI_COMM_WORLD_RANK=0 OMPI_COMM_WORLD_SIZE=0", "auto", "number of shards"},
        /* parts of an array: two elements resubmitted, every second one, without the first */
        {"SLURM_ARRAY_TASK_ID=17 SLURM_ARRAY_TASK_MIN=3 SLURM_ARRAY_TASK_MAX=17 SLURM_ARRAY_TASK_COUNT=2",
         "auto", "SLURM_ARRAY_TASK_ID, 3 to 17, is not known to be whole"},
        {"SLURM_ARRAY_TASK_ID=0 SLURM_ARRAY_TASK_MIN=0 SLURM_ARRAY_TASK_MAX=17 SLURM_ARRAY_TASK_COUNT=2",
         "auto", "not known to be whole"},
        {"SLURM_ARRAY_TASK_ID=2 SLURM_ARRAY_TASK_MIN=0 SLURM_ARRAY_TASK_MAX=6 SLURM_ARRAY_TASK_STEP=2",
         "auto", "not known to be whole"},
        {"SLURM_ARRAY_TASK_ID=1 SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_MAX=4 SLURM_ARRAY_TASK_COUNT=4",
         "auto", "(0 to N - 1, each)"},
        {"SLURM_ARRAY_TASK_ID=1", "auto", "without SLURM_ARRAY_TASK_MIN and SLURM_ARRAY_TASK_MAX"},
        {"SGE_TASK_ID=4 SGE_TASK_FIRST=4 SGE_TASK_LAST=4 SGE_TASK_STEPSIZE=1", "auto", "(1 to N, each)"},
        {"SGE_TASK_ID=0", "auto/4", "SGE_TASK_ID is 0, not a number from 1 to 4"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        shard s = {77, 77};
        facet_error error = {0};
        if (parse(cases[i].environment, cases[i].text, &s, &error) != FACET_ERROR_ARGUMENT)
            fail_msg("%s with %s was read", cases[i].text, cases[i].environment);
        if (!strstr(error.message, cases[i].part))
            fail_msg("\"%s\" lacks \"%s\"", error.message, cases[i].part);
        assert_true(s.index == 77 && s.count == 77);
    }
}

/* Every item has one shard; shards differ by at most one item; shard_size() counts them. */
static void items_are_shared_out(void **state)
{
    (void)state;
    static const uint32_t counts[] = {1, 2, 3, 7, 64, 400};
    enum { ITEMS = 1003 };
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        uint32_t sizes[400] = {0};
        for (uint64_t item = 0; item < ITEMS; item++) {
            uint32_t owners = 0;
            for (uint32_t i = 0; i < counts[c]; i++)
                if (shard_has((shard){i, counts[c]}, item)) {
                    owners++;
                    sizes[i]++;
                }
            assert_int_equal(owners, 1);
        }
        for (uint32_t i = 0; i < counts[c]; i++) {
            assert_in_range(sizes[i], ITEMS / counts[c], ITEMS / counts[c] + 1);
            assert_int_equal(shard_size((shard){i, counts[c]}, ITEMS), sizes[i]);
        }
    }
    assert_true(shard_size((shard){0, 1}, 0) == 0);
}

/* A list in which each eighth item is large gives each of 8 shards its share of them, unlike item mod 8: the
 * expectation is 1000, the standard deviation 30. */
static void periods_are_spread(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 8; i++) {
        int large = 0;
        for (uint64_t item = 0; item < 64000; item += 8)
            large += shard_has((shard){i, 8}, item);
        assert_in_range(large, 850, 1150);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shards_are_read),
        cmocka_unit_test(what_is_no_shard_is_refused),
        cmocka_unit_test(items_are_shared_out),
        cmocka_unit_test(periods_are_spread),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
