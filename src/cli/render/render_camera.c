/* render_camera.c - see render_camera.h. */
#include "cli/render/render_camera.h"

#include "cli/shared/failure.h"

#include <math.h>

#define TWO_PI 6.283185307179586

static float aspect_of(const render_options *options)
{
    return (float)options->desc.width / (float)options->desc.height;
}

/* The target relative to the origin of the scene; coordinates that are not given are those of the
 * framing's center. */
static void resolve_target(const facet_scene *scene, const facet_pose_desc *pose,
                           const render_options *options, float target[3])
{
    facet_orbit orbit = options->orbit;
    facet_camera camera;
    double origin[3];
    orbit.has_target = false;
    orbit.is_orthographic = false;
    orbit.radius = 1.0f; /* only the center is needed */
    facet_camera_from_orbit(scene, pose, &orbit, aspect_of(options), &camera, NULL);
    facet_scene_get_origin(scene, origin);
    for (int i = 0; i < 3; i++)
        target[i] = options->has_target[i] ? (float)(options->target[i] - origin[i]) : camera.target[i];
}

facet_orbit render_orbit(const facet_scene *scene, const facet_pose_desc *pose, const render_options *options)
{
    facet_orbit orbit = options->orbit;
    orbit.has_target = options->has_target[0] || options->has_target[1] || options->has_target[2];
    if (orbit.has_target)
        resolve_target(scene, pose, options, orbit.target);
    return orbit;
}

static facet_orbit orbit_of_view(const facet_scene *scene, const render_view *view,
                                 const render_options *options)
{
    facet_orbit orbit = render_orbit(scene, view->pose, options);
    orbit.azimuth_rad += (float)(TWO_PI * view->turn);
    orbit.fits_all_azimuths = view->turns;
    orbit.fits_all_times = view->moves;
    return orbit;
}

static float distance(const float a[3], const float b[3])
{
    return hypotf(hypotf(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* A camera at --eye that looks at --target. */
static facet_result camera_from_eye(const facet_scene *scene, const facet_pose_desc *pose,
                                    const render_options *options, facet_camera *camera, facet_error *error)
{
    *camera = (facet_camera){.fov_y_rad = options->orbit.fov_y_rad};
    resolve_target(scene, pose, options, camera->target);
    double origin[3];
    facet_scene_get_origin(scene, origin);
    for (int i = 0; i < 3; i++)
        camera->eye[i] = (float)(options->eye[i] - origin[i]);
    float far_away = distance(camera->eye, camera->target);
    if (!(far_away > 0.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "--eye: the camera is at its target (%.9g,%.9g,%.9g)",
                    options->eye[0], options->eye[1], options->eye[2]);
    if (options->orbit.is_orthographic) {
        camera->ortho_height = 2.0f * far_away * tanf(0.5f * camera->fov_y_rad);
        camera->fov_y_rad = 0.0f;
    }
    for (int i = 0; i < 3; i++)
        camera->up[i] = options->up[i];
    if (options->orbit.is_z_up) {
        bool looks_along_z = fabsf(camera->target[2] - camera->eye[2]) > 0.99999f * far_away;
        camera->up[looks_along_z ? 1 : 2] = 1.0f;
    }
    return FACET_OK;
}

facet_result render_camera(const facet_scene *scene, const render_view *view, const render_options *options,
                           facet_camera *camera, facet_error *error)
{
    if (options->camera) {
        uint32_t index;
        facet_result result = facet_scene_find_camera(scene, options->camera, &index, error);
        if (result != FACET_OK)
            return result;
        return facet_camera_from_scene(scene, view->pose, index, camera, error);
    }
    if (options->has_eye)
        return camera_from_eye(scene, view->pose, options, camera, error);
    facet_orbit orbit = orbit_of_view(scene, view, options);
    return facet_camera_from_orbit(scene, view->pose, &orbit, aspect_of(options), camera, error);
}

void render_keep_framing(render_options *options, const facet_scene *scene, const facet_camera *camera)
{
    facet_orbit *orbit = &options->orbit;
    double origin[3];
    if (options->camera || options->has_eye)
        return;
    facet_scene_get_origin(scene, origin);
    for (int i = 0; i < 3; i++) {
        options->target[i] = (double)camera->target[i] + origin[i];
        options->has_target[i] = true;
    }
    orbit->radius = orbit->is_orthographic ? 0.5f * camera->ortho_height / tanf(0.5f * orbit->fov_y_rad)
                                           : distance(camera->eye, camera->target);
}
