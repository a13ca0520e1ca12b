/* view_shot.c - saves a view: an image of it, and the command line that renders it. */
#include "view/view_app.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/result.h"
#include "scene/scene.h"
#include "view/view_camera.h"

static facet_result save(view_app *a, const view_image *display, const char *path, facet_error *error)
{
    const facet_allocator *allocator = &a->desc->allocator;
    float *linear = view_image_to_linear(display, allocator);
    if (!linear)
        return fail_memory(error, "image", (size_t)display->width * display->height * 16);
    const facet_image_view view = {.name = "",
                                   .width = display->width,
                                   .height = display->height,
                                   .channel_count = 4,
                                   .pixels = linear,
                                   .row_stride_bytes = (size_t)display->width * 16};
    facet_image *image = NULL;
    facet_result result = a->host->image_create(&view, allocator, &image, error);
    if (result == FACET_OK)
        result = a->host->image_save(
            image, path, &(facet_image_save_desc){.allocator = *allocator, .format = FACET_IMAGE_FORMAT_PNG},
            error);
    a->host->image_destroy(image);
    mem_free(linear);
    return result;
}

facet_result view_shot_save(view_app *a, const char *path, bool has_panels, facet_error *error)
{
    if (a->scene && scene_has_file(a->scene, path))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: the model was read from it, and would be overwritten; name another file", path);
    facet_result result = view_show_into(a, has_panels, error);
    if (result != FACET_OK)
        return result;
    const view_surface *s = &a->shot;
    view_image display = {s->width, s->height,
                          mem_alloc(&a->desc->allocator, (size_t)s->width * s->height, 4)};
    if (!display.pixels)
        return fail_memory(error, "image", (size_t)s->width * s->height * 4);
    view_surface_read(s, display.pixels);
    result = save(a, &display, path, error);
    view_image_destroy(&display);
    return result;
}

/* helmet-1.png, helmet-2.png .. in the working directory. */
static bool find_name(const view_app *a, char *name, size_t size)
{
    const char *base = a->path ? path_base_name(a->path) : "facet";
    const char *extension = path_extension(base);
    int stem = (int)(strlen(base) - strlen(extension) - (*extension != 0));
    for (int i = 1; i < 10000; i++) {
        snprintf(name, size, "%.*s-%d.png", stem < 200 ? stem : 200, base, i);
        if (access(name, F_OK) != 0)
            return true;
    }
    return false;
}

void view_shot_key(view_app *a)
{
    char name[256];
    char text[1024];
    facet_error error;
    if (!find_name(a, name, sizeof name))
        snprintf(text, sizeof text, "%s: there are too many images already", name);
    else if (view_shot_save(a, name, false, &error) == FACET_OK)
        snprintf(text, sizeof text, "Saved %s", name);
    else
        snprintf(text, sizeof text, "%.1000s", error.message);
    view_app_say(a, text, 4.0);
}

/* A block of malloc(); NULL: there is none. */
static char *describe(view_app *a)
{
    uint32_t width;
    uint32_t height;
    facet_camera camera;
    view_window_size(a->window, &width, &height);
    if (!a->scene || !width)
        return NULL;
    facet_render_desc desc = view_show_desc(a, width, height, &camera);
    if (view_renderer_accumulates(desc.renderer) && a->traced[1].is_current)
        desc.samples = a->traced[1].samples;
    const view_state *s = &a->state;
    const facet_orbit orbit = view_camera_round(&s->orbit);
    facet_view_image image = {.model = a->path,
                              .environment = a->environment_name,
                              .render = &desc,
                              .orbit = s->camera == VIEW_NO_CAMERA ? &orbit : NULL,
                              .camera = s->camera == VIEW_NO_CAMERA ? 0 : (uint32_t)s->camera};
    memcpy(image.origin, a->scene->origin, sizeof image.origin);
    return a->desc->source.describe(a->desc->source.user, &image);
}

void view_shot_copy(view_app *a)
{
    char *text = describe(a);
    if (text) {
        view_window_copy(a->window, text);
        a->desc->source.print(a->desc->source.user, text);
    }
    view_app_say(a, text ? "Copied as a facet render command" : "There is no command for this", 2.0);
    free(text);
}

void view_shot_print(view_app *a)
{
    char *text = describe(a);
    if (text)
        a->desc->source.print(a->desc->source.user, text);
    free(text);
}
