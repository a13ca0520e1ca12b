/* outline.h - whether what a film shows stands out from its background. */
#ifndef FILM_OUTLINE_H
#define FILM_OUTLINE_H

#include "film/film.h"

/* Whether most of the outline has the color of the background, linear Rec.709, once it is tone mapped: by a difference
 * of less than 16 of 255 codes in every channel. False where there is hardly an outline. */
bool film_outline_is_hidden(const film *f, facet_tonemap operator_, const float background[3]);

#endif
