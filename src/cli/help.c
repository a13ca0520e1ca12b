/* help.c - the option table as text for people: examples first, then the options by group. */
#include "cli/help.h"

#include "cli/failure.h"
#include "cli/terminal.h"

#include <string.h>

enum { TEXT_COLUMN = 31, OPTION_COLUMN = 2, VERB_COLUMN = 12 };

const char help_summary[] = "physically based pictures of models on any CPU, conversions, plots";
const char help_first_use[] = "facet render helmet.glb -o helmet.png";

/* A paragraph, or several, each wrapped. */
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
static void print_option(FILE *stream, const option *o, int width)
{
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
    if (column >= TEXT_COLUMN) {
        fputc('\n', stream);
        column = 0;
    }
    terminal_wrap(stream, text, TEXT_COLUMN, width, &column);
    fputc('\n', stream);
}

static void print_heading(FILE *stream, const char *title)
{
    fprintf(stream, terminal_has_color(stream) ? "\n\033[1m%s\033[0m\n" : "\n%s\n", title);
}

void help_print_verb(FILE *stream, const verb *v)
{
    int width = terminal_width(stream);
    fprintf(stream, "facet %s - %s\n\n  facet %s%s%s [options]\n", v->name, v->summary, v->name,
            *v->arguments ? " " : "", v->arguments);
    print_heading(stream, "Examples");
    for (const example *e = v->examples; e->command; e++) {
        int column = 0;
        terminal_wrap(stream, e->command, 2, 1 << 20, &column); /* not wrapped: to be copied */
        fputc('\n', stream);
        column = 0;
        terminal_wrap(stream, e->what, 6, width, &column);
        fputc('\n', stream);
    }
    fputc('\n', stream);
    print_paragraphs(stream, v->description, 0, width);
    for (const option_group *const *g = v->groups; *g; g++) {
        print_heading(stream, (*g)->title);
        for (size_t i = 0; i < (*g)->option_count; i++)
            print_option(stream, &(*g)->options[i], width);
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
    fprintf(stream,
            "\nfacet help COMMAND lists the options of one; facet help exit-codes says what 0 to 75 mean.\n");
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
