/* ray_bundle.c - see ray_bundle.h. Igehy 1999, "Tracing Ray Differentials". */
#include "cpu/ray_bundle.h"

/* A bundle does not open wider than this, in rad per footprint: beyond it (at the rim of a sphere) the linear changes
 * mean nothing. */
static const float WIDEST = 0.5f;

static vec3 bounded(vec3 v)
{
    float length2 = dot(v, v);
    if (!(length2 <= WIDEST * WIDEST))
        return length2 < 1e30f ? v * (WIDEST * inversesqrt(length2)) : vec3(0.0f);
    return v;
}

/* Where a neighbour of the ray meets the plane of the surface, as seen from the ray's hit. */
static vec3 change_of_position(vec3 dO, vec3 dD, float t, vec3 D, vec3 Ng)
{
    vec3 off = dO + dD * t;
    float cos_D = dot(D, Ng);
    return cos_D < -1e-4f ? off - D * (dot(off, Ng) / cos_D) : off;
}

bundle_hit ray_bundle_meet(const shading_ray *ray, const surface_point *s, const boundary_normal *normal)
{
    bundle_hit hit = {.P = s->P, .D = -s->V, .dN_dx = normal->dN_dx, .dN_dy = normal->dN_dy};
    const ray_spread *spread = ray->spread;
    vec3 d = load3(ray->direction);
    float inverse = inversesqrt(dot(d, d));
    float t = dot(s->P - load3(ray->origin), hit.D); /* m */
    vec3 dD[2] = {vec3(0.0f), vec3(0.0f)};
    vec3 dO[2] = {vec3(0.0f), vec3(0.0f)};
    for (int axis = 0; axis < 2; axis++) {
        if (spread->turns) {
            vec3 change =
                load3(axis ? spread->direction_dy : spread->direction_dx) * (ray->footprint * inverse);
            dD[axis] = change - hit.D * dot(hit.D, change);
        }
        if (spread->moves)
            dO[axis] = load3(axis ? spread->origin_dy : spread->origin_dx) * ray->footprint;
    }
    hit.dD_dx = dD[0];
    hit.dD_dy = dD[1];
    hit.dP_dx = change_of_position(dO[0], dD[0], t, hit.D, normal->Ng);
    hit.dP_dy = change_of_position(dO[1], dD[1], t, hit.D, normal->Ng);
    return hit;
}

static bundle_ray make_ray(const bundle_hit *hit, vec3 D, vec3 dD_dx, vec3 dD_dy)
{
    bundle_ray out = {.ray = {.far_t = INFINITY, .footprint = 1.0f},
                      .spread = {.moves = true, .turns = true}};
    store3(hit->P, out.ray.origin);
    store3(D, out.ray.direction);
    store3(hit->dP_dx, out.spread.origin_dx);
    store3(hit->dP_dy, out.spread.origin_dy);
    store3(bounded(dD_dx), out.spread.direction_dx);
    store3(bounded(dD_dy), out.spread.direction_dy);
    return out;
}

bundle_ray ray_bundle_pass(const bundle_hit *hit)
{
    return make_ray(hit, hit->D, hit->dD_dx, hit->dD_dy);
}

/* D' = eta D + m N with c = -D.N, c' = sqrt(1 - eta^2 (1 - c^2)) and m = eta c - c'; hence
 * dD' = eta dD + m dN + dm N,  dm = (eta - eta^2 c / c') dc,  dc = -(dD.N + D.dN). */
bool ray_bundle_refract(const bundle_hit *hit, vec3 N, float eta, bundle_ray *out)
{
    float c = -dot(hit->D, N);
    float k = 1.0f - eta * eta * (1.0f - c * c);
    if (!(k > 0.0f))
        return false;
    float c_t = sqrt(k);
    float m = eta * c - c_t;
    float dm = eta - eta * eta * c / max(c_t, 1e-3f);
    vec3 x = hit->dD_dx * eta + hit->dN_dx * m - N * (dm * (dot(hit->dD_dx, N) + dot(hit->D, hit->dN_dx)));
    vec3 y = hit->dD_dy * eta + hit->dN_dy * m - N * (dm * (dot(hit->dD_dy, N) + dot(hit->D, hit->dN_dy)));
    *out = make_ray(hit, normalize(hit->D * eta + N * m), x, y);
    return true;
}

/* D' = D + 2 c N. */
bundle_ray ray_bundle_reflect(const bundle_hit *hit, vec3 N)
{
    float c = -dot(hit->D, N);
    vec3 x = hit->dD_dx + (hit->dN_dx * c - N * (dot(hit->dD_dx, N) + dot(hit->D, hit->dN_dx))) * 2.0f;
    vec3 y = hit->dD_dy + (hit->dN_dy * c - N * (dot(hit->dD_dy, N) + dot(hit->D, hit->dN_dy))) * 2.0f;
    return make_ray(hit, normalize(hit->D + N * (2.0f * c)), x, y);
}

void ray_bundle_widen(bundle_ray *bundle, float angle_rad)
{
    ray_spread *spread = &bundle->spread;
    vec3 x = load3(spread->direction_dx);
    vec3 y = load3(spread->direction_dy);
    float least2 = angle_rad * angle_rad;
    if (dot(x, x) >= least2 && dot(y, y) >= least2)
        return;
    mat3 basis = basis_from_normal(load3(bundle->ray.direction));
    store3(COL(basis, 0) * max(sqrt(dot(x, x)), angle_rad), spread->direction_dx);
    store3(COL(basis, 1) * max(sqrt(dot(y, y)), angle_rad), spread->direction_dy);
}
