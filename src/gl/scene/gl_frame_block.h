/* gl_frame_block.h - the uniform block that all programs of a view share: blocks.glsl. */
#ifndef GL_GL_FRAME_BLOCK_H
#define GL_GL_FRAME_BLOCK_H

#include "gl/scene/gl_frame.h"

/* What follows from the description and the light. */
void gl_frame_fill_block(const gl_frame *frame, const facet_render_desc *desc, gl_frame_block *block);
/* Uploads and binds it. */
void gl_frame_set_block(const gl_frame *frame, const gl_frame_block *block);
/* To the uniform background, if surfaces are drawn as displayed. */
void gl_frame_set_clear_color(const gl_frame *frame, const gl_frame_block *block);

#endif
