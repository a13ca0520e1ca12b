/* chart_csv.c - the numbers of a chart as CSV (RFC 4180, lines end with LF): a block for each panel, after
 * a line "# title"; numbers are the shortest that read back as the same double, NaN is empty. */
#include "plot/chart.h"

#include <string.h>

#include "base/result.h"
#include "base/text.h"
#include "plot/chart_ticks.h"

/* Quoted if necessary. */
static void add_field(text *t, const char *field)
{
    if (!strpbrk(field, ",\"\r\n") && field[0] != '#') {
        text_add(t, field);
        return;
    }
    text_add(t, "\"");
    for (const char *p = field; *p; p++) {
        if (*p == '"')
            text_add(t, "\"");
        text_add_bytes(t, p, 1);
    }
    text_add(t, "\"");
}

static void add_number(text *t, double value)
{
    char digits[NUMBER_SIZE];
    number_shortest(value, digits);
    text_add(t, digits);
}

static const char *name_or(const char *name, const char *other)
{
    return name && *name ? name : other;
}

/* "# text", of one line. */
static void add_comment(text *t, const char *comment)
{
    text_add(t, "# ");
    for (const char *p = comment; *p; p++)
        text_add_bytes(t, *p == '\n' || *p == '\r' ? " " : p, 1);
    text_add(t, "\n");
}

/* ---- curves ---- */

static bool shares_x(const chart_curve *a, const chart_curve *b)
{
    return a->count == b->count &&
           (a->x == b->x || a->count == 0 || memcmp(a->x, b->x, a->count * sizeof *a->x) == 0);
}

/* The first curve with the same x as curve i. */
static size_t leader_of(const chart_panel *p, size_t i)
{
    for (size_t k = 0; k < i; k++)
        if (shares_x(&p->curves[k], &p->curves[i]))
            return k;
    return i;
}

static void add_heads(text *t, const chart_panel *p, const size_t *leaders)
{
    const char *x = name_or(p->x.label, p->kind == CHART_POLAR ? "angle, rad" : "x"),
               *y = name_or(p->y.label, "y");
    for (size_t i = 0; i < p->curve_count; i++) {
        if (leaders[i] != i)
            continue;
        if (i > 0)
            text_add(t, ",");
        add_field(t, x);
        for (size_t k = i; k < p->curve_count; k++) {
            if (leaders[k] != i)
                continue;
            text head = {.allocator = t->allocator};
            if (p->curves[k].name && *p->curves[k].name) {
                text_add(&head, p->curves[k].name);
                if (p->y.label && *p->y.label)
                    text_add(&head, ": ");
            }
            if ((p->y.label && *p->y.label) || head.length == 0)
                text_add(&head, y);
            text_add(t, ",");
            add_field(t, head.data ? head.data : "");
            t->has_failed = t->has_failed || head.has_failed;
            text_destroy(&head);
        }
    }
    text_add(t, "\n");
}

static void add_row(text *t, const chart_panel *p, const size_t *leaders, size_t row)
{
    for (size_t i = 0; i < p->curve_count; i++) {
        if (leaders[i] != i)
            continue;
        if (i > 0)
            text_add(t, ",");
        if (row < p->curves[i].count)
            add_number(t, p->curves[i].x[row]);
        for (size_t k = i; k < p->curve_count; k++) {
            if (leaders[k] != i)
                continue;
            text_add(t, ",");
            if (row < p->curves[k].count)
                add_number(t, p->curves[k].y[row]);
        }
    }
    text_add(t, "\n");
}

static void add_curves(text *t, const chart_panel *p)
{
    size_t *leaders = mem_alloc(&t->allocator, p->curve_count, sizeof *leaders), row_count = 0;
    if (!leaders) {
        t->has_failed = true;
        return;
    }
    for (size_t i = 0; i < p->curve_count; i++) {
        leaders[i] = leader_of(p, i);
        row_count = p->curves[i].count > row_count ? p->curves[i].count : row_count;
    }
    add_heads(t, p, leaders);
    for (size_t row = 0; row < row_count && !t->has_failed; row++)
        add_row(t, p, leaders, row);
    mem_free(leaders);
}

/* ---- fields and surfaces ---- */

static void add_named_field(text *t, const char *field)
{
    add_field(t, field);
    text_add(t, ",");
}

static void add_grid(text *t, const chart_panel *p)
{
    const chart_field *f = p->field;
    add_named_field(t, name_or(p->x.label, "x"));
    add_named_field(t, name_or(p->y.label, "y"));
    add_field(t, name_or(f->label, "value"));
    text_add(t, "\n");
    for (uint32_t row = 0; row < f->height; row++)
        for (uint32_t column = 0; column < f->width && !t->has_failed; column++) {
            add_number(t, f->x0 + (f->x1 - f->x0) * (column + 0.5) / f->width);
            text_add(t, ",");
            add_number(t, f->y1 - (f->y1 - f->y0) * (row + 0.5) / f->height);
            text_add(t, ",");
            add_number(t, f->values[(size_t)row * f->width + column]);
            text_add(t, "\n");
        }
}

static void add_surface(text *t, const chart_surface *s)
{
    text_add(t, "x,y,z,");
    add_field(t, name_or(s->label, "value"));
    text_add(t, "\n");
    for (size_t i = 0; i < (size_t)s->width * s->height && !t->has_failed; i++) {
        add_number(t, s->x[i]);
        text_add(t, ",");
        add_number(t, s->y[i]);
        text_add(t, ",");
        add_number(t, s->z[i]);
        text_add(t, ",");
        add_number(t, s->values ? s->values[i] : s->z[i]);
        text_add(t, "\n");
    }
}

static void add_panel(text *t, const chart_panel *p, const char *title, uint32_t number)
{
    if (number > 1)
        text_add(t, "\n");
    if (title && *title) {
        add_comment(t, title);
    } else {
        text_addf(t, "# panel %u\n", number);
    }
    if (p->note && *p->note)
        add_comment(t, p->note);
    const bool has_field = (p->kind == CHART_FIELD || p->kind == CHART_DISC) && p->field;
    if (has_field)
        add_grid(t, p);
    if (p->kind == CHART_SURFACE && p->surface)
        add_surface(t, p->surface);
    if (p->curve_count > 0 && p->kind != CHART_DISC && p->kind != CHART_SURFACE) {
        if (has_field)
            text_add(t, "\n");
        add_curves(t, p);
    }
}

facet_result chart_write_csv(const chart *c, const facet_allocator *allocator, unsigned char **bytes,
                             size_t *size, facet_error *error)
{
    text t = {.allocator = allocator ? *allocator : (facet_allocator){0}};
    *bytes = NULL;
    *size = 0;
    text_add(&t, ""); /* a chart without panels gives an empty file */
    for (uint32_t i = 0; i < c->panel_count; i++) {
        const char *title = c->panels[i].title;
        if (c->panel_count == 1)
            title = name_or(title, c->title);
        add_panel(&t, &c->panels[i], title, i + 1);
    }
    if (t.has_failed) {
        text_destroy(&t);
        return fail_memory(error, "CSV of a plot", t.length);
    }
    *bytes = (unsigned char *)t.data;
    *size = t.length;
    return FACET_OK;
}
