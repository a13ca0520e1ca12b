/* gl_light.c - see gl_light.h. */
#include "gl/scene/gl_light.h"

#include <epoxy/gl.h>

#include "base/memory.h"
#include "base/result.h"
#include "gl/scene/gl_ground.h"
#include "gl/scene/gl_light_atlas.h"
#include "gl/scene/gl_light_tables.h"
#include "gl/core/gl_program.h"
#include "gl/scene/gl_punctual.h"
#include "gl/scene/gl_shadow.h"
#include "ibl/dfg.h"
#include "ibl/environment.h"

struct gl_light {
    gl_context *context;
    facet_allocator allocator;
    gl_light_tables tables;
    gl_light_atlas atlas;
    gl_punctual punctual;
    gl_shadow *shadow;
    gl_ground ground;
    GLuint caster_block;
    /* whose parts are in the atlas: as long as it lives they stay what they are */
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
    facet_result result = gl_light_tables_create(&light->tables, context, &light->allocator, error);
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
    gl_light_tables_destroy(&light->tables);
    gl_punctual_destroy(&light->punctual);
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
    facet_result result = update_environment(light, setup->ibl, &block, error);
    if (result == FACET_OK)
        result = gl_shadow_plan(light->shadow, desc, setup, bounds_min, bounds_max, error);
    if (result == FACET_OK)
        result = gl_punctual_update(&light->punctual, light->context, &light->allocator, setup, light->shadow,
                                    &block, error);
    if (result != FACET_OK)
        return result;
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
    if (!(features & GL_SURFACE_HAS_SHADOWS)) /* then nothing but the map is looked up */
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
    facet_result result = FACET_OK;
    for (uint32_t i = first; i < end && result == FACET_OK; i++)
        result = gl_programs_request(programs, keys[i], error);
    return result;
}

void gl_light_bind_ground(const gl_light *light)
{
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_MATERIAL);
    glBindTexture(GL_TEXTURE_2D, light->ground.map);
    glBindSampler(GL_UNIT_MATERIAL, 0); /* a material's, with mips */
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
