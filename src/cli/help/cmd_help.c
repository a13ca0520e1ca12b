/* cmd_help.c - facet help: a command, a topic, an option, or a word. */
#define _GNU_SOURCE
#include "cli/shared/options.h"

#include "cli/help/help.h"
#include "cli/shared/command_line.h"
#include "cli/shared/failure.h"
#include "cli/shared/messages.h"
#include "cli/shared/suggest.h"
#include "cli/shared/terminal.h"
#include "facet_install.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- documents and search ---- */

enum { MAX_VERBS = 32, DOCUMENT_COLUMN = 24 };

static const struct {
    const char *name, *summary;
} documents[] = {
    {"cli.md", "the command: output names, motion, light, limits, JSON, exit codes"},
    {"formats.md", "model files: what is read of each format"},
    {"images.md", "image files: which are read and written, and what of them"},
    {"gltf-support.md", "glTF: how each extension is read, rendered and written"},
    {"shading-model.md", "the material model: equations and sources"},
    {"path-tracing.md", "path tracing: what is exact, what is biased, noise"},
    {"denoising.md", "the denoiser: what it does and how far it is off"},
    {"environments.md", "environments: images, cube maps, skies, studios and their units"},
    {"bake.md", "prefiltered environments for real-time engines, three.js and Filament among them"},
    {"ocean.md", "the sea: wind, water, beds, floating models, maps and meshes"},
    {"gl.md", "OpenGL: features, methods, drivers"},
    {"layers.md", "layers of .exr files: depth, normals, IDs, Cryptomatte"},
    {"legacy.md", "materials of OpenGL 1, OBJ and MTL, to glTF's and back"},
    {"r.md", "R's rgl: parameters, web pages, vignettes"},
    {"compare.md", "image metrics: FLIP, SSIM, limits for tests"},
    {"serve.md", "rendering for web servers, programs and agents: HTTP, JSON-RPC, MCP"},
    {"inspect.md", "the JSON of facet inspect"},
    {"parts.md", "one image in parts: tiles, samples, frames, and merging them"},
    {"farm.md", "many machines: shards, Slurm and other engines"},
    {"view.md", "the window: keys, mouse, scripts; web pages"},
    {"shaders.md", "the shader library as GLSL for other renderers"},
    {"c-api.md", "the library, by example"},
    {"python.md", "the same from Python, with numpy"},
    {"packaging.md", "packages, thumbnails in file managers, containers, releases"},
    {"security.md", "untrusted files: what holds, and limits"},
    {"comparison.md", "facet compared with other renderers"},
    {"performance.md", "times and memory"},
    {"gallery.md", "example images"},
};
enum { DOCUMENT_COUNT = sizeof documents / sizeof *documents };

/* Whether a word in text begins with word: "ground" is not in "background". */
static bool has_word(const char *text, const char *word)
{
    for (const char *at = text; (at = strcasestr(at, word)); at++)
        if (at == text || !isalnum((unsigned char)at[-1]))
            return true;
    return false;
}

/* ---- documents ---- */

/* The folder of the installed documents, relative to the command; "": not installed. */
static void find_documents(char *folder, size_t size)
{
    char command[3072];
    ssize_t length = readlink("/proc/self/exe", command, sizeof command - 1);
    command[length > 0 ? length : 0] = 0;
    char *slash = strrchr(command, '/');
    *folder = 0;
    if (!slash)
        return;
    *slash = 0;
    snprintf(folder, size, "%s/%s", command, FACET_DOCUMENTS_FROM_COMMAND);
    char *clean = realpath(folder, NULL);
    snprintf(folder, size, "%s/%s", clean ? clean : "", documents[0].name);
    bool is_there = clean && access(folder, R_OK) == 0; /* the folder alone may hold licences only */
    snprintf(folder, size, "%s", is_there ? clean : "");
    free(clean);
}

static void print_document(FILE *stream, int i)
{
    char folder[4096], path[4200];
    find_documents(folder, sizeof folder);
    snprintf(path, sizeof path, "%s/%s", folder, documents[i].name);
    bool is_there = *folder && access(path, R_OK) == 0;
    int column = fprintf(stream, "  %s", is_there ? path : documents[i].name);
    if (column >= DOCUMENT_COLUMN) {
        fputc('\n', stream);
        column = 0;
    }
    terminal_wrap(stream, documents[i].summary, DOCUMENT_COLUMN, terminal_width(stream), &column);
    fputc('\n', stream);
}

static void help_print_documents(FILE *stream)
{
    char folder[4096];
    find_documents(folder, sizeof folder);
    if (!*folder)
        fprintf(stream, "The documents are not installed beside this command (Debian's package: facet-doc); "
                        "they are in docs/ of "
                        "facet's source.\n\n");
    for (int i = 0; i < DOCUMENT_COUNT; i++)
        print_document(stream, i);
}

/* ---- options ---- */

/* The verbs with o, or with an option of the same name and help. */
static size_t find_verbs(const option *o, const verb *found[MAX_VERBS])
{
    size_t count = 0;
    for (const verb *const *v = verbs; *v && count < MAX_VERBS; v++) {
        const option *other = option_find(*v, o->name, strlen(o->name));
        if (other && strcmp(other->help, o->help) == 0)
            found[count++] = *v;
    }
    return count;
}

static void print_option_of(FILE *stream, const option *o)
{
    const verb *found[MAX_VERBS];
    size_t count = find_verbs(o, found);
    char list[512] = "in ";
    for (size_t i = 0; i < count; i++) {
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%sfacet %s", i ? ", " : "", found[i]->name);
    }
    help_print_option_line(stream, o);
    int column = 0;
    terminal_wrap(stream, list, HELP_TEXT_COLUMN, terminal_width(stream), &column);
    fputc('\n', stream);
}

typedef bool option_test(const option *o, const char *word);

/* Prints the options that pass, each description once. */
static size_t print_options(FILE *stream, option_test *passes, const char *word)
{
    size_t printed = 0;
    const option *o;
    for (const verb *const *v = verbs; *v; v++)
        for (size_t i = 0; (o = option_at(*v, i)); i++) {
            const verb *found[MAX_VERBS];
            if (!passes(o, word) || find_verbs(o, found) == 0 || found[0] != *v)
                continue;
            print_option_of(stream, o);
            printed++;
        }
    return printed;
}

static bool has_name(const option *o, const char *word)
{
    return strcmp(o->name, word) == 0;
}

static bool help_print_option(FILE *stream, const char *name)
{
    const char *plain = name + strspn(name, "-");
    if (print_options(stream, has_name, plain))
        return true;
    size_t printed = 0;
    for (const verb *const *v = verbs; *v; v++) {
        const char *ours = suggest_foreign(*v, plain, strlen(plain));
        if (ours)
            printed += fprintf(stream, "  %s is, in facet %s: %s\n", plain, (*v)->name, ours) > 0;
    }
    return printed > 0;
}

/* ---- search ---- */

static bool mentions(const option *o, const char *word)
{
    if (has_word(o->name, word) || has_word(o->help, word))
        return true;
    for (int i = 0; o->choices && o->choices[i]; i++)
        if (has_word(o->choices[i], word))
            return true;
    return false;
}

static size_t search_verbs(FILE *stream, const char *word)
{
    size_t printed = 0;
    for (const verb *const *v = verbs; *v; v++) {
        bool is_found =
            has_word((*v)->name, word) || has_word((*v)->summary, word) || has_word((*v)->description, word);
        if (is_found)
            printed += fprintf(stream, "  facet help %s: %s\n", (*v)->name, (*v)->summary) > 0;
        for (const example *e = (*v)->examples; e->command; e++)
            if (has_word(e->command, word) || has_word(e->what, word))
                printed += fprintf(stream, "  %s\n      %s\n", e->command, e->what) > 0;
    }
    return printed;
}

static bool help_search(FILE *stream, const char *word)
{
    size_t printed = *word ? print_options(stream, mentions, word) : 0;
    printed += *word ? search_verbs(stream, word) : 0;
    for (int i = 0; i < DOCUMENT_COUNT; i++)
        if (*word && (has_word(documents[i].name, word) || has_word(documents[i].summary, word))) {
            print_document(stream, i);
            printed++;
        }
    return printed > 0;
}

const verb help_verb = {
    .name = "help",
    .summary = "explain facet or one of its commands",
    .arguments = "[COMMAND|OPTION|WORD]",
    .max_arguments = 1,
    .words =
        (const char *const[]){
#define VERB(name) #name,
#include "cli/shared/verbs.def"
#undef VERB
            "exit-codes", "documents", NULL},
    .description =
        "Prints the same as facet --help or facet COMMAND --help; of an option its meaning and the "
        "commands that have it; of another word all places that mention it. exit-codes and documents "
        "are topics.",
    .examples = (const example[]){{"facet help render", "the main options of render; --help-all shows all"},
                                  {"facet help orbit", "an option, in all commands that have it"},
                                  {"facet help --search ground", "all places that mention a word"},
                                  {"facet help documents", "where the manual is"},
                                  {"facet help exit-codes", "the exit codes"},
                                  {NULL, NULL}},
    .groups =
        (const option_group *const[]){OPTION_GROUP("Options", OPT_SEARCH, OPT_HELP, OPT_HELP_ALL), NULL},
};

static int search(const char *word)
{
    size_t length = strlen(word);
    char singular[64] = "";
    if (length > 3 && length < sizeof singular && word[length - 1] == 's')
        memcpy(singular, word, length - 1);
    if (help_search(stdout, word) || help_search(stdout, singular))
        return EXIT_DONE;
    message_error("facet: no command, option or document mentions \"%s\"", word);
    return EXIT_USAGE;
}

/* Explains a word that is neither a command nor a topic. */
static int explain_word(const char *word)
{
    if (help_print_option(stdout, word))
        return EXIT_DONE;
    const char *near = suggest_verb(word);
    if (near)
        message_error("facet: there is no command \"%s\"; did you mean facet help %s?", word, near);
    else
        return search(word);
    return EXIT_USAGE;
}

int cmd_help(command_line *c)
{
    const char *topic = c->argument_count ? c->arguments[0] : NULL;
    const verb *v = topic ? verb_find(topic) : NULL;
    if (is_given(c, OPT_SEARCH))
        return search(option_text(c, OPT_SEARCH, ""));
    if (!topic)
        help_print_overview(stdout);
    else if (v)
        help_print_verb(stdout, v, is_given(c, OPT_HELP_ALL));
    else if (strcmp(topic, "exit-codes") == 0)
        help_print_exit_codes(stdout);
    else if (strcmp(topic, "documents") == 0)
        help_print_documents(stdout);
    else
        return explain_word(topic);
    return EXIT_DONE;
}
