/* camera_api.c - cameras of facet.h. */
#include "base/result.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

facet_orbit facet_orbit_default(void)
{
    return scene_orbit_default();
}

facet_result facet_camera_from_orbit(const facet_scene *scene, const facet_pose_desc *pose_desc,
                                     const facet_orbit *orbit, float aspect, facet_camera *camera,
                                     facet_error *error)
{
    return scene_fit_orbit(scene, pose_desc, orbit, aspect, camera, error);
}

facet_result facet_camera_from_scene(const facet_scene *scene, const facet_pose_desc *pose_desc,
                                     uint32_t index, facet_camera *camera, facet_error *error)
{
    *camera = (facet_camera){0};
    if (index >= scene->camera_count)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: there is no camera %u; the file has %u", scene->source,
                    index, scene->camera_count);
    scene_pose pose;
    facet_result result =
        scene_pose_create(scene, pose_desc, &scene->allocator, scene->thread_count, &pose, error);
    if (result != FACET_OK)
        return result;
    const scene_posed_camera *found = NULL;
    for (uint32_t i = 0; i < pose.camera_count && !found; i++)
        if (pose.cameras[i].index == index)
            found = &pose.cameras[i];
    if (found) {
        const scene_camera *c = &found->camera;
        const float *m = found->world.m;
        *camera = (facet_camera){.fov_y_rad = c->is_orthographic ? 0.0f : c->fov_y_rad,
                                 .ortho_height = c->ortho_height,
                                 .aspect = c->is_orthographic ? c->ortho_width / c->ortho_height : c->aspect,
                                 .near_m = c->near_m,
                                 .far_m = c->far_m};
        double length =
            sqrt((double)m[8] * (double)m[8] + (double)m[9] * (double)m[9] + (double)m[10] * (double)m[10]);
        /* far from the origin a target 1 m away would be the eye, rounded */
        double distance =
            fmax(1.0, fmax(fabs((double)m[12]), fmax(fabs((double)m[13]), fabs((double)m[14]))));
        for (int k = 0; k < 3; k++) {
            camera->eye[k] = m[12 + k];
            camera->target[k] = (float)((double)m[12 + k] - distance * (double)m[8 + k] / length);
            camera->up[k] = m[4 + k];
        }
        if (!(length > 0.0))
            result = fail(error, FACET_ERROR_INVALID,
                          "%s: camera %u \"%s\": the matrix of its node gives it no direction", scene->source,
                          index, c->name);
    } else {
        result =
            fail(error, FACET_ERROR_ARGUMENT, "%s: camera %u \"%s\" is not attached to a node of the scene",
                 scene->source, index, scene->cameras[index].name);
    }
    scene_pose_destroy(&pose);
    return result;
}
