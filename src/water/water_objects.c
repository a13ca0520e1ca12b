/* water_objects.c - see water_objects.h. */
#include "water/water_objects.h"

#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "ocean/sea.h"

/* ---- materials ---- */

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
    m.extensions = SCENE_SPECULAR; /* the bed is Lambertian */
    m.specular = 0.0f;
    m.is_double_sided = true;
    for (int i = 0; i < 3; i++)
        m.base_color[i] = bed->albedo[i];
    return m;
}

/* ---- beside a model ---- */

/* A copy of `count` items with room for `more`. NULL: out of memory. */
static void *extended(arena *memory, const void *items, uint32_t count, uint32_t more, size_t size)
{
    unsigned char *out = arena_zalloc(memory, (size_t)count + more, size);
    if (out && count)
        memcpy(out, items, count * size);
    return out;
}

/* Everything visible in `with`, with room for `more` meshes with a node and a material each. */
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

/* Adds the nodes from `first` on to all scenes; a file without scenes shows its root nodes. */
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
    scene_node *node = &scene->nodes[scene->node_count++];
    *node = scene_node_default(material->name);
    node->mesh = scene->mesh_count++;
    return true;
}

bool water_objects_add(const facet_scene *with, const facet_sea *sea, const scene_primitive *surface,
                       const scene_primitive *bed, facet_scene *scene)
{
    static const facet_scene nothing;
    const facet_scene *model = with ? with : &nothing;
    const scene_material water = water_material(), ground = bed_material(&sea->desc.bed);
    return borrow(scene, model, WATER_OBJECTS) && add(scene, surface, &water) &&
           (!bed || add(scene, bed, &ground)) && show(scene, model->node_count);
}

/* ---- without triangles ---- */

facet_result water_objects_scene(const facet_scene *with, const facet_sea *sea,
                                 const facet_allocator *allocator, facet_scene **out, facet_error *error)
{
    static const scene_primitive empty;
    *out = NULL;
    facet_scene *scene;
    TRY(scene_create(allocator, "sea", &scene, error));
    if (!water_objects_add(with, sea, &empty, sea_has_bed(&sea->desc.bed) ? &empty : NULL, scene)) {
        scene_destroy(scene);
        return fail_memory(error, "the objects of a sea", sizeof *scene);
    }
    *out = scene;
    return FACET_OK;
}

facet_result water_objects_identify(const facet_scene *with, const facet_sea *sea,
                                    const facet_allocator *allocator, scene_identity **out,
                                    facet_error *error)
{
    scene_instance instances[WATER_OBJECTS] = {{0}};
    facet_scene *scene;
    *out = NULL;
    TRY(water_objects_scene(with, sea, allocator, &scene, error));
    scene_pose pose = {.instances = instances,
                       .instance_count = scene->node_count - (with ? with->node_count : 0)};
    for (uint32_t i = 0; i < pose.instance_count; i++) {
        instances[i].node = scene->node_count - pose.instance_count + i;
        instances[i].material = scene->material_count - pose.instance_count + i;
    }
    facet_result result = scene_identities_create(scene, &pose, allocator, out, error);
    scene_destroy(scene);
    return result;
}
