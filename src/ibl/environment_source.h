/* environment_source.h - what was decoded as the source of an environment: repaired, counted, laid out. */
#ifndef IBL_ENVIRONMENT_SOURCE_H
#define IBL_ENVIRONMENT_SOURCE_H

#include "ibl/environment.h"
#include "ibl/sphere.h"
#include "image/image.h"
#include "image/ktx2.h"

/* What was wrong with texels. {.first = UINT64_MAX} at first. */
typedef struct environment_repairs {
    uint64_t count;
    uint64_t first; /* place of the first: what of an image is before it, in texels */
} environment_repairs;

/* Says once what was repaired, where: "texel (x, y) of PLACE"; place NULL: of the image. */
void environment_report(facet_environment *e, const environment_repairs *repairs, const char *name,
                        const char *place, uint32_t x, uint32_t y);

/* e->image of a cube map (borders filled), as turned: so many rows that nothing that can be seen is lost. */
facet_result environment_unroll(facet_environment *e, const cube *c, const sphere_turn *turn,
                                uint32_t thread_count, facet_error *error);

/* ---- six faces ---- */

extern const char *const cube_face_names[6]; /* "+X" "-X" "+Y" "-Y" "+Z" "-Z" */

typedef struct cube_face {
    const void *bytes;
    size_t size;
    const char *name; /* for messages */
    image image;      /* decoded, with what is not finite */
    float largest;    /* what infinity becomes */
    image_note note;  /* of decoding */
    facet_result result;
    facet_error error;
} cube_face;

/* Decodes them side by side. FACET_ERROR_INVALID: not square, or not of one size; and how image_decode() fails. */
facet_result cube_faces_decode(cube_face faces[6], const facet_environment_desc *desc, facet_error *error);
void cube_faces_destroy(cube_face faces[6]); /* {0} is allowed */

/* The images as a cube map without borders, repaired and released one by one. */
facet_result cube_faces_assemble(cube_face faces[6], const facet_allocator *allocator, uint32_t thread_count,
                                 cube *out, environment_repairs *repairs, facet_error *error);
/* The face, column and row of environment_repairs.first. */
void cube_faces_place(const cube *c, uint64_t place, uint32_t *face, uint32_t *x, uint32_t *y);

/* How badly faces meet: the mean over the texels along edges of |a - b| / (a + b), b across the edge; in [0, 1]. */
double scene_cube_seams(const cube *c);

#endif
