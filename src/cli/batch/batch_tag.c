/* batch_tag.c - see batch_tag.h. PNG: chunks of length, type, data, CRC, up to IDAT. OpenEXR: attributes of name, type, size and
 * value, up to an empty name. */
#define _POSIX_C_SOURCE 200809L
#include "cli/batch/batch_tag.h"

#include <fcntl.h>
#include <stdint.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char keyword[] = "facet-tag";

enum { MAX_PARTS = 1000 }; /* chunks or attributes before the tag */

static bool read_u32(FILE *file, bool is_big_endian, uint32_t *value)
{
    unsigned char b[4];
    if (fread(b, 1, 4, file) != 4)
        return false;
    *value = is_big_endian ? (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3]
                           : (uint32_t)b[3] << 24 | (uint32_t)b[2] << 16 | (uint32_t)b[1] << 8 | b[0];
    return true;
}

static bool read_text(FILE *file, uint32_t size, char *text)
{
    if (size >= BATCH_TAG_SIZE || fread(text, 1, size, file) != size)
        return false;
    text[size] = 0;
    return true;
}

/* Reads a text that ends with 0. */
static bool read_name(FILE *file, char name[BATCH_TAG_SIZE])
{
    for (size_t i = 0; i < BATCH_TAG_SIZE; i++) {
        int c = getc(file);
        if (c == EOF)
            return false;
        name[i] = (char)c;
        if (!c)
            return true;
    }
    return false;
}

static bool find_in_png(FILE *file, char tag[BATCH_TAG_SIZE])
{
    for (int i = 0; i < MAX_PARTS; i++) {
        uint32_t size;
        char type[4], text[BATCH_TAG_SIZE];
        if (!read_u32(file, true, &size) || fread(type, 1, 4, file) != 4 || memcmp(type, "IDAT", 4) == 0)
            return false;
        bool may_be_tag = memcmp(type, "tEXt", 4) == 0 && size > sizeof keyword && size < BATCH_TAG_SIZE;
        if (may_be_tag && !read_text(file, size, text))
            return false;
        if (may_be_tag && strcmp(text, keyword) == 0) {
            memcpy(tag, text + sizeof keyword, size + 1 - sizeof keyword);
            return true;
        }
        if (fseek(file, (may_be_tag ? 0 : (long)size) + 4, SEEK_CUR) != 0)
            return false;
    }
    return false;
}

static bool find_in_exr(FILE *file, char tag[BATCH_TAG_SIZE])
{
    for (int i = 0; i < MAX_PARTS; i++) {
        char name[BATCH_TAG_SIZE], type[BATCH_TAG_SIZE];
        uint32_t size;
        if (!read_name(file, name) || !*name || !read_name(file, type) || !read_u32(file, false, &size))
            return false;
        if (strcmp(name, keyword) == 0)
            return strcmp(type, "string") == 0 && read_text(file, size, tag);
        if (fseek(file, (long)size, SEEK_CUR) != 0)
            return false;
    }
    return false;
}

FILE *batch_open_regular(const char *path)
{
    struct stat info;
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    FILE *file = fd >= 0 && fstat(fd, &info) == 0 && S_ISREG(info.st_mode) ? fdopen(fd, "rb") : NULL;
    if (!file && fd >= 0)
        close(fd);
    return file;
}

bool batch_tag_read(const char *path, char tag[BATCH_TAG_SIZE])
{
    static const unsigned char exr_magic[] = {0x76, 0x2f, 0x31, 0x01};
    unsigned char magic[8];
    FILE *file = batch_open_regular(path);
    if (!file)
        return false;
    bool has_tag = false;
    if (fread(magic, 1, 8, file) == 8) { /* of OpenEXR magic number and version */
        if (memcmp(magic, "\x89PNG\r\n\x1a\n", 8) == 0)
            has_tag = find_in_png(file, tag);
        else if (memcmp(magic, exr_magic, 4) == 0)
            has_tag = find_in_exr(file, tag);
    }
    fclose(file);
    return has_tag;
}
