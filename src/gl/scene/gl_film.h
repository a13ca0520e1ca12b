/* gl_film.h - renders a film in tiles and passes, where an image exceeds OpenGL's size limit or number of
 * samples. What a view shows is drawn by functions of the caller: a scene (gl_renderer.c), or a sea (gl_sea.c). */
#ifndef GL_GL_FILM_H
#define GL_GL_FILM_H

#include "draw/render_watch.h"
#include "film/film.h"
#include "gl/core/gl_target.h"
#include "gl/scene/gl_camera.h"
#include "scene/identity.h"

typedef facet_result gl_film_draw_function(void *self, const gl_target *target, const gl_view *view,
                                           facet_error *error);

/* What is rendered. */
typedef struct gl_film_desc {
    gl_context *context;
    const facet_render_desc *render; /* resolved */
    gl_target *target;               /* kept from image to image */
    gl_sampling sampling;            /* of the image */
    /* passes that read other pixels (transmission, bloom) need as much of the whole image as possible */
    bool looks_around;
    double deadline_s; /* of clock_seconds(); 0: none */
    /* Indexed by the number in the layers of draw_layers(); NULL: no requested layer needs them. */
    const scene_identity *identities;
    uint32_t identity_count;
    void *self;                  /* of both functions, for a view that fills a target of the same size */
    gl_film_draw_function *draw; /* the image, resolved: radiance times exposure, premultiplied */
    gl_film_draw_function
        *draw_layers; /* GL_TARGET_LAYERED: outputs of surface_io.glsl, opacity 0 for no surface */
} gl_film_desc;

/* Fills all layers of the film. Fails with FACET_ERROR_MEMORY, FACET_ERROR_LIMIT past the deadline,
 * FACET_ERROR_CANCELLED, FACET_ERROR_SYSTEM. */
facet_result gl_film_draw(const gl_film_desc *desc, film *target, facet_error *error);

#endif
