/* cube_layout.h - cube maps and other spheres as flat pictures: crosses, strips, octahedra (facet_layout). */
#ifndef IBL_CUBE_LAYOUT_H
#define IBL_CUBE_LAYOUT_H

#include "facet/facet.h"
#include "ibl/cube.h"
#include "image/image.h"

/* What a picture of these edges is; FACET_LAYOUT_AUTO: none of them. */
facet_layout layout_detect(uint32_t width, uint32_t height);

/* The faces of a picture (F32 RGB) in a layout of cube maps, borders filled. name stands first in messages.
 * FACET_ERROR_INVALID: its edges do not fit the layout. */
facet_result layout_read(const image *picture, facet_layout layout, const char *name,
                         const facet_allocator *allocator, uint32_t thread_count, cube *out,
                         facet_error *error);

/* A cube map with borders as a picture (F32 RGBA, alpha 0 where a cross is empty). height: of equirectangular and octahedral
 * ones; 0: twice the cube's size. FACET_ERROR_ARGUMENT: FACET_LAYOUT_AUTO or _FACES. */
facet_result layout_write(const cube *c, facet_layout layout, uint32_t height,
                          const facet_allocator *allocator, uint32_t thread_count, image *out,
                          facet_error *error);

#endif
