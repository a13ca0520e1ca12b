/* joining.c - everything of one scene behind that of another, with its indices: for scenes of several parts (parts.c)
 * and assets that a file refers to (attach.c). */
#include "scene/joining.h"

#include <stdio.h>
#include <string.h>

#include "scene/legacy.h"

/* Indices are below SCENE_NONE. */
static bool is_index(joining *j, size_t count)
{
    j->lacks_memory |= count >= SCENE_NONE;
    return count < SCENE_NONE;
}

void *joining_array(joining *j, size_t count, size_t size)
{
    void *array = arena_alloc(j->to->arena, count, size);
    j->lacks_memory |= !array;
    return array;
}

void *joining_both(joining *j, const void *a, uint32_t a_count, const void *b, uint32_t b_count, size_t size)
{
    unsigned char *array =
        is_index(j, (size_t)a_count + b_count) ? joining_array(j, (size_t)a_count + b_count, size) : NULL;
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

void *joining_extended(joining *j, const void *a, uint32_t a_count, const void *b, uint32_t b_count,
                       size_t size)
{
    size_t used = a_count * size, wanted = used + b_count * size;
    if (!is_index(j, (size_t)a_count + b_count))
        return NULL;
    scene_room *room = used ? find_room(j, a) : NULL;
    bool fits = room && wanted <= room->capacity;
    room = room ? room : find_room(j, NULL);
    size_t capacity = room && (j->grows || j->to->part_count > 1) ? 2 * wanted : wanted;
    unsigned char *array = fits ? (unsigned char *)(uintptr_t)a : joining_array(j, capacity, 1);
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

uint32_t joining_shifted(uint32_t index, uint32_t by)
{
    return index == SCENE_NONE ? SCENE_NONE : index + by;
}

const uint32_t *joining_list(joining *j, const uint32_t *list, uint32_t count, uint32_t by)
{
    uint32_t *out = joining_array(j, count, sizeof *out);
    for (uint32_t i = 0; out && i < count; i++)
        out[i] = joining_shifted(list[i], by);
    return out;
}

static void join_textures(joining *j)
{
    if (j->shares)
        return;
    JOIN(j, images, image_count, i)
    j->out.images[i].meta.extensions = NULL;
    JOIN(j, textures, texture_count, i)
    {
        scene_texture *t = &j->out.textures[i];
        t->image = joining_shifted(t->image, j->shift.image);
        t->meta.extensions = NULL;
    }
    JOIN(j, materials, material_count, i)
    {
        scene_material *m = &j->out.materials[i];
        for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
            m->textures[slot].texture = joining_shifted(m->textures[slot].texture, j->shift.texture);
        m->meta.extensions = NULL;
    }
    JOIN(j, image_lights, image_light_count, i)
    {
        scene_image_light *l = &j->out.image_lights[i];
        l->images = joining_list(j, l->images, 6 * l->mip_count, j->shift.image);
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
    j->out.variants = joining_both(j, j->to->variants, j->to->variant_count, j->from->variants,
                                   j->from->variant_count, sizeof *j->out.variants);
    for (uint32_t i = 0; !j->lacks_memory && i < j->from->variant_count; i++)
        if (find_variant(j, j->from->variants[i]) == j->out.variant_count)
            j->out.variants[j->out.variant_count++] = j->from->variants[i];
}

/* Re-indexes a primitive of `own`, one of the two scenes. */
static void join_primitive(joining *j, const facet_scene *own, scene_primitive *p)
{
    uint32_t by = own == j->from ? j->shift.material : 0;
    p->material = joining_shifted(p->material, by);
    if (own == j->from)
        p->meta.extensions = NULL;
    if (!p->variant_materials)
        return;
    uint32_t *list = joining_array(j, j->out.variant_count, sizeof *list);
    for (uint32_t i = 0; list && i < j->out.variant_count; i++)
        list[i] = SCENE_NONE;
    for (uint32_t i = 0; list && i < own->variant_count; i++)
        list[find_variant(j, own->variants[i])] = joining_shifted(p->variant_materials[i], by);
    p->variant_materials = list;
}

static void join_meshes(joining *j)
{
    if (j->shares)
        return;
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
            joining_both(j, mesh->primitives, mesh->primitive_count, NULL, 0, sizeof *mesh->primitives);
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
        n->parent = joining_shifted(n->parent, by);
        n->children = joining_list(j, n->children, n->child_count, by);
        n->mesh = joining_shifted(n->mesh, j->shift.mesh);
        n->camera = joining_shifted(n->camera, j->to->camera_count);
        n->light = joining_shifted(n->light, j->to->light_count);
        n->skin = joining_shifted(n->skin, j->to->skin_count);
        n->meta.extensions = NULL;
    }
    JOIN(j, skins, skin_count, i)
    {
        scene_skin *s = &j->out.skins[i];
        s->joints = joining_list(j, s->joints, s->joint_count, by);
        s->skeleton = joining_shifted(s->skeleton, by);
        s->meta.extensions = NULL;
    }
}

/* A JSON pointer such as "/nodes/3/scale" with its first number shifted; NULL: no memory. */
static const char *shifted_pointer(joining *j, const char *pointer, uint32_t by)
{
    size_t before = strcspn(pointer, "0123456789");
    size_t digits = strspn(pointer + before, "0123456789"), size = strlen(pointer) + 12;
    unsigned long long number = 0;
    char *out = joining_array(j, size, 1);
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
        [SCENE_TARGET_WEIGHTS] = j->to->node_count, [SCENE_TARGET_MATERIAL] = j->shift.material,
        [SCENE_TARGET_LIGHT] = j->to->light_count,  [SCENE_TARGET_CAMERA] = j->to->camera_count};
    JOIN(j, animations, animation_count, i)
    {
        scene_animation *a = &j->out.animations[i];
        scene_channel *channels = joining_both(j, a->channels, a->channel_count, NULL, 0, sizeof *channels);
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

static void join_extensions(joining *j)
{
    j->out.extensions = joining_both(j, j->to->extensions, j->to->extension_count, j->from->extensions,
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
    if (j->shares)
        return;
    bool are_alike = scene_has_legacy_materials(j->to) && scene_has_legacy_materials(j->from) &&
                     to->colors == from->colors && to->is_rgl == from->is_rgl;
    j->out.conversion = NULL;
    j->out.legacy = are_alike ? joining_array(j, 1, sizeof *j->out.legacy) : NULL;
    if (!j->out.legacy)
        return;
    scene_legacy *out = j->out.legacy;
    *out = *to;
    out->is_source = true; /* of the parts, each of which has its own conversion */
    out->materials = joining_extended(j, to->materials, j->to->material_count, from->materials,
                                      j->from->material_count, sizeof *out->materials);
    out->lights = joining_extended(j, to->lights, to->light_count, from->lights, from->light_count,
                                   sizeof *out->lights);
    out->light_count = to->light_count + from->light_count;
    if (out->fog.mode == LEGACY_FOG_NONE)
        out->fog = from->fog;
    for (uint32_t i = j->to->material_count; !j->lacks_memory && i < j->out.material_count; i++)
        for (int slot = 0; slot < LEGACY_MAP_COUNT; slot++) {
            uint32_t *texture = &out->materials[i].maps[slot].ref.texture;
            *texture = joining_shifted(*texture, j->to->texture_count);
        }
}

joining joining_begin(const facet_scene *to, const facet_scene *from)
{
    return (joining){.to = to,
                     .from = from,
                     .out = *to,
                     .shift = {.image = to->image_count,
                               .texture = to->texture_count,
                               .material = to->material_count,
                               .mesh = to->mesh_count}};
}

void joining_run(joining *j)
{
    void (*const steps[])(joining *) = {join_textures,   join_meshes,     join_nodes,
                                        join_animations, join_extensions, join_legacy};
    for (size_t i = 0; i < sizeof steps / sizeof *steps && !j->lacks_memory; i++)
        steps[i](j);
    j->out.is_far |= j->from->is_far;
    j->out.content_revision++;
}
