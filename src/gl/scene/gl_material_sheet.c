/* gl_material_sheet.c - small copies of a material's textures: see gl_material.h. */
#include <math.h>
#include <stdlib.h>

#include "gl/core/gl_api.h"
#include "gl/scene/gl_material.h"
#include "scene/material_table.h"
#include "shade/shade.h"

enum { SIZE = GL_MATERIAL_SHEET_SIZE };

scene_texture_slot gl_material_sheet_slot(const scene_material *m)
{
    static const scene_texture_slot slots[] = {SCENE_BASE_COLOR_TEXTURE, SCENE_TRANSMISSION_TEXTURE,
                                               SCENE_METALLIC_ROUGHNESS_TEXTURE};
    for (int i = 0; i < 3; i++)
        if (scene_material_has(m, slots[i]))
            return slots[i];
    return SCENE_BASE_COLOR_TEXTURE;
}

/* The first level of at most SIZE texels along its edges. */
static GLint level_of(const uint32_t size[2])
{
    GLint level = 0;
    while (size[0] >> level > SIZE || size[1] >> level > SIZE)
        level++;
    return level;
}

static uint32_t edge_of(uint32_t size, GLint level)
{
    return size >> level ? size >> level : 1;
}

gl_material_sheet gl_material_sheet_size(const gl_material_set *set, const scene_material *m)
{
    uint32_t size[2] = {0, 0};
    gl_material_texture(set, m, gl_material_sheet_slot(m), size);
    GLint level = level_of(size);
    return (gl_material_sheet){edge_of(size[0], level), edge_of(size[1], level),
                               level == 0 && gl_material_is_nearest(set, m, gl_material_sheet_slot(m))};
}

/* A level of a texture, 8-bit RGBA; NULL: it has none, or cannot be read. */
static unsigned char *read_level(uint32_t name, const uint32_t size[2], uint32_t *width, uint32_t *height)
{
    GLint level = level_of(size);
    GLuint framebuffer;
    *width = edge_of(size[0], level);
    *height = edge_of(size[1], level);
    unsigned char *texels = name ? malloc((size_t)*width * *height * 4) : NULL;
    if (!texels)
        return NULL;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, name, level);
    bool is_read = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    if (is_read) {
        glReadBuffer(GL_COLOR_ATTACHMENT0);
        glPixelStorei(GL_PACK_ALIGNMENT, 4);
        glReadPixels(0, 0, (GLsizei)*width, (GLsizei)*height, GL_RGBA, GL_UNSIGNED_BYTE, texels);
        is_read = glGetError() == GL_NO_ERROR; /* half floats cannot be read as bytes everywhere */
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &framebuffer);
    if (is_read)
        return texels;
    free(texels);
    return NULL;
}

/* A slot's texture as it is read into a sheet. */
typedef struct sheet_source {
    unsigned char *texels; /* NULL: every texel is the mean */
    uint32_t width, height;
    float mean[4];
    bool is_color;
} sheet_source;

static bool has_same_coordinates(const scene_texture_ref *a, const scene_texture_ref *b)
{
    for (int i = 0; a->has_transform && b->has_transform && i < 6; i++)
        if (a->transform[i] < b->transform[i] || a->transform[i] > b->transform[i])
            return false;
    return a->texcoord == b->texcoord && a->has_transform == b->has_transform;
}

static sheet_source source_of(const gl_material_set *set, const scene_material *m, scene_texture_slot slot)
{
    sheet_source s = {.is_color = material_textures[slot].is_color};
    uint32_t size[2];
    uint32_t name = gl_material_texture(set, m, slot, size);
    gl_material_mean(set, m, slot, s.mean);
    if (has_same_coordinates(&m->textures[slot], &m->textures[gl_material_sheet_slot(m)]))
        s.texels = read_level(name, size, &s.width, &s.height);
    return s;
}

/* Channel c at the middle of texel (x, y) of the sheet. */
static float channel_at(const sheet_source *s, const gl_material_sheet *sheet, uint32_t x, uint32_t y,
                        uint32_t c)
{
    if (!s->texels)
        return s->mean[c];
    uint32_t column = (2 * x + 1) * s->width / (2 * sheet->width);
    uint32_t row = (2 * y + 1) * s->height / (2 * sheet->height);
    float code = (float)s->texels[4 * ((size_t)row * s->width + column) + c] * (1.0f / 255.0f);
    return s->is_color && c < 3 ? linear_from_srgb1(code) : code;
}

static float rounded(float share)
{
    return floorf(255.0f * fminf(fmaxf(share, 0.0f), 1.0f) + 0.5f);
}

void gl_material_sheet_read(const gl_material_set *set, const scene_material *m,
                            const gl_material_sheet *sheet, float *texels)
{
    sheet_source color = source_of(set, m, SCENE_BASE_COLOR_TEXTURE),
                 transmission = source_of(set, m, SCENE_TRANSMISSION_TEXTURE),
                 roughness = source_of(set, m, SCENE_METALLIC_ROUGHNESS_TEXTURE);
    for (uint32_t y = 0; y < sheet->height; y++)
        for (uint32_t x = 0; x < sheet->width; x++, texels += 4) {
            for (uint32_t c = 0; c < 3; c++)
                texels[c] = channel_at(&color, sheet, x, y, c);
            texels[3] = rounded(channel_at(&color, sheet, x, y, 3)) +
                        256.0f * rounded(channel_at(&transmission, sheet, x, y, 0)) +
                        65536.0f * rounded(channel_at(&roughness, sheet, x, y, 1));
        }
    free(color.texels);
    free(transmission.texels);
    free(roughness.texels);
}
