/* man_page.c - the option table as man pages, man(7). */
#include "cli/help/man_page.h"

#include "cli/shared/failure.h"
#include "cli/help/help.h"

#include <ctype.h>
#include <string.h>

/* Text as roff: backslashes and dashes are escaped (a plain - may become a typographic hyphen, which cannot be
 * copied into a shell), and a line does not begin with a request. */
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

/* Text in bold, within a line. */
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
               "Reads glTF 2.0, OBJ, STL and PLY models and draws them on the CPU, without a GPU, display or "
               "network; converts between "
               "them, and plots reflectance. Begin with:");
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
