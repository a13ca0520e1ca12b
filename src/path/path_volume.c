/* path_volume.c - see path_volume.h. */
#include <stdlib.h>
#include <string.h>

#include "cpu/shading_hit.h"

#include "path/path_volume.h"

/* ---- nested bodies ---- */

/* The number of the key "priority" in extras, which is asked for where bodies overlap only. */
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
    float ior = max(m->ior, 1.0f); /* 0: infinite, of which nothing is transmitted */
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
            (m->bodies[i].material != here->material && displaces(m->bodies[i].material, here->material)))
            here = &m->bodies[i];
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
        if (m->bodies[i].material == material)
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

/* The channel whose share of weights u falls into; the shares. */
static int choose_channel(vec3 weights, float u, vec3 *shares)
{
    float sum = weights[0] + weights[1] + weights[2];
    *shares = weights * (1.0f / sum);
    if (u < (*shares)[0])
        return 0;
    return u < (*shares)[0] + (*shares)[1] || !((*shares)[2] > 0.0f) ? 1 : 2;
}

/* Free flight with an extinction that differs by channel: the distance is drawn by one channel, chosen by what each
 * carries, and weighted as if all had been asked (one-sample multiple importance sampling). */
bool path_fly(path *p, float distance_m, float u_channel, float u_distance)
{
    const medium *here = path_media_here(&p->media);
    if (!here)
        return false;
    const scene_material *m = here->material;
    float length_m = length_in(here, distance_m + p->skipped_m);
    if (!scatters(m) || !(max3(p->throughput) > 0.0f)) {
        p->throughput *= transmittance(m, length_m);
        return false;
    }
    /* max: that of white is -0. */
    vec3 extinction = max(volume_extinction(load3(m->attenuation_color), m->attenuation_distance), 0.0f);
    vec3 shares;
    int channel = choose_channel(p->throughput, u_channel, &shares);
    float t = -log(1.0f - u_distance) / extinction[channel];
    if (!(t < length_m)) {
        vec3 passed = exp(extinction * -length_m);
        p->throughput *= passed * (1.0f / dot(shares, passed));
        return false;
    }
    vec3 passed = exp(extinction * -t);
    vec3 albedo = single_scatter_albedo(clamp(load3(m->multiscatter_color), 0.0f, 1.0f));
    p->throughput *= albedo * extinction * passed * (1.0f / dot(shares, extinction * passed));
    p->P += p->D * (t - p->skipped_m);
    p->skipped_m = 0.0f;
    return true;
}
