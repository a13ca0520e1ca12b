/* cube_faces.h - the six files of a cube map, decoded. */
#ifndef IBL_CUBE_FACES_H
#define IBL_CUBE_FACES_H

#include "ibl/environment_source.h"

extern const char *const cube_face_names[6]; /* "+X" "-X" "+Y" "-Y" "+Z" "-Z" */

typedef struct cube_face {
    const void *bytes;
    size_t size;
    const char *name; /* for messages */
    image picture;    /* decoded, with what is not finite */
    float largest;    /* what infinity becomes */
    image_note note;  /* of decoding */
    facet_result result;
    facet_error error;
} cube_face;

/* Decodes them side by side. FACET_ERROR_INVALID: not square, or not of one size; and how image_decode() fails. */
facet_result cube_faces_decode(cube_face faces[6], const facet_environment_desc *desc, facet_error *error);
void cube_faces_destroy(cube_face faces[6]); /* {0} is allowed */

/* The pictures as a cube map without borders, repaired and released one by one. */
facet_result cube_faces_assemble(cube_face faces[6], const facet_allocator *allocator, uint32_t thread_count,
                                 cube *out, environment_repairs *repairs, facet_error *error);
/* The face, column and row of environment_repairs.first. */
void cube_faces_place(const cube *c, uint64_t place, uint32_t *face, uint32_t *x, uint32_t *y);

#endif
