/* sheet_words.h - text and lines on a sheet. */
#ifndef REPORT_SHEET_WORDS_H
#define REPORT_SHEET_WORDS_H

#include "facet/facet.h"
#include "image/image.h"

typedef enum word_align { WORD_LEFT, WORD_CENTER, WORD_RIGHT } word_align;

/* A line of text; if text is "", a thin line of that width. */
typedef struct sheet_word {
    float x, y;     /* px; of the baseline */
    float size;     /* px */
    float width;    /* longer text is cut; 0: not */
    float strength; /* 1: white */
    word_align align;
    bool is_bold;
    char text[160]; /* UTF-8 */
} sheet_word;

/* Draws them into an image (F32 RGBA, display-referred linear). FACET_ERROR_SYSTEM, _UNSUPPORTED: cairo is
 * missing, and the image is unchanged; _MEMORY. */
facet_result sheet_write_words(const sheet_word *words, uint32_t count, const facet_allocator *allocator,
                               image *target, facet_error *error);

#endif
