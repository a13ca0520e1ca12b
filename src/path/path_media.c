/* path_media.c - see path_media.h. */
#include <stdlib.h>
#include <string.h>

#include "cpu/shading_hit.h"

#include "path/path_media.h"

/* ---- nested dielectrics ---- */

/* The number of the key "priority" in extras. Only overlapping volumes read it. */
static long priority_of(const scene_material *m)
{
    const char *key = m->meta.extras ? strstr(m->meta.extras, "\"priority\"") : NULL;
    if (!key)
        return 0;
    key += strlen("\"priority\"");
    key += strspn(key, " \t\r\n");
    return *key == ':' ? strtol(key + 1, NULL, 10) : 0;
}

static float ior_of(const scene_material *m, float wavelength_nm)
{
    float ior = max(m->ior, 1.0f); /* 0: infinite, which transmits nothing */
    if (wavelength_nm > 0.0f && m->extensions & SCENE_DISPERSION && m->dispersion > 0.0f)
        return dispersed_ior_at(ior, m->dispersion, wavelength_nm);
    return ior;
}

static bool displaces(const scene_material *a, const scene_material *b)
{
    long priority_a = priority_of(a);
    long priority_b = priority_of(b);
    if (priority_a != priority_b)
        return priority_a > priority_b;
    if (a->ior < b->ior || a->ior > b->ior)
        return a->ior > b->ior;
    return a < b;
}

const medium *path_media_here(const media *m)
{
    const medium *here = NULL;
    for (uint32_t i = 0; i < m->count; i++)
        if (!here ||
            (m->volumes[i].material != here->material && displaces(m->volumes[i].material, here->material)))
            here = &m->volumes[i];
    return here;
}

float path_media_ior(const media *m, float wavelength_nm)
{
    const medium *here = path_media_here(m);
    return here ? ior_of(here->material, wavelength_nm) : 1.0f;
}

bool path_media_disperses(const media *m)
{
    const medium *here = path_media_here(m);
    return here && here->material->extensions & SCENE_DISPERSION && here->material->dispersion > 0.0f &&
           here->material->ior > 1.0f;
}

bool path_media_has(const media *m, const scene_material *material)
{
    for (uint32_t i = 0; i < m->count; i++)
        if (m->volumes[i].material == material)
            return true;
    return false;
}

/* ---- between surfaces ---- */

static float length_in(const medium *here, float distance_m)
{
    return distance_m < INFINITY ? distance_m : here->thickness_m;
}

static vec3 transmittance(const scene_material *m, float distance_m)
{
    return volume_transmittance(load3(m->attenuation_color), m->attenuation_distance, distance_m);
}

vec3 path_media_transmittance(const media *m, float distance_m)
{
    const medium *here = path_media_here(m);
    return here ? transmittance(here->material, length_in(here, distance_m)) : vec3(1.0f);
}

static bool scatters(const scene_material *m)
{
    return m->extensions & SCENE_VOLUME_SCATTER && m->attenuation_distance < INFINITY &&
           max3(load3(m->multiscatter_color)) > 0.0f;
}

/* The channel whose share of the weights contains u; also returns the shares. */
static int choose_channel(vec3 weights, float u, vec3 *shares)
{
    float sum = weights[0] + weights[1] + weights[2];
    *shares = weights * (1.0f / sum);
    if (u < (*shares)[0])
        return 0;
    return u < (*shares)[0] + (*shares)[1] || !((*shares)[2] > 0.0f) ? 1 : 2;
}

/* The extinction differs by channel: the distance is sampled from one channel, chosen in proportion to
 * beta, and weighted by the mean density of all (one-sample multiple importance sampling). */
path_flight path_media_sample_flight(const media *m, vec3 beta, float distance_m, float u_channel,
                                     float u_distance)
{
    path_flight out = {.weight = vec3(1.0f)};
    const medium *here = path_media_here(m);
    if (!here)
        return out;
    const scene_material *material = here->material;
    float length_m = length_in(here, distance_m);
    if (!scatters(material) || !(max3(beta) > 0.0f)) {
        out.weight = transmittance(material, length_m);
        return out;
    }
    /* max: the extinction of white is -0. */
    vec3 extinction =
        max(volume_extinction(load3(material->attenuation_color), material->attenuation_distance), 0.0f);
    vec3 shares;
    int channel = choose_channel(beta, u_channel, &shares);
    float t = -log(1.0f - u_distance) / extinction[channel];
    if (!(t < length_m)) {
        vec3 passed = exp(extinction * -length_m);
        out.weight = passed * (1.0f / dot(shares, passed));
        return out;
    }
    vec3 passed = exp(extinction * -t);
    vec3 albedo = single_scatter_albedo(clamp(load3(material->multiscatter_color), 0.0f, 1.0f));
    out.weight = albedo * extinction * passed * (1.0f / dot(shares, extinction * passed));
    out.distance_m = t;
    out.is_scattered = true;
    return out;
}
