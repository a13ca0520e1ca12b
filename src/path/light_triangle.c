/* light_triangle.c - see light_triangle.h. Spherical triangles are computed in double: their angles come close to those of
 * plane ones, from which their area is the difference. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "path/light_triangle.h"

/* From this area on, in squares of the distance to the middle. Below, distances and angles to its points differ by a tenth
 * at most, and points cost a fifth of directions. */
static const float NEAR_AREA = 0.01f;
static const double LEAST_SOLID_ANGLE = 1e-6; /* sr; below it is seen edge on */

typedef struct direction {
    double x, y, z;
} direction;

static double inner(direction a, direction b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static direction outer(direction a, direction b)
{
    return (direction){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* a s + b t */
static direction combined(direction a, double s, direction b, double t)
{
    return (direction){a.x * s + b.x * t, a.y * s + b.y * t, a.z * s + b.z * t};
}

static direction unit(direction a)
{
    double length2 = inner(a, a);
    double scale = length2 > 0.0 ? 1.0 / (sqrt)(length2) : 0.0;
    return (direction){a.x * scale, a.y * scale, a.z * scale};
}

static direction direction_of(vec3 v)
{
    return unit((direction){(double)v[0], (double)v[1], (double)v[2]});
}

static double within(double x, double low, double high)
{
    return x > low ? x < high ? x : high : low;
}

/* ---- spherical triangles ---- */

typedef struct spherical_triangle {
    direction a, b, c;
    double solid_angle; /* sr */
} spherical_triangle;

/* False: it is too small for P to bother, or degenerate. The solid angle: Van Oosterom and Strackee 1983, "The Solid Angle of
 * a Plane Triangle". */
static bool is_near(const light_triangle *t, vec3 P, spherical_triangle *s)
{
    vec3 to = t->corner - P;
    vec3 middle = to + (t->edge1 + t->edge2) * (1.0f / 3.0f);
    if (!(light_triangle_area(t) > NEAR_AREA * dot(middle, middle)))
        return false;
    s->a = direction_of(to);
    s->b = direction_of(to + t->edge1);
    s->c = direction_of(to + t->edge2);
    double volume = inner(s->a, outer(s->b, s->c));
    double sum = 1.0 + inner(s->a, s->b) + inner(s->b, s->c) + inner(s->c, s->a);
    s->solid_angle = 2.0 * atan2(fabs(volume), sum);
    return s->solid_angle > LEAST_SOLID_ANGLE;
}

/* A uniform direction: the triangle is cut from b so that the part at a has the share u[0] of its area, and the cut is gone
 * along by u[1]. Arvo 1995. */
static direction sample_spherical(const spherical_triangle *s, vec2 u)
{
    direction normal_ab = unit(outer(s->a, s->b));
    direction normal_ac = unit(outer(s->a, s->c));
    double cos_alpha = within(inner(normal_ab, normal_ac), -1.0, 1.0);
    direction across = outer(normal_ab, normal_ac);
    double sin_alpha = (sqrt)(inner(across, across));
    double alpha = atan2(sin_alpha, cos_alpha);
    double phi = (double)u[0] * s->solid_angle - alpha; /* of the part: beta - pi */
    double cos_phi = (cos)(phi);
    double sin_phi = (sin)(phi);
    double p = cos_phi - cos_alpha;
    double q = sin_phi + sin_alpha * inner(s->a, s->b);
    double cos_b = ((q * cos_phi - p * sin_phi) * cos_alpha - q) / ((q * sin_phi + p * cos_phi) * sin_alpha);
    cos_b = isnan(cos_b) ? 1.0 : within(cos_b, -1.0, 1.0);
    direction side = unit(combined(s->c, 1.0, s->a, -inner(s->c, s->a)));
    direction end = combined(s->a, cos_b, side, (sqrt)(1.0 - cos_b * cos_b));
    double z = 1.0 - (double)u[1] * (1.0 - inner(end, s->b));
    direction along = unit(combined(end, 1.0, s->b, -inner(end, s->b)));
    return combined(s->b, z, along, (sqrt)(fmax(1.0 - z * z, 0.0)));
}

/* ---- both ---- */

/* Heitz 2019, "A Low-Distortion Map Between Triangle and Square". */
static vec2 uniform_point(vec2 u)
{
    if (u[1] > u[0])
        return vec2(0.5f * u[0], u[1] - 0.5f * u[0]);
    return vec2(u[0] - 0.5f * u[1], 0.5f * u[1]);
}

/* distance^2 / (area |cos|). */
static float area_pdf(const light_triangle *t, vec3 d, float distance_m)
{
    return 2.0f * distance_m * distance_m / abs(dot(cross(t->edge1, t->edge2), d));
}

/* Where the ray from P along w meets the plane of the triangle, kept inside of it. Moeller and Trumbore 1997. */
static bool meet(const light_triangle *t, vec3 P, direction w, light_triangle_point *out)
{
    direction e1 = {(double)t->edge1[0], (double)t->edge1[1], (double)t->edge1[2]};
    direction e2 = {(double)t->edge2[0], (double)t->edge2[1], (double)t->edge2[2]};
    vec3 from = P - t->corner;
    direction s = {(double)from[0], (double)from[1], (double)from[2]};
    direction h = outer(w, e2);
    double determinant = inner(e1, h);
    direction q = outer(s, e1);
    double u = within(inner(s, h) / determinant, 0.0, 1.0);
    double v = within(inner(w, q) / determinant, 0.0, 1.0 - u);
    double distance = inner(e2, q) / determinant;
    out->u = (float)u;
    out->v = (float)v;
    out->distance_m = (float)distance;
    out->L = vec3((float)w.x, (float)w.y, (float)w.z);
    return fabs(determinant) > 0.0 && distance > 0.0 && isfinite(distance);
}

bool light_triangle_sample(const light_triangle *t, vec3 P, vec2 u, light_triangle_point *out)
{
    spherical_triangle s;
    if (is_near(t, P, &s)) {
        out->pdf = (float)(1.0 / s.solid_angle);
        return meet(t, P, sample_spherical(&s, u), out);
    }
    vec2 weights = uniform_point(u);
    vec3 to = t->corner + t->edge1 * weights[0] + t->edge2 * weights[1] - P;
    out->u = weights[0];
    out->v = weights[1];
    out->distance_m = length(to);
    if (!(out->distance_m > 1e-15f)) /* its square has no digits */
        return false;
    out->L = to * (1.0f / out->distance_m);
    out->pdf = area_pdf(t, out->L, out->distance_m);
    return out->pdf > 0.0f && out->pdf < INFINITY;
}

float light_triangle_pdf(const light_triangle *t, vec3 P, vec3 d, float distance_m)
{
    spherical_triangle s;
    if (is_near(t, P, &s))
        return (float)(1.0 / s.solid_angle);
    float pdf = area_pdf(t, d, distance_m);
    return pdf < INFINITY ? pdf : 0.0f;
}
