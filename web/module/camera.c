/* camera.c - the camera of <facet-viewer>: a rig (view_rig.h) that places the orbit of the state for every frame. An option or a key
 * that moves the orbit otherwise is followed. */
#include <emscripten/emscripten.h>
#include <math.h>
#include <string.h>

#include "base/result.h"
#include "view/view_camera.h"
#include "view/view_terms.h"
#include "viewer.h"

static bool is_same(const facet_orbit *a, const facet_orbit *b)
{
    bool same = a->azimuth_rad == b->azimuth_rad && a->polar_rad == b->polar_rad && a->radius == b->radius &&
                a->fov_y_rad == b->fov_y_rad;
    for (int i = 0; i < 3; i++)
        same = same && a->target[i] == b->target[i];
    return same;
}

/* The orbit as the rig has it. */
static void place(viewer *v)
{
    view_motion_place(&v->rig.motion, &v->state.orbit);
    v->placed = v->state.orbit;
    v->state.needs_framing = v->state.is_framed = false;
}

/* Where the camera is before it is moved. */
static bool find_home(const viewer *v, facet_orbit *out)
{
    if (!view_rig_home(&v->rig, out))
        return false;
    if (v->frames_tightly)
        *out = v->tight_home;
    return true;
}

/* Whether the orbit differs from that of an unmoved camera by no more than its options show. */
static bool is_home(const viewer *v)
{
    const view_state *s = &v->state;
    facet_orbit home = s->orbit;
    if (s->camera != VIEW_NO_CAMERA || home.is_orthographic || home.is_z_up || !find_home(v, &home))
        return false;
    facet_orbit rounded = view_camera_round(&s->orbit);
    home = view_camera_round(&home);
    if (fabsf(rounded.fov_y_rad - home.fov_y_rad) < 1e-5f)
        rounded.fov_y_rad = home.fov_y_rad;
    return is_same(&rounded, &home);
}

bool web_camera_is_home(const viewer *v)
{
    return v->scene && !v->state.needs_framing && is_same(&v->state.orbit, &v->placed) && is_home(v);
}

/* An orbit that says nothing is left to the attributes, not to the framing of facet render. */
static bool is_usual(const facet_orbit *o)
{
    const facet_orbit usual = facet_orbit_default();
    return o->radius == 0.0f && o->radius_scale == usual.radius_scale && !o->has_target &&
           !o->is_orthographic && !o->is_z_up && o->azimuth_rad == usual.azimuth_rad &&
           o->polar_rad == usual.polar_rad && o->fov_y_rad == usual.fov_y_rad;
}

/* Takes over an orbit that is not the rig's. Before the first frame the rig waits. */
static facet_result follow(viewer *v, float aspect, facet_error *error)
{
    view_state *s = &v->state;
    if (!s->needs_framing && is_same(&s->orbit, &v->placed))
        return FACET_OK;
    bool goes_home = s->needs_framing && is_usual(&s->orbit);
    TRY(view_state_frame(s, aspect, error));
    if (!v->frames_tightly && (goes_home || is_home(v)))
        TRY(view_rig_frame(&v->rig, v->scene, &s->pose, false, error));
    else
        view_rig_follow(&v->rig, &s->orbit);
    place(v);
    if (goes_home && v->frames_tightly)
        v->tight_home = s->orbit;
    return FACET_OK;
}

/* Where facet render puts the camera, unless an attribute or the pointer has put it elsewhere. */
static void frame_tightly(viewer *v)
{
    facet_orbit home = v->state.orbit;
    if (!v->frames_tightly || v->state.camera != VIEW_NO_CAMERA || !view_rig_home(&v->rig, &home))
        return;
    v->state.orbit = facet_orbit_default();
    v->state.needs_framing = true;
}

facet_result web_camera_settle(viewer *v, facet_error *error)
{
    bool is_rigged = v->scene && v->rig.is_framed && v->state.camera == VIEW_NO_CAMERA;
    return is_rigged ? follow(v, (float)v->rig.aspect, error) : FACET_OK;
}

/* The model turns, not the light. */
static void turn_light(viewer *v, double by_rad)
{
    const double turn = 6.28318530717958647693;
    float *rotation = &v->state.render.environment_rotation_rad;
    if (by_rad != 0.0)
        *rotation = (float)remainder((double)*rotation - by_rad, turn);
}

facet_result web_camera_advance(viewer *v, uint32_t width, uint32_t height, double seconds,
                                facet_error *error)
{
    float aspect = (float)width / (float)(height ? height : 1);
    if (!v->scene || !v->rig.is_framed || v->state.camera != VIEW_NO_CAMERA)
        return FACET_OK;
    if (v->frames_tightly && (double)aspect != v->rig.aspect && web_camera_is_home(v)) {
        view_rig_set_aspect(&v->rig, (double)aspect);
        frame_tightly(v);
    }
    TRY(follow(v, aspect, error));
    double before = v->rig.motion.turntable_rad;
    view_rig_set_aspect(&v->rig, (double)aspect);
    view_motion_advance(&v->rig.motion, seconds);
    turn_light(v, v->rig.motion.turntable_rad - before);
    place(v);
    return FACET_OK;
}

bool web_camera_is_moving(const viewer *v)
{
    return v->scene && v->rig.is_framed && v->state.camera == VIEW_NO_CAMERA &&
           view_motion_is_moving(&v->rig.motion);
}

/* Before input: a camera of the file becomes an orbit. */
static void take_over(viewer *v)
{
    view_state_leave_file_camera(&v->state);
    (void)follow(v, (float)v->rig.aspect, NULL);
}

/* ---- attributes ---- */

/* Numbers of view_rig_set_number(). */
EMSCRIPTEN_KEEPALIVE int facet_web_set_motion(viewer *v, const char *name, double value)
{
    double before = v->rig.motion.turntable_rad;
    if (!view_rig_set_number(&v->rig, name, value))
        return fail(web_error(), FACET_ERROR_ARGUMENT, "%.60s=%g is no setting of the camera", name, value);
    turn_light(v, v->rig.motion.turntable_rad - before);
    return FACET_OK;
}

/* Texts of view_rig_set(). */
EMSCRIPTEN_KEEPALIVE int facet_web_set_camera(viewer *v, const char *name, const char *text)
{
    if (v->rig.is_framed)
        take_over(v);
    return view_rig_set(&v->rig, name, text, web_error());
}

/* Goes to what the attributes say, for an image of that size. */
EMSCRIPTEN_KEEPALIVE int facet_web_frame(viewer *v, int width, int height, bool keeps_direction)
{
    if (!v->scene)
        return fail(web_error(), FACET_ERROR_ARGUMENT, "there is no model to frame");
    view_rig_set_aspect(&v->rig, (double)width / (height > 0 ? height : 1));
    TRY(view_rig_frame(&v->rig, v->scene, &v->state.pose, keeps_direction, web_error()));
    place(v);
    frame_tightly(v);
    return FACET_OK;
}

/* How an unmoved camera shows the model: tightly, as facet render does, or so that it stays in view from every direction. */
EMSCRIPTEN_KEEPALIVE void facet_web_set_framing(viewer *v, bool is_tight)
{
    v->frames_tightly = is_tight;
}

/* Columns of the matrix that scales, then turns around Z, X and Y: roll, pitch and yaw (rad) of <model-viewer>. */
static void make_placement(const double turn[3], const double scale[3], float matrix[16])
{
    double sr = sin(turn[0]), cr = cos(turn[0]), sp = sin(turn[1]), cp = cos(turn[1]), sy = sin(turn[2]),
           cy = cos(turn[2]);
    const double columns[3][3] = {{cy * cr + sy * sp * sr, cp * sr, cy * sp * sr - sy * cr},
                                  {sy * sp * cr - cy * sr, cp * cr, cy * sp * cr + sy * sr},
                                  {sy * cp, -sp, cy * cp}};
    memset(matrix, 0, 16 * sizeof *matrix);
    for (int k = 0; k < 3; k++)
        for (int row = 0; row < 3; row++)
            matrix[4 * k + row] = (float)(scale[k] * columns[k][row]);
    matrix[15] = 1.0f;
}

/* The attributes orientation ("roll pitch yaw") and scale ("x y z"). The model is to be framed again. */
EMSCRIPTEN_KEEPALIVE int facet_web_place(viewer *v, const char *orientation, const char *scale)
{
    const view_term angle = {VIEW_UNIT_ANGLE, 0.0, 0.0}, factor = {VIEW_UNIT_LENGTH, 1.0, 1.0};
    const view_term angles[3] = {angle, angle, angle}, factors[3] = {factor, factor, factor};
    double turn[3], size[3];
    float matrix[16];
    if (!v->scene)
        return fail(web_error(), FACET_ERROR_ARGUMENT, "there is no model to place");
    TRY(view_terms_read("orientation", orientation, angles, 3, 0.0, turn, web_error()));
    TRY(view_terms_read("scale", scale, factors, 3, 0.0, size, web_error()));
    make_placement(turn, size, matrix);
    TRY(facet_scene_place(v->scene, matrix, web_error()));
    return web_model_find_bounds(v, web_error());
}

/* ---- input: view_motion.h ---- */

EMSCRIPTEN_KEEPALIVE void facet_web_turn(viewer *v, double dx, double dy, double height)
{
    take_over(v);
    view_motion_turn(&v->rig.motion, dx, dy, height);
}

EMSCRIPTEN_KEEPALIVE void facet_web_pan(viewer *v, double dx, double dy, double height)
{
    take_over(v);
    view_motion_pan(&v->rig.motion, dx, dy, height);
}

EMSCRIPTEN_KEEPALIVE void facet_web_zoom(viewer *v, double steps)
{
    take_over(v);
    view_motion_zoom(&v->rig.motion, steps);
}

EMSCRIPTEN_KEEPALIVE void facet_web_step(viewer *v, int step, bool pans, double height)
{
    take_over(v);
    if (step >= 0 && step < VIEW_STEP_COUNT)
        view_motion_step(&v->rig.motion, (view_step)step, pans, height);
}

EMSCRIPTEN_KEEPALIVE void facet_web_set_pivot(viewer *v, const double point[3])
{
    take_over(v);
    view_rig_set_pivot(&v->rig, point);
}

/* NULL: what camera-target says, from afar. */
EMSCRIPTEN_KEEPALIVE void facet_web_set_target(viewer *v, const double *point)
{
    take_over(v);
    view_rig_look_at(&v->rig, point);
}

EMSCRIPTEN_KEEPALIVE void facet_web_jump(viewer *v)
{
    view_motion_jump(&v->rig.motion);
}

/* The time of the running animation, s. */
EMSCRIPTEN_KEEPALIVE void facet_web_set_time(viewer *v, double seconds)
{
    if (isfinite(seconds))
        v->state.pose.time_s = seconds;
}

/* ---- queries ---- */

/* Azimuth, polar angle (rad), radius (m), field of view, its limits (degrees), target (m, file's world), turntable (rad), aspect
 * from which the model fits the height, low and high corner of the model at rest. */
EMSCRIPTEN_KEEPALIVE void facet_web_get_camera(viewer *v, double out[17])
{
    const double degree = 3.14159265358979323846 / 180.0;
    const view_motion *m = &v->rig.motion;
    const double *origin = v->rig.origin;
    memcpy(out, m->now, 3 * sizeof *out);
    out[3] = view_motion_fov(m) / degree;
    out[4] = exp(m->low[VIEW_AXIS_LOG_FOV]) / degree;
    out[5] = exp(m->high[VIEW_AXIS_LOG_FOV]) / degree;
    out[9] = m->turntable_rad;
    out[10] = v->rig.framing.aspect;
    for (int i = 0; i < 3; i++) {
        out[6 + i] = m->now[VIEW_AXIS_TARGET + i] + origin[i];
        out[11 + i] = v->rig.framing.low[i] + origin[i];
        out[14 + i] = v->rig.framing.high[i] + origin[i];
    }
}

/* view_motion_side(): a name that is never freed. */
EMSCRIPTEN_KEEPALIVE const char *facet_web_get_side(viewer *v)
{
    return view_motion_side(&v->rig.motion);
}

/* For a point of the surface: x and y in [0, 1] of the last frame from its top left, depth in m, and 1 or 0: it faces the
 * camera and is in front of it. */
EMSCRIPTEN_KEEPALIVE int facet_web_locate(viewer *v, const double position[3], const double normal[3],
                                          double out[4])
{
    double projected[4], facing = 0.0;
    TRY(web_draw_project(v, position, projected, web_error()));
    facet_camera camera = view_camera_of(&v->state.orbit, 1.0f, v->state.low, v->state.high);
    if (v->state.camera != VIEW_NO_CAMERA)
        camera = v->state.file_camera;
    for (int i = 0; i < 3; i++)
        facing += normal[i] * ((double)camera.eye[i] + v->rig.origin[i] - position[i]);
    out[0] = projected[0] / (v->state.width ? v->state.width : 1);
    out[1] = projected[1] / (v->state.height ? v->state.height : 1);
    out[2] = projected[2];
    out[3] = facing > 0.0 && projected[3] != 0.0;
    return FACET_OK;
}

/* Motion in a page may go on for ever, as that of animations does: a quarter of the resolution, in which models are hardly
 * recognized, is left to frames that take longer than this in half of it. */
static const double most_half_s = 0.125;

/* Whether the next frame is to be a draft, for facet_web_draw(). */
EMSCRIPTEN_KEEPALIVE bool facet_web_drafts(viewer *v, bool is_moving)
{
    return view_pace_drafts(&v->pace, is_moving);
}

/* After a frame that came that long after the one before (0: the first): by what to divide width and height of the next. */
EMSCRIPTEN_KEEPALIVE int facet_web_pace(viewer *v, bool is_moving, int divisor, double seconds)
{
    if (seconds > 0.0 && divisor > 0)
        view_pace_measure(&v->pace, (uint32_t)divisor, seconds);
    const int wanted = (int)view_pace_divisor(&v->pace, is_moving);
    return wanted > 2 && v->pace.full_s <= 4.0 * most_half_s ? 2 : wanted;
}
