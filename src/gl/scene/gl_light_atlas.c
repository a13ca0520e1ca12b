/* gl_light_atlas.c - see gl_light_atlas.h. Parts are packed on shelves, the tallest first. */
#include "gl/scene/gl_light_atlas.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "gl/core/gl_api.h"
#include "ibl/dfg.h"
#include "ibl/equirect.h"
#include "image/half.h"

/* The source of a part: one of the two. */
typedef struct atlas_source {
    const cube *faces;
    const image *equirect;
} atlas_source;

static atlas_source source_of(const ibl_light *light, uint32_t part)
{
    const cube *faces = part == GL_ATLAS_IRRADIANCE ? &light->irradiance_over_pi
                        : part < GL_ATLAS_LEVELS
                            ? &light->levels[part / PREFILTER_LEVEL_COUNT][part % PREFILTER_LEVEL_COUNT]
                            : NULL;
    if (faces)
        return (atlas_source){.faces = faces->texels ? faces : NULL};
    uint32_t number = part - GL_ATLAS_IMAGES;
    const image *equirect = number == 0 ? &light->sharp
                            : light->narrow && number <= light->narrow->count
                                ? &light->narrow->blurred[number - 1]
                                : NULL;
    return (atlas_source){.equirect = equirect && equirect->pixels ? equirect : NULL};
}

static const void *source_texels(atlas_source s)
{
    return s.faces ? s.faces->texels : s.equirect ? s.equirect->pixels : NULL;
}

/* ---- texels ---- */

/* The power of two that scales the largest of count floats to [2^14, 2^15). */
static float find_scale(const float *values, size_t count)
{
    float most = 0.0f;
    int exponent = 0;
    for (size_t i = 0; i < count; i++)
        most = values[i] > most ? values[i] : most;
    if (most > 0.0f)
        frexpf(most, &exponent);
    return most > 0.0f ? ldexpf(1.0f, exponent - 15) : 1.0f;
}

static void store_texel(uint16_t *out, const float *rgb, float factor)
{
    for (int k = 0; k < 3; k++)
        out[k] = half_from_float(rgb[k] * factor);
    out[3] = 0;
}

static uint16_t *make_texels(const facet_allocator *allocator, size_t width, size_t height,
                             facet_error *error)
{
    uint16_t *texels = mem_alloc(allocator, width * height, 4 * sizeof *texels);
    if (!texels)
        fail_memory(error, "environment", width * height * 4 * sizeof *texels);
    return texels;
}

static void send(const uint16_t *texels, uint32_t x, uint32_t y, uint32_t width, uint32_t height)
{
    glTexSubImage2D(GL_TEXTURE_2D, 0, (GLint)x, (GLint)y, (GLsizei)width, (GLsizei)height, GL_RGBA,
                    GL_HALF_FLOAT, texels);
}

/* Columns are the axes of the faces, rows their signs. */
static facet_result send_cube(const cube *c, gl_atlas_part *part, const facet_allocator *allocator,
                              facet_error *error)
{
    size_t stride = (size_t)c->size + 2;
    uint16_t *texels = make_texels(allocator, stride, stride, error);
    if (!texels)
        return FACET_ERROR_MEMORY;
    float most = 0.0f; /* without the unused fourth lane */
    for (size_t i = 0; i < 6 * stride * stride; i++)
        for (int k = 0; k < 3; k++)
            most = c->texels[i][k] > most ? c->texels[i][k] : most;
    part->scale = find_scale(&most, 1);
    for (uint32_t face = 0; face < 6; face++) {
        for (size_t i = 0; i < stride * stride; i++) {
            rgbx t = c->texels[face * stride * stride + i];
            store_texel(texels + 4 * i, (float[3]){t[0], t[1], t[2]}, 1.0f / part->scale);
        }
        send(texels, part->x + face / 2 * (uint32_t)stride, part->y + (face & 1) * (uint32_t)stride,
             (uint32_t)stride, (uint32_t)stride);
    }
    mem_free(texels);
    return FACET_OK;
}

enum { BAND = 64 }; /* rows per upload */

/* Uploads an equirectangular image. border: texels around it, which wrap around the seam and repeat the
 * rows at the poles. */
static facet_result send_equirect(const image *equirect, uint32_t border, gl_atlas_part *part,
                                  const facet_allocator *allocator, facet_error *error)
{
    uint32_t width = equirect->width + 2 * border;
    uint32_t height = equirect->height + 2 * border;
    uint16_t *texels = make_texels(allocator, width, BAND, error);
    if (!texels)
        return FACET_ERROR_MEMORY;
    part->scale = find_scale(equirect->pixels, 3 * (size_t)equirect->width * equirect->height);
    for (uint32_t first = 0; first < height; first += BAND) {
        uint32_t count = height - first < BAND ? height - first : BAND;
        for (uint32_t i = 0; i < count; i++) {
            uint32_t y = first + i < border ? 0 : first + i - border;
            y = y < equirect->height ? y : equirect->height - 1;
            const float *row = (const float *)equirect->pixels + 3 * (size_t)equirect->width * y;
            for (uint32_t x = 0; x < width; x++)
                store_texel(texels + 4 * ((size_t)i * width + x),
                            row + 3 * (size_t)((x + equirect->width - border) % equirect->width),
                            1.0f / part->scale);
        }
        send(texels, part->x, part->y + first, width, count);
    }
    mem_free(texels);
    return FACET_OK;
}

/* The same, scaled down to OpenGL's limit. */
static facet_result send_fitting(const image *equirect, uint32_t border, gl_atlas_part *part,
                                 const facet_allocator *allocator, facet_error *error)
{
    if (part->width == equirect->width && part->height == equirect->height)
        return send_equirect(equirect, border, part, allocator, error);
    image small = {0};
    facet_result result = equirect_resize(equirect, part->width, part->height, allocator, 1, &small, error);
    if (result == FACET_OK)
        result = send_equirect(&small, border, part, allocator, error);
    image_destroy(&small);
    return result;
}

/* ---- textures ---- */

static uint32_t make_texture(uint32_t width, uint32_t height, GLint wrap)
{
    GLuint name;
    glGenTextures(1, &name);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, (GLsizei)width, (GLsizei)height, 0, GL_RGBA, GL_HALF_FLOAT,
                 NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return name;
}

static bool is_cube(uint32_t part)
{
    return part < GL_ATLAS_IMAGES;
}

/* Size of a part in the texture, border included. */
static uint32_t outer_width(const gl_light_atlas *a, uint32_t part)
{
    return is_cube(part) ? 3 * (a->parts[part].width + 2) : a->parts[part].width + 2;
}

static uint32_t outer_height(const gl_light_atlas *a, uint32_t part)
{
    return is_cube(part) ? 2 * (a->parts[part].height + 2) : a->parts[part].height + 2;
}

/* Sorts the indices of the existing parts, the tallest first; returns their number. */
static uint32_t sort_parts(const gl_light_atlas *a, uint32_t order[GL_ATLAS_PARTS])
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < GL_ATLAS_PARTS; i++) {
        if (!a->parts[i].texels)
            continue;
        uint32_t at = count++;
        for (; at > 0 && outer_height(a, order[at - 1]) < outer_height(a, i); at--)
            order[at] = order[at - 1];
        order[at] = i;
    }
    return count;
}

/* Places the parts in a texture of that width; returns its height. */
static uint32_t place_parts(gl_light_atlas *a, uint32_t width)
{
    uint32_t order[GL_ATLAS_PARTS];
    uint32_t count = sort_parts(a, order);
    uint32_t x = 0, y = 0, shelf = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t w = outer_width(a, order[i]);
        if (x + w > width) {
            x = 0;
            y += shelf;
            shelf = 0;
        }
        a->parts[order[i]].x = x;
        a->parts[order[i]].y = y;
        x += w;
        shelf = shelf > outer_height(a, order[i]) ? shelf : outer_height(a, order[i]);
    }
    return y + shelf;
}

/* Sizes and positions. All cube maps together take 628 thousand texels; an image takes at most a quarter of
 * OpenGL's limit (at least 2048 rows), and only the first one is large, so everything fits. */
static void plan(gl_light_atlas *a, const ibl_light *light, uint32_t most)
{
    uint32_t widest = 1024;
    for (uint32_t i = 0; i < GL_ATLAS_PARTS; i++) {
        atlas_source s = source_of(light, i);
        gl_atlas_part *p = &a->parts[i];
        *p = (gl_atlas_part){.texels = source_texels(s)};
        if (s.faces)
            p->width = p->height = s.faces->size;
        if (s.equirect) {
            p->width = s.equirect->width < most - 2 ? s.equirect->width : most - 2;
            p->height = s.equirect->height < most / 4 ? s.equirect->height : most / 4;
        }
        uint32_t width = p->texels ? outer_width(a, i) : 0;
        widest = widest > width ? widest : width;
    }
    a->width = widest;
    a->height = place_parts(a, widest);
    a->height = a->height ? a->height : 1;
}

static facet_result upload(gl_light_atlas *a, const ibl_light *light, const facet_allocator *allocator,
                           facet_error *error)
{
    a->texture = make_texture(a->width, a->height, GL_CLAMP_TO_EDGE);
    facet_result result = FACET_OK;
    for (uint32_t i = 0; i < GL_ATLAS_PARTS && result == FACET_OK; i++) {
        atlas_source s = source_of(light, i);
        if (s.faces)
            result = send_cube(s.faces, &a->parts[i], allocator, error);
        else if (s.equirect)
            result = send_fitting(s.equirect, 1, &a->parts[i], allocator, error);
    }
    return result;
}

static facet_result upload_background(gl_light_atlas *a, const image *equirect, uint32_t most,
                                      const facet_allocator *allocator, facet_error *error)
{
    a->behind = (gl_atlas_part){.texels = equirect->pixels,
                                .width = equirect->width < most ? equirect->width : most,
                                .height = equirect->height < most ? equirect->height : most,
                                .scale = 1.0f};
    a->background = make_texture(a->behind.width, a->behind.height, GL_REPEAT);
    return send_fitting(equirect, 0, &a->behind, allocator, error);
}

static bool has_parts(const gl_light_atlas *a, const ibl_light *light)
{
    for (uint32_t i = 0; i < GL_ATLAS_PARTS; i++) {
        const void *texels = source_texels(source_of(light, i));
        if (texels && texels != a->parts[i].texels)
            return false;
    }
    return a->texture != 0;
}

static void destroy_texture(uint32_t *name)
{
    glDeleteTextures(1, name);
    *name = 0;
}

facet_result gl_light_atlas_update(gl_light_atlas *a, gl_context *context, const facet_allocator *allocator,
                                   const ibl_light *light, facet_error *error)
{
    uint32_t most = (uint32_t)context->max_texture_size;
    facet_result result = FACET_OK;
    if (!has_parts(a, light)) {
        destroy_texture(&a->texture);
        plan(a, light, most);
        result = upload(a, light, allocator, error);
    }
    if (result == FACET_OK && light->background.pixels && light->background.pixels != a->behind.texels) {
        destroy_texture(&a->background);
        result = upload_background(a, &light->background, most, allocator, error);
    }
    if (result == FACET_OK)
        result = gl_context_check(context, "environment", error);
    if (result != FACET_OK)
        gl_light_atlas_destroy(a);
    return result;
}

void gl_light_atlas_destroy(gl_light_atlas *a)
{
    destroy_texture(&a->texture);
    destroy_texture(&a->background);
    *a = (gl_light_atlas){0};
}

/* ---- the uniform block ---- */

static void describe_cube(const gl_atlas_part *p, float place[4])
{
    place[0] = (float)p->x;
    place[1] = (float)p->y;
    place[2] = (float)p->width;
    place[3] = p->texels ? p->scale : 0.0f;
}

static void describe_levels(const gl_light_atlas *a, const ibl_light *light, prefilter_lobe lobe,
                            gl_light_block *block)
{
    ibl_level_range range = light->ranges[lobe];
    bool is_there = range.first <= range.last;
    block->ranges[2 * lobe] = is_there ? (int32_t)range.first : 1;
    block->ranges[2 * lobe + 1] = is_there ? (int32_t)range.last : 1;
    uint32_t count = prefilter_level_count(lobe);
    for (uint32_t i = 0; i < count; i++) {
        if (is_there) /* otherwise all levels are black */
            describe_cube(&a->parts[PREFILTER_LEVEL_COUNT * lobe + i], block->places[lobe][i]);
        block->steps[lobe][i] = prefilter_roughness(lobe, i);
        if (i >= range.first && i < range.last && is_there)
            block->slopes[lobe][i] = 1.0f / (prefilter_roughness(lobe, i + 1) - prefilter_roughness(lobe, i));
    }
}

static void describe_narrow(const gl_light_atlas *a, const ibl_light *light, gl_light_block *block)
{
    for (uint32_t k = 0; k < GL_LIGHT_IMAGES; k++) {
        const gl_atlas_part *p = &a->parts[GL_ATLAS_IMAGES + k];
        float place[4] = {(float)p->x, (float)p->y, (float)p->width, (float)p->height};
        memcpy(block->images[k], place, sizeof place);
    }
    for (uint32_t i = 0; i < GL_LIGHT_STEPS; i++) {
        const float sharp[NARROW_PARTS] = {1.0f};
        const float *weights = light->narrow ? light->narrow->weights[i] : sharp;
        for (uint32_t k = 0; k < GL_LIGHT_IMAGES; k++)
            if (a->parts[GL_ATLAS_IMAGES + k].texels)
                block->narrow_weights[i][k] = weights[NARROW_SHARP + k] * a->parts[GL_ATLAS_IMAGES + k].scale;
        block->narrow_lobe[i][0] = weights[NARROW_LOBE];
    }
}

void gl_light_atlas_describe(const gl_light_atlas *a, const ibl_light *light, gl_light_block *block)
{
    block->atlas[0] = 1.0f / (float)a->width;
    block->atlas[1] = 1.0f / (float)a->height;
    block->atlas[2] = light->background.pixels ? a->behind.scale : 0.0f;
    for (int lobe = 0; lobe < PREFILTER_LOBE_COUNT; lobe++)
        describe_levels(a, light, (prefilter_lobe)lobe, block);
    if (light->irradiance_over_pi.texels)
        describe_cube(&a->parts[GL_ATLAS_IRRADIANCE], block->irradiance);
    describe_narrow(a, light, block);
}
