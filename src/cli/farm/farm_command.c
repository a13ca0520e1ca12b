/* farm_command.c - see farm_command.h. */
#include "cli/farm/farm_command.h"

#include "base/result.h"

#include <stdint.h>
#include <string.h>

bool farm_command_is_catalog(const farm_command *c)
{
    return strcmp(c->verb->name, "batch") == 0;
}

const char *farm_command_option(const farm_command *c, const char *name)
{
    const option *o = option_find(c->verb, name, strlen(name));
    return o ? c->line.values[o->id].text : NULL;
}

static bool has_option(const farm_command *c, const char *name)
{
    const option *o = option_find(c->verb, name, strlen(name));
    return o && is_given(&c->line, o->id);
}

/* Options that the run itself sets, or under which a shard has no result. */
static facet_result check_options(const farm_command *c, facet_error *error)
{
    static const char *const own[] = {"shard", "results", "json", "verify", "gallery"};
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (has_option(c, own[i]))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "farm: the command has --%s, which facet farm sets itself for each shard", own[i]);
    const char *output = farm_command_option(c, "output");
    if (output && strcmp(output, "-") == 0)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "farm: the command writes to standard output; the shards of a run write files (-o NAME)");
    const char *manifest = farm_command_option(c, "manifest");
    if (!farm_command_is_catalog(c) || (manifest && strcmp(manifest, "-") != 0))
        return FACET_OK;
    return fail(
        error, FACET_ERROR_ARGUMENT,
        "farm: facet batch needs --manifest FILE here: every shard reads the list, which must not change "
        "during the run, as a folder may");
}

facet_result farm_command_read(const char *const *words, size_t word_count, farm_command *out,
                               facet_error *error)
{
    if (word_count == 0)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "farm: which command? It follows after --, as in facet farm submit -- batch --manifest "
                    "jobs.jsonl");
    out->verb = verb_find(words[0]);
    if (!out->verb || !option_find(out->verb, "shard", 5))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "farm: \"%.100s\" is not a command that works in shards; facet batch and facet render do",
                    words[0]);
    out->words = words + 1;
    out->word_count = word_count - 1;
    TRY(command_line_parse(out->verb, (int)out->word_count, (char **)(uintptr_t)out->words, &out->line,
                           error));
    return check_options(out, error);
}

void farm_command_destroy(farm_command *c)
{
    command_line_destroy(&c->line);
    *c = (farm_command){0};
}
