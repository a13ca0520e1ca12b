/* ibl.c - time and error of preparing environments. usage: ibl [-t THREADS] [-r RUNS] [-e] [-d FOLDER]
 * [ENVIRONMENT]       (default: the studio)
 *   -e   root mean square error of each level against direct summation over the image, in double
 *   -d   writes the levels as PNG files: faces side by side, as sRGB, scaled to a mean of 0.5 */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "ibl/environment.h"
#include "ibl/equirect.h"
#include "ibl/ibl.h"

#include "shade/shade.h"

typedef struct settings {
    const char *path;
    uint32_t thread_count;
    int runs;
} settings;

static facet_environment *open_environment(const settings *s)
{
    facet_environment *e = NULL;
    facet_error error = {0};
    facet_environment_desc desc = {.thread_count = s->thread_count};
    facet_result result = s->path ? facet_environment_load(s->path, &desc, &e, &error)
                                  : facet_environment_create_studio(&desc, &e, &error);
    if (result != FACET_OK) {
        fprintf(stderr, "%s\n", error.message);
        exit(1);
    }
    return e;
}

static const ibl_light *prepare(facet_environment *e, const ibl_light_desc *desc)
{
    const ibl_light *light = NULL;
    facet_error error = {0};
    if (ibl_light_prepare(e, desc, &light, &error) != FACET_OK) {
        fprintf(stderr, "%s\n", error.message);
        exit(1);
    }
    return light;
}

/* Best of the runs, each with its own environment. */
static void time_stage(const settings *s, const char *name, ibl_light_desc desc)
{
    double best = 1e9;
    double best_load = 1e9;
    desc.thread_count = s->thread_count;
    for (int i = 0; i < s->runs; i++) {
        double start = clock_seconds();
        facet_environment *e = open_environment(s);
        double loaded = clock_seconds();
        const ibl_light *light = prepare(e, &desc);
        double done = clock_seconds();
        ibl_light_release(light);
        facet_environment_destroy(e);
        best = fmin(best, done - loaded);
        best_load = fmin(best_load, loaded - start);
    }
    printf("%-28s %7.2f ms   (loading: %.2f ms)\n", name, 1e3 * best, 1e3 * best_load);
}

/* ---- error ---- */

enum { PROBE_COUNT = 192 };

typedef struct probing {
    const image *panorama;
    const ibl_light *light;
    float roughness;
    uint32_t size; /* of the level */
    double square[PROBE_COUNT], reference[PROBE_COUNT];
} probing;

/* Center of a texel of the level, where the lookup does not interpolate. */
static void probe_direction(size_t i, uint32_t size, float R[3])
{
    uint32_t hash = (uint32_t)i * 2654435761u;
    double d[3];
    uint32_t x = (hash >> 8) % size;
    uint32_t y = (hash >> 18) % size;
    cube_direction((uint32_t)i % 6, (2.0 * x + 1.0) / size - 1.0, (2.0 * y + 1.0) / size - 1.0, d);
    double scale = 1.0 / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int k = 0; k < 3; k++)
        R[k] = (float)(d[k] * scale);
}

static void probe_one(void *context, size_t begin, size_t end)
{
    probing *p = context;
    float alpha = alpha_from_roughness(p->roughness);
    uint32_t width = p->panorama->width;
    uint32_t height = p->panorama->height;
    uint32_t size = p->size;
    for (size_t i = begin; i < end; i++) {
        float R[3], got[3];
        probe_direction(i, size, R);
        double sum[3] = {0.0, 0.0, 0.0};
        double whole = 0.0;
        for (uint32_t y = 0; y < height; y++) {
            double row[3] = {0.0, 0.0, 0.0};
            double row_weight = 0.0;
            double theta = 3.14159265358979323846 * (y + 0.5) / height;
            double st = sin(theta);
            double ct = cos(theta);
            for (uint32_t x = 0; x < width; x++) {
                double phi = 6.283185307179586 * ((x + 0.5) / width - 0.5);
                double NdotL =
                    st * cos(phi) * (double)R[0] + ct * (double)R[1] + st * sin(phi) * (double)R[2];
                if (NdotL <= 0.0)
                    continue;
                float NdotH = (float)sqrt(0.5 + 0.5 * NdotL);
                double w = (double)D_GGX(NdotH, alpha) * NdotL;
                const float *c = (const float *)p->panorama->pixels + 3 * ((size_t)y * width + x);
                for (int k = 0; k < 3; k++)
                    row[k] += w * (double)c[k];
                row_weight += w;
            }
            double omega = equirect_texel_solid_angle(width, height, y);
            for (int k = 0; k < 3; k++)
                sum[k] += row[k] * omega;
            whole += row_weight * omega;
        }
        ibl_specular(p->light, R, p->roughness, got);
        p->square[i] = p->reference[i] = 0.0;
        for (int k = 0; k < 3; k++) {
            double reference = sum[k] / whole;
            double difference = (double)got[k] - reference;
            p->square[i] += difference * difference;
            p->reference[i] += reference * reference;
        }
    }
}

static void print_errors(const settings *s)
{
    facet_environment *e = open_environment(s);
    const ibl_light *light = prepare(
        e, &(ibl_light_desc){.thread_count = s->thread_count, .needs_specular = true, .max_roughness = 1.0f});
    for (uint32_t level = 1; level < prefilter_level_count(PREFILTER_GGX); level++) {
        probing p = {.panorama = &e->panorama,
                     .light = light,
                     .roughness = prefilter_roughness(PREFILTER_GGX, level),
                     .size = e->parts.levels[PREFILTER_GGX][level].size};
        parallel_for(s->thread_count, PROBE_COUNT, 1, probe_one, &p);
        double square = 0.0;
        double reference = 0.0;
        double relative = 0.0;
        for (int i = 0; i < PROBE_COUNT; i++) {
            square += p.square[i];
            reference += p.reference[i];
            relative += p.square[i] / (p.reference[i] + 1e-12);
        }
        double mean[3];
        cube_mean(&e->parts.levels[PREFILTER_GGX][level], mean);
        printf("roughness %.2f  size %3u  RMS error / RMS %.5f  RMS of relative error %.5f  mean G %.5f "
               "(panorama %.5f)\n",
               (double)p.roughness, e->parts.levels[PREFILTER_GGX][level].size, sqrt(square / reference),
               sqrt(relative / PROBE_COUNT), mean[1], (double)e->parts.harmonics.mean[1]);
    }
    ibl_light_release(light);
    facet_environment_destroy(e);
}

/* ---- images ---- */

static void write_faces(const cube *c, float scale, const char *folder, uint32_t level)
{
    uint32_t zoom = 128 / c->size ? 128 / c->size : 1;
    image out;
    uint32_t n = c->size * zoom;
    if (image_create(NULL, 4 * n, 3 * n, 3, IMAGE_U8, &out, NULL) != FACET_OK)
        exit(1);
    memset(out.pixels, 0, image_row_size(&out) * out.height);
    /* a cross: +Y above, -Y below, -X +Z +X -Z in a row */
    static const uint8_t column[6] = {2, 0, 1, 1, 1, 3};
    static const uint8_t row[6] = {1, 1, 0, 2, 1, 1};
    for (uint32_t face = 0; face < 6; face++)
        for (uint32_t y = 0; y < n; y++)
            for (uint32_t x = 0; x < n; x++) {
                rgbx t = *cube_texel(c, face, (int)(x / zoom), (int)(y / zoom));
                unsigned char *p = (unsigned char *)out.pixels +
                                   3 * ((size_t)(row[face] * n + y) * out.width + column[face] * n + x);
                for (int k = 0; k < 3; k++) {
                    float v = srgb_from_linear1(clamp(t[k] * scale, 0.0f, 1.0f));
                    p[k] = (unsigned char)(v * 255.0f + 0.5f);
                }
            }
    unsigned char *bytes = NULL;
    size_t size = 0;
    char path[512];
    facet_error error;
    snprintf(path, sizeof path, "%s/level%u.png", folder, level);
    if (image_encode(&out, IMAGE_CODEC_PNG, &(image_encode_desc){0}, &bytes, &size, &error) != FACET_OK ||
        file_write(path, bytes, size, &error) != FACET_OK)
        fprintf(stderr, "%s\n", error.message);
    mem_free(bytes);
    image_destroy(&out);
}

static void write_images(const settings *s, const char *folder)
{
    facet_environment *e = open_environment(s);
    const ibl_light *light = prepare(
        e, &(ibl_light_desc){.thread_count = s->thread_count, .needs_specular = true, .max_roughness = 1.0f});
    for (uint32_t level = 1; level < prefilter_level_count(PREFILTER_GGX); level++)
        write_faces(&e->parts.levels[PREFILTER_GGX][level], 0.5f / e->parts.harmonics.mean[1], folder, level);
    ibl_light_release(light);
    facet_environment_destroy(e);
}

int main(int argc, char **argv)
{
    settings s = {.runs = 20};
    const char *folder = NULL;
    bool has_errors = false;
    int option = 0;
    while ((option = getopt(argc, argv, "t:r:ed:")) != -1) {
        if (option == 't')
            s.thread_count = (uint32_t)strtoul(optarg, NULL, 10);
        else if (option == 'r')
            s.runs = (int)strtol(optarg, NULL, 10);
        else if (option == 'e')
            has_errors = true;
        else if (option == 'd')
            folder = optarg;
        else
            return 2;
    }
    s.path = optind < argc ? argv[optind] : NULL;
    time_stage(&s, "irradiance", (ibl_light_desc){.needs_irradiance = true});
    time_stage(&s, "mirror only", (ibl_light_desc){.needs_specular = true});
    time_stage(&s, "roughness 0 to 0.16", (ibl_light_desc){.needs_specular = true, .max_roughness = 0.16f});
    time_stage(&s, "roughness 0.25 to 1",
               (ibl_light_desc){.needs_specular = true, .min_roughness = 0.25f, .max_roughness = 1.0f});
    time_stage(&s, "roughness 0.5 to 0.5",
               (ibl_light_desc){.needs_specular = true, .min_roughness = 0.5f, .max_roughness = 0.5f});
    time_stage(&s, "roughness 0 to 1", (ibl_light_desc){.needs_specular = true, .max_roughness = 1.0f});
    time_stage(&s, "all with irradiance",
               (ibl_light_desc){.needs_irradiance = true, .needs_specular = true, .max_roughness = 1.0f});
    time_stage(
        &s, "sheen 0.3",
        (ibl_light_desc){.needs_sheen = true, .min_sheen_roughness = 0.3f, .max_sheen_roughness = 0.3f});
    time_stage(&s, "sheen 0 to 1", (ibl_light_desc){.needs_sheen = true, .max_sheen_roughness = 1.0f});
    time_stage(&s, "all with irradiance and sheen 0.3",
               (ibl_light_desc){.needs_irradiance = true,
                                .needs_specular = true,
                                .max_roughness = 1.0f,
                                .needs_sheen = true,
                                .min_sheen_roughness = 0.3f,
                                .max_sheen_roughness = 0.3f});
    time_stage(&s, "background", (ibl_light_desc){.needs_background = true});
    if (has_errors)
        print_errors(&s);
    if (folder)
        write_images(&s, folder);
    return 0;
}
