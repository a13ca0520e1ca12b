/* manifest_line.h - which lines of a manifest are items, the same for facet batch and facet farm, which count them. */
#ifndef CLI_MANIFEST_LINE_H
#define CLI_MANIFEST_LINE_H

#include <stdbool.h>
#include <stddef.h>

/* Whether a byte of a line says nothing. Bytes of 0, which a crash of the machine can leave, are no space. */
static inline bool manifest_is_space(char byte)
{
    return byte == ' ' || byte == '\t' || byte == '\r';
}

/* Whether a line, without its end, is no item. */
static inline bool manifest_is_blank(const char *line, size_t length)
{
    for (size_t i = 0; i < length; i++)
        if (!manifest_is_space(line[i]))
            return false;
    return true;
}

#endif
