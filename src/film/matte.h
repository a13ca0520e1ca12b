/* matte.h - the Cryptomatte layers of a film: the IDs that cover most of each pixel, each with its coverage.
 * Specification 1.2.0 (Friedman and Jones 2015). scene/identity.h defines the IDs. */
#ifndef FILM_MATTE_H
#define FILM_MATTE_H

#include "film/film.h"

enum { MATTE_KINDS = 3 /* objects, materials, instances */, MATTE_RANKS = 6 };

typedef struct matte_layers {
    uint32_t aovs; /* those of FACET_AOV_CRYPTOMATTE that the film has; 0: nothing to do */
    float *pixels[MATTE_KINDS][MATTE_RANKS / 2];
} matte_layers;

matte_layers matte_find(film *f);
/* Sets all coverages to 0. */
void matte_clear(const matte_layers *m, size_t pixel_count);
/* Adds weight to the coverage of ids[kind] in each layer that the film has. A seventh ID of a pixel replaces
 * the one with the smallest coverage if its own is larger; the smaller coverage is lost either way. Different
 * pixels may be added to concurrently. */
void matte_add(const matte_layers *m, size_t pixel, const float ids[MATTE_KINDS], float weight);
/* Multiplies the coverages of a pixel by scale, clamps them to [0, 1] and sorts them, the largest first. */
void matte_finish(const matte_layers *m, size_t pixel, float scale);

/* The metadata of a layer: names of attributes, i below MATTE_TEXTS. */
enum { MATTE_TEXTS = 4, MATTE_TEXT_NAME_SIZE = 64 };
void matte_text_name(uint32_t kind, uint32_t i, char name[MATTE_TEXT_NAME_SIZE]);
/* Adds the metadata that names a layer and its IDs. kind: 0 to MATTE_KINDS - 1. FACET_ERROR_MEMORY. */
facet_result matte_describe(film *f, uint32_t kind, const char *manifest, const facet_allocator *allocator,
                            facet_error *error);

#endif
