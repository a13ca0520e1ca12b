/* glsl_generate.c - writes texts of shaders to a C header; runs when facet is built.
 * usage: glsl_generate [--compact] OUTPUT SHADE_FOLDER       the shader library
 *        glsl_generate [--compact] OUTPUT FOLDER NAME...     files of a folder, as the array `parts`; their names
 *                                                            are without the paths from there
 *
 * OUTPUT gets the dialect of GLSL and, in the order of shade.h, the parts of the text as arrays of bytes:
 * a string literal is limited to 4095. --compact: without comments (glsl_compact.h), for downloads. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glsl/glsl_compact.h"

enum { MAX_LINE = 1024, MAX_PARTS = 64, MAX_NAME = 64, MAX_TEXT = 1 << 18 };

static bool is_compact;

static void stop(const char *path, const char *what)
{
    fprintf(stderr, "glsl_generate: %s: %s\n", path, what);
    exit(1);
}

static FILE *open_text(const char *folder, const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "r");
    if (!file)
        stop(path, "cannot be read");
    return file;
}

/* The file's lines, except those for C alone, as an array. */
static void put_text(FILE *out, const char *folder, const char *name, const char *array)
{
    static char text[MAX_TEXT];
    FILE *file = open_text(folder, name);
    char line[MAX_LINE];
    size_t length = 0;
    text[0] = 0;
    while (fgets(line, sizeof line, file)) {
        size_t added = strlen(line);
        if (!strchr(line, '\n') || length + added >= sizeof text)
            stop(name, "has a line that is too long, or too many");
        if (strncmp(line, "#include", 8) == 0)
            continue;
        memcpy(text + length, line, added + 1);
        length += added;
    }
    fclose(file);
    if (is_compact)
        glsl_compact(text);
    fprintf(out, "static const unsigned char %s[] = {", array);
    for (const char *c = text; *c; c++)
        fprintf(out, *c == '\n' ? "%d,\n" : "%d,", (unsigned char)*c);
    fprintf(out, "0};\n");
}

/* The same as text_INDEX. */
static void put_part(FILE *out, const char *folder, const char *name, int index)
{
    char array[32];
    snprintf(array, sizeof array, "text_%d", index);
    put_text(out, folder, name, array);
}

/* Writes the parts of shade.h; returns their number. */
static int put_shared(FILE *out, const char *folder, char names[MAX_PARTS][MAX_NAME])
{
    int count = 0;
    FILE *order = open_text(folder, "shade.h");
    char line[MAX_LINE];
    put_part(out, folder, "lang/lang_glsl.glsl", 0);
    put_text(out, folder, "lang/khronos_begin.glsl", "khronos_begin");
    put_text(out, folder, "lang/khronos_end.glsl", "khronos_end");
    while (fgets(line, sizeof line, order)) {
        char *name = names[count];
        int end = 0;
        if (sscanf(line, "#include \"%63[a-z_0-9].h\"%n", name, &end) != 1 || end == 0)
            continue; /* the dialect for C is in a folder */
        char file[MAX_NAME + 2];
        snprintf(file, sizeof file, "%s.h", name);
        if (++count == MAX_PARTS)
            stop("shade.h", "has too many headers");
        put_part(out, folder, file, count);
    }
    fclose(order);
    return count;
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "--compact") == 0) {
        is_compact = true;
        argv++;
        argc--;
    }
    if (argc < 3 || argc > 3 + MAX_PARTS) {
        fprintf(stderr, "usage: glsl_generate [--compact] OUTPUT FOLDER [NAME...]\n");
        return 2;
    }
    FILE *out = fopen(argv[1], "w");
    if (!out)
        stop(argv[1], "cannot be written");
    static char names[MAX_PARTS][MAX_NAME];
    int count = argc - 3;
    for (int i = 0; i < count; i++) {
        const char *slash = strrchr(argv[3 + i], '/');
        snprintf(names[i], sizeof names[i], "%s", slash ? slash + 1 : argv[3 + i]);
        put_part(out, argv[2], argv[3 + i], i + 1);
    }
    if (count == 0)
        count = put_shared(out, argv[2], names);
    fprintf(out, "static const glsl_part parts[] = {\n");
    for (int i = 0; i < count; i++)
        fprintf(out, "    {\"%s\", (const char *)text_%d},\n", names[i], i + 1);
    fprintf(out, "};\n");
    if (fclose(out) != 0)
        stop(argv[1], "cannot be written");
    return 0;
}
