/* view_rig.c - see view_rig.h. */
#include "view/view_rig.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/result.h"
#include "scene/scene.h"
#include "view/view_terms.h"

static const double degree = 3.14159265358979323846 / 180.0;
static const double nearest = 2.2; /* radii of the sphere around the model: the closest eye */
static const double default_scale = 1.05;
static const double default_fov = 30.0, least_fov = 12.0; /* degrees */

static const char usual_orbit[] = "0deg 75deg 105%";

static const char *const names[VIEW_RIG_TEXT_COUNT] = {
    "field-of-view",    "camera-target",    "min-field-of-view", "max-field-of-view",
    "min-camera-orbit", "max-camera-orbit", "camera-orbit",      "rotation-per-second"};

void view_rig_create(view_rig *rig)
{
    *rig = (view_rig){.aspect = 1.0, .fov_rad = default_fov * degree};
    view_motion_create(&rig->motion);
    for (int i = 0; i < VIEW_RIG_TEXT_COUNT; i++)
        strcpy(rig->texts[i], "auto");
    strcpy(rig->texts[VIEW_RIG_ORBIT], usual_orbit);
}

/* What percentages and auto mean. Returns how many words the text has. */
static uint32_t terms_of(const view_rig *rig, view_rig_text which, view_term terms[3])
{
    const double pi = 180.0 * degree;
    double ideal = view_framing_distance(&rig->framing, rig->fov_rad);
    switch (which) {
    case VIEW_RIG_ORBIT:
        terms[0] = (view_term){VIEW_UNIT_ANGLE, 0.0, 0.0};
        terms[1] = (view_term){VIEW_UNIT_ANGLE, 75.0 * degree, 75.0 * degree};
        terms[2] = (view_term){VIEW_UNIT_LENGTH, ideal, default_scale * ideal};
        return 3;
    case VIEW_RIG_MIN_ORBIT:
        terms[0] = (view_term){VIEW_UNIT_ANGLE, -HUGE_VAL, -HUGE_VAL};
        terms[1] = (view_term){VIEW_UNIT_ANGLE, 0.0, 0.0};
        terms[2] =
            (view_term){VIEW_UNIT_LENGTH, nearest * rig->framing.radius, nearest * rig->framing.radius};
        return 3;
    case VIEW_RIG_MAX_ORBIT:
        terms[0] = (view_term){VIEW_UNIT_ANGLE, HUGE_VAL, HUGE_VAL};
        terms[1] = (view_term){VIEW_UNIT_ANGLE, pi, pi};
        terms[2] = (view_term){VIEW_UNIT_LENGTH, default_scale * ideal, default_scale * ideal};
        return 3;
    case VIEW_RIG_TARGET:
        for (int i = 0; i < 3; i++) {
            double middle = 0.5 * (rig->framing.low[i] + rig->framing.high[i]) + rig->origin[i];
            terms[i] = (view_term){VIEW_UNIT_LENGTH, middle, middle};
        }
        return 3;
    case VIEW_RIG_MIN_FOV:
        terms[0] = (view_term){VIEW_UNIT_ANGLE, least_fov * degree, least_fov * degree};
        return 1;
    case VIEW_RIG_RATE:
        terms[0] = (view_term){VIEW_UNIT_ANGLE, pi / 32.0, pi / 32.0};
        return 1;
    default:
        terms[0] = (view_term){VIEW_UNIT_ANGLE, default_fov * degree, default_fov * degree};
        return 1;
    }
}

static double shown_fov(const view_rig *rig, double fov_rad)
{
    return view_framing_fov(&rig->framing, fmin(fmax(fov_rad, 0.01), 3.0), rig->aspect);
}

static void to_scene(const view_rig *rig, const double point[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = point[i] - rig->origin[i];
}

/* Values of the text, and what follows from them. */
static facet_result apply(view_rig *rig, view_rig_text which, const char *text, facet_error *error)
{
    view_term terms[3];
    double v[3] = {0.0, 0.0, 0.0};
    double low[VIEW_AXIS_TARGET] = {VIEW_UNSET, VIEW_UNSET, VIEW_UNSET, VIEW_UNSET},
           high[VIEW_AXIS_TARGET] = {VIEW_UNSET, VIEW_UNSET, VIEW_UNSET, VIEW_UNSET};
    double goal[VIEW_AXIS_COUNT] = {VIEW_UNSET, VIEW_UNSET, VIEW_UNSET, VIEW_UNSET,
                                    VIEW_UNSET, VIEW_UNSET, VIEW_UNSET};
    uint32_t count = terms_of(rig, which, terms);
    TRY(view_terms_read(names[which], text, terms, count, rig->scroll, v, error));
    switch (which) {
    case VIEW_RIG_ORBIT:
        memcpy(goal, v, sizeof v);
        break;
    case VIEW_RIG_TARGET:
        to_scene(rig, v, goal + VIEW_AXIS_TARGET);
        break;
    case VIEW_RIG_MIN_ORBIT:
        memcpy(low, v, sizeof v);
        break;
    case VIEW_RIG_MAX_ORBIT:
        memcpy(high, v, sizeof v);
        break;
    case VIEW_RIG_FOV:
        rig->fov_rad = fmin(fmax(v[0], 0.01), 3.0);
        goal[VIEW_AXIS_LOG_FOV] = log(shown_fov(rig, v[0]));
        break;
    case VIEW_RIG_MIN_FOV:
        low[VIEW_AXIS_LOG_FOV] = log(fmax(v[0], 1e-3));
        break;
    case VIEW_RIG_MAX_FOV:
        high[VIEW_AXIS_LOG_FOV] = log(shown_fov(rig, v[0]));
        break;
    default:
        rig->motion.rotation_rad_s = v[0];
        break;
    }
    view_motion_limit(&rig->motion, low, high);
    view_motion_aim(&rig->motion, goal);
    for (int i = 0; i < VIEW_AXIS_COUNT; i++)
        if (!isnan(goal[i]))
            rig->home[i] = rig->motion.goal[i];
    return FACET_OK;
}

facet_result view_rig_set(view_rig *rig, const char *name, const char *text, facet_error *error)
{
    int which = 0;
    while (which < VIEW_RIG_TEXT_COUNT && strcmp(names[which], name) != 0)
        which++;
    if (which == VIEW_RIG_TEXT_COUNT)
        return fail(error, FACET_ERROR_ARGUMENT, "%.60s is no attribute of the camera", name);
    if (strlen(text) >= VIEW_RIG_TEXT_SIZE)
        return fail(error, FACET_ERROR_ARGUMENT, "%s has more than %d characters", name,
                    VIEW_RIG_TEXT_SIZE - 1);
    TRY(apply(rig, (view_rig_text)which, text, error));
    snprintf(rig->texts[which], VIEW_RIG_TEXT_SIZE, "%s", text);
    bool is_limit = which != VIEW_RIG_ORBIT && which != VIEW_RIG_TARGET && which != VIEW_RIG_FOV;
    if (is_limit && rig->is_framed)
        view_motion_jump(&rig->motion);
    return FACET_OK;
}

bool view_rig_set_number(view_rig *rig, const char *name, double value)
{
    if (strcmp(name, "scroll") != 0)
        return view_motion_set(&rig->motion, name, value);
    rig->scroll = isfinite(value) ? fmin(fmax(value, 0.0), 1.0) : 0.0;
    return isfinite(value);
}

/* The target, which the text may say in parts of the bounds. */
static facet_result measure(view_rig *rig, const facet_scene *scene, const facet_pose_desc *pose,
                            double target[3], facet_error *error)
{
    view_term terms[3];
    double point[3];
    memcpy(rig->origin, scene->origin, sizeof rig->origin);
    TRY(view_framing_measure(scene, pose, NULL, rig->fov_rad, &rig->framing, error));
    terms_of(rig, VIEW_RIG_TARGET, terms);
    TRY(view_terms_read(names[VIEW_RIG_TARGET], rig->texts[VIEW_RIG_TARGET], terms, 3, rig->scroll, point,
                        error));
    to_scene(rig, point, target);
    if (memcmp(target, rig->framing.target, sizeof rig->framing.target) == 0)
        return FACET_OK;
    return view_framing_measure(scene, pose, target, rig->fov_rad, &rig->framing, error);
}

facet_result view_rig_frame(view_rig *rig, const facet_scene *scene, const facet_pose_desc *pose,
                            bool keeps_direction, facet_error *error)
{
    /* Limits before what they limit. */
    static const view_rig_text order[] = {VIEW_RIG_MAX_FOV,   VIEW_RIG_MIN_FOV,   VIEW_RIG_FOV,
                                          VIEW_RIG_MIN_ORBIT, VIEW_RIG_MAX_ORBIT, VIEW_RIG_ORBIT,
                                          VIEW_RIG_TARGET};
    double target[3];
    double direction[VIEW_AXIS_COUNT] = {VIEW_UNSET, VIEW_UNSET, VIEW_UNSET, VIEW_UNSET,
                                         VIEW_UNSET, VIEW_UNSET, VIEW_UNSET};
    TRY(apply(rig, VIEW_RIG_FOV, rig->texts[VIEW_RIG_FOV], error));
    TRY(measure(rig, scene, pose, target, error));
    if (keeps_direction && rig->was_aimed)
        memcpy(direction, rig->motion.now, 2 * sizeof *direction);
    memcpy(rig->motion.center, rig->framing.target, sizeof rig->motion.center);
    rig->motion.reach = rig->framing.radius;
    for (size_t i = 0; i < sizeof order / sizeof *order; i++)
        TRY(apply(rig, order[i], rig->texts[order[i]], error));
    view_motion_aim(&rig->motion, direction);
    view_motion_jump(&rig->motion);
    rig->is_framed = rig->was_aimed = true;
    return FACET_OK;
}

void view_rig_set_aspect(view_rig *rig, double aspect)
{
    if (aspect == rig->aspect || !(aspect > 0.0))
        return;
    double zoom = exp(rig->motion.goal[VIEW_AXIS_LOG_FOV]) / shown_fov(rig, rig->fov_rad);
    rig->aspect = aspect;
    if (!rig->is_framed)
        return;
    (void)apply(rig, VIEW_RIG_MAX_FOV, rig->texts[VIEW_RIG_MAX_FOV], NULL); /* it was read before */
    rig->home[VIEW_AXIS_LOG_FOV] = log(shown_fov(rig, rig->fov_rad));
    double goal[VIEW_AXIS_COUNT] = {
        VIEW_UNSET, VIEW_UNSET, VIEW_UNSET, log(zoom * shown_fov(rig, rig->fov_rad)),
        VIEW_UNSET, VIEW_UNSET, VIEW_UNSET};
    /* a field of view beyond the limit was asked for by number: view_rig_follow() */
    rig->motion.high[VIEW_AXIS_LOG_FOV] = fmax(rig->motion.high[VIEW_AXIS_LOG_FOV], goal[VIEW_AXIS_LOG_FOV]);
    view_motion_aim(&rig->motion, goal);
    rig->motion.now[VIEW_AXIS_LOG_FOV] = rig->motion.goal[VIEW_AXIS_LOG_FOV];
    rig->motion.velocity[VIEW_AXIS_LOG_FOV] = 0.0;
}

/* Nothing but "auto", or the orbit's default. */
static bool is_usual(view_rig_text which, const char *text)
{
    if (which == VIEW_RIG_ORBIT && strcmp(text, usual_orbit) == 0)
        return true;
    while (strncmp(text, "auto", 4) == 0)
        text += 4 + strspn(text + 4, " ");
    return !*text;
}

bool view_rig_home(const view_rig *rig, facet_orbit *out)
{
    view_motion home = rig->motion;
    for (int i = 0; i < VIEW_RIG_RATE; i++)
        if (!is_usual((view_rig_text)i, rig->texts[i]))
            return false;
    memcpy(home.now, rig->home, sizeof home.now);
    view_motion_place(&home, out);
    return rig->is_framed && rig->motion.turntable_rad == 0.0;
}

void view_rig_follow(view_rig *rig, const facet_orbit *orbit)
{
    const double values[VIEW_AXIS_COUNT] = {(double)orbit->azimuth_rad + rig->motion.turntable_rad,
                                            (double)orbit->polar_rad,
                                            (double)orbit->radius,
                                            log((double)orbit->fov_y_rad),
                                            (double)orbit->target[0],
                                            (double)orbit->target[1],
                                            (double)orbit->target[2]};
    /* Limits are for hands; what is asked for by number is shown. */
    for (int i = 0; i < VIEW_AXIS_TARGET; i++) {
        rig->motion.low[i] = fmin(rig->motion.low[i], values[i]);
        rig->motion.high[i] = fmax(rig->motion.high[i], values[i]);
    }
    view_motion_aim(&rig->motion, values);
    view_motion_jump(&rig->motion);
    rig->was_aimed = true;
}

void view_rig_look_at(view_rig *rig, const double *point)
{
    double goal[VIEW_AXIS_COUNT] = {VIEW_UNSET, VIEW_UNSET, VIEW_UNSET, VIEW_UNSET,
                                    VIEW_UNSET, VIEW_UNSET, VIEW_UNSET};
    rig->motion.idle_s = 0.0;
    if (point) {
        to_scene(rig, point, goal + VIEW_AXIS_TARGET);
        view_motion_aim(&rig->motion, goal);
        return;
    }
    (void)apply(rig, VIEW_RIG_TARGET, rig->texts[VIEW_RIG_TARGET], NULL); /* it was read before */
    view_motion_zoom(&rig->motion, 25.0);
}

void view_rig_set_pivot(view_rig *rig, const double point[3])
{
    double inside[3];
    to_scene(rig, point, inside);
    view_motion_set_pivot(&rig->motion, inside);
}
