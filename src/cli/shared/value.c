/* value.c - see value.h. */
#include "cli/shared/value.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define DEGREE 0.017453292519943295 /* pi / 180 */

/* degrees or radians; floats still resolve a tenth of a degree */
static const double MAX_ANGLE = 1e4;

static const char *skip_blanks(const char *text)
{
    return text + strspn(text, " \t");
}

bool scan_number(const char **text, double *number)
{
    const char *start = skip_blanks(*text);
    const char *digits = start + (*start == '+' || *start == '-');
    size_t length = strspn(digits, "0123456789.");
    /* strtod() would also accept hexadecimal, inf and nan */
    if (strcspn(digits, "0123456789") >= length ||
        (digits[0] == '0' && (digits[1] == 'x' || digits[1] == 'X') && strspn(digits + 2, "0123456789") == 0))
        return false;
    char *end;
    double parsed;
    if (digits[0] == '0' && (digits[1] == 'x' || digits[1] == 'X')) { /* "0x480" as a size: the number is 0 */
        parsed = 0.0;
        end = (char *)(uintptr_t)(digits + 1);
    } else {
        parsed = strtod(start, &end);
    }
    if (end == start || !isfinite(parsed))
        return false;
    *text = end;
    *number = parsed;
    return true;
}

bool value_number(const char *text, double *number)
{
    double parsed;
    if (!scan_number(&text, &parsed) || *skip_blanks(text))
        return false;
    *number = parsed;
    return true;
}

bool value_numbers(const char *text, size_t count, double *numbers)
{
    double parsed[16];
    for (size_t i = 0; i < count; i++) {
        if (i > 0) {
            text = skip_blanks(text);
            text += *text == ',';
        }
        if (!scan_number(&text, &parsed[i]))
            return false;
    }
    if (*skip_blanks(text))
        return false;
    memcpy(numbers, parsed, count * sizeof *numbers);
    return true;
}

/* Converts an integral number from minimum to maximum. */
static bool whole(double number, double minimum, double maximum, uint32_t *out)
{
    if (!(number >= minimum && number <= maximum) || number != floor(number))
        return false;
    *out = (uint32_t)number;
    return true;
}

bool value_size(const char *text, uint32_t *width, uint32_t *height)
{
    static const char times[] = "\xc3\x97"; /* the multiplication sign in UTF-8 */
    const double largest = 65536.0;
    double w, h;
    uint32_t parsed[2];
    if (!scan_number(&text, &w))
        return false;
    text = skip_blanks(text);
    h = w;
    if (*text) {
        if (strncmp(text, times, 2) == 0)
            text += 2;
        else if (*text == 'x' || *text == 'X' || *text == ',')
            text++;
        else
            return false;
        if (!value_number(text, &h))
            return false;
    }
    if (!whole(w, 1.0, largest, &parsed[0]) || !whole(h, 1.0, largest, &parsed[1]))
        return false;
    *width = parsed[0];
    *height = parsed[1];
    return true;
}

bool value_rectangle(const char *text, uint32_t rectangle[4])
{
    double numbers[4];
    uint32_t parsed[4];
    if (!value_numbers(text, 4, numbers))
        return false;
    for (int i = 0; i < 4; i++)
        if (!whole(numbers[i], i < 2 ? 0.0 : 1.0, 65536.0, &parsed[i]))
            return false;
    memcpy(rectangle, parsed, sizeof parsed);
    return true;
}

/* Multiplies *number by the factor of the unit text; the first unit is "". */
typedef struct unit {
    const char *name;
    double factor;
} unit;

static bool apply_unit(const char *text, const unit *units, double *number)
{
    text = skip_blanks(text);
    for (; units->name; units++)
        if (strcasecmp(text, units->name) == 0) {
            *number *= units->factor;
            return true;
        }
    return false;
}

bool value_bytes(const char *text, uint64_t *bytes)
{
    const double K = 1024.0, M = K * K, G = M * K, T = G * K;
    const unit units[] = {{"", 1},    {"B", 1},  {"K", K},   {"KB", K},  {"KiB", K},
                          {"M", M},   {"MB", M}, {"MiB", M}, {"G", G},   {"GB", G},
                          {"GiB", G}, {"T", T},  {"TB", T},  {"TiB", T}, {NULL, 0}};
    double number;
    if (!scan_number(&text, &number) || !apply_unit(text, units, &number) || number < 0.0 || number > 9e18)
        return false;
    *bytes = (uint64_t)number;
    return true;
}

bool value_seconds(const char *text, double *seconds)
{
    static const unit units[] = {{"", 1},   {"s", 1},    {"sec", 1},  {"ms", 1e-3},
                                 {"m", 60}, {"min", 60}, {"h", 3600}, {NULL, 0}};
    double number;
    if (!scan_number(&text, &number) || !apply_unit(text, units, &number) || !(number > 0.0) || number > 1e9)
        return false;
    *seconds = number;
    return true;
}

bool value_exposure(const char *text, double *stops)
{
    double number;
    if (!scan_number(&text, &number))
        return false;
    text = skip_blanks(text);
    if (strcasecmp(text, "x") == 0) {
        if (!(number > 0.0))
            return false;
        number = log2(number);
    } else if (*text && strcasecmp(text, "ev") != 0 && strcasecmp(text, "stops") != 0) {
        return false;
    }
    if (fabs(number) > 100.0)
        return false;
    *stops = number;
    return true;
}

bool value_metered_exposure(const char *text, bool *is_metered, double *stops)
{
    *stops = 0.0;
    *is_metered = strncmp(text, "auto", 4) == 0;
    text += *is_metered ? 4 : 0;
    return (*is_metered && !*text) || value_exposure(text, stops);
}

bool value_angle(const char *text, double *radians)
{
    static const unit units[] = {{"", DEGREE}, {"deg", DEGREE}, {"rad", 1.0}, {NULL, 0}};
    double number;
    if (!scan_number(&text, &number) || !apply_unit(text, units, &number) || fabs(number) > MAX_ANGLE)
        return false;
    *radians = number;
    return true;
}

/* ---- lists of frame numbers ---- */

static bool scan_whole(const char **text, uint32_t *number)
{
    const char *at = *text;
    uint32_t value = 0;
    if (*at < '0' || *at > '9')
        return false;
    for (; *at >= '0' && *at <= '9'; at++) {
        value = 10 * value + (uint32_t)(*at - '0');
        if (value > 100000000)
            return false;
    }
    *text = at;
    *number = value;
    return true;
}

static bool skip(const char **text, const char *word)
{
    size_t length = strlen(word);
    if (strncmp(*text, word, length) != 0)
        return false;
    *text += length;
    return true;
}

static uint32_t count_of(const frame_range *r)
{
    return (r->last - r->first) / r->step + 1;
}

static bool scan_range(const char **text, frame_range *out)
{
    while (skip(text, " "))
        ;
    if (!scan_whole(text, &out->first))
        return false;
    out->last = out->first;
    out->step = 1;
    if ((skip(text, "-") || skip(text, "..")) && !scan_whole(text, &out->last))
        return false;
    if (skip(text, "x") && !scan_whole(text, &out->step))
        return false;
    while (skip(text, " "))
        ;
    return out->first >= 1 && out->last >= out->first && out->step > 0;
}

bool frame_list_parse(const char *text, frame_list *out)
{
    frame_list list = {0};
    do {
        if (list.range_count == FRAME_LIST_RANGES || !scan_range(&text, &list.ranges[list.range_count]))
            return false;
        uint32_t count = count_of(&list.ranges[list.range_count++]);
        if (count > FRAME_LIST_FRAMES - list.frame_count)
            return false;
        list.frame_count += count;
    } while (skip(&text, ","));
    if (*text)
        return false;
    *out = list;
    return true;
}

frame_list frame_list_all(uint32_t first, uint32_t last)
{
    frame_list list = {.range_count = 1, .ranges = {{first, last, 1}}};
    list.frame_count = count_of(&list.ranges[0]);
    return list;
}

uint32_t frame_list_at(const frame_list *list, uint32_t index)
{
    const frame_range *r = list->ranges;
    for (; index >= count_of(r); r++)
        index -= count_of(r);
    return r->first + index * r->step;
}
