/* render_api.c - facet_render(): fills in the desc, runs the renderer, develops the film. */
#include "api/api.h"
#include "base/clock.h"
#include "base/memory.h"
#include "base/result.h"
#include "cpu/preview.h"

#include <math.h>
#include <string.h>

enum { MAX_IMAGE_SIZE = 65536, MAX_SAMPLES = 4096 };

static uint32_t samples_of(facet_quality quality)
{
    switch (quality) {
    case FACET_QUALITY_DRAFT:
        return 1;
    case FACET_QUALITY_FINAL:
        return 16;
    default:
        return 4;
    }
}

/* The desc with every default filled in, or what is wrong with it. *camera holds a default camera. */
static facet_result resolve(const facet_scene *scene, const facet_render_desc *desc, facet_render_desc *out,
                            facet_camera *camera, facet_error *error)
{
    *out = *desc;
    if (!out->width && !out->height) {
        out->width = 1024;
        out->height = 768;
    }
    if (!out->width || !out->height || out->width > MAX_IMAGE_SIZE || out->height > MAX_IMAGE_SIZE)
        return fail(error, FACET_ERROR_ARGUMENT, "picture: %u x %u pixels; each side must be 1 to %d",
                    out->width, out->height, MAX_IMAGE_SIZE);
    const uint32_t *crop = out->crop;
    if (crop[0] || crop[1] || crop[2] || crop[3]) {
        if (!crop[2] || !crop[3] || crop[0] >= out->width || crop[1] >= out->height ||
            crop[2] > out->width - crop[0] || crop[3] > out->height - crop[1])
            return fail(error, FACET_ERROR_ARGUMENT,
                        "crop: %u,%u,%u,%u is not inside the picture of %u x %u pixels", crop[0], crop[1],
                        crop[2], crop[3], out->width, out->height);
    } else {
        out->crop[2] = out->width;
        out->crop[3] = out->height;
    }
    if (!out->samples)
        out->samples = samples_of(out->quality);
    if (out->samples > MAX_SAMPLES)
        return fail(error, FACET_ERROR_ARGUMENT, "samples: %u per pixel; the most are %d", out->samples,
                    MAX_SAMPLES);
    if (!isfinite(out->exposure_ev) || !isfinite(out->environment_ev) ||
        !isfinite(out->environment_rotation_rad))
        return fail(error, FACET_ERROR_ARGUMENT, "exposure, light: a value is not a finite number");
    if (!out->thread_count)
        out->thread_count = facet_thread_count();
    if (!out->camera) {
        facet_orbit orbit = facet_orbit_default();
        facet_result result = facet_camera_from_orbit(scene, &out->pose, &orbit,
                                                      (float)out->width / (float)out->height, camera, error);
        if (result != FACET_OK)
            return result;
        out->camera = camera;
    }
    return FACET_OK;
}

facet_result facet_render(const facet_scene *scene, const facet_render_desc *desc, facet_image **image,
                          facet_error *error)
{
    static const facet_render_desc default_desc = {0};
    *image = NULL;
    double start = clock_seconds();
    facet_render_desc resolved;
    facet_camera camera;
    facet_result result = resolve(scene, desc ? desc : &default_desc, &resolved, &camera, error);
    if (result != FACET_OK)
        return result;

    facet_image *made = mem_zalloc(&resolved.allocator, 1, sizeof *made);
    if (!made)
        return fail_memory(error, "image", sizeof *made);
    result = film_create(&resolved.allocator, resolved.crop[2], resolved.crop[3], resolved.aovs, &made->film,
                         error);
    if (result == FACET_OK)
        result = preview_render(scene, &resolved, &made->film, &made->stats, error);
    if (result != FACET_OK) {
        facet_image_destroy(made);
        return result;
    }
    film_develop(&made->film, resolved.tonemap,
                 resolved.background == FACET_BACKGROUND_COLOR ? resolved.background_color : NULL,
                 resolved.thread_count);
    made->stats.thread_count = resolved.thread_count;
    made->stats.total_s = clock_seconds() - start;
    *image = made;
    return FACET_OK;
}

struct facet_renderer {
    const facet_scene *scene;
};

facet_result facet_renderer_create(const facet_scene *scene, const facet_allocator *allocator,
                                   facet_renderer **renderer, facet_error *error)
{
    *renderer = mem_zalloc(allocator, 1, sizeof **renderer);
    if (!*renderer)
        return fail_memory(error, "renderer", sizeof **renderer);
    (*renderer)->scene = scene;
    return FACET_OK;
}

facet_result facet_renderer_render(facet_renderer *renderer, const facet_render_desc *desc,
                                   facet_image **image, facet_error *error)
{
    return facet_render(renderer->scene, desc, image, error);
}

void facet_renderer_destroy(facet_renderer *renderer)
{
    mem_free(renderer);
}

facet_render_stats facet_image_get_render_stats(const facet_image *image)
{
    return image->stats;
}
