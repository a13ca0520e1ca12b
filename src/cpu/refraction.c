/* refraction.c - see refraction.h. */
#include "cpu/media.h"
#include "cpu/ray_trace.h"

#include "cpu/boundary.h"
#include "cpu/ray_samples.h"
#include "cpu/refraction.h"
#include "cpu/surface_light.h"

enum {
    MAX_PENDING = 24, /* secondary rays that are not traced yet */
    DEPTH = 16,       /* surfaces along a ray */
    COLORS = 3        /* rays into which a white one splits at a dispersive volume behind another surface */
};

/* Rays that carry less of a shade are not traced. */
static const float MIN_WEIGHT[] = {
    [FACET_QUALITY_NORMAL] = 0.01f, [FACET_QUALITY_DRAFT] = 0.02f, [FACET_QUALITY_FINAL] = 0.003f};
/* Factor on it where the view is blurred: excludes the inner reflection of one boundary, but not total
 * reflection. */
static const float BLURRED = 6.0f;
/* GGX width up to which one ray in the middle of the lobe suffices: its hit is filtered for the lobe,
 * which blurs textures and the environment but no edges. */
static const float SMOOTH = 0.0125f;

/* A ray to be traced, and its weight and lobe. */
typedef struct branch {
    shading_ray ray; /* its spread is the camera's, or the one below */
    ray_spread spread;
    vec3 weight;  /* of its radiance */
    media media;  /* at its origin */
    float alpha2; /* squared GGX width of the lobe of directions around it */
    /* shift of the ior: -1 red, 0 green, 1 blue (dispersion.h), and between and beyond */
    float shift;
    bool is_white;     /* carries all wavelengths: dispersion has not split it */
    bool is_reflected; /* inside of glass; others see the backdrop */
    uint32_t depth;    /* surfaces before it */
} branch;

typedef struct tracer {
    const shading_scene *scene;
    uint32_t sample; /* index for ray_samples.h */
    float share;     /* share of a lobe per sample; 1: lobes are not sampled */
    float least_weight;
    uint32_t budget;
    uint64_t rays;
    vec3 radiance;
    vec3 behind, unseen; /* weight of rays to the backdrop, and the environment's radiance along them */
    uint32_t pending_count;
    branch pending[MAX_PENDING];
} tracer;

/* ---- between surfaces ---- */

static vec3 environment_at(void (*light)(const light_setup *, const float[3], float, float[3]),
                           const light_setup *setup, const float d[3], float argument)
{
    float out[3];
    light(setup, d, argument, out);
    return load3(out);
}

/* Squared GGX width of a lobe about as wide as the bundle: where glass spreads a pixel over much of the
 * environment, it shows the mean. */
static float bundle_alpha2(const shading_ray *ray)
{
    const ray_spread *spread = ray->spread;
    if (!spread->turns)
        return 0.0f;
    float width = 0.125f * (length(load3(spread->direction_dx)) + length(load3(spread->direction_dy)));
    return width * width;
}

/* Environment radiance along the ray. */
static vec3 environment_seen(const shading_scene *scene, const branch *b)
{
    if (!scene->light->ibl)
        return vec3(0.0f);
    float alpha2 = max(b->alpha2, bundle_alpha2(&b->ray));
    if (environment_is_sharp(alpha2, scene->background_blur) && scene->light->has_background)
        return environment_at(light_background, scene->light, b->ray.direction, 0.0f);
    return environment_at(light_specular, scene->light, b->ray.direction,
                          environment_blur(alpha2, scene->background_blur));
}

/* In-scattered radiance of a volume along a ray: that of the environment ahead of it and behind it. */
static vec3 ambient(const shading_scene *scene, vec3 D, float anisotropy)
{
    float ahead[3];
    float behind[3];
    float a[3];
    float b[3];
    store3(D, ahead);
    store3(-D, behind);
    if (!scene->light->ibl)
        return vec3(0.0f);
    light_irradiance_over_pi(scene->light, ahead, a);
    light_irradiance_over_pi(scene->light, behind, b);
    return scattered_ambient(load3(a), load3(b), anisotropy);
}

/* Attenuates the ray over a length of its volume. Scattered light is replaced as far as the volume's color
 * says, under uniform light of the environment: a white volume loses nothing. */
static void travel(tracer *t, branch *b, float length_m)
{
    const scene_material *m = media_here(&b->media);
    if (!m || !(m->attenuation_distance < INFINITY))
        return;
    vec3 T = volume_transmittance(load3(m->attenuation_color), m->attenuation_distance, length_m);
    if (m->extensions & SCENE_VOLUME_SCATTER)
        t->radiance += b->weight * (1.0f - T) * load3(m->multiscatter_color) *
                       ambient(t->scene, load3(b->ray.direction), m->scatter_anisotropy);
    b->weight *= T;
}

/* Ends the ray. In a volume without exit, at the material's thickness. */
static void end(tracer *t, branch *b)
{
    if (b->media.count)
        travel(t, b, b->media.volumes[b->media.count - 1].thickness_m);
    vec3 seen = b->weight * environment_seen(t->scene, b);
    if (t->scene->backdrop == SHADING_BACKDROP_ENVIRONMENT || b->is_reflected) {
        t->radiance += seen;
        return;
    }
    t->behind += b->weight;
    t->unseen += seen;
}

/* Ends a ray that is not followed to the boundaries around it: each would tint it once. Without their colors glass
 * with many inner reflections (a high ior, a rough surface) is too pale. */
static void cut(tracer *t, branch *b)
{
    for (uint32_t i = 0; i < b->media.count; i++)
        b->weight *= load3(b->media.volumes[i].material->base_color);
    end(t, b);
}

static void follow_later(tracer *t, const branch *b)
{
    if (t->pending_count < MAX_PENDING) {
        t->pending[t->pending_count++] = *b;
        return;
    }
    branch last = *b;
    last.ray.spread = &last.spread;
    cut(t, &last);
}

/* ---- the boundary ---- */

/* A transmissive surface at the hit of a ray. */
typedef struct boundary {
    const surface_point *s;
    boundary_normal normal;
    float alpha;       /* roughness of transmission */
    media behind;      /* on the other side */
    vec3 H;            /* the microfacet of this sample */
    bundle_hit bundle; /* with the normal's change for that of H */
} boundary;

static mat3 frame_of(const Layers *m, vec3 N)
{
    if (m->layers & LAYER_ANISOTROPY && dot(N, m->base.N) > 0.999f)
        return mat3(m->anisotropy_T, m->anisotropy_B, N);
    return basis_from_normal(N);
}

/* The microfacet of this sample. */
static vec3 microfacet(const tracer *t, const branch *b, const boundary *y)
{
    if (t->share >= 1.0f || y->alpha < SMOOTH)
        return y->normal.N;
    const Layers *m = &y->s->m;
    mat3 frame = frame_of(m, y->normal.N);
    vec2 widths = layers_alpha(*m, y->alpha);
    vec2 u = ray_samples_at(t->sample, b->depth);
    return normalize(mul(frame, sample_VNDF_GGX(u, mul(transpose(frame), y->s->V), widths[0], widths[1])));
}

/* The part that samples and colors share. */
static boundary boundary_of(const shading_scene *scene, const branch *b, const visibility_hit *hit,
                            const surface_point *s)
{
    boundary y = {.s = s,
                  .normal = boundary_normal_at(s, hit),
                  .alpha = layers_transmission_alpha(s->m),
                  .behind = b->media};
    y.bundle = ray_bundle_hit(&b->ray, s, &y.normal);
    if (s->plan->is_volume)
        media_cross(scene, hit, s, y.normal.tolerance, &y.behind);
    return y;
}

/* Moves a ray to its side of the surface (1: where it came from, -1 behind): directions on the wrong side
 * of the geometric normal are mirrored, and the origin is offset by the tolerance. */
static void keep_side(shading_ray *ray, const boundary *y, float side)
{
    vec3 Ng = y->normal.Ng;
    vec3 D = load3(ray->direction);
    float c = dot(D, Ng);
    if (c * side <= 0.0f)
        store3(normalize(D - Ng * (2.0f * c - side * 1e-4f)), ray->direction);
    store3(y->s->P + Ng * (side * y->normal.tolerance), ray->origin);
}

/* A ray that continues from b's surface on a side of it. */
static branch child_of(const branch *b, const boundary *y, float side, bundle_ray bundle, vec3 weight,
                       float alpha2)
{
    branch c = *b;
    keep_side(&bundle.ray, y, side);
    c.alpha2 = min(alpha2, 1.0f);
    if (alpha2 > 0.0f)
        ray_bundle_widen(&bundle, sqrt(c.alpha2));
    c.ray = bundle.ray;
    c.spread = bundle.spread;
    c.weight = weight;
    c.depth = b->depth + 1;
    return c;
}

/* Share of the lobe of b's surface per ray: samples cover the first two surfaces only. */
static float share_of(const tracer *t, const branch *b)
{
    return b->depth < 2 ? t->share : 1.0f;
}

/* Straight through a thin wall; roughness scatters as it does for the reflection. */
static void pass_wall(tracer *t, const branch *b, const boundary *y, vec3 weight)
{
    bundle_ray bundle = ray_bundle_pass(&y->bundle);
    if (dot(y->H, y->normal.N) < 1.0f)
        store3(mirror_through(reflect(-y->s->V, y->H), y->normal.N), bundle.ray.direction);
    branch c = child_of(b, y, -1.0f, bundle, weight, b->alpha2 + y->alpha * y->alpha * share_of(t, b));
    follow_later(t, &c);
}

/* The earlier width scales with eta. */
static void refract_into(tracer *t, const branch *b, const boundary *y, float eta, vec3 weight)
{
    bundle_ray bundle;
    if (abs(eta - 1.0f) < 1e-6f)
        bundle = ray_bundle_pass(&y->bundle);
    else if (!ray_bundle_refract(&y->bundle, y->H, eta, &bundle) &&
             !ray_bundle_refract(&y->bundle, y->normal.N, eta, &bundle))
        bundle = ray_bundle_pass(&y->bundle);
    float own = refracted_alpha(y->alpha, eta);
    branch c = child_of(b, y, -1.0f, bundle, weight, b->alpha2 * eta * eta + own * own * share_of(t, b));
    c.media = y->behind;
    follow_later(t, &c);
}

static void reflect_back(tracer *t, const branch *b, const boundary *y, vec3 weight)
{
    bundle_ray bundle = ray_bundle_reflect(&y->bundle, y->H);
    branch c = child_of(b, y, 1.0f, bundle, weight, b->alpha2 + y->alpha * y->alpha * share_of(t, b));
    c.is_reflected = true;
    follow_later(t, &c);
}

/* ---- media ---- */

static bool is_dispersive(const scene_material *m)
{
    return m && m->extensions & SCENE_DISPERSION && m->dispersion > 0.0f && m->ior > 1.0f;
}

static float ior_of(const scene_material *m, float shift)
{
    if (!m || !(m->ior > 0.0f))
        return 1.0f;
    if (!is_dispersive(m))
        return m->ior;
    float spread = dispersed_ior(m->ior, m->dispersion, 2) - m->ior;
    return max(m->ior + spread * shift, 1.0f);
}

/* ---- hits ---- */

/* The boundary between two volumes, or of one seen from inside: Fresnel's equations, with the reflection
 * traced as well. The rest is scattered by the base color under the environment. */
static void cross_inside(tracer *t, const branch *b, const boundary *y, vec3 weight)
{
    const Layers *m = &y->s->m;
    float eta = ior_of(media_here(&b->media), b->shift) / ior_of(media_here(&y->behind), b->shift);
    float F =
        abs(eta - 1.0f) < 1e-6f ? 0.0f : F_dielectric(clamp(dot(y->s->V, y->H), 0.0f, 1.0f), 1.0f / eta);
    vec3 base_color = m->base.base_color;
    float dielectric = 1.0f - m->base.metallic;
    vec3 reflected = mix(vec3(F), base_color, m->base.metallic);
    vec3 passed = base_color * ((1.0f - F) * dielectric);
    float transmission = m->transmission;
    if (y->s->is_front)
        t->radiance += weight * layers_emission(*m, y->s->V);
    if (transmission < 1.0f && t->scene->light->ibl) {
        float N[3];
        float irradiance[3];
        store3(y->normal.N, N);
        light_irradiance_over_pi(t->scene->light, N, irradiance);
        t->radiance += weight * passed * load3(irradiance) * (1.0f - transmission);
    }
    if (max3(reflected) > 0.0f)
        reflect_back(t, b, y, weight * reflected);
    if (F < 1.0f)
        refract_into(t, b, y, eta, weight * passed * transmission);
}

/* A volume in air seen from outside, or a thin wall: shaded as other surfaces, except for transmission. */
static bool is_outer_surface(const branch *b, const surface_point *s)
{
    return !s->plan->is_volume || (b->media.count == 0 && s->is_front);
}

/* Continues behind the surface with weight; that of an outer surface excludes its reflection. */
static void let_through(tracer *t, const branch *b, boundary *y, vec3 weight)
{
    y->H = microfacet(t, b, y);
    if (!y->s->plan->is_volume)
        pass_wall(t, b, y, weight);
    else if (is_outer_surface(b, y->s))
        refract_into(t, b, y, ior_of(NULL, b->shift) / ior_of(media_here(&y->behind), b->shift), weight);
    else
        cross_inside(t, b, y, weight);
}

static bool is_dispersed_by(const branch *b, const surface_point *s)
{
    return b->is_white && s->plan->is_volume &&
           (is_dispersive(s->hit.geometry->material) || is_dispersive(media_here(&b->media)));
}

/* Shades a surface that a ray hits with `weight`. A white ray that hits a dispersive volume splits into
 * one per channel. */
static void shade_hit(tracer *t, const branch *b, const visibility_hit *hit, const surface_point *s,
                      vec3 weight)
{
    bool passes = (s->m.layers & LAYER_TRANSMISSION) != 0;
    if (!passes || is_outer_surface(b, s)) {
        surface_light light = surface_light_at(t->scene, s);
        t->radiance += weight * light.radiance;
        t->rays += light.rays;
        weight *= light.through;
    }
    if (!passes)
        return;
    boundary y = boundary_of(t->scene, b, hit, s);
    if (!is_dispersed_by(b, s)) {
        let_through(t, b, &y, weight);
        return;
    }
    for (int channel = 0; channel < COLORS; channel++) {
        branch c = *b;
        c.is_white = false;
        c.shift = (float)(channel - 1);
        vec3 share = vec3(0.0f);
        share[channel] = weight[channel];
        let_through(t, &c, &y, share);
    }
}

/* Traces a ray to the first opaque or transmissive surface. */
static void follow(tracer *t, branch *b)
{
    visibility_hit hits[RAY_TRACE_LAYERS + 1];
    uint32_t count = ray_trace_layers(t->scene, &b->ray, hits);
    float from = 0.0f;
    t->rays++;
    for (uint32_t i = 0; i < count; i++) {
        travel(t, b, hits[i].t - from);
        from = hits[i].t;
        shading_point point = {.hit = &hits[i], .ray = &b->ray};
        surface_point s;
        surface_point_make(t->scene, &point, &s);
        const scene_material *material = s.hit.geometry->material;
        /* Masking was decided by the hit. */
        float opacity =
            material->alpha_mode == SCENE_ALPHA_BLEND ? surface_opacity(material, s.base_color[3]) : 1.0f;
        shade_hit(t, b, &hits[i], &s, b->weight * opacity);
        b->weight *= 1.0f - opacity;
        if (opacity >= 1.0f)
            return;
    }
    end(t, b);
}

static void follow_all(tracer *t)
{
    while (t->pending_count) {
        uint32_t heaviest = 0;
        for (uint32_t i = 1; i < t->pending_count; i++)
            if (max3(t->pending[i].weight) > max3(t->pending[heaviest].weight))
                heaviest = i;
        branch b = t->pending[heaviest];
        t->pending[heaviest] = t->pending[--t->pending_count];
        b.ray.spread = &b.spread;
        if (t->budget == 0 || b.depth > DEPTH || max3(b.weight) < t->least_weight) {
            cut(t, &b);
        } else {
            t->budget--;
            follow(t, &b);
        }
    }
}

/* ---- the first surface ---- */

/* How a shade is split into rays. */
typedef struct split {
    uint32_t count;  /* rays of this shade */
    uint32_t total;  /* of all of the pixel */
    uint32_t budget; /* per ray, with its secondary rays */
    bool is_rough, is_dispersed;
} split;

static split choose_split(const shading_scene *scene, const surface_point *s, uint32_t shade_count)
{
    static const uint32_t rough_totals[] = {
        [FACET_QUALITY_NORMAL] = 16, [FACET_QUALITY_DRAFT] = 1, [FACET_QUALITY_FINAL] = 64};
    static const uint32_t least_colors[] = {
        [FACET_QUALITY_NORMAL] = 4, [FACET_QUALITY_DRAFT] = 3, [FACET_QUALITY_FINAL] = 4};
    static const uint32_t budgets[] = {
        [FACET_QUALITY_NORMAL] = 24, [FACET_QUALITY_DRAFT] = 8, [FACET_QUALITY_FINAL] = 48};
    split p = {.count = 1,
               .budget = budgets[scene->quality],
               .is_rough = s->m.base.alpha >= SMOOTH,
               .is_dispersed = s->plan->is_volume && is_dispersive(s->hit.geometry->material)};
    if (p.is_rough && rough_totals[scene->quality] > shade_count)
        p.count = rough_totals[scene->quality] / shade_count;
    if (p.is_dispersed && p.count < least_colors[scene->quality])
        p.count = least_colors[scene->quality];
    if (p.count > 1)
        p.budget = p.budget > 24 ? p.budget / 4 : 6;
    p.total = p.count * shade_count;
    return p;
}

/* Shift of color k of n: evenly over twice the distance from red to blue; three are the channels
 * themselves. */
static float color_shift(uint32_t k, uint32_t n)
{
    return n == 3 ? (float)k - 1.0f : 4.0f * ((float)k + 0.5f) / (float)n - 2.0f;
}

/* The shift of a ray. Each shade has every shade_count-th color, in an order other than that of the rays, and
 * different per pixel: the ray's index determines its direction. */
static float shift_of_ray(const split *p, const shading_point *point, uint32_t place, uint32_t ray)
{
    uint32_t k = p->total == 3 ? ray : (ray * 5 + ray_samples_hash(place)) % p->count;
    return color_shift(k * point->shade_count + point->shade, p->total);
}

/* Unscaled weights: tents of half width 1 around red, green and blue, so that neighboring colors overlap. */
static vec3 color_weight(float shift)
{
    return max(1.0f - abs(vec3(shift + 1.0f, shift, shift - 1.0f)), 0.0f);
}

static vec3 color_sum(const split *p, const shading_point *point)
{
    vec3 sum = vec3(0.0f);
    for (uint32_t ray = 0; ray < p->count; ray++)
        sum += color_weight(shift_of_ray(p, point, 0, ray));
    return sum;
}

/* What a tracer has found. */
static void conclude(const tracer *t, shading_result *out)
{
    float behind[3];
    float unseen[3];
    store3(t->radiance, out->radiance);
    store3(t->behind, behind);
    store3(t->unseen, unseen);
    out->behind = t->scene->backdrop == SHADING_BACKDROP_ENVIRONMENT
                      ? 0.0f
                      : shading_show_backdrop(t->scene, behind, unseen, out->radiance);
    out->rays = t->rays;
}

void refraction_shade(const shading_scene *scene, const shading_point *point, const surface_point *s,
                      shading_result *out)
{
    split p = choose_split(scene, s, point->shade_count);
    branch first = {.ray = *point->ray, .is_white = true};
    tracer t = {.scene = scene, .radiance = vec3(0.0f), .behind = vec3(0.0f), .unseen = vec3(0.0f)};
    vec3 weight = vec3(1.0f);
    if (is_outer_surface(&first, s)) {
        surface_light light = surface_light_at(scene, s);
        t.radiance = light.radiance;
        t.rays = light.rays;
        weight = light.through;
    } else { /* the camera is in the volume */
        media_enter(&first.media, s->hit.geometry->material, 0.0f);
    }
    boundary y = boundary_of(scene, &first, point->hit, s);
    vec3 colors = p.is_dispersed ? color_sum(&p, point) : vec3((float)p.count);
    /* Four times its part of the lobe, which that widens by a tenth: bright lights leave no fireflies. */
    t.share = p.is_rough ? min(4.0f / (float)p.total, 1.0f) : 1.0f;
    t.least_weight = MIN_WEIGHT[scene->quality] * (p.is_rough ? BLURRED : 1.0f) / (float)p.count;
    uint32_t place = ray_samples_place(point->x, point->y);
    for (uint32_t i = 0; i < p.count; i++) {
        branch b = first;
        vec3 share = weight / colors;
        if (p.is_dispersed) {
            b.is_white = false;
            b.shift = shift_of_ray(&p, point, place, i);
            share *= color_weight(b.shift);
        }
        t.sample = place * p.total + point->shade * p.count + i;
        t.budget = p.budget;
        b.weight = share;
        travel(&t, &b, length(s->P - load3(point->ray->origin)));
        let_through(&t, &b, &y, b.weight);
        follow_all(&t);
    }
    conclude(&t, out);
}
