/* facet/camera.h - cameras: given directly, framing a model from an orbit, or from the model's file. */
#ifndef FACET_CAMERA_H
#define FACET_CAMERA_H

#include "base.h"
#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A camera in world space (facet_scene_get_origin()). */
typedef struct facet_camera {
    float eye[3];        /* m */
    float target[3];     /* m; any point in front of the camera on its axis */
    float up[3];         /* not parallel to the axis; {0}: +Y, or -Z for a camera that looks along Y */
    float fov_y_rad;     /* vertical field of view; 0: orthographic with ortho_height */
    float ortho_height;  /* m, full height of the image */
    float aspect;        /* width / height that the camera was made for; 0: that of the image */
    float near_m, far_m; /* clipping distances along the axis; 0: none */
    /* of a thin lens, FACET_RENDERER_KIND_PATH only; 0: a pinhole without depth of field */
    float lens_radius_m;
    float focus_m; /* focus distance along the axis; 0: that of target */
} facet_camera;

/* A camera on a sphere around a target, in the convention of <model-viewer>. Start from
 * facet_orbit_default(). */
typedef struct facet_orbit {
    float azimuth_rad;  /* around +Y; 0: from +Z, positive: towards +X */
    float polar_rad;    /* from +Y; 0: looks straight down, pi/2: level */
    float radius;       /* m; 0: radius_scale times the radius that frames the model */
    float radius_scale; /* 1: the model touches the border of the image */
    float target[3];    /* m, where has_target */
    bool has_target;    /* false: the center of the bounds */
    bool is_orthographic;
    float fov_y_rad;
    bool is_z_up; /* the model has +Z up; the camera rises along it */
    /* radius 0: frames the model from every azimuth, so that its size stays in a turntable */
    bool fits_all_azimuths;
    /* frames (and targets the center of) the whole motion of the pose's animations, not only time_s */
    bool fits_all_times;
    /* counts parts so far away that they would shrink the rest to a dot; false: they are left out of
     * center and distance, and log gets a warning */
    bool includes_far_parts;
    facet_log log;
} facet_orbit;

/* Azimuth 0, polar angle 75 degrees, radius_scale 1.05, field of view 30 degrees. */
FACET_API facet_orbit facet_orbit_default(void);

/* The camera of an orbit around what pose shows (NULL: {0}), for an image of that aspect (width / height).
 * Framing counts every vertex, not only the corners of the bounds, except invisible ones (of triangles
 * without area or of opacity 0). */
FACET_API facet_result facet_camera_from_orbit(const facet_scene *scene, const facet_pose_desc *pose,
                                               const facet_orbit *orbit, float aspect, facet_camera *camera,
                                               facet_error *error);
/* Camera index of the file, at its first node of the pose's scene. */
FACET_API facet_result facet_camera_from_scene(const facet_scene *scene, const facet_pose_desc *pose,
                                               uint32_t index, facet_camera *camera, facet_error *error);

#ifdef __cplusplus
}
#endif

#endif
