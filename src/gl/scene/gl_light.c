/* gl_light.c - see gl_light.h. */
#include "gl/scene/gl_light.h"

#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "gl/core/gl_api.h"
#include "gl/core/gl_program.h"
#include "gl/scene/gl_ground.h"
#include "gl/scene/gl_light_atlas.h"
#include "gl/scene/gl_shadow.h"
#include "ibl/dfg.h"
#include "ibl/environment.h"

#include "shade/shade.h"

/* ---- albedo LUTs ---- */

/* LUTs of directional albedo (ibl/dfg.h) as half floats: 2^-11 relative. */
typedef struct light_tables {
    uint32_t albedo; /* DFG and sheen albedo */
    uint32_t glass;  /* 3D: one layer per ior */
} light_tables;

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

enum {
    ALBEDO_NODES = DFG_SIZE * DFG_SIZE,
    GLASS_NODES = 2 * GLASS_IORS * GLASS_SIZE * GLASS_SIZE,
    MAX_NODES = ALBEDO_NODES > GLASS_NODES ? ALBEDO_NODES : GLASS_NODES
};

/* What a texture is made of: three halves of each node, and four of each texel. */
typedef struct table_texels {
    uint16_t halves[3 * MAX_NODES], texels[4 * MAX_NODES];
} table_texels;

static void upload_albedo(light_tables *tables, table_texels *t)
{
    const uint16_t *dfg = t->halves, *sheen = t->halves + DFG_VALUES;
    ibl_dfg_halves(t->halves);
    ibl_sheen_halves(t->halves + DFG_VALUES);
    for (size_t i = 0; i < ALBEDO_NODES; i++) {
        const uint16_t texel[4] = {dfg[2 * i], dfg[2 * i + 1], sheen[i], 0};
        memcpy(t->texels + 4 * i, texel, sizeof texel);
    }
    tables->albedo = make_texture(GL_TEXTURE_2D);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, DFG_SIZE, DFG_SIZE, 0, GL_RGBA, GL_HALF_FLOAT, t->texels);
}

static void upload_glass(light_tables *tables, table_texels *t)
{
    ibl_glass_halves(t->halves);
    for (size_t i = 0; i < GLASS_NODES; i++) {
        memcpy(t->texels + 4 * i, t->halves + 3 * i, 3 * sizeof *t->halves);
        t->texels[4 * i + 3] = 0;
    }
    tables->glass = make_texture(GL_TEXTURE_3D);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA16F, GLASS_SIZE, GLASS_SIZE, 2 * GLASS_IORS, 0, GL_RGBA,
                 GL_HALF_FLOAT, t->texels);
}

static facet_result create_tables(light_tables *tables, gl_context *context, const facet_allocator *allocator,
                                  facet_error *error)
{
    *tables = (light_tables){0};
    table_texels *texels = mem_alloc(allocator, 1, sizeof *texels);
    if (!texels)
        return fail_memory(error, "tables", sizeof *texels);
    upload_albedo(tables, texels);
    upload_glass(tables, texels);
    mem_free(texels);
    return gl_context_check(context, "tables", error);
}

static void destroy_tables(light_tables *tables)
{
    glDeleteTextures(1, &tables->albedo);
    glDeleteTextures(1, &tables->glass);
    *tables = (light_tables){0};
}

/* ---- punctual lights ---- */

/* Punctual lights and the grid of cells that they reach (light_grid.h), as one texture.
 *
 * Rows of GL_LIGHT_ROW texels of four 32-bit words: four texels per light (position and range, spot
 * direction and scale, intensity and spot offset, whether it is directional and where its shadow record
 * is), shadow records (gl_shadow.h), lists of light indices (four per texel: the lights without range,
 * then those of each cell), cells (two per texel: begin and end of the list). Positions are in world
 * space, so a moving camera uploads nothing. Shading a point reads one texel for its cell, then one for
 * the index and four for the data of each light: the cost depends on the lights that reach the point, not
 * on their total. */
typedef struct punctual_lights {
    uint32_t texture;
    uint32_t *words; /* as uploaded */
    uint32_t rows;
} punctual_lights;

enum { LIGHT_TEXELS = 4, WORDS = 4, RECORD_TEXELS = sizeof(gl_shadow_record) / 16 }; /* of four words each */

/* Where each part begins, in texels. */
typedef struct layout {
    size_t records, lists, cells, end, index_count, cell_count;
} layout;

/* Without a grid where there is none, or where it does not fit. */
static layout plan_layout(const light_setup *setup, uint32_t record_count, bool has_grid)
{
    const light_grid *grid = &setup->grid;
    layout l = {.records = LIGHT_TEXELS * (size_t)setup->punctual_count};
    l.lists = l.records + RECORD_TEXELS * (size_t)record_count;
    if (has_grid) {
        l.cell_count = (size_t)grid->cell_count[0] * grid->cell_count[1] * grid->cell_count[2];
        l.index_count = grid->everywhere_count + grid->first[l.cell_count];
    }
    l.cells = l.lists + (l.index_count + WORDS - 1) / WORDS;
    l.end = l.cells + (l.cell_count + 1) / 2;
    return l;
}

/* record: first texel of the light's shadow record; 0: none. */
static void store_light(const Light *light, size_t record, uint32_t *out)
{
    float rows[3][4] = {
        {light->position[0], light->position[1], light->position[2], light->range},
        {light->spot_direction[0], light->spot_direction[1], light->spot_direction[2], light->spot_scale},
        {light->intensity[0], light->intensity[1], light->intensity[2], light->spot_offset}};
    memcpy(out, rows, sizeof rows);
    out[12] = light->directional;
    out[13] = (uint32_t)record;
}

static void store_grid(const light_grid *grid, const layout *l, uint32_t *words)
{
    uint32_t *indices = words + WORDS * l->lists;
    uint32_t *cells = words + WORDS * l->cells;
    size_t near_count = grid->first[l->cell_count];
    if (grid->everywhere_count)
        memcpy(indices, grid->everywhere, grid->everywhere_count * sizeof *indices);
    memcpy(indices + grid->everywhere_count, grid->lights, near_count * sizeof *indices);
    for (size_t i = 0; i < l->cell_count; i++) {
        cells[2 * i] = grid->everywhere_count + grid->first[i];
        cells[2 * i + 1] = grid->everywhere_count + grid->first[i + 1];
    }
}

static void upload_lights(punctual_lights *p, uint32_t rows)
{
    glActiveTexture(GL_TEXTURE0);
    if (!p->texture)
        glGenTextures(1, &p->texture);
    glBindTexture(GL_TEXTURE_2D, p->texture);
    if (rows != p->rows) {
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32UI, GL_LIGHT_ROW, (GLsizei)rows, 0, GL_RGBA_INTEGER,
                     GL_UNSIGNED_INT, NULL);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        p->rows = rows;
    }
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, GL_LIGHT_ROW, (GLsizei)rows, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                    p->words);
}

static void describe_grid(const light_setup *setup, const layout *l, gl_light_block *block)
{
    const light_grid *grid = &setup->grid;
    for (int axis = 0; axis < 3; axis++) {
        block->grid_origin[axis] = grid->origin[axis];
        block->grid_cells[axis] = grid->cells_per_m[axis];
        block->grid_size[axis] = l->cell_count ? (int32_t)grid->cell_count[axis] : 0;
    }
    block->lists[0] = (int32_t)l->lists;
    block->lists[1] = (int32_t)l->cells;
    block->lists[2] = (int32_t)(l->cell_count ? grid->everywhere_count : setup->punctual_count);
}

static facet_result update_punctual(punctual_lights *p, gl_context *context, const facet_allocator *allocator,
                                    const light_setup *setup, const gl_shadow *shadow, gl_light_block *block,
                                    facet_error *error)
{
    uint32_t record_count;
    const gl_shadow_record *records = gl_shadow_records(shadow, &record_count);
    size_t most = (size_t)context->max_texture_size * GL_LIGHT_ROW;
    layout l = plan_layout(setup, record_count, setup->grid.first != NULL);
    if (l.end > most)
        l = plan_layout(setup, record_count, false);
    if (l.end > most)
        return fail(error, FACET_ERROR_LIMIT, "OpenGL (%s): %u lights; the maximum is %zu", context->name,
                    setup->punctual_count, most / LIGHT_TEXELS);
    describe_grid(setup, &l, block);
    if (setup->punctual_count == 0)
        return FACET_OK;
    size_t rows = (l.end + GL_LIGHT_ROW - 1) / GL_LIGHT_ROW;
    uint32_t *words = mem_zalloc(allocator, rows * GL_LIGHT_ROW, WORDS * sizeof *words);
    if (!words)
        return fail_memory(error, "lights", rows * GL_LIGHT_ROW * WORDS * sizeof *words);
    for (uint32_t i = 0; i < setup->punctual_count; i++) {
        uint32_t record = gl_shadow_of_light(shadow, i);
        store_light(&setup->punctual[i], record ? l.records + RECORD_TEXELS * (record - 1) : 0,
                    words + (size_t)i * LIGHT_TEXELS * WORDS);
    }
    if (record_count)
        memcpy(words + l.records * WORDS, records, record_count * sizeof *records);
    if (l.cell_count)
        store_grid(&setup->grid, &l, words);
    bool is_same =
        p->words && mem_size(p->words) == mem_size(words) && memcmp(p->words, words, mem_size(words)) == 0;
    mem_free(p->words);
    p->words = words;
    if (!is_same)
        upload_lights(p, (uint32_t)rows);
    return gl_context_check(context, "lights", error);
}

static void destroy_punctual(punctual_lights *p)
{
    glDeleteTextures(1, &p->texture);
    mem_free(p->words);
    *p = (punctual_lights){0};
}

/* ---- the light of an image ---- */

struct gl_light {
    gl_context *context;
    facet_allocator allocator;
    light_tables tables;
    gl_light_atlas atlas;
    punctual_lights punctual;
    gl_shadow *shadow;
    gl_ground ground;
    GLuint caster_block;
    /* retained: as long as it lives, the parts in the atlas stay valid */
    facet_environment *environment;
    bool has_environment;
    uint32_t light_count;
    float scale, rotation_cos, rotation_sin;
    GLuint block;
};

facet_result gl_light_create(gl_context *context, const facet_allocator *allocator, gl_light **out,
                             facet_error *error)
{
    gl_light *light = mem_zalloc(allocator, 1, sizeof *light);
    *out = NULL;
    if (!light)
        return fail_memory(error, "light", sizeof *light);
    light->context = context;
    light->ground.context = context;
    light->allocator = allocator ? *allocator : (facet_allocator){0};
    glGenBuffers(1, &light->block);
    facet_result result = create_tables(&light->tables, context, &light->allocator, error);
    if (result == FACET_OK)
        result = gl_shadow_create(context, &light->allocator, &light->shadow, error);
    if (result != FACET_OK) {
        gl_light_destroy(light);
        return result;
    }
    *out = light;
    return FACET_OK;
}

static void drop_environment(gl_light *light)
{
    gl_light_atlas_destroy(&light->atlas);
    if (light->environment)
        environment_release(light->environment);
    light->environment = NULL;
}

void gl_light_destroy(gl_light *light)
{
    if (!light)
        return;
    drop_environment(light);
    destroy_tables(&light->tables);
    destroy_punctual(&light->punctual);
    gl_shadow_destroy(light->shadow);
    gl_ground_destroy(&light->ground);
    glDeleteBuffers(1, &light->block);
    glDeleteBuffers(1, &light->caster_block);
    mem_free(light);
}

static facet_result update_environment(gl_light *light, const ibl_light *ibl, gl_light_block *block,
                                       facet_error *error)
{
    light->has_environment = ibl != NULL;
    if (!ibl || light->environment != ibl->environment)
        drop_environment(light);
    if (!ibl)
        return FACET_OK;
    if (!light->environment) {
        light->environment = ibl->environment;
        environment_retain(light->environment);
    }
    facet_result result = gl_light_atlas_update(&light->atlas, light->context, &light->allocator, ibl, error);
    if (result == FACET_OK)
        gl_light_atlas_describe(&light->atlas, ibl, block);
    return result;
}

facet_result gl_light_update(gl_light *light, const light_setup *setup, const facet_render_desc *desc,
                             const float bounds_min[3], const float bounds_max[3], facet_error *error)
{
    gl_light_block block = {.atlas = {0.0f, 0.0f, 0.0f, GLASS_ROOT_MAX}};
    light->scale = setup->scale;
    light->rotation_cos = setup->rotation_cos;
    light->rotation_sin = setup->rotation_sin;
    light->light_count = setup->punctual_count;
    TRY(update_environment(light, setup->ibl, &block, error));
    TRY(gl_shadow_plan(light->shadow, desc, setup, bounds_min, bounds_max, error));
    TRY(update_punctual(&light->punctual, light->context, &light->allocator, setup, light->shadow, &block,
                        error));
    gl_shadow_describe(light->shadow, &block);
    gl_ground_plan(&light->ground, desc, bounds_min, bounds_max);
    gl_ground_describe(&light->ground, &block);
    glBindBuffer(GL_UNIFORM_BUFFER, light->block);
    glBufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_DYNAMIC_DRAW);
    return gl_context_check(light->context, "light", error);
}

facet_result gl_light_draw_shadows(gl_light *light, gl_programs *programs, const gl_mesh_set *meshes,
                                   const gl_material_set *materials, const float eye[3], uint64_t revision,
                                   facet_error *error)
{
    gl_casters casters = {.context = light->context,
                          .programs = programs,
                          .meshes = meshes,
                          .materials = materials,
                          .eye = {eye[0], eye[1], eye[2]},
                          .revision = revision,
                          .block = light->caster_block};
    facet_result result = gl_shadow_draw(light->shadow, &casters, error);
    glBindBufferBase(GL_UNIFORM_BUFFER, GL_BLOCK_LIGHT, light->block);
    if (result == FACET_OK)
        result = gl_ground_draw(&light->ground, &casters, error);
    light->caster_block = casters.block;
    return result;
}

uint64_t gl_light_features(const gl_light *light)
{
    uint32_t shadow_count;
    gl_shadow_records(light->shadow, &shadow_count);
    return (light->has_environment ? GL_SURFACE_HAS_ENVIRONMENT : 0u) |
           (light->light_count ? GL_SURFACE_HAS_LIGHTS : 0u) | (shadow_count ? GL_SURFACE_HAS_SHADOWS : 0u);
}

uint64_t gl_light_background_features(const gl_light *light, const facet_render_desc *desc)
{
    return (light->has_environment ? GL_BACKGROUND_HAS_ENVIRONMENT : 0u) |
           (desc->background_blur > 0.0f ? GL_BACKGROUND_IS_BLURRED : 0u);
}

bool gl_light_has_ground(const gl_light *light)
{
    return light->ground.is_wanted;
}

uint64_t gl_light_ground_features(const gl_light *light)
{
    uint64_t features = gl_light_features(light);
    if (!(features & GL_SURFACE_HAS_SHADOWS)) /* then only the map is looked up */
        return 0;
    return GL_GROUND_HAS_LIGHTS | GL_GROUND_HAS_SHADOWS |
           (features & GL_SURFACE_HAS_ENVIRONMENT ? GL_GROUND_HAS_ENVIRONMENT : 0u);
}

facet_result gl_light_request_programs(const gl_light *light, gl_programs *programs, facet_error *error)
{
    const gl_program_key keys[] = {
        {GL_MAIN_SHADOW, 0}, {GL_MAIN_GROUND_MAP, 0}, {GL_MAIN_GROUND, gl_light_ground_features(light)}};
    bool has_shadows = gl_light_features(light) & GL_SURFACE_HAS_SHADOWS;
    uint32_t first = has_shadows || light->ground.is_wanted ? 0 : 1;
    uint32_t end = light->ground.is_wanted ? 3 : 1;
    for (uint32_t i = first; i < end; i++)
        TRY(gl_programs_request(programs, keys[i], error));
    return FACET_OK;
}

void gl_light_bind_ground(const gl_light *light)
{
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_MATERIAL);
    glBindTexture(GL_TEXTURE_2D, light->ground.map);
    glBindSampler(GL_UNIT_MATERIAL, 0); /* without a material's sampler, which has mips */
}

static void bind(GLuint unit, GLenum target, GLuint texture)
{
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(target, texture);
}

void gl_light_bind(const gl_light *light, gl_frame_block *block)
{
    bind(GL_UNIT_ENVIRONMENT, GL_TEXTURE_2D, light->atlas.texture);
    bind(GL_UNIT_SHARP, GL_TEXTURE_2D, light->atlas.background);
    bind(GL_UNIT_TABLES, GL_TEXTURE_2D, light->tables.albedo);
    bind(GL_UNIT_GLASS, GL_TEXTURE_3D, light->tables.glass);
    bind(GL_UNIT_LIGHTS, GL_TEXTURE_2D, light->punctual.texture);
    bind(GL_UNIT_SHADOWS, GL_TEXTURE_2D, gl_shadow_texture(light->shadow));
    glBindBufferBase(GL_UNIFORM_BUFFER, GL_BLOCK_LIGHT, light->block);
    block->light[0] = light->scale;
    block->light[1] = light->rotation_cos;
    block->light[2] = light->rotation_sin;
    block->light[3] = (float)light->light_count;
}
