/* convert.c - see convert.h: what is done in which direction, and that a conversion is whole or not at all. */
#include "legacy/convert.h"

#include <string.h>

#include "base/result.h"
#include "legacy/convert_state.h"
#include "legacy/lights.h"

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
    return texture_bench_create(scene, &c->bench, error);
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

/* Whether the old materials cannot be converted once more: pictures of theirs have left, with the first time. */
static bool has_lost_pictures(const facet_scene *scene)
{
    if (!scene->legacy || !scene->legacy->is_source || !scene->conversion)
        return false;
    for (uint32_t i = 0; i < scene->material_count; i++)
        if (legacy_lacks_pictures(&scene->legacy->materials[i]))
            return true;
    return false;
}

facet_result legacy_convert(facet_scene *scene, facet_material_model to, const facet_legacy_desc *desc,
                            const facet_log *log, facet_error *error)
{
    if (to == FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS && has_lost_pictures(scene))
        return FACET_OK;
    conversion c = {.scene = scene, .desc = *desc, .log = log, .notes = {.scene = scene}};
    facet_result result = begin(&c, to, error);
    if (result == FACET_OK)
        result = convert_all(&c, to, error);
    if (result == FACET_OK)
        note_light(&c, to);
    /* Nothing of the scene is touched before all is there. */
    bool has_legacy = c.materials && scene->legacy && scene->legacy->is_source;
    if (result == FACET_OK && has_legacy && desc->drops_sources &&
        to == FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS)
        result = drop_plan_make(&c, error);
    if (result == FACET_OK && has_legacy)
        result = convert_extras(&c, error);
    if (result == FACET_OK && !note_list_finish(&c.notes, log, c.out))
        result = fail_memory(error, "warnings", c.notes.count * sizeof(note));
    if (result == FACET_OK)
        result = texture_bench_finish(c.bench, error);
    if (result == FACET_OK) {
        drop_plan_carry_out(&c);
        scene->conversion = c.out;
        scene->materials = c.materials ? c.materials : scene->materials;
        scene->legacy = c.legacy ? c.legacy : scene->legacy;
    }
    texture_bench_destroy(c.bench);
    note_list_destroy(&c.notes);
    return result;
}
