/* gl_shadow.c - see gl_shadow.h. */
#include "gl/scene/gl_shadow.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "gl/core/gl_api.h"
#include "ibl/cube.h"

#include "shade/shade.h"

/* ---- bounds and lights ---- */

/* The region that receives shadows. */
typedef struct shadow_bounds {
    float min[3], max[3];
} shadow_bounds;

/* Wider spots (half angle) use six faces, because a plane would need endless texels: cos(55 degrees). */
static const float WIDE_COS = 0.5736f;

/* Casters closer to a light than a 2000th of the farthest distance are ignored: 24 bits of a + b / depth then
 * resolve depths to 1e-4, a tenth of a texel. */
static const double NEAREST = 1.0 / 2000.0;

static vec3 middle_of(const shadow_bounds *b)
{
    return vec3(0.5f * (b->min[0] + b->max[0]), 0.5f * (b->min[1] + b->max[1]),
                0.5f * (b->min[2] + b->max[2]));
}

static vec3 corner_of(const shadow_bounds *b, int i)
{
    return vec3(i & 1 ? b->max[0] : b->min[0], i & 2 ? b->max[1] : b->min[1], i & 4 ? b->max[2] : b->min[2]);
}

/* Distances from a point to the nearest and farthest point of the box. */
static void distances(const shadow_bounds *b, vec3 P, float *nearest, float *farthest)
{
    vec3 low = vec3(0.0f), high = vec3(0.0f);
    for (int i = 0; i < 3; i++) {
        low[i] = max(max(b->min[i] - P[i], P[i] - b->max[i]), 0.0f);
        high[i] = max(fabsf(b->min[i] - P[i]), fabsf(b->max[i] - P[i]));
    }
    *nearest = length(low);
    *farthest = length(high);
}

static bool is_spot(const Light *light)
{
    return !light->directional && light->spot_scale > 0.0f;
}

/* Cosine of the outer cone. */
static float spot_cosine(const Light *light)
{
    return -light->spot_offset / light->spot_scale;
}

static bool is_cube(const Light *light)
{
    return !light->directional && !(is_spot(light) && spot_cosine(light) > WIDE_COS);
}

/* Illuminance at the nearest point of the bounds, lx, ignoring the cone of a spot. */
static float shadow_brightness(const Light *light, const shadow_bounds *bounds)
{
    float nearest = 1.0f, farthest = 1.0f,
          radius = 0.5f * length(corner_of(bounds, 7) - corner_of(bounds, 0));
    float lux = luminance(light->intensity);
    if (light->directional)
        return lux;
    distances(bounds, light->position, &nearest, &farthest);
    return lux * attenuation_range(max(nearest, 0.1f * radius), light->range);
}

/* Number of tiles of a light; 0: it does not reach the bounds. */
static uint32_t shadow_tile_count(const Light *light, const shadow_bounds *bounds)
{
    if (!(shadow_brightness(light, bounds) > 0.0f))
        return 0;
    return is_cube(light) ? 6 : 1;
}

/* ---- frusta ---- */

static void set3(float out[3], vec3 v)
{
    for (int i = 0; i < 3; i++)
        out[i] = v[i];
}

/* Share of a tile's texels that is not guard. */
static float open_share(uint32_t tile)
{
    return (float)(tile - 2 * GL_SHADOW_GUARD) / (float)tile;
}

/* Fitted around the bounds as seen along the light. */
static void set_parallel(gl_shadow_record *r, const Light *light, const shadow_bounds *bounds, uint32_t tile)
{
    vec3 forward = light->spot_direction;
    mat3 basis = basis_from_normal(forward);
    vec3 low = vec3(INFINITY), high = vec3(-INFINITY), middle = middle_of(bounds);
    for (int i = 0; i < 8; i++) {
        vec3 d = corner_of(bounds, i) - middle;
        vec3 at = vec3(dot(d, COL(basis, 0)), dot(d, COL(basis, 1)), dot(d, forward));
        low = min(low, at);
        high = max(high, at);
    }
    /* A flat scene gets some thickness, so that it lies within. */
    float size = max(max3(high - low), 1e-6f);
    float half_edge = 0.5f * max(high[0] - low[0], high[1] - low[1]) + 1e-3f * size;
    float depth = high[2] - low[2] + 0.02f * size;
    set3(r->origin, middle + forward * (low[2] - 0.01f * size));
    set3(r->right, COL(basis, 0) * (open_share(tile) / half_edge));
    set3(r->up, COL(basis, 1) * (open_share(tile) / half_edge));
    set3(r->forward, forward * (1.0f / depth));
    r->texel = 2.0f * half_edge / (open_share(tile) * (float)tile);
}

/* Range of depths from a light at a point, limited by NEAREST. */
static void set_depths(gl_shadow_record *r, const Light *light, const shadow_bounds *bounds)
{
    float nearest, farthest;
    distances(bounds, light->position, &nearest, &farthest);
    double far = 1.01 * fmax((double)farthest, 1e-6);
    if (light->range > 0.0f)
        far = fmin(far, 1.01 * (double)light->range);
    /* Depth along the axis is shorter than the distance, in a corner of a cube face by 1.74. */
    double near = fmax(0.55 * (double)nearest, NEAREST * far);
    near = fmin(near, 0.5 * far);
    r->depth_a = (float)(far / (far - near));
    r->depth_b = (float)(-far * near / (far - near));
}

static void set_spot(gl_shadow_record *r, const Light *light, uint32_t tile)
{
    mat3 basis = basis_from_normal(light->spot_direction);
    float cosine = spot_cosine(light);
    float tangent = max(sqrt(max(1.0f - cosine * cosine, 0.0f)) / cosine, 1e-3f);
    set3(r->right, COL(basis, 0) * (open_share(tile) / tangent));
    set3(r->up, COL(basis, 1) * (open_share(tile) / tangent));
    set3(r->forward, light->spot_direction);
    r->texel = 2.0f * tangent / (open_share(tile) * (float)tile);
}

/* tile: edge of a tile in texels. */
static gl_shadow_record shadow_record_make(const Light *light, const shadow_bounds *bounds,
                                           uint32_t first_tile, uint32_t tile)
{
    gl_shadow_record r = {.tile = (float)first_tile, .scale = 1.0f};
    if (light->directional) {
        r.kind = GL_SHADOW_PARALLEL;
        set_parallel(&r, light, bounds, tile);
        return r;
    }
    set3(r.origin, light->position);
    set_depths(&r, light, bounds);
    r.kind = GL_SHADOW_SPOT;
    if (!is_cube(light)) {
        set_spot(&r, light, tile);
        return r;
    }
    r.kind = GL_SHADOW_CUBE;
    r.scale = open_share(tile);
    r.texel = 2.0f / (open_share(tile) * (float)tile);
    return r;
}

/* ---- matrices ---- */

/* Axes of a tile: clip-space x and y are dot(d, .) (for cubes s and t); and forward. */
static void axes_of(const gl_shadow_record *r, uint32_t face, double x[3], double y[3], double forward[3])
{
    if ((int)r->kind == GL_SHADOW_CUBE) {
        cube_direction(face, 0.0, 0.0, forward);
        cube_direction(face, 1.0, 0.0, x);
        cube_direction(face, 0.0, 1.0, y);
    }
    for (int i = 0; i < 3; i++) {
        if ((int)r->kind == GL_SHADOW_CUBE) {
            x[i] = (x[i] - forward[i]) * (double)r->scale;
            y[i] = (y[i] - forward[i]) * (double)r->scale;
        } else {
            x[i] = (double)r->right[i];
            y[i] = (double)r->up[i];
            forward[i] = (double)r->forward[i];
        }
    }
}

/* Column-major matrix to clip space (z from -1 to 1) of a tile, for points relative to eye. face: of a cube. */
static void shadow_matrix(const gl_shadow_record *r, uint32_t face, const float eye[3], float out[16])
{
    bool is_parallel = (int)r->kind == GL_SHADOW_PARALLEL;
    double axes[3][3], rows[4][4];
    axes_of(r, face, axes[0], axes[1], axes[2]);
    /* Depth z in [0, 1] is dot(d, forward), or a + b / w; clip space has (2 z - 1) w. */
    double slope = is_parallel ? 2.0 : 2.0 * (double)r->depth_a - 1.0;
    double offset = is_parallel ? -1.0 : 2.0 * (double)r->depth_b;
    for (int i = 0; i < 3; i++) {
        rows[0][i] = axes[0][i];
        rows[1][i] = axes[1][i];
        rows[2][i] = axes[2][i] * slope;
        rows[3][i] = is_parallel ? 0.0 : axes[2][i];
    }
    rows[0][3] = rows[1][3] = 0.0;
    rows[2][3] = offset;
    rows[3][3] = is_parallel ? 1.0 : 0.0;
    for (int row = 0; row < 4; row++) {
        for (int i = 0; i < 3; i++) {
            rows[row][3] -= rows[row][i] * ((double)r->origin[i] - (double)eye[i]);
            out[4 * i + row] = (float)rows[row][i];
        }
        out[12 + row] = (float)rows[row][3];
    }
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
