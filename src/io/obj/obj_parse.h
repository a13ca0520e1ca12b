/* obj_parse.h - parses the text of one chunk, words and lines, into its lists. All text ends with a line
 * end, followed by NUMBER_TAIL readable bytes. */
#ifndef IO_OBJ_PARSE_H
#define IO_OBJ_PARSE_H

#include "io/obj/obj_reader.h"

static inline bool obj_is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}
/* A lone CR ends a line too, as on the first Macs; between CR and LF is an empty line. */
static inline bool obj_is_line_end(char c)
{
    return c == '\n' || c == '\r';
}

/* Behind a backslash that joins its line with the next; p where there is none. */
const char *obj_skip_continuation(const char *p);

static inline const char *obj_skip_blanks(const char *p)
{
    for (;;) {
        while (obj_is_blank(*p))
            p++;
        if (*p != '\\')
            return p;
        const char *behind = obj_skip_continuation(p);
        if (behind == p)
            return p;
        p = behind;
    }
}
static inline bool obj_ends_word(const char *p)
{
    return obj_is_blank(*p) || obj_is_line_end(*p) || (*p == '\\' && obj_skip_continuation(p) != p);
}
const char *obj_skip_word(const char *p);
/* To the end of the line, or of the last line that it is joined with. */
const char *obj_skip_statement(const char *p);

/* Read the arguments of statements: kind is that of v, vt, vn (0, 't', 'n'). Return where they stopped. */
const char *obj_read_vertex(obj_chunk *c, const char *p, char kind, const facet_allocator *allocator);
const char *obj_read_element(obj_chunk *c, const char *p, scene_mode mode, const facet_allocator *allocator);

/* Sets element and corner. */
void obj_add_event(obj_chunk *c, obj_event event, const facet_allocator *allocator);
/* Room for at least one more. False: no memory, recorded in the chunk. */
bool obj_indices_grow(obj_chunk *c, obj_indices *list, const facet_allocator *allocator);

#endif
