/* serve_verb.c - the options and the help of facet serve. */
#include "cli/shared/options.h"

const verb serve_verb = {
    .name = "serve",
    .summary = "render for programs, agents and web servers",
    .arguments = "",
    .description =
        "Answers requests until it is stopped: render, inspect, convert, compare and bake, with the long "
        "options of "
        "these commands as parameters. Environment and tables are prepared once; each request runs in a "
        "process of "
        "its own, so that a crash, a hang or the memory of one affects no other.\n\n"
        "--stdio and --socket speak JSON-RPC 2.0, one message a line; --http has GET "
        "/render?model=a.glb&size=256, "
        "POST /render with the model as body, /health and /metrics; --mcp is a server of the Model Context "
        "Protocol for agents. Requests read and write below the folder of --root only. SIGTERM and SIGINT "
        "let "
        "what runs end, and refuse what waits. serve.md of facet help documents has the protocols.",
    .examples =
        (const example[]){
            {"facet serve --http 8080 --root models/",
             "http://127.0.0.1:8080/render?model=chair.glb&size=256"},
            {"facet serve --socket /run/facet.sock --root /srv/models -j 4",
             "for a web application, 4 at a time"},
            {"facet serve --stdio", "for a program that starts it; paths below the current folder"},
            {"facet serve --mcp --root ~/models", "as the command of an MCP server, for agents"},
            {"facet serve --http 8080 --time-limit 5s --max-memory 1G --max-body 20M --queue 16",
             "for models from strangers"},
            {NULL, NULL}},
    .groups =
        (const option_group *const[]){
            OPTION_GROUP("Ways in", OPT_STDIO, OPT_SOCKET, OPT_HTTP, OPT_MCP),
            OPTION_GROUP("Files", OPT_ROOT, OPT_ENV),
            OPTION_GROUP("Limits", OPT_JOBS, OPT_QUEUE, OPT_TIME_LIMIT, OPT_MAX_MEMORY, OPT_MAX_TEXTURE,
                         OPT_MAX_BODY, OPT_CLIENT_TIMEOUT),
            OPTION_GROUP("Messages", OPT_QUIET, OPT_VERBOSE, OPT_HELP, OPT_HELP_ALL), NULL},
};
