/* gl_light_tables.c - see gl_light_tables.h. */
#include "gl/scene/gl_light_tables.h"

#include <epoxy/gl.h>

#include "base/memory.h"
#include "base/result.h"
#include "ibl/dfg.h"
#include "image/half.h"

_Static_assert(DFG_SIZE == SHEEN_SIZE, "both tables have the same nodes, so that they share texels");

static uint32_t make_texture(GLenum target)
{
    GLuint name;
    glGenTextures(1, &name);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(target, name);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
    return name;
}

static void upload_albedo(gl_light_tables *tables, uint16_t *texels)
{
    for (size_t i = 0; i < (size_t)DFG_SIZE * DFG_SIZE; i++) {
        texels[4 * i] = half_from_float(ibl_dfg_nodes()[2 * i]);
        texels[4 * i + 1] = half_from_float(ibl_dfg_nodes()[2 * i + 1]);
        texels[4 * i + 2] = half_from_float(ibl_sheen_nodes()[i]);
        texels[4 * i + 3] = 0;
    }
    tables->albedo = make_texture(GL_TEXTURE_2D);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, DFG_SIZE, DFG_SIZE, 0, GL_RGBA, GL_HALF_FLOAT, texels);
}

enum { GLASS_NODES = 2 * GLASS_IORS * GLASS_SIZE * GLASS_SIZE };

static void upload_glass(gl_light_tables *tables, uint16_t *texels)
{
    for (size_t i = 0; i < GLASS_NODES; i++) {
        for (size_t k = 0; k < 3; k++)
            texels[4 * i + k] = half_from_float((float)ibl_glass_nodes()[3 * i + k] * (1.0f / GLASS_UNIT));
        texels[4 * i + 3] = 0;
    }
    tables->glass = make_texture(GL_TEXTURE_3D);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA16F, GLASS_SIZE, GLASS_SIZE, 2 * GLASS_IORS, 0, GL_RGBA,
                 GL_HALF_FLOAT, texels);
}

facet_result gl_light_tables_create(gl_light_tables *tables, gl_context *context,
                                    const facet_allocator *allocator, facet_error *error)
{
    enum { TEXELS = DFG_SIZE * DFG_SIZE > GLASS_NODES ? DFG_SIZE * DFG_SIZE : GLASS_NODES };
    *tables = (gl_light_tables){0};
    uint16_t *texels = mem_alloc(allocator, TEXELS, 4 * sizeof *texels);
    if (!texels)
        return fail_memory(error, "tables", TEXELS * 4 * sizeof *texels);
    upload_albedo(tables, texels);
    upload_glass(tables, texels);
    mem_free(texels);
    return gl_context_check(context, "tables", error);
}

void gl_light_tables_destroy(gl_light_tables *tables)
{
    glDeleteTextures(1, &tables->albedo);
    glDeleteTextures(1, &tables->glass);
    *tables = (gl_light_tables){0};
}
