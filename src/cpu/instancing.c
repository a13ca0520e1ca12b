/* instancing.c - see instancing.h.
 *
 * Flat triangles take 160 to 290 ns each to build with two threads and 80 bytes; an instance 0.6 us and
 * 0.4 kB, however large its shape is. A ray takes 3 ns more through instances that do not overlap, up to
 * 60 ns where many do. So instancing pays if it saves a triangle per 5 to 90 rays; below that, and in
 * every model whose meshes are drawn once, all stays flat. (Packets of 16 rays, 30 to 60 ns each; spheres
 * of 484 and 4900 triangles in a grid.) */
#include "cpu/instancing.h"

#include <math.h>

#include "base/memory.h"
#include "base/result.h"

enum {
    RAYS_PER_TRIANGLE = 16,
    MIN_SAVED = 1 << 15, /* triangles: 8 ms */
    MAX_SAVED = 1 << 20, /* from here on instancing saves memory: 80 MB */
    MIN_TRIANGLES = 16   /* of a shape; an instance costs as much as 5 triangles */
};

/* Limits of coordinates, m, and scale: rays stay within 1e10 * 1e7. */
static const double MAX_COORDINATE = 1e10;
static const double MAX_SCALE = 1e7;

bool instancing_is_within_reach(const scene_pose *pose, const camera_rays *camera)
{
    for (int i = 0; i < 3; i++) {
        double width = 2.0 * (double)camera->middle[0];
        double height = 2.0 * (double)camera->middle[1];
        double origin = fabs((double)camera->origin[i]) + fabs((double)camera->origin_dx[i]) * width +
                        fabs((double)camera->origin_dy[i]) * height;
        double direction = fabs((double)camera->direction[i]) +
                           fabs((double)camera->direction_dx[i]) * width +
                           fabs((double)camera->direction_dy[i]) * height;
        double bounds = fmax(fabs((double)pose->bounds_min[i]), fabs((double)pose->bounds_max[i]));
        if (!(origin <= MAX_COORDINATE && direction <= MAX_COORDINATE && bounds <= MAX_COORDINATE))
            return false;
    }
    return true;
}

/* Whether world and its inverse scale by no more than MAX_SCALE. The inverse is the cofactors over the
 * determinant. */
static bool is_moderate(const mat4 *world)
{
    const float *m = world->m;
    double cofactors[9];
    double largest = 0.0;
    double largest_cofactor = 0.0;
    for (int i = 0; i < 9; i++) {
        int row = i / 3;
        int column = i % 3;
        const float *a = m + 4 * ((column + 1) % 3);
        const float *b = m + 4 * ((column + 2) % 3);
        cofactors[i] = (double)a[(row + 1) % 3] * (double)b[(row + 2) % 3] -
                       (double)a[(row + 2) % 3] * (double)b[(row + 1) % 3];
        double value = fabs((double)m[4 * column + row]);
        largest = value > largest ? value : largest;
        value = fabs(cofactors[i]);
        largest_cofactor = value > largest_cofactor ? value : largest_cofactor;
    }
    double determinant = 0.0;
    for (int row = 0; row < 3; row++)
        determinant += (double)m[row] * cofactors[3 * row];
    return largest <= MAX_SCALE && largest_cofactor <= MAX_SCALE * fabs(determinant);
}

/* Whether a mesh is near its own origin: far from it, the rounding of hits would be large relative to its
 * size, and differ from that of flat vertices, from which reflected rays start. */
static bool is_centered(const scene_primitive *primitive)
{
    const float most = 256.0f; /* times its size: an error of 3e-5 of it */
    float size = 0.0f;
    float farthest = 0.0f;
    for (int i = 0; i < 3; i++) {
        size = fmaxf(size, primitive->bounds_max[i] - primitive->bounds_min[i]);
        farthest = fmaxf(farthest, fmaxf(fabsf(primitive->bounds_min[i]), fabsf(primitive->bounds_max[i])));
    }
    return farthest <= most * size;
}

/* ---- animated nodes ---- */

enum { UNKNOWN, AT_REST, MOVES };

static void mark_channels(const facet_scene *scene, const facet_pose_desc *desc, uint8_t *moves)
{
    for (uint32_t i = 0; i < desc->animation_count; i++) {
        const scene_animation *animation = &scene->animations[desc->animations[i]];
        for (uint32_t k = 0; k < animation->channel_count; k++) {
            const scene_channel *channel = &animation->channels[k];
            if (channel->kind == SCENE_TARGET_NODE && channel->index < scene->node_count)
                moves[channel->index] = MOVES;
        }
    }
}

/* Nodes below a moving node move with it. Each node is visited once: upwards to one that is known, then
 * again to record the result. */
static void mark_descendants(const facet_scene *scene, uint8_t *moves)
{
    for (uint32_t i = 0; i < scene->node_count; i++) {
        uint32_t node = i;
        while (node != SCENE_NONE && moves[node] == UNKNOWN)
            node = scene->nodes[node].parent;
        uint8_t found = node == SCENE_NONE ? AT_REST : moves[node];
        for (node = i; node != SCENE_NONE && moves[node] == UNKNOWN; node = scene->nodes[node].parent)
            moves[node] = found;
    }
}

/* ---- shapes ---- */

typedef struct chooser {
    const facet_scene *scene;
    const scene_pose *pose;
    const instancing_desc *desc;
    render_geometry_set *set;
    uint8_t *moves;        /* per node; NULL: no animation */
    uint32_t *first_slots; /* per mesh: of its primitives */
    uint32_t *slots;       /* per primitive of the scene: its shape so far, SCENE_NONE: none */
    uint64_t needed;       /* triangles to be saved */
} chooser;

static uint64_t triangle_count(const render_geometry *g)
{
    return g->primitive->mode == SCENE_TRIANGLES ? g->primitive->index_count / 3 : 0;
}

/* Whether the vertices may differ between frames, although those of this pose may be at rest. */
static bool is_soft(const chooser *c, uint32_t i)
{
    const scene_instance *instance = &c->pose->instances[i];
    bool has_skin =
        instance->primitive->influence_count && c->scene->nodes[instance->node].skin != SCENE_NONE;
    return instance->is_deformed || instance->primitive->target_count || has_skin;
}

static bool is_moved(const chooser *c, uint32_t i)
{
    return c->moves && c->moves[c->pose->instances[i].node] == MOVES;
}

/* Assigns a shape to every geometry that could be instanced. Geometries with the same vertices share it;
 * deformed ones do where they are consecutive. */
static void find_shapes(chooser *c)
{
    render_geometry_set *set = c->set;
    for (uint32_t i = 0; i < set->count; i++) {
        const scene_instance *instance = &c->pose->instances[i];
        render_geometry *g = &set->items[i];
        g->shape = SCENE_NONE;
        if (triangle_count(g) < MIN_TRIANGLES || !is_centered(g->primitive) || !is_moderate(&instance->world))
            continue;
        uint32_t *slot = &c->slots[c->first_slots[instance->mesh] + instance->primitive_index];
        if (*slot == SCENE_NONE || set->shapes[*slot].positions != g->positions) {
            *slot = set->shape_count++;
            set->shapes[*slot] = (render_shape){.primitive = g->primitive, .positions = g->positions};
        }
        g->shape = *slot;
        set->shapes[*slot].use_count++;
    }
}

/* Whether the pose is a frame of an animation, and enough triangles are the same in the others. */
static bool pays_to_keep(const chooser *c)
{
    uint64_t kept = 0;
    bool has_motion = false;
    for (uint32_t i = 0; i < c->set->count && c->moves; i++) {
        bool moves = is_moved(c, i);
        has_motion = has_motion || moves || is_soft(c, i);
        if (!is_soft(c, i) && (!moves || c->set->items[i].shape != SCENE_NONE))
            kept += triangle_count(&c->set->items[i]);
    }
    return has_motion && kept >= c->needed;
}

static bool pays_to_share(const chooser *c)
{
    uint64_t saved = 0;
    for (uint32_t i = 0; i < c->set->shape_count; i++) {
        const render_shape *shape = &c->set->shapes[i];
        saved += (uint64_t)(shape->primitive->index_count / 3) * (shape->use_count - 1);
    }
    return saved >= c->needed;
}

static render_role choose_role(const chooser *c, uint32_t i, bool is_animated, bool is_shared)
{
    const render_geometry *g = &c->set->items[i];
    bool has_shape = g->shape != SCENE_NONE;
    if (is_shared && has_shape && c->set->shapes[g->shape].use_count > 1)
        return RENDER_INSTANCED;
    if (!is_animated || g->primitive->mode != SCENE_TRIANGLES || is_soft(c, i))
        return RENDER_FLAT;
    if (is_moved(c, i))
        return has_shape ? RENDER_INSTANCED : RENDER_FLAT;
    return RENDER_STILL;
}

/* Removes unused shapes. indices: room for one per shape. */
static void compact_shapes(render_geometry_set *set, uint32_t *indices)
{
    for (uint32_t i = 0; i < set->shape_count; i++)
        set->shapes[i].use_count = 0;
    for (uint32_t i = 0; i < set->count; i++)
        if (set->items[i].role == RENDER_INSTANCED)
            set->shapes[set->items[i].shape].use_count++;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < set->shape_count; i++) {
        indices[i] = kept;
        if (set->shapes[i].use_count)
            set->shapes[kept++] = set->shapes[i];
    }
    set->shape_count = kept;
    for (uint32_t i = 0; i < set->count; i++) {
        render_geometry *g = &set->items[i];
        g->shape = g->role == RENDER_INSTANCED ? indices[g->shape] : SCENE_NONE;
    }
}

/* An upper bound of the savings; it excludes most models early. */
static bool is_worth_a_look(const chooser *c)
{
    uint64_t triangles = 0;
    for (uint32_t i = 0; i < c->set->count; i++)
        triangles += triangle_count(&c->set->items[i]);
    return triangles >= c->needed && (c->set->count > 1 || c->desc->pose->animation_count);
}

/* Fills the index of each mesh's first primitive; returns the count of all. */
static size_t number_primitives(const facet_scene *scene, uint32_t *first_slots)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        first_slots[i] = count;
        count += scene->meshes[i].primitive_count;
    }
    return count;
}

facet_result instancing_choose(const facet_scene *scene, const scene_pose *pose, const instancing_desc *desc,
                               const facet_allocator *allocator, render_geometry_set *set, facet_error *error)
{
    uint64_t needed = desc->ray_count / RAYS_PER_TRIANGLE;
    needed = needed < MIN_SAVED ? MIN_SAVED : needed > MAX_SAVED ? MAX_SAVED : needed;
    chooser c = {.scene = scene, .pose = pose, .desc = desc, .set = set, .needed = needed};
    if (!desc->is_within_reach || !is_worth_a_look(&c))
        return FACET_OK;

    facet_result result = FACET_OK;
    size_t slot_count = 0;
    bool is_animated = desc->pose->animation_count > 0;
    c.first_slots = mem_alloc(allocator, scene->mesh_count, sizeof *c.first_slots);
    if (c.first_slots)
        slot_count = number_primitives(scene, c.first_slots);
    c.slots = mem_alloc(allocator, slot_count + set->count, sizeof *c.slots);
    set->shapes = mem_zalloc(allocator, set->count, sizeof *set->shapes);
    if (is_animated)
        c.moves = mem_zalloc(allocator, scene->node_count, sizeof *c.moves);
    if (!c.first_slots || !c.slots || !set->shapes || (is_animated && !c.moves)) {
        result = fail_memory(error, "instances", set->count * sizeof *set->shapes);
        goto done;
    }
    for (size_t i = 0; i < slot_count; i++)
        c.slots[i] = SCENE_NONE;
    if (c.moves) {
        mark_channels(scene, desc->pose, c.moves);
        mark_descendants(scene, c.moves);
    }
    find_shapes(&c);
    set->is_animated = pays_to_keep(&c);
    bool is_shared = pays_to_share(&c);
    for (uint32_t i = 0; i < set->count; i++)
        set->items[i].role = (uint8_t)choose_role(&c, i, set->is_animated, is_shared);
    compact_shapes(set, c.slots + slot_count);
done:
    mem_free(c.first_slots);
    mem_free(c.slots);
    mem_free(c.moves);
    return result;
}

/* ---- copies that are seen from nearby ---- */

typedef struct sphere {
    float center[3], radius; /* world, m */
    float scale;             /* of world: the longest of its axes */
} sphere;

static float length3(const float v[3])
{
    return sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static float dot3(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static sphere bounding_sphere(const render_geometry *g)
{
    const scene_primitive *p = g->primitive;
    sphere s = {.scale = 0.0f};
    float middle[3];
    float half[3];
    for (int i = 0; i < 3; i++) {
        middle[i] = 0.5f * (p->bounds_min[i] + p->bounds_max[i]);
        half[i] = 0.5f * (p->bounds_max[i] - p->bounds_min[i]);
        s.scale = fmaxf(s.scale, length3(g->world->m + 4 * i));
    }
    mat4_transform_point(g->world, middle, s.center);
    s.radius = length3(half) * s.scale;
    return s;
}

/* Size of a pixel at the nearest point of the copy, in the units of its mesh; infinity: outside of the
 * image. */
static float pixel_size(const render_geometry *g, const camera_rays *camera, uint32_t width, uint32_t height)
{
    const float *dx = camera->is_orthographic ? camera->origin_dx : camera->direction_dx;
    const float *dy = camera->is_orthographic ? camera->origin_dy : camera->direction_dy;
    sphere s = bounding_sphere(g);
    float d[3];
    for (int i = 0; i < 3; i++)
        d[i] = s.center[i] - camera->origin[i];
    float depth = dot3(d, camera->direction);
    if (depth + s.radius < camera->near_m)
        return INFINITY;
    float nearest = fmaxf(depth - s.radius, camera->near_m);
    float pixel = camera_rays_pixel_size(camera, nearest);
    if (!(pixel > 0.0f))
        return 0.0f; /* it encloses the camera */
    float pixel2 = camera->pixel_size * camera->pixel_size * (camera->is_orthographic ? 1.0f : depth);
    float x = dot3(d, dx) / pixel2 + camera->middle[0];
    float y = dot3(d, dy) / pixel2 + camera->middle[1];
    float radius = s.radius / pixel;
    if (x + radius < 0.0f || y + radius < 0.0f || x - radius > (float)width || y - radius > (float)height)
        return INFINITY;
    return pixel / s.scale;
}

/* Keeps the NEAREST_COPIES smallest, sorted. */
static void insert(float *smallest, float value)
{
    int place = NEAREST_COPIES;
    if (!(value < smallest[NEAREST_COPIES - 1]))
        return;
    while (place > 0 && value < smallest[place - 1]) {
        if (place < NEAREST_COPIES)
            smallest[place] = smallest[place - 1];
        place--;
    }
    smallest[place] = value;
}

static bool has_many(const render_geometry_set *set, const render_geometry *g)
{
    return g->role == RENDER_INSTANCED && set->shapes[g->shape].use_count > NEAREST_COPIES;
}

facet_result nearest_copies_choose(render_geometry_set *set, const camera_rays *camera, uint32_t width,
                                   uint32_t height, const facet_allocator *allocator, facet_error *error)
{
    bool is_needed = false;
    for (uint32_t i = 0; i < set->shape_count; i++)
        is_needed = is_needed || set->shapes[i].use_count > NEAREST_COPIES;
    if (!is_needed)
        return FACET_OK;
    float *smallest = mem_alloc(allocator, (size_t)set->shape_count * NEAREST_COPIES, sizeof *smallest);
    float *sizes = mem_alloc(allocator, set->count, sizeof *sizes);
    bool has_memory = smallest && sizes;
    for (size_t i = 0; has_memory && i < (size_t)set->shape_count * NEAREST_COPIES; i++)
        smallest[i] = INFINITY;
    for (uint32_t i = 0; has_memory && i < set->count; i++) {
        const render_geometry *g = &set->items[i];
        if (!has_many(set, g))
            continue;
        sizes[i] = pixel_size(g, camera, width, height);
        insert(smallest + (size_t)g->shape * NEAREST_COPIES, sizes[i]);
    }
    for (uint32_t i = 0; has_memory && i < set->count; i++) {
        render_geometry *g = &set->items[i];
        if (!has_many(set, g))
            continue;
        float *of_shape = smallest + (size_t)g->shape * NEAREST_COPIES;
        g->is_far_copy = !(sizes[i] <= of_shape[NEAREST_COPIES - 1] && sizes[i] < INFINITY);
        if (of_shape[0] == INFINITY) { /* none is visible: the first represents all */
            g->is_far_copy = false;
            of_shape[0] = 0.0f;
        }
    }
    mem_free(smallest);
    mem_free(sizes);
    return has_memory ? FACET_OK : fail_memory(error, "instances", set->count * sizeof *sizes);
}
