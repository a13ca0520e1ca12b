/* material_plan.c - see material_plan.h. Texels only scale a factor down: a layer whose factor is 0 is absent
 * everywhere. */
#include "draw/material_plan.h"

#include "base/memory.h"
#include "base/result.h"

#include "shade/shade.h"

_Static_assert((int)SCENE_SPECULAR_COLOR_TEXTURE + 1 == (int)SCENE_CLEARCOAT_TEXTURE,
               "the slots of simple materials come first");

static bool has(const scene_material *m, uint32_t extension)
{
    return (m->extensions & extension) != 0;
}

static bool is_black(const float color[3])
{
    return !(color[0] > 0.0f || color[1] > 0.0f || color[2] > 0.0f);
}

/* ---- layers ---- */

static bool is_metal(const scene_material *m)
{
    return m->metallic >= 1.0f && !scene_material_has(m, SCENE_METALLIC_ROUGHNESS_TEXTURE);
}

/* Layers below the surface of a dielectric. ior 0 means a surface that reflects everything: no light gets
 * below it. */
static uint32_t layers_below(const scene_material *m)
{
    uint32_t layers = 0;
    if (is_metal(m))
        return 0;
    if (has(m, SCENE_TRANSMISSION) && m->transmission > 0.0f && m->ior > 0.0f)
        layers |= LAYER_TRANSMISSION;
    if (has(m, SCENE_DIFFUSE_TRANSMISSION) && m->diffuse_transmission > 0.0f)
        layers |= LAYER_DIFFUSE_TRANSMISSION;
    if (!layers || !has(m, SCENE_VOLUME) || !(m->thickness > 0.0f))
        return layers;
    layers |= LAYER_VOLUME;
    if (has(m, SCENE_DISPERSION) && m->dispersion > 0.0f && m->ior > 1.0f)
        layers |= LAYER_DISPERSION;
    if (has(m, SCENE_VOLUME_SCATTER) && !is_black(m->multiscatter_color))
        layers |= LAYER_SCATTER;
    return layers;
}

uint32_t material_plan_layers(const scene_material *m)
{
    if (has(m, SCENE_UNLIT | SCENE_SPECULAR_GLOSSINESS))
        return 0; /* which excludes all other extensions */
    uint32_t layers = layers_below(m);
    if (has(m, SCENE_CLEARCOAT) && m->clearcoat > 0.0f)
        layers |= LAYER_CLEARCOAT;
    if (has(m, SCENE_SHEEN) && !is_black(m->sheen_color))
        layers |= LAYER_SHEEN;
    if (has(m, SCENE_IRIDESCENCE) && m->iridescence > 0.0f)
        layers |= LAYER_IRIDESCENCE;
    if (has(m, SCENE_ANISOTROPY) && m->anisotropy > 0.0f)
        layers |= LAYER_ANISOTROPY;
    if (has(m, SCENE_DIFFUSE_ROUGHNESS) && m->diffuse_roughness > 0.0f && !is_metal(m))
        layers |= LAYER_DIFFUSE_ROUGHNESS;
    return layers;
}

/* ---- textures ---- */

#define BIT(slot) (1u << (slot))

static uint32_t textures_of_layers(uint32_t layers)
{
    uint32_t bits = 0;
    if (layers & LAYER_CLEARCOAT)
        bits |= BIT(SCENE_CLEARCOAT_TEXTURE) | BIT(SCENE_CLEARCOAT_ROUGHNESS_TEXTURE) |
                BIT(SCENE_CLEARCOAT_NORMAL_TEXTURE);
    if (layers & LAYER_SHEEN)
        bits |= BIT(SCENE_SHEEN_COLOR_TEXTURE) | BIT(SCENE_SHEEN_ROUGHNESS_TEXTURE);
    if (layers & LAYER_IRIDESCENCE)
        bits |= BIT(SCENE_IRIDESCENCE_TEXTURE) | BIT(SCENE_IRIDESCENCE_THICKNESS_TEXTURE);
    if (layers & LAYER_ANISOTROPY)
        bits |= BIT(SCENE_ANISOTROPY_TEXTURE);
    if (layers & LAYER_DIFFUSE_ROUGHNESS)
        bits |= BIT(SCENE_DIFFUSE_ROUGHNESS_TEXTURE);
    if (layers & LAYER_TRANSMISSION)
        bits |= BIT(SCENE_TRANSMISSION_TEXTURE);
    if (layers & LAYER_DIFFUSE_TRANSMISSION) {
        bits |= BIT(SCENE_DIFFUSE_TRANSMISSION_TEXTURE) | BIT(SCENE_DIFFUSE_TRANSMISSION_COLOR_TEXTURE);
        if (layers & LAYER_VOLUME)
            bits |= BIT(SCENE_THICKNESS_TEXTURE); /* straight rays have true distances */
    }
    return bits;
}

uint32_t material_plan_textures(const render_geometry *g)
{
    const scene_material *m = g->material;
    uint32_t bits = BIT(SCENE_BASE_COLOR_TEXTURE);
    if (!has(m, SCENE_UNLIT))
        bits |= BIT(SCENE_EMISSIVE_TEXTURE);
    if (g->is_lit) {
        bits |= BIT(SCENE_NORMAL_TEXTURE) | BIT(SCENE_OCCLUSION_TEXTURE);
        if (has(m, SCENE_SPECULAR_GLOSSINESS))
            bits |= BIT(SCENE_SPECULAR_GLOSSINESS_TEXTURE);
        else
            bits |= BIT(SCENE_METALLIC_ROUGHNESS_TEXTURE) | BIT(SCENE_SPECULAR_TEXTURE) |
                    BIT(SCENE_SPECULAR_COLOR_TEXTURE) | textures_of_layers(material_plan_layers(m));
    }
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
        if (!scene_material_has(m, (scene_texture_slot)slot))
            bits &= ~BIT(slot);
    return bits;
}

/* ---- all ---- */

/* A thin wall without blur, or the boundary of a volume with the same ior on both sides: of a volume of
 * ior 1, or where volumes overlap. */
static bool may_pass_straight(const render_geometry *g, const material_plan *plan, bool has_several_volumes)
{
    const scene_material *m = g->material;
    if (!plan->lets_rays_through)
        return false;
    if (plan->is_volume)
        return !(m->ior > 1.0f) || has_several_volumes;
    bool may_be_smooth = scene_material_has(m, SCENE_METALLIC_ROUGHNESS_TEXTURE);
    return may_be_smooth ||
           thin_wall_alpha(alpha_from_roughness(m->perceptual_roughness), m->ior) <= ALPHA_DELTA;
}

facet_result material_plans_create(const render_geometry_set *set, const facet_allocator *allocator,
                                   material_plan_set *out, facet_error *error)
{
    *out = (material_plan_set){.items = mem_zalloc(allocator, set->count, sizeof *out->items)};
    if (!out->items)
        return fail_memory(error, "materials", set->count * sizeof *out->items);
    const scene_material *volume = NULL;
    for (uint32_t i = 0; i < set->count; i++) {
        const render_geometry *g = &set->items[i];
        material_plan *plan = &out->items[i];
        if (g->legacy)
            continue;
        plan->textures = material_plan_textures(g);
        if (!g->tangents)
            plan->textures &= ~BIT(SCENE_NORMAL_TEXTURE);
        plan->layers = g->is_lit ? material_plan_layers(g->material) : 0;
        bool is_plain = !plan->layers && !has(g->material, SCENE_SPECULAR_GLOSSINESS);
        plan->slot_count = is_plain ? SCENE_CLEARCOAT_TEXTURE : SCENE_TEXTURE_SLOT_COUNT;
        plan->lets_rays_through = (plan->layers & LAYER_TRANSMISSION) != 0;
        plan->needs_derivatives = plan->textures || plan->lets_rays_through;
        plan->is_volume =
            plan->lets_rays_through && (plan->layers & LAYER_VOLUME) && g->primitive->mode == SCENE_TRIANGLES;
        plan->is_closed_volume = (plan->layers & LAYER_VOLUME) && g->primitive->mode == SCENE_TRIANGLES;
        out->has_closed_volumes = out->has_closed_volumes || plan->is_closed_volume;
        out->has_see_through = out->has_see_through || g->is_see_through;
        out->lets_rays_through = out->lets_rays_through || plan->lets_rays_through;
        if (plan->is_volume) {
            out->has_several_volumes = out->has_several_volumes || (volume && volume != g->material);
            volume = g->material;
        }
    }
    for (uint32_t i = 0; i < set->count; i++) {
        out->items[i].may_pass_straight =
            may_pass_straight(&set->items[i], &out->items[i], out->has_several_volumes);
        out->may_pass_straight = out->may_pass_straight || out->items[i].may_pass_straight;
    }
    return FACET_OK;
}

bool material_plan_drops_occlusion(const scene_material *m, bool lacks_red)
{
    return lacks_red && m->occlusion_strength >= 1.0f && scene_material_has(m, SCENE_OCCLUSION_TEXTURE);
}

void material_plan_warn_occlusion(const facet_scene *scene, uint32_t material, const facet_log *log)
{
    const scene_address at = scene_get_address(scene, SCENE_ITEM_MATERIAL, material);
    log_warning(log,
                "%s: the occlusion texture of material %u is black throughout: environment light does not "
                "reach it, so "
                "the texture is left out",
                at.source, at.number);
}

void material_plans_destroy(material_plan_set *plans)
{
    mem_free(plans->items);
    *plans = (material_plan_set){0};
}
