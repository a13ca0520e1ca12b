/* generate.c - the table of options as man pages, man(7), and as completions for bash, zsh and fish. */

#include "cli/help/help.h"
#include "cli/shared/failure.h"
#include "cli/shared/options.h"

#include <ctype.h>
#include <string.h>

/* Prints text as roff: with escaped backslashes and dashes (a plain - may become a typographic hyphen,
 * which shells do not accept), and without a request at the start of a line. */
static void print_inline(FILE *stream, const char *text)
{
    bool is_line_start = true;
    for (; *text; text++) {
        if (is_line_start && (*text == '.' || *text == '\''))
            fputs("\\&", stream);
        if (*text == '\\')
            fputs("\\e", stream);
        else if (*text == '-')
            fputs("\\-", stream);
        else if (*text == '\'')
            fputs("\\(aq", stream);
        else if (*text == '^')
            fputs("\\(ha", stream);
        else if (*text == '~')
            fputs("\\(ti", stream);
        else if (*text == '\n' && text[1] == '\n')
            fputs("\n.PP", stream);
        else
            fputc(*text, stream);
        is_line_start = *text == '\n';
    }
}

static void print_text(FILE *stream, const char *text)
{
    print_inline(stream, text);
    fputc('\n', stream);
}

static void print_sentence(FILE *stream, const char *text)
{
    print_inline(stream, text);
    fputs(".\n", stream);
}

static void print_upper(FILE *stream, const char *text)
{
    for (; *text; text++)
        fputc(toupper((unsigned char)*text), stream);
}

/* Prints bold text within a line. */
static void print_bold(FILE *stream, const char *text)
{
    fputs("\\fB", stream);
    for (; *text; text++)
        fputs(*text == '-' ? "\\-" : *text == '\'' ? "\\(aq" : (char[]){*text, 0}, stream);
    fputs("\\fR", stream);
}

static void print_option(FILE *stream, const option *o)
{
    fputs(".TP\n", stream);
    if (o->letter)
        fprintf(stream, "\\fB\\-%c\\fR, ", o->letter);
    fputs("\\fB\\-\\-\\fR", stream);
    print_bold(stream, o->name);
    if (o->argument)
        fprintf(stream, " \\fI%s\\fR", o->argument);
    fputc('\n', stream);
    print_sentence(stream, o->help);
    if (o->kind == OPTION_CHOICE || o->kind == OPTION_CHOICES) {
        fputs(o->kind == OPTION_CHOICE ? "One of" : "Some of", stream);
        for (int i = 0; o->choices[i]; i++) {
            fputs(i ? ", " : " ", stream);
            print_bold(stream, o->choices[i]);
        }
        fputs(".\n", stream);
    }
    if (o->default_text) {
        fputs("Default: ", stream);
        print_sentence(stream, o->default_text);
    }
}

static void print_examples(FILE *stream, const example *e)
{
    fputs(".SH EXAMPLES\n", stream);
    for (; e->command; e++) {
        fputs(".TP\n", stream);
        print_bold(stream, e->command);
        fputc('\n', stream);
        print_text(stream, e->what);
    }
}

static void print_exit_status(FILE *stream)
{
    fputs(".SH EXIT STATUS\n", stream);
    for (const exit_meaning *e = exit_meanings; e->code; e++) {
        fprintf(stream, ".TP\n.B %s\n", e->code);
        print_text(stream, e->meaning);
    }
}

static void print_environment(FILE *stream)
{
    fputs(".SH ENVIRONMENT\n"
          ".TP\n.B NO_COLOR\nwhen set and not empty, messages have no color\n"
          ".TP\n.B COLUMNS\nthe width that help is wrapped to\n",
          stream);
}

static void print_see_also(FILE *stream, const verb *self)
{
    fputs(".SH SEE ALSO\n", stream);
    const char *separator = "";
    if (self) {
        fputs(".BR facet (1)", stream);
        separator = ",\n";
    }
    for (const verb *const *v = verbs; *v; v++) {
        if (*v == self)
            continue;
        fprintf(stream, "%s.BR facet\\-%s (1)", separator, (*v)->name);
        separator = ",\n";
    }
    fputc('\n', stream);
}

static void print_verb(FILE *stream, const verb *v)
{
    fputs(".SH NAME\nfacet\\-", stream);
    fprintf(stream, "%s \\- ", v->name);
    print_text(stream, v->summary);
    fprintf(stream, ".SH SYNOPSIS\n.B facet %s\n", v->name);
    if (*v->arguments)
        fprintf(stream, "\\fI%s\\fR\n", v->arguments);
    fputs("[\\fIoptions\\fR]\n.SH DESCRIPTION\n", stream);
    print_text(stream, v->description);
    print_examples(stream, v->examples);
    fputs(".SH OPTIONS\nOptions may stand before, between and behind the files; \\fB\\-\\-\\fR ends them.\n",
          stream);
    for (const option_group *const *g = v->groups; *g; g++) {
        fprintf(stream, ".SS %s\n", (*g)->title);
        for (const option_id *id = (*g)->ids; *id != OPTION_ID_COUNT; id++)
            print_option(stream, option_find_id(v, *id));
    }
}

static void print_overview(FILE *stream)
{
    fputs(".SH NAME\nfacet \\- ", stream);
    print_text(stream, help_summary);
    fputs(".SH SYNOPSIS\n.B facet\n\\fICOMMAND\\fR [\\fIMODEL\\fR...] [\\fIoptions\\fR]\n.SH DESCRIPTION\n",
          stream);
    print_text(stream,
               "Reads glTF 2.0, OBJ, STL and PLY models and renders them on the CPU, without a GPU, display "
               "or network; converts between them, bakes environments, and plots reflectance. Begin with:");
    fputs(".PP\n.RS\n.B ", stream);
    print_text(stream, help_first_use);
    fputs(".RE\n.SH COMMANDS\n", stream);
    for (const verb *const *v = verbs; *v; v++) {
        fprintf(stream, ".TP\n.BR facet\\-%s (1)\n", (*v)->name);
        print_text(stream, (*v)->summary);
    }
}

void man_page_print(FILE *stream, const verb *v, const char *version)
{
    fputs(".TH FACET", stream);
    if (v) {
        fputs("\\-", stream);
        print_upper(stream, v->name);
    }
    fprintf(stream, " 1 \"\" \"facet %s\" \"User Commands\"\n", version);
    if (v)
        print_verb(stream, v);
    else
        print_overview(stream);
    print_exit_status(stream);
    print_environment(stream);
    print_see_also(stream, v);
}

/* ---- completions ---- */

typedef void print_option_function(FILE *stream, const verb *v, const option *o);

static void for_each_option(FILE *stream, const verb *v, print_option_function *print)
{
    const option *o;
    for (size_t i = 0; (o = option_at(v, i)); i++)
        print(stream, v, o);
}

static void print_words(FILE *stream, const char *const *words, const char *separator)
{
    for (int i = 0; words[i]; i++)
        fprintf(stream, "%s%s", i ? separator : "", words[i]);
}

/* ---- bash: one function, a case per verb for the option before the cursor ---- */

static void bash_name(FILE *stream, const verb *v, const option *o)
{
    (void)v;
    if (o->letter)
        fprintf(stream, "-%c ", o->letter);
    fprintf(stream, "--%s ", o->name);
}

static void bash_value(FILE *stream, const verb *v, const option *o)
{
    (void)v;
    if (!option_takes_value(o))
        return;
    fprintf(stream, "            ");
    if (o->letter)
        fprintf(stream, "-%c | ", o->letter);
    fprintf(stream, "--%s)\n", o->name);
    fprintf(stream, "                mapfile -t COMPREPLY < <(");
    if (o->choices) {
        fprintf(stream, "compgen -W '");
        print_words(stream, o->choices, " ");
        fprintf(stream, "' -- \"$current\"; ");
    }
    if (o->kind == OPTION_FILE)
        fprintf(stream, "compgen -f -- \"$current\"");
    if (o->kind == OPTION_FOLDER)
        fprintf(stream, "compgen -d -- \"$current\"");
    fprintf(stream, ")\n                return\n                ;;\n");
}

static void bash_verb(FILE *stream, const verb *v)
{
    fprintf(stream, "    %s)\n        case \"$previous\" in\n", v->name);
    for_each_option(stream, v, bash_value);
    fprintf(stream, "        esac\n        if [[ $current == -* ]]; then\n"
                    "            mapfile -t COMPREPLY < <(compgen -W '");
    for_each_option(stream, v, bash_name);
    fprintf(stream, "' -- \"$current\")\n        else\n            mapfile -t COMPREPLY < <(");
    if (v->words) {
        fprintf(stream, "compgen -W '");
        print_words(stream, v->words, " ");
        fprintf(stream, "' -- \"$current\"; ");
    }
    if (v->file_types) {
        fprintf(stream, "compgen -d -- \"$current\"");
        for (const char *type = v->file_types; *type; type += strspn(type, " ")) {
            int length = (int)strcspn(type, " ");
            fprintf(stream, "; compgen -f -X '!*.%.*s' -- \"$current\"", length, type);
            type += length;
        }
    }
    fprintf(stream, ")\n        fi\n        ;;\n");
}

static void print_bash(FILE *stream)
{
    fprintf(stream, "# bash completion for facet, made by: facet --generate-completion bash\n"
                    "_facet() {\n"
                    "    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
                    "    COMPREPLY=()\n"
                    "    # --name=value comes as three words\n"
                    "    if [[ $current == = ]]; then\n"
                    "        current=''\n"
                    "    elif [[ $previous == = && COMP_CWORD -ge 2 ]]; then\n"
                    "        previous=${COMP_WORDS[COMP_CWORD - 2]}\n"
                    "    fi\n"
                    "    if [[ $COMP_CWORD -eq 1 ]]; then\n"
                    "        mapfile -t COMPREPLY < <(compgen -W '");
    for (const verb *const *v = verbs; *v; v++)
        fprintf(stream, "%s ", (*v)->name);
    fprintf(stream, "--help --version' -- \"$current\")\n        return\n    fi\n"
                    "    case \"${COMP_WORDS[1]}\" in\n");
    for (const verb *const *v = verbs; *v; v++)
        bash_verb(stream, *v);
    fprintf(stream, "    esac\n}\ncomplete -o filenames -F _facet facet\n");
}

/* ---- zsh: _arguments with a specification per option ---- */

/* Prints text inside [..] of a single-quoted specification, where brackets and colons are special. */
static void zsh_text(FILE *stream, const char *text)
{
    for (; *text; text++) {
        if (*text == '\'') {
            fputs("'\\''", stream);
            continue;
        }
        if (strchr("[]:\\", *text))
            fputc('\\', stream);
        fputc(*text, stream);
    }
}

static void zsh_action(FILE *stream, const option *o)
{
    fprintf(stream, ":");
    zsh_text(stream, o->argument);
    fprintf(stream, ":");
    if (o->kind == OPTION_FILE)
        fprintf(stream, "_files");
    else if (o->kind == OPTION_FOLDER)
        fprintf(stream, "_files -/");
    else if (o->kind == OPTION_CHOICES) {
        fprintf(stream, "_values -s , %s ", o->name);
        print_words(stream, o->choices, " ");
    } else if (o->choices) {
        fprintf(stream, "(");
        print_words(stream, o->choices, " ");
        fprintf(stream, ")");
    }
}

static void zsh_specification(FILE *stream, const option *o, bool is_letter)
{
    const char *many = o->kind == OPTION_COUNT || o->kind == OPTION_TEXTS ? "*" : "";
    if (is_letter)
        fprintf(stream, "                '%s-%c%s[", many, o->letter, option_takes_value(o) ? "+" : "");
    else
        fprintf(stream, "                '%s--%s%s[", many, o->name, option_takes_value(o) ? "=" : "");
    zsh_text(stream, o->help);
    fprintf(stream, "]");
    if (option_takes_value(o))
        zsh_action(stream, o);
    fprintf(stream, "' \\\n");
}

static void zsh_option(FILE *stream, const verb *v, const option *o)
{
    (void)v;
    if (o->letter)
        zsh_specification(stream, o, true);
    zsh_specification(stream, o, false);
}

static void zsh_verb(FILE *stream, const verb *v)
{
    fprintf(stream, "        %s)\n            _arguments -s -S \\\n", v->name);
    for_each_option(stream, v, zsh_option);
    if (v->words) {
        fprintf(stream, "                '*:word:(");
        print_words(stream, v->words, " ");
        fprintf(stream, ")'\n");
    } else if (v->file_types) {
        fprintf(stream, "                '*:model:_files -g \"*.(");
        for (const char *type = v->file_types; *type; type++)
            fputc(*type == ' ' ? '|' : *type, stream);
        fprintf(stream, ")(-.)\"'\n");
    } else {
        fprintf(stream, "                && return\n");
    }
    fprintf(stream, "            ;;\n");
}

static void print_zsh(FILE *stream)
{
    fprintf(stream, "#compdef facet\n# zsh completion for facet, made by: facet --generate-completion zsh\n"
                    "_facet() {\n"
                    "    local -a commands\n"
                    "    commands=(\n");
    for (const verb *const *v = verbs; *v; v++) {
        fprintf(stream, "        '%s:", (*v)->name);
        zsh_text(stream, (*v)->summary);
        fprintf(stream, "'\n");
    }
    fprintf(stream, "    )\n"
                    "    if (( CURRENT == 2 )); then\n"
                    "        _describe command commands\n"
                    "        return\n"
                    "    fi\n"
                    "    shift words\n"
                    "    (( CURRENT-- ))\n"
                    "    case \"$words[1]\" in\n");
    for (const verb *const *v = verbs; *v; v++)
        zsh_verb(stream, *v);
    fprintf(stream, "    esac\n}\n_facet \"$@\"\n");
}

/* ---- fish: one line per option ---- */

static void fish_text(FILE *stream, const char *text)
{
    fputc('\'', stream);
    for (; *text; text++) {
        if (*text == '\'' || *text == '\\')
            fputc('\\', stream);
        fputc(*text, stream);
    }
    fputc('\'', stream);
}

static void fish_option(FILE *stream, const verb *v, const option *o)
{
    fprintf(stream, "complete -c facet -n '__fish_seen_subcommand_from %s' -l %s", v->name, o->name);
    if (o->letter)
        fprintf(stream, " -s %c", o->letter);
    if (option_takes_value(o))
        fprintf(stream, o->kind == OPTION_FILE ? " -r -F" : " -x");
    if (o->kind == OPTION_FOLDER)
        fprintf(stream, " -a '(__fish_complete_directories)'");
    if (o->choices) {
        fprintf(stream, " -a '");
        print_words(stream, o->choices, " ");
        fprintf(stream, "'");
    }
    fprintf(stream, " -d ");
    fish_text(stream, o->help);
    fputc('\n', stream);
}

static void print_fish(FILE *stream)
{
    fprintf(stream, "# fish completion for facet, made by: facet --generate-completion fish\n"
                    "complete -c facet -n __fish_use_subcommand -f\n");
    for (const verb *const *v = verbs; *v; v++) {
        fprintf(stream, "complete -c facet -n __fish_use_subcommand -a %s -d ", (*v)->name);
        fish_text(stream, (*v)->summary);
        fputc('\n', stream);
    }
    for (const verb *const *v = verbs; *v; v++) {
        if (!(*v)->file_types)
            fprintf(stream, "complete -c facet -n '__fish_seen_subcommand_from %s' -f\n", (*v)->name);
        if ((*v)->words) {
            fprintf(stream, "complete -c facet -n '__fish_seen_subcommand_from %s' -a '", (*v)->name);
            print_words(stream, (*v)->words, " ");
            fprintf(stream, "'\n");
        }
        for_each_option(stream, *v, fish_option);
    }
}

bool completion_print(FILE *stream, const char *shell)
{
    if (strcmp(shell, "bash") == 0)
        print_bash(stream);
    else if (strcmp(shell, "zsh") == 0)
        print_zsh(stream);
    else if (strcmp(shell, "fish") == 0)
        print_fish(stream);
    else
        return false;
    return true;
}
