/* command.c - see command.h. */
#include "cli/command.h"

#include "cli/help/help.h"
#include "cli/shared/command_line.h"
#include "cli/shared/options.h"
#include "cli/shared/failure.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/messages.h"
#include "cli/shared/output.h"
#include "cli/shared/suggest.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

static const struct {
    const char *name;
    int (*run)(command_line *c);
} commands[] = {
#define VERB(name) {#name, cmd_##name},
#include "cli/shared/verbs.def"
#undef VERB
};

/* Whether the word in place of the verb is a file. */
static bool looks_like_file(const char *word)
{
    return strchr(word, '.') || strchr(word, '/') || output_exists(word);
}

/* Whether the word is an environment instead of a model. */
static bool looks_like_light(const char *word)
{
    static const char *const extensions[] = {"hdr", "exr", "ktx2", "pfm"};
    const char *dot = strrchr(word, '.');
    for (size_t i = 0; dot && i < sizeof extensions / sizeof *extensions; i++)
        if (strcasecmp(dot + 1, extensions[i]) == 0)
            return true;
    return false;
}

/* Whether the words contain --json, before they are parsed. */
static bool wants_json(int argc, char **argv)
{
    for (int i = 0; i < argc && strcmp(argv[i], "--") != 0; i++)
        if (strcmp(argv[i], "--json") == 0)
            return true;
    return false;
}

/* Reports a wrong command line, with --json also on standard output. Returns the exit code. */
static int refuse(int argc, char **argv, const facet_error *error)
{
    int exit_code = exit_code_of(error->result);
    message_error("facet: %s", error->message);
    if (wants_json(argc, argv))
        report_print_failure_json(error, exit_code);
    return exit_code;
}

/* Explains a first word that is not a verb. */
static int explain_verb(const char *word, int argc, char **argv)
{
    const char *near = suggest_verb(word);
    facet_error error;
    if (word[0] == '-') {
        fail(&error, FACET_ERROR_ARGUMENT,
             "the command comes first, as in facet render %.300s; facet help lists the commands", word);
    } else if (looks_like_file(word)) {
        char stem[256];
        if (!output_name_stem(word, stem, sizeof stem))
            memcpy(stem, "model", 6);
        if (looks_like_light(word))
            fail(&error, FACET_ERROR_ARGUMENT,
                 "which command? To filter it for real-time renderers: facet bake %.300s -o %s.ktx2; to "
                 "light a model with it: facet render model.glb --env %.300s",
                 word, stem, word);
        else
            fail(&error, FACET_ERROR_ARGUMENT,
                 "which command? For an image: facet render %.300s -o %s.png; to see what is in it: "
                 "facet inspect %.300s",
                 word, stem, word);
    } else {
        fail(&error, FACET_ERROR_ARGUMENT, "there is no command \"%.300s\"%s%s%s", word,
             near ? "; did you mean " : "", near ? near : "; facet help lists the commands", near ? "?" : "");
    }
    return refuse(argc, argv, &error);
}

/* Hidden options of the build: man pages and completions. */
static int generate(const char *what, const char *name)
{
    const verb *v = verb_find(name);
    if (strcmp(what, "--generate-completion") == 0 && completion_print(stdout, name))
        return EXIT_DONE;
    if (strcmp(what, "--generate-man") == 0 && (v || strcmp(name, "facet") == 0)) {
        man_page_print(stdout, v, facet_version());
        return EXIT_DONE;
    }
    message_error("facet: %s: \"%s\" is unknown", what, name);
    return EXIT_USAGE;
}

static int run_verb(const verb *v, int argc, char **argv)
{
    command_line line;
    facet_error error;
    int exit_code = EXIT_BUG;
    facet_result result = command_line_parse(v, argc, argv, &line, &error);
    if (result != FACET_OK) {
        exit_code = refuse(option_find_id(v, OPT_JSON) ? argc : 0, argv, &error);
    } else if (is_given(&line, OPT_HELP) ||
               (is_given(&line, OPT_HELP_ALL) && (v != verb_find("help") || !line.argument_count))) {
        help_print_verb(stdout, v, is_given(&line, OPT_HELP_ALL));
        exit_code = EXIT_DONE;
    } else {
        if (strcmp(v->name, "view") != 0) /* the window handles signals itself */
            interrupt_install(is_given(&line, OPT_JSON));
        for (size_t i = 0; i < sizeof commands / sizeof *commands; i++)
            if (strcmp(commands[i].name, v->name) == 0)
                exit_code = commands[i].run(&line);
    }
    command_line_destroy(&line);
    return exit_code;
}

static int run(int argc, char **argv)
{
    if (argc < 2) {
        help_print_overview(stderr);
        return EXIT_USAGE;
    }
    const char *word = argv[1];
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0)
        word = "help";
    else if (strcmp(word, "--version") == 0 || strcmp(word, "-V") == 0)
        word = "version";
    if (argc == 3 && strncmp(word, "--generate-", 11) == 0)
        return generate(word, argv[2]);
    const verb *v = verb_find(word);
    if (v && v == verb_find("help") && argc > 2 && strncmp(argv[2], "--", 2) == 0 &&
        !option_find(v, argv[2] + 2, strcspn(argv[2] + 2, "=")))
        argv[2] += 2; /* facet help --orbit */
    return v ? run_verb(v, argc - 2, argv + 2) : explain_verb(word, argc - 2, argv + 2);
}

int command_run(int argc, char **argv)
{
    int exit_code = run(argc, argv);
    facet_error error;
    bool is_written = output_close_stdout(&error) == FACET_OK;
    if (!is_written && interrupt_signal()) /* the reader has gone */
        return interrupt_exit();
    if (!is_written && exit_code != EXIT_WRITE) { /* already reported */
        message_error("%s", error.message);
        if (exit_code == EXIT_DONE)
            exit_code = EXIT_WRITE;
    }
    return exit_code;
}
