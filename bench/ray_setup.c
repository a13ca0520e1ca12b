/* ray_setup.c - see ray_setup.h. */
#include "ray_setup.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "io/gltf/gltf.h"

static facet_result look_at(ray_setup *s, const float minimum[3], const float maximum[3], facet_error *error)
{
    static const float offset[3] = {2.0f, 1.5f, 4.0f};
    facet_camera camera = {.fov_y_rad = 0.5236f};
    float radius = 0.0f;
    for (int i = 0; i < 3; i++) {
        camera.target[i] = 0.5f * (minimum[i] + maximum[i]);
        radius = fmaxf(radius, 0.5f * (maximum[i] - minimum[i]));
    }
    for (int i = 0; i < 3; i++)
        camera.eye[i] = camera.target[i] + offset[i] * radius;
    return camera_rays_create(&camera, s->size, s->size, &s->camera, error);
}

facet_result ray_setup_sphere(ray_setup *s, uint32_t columns, uint32_t rows, double amplitude,
                              facet_error *error)
{
    const size_t vertex_count = ((size_t)columns + 1) * (rows + 1);
    float *positions = mem_alloc(NULL, vertex_count + 1, 3 * sizeof(float));
    uint32_t *indices = mem_alloc(NULL, (size_t)columns * rows, 6 * sizeof(uint32_t));
    uint32_t count = 0;
    if (!positions || !indices)
        return fail_memory(error, "sphere", vertex_count * 3 * sizeof(float));
    for (uint32_t row = 0; row <= rows; row++)
        for (uint32_t column = 0; column <= columns; column++) {
            const double theta = 3.14159265358979 * row / rows;
            const double phi = 2.0 * 3.14159265358979 * column / columns;
            const double radius = 1.0 + amplitude * sin(9.0 * phi) * sin(7.0 * theta);
            const uint32_t i = row * (columns + 1) + column;
            positions[3 * i] = (float)(radius * sin(theta) * sin(phi));
            positions[3 * i + 1] = (float)(radius * cos(theta));
            positions[3 * i + 2] = (float)(radius * sin(theta) * cos(phi));
            if (row == rows || column == columns)
                continue;
            const uint32_t corners[6] = {i, i + columns + 1, i + 1, i + 1, i + columns + 1, i + columns + 2};
            memcpy(indices + count, corners, sizeof corners);
            count += 6;
        }
    s->sphere = (scene_primitive){.mode = SCENE_TRIANGLES,
                                  .vertex_count = (uint32_t)vertex_count,
                                  .index_count = count,
                                  .indices = indices,
                                  .positions = positions};
    s->material = scene_material_default();
    s->geometry = (render_geometry){.primitive = &s->sphere, .material = &s->material, .vertices = positions};
    s->set = (render_geometry_set){.count = 1, .items = &s->geometry};
    return look_at(s, (float[3]){-1, -1, -1}, (float[3]){1, 1, 1}, error);
}

facet_result ray_setup_load(ray_setup *s, const char *path, facet_error *error)
{
    const facet_allocator allocator = {0};
    TRY(gltf_load(path, &(facet_scene_desc){0}, &s->scene, error));
    TRY(scene_pose_create(s->scene, NULL, &allocator, 1, &s->pose, error));
    TRY(look_at(s, s->pose.bounds_min, s->pose.bounds_max, error));
    TRY(render_geometry_create(s->scene, &s->pose, &allocator, &s->set, error));
    return render_geometry_transform(&s->set, &s->pose, &s->camera, &allocator, 1, error);
}
