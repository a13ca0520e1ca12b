/* gl_sea_textures.c - see gl_sea_textures.h. */
#include "gl/gl_sea_textures.h"

#include <epoxy/gl.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "gl/gl_blocks.h"
#include "ocean/wave_patches.h"

void gl_sea_textures_destroy(gl_sea_textures *t)
{
    const GLuint names[] = {t->low, t->high, t->foam, t->patches, t->sky, t->means, t->caustics};
    glDeleteTextures(7, names);
    *t = (gl_sea_textures){.size = 0};
}

static void bind(uint32_t unit, GLenum target, GLuint name)
{
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(target, name);
}

void gl_sea_textures_bind(const gl_sea_textures *t)
{
    bind(GL_UNIT_SEA_LOW, GL_TEXTURE_2D_ARRAY, t->low);
    bind(GL_UNIT_SEA_HIGH, GL_TEXTURE_2D_ARRAY, t->high);
    bind(GL_UNIT_SEA_FOAM, GL_TEXTURE_2D_ARRAY, t->foam);
    bind(GL_UNIT_SEA_PATCHES, GL_TEXTURE_2D, t->patches);
    bind(GL_UNIT_SEA_SKY, GL_TEXTURE_2D_ARRAY, t->sky);
    bind(GL_UNIT_SEA_MEANS, GL_TEXTURE_2D, t->means);
    bind(GL_UNIT_SEA_CAUSTICS, GL_TEXTURE_2D_ARRAY, t->caustics);
}

/* Bound afterwards. */
static GLuint make(uint32_t unit, GLenum target, GLenum filter, GLenum wrap_s, GLenum wrap_t)
{
    GLuint name;
    glGenTextures(1, &name);
    bind(unit, target, name);
    GLint minified = filter == GL_LINEAR_MIPMAP_LINEAR || filter == GL_NEAREST ? (GLint)filter : GL_LINEAR;
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, minified);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, filter == GL_NEAREST ? GL_NEAREST : GL_LINEAR);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, (GLint)wrap_s);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, (GLint)wrap_t);
    return name;
}

/* With all mips. */
static GLuint make_layers(uint32_t unit, GLenum format, GLenum channels, uint32_t size, uint32_t layers,
                          GLenum wrap)
{
    GLuint name = make(unit, GL_TEXTURE_2D_ARRAY, GL_LINEAR_MIPMAP_LINEAR, wrap, wrap);
    GLint level = 0;
    for (uint32_t edge = size; edge; edge >>= 1)
        glTexImage3D(GL_TEXTURE_2D_ARRAY, level++, (GLint)format, (GLsizei)edge, (GLsizei)edge,
                     (GLsizei)layers, 0, channels, GL_FLOAT, NULL);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, level - 1);
    return name;
}

static void make_all(gl_sea_textures *t, const gl_context *c)
{
    GLenum rgba = c->has_float_linear ? GL_RGBA32F : GL_RGBA16F,
           red = c->has_float_linear ? GL_R32F : GL_R16F;
    t->low = make_layers(GL_UNIT_SEA_LOW, rgba, GL_RGBA, t->size, t->tile_count, GL_REPEAT);
    t->high = make_layers(GL_UNIT_SEA_HIGH, rgba, GL_RGBA, t->size, t->tile_count, GL_REPEAT);
    t->foam = make_layers(GL_UNIT_SEA_FOAM, red, GL_RED, t->plane_count ? t->size : 1,
                          t->plane_count ? t->plane_count : 1, GL_REPEAT);
    t->caustics =
        make_layers(GL_UNIT_SEA_CAUSTICS, red, GL_RED, t->caustic_size, CAUSTIC_LAYERS, GL_CLAMP_TO_EDGE);
    t->patches = make(GL_UNIT_SEA_PATCHES, GL_TEXTURE_2D, GL_NEAREST, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
    t->means = make(GL_UNIT_SEA_MEANS, GL_TEXTURE_2D, GL_LINEAR, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
    t->sky = make(GL_UNIT_SEA_SKY, GL_TEXTURE_2D_ARRAY, GL_LINEAR, GL_REPEAT, GL_CLAMP_TO_EDGE);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, (GLint)rgba, SEA_SKY_WIDTH, SEA_SKY_HEIGHT, SEA_SKY_LAYERS, 0,
                 GL_RGBA, GL_FLOAT, NULL);
}

/* ---- waves, foam ---- */

typedef struct splitting {
    const float *texels;
    float *low, *high;
} splitting;

static void split(void *context, size_t begin, size_t end)
{
    const splitting *s = context;
    for (size_t i = begin; i < end; i++) {
        memcpy(s->low + 4 * i, s->texels + WAVE_FIELDS * i, 4 * sizeof(float));
        memcpy(s->high + 4 * i, s->texels + WAVE_FIELDS * i + 4, 4 * sizeof(float));
    }
}

static void upload_layer(uint32_t unit, uint32_t level, uint32_t layer, uint32_t edge, GLenum channels,
                         const float *texels)
{
    glActiveTexture(GL_TEXTURE0 + unit);
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, (GLint)level, 0, 0, (GLint)layer, (GLsizei)edge, (GLsizei)edge, 1,
                    channels, GL_FLOAT, texels);
}

static facet_result upload_waves(const sea_picture *p, facet_error *error)
{
    const waves *w = &p->sea->waves;
    const facet_render_desc *r = &p->desc->render;
    if (!w->tile_count)
        return FACET_OK;
    size_t most = (size_t)w->tiles[0].size * w->tiles[0].size;
    float *texels = mem_alloc(&r->allocator, most, WAVE_FIELDS * sizeof(float));
    if (!texels)
        return fail_memory(error, "tiles of waves", most * WAVE_FIELDS * sizeof(float));
    for (uint32_t i = 0; i < w->tile_count; i++)
        for (uint32_t level = 0; level < w->tiles[i].level_count; level++) {
            uint32_t edge = w->tiles[i].size >> level;
            splitting s = {w->tiles[i].levels[level], texels, texels + 4 * most};
            parallel_for(r->thread_count, (size_t)edge * edge, 8192, split, &s);
            upload_layer(GL_UNIT_SEA_LOW, level, i, edge, GL_RGBA, s.low);
            upload_layer(GL_UNIT_SEA_HIGH, level, i, edge, GL_RGBA, s.high);
        }
    mem_free(texels);
    return FACET_OK;
}

static void upload_foam(const waves_foam *f)
{
    for (uint32_t i = 0; f && i < 1 + FOAM_PATTERNS; i++) {
        const foam_plane *plane = i ? &f->patterns[i - 1] : &f->share;
        for (uint32_t level = 0; level < plane->level_count; level++)
            upload_layer(GL_UNIT_SEA_FOAM, level, i, plane->size >> level, GL_RED, plane->levels[level]);
    }
}

static void upload_caustics(const caustic_map *map)
{
    for (uint32_t layer = 0; map && layer < CAUSTIC_LAYERS; layer++)
        for (uint32_t mip = 0; mip < CAUSTIC_MIPS; mip++)
            upload_layer(GL_UNIT_SEA_CAUSTICS, mip, layer, CAUSTIC_SIZE >> mip, GL_RED,
                         map->layers[layer].mips[mip]);
}

/* Corners around the eye's, each where its index falls modulo the edge. */
static facet_result upload_patches(const sea_picture *p, const camera_rays *camera, facet_error *error)
{
    enum { EDGE = GL_SEA_PATCHES, TEXELS = EDGE * EDGE };
    const waves *w = &p->sea->waves;
    float *texels =
        mem_zalloc(&p->desc->render.allocator, (size_t)TEXELS * WAVES_MAX_TILES, 2 * sizeof *texels);
    if (!texels)
        return fail_memory(error, "patches of waves", (size_t)TEXELS * WAVES_MAX_TILES * 2 * sizeof *texels);
    for (uint32_t tile = 0; tile < w->tile_count; tile++) {
        const wave_tile *t = &w->tiles[tile];
        wave_rhombus eye = wave_rhombus_at(t, (double)camera->origin[0], (double)camera->origin[2]);
        for (int k = 0; t->is_patched && k < TEXELS; k++) {
            int64_t i = eye.i + k % EDGE - EDGE / 2, j = eye.j + k / EDGE - EDGE / 2;
            uint64_t hash = wave_patch_hash(w->seed + tile, i, j);
            float *to = texels + 2 * ((size_t)tile * TEXELS + (size_t)k);
            to[0] = (float)((uint32_t)hash & (t->size - 1u));
            to[1] = (float)((uint32_t)(hash >> 32) & (t->size - 1u));
        }
    }
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_SEA_PATCHES);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RG32F, EDGE, EDGE * WAVES_MAX_TILES, 0, GL_RG, GL_FLOAT, texels);
    mem_free(texels);
    return FACET_OK;
}

/* ---- all ---- */

facet_result gl_sea_textures_update(gl_sea_textures *t, gl_context *c, const sea_picture *p,
                                    const camera_rays *camera, facet_error *error)
{
    const waves *w = &p->sea->waves;
    uint32_t size = w->tile_count ? w->tiles[0].size : 1, tile_count = w->tile_count ? w->tile_count : 1;
    uint32_t plane_count = p->foam ? 1 + FOAM_PATTERNS : 0;
    uint32_t caustic_size = p->caustics ? CAUSTIC_SIZE : 1;
    if (size > (uint32_t)c->max_texture_size)
        return fail(error, FACET_ERROR_LIMIT, "OpenGL (%s): tiles of %u samples; the most are %d", c->name,
                    size, c->max_texture_size);
    if (!t->low || t->size != size || t->tile_count != tile_count || t->plane_count != plane_count ||
        t->caustic_size != caustic_size) {
        gl_sea_textures_destroy(t);
        *t = (gl_sea_textures){
            .size = size, .tile_count = tile_count, .plane_count = plane_count, .caustic_size = caustic_size};
        make_all(t, c);
    }
    gl_sea_textures_bind(t);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    facet_result result = upload_waves(p, error);
    if (result == FACET_OK)
        result = upload_patches(p, camera, error);
    if (result != FACET_OK)
        return result;
    upload_foam(p->foam);
    upload_caustics(p->caustics);
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_SEA_SKY);
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, SEA_SKY_WIDTH, SEA_SKY_HEIGHT, SEA_SKY_LAYERS, GL_RGBA,
                    GL_FLOAT, p->sky);
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_SEA_MEANS);
    glTexImage2D(GL_TEXTURE_2D, 0, c->has_float_linear ? GL_RGBA32F : GL_RGBA16F, WATER_TABLE_WIDTH,
                 WATER_TABLE_HEIGHT, 0, GL_RGBA, GL_FLOAT, p->table->texels);
    return gl_context_check(c, "a sea", error);
}
