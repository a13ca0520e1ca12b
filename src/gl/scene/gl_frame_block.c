/* gl_frame_block.c - see gl_frame_block.h. */
#include "gl/scene/gl_frame_block.h"

#include <math.h>

#include "gl/core/gl_api.h"
#include "gl/gl_entry.h"
#include "shade/lang/lang_c_load.h"

void gl_frame_set_block(const gl_frame *f, const gl_frame_block *block)
{
    glBindBuffer(GL_UNIFORM_BUFFER, f->frame_buffer);
    glBufferData(GL_UNIFORM_BUFFER, sizeof *block, block, GL_DYNAMIC_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, GL_BLOCK_FRAME, f->frame_buffer);
}

void gl_frame_fill_block(const gl_frame *f, const facet_render_desc *desc, gl_frame_block *block)
{
    const float *behind = desc->background_color;
    bool is_light = gl_channel_is_light(desc->gl.channel);
    block->exposure = is_light ? exp2f(desc->exposure_ev) : 1.0f;
    block->energy = (int32_t)light_energy(desc);
    block->channel = (int32_t)desc->gl.channel;
    block->background_blur = desc->background_blur;
    for (int i = 0; i < 3; i++)
        block->background[i] = is_light ? behind[i] : 0.0f;
    block->background[3] = !is_light || desc->background == FACET_BACKGROUND_COLOR;
    if (!desc->sea && is_light && desc->background != FACET_BACKGROUND_ENVIRONMENT)
        block->backdrop[3] = desc->background == FACET_BACKGROUND_COLOR ? 2.0f : 1.0f;
    for (int i = 0; i < 3; i++)
        block->backdrop[i] = behind[i] / block->exposure;
    gl_light_bind(f->light, block);
}

void gl_frame_set_clear_color(const gl_frame *f, const gl_frame_block *block)
{
    const float *behind = block->background;
    vec3 shown = srgb_from_linear(clamp(vec3(behind[0], behind[1], behind[2]), 0.0f, 1.0f));
    if (f->display_features && behind[3] > 0.0f)
        glClearColor(shown[0], shown[1], shown[2], 1.0f);
    else
        glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
}
