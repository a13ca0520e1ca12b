/* shard.c - --shard: its notation, the variables of cluster engines, and the partition. */
#include "cli/shared/shard.h"

#include "base/hash.h"
#include "base/result.h"

#include <stdlib.h>
#include <string.h>

/* ---- the partition ---- */

/* The shard of an item: its place in its block of count items, rotated by a random number of the block. */
static uint32_t shard_of(uint64_t item, uint32_t count)
{
    uint64_t block = item / count, place = item % count;
    return (uint32_t)((place + mix64((block + 1) * MIX64_STEP) % count) % count);
}

bool shard_has(shard s, uint64_t item)
{
    return shard_of(item, s.count) == s.index;
}

uint64_t shard_size(shard s, uint64_t item_count)
{
    uint64_t size = item_count / s.count;
    for (uint64_t item = size * s.count; item < item_count; item++)
        if (shard_has(s, item))
            return size + 1;
    return size;
}

/* ---- notation ---- */

/* A whole number of at most 9 digits at the start of *text, which advances past it. */
static bool scan_whole(const char **text, uint32_t *number)
{
    size_t length = strspn(*text, "0123456789");
    if (length == 0 || length > 9)
        return false;
    *number = (uint32_t)strtoul(*text, NULL, 10);
    *text += length;
    return true;
}

static bool parse_whole(const char *text, uint32_t *number)
{
    return scan_whole(&text, number) && !*text;
}

static bool parse_count(const char *text, uint32_t *count)
{
    return parse_whole(text, count) && *count >= 1 && *count <= SHARD_COUNT_MAX;
}

static bool parse_pair(const char *text, shard *out)
{
    shard s;
    if (!scan_whole(&text, &s.index) || *text != '/' || !parse_count(text + 1, &s.count) ||
        s.index >= s.count)
        return false;
    *out = s;
    return true;
}

/* ---- the environment ---- */

/* How the variables of an engine describe its array of jobs. */
typedef struct engine {
    const char *index;               /* number of this job; its presence tells the engine */
    const char *count;               /* number of jobs; NULL: none is given */
    const char *first, *last, *step; /* range of the indices; NULL: from 0, step 1 */
    uint32_t base;                   /* smallest index of a whole array */
} engine;

/* In the order in which they are tried. An engine that starts another one (mpirun within a Slurm array) comes
 * first. */
static const engine engines[] = {
    {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_MAX",
     "SLURM_ARRAY_TASK_STEP", 0},
    {"JOB_COMPLETION_INDEX", NULL, NULL, NULL, NULL, 0},
    {"AWS_BATCH_JOB_ARRAY_INDEX", NULL, NULL, NULL, NULL, 0},
    {"PBS_ARRAY_INDEX", NULL, NULL, NULL, NULL, 0},
    {"SGE_TASK_ID", NULL, "SGE_TASK_FIRST", "SGE_TASK_LAST", "SGE_TASK_STEPSIZE", 1},
    {"CLOUD_RUN_TASK_INDEX", "CLOUD_RUN_TASK_COUNT", NULL, NULL, NULL, 0},
    {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", NULL, NULL, NULL, 0},
};
enum { ENGINE_COUNT = sizeof engines / sizeof *engines };

/* The value of a variable; NULL where it is not set, or as Grid Engine has it outside of arrays. */
static const char *variable(const char *name)
{
    const char *value = name ? getenv(name) : NULL;
    return value && *value && strcmp(value, "undefined") != 0 ? value : NULL;
}

static facet_result fail_variable(const char *name, const char *expected, facet_error *error)
{
    return fail(error, FACET_ERROR_ARGUMENT, "--shard auto: %s is \"%.100s\", not %s", name, variable(name),
                expected);
}

static facet_result read_variable(const char *name, uint32_t *number, facet_error *error)
{
    return parse_whole(variable(name), number) ? FACET_OK : fail_variable(name, "a whole number", error);
}

/* The number of jobs of a whole array, from its range or the engine's count; 0: neither is known. */
static facet_result read_extent(const engine *e, uint32_t *count, facet_error *error)
{
    uint32_t first = e->base, last, step = 1;
    *count = 0;
    if (variable(e->count))
        TRY(read_variable(e->count, count, error));
    if (!e->first)
        return FACET_OK;
    if (!variable(e->first) || !variable(e->last))
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "--shard auto: %s is set without %s and %s; write --shard auto/N with the number of shards",
            e->index, e->first, e->last);
    TRY(read_variable(e->first, &first, error));
    TRY(read_variable(e->last, &last, error));
    if (variable(e->step))
        TRY(read_variable(e->step, &step, error));
    /* A part of an array, as of a resubmission, does not tell the size of the whole. */
    if (first != e->base || step != 1 || last < first || (*count && *count != last - first + 1))
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "--shard auto: the array of %s, %u to %u, is not known to be whole (%u to N%s, each); write "
            "--shard auto/N with the number of shards of the whole job",
            e->index, first, last, e->base, e->base ? "" : " - 1");
    *count = last - first + 1;
    return FACET_OK;
}

/* The number of shards: of "auto/N", of FACET_SHARD_COUNT, or the engine's. */
static facet_result find_count(const engine *e, const char *text, uint32_t *count, facet_error *error)
{
    static const char *const expected = "a number of shards from 1 to 1000000";
    const char *given = variable("FACET_SHARD_COUNT");
    if (*text == '/')
        return parse_count(text + 1, count)
                   ? FACET_OK
                   : fail(error, FACET_ERROR_ARGUMENT, "--shard: \"auto%s\": \"%s\" is not %s", text,
                          text + 1, expected);
    if (given)
        return parse_count(given, count) ? FACET_OK : fail_variable("FACET_SHARD_COUNT", expected, error);
    TRY(read_extent(e, count, error));
    if (*count == 0)
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "--shard auto: %s is %s, but the number of shards is not in the environment; write --shard "
            "auto/N, or set FACET_SHARD_COUNT",
            e->index, variable(e->index));
    return *count <= SHARD_COUNT_MAX ? FACET_OK
                                     : fail_variable(e->count ? e->count : e->last, expected, error);
}

static facet_result fail_unknown(facet_error *error)
{
    char list[512] = "FACET_SHARD=I/N";
    for (size_t i = 0; i < ENGINE_COUNT; i++) {
        strcat(list, i + 1 < ENGINE_COUNT ? ", " : " or ");
        strcat(list, engines[i].index);
    }
    return fail(error, FACET_ERROR_ARGUMENT,
                "--shard auto: the environment has none of %s; write --shard I/N instead", list);
}

/* rest is what follows "auto". */
static facet_result find_shard(const char *rest, shard *out, facet_error *error)
{
    if (variable("FACET_SHARD"))
        return parse_pair(variable("FACET_SHARD"), out)
                   ? FACET_OK
                   : fail_variable("FACET_SHARD", "I/N with I from 0 to N - 1", error);
    const engine *e = engines;
    while (e < engines + ENGINE_COUNT && !variable(e->index))
        e++;
    if (e == engines + ENGINE_COUNT)
        return fail_unknown(error);
    shard s;
    TRY(read_variable(e->index, &s.index, error));
    TRY(find_count(e, rest, &s.count, error));
    if (s.index < e->base || s.index - e->base >= s.count)
        return fail(error, FACET_ERROR_ARGUMENT, "--shard auto: %s is %u, not a number from %u to %u",
                    e->index, s.index, e->base, e->base + s.count - 1);
    s.index -= e->base;
    *out = s;
    return FACET_OK;
}

facet_result shard_parse(const char *text, shard *out, facet_error *error)
{
    if (strncmp(text, "auto", 4) == 0 && (!text[4] || text[4] == '/'))
        return find_shard(text + 4, out, error);
    if (parse_pair(text, out))
        return FACET_OK;
    return fail(
        error, FACET_ERROR_ARGUMENT,
        "--shard: \"%.100s\" is not I/N with I from 0 to N - 1 and N up to 1000000, nor auto or auto/N",
        text);
}

facet_result shard_read(const command_line *c, shard *out, facet_error *error)
{
    *out = (shard){0, 1};
    return is_given(c, OPT_SHARD) ? shard_parse(option_text(c, OPT_SHARD, ""), out, error) : FACET_OK;
}
