/* water_scene.c - see water_scene.h and water_mesh_scene() of water_mesh.h. */
#include "water/water_scene.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/result.h"

#include "water/water_mesh.h"
#include "water/water_path.h"

/* ---- triangles beside a model ---- */

/* 70 bytes each with their two triangles, and about as much again for the BVH. */
enum { MAX_VERTICES = 2000000 };

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

static bool fill(const water_setup *s, facet_scene *scene, const facet_scene *with, render_watch *watch)
{
    static const facet_scene nothing;
    uint32_t first = with ? with->node_count : 0;
    scene_primitive surface, bed;
    water_mesh_lattice l;
    const scene_material water = water_material(), ground = bed_material(&s->sea->desc.bed);
    return borrow(scene, with ? with : &nothing, 2) &&
           water_mesh_lattice_create(s, MAX_VERTICES, scene->arena, &l) &&
           water_mesh_surface(s, &l, watch, scene->arena, &surface) && add(scene, &surface, &water) &&
           (!water_has_bed(s) || (water_mesh_bed(s, &l, scene->arena, &bed) && add(scene, &bed, &ground))) &&
           show(scene, first);
}

facet_result water_mesh_scene(const water_setup *s, const facet_scene *with, double deadline_s,
                              facet_scene **out, facet_error *error)
{
    *out = NULL;
    render_watch watch;
    render_watch_init(&watch, &s->desc->progress, "prepare", deadline_s, 1.0);
    facet_scene *scene;
    facet_result result = scene_create(&s->desc->allocator, "sea", &scene, error);
    if (result != FACET_OK)
        return result;
    result = fill(s, scene, with, &watch)
                 ? render_watch_explain(&watch, error)
                 : fail_memory(error, "triangles of a sea", (size_t)MAX_VERTICES * 70);
    if (result == FACET_OK)
        *out = scene;
    else
        scene_destroy(scene);
    return result;
}

/* ---- for the path tracer ---- */

struct water_scene {
    water_setup setup;
    facet_scene *scene;
    facet_render_desc desc;
    water_path water;
    path_surface surface; /* of water */
};

/* The preview's lighting: the sky without its lower half and its sun, and a directional sun. */
static facet_render_desc desc_of(const water_setup *s, double deadline_s)
{
    facet_render_desc r = *s->desc;
    vec3 L = s->sky.L, E = s->sky.sun_irradiance;
    r.sea = NULL; /* it is part of the scene */
    r.environment = s->sky.mirrored;
    r.environment_ev = log2(max(s->sky.scale, 1e-30f));
    r.background = FACET_BACKGROUND_ENVIRONMENT;
    r.sun.azimuth_rad = atan(L[0], L[2]);
    r.sun.elevation_rad = asin(clamp(L[1], -1.0f, 1.0f));
    r.sun.illuminance_lux[0] = E[0];
    r.sun.illuminance_lux[1] = E[1];
    r.sun.illuminance_lux[2] = E[2];
    if (deadline_s > 0.0)
        r.time_limit_s = fmax(deadline_s - clock_seconds(), 1e-6);
    return r;
}

facet_result water_scene_create(water_cache *cache, const facet_scene *scene, const facet_render_desc *desc,
                                double deadline_s, water_scene **out, facet_render_stats *stats,
                                facet_error *error)
{
    *out = NULL;
    water_scene *w = mem_zalloc(&desc->allocator, 1, sizeof *w);
    if (!w)
        return fail_memory(error, "the scene of a sea", sizeof *w);
    facet_result result = water_setup_create(cache, scene, desc, 0, &w->setup, stats, error);
    if (result == FACET_OK)
        result = water_mesh_scene(&w->setup, scene, deadline_s, &w->scene, error);
    if (result != FACET_OK) {
        water_scene_destroy(w);
        return result;
    }
    w->water = water_path_make(&w->setup);
    w->surface = water_path_surface(&w->water);
    w->desc = desc_of(&w->setup, deadline_s);
    *out = w;
    return FACET_OK;
}

void water_scene_destroy(water_scene *w)
{
    if (!w)
        return;
    scene_destroy(w->scene);
    water_setup_destroy(&w->setup);
    mem_free(w);
}

const facet_scene *water_scene_get_scene(const water_scene *w)
{
    return w->scene;
}

const facet_render_desc *water_scene_get_desc(const water_scene *w)
{
    return &w->desc;
}

const path_surface *water_scene_get_surface(const water_scene *w)
{
    return &w->surface;
}
