/* water_mesh_scene.c - the sea as triangles, and a model beside it, in one scene: see water_mesh.h. */
#include <math.h>
#include <string.h>

#include "base/result.h"

#include "water/water_mesh.h"

/* 70 bytes each, with their two triangles, and about as much again for the rays' hierarchy. */
enum { MOST_VERTICES = 2000000 };

static scene_material water_material(void)
{
    scene_material m = scene_material_default();
    m.name = "water";
    m.metallic = 0.0f;
    m.is_double_sided = true;
    return m;
}

static scene_material bed_material(const facet_sea_bed *bed)
{
    scene_material m = scene_material_default();
    m.name = "bed";
    m.metallic = 0.0f;
    m.perceptual_roughness = 1.0f;
    m.extensions = SCENE_SPECULAR; /* the ground is Lambert's */
    m.specular = 0.0f;
    m.is_double_sided = true;
    for (int i = 0; i < 3; i++)
        m.base_color[i] = bed->albedo[i];
    return m;
}

/* An array of `count` items with room for `more`. NULL: no memory. */
static void *extended(arena *memory, const void *items, uint32_t count, uint32_t more, size_t size)
{
    unsigned char *out = arena_zalloc(memory, (size_t)count + more, size);
    if (out && count)
        memcpy(out, items, count * size);
    return out;
}

/* All of `with` that is drawn; room for `more` meshes with a node and a material each. */
static bool borrow(facet_scene *scene, const facet_scene *with, uint32_t more)
{
    facet_scene own = *scene;
    *scene = *with;
    scene->allocator = own.allocator;
    scene->arena = own.arena;
    scene->source = own.source;
    scene->file_count = own.file_count;
    scene->files = own.files;
    scene->legacy = NULL;
    scene->conversion = NULL;
    scene->warning_count = 0;
    scene->warnings = NULL;
    scene->materials =
        extended(own.arena, with->materials, with->material_count, more, sizeof *with->materials);
    scene->meshes = extended(own.arena, with->meshes, with->mesh_count, more, sizeof *with->meshes);
    scene->nodes = extended(own.arena, with->nodes, with->node_count, more, sizeof *with->nodes);
    scene->scenes = extended(own.arena, with->scenes, with->scene_count, 1, sizeof *with->scenes);
    return scene->materials && scene->meshes && scene->nodes && scene->scenes;
}

/* Names the nodes from `first` on in all scenes; a file without any shows what has no parent as it is. */
static bool show(facet_scene *scene, uint32_t first)
{
    uint32_t more = scene->node_count - first;
    for (uint32_t i = 0; i < scene->scene_count; i++) {
        scene_root *root = &scene->scenes[i];
        uint32_t *nodes = extended(scene->arena, root->nodes, root->node_count, more, sizeof *nodes);
        if (!nodes)
            return false;
        for (uint32_t k = 0; k < more; k++)
            nodes[root->node_count + k] = first + k;
        root->nodes = nodes;
        root->node_count += more;
    }
    return true;
}

static bool add(facet_scene *scene, const scene_primitive *p, const scene_material *material)
{
    scene_primitive *own = arena_alloc(scene->arena, 1, sizeof *own);
    if (!own)
        return false;
    *own = *p;
    own->material = scene->material_count;
    scene->materials[scene->material_count++] = *material;
    scene->meshes[scene->mesh_count] =
        (scene_mesh){.name = material->name, .primitive_count = 1, .primitives = own};
    scene->nodes[scene->node_count++] = (scene_node){.name = material->name,
                                                     .parent = SCENE_NONE,
                                                     .rotation = {0, 0, 0, 1},
                                                     .scale = {1, 1, 1},
                                                     .mesh = scene->mesh_count++,
                                                     .camera = SCENE_NONE,
                                                     .light = SCENE_NONE,
                                                     .skin = SCENE_NONE};
    return true;
}

static bool fill(const water_setup *s, facet_scene *scene, const facet_scene *with, render_watch *watch)
{
    static const facet_scene nothing;
    uint32_t first = with ? with->node_count : 0;
    scene_primitive surface, bed;
    water_mesh_lattice l;
    const scene_material water = water_material(), ground = bed_material(&s->sea->desc.bed);
    return borrow(scene, with ? with : &nothing, 2) &&
           water_mesh_lattice_create(s, MOST_VERTICES, scene->arena, &l) &&
           water_mesh_surface(s, &l, watch, scene->arena, &surface) && add(scene, &surface, &water) &&
           (!water_has_bed(s) || (water_mesh_bed(s, &l, scene->arena, &bed) && add(scene, &bed, &ground))) &&
           show(scene, first);
}

facet_result water_mesh_scene(const water_setup *s, const facet_scene *with, double deadline_s,
                              facet_scene **out, facet_error *error)
{
    *out = NULL;
    render_watch watch;
    render_watch_init(&watch, &s->desc->render.progress, "prepare", deadline_s, 1.0);
    facet_scene *scene;
    facet_result result = scene_create(&s->desc->render.allocator, "sea", &scene, error);
    if (result != FACET_OK)
        return result;
    result = fill(s, scene, with, &watch)
                 ? render_watch_explain(&watch, error)
                 : fail_memory(error, "triangles of a sea", (size_t)MOST_VERTICES * 70);
    if (result == FACET_OK)
        *out = scene;
    else
        scene_destroy(scene);
    return result;
}
