/* batch_policy.c - see batch_policy.h. */
#include "cli/batch/batch_policy.h"

#include "cli/shared/failure.h"

#include <dirent.h>
#include <string.h>

static const double waits_s[] = {1.0, 4.0, 16.0};
enum { WAIT_COUNT = sizeof waits_s / sizeof *waits_s };

/* Whether this process can list the folder of a file. */
static bool can_list_folder_of(const char *path)
{
    char folder[BATCH_NAME_SIZE] = ".";
    const char *slash = strrchr(path, '/');
    size_t length = slash ? (size_t)(slash - path) + 1 : 0;
    if (length >= sizeof folder)
        return false;
    if (length) {
        memcpy(folder, path, length);
        folder[length] = '\0';
    }
    DIR *listing = opendir(folder);
    bool has_entry = listing && readdir(listing);
    if (listing)
        closedir(listing);
    return has_entry;
}

/* Whether reading failed for lack of a file of the model, rather than of the disk or the network that it is on. */
static bool lacks_file(const batch_item *item, int exit_code)
{
    return exit_code == EXIT_READ && can_list_folder_of(item->name);
}

batch_answer batch_answer_to(const batch_item *item, const job_result *result, double *wait_s)
{
    *wait_s = 0.0;
    if (result->end != JOB_EXITED) /* a crash, a hang, lack of memory */
        return item->is_alone ? ANSWER_FAILED : ANSWER_ALONE;
    switch (result->exit_code) {
    case EXIT_DONE:
        return ANSWER_DONE;
    case EXIT_LIMIT:
    case EXIT_BUG:
        return item->is_alone ? ANSWER_FAILED : ANSWER_ALONE;
    case EXIT_READ:
    case EXIT_WRITE:
    case EXIT_AGAIN:
        if (item->tries > (lacks_file(item, result->exit_code) ? 1 : WAIT_COUNT))
            return ANSWER_FAILED;
        *wait_s = waits_s[item->tries - 1];
        return ANSWER_LATER;
    default:
        return ANSWER_FAILED;
    }
}

bool batch_is_machine_failure(const batch_item *item, const job_result *result)
{
    if (result->end != JOB_EXITED)
        return result->end == JOB_KILLED;
    return result->exit_code != EXIT_AGAIN && batch_is_for_others(item, result->exit_code);
}

bool batch_is_for_others(const batch_item *item, int exit_code)
{
    switch (exit_code) {
    case EXIT_READ:
        return !lacks_file(item, exit_code);
    case EXIT_WRITE:
    case EXIT_ENVIRONMENT:
    case EXIT_AGAIN:
        return true;
    default:
        return false;
    }
}
