/* jobs_absent.c - WebAssembly has no processes: a job (src/cli/jobs) fails with FACET_ERROR_UNSUPPORTED, and so does facet
 * serve, which also lacks sockets. Counterpart of job_child.c and src/cli/serve. */
#include "base/result.h"
#include "cli/jobs/job_child.h"
#include "cli/shared/failure.h"
#include "cli/shared/messages.h"
#include "cli/shared/options.h"

int cmd_serve(struct command_line *c)
{
    (void)c;
    message_error("serve: WebAssembly has no processes for requests");
    return EXIT_UNSUPPORTED;
}

facet_result job_child_start(const job_request *job, job_child *child, facet_error *error)
{
    *child = (job_child){-1, -1, -1, -1};
    return fail(error, FACET_ERROR_UNSUPPORTED, "%s: WebAssembly has no processes for jobs", job->name);
}

void job_child_signal(const job_child *child, int number)
{
    (void)child, (void)number;
}

void job_child_finish(job_child *child, job_result *result)
{
    (void)child, (void)result;
}
