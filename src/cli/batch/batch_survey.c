/* batch_survey.c - see batch_survey.h. */
#include "cli/batch/batch_survey.h"

#include "cli/shared/failure.h"
#include "cli/shared/terminal.h"

#include <stdio.h>
#include <string.h>

/* What is known about an item. */
static batch_known judge(const batch_survey *s, const batch_item *item)
{
    if (item->problem)
        return KNOWN_FAILED;
    if (batch_is_done(s->history, item))
        return KNOWN_DONE;
    if (batch_history_find(s->history, item) == KNOWN_FAILED)
        return KNOWN_FAILED;
    /* without results, a file that is there is all that is known of formats without a tag */
    bool is_unknown = !s->plan->results && item->output && !item->has_metadata && !item->writes_sequence;
    return is_unknown && output_exists(item->output) ? KNOWN_DONE : KNOWN_NOT;
}

facet_result batch_survey_all(batch_survey *s, void *user,
                              void (*each)(void *user, const batch_item *item, batch_known known,
                                           const char *message),
                              facet_error *error)
{
    batch_source *source = NULL;
    batch_item *item = NULL;
    s->done = s->failed = s->missing = 0;
    if (s->plan->manifest && strcmp(s->plan->manifest, "-") == 0)
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "--manifest: standard input cannot be read again for --verify and --gallery; name a file");
    TRY(batch_source_open(s->plan, s->models, &source, error));
    batch_next next;
    while ((next = batch_source_next(source, &item, error)) == NEXT_ITEM) {
        batch_known known = judge(s, item);
        s->done += known == KNOWN_DONE;
        s->failed += known == KNOWN_FAILED;
        s->missing += known == KNOWN_NOT;
        const char *message = json_string_value(json_object_get(s->messages, item->id));
        each(user, item, known, item->problem ? item->problem : message);
        batch_item_destroy(item);
    }
    batch_source_close(source);
    return next == NEXT_END ? FACET_OK : error->result;
}

/* ---- --verify ---- */

static void print_state(void *user, const batch_item *item, batch_known known, const char *message)
{
    const bool *is_quiet = user;
    char line[2048];
    if (known == KNOWN_DONE || *is_quiet)
        return;
    const char *name = item->output ? item->output : item->name;
    if (known == KNOWN_FAILED)
        snprintf(line, sizeof line, "failed: %.900s%s%.900s", name, message ? ": " : "",
                 message ? message : "");
    else
        snprintf(line, sizeof line, "missing: %.900s, of %.900s", name, item->name);
    terminal_disarm(line);
    puts(line);
}

facet_result batch_verify(batch_survey *survey, bool is_quiet, facet_error *error)
{
    return batch_survey_all(survey, &is_quiet, print_state, error);
}
