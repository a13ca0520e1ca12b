/* cube_layout.h - cube maps and other spheres as flat images: crosses, strips, octahedra (facet_layout). */
#ifndef IBL_CUBE_LAYOUT_H
#define IBL_CUBE_LAYOUT_H

#include "facet/facet.h"
#include "ibl/cube.h"
#include "image/image.h"

/* What an image of these edges is; FACET_LAYOUT_AUTO: none of them. Octahedral images are not told by their edges. */
facet_layout layout_detect(uint32_t width, uint32_t height);
/* Whether the layout holds the faces of a cube map, texel by texel. */
bool layout_is_faces(facet_layout layout);
/* FACET_ERROR_INVALID: an image of these edges is not of the layout. Equirectangular ones may have any. */
facet_result layout_check(facet_layout layout, uint32_t width, uint32_t height, const char *name,
                          facet_error *error);

/* The faces of an image (F32 RGB or RGBA), borders filled: texels as they are of crosses and strips; resampled to faces
 * half as high as the image where it is equirectangular or octahedral (sphere.h). name stands first in messages.
 * FACET_ERROR_INVALID: its edges do not fit the layout; _MEMORY. */
facet_result layout_read(const image *panorama, facet_layout layout, const char *name,
                         const facet_allocator *allocator, uint32_t thread_count, cube *out,
                         facet_error *error);

/* Turns a vertical strip as OpenEXR has it, each face as it is seen from inside, into one of faces as OpenGL has them, in
 * place; and back. */
void layout_flip_inside_faces(image *strip);

/* A cube map with borders as an image (F32 RGBA, alpha 0 where a cross is empty). height: of equirectangular and octahedral
 * ones; 0: twice the cube's size. FACET_ERROR_ARGUMENT: FACET_LAYOUT_AUTO or _FACES. */
facet_result layout_write(const cube *c, facet_layout layout, uint32_t height,
                          const facet_allocator *allocator, uint32_t thread_count, image *out,
                          facet_error *error);

#endif
