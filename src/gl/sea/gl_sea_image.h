/* gl_sea_image.h - the passes of one image of a sea: mesh, visible water, classes of pixels, shading. */
#ifndef FACET_GL_SEA_IMAGE_H
#define FACET_GL_SEA_IMAGE_H

#include "draw/camera_rays.h"
#include "gl/scene/gl_camera.h"
#include "gl/sea/gl_sea_block.h"
#include "gl/sea/gl_sea_model.h"
#include "gl/sea/gl_sea_state.h"

/* Programs of GL_MAIN_SEA: for water that is read with cubic filtering and without, and for all other pixels. */
typedef struct gl_sea_programs {
    GLuint cubic, linear, beside;
} gl_sea_programs;

/* The state of one image. */
typedef struct gl_sea_image {
    gl_sea *s;
    const water_frame *frame;
    camera_rays camera;
    gl_sea_fan fan;
    gl_sea_block block;
    gl_sea_model model;
    bool has_model;
    GLuint grid, surface, sorting; /* programs */
    gl_sea_programs image, layers;
    bool is_clipped;   /* to the crop, within a target of the whole image */
    uint32_t part[4];  /* of the crop, to be shaded: x, y, width, height; where is_clipped is set */
    bool is_continued; /* the visible water of the crop is known from an earlier part */
    uint32_t earlier;  /* images in the target, with which the next one is averaged */
} gl_sea_image;

/* Starts to compile the programs that the frame needs. *is_ready: they are there, or the driver cannot tell. */
facet_result gl_sea_image_request(gl_sea *s, const water_frame *frame, bool *is_ready, facet_error *error);

/* Gets programs, light, textures and mesh for the frame of d. gl_sea_model_end(&d->model) ends it, also after a
 * failure. */
facet_result gl_sea_image_prepare(gl_sea_image *d, facet_render_stats *stats, facet_error *error);

/* Moves the nodes of the mesh to the waves: once for all views of an image. */
facet_result gl_sea_image_draw_grid(gl_sea_image *d, facet_error *error);

/* Draws a view into the target. Layers have one sample per pixel, of its whole footprint. */
facet_result gl_sea_image_draw(gl_sea_image *d, const gl_target *target, const gl_view *view, bool is_layers,
                               facet_error *error);

#endif
