/* farm_command.c - see farm_command.h. */
#include "cli/farm/farm_command.h"

#include "base/result.h"
#include "cli/shared/output.h"

#include <stdint.h>
#include <stdlib.h>
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

bool farm_command_lacks(const farm_command *c, const char *name)
{
    const option *o = option_find(c->verb, name, strlen(name));
    return o && !is_given(&c->line, o->id);
}

/* Options that the run itself sets, or under which a shard has no result. */
static facet_result check_options(const farm_command *c, facet_error *error)
{
    static const char *const own[] = {"shard", "results", "failed", "json", "verify", "gallery"};
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (option_find(c->verb, own[i], strlen(own[i])) && !farm_command_lacks(c, own[i]))
            return fail(error, FACET_ERROR_ARGUMENT, "farm: the command must not have --%s here", own[i]);
    const char *output = farm_command_option(c, "output");
    if (output && strcmp(output, "-") == 0)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "farm: the command writes to standard output; the shards of a run write files (-o NAME)");
    const char *manifest = farm_command_option(c, "manifest");
    if (!farm_command_is_catalog(c) || (manifest && strcmp(manifest, "-") != 0))
        return FACET_OK;
    return fail(error, FACET_ERROR_ARGUMENT,
                "farm: facet batch needs --manifest FILE here: every shard reads the list, which must not "
                "change during the run, as a folder may");
}

/* Takes an option out of the words and gives it to facet merge. */
static void take_option(farm_command *c, const option *o)
{
    const char *value = c->line.values[o->id].text;
    c->merge_options[c->merge_option_count++] = o;
    for (size_t i = 0; i < c->word_count; i++) {
        const char *word = c->words[i];
        if (value < word || value > word + strlen(word))
            continue;
        size_t first = value == word ? i - 1 : i; /* "-o NAME" or "-oNAME" */
        c->word_count -= i + 1 - first;
        memmove(c->words + first, c->words + i + 1, (c->word_count - first) * sizeof *c->words);
        return;
    }
}

/* Parts of an image have outputs of their own; the file of the whole image is that of facet merge. */
static facet_result take_output(farm_command *c, facet_error *error)
{
    static const char *const names[] = {"output", "format", "jpeg-quality", "png-compression"};
    const option *output = option_find(c->verb, "output", 6);
    if (!is_given(&c->line, output->id))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "farm: facet %s needs -o NAME here: the image, or frames as frame_####.png",
                    c->verb->name);
    if (c->line.argument_count > 1)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "farm: facet %s takes one model here; several are a catalog, for facet batch",
                    c->verb->name);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const option *o = option_find(c->verb, names[i], strlen(names[i]));
        unsigned count = o ? c->line.values[o->id].count : 0;
        if (count > 1)
            return fail(error, FACET_ERROR_ARGUMENT, "farm: the command has --%s twice", names[i]);
        if (count)
            take_option(c, o);
    }
    return FACET_OK;
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
    out->words = malloc(word_count * sizeof *out->words);
    if (!out->words)
        return fail_memory(error, "command", word_count * sizeof *out->words);
    out->word_count = word_count - 1;
    memcpy(out->words, words + 1, out->word_count * sizeof *out->words);
    TRY(command_line_parse(out->verb, (int)out->word_count, (char **)(uintptr_t)out->words, &out->line,
                           error));
    TRY(check_options(out, error));
    const char *by = farm_command_option(out, "shard-by"), *output = farm_command_option(out, "output");
    bool is_whole = farm_command_is_catalog(out) || (by && strcmp(by, "frames") == 0) ||
                    (output && output_name_has_frame(output));
    return is_whole ? FACET_OK : take_output(out, error);
}

void farm_command_destroy(farm_command *c)
{
    free(c->words);
    command_line_destroy(&c->line);
    *c = (farm_command){0};
}
