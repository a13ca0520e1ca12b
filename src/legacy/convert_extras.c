/* convert_extras.c - what a file said, kept in the extras of what it became: "facet_legacy" of each glTF material and of
 * the scene, so that nothing is lost and the way back is exact. */
#include <string.h>

#include "base/result.h"
#include "legacy/convert_state.h"
#include "scene/legacy_extras.h"

/* extras with that member, in the arena; NULL: no memory. */
static const char *merged(const facet_scene *scene, const char *extras, const text *member)
{
    text all = {.allocator = scene->allocator};
    legacy_extras_merge(extras, member->data, &all);
    const char *kept =
        member->has_failed || all.has_failed ? NULL : arena_strdup(scene->arena, all.data ? all.data : "{}");
    text_destroy(&all);
    return kept;
}

facet_result convert_extras(conversion *c, facet_error *error)
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
