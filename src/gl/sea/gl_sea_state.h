/* gl_sea_state.h - what a renderer of seas keeps from image to image, for the files of this folder. */
#ifndef FACET_GL_SEA_STATE_H
#define FACET_GL_SEA_STATE_H

#include "gl/core/gl_api.h"
#include "gl/core/gl_program.h"
#include "gl/core/gl_target.h"
#include "gl/scene/gl_light_atlas.h"
#include "gl/sea/gl_sea.h"
#include "gl/sea/gl_sea_mesh.h"
#include "gl/sea/gl_sea_textures.h"

struct gl_sea {
    facet_allocator allocator;
    gl_context own, *context; /* own: {0} before its creation or after its loss */
    gl_api api;               /* of own */
    gl_programs *programs;
    gl_sea_textures textures;
    gl_light_atlas atlas;
    gl_target grid, seen, target;
    /* those whose parts are in the atlas: referenced, so they do not change */
    facet_environment *environments[2];
    gl_sea_mesh mesh;
    GLuint frame_buffer, light_buffer, sea_buffer, empty_array;
};

/* Makes the context current, and creates what is missing: all of it after a loss. */
facet_result gl_sea_start(gl_sea *sea, facet_error *error);

/* Frees all OpenGL objects, and its own context. */
void gl_sea_stop(gl_sea *sea);

/* Frees the light of the image that the sky was. */
void gl_sea_forget_light(gl_sea *sea);

void gl_sea_set_block(GLuint buffer, GLuint point, const void *block, size_t size);

#endif
