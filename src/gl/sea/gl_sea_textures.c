/* gl_sea_textures.c - see gl_sea_textures.h. */
#include "gl/sea/gl_sea_textures.h"

#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "gl/core/gl_api.h"
#include "gl/core/gl_blocks.h"
#include "ocean/wave_patches.h"

void gl_sea_texture_bind(uint32_t unit, uint32_t target, uint32_t name)
{
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(target, name);
    glBindSampler(unit, 0); /* a material of a model may have left one, which expects mips */
}

uint32_t gl_sea_texture_make(uint32_t unit, uint32_t target, uint32_t filter, uint32_t wrap_s,
                             uint32_t wrap_t)
{
    GLuint name;
    glGenTextures(1, &name);
    gl_sea_texture_bind(unit, target, name);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, (GLint)filter);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, filter == GL_NEAREST ? GL_NEAREST : GL_LINEAR);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, (GLint)wrap_s);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, (GLint)wrap_t);
    if (target == GL_TEXTURE_3D)
        glTexParameteri(target, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
    return name;
}

void gl_sea_textures_destroy(gl_sea_textures *t)
{
    const GLuint names[] = {t->low, t->high, t->foam, t->patches, t->sky, t->lobes, t->means, t->caustics};
    glDeleteTextures(8, names);
    *t = (gl_sea_textures){.size = 0};
}

void gl_sea_textures_forget_light(gl_sea_textures *t)
{
    const GLuint names[] = {t->sky, t->lobes, t->means};
    glDeleteTextures(3, names);
    t->sky = t->lobes = t->means = 0;
}

void gl_sea_textures_bind(const gl_sea_textures *t)
{
    gl_sea_texture_bind(GL_UNIT_SEA_LOW, GL_TEXTURE_2D_ARRAY, t->low);
    gl_sea_texture_bind(GL_UNIT_SEA_HIGH, GL_TEXTURE_2D_ARRAY, t->high);
    gl_sea_texture_bind(GL_UNIT_SEA_FOAM, GL_TEXTURE_2D_ARRAY, t->foam);
    gl_sea_texture_bind(GL_UNIT_SEA_PATCHES, GL_TEXTURE_2D, t->patches);
    gl_sea_texture_bind(GL_UNIT_SEA_SKY, GL_TEXTURE_2D_ARRAY, t->sky);
    gl_sea_texture_bind(GL_UNIT_SEA_LOBES, GL_TEXTURE_3D, t->lobes);
    gl_sea_texture_bind(GL_UNIT_SEA_MEANS, GL_TEXTURE_2D, t->means);
    gl_sea_texture_bind(GL_UNIT_SEA_CAUSTICS, GL_TEXTURE_2D_ARRAY, t->caustics);
}

/* Floats, of 32 bits where the driver filters them. */
static GLint format_of(const gl_context *c, GLenum channels)
{
    if (channels == GL_RED)
        return c->has_float_linear ? GL_R32F : GL_R16F;
    return c->has_float_linear ? GL_RGBA32F : GL_RGBA16F;
}

/* With all mips, in place of the previous one; bound. */
static void make_layers(uint32_t *name, uint32_t unit, const gl_context *c, GLenum channels, uint32_t size,
                        uint32_t layers, GLenum filter, GLenum wrap)
{
    glDeleteTextures(1, name);
    *name = gl_sea_texture_make(unit, GL_TEXTURE_2D_ARRAY, filter, wrap, wrap);
    GLint level = 0;
    for (uint32_t edge = size; edge; edge >>= 1)
        glTexImage3D(GL_TEXTURE_2D_ARRAY, level++, format_of(c, channels), (GLsizei)edge, (GLsizei)edge,
                     (GLsizei)layers, 0, channels, GL_FLOAT, NULL);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, level - 1);
}

/* Textures that are missing, or have another size. An image without foam or caustics reads neither: the
 * previous ones stay. */
static void make_missing(gl_sea_textures *t, const gl_context *c, const water_frame *p)
{
    const waves *w = &p->sea->waves;
    uint32_t size = w->tile_count ? w->tiles[0].size : 1, tile_count = w->tile_count ? w->tile_count : 1;
    if (t->size != size || t->tile_count != tile_count) {
        make_layers(&t->low, GL_UNIT_SEA_LOW, c, GL_RGBA, size, tile_count, GL_LINEAR_MIPMAP_LINEAR,
                    GL_REPEAT);
        make_layers(&t->high, GL_UNIT_SEA_HIGH, c, GL_RGBA, size, tile_count, GL_LINEAR_MIPMAP_LINEAR,
                    GL_REPEAT);
        t->size = size;
        t->tile_count = tile_count;
    }
    uint32_t foam_size = p->foam ? p->foam->share.size : 1;
    if (!t->foam || (p->foam && t->foam_size != foam_size)) {
        make_layers(&t->foam, GL_UNIT_SEA_FOAM, c, GL_RED, foam_size, 1 + FOAM_PATTERNS,
                    GL_LINEAR_MIPMAP_NEAREST, GL_REPEAT);
        t->foam_size = foam_size;
        t->has_patterns = false;
    }
    uint32_t caustic_size = p->caustics ? CAUSTIC_SIZE : 1;
    if (!t->caustics || (p->caustics && t->caustic_size != caustic_size)) {
        make_layers(&t->caustics, GL_UNIT_SEA_CAUSTICS, c, GL_RED, caustic_size, CAUSTIC_LAYERS,
                    GL_LINEAR_MIPMAP_LINEAR, GL_CLAMP_TO_EDGE);
        t->caustic_size = caustic_size;
    }
}

/* ---- light ---- */

static void upload_light(gl_sea_textures *t, const gl_context *c, const water_frame *p)
{
    GLint format = format_of(c, GL_RGBA);
    t->sky =
        gl_sea_texture_make(GL_UNIT_SEA_SKY, GL_TEXTURE_2D_ARRAY, GL_LINEAR, GL_REPEAT, GL_CLAMP_TO_EDGE);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, format, SEA_SKY_WIDTH, SEA_SKY_HEIGHT, SEA_SKY_LAYERS, 0, GL_RGBA,
                 GL_FLOAT, p->sky);
    t->means =
        gl_sea_texture_make(GL_UNIT_SEA_MEANS, GL_TEXTURE_2D, GL_LINEAR, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
    glTexImage2D(GL_TEXTURE_2D, 0, format, WATER_TABLE_WIDTH, WATER_TABLE_HEIGHT, 0, GL_RGBA, GL_FLOAT,
                 p->table->texels);
    if (!p->lobes)
        return;
    t->lobes = gl_sea_texture_make(GL_UNIT_SEA_LOBES, GL_TEXTURE_3D, GL_LINEAR, GL_REPEAT, GL_CLAMP_TO_EDGE);
    glTexImage3D(GL_TEXTURE_3D, 0, format, SEA_LOBE_WIDTH, SEA_LOBE_HEIGHT, SEA_LOBE_LAYERS, 0, GL_RGBA,
                 GL_FLOAT, p->lobes);
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

static facet_result upload_waves(const water_frame *p, facet_error *error)
{
    const waves *w = &p->sea->waves;
    const facet_render_desc *r = p->desc;
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

static void upload_plane(const foam_plane *plane, uint32_t layer)
{
    for (uint32_t level = 0; level < plane->level_count; level++)
        upload_layer(GL_UNIT_SEA_FOAM, level, layer, plane->size >> level, GL_RED, plane->levels[level]);
}

/* Patterns of a size are the same for every sea. */
static void upload_foam(gl_sea_textures *t, const waves_foam *f)
{
    if (!f)
        return;
    upload_plane(&f->share, 0);
    for (uint32_t i = 0; i < FOAM_PATTERNS && !t->has_patterns; i++)
        upload_plane(&f->patterns[i], 1 + i);
    t->has_patterns = true;
}

static void upload_caustics(const caustic_map *map)
{
    for (uint32_t layer = 0; map && layer < CAUSTIC_LAYERS; layer++)
        for (uint32_t mip = 0; mip < CAUSTIC_MIPS; mip++)
            upload_layer(GL_UNIT_SEA_CAUSTICS, mip, layer, CAUSTIC_SIZE >> mip, GL_RED,
                         map->layers[layer].mips[mip]);
}

/* ---- patches ---- */

static gl_sea_patches patches_around(const waves *w, const camera_rays *camera)
{
    gl_sea_patches around;
    memset(&around, 0, sizeof around); /* including padding: it is compared as bytes */
    around.seed = w->seed;
    for (uint32_t tile = 0; tile < w->tile_count; tile++) {
        const wave_tile *t = &w->tiles[tile];
        if (!t->is_patched)
            continue;
        wave_rhombus eye = wave_rhombus_at(t, (double)camera->origin[0], (double)camera->origin[2]);
        around.sizes[tile] = t->size;
        around.i[tile] = eye.i;
        around.j[tile] = eye.j;
    }
    return around;
}

/* Corners around the eye's, each stored at its index modulo the width; kept where they are the same. */
static facet_result upload_patches(gl_sea_textures *t, const water_frame *p, const camera_rays *camera,
                                   facet_error *error)
{
    enum { EDGE = GL_SEA_PATCHES, TEXELS = EDGE * EDGE };
    gl_sea_patches around = patches_around(&p->sea->waves, camera);
    if (t->patches && memcmp(&around, &t->around, sizeof around) == 0)
        return FACET_OK;
    float *texels = mem_zalloc(&p->desc->allocator, (size_t)TEXELS * WAVES_MAX_TILES, 2 * sizeof *texels);
    if (!texels)
        return fail_memory(error, "patches of waves", (size_t)TEXELS * WAVES_MAX_TILES * 2 * sizeof *texels);
    for (uint32_t tile = 0; tile < WAVES_MAX_TILES; tile++)
        for (int k = 0; around.sizes[tile] && k < TEXELS; k++) {
            int64_t i = around.i[tile] + k % EDGE - EDGE / 2, j = around.j[tile] + k / EDGE - EDGE / 2;
            uint64_t hash = wave_patch_hash(around.seed + tile, i, j);
            float *to = texels + 2 * ((size_t)tile * TEXELS + (size_t)k);
            to[0] = (float)((uint32_t)hash & (around.sizes[tile] - 1u));
            to[1] = (float)((uint32_t)(hash >> 32) & (around.sizes[tile] - 1u));
        }
    if (!t->patches)
        t->patches = gl_sea_texture_make(GL_UNIT_SEA_PATCHES, GL_TEXTURE_2D, GL_NEAREST, GL_CLAMP_TO_EDGE,
                                         GL_CLAMP_TO_EDGE);
    gl_sea_texture_bind(GL_UNIT_SEA_PATCHES, GL_TEXTURE_2D, t->patches);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RG32F, EDGE, EDGE * WAVES_MAX_TILES, 0, GL_RG, GL_FLOAT, texels);
    mem_free(texels);
    t->around = around;
    return FACET_OK;
}

/* ---- entry points ---- */

facet_result gl_sea_textures_update(gl_sea_textures *t, gl_context *c, const water_frame *p,
                                    const camera_rays *camera, facet_error *error)
{
    const waves *w = &p->sea->waves;
    if (w->tile_count && w->tiles[0].size > (uint32_t)c->max_texture_size)
        return fail(error, FACET_ERROR_LIMIT, "OpenGL (%s): tiles of %u samples; the maximum is %d", c->name,
                    w->tiles[0].size, c->max_texture_size);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    make_missing(t, c, p);
    if (!t->sky)
        upload_light(t, c, p);
    gl_sea_textures_bind(t);
    TRY(upload_waves(p, error));
    TRY(upload_patches(t, p, camera, error));
    upload_foam(t, p->foam);
    upload_caustics(p->caustics);
    return gl_context_check(c, "a sea", error);
}
