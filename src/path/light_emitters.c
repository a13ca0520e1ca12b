/* light_emitters.c - see light_emitters.h. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "cpu/ray_trace.h"
#include "cpu/shading_hit.h"

#include "path/light_emitters.h"

/* ==== a triangle ==== */

/* Spherical triangles are computed in double: their angles are close to those of plane ones, from which
 * their area is the difference. */

/* Area of a triangle, relative to the squared distance to its middle, from which directions are sampled.
 * Below it distances and angles to its points differ by a tenth at most, and points cost a fifth of
 * directions. */
static const float NEAR_AREA = 0.1f;
static const double MIN_SOLID_ANGLE = 1e-6; /* sr; below it the triangle is seen edge on */

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
    double scale = length2 > 0.0 ? 1.0 / sqrt(length2) : 0.0;
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

/* False: the triangle is too small as seen from P, or degenerate. The solid angle: Van Oosterom and
 * Strackee 1983, "The Solid Angle of a Plane Triangle". */
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
    return s->solid_angle > MIN_SOLID_ANGLE;
}

/* A uniform direction: an arc from b cuts the triangle such that the part at a has the share u[0] of its
 * area; u[1] is the position along the arc. Arvo 1995. */
static direction sample_spherical(const spherical_triangle *s, vec2 u)
{
    direction normal_ab = unit(outer(s->a, s->b));
    direction normal_ac = unit(outer(s->a, s->c));
    double cos_alpha = within(inner(normal_ab, normal_ac), -1.0, 1.0);
    direction across = outer(normal_ab, normal_ac);
    double sin_alpha = sqrt(inner(across, across));
    double alpha = atan2(sin_alpha, cos_alpha);
    double phi = (double)u[0] * s->solid_angle - alpha; /* of the part: beta - pi */
    double cos_phi = cos(phi);
    double sin_phi = sin(phi);
    double p = cos_phi - cos_alpha;
    double q = sin_phi + sin_alpha * inner(s->a, s->b);
    double cos_b = ((q * cos_phi - p * sin_phi) * cos_alpha - q) / ((q * sin_phi + p * cos_phi) * sin_alpha);
    cos_b = isnan(cos_b) ? 1.0 : within(cos_b, -1.0, 1.0);
    direction side = unit(combined(s->c, 1.0, s->a, -inner(s->c, s->a)));
    direction end = combined(s->a, cos_b, side, sqrt(1.0 - cos_b * cos_b));
    double z = 1.0 - (double)u[1] * (1.0 - inner(end, s->b));
    direction along = unit(combined(end, 1.0, s->b, -inner(end, s->b)));
    return combined(s->b, z, along, sqrt(fmax(1.0 - z * z, 0.0)));
}

/* ---- points and directions ---- */

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

/* Intersection of the ray from P along w with the plane of the triangle, clamped to the triangle. Moeller and
 * Trumbore 1997. */
static bool intersect_plane(const light_triangle *t, vec3 P, direction w, light_triangle_point *out)
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
        return intersect_plane(t, P, sample_spherical(&s, u), out);
    }
    vec2 weights = uniform_point(u);
    vec3 to = t->corner + t->edge1 * weights[0] + t->edge2 * weights[1] - P;
    out->u = weights[0];
    out->v = weights[1];
    out->distance_m = length(to);
    if (!(out->distance_m > 1e-15f)) /* its square would underflow */
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

/* ==== all that emit ==== */

/* The share of a geometry's mean emission that its triangles get by area alone: a few texels that are
 * black do not prove that all between them are. */
static const float DEFENSIVE_SHARE = 0.01f;

/* Radiance above this, times the largest areas, would not be finite. */
static const float MAX_RADIANCE = 1e15f;

/* ---- geometry ---- */

static light_triangle triangle_of(const render_geometry *g, uint32_t primitive)
{
    const uint32_t *corners = render_geometry_triangle(g, primitive);
    float p[3][3];
    for (int i = 0; i < 3; i++)
        render_geometry_corner(g, corners[i], p[i]);
    vec3 corner = load3(p[0]); /* edges as in shading_hit_make(), to the bit */
    return (light_triangle){corner, load3(p[1]) - corner, load3(p[2]) - corner};
}

light_triangle light_emitters_triangle(const light_emitters *e, uint32_t item)
{
    const light_emitter *l = &e->items[item];
    return triangle_of(&e->scene->geometries->items[l->geometry], l->primitive);
}

bool light_emitters_is_two_sided(const light_emitters *e, uint32_t item)
{
    uint32_t geometry = e->items[item].geometry;
    return e->scene->geometries->items[geometry].is_double_sided ||
           e->scene->plans->items[geometry].is_volume;
}

float light_emitters_normal_sign(const light_emitters *e, uint32_t item)
{
    return e->scene->geometries->items[e->items[item].geometry].is_mirrored ? -1.0f : 1.0f;
}

/* ---- radiance ---- */

static bool is_finite(vec3 v)
{
    return isfinite(v[0] + v[1] + v[2]);
}

/* The factor of all texels. */
static vec3 emission_factor(const scene_material *m)
{
    return load3(m->emissive) * m->emissive_strength;
}

static bool emits(const render_geometry *g)
{
    if (g->primitive->mode != SCENE_TRIANGLES || !g->is_lit)
        return false;
    vec3 factor = emission_factor(g->material);
    return is_finite(factor) && max3(factor) > 0.0f && max3(factor) <= MAX_RADIANCE;
}

/* Whether the radiance is the factor alone, without texels, coverage and coat. */
static bool is_uniform(const render_geometry *g, const material_plan *plan)
{
    return !g->is_see_through && !(plan->textures & 1u << SCENE_EMISSIVE_TEXTURE) &&
           !(plan->layers & LAYER_CLEARCOAT);
}

vec3 light_emitters_radiance(const light_emitters *e, uint32_t item, float u, float v, vec3 P, vec3 d,
                             float distance_m)
{
    const light_emitter *l = &e->items[item];
    const render_geometry *g = &e->scene->geometries->items[l->geometry];
    light_triangle t = light_emitters_triangle(e, item);
    visibility_hit hit = {
        .t = distance_m, .u = u, .v = v, .geometry = l->geometry, .primitive = l->primitive};
    store3(cross(t.edge1, t.edge2), hit.normal);
    ray_spread spread = {.moves = false, .turns = false};
    shading_ray ray = {.far_t = INFINITY, .spread = &spread, .footprint = 0.0f};
    store3(P, ray.origin);
    store3(d, ray.direction);
    if (!ray_trace_is_visible_side(e->scene, &hit, ray.direction))
        return vec3(0.0f);
    if (is_uniform(g, &e->scene->plans->items[l->geometry]))
        return max(emission_factor(g->material), 0.0f);
    shading_point point = {.hit = &hit, .ray = &ray, .shade_count = 1};
    surface_point s;
    surface_point_make(e->scene, &point, &s);
    vec3 radiance = layers_emission(s.m, s.V) * surface_opacity(g->material, s.base_color[3]);
    return is_finite(radiance) ? max(radiance, 0.0f) : vec3(0.0f);
}

/* ---- power ---- */

/* Mean radiance over a triangle, mean of the channels: texels at the centers of its four similar quarters,
 * each filtered over the quarter. Coverage counts; clearcoat does not. */
static float mean_radiance(const shading_scene *scene, uint32_t geometry, uint32_t primitive)
{
    static const float middles[4][2] = {{1.0f / 3.0f, 1.0f / 3.0f},
                                        {1.0f / 6.0f, 1.0f / 6.0f},
                                        {2.0f / 3.0f, 1.0f / 6.0f},
                                        {1.0f / 6.0f, 2.0f / 3.0f}};
    const render_geometry *g = &scene->geometries->items[geometry];
    const material_plan *plan = &scene->plans->items[geometry];
    uint32_t wanted = 1u << SCENE_EMISSIVE_TEXTURE;
    wanted |= g->is_see_through ? 1u << SCENE_BASE_COLOR_TEXTURE : 0u;
    wanted &= plan->textures;
    shading_hit h = {
        .geometry = g, .first_index = 3 * (size_t)primitive, .dx = {0.5f, 0.0f}, .dy = {0.0f, 0.5f}};
    for (int i = 0; i < 3; i++)
        h.corner[i] = render_geometry_triangle(g, primitive)[i];
    vec3 sum = vec3(0.0f);
    int count = wanted || g->is_see_through ? 4 : 1;
    for (int i = 0; i < count; i++) {
        h.weight[1] = middles[i][0];
        h.weight[2] = middles[i][1];
        h.weight[0] = 1.0f - h.weight[1] - h.weight[2];
        material_texels texels;
        material_texels_read(scene, &h, wanted, SCENE_TEXTURE_SLOT_COUNT, texels);
        float color[4];
        shading_hit_color(&h, color);
        float alpha = texels[SCENE_BASE_COLOR_TEXTURE][3] * (g->material->base_color[3] * color[3]);
        sum += load3(texels[SCENE_EMISSIVE_TEXTURE]) * surface_opacity(g->material, alpha);
    }
    vec3 mean = max(emission_factor(g->material) * sum * (1.0f / (float)count), 0.0f);
    return (mean[0] + mean[1] + mean[2]) * (1.0f / 3.0f);
}

typedef struct measuring {
    light_emitters *e;
    uint32_t geometry;
    float *radiance, *area; /* per triangle */
} measuring;

static void measure_triangles(void *context, size_t begin, size_t end)
{
    const measuring *m = context;
    const render_geometry *g = &m->e->scene->geometries->items[m->geometry];
    for (size_t i = begin; i < end; i++) {
        light_triangle t = triangle_of(g, (uint32_t)i);
        float area = light_triangle_area(&t);
        float farthest = max3(abs(t.corner)) + max3(abs(t.edge1)) + max3(abs(t.edge2));
        bool is_any = area > 0.0f && isfinite(area) && farthest < 1e15f;
        m->area[i] = is_any ? area : 0.0f;
        m->radiance[i] = is_any ? mean_radiance(m->e->scene, m->geometry, (uint32_t)i) : 0.0f;
        if (!isfinite(m->radiance[i]))
            m->radiance[i] = 0.0f;
    }
}

/* Adds the triangles of a geometry, in their order. */
static void add_triangles(light_emitters *e, const measuring *m, uint32_t triangle_count)
{
    double area = 0.0;
    double intensity = 0.0;
    for (uint32_t i = 0; i < triangle_count; i++) {
        area += (double)m->area[i];
        intensity += (double)m->area[i] * (double)m->radiance[i];
    }
    vec3 factor = max(emission_factor(e->scene->geometries->items[m->geometry].material), 0.0f);
    float most = (factor[0] + factor[1] + factor[2]) * (1.0f / 3.0f);
    float mean = area > 0.0 ? (float)(intensity / area) : 0.0f;
    float least = DEFENSIVE_SHARE * (mean > 0.0f ? mean : most);
    for (uint32_t i = 0; i < triangle_count; i++) {
        float each = m->area[i] * (m->radiance[i] + least);
        bool is_light = each > 0.0f && isfinite(each);
        e->item_of[e->first[m->geometry] + i] = is_light ? e->count : LIGHT_EMITTERS_NONE;
        if (is_light)
            e->items[e->count++] =
                (light_emitter){.geometry = m->geometry, .primitive = i, .intensity = each};
        else
            e->ignored++;
    }
}

/* ---- making ---- */

static uint32_t triangle_count_of(const render_geometry *g)
{
    return g->primitive->index_count / 3;
}

facet_result light_emitters_create(const shading_scene *scene, const facet_allocator *allocator,
                                   uint32_t thread_count, light_emitters *out, facet_error *error)
{
    const render_geometry_set *set = scene->geometries;
    *out = (light_emitters){.scene = scene};
    size_t all = 0;
    uint32_t most = 0;
    for (uint32_t i = 0; i < set->count; i++)
        if (emits(&set->items[i])) {
            uint32_t triangles = triangle_count_of(&set->items[i]);
            all += triangles;
            most = triangles > most ? triangles : most;
        }
    if (all == 0)
        return FACET_OK;
    measuring m = {.e = out,
                   .radiance = mem_alloc(allocator, most, sizeof *m.radiance),
                   .area = mem_alloc(allocator, most, sizeof *m.area)};
    out->items = mem_alloc(allocator, all, sizeof *out->items);
    out->first = mem_alloc(allocator, set->count, sizeof *out->first);
    out->item_of = mem_alloc(allocator, all, sizeof *out->item_of);
    bool has_memory =
        all < LIGHT_EMITTERS_NONE && m.radiance && m.area && out->items && out->first && out->item_of;
    if (has_memory) {
        uint32_t next = 0;
        for (m.geometry = 0; m.geometry < set->count; m.geometry++) {
            const render_geometry *g = &set->items[m.geometry];
            out->first[m.geometry] = emits(g) ? next : LIGHT_EMITTERS_NONE;
            if (!emits(g))
                continue;
            uint32_t triangles = triangle_count_of(g);
            parallel_for(thread_count, triangles, 256, measure_triangles, &m);
            add_triangles(out, &m, triangles);
            next += triangles;
        }
    } else {
        light_emitters_destroy(out);
    }
    mem_free(m.radiance);
    mem_free(m.area);
    return has_memory ? FACET_OK : fail_memory(error, "lights", all * sizeof *out->items);
}

void light_emitters_destroy(light_emitters *e)
{
    mem_free(e->items);
    mem_free(e->first);
    mem_free(e->item_of);
    *e = (light_emitters){0};
}
