/* sheet_words.c - see sheet_words.h. cairo draws in white on transparent; coverage blends in display
 * values, which keeps the weight of letters. */
#include "report/sheet_words.h"

#include "image/srgb.h"
#include "plot/chart_text.h"

static void write_word(canvas *c, const sheet_word *w)
{
    const canvas_color color = {1.0, 1.0, 1.0, (double)w->strength};
    double x = (double)w->x;
    double y = (double)w->y;
    if (!w->text[0]) {
        canvas_rectangle(c, x, y, (double)w->width, 1.0);
        canvas_fill(c, color);
        return;
    }
    static const label_align aligns[] = {LABEL_LEFT, LABEL_CENTER, LABEL_RIGHT};
    const canvas_font font = {(double)w->size, w->is_bold};
    label_line line;
    label_fit(c, font, w->text, w->width > 0.0f ? (double)w->width : 1e5, &line);
    label_draw(c, &line, font, color, aligns[w->align], x, y);
}

/* Premultiplied white: coverage is any of its channels. */
static void blend_over(const uint32_t *pixels, image *target)
{
    float *p = target->pixels;
    for (size_t i = 0; i < (size_t)target->width * target->height; i++, p += 4) {
        double share = (double)(pixels[i] & 255u) / 255.0;
        if (share == 0.0)
            continue;
        for (int c = 0; c < 3; c++) {
            double below = srgb_encode(p[c] < 1.0f ? (double)p[c] : 1.0);
            double encoded = below + (1.0 - below) * share;
            p[c] = encoded < 1.0 ? (float)srgb_decode(encoded) : 1.0f;
        }
    }
}

facet_result sheet_write_words(const sheet_word *words, uint32_t count, const facet_allocator *allocator,
                               image *target, facet_error *error)
{
    canvas *c = NULL;
    facet_result result = canvas_create(&(canvas_desc){.allocator = *allocator,
                                                       .format = FACET_PLOT_FORMAT_PNG,
                                                       .width = target->width,
                                                       .height = target->height},
                                        &c, error);
    if (result != FACET_OK)
        return result;
    for (uint32_t i = 0; i < count; i++)
        write_word(c, &words[i]);
    const uint32_t *pixels = NULL;
    result = canvas_read(c, &pixels, error);
    if (result == FACET_OK)
        blend_over(pixels, target);
    canvas_destroy(c);
    return result;
}
