/* output.c - see output.h. */
#define _POSIX_C_SOURCE 200809L
#include "cli/shared/output.h"

#include "cli/shared/failure.h"
#include "cli/shared/interrupt.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

bool output_exists(const char *path)
{
    return access(path, F_OK) == 0;
}

/* Writes the nearest existing folder above path to folder, without a trailing slash, and returns the rest
 * of path. NULL: too long. */
static const char *find_folder(const char *path, char *folder, size_t size)
{
    struct stat info;
    size_t length = strlen(path);
    if (length >= size)
        return NULL;
    for (size_t i = length; i > 0; i--) {
        if (path[i - 1] != '/')
            continue;
        snprintf(folder, size, "%.*s", i > 1 ? (int)i - 1 : 1, path);
        if (stat(folder, &info) == 0)
            return path + i;
    }
    snprintf(folder, size, ".");
    return path;
}

char *output_identity(const char *path)
{
    char folder[4096];
    struct stat info = {0};
    const char *rest = find_folder(path, folder, sizeof folder);
    size_t size = strlen(path) + 64;
    char *identity = malloc(size);
    if (!identity)
        return NULL;
    if (!rest || stat(folder, &info) != 0) /* which is reported elsewhere */
        info.st_ino = 0;
    snprintf(identity, size, "%llx.%llx/%s", (unsigned long long)info.st_dev, (unsigned long long)info.st_ino,
             rest ? rest : path);
    return identity;
}

facet_result output_make_folders(const char *path, facet_error *error)
{
    char folder[4096];
    if (strcmp(path, "-") == 0)
        return FACET_OK;
    const char *rest = find_folder(path, folder, sizeof folder);
    for (const char *slash = rest; slash && (slash = strchr(slash, '/')); slash++) {
        snprintf(folder, sizeof folder, "%.*s", (int)(slash - path), path);
        if (mkdir(folder, 0777) != 0 && errno != EEXIST)
            return fail(error, FACET_ERROR_WRITE, "%s: the folder %s cannot be created: %s", path, folder,
                        strerror(errno));
    }
    return FACET_OK;
}

/* From the first progress report on there are files, which the library removes on failure. */
static bool may_go_on(void *user, const char *stage, double fraction)
{
    (void)user, (void)stage, (void)fraction;
    interrupt_end();
    return !interrupt_signal() && interrupt_seconds_left() > 0.0;
}

facet_result output_write_scene(const facet_scene *scene, const char *path, facet_scene_save_desc desc,
                                facet_error *error)
{
    if (output_make_folders(path, error) != FACET_OK)
        return FACET_ERROR_WRITE;
    desc.progress.report = may_go_on;
    interrupt_begin(path, "writing it", false);
    facet_result result = facet_scene_save(scene, path, &desc, error);
    interrupt_end();
    return result == FACET_ERROR_CANCELLED ? interrupt_check(path, error) : result;
}

facet_result output_check(const char *path, facet_error *error)
{
    if (strcmp(path, "-") == 0)
        return FACET_OK;
    struct stat info;
    if (stat(path, &info) == 0) {
        if (S_ISDIR(info.st_mode))
            return fail(error, FACET_ERROR_WRITE, "%s: it is a folder; the name of a file was expected",
                        path);
        if (!S_ISREG(info.st_mode)) /* a device, a pipe: written directly */
            return access(path, W_OK) == 0 ? FACET_OK
                                           : fail(error, FACET_ERROR_WRITE, "%s: %s", path, strerror(errno));
    }
    char folder[4096];
    const char *rest = find_folder(path, folder, sizeof folder);
    if (!rest)
        return fail(error, FACET_ERROR_WRITE, "%s: the name is too long", path);
    if (stat(folder, &info) != 0)
        return fail(error, FACET_ERROR_WRITE, "%s: there is no folder %s", path, folder);
    if (!S_ISDIR(info.st_mode))
        return fail(error, FACET_ERROR_WRITE, "%s: %s is not a folder", path, folder);
    if (access(folder, W_OK | X_OK) != 0)
        return fail(error, FACET_ERROR_WRITE, "%s: the folder %s cannot be written to: %s", path, folder,
                    strerror(errno));
    return FACET_OK;
}

/* Begins the writing of a regular file (interrupt.h), or of a stream, which needs no cleanup and whose
 * reader may never come. Returns whether path is a file. */
static bool begin_writing(const char *path)
{
    struct stat info;
    bool is_stream = strcmp(path, "-") == 0 ||
                     (lstat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISLNK(info.st_mode));
    if (is_stream)
        interrupt_begin("facet", "writing", false);
    else
        interrupt_file_begin();
    return !is_stream;
}

static void end_writing(bool is_file)
{
    if (is_file)
        interrupt_file_end();
    else
        interrupt_end();
}

facet_result output_write_bytes(const void *bytes, size_t size, const char *path, facet_error *error)
{
    facet_result result = output_make_folders(path, error);
    if (result != FACET_OK)
        return result;
    bool is_file = begin_writing(path);
    if (strcmp(path, "-") != 0)
        result = facet_bytes_save(bytes, size, path, error);
    else if (fwrite(bytes, 1, size, stdout) != size || fflush(stdout) != 0)
        result = fail(error, FACET_ERROR_WRITE, "stdout: %s", strerror(errno));
    end_writing(is_file);
    return result;
}

facet_result output_write(const facet_image *image, const char *path, const facet_image_save_desc *desc,
                          facet_error *error)
{
    if (strcmp(path, "-") != 0) {
        if (output_make_folders(path, error) != FACET_OK)
            return FACET_ERROR_WRITE;
        bool is_file = begin_writing(path);
        facet_result saved = facet_image_save(image, path, desc, error);
        end_writing(is_file);
        return saved;
    }
    unsigned char *bytes;
    size_t size;
    facet_result result = facet_image_encode(image, desc, &bytes, &size, error);
    if (result == FACET_OK)
        result = output_write_bytes(bytes, size, path, error);
    facet_bytes_destroy(bytes);
    return result;
}

facet_result output_close_stdout(facet_error *error)
{
    bool has_failed = ferror(stdout) != 0;
    errno = 0;
    if (fflush(stdout) != 0 || has_failed)
        return fail(error, FACET_ERROR_WRITE, "stdout: %s",
                    errno ? strerror(errno) : "it could not be written");
    return FACET_OK;
}

/* ---- names ---- */

enum { MARK_STEM, MARK_NAME, MARK_DIR, MARK_INDEX, MARK_COUNT };
static const char *const marks[] = {"{stem}", "{name}", "{dir}", "{index}"};

/* Length of the frame number placeholder at text, 0: none; *width is its number of digits. A single #
 * belongs to the name, as in "part#2.png". */
static size_t frame_mark(const char *text, int *width)
{
    size_t run = strspn(text, "#");
    if (run >= 2) {
        *width = run > 20 ? 20 : (int)run;
        return run;
    }
    if (text[0] != '%')
        return 0;
    size_t digits = strspn(text + 1, "0123456789");
    if (digits > 2 || text[1 + digits] != 'd')
        return 0;
    *width = digits ? atoi(text + 1) : 1;
    return digits + 2;
}

bool output_name_has_frame(const char *pattern)
{
    int width;
    for (; *pattern; pattern++)
        if (frame_mark(pattern, &width))
            return true;
    return false;
}

bool output_name_has_model(const char *pattern)
{
    for (int i = 0; i < MARK_COUNT; i++)
        if (strstr(pattern, marks[i]))
            return true;
    return false;
}

/* Whether a blank-separated list contains the first length characters of word. */
static bool has_word(const char *words, const char *word, size_t length)
{
    for (; *words; words += strspn(words, " ")) {
        size_t n = strcspn(words, " ");
        if (n == length && memcmp(words, word, n) == 0)
            return true;
        words += n;
    }
    return false;
}

facet_result output_name_check(const char *place, const char *pattern, const char *words, facet_error *error)
{
    for (const char *at = pattern; (at = strchr(at, '{')); at++) {
        size_t length = 0;
        while (isalpha((unsigned char)at[1 + length]))
            length++;
        if (length == 0 || at[1 + length] != '}' || has_word(words, at + 1, length))
            continue;
        char known[128] = "";
        for (const char *w = words; *w; w += strspn(w, " ")) {
            size_t used = strlen(known);
            int n = (int)strcspn(w, " ");
            snprintf(known + used, sizeof known - used, "%s{%.*s}", used ? ", " : "", n, w);
            w += n;
        }
        return fail(error, FACET_ERROR_ARGUMENT, "%s: {%.*s} is not a placeholder; the placeholders are %s",
                    place, (int)(length < 60 ? length : 60), at + 1, known);
    }
    return FACET_OK;
}

/* ---- filling in ---- */

/* A name being composed in a buffer of fixed size. */
typedef struct filling {
    char *name;
    size_t used, size;
    bool is_full;
} filling;

static void put(filling *f, const char *text, size_t length)
{
    f->is_full = f->is_full || length >= f->size - f->used;
    if (f->is_full)
        return;
    memcpy(f->name + f->used, text, length);
    f->used += length;
}

/* Appends the number of the model, as wide as the last one. */
static void put_index(filling *f, const model_name *model)
{
    char number[32], last[32];
    int width = snprintf(last, sizeof last, "%zu", model->count ? model->count : 1);
    int length = snprintf(number, sizeof number, "%0*zu", width, model->number ? model->number : 1);
    put(f, number, (size_t)length);
}

/* Appends the text of a placeholder. */
static void put_model(filling *f, int mark, const model_name *model)
{
    const char *path = !model->path ? "facet" : strcmp(model->path, "-") == 0 ? "stdin" : model->path;
    const char *slash = strrchr(path, '/');
    const char *folder = model->folder ? model->folder : "";
    char stem[1024];
    switch (mark) {
    case MARK_STEM:
        f->is_full = f->is_full || !output_name_stem(path, stem, sizeof stem);
        if (!f->is_full)
            put(f, stem, strlen(stem));
        return;
    case MARK_NAME:
        put(f, slash ? slash + 1 : path, strlen(slash ? slash + 1 : path));
        return;
    case MARK_DIR:
        put(f, folder, strlen(folder));
        return;
    default:
        put_index(f, model);
    }
}

/* The placeholder that text begins with; MARK_COUNT: none. */
static int find_mark(const char *text)
{
    for (int i = 0; i < MARK_COUNT; i++)
        if (strncmp(text, marks[i], strlen(marks[i])) == 0)
            return i;
    return MARK_COUNT;
}

bool output_name_expand(const char *pattern, const model_name *model, const uint32_t *frame, char *name,
                        size_t size)
{
    filling f = {.name = name, .size = size};
    while (*pattern && !f.is_full) {
        char number[128];
        int width, mark = find_mark(pattern);
        size_t place = frame ? frame_mark(pattern, &width) : 0;
        if (place) {
            put(&f, number, (size_t)snprintf(number, sizeof number, "%0*u", width, *frame));
            pattern += place;
        } else if (mark < MARK_COUNT) {
            size_t before = f.used;
            put_model(&f, mark, model);
            pattern += strlen(marks[mark]);
            /* without a folder no slash: '{dir}/{stem}.png' stays below the current folder */
            pattern += mark == MARK_DIR && f.used == before && *pattern == '/';
        } else {
            put(&f, pattern++, 1);
        }
    }
    if (f.is_full || f.used >= size)
        return false;
    name[f.used] = 0;
    return true;
}

/* ---- parts of names ---- */

bool output_name_has_type(const char *path, const char *types)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    for (; dot && *types; types += strspn(types, " ")) {
        size_t length = strcspn(types, " ");
        if (strlen(dot + 1) == length && strncasecmp(dot + 1, types, length) == 0)
            return true;
        types += length;
    }
    return false;
}

bool output_name_stem(const char *path, char *stem, size_t size)
{
    const char *slash = strrchr(path, '/');
    const char *base = slash ? slash + 1 : path;
    const char *dot = strrchr(base, '.');
    size_t length = dot && dot != base ? (size_t)(dot - base) : strlen(base);
    if (!length) {
        base = "model";
        length = strlen(base);
    }
    if (length >= size)
        return false;
    memcpy(stem, base, length);
    stem[length] = 0;
    return true;
}
