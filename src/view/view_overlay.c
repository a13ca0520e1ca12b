/* view_overlay.c - see view_overlay.h. Light text on a dark translucent panel, which is legible over any
 * image. */
#include "view/view_overlay.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "plot/chart_text.h"
#include "view/view_input.h"

enum { MAX_ROWS = 96, MAX_COLUMNS = 4, OVERLAY_TEXT = 512 };

static const canvas_color glass = {0.06, 0.06, 0.07, 0.86};
static const canvas_color bright = {1.0, 1.0, 1.0, 0.96};
static const canvas_color soft = {1.0, 1.0, 1.0, 0.72};

/* A row of two columns; without right it may be of any width, bold where it is a heading. */
typedef struct overlay_row {
    char left[OVERLAY_TEXT], right[OVERLAY_TEXT];
    bool is_heading, has_gap; /* above */
} overlay_row;

typedef struct overlay_rows {
    overlay_row rows[MAX_ROWS + 1]; /* one for the page footer */
    int count;
} overlay_rows;

/* Lengths in pixels. */
typedef struct overlay_metrics {
    double size, line, gap, margin, between; /* text, rows, above a group, to the border, between columns */
} overlay_metrics;

static overlay_metrics metrics_of(double size)
{
    return (overlay_metrics){size, ceil(1.5 * size), ceil(0.7 * size), ceil(0.9 * size), ceil(1.1 * size)};
}

/* ---- a block of rows ---- */

typedef struct overlay_block {
    int first, count;
    double left_width, width, height;
} overlay_block;

static overlay_block measure(canvas *c, const overlay_rows *rows, int first, int count, overlay_metrics m)
{
    overlay_block b = {.first = first, .count = count};
    double right_width = 0.0;
    double alone = 0.0;
    for (int i = first; i < first + count; i++) {
        const overlay_row *r = &rows->rows[i];
        double width = canvas_text_width(c, (canvas_font){m.size, r->is_heading}, r->left);
        if (r->right[0]) {
            b.left_width = fmax(b.left_width, width);
            right_width = fmax(right_width, canvas_text_width(c, (canvas_font){m.size, false}, r->right));
        } else {
            alone = fmax(alone, width);
        }
        b.height += m.line + (r->has_gap && i > first ? m.gap : 0.0);
    }
    b.width = fmax(alone, right_width > 0.0 ? b.left_width + m.between + right_width : 0.0);
    return b;
}

static void draw_cut(canvas *c, const char *text, canvas_font font, canvas_color color, double max_width,
                     double x, double y)
{
    label_line line;
    label_fit(c, font, text, max_width, &line);
    label_draw(c, &line, font, color, LABEL_LEFT, x, y);
}

static void draw(canvas *c, const overlay_rows *rows, const overlay_block *b, overlay_metrics m, double x,
                 double y)
{
    for (int i = b->first; i < b->first + b->count; i++) {
        const overlay_row *r = &rows->rows[i];
        y += r->has_gap && i > b->first ? m.gap : 0.0;
        double base = y + 0.5 * m.line + label_middle((canvas_font){m.size, false});
        draw_cut(c, r->left, (canvas_font){m.size, r->is_heading}, bright,
                 r->right[0] ? b->left_width + 1.0 : b->width + 1.0, x, base);
        if (r->right[0])
            draw_cut(c, r->right, (canvas_font){m.size, false}, soft,
                     fmax(b->width - b->left_width - m.between + 1.0, 0.0), x + b->left_width + m.between,
                     base);
        y += m.line;
    }
}

/* ---- panels ---- */

static facet_result open_canvas(const facet_allocator *allocator, uint32_t width, uint32_t height, canvas **c,
                                facet_error *error)
{
    return canvas_create(
        &(canvas_desc){
            .allocator = *allocator, .format = FACET_PLOT_FORMAT_PNG, .width = width, .height = height},
        c, error);
}

static void draw_glass(canvas *c, double width, double height, double radius)
{
    const double quarter = 1.57079632679489662;
    canvas_arc(c, width - radius, radius, radius, -quarter, 0.0);
    canvas_arc(c, width - radius, height - radius, radius, 0.0, quarter);
    canvas_arc(c, radius, height - radius, radius, quarter, 2.0 * quarter);
    canvas_arc(c, radius, radius, radius, 2.0 * quarter, 3.0 * quarter);
    canvas_close(c);
    canvas_fill(c, glass);
}

/* From cairo's 32-bit words to bytes. */
static facet_result read_panel(canvas *c, const facet_allocator *allocator, view_panel *out,
                               facet_error *error)
{
    const uint32_t *words;
    TRY(canvas_read(c, &words, error));
    size_t count = (size_t)out->width * out->height;
    out->pixels = mem_alloc(allocator, count, 4);
    if (!out->pixels)
        return fail_memory(error, "text", count * 4);
    for (size_t i = 0; i < count; i++) {
        out->pixels[4 * i + 0] = (unsigned char)(words[i] >> 16);
        out->pixels[4 * i + 1] = (unsigned char)(words[i] >> 8);
        out->pixels[4 * i + 2] = (unsigned char)words[i];
        out->pixels[4 * i + 3] = (unsigned char)(words[i] >> 24);
    }
    return FACET_OK;
}

/* foot: the row below all columns; -1: none. */
static facet_result draw_panel(const overlay_rows *rows, const overlay_block *blocks, int block_count,
                               int foot, overlay_metrics m, const facet_allocator *allocator, view_panel *out,
                               facet_error *error)
{
    double foot_height = foot >= 0 ? m.gap + m.line : 0.0;
    double width = 2.0 * m.margin;
    double height = 0.0;
    for (int i = 0; i < block_count; i++) {
        width += blocks[i].width + (i ? 2.0 * m.between : 0.0);
        height = fmax(height, blocks[i].height);
    }
    *out = (view_panel){.width = (uint32_t)ceil(width),
                        .height = (uint32_t)ceil(height + foot_height + 1.4 * m.margin)};
    canvas *c = NULL;
    facet_result result = open_canvas(allocator, out->width, out->height, &c, error);
    if (result == FACET_OK) {
        draw_glass(c, out->width, out->height, 0.6 * m.size);
        double x = m.margin;
        for (int i = 0; i < block_count; i++) {
            draw(c, rows, &blocks[i], m, x, 0.7 * m.margin);
            x += blocks[i].width + 2.0 * m.between;
        }
        if (foot >= 0) {
            double inside = out->width - 2.0 * m.margin;
            draw(c, rows, &(overlay_block){.first = foot, .count = 1, .width = inside}, m, m.margin,
                 0.7 * m.margin + height + m.gap);
        }
        result = read_panel(c, allocator, out, error);
    }
    canvas_destroy(c);
    if (result != FACET_OK)
        *out = (view_panel){0};
    return result;
}

/* ---- text ---- */

static void clean(const char *text, size_t length, char out[OVERLAY_TEXT])
{
    char piece[LABEL_SIZE];
    char whole[LABEL_SIZE];
    snprintf(piece, sizeof piece, "%.*s", (int)length, text);
    label_clean(piece, whole);
    size_t used = strlen(whole);
    if (used >= OVERLAY_TEXT) { /* not inside a UTF-8 character */
        used = OVERLAY_TEXT - 1;
        while (used > 0 && (whole[used] & 0xc0) == 0x80)
            used--;
    }
    memcpy(out, whole, used);
    out[used] = 0;
}

/* A single-column line that is too wide is wrapped to further rows. */
static void wrap_rows(canvas *c, overlay_rows *rows, double size, double max_width)
{
    const canvas_font font = {size, false};
    overlay_rows wrapped = {.count = 0};
    for (int i = 0; i < rows->count; i++) {
        label_line lines[LABEL_MAX_LINES];
        const overlay_row *r = &rows->rows[i];
        if (r->right[0]) {
            if (wrapped.count < MAX_ROWS)
                wrapped.rows[wrapped.count++] = *r;
            continue;
        }
        int count = label_wrap(c, font, r->left, max_width, LABEL_MAX_LINES, lines);
        for (int k = 0; k < count && wrapped.count < MAX_ROWS; k++) {
            overlay_row *w = &wrapped.rows[wrapped.count++];
            memset(w, 0, sizeof *w);
            clean(lines[k].text, strlen(lines[k].text), w->left);
        }
    }
    *rows = wrapped;
}

facet_result view_overlay_text(const char *lines, float scale, uint32_t max_width,
                               const facet_allocator *allocator, view_panel *out, facet_error *error)
{
    overlay_rows rows = {.count = 0};
    *out = (view_panel){0};
    for (const char *p = lines; *p && rows.count < MAX_ROWS;) {
        size_t length = strcspn(p, "\n");
        size_t left = strcspn(p, "\t\n");
        overlay_row *r = &rows.rows[rows.count++];
        memset(r, 0, sizeof *r);
        clean(p, left, r->left);
        if (left < length)
            clean(p + left + 1, length - left - 1, r->right);
        p += length + (p[length] == '\n');
    }
    canvas *ruler = NULL;
    TRY(open_canvas(allocator, 1, 1, &ruler, error));
    overlay_metrics m = metrics_of(13.0 * (double)scale);
    double widest = fmax((double)max_width - 2.0 * m.margin, m.size);
    wrap_rows(ruler, &rows, m.size, widest);
    overlay_block b = measure(ruler, &rows, 0, rows.count, m);
    canvas_destroy(ruler);
    b.width = fmax(fmin(b.width, widest), m.size);
    b.left_width = fmin(b.left_width, b.width);
    return draw_panel(&rows, &b, 1, -1, m, allocator, out, error);
}

/* ---- help ---- */

static void add_help_rows(overlay_rows *rows)
{
    for (uint32_t i = 0; i < view_binding_count; i++) {
        const view_binding *b = &view_bindings[i];
        char input[32];
        view_key_write(b->key, b->modifiers, input, sizeof input);
        if (!b->help) { /* described by the previous line */
            overlay_row *r = &rows->rows[rows->count - 1];
            size_t used = strlen(r->left);
            snprintf(r->left + used, sizeof r->left - used, ", %s", input);
            continue;
        }
        if (b->group) {
            overlay_row *r = &rows->rows[rows->count++];
            *r = (overlay_row){.is_heading = true, .has_gap = true};
            snprintf(r->left, sizeof r->left, "%s", b->group);
        }
        overlay_row *r = &rows->rows[rows->count++];
        memset(r, 0, sizeof *r);
        snprintf(r->left, sizeof r->left, "%s", input);
        snprintf(r->right, sizeof r->right, "%s", b->help);
    }
    rows->rows[rows->count++] = (overlay_row){.left = "Pointer", .is_heading = true, .has_gap = true};
    for (uint32_t i = 0; i < view_pointer_line_count; i++) {
        overlay_row *r = &rows->rows[rows->count++];
        memset(r, 0, sizeof *r);
        snprintf(r->left, sizeof r->left, "%s", view_pointer_lines[i].input);
        snprintf(r->right, sizeof r->right, "%s", view_pointer_lines[i].help);
    }
}

/* Groups from top to bottom, then to the right: columns of about the same number of rows, without breaking a
 * group. */
static int split(canvas *c, const overlay_rows *rows, int columns, overlay_metrics m, overlay_block *blocks)
{
    int count = 0;
    int first = 0;
    for (int i = 1; i <= rows->count; i++) {
        if (i < rows->count && !rows->rows[i].is_heading)
            continue;
        int next = i; /* the end of the following group */
        while (next < rows->count && (next == i || !rows->rows[next].is_heading))
            next++;
        bool is_full = (next - first) * columns > rows->count + columns * 3;
        if (i == rows->count || (is_full && count < columns - 1)) {
            blocks[count++] = measure(c, rows, first, i - first, m);
            first = i;
        }
    }
    return count;
}

static bool fits(const overlay_block *blocks, int count, overlay_metrics m, double width, double height)
{
    double used = 2.0 * m.margin;
    bool is_high = false;
    for (int i = 0; i < count; i++) {
        used += blocks[i].width + (i ? 2.0 * m.between : 0.0);
        is_high = is_high || blocks[i].height + 1.4 * m.margin > height;
    }
    return used <= width && !is_high;
}

/* The rows from first on that fit into a column: whole groups, or part of one that is taller than the column.
 * Returns their number. */
static int fill_column(const overlay_rows *rows, int first, overlay_metrics m, double height)
{
    double used = 0.0;
    int groups_end = first; /* of those that fit whole */
    int i = first;
    for (; i < rows->count; i++) {
        const overlay_row *r = &rows->rows[i];
        if (r->is_heading)
            groups_end = i;
        used += m.line + (r->has_gap && i > first ? m.gap : 0.0);
        if (used > height)
            break;
    }
    if (i == rows->count)
        groups_end = i;
    int count = (groups_end > first ? groups_end : i) - first;
    return count > 0 ? count : 1;
}

/* The columns, side by side, of the page that begins with row first; at least one. Returns their number;
 * *next: first row of the next page. */
static int fill_page(canvas *c, const overlay_rows *rows, int first, overlay_metrics m, double width,
                     double height, overlay_block *blocks, int *next)
{
    double used = 2.0 * m.margin;
    int count = 0;
    while (first < rows->count && count < MAX_COLUMNS) {
        int row_count = fill_column(rows, first, m, height);
        overlay_block b = measure(c, rows, first, row_count, m);
        used += b.width + (count ? 2.0 * m.between : 0.0);
        if (count && used > width)
            break;
        b.width = fmax(fmin(b.width, width - 2.0 * m.margin), m.size);
        b.left_width = fmin(b.left_width, b.width);
        blocks[count++] = b;
        first += row_count;
    }
    *next = first;
    return count;
}

/* Lays out the requested page, or the last one; the footer, which names the other pages, is the row after the
 * table's. */
static int lay_pages(canvas *c, overlay_rows *rows, overlay_metrics m, double width, double height,
                     uint32_t page, uint32_t *page_count, overlay_block *blocks)
{
    overlay_block candidates[MAX_COLUMNS];
    int count = 0;
    height -= 1.4 * m.margin + m.gap + m.line;
    *page_count = 0;
    for (int first = 0; first < rows->count;) {
        int filled = fill_page(c, rows, first, m, width, height, candidates, &first);
        if (++*page_count <= page) {
            count = filled;
            memcpy(blocks, candidates, sizeof candidates);
        }
    }
    overlay_row *r = &rows->rows[rows->count];
    memset(r, 0, sizeof *r);
    snprintf(r->left, sizeof r->left, "%u of %u. H: %s", page < *page_count ? page : *page_count, *page_count,
             page < *page_count ? "next page" : "close");
    return count;
}

/* Smallest text, as a fraction of the usual size, on one page or several. */
static const double smallest_letters = 0.8, letters_of_pages = 0.9;

facet_result view_overlay_help(float scale, uint32_t max_width, uint32_t max_height, uint32_t page,
                               uint32_t *page_count, const facet_allocator *allocator, view_panel *out,
                               facet_error *error)
{
    overlay_rows rows = {.count = 0};
    *out = (view_panel){0};
    *page_count = 1;
    add_help_rows(&rows);
    canvas *ruler = NULL;
    TRY(open_canvas(allocator, 1, 1, &ruler, error));
    overlay_block blocks[MAX_COLUMNS + 1];
    overlay_metrics m = {0};
    int count = 0;
    bool is_found = false;
    for (double size = 1.0; size >= smallest_letters && !is_found; size *= 0.94) {
        m = metrics_of(size * 13.0 * (double)scale);
        for (int columns = 1; columns <= MAX_COLUMNS && !is_found; columns++) {
            count = split(ruler, &rows, columns, m, blocks);
            is_found = fits(blocks, count, m, max_width, max_height);
        }
    }
    if (!is_found) {
        m = metrics_of(letters_of_pages * 13.0 * (double)scale);
        count = lay_pages(ruler, &rows, m, max_width, max_height, page, page_count, blocks);
    }
    canvas_destroy(ruler);
    return draw_panel(&rows, blocks, count, is_found ? -1 : rows.count, m, allocator, out, error);
}

void view_panel_destroy(view_panel *panel)
{
    mem_free(panel->pixels);
    *panel = (view_panel){0};
}
