/* frames.c - frames per second of one scene: a turntable, or its first animation if it has one; with one
 * facet_renderer and with facet_render() per frame, which must give the same bits.
 *
 *     frames MODEL [FRAMES] [SIZE] [ENVIRONMENT]     24 frames of 512 x 512 pixels, 4 samples; facet's studio
 *
 * Without saving. Memory: the peak of the process. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "base/clock.h"
#include "facet/facet.h"
#include "median.h"

typedef struct film_strip {
    facet_scene *scene;
    facet_environment *environment;
    facet_camera *cameras;
    uint32_t count, size;
    facet_animation animation;
    bool is_animated;
} film_strip;

static void check(facet_result result, const facet_error *error)
{
    if (result == FACET_OK)
        return;
    fprintf(stderr, "frames: %s\n", error->message);
    exit(1);
}

static facet_render_desc frame_desc(const film_strip *s, uint32_t frame)
{
    static const uint32_t first_animation = 0;
    facet_render_desc desc = {.width = s->size, .height = s->size, .environment = s->environment};
    desc.camera = &s->cameras[frame];
    if (s->is_animated) {
        desc.pose.animation_count = 1;
        desc.pose.animations = &first_animation;
        desc.pose.time_s = s->animation.begin_s +
                           (s->animation.end_s - s->animation.begin_s) * (double)frame / (double)s->count;
    }
    return desc;
}

static void make_cameras(film_strip *s)
{
    facet_error error;
    s->cameras = calloc(s->count, sizeof *s->cameras);
    if (!s->cameras)
        exit(1);
    for (uint32_t i = 0; i < s->count; i++) {
        facet_orbit orbit = facet_orbit_default();
        facet_render_desc desc = frame_desc(s, i);
        orbit.fits_all_azimuths = true;
        orbit.azimuth_rad = s->is_animated ? 0.5f : 6.2831853f * (float)i / (float)s->count;
        check(facet_camera_from_orbit(s->scene, &desc.pose, &orbit, 1.0f, &s->cameras[i], &error), &error);
        if (s->is_animated)
            s->cameras[i] = s->cameras[0];
    }
}

static long peak_megabytes(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
}

static uint64_t hash_image(const facet_image *rendered)
{
    facet_image_view view = facet_image_get_layer(rendered, 0);
    uint64_t hash = 14695981039346656037u; /* FNV-1a */
    for (uint32_t y = 0; y < view.height; y++) {
        const unsigned char *row = (const unsigned char *)view.pixels + y * view.row_stride_bytes;
        for (size_t i = 0; i < (size_t)view.width * view.channel_count * sizeof(float); i++)
            hash = (hash ^ row[i]) * 1099511628211u;
    }
    return hash;
}

/* Renders all frames; renderer NULL: each by facet_render(). */
static void run(const film_strip *s, facet_renderer *renderer, uint64_t *hashes, const char *name)
{
    facet_error error;
    double *seconds = calloc(s->count, sizeof *seconds);
    double geometry = 0.0;
    double textures = 0.0;
    double shade = 0.0;
    double cpu = cpu_seconds();
    if (!seconds)
        exit(1);
    for (uint32_t i = 0; i < s->count; i++) {
        facet_image *rendered;
        facet_render_desc desc = frame_desc(s, i);
        double start = clock_seconds();
        check(renderer ? facet_renderer_render(renderer, &desc, &rendered, &error)
                       : facet_render(s->scene, &desc, &rendered, &error),
              &error);
        seconds[i] = clock_seconds() - start;
        facet_render_stats stats = facet_image_get_render_stats(rendered);
        if (i > 0) { /* the first frame prepares what the others reuse */
            geometry += stats.geometry_s;
            textures += stats.textures_s;
            shade += stats.shade_s;
        } else {
            cpu = cpu_seconds();
        }
        hashes[i] = hash_image(rendered);
        facet_image_destroy(rendered);
    }
    double first = seconds[0], *others = seconds + (s->count > 1);
    double n = s->count > 1 ? (double)(s->count - 1) : 1.0;
    cpu = cpu_seconds() - cpu;
    double typical = median(others, s->count > 1 ? (int)s->count - 1 : 1);
    printf("%-9s first %6.1f ms; others: median %6.1f ms (%.1f frames/s), least %6.1f ms, CPU %6.1f ms: "
           "geometry "
           "%.1f, textures %.1f, shade %.1f; peak %ld MB\n",
           name, first * 1e3, typical * 1e3, 1.0 / typical, others[0] * 1e3, cpu / n * 1e3,
           geometry / n * 1e3, textures / n * 1e3, shade / n * 1e3, peak_megabytes());
    free(seconds);
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        fprintf(stderr, "usage: frames MODEL [FRAMES] [SIZE] [ENVIRONMENT]\n");
        return 2;
    }
    film_strip s = {.count = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 24,
                    .size = argc > 3 ? (uint32_t)strtoul(argv[3], NULL, 10) : 512};
    facet_error error;
    if (s.count == 0)
        s.count = 1;
    check(facet_scene_load(argv[1], NULL, &s.scene, &error), &error);
    check(argc > 4 ? facet_environment_load(argv[4], NULL, &s.environment, &error)
                   : facet_environment_create_studio(NULL, &s.environment, &error),
          &error);
    s.is_animated = facet_scene_get_counts(s.scene).animations > 0;
    if (s.is_animated)
        s.animation = facet_scene_get_animation(s.scene, 0);
    make_cameras(&s);
    uint64_t *hashes[2] = {calloc(s.count, sizeof **hashes), calloc(s.count, sizeof **hashes)};
    facet_renderer *renderer;
    check(facet_renderer_create(s.scene, NULL, &renderer, &error), &error);
    if (!hashes[0] || !hashes[1])
        return 1;
    run(&s, renderer, hashes[0], "renderer");
    facet_renderer_destroy(renderer);
    run(&s, NULL, hashes[1], "render");
    uint32_t different = 0;
    for (uint32_t i = 0; i < s.count; i++)
        different += hashes[0][i] != hashes[1][i];
    printf("%u of %u frames differ\n", different, s.count);
    free(hashes[0]);
    free(hashes[1]);
    free(s.cameras);
    facet_environment_destroy(s.environment);
    facet_scene_destroy(s.scene);
    return different != 0;
}
