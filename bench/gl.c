/* gl.c - frame times with OpenGL: each pass by GPU timers, the whole by the clock.
 *
 *     gl [-n FRAMES] [-s WxH] [-m SAMPLES] [-e] [-o] [-b] [MODEL]
 *       -n   50 frames, after 5 untimed ones
 *       -s   1920x1080
 *       -m   4 samples a pixel
 *       -e   OpenGL ES in place of OpenGL
 *       -o   the model with OpenGL 1 shading: Blinn-Phong beside physically based
 *       -b   the environment as background
 *
 * Frames are those of a window: a target of RGBA8, tone-mapped, one camera, the studio environment.
 * Milliseconds of passes are medians over the frames; "frame" is the wall time over all of them, without
 * waiting for the GPU in between; "first" is the first frame with all uploads and compilations, and "context"
 * the time before it. */
#define _POSIX_C_SOURCE 200809L
#include <epoxy/gl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "gl/scene/gl_renderer.h"
#include "median.h"

enum { MAX_FRAMES = 10000, UNTIMED_FRAMES = 5 };

static struct {
    uint32_t frames, width, height, samples;
    bool is_es, is_ogl1, has_background;
    const char *model;
} options = {.frames = 50, .width = 1920, .height = 1080, .samples = 4};

static double passes[GL_TIMER_COUNT][MAX_FRAMES];

static void check(facet_result result, const facet_error *error)
{
    if (result == FACET_OK)
        return;
    fprintf(stderr, "gl: %s\n", error->message);
    exit(result == FACET_ERROR_SYSTEM ? 8 : 1);
}

static void read_options(int argc, char **argv)
{
    for (int option; (option = getopt(argc, argv, "n:s:m:eob")) != -1;) {
        bool is_good = true;
        switch (option) {
        case 'n':
            options.frames = (uint32_t)atoi(optarg);
            is_good = options.frames >= 1 && options.frames <= MAX_FRAMES;
            break;
        case 's':
            is_good = sscanf(optarg, "%ux%u", &options.width, &options.height) == 2;
            break;
        case 'm':
            options.samples = (uint32_t)atoi(optarg);
            break;
        case 'e':
            options.is_es = true;
            break;
        case 'o':
            options.is_ogl1 = true;
            break;
        case 'b':
            options.has_background = true;
            break;
        default:
            is_good = false;
        }
        if (!is_good) {
            fprintf(stderr, "usage: gl [-n FRAMES] [-s WxH] [-m SAMPLES] [-e] [-o] [-b] [MODEL]\n");
            exit(2);
        }
    }
    options.model = optind < argc ? argv[optind] : NULL;
}

static facet_scene *load(facet_error *error)
{
    facet_scene *scene;
    check(options.model ? facet_scene_load(options.model, NULL, &scene, error)
                        : facet_scene_create_builtin(NULL, &scene, error),
          error);
    if (options.is_ogl1)
        check(facet_scene_convert_materials(scene, FACET_MATERIAL_MODEL_OGL1, NULL, NULL, error), error);
    return scene;
}

/* A target like that of a window. */
static GLuint make_window(void)
{
    GLuint texture, framebuffer;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, (GLsizei)options.width, (GLsizei)options.height, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, NULL);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    return framebuffer;
}

static void present(gl_renderer *renderer, const facet_render_desc *desc, GLuint window)
{
    facet_error error;
    facet_render_stats stats;
    check(gl_renderer_present(renderer, desc, window, 0, 0, &stats, &error), &error);
}

/* A single frame, and the times of its passes. */
static void time_passes(gl_renderer *renderer, const facet_render_desc *desc, GLuint window, uint32_t frame)
{
    present(renderer, desc, window);
    glFinish();
    present(renderer, desc, window); /* queries the results of the previous frame */
    glFinish();
    gl_times times = gl_renderer_get_times(renderer);
    for (int i = 0; i < GL_TIMER_COUNT; i++)
        passes[i][frame] = times.ms[i];
}

static void print_passes(void)
{
    double sum = 0.0;
    for (int i = 0; i < GL_TIMER_COUNT; i++) {
        double ms = median(passes[i], (int)options.frames);
        sum += ms;
        if (ms > 0.0)
            printf("%-14s %9.3f ms\n", gl_timer_name((gl_timer)i), ms);
    }
    printf("%-14s %9.3f ms\n", "gpu", sum);
}

int main(int argc, char **argv)
{
    read_options(argc, argv);
    facet_error error;
    double begin = clock_seconds();
    gl_context context;
    check(gl_context_create_api(&context, options.is_es ? GL_API_ES : GL_API_ANY, &error), &error);
    double context_s = clock_seconds() - begin;
    facet_scene *scene = load(&error);
    facet_environment *studio;
    check(facet_environment_create_studio(NULL, &studio, &error), &error);
    facet_camera camera;
    facet_orbit orbit = facet_orbit_default();
    check(facet_camera_from_orbit(scene, NULL, &orbit, (float)options.width / (float)options.height, &camera,
                                  &error),
          &error);
    const facet_render_desc desc = {.width = options.width,
                                    .height = options.height,
                                    .samples = options.samples,
                                    .environment = options.is_ogl1 ? NULL : studio,
                                    .camera = &camera,
                                    .tonemap = FACET_TONEMAP_NEUTRAL,
                                    .renderer = FACET_RENDERER_KIND_GL,
                                    .shading = options.is_ogl1 ? FACET_SHADING_OGL1 : FACET_SHADING_GLTF,
                                    .background = options.has_background ? FACET_BACKGROUND_ENVIRONMENT
                                                                         : FACET_BACKGROUND_TRANSPARENT,
                                    .thread_count = facet_thread_count()};
    gl_renderer *renderer;
    begin = clock_seconds();
    check(gl_renderer_create(scene, &context, NULL, &renderer, &error), &error);
    check(gl_context_make_current(&context, &error), &error);
    GLuint window = make_window();
    present(renderer, &desc, window);
    glFinish();
    double first_s = clock_seconds() - begin;
    for (int i = 0; i < UNTIMED_FRAMES; i++)
        present(renderer, &desc, window);
    for (uint32_t i = 0; i < options.frames; i++)
        time_passes(renderer, &desc, window, i);
    begin = clock_seconds();
    for (uint32_t i = 0; i < options.frames; i++)
        present(renderer, &desc, window);
    glFinish();
    double frame_s = (clock_seconds() - begin) / options.frames;
    printf("%s: %s, %u x %u, %u samples, %s\n", context.name,
           options.model ? options.model : "built-in scene", options.width, options.height, options.samples,
           options.is_ogl1 ? "OpenGL 1" : "physically based");
    printf("%-14s %9.3f ms\n%-14s %9.3f ms\n", "context", 1e3 * context_s, "first", 1e3 * first_s);
    print_passes();
    printf("%-14s %9.3f ms, %.1f frames a second\n", "frame", 1e3 * frame_s, 1.0 / frame_s);
    gl_renderer_destroy(renderer);
    gl_context_destroy(&context);
    facet_environment_destroy(studio);
    facet_scene_destroy(scene);
    return 0;
}
