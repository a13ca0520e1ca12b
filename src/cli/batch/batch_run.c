/* batch_run.c - see batch_run.h. One loop: start what can be started, wait for a result, decide what follows from it. */
#define _POSIX_C_SOURCE 200809L
#include "cli/batch/batch_run.h"

#include "cli/batch/batch_policy.h"
#include "cli/shared/failure.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/shell_line.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    MAX_ALONE = 64,         /* items that wait to run alone; with more, they run before the next others */
    SUSPECT_COUNT = 3,      /* items in a row whose failure may be the machine's */
    MAX_START_FAILURES = 30 /* seconds without a process to be had */
};
static const double stop_grace_s = 20.0; /* for running items after a signal */

static bool is_stopping(const batch_run *run)
{
    return run->stop_time > 0.0;
}

/* ---- lists ---- */

/* Appends item to a list. */
static void append(batch_item **list, batch_item *item)
{
    while (*list)
        list = &(*list)->next;
    item->next = NULL;
    *list = item;
}

static batch_item *take_first(batch_item **list)
{
    batch_item *item = *list;
    if (item)
        *list = item->next;
    return item;
}

/* Takes the first item of the list that is due. */
static batch_item *take_due(batch_item **list)
{
    double now = interrupt_clock();
    while (*list && (*list)->due > now)
        list = &(*list)->next;
    return take_first(list);
}

/* ---- results ---- */

static void add_failure(batch_run *run, const batch_item *item, const char *message, int exit_code)
{
    if (!run->failures || json_array_size(run->failures) >= BATCH_KEPT_FAILURES)
        return;
    facet_error error = {.result = FACET_ERROR_INVALID};
    snprintf(error.message, sizeof error.message, "%s", message);
    json_array_append_new(run->failures, report_error_json(&error, item->name, exit_code));
}

/* Records the final result of an item and releases it. */
static facet_result record(batch_run *run, batch_item *item, const job_result *result, bool is_done,
                           facet_error *error)
{
    const char *message = result->message ? result->message : "it failed without a message";
    facet_result written = batch_lines_add(&run->results, batch_result_json(item, result, is_done), error);
    uint64_t known = batch_history_value(item, is_done ? KNOWN_DONE : KNOWN_FAILED);
    if (written == FACET_OK && run->reasons && !batch_map_set(&run->history, item->id, known))
        written = fail_memory(error, "results", 0);
    if (is_done) {
        run->progress.done++;
        message_at(run->messages, VERBOSITY_DETAILS, "%s: done, %.2f s",
                   item->output ? item->output : item->name, result->seconds);
    } else {
        run->progress.failed++;
        run->for_others += batch_is_for_others(item, result->exit_code);
        message_error("%s", message);
        add_failure(run, item, message, result->exit_code);
        if (run->reasons)
            json_object_set_new(run->reasons, item->id, report_string_json(message));
        if (written == FACET_OK)
            written =
                batch_lines_add(&run->failed, batch_failed_json(item, result->exit_code, message), error);
    }
    batch_progress_show(&run->progress, item->name, false);
    batch_item_destroy(item);
    return written;
}

/* An item that cannot run, since its line is wrong. */
static facet_result record_problem(batch_run *run, batch_item *item, facet_error *error)
{
    const job_result result = {.exit_code = EXIT_USAGE, .message = item->problem};
    return record(run, item, &result, false, error);
}

/* An item that an earlier run has done; the results may lack it, if that run was killed. */
static facet_result record_kept(batch_run *run, batch_item *item, facet_error *error)
{
    facet_result written = FACET_OK;
    if (batch_history_find(&run->history, item) != KNOWN_DONE)
        written = batch_lines_add(&run->results, batch_kept_json(item), error);
    run->progress.kept++;
    batch_progress_show(&run->progress, NULL, false);
    batch_item_destroy(item);
    return written;
}

/* Whether a picture without a model can be rendered here: then it is the models that crash, not the machine. */
static bool can_render_here(void)
{
    static const char *const words[] = {"render", "--size=16", "--format=png", "--output=/dev/null", NULL};
    const job_request request = {.words = words, .name = "a picture", .time_limit_s = 30.0};
    job_result result = {.exit_code = EXIT_BUG};
    facet_error error;
    job_pool *pool = job_pool_create(1);
    bool is_good = pool && job_pool_start(pool, &request, &error) == FACET_OK;
    while (is_good && job_pool_running(pool) && !interrupt_signal())
        job_pool_wait(pool, NULL, 0, 1.0, &result);
    is_good = is_good && result.end == JOB_EXITED && result.exit_code == EXIT_DONE;
    job_result_destroy(&result);
    job_pool_destroy(pool);
    return is_good;
}

/* Counts items in a row whose first try failed by the machine. */
static void suspect(batch_run *run, const batch_item *item, const job_result *result)
{
    if (item->tries > 1)
        return;
    if (!batch_is_machine_failure(item, result)) {
        run->suspect_count = 0;
        return;
    }
    snprintf(run->reason, sizeof run->reason, "%s", result->message ? result->message : item->name);
    if (run->is_suspect || ++run->suspect_count < SUSPECT_COUNT)
        return;
    run->suspect_count = 0;
    run->is_suspect = result->end != JOB_KILLED || !can_render_here();
}

/* Removes the image that path tracing has written when it was interrupted, at whose place a complete one was expected. */
static void remove_partial(const batch_item *item, const job_result *result)
{
    const json_t *image = json_array_get(json_object_get(result->report, "pictures"), 0);
    bool is_wanted =
        result->end == JOB_EXITED && (result->exit_code == EXIT_DONE || result->exit_code == EXIT_NEGATIVE);
    if (!is_wanted && item->output && !item->writes_sequence &&
        json_is_true(json_object_get(image, "partial")))
        unlink(item->output);
}

/* Decides what follows from a result. */
static facet_result receive(batch_run *run, batch_item *item, job_result *result, facet_error *error)
{
    double wait_s;
    run->running_alone = NULL;
    if (result->end != JOB_EXITED && item->output)
        batch_remove_temporaries(item->output);
    remove_partial(item, result);
    /* Slurm sends its signals to the items, too */
    bool was_interrupted =
        interrupt_signal() && (result->end == JOB_KILLED || result->exit_code == EXIT_AGAIN);
    if (result->end == JOB_CANCELLED || was_interrupted) {
        batch_item_destroy(item);
        return FACET_OK;
    }
    item->tries++;
    batch_answer answer = batch_answer_to(item, result, &wait_s);
    suspect(run, item, result);
    switch (answer) {
    case ANSWER_DONE:
        return record(run, item, result, true, error);
    case ANSWER_LATER:
        item->is_alone = false;
        item->due = interrupt_clock() + wait_s;
        append(&run->later, item);
        break;
    case ANSWER_ALONE:
        item->is_alone = true;
        append(&run->alone, item);
        run->alone_count++;
        break;
    case ANSWER_FAILED:
        return record(run, item, result, false, error);
    }
    message_at(run->messages, VERBOSITY_DETAILS, "%s; it is tried again",
               result->message ? result->message : item->name);
    return FACET_OK;
}

/* ---- starting ---- */

/* Threads of an item that runs beside others; the last items share what is free. */
static uint32_t thread_share(const batch_run *run)
{
    const batch_progress *p = &run->progress;
    uint64_t others = run->plan->job_count;
    if (p->total != UINT64_MAX) {
        uint64_t ended = p->done + p->kept + p->failed;
        uint64_t left = p->total > ended ? p->total - ended : 1;
        others = left < others ? left : others;
    }
    uint32_t share = (uint32_t)(run->plan->core_count / (others ? others : 1));
    return share ? share : 1;
}

static void add_limits(const batch_run *run, const batch_item *item, job_words *w)
{
    uint32_t threads = item->is_alone ? run->plan->core_count / 2 : thread_share(run);
    uint64_t bytes = item->is_alone ? run->plan->alone_bytes : run->plan->max_memory_bytes;
    if (option_find_id(item->verb, OPT_THREADS) && (item->is_alone || !item->has_threads))
        job_words_addf(w, "--threads=%u", threads ? threads : 1u);
    if (option_find_id(item->verb, OPT_MAX_MEMORY) && !item->has_memory)
        job_words_addf(w, "--max-memory=%" PRIu64, bytes);
    if (item->has_metadata)
        job_words_addf(w, "--tag=%s", item->hash);
}

/* Prints the command of an item as words for a shell. */
static facet_result print_command(batch_run *run, batch_item *item, const job_words *w, facet_error *error)
{
    shell_line line = {.text = NULL};
    shell_line_add_word(&line, "facet");
    for (size_t i = 0; i < w->count; i++)
        shell_line_add_word(&line, w->words[i]);
    facet_result result = line.has_failed ? fail_memory(error, "a command", 0) : FACET_OK;
    if (result == FACET_OK)
        puts(line.text);
    free(line.text);
    run->progress.done++;
    batch_item_destroy(item);
    return result;
}

/* Starts the job of an item. */
static facet_result start(batch_run *run, batch_item *item, facet_error *error)
{
    job_words w = {.words = NULL};
    job_words_add_all(&w, (const char *const *)item->words.words);
    add_limits(run, item, &w);
    if (run->plan->is_dry && !w.has_failed) {
        facet_result printed = print_command(run, item, &w, error);
        job_words_destroy(&w);
        return printed;
    }
    const job_request request = {.words = (const char *const *)w.words,
                                 .name = item->name,
                                 .time_limit_s = item->time_limit_s,
                                 .max_memory_bytes = item->has_memory ? 0
                                                     : item->is_alone ? run->plan->alone_bytes
                                                                      : run->plan->max_memory_bytes,
                                 .user = item};
    facet_result result =
        w.has_failed ? fail_memory(error, item->name, 0) : job_pool_start(run->pool, &request, error);
    job_words_destroy(&w);
    if (result == FACET_OK) {
        run->start_failures = 0;
        run->running_alone = item->is_alone ? item : NULL;
        return FACET_OK;
    }
    item->due = interrupt_clock() + 1.0; /* the system may have a process for it then */
    append(&run->later, item);
    bool is_hopeless = result == FACET_ERROR_UNSUPPORTED || ++run->start_failures > MAX_START_FAILURES;
    return is_hopeless && !job_pool_running(run->pool) ? result : FACET_OK;
}

/* Writes the name of an output without "./" and double slashes, so that notations of one file are equal. */
static void simplify(const char *output, char name[BATCH_NAME_SIZE])
{
    size_t length = 0;
    for (const char *at = output; *at && length + 1 < BATCH_NAME_SIZE; at++) {
        bool is_first = at == output || at[-1] == '/';
        if (is_first && at[0] == '.' && at[1] == '/')
            at++;
        else if (at == output || *at != '/' || !is_first)
            name[length++] = *at;
    }
    name[length] = '\0';
}

/* Whether an item of the source has nothing to run: it is wrong, or an earlier run has done it; it is then recorded. */
static facet_result check(batch_run *run, batch_item **item, facet_error *error)
{
    batch_item *i = *item;
    char name[BATCH_NAME_SIZE] = "";
    simplify(i->output ? i->output : "", name);
    const uint64_t *other = *name && !i->problem ? batch_map_find(&run->outputs, name) : NULL;
    char text[BATCH_NAME_SIZE + 600];
    if (other && *other != i->number) {
        snprintf(text, sizeof text, "%s: its output %s is that of item %" PRIu64 " as well",
                 i->place ? i->place : i->name, i->output, *other + 1);
        i->problem = strdup(text);
    }
    if (i->problem) {
        *item = NULL;
        return record_problem(run, i, error);
    }
    if (*name && !batch_map_set(&run->outputs, name, i->number))
        return fail_memory(error, "names of outputs", 0);
    if (i->output && !run->plan->is_dry)
        batch_leftovers_remove(&run->leftovers, i->output);
    if (run->plan->resume == RESUME_NOTHING || !batch_is_done(&run->history, i))
        return FACET_OK;
    *item = NULL;
    return record_kept(run, i, error);
}

/* The next item to start beside others; NULL: none now. */
static facet_result find_item(batch_run *run, batch_item **item, facet_error *error)
{
    *item = take_due(&run->later);
    while (!*item && !run->is_at_end && !interrupt_signal()) {
        batch_next next = batch_source_next(run->source, item, error);
        if (next == NEXT_FAILED)
            return error->result;
        run->is_at_end = next == NEXT_END;
        run->is_waiting = next == NEXT_LATER;
        if (!*item)
            return FACET_OK;
        TRY(check(run, item, error));
    }
    return FACET_OK;
}

/* Whether items that are to run alone are next: there are no others, or many of them. */
static bool is_time_for_alone(const batch_run *run)
{
    bool has_others = run->later || !(run->is_at_end || run->is_waiting);
    return run->alone && (!has_others || run->alone_count >= MAX_ALONE);
}

static facet_result start_items(batch_run *run, facet_error *error)
{
    while (!is_stopping(run) && !run->is_suspect && !run->running_alone && job_pool_has_slot(run->pool)) {
        batch_item *item = NULL;
        if (!is_time_for_alone(run))
            TRY(find_item(run, &item, error));
        if (!item && is_time_for_alone(run) && !job_pool_running(run->pool)) {
            item = take_first(&run->alone);
            run->alone_count--;
        }
        if (!item)
            return FACET_OK;
        TRY(start(run, item, error));
    }
    return FACET_OK;
}

/* ---- waiting ---- */

/* Until the next item is due to be tried again, at most a second, in which progress is shown. */
static double wait_time(const batch_run *run)
{
    double now = interrupt_clock(), wait = 1.0;
    bool can_start = job_pool_has_slot(run->pool) && !run->running_alone && !is_stopping(run);
    for (const batch_item *item = can_start ? run->later : NULL; item; item = item->next)
        wait = item->due - now < wait ? item->due - now : wait;
    return wait > 0.0 ? wait : 0.0;
}

static facet_result wait_for_result(batch_run *run, facet_error *error)
{
    job_result result = {.user = NULL};
    bool polls = run->is_waiting && job_pool_has_slot(run->pool) && !is_stopping(run);
    struct pollfd input = {.fd = batch_source_descriptor(run->source), .events = POLLIN};
    bool has_ended = job_pool_wait(run->pool, &input, polls ? 1 : 0, wait_time(run), &result);
    facet_result written = has_ended ? receive(run, result.user, &result, error) : FACET_OK;
    job_result_destroy(&result);
    run->progress.running = job_pool_running(run->pool);
    batch_progress_show(&run->progress, NULL, false);
    return written;
}

/* After a signal no item is started, and what runs has a while to end. */
static void check_signal(batch_run *run)
{
    if (interrupt_signal() && !is_stopping(run)) {
        run->stop_time = interrupt_clock();
        if (job_pool_running(run->pool))
            message_at(run->messages, VERBOSITY_NORMAL, "batch: it stops after the %u items that run",
                       job_pool_running(run->pool));
    }
    if (run->is_suspect || (is_stopping(run) && interrupt_clock() > run->stop_time + stop_grace_s))
        job_pool_cancel_all(run->pool);
}

static bool has_work(const batch_run *run)
{
    if (job_pool_running(run->pool))
        return true;
    return !is_stopping(run) && !run->is_suspect && (!run->is_at_end || run->later || run->alone);
}

facet_result batch_run_all(batch_run *run, facet_error *error)
{
    facet_result result = FACET_OK;
    run->pool = job_pool_create(run->plan->job_count);
    if (!run->pool)
        return fail_memory(error, "jobs", 0);
    run->progress.start = interrupt_clock();
    while (result == FACET_OK && has_work(run)) {
        check_signal(run);
        result = start_items(run, error);
        if (result == FACET_OK && has_work(run))
            result = wait_for_result(run, error);
    }
    batch_progress_show(&run->progress, NULL, true);
    progress_clear();
    if (result == FACET_OK && run->is_suspect)
        return fail(error, FACET_ERROR_CANCELLED,
                    "batch: three items in a row failed as if by this machine; run the rest again with "
                    "--resume, perhaps "
                    "elsewhere. The last: %s",
                    run->reason);
    if (result == FACET_OK && is_stopping(run))
        return fail(error, FACET_ERROR_CANCELLED, "batch: interrupted; --resume continues");
    return result;
}

void batch_run_destroy(batch_run *run)
{
    while (run->pool && job_pool_running(run->pool)) { /* after a failure of the batch itself */
        job_result result = {.user = NULL};
        job_pool_cancel_all(run->pool);
        if (job_pool_wait(run->pool, NULL, 0, 1.0, &result))
            batch_item_destroy(result.user);
        job_result_destroy(&result);
    }
    job_pool_destroy(run->pool);
    for (batch_item *item; (item = take_first(&run->later));)
        batch_item_destroy(item);
    for (batch_item *item; (item = take_first(&run->alone));)
        batch_item_destroy(item);
    batch_source_close(run->source);
    batch_lines_close(&run->results);
    batch_lines_close(&run->failed);
    batch_map_destroy(&run->history);
    batch_map_destroy(&run->outputs);
    batch_leftovers_destroy(&run->leftovers);
}
