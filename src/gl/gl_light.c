/* gl_light.c - see gl_light.h. */
#include "gl/gl_light.h"

#include "base/memory.h"
#include "base/result.h"

struct gl_light {
    gl_context *context;
    facet_allocator allocator;
    float scale, rotation_cos, rotation_sin;
};

facet_result gl_light_create(gl_context *context, const facet_allocator *allocator, gl_light **out,
                             facet_error *error)
{
    *out = mem_zalloc(allocator, 1, sizeof **out);
    if (!*out)
        return fail_memory(error, "light", sizeof **out);
    (*out)->context = context;
    (*out)->allocator = allocator ? *allocator : (facet_allocator){0};
    return FACET_OK;
}

void gl_light_destroy(gl_light *light)
{
    mem_free(light);
}

facet_result gl_light_update(gl_light *light, const light_setup *setup, const float eye[3],
                             facet_error *error)
{
    (void)eye, (void)error;
    light->scale = setup->scale;
    light->rotation_cos = setup->rotation_cos;
    light->rotation_sin = setup->rotation_sin;
    return FACET_OK;
}

uint64_t gl_light_features(const gl_light *light)
{
    (void)light;
    return 0;
}

uint64_t gl_light_background_features(const gl_light *light, const facet_render_desc *desc)
{
    (void)light, (void)desc;
    return 0;
}

void gl_light_bind(const gl_light *light, gl_frame_block *block)
{
    block->light[0] = light->scale;
    block->light[1] = light->rotation_cos;
    block->light[2] = light->rotation_sin;
    block->light[3] = 0.0f;
}
