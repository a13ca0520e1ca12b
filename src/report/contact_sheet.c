/* contact_sheet.c - images of one size in rows, with labels; see report.h. */
#include "report/report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "report/sheet_words.h"

enum { MAX_SIZE = 65536, DEFAULT_GAP = 4 };
static const float BACKGROUND = 0.0100f; /* linear, dark grey */

typedef struct layout {
    uint32_t width, height;            /* of an image */
    uint32_t columns, rows, gap, band; /* band: below each image, for its label */
} layout;

static uint32_t left_of(const layout *l, uint32_t i)
{
    return i % l->columns * (l->width + l->gap);
}

static uint32_t top_of(const layout *l, uint32_t i)
{
    return i / l->columns * (l->height + l->band + l->gap);
}

static facet_result plan(const film *const *films, uint32_t count, const facet_contact_sheet_desc *d,
                         layout *l, facet_error *error)
{
    if (!count)
        return fail(error, FACET_ERROR_ARGUMENT, "sheet: there are no images");
    *l = (layout){.width = films[0]->width, .height = films[0]->height, .columns = d->column_count};
    for (uint32_t i = 1; i < count; i++)
        if (films[i]->width != l->width || films[i]->height != l->height)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "sheet: image %u has %u x %u pixels; the first has %u x %u", i, films[i]->width,
                        films[i]->height, l->width, l->height);
    if (!l->columns)
        l->columns = (uint32_t)ceil(sqrt((double)count));
    if (l->columns > count)
        l->columns = count;
    l->rows = (count - 1) / l->columns + 1;
    l->gap = d->gap ? d->gap : DEFAULT_GAP;
    uint32_t letters = l->height / 14;
    letters = letters < 11 ? 11 : letters > 24 ? 24 : letters;
    l->band = d->labels ? 2 * letters : 0;
    uint64_t width = (uint64_t)l->columns * ((uint64_t)l->width + l->gap) - l->gap;
    uint64_t height = (uint64_t)l->rows * ((uint64_t)l->height + l->band + l->gap) - l->gap;
    if (width > MAX_SIZE || height > MAX_SIZE)
        return fail(error, FACET_ERROR_ARGUMENT, "sheet: %u images of %u x %u make one larger than %d pixels",
                    count, l->width, l->height, MAX_SIZE);
    return FACET_OK;
}

static void copy(const film *from, const layout *l, uint32_t i, film *to)
{
    const float *source = from->layers[0].pixels;
    float *target = to->layers[0].pixels + 4 * ((size_t)top_of(l, i) * to->width + left_of(l, i));
    for (uint32_t y = 0; y < l->height; y++)
        memcpy(target + 4 * (size_t)y * to->width, source + 4 * (size_t)y * l->width,
               4 * (size_t)l->width * sizeof *target);
}

static facet_result write_labels(const layout *l, uint32_t count, const facet_contact_sheet_desc *d,
                                 film *sheet, facet_error *error)
{
    sheet_word *words = mem_zalloc(&d->allocator, count, sizeof *words);
    if (!words)
        return fail_memory(error, "labels of a sheet", count * sizeof *words);
    for (uint32_t i = 0; i < count; i++) {
        sheet_word *w = &words[i];
        *w = (sheet_word){.x = (float)left_of(l, i) + 0.5f * (float)l->width,
                          .y = (float)(top_of(l, i) + l->height) + 0.68f * (float)l->band,
                          .size = 0.5f * (float)l->band,
                          .width = (float)l->width - 4.0f,
                          .strength = 0.9f,
                          .align = WORD_CENTER};
        snprintf(w->text, sizeof w->text, "%s", d->labels[i]);
    }
    image target = {.pixels = sheet->layers[0].pixels,
                    .width = sheet->width,
                    .height = sheet->height,
                    .channel_count = 4,
                    .type = IMAGE_F32};
    facet_result result = sheet_write_words(words, count, &d->allocator, &target, error);
    mem_free(words);
    return result;
}

facet_result contact_sheet_create(const film *const *films, uint32_t count,
                                  const facet_contact_sheet_desc *desc, film *out, facet_error *error)
{
    layout l = {0};
    *out = (film){0};
    facet_result result = plan(films, count, desc, &l, error);
    if (result == FACET_OK)
        result = film_create(&desc->allocator, l.columns * (l.width + l.gap) - l.gap,
                             l.rows * (l.height + l.band + l.gap) - l.gap, 0, out, error);
    if (result != FACET_OK)
        return result;
    float *p = out->layers[0].pixels;
    for (size_t i = 0; i < (size_t)out->width * out->height; i++, p += 4) {
        p[0] = p[1] = p[2] = BACKGROUND;
        p[3] = 1.0f;
    }
    for (uint32_t i = 0; i < count; i++)
        copy(films[i], &l, i, out);
    facet_error remark;
    if (desc->labels)
        result = write_labels(&l, count, desc, out, &remark);
    if (result == FACET_ERROR_SYSTEM || result == FACET_ERROR_UNSUPPORTED) {
        log_warning(&desc->log, "sheet: no labels: %s", remark.message);
        return FACET_OK;
    }
    if (result != FACET_OK) {
        fail(error, result, "%s", remark.message);
        film_destroy(out);
    }
    return result;
}
