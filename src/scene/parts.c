/* parts.c - scenes of several parts: the place of each, and appending one scene to another. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/result.h"
#include "scene/joining.h"

/* ---- a part's place: a node above the roots of its default scene ---- */

static bool is_affine(const float m[16])
{
    for (int i = 0; i < 16; i++)
        if (!isfinite(m[i]))
            return false;
    return m[3] == 0.0f && m[7] == 0.0f && m[11] == 0.0f && m[15] == 1.0f;
}

static uint32_t default_index(const facet_scene *s)
{
    return s->default_scene == SCENE_NONE ? 0 : s->default_scene;
}

/* The roots of the default scene; a file without scenes shows all nodes without a parent. False: no
 * memory. */
static bool find_roots(facet_scene *s, scene_root *out)
{
    if (s->scene_count) {
        *out = s->scenes[default_index(s)];
        return true;
    }
    uint32_t *nodes = arena_alloc(s->arena, (size_t)s->node_count + 1, sizeof *nodes);
    if (!nodes)
        return false;
    *out = (scene_root){.name = "", .nodes = nodes, .image_light = SCENE_NONE};
    for (uint32_t i = 0; i < s->node_count; i++)
        if (s->nodes[i].parent == SCENE_NONE)
            nodes[out->node_count++] = i;
    return true;
}

/* A matrix of the part's world, relative to its origin before it had a place. */
static void set_place(facet_scene *s, uint32_t part, const dmat4 *place)
{
    const double *origin = s->parts[part].origin;
    const double back[3] = {-origin[0], -origin[1], -origin[2]};
    dmat4 to_world = dmat4_translation(back);
    s->nodes[s->parts[part].node].matrix = dmat4_multiply(place, &to_world);
    s->place_revision++;
}

/* Makes all of the scene its part 0, where it is. Arrays are replaced, not changed. */
static facet_result make_part(facet_scene *s, facet_error *error)
{
    scene_root roots;
    bool fits = find_roots(s, &roots);
    scene_node *nodes = arena_alloc(s->arena, (size_t)s->node_count + 1, sizeof *nodes);
    scene_root *scenes = arena_alloc(s->arena, (size_t)s->scene_count + 1, sizeof *scenes);
    uint32_t *list = arena_alloc(s->arena, 1, sizeof *list);
    scene_part *part = arena_alloc(s->arena, 1, sizeof *part);
    if (!fits || !nodes || !scenes || !list || !part)
        return fail_memory(error, "a place for a model", ((size_t)s->node_count + 1) * sizeof *nodes);
    uint32_t own = s->node_count, index = default_index(s);
    if (own)
        memcpy(nodes, s->nodes, own * sizeof *nodes);
    if (s->scene_count)
        memcpy(scenes, s->scenes, s->scene_count * sizeof *scenes);
    for (uint32_t i = 0; i < roots.node_count; i++)
        nodes[roots.nodes[i]].parent = own;
    nodes[own] = scene_node_default("place");
    nodes[own].child_count = roots.node_count;
    nodes[own].children = roots.nodes;
    nodes[own].has_matrix = true;
    *list = own;
    scenes[index] = roots;
    scenes[index].nodes = list;
    scenes[index].node_count = 1;
    s->nodes = nodes;
    s->node_count++;
    s->scenes = scenes;
    s->scene_count += s->scene_count == 0;
    *part = (scene_part){.node = own, .source = s->source};
    memcpy(part->origin, s->origin, sizeof part->origin);
    s->parts = part;
    s->part_count = 1;
    memset(s->origin, 0, sizeof s->origin);
    const dmat4 identity = dmat4_identity();
    set_place(s, 0, &identity);
    return FACET_OK;
}

static facet_result check_is_free(const facet_scene *scene, facet_error *error)
{
    return scene->is_appended ? fail(error, FACET_ERROR_ARGUMENT,
                                     "%s: belongs to another scene, to which it was appended", scene->source)
                              : FACET_OK;
}

facet_result scene_place(facet_scene *scene, uint32_t part, const float matrix[16], facet_error *error)
{
    TRY(check_is_free(scene, error));
    if (!is_affine(matrix))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: a matrix whose last row is 0 0 0 1 was expected",
                    scene->source);
    if (part >= (scene->part_count ? scene->part_count : 1))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: there is no part %u; it has %u", scene->source, part,
                    scene->part_count ? scene->part_count : 1);
    if (!scene->part_count)
        TRY(make_part(scene, error));
    dmat4 place;
    for (int i = 0; i < 16; i++)
        place.m[i] = (double)matrix[i];
    set_place(scene, part, &place);
    return FACET_OK;
}

scene_address scene_get_address(const facet_scene *scene, scene_item item, uint32_t index)
{
    uint32_t i = scene->part_count;
    while (i > 0 && scene->parts[i - 1].first[item] > index)
        i--;
    if (i == 0)
        return (scene_address){scene->source, index};
    const scene_part *part = &scene->parts[i - 1];
    return (scene_address){part->source, index - part->first[item]};
}

/* ---- appending ---- */

/* The default scene of `from` becomes a part of that of `to`, which keeps its image-based light; the other
 * scenes of `from` follow. */
static void join_scenes(joining *j)
{
    uint32_t merged = j->to->scene_count + default_index(j->from);
    j->out.scenes = joining_both(j, j->to->scenes, j->to->scene_count, j->from->scenes, j->from->scene_count,
                                 sizeof *j->out.scenes);
    j->out.scene_count = j->to->scene_count + j->from->scene_count;
    for (uint32_t i = j->to->scene_count; !j->lacks_memory && i < j->out.scene_count; i++) {
        scene_root *s = &j->out.scenes[i];
        s->nodes = joining_list(j, s->nodes, s->node_count, j->to->node_count);
        s->image_light = joining_shifted(s->image_light, j->to->image_light_count);
        s->meta.extensions = NULL;
    }
    if (j->lacks_memory)
        return;
    scene_root *to = &j->out.scenes[default_index(j->to)], *from = &j->out.scenes[merged];
    to->nodes =
        joining_extended(j, to->nodes, to->node_count, from->nodes, from->node_count, sizeof *to->nodes);
    to->node_count += from->node_count;
    if (to->image_light == SCENE_NONE)
        to->image_light = from->image_light;
    memmove(from, from + 1, (j->out.scene_count - merged - 1) * sizeof *from);
    j->out.scene_count--;
}

/* The files of the first parts, each once, and the index of each part's first items. */
static void join_parts(joining *j)
{
    JOIN(j, externals, external_count, i)
    j->out.externals[i].node += j->to->node_count;
    JOIN(j, parts, part_count, i)
    {
        scene_part *part = &j->out.parts[i];
        part->node += j->to->node_count;
        part->first[SCENE_ITEM_IMAGE] += j->to->image_count;
        part->first[SCENE_ITEM_MATERIAL] += j->to->material_count;
        part->first[SCENE_ITEM_IMAGE_LIGHT] += j->to->image_light_count;
    }
    enum { NAMED = 3 };
    const char *names[NAMED + 1];
    uint32_t count = 0;
    size_t size = sizeof ", ...";
    for (uint32_t i = 0; !j->lacks_memory && i < j->out.part_count && count <= NAMED; i++) {
        const char *source = j->out.parts[i].source;
        uint32_t k = 0;
        while (k < count && strcmp(names[k], source) != 0)
            k++;
        if (k == count) {
            names[count++] = source;
            size += strlen(source) + 2;
        }
    }
    char *text = joining_array(j, size, 1);
    for (uint32_t i = 0, at = 0; text && i < count; i++)
        at += (uint32_t)snprintf(text + at, size - at, "%s%s", i ? ", " : "", i < NAMED ? names[i] : "...");
    j->out.source = text;
}

facet_result scene_append(facet_scene *scene, facet_scene *other, facet_error *error)
{
    if (scene == other)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: a scene cannot be appended to itself", scene->source);
    TRY(check_is_free(scene, error));
    TRY(check_is_free(other, error));
    facet_scene to = *scene, from = *other; /* both stay as they are where memory is lacking */
    if (!to.part_count)
        TRY(make_part(&to, error));
    if (!from.part_count)
        TRY(make_part(&from, error));
    joining j = joining_begin(&to, &from);
    joining_run(&j);
    void (*const steps[])(joining *) = {join_scenes, join_parts};
    for (size_t i = 0; i < sizeof steps / sizeof *steps && !j.lacks_memory; i++)
        steps[i](&j);
    if (j.lacks_memory)
        return fail_memory(error, "a scene of two", (size_t)j.out.node_count * sizeof *scene->nodes);
    *scene = j.out;
    scene_keep_scene(scene, other);
    return FACET_OK;
}
