/* builtin.c - the scene that facet renders without a model: spheres over roughness and metallic, and in
 * front of them a few materials by name, on a checkered plate. It is computed and needs no file. */
#include "scene/scene.h"
#include "scene/sphere.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/result.h"

enum {
    /* Around the axis: for a radius of r pixels, chords deviate from the circle by r pi^2 / (2
     * SEGMENTS^2), 0.13 pixels in an image of 1024 x 768, 0.25 at twice that size. */
    SEGMENTS = 48,
    RINGS = 24,
    COLUMNS = 6, /* of the grid: perceptual roughness 0 to 1 */
    ROWS = 4,    /* metallic 0 to 1, from below */
    NAMED = 7,
    TILES_X = 12,
    TILES_Z = 5,
    GRID = COLUMNS * ROWS,
    MATERIALS = GRID + NAMED + 1
};

/* Base colors of metals: reflectance facing, linear Rec.709 (Lagarde 2011, "Feeding a physically based
 * shading model"). */
static const struct {
    const char *name;
    float base_color[3];
    float metallic, perceptual_roughness;
    float emissive[3];
} NAMED_MATERIALS[NAMED] = {
    {"gold", {1.0f, 0.766f, 0.336f}, 1, 0.15f, {0}},
    {"copper", {0.955f, 0.638f, 0.538f}, 1, 0.35f, {0}},
    {"chrome", {0.549f, 0.556f, 0.554f}, 1, 0.0f, {0}},
    {"glossy plastic", {0.02f, 0.1f, 0.3f}, 0, 0.08f, {0}},
    {"satin plastic", {0.02f, 0.1f, 0.3f}, 0, 0.4f, {0}},
    {"matte plastic", {0.02f, 0.1f, 0.3f}, 0, 0.85f, {0}},
    {"lamp", {0.05f, 0.05f, 0.05f}, 0, 0.6f, {1.0f, 0.62f, 0.22f}},
};
static const float GRID_COLOR[3] = {0.56f, 0.11f, 0.06f};
static const float TILE_COLORS[2] = {0.42f, 0.2f};

/* ---- geometry ---- */

typedef struct builder {
    arena *arena;
    facet_scene *scene;
    bool has_failed;
    uint32_t node_count;
} builder;

static void *take(builder *b, size_t count, size_t size)
{
    void *memory = arena_zalloc(b->arena, count, size);
    b->has_failed |= memory == NULL;
    return memory;
}

typedef struct vertices {
    float *positions, *normals, *uvs, *colors;
    uint32_t *indices;
    uint32_t vertex_count, index_count;
} vertices;

static scene_primitive finish(builder *b, const vertices *v, uint32_t material)
{
    const float **sets = take(b, 1, sizeof *sets);
    scene_primitive p = {.mode = SCENE_TRIANGLES,
                         .vertex_count = v->vertex_count,
                         .index_count = v->index_count,
                         .indices = v->indices,
                         .positions = v->positions,
                         .normals = v->normals,
                         .colors = v->colors,
                         .texcoord_count = 1,
                         .texcoords = sets,
                         .material = material};
    if (b->has_failed)
        return p;
    sets[0] = v->uvs;
    for (int k = 0; k < 3; k++) {
        p.bounds_min[k] = p.bounds_max[k] = v->positions[k];
        for (uint32_t i = 0; i < v->vertex_count; i++) {
            p.bounds_min[k] = fminf(p.bounds_min[k], v->positions[3 * i + (uint32_t)k]);
            p.bounds_max[k] = fmaxf(p.bounds_max[k], v->positions[3 * i + (uint32_t)k]);
        }
    }
    return p;
}

static vertices allocate_vertices(builder *b, uint32_t vertex_count, uint32_t index_count, bool has_colors)
{
    return (vertices){.positions = take(b, vertex_count, 3 * sizeof(float)),
                      .normals = take(b, vertex_count, 3 * sizeof(float)),
                      .uvs = take(b, vertex_count, 2 * sizeof(float)),
                      .colors = has_colors ? take(b, vertex_count, 4 * sizeof(float)) : NULL,
                      .indices = take(b, index_count, sizeof(uint32_t))};
}

/* A gray quad with corners a, a + s, a + s + t, a + t, facing s x t. */
static void add_quad(vertices *v, const float a[3], const float s[3], const float t[3], float grey)
{
    const float normal[3] = {s[1] * t[2] - s[2] * t[1], s[2] * t[0] - s[0] * t[2], s[0] * t[1] - s[1] * t[0]};
    float length = sqrtf(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    const uint32_t corners[6] = {0, 1, 2, 0, 2, 3};
    for (int k = 0; k < 6; k++)
        v->indices[v->index_count++] = v->vertex_count + corners[k];
    for (uint32_t corner = 0; corner < 4; corner++) {
        float along_s = corner == 1 || corner == 2 ? 1.0f : 0.0f;
        float along_t = corner >= 2 ? 1.0f : 0.0f;
        size_t at = v->vertex_count++;
        for (size_t k = 0; k < 3; k++) {
            v->positions[3 * at + k] = a[k] + along_s * s[k] + along_t * t[k];
            v->normals[3 * at + k] = normal[k] / length;
            v->colors[4 * at + k] = grey;
        }
        v->colors[4 * at + 3] = 1.0f;
        v->uvs[2 * at] = along_s;
        v->uvs[2 * at + 1] = 1.0f - along_t;
    }
}

/* Tiles of 1 m with their top at y = 0, and the four sides of the plate. */
static scene_primitive make_plate(builder *b, uint32_t material)
{
    const float x = 0.5f * TILES_X;
    const float z = 0.5f * TILES_Z;
    const float height = 0.3f;
    uint32_t quads = TILES_X * TILES_Z + 4;
    vertices v = allocate_vertices(b, 4 * quads, 6 * quads, true);
    if (b->has_failed)
        return (scene_primitive){0};
    for (int row = 0; row < TILES_Z; row++)
        for (int column = 0; column < TILES_X; column++)
            add_quad(&v, (const float[3]){(float)column - x, 0.0f, (float)row + 1.0f - z},
                     (const float[3]){1, 0, 0}, (const float[3]){0, 0, -1}, TILE_COLORS[(row + column) % 2]);
    const float up[3] = {0, height, 0};
    const float corners[4][3] = {{-x, -height, z}, {x, -height, z}, {x, -height, -z}, {-x, -height, -z}};
    for (int side = 0; side < 4; side++) {
        const float *from = corners[side];
        const float *to = corners[(side + 1) % 4];
        const float along[3] = {to[0] - from[0], 0.0f, to[2] - from[2]};
        add_quad(&v, from, along, up, TILE_COLORS[1]);
    }
    return finish(b, &v, material);
}

/* ---- the scene ---- */

static const char *copy_name(builder *b, const char *name)
{
    const char *copy = arena_strdup(b->arena, name);
    b->has_failed |= copy == NULL;
    return copy ? copy : "";
}

static void make_materials(builder *b)
{
    scene_material *materials = b->scene->materials;
    for (int i = 0; i < MATERIALS; i++)
        materials[i] = scene_material_default();
    for (int i = 0; i < GRID; i++) {
        char name[64];
        scene_material *m = &materials[i];
        m->perceptual_roughness = (float)(i % COLUMNS) / (COLUMNS - 1);
        m->metallic = (float)(i / COLUMNS) / (ROWS - 1);
        memcpy(m->base_color, GRID_COLOR, sizeof GRID_COLOR);
        snprintf(name, sizeof name, "metallic %.2f roughness %.1f", (double)m->metallic,
                 (double)m->perceptual_roughness);
        m->name = copy_name(b, name);
    }
    for (int i = 0; i < NAMED; i++) {
        scene_material *m = &materials[GRID + i];
        m->name = NAMED_MATERIALS[i].name;
        m->metallic = NAMED_MATERIALS[i].metallic;
        m->perceptual_roughness = NAMED_MATERIALS[i].perceptual_roughness;
        memcpy(m->base_color, NAMED_MATERIALS[i].base_color, sizeof NAMED_MATERIALS[i].base_color);
        memcpy(m->emissive, NAMED_MATERIALS[i].emissive, sizeof m->emissive);
    }
    scene_material *plate = &materials[GRID + NAMED];
    plate->name = "plate";
    plate->metallic = 0.0f;
    plate->perceptual_roughness = 0.45f;
}

/* Mesh and node i: primitive at (x, y, z), scaled by radius. */
static void place(builder *b, scene_primitive primitive, uint32_t material, float x, float y, float z,
                  float radius)
{
    uint32_t i = b->node_count++;
    scene_primitive *own = take(b, 1, sizeof *own);
    if (!own)
        return;
    *own = primitive;
    own->material = material;
    const char *name = b->scene->materials[material].name;
    b->scene->meshes[i] = (scene_mesh){.name = name, .primitive_count = 1, .primitives = own};
    scene_node *node = &b->scene->nodes[i];
    const double place[3] = {(double)x, (double)y, (double)z};
    *node = scene_node_default(name);
    node->mesh = i;
    for (int k = 0; k < 3; k++) {
        node->translation[k] = place[k];
        node->scale[k] = radius;
    }
}

static void make_nodes(builder *b)
{
    scene_primitive sphere = {0};
    if (!scene_make_sphere(b->scene->arena, SEGMENTS, RINGS, &sphere))
        b->has_failed = true;
    for (uint32_t i = 0; i < GRID && !b->has_failed; i++)
        place(b, sphere, i, 2.2f * ((float)(i % COLUMNS) - 0.5f * (COLUMNS - 1)),
              2.25f + 2.15f * (float)(i / COLUMNS), -1.6f, 1.0f);
    for (uint32_t i = 0; i < NAMED && !b->has_failed; i++)
        place(b, sphere, GRID + i, 1.7f * ((float)i - 0.5f * (NAMED - 1)), 0.78f, 1.2f, 0.78f);
    scene_primitive plate = make_plate(b, GRID + NAMED);
    if (!b->has_failed)
        place(b, plate, GRID + NAMED, 0.0f, 0.0f, 0.2f, 1.0f);
}

facet_result scene_create_builtin(const facet_scene_desc *desc, facet_scene **out, facet_error *error)
{
    *out = NULL;
    facet_scene *scene = NULL;
    TRY(scene_create(&desc->allocator, "built-in scene", &scene, error));
    builder b = {.arena = scene->arena, .scene = scene};
    scene->generator = "facet";
    scene->version = "2.0";
    scene->materials = take(&b, MATERIALS, sizeof *scene->materials);
    scene->meshes = take(&b, MATERIALS, sizeof *scene->meshes);
    scene->nodes = take(&b, MATERIALS, sizeof *scene->nodes);
    scene->scenes = take(&b, 1, sizeof *scene->scenes);
    uint32_t *roots = take(&b, MATERIALS, sizeof *roots);
    if (!b.has_failed) {
        make_materials(&b);
        make_nodes(&b);
    }
    if (b.has_failed) {
        scene_destroy(scene);
        return fail_memory(error, "built-in scene", 0);
    }
    for (uint32_t i = 0; i < MATERIALS; i++)
        roots[i] = i;
    scene->scenes[0] =
        (scene_root){.name = "materials", .node_count = MATERIALS, .nodes = roots, .image_light = SCENE_NONE};
    scene->scene_count = 1;
    scene->default_scene = 0;
    scene->material_count = scene->mesh_count = scene->node_count = MATERIALS;
    scene->max_texture_size = desc->max_texture_size;
    scene->thread_count = desc->thread_count;
    *out = scene;
    return FACET_OK;
}
