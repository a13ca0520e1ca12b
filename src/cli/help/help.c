/* help.c - help text: examples first, then the options by group. */
#include "cli/help/help.h"

#include "cli/shared/failure.h"
#include "cli/shared/terminal.h"

#include <stdint.h>
#include <string.h>

enum { OPTION_COLUMN = 2, VERB_COLUMN = 12, SHORT_EXAMPLES = 5 };

const char help_summary[] = "physically based images of models on any CPU, conversions, plots";
const char help_first_use[] = "facet render helmet.glb -o helmet.png";

/* Prints wrapped paragraphs. */
static void print_paragraphs(FILE *stream, const char *text, int indent, int width)
{
    while (*text) {
        char paragraph[1024];
        const char *end = strstr(text, "\n\n");
        size_t length = end ? (size_t)(end - text) : strlen(text);
        snprintf(paragraph, sizeof paragraph, "%.*s", (int)length, text);
        int column = 0;
        terminal_wrap(stream, paragraph, indent, width, &column);
        fputc('\n', stream);
        text += length + (end ? 2 : 0);
        if (*text)
            fputc('\n', stream);
    }
}

/* "  -s, --size WxH      width and height ... [1024x768]" */
void help_print_option_line(FILE *stream, const option *o)
{
    int width = terminal_width(stream);
    char left[96], text[1024];
    int n = o->letter ? snprintf(left, sizeof left, "-%c, --%s", o->letter, o->name)
                      : snprintf(left, sizeof left, "    --%s", o->name);
    if (o->argument)
        snprintf(left + n, sizeof left - (size_t)n, " %s", o->argument);
    size_t used = (size_t)snprintf(text, sizeof text, "%s", o->help);
    if (o->kind == OPTION_CHOICE || o->kind == OPTION_CHOICES) {
        for (int i = 0; o->choices[i] && used < sizeof text; i++)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%s", i ? ", " : " (", o->choices[i]);
        if (used < sizeof text)
            used += (size_t)snprintf(text + used, sizeof text - used, ")");
    }
    if (o->default_text && used < sizeof text)
        snprintf(text + used, sizeof text - used, " [%s]", o->default_text);
    int column = fprintf(stream, "%*s%s", OPTION_COLUMN, "", left);
    if (column >= HELP_TEXT_COLUMN) {
        fputc('\n', stream);
        column = 0;
    }
    terminal_wrap(stream, text, HELP_TEXT_COLUMN, width, &column);
    fputc('\n', stream);
}

static void print_heading(FILE *stream, const char *title)
{
    fprintf(stream, terminal_has_color(stream) ? "\n\033[1m%s\033[0m\n" : "\n%s\n", title);
}

static void print_examples(FILE *stream, const verb *v, size_t most)
{
    print_heading(stream, "Examples");
    for (size_t i = 0; v->examples[i].command && i < most; i++) {
        int column = 0;
        terminal_wrap(stream, v->examples[i].command, 2, 1 << 20, &column); /* not wrapped, for copying */
        fputc('\n', stream);
        column = 0;
        terminal_wrap(stream, v->examples[i].what, 6, terminal_width(stream), &column);
        fputc('\n', stream);
    }
}

static size_t count_options(const verb *v)
{
    size_t count = 0;
    while (option_at(v, count))
        count++;
    return count;
}

static void print_basics(FILE *stream, const verb *v)
{
    print_examples(stream, v, SHORT_EXAMPLES);
    print_heading(stream, "Main options");
    for (const option_id *id = v->basics; *id != OPTION_ID_COUNT; id++)
        help_print_option_line(stream, option_find_id(v, *id));
    fprintf(stream,
            "\nfacet %s --help-all lists all %zu options with a description; facet help OPTION explains one, "
            "and\nfacet help --search WORD finds them.\n",
            v->name, count_options(v));
}

void help_print_verb(FILE *stream, const verb *v, bool all)
{
    const char *rest = strstr(v->arguments, " [-- "); /* options stand before it */
    int length = (int)(rest ? rest - v->arguments : (ptrdiff_t)strlen(v->arguments));
    fprintf(stream, "facet %s - %s\n\n  facet %s%s%.*s [options]%s\n", v->name, v->summary, v->name,
            *v->arguments ? " " : "", length, v->arguments, rest ? rest : "");
    if (v->basics && !all) {
        print_basics(stream, v);
        return;
    }
    print_examples(stream, v, SIZE_MAX);
    fputc('\n', stream);
    print_paragraphs(stream, v->description, 0, terminal_width(stream));
    for (const option_group *const *g = v->groups; *g; g++) {
        print_heading(stream, (*g)->title);
        for (const option_id *id = (*g)->ids; *id != OPTION_ID_COUNT; id++)
            help_print_option_line(stream, option_find_id(v, *id));
    }
}

void help_print_overview(FILE *stream)
{
    int width = terminal_width(stream);
    fprintf(stream, "facet - %s\n\n  facet COMMAND [MODEL...] [options]\n", help_summary);
    print_heading(stream, "Examples");
    fprintf(stream, "  %s\n", help_first_use);
    fprintf(stream, "  facet render shoe.glb -o 'turn_####.png' --turntable 72 --size 512\n");
    fprintf(stream, "  facet render                    (no model: the built-in scene)\n");
    fprintf(stream, "  facet inspect helmet.glb\n");
    fprintf(stream, "  facet bake studio.hdr -o studio.ktx2\n");
    print_heading(stream, "Commands");
    for (const verb *const *v = verbs; *v; v++) {
        int column = fprintf(stream, "  %s", (*v)->name);
        terminal_wrap(stream, (*v)->summary, VERB_COLUMN, width, &column);
        fputc('\n', stream);
    }
    fprintf(stream, "\nfacet help COMMAND explains a command, facet help OPTION an option (facet help "
                    "orbit); facet help --search\nWORD searches all of it, facet help documents lists the "
                    "manual, facet help exit-codes the exit codes.\n");
}

void help_print_exit_codes(FILE *stream)
{
    int width = terminal_width(stream);
    for (const exit_meaning *e = exit_meanings; e->code; e++) {
        int column = fprintf(stream, "  %s", e->code);
        terminal_wrap(stream, e->meaning, VERB_COLUMN, width, &column);
        fputc('\n', stream);
    }
}
