/* mtl_text.c - the text of MTL files: lines, words, numbers. */
#include <math.h>
#include <string.h>
#include <strings.h>

#include "image/codec.h"
#include "io/obj/mtl_parts.h"

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

mtl_span mtl_trim(mtl_span s)
{
    while (s.begin < s.end && is_blank(*s.begin))
        s.begin++;
    while (s.begin < s.end && is_blank(s.end[-1]))
        s.end--;
    return s;
}

mtl_span mtl_next_word(mtl_span *rest)
{
    mtl_span word = mtl_trim(*rest);
    const char *end = word.begin;
    while (end < word.end && !is_blank(*end))
        end++;
    rest->begin = end;
    rest->end = word.end;
    word.end = end;
    return word;
}

bool mtl_is_word(mtl_span s, const char *word)
{
    size_t length = strlen(word);
    return mtl_length(s) == length && strncasecmp(s.begin, word, length) == 0;
}

bool mtl_to_number(mtl_span s, double *out)
{
    const char *after;
    *out = codec_parse_number(s.begin, s.end, &after);
    return after == s.end && isfinite(*out);
}

mtl_lines mtl_lines_begin(const facet_allocator *allocator, const void *bytes, size_t size)
{
    mtl_lines lines = {.at = bytes, .end = (const char *)bytes + size, .next = 1};
    if (allocator)
        lines.joined.allocator = *allocator;
    if (size >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0) /* byte order mark */
        lines.at += 3;
    return lines;
}

/* The next line of the file without its end, which is LF, CR or both; or 0, which no line may hold. */
static mtl_span take_line(mtl_lines *lines)
{
    mtl_span line = {lines->at, lines->at};
    while (line.end < lines->end && *line.end != '\n' && *line.end != '\r' && *line.end != 0)
        line.end++;
    lines->at = line.end;
    if (lines->at < lines->end)
        lines->at += lines->end - lines->at >= 2 && lines->at[0] == '\r' && lines->at[1] == '\n' ? 2 : 1;
    lines->next++;
    return line;
}

/* A backslash at the end of a line continues it, but for comments: those end in paths of Windows now and then. */
static bool is_continued(const mtl_lines *lines, mtl_span line)
{
    return line.end > line.begin && line.end[-1] == '\\' && lines->at < lines->end &&
           !(mtl_length(mtl_trim(line)) > 0 && *mtl_trim(line).begin == '#');
}

bool mtl_next_line(mtl_lines *lines, mtl_span *out)
{
    while (lines->at < lines->end && !lines->joined.has_failed) {
        lines->line = lines->next;
        mtl_span line = take_line(lines);
        if (is_continued(lines, line)) {
            lines->joined.length = 0;
            do {
                text_add_bytes(&lines->joined, line.begin, mtl_length(line) - 1);
                text_add(&lines->joined, " ");
                line = take_line(lines);
            } while (is_continued(lines, line));
            text_add_bytes(&lines->joined, line.begin, mtl_length(line));
            if (lines->joined.has_failed)
                return false;
            line = (mtl_span){lines->joined.data, lines->joined.data + lines->joined.length};
        }
        *out = mtl_trim(line);
        if (mtl_length(*out) > 0)
            return true;
    }
    return false;
}
