/* environment_source.h - sources of environments: files decoded, repaired, and converted to a panorama. */
#ifndef IBL_ENVIRONMENT_SOURCE_H
#define IBL_ENVIRONMENT_SOURCE_H

#include "ibl/environment.h"
#include "ibl/sphere.h"
#include "image/image.h"
#include "image/ktx2.h"

/* Repaired texels. Initialise with {.first = UINT64_MAX}. */
typedef struct environment_repairs {
    uint64_t count;
    uint64_t first; /* position of the first one, in texels */
} environment_repairs;

/* Warns once about repairs: how many, the first one at "(x, y) of PLACE"; place NULL: of the image. */
void environment_report(facet_environment *e, const environment_repairs *repairs, const char *name,
                        const char *place, uint32_t x, uint32_t y);

/* Resamples e->panorama from a cube map with borders, rotated, with enough rows to keep its resolution. */
facet_result environment_unroll(facet_environment *e, const cube *c, const sphere_turn *turn,
                                uint32_t thread_count, facet_error *error);

/* ---- six faces ---- */

extern const char *const cube_face_names[6]; /* "+X" "-X" "+Y" "-Y" "+Z" "-Z" */

typedef struct cube_face {
    const void *bytes;
    size_t size;
    const char *name; /* for messages */
    image image;      /* decoded, including values that are not finite */
    float largest;    /* replaces infinity */
    image_note note;  /* from decoding */
    facet_result result;
    facet_error error;
} cube_face;

/* Decodes the faces in parallel. FACET_ERROR_INVALID: not square, or of different sizes; and the errors of
 * image_decode(). */
facet_result cube_faces_decode(cube_face faces[6], const facet_environment_desc *desc, facet_error *error);
void cube_faces_destroy(cube_face faces[6]); /* {0} is allowed */

/* Makes a cube map without borders of the images, which are repaired and released one by one. */
facet_result cube_faces_assemble(cube_face faces[6], const facet_allocator *allocator, uint32_t thread_count,
                                 cube *out, environment_repairs *repairs, facet_error *error);
/* The face, column and row of environment_repairs.first. */
void cube_faces_place(const cube *c, uint64_t place, uint32_t *face, uint32_t *x, uint32_t *y);

/* Discontinuity between faces in [0, 1]: the mean over the texels along edges of |a - b| / (a + b), b across
 * the edge. */
double scene_cube_seams(const cube *c);

#endif
