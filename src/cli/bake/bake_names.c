/* bake_names.c - see bake_names.h. */
#define _DEFAULT_SOURCE
#include "cli/bake/bake_names.h"

#include "cli/shared/output.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const char *const bake_face_names[6] = {"px", "nx", "py", "ny", "pz", "nz"};

static const struct {
    const char *extension;
    bake_container container;
} extensions[] = {{"ktx2", CONTAINER_KTX2},     {"ktx", CONTAINER_KTX1},  {"exr", CONTAINER_EXR},
                  {"exr", CONTAINER_EXR_FLOAT}, {"hdr", CONTAINER_HDR},   {"pfm", CONTAINER_PFM},
                  {"png", CONTAINER_PNG},       {"jpg", CONTAINER_JPEG},  {"jpeg", CONTAINER_JPEG},
                  {"webp", CONTAINER_WEBP},     {"json", CONTAINER_JSON}, {"h", CONTAINER_HEADER},
                  {"txt", CONTAINER_TEXT}};
enum { EXTENSION_COUNT = sizeof extensions / sizeof *extensions };

bake_container bake_container_of(const char *path)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    for (int i = 0; dot && i < EXTENSION_COUNT; i++)
        if (strcasecmp(dot + 1, extensions[i].extension) == 0)
            return extensions[i].container;
    return CONTAINER_FROM_NAME;
}

const char *bake_container_extension(bake_container container)
{
    for (int i = 0; i < EXTENSION_COUNT; i++)
        if (extensions[i].container == container)
            return extensions[i].extension;
    return "";
}

/* Appends length bytes of text to name, of which used bytes are taken. False: too long. */
static bool append(char *name, size_t *used, const char *text, size_t length)
{
    if (length >= BAKE_NAME_SIZE - *used)
        return false;
    memcpy(name + *used, text, length);
    *used += length;
    name[*used] = 0;
    return true;
}

bool bake_name_has_face(const char *pattern)
{
    return strstr(pattern, "{face}") != NULL;
}

bool bake_name_expand(const char *pattern, const char *stem, int level, bool has_levels, int face, char *name)
{
    char number[16];
    const char *face_name = face >= 0 ? bake_face_names[face] : "";
    snprintf(number, sizeof number, "%d", level < 0 ? 0 : level);
    const struct {
        const char *mark, *text;
    } places[] = {{"{stem}", stem}, {"{level}", number}, {"{face}", face_name}};
    const char *slash = strrchr(pattern, '/'), *dot = strrchr(slash ? slash : pattern, '.');
    const bool lacks_level = has_levels && !strstr(pattern, "{level}");
    const bool lacks_face = face >= 0 && !bake_name_has_face(pattern);
    size_t used = 0;
    *name = 0;
    for (const char *at = pattern;;) {
        if (at == dot || !*at) {
            char suffix[32];
            int length =
                snprintf(suffix, sizeof suffix, "%s%s%s%s", lacks_level ? "_m" : "",
                         lacks_level ? number : "", lacks_face ? "_" : "", lacks_face ? face_name : "");
            if ((at == dot || !dot) && !append(name, &used, suffix, (size_t)length))
                return false;
        }
        if (!*at)
            return true;
        size_t consumed = 0;
        for (size_t i = 0; i < sizeof places / sizeof *places && !consumed; i++)
            if (strncmp(at, places[i].mark, strlen(places[i].mark)) == 0) {
                consumed = strlen(places[i].mark);
                if (!append(name, &used, places[i].text, strlen(places[i].text)))
                    return false;
            }
        if (!consumed) {
            consumed = 1;
            if (!append(name, &used, at, 1))
                return false;
        }
        at += consumed;
    }
}

bool bake_name_join(const char *folder, const char *file, char *name)
{
    size_t length = strlen(folder), used = 0;
    while (length > 1 && folder[length - 1] == '/')
        length--;
    *name = 0;
    return append(name, &used, folder, length) &&
           (folder[length - 1] == '/' || append(name, &used, "/", 1)) &&
           append(name, &used, file, strlen(file));
}

void bake_name_of_folder(const char *folder, char *name)
{
    static const char otherwise[] = "environment";
    char resolved[PATH_MAX];
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/')
        length--;
    size_t begin = length;
    while (begin > 0 && folder[begin - 1] != '/')
        begin--;
    const char *part = folder + begin;
    length -= begin;
    if ((length == 0 || (length == 1 && part[0] == '.') || (length == 2 && memcmp(part, "..", 2) == 0)) &&
        realpath(folder, resolved)) {
        part = strrchr(resolved, '/') + 1;
        length = strlen(part);
    }
    if (length == 0 || length >= BAKE_NAME_SIZE) {
        part = otherwise;
        length = sizeof otherwise - 1;
    }
    memcpy(name, part, length);
    name[length] = 0;
}

void bake_symbol(const char *path, char *symbol, size_t size)
{
    char stem[256];
    size_t n = 0;
    if (!output_name_stem(path, stem, sizeof stem))
        memcpy(stem, "baked", 6);
    if (stem[0] >= '0' && stem[0] <= '9')
        symbol[n++] = '_';
    for (const char *at = stem; *at && n + 1 < size; at++) {
        bool is_good = (*at >= 'a' && *at <= 'z') || (*at >= 'A' && *at <= 'Z') || (*at >= '0' && *at <= '9');
        symbol[n++] = is_good ? *at : '_';
    }
    symbol[n] = 0;
}
