/* pixel.c - see pixel.h. Visibility is sampled several times in a pixel, light is computed once for each
 * surface that the samples see there, as multisampling does: an edge is smooth and the inside costs one
 * shade. */
#include "cpu/pixel.h"

#include <math.h>

#include "cpu/ogl1_shade.h"
#include "scene/identity.h"

#include "shade/shade.h"

/* Two hits on one mesh are one surface if their faces differ by less than 14 degrees and lie in one plane,
 * within a pixel: a shade in between is visually the same. */
static const float SAME_FACE_COS = 0.97f;

/* ---- fragments ---- */

static bool add_fragment(pixel_resolver *r, const visibility_hit *hit, uint32_t sample)
{
    if (!mem_reserve(r->allocator, (void **)&r->fragments, &r->fragment_capacity, r->fragment_count + 1,
                     sizeof *r->fragments))
        return false;
    r->fragments[r->fragment_count++] = (pixel_fragment){.hit = *hit, .sample = sample};
    return true;
}

/* Whether the ray ends at its nearest hit. */
static bool is_simple(const pixel_resolver *r, const visibility_hit *hit, float x, float y)
{
    const render_geometry *g = &r->scene->geometries->items[hit->geometry];
    if (g->is_see_through)
        return false;
    if (g->is_double_sided || r->has_visible_hits)
        return true;
    const camera_rays *camera = r->scene->camera;
    float X = x - camera->middle[0];
    float Y = y - camera->middle[1];
    float direction[3];
    for (int i = 0; i < 3; i++)
        direction[i] = camera->direction[i] + X * camera->direction_dx[i] + Y * camera->direction_dy[i];
    return ray_trace_is_visible_side(r->scene, hit, direction);
}

static bool collect_fragments(pixel_resolver *r, uint32_t x, uint32_t y, const visibility_hit *hits)
{
    uint32_t n = r->pattern->sample_count;
    float footprint = inversesqrt((float)n);
    r->fragment_count = 0;
    for (uint32_t sample = 0; sample < n; sample++) {
        if (hits[sample].geometry == VISIBILITY_NONE)
            continue;
        float px = (float)x + r->pattern->points[2 * sample];
        float py = (float)y + r->pattern->points[2 * sample + 1];
        if (is_simple(r, &hits[sample], px, py)) {
            if (!add_fragment(r, &hits[sample], sample))
                return false;
            continue;
        }
        visibility_hit layers[RAY_TRACE_LAYERS + 1];
        shading_ray ray =
            shading_ray_of_camera(r->scene->camera, &r->scene->camera_spread, px, py, footprint);
        uint32_t count = ray_trace_layers(r->scene, &ray, layers);
        r->rays++;
        for (uint32_t i = 0; i < count; i++)
            if (!add_fragment(r, &layers[i], sample))
                return false;
    }
    return true;
}

/* ---- surfaces ---- */

static vec3 hit_position(const pixel_resolver *r, uint32_t x, uint32_t y, const pixel_fragment *f)
{
    float origin[3];
    float direction[3];
    camera_rays_at(r->scene->camera, (float)x + r->pattern->points[2 * f->sample],
                   (float)y + r->pattern->points[2 * f->sample + 1], origin, direction);
    return load3(origin) + load3(direction) * f->hit.t;
}

static uint32_t quarter_of(const pixel_resolver *r, uint32_t sample)
{
    const float *point = r->pattern->points + 2 * sample;
    return (uint32_t)(point[0] >= 0.5f) + 2 * (uint32_t)(point[1] >= 0.5f);
}

/* Transmissive surfaces are shaded for each sample: the objects behind them have edges too. */
static bool is_glass(const pixel_resolver *r, const visibility_hit *hit)
{
    return r->scene->plans->items[hit->geometry].lets_rays_through;
}

static bool is_one_surface(const pixel_resolver *r, uint32_t x, uint32_t y, const pixel_fragment *a,
                           const pixel_fragment *b)
{
    if (a->hit.geometry != b->hit.geometry || is_glass(r, &a->hit))
        return false;
    if (r->splits_quarters && quarter_of(r, a->sample) != quarter_of(r, b->sample))
        return false;
    if (a->hit.primitive == b->hit.primitive)
        return true;
    vec3 n = load3(a->hit.normal);
    vec3 m = load3(b->hit.normal);
    float n2 = dot(n, n);
    float cos_nm = dot(n, m);
    if (!(cos_nm > 0.0f && cos_nm * cos_nm > SAME_FACE_COS * SAME_FACE_COS * n2 * dot(m, m)))
        return false;
    float off_plane = dot(n, hit_position(r, x, y, b) - hit_position(r, x, y, a));
    float pixel = camera_rays_pixel_size(r->scene->camera, a->hit.t);
    return off_plane * off_plane <= pixel * pixel * n2;
}

static bool group_surfaces(pixel_resolver *r, uint32_t x, uint32_t y)
{
    r->surface_count = 0;
    for (size_t i = 0; i < r->fragment_count; i++) {
        pixel_fragment *f = &r->fragments[i];
        size_t k = r->surface_count;
        while (k > 0 && !is_one_surface(r, x, y, &r->fragments[r->surfaces[k - 1].first], f))
            k--;
        if (k == 0) {
            if (!mem_reserve(r->allocator, (void **)&r->surfaces, &r->surface_capacity, r->surface_count + 1,
                             sizeof *r->surfaces))
                return false;
            r->surfaces[r->surface_count++] = (pixel_surface){.first = (uint32_t)i};
            k = r->surface_count;
        }
        pixel_surface *s = &r->surfaces[k - 1];
        f->surface = (uint32_t)(k - 1);
        s->fragment_count++;
        s->middle[0] += r->pattern->points[2 * f->sample];
        s->middle[1] += r->pattern->points[2 * f->sample + 1];
    }
    return true;
}

/* The fragment nearest to the middle of the surface's samples. */
static const pixel_fragment *middle_fragment(const pixel_resolver *r, uint32_t number)
{
    const pixel_surface *s = &r->surfaces[number];
    const pixel_fragment *nearest = &r->fragments[s->first];
    float nearest_distance2 = INFINITY;
    for (size_t i = s->first; i < r->fragment_count; i++) {
        const pixel_fragment *f = &r->fragments[i];
        if (f->surface != number)
            continue;
        float dx = r->pattern->points[2 * f->sample] - s->middle[0];
        float dy = r->pattern->points[2 * f->sample + 1] - s->middle[1];
        if (dx * dx + dy * dy < nearest_distance2) {
            nearest = f;
            nearest_distance2 = dx * dx + dy * dy;
        }
    }
    return nearest;
}

/* Sums over samples that hit one triangle. */
typedef struct sample_sum {
    float t, u, v, x, y, count;
} sample_sum;

static inline void add_sample(sample_sum *sum, const visibility_hit *hit, const float point[2])
{
    sum->t += hit->t;
    sum->u += hit->u;
    sum->v += hit->v;
    sum->x += point[0];
    sum->y += point[1];
    sum->count += 1.0f;
}

/* Shades hit at (cx, cy) in the pixel; sample: the first one of those that share it. */
static void shade_hit(pixel_resolver *r, uint32_t x, uint32_t y, const visibility_hit *hit, float cx,
                      float cy, uint32_t sample, pixel_surface *s)
{
    float footprint = r->splits_quarters ? 0.5f : 1.0f;
    shading_point point = {.hit = hit, .x = x, .y = y, .shade_count = 1, .ambient = r->ambient};
    if (is_glass(r, hit)) {
        point.shade = sample;
        point.shade_count = r->pattern->sample_count;
        footprint = inversesqrt((float)point.shade_count);
    }
    shading_ray ray = shading_ray_of_camera(r->scene->camera, &r->scene->camera_spread, (float)x + cx,
                                            (float)y + cy, footprint);
    point.ray = &ray;
    shading_result result;
    shading_shade(r->scene, &point, &result);
    r->shades++;
    r->rays += result.rays;
    for (int i = 0; i < 3; i++)
        s->radiance[i] = result.radiance[i];
    /* Masking was decided for each sample. */
    bool is_blended = r->scene->ogl1 ||
                      r->scene->geometries->items[hit->geometry].material->alpha_mode == SCENE_ALPHA_BLEND;
    s->opacity = is_blended ? result.opacity : 1.0f;
    s->behind = result.behind;
}

/* Shades the triangle of hit at the centroid of the samples; sample: the first one. */
static void shade_centroid(pixel_resolver *r, uint32_t x, uint32_t y, visibility_hit hit,
                           const sample_sum *sum, uint32_t sample, pixel_surface *s)
{
    hit.t = sum->t / sum->count;
    hit.u = sum->u / sum->count;
    hit.v = sum->v / sum->count;
    shade_hit(r, x, y, &hit, sum->x / sum->count, sum->y / sum->count, sample, s);
}

/* Shades a surface at the centroid of its samples on one triangle, the one in the middle: inside the
 * covered area, so that no texture is read beyond the mesh's edge. */
static void shade_surface(pixel_resolver *r, uint32_t x, uint32_t y, uint32_t number)
{
    pixel_surface *s = &r->surfaces[number];
    s->middle[0] /= (float)s->fragment_count;
    s->middle[1] /= (float)s->fragment_count;
    const visibility_hit *hit = &middle_fragment(r, number)->hit;
    sample_sum sum = {.count = 0.0f};
    for (size_t i = s->first; i < r->fragment_count; i++) {
        const pixel_fragment *f = &r->fragments[i];
        if (f->surface == number && f->hit.primitive == hit->primitive)
            add_sample(&sum, &f->hit, r->pattern->points + 2 * f->sample);
    }
    shade_centroid(r, x, y, *hit, &sum, r->fragments[s->first].sample, s);
}

/* ---- one triangle ---- */

/* Whether pixels of one opaque triangle are resolved without fragments. */
static bool has_plain_pixels(const pixel_resolver *r)
{
    return r->has_visible_hits && !r->splits_quarters && !r->scene->ogl1;
}

/* The color of a pixel of which count samples see s. */
static void cover(const pixel_resolver *r, const pixel_surface *s, float count, float rgba[4])
{
    const float n = (float)r->pattern->sample_count;
    rgba[0] = rgba[1] = rgba[2] = 0.0f;
    for (float k = 0.0f; k < count; k += 1.0f)
        for (int c = 0; c < 3; c++)
            rgba[c] += s->radiance[c];
    for (int c = 0; c < 3; c++)
        rgba[c] /= n;
    rgba[3] = count / n;
}

/* The usual pixel: all samples that hit anything hit the same triangle, which is opaque. The result is that of
 * fragments and composite(), in a quarter of the time. False: it is another one. */
static bool resolve_triangle(pixel_resolver *r, uint32_t x, uint32_t y, const visibility_hit *hits,
                             float rgba[4])
{
    const uint32_t n = r->pattern->sample_count;
    const visibility_hit *first = NULL;
    sample_sum sum = {.count = 0.0f};
    if (!has_plain_pixels(r))
        return false;
    for (uint32_t sample = 0; sample < n; sample++) {
        const visibility_hit *hit = &hits[sample];
        if (hit->geometry == VISIBILITY_NONE)
            continue;
        first = first ? first : hit;
        if (hit->geometry != first->geometry || hit->primitive != first->primitive ||
            r->scene->geometries->items[hit->geometry].is_see_through)
            return false;
        add_sample(&sum, hit, r->pattern->points + 2 * sample);
    }
    rgba[0] = rgba[1] = rgba[2] = rgba[3] = 0.0f;
    if (!first)
        return true;
    pixel_surface s;
    shade_centroid(r, x, y, *first, &sum, 0, &s);
    cover(r, &s, sum.count, rgba);
    return true;
}

/* ---- composition ---- */

/* Composites the samples' layers ("over", Porter and Duff 1984) and averages. */
static void composite(const pixel_resolver *r, float rgba[4])
{
    float sum[3] = {0.0f};
    float passed_sum = 0.0f; /* transmittance of all layers, over the samples that hit */
    float behind_sum = 0.0f; /* background that is seen through glass */
    uint32_t hit_samples = 0;
    for (size_t i = 0; i < r->fragment_count;) {
        uint32_t sample = r->fragments[i].sample;
        float passed = 1.0f;
        for (; i < r->fragment_count && r->fragments[i].sample == sample; i++) {
            const pixel_surface *s = &r->surfaces[r->fragments[i].surface];
            float weight = passed * s->opacity;
            for (int c = 0; c < 3; c++)
                sum[c] += weight * s->radiance[c];
            behind_sum += weight * s->behind;
            passed *= 1.0f - s->opacity;
        }
        passed_sum += passed;
        hit_samples++;
    }
    float n = (float)r->pattern->sample_count;
    for (int c = 0; c < 3; c++)
        rgba[c] = sum[c] / n;
    rgba[3] = ((float)hit_samples - passed_sum - behind_sum) / n;
}

void pixel_add_background(const shading_scene *scene, float blur, float scale, uint32_t x, uint32_t y,
                          float rgba[4])
{
    float passed = 1.0f - rgba[3];
    if (!(passed > 0.0f))
        return;
    const camera_rays *camera = scene->camera;
    float origin[3];
    float direction[3];
    float radiance[3];
    camera_rays_at(camera, (float)x + 0.5f, (float)y + 0.5f, origin, direction);
    vec3 d = normalize(load3(direction));
    float unit[3] = {d[0], d[1], d[2]};
    if (blur > 0.0f)
        light_specular(scene->light, unit, blur, radiance);
    else
        light_background(scene->light, unit, camera->is_orthographic ? 0.0f : camera->pixel_size, radiance);
    for (int c = 0; c < 3; c++)
        rgba[c] += passed * radiance[c] * scale;
    rgba[3] = 1.0f;
}

static bool resolve_fragments(pixel_resolver *r, uint32_t x, uint32_t y, const visibility_hit *hits,
                              float rgba[4])
{
    if (!collect_fragments(r, x, y, hits))
        return false;
    rgba[0] = rgba[1] = rgba[2] = rgba[3] = 0.0f;
    if (r->fragment_count) {
        if (!group_surfaces(r, x, y))
            return false;
        for (uint32_t i = 0; i < r->surface_count; i++)
            shade_surface(r, x, y, i);
        composite(r, rgba);
        if (r->scene->ogl1)
            ogl1_develop(r->scene, rgba);
    }
    return true;
}

/* Adds the background and scales. */
static void finish(const pixel_resolver *r, uint32_t x, uint32_t y, float rgba[4])
{
    if (r->draws_background)
        pixel_add_background(r->scene, r->background_blur, 1.0f, x, y, rgba);
    for (int c = 0; c < 3; c++)
        rgba[c] *= r->scale;
}

bool pixel_resolve(pixel_resolver *r, uint32_t x, uint32_t y, const visibility_hit *hits, float rgba[4])
{
    if (!resolve_triangle(r, x, y, hits, rgba) && !resolve_fragments(r, x, y, hits, rgba))
        return false;
    finish(r, x, y, rgba);
    return true;
}

bool pixel_resolve_one(pixel_resolver *r, uint32_t x, uint32_t y, const visibility_hit *hit, float rgba[4])
{
    if (!has_plain_pixels(r))
        return false;
    if (hit->geometry == VISIBILITY_NONE) {
        rgba[0] = rgba[1] = rgba[2] = rgba[3] = 0.0f;
    } else if (r->scene->geometries->items[hit->geometry].is_see_through) {
        return false;
    } else {
        const float *middle = r->pattern->middle;
        pixel_surface s;
        shade_hit(r, x, y, hit, middle[0], middle[1], 0, &s);
        cover(r, &s, (float)r->pattern->sample_count, rgba);
    }
    finish(r, x, y, rgba);
    return true;
}

/* The weights are those of composite(): shares add up to the image's opacity. */
void pixel_add_mattes(const pixel_resolver *r, const scene_identity *identities, const matte_layers *mattes,
                      size_t number)
{
    for (size_t i = 0; i < r->fragment_count;) {
        uint32_t sample = r->fragments[i].sample;
        float passed = 1.0f;
        for (; i < r->fragment_count && r->fragments[i].sample == sample; i++) {
            const pixel_fragment *f = &r->fragments[i];
            float opacity = r->surfaces[f->surface].opacity;
            matte_add(mattes, number, identities[f->hit.geometry].hashes, passed * opacity);
            passed *= 1.0f - opacity;
        }
    }
    matte_finish(mattes, number, 1.0f / (float)r->pattern->sample_count);
}

bool pixel_nearest_surface(pixel_resolver *r, uint32_t x, uint32_t y, const visibility_hit *hit,
                           shading_description *result, float *depth_m, uint32_t *geometry)
{
    if (hit->geometry == VISIBILITY_NONE)
        return false;
    float px = (float)x + 0.5f;
    float py = (float)y + 0.5f;
    visibility_hit layers[RAY_TRACE_LAYERS + 1];
    shading_ray ray = shading_ray_of_camera(r->scene->camera, &r->scene->camera_spread, px, py, 1.0f);
    if (!is_simple(r, hit, px, py)) {
        r->rays++;
        if (ray_trace_layers(r->scene, &ray, layers) == 0)
            return false;
        hit = &layers[0];
    }
    shading_point point = {.hit = hit, .ray = &ray};
    shading_describe(r->scene, &point, result);
    r->shades++;
    *depth_m = hit->t;
    *geometry = hit->geometry;
    return true;
}

void pixel_resolver_destroy(pixel_resolver *r)
{
    mem_free(r->fragments);
    mem_free(r->surfaces);
    r->fragments = NULL;
    r->surfaces = NULL;
}
