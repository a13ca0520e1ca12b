/* settle.c - see settle.h. */
#include "scene/settle.h"

#include <float.h>

#include "scene/material_table.h"

static float clamp_to(float value, float minimum, float maximum)
{
    return value < minimum ? minimum : value > maximum ? maximum : value;
}

static bool overlaps(size_t offset, size_t size, size_t other, size_t other_size)
{
    return offset < other + other_size && other < offset + size;
}

void scene_settle_material(scene_material *material, size_t offset, size_t size)
{
    for (int i = 0; i < MATERIAL_PARAMETER_COUNT; i++) {
        const material_parameter *row = &material_parameters[i];
        if (!overlaps(offset, size, row->offset, row->count * sizeof(float)) ||
            (row->extension && !(row->extension & material->extensions)))
            continue;
        float *values = material_floats(material, row);
        for (uint32_t k = 0; k < row->count; k++)
            values[k] = clamp_to(values[k], row->minimum, row->maximum);
    }
    for (size_t i = 0; i < SCENE_TEXTURE_SLOT_COUNT; i++)
        if (overlaps(offset, size, offsetof(scene_material, textures) + i * sizeof *material->textures,
                     sizeof *material->textures))
            scene_texture_ref_update(&material->textures[i]);
}

void scene_settle_light(scene_light *light)
{
    const float right_angle = 1.57079633f;
    for (int i = 0; i < 3; i++)
        light->color[i] = clamp_to(light->color[i], 0.0f, FLT_MAX);
    light->intensity = clamp_to(light->intensity, 0.0f, FLT_MAX);
    light->range = clamp_to(light->range, 0.0f, FLT_MAX);
    light->outer_cone_rad = clamp_to(light->outer_cone_rad, 0.0f, right_angle);
    light->inner_cone_rad = clamp_to(light->inner_cone_rad, 0.0f, light->outer_cone_rad);
}

void scene_settle_camera(scene_camera *camera, const scene_camera *rest)
{
    if (!(camera->fov_y_rad > 0.0f && camera->fov_y_rad < 3.14f))
        camera->fov_y_rad = rest->fov_y_rad;
    if (!(camera->aspect >= 0.0f))
        camera->aspect = rest->aspect;
    if (!(camera->ortho_height > 0.0f))
        camera->ortho_height = rest->ortho_height;
    if (!(camera->ortho_width > 0.0f))
        camera->ortho_width = rest->ortho_width;
    if (!(camera->near_m >= 0.0f && camera->far_m >= 0.0f) ||
        (camera->far_m != 0.0f && !(camera->far_m > camera->near_m))) {
        camera->near_m = rest->near_m;
        camera->far_m = rest->far_m;
    }
}
