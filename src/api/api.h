/* api.h - what the files behind facet.h share. */
#ifndef API_API_H
#define API_API_H

#include "film/film.h"

struct facet_image {
    film film; /* developed: tone-mapped, background laid under it */
    facet_render_stats stats;
    bool is_for_display; /* read from a file whose colors are a display's */
};

#endif
