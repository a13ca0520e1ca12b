/* batch_policy.c - see batch_policy.h. */
#include "cli/batch/batch_policy.h"

#include "cli/shared/failure.h"

static const double waits_s[] = {1.0, 4.0, 16.0};
enum { WAIT_COUNT = sizeof waits_s / sizeof *waits_s };

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
        if (item->tries > WAIT_COUNT)
            return ANSWER_FAILED;
        *wait_s = waits_s[item->tries - 1];
        return ANSWER_LATER;
    default:
        return ANSWER_FAILED;
    }
}

bool batch_is_machine_failure(const job_result *result)
{
    return result->end == JOB_KILLED ||
           (result->end == JOB_EXITED && (result->exit_code == EXIT_READ || result->exit_code == EXIT_WRITE ||
                                          result->exit_code == EXIT_ENVIRONMENT));
}

bool batch_is_for_others(int exit_code)
{
    return exit_code == EXIT_READ || exit_code == EXIT_WRITE || exit_code == EXIT_ENVIRONMENT ||
           exit_code == EXIT_AGAIN;
}
