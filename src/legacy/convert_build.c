/* convert_build.c - a glTF material from an interpreted legacy one: factors, opacity, emission and
 * extensions. Textures of the surface are made by convert_build_maps.c. */
#include "legacy/convert_state.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/result.h"

const char *made_name(conversion *c, uint32_t texture, const char *purpose)
{
    const facet_scene *scene = c->scene;
    const scene_image *source = texture < scene->texture_count && scene->textures[texture].image != SCENE_NONE
                                    ? &scene->images[scene->textures[texture].image]
                                    : NULL;
    const char *name = source ? (source->name[0] ? source->name : source->uri ? source->uri : "") : "";
    const char *slash = strrchr(name, '/');
    name = slash ? slash + 1 : name;
    const char *dot = strrchr(name, '.');
    size_t length = dot && dot != name ? (size_t)(dot - name) : strlen(name);
    char whole[160];
    snprintf(whole, sizeof whole, "%.*s_%s", (int)(length < 120 ? length : 120), name, purpose);
    const char *kept = arena_strdup(scene->arena, whole);
    c->notes.has_failed |= !kept;
    return kept ? kept : "";
}

ogl1_surface build_representative(const conversion *c, const legacy_reading *r)
{
    ogl1_surface s = r->surface;
    const legacy_map *maps = r->m.maps;
    if (!legacy_has_map(&r->m, LEGACY_DIFFUSE_MAP) && !legacy_has_map(&r->m, LEGACY_SPECULAR_MAP) &&
        !legacy_has_map(&r->m, LEGACY_SHININESS_MAP))
        return s;
    color_lut diffuse = color_lut_make(c->baker, &maps[LEGACY_DIFFUSE_MAP], r->surface.diffuse);
    color_lut specular = color_lut_make(c->baker, &maps[LEGACY_SPECULAR_MAP], r->surface.specular);
    scalar_lut shininess =
        scalar_lut_make(c->baker, &maps[LEGACY_SHININESS_MAP], r->surface.shininess, TEXTURE_GREY);
    color_lut_mean(&diffuse, c->baker, &maps[LEGACY_DIFFUSE_MAP], s.diffuse);
    color_lut_mean(&specular, c->baker, &maps[LEGACY_SPECULAR_MAP], s.specular);
    s.shininess = scalar_lut_mean(&shininess, c->baker, &maps[LEGACY_SHININESS_MAP]);
    return s;
}

/* ---- emission and occlusion ---- */

typedef struct emission_parameters {
    color_lut color;
    const srgb_tables *srgb;
} emission_parameters;

static void emission_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out)
{
    const emission_parameters *p = parameters;
    for (uint32_t x = 0; x < width; x++, out += 3) {
        float color[3];
        lut_color(&p->color, in[0] + (size_t)x * 4, color);
        for (int k = 0; k < 3; k++)
            out[k] = srgb_encode_u8(p->srgb, color[k]);
    }
}

/* emissiveFactor is at most 1; the rest goes into the strength. */
static facet_result build_emission(conversion *c, const legacy_reading *r, scene_material *out,
                                   facet_error *error)
{
    const legacy_map *map = &r->m.maps[LEGACY_EMISSION_MAP];
    float most = highest_of(r->emission);
    if (most <= 0.0f)
        return FACET_OK;
    out->emissive_strength = most > 1.0f ? most : 1.0f;
    if (most > 1.0f)
        out->extensions |= SCENE_EMISSIVE_STRENGTH;
    for (int k = 0; k < 3; k++)
        out->emissive[k] = r->emission[k] / out->emissive_strength;
    if (map->ref.texture == SCENE_NONE)
        return FACET_OK;
    out->textures[SCENE_EMISSIVE_TEXTURE] = map->ref;
    if (map_is_plain(map))
        return FACET_OK;
    emission_parameters p;
    memset(&p, 0, sizeof p);
    p.color = color_lut_make(c->baker, map, (const float[3]){1, 1, 1});
    p.srgb = texture_baker_srgb(c->baker);
    texture_bake bake = {.name = made_name(c, map->ref.texture, "emission"),
                         .inputs = {map->ref.texture},
                         .input_count = 1,
                         .channel_count = 3,
                         .row = emission_row,
                         .parameters = &p,
                         .parameter_size = sizeof p};
    return texture_baker_bake(c->baker, &bake, &out->textures[SCENE_EMISSIVE_TEXTURE].texture, error);
}

/* ---- relief ---- */

/* The full range of a bump map at -bm 1 rises by this fraction of the width of its image. */
#define BUMP_SLOPE 0.02f

/* Tangent-space normals are (.5, .5, 1) on average; a grey image has three equal means. */
static bool is_normal_map(const texture_statistics *s)
{
    float codes[256];
    for (int i = 0; i < 256; i++)
        codes[i] = (float)i / 255.0f;
    double red = texture_mean(s, TEXTURE_RED, codes);
    double green = texture_mean(s, TEXTURE_GREEN, codes);
    double blue = texture_mean(s, TEXTURE_BLUE, codes);
    return fabs(red - 0.5) < 0.1 && fabs(green - 0.5) < 0.1 && blue > 0.75;
}

static void relief_weights(const legacy_map *map, float weights[4])
{
    for (int k = 0; k < 4; k++)
        weights[k] = k < 3 ? 1.0f / 3.0f : 0.0f;
    const char *letters = "rgbm";
    const char *found = map->channel ? strchr(letters, map->channel) : NULL;
    for (int k = 0; found && k < 4; k++)
        weights[k] = letters + k == found ? 1.0f : 0.0f;
}

static facet_result build_normals(conversion *c, uint32_t material, const legacy_reading *r,
                                  scene_material *out, facet_error *error)
{
    const legacy_map *normal = &r->m.maps[LEGACY_NORMAL_MAP];
    const legacy_map *bump = &r->m.maps[LEGACY_BUMP_MAP];
    scene_texture_ref *ref = &out->textures[SCENE_NORMAL_TEXTURE];
    if (normal->ref.texture != SCENE_NONE) {
        *ref = normal->ref;
        out->normal_scale = normal->bump_multiplier;
        if (bump->ref.texture != SCENE_NONE)
            note_add(&c->notes, material, NOTE_MAP_DROPPED,
                     "bump is ignored, since there is a norm map; extras keep it");
        return FACET_OK;
    }
    if (bump->ref.texture == SCENE_NONE)
        return FACET_OK;
    *ref = bump->ref;
    if (is_normal_map(texture_baker_statistics(c->baker, bump->ref.texture))) {
        out->normal_scale = bump->bump_multiplier;
        note_add(&c->notes, material, NOTE_BUMP_AS_NORMAL,
                 "map_bump contains normals, not heights, and is used as a normal map");
        return FACET_OK;
    }
    texture_relief relief = {.name = made_name(c, bump->ref.texture, "normal"),
                             .texture = bump->ref.texture,
                             .base = bump->base,
                             .gain = bump->gain,
                             .slope = BUMP_SLOPE * bump->bump_multiplier};
    relief_weights(bump, relief.weights);
    return texture_baker_relief(c->baker, &relief, &ref->texture, error);
}

/* ---- MTL's extension for physically based materials ---- */

typedef struct sheen_parameters {
    scalar_lut sheen;
    const srgb_tables *srgb;
} sheen_parameters;

static void sheen_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out)
{
    const sheen_parameters *p = parameters;
    for (uint32_t x = 0; x < width; x++, out += 3)
        memset(out, srgb_encode_u8(p->srgb, lut_scalar(&p->sheen, in[0] + (size_t)x * 4)), 3);
}

/* Ps states no roughness; importers of principled materials start from this. */
#define SHEEN_ROUGHNESS 0.5f

static facet_result build_sheen(conversion *c, const legacy_reading *r, scene_material *out,
                                facet_error *error)
{
    const legacy_map *map = &r->m.maps[LEGACY_SHEEN_MAP];
    bool has_map = map->ref.texture != SCENE_NONE;
    float sheen = legacy_has(&r->m, LEGACY_SHEEN) ? unit_of(r->m.sheen) : has_map ? 1.0f : 0.0f;
    if (sheen <= 0.0f)
        return FACET_OK;
    out->extensions |= SCENE_SHEEN;
    out->sheen_roughness = SHEEN_ROUGHNESS;
    for (int k = 0; k < 3; k++)
        out->sheen_color[k] = sheen;
    if (!has_map)
        return FACET_OK;
    sheen_parameters p;
    memset(&p, 0, sizeof p);
    p.sheen = scalar_lut_make(c->baker, map, 1.0f, TEXTURE_GREY);
    p.srgb = texture_baker_srgb(c->baker);
    texture_bake bake = {.name = made_name(c, map->ref.texture, "sheen"),
                         .inputs = {map->ref.texture},
                         .input_count = 1,
                         .channel_count = 3,
                         .row = sheen_row,
                         .parameters = &p,
                         .parameter_size = sizeof p};
    out->textures[SCENE_SHEEN_COLOR_TEXTURE] = map->ref;
    return texture_baker_bake(c->baker, &bake, &out->textures[SCENE_SHEEN_COLOR_TEXTURE].texture, error);
}

static void build_coat(const conversion *c, const legacy_reading *r, scene_material *out)
{
    const legacy_material *m = &r->m;
    /* Blender stores its coat weight times 4. */
    float share = c->scene->legacy->dialect == FACET_MTL_DIALECT_BLENDER3 ? 0.25f : 1.0f;
    if (legacy_has(m, LEGACY_CLEARCOAT) && m->clearcoat > 0.0f) {
        out->extensions |= SCENE_CLEARCOAT;
        out->clearcoat = unit_of(m->clearcoat * share);
        out->clearcoat_roughness =
            legacy_has(m, LEGACY_CLEARCOAT_ROUGHNESS) ? unit_of(m->clearcoat_roughness) : 0.0f;
    }
    if (legacy_has(m, LEGACY_ANISOTROPY) && m->anisotropy != 0.0f) {
        out->extensions |= SCENE_ANISOTROPY;
        out->anisotropy = unit_of(m->anisotropy);
        out->anisotropy_rotation =
            legacy_has(m, LEGACY_ANISOTROPY_ROTATION) ? m->anisotropy_rotation * 6.2831853f : 0.0f;
    }
}

/* ---- glass ---- */

/* The smallest extent of the geometry with the material: the thickness of its volume. */
static float thickness_of(const facet_scene *scene, uint32_t material)
{
    float least = 0;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t j = 0; j < scene->meshes[i].primitive_count; j++) {
            const scene_primitive *p = &scene->meshes[i].primitives[j];
            for (int k = 0; p->material == material && k < 3; k++) {
                float extent = p->bounds_max[k] - p->bounds_min[k];
                if (extent > 0.0f && (least == 0.0f || extent < least))
                    least = extent;
            }
        }
    return least;
}

static void build_glass(const conversion *c, uint32_t material, const legacy_reading *r, scene_material *out)
{
    if (r->transmission <= 0.0f)
        return;
    out->extensions |= SCENE_TRANSMISSION;
    out->transmission = r->transmission;
    if (out->ior != 0.0f) {
        out->extensions |= SCENE_IOR;
        out->ior = r->ior;
    }
    float thickness = r->is_refracting ? thickness_of(c->scene, material) : 0.0f;
    if (thickness > 0.0f) {
        out->extensions |= SCENE_VOLUME;
        out->thickness = thickness;
    }
}

/* ---- the surface ---- */

static void build_specular_level(const legacy_reading *r, scene_material *out)
{
    if (r->specular_level == 1.0f)
        return;
    out->extensions |= SCENE_SPECULAR;
    out->specular = r->specular_level < 1.0f ? r->specular_level : 1.0f;
    for (int k = 0; k < 3; k++)
        out->specular_color[k] = r->specular_level > 1.0f ? r->specular_level : 1.0f;
}

static void build_factors(const conversion *c, const legacy_reading *r, const solve_item *item,
                          scene_material *out)
{
    out->metallic = 0.0f;
    switch (r->kind) {
    case READING_UNLIT:
        out->extensions |= SCENE_UNLIT;
        break;
    case READING_METALLIC:
        out->metallic = r->metallic;
        out->perceptual_roughness = r->perceptual_roughness;
        if (c->desc.profile == FACET_LEGACY_PROFILE_SPECULAR_IOR)
            build_specular_level(r, out);
        break;
    case READING_GLOSSY: /* shade/specular_glossiness.h */
        out->extensions |= SCENE_SPECULAR | SCENE_IOR;
        out->ior = 0.0f;
        out->perceptual_roughness = 1.0f - r->glossiness;
        out->specular = r->F90;
        for (int k = 0; k < 3; k++)
            out->specular_color[k] = r->surface.specular[k] / r->F90;
        break;
    case READING_OGL1:
        out->metallic = item->pbr.metallic;
        out->perceptual_roughness = item->pbr.perceptual_roughness;
        out->ior = item->pbr.ior;
        out->specular = item->pbr.specular;
        memcpy(out->specular_color, item->pbr.specular_color, sizeof out->specular_color);
        if (c->desc.profile == FACET_LEGACY_PROFILE_SPECULAR_IOR)
            out->extensions |= SCENE_SPECULAR | SCENE_IOR;
        break;
    case READING_KEPT:
        break;
    }
}

facet_result build_material(conversion *c, uint32_t material, legacy_reading *r, const solve_item *item,
                            scene_material *out, facet_error *error)
{
    const scene_material *before = &c->scene->materials[material];
    *out = scene_material_default();
    out->name = before->name;
    out->meta = before->meta;
    out->is_double_sided = !r->m.is_culled;
    build_factors(c, r, item, out);
    facet_result result = build_surface_maps(c, material, r, item, out, error);
    if (result != FACET_OK || r->kind == READING_UNLIT)
        return result;
    build_coat(c, r, out);
    build_glass(c, material, r, out);
    if (c->desc.ambient == FACET_LEGACY_AMBIENT_OCCLUSION && legacy_has_map(&r->m, LEGACY_AMBIENT_MAP))
        out->textures[SCENE_OCCLUSION_TEXTURE] = r->m.maps[LEGACY_AMBIENT_MAP].ref;
    TRY(build_emission(c, r, out, error));
    TRY(build_sheen(c, r, out, error));
    return build_normals(c, material, r, out, error);
}
