/* denoise_fixture.c - a path tracer of spheres; see denoise_fixture.h. */
#include "film/denoise_fixture.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"

#include "shade/shade.h"

const char *const fixture_scene_names[FIXTURE_SCENE_COUNT] = {"box", "sky", "lights", "cutout"};

typedef enum sphere_kind { MATTE, GLOSSY, GLASS, VEIL } sphere_kind;

typedef struct sphere {
    vec3 center;
    float radius;
    sphere_kind kind;
    vec3 albedo, emission;
    float checks; /* per metre: the albedo alternates with a quarter of it; 0: uniform */
    float grain;  /* share of the albedo that a fine texture removes */
} sphere;

typedef struct scene {
    const sphere *spheres;
    int sphere_count;
    vec3 eye;
    vec3 sky, sun; /* radiance of the zenith; illuminance of the sun */
    bool has_background;
} scene;

/* ---- random numbers ---- */

typedef struct random_state {
    uint32_t value;
} random_state;

static uint32_t hash_bits(uint32_t x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

static float random_number(random_state *r)
{
    r->value += 0x9e3779b9u;
    return (float)(hash_bits(r->value) >> 8) * 0x1p-24f;
}

/* ---- geometry ---- */

typedef struct sphere_hit {
    float t;
    int index; /* -1: none */
    vec3 P, N; /* N outwards */
} sphere_hit;

static bool meets(const sphere *b, vec3 O, vec3 D, float *t)
{
    vec3 to = b->center - O;
    float along = dot(to, D);
    vec3 off = to - D * along;
    float inside = b->radius * b->radius - dot(off, off);
    if (inside < 0.0f)
        return false;
    float half = sqrtf(inside);
    float eps = 1e-4f * (1.0f + b->radius * 0.01f);
    *t = along - half > eps ? along - half : along + half;
    return *t > eps;
}

static sphere_hit nearest(const scene *s, vec3 O, vec3 D)
{
    sphere_hit h = {.t = FLT_MAX, .index = -1};
    float t;
    for (int i = 0; i < s->sphere_count; i++)
        if (meets(&s->spheres[i], O, D, &t) && t < h.t) {
            h.t = t;
            h.index = i;
        }
    if (h.index >= 0) {
        h.P = O + D * h.t;
        h.N = normalize(h.P - s->spheres[h.index].center);
    }
    return h;
}

static vec3 around(vec3 N, float x, float y, float z)
{
    vec3 T = normalize(cross(fabsf(N[0]) > 0.7f ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f), N));
    return T * x + cross(N, T) * y + N * z;
}

/* Cosine-power direction around N; n = 1 is Lambert's. */
static vec3 lobe(vec3 N, float n, random_state *r)
{
    float z = powf(random_number(r), 1.0f / (n + 1.0f));
    float phi = 2.0f * PI * random_number(r);
    float s = sqrtf(fmaxf(0.0f, 1.0f - z * z));
    return around(N, s * cosf(phi), s * sinf(phi), z);
}

static vec3 texture(const sphere *b, vec3 P)
{
    vec3 a = b->albedo;
    if (b->checks > 0.0f) {
        int parity = 0;
        for (int k = 0; k < 3; k++)
            parity += (int)floorf(P[k] * b->checks + 1e-3f);
        if (parity & 1)
            a = a * 0.25f;
    }
    if (b->grain > 0.0f) {
        uint32_t cell = 0;
        for (int k = 0; k < 3; k++)
            cell = hash_bits(cell + (uint32_t)(int)floorf(P[k] * 20.0f));
        a = a * (1.0f - b->grain * (float)(cell >> 8) * 0x1p-24f);
    }
    return a;
}

/* ---- light ---- */

static const vec3 sun_direction = {0.48f, 0.64f, 0.6f};

static vec3 sky_radiance(const scene *s, vec3 D)
{
    return s->sky * (0.3f + 0.7f * fmaxf(D[1], 0.0f));
}

/* Direct light reflected by a diffuse point P with normal N, over its albedo: a light chosen at random, and
 * the sun. */
static vec3 direct_light(const scene *s, vec3 P, vec3 N, random_state *r)
{
    vec3 sum = vec3(0.0f);
    int lights = 0;
    int chosen = -1;
    for (int i = 0; i < s->sphere_count; i++)
        if (s->spheres[i].emission[1] > 0.0f && random_number(r) * (float)++lights < 1.0f)
            chosen = i;
    if (chosen >= 0) {
        const sphere *b = &s->spheres[chosen];
        vec3 to = b->center - P;
        float d2 = dot(to, to);
        float least = sqrtf(fmaxf(0.0f, 1.0f - b->radius * b->radius / d2));
        float z = 1.0f - random_number(r) * (1.0f - least);
        float phi = 2.0f * PI * random_number(r);
        float sine = sqrtf(fmaxf(0.0f, 1.0f - z * z));
        vec3 L = around(to / sqrtf(d2), sine * cosf(phi), sine * sinf(phi), z);
        float NdotL = dot(N, L);
        if (NdotL > 0.0f && nearest(s, P, L).index == chosen)
            sum = b->emission * (2.0f * (1.0f - least) * NdotL * (float)lights);
    }
    vec3 L = normalize(sun_direction + lobe(sun_direction, 1.0f, r) * 0.2f);
    float NdotL = dot(N, L);
    if (s->sun[1] > 0.0f && NdotL > 0.0f && nearest(s, P, L).index < 0)
        sum = sum + s->sun * (NdotL * INV_PI);
    return sum;
}

typedef struct fixture_sample {
    vec3 radiance, albedo, normal;
    float opacity;
} fixture_sample;

static fixture_sample trace(const scene *s, vec3 O, vec3 D, random_state *r)
{
    fixture_sample out = {
        .radiance = vec3(0.0f), .albedo = vec3(0.0f), .normal = vec3(0.0f), .opacity = 1.0f};
    vec3 throughput = vec3(1.0f);
    bool has_features = false;
    bool sees_lights = true; /* else direct_light() has them */
    for (int depth = 0; depth < 12; depth++) {
        sphere_hit h = nearest(s, O, D);
        if (h.index < 0) {
            if (depth == 0 || (!has_features && !s->has_background))
                out.opacity = s->has_background ? 1.0f : 0.0f;
            if (out.opacity > 0.0f)
                out.radiance = out.radiance + throughput * sky_radiance(s, D);
            return out;
        }
        const sphere *b = &s->spheres[h.index];
        if (b->kind == VEIL && random_number(r) < 0.5f) {
            O = h.P;
            depth--;
            continue;
        }
        bool leaves = dot(h.N, D) > 0.0f;
        vec3 N = leaves ? -h.N : h.N;
        float cosine = -dot(N, D);
        vec3 albedo = texture(b, h.P);
        if (b->emission[1] > 0.0f) {
            if (sees_lights)
                out.radiance = out.radiance + throughput * b->emission;
            if (!has_features) {
                out.albedo = vec3(1.0f);
                out.normal = N;
            }
            return out;
        }
        float fresnel = 0.04f + 0.96f * powf(1.0f - cosine, 5.0f);
        if (b->kind == GLASS) {
            float eta = leaves ? 1.5f : 1.0f / 1.5f;
            float k = 1.0f - eta * eta * (1.0f - cosine * cosine);
            O = h.P;
            D = k < 0.0f || random_number(r) < fresnel ? D + N * (2.0f * cosine)
                                                       : D * eta + N * (eta * cosine - sqrtf(k));
            D = normalize(D);
            sees_lights = true;
            continue;
        }
        if (!has_features) {
            has_features = true;
            out.albedo = albedo;
            out.normal = N;
        }
        O = h.P;
        if (b->kind == GLOSSY && random_number(r) < 0.5f + 0.5f * fresnel) { /* a coat of half metal */
            D = lobe(D + N * (2.0f * cosine), 50.0f, r);
            if (dot(D, N) <= 0.0f)
                return out;
            sees_lights = true;
            continue;
        }
        throughput = throughput * albedo;
        out.radiance = out.radiance + throughput * direct_light(s, h.P, N, r);
        D = lobe(N, 1.0f, r);
        sees_lights = false;
        float survival =
            depth > 2 ? fminf(0.95f, fmaxf(throughput[0], fmaxf(throughput[1], throughput[2]))) : 1.0f;
        if (random_number(r) >= survival)
            return out;
        throughput = throughput / survival;
    }
    return out;
}

/* ---- scenes ---- */

enum { MAX_SPHERES = 80 };

static sphere plain(float x, float y, float z, float radius, sphere_kind kind, vec3 albedo)
{
    return (sphere){
        .center = vec3(x, y, z), .radius = radius, .kind = kind, .albedo = albedo, .emission = vec3(0.0f)};
}

static scene make_scene(fixture_scene which, sphere spheres[MAX_SPHERES])
{
    scene s = {.spheres = spheres, .eye = vec3(0.0f, 1.0f, 4.0f), .sky = vec3(0.0f), .sun = vec3(0.0f)};
    int n = 0;
    const float far = 1000.0f;
    sphere floor = plain(0.0f, -far, 0.0f, far, MATTE, vec3(0.7f, 0.65f, 0.6f));
    floor.checks = 2.0f;
    if (which == FIXTURE_BOX || which == FIXTURE_LIGHTS) {
        s.has_background = true;
        spheres[n++] = floor;
        spheres[n++] = plain(0.0f, far + 2.6f, 0.0f, far, MATTE, vec3(0.75f));
        spheres[n++] = plain(-far - 2.0f, 0.0f, 0.0f, far, MATTE, vec3(0.65f, 0.1f, 0.1f));
        spheres[n++] = plain(far + 2.0f, 0.0f, 0.0f, far, MATTE, vec3(0.1f, 0.5f, 0.15f));
        spheres[n++] = plain(0.0f, 0.0f, -far - 2.0f, far, MATTE, vec3(0.7f));
        spheres[n++] = plain(0.0f, 0.0f, far + 5.0f, far, MATTE, vec3(0.5f));
        spheres[n++] =
            plain(-1.0f, 0.6f, -0.6f, 0.6f, which == FIXTURE_BOX ? GLOSSY : MATTE, vec3(0.8f, 0.7f, 0.3f));
        spheres[n++] = plain(0.9f, 0.5f, 0.2f, 0.5f, which == FIXTURE_BOX ? GLASS : GLOSSY, vec3(0.9f));
        spheres[n] = plain(0.1f, 0.35f, -0.9f, 0.35f, MATTE, vec3(0.2f, 0.3f, 0.8f));
        spheres[n++].grain = 0.8f;
    }
    if (which == FIXTURE_BOX) {
        spheres[n] = plain(0.2f, 2.7f, 1.8f, 0.5f, MATTE, vec3(0.0f));
        spheres[n++].emission = vec3(8.0f, 7.0f, 5.5f);
    } else if (which == FIXTURE_LIGHTS) {
        for (uint32_t i = 0; i < 12; i++) {
            random_state r = {i * 77u};
            float x = 3.6f * random_number(&r) - 1.8f;
            float y = 0.1f + 2.3f * random_number(&r);
            float z = 4.2f + 0.6f * random_number(&r); /* behind the eye */
            spheres[n] = plain(x, y, z, 0.05f, MATTE, vec3(0.0f));
            vec3 hue = vec3(random_number(&r), random_number(&r), random_number(&r));
            spheres[n++].emission = hue * 12.0f + 1.0f;
        }
    } else if (which == FIXTURE_SKY) {
        s.has_background = true;
        s.sky = vec3(0.5f, 0.8f, 1.4f);
        s.sun = vec3(5.0f, 4.5f, 3.6f);
        floor.checks = 0.0f;
        floor.grain = 0.2f;
        spheres[n++] = floor;
        spheres[n] = plain(-0.9f, 0.7f, 0.0f, 0.7f, MATTE, vec3(0.8f, 0.3f, 0.2f));
        spheres[n++].grain = 0.5f;
        spheres[n] = plain(0.8f, 0.5f, 0.4f, 0.5f, MATTE, vec3(0.9f));
        spheres[n++].checks = 7.0f;
        spheres[n++] = plain(0.1f, 0.3f, 1.1f, 0.3f, GLOSSY, vec3(0.3f, 0.8f, 0.4f));
    } else {
        s.sky = vec3(1.2f, 1.0f, 0.9f);
        s.sun = vec3(3.0f);
        spheres[n] = plain(-0.6f, 1.2f, 0.0f, 0.8f, MATTE, vec3(0.9f, 0.4f, 0.2f));
        spheres[n++].checks = 5.0f;
        spheres[n++] = plain(0.7f, 0.9f, 0.5f, 0.6f, VEIL, vec3(0.2f, 0.4f, 0.9f));
        spheres[n++] = plain(0.3f, 1.8f, -0.5f, 0.4f, GLOSSY, vec3(0.02f));
    }
    s.sphere_count = n;
    return s;
}

/* ---- images ---- */

typedef struct drawing {
    const scene *scene;
    film *film;
    uint32_t samples, seed;
} drawing;

static void draw_pixel(const drawing *d, uint32_t x, uint32_t y)
{
    film *f = d->film;
    size_t i = (size_t)y * f->width + x;
    double sum[10] = {0}, square[3] = {0};
    random_state r = {hash_bits(hash_bits((uint32_t)i) + 77u * d->seed)};
    uint32_t strata = (uint32_t)sqrt((double)d->samples);
    for (uint32_t k = 0; k < d->samples; k++) {
        float sx = ((float)(k % strata) + random_number(&r)) / (float)strata;
        float sy = ((float)(k / strata % strata) + random_number(&r)) / (float)strata;
        float px = ((float)x + sx - 0.5f * (float)f->width) / (float)f->height;
        float py = (0.5f * (float)f->height - (float)y - sy) / (float)f->height;
        vec3 D = normalize(vec3(px, py, -1.1f));
        fixture_sample one = trace(d->scene, d->scene->eye, D, &r);
        for (int c = 0; c < 3; c++) {
            sum[c] += (double)one.radiance[c];
            square[c] += (double)one.radiance[c] * (double)one.radiance[c];
            sum[4 + c] += (double)one.albedo[c];
            sum[7 + c] += (double)one.normal[c];
        }
        sum[3] += (double)one.opacity;
    }
    double n = (double)d->samples;
    double length = sqrt(sum[7] * sum[7] + sum[8] * sum[8] + sum[9] * sum[9]);
    for (size_t c = 0; c < 4; c++)
        film_find(f, "")->pixels[4 * i + c] = (float)(sum[c] / n);
    for (size_t c = 0; c < 3; c++) {
        double mean = sum[c] / n;
        film_find(f, "albedo")->pixels[3 * i + c] = (float)(sum[4 + c] / n);
        film_find(f, "normal")->pixels[3 * i + c] = length > 0.0 ? (float)(sum[7 + c] / length) : 0.0f;
        film_find(f, "variance")->pixels[3 * i + c] =
            n > 1.0 ? (float)(fmax(square[c] / n - mean * mean, 0.0) / (n - 1.0)) : 0.0f;
    }
}

static void draw_rows(void *context, size_t begin, size_t end)
{
    const drawing *d = context;
    for (size_t y = begin; y < end; y++)
        for (uint32_t x = 0; x < d->film->width; x++)
            draw_pixel(d, x, (uint32_t)y);
}

film fixture_render(fixture_scene which, uint32_t width, uint32_t height, uint32_t samples, uint32_t seed)
{
    static const uint32_t aovs = FACET_AOV_NORMAL | FACET_AOV_ALBEDO | FACET_AOV_VARIANCE;
    sphere spheres[MAX_SPHERES];
    scene s = make_scene(which, spheres);
    film f;
    if (film_create(NULL, width, height, aovs, &f, NULL) != FACET_OK)
        abort();
    drawing d = {.scene = &s, .film = &f, .samples = samples, .seed = seed};
    parallel_for(0, height, 1, draw_rows, &d);
    return f;
}

film fixture_copy(const film *f)
{
    film copy = *f;
    for (uint32_t k = 0; k < f->layer_count; k++) {
        size_t count = (size_t)f->width * f->height * f->layers[k].channel_count;
        copy.layers[k].pixels = mem_alloc(NULL, count, sizeof(float));
        if (!copy.layers[k].pixels)
            abort();
        memcpy(copy.layers[k].pixels, f->layers[k].pixels, count * sizeof(float));
    }
    return copy;
}

double fixture_error(const film *f, const film *truth, bool is_relative)
{
    size_t count = (size_t)f->width * f->height;
    double mean = 0.0, sum = 0.0;
    for (size_t i = 0; i < 4 * count; i++)
        if (i % 4 < 3)
            mean += (double)truth->layers[0].pixels[i] / (3.0 * (double)count);
    const float *noise = film_find((film *)truth, "variance")->pixels;
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++) {
            double t = (double)truth->layers[0].pixels[4 * i + c];
            double e = (double)f->layers[0].pixels[4 * i + c] - t;
            double square = e * e - (double)noise[3 * i + c];
            sum += is_relative ? square / (t * t + 0.01 * mean * mean) : square;
        }
    return sqrt(fmax(sum, 0.0) / (3.0 * (double)count));
}
