/* boundary_normal.c - see boundary_normal.h.
 *
 * On an arc from a to b the normals lean apart by the same angle at both ends. So along each edge the slopes of the two
 * normals against the triangle are replaced by one, of opposite sign at the ends: the smaller of the two, or 0 where they
 * disagree in sign (the minmod limiter, Roe 1986). What meshes of a smooth surface have stays as it is; a normal that
 * leans towards a sharp edge leans no more. */
#include "cpu/boundary_normal.h"
#include "cpu/shading_frame.h"
#include "cpu/volume_rays.h"

/* Normals that lean farther from the triangle count as this far. */
static const float LEAST_COS = 0.2f;

typedef struct corner_normals {
    vec3 Ng;       /* unit, outward */
    vec3 farthest; /* coordinates of the corners */
    vec3 slope[3]; /* in the plane of the triangle: normal = Ng + slope */
} corner_normals;

static float limit(float a, float b)
{
    if (!(a * b > 0.0f))
        return 0.0f;
    return abs(a) < abs(b) ? a : b;
}

/* The vector in the plane of the triangle whose dot products with e and f are a and b. */
static vec3 solve(vec3 e, vec3 f, float a, float b)
{
    float ee = dot(e, e);
    float ef = dot(e, f);
    float ff = dot(f, f);
    float determinant = ee * ff - ef * ef;
    if (!(determinant > 1e-12f * ee * ff))
        return vec3(0.0f);
    return e * ((a * ff - b * ef) / determinant) + f * ((b * ee - a * ef) / determinant);
}

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
    vec3 slope[3];
    for (int i = 0; i < 3; i++) {
        float corner[3];
        render_geometry_corner(h->geometry, h->corner[i], corner);
        p[i] = load3(corner);
        c.farthest = max(c.farthest, abs(p[i]));
        vec3 n = unit_normal(h->geometry, h->corner[i]);
        float cos_n = dot(n, Ng);
        slope[i] = (n - Ng * cos_n) * (1.0f / max(cos_n, LEAST_COS));
    }
    float along[3]; /* of the edge from i to i + 1 */
    for (int i = 0; i < 3; i++) {
        int k = (i + 1) % 3;
        vec3 edge = p[k] - p[i];
        along[i] = limit(-dot(slope[i], edge), dot(slope[k], edge));
    }
    for (int i = 0; i < 3; i++) {
        int next = (i + 1) % 3;
        int last = (i + 2) % 3;
        c.slope[i] = solve(p[next] - p[i], p[last] - p[i], -along[i], -along[last]);
    }
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
                           .tolerance = volume_rays_tolerance_of(max3(c.farthest)),
                           .dN_dx = change(&c, h->dx, n, N) * side,
                           .dN_dy = change(&c, h->dy, n, N) * side};
    /* What a normal texture adds is kept. */
    vec3 smooth = normalize_or(shading_frame_normal(h, s->is_front), out.Ng);
    out.N = normalize_or(N * side + (s->m.base.N - smooth), out.Ng);
    if (!(dot(out.N, s->V) > 1e-3f))
        out.N = out.Ng;
    return out;
}
