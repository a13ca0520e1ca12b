/* ibl_sheet_words.h - words and lines on a sheet. */
#ifndef REPORT_IBL_SHEET_WORDS_H
#define REPORT_IBL_SHEET_WORDS_H

#include "facet/facet.h"
#include "image/image.h"

typedef enum word_align { WORD_LEFT, WORD_CENTER, WORD_RIGHT } word_align;

/* A line of text, or where text is "" a thin line to the right as long as it may be wide. */
typedef struct sheet_word {
    float x, y;     /* px; of the base line */
    float size;     /* px */
    float width;    /* longer text is cut; 0: it is not */
    float strength; /* 1: white */
    word_align align;
    bool is_bold;
    char text[160]; /* UTF-8 */
} sheet_word;

/* Writes them on a picture (F32 RGBA, linear light of a display). FACET_ERROR_SYSTEM, _UNSUPPORTED: there is no cairo, and
 * the picture is as it was; _MEMORY. */
facet_result sheet_write_words(const sheet_word *words, uint32_t count, const facet_allocator *allocator,
                               image *picture, facet_error *error);

#endif
