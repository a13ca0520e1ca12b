/* parts.c - scenes of several parts: the place of each, and appending one scene to another. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/result.h"
#include "scene/legacy.h"
#include "scene/scene.h"

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

/* out becomes `to` with everything of `from` behind its own; both stay as they are until the end. */
typedef struct joining {
    const facet_scene *to, *from;
    facet_scene out;
    bool lacks_memory;
} joining;

/* Indices are below SCENE_NONE. */
static bool is_index(joining *j, size_t count)
{
    j->lacks_memory |= count >= SCENE_NONE;
    return count < SCENE_NONE;
}

static void *new_array(joining *j, size_t count, size_t size)
{
    void *array = arena_alloc(j->to->arena, count, size);
    j->lacks_memory |= !array;
    return array;
}

/* Both arrays in one. NULL: no memory. */
static void *both(joining *j, const void *a, uint32_t a_count, const void *b, uint32_t b_count, size_t size)
{
    unsigned char *array =
        is_index(j, (size_t)a_count + b_count) ? new_array(j, (size_t)a_count + b_count, size) : NULL;
    if (array && a_count)
        memcpy(array, a, a_count * size);
    if (array && b_count)
        memcpy(array + a_count * size, b, b_count * size);
    return array;
}

/* The space of an array; NULL: it has no other than its own. */
static scene_room *find_room(joining *j, const void *array)
{
    for (int i = 0; i < SCENE_ROOM_COUNT; i++)
        if (j->out.rooms[i].array == array)
            return &j->out.rooms[i];
    return NULL;
}

/* The same with space behind b from the third part on, so that the time and memory of appending one scene
 * after the other are linear. What is in that space belongs to no scene before the end; a itself stays. */
static void *extended(joining *j, const void *a, uint32_t a_count, const void *b, uint32_t b_count,
                      size_t size)
{
    size_t used = a_count * size, wanted = used + b_count * size;
    if (!is_index(j, (size_t)a_count + b_count))
        return NULL;
    scene_room *room = used ? find_room(j, a) : NULL;
    bool fits = room && wanted <= room->capacity;
    room = room ? room : find_room(j, NULL);
    size_t capacity = room && j->to->part_count > 1 ? 2 * wanted : wanted;
    unsigned char *array = fits ? (unsigned char *)(uintptr_t)a : new_array(j, capacity, 1);
    if (!array)
        return NULL;
    if (!fits && used)
        memcpy(array, a, used);
    if (!fits && room && wanted)
        *room = (scene_room){array, capacity};
    if (b_count)
        memcpy(array + used, b, b_count * size);
    return array;
}

/* Joins an array and its count, and runs the statement behind it for each appended index i. */
#define JOIN(j, array, count, i)                                                                             \
    (j)->out.array = extended(j, (j)->to->array, (j)->to->count, (j)->from->array, (j)->from->count,         \
                              sizeof *(j)->out.array);                                                       \
    (j)->out.count = (j)->to->count + (j)->from->count;                                                      \
    for (uint32_t i = (j)->to->count; !(j)->lacks_memory && i < (j)->out.count; i++)

static uint32_t shifted(uint32_t index, uint32_t by)
{
    return index == SCENE_NONE ? SCENE_NONE : index + by;
}

static const uint32_t *shifted_list(joining *j, const uint32_t *list, uint32_t count, uint32_t by)
{
    uint32_t *out = new_array(j, count, sizeof *out);
    for (uint32_t i = 0; out && i < count; i++)
        out[i] = shifted(list[i], by);
    return out;
}

static void join_textures(joining *j)
{
    JOIN(j, images, image_count, i)
    j->out.images[i].meta.extensions = NULL;
    JOIN(j, textures, texture_count, i)
    {
        scene_texture *t = &j->out.textures[i];
        t->image = shifted(t->image, j->to->image_count);
        t->meta.extensions = NULL;
    }
    JOIN(j, materials, material_count, i)
    {
        scene_material *m = &j->out.materials[i];
        for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
            m->textures[slot].texture = shifted(m->textures[slot].texture, j->to->texture_count);
        m->meta.extensions = NULL;
    }
    JOIN(j, image_lights, image_light_count, i)
    {
        scene_image_light *l = &j->out.image_lights[i];
        l->images = shifted_list(j, l->images, 6 * l->mip_count, j->to->image_count);
        l->meta.extensions = NULL;
    }
}

/* The index of a variant of `from` in out, by its name. */
static uint32_t find_variant(const joining *j, const char *name)
{
    uint32_t i = 0;
    while (i < j->out.variant_count && strcmp(j->out.variants[i], name) != 0)
        i++;
    return i;
}

static void join_variants(joining *j)
{
    j->out.variants = both(j, j->to->variants, j->to->variant_count, j->from->variants,
                           j->from->variant_count, sizeof *j->out.variants);
    for (uint32_t i = 0; !j->lacks_memory && i < j->from->variant_count; i++)
        if (find_variant(j, j->from->variants[i]) == j->out.variant_count)
            j->out.variants[j->out.variant_count++] = j->from->variants[i];
}

/* Re-indexes a primitive of `own`, one of the two scenes. */
static void join_primitive(joining *j, const facet_scene *own, scene_primitive *p)
{
    uint32_t by = own == j->from ? j->to->material_count : 0;
    p->material = shifted(p->material, by);
    if (own == j->from)
        p->meta.extensions = NULL;
    if (!p->variant_materials)
        return;
    uint32_t *list = new_array(j, j->out.variant_count, sizeof *list);
    for (uint32_t i = 0; list && i < j->out.variant_count; i++)
        list[i] = SCENE_NONE;
    for (uint32_t i = 0; list && i < own->variant_count; i++)
        list[find_variant(j, own->variants[i])] = shifted(p->variant_materials[i], by);
    p->variant_materials = list;
}

static void join_meshes(joining *j)
{
    join_variants(j);
    bool is_regrouped = j->out.variant_count != j->to->variant_count;
    scene_room *room = find_room(j, j->to->meshes);
    if (is_regrouped && room) /* all meshes are changed, so that they need another array */
        *room = (scene_room){0};
    JOIN(j, meshes, mesh_count, i)
    j->out.meshes[i].meta.extensions = NULL;
    for (uint32_t i = is_regrouped ? 0 : j->to->mesh_count; !j->lacks_memory && i < j->out.mesh_count; i++) {
        scene_mesh *mesh = &j->out.meshes[i];
        const facet_scene *own = i < j->to->mesh_count ? j->to : j->from;
        mesh->primitives =
            both(j, mesh->primitives, mesh->primitive_count, NULL, 0, sizeof *mesh->primitives);
        for (uint32_t k = 0; !j->lacks_memory && k < mesh->primitive_count; k++)
            join_primitive(j, own, &mesh->primitives[k]);
    }
}

static void join_nodes(joining *j)
{
    const uint32_t by = j->to->node_count;
    JOIN(j, cameras, camera_count, i)
    j->out.cameras[i].meta.extensions = NULL;
    JOIN(j, lights, light_count, i)
    j->out.lights[i].meta.extensions = NULL;
    JOIN(j, nodes, node_count, i)
    {
        scene_node *n = &j->out.nodes[i];
        n->parent = shifted(n->parent, by);
        n->children = shifted_list(j, n->children, n->child_count, by);
        n->mesh = shifted(n->mesh, j->to->mesh_count);
        n->camera = shifted(n->camera, j->to->camera_count);
        n->light = shifted(n->light, j->to->light_count);
        n->skin = shifted(n->skin, j->to->skin_count);
        n->meta.extensions = NULL;
    }
    JOIN(j, skins, skin_count, i)
    {
        scene_skin *s = &j->out.skins[i];
        s->joints = shifted_list(j, s->joints, s->joint_count, by);
        s->skeleton = shifted(s->skeleton, by);
        s->meta.extensions = NULL;
    }
}

/* A JSON pointer such as "/nodes/3/scale" with its first number shifted; NULL: no memory. */
static const char *shifted_pointer(joining *j, const char *pointer, uint32_t by)
{
    size_t before = strcspn(pointer, "0123456789");
    size_t digits = strspn(pointer + before, "0123456789"), size = strlen(pointer) + 12;
    unsigned long long number = 0;
    char *out = new_array(j, size, 1);
    if (sscanf(pointer + before, "%llu", &number) == 1 && out)
        snprintf(out, size, "%.*s%llu%s", (int)before, pointer, number + by, pointer + before + digits);
    else if (out)
        memcpy(out, pointer, strlen(pointer) + 1);
    return out;
}

static void join_animations(joining *j)
{
    const uint32_t shifts[] = {
        [SCENE_TARGET_NODE] = j->to->node_count,    [SCENE_TARGET_VISIBLE] = j->to->node_count,
        [SCENE_TARGET_WEIGHTS] = j->to->node_count, [SCENE_TARGET_MATERIAL] = j->to->material_count,
        [SCENE_TARGET_LIGHT] = j->to->light_count,  [SCENE_TARGET_CAMERA] = j->to->camera_count};
    JOIN(j, animations, animation_count, i)
    {
        scene_animation *a = &j->out.animations[i];
        scene_channel *channels = both(j, a->channels, a->channel_count, NULL, 0, sizeof *channels);
        for (uint32_t k = 0; !j->lacks_memory && k < a->channel_count; k++) {
            uint32_t by = shifts[channels[k].kind];
            channels[k].index += by;
            if (channels[k].pointer)
                channels[k].pointer = shifted_pointer(j, channels[k].pointer, by);
        }
        a->channels = channels;
        a->meta.extensions = NULL;
    }
}

/* The default scene of `from` becomes a part of that of `to`, which keeps its image-based light; the other
 * scenes of `from` follow. */
static void join_scenes(joining *j)
{
    uint32_t merged = j->to->scene_count + default_index(j->from);
    j->out.scenes = both(j, j->to->scenes, j->to->scene_count, j->from->scenes, j->from->scene_count,
                         sizeof *j->out.scenes);
    j->out.scene_count = j->to->scene_count + j->from->scene_count;
    for (uint32_t i = j->to->scene_count; !j->lacks_memory && i < j->out.scene_count; i++) {
        scene_root *s = &j->out.scenes[i];
        s->nodes = shifted_list(j, s->nodes, s->node_count, j->to->node_count);
        s->image_light = shifted(s->image_light, j->to->image_light_count);
        s->meta.extensions = NULL;
    }
    if (j->lacks_memory)
        return;
    scene_root *to = &j->out.scenes[default_index(j->to)], *from = &j->out.scenes[merged];
    to->nodes = extended(j, to->nodes, to->node_count, from->nodes, from->node_count, sizeof *to->nodes);
    to->node_count += from->node_count;
    if (to->image_light == SCENE_NONE)
        to->image_light = from->image_light;
    memmove(from, from + 1, (j->out.scene_count - merged - 1) * sizeof *from);
    j->out.scene_count--;
}

/* The files of the first parts, each once, and the index of each part's first items. */
static void join_parts(joining *j)
{
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
    char *text = new_array(j, size, 1);
    for (uint32_t i = 0, at = 0; text && i < count; i++)
        at += (uint32_t)snprintf(text + at, size - at, "%s%s", i ? ", " : "", i < NAMED ? names[i] : "...");
    j->out.source = text;
}

static void join_extensions(joining *j)
{
    j->out.extensions = both(j, j->to->extensions, j->to->extension_count, j->from->extensions,
                             j->from->extension_count, sizeof *j->out.extensions);
    for (uint32_t i = 0; !j->lacks_memory && i < j->from->extension_count; i++) {
        const scene_extension *e = &j->from->extensions[i];
        uint32_t k = 0;
        while (k < j->out.extension_count && strcmp(j->out.extensions[k].name, e->name) != 0)
            k++;
        scene_extension *same = &j->out.extensions[k];
        if (k == j->out.extension_count) {
            *same = *e;
            j->out.extension_count++;
            continue;
        }
        same->is_required |= e->is_required;
        same->is_present |= e->is_present;
        same->support = e->support > same->support ? e->support : same->support;
    }
}

/* Legacy materials of both, where they obey the same rules. */
static void join_legacy(joining *j)
{
    const scene_legacy *to = j->to->legacy, *from = j->from->legacy;
    bool are_alike = scene_has_legacy_materials(j->to) && scene_has_legacy_materials(j->from) &&
                     to->colors == from->colors && to->is_rgl == from->is_rgl;
    j->out.conversion = NULL;
    j->out.legacy = are_alike ? new_array(j, 1, sizeof *j->out.legacy) : NULL;
    if (!j->out.legacy)
        return;
    scene_legacy *out = j->out.legacy;
    *out = *to;
    out->is_source = true; /* of the parts, each of which has its own conversion */
    out->materials = extended(j, to->materials, j->to->material_count, from->materials,
                              j->from->material_count, sizeof *out->materials);
    out->lights =
        extended(j, to->lights, to->light_count, from->lights, from->light_count, sizeof *out->lights);
    out->light_count = to->light_count + from->light_count;
    if (out->fog.mode == LEGACY_FOG_NONE)
        out->fog = from->fog;
    for (uint32_t i = j->to->material_count; !j->lacks_memory && i < j->out.material_count; i++)
        for (int slot = 0; slot < LEGACY_MAP_COUNT; slot++) {
            uint32_t *texture = &out->materials[i].maps[slot].ref.texture;
            *texture = shifted(*texture, j->to->texture_count);
        }
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
    joining j = {.to = &to, .from = &from, .out = to};
    void (*const steps[])(joining *) = {join_textures,   join_meshes, join_nodes,  join_animations,
                                        join_extensions, join_legacy, join_scenes, join_parts};
    for (size_t i = 0; i < sizeof steps / sizeof *steps && !j.lacks_memory; i++)
        steps[i](&j);
    if (j.lacks_memory)
        return fail_memory(error, "a scene of two", (size_t)j.out.node_count * sizeof *scene->nodes);
    j.out.is_far |= other->is_far;
    j.out.content_revision++;
    *scene = j.out;
    scene_keep_scene(scene, other);
    return FACET_OK;
}
