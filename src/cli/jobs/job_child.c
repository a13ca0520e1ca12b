/* job_child.c - see job_child.h. The child's standard streams are files in memory, which it can fill without a reader; its
 * output is a pipe, whose end also says that the child has ended. */
#define _GNU_SOURCE
#include "cli/jobs/job_child.h"

#include "cli/command.h"
#include "cli/shared/failure.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/options.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { OUTPUT_DESCRIPTOR = 3, MAX_LOG_BYTES = 64 << 10, MAX_REPORT_BYTES = 64 << 20 };

/* ---- the child ---- */

/* Addresses that a process of so much data needs besides: code, stacks, and what the parent shares. */
static const uint64_t fence_extra = (uint64_t)1 << 30;

static void set_limits(const job_request *job)
{
    const struct rlimit none = {0, 0};
    setrlimit(RLIMIT_CORE, &none); /* thousands of crashes must not fill the disk */
    if (job->max_memory_bytes && JOB_HAS_FENCE) {
        rlim_t bytes = (rlim_t)(job->max_memory_bytes + job->max_memory_bytes / 4 + fence_extra);
        const struct rlimit fence = {bytes, bytes};
        setrlimit(RLIMIT_DATA, &fence);
    }
    /* where the machine runs out of memory the kernel shall choose a child */
    int file = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
    ssize_t ignored = file >= 0 ? write(file, "500", 3) : 0;
    (void)ignored;
    if (file >= 0)
        close(file);
}

/* Copies the descriptors out of the way of those that they become. */
static bool move_away(const int descriptors[OUTPUT_DESCRIPTOR + 1], int moved[OUTPUT_DESCRIPTOR + 1])
{
    for (int i = 0; i <= OUTPUT_DESCRIPTOR; i++)
        if ((moved[i] = fcntl(descriptors[i], F_DUPFD_CLOEXEC, OUTPUT_DESCRIPTOR + 1)) < 0)
            return false;
    return true;
}

/* Closes what the child inherits of other jobs, where the system allows few descriptors. */
static void close_others(const int descriptors[OUTPUT_DESCRIPTOR + 1])
{
    for (int fd = 0; fd < 1024; fd++) {
        bool is_wanted = false;
        for (int i = 0; i <= OUTPUT_DESCRIPTOR; i++)
            is_wanted = is_wanted || descriptors[i] == fd;
        if (!is_wanted)
            close(fd);
    }
}

/* Makes descriptors[i] the descriptor i and closes all others. */
static bool place_descriptors(const int descriptors[OUTPUT_DESCRIPTOR + 1])
{
    int moved[OUTPUT_DESCRIPTOR + 1];
    if (!move_away(descriptors, moved)) {
        close_others(descriptors);
        if (!move_away(descriptors, moved))
            return false;
    }
    for (int i = 0; i <= OUTPUT_DESCRIPTOR; i++)
        if (dup2(moved[i], i) < 0)
            return false;
    if (close_range(OUTPUT_DESCRIPTOR + 1, ~0u, 0) != 0) /* Linux before 5.9 */
        for (int fd = OUTPUT_DESCRIPTOR + 1; fd < 1024; fd++)
            close(fd);
    return true;
}

/* Gives signals that have a handler their default effect. */
static void reset_signals(void)
{
    for (int number = 1; number < NSIG; number++) {
        struct sigaction now;
        if (sigaction(number, NULL, &now) == 0 && now.sa_handler != SIG_IGN && now.sa_handler != SIG_DFL)
            signal(number, SIG_DFL);
    }
    interrupt_reset();
}

/* Runs the verb. Does not return. */
static void run_child(const job_request *job, pid_t parent, const int descriptors[OUTPUT_DESCRIPTOR + 1])
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) /* it has ended meanwhile */
        _exit(EXIT_AGAIN);
    setpgid(0, 0); /* signals of the terminal are for the parent */
    if (!place_descriptors(descriptors)) {
        dprintf(descriptors[2], "%s: its process cannot be set up: %s\n",
                job->name ? job->name : job->words[0], strerror(errno));
        _exit(EXIT_ENVIRONMENT);
    }
    set_limits(job);
    size_t count = 0;
    while (job->words[count])
        count++;
    const char **words = calloc(count + 3, sizeof *words);
    const verb *v = verb_find(job->words[0]);
    if (!words || !v)
        _exit(EXIT_BUG);
    int argc = 0;
    words[argc++] = "facet";
    words[argc++] = job->words[0];
    if (option_find_id(v, OPT_JSON))
        words[argc++] = "--json";
    for (size_t i = 1; i < count; i++)
        words[argc++] = job->words[i];
    int exit_code = command_run(argc, (char **)(uintptr_t)words);
    fflush(NULL);
    _exit(exit_code);
}

/* ---- starting ---- */

/* Standard input of a child: a file in memory, at its beginning. Negative: see errno. */
static int open_input(const job_request *job)
{
    if (!job->input)
        return open("/dev/null", O_RDONLY | O_CLOEXEC);
    int fd = memfd_create("facet-input", MFD_CLOEXEC);
    const char *bytes = job->input;
    for (size_t done = 0; fd >= 0 && done < job->input_size;) {
        ssize_t n = write(fd, bytes + done, job->input_size - done);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0) {
            close(fd);
            return -1;
        }
        done += (size_t)n;
    }
    if (fd >= 0)
        lseek(fd, 0, SEEK_SET);
    return fd;
}

static void close_all(const int *descriptors, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (descriptors[i] >= 0)
            close(descriptors[i]);
}

/* Forks with all signals blocked, so that the child does not run the handlers of this process. */
static pid_t fork_child(const job_request *job, const int descriptors[OUTPUT_DESCRIPTOR + 1])
{
    sigset_t all, before;
    sigfillset(&all);
    fflush(NULL); /* else the child would write the same text again */
    sigprocmask(SIG_SETMASK, &all, &before);
    pid_t parent = getpid(), process = fork();
    if (process == 0) {
        reset_signals();
        sigprocmask(SIG_SETMASK, &before, NULL);
        run_child(job, parent, descriptors);
    }
    int code = errno;
    sigprocmask(SIG_SETMASK, &before, NULL);
    errno = code;
    return process;
}

facet_result job_child_start(const job_request *job, job_child *child, facet_error *error)
{
    enum { IN, OUT, LOG, WRITER, READER, COUNT };
    int pipe_ends[2] = {-1, -1};
    int ends[COUNT] = {open_input(job), memfd_create("facet-out", MFD_CLOEXEC),
                       memfd_create("facet-log", MFD_CLOEXEC), -1, -1};
    bool has_pipe = pipe2(pipe_ends, O_CLOEXEC) == 0;
    ends[READER] = pipe_ends[0];
    ends[WRITER] = pipe_ends[1];
    child->process = -1;
    if (has_pipe && ends[IN] >= 0 && ends[OUT] >= 0 && ends[LOG] >= 0)
        child->process = fork_child(job, ends);
    if (child->process < 0) {
        facet_result result = fail(error, FACET_ERROR_SYSTEM, "%s: no process can be started for it: %s",
                                   job->name, strerror(errno));
        close_all(ends, COUNT);
        return result;
    }
    setpgid(child->process, child->process); /* by both, so that it holds for both at once */
    close(ends[IN]);
    close(ends[WRITER]);
    fcntl(ends[READER], F_SETFL, O_NONBLOCK);
    *child = (job_child){child->process, ends[READER], ends[OUT], ends[LOG]};
    return FACET_OK;
}

void job_child_signal(const job_child *child, int number)
{
    kill(-child->process, number);
    kill(child->process, number); /* also if it has no group of its own yet */
}

/* ---- the end ---- */

/* The bytes of a file in memory, at most limit, with a 0 behind them; NULL: empty, or no memory. */
static char *read_all(int fd, size_t limit, size_t *size)
{
    struct stat info;
    *size = 0;
    if (fstat(fd, &info) != 0 || info.st_size <= 0)
        return NULL;
    size_t length = (uint64_t)info.st_size < limit ? (size_t)info.st_size : limit;
    char *text = malloc(length + 1);
    while (text && *size < length) {
        ssize_t n = pread(fd, text + *size, length - *size, (off_t)*size);
        if (n <= 0)
            break;
        *size += (size_t)n;
    }
    if (text)
        text[*size] = 0;
    return text;
}

/* The sentence of the first failure in a report; NULL: none. */
static const char *first_failure(const json_t *report)
{
    const json_t *failure = json_array_get(json_object_get(report, "failures"), 0);
    return json_string_value(json_object_get(failure, "message"));
}

/* Why a child failed: one sentence. */
static char *find_message(const job_result *result)
{
    const char *sentence = first_failure(result->report);
    char *message = NULL;
    if (sentence)
        return strdup(sentence);
    const char *log = result->log ? result->log : "";
    if (!*log || *log == '\n')
        return NULL;
    if (asprintf(&message, "%.*s", (int)strcspn(log, "\n"), log) < 0)
        return NULL;
    return message;
}

void job_child_finish(job_child *child, job_result *result)
{
    int status = 0;
    struct rusage usage = {.ru_maxrss = 0};
    size_t size;
    while (wait4(child->process, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    result->signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    result->end = result->signal ? JOB_KILLED : JOB_EXITED;
    result->exit_code = result->signal ? 128 + result->signal : WEXITSTATUS(status);
    result->cpu_seconds = (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                          1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
    result->peak_memory_bytes = (uint64_t)usage.ru_maxrss * 1024; /* Linux counts in KiB */
    result->log = read_all(child->log, MAX_LOG_BYTES, &size);
    char *text = read_all(child->out, MAX_REPORT_BYTES, &size);
    result->report = text ? json_loadb(text, size, JSON_DISABLE_EOF_CHECK, NULL) : NULL;
    free(text);
    if (result->end == JOB_EXITED && result->exit_code != EXIT_DONE)
        result->message = find_message(result);
    close(child->out);
    close(child->log);
    close(child->output);
    *child = (job_child){-1, -1, -1, -1};
}
