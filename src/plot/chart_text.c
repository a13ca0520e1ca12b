/* chart_text.c - see chart_text.h. */
#include "plot/chart_text.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/utf8.h"

static const char ELLIPSIS[] = "\xe2\x80\xa6", REPLACEMENT[] = "\xef\xbf\xbd";

/* Characters without a glyph, which would break lines: controls, and U+FFFE and U+FFFF, which XML forbids. */
static bool is_control(const unsigned char *s, size_t length)
{
    return (length == 1 && (s[0] < 0x20 || s[0] == 0x7f)) || (length == 2 && s[0] == 0xc2 && s[1] < 0xa0) ||
           (length == 3 && s[0] == 0xef && s[1] == 0xbf && s[2] >= 0xbe);
}

void label_clean(const char *text, char out[LABEL_SIZE])
{
    size_t used = 0;
    for (const unsigned char *s = (const unsigned char *)(text ? text : ""); *s;) {
        size_t length = utf8_length(s, SIZE_MAX), taken = length ? length : 1;
        const char *from = length ? (const char *)s : REPLACEMENT;
        length = length ? length : strlen(REPLACEMENT);
        if (is_control((const unsigned char *)from, length)) {
            from = *s == '\n' ? "\n" : " ";
            length = 1;
        }
        if (used + length >= LABEL_SIZE)
            break;
        memcpy(out + used, from, length);
        used += length;
        s += taken;
    }
    out[used] = 0;
}

static void set_label(canvas *c, canvas_font font, const char *text, size_t length, const char *tail,
                      label_line *out)
{
    length = length < LABEL_SIZE - 4 ? length : LABEL_SIZE - 4; /* a tail has three bytes */
    memcpy(out->text, text, length);
    strcpy(out->text + length, tail);
    for (char *p = out->text; *p; p++)
        *p = *p == '\n' ? ' ' : *p;
    out->width = canvas_text_width(c, font, out->text);
}

/* The longest prefix of text (clean, length bytes) that fits with an ellipsis; empty if even the ellipsis
 * is too wide. */
static void cut(canvas *c, canvas_font font, const char *text, size_t length, double max_width,
                label_line *out)
{
    size_t low = 0, high = length < LABEL_SIZE - 4 ? length : LABEL_SIZE - 4;
    while (low < high) {
        size_t middle = (low + high + 1) / 2;
        while (middle > low && ((unsigned char)text[middle] & 0xc0) == 0x80)
            middle--;
        if (middle == low) { /* a single character remains */
            middle = low + 1;
            while (middle < high && ((unsigned char)text[middle] & 0xc0) == 0x80)
                middle++;
        }
        set_label(c, font, text, middle, ELLIPSIS, out);
        if (out->width <= max_width)
            low = middle;
        else
            high = middle - 1;
        while (high > low && ((unsigned char)text[high] & 0xc0) == 0x80)
            high--;
    }
    while (low > 0 && text[low - 1] == ' ')
        low--;
    set_label(c, font, text, low, ELLIPSIS, out);
    if (out->width > max_width)
        *out = (label_line){.text = ""};
}

void label_fit(canvas *c, canvas_font font, const char *text, double max_width, label_line *out)
{
    char clean[LABEL_SIZE];
    label_clean(text, clean);
    set_label(c, font, clean, strlen(clean), "", out);
    if (out->width > max_width)
        cut(c, font, clean, strlen(clean), max_width, out);
}

/* The bytes of text in one line: up to a line feed, or the last space before max_width; a word that is too
 * wide makes a line of its own. */
static size_t line_length(canvas *c, canvas_font font, const char *text, double max_width)
{
    size_t best = 0;
    for (size_t i = 1;; i++) {
        const bool is_end = text[i] == 0 || text[i] == '\n';
        if (!is_end && text[i] != ' ')
            continue;
        label_line l;
        set_label(c, font, text, i, "", &l);
        if (l.width > max_width)
            return best ? best : i;
        best = i;
        if (is_end)
            return best;
    }
}

int label_wrap(canvas *c, canvas_font font, const char *text, double max_width, int max_lines,
               label_line *lines)
{
    char clean[LABEL_SIZE];
    label_clean(text, clean);
    const char *rest = clean;
    int count = 0;
    while (count < max_lines) {
        while (*rest == ' ' || *rest == '\n')
            rest++;
        if (*rest == 0)
            break;
        label_line *line = &lines[count++];
        const size_t length = line_length(c, font, rest, max_width);
        const bool is_last = rest[length] == 0 || count == max_lines;
        set_label(c, font, rest, is_last ? strlen(rest) : length, "", line);
        if (line->width > max_width)
            cut(c, font, rest, is_last ? strlen(rest) : length, max_width, line);
        rest += is_last ? strlen(rest) : length;
    }
    return count;
}

void label_draw(canvas *c, const label_line *l, canvas_font font, canvas_color color, label_align align,
                double x, double y)
{
    if (*l->text)
        canvas_text(c,
                    x - l->width * (align == LABEL_LEFT     ? 0.0
                                    : align == LABEL_CENTER ? 0.5
                                                            : 1.0),
                    y, 0.0, font, color, l->text);
}

void label_draw_upright(canvas *c, const label_line *l, canvas_font font, canvas_color color, double x,
                        double y)
{
    if (*l->text)
        canvas_text(c, x + label_middle(font), y + 0.5 * l->width, -1.5707963267948966, font, color, l->text);
}

static canvas_font raised(canvas_font font)
{
    font.size *= 0.74;
    return font;
}

double label_tick_width(canvas *c, canvas_font font, const tick_label *t)
{
    double width = canvas_text_width(c, font, t->text);
    if (*t->exponent)
        width += canvas_text_width(c, raised(font), t->exponent) + 0.04 * font.size;
    return width;
}

void label_draw_tick(canvas *c, const tick_label *t, canvas_font font, canvas_color color, label_align align,
                     double x, double y)
{
    const double width = label_tick_width(c, font, t);
    x -= width * (align == LABEL_LEFT ? 0.0 : align == LABEL_CENTER ? 0.5 : 1.0);
    canvas_text(c, x, y, 0.0, font, color, t->text);
    if (*t->exponent)
        canvas_text(c, x + canvas_text_width(c, font, t->text) + 0.04 * font.size, y - 0.38 * font.size, 0.0,
                    raised(font), color, t->exponent);
}
