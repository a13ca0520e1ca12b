/* view_frame.c - how a view_state comes to show the whole model: at once, in all of its motion. */
#include <math.h>

#include "scene/scene.h"
#include "view/view_state.h"

facet_result view_state_frame(view_state *s, float aspect, facet_error *error)
{
    if (!s->needs_framing || s->camera != VIEW_NO_CAMERA)
        return FACET_OK;
    facet_camera camera;
    facet_orbit wanted = s->orbit;
    wanted.fits_all_times = s->pose.animation_count > 0;
    facet_result result = scene_fit_orbit(s->scene, &s->pose, &wanted, aspect, &camera, error);
    if (result != FACET_OK)
        return result;
    s->framing = s->orbit;
    facet_orbit *o = &s->orbit;
    double distance2 = 0.0;
    for (int i = 0; i < 3; i++) {
        double d = (double)camera.eye[i] - (double)camera.target[i];
        o->target[i] = camera.target[i];
        distance2 += d * d;
    }
    o->radius = o->is_orthographic
                    ? (float)(0.5 * (double)camera.ortho_height / tan(0.5 * (double)o->fov_y_rad))
                    : (float)sqrt(distance2);
    o->has_target = true;
    s->needs_framing = false;
    s->is_framed = true;
    return FACET_OK;
}

void view_state_show_whole(view_state *s)
{
    facet_orbit whole = scene_orbit_default();
    view_state_leave_file_camera(s);
    whole.azimuth_rad = s->orbit.azimuth_rad;
    whole.polar_rad = s->orbit.polar_rad;
    whole.is_orthographic = s->orbit.is_orthographic;
    whole.is_z_up = s->orbit.is_z_up;
    whole.fov_y_rad = s->orbit.fov_y_rad;
    s->orbit = whole;
    s->needs_framing = true;
}

void view_state_follow_motion(view_state *s)
{
    if (!s->is_framed || s->needs_framing)
        return;
    bool is_orthographic = s->orbit.is_orthographic;
    s->orbit = s->framing;
    s->orbit.is_orthographic = is_orthographic;
    s->needs_framing = true;
}
