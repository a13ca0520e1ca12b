/* gl_shadow.c - see gl_shadow.h. */
#include "gl/scene/gl_shadow.h"

#include <epoxy/gl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "gl/scene/gl_camera.h"
#include "gl/scene/gl_shadow_plan.h"

#include "shade/shade.h"

/* ---- casters ---- */

facet_result gl_casters_make_texture(gl_context *context, uint32_t edge, bool compares, uint32_t *texture,
                                     uint32_t *framebuffer, facet_error *error)
{
    static const GLenum none = GL_NONE;
    GLint filter = compares ? GL_LINEAR : GL_NEAREST; /* filter of the comparison results */
    glActiveTexture(GL_TEXTURE0);
    glGenTextures(1, texture);
    glBindTexture(GL_TEXTURE_2D, *texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, (GLsizei)edge, (GLsizei)edge, 0, GL_DEPTH_COMPONENT,
                 GL_FLOAT, NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    if (compares) {
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    }
    glGenFramebuffers(1, framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, *texture, 0);
    glDrawBuffers(1, &none);
    glReadBuffer(GL_NONE);
    return gl_context_check(context, "shadows", error);
}

void gl_casters_begin(const gl_casters *c, uint32_t framebuffer, uint32_t edge)
{
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl_camera_end_depth(c->context);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glViewport(0, 0, (GLsizei)edge, (GLsizei)edge);
    glClear(GL_DEPTH_BUFFER_BIT);
}

static bool casts(const gl_batch *batch, gl_pass pass)
{
    return !batch->is_sprites &&
           (pass == GL_PASS_OPAQUE || (pass == GL_PASS_TRANSMISSIVE && batch->plan->is_volume));
}

static facet_result draw_batch(const gl_casters *c, const gl_batch *batch, facet_error *error)
{
    uint64_t all = gl_material_features(c->materials, batch) | gl_mesh_features(c->meshes, batch);
    bool is_masked = all >> GL_SURFACE_HAS_ALPHA_MASK & 1;
    uint32_t program;
    gl_program_key key = {GL_MAIN_SHADOW, is_masked ? all : 0};
    TRY(gl_programs_get(c->programs, key, &program, error));
    glUseProgram(program);
    if (is_masked)
        gl_material_bind(c->materials, batch);
    glDisable(GL_CULL_FACE); /* both sides cast shadows */
    gl_mesh_draw(c->meshes, batch);
    return FACET_OK;
}

facet_result gl_casters_draw(gl_casters *c, const float matrix[16], uint32_t x, uint32_t y, uint32_t edge,
                             facet_error *error)
{
    gl_frame_block frame = {.eye = {c->eye[0], c->eye[1], c->eye[2]}};
    memcpy(frame.view_projection, matrix, sizeof frame.view_projection);
    if (!c->block)
        glGenBuffers(1, &c->block);
    glBindBuffer(GL_UNIFORM_BUFFER, c->block);
    glBufferData(GL_UNIFORM_BUFFER, sizeof frame, &frame, GL_STREAM_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, GL_BLOCK_FRAME, c->block);
    glViewport((GLint)x, (GLint)y, (GLsizei)edge, (GLsizei)edge);
    for (gl_pass pass = GL_PASS_OPAQUE; pass < GL_PASS_COUNT; pass++) {
        uint32_t count;
        const gl_batch *batches = gl_mesh_batches(c->meshes, pass, &count);
        for (uint32_t i = 0; i < count; i++) {
            if (!casts(&batches[i], pass) || gl_mesh_is_outside(&batches[i], &frame))
                continue;
            TRY(draw_batch(c, &batches[i], error));
        }
    }
    return FACET_OK;
}

/* ---- shadow maps ---- */

struct gl_shadow {
    gl_context *context;
    facet_allocator allocator;
    GLuint texture, framebuffer;
    uint32_t edge; /* of the texture, texels */
    uint32_t tile, tiles_per_row, tile_count;
    gl_shadow_record *records;
    uint32_t record_count, lost; /* number of lights without shadows in the last warning */
    uint32_t *of_light;          /* per light: index of its record + 1 */
    uint32_t light_count;
    uint64_t drawn_revision; /* scene revision of the texture; 0: none */
    shadow_bounds bounds;
};

facet_result gl_shadow_create(gl_context *context, const facet_allocator *allocator, gl_shadow **out,
                              facet_error *error)
{
    *out = mem_zalloc(allocator, 1, sizeof **out);
    if (!*out)
        return fail_memory(error, "shadows", sizeof **out);
    (*out)->context = context;
    (*out)->allocator = allocator ? *allocator : (facet_allocator){0};
    return FACET_OK;
}

static void destroy_texture(gl_shadow *s)
{
    glDeleteTextures(1, &s->texture);
    glDeleteFramebuffers(1, &s->framebuffer);
    s->texture = s->framebuffer = 0;
    s->edge = 0;
    s->drawn_revision = 0;
}

void gl_shadow_destroy(gl_shadow *s)
{
    if (!s)
        return;
    destroy_texture(s);
    mem_free(s->records);
    mem_free(s->of_light);
    mem_free(s);
}

/* ---- selection of lights ---- */

typedef struct candidate {
    uint32_t light, tiles;
    float brightness;
} candidate;

static int brightest_first(const void *x, const void *y)
{
    const candidate *a = x, *b = y;
    if (a->brightness < b->brightness || a->brightness > b->brightness)
        return a->brightness > b->brightness ? -1 : 1;
    return (a->light > b->light) - (a->light < b->light);
}

/* Lights that reach the bounds, sorted; returns their number. */
static uint32_t find_candidates(const light_setup *setup, const shadow_bounds *bounds, candidate *out)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < setup->punctual_count; i++) {
        uint32_t tiles = shadow_tile_count(&setup->punctual[i], bounds);
        if (tiles)
            out[count++] = (candidate){i, tiles, shadow_brightness(&setup->punctual[i], bounds)};
    }
    qsort(out, count, sizeof *out, brightest_first);
    return count;
}

/* Number of candidates that fit, and their tiles. */
static uint32_t lay_out(gl_shadow *s, const candidate *candidates, uint32_t count)
{
    uint32_t most = (uint32_t)s->context->max_texture_size;
    most = most < GL_SHADOW_MAP_MAX ? most : GL_SHADOW_MAP_MAX;
    uint32_t rows = most / GL_SHADOW_TILE_MIN, taken = 0, tiles = 0;
    while (taken < count && tiles + candidates[taken].tiles <= rows * rows)
        tiles += candidates[taken++].tiles;
    s->tiles_per_row = 1;
    while (s->tiles_per_row * s->tiles_per_row < tiles)
        s->tiles_per_row++;
    s->tile = most / s->tiles_per_row;
    s->tile = s->tile < GL_SHADOW_TILE_MAX ? s->tile : GL_SHADOW_TILE_MAX;
    s->tile_count = tiles;
    return taken;
}

static void warn_lost(gl_shadow *s, const facet_log *log, uint32_t lost, uint32_t all)
{
    if (lost && lost != s->lost && log->message) {
        char message[160];
        snprintf(message, sizeof message,
                 "shadows: %u of %u lights cast none; the shadow map has room for the %u brightest", lost,
                 all, all - lost);
        log->message(log->user, FACET_LOG_LEVEL_WARNING, message);
    }
    s->lost = lost;
}

/* Takes over the records; where they are unchanged, the texture stays valid. */
static facet_result take_records(gl_shadow *s, const light_setup *setup, const candidate *candidates,
                                 uint32_t count, facet_error *error)
{
    gl_shadow_record *records = mem_zalloc(&s->allocator, count, sizeof *records);
    if (!records)
        return fail_memory(error, "shadows", count * sizeof *records);
    memset(s->of_light, 0, setup->punctual_count * sizeof *s->of_light);
    for (uint32_t i = 0, tile = 0; i < count; tile += candidates[i++].tiles) {
        records[i] = shadow_record_make(&setup->punctual[candidates[i].light], &s->bounds, tile, s->tile);
        s->of_light[candidates[i].light] = i + 1;
    }
    bool is_same = count == s->record_count && s->edge == s->tile * s->tiles_per_row &&
                   (count == 0 || memcmp(records, s->records, count * sizeof *records) == 0);
    mem_free(s->records);
    s->records = records;
    s->record_count = count;
    s->drawn_revision = is_same ? s->drawn_revision : 0;
    return FACET_OK;
}

facet_result gl_shadow_plan(gl_shadow *s, const facet_render_desc *desc, const light_setup *setup,
                            const float bounds_min[3], const float bounds_max[3], facet_error *error)
{
    memcpy(s->bounds.min, bounds_min, sizeof s->bounds.min);
    memcpy(s->bounds.max, bounds_max, sizeof s->bounds.max);
    if (!desc->gl.has_shadows || setup->punctual_count == 0 || !(bounds_min[0] <= bounds_max[0])) {
        s->record_count = s->light_count = 0;
        return FACET_OK;
    }
    candidate *candidates = mem_alloc(&s->allocator, setup->punctual_count, sizeof *candidates);
    uint32_t *of_light = mem_alloc(&s->allocator, setup->punctual_count, sizeof *of_light);
    mem_free(s->of_light);
    s->of_light = of_light;
    s->light_count = of_light ? setup->punctual_count : 0;
    facet_result result = FACET_OK;
    if (!candidates || !of_light)
        result = fail_memory(error, "shadows", setup->punctual_count * sizeof *candidates);
    if (result == FACET_OK) {
        uint32_t count = find_candidates(setup, &s->bounds, candidates);
        uint32_t taken = lay_out(s, candidates, count);
        warn_lost(s, &desc->log, count - taken, count);
        result = take_records(s, setup, candidates, taken, error);
    }
    mem_free(candidates);
    return result;
}

const gl_shadow_record *gl_shadow_records(const gl_shadow *s, uint32_t *count)
{
    *count = s->record_count;
    return s->records;
}

uint32_t gl_shadow_of_light(const gl_shadow *s, uint32_t light)
{
    return light < s->light_count && s->record_count ? s->of_light[light] : 0;
}

void gl_shadow_describe(const gl_shadow *s, gl_light_block *block)
{
    if (s->record_count == 0)
        return;
    block->shadow[0] = (float)s->tile;
    block->shadow[1] = (float)s->tiles_per_row;
    block->shadow[2] = 1.0f / (float)(s->tile * s->tiles_per_row);
}

/* ---- drawing ---- */

static facet_result make_texture(gl_shadow *s, facet_error *error)
{
    uint32_t edge = s->tile * s->tiles_per_row;
    if (s->edge == edge)
        return FACET_OK;
    destroy_texture(s);
    facet_result result =
        gl_casters_make_texture(s->context, edge, true, &s->texture, &s->framebuffer, error);
    if (result != FACET_OK)
        destroy_texture(s);
    else
        s->edge = edge;
    return result;
}

static facet_result draw_tiles(const gl_shadow *s, const gl_shadow_record *record, gl_casters *casters,
                               facet_error *error)
{
    uint32_t faces = (int)record->kind == GL_SHADOW_CUBE ? 6 : 1;
    for (uint32_t face = 0; face < faces; face++) {
        float matrix[16];
        uint32_t tile = (uint32_t)record->tile + face;
        shadow_matrix(record, face, casters->eye, matrix);
        TRY(gl_casters_draw(casters, matrix, tile % s->tiles_per_row * s->tile,
                            tile / s->tiles_per_row * s->tile, s->tile, error));
    }
    return FACET_OK;
}

facet_result gl_shadow_draw(gl_shadow *s, gl_casters *casters, facet_error *error)
{
    if (s->record_count == 0)
        return FACET_OK;
    facet_result result = make_texture(s, error);
    if (result != FACET_OK || s->drawn_revision == casters->revision)
        return result;
    s->drawn_revision = 0;
    gl_casters_begin(casters, s->framebuffer, s->edge);
    for (uint32_t i = 0; i < s->record_count && result == FACET_OK; i++)
        result = draw_tiles(s, &s->records[i], casters, error);
    if (result == FACET_OK)
        result = gl_context_check(s->context, "shadows", error);
    s->drawn_revision = result == FACET_OK ? casters->revision : 0;
    return result;
}

uint32_t gl_shadow_texture(const gl_shadow *s)
{
    return s->texture;
}
