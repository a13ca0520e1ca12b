/* path_key.c - see path_key.h. */
#include "path/path_key.h"

#include <stdio.h>

#include "base/result.h"
#include "base/text.h"
#include "cpu/prepared_scene.h"
#include "ibl/cache.h"
#include "ibl/environment.h"

/* Structs are hashed member by member: their padding is undefined. */

enum { LANES = 4 };

typedef struct key_state {
    uint64_t lanes[LANES];
} key_state;

static void add(key_state *k, const void *bytes, size_t size)
{
    for (int i = 0; i < LANES; i++)
        k->lanes[i] = cache_hash(k->lanes[i], bytes, size);
}

static void add_number(key_state *k, double x)
{
    add(k, &x, sizeof x);
}

static void add_numbers(key_state *k, const float *x, size_t count)
{
    for (size_t i = 0; i < count; i++)
        add_number(k, (double)x[i]);
}

static void add_camera(key_state *k, const facet_camera *c)
{
    add_numbers(k, c->eye, 3);
    add_numbers(k, c->target, 3);
    add_numbers(k, c->up, 3);
    const float rest[] = {c->fov_y_rad, c->ortho_height,  c->aspect, c->near_m,
                          c->far_m,     c->lens_radius_m, c->focus_m};
    add_numbers(k, rest, sizeof rest / sizeof *rest);
}

static void add_light(key_state *k, const facet_render_desc *desc)
{
    const facet_environment *e = desc->environment;
    add_number(k, e ? 1.0 : 0.0);
    if (e) {
        add_number(k, e->panorama.width);
        add(k, e->panorama.pixels, image_row_size(&e->panorama) * e->panorama.height);
    }
    add_number(k, (double)desc->environment_rotation_rad);
    add_number(k, (double)desc->environment_ev);
    const facet_sun *sun = &desc->sun;
    add_numbers(k, sun->illuminance_lux, 3);
    add_number(k, (double)sun->azimuth_rad);
    add_number(k, (double)sun->elevation_rad);
    add_number(k, (double)sun->diameter_rad);
}

static void add_desc(key_state *k, const facet_render_desc *desc)
{
    const facet_path_desc *path = &desc->path;
    const double values[] = {desc->width,
                             desc->height,
                             desc->crop[0],
                             desc->crop[1],
                             desc->crop[2],
                             desc->crop[3],
                             desc->ignores_scene_lights,
                             desc->background == FACET_BACKGROUND_ENVIRONMENT,
                             (double)desc->background_blur,
                             (double)desc->ground,
                             (double)desc->energy,
                             path->max_depth,
                             path->seed,
                             (double)path->filter,
                             (double)path->light_sampling,
                             (double)path->clamp,
                             path->has_straight_shadows,
                             (double)path->shutter_s};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        add_number(k, values[i]);
    if (desc->part.count && desc->part.split == FACET_PART_SPLIT_SAMPLES) {
        add_number(k, desc->part.index);
        add_number(k, desc->part.count);
    }
    if (desc->sea_shading.clamp > 0.0f) {
        add_number(k, (double)desc->sea_shading.clamp);
        add_number(k, (double)desc->exposure_ev);
    }
    add_camera(k, desc->camera);
    add_light(k, desc);
}

static facet_result add_description(key_state *k, const prepared_scene *p, facet_error *error)
{
    text description = {.allocator = p->allocator};
    scene_describe_json(p->scene, &description);
    bool has_memory = !description.has_failed;
    if (has_memory)
        add(k, description.data, description.length);
    text_destroy(&description);
    return has_memory ? FACET_OK : fail_memory(error, "description of the model", description.capacity);
}

/* Posed vertices and their attributes. */
static void add_instance(key_state *k, const scene_instance *instance)
{
    const scene_primitive *p = instance->primitive;
    size_t count = p->vertex_count;
    add(k, &instance->world, sizeof instance->world);
    add_number(k, instance->material);
    if (instance->is_copy)
        return;
    add(k, p->indices, p->index_count * sizeof *p->indices);
    add(k, instance->positions, 3 * count * sizeof(float));
    if (instance->normals)
        add(k, instance->normals, 3 * count * sizeof(float));
    for (uint32_t i = 0; i < p->texcoord_count; i++)
        add(k, p->texcoords[i], 2 * count * sizeof(float));
    if (p->colors)
        add(k, p->colors, 4 * count * sizeof(float));
}

static void add_scene(key_state *k, const facet_scene *scene, const scene_pose *pose)
{
    for (uint32_t i = 0; i < pose->instance_count; i++)
        add_instance(k, &pose->instances[i]);
    for (uint32_t i = 0; i < scene->image_count; i++)
        if (scene->images[i].bytes)
            add(k, scene->images[i].bytes, scene->images[i].size);
}

facet_result path_key_create(prepared_scene *p, const facet_render_desc *desc, path_key *out,
                             facet_error *error)
{
    key_state k = {.lanes = {1, 2, 3, 4}};
    TRY(prepared_scene_pose(p, desc, error));
    TRY(add_description(&k, p, error));
    add_scene(&k, p->scene, &p->pose);
    add_desc(&k, desc);
    for (int i = 0; i < LANES; i++)
        snprintf(out->hex + 16 * i, 17, "%016llx", (unsigned long long)k.lanes[i]);
    return FACET_OK;
}
