/* ogl1_setup.c - see ogl1_setup.h. */
#include <math.h>

#include "base/memory.h"
#include "base/result.h"

#include "draw/ogl1_setup.h"
#include "shade/lang/lang_c_load.h"
#include "shade/shade.h"

_Static_assert(PHONG_VIGNETTE == (int)FACET_OGL1_VARIANT_VIGNETTE &&
                   PHONG_WEBGL == (int)FACET_OGL1_VARIANT_WEBGL &&
                   PHONG_FIXED == (int)FACET_OGL1_VARIANT_FIXED &&
                   PHONG_RGL_DESKTOP == (int)FACET_OGL1_VARIANT_RGL_DESKTOP,
               "the shader library numbers variants as facet.h does");
_Static_assert(PHONG_FOG_NONE == (int)LEGACY_FOG_NONE && PHONG_FOG_LINEAR == (int)LEGACY_FOG_LINEAR &&
                   PHONG_FOG_EXP == (int)LEGACY_FOG_EXP && PHONG_FOG_EXP2 == (int)LEGACY_FOG_EXP2,
               "and fog as scenes do");

/* ---- maps ---- */

const legacy_map_slot ogl1_map_slots[PHONG_MAP_COUNT] = {
    LEGACY_AMBIENT_MAP,   LEGACY_DIFFUSE_MAP, LEGACY_SPECULAR_MAP, LEGACY_EMISSION_MAP,
    LEGACY_SHININESS_MAP, LEGACY_OPACITY_MAP, LEGACY_NORMAL_MAP};

#define BIT(slot) (1u << (slot))

static const uint32_t OPACITY_MAPS = BIT(LEGACY_DIFFUSE_MAP) | BIT(LEGACY_OPACITY_MAP);
static const uint32_t LIGHT_MAPS = BIT(LEGACY_AMBIENT_MAP) | BIT(LEGACY_SPECULAR_MAP) |
                                   BIT(LEGACY_EMISSION_MAP) | BIT(LEGACY_SHININESS_MAP) |
                                   BIT(LEGACY_NORMAL_MAP);
static const uint32_t COLOR_MAPS =
    BIT(LEGACY_AMBIENT_MAP) | BIT(LEGACY_DIFFUSE_MAP) | BIT(LEGACY_SPECULAR_MAP) | BIT(LEGACY_EMISSION_MAP);

uint32_t ogl1_maps(const render_geometry *g, facet_ogl1_variant variant)
{
    uint32_t bits = OPACITY_MAPS;
    if (g->is_lit && !phong_rules((int)variant).is_lit_at_vertices)
        bits |= LIGHT_MAPS;
    for (int slot = 0; slot < LEGACY_MAP_COUNT; slot++)
        if (!legacy_has_map(g->legacy, (legacy_map_slot)slot))
            bits &= ~BIT(slot);
    return bits;
}

uint32_t ogl1_drawn_maps(const render_geometry *g, facet_ogl1_variant variant)
{
    uint32_t maps = ogl1_maps(g, variant);
    return g->tangents ? maps : maps & ~BIT(LEGACY_NORMAL_MAP);
}

bool ogl1_map_is_color(const legacy_material *m, legacy_map_slot slot, bool is_linear)
{
    bool is_opacity = slot == LEGACY_DIFFUSE_MAP && m->texture_type == LEGACY_ALPHA;
    return is_linear && (COLOR_MAPS & BIT(slot)) && !is_opacity;
}

bool ogl1_map_is_spherical(const legacy_material *m, legacy_map_slot slot)
{
    return slot == LEGACY_DIFFUSE_MAP && m->has_environment_map;
}

float ogl1_map_scalar(const legacy_map *map, const float texel[4])
{
    float value = luminance(vec3(texel[0], texel[1], texel[2]));
    switch (map->channel) {
    case 'r':
        value = texel[0];
        break;
    case 'g':
        value = texel[1];
        break;
    case 'b':
        value = texel[2];
        break;
    case 'm':
        value = texel[3];
        break;
    default:
        break;
    }
    return map->base + map->gain * value;
}

/* ---- the setup ---- */

facet_result ogl1_check(const facet_scene *scene, const facet_render_desc *desc, facet_error *error)
{
    if (desc->shading != FACET_SHADING_OGL1)
        return FACET_OK;
    const scene_legacy *legacy = scene->legacy;
    if (!legacy || (scene->material_count && !legacy->materials))
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "shading: the scene has no materials of OpenGL 1; convert it with "
            "facet_scene_convert_materials(scene, FACET_MATERIAL_MODEL_OGL1, ..) before, or draw it as glTF");
    if (desc->background == FACET_BACKGROUND_ENVIRONMENT)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "background: OpenGL 1 has no environment to show behind the model; expected a color or "
                    "transparent");
    return FACET_OK;
}

/* ---- colors ---- */

/* A color of the file in the values of the computation. */
static vec3 computed(const ogl1_setup *s, const float color[3])
{
    vec3 c = load3(color);
    return !s->frame.is_encoded && s->frame.are_colors_srgb ? linear_from_srgb(c) : c;
}

/* A color with a map: an unspecified one counts as 1, so that the map is visible; so does a black diffuse
 * color, which most programs write for fully textured materials. */
static vec3 color_beside_map(const ogl1_setup *s, const legacy_material *m, legacy_map_slot slot,
                             uint32_t field, const float color[3])
{
    vec3 c = load3(color);
    bool is_absent = !legacy_has(m, field) || (slot == LEGACY_DIFFUSE_MAP && !(max3(c) > 0.0f));
    return legacy_has_map(m, slot) && is_absent ? vec3(1.0f) : computed(s, color);
}

static ogl1_material make_material(const ogl1_setup *s, const legacy_material *m)
{
    ogl1_material out = {.legacy = m,
                         .surface = {.opacity = m->opacity,
                                     .texture_type = (int)m->texture_type,
                                     .texture_mode = (int)m->texture_mode,
                                     .is_halo = m->is_halo,
                                     .has_fog = m->has_fog}};
    bool has_mode = m->texture_mode != LEGACY_MODULATE;
    out.surface.has_texture_over_light =
        s->frame.has_rgl_colors || has_mode || s->frame.rules.is_lit_at_vertices || m->has_environment_map;
    out.surface.material.ambient = color_beside_map(s, m, LEGACY_AMBIENT_MAP, LEGACY_AMBIENT, m->ambient);
    out.surface.material.diffuse =
        s->frame.has_rgl_colors ? computed(s, m->diffuse)
                                : color_beside_map(s, m, LEGACY_DIFFUSE_MAP, LEGACY_DIFFUSE, m->diffuse);
    out.surface.material.specular = color_beside_map(s, m, LEGACY_SPECULAR_MAP, LEGACY_SPECULAR, m->specular);
    out.surface.material.emission = color_beside_map(s, m, LEGACY_EMISSION_MAP, LEGACY_EMISSION, m->emission);
    out.surface.material.shininess = max(m->shininess, 0.0f);
    return out;
}

/* ---- the view ---- */

/* The rows of view are the image's right, up and backward. */
static void set_view(ogl1_setup *s, const camera_rays *camera)
{
    const float *dx = camera->is_orthographic ? camera->origin_dx : camera->direction_dx;
    const float *dy = camera->is_orthographic ? camera->origin_dy : camera->direction_dy;
    s->view = transpose(mat3(normalize(load3(dx)), normalize(-load3(dy)), -load3(camera->direction)));
    s->translation = -mul(s->view, load3(camera->origin));
}

/* ---- lights ---- */

/* origin: the scene's, as light positions are in the file's coordinates. */
static PhongLight make_light(const ogl1_setup *s, const legacy_light *l, const double origin[3])
{
    float w = l->is_point ? 1.0f : s->frame.rules.direction_w;
    vec3 position = load3(l->position);
    for (int k = 0; k < 3 && l->is_point && !l->is_viewpoint_relative; k++)
        position[k] = (float)((double)l->position[k] - origin[k]);
    if (!l->is_viewpoint_relative)
        position = phong_to_eye(s->view, s->translation, position, w);
    vec3 ambient = computed(s, l->ambient);
    vec3 diffuse = computed(s, l->diffuse);
    vec3 specular = computed(s, l->specular);
    return l->is_point ? phong_light_point(position, ambient, diffuse, specular)
                       : phong_light_directional(position, ambient, diffuse, specular);
}

/* Where there are no lights: rgl's light. Its ambient part of 1 is meant for rgl's materials, whose
 * ambient color is black; exporters of MTL write a Ka of 1 or equal to Kd, for OpenGL's default ambient
 * light of 0.2. */
static legacy_light fallback_light(const ogl1_setup *s)
{
    legacy_light light = legacy_light_default();
    float ambient = max3(s->frame.rules.global_ambient) > 0.0f ? 0.0f : 0.2f;
    for (int c = 0; c < 3 && !s->frame.has_rgl_colors; c++)
        light.ambient[c] = ambient;
    return light;
}

static facet_result make_lights(ogl1_setup *s, const scene_legacy *legacy, const double origin[3],
                                const facet_render_desc *desc, const light_setup *light, facet_error *error)
{
    legacy_light default_light = fallback_light(s);
    const legacy_light *lights = legacy->lights;
    uint32_t count = desc->ignores_scene_lights ? 0 : legacy->light_count;
    if (count == 0 && light->punctual_count)
        return FACET_OK;
    if (count == 0) {
        lights = &default_light;
        count = 1;
    }
    s->lights = mem_alloc(&desc->allocator, count, sizeof *s->lights);
    if (!s->lights)
        return fail_memory(error, "lights", count * sizeof *s->lights);
    s->light_count = count;
    for (uint32_t i = 0; i < count; i++)
        s->lights[i] = make_light(s, &lights[i], origin);
    return FACET_OK;
}

/* ---- fog ---- */

/* desc->camera is NULL where the camera was fitted. */
static float fov_y(const camera_rays *camera, const facet_render_desc *desc)
{
    return desc->camera ? desc->camera->fov_y_rad
                        : 2.0f * atanf(0.5f * (float)desc->height * camera->pixel_size);
}

/* Where the camera has no clipping distances they are rgl's, which enclose the bounding sphere of the scene. */
static PhongFog make_fog(const ogl1_setup *s, const legacy_fog *fog, const scene_pose *pose,
                         const camera_rays *camera, const facet_render_desc *desc)
{
    PhongFog out = {.mode = desc->ogl1.ignores_fog ? PHONG_FOG_NONE : (int)fog->mode,
                    .color = computed(s, fog->color),
                    .scale = fog->scale > 0.0f ? fog->scale : 1.0f,
                    .w = phong_fog_w(camera->is_orthographic ? 0.0f : fov_y(camera, desc))};
    vec3 low = load3(pose->bounds_min);
    vec3 high = load3(pose->bounds_max);
    vec3 middle = phong_to_eye(s->view, s->translation, (low + high) * 0.5f, 1.0f);
    float radius = 0.5f * length(high - low);
    out.near_m = camera->near_m > 0.0f ? camera->near_m : max(-middle[2] - radius, 0.0f);
    out.far_m = isfinite(camera->far_m) ? camera->far_m : -middle[2] + radius;
    out.far_m = max(out.far_m, out.near_m * 1.000001f + 1e-6f);
    return out;
}

/* ---- all ---- */

facet_result ogl1_setup_create(const ogl1_source *source, const camera_rays *camera,
                               const facet_render_desc *desc, const light_setup *light,
                               material_plan_set *plans, ogl1_setup *out, facet_error *error)
{
    const facet_scene *scene = source->scene;
    const scene_legacy *legacy = scene->legacy;
    *out = (ogl1_setup){.frame = {.rules = phong_rules((int)desc->ogl1.variant),
                                  .is_encoded = !desc->ogl1.is_linear,
                                  .are_colors_srgb = legacy->colors != FACET_LEGACY_COLORS_LINEAR,
                                  .has_rgl_colors = legacy->is_rgl}};
    if (!desc->ogl1.translates_directions)
        out->frame.rules.direction_w = 0.0f;
    if (!out->frame.is_encoded && out->frame.are_colors_srgb)
        out->frame.rules.global_ambient = linear_from_srgb(out->frame.rules.global_ambient);
    set_view(out, camera);
    out->frame.fog = make_fog(out, &legacy->fog, source->pose, camera, desc);
    size_t count = (size_t)scene->material_count + 1;
    out->materials = mem_alloc(&desc->allocator, count, sizeof *out->materials);
    if (!out->materials)
        return fail_memory(error, "materials", count * sizeof *out->materials);
    for (size_t i = 0; i < count; i++)
        out->materials[i] = make_material(out, i ? &legacy->materials[i - 1] : source->fallback);
    for (uint32_t i = 0; plans && i < source->geometries->count; i++) {
        uint32_t maps = ogl1_drawn_maps(&source->geometries->items[i], desc->ogl1.variant);
        plans->items[i].legacy_maps = maps;
        plans->items[i].needs_derivatives = maps != 0;
    }
    facet_result result = make_lights(out, legacy, scene->origin, desc, light, error);
    if (result != FACET_OK)
        ogl1_setup_destroy(out);
    return result;
}

void ogl1_setup_destroy(ogl1_setup *setup)
{
    mem_free(setup->lights);
    mem_free(setup->materials);
    *setup = (ogl1_setup){0};
}
