/* view_camera.c - see view_camera.h. */
#include "view/view_camera.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

/* Where an orbit looks from, as in scene/fit.c. */
typedef struct view_axes {
    double right[3], up[3], back[3];
} view_axes;

/* From +Y up to +Z up: a quarter turn around X. */
static void orient(const double y_up[3], bool is_z_up, double out[3])
{
    out[0] = y_up[0];
    out[1] = is_z_up ? -y_up[2] : y_up[1];
    out[2] = is_z_up ? y_up[1] : y_up[2];
}

static view_axes axes_of(const facet_orbit *o)
{
    double sa = sin((double)o->azimuth_rad);
    double ca = cos((double)o->azimuth_rad);
    double sp = sin((double)o->polar_rad);
    double cp = cos((double)o->polar_rad);
    view_axes axes;
    orient((const double[3]){ca, 0.0, -sa}, o->is_z_up, axes.right);
    orient((const double[3]){-cp * sa, sp, -cp * ca}, o->is_z_up, axes.up);
    orient((const double[3]){sp * sa, cp, sp * ca}, o->is_z_up, axes.back);
    return axes;
}

void view_camera_turn(facet_orbit *o, double dx, double dy, uint32_t height)
{
    double per_pixel = 2.0 * pi / (height ? height : 1);
    o->azimuth_rad = (float)remainder((double)o->azimuth_rad - dx * per_pixel, 2.0 * pi);
    o->polar_rad = (float)fmin(fmax((double)o->polar_rad - dy * per_pixel, 0.0), pi);
}

void view_camera_pan(facet_orbit *o, double dx, double dy, uint32_t height)
{
    view_axes axes = axes_of(o);
    double per_pixel = 2.0 * (double)o->radius * tan(0.5 * (double)o->fov_y_rad) / (height ? height : 1);
    for (int i = 0; i < 3; i++)
        o->target[i] += (float)(per_pixel * (dy * axes.up[i] - dx * axes.right[i]));
}

void view_camera_dolly(facet_orbit *o, double steps, double size)
{
    double radius = (double)o->radius * pow(0.9, steps);
    o->radius = (float)fmin(fmax(radius, 1e-4 * size), 1e3 * size);
}

void view_camera_look(facet_orbit *o, view_direction direction)
{
    static const struct {
        double azimuth, polar; /* degrees */
    } angles[] = {
        [VIEW_FRONT] = {0.0, 90.0},       [VIEW_BACK] = {180.0, 90.0}, [VIEW_RIGHT_SIDE] = {90.0, 90.0},
        [VIEW_LEFT_SIDE] = {-90.0, 90.0}, [VIEW_TOP] = {0.0, 0.0},     [VIEW_BOTTOM] = {0.0, 180.0},
        [VIEW_OBLIQUE] = {45.0, 55.0}};
    o->azimuth_rad = (float)(angles[direction].azimuth * pi / 180.0);
    o->polar_rad = (float)(angles[direction].polar * pi / 180.0);
}

facet_camera view_camera_of(const facet_orbit *o, float aspect, const float low[3], const float high[3])
{
    view_axes axes = axes_of(o);
    facet_camera camera = {.aspect = aspect};
    double distance = (double)o->radius;
    if (o->is_orthographic) {
        camera.ortho_height = (float)(2.0 * distance * tan(0.5 * (double)o->fov_y_rad));
        double reach = 0.0; /* of the bounds from the target */
        for (int i = 0; i < 3; i++) {
            double far = fmax(fabs((double)low[i] - (double)o->target[i]),
                              fabs((double)high[i] - (double)o->target[i]));
            reach += far * far;
        }
        distance = fmax(distance, 2.0 * sqrt(reach)); /* animation may leave the bounds */
    } else {
        camera.fov_y_rad = o->fov_y_rad;
    }
    for (int i = 0; i < 3; i++) {
        camera.target[i] = o->target[i];
        camera.eye[i] = (float)((double)o->target[i] + distance * axes.back[i]);
        camera.up[i] = (float)axes.up[i];
    }
    return camera;
}

/* To thousandths of a degree, as an option in degrees is read. */
static float round_angle(float radians)
{
    const double degree = 0.017453292519943295; /* pi / 180 */
    return (float)((round((double)radians / degree * 1e3) / 1e3 + 0.0) * degree);
}

/* To a multiple of 10^exponent; by division where that is exact. */
static float round_to(double value, int exponent)
{
    double unit = pow(10.0, abs(exponent));
    return (float)((exponent < 0 ? round(value * unit) / unit : round(value / unit) * unit) + 0.0);
}

facet_orbit view_camera_round(const facet_orbit *o)
{
    facet_orbit rounded = *o;
    rounded.azimuth_rad = round_angle(o->azimuth_rad);
    rounded.polar_rad = round_angle(o->polar_rad);
    if (!(o->radius > 0.0f))
        return rounded;
    int exponent = (int)floor(log10((double)o->radius)) - 5;
    rounded.radius = round_to((double)o->radius, exponent);
    for (int i = 0; i < 3; i++)
        rounded.target[i] = round_to((double)o->target[i], exponent);
    return rounded;
}

facet_orbit view_camera_orbit(const facet_camera *c, const facet_orbit *like, const float middle[3])
{
    facet_orbit o = *like;
    double back[3];
    double length2 = 0.0;
    for (int i = 0; i < 3; i++) {
        back[i] = (double)c->eye[i] - (double)c->target[i];
        length2 += back[i] * back[i];
    }
    double length = sqrt(length2);
    double along = 0.0; /* from the eye to the point of the axis nearest to the middle */
    for (int i = 0; i < 3; i++) {
        back[i] /= length;
        along += back[i] * ((double)c->eye[i] - (double)middle[i]);
    }
    o.radius = (float)(along > 1e-3 * length ? along : length);
    for (int i = 0; i < 3; i++)
        o.target[i] = (float)((double)c->eye[i] - (double)o.radius * back[i]);
    o.has_target = true;
    /* to +Y up */
    double y = o.is_z_up ? back[2] : back[1];
    double z = o.is_z_up ? -back[1] : back[2];
    o.polar_rad = (float)acos(fmin(fmax(y, -1.0), 1.0));
    if (fabs(y) < 0.999999)
        o.azimuth_rad = (float)atan2(back[0], z);
    o.is_orthographic = c->fov_y_rad == 0.0f;
    if (o.is_orthographic) /* the height determines the radius; the eye may be anywhere on its axis */
        o.radius = (float)(0.5 * (double)c->ortho_height / tan(0.5 * (double)o.fov_y_rad));
    else
        o.fov_y_rad = round_angle(c->fov_y_rad);
    return o;
}
