/* ogl1_overlay.c - applies a document of parameters to a scene. Objects take precedence over names of
 * materials, and names over entries for everything; among equals the last is used. */
#include <stdlib.h>
#include <string.h>

#include "base/result.h"
#include "io/file_source.h"
#include "io/ogl1/ogl1_json.h"
#include "io/ogl1/ogl1_reader.h"

/* ---- names of entries ---- */

typedef struct entry_name {
    const char *name;
    uint32_t entry;
    bool is_used; /* was found in the scene */
} entry_name;

typedef struct entry_names {
    size_t count;
    entry_name *names; /* sorted and unique, each with the last entry that has it */
} entry_names;

static int compare(const void *a, const void *b)
{
    const entry_name *x = a;
    const entry_name *y = b;
    int order = strcmp(x->name, y->name);
    return order ? order : (x->entry > y->entry) - (x->entry < y->entry);
}

/* Keeps the last one of each name in a sorted list. */
static void keep_last(ogl1_document *d, bool of_objects, entry_names *n)
{
    size_t kept = 0;
    for (size_t i = 0; i < n->count; i++) {
        bool is_last = i + 1 == n->count || strcmp(n->names[i].name, n->names[i + 1].name) != 0;
        if (is_last)
            n->names[kept++] = n->names[i];
        else if (n->names[i].entry != n->names[i + 1].entry)
            io_warn(&d->r, NULL, NULL, "%s \"%.200s\" is listed more than once; the last entry is used",
                    of_objects ? "object" : "material", n->names[i].name);
    }
    n->count = kept;
}

static bool names_create(ogl1_document *d, bool of_objects, entry_names *out)
{
    size_t count = 0;
    for (uint32_t i = 0; i < d->entry_count; i++)
        count += of_objects ? d->entries[i].object_count : d->entries[i].name != NULL;
    *out = (entry_names){.names = mem_alloc(d->r.allocator, count, sizeof *out->names)};
    if (!out->names)
        return false;
    for (uint32_t i = 0; i < d->entry_count; i++) {
        const ogl1_entry *entry = &d->entries[i];
        for (uint32_t k = 0; of_objects && k < entry->object_count; k++)
            out->names[out->count++] = (entry_name){.name = entry->objects[k], .entry = i};
        if (!of_objects && entry->name)
            out->names[out->count++] = (entry_name){.name = entry->name, .entry = i};
    }
    qsort(out->names, out->count, sizeof *out->names, compare);
    keep_last(d, of_objects, out);
    return true;
}

/* The names of the materials, or of the objects, of all entries. Reports those of several entries. False:
 * no memory. */
static void names_destroy(entry_names *n)
{
    mem_free(n->names);
    *n = (entry_names){0};
}

/* The entry of a name; SCENE_NONE: none. */
static uint32_t names_find(entry_names *n, const char *name)
{
    size_t begin = 0;
    size_t end = n->count;
    while (begin < end) {
        size_t middle = begin + (end - begin) / 2;
        int order = strcmp(n->names[middle].name, name);
        if (order == 0) {
            n->names[middle].is_used = true;
            return n->names[middle].entry;
        }
        if (order < 0)
            begin = middle + 1;
        else
            end = middle;
    }
    return SCENE_NONE;
}

/* A node with a mesh, and the entry of its objects. */
typedef struct use {
    uint32_t node, mesh;
    uint32_t entry; /* 0: none; otherwise its number plus 1, so that none sorts first */
} use;

typedef struct overlay {
    ogl1_document d;
    entry_names materials, objects;
    uint32_t all;             /* the entry for everything; SCENE_NONE: none */
    bool *is_set;             /* per material: replaced by an entry */
    uint32_t *material_of;    /* per entry: its material in the scene; SCENE_NONE: none yet */
    bool *is_used, *is_named; /* per entry */
    uint32_t *node_entries;   /* per node: as in use; UINT32_MAX: unknown yet */
    uint32_t *path;           /* node_count, for find_entry() */
    size_t use_count;
    use *uses;
} overlay;

static bool take_memory(overlay *o)
{
    const facet_scene *scene = o->d.r.scene;
    const facet_allocator *allocator = o->d.r.allocator;
    o->is_set = mem_zalloc(allocator, (size_t)scene->material_count + o->d.entry_count, sizeof *o->is_set);
    o->material_of = mem_alloc(allocator, o->d.entry_count, sizeof *o->material_of);
    o->is_used = mem_zalloc(allocator, o->d.entry_count, sizeof *o->is_used);
    o->is_named = mem_zalloc(allocator, o->d.entry_count, sizeof *o->is_named);
    o->node_entries = mem_alloc(allocator, scene->node_count, sizeof *o->node_entries);
    o->path = mem_alloc(allocator, scene->node_count, sizeof *o->path);
    o->uses = mem_alloc(allocator, scene->node_count, sizeof *o->uses);
    if (!o->is_set || !o->material_of || !o->is_used || !o->is_named || !o->node_entries || !o->path ||
        !o->uses || !names_create(&o->d, false, &o->materials) || !names_create(&o->d, true, &o->objects))
        return io_fail_memory(&o->d.r, "parameters", scene->node_count * sizeof *o->uses);
    memset(o->material_of, 0xff, o->d.entry_count * sizeof *o->material_of);
    memset(o->node_entries, 0xff, scene->node_count * sizeof *o->node_entries);
    o->all = SCENE_NONE;
    for (uint32_t i = 0; i < o->d.entry_count; i++)
        if (!o->d.entries[i].name && !o->d.entries[i].object_count)
            o->all = i;
    return true;
}

static void release(overlay *o)
{
    names_destroy(&o->materials);
    names_destroy(&o->objects);
    mem_free(o->is_set);
    mem_free(o->material_of);
    mem_free(o->is_used);
    mem_free(o->is_named);
    mem_free(o->node_entries);
    mem_free(o->path);
    mem_free(o->uses);
}

/* ---- materials ---- */

/* Grows the material arrays of both models. A glTF scene gets legacy materials; those that no entry
 * replaces stay glTF's. */
static void make_room(overlay *o)
{
    io_reader *r = &o->d.r;
    facet_scene *scene = r->scene;
    size_t count = (size_t)scene->material_count + o->d.entry_count + 1;
    scene_material *materials = io_alloc(r, "materials", count, sizeof *materials);
    legacy_material *legacy = io_alloc(r, "materials", count, sizeof *legacy);
    scene_legacy *all = scene->legacy ? scene->legacy : io_alloc(r, "materials", 1, sizeof *all);
    if (!io_is_ok(r))
        return;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        materials[i] = scene->materials[i];
        legacy[i] = scene->legacy ? scene->legacy->materials[i] : legacy_material_default();
        if (!scene->legacy) {
            legacy[i].name = materials[i].name;
            legacy[i].is_gltf_restored = true;
        }
    }
    if (!scene->legacy)
        all->fog.scale = 1.0f;
    all->materials = legacy;
    scene->materials = materials;
    scene->legacy = all;
}

static void set_material(overlay *o, uint32_t material, uint32_t entry)
{
    facet_scene *scene = o->d.r.scene;
    const char *name = scene->materials[material].name;
    scene_material plain = scene_material_default();
    plain.name = name;
    plain.meta = scene->materials[material].meta;
    scene->materials[material] = plain;
    scene->legacy->materials[material] = o->d.entries[entry].material;
    scene->legacy->materials[material].name = name;
    o->is_set[material] = o->is_used[entry] = true;
}

static uint32_t add_material(overlay *o, uint32_t entry, const char *name)
{
    facet_scene *scene = o->d.r.scene;
    uint32_t number = scene->material_count++;
    scene->materials[number] = (scene_material){.name = name};
    set_material(o, number, entry);
    return number;
}

static void replace_materials(overlay *o)
{
    facet_scene *scene = o->d.r.scene;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        uint32_t named = names_find(&o->materials, scene->materials[i].name);
        uint32_t entry = named != SCENE_NONE ? named : o->all;
        if (entry != SCENE_NONE)
            set_material(o, i, entry);
        if (named == SCENE_NONE)
            continue;
        o->is_named[named] = true;
        o->material_of[named] = o->material_of[named] == SCENE_NONE ? i : o->material_of[named];
    }
}

/* The material of an entry, for the objects that it names. */
static uint32_t material_of(overlay *o, uint32_t entry)
{
    const ogl1_entry *e = &o->d.entries[entry];
    if (o->material_of[entry] == SCENE_NONE)
        o->material_of[entry] = add_material(o, entry,
                                             e->name           ? e->name
                                             : e->object_count ? e->objects[0]
                                                               : "material3d");
    return o->material_of[entry];
}

/* ---- objects ---- */

/* The entry of a node: of its own name, its mesh's, or that of the nearest ancestor with one. */
static uint32_t find_entry(overlay *o, uint32_t node)
{
    const facet_scene *scene = o->d.r.scene;
    uint32_t length = 0;
    uint32_t entry = 0;
    for (; node != SCENE_NONE && length < scene->node_count; node = scene->nodes[node].parent) {
        if (o->node_entries[node] != UINT32_MAX) {
            entry = o->node_entries[node];
            break;
        }
        o->path[length++] = node;
    }
    while (length-- > 0) {
        const scene_node *n = &scene->nodes[o->path[length]];
        uint32_t own = names_find(&o->objects, n->name);
        uint32_t meshes =
            n->mesh != SCENE_NONE ? names_find(&o->objects, scene->meshes[n->mesh].name) : SCENE_NONE;
        own = own != SCENE_NONE ? own : meshes;
        entry = own != SCENE_NONE ? own + 1 : entry;
        o->node_entries[o->path[length]] = entry;
    }
    return entry;
}

static int compare_uses(const void *a, const void *b)
{
    const use *x = a;
    const use *y = b;
    if (x->mesh != y->mesh)
        return x->mesh < y->mesh ? -1 : 1;
    if (x->entry != y->entry)
        return x->entry < y->entry ? -1 : 1;
    return (x->node > y->node) - (x->node < y->node);
}

static void find_uses(overlay *o)
{
    const facet_scene *scene = o->d.r.scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        uint32_t entry = find_entry(o, i); /* also nodes without a mesh, whose names count as used */
        if (scene->nodes[i].mesh != SCENE_NONE)
            o->uses[o->use_count++] = (use){.node = i, .mesh = scene->nodes[i].mesh, .entry = entry};
    }
    qsort(o->uses, o->use_count, sizeof *o->uses, compare_uses);
}

static bool begins_group(const overlay *o, size_t i)
{
    return i == 0 || o->uses[i].mesh != o->uses[i - 1].mesh || o->uses[i].entry != o->uses[i - 1].entry;
}

static bool begins_mesh(const overlay *o, size_t i)
{
    return i == 0 || o->uses[i].mesh != o->uses[i - 1].mesh;
}

/* Allocates copies of meshes that several entries share, or an entry and none. */
static void make_mesh_room(overlay *o)
{
    facet_scene *scene = o->d.r.scene;
    size_t count = scene->mesh_count;
    for (size_t i = 0; i < o->use_count; i++)
        count += begins_group(o, i) && !begins_mesh(o, i);
    if (count == scene->mesh_count)
        return;
    scene_mesh *meshes = io_alloc(&o->d.r, "meshes", count, sizeof *meshes);
    if (!meshes)
        return;
    memcpy(meshes, scene->meshes, scene->mesh_count * sizeof *meshes);
    scene->meshes = meshes;
}

static uint32_t copy_mesh(overlay *o, uint32_t mesh)
{
    facet_scene *scene = o->d.r.scene;
    const scene_mesh *from = &scene->meshes[mesh];
    scene_primitive *primitives =
        io_alloc_raw(&o->d.r, "primitives", from->primitive_count, sizeof *primitives);
    if (!primitives)
        return mesh;
    memcpy(primitives, from->primitives, from->primitive_count * sizeof *primitives);
    scene->meshes[scene->mesh_count] = *from;
    scene->meshes[scene->mesh_count].primitives = primitives;
    return scene->mesh_count++;
}

/* The first group of a mesh keeps it, preferably the one without an entry; the others get copies. */
static void assign_objects(overlay *o)
{
    facet_scene *scene = o->d.r.scene;
    uint32_t mesh = SCENE_NONE;
    for (size_t i = 0; i < o->use_count && io_is_ok(&o->d.r); i++) {
        const use *u = &o->uses[i];
        if (begins_group(o, i)) {
            mesh = begins_mesh(o, i) ? u->mesh : copy_mesh(o, u->mesh);
            for (uint32_t k = 0; u->entry && k < scene->meshes[mesh].primitive_count; k++) {
                scene->meshes[mesh].primitives[k].material = material_of(o, u->entry - 1);
                scene->meshes[mesh].primitives[k].variant_materials = NULL;
            }
        }
        scene->nodes[u->node].mesh = mesh;
    }
}

/* Primitives without a material get that of the entry for everything. */
static void assign_rest(overlay *o)
{
    facet_scene *scene = o->d.r.scene;
    for (uint32_t i = 0; o->all != SCENE_NONE && i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++)
            if (scene->meshes[i].primitives[k].material == SCENE_NONE)
                scene->meshes[i].primitives[k].material = material_of(o, o->all);
}

static bool is_used(const facet_scene *scene, uint32_t material)
{
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++)
            if (scene->meshes[i].primitives[k].material == material)
                return true;
    return false;
}

/* Removes the material without a name, which the OBJ reader gives to faces before any usemtl, if entries
 * for objects replaced it everywhere. */
static void drop_unnamed(overlay *o)
{
    facet_scene *scene = o->d.r.scene;
    uint32_t at = 0;
    while (at < scene->material_count &&
           (scene->materials[at].name[0] || o->is_set[at] || scene->legacy->materials[at].is_gltf_restored))
        at++;
    if (at == scene->material_count || is_used(scene, at))
        return;
    uint32_t behind = --scene->material_count - at;
    memmove(scene->materials + at, scene->materials + at + 1, behind * sizeof *scene->materials);
    memmove(scene->legacy->materials + at, scene->legacy->materials + at + 1,
            behind * sizeof *scene->legacy->materials);
    memmove(o->is_set + at, o->is_set + at + 1, behind * sizeof *o->is_set);
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++) {
            uint32_t *material = &scene->meshes[i].primitives[k].material;
            *material -= *material != SCENE_NONE && *material > at;
        }
}

/* rgl's rules for vertex colors and textures apply if everything drawn has parameters of rgl. */
static void decide_rules(overlay *o)
{
    facet_scene *scene = o->d.r.scene;
    bool is_rgl = o->d.entry_count > 0;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++) {
            uint32_t material = scene->meshes[i].primitives[k].material;
            is_rgl = is_rgl && material != SCENE_NONE && o->is_set[material];
        }
    scene->legacy->is_rgl |= is_rgl;
}

/* ---- what met nothing ---- */

static void warn_unmet(overlay *o)
{
    io_reader *r = &o->d.r;
    for (size_t i = 0; i < o->objects.count; i++)
        if (o->objects.names[i].is_used)
            o->is_used[o->objects.names[i].entry] = true;
    for (size_t i = 0; i < o->objects.count; i++) {
        const entry_name *n = &o->objects.names[i];
        if (!n->is_used && !o->is_named[n->entry])
            io_warn(r, NULL, NULL, "object \"%.200s\" is not in the model", n->name);
    }
    for (size_t i = 0; i < o->materials.count; i++) {
        const entry_name *n = &o->materials.names[i];
        if (!n->is_used && !o->is_used[n->entry] && o->d.entries[n->entry].object_count == 0)
            io_warn(r, NULL, NULL, "material \"%.200s\" is not in the model", n->name);
    }
}

static void lay(overlay *o, const facet_scene_desc *desc)
{
    io_reader *r = &o->d.r;
    void (*const steps[])(overlay *) = {make_room,      replace_materials, find_uses,
                                        make_mesh_room, assign_objects,    assign_rest,
                                        drop_unnamed,   decide_rules,      warn_unmet};
    ogl1_find_textures(&o->d);
    if (io_is_ok(r))
        take_memory(o);
    for (size_t i = 0; i < sizeof steps / sizeof *steps && io_is_ok(r); i++)
        steps[i](o);
    if (io_is_ok(r))
        ogl1_set_lights_and_fog(&o->d, &desc->legacy);
    release(o);
}

facet_result ogl1_json_overlay(facet_scene *scene, const char *path, const facet_scene_desc *desc,
                               facet_error *error)
{
    const facet_scene_desc defaults = {0};
    desc = desc ? desc : &defaults;
    file_bytes file = {0};
    TRY(model_file_open(path, desc, &file, error));
    facet_result result;
    overlay o = {0};
    const char *source = scene->source;
    char *folder = path_folder(&desc->allocator, path);
    if (folder) {
        scene->source = path; /* for messages, which are about this file */
        ogl1_document_read(&o.d, scene, (const char *)file.data, file.size, folder, desc, error);
        if (io_is_ok(&o.d.r))
            lay(&o, desc);
        scene->source = source;
        result = o.d.r.result;
    } else {
        result = fail_memory(error, "path", strlen(path));
    }
    if (result == FACET_OK && !scene_note_file(scene, &file, path))
        result = fail_memory(error, "files", sizeof file);
    mem_free(folder);
    file_close(&file);
    return result;
}
