/* gl_material.c - see gl_material.h. */
#include "gl/gl_material.h"

#include <epoxy/gl.h>

#include "base/memory.h"
#include "base/result.h"

struct gl_material_set {
    gl_context *context;
    const facet_scene *scene;
    facet_allocator allocator;
};

facet_result gl_material_create(gl_context *context, const facet_scene *scene,
                                const facet_allocator *allocator, gl_material_set **out, facet_error *error)
{
    *out = mem_zalloc(allocator, 1, sizeof **out);
    if (!*out)
        return fail_memory(error, "materials", sizeof **out);
    (*out)->context = context;
    (*out)->scene = scene;
    (*out)->allocator = allocator ? *allocator : (facet_allocator){0};
    return FACET_OK;
}

void gl_material_destroy(gl_material_set *set)
{
    mem_free(set);
}

facet_result gl_material_update(gl_material_set *set, const gl_mesh_set *meshes,
                                const facet_render_desc *desc, facet_error *error)
{
    (void)set, (void)meshes, (void)desc, (void)error;
    return FACET_OK;
}

uint64_t gl_material_features(const gl_batch *batch)
{
    return batch->geometry->tangents ? 1 : 0;
}

void gl_material_bind(const gl_material_set *set, const gl_batch *batch)
{
    (void)set;
    if (batch->geometry->is_double_sided || batch->plan->is_volume)
        glDisable(GL_CULL_FACE);
    else
        glEnable(GL_CULL_FACE);
    glFrontFace(batch->geometry->is_mirrored ? GL_CW : GL_CCW);
}

uint64_t gl_material_decoded_texels(const gl_material_set *set)
{
    (void)set;
    return 0;
}
