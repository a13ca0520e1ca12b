/* cube_layout.h - cube maps and other spheres as flat images: crosses, strips, octahedra (facet_layout). */
#ifndef IBL_CUBE_LAYOUT_H
#define IBL_CUBE_LAYOUT_H

#include "facet/facet.h"
#include "ibl/cube.h"
#include "image/image.h"

/* The layout that an image of this size has; FACET_LAYOUT_AUTO: none. The size does not identify octahedral
 * images. */
facet_layout layout_detect(uint32_t width, uint32_t height);
/* Whether the layout holds the faces of a cube map, texel by texel. */
bool layout_is_faces(facet_layout layout);
/* FACET_ERROR_INVALID: an image of this size cannot have the layout. Equirectangular images may have any
 * size. */
facet_result layout_check(facet_layout layout, uint32_t width, uint32_t height, const char *name,
                          facet_error *error);

/* The faces of an image (F32 RGB or RGBA) with borders: copied from crosses and strips; resampled (sphere.h)
 * from equirectangular and octahedral images, to faces half as high. name begins messages.
 * FACET_ERROR_INVALID: the size does not fit the layout; _MEMORY. */
facet_result layout_read(const image *panorama, facet_layout layout, const char *name,
                         const facet_allocator *allocator, uint32_t thread_count, cube *out,
                         facet_error *error);

/* Converts a vertical strip between OpenEXR's convention, faces seen from inside, and OpenGL's, in place and
 * in either direction. */
void layout_flip_inside_faces(image *strip);

/* A cube map with borders as an image (F32 RGBA, alpha 0 in the empty parts of a cross). height: of
 * equirectangular and octahedral images; 0: twice the cube's size. FACET_ERROR_ARGUMENT: FACET_LAYOUT_AUTO or
 * _FACES. */
facet_result layout_write(const cube *c, facet_layout layout, uint32_t height,
                          const facet_allocator *allocator, uint32_t thread_count, image *out,
                          facet_error *error);

#endif
