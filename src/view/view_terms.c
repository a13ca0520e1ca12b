/* view_terms.c - see view_terms.h. A recursive descent over sums of products, of limited depth. */
#include "view/view_terms.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/result.h"

enum { MAX_TERMS = 8, MAX_DEPTH = 16 };

/* A number, or a quantity of the term's unit. */
typedef struct quantity {
    double value;
    bool has_unit;
} quantity;

typedef struct reader {
    const char *at;
    const view_term *term;
    double scroll;
    int depth;
    bool is_wrong;
} reader;

static quantity read_sum(reader *r);

static void skip_space(reader *r)
{
    while (*r->at == ' ' || *r->at == '\t' || *r->at == '\n')
        r->at++;
}

static bool take(reader *r, const char *word)
{
    size_t length = strlen(word);
    if (strncmp(r->at, word, length) != 0)
        return false;
    r->at += length;
    return true;
}

static quantity wrong(reader *r)
{
    r->is_wrong = true;
    return (quantity){0.0, false};
}

/* A unit directly behind a number. */
static quantity read_unit(reader *r, double number)
{
    static const struct {
        const char *name;
        view_unit unit;
        double factor;
    } units[] = {{"deg", VIEW_UNIT_ANGLE, 3.14159265358979323846 / 180.0},
                 {"rad", VIEW_UNIT_ANGLE, 1.0},
                 {"mm", VIEW_UNIT_LENGTH, 1e-3},
                 {"cm", VIEW_UNIT_LENGTH, 1e-2},
                 {"m", VIEW_UNIT_LENGTH, 1.0}};
    if (take(r, "%"))
        return (quantity){number / 100.0 * r->term->whole, true};
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (take(r, units[i].name))
            return units[i].unit == r->term->unit ? (quantity){number * units[i].factor, true} : wrong(r);
    return (quantity){number, false};
}

static quantity read_group(reader *r)
{
    if (++r->depth > MAX_DEPTH)
        return wrong(r);
    quantity q = read_sum(r);
    r->depth--;
    skip_space(r);
    return take(r, ")") ? q : wrong(r);
}

static quantity read_value(reader *r)
{
    skip_space(r);
    if (take(r, "calc(") || take(r, "("))
        return read_group(r);
    if (take(r, "env(window-scroll-y)"))
        return (quantity){r->scroll, false};
    if (take(r, "auto"))
        return (quantity){r->term->automatic, true};
    char *end;
    double number = strtod(r->at, &end);
    if (end == r->at || isnan(number))
        return wrong(r);
    r->at = end;
    return read_unit(r, number);
}

/* Outside of parentheses a space ends a word, so operators are read inside only. */
static quantity read_product(reader *r)
{
    quantity left = read_value(r);
    for (;;) {
        skip_space(r);
        bool divides = *r->at == '/';
        if (!divides && *r->at != '*')
            return left;
        r->at++;
        quantity right = read_value(r);
        if (right.has_unit && (divides || left.has_unit))
            return wrong(r);
        left.value = divides ? left.value / right.value : left.value * right.value;
        left.has_unit = left.has_unit || right.has_unit;
    }
}

static quantity read_sum(reader *r)
{
    quantity left = read_product(r);
    for (;;) {
        skip_space(r);
        double sign = *r->at == '+' ? 1.0 : *r->at == '-' ? -1.0 : 0.0;
        if (sign == 0.0)
            return left;
        r->at++;
        quantity right = read_product(r);
        if (left.has_unit != right.has_unit)
            return wrong(r);
        left.value += sign * right.value;
    }
}

static double read_term(reader *r)
{
    quantity q = read_value(r);
    if (!q.has_unit && r->term->unit == VIEW_UNIT_ANGLE)
        q.value *= 3.14159265358979323846 / 180.0;
    if (isnan(q.value))
        r->is_wrong = true;
    return q.value;
}

facet_result view_terms_read(const char *name, const char *text, const view_term *terms, uint32_t count,
                             double scroll, double *values, facet_error *error)
{
    double read[MAX_TERMS];
    reader r = {.at = text, .scroll = scroll};
    for (uint32_t i = 0; i < count && i < MAX_TERMS && !r.is_wrong; i++) {
        r.term = &terms[i];
        skip_space(&r);
        read[i] = *r.at ? read_term(&r) : terms[i].automatic;
        if (*r.at && *r.at != ' ' && *r.at != '\t' && *r.at != '\n')
            r.is_wrong = true;
    }
    skip_space(&r);
    if (r.is_wrong || *r.at)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s=\"%.200s\": expected %u of numbers with %s, %% or auto, or calc() of them", name,
                    text, (unsigned)count,
                    terms[0].unit == VIEW_UNIT_ANGLE ? count > 1 ? "deg, rad and m" : "deg or rad"
                                                     : "m, cm or mm");
    memcpy(values, read, count * sizeof *values);
    return FACET_OK;
}
