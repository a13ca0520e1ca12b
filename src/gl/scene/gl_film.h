/* gl_film.h - renders a film in tiles and passes, where an image exceeds OpenGL's size limit or number of
 * samples. */
#ifndef GL_GL_FILM_H
#define GL_GL_FILM_H

#include "draw/render_watch.h"
#include "film/film.h"
#include "gl/scene/gl_frame.h"

/* What is rendered; the frame is up to date. */
typedef struct gl_film_desc {
    gl_frame *frame;
    const gl_scene *scene;
    const camera_rays *camera;
    const facet_render_desc *render; /* resolved */
    gl_target *target;               /* kept from image to image */
    double deadline_s;               /* of clock_seconds(); 0: none */
} gl_film_desc;

/* Fills all layers of the film. Fails with FACET_ERROR_MEMORY, FACET_ERROR_LIMIT past the deadline,
 * FACET_ERROR_CANCELLED, FACET_ERROR_SYSTEM. */
facet_result gl_film_draw(const gl_film_desc *desc, film *target, facet_error *error);

#endif
