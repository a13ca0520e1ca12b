/* bake_text.h - harmonics and tables as text: JSON, arrays in C, and what Filament's cmgen writes. */
#ifndef CLI_BAKE_TEXT_H
#define CLI_BAKE_TEXT_H

#include "facet/facet.h"

#include <stddef.h>

/* Text that grows; free(data) releases it. {0} starts it. */
typedef struct bake_text {
    char *data;
    size_t size, capacity;
    bool has_failed; /* out of memory */
} bake_text;

/* Nine coefficients by facet_sh_form, with what they are said in the file. source: the environment's name. */
void bake_text_sh_json(bake_text *t, const float sh[3][9][3], const char *source, bool is_windowed);
void bake_text_sh_header(bake_text *t, const float sh[3][9][3], const char *source, const char *symbol);
/* As cmgen's sh.txt: FACET_SH_FORM_FOLDED, a line each. */
void bake_text_sh_filament(bake_text *t, const float folded[9][3]);
/* A table's first channel_count channels as an array of C. what: a sentence on them. */
void bake_text_table(bake_text *t, const facet_image_view *table, uint32_t channel_count, const char *what,
                     const char *symbol);

/* path's base name without extension as an identifier of C. */
void bake_text_symbol(const char *path, char *symbol, size_t size);

#endif
