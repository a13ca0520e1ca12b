/* attach.c - see attach.h. */
#include "scene/attach.h"

#include <string.h>

#include "base/result.h"
#include "scene/joining.h"

/* Whether an animation changes materials, which copies then cannot share. */
static bool animates_materials(const facet_scene *scene)
{
    for (uint32_t i = 0; i < scene->animation_count; i++)
        for (uint32_t k = 0; k < scene->animations[i].channel_count; k++)
            if (scene->animations[i].channels[k].kind == SCENE_TARGET_MATERIAL)
                return true;
    return false;
}

static const char *prefixed(joining *j, const char *prefix, const char *name)
{
    const size_t before = strlen(prefix), after = strlen(name);
    char *out = joining_array(j, before + after + 2, 1);
    if (!out)
        return name;
    memcpy(out, prefix, before);
    out[before] = '/';
    memcpy(out + before + 1, name, after + 1);
    return out;
}

/* Prefixes the names of appended elements that have one. */
#define PREFIX(j, prefix, array, count)                                                                      \
    for (uint32_t i = (j)->to->count; !(j)->lacks_memory && i < (j)->out.count; i++)                         \
        if ((j)->out.array[i].name[0])                                                                       \
    (j)->out.array[i].name = prefixed(j, prefix, (j)->out.array[i].name)

static void prefix_names(joining *j, const char *prefix)
{
    if (!prefix[0])
        return;
    PREFIX(j, prefix, nodes, node_count);
    PREFIX(j, prefix, cameras, camera_count);
    PREFIX(j, prefix, lights, light_count);
    PREFIX(j, prefix, skins, skin_count);
    PREFIX(j, prefix, animations, animation_count);
}

/* The asset itself, then those in it. */
static void join_externals(joining *j, const scene_external *external)
{
    const facet_scene *from = j->from;
    scene_external *list = joining_array(j, (size_t)from->external_count + 1, sizeof *list);
    if (!list)
        return;
    list[0] = *external;
    list[0].node_count = from->node_count;
    for (uint32_t i = 0; i < from->external_count; i++) {
        list[i + 1] = from->externals[i];
        list[i + 1].node += j->to->node_count;
        list[i + 1].depth++;
        list[i + 1].name = prefixed(j, external->name, list[i + 1].name);
    }
    j->out.externals = joining_extended(j, j->to->externals, j->to->external_count, list,
                                        from->external_count + 1, sizeof *list);
    j->out.external_count = j->to->external_count + from->external_count + 1;
}

facet_result scene_attach(facet_scene *to, const facet_scene *from, const scene_external *external,
                          scene_attachment *attachment, facet_error *error)
{
    joining j = joining_begin(to, from);
    const uint32_t node = external->node, by = to->node_count, own = to->nodes[node].child_count;
    const scene_root none = {0}, *roots = from->scene_count && from->default_scene != SCENE_NONE
                                              ? &from->scenes[from->default_scene]
                                              : &none;
    j.grows = true;
    if (attachment->is_there && !animates_materials(from)) {
        j.shares = true;
        j.shift.image = attachment->first_image;
        j.shift.texture = attachment->first_texture;
        j.shift.material = attachment->first_material;
        j.shift.mesh = attachment->first_mesh;
    }
    joining_run(&j);
    prefix_names(&j, external->name);
    join_externals(&j, external);
    uint32_t *children =
        joining_both(&j, to->nodes[node].children, own, roots->nodes, roots->node_count, sizeof *children);
    if (j.lacks_memory)
        return fail_memory(error, "an external asset", (size_t)j.out.node_count * sizeof *to->nodes);
    for (uint32_t i = 0; i < roots->node_count; i++) {
        children[own + i] += by;
        j.out.nodes[by + roots->nodes[i]].parent = node;
    }
    j.out.nodes[node].children = children;
    j.out.nodes[node].child_count = own + roots->node_count;
    *attachment = (scene_attachment){true, j.shift.image, j.shift.texture, j.shift.material, j.shift.mesh};
    for (uint32_t i = to->animation_count; i < j.out.animation_count; i++)
        j.out.animations[i].is_external = true;
    *to = j.out;
    return FACET_OK;
}
