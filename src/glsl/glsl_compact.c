/* glsl_compact.c - see glsl_compact.h. */
#include "glsl/glsl_compact.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

/* The end of the comment that begins at c; c: none begins there. The newline after "//" is no part of it. */
static const char *skip_comment(const char *c)
{
    if (c[0] != '/' || (c[1] != '*' && c[1] != '/'))
        return c;
    const char *end = c[1] == '*' ? strstr(c + 2, "*/") : strchr(c, '\n');
    if (!end)
        return c + strlen(c);
    return c[1] == '*' ? end + 2 : end;
}

static bool is_name(char c)
{
    return isalnum((unsigned char)c) || c == '_';
}

static bool is_operator(char c)
{
    return c && strchr("+-*/%<>=!&|^", c);
}

/* Whether the tokens that end with a and begin with b would become others without a space. */
static bool would_merge(char a, char b)
{
    return (is_name(a) && is_name(b)) || (is_operator(a) && is_operator(b));
}

void glsl_compact(char *text)
{
    char *out = text, *line = text; /* line: where the current one begins in the output */
    bool has_space = false;
    for (const char *c = text; *c;) {
        const char *after = skip_comment(c);
        if (after != c || (*c != '\n' && isspace((unsigned char)*c))) {
            has_space = true;
            c = after != c ? after : c + 1;
            continue;
        }
        if (*c == '\n') {
            if (out != line)
                *out++ = '\n';
            line = out;
        } else {
            if (has_space && out != line && (*line == '#' || would_merge(out[-1], *c)))
                *out++ = ' ';
            *out++ = *c;
        }
        has_space = false;
        c++;
    }
    *out = 0;
}
