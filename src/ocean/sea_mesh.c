/* sea_mesh.c - the surface and its bed as a mesh: see sea.h. */
#include "ocean/sea.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"
#include "scene/scene.h"

enum { DEFAULT_SAMPLES = 512, MAX_SAMPLES = 4096 };
static const double FLAT_SIZE_M = 100.0;
static const float DEEP_THICKNESS_M = 10.0f;     /* for viewers that do not trace light to the bed */
static const double DIFFUSE_REFLECTANCE = 0.067; /* of the surface, from above, n = 1.34 */

typedef struct sheet {
    const facet_sea *sea;
    uint32_t samples;
    double half_m, center[2];
    /* vertices lie at half_m sinh(bend u) / sinh(bend), u in equal steps from -1 to 1; 0: equidistant */
    double bend;
    float *positions, *normals, *uvs;
} sheet;

/* ---- where vertices are ---- */

/* sinh(a) / a = refinement: density at the center relative to equidistant vertices. */
static double bend_of(double refinement)
{
    double low = 0.0, high = 12.0;
    if (refinement <= 1.0)
        return 0.0;
    for (int i = 0; i < 60; i++) {
        double a = 0.5 * (low + high);
        if (sinh(a) / a < refinement)
            low = a;
        else
            high = a;
    }
    return 0.5 * (low + high);
}

static double place_of(const sheet *s, uint32_t i)
{
    double u = 2.0 * i / (s->samples - 1) - 1.0;
    return s->half_m * (s->bend > 0.0 ? sinh(s->bend * u) / sinh(s->bend) : u);
}

/* Distance from vertex i to the next or the previous one. */
static double step_of(const sheet *s, uint32_t i)
{
    return i + 1 < s->samples ? place_of(s, i + 1) - place_of(s, i) : place_of(s, i) - place_of(s, i - 1);
}

static void fill_row(const sheet *s, uint32_t row)
{
    double z = place_of(s, row), step_z = step_of(s, row);
    for (uint32_t column = 0; column < s->samples; column++) {
        double x = place_of(s, column), step = fmax(step_z, step_of(s, column));
        wave_point p = waves_at(&s->sea->waves, s->center[0] + x, s->center[1] + z, (float)step);
        wave_shape shape = wave_shape_of(&p);
        size_t at = (size_t)row * s->samples + column;
        s->positions[3 * at] = (float)(s->center[0] + x) + p.displacement[0];
        s->positions[3 * at + 1] = p.height_m;
        s->positions[3 * at + 2] = (float)(s->center[1] + z) + p.displacement[1];
        memcpy(s->normals + 3 * at, shape.normal, sizeof shape.normal);
        s->uvs[2 * at] = (float)(0.5 + 0.5 * x / s->half_m);
        s->uvs[2 * at + 1] = (float)(0.5 + 0.5 * z / s->half_m);
    }
}

static void fill_rows(void *context, size_t begin, size_t end)
{
    for (size_t row = begin; row < end; row++)
        fill_row(context, (uint32_t)row);
}

/* Two triangles per quad, facing up. */
static void fill_indices(uint32_t columns, uint32_t rows, uint32_t *indices)
{
    for (uint32_t row = 0; row + 1 < rows; row++)
        for (uint32_t column = 0; column + 1 < columns; column++) {
            uint32_t a = row * columns + column, b = a + columns;
            const uint32_t corners[6] = {a, b, a + 1, a + 1, b, b + 1};
            memcpy(indices, corners, sizeof corners);
            indices += 6;
        }
}

static void bound(scene_primitive *p)
{
    for (int k = 0; k < 3; k++) {
        p->bounds_min[k] = p->bounds_max[k] = p->positions[k];
        for (uint32_t i = 1; i < p->vertex_count; i++) {
            float x = p->positions[3 * (size_t)i + (size_t)k];
            p->bounds_min[k] = fminf(p->bounds_min[k], x);
            p->bounds_max[k] = fmaxf(p->bounds_max[k], x);
        }
    }
}

/* Allocates columns x rows vertices and their triangles; false: out of memory. */
static bool allocate(arena *memory, uint32_t samples, scene_primitive *p, float **positions, float **normals,
                     float **uvs)
{
    size_t vertices = (size_t)samples * samples, indices = 6 * (size_t)(samples - 1) * (samples - 1);
    const float **sets = arena_zalloc(memory, 1, sizeof *sets);
    uint32_t *triangles = arena_alloc(memory, indices, sizeof *triangles);
    *positions = arena_alloc(memory, vertices, 3 * sizeof(float));
    *normals = arena_alloc(memory, vertices, 3 * sizeof(float));
    *uvs = arena_alloc(memory, vertices, 2 * sizeof(float));
    if (!sets || !triangles || !*positions || !*normals || !*uvs)
        return false;
    fill_indices(samples, samples, triangles);
    sets[0] = *uvs;
    *p = (scene_primitive){.mode = SCENE_TRIANGLES,
                           .vertex_count = (uint32_t)vertices,
                           .index_count = (uint32_t)indices,
                           .indices = triangles,
                           .positions = *positions,
                           .normals = *normals,
                           .texcoord_count = 1,
                           .texcoords = sets};
    return true;
}

static bool make_surface(sheet *s, arena *memory, scene_primitive *p)
{
    if (!allocate(memory, s->samples, p, &s->positions, &s->normals, &s->uvs))
        return false;
    parallel_for(s->sea->desc.thread_count, s->samples, 4, fill_rows, s);
    bound(p);
    return true;
}

/* A plane of the surface's extent: the bed, or, without one, a plane below the deepest trough. */
static bool make_floor(const sheet *s, arena *memory, float depth_m, scene_primitive *p)
{
    const facet_sea_bed *bed = &s->sea->desc.bed;
    float *positions, *normals, *uvs;
    if (!allocate(memory, 2, p, &positions, &normals, &uvs))
        return false;
    double slope = sea_has_bed(bed) ? (double)bed->slope : 0.0;
    double ex = slope * cos((double)bed->direction_rad), ez = slope * sin((double)bed->direction_rad);
    double length = sqrt(1.0 + slope * slope);
    for (uint32_t i = 0; i < 4; i++) {
        double x = s->center[0] + (i % 2 ? s->half_m : -s->half_m);
        double z = s->center[1] + (i / 2 ? s->half_m : -s->half_m);
        const float position[3] = {(float)x, (float)(ex * x + ez * z) - depth_m, (float)z};
        const float normal[3] = {(float)(-ex / length), (float)(1.0 / length), (float)(-ez / length)};
        memcpy(positions + 3 * i, position, sizeof position);
        memcpy(normals + 3 * i, normal, sizeof normal);
        uvs[2 * i] = (float)(i % 2);
        uvs[2 * i + 1] = (float)(i / 2);
    }
    bound(p);
    return true;
}

/* ---- materials ---- */

/* Attenuation of nearly straight light: forward scattering does not count, only backscattering. */
static float attenuation(const facet_sea *sea, int channel)
{
    return sea->optics.absorption[channel] + sea->optics.backscattering[channel];
}

/* Roughness of slopes that vertices step_m apart do not resolve: alpha^2 is their variance. */
static float roughness_below(const facet_sea *sea, double step_m)
{
    const slope_filter *f = &sea->slopes;
    uint32_t i = (uint32_t)(slope_filter_place((float)step_m) + 0.5f);
    double variance = (double)f->residual[i].xx + (double)f->residual[i].zz;
    return (float)fmin(sqrt(sqrt(fmax(variance, 0.0))), 1.0);
}

static scene_material water_material(const facet_sea *sea, double step_m)
{
    scene_material m = scene_material_default();
    m.name = "water";
    m.extensions = SCENE_IOR | SCENE_TRANSMISSION | SCENE_VOLUME;
    m.metallic = 0.0f;
    m.perceptual_roughness = roughness_below(sea, step_m);
    m.ior = sea->optics.ior;
    m.transmission = 1.0f;
    m.thickness = sea_has_bed(&sea->desc.bed) ? sea->desc.bed.depth_m : DEEP_THICKNESS_M;
    m.attenuation_distance = 1.0f;
    for (int i = 0; i < 3; i++)
        m.attenuation_color[i] = expf(-attenuation(sea, i));
    return m;
}

/* Color of the bed, or one that looks like deep water through the water above it. */
static scene_material floor_material(const facet_sea *sea, float depth_m)
{
    scene_material m = scene_material_default();
    bool is_bed = sea_has_bed(&sea->desc.bed);
    m.name = is_bed ? "bed" : "deep water";
    m.metallic = 0.0f;
    double n = (double)sea->optics.ior, F0 = (n - 1.0) * (n - 1.0) / ((n + 1.0) * (n + 1.0));
    /* from just above the surface to just below */
    double below = n * n / ((1.0 - F0) * (1.0 - DIFFUSE_REFLECTANCE));
    for (int i = 0; i < 3; i++) {
        double gain = exp(2.0 * (double)attenuation(sea, i) * (double)depth_m);
        double deep = fmin((double)sea->optics.reflectance[i] * below * gain, 1.0);
        m.base_color[i] = is_bed ? sea->desc.bed.albedo[i] : (float)fmax(deep, 0.0);
    }
    m.perceptual_roughness = 1.0f;
    if (!is_bed) { /* transmits light everywhere */
        m.extensions |= SCENE_SPECULAR;
        m.specular = 0.0f;
    }
    return m;
}

/* ---- the scene ---- */

static facet_result check(const facet_sea_mesh_desc *d, facet_error *error)
{
    if (!(d->size_m >= 0.0f && d->size_m <= 1e6f))
        return fail(error, FACET_ERROR_ARGUMENT, "mesh: a size of %g m is not within (0, 1e6]",
                    (double)d->size_m);
    if (d->samples == 1 || d->samples > MAX_SAMPLES)
        return fail(error, FACET_ERROR_ARGUMENT, "mesh: %u samples along an edge are not within [2, %d]",
                    d->samples, MAX_SAMPLES);
    if (!(fabs(d->center_m[0]) <= 1e9 && fabs(d->center_m[1]) <= 1e9))
        return fail(error, FACET_ERROR_ARGUMENT, "mesh: its center is farther than 1e9 m away");
    if (d->refinement != 0.0f && !(d->refinement >= 1.0f && d->refinement <= 1000.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "mesh: a refinement of %g is not within [1, 1000]",
                    (double)d->refinement);
    return FACET_OK;
}

static bool add_node(facet_scene *scene, uint32_t i, const scene_primitive *p)
{
    scene_primitive *own = arena_alloc(scene->arena, 1, sizeof *own);
    if (!own)
        return false;
    *own = *p;
    own->material = i;
    const char *name = scene->materials[i].name;
    scene->meshes[i] = (scene_mesh){.name = name, .primitive_count = 1, .primitives = own};
    scene->nodes[i] = scene_node_default(name);
    scene->nodes[i].mesh = i;
    return true;
}

static bool fill(facet_scene *scene, sheet *s, bool has_floor)
{
    const facet_sea *sea = s->sea;
    uint32_t count = has_floor ? 2 : 1;
    scene->materials = arena_zalloc(scene->arena, count, sizeof *scene->materials);
    scene->meshes = arena_zalloc(scene->arena, count, sizeof *scene->meshes);
    scene->nodes = arena_zalloc(scene->arena, count, sizeof *scene->nodes);
    scene->scenes = arena_zalloc(scene->arena, 1, sizeof *scene->scenes);
    uint32_t *roots = arena_zalloc(scene->arena, 2, sizeof *roots);
    scene_primitive surface, ground;
    if (!scene->materials || !scene->meshes || !scene->nodes || !scene->scenes || !roots ||
        !make_surface(s, scene->arena, &surface))
        return false;
    float depth = sea_has_bed(&sea->desc.bed) ? sea->desc.bed.depth_m : 1.0f - surface.bounds_min[1];
    scene->materials[0] = water_material(sea, step_of(s, s->samples / 2));
    bool fits = add_node(scene, 0, &surface);
    if (fits && has_floor) {
        scene->materials[1] = floor_material(sea, depth);
        fits = make_floor(s, scene->arena, depth, &ground) && add_node(scene, 1, &ground);
    }
    roots[1] = 1;
    scene->scenes[0] =
        (scene_root){.name = "sea", .node_count = count, .nodes = roots, .image_light = SCENE_NONE};
    scene->material_count = scene->mesh_count = scene->node_count = count;
    scene->scene_count = 1;
    return fits;
}

facet_result sea_mesh_create(const facet_sea *sea, const facet_sea_mesh_desc *desc, facet_scene **out,
                             facet_error *error)
{
    *out = NULL;
    facet_result result = check(desc, error);
    if (result != FACET_OK)
        return result;
    facet_scene *scene = NULL;
    result = scene_create(&desc->allocator, "sea", &scene, error);
    if (result != FACET_OK)
        return result;
    double size = desc->size_m > 0.0f     ? (double)desc->size_m
                  : sea->waves.tile_count ? sea->waves.tiles[0].length_m
                                          : FLAT_SIZE_M;
    sheet s = {.sea = sea,
               .samples = desc->samples ? desc->samples : DEFAULT_SAMPLES,
               .half_m = 0.5 * size,
               .center = {desc->center_m[0], desc->center_m[1]},
               .bend = bend_of((double)desc->refinement)};
    scene->generator = "facet";
    scene->version = "2.0";
    if (!fill(scene, &s, !desc->omits_bed)) {
        scene_destroy(scene);
        return fail_memory(error, "mesh of a sea",
                           (size_t)s.samples * s.samples * (8 * sizeof(float) + 6 * sizeof(uint32_t)));
    }
    scene->thread_count = sea->desc.thread_count;
    *out = scene;
    return FACET_OK;
}
