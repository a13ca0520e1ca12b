/* convert.c - the order of a conversion, which is whole or not at all. See convert.h. */
#include "legacy/convert.h"

#include <string.h>

#include "base/result.h"
#include "legacy/convert_state.h"
#include "scene/legacy_extras.h"

/* ---- textures that only the source materials read leave the scene (facet_legacy_desc.drops_sources) ----
 *
 * Planned before extras are written, which refer to textures by index, and carried out when all else is there. The original
 * lists stay with the conversion, whose report renders the source materials. */

enum { STAYS = 0 }; /* marks a kept texture until its new index is assigned */

/* The image of a texture after texture_baker_finish(), which appends new ones. */
static uint32_t image_of(const facet_scene *scene, uint32_t texture)
{
    return texture < scene->texture_count ? scene->textures[texture].image
                                          : scene->image_count + (texture - scene->texture_count);
}

static void mark_textures(const conversion *c, drop_plan *plan)
{
    const facet_scene *scene = c->scene;
    for (uint32_t i = 0; i < plan->texture_count; i++)
        plan->textures[i] = i < scene->texture_count ? STAYS : SCENE_NONE;
    for (uint32_t i = 0; i < scene->material_count; i++)
        for (int slot = 0; slot < LEGACY_MAP_COUNT; slot++) {
            uint32_t texture = scene->legacy->materials[i].maps[slot].ref.texture;
            if (texture < plan->texture_count)
                plan->textures[texture] = SCENE_NONE;
        }
    for (uint32_t i = 0; i < scene->material_count; i++)
        for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++) {
            uint32_t texture = c->materials[i].textures[slot].texture;
            if (texture < plan->texture_count)
                plan->textures[texture] = STAYS;
        }
}

static void mark_images(const facet_scene *scene, drop_plan *plan)
{
    /* Dropped textures first, since a texture that stays keeps an image that they share. */
    for (int stays = 0; stays < 2; stays++)
        for (uint32_t i = 0; i < plan->texture_count; i++) {
            uint32_t image = image_of(scene, i);
            if (image < plan->image_count && (plan->textures[i] == STAYS) == (stays == 1))
                plan->images[image] = plan->textures[i];
        }
}

/* Numbers the entries that stay, in order; returns their count. */
static uint32_t count_places(uint32_t *places, uint32_t count)
{
    uint32_t next = 0;
    for (uint32_t i = 0; i < count; i++)
        if (places[i] != SCENE_NONE)
            places[i] = next++;
    return next;
}

static uint32_t place_of(const drop_plan *plan, uint32_t texture)
{
    return texture < plan->texture_count ? plan->textures[texture] : SCENE_NONE;
}

static void move_pbr(const drop_plan *plan, scene_material *m)
{
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
        m->textures[slot].texture = place_of(plan, m->textures[slot].texture);
}

static void move_legacy(const drop_plan *plan, legacy_material *m)
{
    for (int slot = 0; slot < LEGACY_MAP_COUNT; slot++) {
        legacy_map *map = &m->maps[slot];
        uint32_t place = place_of(plan, map->ref.texture);
        map->is_left_out |= place == SCENE_NONE && map->ref.texture != SCENE_NONE;
        map->ref.texture = place;
    }
}

/* Copies of the materials with the new indices. */
static bool move_materials(conversion *c, drop_plan *plan)
{
    facet_scene *scene = c->scene;
    size_t count = scene->material_count;
    scene_material *materials = arena_alloc(scene->arena, count + 1, sizeof *materials);
    legacy_material *legacy = arena_alloc(scene->arena, count + 1, sizeof *legacy);
    c->legacy = arena_alloc(scene->arena, 1, sizeof *c->legacy);
    if (!materials || !legacy || !c->legacy)
        return false;
    plan->source->materials = c->materials;
    plan->source->legacy = scene->legacy->materials;
    for (size_t i = 0; i < count; i++) {
        materials[i] = c->materials[i];
        legacy[i] = scene->legacy->materials[i];
        move_pbr(plan, &materials[i]);
        move_legacy(plan, &legacy[i]);
        c->out->materials[i].pbr = materials[i];
        c->out->materials[i].legacy = legacy[i];
    }
    c->materials = materials;
    *c->legacy = *scene->legacy;
    c->legacy->materials = legacy;
    return true;
}

static facet_result drop_plan_make(conversion *c, facet_error *error)
{
    facet_scene *scene = c->scene;
    drop_plan *plan = &c->drop;
    uint32_t made = texture_baker_made(c->baker);
    *plan =
        (drop_plan){.texture_count = scene->texture_count + made, .image_count = scene->image_count + made};
    size_t texture_count = (size_t)plan->texture_count + 1;
    size_t image_count = (size_t)plan->image_count + 1;
    plan->textures = arena_zalloc(scene->arena, texture_count, sizeof *plan->textures);
    plan->images = arena_zalloc(scene->arena, image_count, sizeof *plan->images);
    plan->new_textures = arena_alloc(scene->arena, texture_count, sizeof *plan->new_textures);
    plan->new_images = arena_alloc(scene->arena, image_count, sizeof *plan->new_images);
    plan->source = arena_zalloc(scene->arena, 1, sizeof *plan->source);
    if (!plan->textures || !plan->images || !plan->new_textures || !plan->new_images || !plan->source)
        return fail_memory(error, "textures", texture_count * sizeof *plan->new_textures);
    mark_textures(c, plan);
    mark_images(scene, plan);
    uint32_t kept_textures = count_places(plan->textures, plan->texture_count);
    uint32_t kept_images = count_places(plan->images, plan->image_count);
    /* Image-based lights refer to images too, but come with glTF files only, whose images stay. */
    plan->is_needed = scene->image_light_count == 0 &&
                      (kept_textures < plan->texture_count || kept_images < plan->image_count);
    if (plan->is_needed && !move_materials(c, plan))
        return fail_memory(error, "materials", scene->material_count * sizeof(legacy_material));
    return FACET_OK;
}

static void drop_plan_carry_out(conversion *c)
{
    facet_scene *scene = c->scene;
    drop_plan *plan = &c->drop;
    uint32_t texture_count = 0;
    uint32_t image_count = 0;
    if (!plan->is_needed)
        return;
    for (uint32_t i = 0; i < scene->texture_count; i++) {
        if (plan->textures[i] == SCENE_NONE)
            continue;
        scene_texture *texture = &plan->new_textures[texture_count++];
        *texture = scene->textures[i];
        texture->image = texture->image < plan->image_count ? plan->images[texture->image] : SCENE_NONE;
    }
    for (uint32_t i = 0; i < scene->image_count; i++)
        if (plan->images[i] != SCENE_NONE)
            plan->new_images[image_count++] = scene->images[i];
    plan->source->texture_count = scene->texture_count;
    plan->source->textures = scene->textures;
    plan->source->image_count = scene->image_count;
    plan->source->images = scene->images;
    c->out->source = plan->source;
    scene->textures = plan->new_textures;
    scene->texture_count = texture_count;
    scene->images = plan->new_images;
    scene->image_count = image_count;
}

/* ---- extras.facet_legacy of each glTF material and of the scene: nothing is lost, and the reverse is
 * exact ---- */

/* Extras with that member, in the arena; NULL: out of memory. */
static const char *merged(const facet_scene *scene, const char *extras, const text *member)
{
    text all = {.allocator = scene->allocator};
    legacy_extras_merge(extras, member->data, &all);
    const char *kept =
        member->has_failed || all.has_failed ? NULL : arena_strdup(scene->arena, all.data ? all.data : "{}");
    text_destroy(&all);
    return kept;
}

static facet_result convert_extras(conversion *c, facet_error *error)
{
    facet_scene *scene = c->scene;
    const struct scene_legacy *legacy = c->legacy ? c->legacy : scene->legacy;
    text member = {.allocator = scene->allocator};
    for (uint32_t i = 0; i < scene->material_count; i++) {
        scene_material *material = &c->materials[i];
        if (legacy->materials[i].is_gltf_restored)
            continue;
        text_destroy(&member);
        member = (text){.allocator = scene->allocator};
        legacy_extras_write(legacy, i, material, &member);
        material->meta.extras = merged(scene, material->meta.extras, &member);
        if (!material->meta.extras)
            break;
        c->out->materials[i].pbr.meta = material->meta;
    }
    bool is_complete = true;
    for (uint32_t i = 0; i < scene->material_count; i++)
        is_complete &= legacy->materials[i].is_gltf_restored || c->materials[i].meta.extras != NULL;
    text_destroy(&member);
    member = (text){.allocator = scene->allocator};
    legacy_extras_write_scene(legacy, &member);
    const char *extras = is_complete ? merged(scene, scene->meta.extras, &member) : NULL;
    text_destroy(&member);
    if (!extras)
        return fail_memory(error, "extras", scene->material_count);
    scene->meta.extras = extras;
    return FACET_OK;
}

/* ---- the conversion ---- */

#define PI 3.14159265358979323846

static void note_light(conversion *c, facet_material_model to)
{
    bool is_legacy = to == FACET_MATERIAL_MODEL_OGL1 || (c->scene->legacy && c->scene->legacy->is_source);
    c->out->light_scale = is_legacy && !c->desc.keeps_light ? PI : 1.0;
    if (is_legacy && !c->desc.keeps_light)
        note_add(&c->notes, SCENE_NONE, NOTE_LEGACY_LIGHT_PI,
                 "a legacy light of 1 is an illuminance of pi in glTF: %s",
                 c->scene->light_count > 0 ? "lights were converted so"
                                           : "light the model with pi times what the legacy program had");
}

static facet_result begin(conversion *c, facet_material_model to, facet_error *error)
{
    facet_scene *scene = c->scene;
    c->out = arena_zalloc(scene->arena, 1, sizeof *c->out);
    material_conversion *materials =
        arena_zalloc(scene->arena, (size_t)scene->material_count + 1, sizeof *materials);
    if (!c->out || !materials)
        return fail_memory(error, "materials", scene->material_count * sizeof *materials);
    *c->out = (scene_conversion){.to = to, .material_count = scene->material_count, .materials = materials};
    return texture_baker_create(scene, &c->baker, error);
}

static facet_result convert_all(conversion *c, facet_material_model to, facet_error *error)
{
    bool is_source = c->scene->legacy && c->scene->legacy->is_source;
    switch (to) {
    case FACET_MATERIAL_MODEL_OGL1:
        return convert_to_ogl1(c, error);
    case FACET_MATERIAL_MODEL_SPECULAR_GLOSSINESS:
        return convert_to_glossiness(c, error);
    case FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS:
        break;
    }
    return is_source ? convert_from_ogl1(c, error) : convert_from_glossiness(c, error);
}

/* Whether legacy materials cannot be converted again, since the first conversion dropped images of theirs. */
static bool has_missing_images(const facet_scene *scene)
{
    if (!scene->legacy || !scene->legacy->is_source || !scene->conversion)
        return false;
    for (uint32_t i = 0; i < scene->material_count; i++)
        if (legacy_lacks_images(&scene->legacy->materials[i]))
            return true;
    return false;
}

facet_result legacy_convert(facet_scene *scene, facet_material_model to, const facet_legacy_desc *desc,
                            const facet_log *log, facet_error *error)
{
    if (to == FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS && has_missing_images(scene))
        return FACET_OK;
    conversion c = {.scene = scene, .desc = *desc, .log = log, .notes = {.scene = scene}};
    facet_result result = begin(&c, to, error);
    if (result == FACET_OK)
        result = convert_all(&c, to, error);
    if (result == FACET_OK)
        note_light(&c, to);
    /* The scene is unchanged until everything else has succeeded. */
    bool has_legacy = c.materials && scene->legacy && scene->legacy->is_source;
    if (result == FACET_OK && has_legacy && desc->drops_sources &&
        to == FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS)
        result = drop_plan_make(&c, error);
    if (result == FACET_OK && has_legacy)
        result = convert_extras(&c, error);
    if (result == FACET_OK && !note_list_finish(&c.notes, log, c.out))
        result = fail_memory(error, "warnings", c.notes.count * sizeof(note));
    if (result == FACET_OK)
        result = texture_baker_finish(c.baker, error);
    if (result == FACET_OK) {
        drop_plan_carry_out(&c);
        scene->conversion = c.out;
        scene->materials = c.materials ? c.materials : scene->materials;
        scene->legacy = c.legacy ? c.legacy : scene->legacy;
        scene->content_revision++;
    }
    texture_baker_destroy(c.baker);
    note_list_destroy(&c.notes);
    return result;
}
