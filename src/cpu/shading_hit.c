/* shading_hit.c - see shading_hit.h. */
#include "cpu/shading_hit.h"

/* Weights of a ray o + t d by Moeller and Trumbore 1997, with s = o - p0:
 *     w1 = A.d / C.d,  w2 = B.d / C.d,   A = e2 x s,  B = s x e1,  C = e2 x e1
 * so that with changes do of the origin and dd of the direction
 *     dw1 = (A.dd - w1 C.dd + (e2 x do).d) / C.d,  dw2 = (B.dd - w2 C.dd + (do x e1).d) / C.d */
static void weight_derivatives(const shading_ray *ray, vec3 p0, vec3 e1, vec3 e2, shading_hit *h)
{
    vec3 d = h->direction;
    vec3 C = cross(e2, e1);
    float Cd = dot(C, d);
    if (!(Cd < 0.0f || Cd > 0.0f))
        return;
    float scale = ray->footprint / Cd;
    const ray_spread *spread = ray->spread;
    float *out[2] = {h->dx, h->dy};
    if (spread->turns) {
        vec3 s = load3(ray->origin) - p0;
        vec3 A = cross(e2, s);
        vec3 B = cross(s, e1);
        for (int i = 0; i < 2; i++) {
            vec3 step = load3(i ? spread->direction_dy : spread->direction_dx);
            float C_step = dot(C, step);
            out[i][0] = (dot(A, step) - h->weight[1] * C_step) * scale;
            out[i][1] = (dot(B, step) - h->weight[2] * C_step) * scale;
        }
    }
    if (spread->moves)
        for (int i = 0; i < 2; i++) {
            vec3 step = load3(i ? spread->origin_dy : spread->origin_dx);
            out[i][0] += dot(cross(e2, step), d) * scale;
            out[i][1] += dot(cross(step, e1), d) * scale;
        }
}

static vec3 corner(const render_geometry *g, size_t vertex)
{
    float p[3];
    render_geometry_corner(g, vertex, p);
    return load3(p);
}

shading_hit shading_hit_make(const shading_scene *scene, const shading_point *point)
{
    const visibility_hit *hit = point->hit;
    shading_hit h = {.geometry = &scene->geometries->items[hit->geometry]};
    vec3 origin = load3(point->ray->origin);
    h.direction = load3(point->ray->direction);
    const uint32_t *indices = h.geometry->primitive->indices;
    switch (h.geometry->primitive->mode) {
    case SCENE_TRIANGLES: {
        h.first_index = 3 * (size_t)hit->primitive;
        indices += h.first_index;
        for (int i = 0; i < 3; i++)
            h.corner[i] = indices[i];
        h.weight[0] = 1.0f - hit->u - hit->v;
        h.weight[1] = hit->u;
        h.weight[2] = hit->v;
        vec3 p0 = corner(h.geometry, h.corner[0]);
        vec3 e1 = corner(h.geometry, h.corner[1]) - p0;
        vec3 e2 = corner(h.geometry, h.corner[2]) - p0;
        h.position = p0 + e1 * hit->u + e2 * hit->v;
        if (scene->plans->items[hit->geometry].reads_changes || scene->has_specular_antialiasing)
            weight_derivatives(point->ray, p0, e1, e2, &h);
        break;
    }
    case SCENE_LINES:
        indices += 2 * (size_t)hit->primitive;
        h.corner[0] = indices[0];
        h.corner[1] = h.corner[2] = indices[1];
        h.weight[1] = clamp(hit->u, 0.0f, 1.0f);
        h.weight[0] = 1.0f - h.weight[1];
        h.position = origin + h.direction * hit->t;
        break;
    case SCENE_POINTS:
        h.corner[0] = h.corner[1] = h.corner[2] = indices[hit->primitive];
        h.weight[0] = 1.0f;
        h.position = origin + h.direction * hit->t;
        break;
    }
    return h;
}

vec3 shading_hit_vec3(const shading_hit *h, const float *attribute)
{
    return load3(attribute + 3 * h->corner[0]) * h->weight[0] +
           load3(attribute + 3 * h->corner[1]) * h->weight[1] +
           load3(attribute + 3 * h->corner[2]) * h->weight[2];
}

void shading_hit_color(const shading_hit *h, float out[4])
{
    const float *colors = h->geometry->primitive->colors;
    for (int i = 0; i < 4; i++)
        out[i] = colors ? colors[4 * h->corner[0] + (size_t)i] * h->weight[0] +
                              colors[4 * h->corner[1] + (size_t)i] * h->weight[1] +
                              colors[4 * h->corner[2] + (size_t)i] * h->weight[2]
                        : 1.0f;
}

shading_texcoord shading_hit_texcoord(const shading_hit *h, uint32_t set)
{
    shading_texcoord c = {0};
    if (set >= h->geometry->primitive->texcoord_count)
        return c;
    const float *uvs = h->geometry->primitive->texcoords[set];
    const float *a = uvs + 2 * h->corner[0];
    const float *b = uvs + 2 * h->corner[1];
    const float *d = uvs + 2 * h->corner[2];
    for (int i = 0; i < 2; i++) {
        float e1 = b[i] - a[i];
        float e2 = d[i] - a[i];
        c.uv[i] = a[i] + e1 * h->weight[1] + e2 * h->weight[2];
        c.dx[i] = e1 * h->dx[0] + e2 * h->dx[1];
        c.dy[i] = e1 * h->dy[0] + e2 * h->dy[1];
    }
    return c;
}
