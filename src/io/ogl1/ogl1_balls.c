/* ogl1_balls.c - a scene to look at parameters: one ball per material, in a grid as wide as a picture. */
#include <math.h>
#include <stdio.h>

#include "io/ogl1/ogl1_reader.h"
#include "scene/sphere.h"

enum { SEGMENTS = 64, RINGS = 32 };
static const float SPACING = 2.5f; /* m, of balls of radius 1 */

/* The entry's name, else that of its first object, else a number. */
static const char *name_of(io_reader *r, const ogl1_entry *entry, uint32_t number)
{
    char name[32];
    if (entry->name)
        return entry->name;
    if (entry->object_count)
        return entry->objects[0];
    snprintf(name, sizeof name, "material %u", number + 1);
    const char *copy = arena_strdup(r->scene->arena, name);
    if (!copy)
        io_fail_memory(r, "name", sizeof name);
    return copy ? copy : "";
}

/* Mesh and node number i, at its place in the grid: rows from the top, filled from the left. */
static void place(io_reader *r, const scene_primitive *sphere, uint32_t i, uint32_t columns, uint32_t rows)
{
    facet_scene *scene = r->scene;
    scene_primitive *own = io_alloc(r, "primitive", 1, sizeof *own);
    if (!own)
        return;
    *own = *sphere;
    own->material = i;
    const char *name = scene->materials[i].name;
    scene->meshes[i] = (scene_mesh){.name = name, .primitive_count = 1, .primitives = own};
    scene->nodes[i] = (scene_node){
        .name = name,
        .parent = SCENE_NONE,
        .translation = {(double)(SPACING * ((float)(i % columns) - 0.5f * (float)(columns - 1))),
                        (double)(SPACING * (0.5f * (float)(rows - 1) - (float)(i / columns))), 0.0},
        .rotation = {0, 0, 0, 1},
        .scale = {1, 1, 1},
        .mesh = i,
        .camera = SCENE_NONE,
        .light = SCENE_NONE,
        .skin = SCENE_NONE,
    };
}

static void make_materials(ogl1_document *d)
{
    facet_scene *scene = d->r.scene;
    for (uint32_t i = 0; i < d->entry_count && io_is_ok(&d->r); i++) {
        scene->materials[i] = scene_material_default();
        scene->legacy->materials[i] = d->entries[i].material;
        scene->materials[i].name = scene->legacy->materials[i].name = name_of(&d->r, &d->entries[i], i);
    }
}

void ogl1_make_balls(ogl1_document *d)
{
    io_reader *r = &d->r;
    facet_scene *scene = r->scene;
    uint32_t count = d->entry_count;
    uint32_t columns = (uint32_t)ceil(sqrt((double)count * 4.0 / 3.0)); /* as wide as most pictures are */
    uint32_t rows = (count + columns - 1) / columns;
    scene_primitive sphere;
    scene->materials = io_alloc(r, "materials", count, sizeof *scene->materials);
    scene->meshes = io_alloc(r, "meshes", count, sizeof *scene->meshes);
    scene->nodes = io_alloc(r, "nodes", count, sizeof *scene->nodes);
    scene->scenes = io_alloc(r, "scenes", 1, sizeof *scene->scenes);
    scene->legacy = io_alloc(r, "materials", 1, sizeof *scene->legacy);
    legacy_material *materials = io_alloc(r, "materials", count, sizeof *materials);
    uint32_t *roots = io_alloc(r, "nodes", count, sizeof *roots);
    if (!io_is_ok(r))
        return;
    if (!scene_make_sphere(scene->arena, SEGMENTS, RINGS, &sphere)) {
        io_fail_memory(r, "sphere", 0);
        return;
    }
    scene->legacy->materials = materials;
    scene->legacy->is_rgl = true;
    make_materials(d);
    for (uint32_t i = 0; i < count && io_is_ok(r); i++) {
        place(r, &sphere, i, columns, rows);
        roots[i] = i;
    }
    scene->scenes[0] =
        (scene_root){.name = "materials", .node_count = count, .nodes = roots, .image_light = SCENE_NONE};
    scene->scene_count = 1;
    scene->default_scene = 0;
    scene->material_count = scene->mesh_count = scene->node_count = count;
}
