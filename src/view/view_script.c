/* view_script.c - see view_script.h. A line is a word and its arguments; # begins a comment. */
#include "view/view_script.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/number.h"
#include "base/result.h"
#include "view/view_input.h"

/* The arguments of a word. */
typedef enum step_takes { TAKES_NOTHING, TAKES_KEY, TAKES_DRAG, TAKES_NUMBERS, TAKES_PATH } step_takes;

static const struct {
    const char *word;
    view_step_kind kind;
    step_takes takes;
    int fewest, most; /* count of numbers */
    const char *expected;
} words[] = {
    {"key", VIEW_STEP_KEY, TAKES_KEY, 0, 0, "a key such as h, Shift+L, Left or F12"},
    {"drag", VIEW_STEP_DRAG, TAKES_DRAG, 4, 4,
     "left, right or middle, X Y X Y in pixels, and maybe Shift+, Ctrl+ or Alt+ before the button"},
    {"scroll", VIEW_STEP_SCROLL, TAKES_NUMBERS, 2, 2, "steps to the right and away"},
    {"drop", VIEW_STEP_DROP, TAKES_PATH, 0, 0, "a file"},
    {"size", VIEW_STEP_SIZE, TAKES_NUMBERS, 2, 2, "width and height in pixels"},
    {"wait", VIEW_STEP_WAIT, TAKES_NUMBERS, 1, 1, "seconds"},
    {"load", VIEW_STEP_LOAD, TAKES_NOTHING, 0, 0, "nothing more"},
    {"reload", VIEW_STEP_RELOAD, TAKES_NOTHING, 0, 0, "nothing more"},
    {"trace", VIEW_STEP_TRACE, TAKES_NUMBERS, 0, 2, "samples per pixel, and the seconds that they may take"},
    {"picture", VIEW_STEP_IMAGE, TAKES_PATH, 0, 0, "a file"},
    {"window", VIEW_STEP_WINDOW, TAKES_PATH, 0, 0, "a file"},
    {"print", VIEW_STEP_PRINT, TAKES_NOTHING, 0, 0, "nothing more"},
    {"minimise", VIEW_STEP_MINIMISE, TAKES_NOTHING, 0, 0, "nothing more"},
    {"restore", VIEW_STEP_RESTORE, TAKES_NOTHING, 0, 0, "nothing more"},
    {"close", VIEW_STEP_CLOSE, TAKES_NOTHING, 0, 0, "nothing more"},
};

/* The next word of a line, terminated by 0; NULL: there is none. */
static char *next_word(char **at)
{
    char *word = *at + strspn(*at, " \t\r");
    if (!*word)
        return NULL;
    char *end = word + strcspn(word, " \t\r");
    *at = end + (*end != 0);
    *end = 0;
    return word;
}

static bool read_numbers(char **at, int fewest, int most, double numbers[4])
{
    int count = 0;
    for (char *word; (word = next_word(at)) != NULL; count++) {
        float number;
        const char *end = number_read_float(word, &number); /* the script's text has padding after it */
        if (count == most || !end || *end || !isfinite(number))
            return false;
        numbers[count] = (double)number;
    }
    return count >= fewest;
}

/* "left", "Shift+right" */
static bool read_button(char **at, view_step *step)
{
    static const struct {
        const char *prefix;
        unsigned modifier;
    } modifiers[] = {{"Shift+", VIEW_SHIFT}, {"Ctrl+", VIEW_CONTROL}, {"Alt+", VIEW_ALT}};
    static const char *const buttons[] = {"left", "right", "middle"};
    const char *word = next_word(at);
    if (!word)
        return false;
    for (size_t i = 0; i < 3; i++) {
        size_t length = strlen(modifiers[i].prefix);
        if (strncmp(word, modifiers[i].prefix, length) == 0) {
            step->modifiers = modifiers[i].modifier;
            word += length;
        }
    }
    for (size_t i = 0; i < 3; i++)
        if (strcmp(word, buttons[i]) == 0) {
            step->button = (view_button)i;
            return true;
        }
    return false;
}

/* The rest of the line, which may contain spaces. */
static bool read_path(char **at, view_step *step)
{
    step->path = *at + strspn(*at, " \t\r");
    size_t length = strlen(step->path);
    while (length && strchr(" \t\r", step->path[length - 1]))
        step->path[--length] = 0;
    *at = step->path + length;
    return length > 0;
}

static bool read_step(size_t word, char *rest, view_step *step)
{
    char *key;
    step->kind = words[word].kind;
    switch (words[word].takes) {
    case TAKES_KEY:
        key = next_word(&rest);
        return key && view_key_parse(key, &step->key, &step->modifiers) && !next_word(&rest);
    case TAKES_DRAG:
        return read_button(&rest, step) && read_numbers(&rest, 4, 4, step->numbers);
    case TAKES_NUMBERS:
        return read_numbers(&rest, words[word].fewest, words[word].most, step->numbers);
    case TAKES_PATH:
        return read_path(&rest, step);
    default:
        return !next_word(&rest);
    }
}

static facet_result read_line(view_script *s, const facet_allocator *allocator, char *line, uint32_t number,
                              const char *name, facet_error *error)
{
    char *rest = line;
    const char *word = next_word(&rest);
    if (!word || word[0] == '#')
        return FACET_OK;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        view_step step = {.line = number};
        if (strcmp(word, words[i].word) != 0)
            continue;
        if (!read_step(i, rest, &step))
            return fail(error, FACET_ERROR_ARGUMENT, "%s: line %u: %s takes %s", name, number, word,
                        words[i].expected);
        if (!mem_reserve(allocator, (void **)&s->steps, &s->capacity, s->count + 1, sizeof *s->steps))
            return fail_memory(error, "script", (s->count + 1) * sizeof *s->steps);
        s->steps[s->count++] = step;
        return FACET_OK;
    }
    return fail(error, FACET_ERROR_ARGUMENT, "%s: line %u: there is no \"%.40s\" in scripts of facet view",
                name, number, word);
}

facet_result view_script_parse(const char *text, size_t size, const char *name,
                               const facet_allocator *allocator, view_script *out, facet_error *error)
{
    *out = (view_script){.text = mem_alloc(allocator, size + 1, 1)};
    if (!out->text)
        return fail_memory(error, "script", size + 1);
    for (size_t i = 0; i < size; i++)
        out->text[i] = text[i] ? text[i] : ' ';
    out->text[size] = 0;
    facet_result result = FACET_OK;
    uint32_t number = 1;
    for (char *line = out->text; line && result == FACET_OK; number++) {
        char *end = strchr(line, '\n');
        if (end)
            *end++ = 0;
        result = read_line(out, allocator, line, number, name, error);
        line = end;
    }
    if (result != FACET_OK)
        view_script_destroy(out);
    return result;
}

facet_result view_script_load(const char *path, const facet_allocator *allocator, view_script *out,
                              facet_error *error)
{
    file_bytes file;
    *out = (view_script){0};
    facet_result result = file_open(path, (uint64_t)1 << 20, allocator, &file, error);
    if (result != FACET_OK)
        return result;
    result = view_script_parse((const char *)file.data, file.size, path, allocator, out, error);
    file_close(&file);
    return result;
}

void view_script_destroy(view_script *s)
{
    mem_free(s->text);
    mem_free(s->steps);
    *s = (view_script){0};
}
