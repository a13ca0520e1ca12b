/* legacy.c - see legacy.h. */
#include "scene/legacy.h"

#include <math.h>

legacy_map legacy_map_default(void)
{
    return (legacy_map){
        .ref = {.texture = SCENE_NONE, .scale = {1, 1}, .transform = {1, 0, 0, 0, 1, 0}},
        .gain = 1.0f,
        .bump_multiplier = 1.0f,
    };
}

legacy_material legacy_material_default(void)
{
    legacy_material m = {
        .name = "",
        .diffuse = {0.8f, 0.8f, 0.8f},
        .opacity = 1.0f,
        .illum = -1,
        .is_lit = true,
        .is_smooth = true,
        .has_fog = true,
        .ior = 1.0f,
        .transmission_filter = {1, 1, 1},
        .sharpness = 60.0f,
    };
    for (int i = 0; i < LEGACY_MAP_COUNT; i++)
        m.maps[i] = legacy_map_default();
    return m;
}

void legacy_light_direction(float theta_rad, float phi_rad, float out[3])
{
    /* (0, 0, 1) turned by -phi about x is (0, sin phi, cos phi). */
    double theta = (double)theta_rad;
    double phi = (double)phi_rad;
    out[0] = (float)(sin(theta) * cos(phi));
    out[1] = (float)sin(phi);
    out[2] = (float)(cos(theta) * cos(phi));
}

legacy_light legacy_light_default(void)
{
    legacy_light light = {
        .is_viewpoint_relative = true, .ambient = {1, 1, 1}, .diffuse = {1, 1, 1}, .specular = {1, 1, 1}};
    legacy_light_direction(0.0f, 15.0f * 0.017453292f, light.position);
    return light;
}

bool legacy_lacks_images(const legacy_material *m)
{
    for (int slot = 0; slot < LEGACY_MAP_COUNT; slot++) {
        bool has_counterpart = slot != LEGACY_AMBIENT_MAP && slot != LEGACY_DISPLACEMENT_MAP &&
                               slot != LEGACY_DECAL_MAP && slot != LEGACY_REFLECTION_MAP;
        if (has_counterpart && m->maps[slot].is_left_out)
            return true;
    }
    return false;
}

bool scene_has_legacy_materials(const facet_scene *scene)
{
    return scene->legacy && (scene->legacy->is_source ||
                             (scene->conversion && scene->conversion->to == FACET_MATERIAL_MODEL_OGL1));
}
