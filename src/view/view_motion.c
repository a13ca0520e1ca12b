/* view_motion.c - see view_motion.h. */
#include "view/view_motion.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
static const double zoom_step = 0.04; /* of a key, in ln of the field of view */
static const double pan_step = 10.0;  /* of a key, pixels */

void view_motion_create(view_motion *m)
{
    const double degree = pi / 180.0;
    *m = (view_motion){.goal = {0.0, 75.0 * degree, 1.0, log(30.0 * degree)},
                       .low = {-HUGE_VAL, 0.0, 0.0, log(12.0 * degree)},
                       .high = {HUGE_VAL, pi, HUGE_VAL, log(120.0 * degree)},
                       .reach = HUGE_VAL,
                       .decay_s = 0.05,
                       .orbit_sensitivity = 1.0,
                       .zoom_sensitivity = 1.0,
                       .pan_sensitivity = 1.0,
                       .input_sensitivity = 1.0,
                       .rotation_rad_s = pi / 32.0,
                       .rotation_delay_s = 3.0};
    for (int i = 0; i < 3; i++) {
        m->low[VIEW_AXIS_TARGET + i] = -HUGE_VAL;
        m->high[VIEW_AXIS_TARGET + i] = HUGE_VAL;
    }
    view_motion_jump(m);
}

bool view_motion_set(view_motion *m, const char *name, double value)
{
    const struct {
        const char *name;
        double *number;
        bool *flag;
    } table[] = {{"decay", &m->decay_s, NULL},
                 {"orbit-sensitivity", &m->orbit_sensitivity, NULL},
                 {"zoom-sensitivity", &m->zoom_sensitivity, NULL},
                 {"pan-sensitivity", &m->pan_sensitivity, NULL},
                 {"input-sensitivity", &m->input_sensitivity, NULL},
                 {"auto-rotate-delay", &m->rotation_delay_s, NULL},
                 {"rotation-per-second", &m->rotation_rad_s, NULL},
                 {"turntable", &m->turntable_rad, NULL},
                 {"auto-rotate", NULL, &m->rotates},
                 {"reduced", NULL, &m->is_reduced}};
    for (size_t i = 0; isfinite(value) && i < sizeof table / sizeof *table; i++) {
        if (strcmp(table[i].name, name) != 0)
            continue;
        if (table[i].number) {
            *table[i].number = value;
        } else {
            *table[i].flag = value != 0.0;
            m->idle_s = 0.0;
        }
        return true;
    }
    return false;
}

/* ---- the goal ---- */

static bool is_azimuth_free(const view_motion *m)
{
    return isinf(m->low[VIEW_AXIS_AZIMUTH]) && isinf(m->high[VIEW_AXIS_AZIMUTH]);
}

/* Where the limits exclude each other, the upper one wins. */
static double clamp(double value, double low, double high)
{
    return fmin(fmax(value, low), high);
}

void view_motion_aim(view_motion *m, const double goal[VIEW_AXIS_COUNT])
{
    for (int i = 0; i < VIEW_AXIS_COUNT; i++)
        if (!isnan(goal[i]) && !isinf(goal[i]))
            m->goal[i] = clamp(goal[i], m->low[i], m->high[i]);
    double *now = &m->now[VIEW_AXIS_AZIMUTH];
    if (is_azimuth_free(m))
        *now = m->goal[VIEW_AXIS_AZIMUTH] + remainder(*now - m->goal[VIEW_AXIS_AZIMUTH], 2.0 * pi);
}

void view_motion_limit(view_motion *m, const double low[VIEW_AXIS_TARGET],
                       const double high[VIEW_AXIS_TARGET])
{
    for (int i = 0; i < VIEW_AXIS_TARGET; i++) {
        m->low[i] = isnan(low[i]) ? m->low[i] : low[i];
        m->high[i] = isnan(high[i]) ? m->high[i] : high[i];
        m->goal[i] = clamp(m->goal[i], m->low[i], m->high[i]);
    }
}

void view_motion_jump(view_motion *m)
{
    memcpy(m->now, m->goal, sizeof m->now);
    memset(m->velocity, 0, sizeof m->velocity);
}

/* ---- input ---- */

static void set_goal(view_motion *m, view_axis axis, double value)
{
    if (isfinite(value))
        m->goal[axis] = clamp(value, m->low[axis], m->high[axis]);
    m->idle_s = 0.0;
}

/* The goal stays less than half a turn ahead of the camera, so that the glide goes where the drag went. */
void view_motion_turn(view_motion *m, double dx, double dy, double height)
{
    double per_pixel = 2.0 * pi / fmax(height, 1.0) * m->orbit_sensitivity * m->input_sensitivity;
    double most = pi - 1e-3;
    double ahead = m->goal[VIEW_AXIS_AZIMUTH] - m->now[VIEW_AXIS_AZIMUTH];
    set_goal(m, VIEW_AXIS_AZIMUTH, m->now[VIEW_AXIS_AZIMUTH] + clamp(ahead - dx * per_pixel, -most, most));
    set_goal(m, VIEW_AXIS_POLAR, m->goal[VIEW_AXIS_POLAR] - dy * per_pixel);
}

typedef struct basis {
    double right[3], up[3], back[3];
} basis;

static basis basis_of(const view_motion *m)
{
    double azimuth = m->now[VIEW_AXIS_AZIMUTH] - m->turntable_rad; /* in the space of the model */
    double sa = sin(azimuth), ca = cos(azimuth);
    double sp = sin(m->now[VIEW_AXIS_POLAR]), cp = cos(m->now[VIEW_AXIS_POLAR]);
    return (basis){{ca, 0.0, -sa}, {-cp * sa, sp, -cp * ca}, {sp * sa, cp, sp * ca}};
}

/* Into the sphere around what was framed, so that the model cannot be lost. */
static void hold_target(view_motion *m)
{
    double *target = &m->goal[VIEW_AXIS_TARGET];
    double length = sqrt((target[0] - m->center[0]) * (target[0] - m->center[0]) +
                         (target[1] - m->center[1]) * (target[1] - m->center[1]) +
                         (target[2] - m->center[2]) * (target[2] - m->center[2]));
    for (int i = 0; i < 3 && length > m->reach; i++)
        target[i] = m->center[i] + (target[i] - m->center[i]) * m->reach / length;
}

void view_motion_pan(view_motion *m, double dx, double dy, double height)
{
    basis b = basis_of(m);
    double per_pixel = 2.0 * m->now[VIEW_AXIS_RADIUS] * tan(0.5 * view_motion_fov(m)) / fmax(height, 1.0) *
                       m->pan_sensitivity * m->input_sensitivity;
    for (int i = 0; i < 3; i++)
        set_goal(m, (view_axis)(VIEW_AXIS_TARGET + i),
                 m->goal[VIEW_AXIS_TARGET + i] + per_pixel * (dy * b.up[i] - dx * b.right[i]));
    hold_target(m);
}

/* Radius and field of view reach their limits together: the rest of one changes as the rest of the other. */
void view_motion_zoom(view_motion *m, double steps)
{
    double change = steps * zoom_step * m->zoom_sensitivity * m->input_sensitivity;
    const double *limits = change > 0.0 ? m->high : m->low;
    double *goal = m->goal;
    if (change == 0.0)
        return;
    double ratio = (limits[VIEW_AXIS_RADIUS] - goal[VIEW_AXIS_RADIUS]) /
                   (limits[VIEW_AXIS_LOG_FOV] - goal[VIEW_AXIS_LOG_FOV]);
    if (!isfinite(ratio)) /* at a limit of the field of view, or the radius has none */
        ratio = isfinite(m->high[VIEW_AXIS_RADIUS])
                    ? 2.0 * (m->high[VIEW_AXIS_RADIUS] - m->low[VIEW_AXIS_RADIUS])
                    : goal[VIEW_AXIS_RADIUS];
    set_goal(m, VIEW_AXIS_RADIUS, goal[VIEW_AXIS_RADIUS] + change * ratio);
    set_goal(m, VIEW_AXIS_LOG_FOV, goal[VIEW_AXIS_LOG_FOV] + change);
}

void view_motion_set_pivot(view_motion *m, const double point[3])
{
    basis b = basis_of(m);
    double along = 0.0;
    for (int i = 0; i < 3; i++)
        along += b.back[i] * (point[i] - m->goal[VIEW_AXIS_TARGET + i]);
    for (int i = 0; i < 3; i++)
        set_goal(m, (view_axis)(VIEW_AXIS_TARGET + i), m->goal[VIEW_AXIS_TARGET + i] + along * b.back[i]);
    set_goal(m, VIEW_AXIS_RADIUS, m->goal[VIEW_AXIS_RADIUS] - along);
}

void view_motion_step(view_motion *m, view_step step, bool pans, double height)
{
    static const struct {
        double x, y, zoom;
    } steps[VIEW_STEP_COUNT] = {[VIEW_STEP_LEFT] = {-1.0, 0.0, 0.0}, [VIEW_STEP_RIGHT] = {1.0, 0.0, 0.0},
                                [VIEW_STEP_UP] = {0.0, -1.0, 0.0},   [VIEW_STEP_DOWN] = {0.0, 1.0, 0.0},
                                [VIEW_STEP_IN] = {0.0, 0.0, -1.0},   [VIEW_STEP_OUT] = {0.0, 0.0, 1.0}};
    double x = steps[step].x;
    double y = steps[step].y;
    if (steps[step].zoom != 0.0)
        view_motion_zoom(m, steps[step].zoom);
    else if (pans)
        view_motion_pan(m, x * pan_step, y * pan_step, height);
    else
        view_motion_turn(m, x, y, 16.0); /* a sixteenth of the height: pi / 8 */
}

/* ---- time ---- */

/* The size against which a remaining distance is invisible. */
static double scale_of(const view_motion *m, int axis)
{
    switch (axis) {
    case VIEW_AXIS_AZIMUTH:
    case VIEW_AXIS_POLAR:
        return pi;
    case VIEW_AXIS_LOG_FOV:
        return 1.0;
    default:
        return 0.1 * m->goal[VIEW_AXIS_RADIUS];
    }
}

/* A critically damped spring with d'' = -2 w d' - w^2 d for the distance d from the goal: d = (d0 + (v0 + w d0) t) e^(-w t).
 * It ends where what remains is invisible. */
static bool glide(view_motion *m, int axis, double seconds)
{
    double distance = m->now[axis] - m->goal[axis];
    if (distance == 0.0 && m->velocity[axis] == 0.0)
        return false;
    double rate = 1.0 / m->decay_s;
    double slope = m->velocity[axis] + rate * distance;
    double decay = exp(-rate * seconds);
    double next = (distance + slope * seconds) * decay;
    double velocity = slope * decay - rate * next;
    if (fabs(next) + fabs(velocity) * m->decay_s < 2e-4 * scale_of(m, axis))
        next = velocity = 0.0;
    m->now[axis] = m->goal[axis] + next;
    m->velocity[axis] = velocity;
    return true;
}

static bool turn_table(view_motion *m, double seconds)
{
    m->idle_s += seconds;
    if (!m->rotates || m->is_reduced || m->rotation_rad_s == 0.0)
        return false;
    double turning = fmin(seconds, m->idle_s - m->rotation_delay_s);
    if (!(turning > 0.0))
        return false;
    m->turntable_rad = remainder(m->turntable_rad + turning * m->rotation_rad_s, 2.0 * pi);
    return true;
}

bool view_motion_advance(view_motion *m, double seconds)
{
    bool moved = false;
    if (!(seconds > 0.0))
        return false;
    if (m->is_reduced || !(m->decay_s > 0.0)) {
        moved = view_motion_is_gliding(m);
        view_motion_jump(m);
    }
    for (int axis = 0; axis < VIEW_AXIS_COUNT; axis++)
        moved = glide(m, axis, seconds) || moved;
    return turn_table(m, seconds) || moved;
}

bool view_motion_is_gliding(const view_motion *m)
{
    for (int axis = 0; axis < VIEW_AXIS_COUNT; axis++)
        if (m->now[axis] != m->goal[axis] || m->velocity[axis] != 0.0)
            return true;
    return false;
}

bool view_motion_is_moving(const view_motion *m)
{
    return view_motion_is_gliding(m) || (m->rotates && !m->is_reduced && m->rotation_rad_s != 0.0);
}

/* ---- what is seen ---- */

double view_motion_fov(const view_motion *m)
{
    return exp(m->now[VIEW_AXIS_LOG_FOV]);
}

void view_motion_place(const view_motion *m, facet_orbit *orbit)
{
    orbit->azimuth_rad = (float)remainder(m->now[VIEW_AXIS_AZIMUTH] - m->turntable_rad, 2.0 * pi);
    orbit->polar_rad = (float)m->now[VIEW_AXIS_POLAR];
    orbit->radius = (float)m->now[VIEW_AXIS_RADIUS];
    orbit->fov_y_rad = (float)view_motion_fov(m);
    orbit->has_target = true;
    for (int i = 0; i < 3; i++)
        orbit->target[i] = (float)m->now[VIEW_AXIS_TARGET + i];
}

const char *view_motion_side(const view_motion *m)
{
    static const char *const names[3][4] = {{"upper-front", "upper-right", "upper-back", "upper-left"},
                                            {"front", "right", "back", "left"},
                                            {"lower-front", "lower-right", "lower-back", "lower-left"}};
    double quarter = floor(m->now[VIEW_AXIS_AZIMUTH] / (0.5 * pi) + 0.5);
    double third = floor(3.0 * m->now[VIEW_AXIS_POLAR] / pi);
    return names[third < 0.0   ? 0
                 : third > 2.0 ? 2
                               : (int)third][(int)(quarter - 4.0 * floor(quarter / 4.0)) & 3];
}
