/* gl_phong.c - see gl_phong.h. Textures are apart from those of glTF: the same image is read as other numbers. */
#include "gl/scene/gl_phong.h"

#include <epoxy/gl.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "draw/ogl1_maps.h"
#include "gl/core/gl_texture.h"

#include "gl/scene/gl_phong_block.h"

_Static_assert((int)GL_PHONG_MAP_COUNT == (int)GL_PHONG_MAPS, "each map has its feature");

struct gl_phong {
    gl_context *context;
    const facet_scene *scene;
    facet_allocator allocator;
    gl_texture_set *textures;
    texture_use *uses; /* by texture */
    GLuint picture_buffer, material_buffer, white;
    size_t stride; /* of the materials' blocks */
    facet_ogl1_desc desc;
    gl_target copy; /* of what is developed */
};

static GLuint make_white(void)
{
    static const unsigned char texel[4] = {255, 255, 255, 255};
    GLuint name;
    glGenTextures(1, &name);
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_MATERIAL);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, texel);
    return name;
}

facet_result gl_phong_create(gl_context *context, const facet_scene *scene, const facet_allocator *allocator,
                             gl_phong **out, facet_error *error)
{
    gl_phong *p = mem_zalloc(allocator, 1, sizeof *p);
    *out = p;
    if (!p)
        return fail_memory(error, "materials", sizeof *p);
    *p = (gl_phong){.context = context, .scene = scene};
    p->allocator = allocator ? *allocator : (facet_allocator){0};
    size_t uses_size = (size_t)scene->texture_count + 1;
    p->uses = mem_zalloc(allocator, uses_size, sizeof *p->uses);
    facet_result result = p->uses ? FACET_OK : fail_memory(error, "materials", uses_size * sizeof *p->uses);
    if (result == FACET_OK)
        result = gl_texture_create(context, scene, &p->allocator, &p->textures, error);
    GLint alignment = 256;
    glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
    size_t step = alignment > 0 ? (size_t)alignment : 256;
    p->stride = (sizeof(gl_phong_material) + step - 1) / step * step;
    glGenBuffers(1, &p->picture_buffer);
    glGenBuffers(1, &p->material_buffer);
    p->white = make_white();
    if (result != FACET_OK) {
        gl_phong_destroy(p);
        *out = NULL;
    }
    return result;
}

void gl_phong_destroy(gl_phong *p)
{
    if (!p)
        return;
    glDeleteBuffers(1, &p->picture_buffer);
    glDeleteBuffers(1, &p->material_buffer);
    glDeleteTextures(1, &p->white);
    gl_target_destroy(&p->copy);
    gl_texture_destroy(p->textures);
    mem_free(p->uses);
    mem_free(p);
}

/* ---- what a picture needs ---- */

static uint32_t maps_of(const gl_phong *p, const gl_batch *batch)
{
    return ogl1_drawn_maps(batch->geometry, p->desc.variant);
}

static bool is_color(const gl_phong *p, const gl_batch *batch, int map)
{
    return ogl1_map_is_color(batch->geometry->legacy, gl_phong_slots[map], p->desc.is_linear);
}

static void add_uses(gl_phong *p, const gl_batch *batch)
{
    uint32_t maps = maps_of(p, batch);
    for (int i = 0; i < GL_PHONG_MAPS; i++) {
        uint32_t texture = batch->geometry->legacy->maps[gl_phong_slots[i]].ref.texture;
        if (!(maps >> gl_phong_slots[i] & 1) || texture >= p->scene->texture_count)
            continue;
        if (is_color(p, batch, i))
            p->uses[texture].is_read_as_color = true;
        else
            p->uses[texture].is_read_as_data = true;
    }
}

static facet_result update_textures(gl_phong *p, const gl_phong_view *view, facet_error *error)
{
    memset(p->uses, 0, p->scene->texture_count * sizeof *p->uses);
    for (gl_pass pass = GL_PASS_OPAQUE; pass < GL_PASS_COUNT; pass++) {
        uint32_t count;
        const gl_batch *batches = gl_mesh_batches(view->meshes, pass, &count);
        for (uint32_t i = 0; i < count; i++)
            add_uses(p, &batches[i]);
    }
    return gl_texture_update(p->textures, p->uses, &view->render->log, view->render->thread_count, error);
}

/* The picture's block is too large for the stack of a thread that somebody else made. */
static facet_result upload_picture(gl_phong *p, const ogl1_setup *setup, facet_error *error)
{
    gl_phong_picture *block = mem_alloc(&p->allocator, 1, sizeof *block);
    if (!block)
        return fail_memory(error, "lights", sizeof *block);
    gl_phong_picture_fill(setup, p->desc.variant, block);
    glBindBuffer(GL_UNIFORM_BUFFER, p->picture_buffer);
    glBufferData(GL_UNIFORM_BUFFER, sizeof *block, block, GL_DYNAMIC_DRAW);
    mem_free(block);
    return FACET_OK;
}

static facet_result upload_materials(gl_phong *p, const ogl1_setup *setup, facet_error *error)
{
    size_t count = (size_t)p->scene->material_count + 1;
    unsigned char *blocks = mem_zalloc(&p->allocator, count, p->stride);
    if (!blocks)
        return fail_memory(error, "materials", count * p->stride);
    for (size_t i = 0; i < count; i++) {
        gl_phong_material block;
        gl_phong_material_fill(p->scene, &setup->materials[i], &block);
        memcpy(blocks + i * p->stride, &block, sizeof block);
    }
    glBindBuffer(GL_UNIFORM_BUFFER, p->material_buffer);
    glBufferData(GL_UNIFORM_BUFFER, (GLsizeiptr)(count * p->stride), blocks, GL_DYNAMIC_DRAW);
    mem_free(blocks);
    return FACET_OK;
}

facet_result gl_phong_update(gl_phong *p, const gl_phong_view *view, facet_error *error)
{
    const gl_scene *s = view->scene;
    const ogl1_source source = {s->scene, &s->pose, &s->geometries, &s->default_legacy};
    ogl1_setup setup;
    p->desc = view->render->ogl1;
    facet_result result =
        ogl1_setup_create(&source, view->camera, view->render, view->light, NULL, &setup, error);
    if (result != FACET_OK)
        return result;
    if (setup.light_count > GL_PHONG_LIGHTS)
        result = fail(error, FACET_ERROR_LIMIT, "%s: %u lights of OpenGL 1; with OpenGL at most %d are drawn",
                      p->scene->source, setup.light_count, GL_PHONG_LIGHTS);
    if (result == FACET_OK)
        result = update_textures(p, view, error);
    if (result == FACET_OK)
        result = upload_picture(p, &setup, error);
    if (result == FACET_OK)
        result = upload_materials(p, &setup, error);
    ogl1_setup_destroy(&setup);
    return result == FACET_OK ? gl_context_check(p->context, "materials of OpenGL 1", error) : result;
}

/* ---- a batch ---- */

uint64_t gl_phong_features(const gl_phong *p, const gl_batch *batch)
{
    const render_geometry *g = batch->geometry;
    uint32_t maps = maps_of(p, batch);
    uint64_t features = g->tangents ? GL_SURFACE_HAS_TANGENTS : 0;
    for (int i = 0; i < GL_PHONG_MAPS; i++)
        if (maps >> gl_phong_slots[i] & 1)
            features |= 1ull << (GL_SURFACE_TEXTURES + i);
    if (maps >> LEGACY_DIFFUSE_MAP & 1 && ogl1_map_is_spherical(g->legacy, LEGACY_DIFFUSE_MAP))
        features |= 1ull << GL_PHONG_IS_SPHERE_MAP;
    if (phong_rules((int)p->desc.variant).is_lit_at_vertices)
        features |= 1ull << GL_PHONG_IS_AT_VERTICES;
    if (!g->legacy->is_smooth)
        features |= 1ull << GL_PHONG_IS_FLAT;
    if (g->is_see_through)
        features |= 1ull << GL_PHONG_IS_SEE_THROUGH;
    if (g->is_lit)
        features |= 1ull << GL_SURFACE_IS_LIT;
    if (g->primitive->colors)
        features |= 1ull << GL_SURFACE_HAS_COLORS;
    return features;
}

void gl_phong_bind(const gl_phong *p, const gl_batch *batch)
{
    const render_geometry *g = batch->geometry;
    uint32_t maps = maps_of(p, batch);
    for (int i = 0; i < GL_PHONG_MAPS; i++) {
        if (!(maps >> gl_phong_slots[i] & 1))
            continue;
        uint32_t texture = g->legacy->maps[gl_phong_slots[i]].ref.texture;
        uint32_t name = gl_texture_name(p->textures, texture, is_color(p, batch, i));
        GLuint unit = (GLuint)GL_UNIT_MATERIAL + (GLuint)i;
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_2D, name ? name : p->white);
        glBindSampler(unit, gl_texture_sampler(p->textures, texture));
    }
    glBindBufferBase(GL_UNIFORM_BUFFER, GL_BLOCK_OGL1, p->picture_buffer);
    glBindBufferRange(GL_UNIFORM_BUFFER, GL_BLOCK_MATERIAL, p->material_buffer,
                      (GLintptr)(g->material_id * p->stride), sizeof(gl_phong_material));
    if (g->is_double_sided)
        glDisable(GL_CULL_FACE);
    else
        glEnable(GL_CULL_FACE);
    glFrontFace(g->is_mirrored ? GL_CW : GL_CCW);
}

/* ---- the picture ---- */

facet_result gl_phong_develop(gl_phong *p, const gl_pyramid_brush *brush, const gl_target *target,
                              facet_error *error)
{
    if (p->desc.is_linear)
        return FACET_OK;
    gl_program_key key = {GL_MAIN_DEVELOP, 0};
    uint32_t program;
    facet_result result =
        gl_target_update(&p->copy, p->context, target->kind, target->width, target->height, 1, error);
    if (result == FACET_OK)
        result = gl_programs_get(brush->programs, key, &program, error);
    if (result != FACET_OK)
        return result;
    GLint w = (GLint)target->width, h = (GLint)target->height;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target->resolved_framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, p->copy.framebuffer);
    glBlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, target->resolved_framebuffer);
    glViewport(0, 0, w, h);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_OPAQUE);
    glBindTexture(GL_TEXTURE_2D, p->copy.color);
    glUseProgram(program);
    glBindVertexArray(brush->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return FACET_OK;
}

uint64_t gl_phong_decoded_texels(const gl_phong *p)
{
    return gl_texture_decoded_texels(p->textures);
}
