/* gl_phong.c - see gl_phong.h. Its textures are separate from those of glTF materials, because the same
 * image may be decoded differently. */
#include "gl/scene/gl_phong.h"

#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "gl/core/gl_api.h"
#include "gl/core/gl_texture.h"

#include "draw/ogl1_setup.h"
#include "shade/lang/lang_c_load.h"

/* ---- uniform blocks ---- */

/* As phong.glsl has them (std140). */
enum {
    GL_PHONG_LIGHTS = 64 /* OpenGL 1 guarantees eight */
};

/* Per image. */
typedef struct phong_frame_block {
    float view[3][4]; /* rows: world to eye space; w: the eye, m */
    int32_t variant, is_encoded, are_colors_srgb, light_count;
    float global_ambient[3], has_rgl_colors;
    float fog_color[3], fog_mode;
    float fog_near, fog_far, fog_scale, fog_w;
    float lights[GL_PHONG_LIGHTS][4][4]; /* position, 1 for point lights; ambient; diffuse; specular */
} phong_frame_block;

/* Per material. */
typedef struct phong_material_block {
    float ambient[3], shininess;
    float diffuse[3], opacity;
    float specular[3], texture_type;
    float emission[3], texture_mode;
    float has_texture_over_light, is_halo, has_fog, bump_multiplier;
    float maps[PHONG_MAP_COUNT][3]
              [4]; /* rows of the transform, w: set, 1 for trilinear; base, gain, channel */
} phong_material_block;

static void fill_frame(const ogl1_setup *s, const camera_rays *camera, facet_ogl1_variant variant,
                       phong_frame_block *b)
{
    memset(b, 0, sizeof *b);
    for (int axis = 0; axis < 3; axis++) {
        vec3 unit = vec3(axis == 0 ? 1.0f : 0.0f, axis == 1 ? 1.0f : 0.0f, axis == 2 ? 1.0f : 0.0f);
        vec3 column = mul(s->view, unit);
        for (int row = 0; row < 3; row++)
            b->view[row][axis] = column[row];
        b->view[axis][3] = camera->origin[axis];
    }
    b->variant = (int32_t)variant;
    b->is_encoded = s->frame.is_encoded;
    b->are_colors_srgb = s->frame.are_colors_srgb;
    b->light_count = (int32_t)s->light_count;
    store3(s->frame.rules.global_ambient, b->global_ambient);
    b->has_rgl_colors = s->frame.has_rgl_colors ? 1.0f : 0.0f;
    store3(s->frame.fog.color, b->fog_color);
    b->fog_mode = (float)s->frame.fog.mode;
    b->fog_near = s->frame.fog.near_m;
    b->fog_far = s->frame.fog.far_m;
    b->fog_scale = s->frame.fog.scale;
    b->fog_w = s->frame.fog.w;
    for (uint32_t i = 0; i < s->light_count; i++) {
        store3(s->lights[i].position, b->lights[i][0]);
        b->lights[i][0][3] = s->lights[i].is_point ? 1.0f : 0.0f;
        store3(s->lights[i].ambient, b->lights[i][1]);
        store3(s->lights[i].diffuse, b->lights[i][2]);
        store3(s->lights[i].specular, b->lights[i][3]);
    }
}

/* 0 to 3; 4: luminance, as ogl1_map_scalar() has it. */
static float channel_of(char channel)
{
    return channel == 'r'   ? 0.0f
           : channel == 'g' ? 1.0f
           : channel == 'b' ? 2.0f
           : channel == 'm' ? 3.0f
                            : 4.0f;
}

static void fill_map(const facet_scene *scene, const legacy_map *map, float out[3][4])
{
    static const float identity[6] = {1, 0, 0, 0, 1, 0};
    const float *transform = map->ref.has_transform ? map->ref.transform : identity;
    memcpy(out[0], transform, 3 * sizeof *transform);
    memcpy(out[1], transform + 3, 3 * sizeof *transform);
    if (map->ref.texture < scene->texture_count) {
        const scene_texture *t = &scene->textures[map->ref.texture];
        out[0][3] = (float)map->ref.texcoord;
        out[1][3] = t->min_filter == SCENE_FILTER_LINEAR && t->mip_filter == SCENE_MIP_LINEAR;
    }
    out[2][0] = map->base;
    out[2][1] = map->gain;
    out[2][2] = channel_of(map->channel);
}

static void fill_material(const facet_scene *scene, const ogl1_material *m, phong_material_block *b)
{
    const legacy_material *l = m->legacy;
    memset(b, 0, sizeof *b);
    store3(m->surface.material.ambient, b->ambient);
    b->shininess = m->surface.material.shininess;
    store3(m->surface.material.diffuse, b->diffuse);
    b->opacity = l->opacity;
    store3(m->surface.material.specular, b->specular);
    b->texture_type = (float)l->texture_type;
    store3(m->surface.material.emission, b->emission);
    b->texture_mode = (float)l->texture_mode;
    b->has_texture_over_light = m->surface.has_texture_over_light ? 1.0f : 0.0f;
    b->is_halo = l->is_halo ? 1.0f : 0.0f;
    b->has_fog = l->has_fog ? 1.0f : 0.0f;
    b->bump_multiplier = l->maps[LEGACY_NORMAL_MAP].bump_multiplier;
    for (int i = 0; i < PHONG_MAP_COUNT; i++)
        fill_map(scene, &l->maps[ogl1_map_slots[i]], b->maps[i]);
}

/* ---- the set ---- */

struct gl_phong {
    gl_context *context;
    const facet_scene *scene;
    facet_allocator allocator;
    gl_texture_set *textures;
    texture_use *uses; /* by texture */
    GLuint frame_buffer, material_buffer, white;
    size_t stride; /* of the material blocks */
    facet_ogl1_desc desc;
    gl_target copy; /* of the image that is linearized */
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
    p->stride = (sizeof(phong_material_block) + step - 1) / step * step;
    glGenBuffers(1, &p->frame_buffer);
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
    glDeleteBuffers(1, &p->frame_buffer);
    glDeleteBuffers(1, &p->material_buffer);
    glDeleteTextures(1, &p->white);
    gl_target_destroy(&p->copy);
    gl_texture_destroy(p->textures);
    mem_free(p->uses);
    mem_free(p);
}

/* ---- updates ---- */

static uint32_t maps_of(const gl_phong *p, const gl_batch *batch)
{
    return ogl1_drawn_maps(batch->geometry, p->desc.variant);
}

static bool is_color(const gl_phong *p, const gl_batch *batch, int map)
{
    return ogl1_map_is_color(batch->geometry->legacy, ogl1_map_slots[map], p->desc.is_linear);
}

static void add_uses(gl_phong *p, const gl_batch *batch)
{
    uint32_t maps = maps_of(p, batch);
    for (int i = 0; i < PHONG_MAP_COUNT; i++) {
        uint32_t texture = batch->geometry->legacy->maps[ogl1_map_slots[i]].ref.texture;
        if (!(maps >> ogl1_map_slots[i] & 1) || texture >= p->scene->texture_count)
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

/* On the heap, because the block is too large for the stack of an arbitrary caller's thread. */
static facet_result upload_frame(gl_phong *p, const ogl1_setup *setup, const camera_rays *camera,
                                 facet_error *error)
{
    phong_frame_block *block = mem_alloc(&p->allocator, 1, sizeof *block);
    if (!block)
        return fail_memory(error, "lights", sizeof *block);
    fill_frame(setup, camera, p->desc.variant, block);
    glBindBuffer(GL_UNIFORM_BUFFER, p->frame_buffer);
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
        phong_material_block block;
        fill_material(p->scene, &setup->materials[i], &block);
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
        result = upload_frame(p, &setup, view->camera, error);
    if (result == FACET_OK)
        result = upload_materials(p, &setup, error);
    ogl1_setup_destroy(&setup);
    return result == FACET_OK ? gl_context_check(p->context, "materials of OpenGL 1", error) : result;
}

/* ---- drawing ---- */

uint64_t gl_phong_features(const gl_phong *p, const gl_batch *batch)
{
    const render_geometry *g = batch->geometry;
    uint32_t maps = maps_of(p, batch);
    uint64_t features = g->tangents ? GL_SURFACE_HAS_TANGENTS : 0;
    for (int i = 0; i < PHONG_MAP_COUNT; i++)
        if (maps >> ogl1_map_slots[i] & 1)
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
    for (int i = 0; i < PHONG_MAP_COUNT; i++) {
        if (!(maps >> ogl1_map_slots[i] & 1))
            continue;
        uint32_t texture = g->legacy->maps[ogl1_map_slots[i]].ref.texture;
        uint32_t name = gl_texture_name(p->textures, texture, is_color(p, batch, i));
        GLuint unit = (GLuint)GL_UNIT_MATERIAL + (GLuint)i;
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_2D, name ? name : p->white);
        glBindSampler(unit, gl_texture_sampler(p->textures, texture));
    }
    glBindBufferBase(GL_UNIFORM_BUFFER, GL_BLOCK_OGL1, p->frame_buffer);
    glBindBufferRange(GL_UNIFORM_BUFFER, GL_BLOCK_MATERIAL, p->material_buffer,
                      (GLintptr)(g->material_id * p->stride), sizeof(phong_material_block));
    if (g->is_double_sided)
        glDisable(GL_CULL_FACE);
    else
        glEnable(GL_CULL_FACE);
    glFrontFace(g->is_mirrored ? GL_CW : GL_CCW);
}

/* ---- linearization ---- */

facet_result gl_phong_linearize(gl_phong *p, const gl_pyramid_brush *brush, const gl_target *target,
                                facet_error *error)
{
    if (p->desc.is_linear)
        return FACET_OK;
    gl_program_key key = {GL_MAIN_LINEARIZE, 0};
    uint32_t program;
    TRY(gl_target_update(&p->copy, p->context, target->kind, target->width, target->height, 1, error));
    TRY(gl_programs_get(brush->programs, key, &program, error));
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
