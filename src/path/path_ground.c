/* path_ground.c - see path_ground.h. The ground is the first vertex of a path of its own, so that light which comes by way
 * of the model, through its glass or off its walls, counts as well. */
#include "cpu/volume_rays.h"

#include "path/path_ground.h"
#include "path/path_shadow.h"
#include "path/path_walk.h"

static const float UP[3] = {0.0f, 1.0f, 0.0f};

bool path_ground_is_met(const path_scene *scene, vec3 P, vec3 D, vec3 *out)
{
    float height = P[1] - scene->ground_y;
    if (!scene->has_ground || !(height > 0.0f) || !(D[1] < 0.0f))
        return false;
    *out = P - D * (height / D[1]);
    (*out)[1] = scene->ground_y;
    return max3(abs(*out)) < 1e15f;
}

/* The light that a ray brings, and that it would bring without the model. */
typedef struct ground_light {
    vec3 lit, open;
} ground_light;

/* Aimed at. A triangle that shines is part of the model. */
static ground_light aim(path *p, vec2 u, float u_light)
{
    ground_light g = {.lit = vec3(0.0f), .open = vec3(0.0f)};
    path_light_sample light;
    if (!path_lights_sample(p->scene->lights, p->from.P, p->from.N, u_light, u, &light))
        return g;
    float cosine = max(light.L[1], 0.0f);
    float pdf = pdf_cosine(cosine);
    vec3 radiance = light.radiance * (INV_PI * cosine * path_aimed_weight(p->scene, &light, pdf) / light.pdf);
    if (!(max3(radiance) > 0.0f))
        return g;
    if (light.geometry == VISIBILITY_NONE)
        g.open = radiance;
    g.lit = radiance * path_shadow(p, p->from.P, p->P, &p->media, &light);
    return g;
}

/* Met by a direction of density cosine / pi, which is what light counts for here: the throughput stays 1. */
static ground_light meet(path *p, vec2 u)
{
    p->D = mul(basis_from_normal(load3(UP)), sample_cosine(u));
    p->from.pdf = pdf_cosine(p->D[1]);
    p->from.is_chosen = true;
    p->angle = 0.1f * inversesqrt(max(p->from.pdf, 1e-3f));
    float pdf = path_lights_surroundings_pdf(p->scene->lights, p->from.P, p->from.N, p->D);
    vec3 open = path_lights_surroundings(p->scene->lights, p->D) * path_met_weight(p, pdf);
    path_walk(p);
    return (ground_light){.lit = p->radiance, .open = open};
}

static void add(vec3 light, float share, float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] += light[i] * share;
}

void path_ground_light(const path_scene *scene, path_sampler sampler, vec3 P, float share, path_sample *out)
{
    path p = {.scene = scene,
              .shading = &scene->setup->shading,
              .sampler = sampler,
              .throughput = vec3(1.0f),
              .from = {.P = P, .N = load3(UP)},
              .P = P,
              .depth = 1,
              .vertex = 1,
              .out = out};
    /* The model may stand on the plane: what touches it casts its shadow from there. */
    p.P[1] += volume_rays_tolerance_of(max3(abs(P)));
    path_sampler_begin(&p.sampler, p.vertex);
    vec2 u_light = path_sampler_pair(&p.sampler);
    vec2 u_direction = path_sampler_pair(&p.sampler);
    float u_which = path_sampler_number(&p.sampler);
    ground_light aimed = aim(&p, u_light, u_which);
    ground_light met = meet(&p, u_direction);
    add(aimed.lit + met.lit, share, out->ground_lit);
    add(aimed.open + met.open, share, out->ground_open);
}
