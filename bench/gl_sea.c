/* gl_sea.c - frame times of an animated sea with OpenGL, beside the legacy style on the same surface.
 *
 *     gl_sea [-n FRAMES] [-s WxH] [-p PRESET] [-e]
 *       -n   20 frames of each style, alternating, 1/24 s apart, after 2 untimed ones
 *       -s   640x360, one sample a pixel
 *       -p   trade-wind
 *       -e   OpenGL ES in place of OpenGL
 *
 * Medians over the frames of the wall time, in ms. waves: the time step; light: preparation of the frame's
 * lighting; upload: textures and buffers; draw: passes and reading back; processors: CPU time of all threads,
 * the driver's included, and the part of it in upload and draw. "first" is the first frame, with all
 * compilations. */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/clock.h"
#include "film/film.h"
#include "film/meter.h"
#include "gl/sea/gl_sea.h"
#include "median.h"
#include "ocean/sea.h"
#include "water/water_frame.h"

enum { MAX_FRAMES = 1000, UNTIMED_FRAMES = 2, STYLES = 2 };
typedef enum part { WAVES, LIGHT, UPLOAD, DRAW, FRAME, DRAW_PROCESSOR, PROCESSOR, PART_COUNT } part;

static struct {
    uint32_t frames, width, height;
    const char *preset;
    bool is_es;
} options = {.frames = 20, .width = 640, .height = 360, .preset = "trade-wind"};

static double times[STYLES][PART_COUNT][MAX_FRAMES];

static void check(facet_result result, const facet_error *error)
{
    if (result == FACET_OK)
        return;
    fprintf(stderr, "gl_sea: %s\n", error->message);
    exit(result == FACET_ERROR_SYSTEM ? 8 : 1);
}

static void read_options(int argc, char **argv)
{
    for (int option; (option = getopt(argc, argv, "n:s:p:e")) != -1;) {
        bool is_good = true;
        switch (option) {
        case 'n':
            options.frames = (uint32_t)atoi(optarg);
            is_good = options.frames >= 1 && options.frames <= MAX_FRAMES;
            break;
        case 's':
            is_good = sscanf(optarg, "%ux%u", &options.width, &options.height) == 2;
            break;
        case 'p':
            options.preset = optarg;
            break;
        case 'e':
            options.is_es = true;
            break;
        default:
            is_good = false;
        }
        if (!is_good) {
            fprintf(stderr, "usage: gl_sea [-n FRAMES] [-s WxH] [-p PRESET] [-e]\n");
            exit(2);
        }
    }
}

/* One frame; to: its times, or NULL. */
static void draw(gl_sea *renderer, water_cache *cache, facet_sea *sea, const facet_render_desc *desc,
                 double time_s, film *target, double *to[PART_COUNT])
{
    facet_error error;
    facet_render_stats stats = {.total_s = 0.0};
    water_frame *frame;
    double begin = clock_seconds(), processor = cpu_seconds();
    waves_set_time(&sea->waves, time_s);
    double stepped = clock_seconds();
    check(water_frame_create(cache, NULL, desc, &frame, &stats, &error), &error);
    double prepared = clock_seconds(), unlit = cpu_seconds();
    check(gl_sea_draw(renderer, frame, target, &stats, &error), &error);
    double end = clock_seconds(), drawn = cpu_seconds();
    water_frame_destroy(frame);
    if (!to)
        return;
    *to[WAVES] = 1e3 * (stepped - begin);
    *to[LIGHT] = 1e3 * (prepared - stepped);
    *to[UPLOAD] = 1e3 * stats.geometry_s;
    *to[DRAW] = 1e3 * stats.shade_s;
    *to[FRAME] = 1e3 * (end - begin);
    *to[DRAW_PROCESSOR] = 1e3 * (drawn - unlit);
    *to[PROCESSOR] = 1e3 * (drawn - processor);
}

static facet_sea *make_sea(void)
{
    facet_error error;
    facet_sea_desc desc;
    facet_sea *sea;
    check(sea_preset(options.preset, &desc, &error), &error);
    desc.thread_count = facet_thread_count();
    check(sea_create(&desc, &sea, &error), &error);
    return sea;
}

static void print_times(void)
{
    static const char *const names[PART_COUNT] = {"waves", "light",   "upload",    "draw",
                                                  "frame", "of draw", "processors"};
    printf("%-10s %9s %9s %9s\n", "", "physical", "before", "ratio");
    for (int p = 0; p < PART_COUNT; p++) {
        double physical = median(times[0][p], (int)options.frames),
               before = median(times[1][p], (int)options.frames);
        printf("%-10s %9.1f %9.1f %9.2f\n", names[p], physical, before, physical / before);
    }
}

int main(int argc, char **argv)
{
    read_options(argc, argv);
    facet_error error;
    gl_sea *renderer;
    check(gl_sea_create_api(options.is_es ? GL_API_ES : GL_API_ANY, NULL, &renderer, &error), &error);
    facet_sea *sea = make_sea();
    const facet_camera camera = facet_sea_camera(sea, 0.0f, 0.0f);
    facet_render_desc desc = {.sea = sea,
                              .sky = {.sun_elevation_rad = 0.384f, .sun_azimuth_rad = -0.63f},
                              .width = options.width,
                              .height = options.height,
                              .samples = 1,
                              .camera = &camera,
                              .crop = {0, 0, options.width, options.height},
                              .exposure_ev = (float)meter_exposure_ev(13.3),
                              .renderer = FACET_RENDERER_KIND_GL,
                              .thread_count = facet_thread_count()};
    water_cache cache = {.sea_serial = 0};
    film target = {.width = 0};
    check(film_create(NULL, options.width, options.height, 0, &target, &error), &error);
    double begin = clock_seconds();
    draw(renderer, &cache, sea, &desc, 0.0, &target, NULL);
    double first_s = clock_seconds() - begin;
    for (uint32_t i = 0; i < UNTIMED_FRAMES + options.frames; i++)
        for (int style = 0; style < STYLES; style++) {
            desc.sea_shading.style = style ? FACET_SEA_STYLE_LEGACY_INTENDED : FACET_SEA_STYLE_PHYSICAL;
            double *to[PART_COUNT];
            for (int p = 0; p < PART_COUNT; p++)
                to[p] = &times[style][p][i < UNTIMED_FRAMES ? 0 : i - UNTIMED_FRAMES];
            draw(renderer, &cache, sea, &desc, i / 24.0, &target, to);
        }
    printf("%s, %u x %u, first %.0f ms\n", options.preset, options.width, options.height, 1e3 * first_s);
    print_times();
    film_destroy(&target);
    water_cache_clear(&cache);
    sea_destroy(sea);
    gl_sea_destroy(renderer);
    return 0;
}
