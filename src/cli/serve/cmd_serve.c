/* cmd_serve.c - facet serve: reads the options, prepares what requests share, and runs the loop of all clients. */
#define _GNU_SOURCE
#include "cli/jobs/job_warm.h"
#include "cli/serve/http.h"
#include "cli/serve/line_clients.h"
#include "cli/shared/command_line.h"
#include "cli/shared/environment_input.h"
#include "cli/shared/failure.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/limits.h"
#include "cli/shared/messages.h"
#include "cli/shared/value.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* {0}, with line. */
typedef struct serve_run {
    const command_line *line;
    messages messages;
    server_settings settings;
    server *server;
    line_clients lines;
    http *http;
    poll_set set;
    bool has_stdio; /* --stdio or --mcp */
    int signals_seen;
    double idle_since; /* interrupt_clock(); while the server stops and only clients are waited for; 0: not */
} serve_run;

/* ---- signals ---- */

/* The pipe that wakes the loop. */
static int signal_pipe[2] = {-1, -1};

static void on_signal(int number)
{
    int code = errno;
    const char byte = (char)number;
    ssize_t n = write(signal_pipe[1], &byte, 1);
    (void)n;
    errno = code;
}

static facet_result watch_signals(facet_error *error)
{
    static const int numbers[] = {SIGTERM, SIGINT, SIGHUP};
    if (pipe2(signal_pipe, O_CLOEXEC | O_NONBLOCK) != 0)
        return fail(error, FACET_ERROR_SYSTEM, "serve: %s", strerror(errno));
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        sigaction(numbers[i], &(struct sigaction){.sa_handler = on_signal, .sa_flags = SA_RESTART}, NULL);
    sigaction(SIGPIPE, &(struct sigaction){.sa_handler = SIG_IGN}, NULL);
    return FACET_OK;
}

/* Opens standard streams that are closed, so that nothing else becomes standard input or output. */
static facet_result open_standard_streams(facet_error *error)
{
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; fd++)
        if (fcntl(fd, F_GETFD) < 0 && open("/dev/null", O_RDWR) < 0)
            return fail(error, FACET_ERROR_SYSTEM, "serve: /dev/null: %s", strerror(errno));
    return FACET_OK;
}

/* ---- options ---- */

static facet_result read_ways(const command_line *c, facet_error *error)
{
    bool is_any =
        is_given(c, OPT_STDIO) || is_given(c, OPT_MCP) || is_given(c, OPT_SOCKET) || is_given(c, OPT_HTTP);
    if (!is_any)
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "serve: for whom? --stdio, --socket PATH, --http PORT or --mcp; facet help serve has examples");
    if (is_given(c, OPT_STDIO) && is_given(c, OPT_MCP))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "serve: --stdio and --mcp both need standard input; give one of them");
    return FACET_OK;
}

static facet_result read_limits(serve_run *run, facet_error *error)
{
    const command_line *c = run->line;
    server_settings *s = &run->settings;
    request_limits *l = &s->limits;
    limits common;
    TRY(limits_read(c, &common, error));
    l->max_threads = facet_thread_count();
    s->worker_count = (unsigned)option_number(c, OPT_JOBS, l->max_threads);
    l->time_limit_s = common.time_limit_s > 0.0 ? common.time_limit_s : 60.0;
    l->max_memory_bytes = common.max_memory_bytes;
    if (!is_given(c, OPT_MAX_MEMORY))
        l->max_memory_bytes /= s->worker_count;
    if (!l->max_memory_bytes)
        return option_fail(c, OPT_MAX_MEMORY, "a size such as 512M or 2G", error);
    l->max_texture_size = common.max_texture_size;
    s->queue_limit = (size_t)option_number(c, OPT_QUEUE, 64.0);
    l->max_body_bytes = (uint64_t)64 << 20;
    if (is_given(c, OPT_MAX_BODY) && (!value_bytes(option_text(c, OPT_MAX_BODY, ""), &l->max_body_bytes) ||
                                      l->max_body_bytes < 1024 || l->max_body_bytes > (uint64_t)4 << 30))
        return option_fail(c, OPT_MAX_BODY, "a size from 1K to 4G", error);
    s->client_timeout_s = 30.0;
    s->messages = &run->messages;
    if (is_given(c, OPT_CLIENT_TIMEOUT) &&
        !value_seconds(option_text(c, OPT_CLIENT_TIMEOUT, ""), &s->client_timeout_s))
        return option_fail(c, OPT_CLIENT_TIMEOUT, "a time such as 30s, 500ms or 5m", error);
    return FACET_OK;
}

/* ---- preparation ---- */

/* Prepares an environment that requests share, by the words that they will have. */
static facet_result warm(const char *env, facet_error *error)
{
    job_words words = {0};
    job_words_add(&words, "render");
    job_words_addf(&words, "--env=%s", env);
    facet_result result = job_warm(&words, error);
    job_words_destroy(&words);
    return result;
}

static facet_result warm_all(serve_run *run, facet_error *error)
{
    const char *env = option_text(run->line, OPT_ENV, NULL);
    char path[ROOT_PATH_SIZE];
    answer refusal = {0};
    TRY(warm("neutral", error));
    if (!env)
        return FACET_OK;
    if (!request_find_environment(&run->settings.limits.root, "--env", env, ENVIRONMENT_TAKES_NONE, path,
                                  &refusal))
        return fail(error, refusal.kind == ANSWER_USAGE ? FACET_ERROR_ARGUMENT : FACET_ERROR_READ, "%s",
                    refusal.message);
    return warm(path, error);
}

static facet_result listen_http(serve_run *run, facet_error *error)
{
    http_address address;
    TRY(http_listen(option_text(run->line, OPT_HTTP, ""), &address, error));
    facet_result result = http_create(run->server, &address, &run->http, error);
    if (result != FACET_OK) {
        close(address.fd);
        return result;
    }
    message_at(&run->messages, VERBOSITY_NORMAL, "facet: serving at http://%s/", address.name);
    if (!address.is_loopback)
        message_at(&run->messages, VERBOSITY_NORMAL,
                   "facet: %s is reached from other machines, and this server has no access control",
                   address.name);
    return FACET_OK;
}

/* Opens all ways in. The socket's path is relative to the folder where the command was started. */
static facet_result open_ways(serve_run *run, facet_error *error)
{
    const command_line *c = run->line;
    if (is_given(c, OPT_SOCKET)) {
        TRY(unix_socket_open(&run->lines.listener, option_text(c, OPT_SOCKET, ""), error));
        message_at(&run->messages, VERBOSITY_NORMAL, "facet: serving at %s", run->lines.listener.path);
    }
    TRY(root_enter(option_text(c, OPT_ROOT, "."), &run->settings.limits.root, error));
    TRY(warm_all(run, error));
    run->server = server_create(&run->settings);
    if (!run->server)
        return fail_memory(error, "a server", 0);
    run->lines.server = run->server;
    run->has_stdio = is_given(c, OPT_STDIO) || is_given(c, OPT_MCP);
    if (run->has_stdio)
        TRY(line_clients_add_stdio(&run->lines, is_given(c, OPT_MCP) ? &mcp_protocol : &rpc_protocol, error));
    return is_given(c, OPT_HTTP) ? listen_http(run, error) : FACET_OK;
}

/* ---- the loop ---- */

/* The first signal lets jobs end, the second ends them. */
static void take_signals(serve_run *run)
{
    char bytes[16];
    ssize_t n = read(signal_pipe[0], bytes, sizeof bytes);
    if (n <= 0)
        return;
    run->signals_seen += (int)n;
    if (run->signals_seen > 1)
        server_cancel_all(run->server);
    if (server_is_stopping(run->server))
        return;
    message_at(&run->messages, VERBOSITY_NORMAL,
               "facet: stopping: %u requests run on, %zu that wait are refused", server_running(run->server),
               server_queue_depth(run->server));
    server_stop(run->server);
    unix_socket_close(&run->lines.listener);
    if (run->http)
        http_stop(run->http);
}

/* Whether the last answer is sent, or its reader has had time enough. */
static bool is_over(serve_run *run)
{
    bool has_listener = run->lines.listener.fd >= 0 || run->http;
    if (run->has_stdio && !run->lines.has_stdio && !has_listener)
        return true; /* the client of standard input has what it asked for, or has gone */
    if (!server_is_stopping(run->server) || !server_is_idle(run->server))
        return false;
    if (!line_clients_have_output(&run->lines) && !(run->http && http_has_output(run->http)))
        return true;
    if (run->idle_since <= 0.0)
        run->idle_since = interrupt_clock();
    return interrupt_clock() > run->idle_since + run->settings.client_timeout_s;
}

static void run_loop(serve_run *run)
{
    poll_set *set = &run->set;
    while (!is_over(run)) {
        poll_set_clear(set, interrupt_clock() + (server_is_stopping(run->server) ? 0.1 : 3600.0));
        long entry = poll_set_add(set, signal_pipe[0], POLLIN);
        line_clients_prepare(&run->lines, set);
        if (run->http)
            http_prepare(run->http, set);
        server_turn(run->server, set);
        if (poll_set_events(set, entry))
            take_signals(run);
        line_clients_handle(&run->lines, set);
        if (run->http)
            http_handle(run->http, set);
    }
}

static facet_result serve(serve_run *run, facet_error *error)
{
    TRY(read_ways(run->line, error));
    TRY(read_limits(run, error));
    TRY(open_standard_streams(error));
    TRY(watch_signals(error));
    TRY(open_ways(run, error));
    run_loop(run);
    return FACET_OK;
}

int cmd_serve(command_line *c)
{
    facet_error error;
    serve_run run = {
        .line = c, .lines = {.listener = {.fd = -1}}, .messages = {.verbosity = messages_verbosity(c)}};
    facet_result result = serve(&run, &error);
    if (result != FACET_OK)
        message_error("%s%s", error.message[0] == '-' ? "facet: " : "", error.message);
    line_clients_destroy(&run.lines);
    if (run.http)
        http_destroy(run.http);
    server_destroy(run.server);
    poll_set_destroy(&run.set);
    messages_clear(&run.messages);
    for (int i = 0; i < 2 && signal_pipe[0] >= 0; i++)
        close(signal_pipe[i]);
    return exit_code_of(result);
}
