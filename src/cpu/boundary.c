/* boundary.c - see boundary.h. */
#include "cpu/boundary.h"
#include "cpu/media.h"
#include "draw/corner_slopes.h"

/* ---- the normal ---- */

typedef struct corner_normals {
    vec3 Ng;       /* unit, outward */
    vec3 farthest; /* coordinates of the corners */
    vec3 slope[3]; /* in the plane of the triangle: normal = Ng + slope */
} corner_normals;

static vec3 unit_normal(const render_geometry *g, size_t vertex)
{
    vec3 n = load3(g->normals + 3 * vertex);
    const float *m = g->normal_matrix;
    vec3 world = vec3(dot(load3(m), n), dot(load3(m + 3), n), dot(load3(m + 6), n));
    return normalize_or(world, vec3(0.0f));
}

static corner_normals corner_normals_of(const shading_hit *h, vec3 Ng)
{
    corner_normals c = {.Ng = Ng, .farthest = vec3(0.0f)};
    vec3 p[3];
    vec3 n[3];
    for (int i = 0; i < 3; i++) {
        float corner[3];
        render_geometry_corner(h->geometry, h->corner[i], corner);
        p[i] = load3(corner);
        c.farthest = max(c.farthest, abs(p[i]));
        n[i] = unit_normal(h->geometry, h->corner[i]);
    }
    corner_slopes(p, n, Ng, c.slope);
    return c;
}

/* The unit normal and, by the chain rule, its change. */
static vec3 interpolate(const corner_normals *c, const float w[3], vec3 *length_free)
{
    vec3 n = c->Ng + c->slope[0] * w[0] + c->slope[1] * w[1] + c->slope[2] * w[2];
    *length_free = n;
    return normalize(n);
}

static vec3 change(const corner_normals *c, const float dw[2], vec3 n, vec3 N)
{
    vec3 dn = (c->slope[1] - c->slope[0]) * dw[0] + (c->slope[2] - c->slope[0]) * dw[1];
    return (dn - N * dot(N, dn)) * inversesqrt(dot(n, n));
}

boundary_normal boundary_normal_at(const surface_point *s, const visibility_hit *hit)
{
    const shading_hit *h = &s->hit;
    float side = s->is_front ? 1.0f : -1.0f;
    vec3 Ng = normalize_or(load3(hit->normal), s->V) * (h->geometry->is_mirrored ? -1.0f : 1.0f);
    corner_normals c = corner_normals_of(h, Ng);
    vec3 n;
    vec3 N = interpolate(&c, h->weight, &n);
    boundary_normal out = {.Ng = Ng * side,
                           .tolerance = media_tolerance(max3(c.farthest)),
                           .dN_dx = change(&c, h->dx, n, N) * side,
                           .dN_dy = change(&c, h->dy, n, N) * side};
    /* The offset of the normal texture is kept. */
    vec3 smooth = normalize_or(shading_frame_normal(h, s->is_front), out.Ng);
    out.N = normalize_or(N * side + (s->m.base.N - smooth), out.Ng);
    if (!(dot(out.N, s->V) > 1e-3f))
        out.N = out.Ng;
    return out;
}

/* ---- bundles of rays: Igehy 1999, "Tracing Ray Differentials" ---- */

/* Largest opening of a bundle, rad per footprint: beyond it (at the silhouette of a sphere) linear
 * differentials are meaningless. */
static const float MAX_SPREAD = 0.5f;

static vec3 bounded(vec3 v)
{
    float length2 = dot(v, v);
    if (!(length2 <= MAX_SPREAD * MAX_SPREAD))
        return length2 < 1e30f ? v * (MAX_SPREAD * inversesqrt(length2)) : vec3(0.0f);
    return v;
}

/* The offset at which a neighbor of the ray hits the plane of the surface. */
static vec3 change_of_position(vec3 dO, vec3 dD, float t, vec3 D, vec3 Ng)
{
    vec3 off = dO + dD * t;
    float cos_D = dot(D, Ng);
    return cos_D < -1e-4f ? off - D * (dot(off, Ng) / cos_D) : off;
}

bundle_hit ray_bundle_hit(const shading_ray *ray, const surface_point *s, const boundary_normal *normal)
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
