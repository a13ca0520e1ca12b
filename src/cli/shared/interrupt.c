/* interrupt.c - signals and the time limit. */
#define _DEFAULT_SOURCE
#include "cli/shared/interrupt.h"

#include "cli/shared/failure.h"

#include <jansson.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static const char OVER_BAR[] = "\r\033[K"; /* clears a progress bar */

/* State shared with the signal handlers, the only global state. */
static atomic_int pending_signal;          /* lock-free: written by the handler, read by all threads */
static _Atomic(const char *) safe_message; /* NULL: no section is open; renderer threads close it, too */
static int open_file_count;
static volatile double deadline;      /* in interrupt_clock() time; 0: none */
static volatile double signal_time;   /* of pending_signal, in interrupt_clock() time */
static volatile double section_grace; /* time for the open section to end by itself, s */
static bool is_installed;             /* the handlers are installed */
static bool has_json;                 /* the end is reported as JSON, too */
static char json_at_deadline[4096];

double interrupt_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void end_by(int number)
{
    signal(number, SIG_DFL);
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, number);
    raise(number);
    sigprocmask(SIG_UNBLOCK, &set, NULL);
    _exit(128 + number);
}

/* Ends the process if a section is open: by the signal, or at the time limit. */
static void end_section(void)
{
    const char *message = safe_message;
    double now = interrupt_clock();
    if (!message)
        return;
    if (pending_signal && now >= signal_time + section_grace) {
        if (pending_signal == SIGTERM)
            _exit(EXIT_AGAIN);
        end_by(pending_signal);
    }
    if (!(deadline > 0.0) || now < deadline + section_grace)
        return;
    ssize_t ignored = write(STDERR_FILENO, message, strlen(message));
    ignored = write(STDOUT_FILENO, json_at_deadline, strlen(json_at_deadline));
    (void)ignored;
    _exit(EXIT_LIMIT);
}

static void on_tick(int number)
{
    (void)number;
    end_section();
}

/* Schedules on_tick() after delay_s and then every 50 ms: the first tick may come outside of a section. */
static void start_ticks(double delay_s)
{
    struct itimerval timer = {{0, 50000}, {0, 0}};
    timer.it_value.tv_sec = (time_t)delay_s;
    timer.it_value.tv_usec = (suseconds_t)((delay_s - (double)(time_t)delay_s) * 1e6) + 1;
    setitimer(ITIMER_REAL, &timer, NULL);
}

static void on_stop(int number)
{
    signal_time = interrupt_clock();
    pending_signal = number;
    if (number == SIGINT)
        signal(SIGINT, SIG_DFL);
    end_section();
    if (safe_message)
        start_ticks(section_grace);
}

static void install(int number, void (*handler)(int))
{
    struct sigaction action = {.sa_handler = handler, .sa_flags = SA_RESTART};
    sigaction(number, &action, NULL);
}

/* Installs on_stop() unless the signal is ignored, as under nohup. */
static void install_stop(int number)
{
    struct sigaction before;
    if (sigaction(number, NULL, &before) == 0 && before.sa_handler == SIG_IGN)
        return;
    install(number, on_stop);
}

void interrupt_install(bool reports_json)
{
    is_installed = true;
    has_json = reports_json;
    install(SIGALRM, on_tick);
    install_stop(SIGINT);
    install_stop(SIGTERM);
    install_stop(SIGHUP);
    install_stop(SIGPIPE);    /* the reader of the messages may exit while a file is being written */
    signal(SIGXFSZ, SIG_IGN); /* a file beyond the user's limit is then a failed write, which cleans up */
}

void interrupt_reset(void)
{
    pending_signal = 0;
    safe_message = NULL;
    open_file_count = 0;
    deadline = 0.0;
    is_installed = false;
}

int interrupt_signal(void)
{
    return pending_signal;
}

void interrupt_set_deadline(double seconds)
{
    if (!is_installed)
        return;
    deadline = seconds > 0.0 ? interrupt_clock() + seconds : 0.0;
    if (seconds > 0.0) {
        start_ticks(seconds);
    } else {
        const struct itimerval none = {{0, 0}, {0, 0}};
        setitimer(ITIMER_REAL, &none, NULL);
    }
}

double interrupt_seconds_left(void)
{
    return deadline > 0.0 ? deadline - interrupt_clock() : 1e30;
}

/* Prepares the report of an end at the time limit, since a signal handler cannot format it. */
static void prepare_json(const char *message)
{
    facet_error error = {.result = FACET_ERROR_LIMIT};
    const char *sentence = message;
    if (strncmp(sentence, OVER_BAR, strlen(OVER_BAR)) == 0)
        sentence += strlen(OVER_BAR);
    snprintf(error.message, sizeof error.message, "%.*s", (int)strlen(sentence) - 1, sentence); /* no "\n" */
    json_t *root = json_pack("{s:s, s:[o], s:i}", "facet", facet_version(), "failures",
                             report_error_json(&error, NULL, EXIT_LIMIT), "exit_code", EXIT_LIMIT);
    json_at_deadline[0] = 0;
    size_t size = root ? json_dumpb(root, json_at_deadline, sizeof json_at_deadline - 2, 0) : 0;
    size = size < sizeof json_at_deadline - 1 ? size : 0;
    memcpy(json_at_deadline + size, "\n", size ? 2 : 0);
    json_decref(root);
}

void interrupt_end(void)
{
    safe_message = NULL;
}

void interrupt_file_begin(void)
{
    open_file_count++;
    interrupt_end();
}

void interrupt_file_end(void)
{
    open_file_count--;
}

static void begin(const char *name, const char *doing, bool has_bar, double grace)
{
    static char sentence[512];
    interrupt_end(); /* the handler must not print a half-written sentence */
    if (open_file_count)
        return;
    snprintf(sentence, sizeof sentence, "%s%.400s: the time limit (--time-limit) was reached while %s\n",
             has_bar ? OVER_BAR : "", name, doing);
    if (has_json)
        prepare_json(sentence);
    section_grace = grace;
    safe_message = sentence;
    if (pending_signal) /* the signal came before the section: its work is not started */
        exit(interrupt_exit());
}

void interrupt_begin(const char *name, const char *doing, bool has_bar)
{
    begin(name, doing, has_bar, 0.0);
}

void interrupt_begin_polling(const char *name, const char *doing, bool has_bar)
{
    begin(name, doing, has_bar, 0.3);
}

void interrupt_begin_reading(const char *name)
{
    interrupt_begin(name, "reading", false);
}

facet_result interrupt_check(const char *name, facet_error *error)
{
    if (pending_signal)
        return fail(error, FACET_ERROR_CANCELLED, "%s: interrupted", name);
    return interrupt_seconds_left() > 0.0
               ? FACET_OK
               : fail(error, FACET_ERROR_LIMIT, "%s: the time limit (--time-limit) was reached", name);
}

int interrupt_exit_code(void)
{
    int number = pending_signal;
    return number == SIGTERM || number == 0 ? EXIT_AGAIN : 128 + number;
}

int interrupt_exit(void)
{
    int exit_code = interrupt_exit_code();
    fflush(stdout);
    if (exit_code != EXIT_AGAIN)
        end_by(pending_signal);
    return exit_code;
}
