/* api.h - what the files behind facet.h share. */
#ifndef API_API_H
#define API_API_H

#include "film/film.h"
#include "gl/gl_entry.h"

struct image; /* image/image.h */

struct facet_image {
    film film;            /* tone-mapped over its background; layer 0 has no pixels where there are texels */
    struct image *texels; /* those of a file as they are (facet_image_load_desc.is_compact); NULL: none */
    bool is_straight;     /* the colors of texels are not multiplied by alpha yet */
    facet_render_stats stats;
    bool is_for_display; /* read from a file whose colors are a display's */
    bool is_part;        /* not finished; for an OpenEXR file (facet_part_desc) */
};

/* facet_render() by a renderer of OpenGL that is there already, a window's. */
facet_result render_by_gl(gl_renderer *renderer, const facet_render_desc *desc, facet_image **image,
                          facet_error *error);

#endif
