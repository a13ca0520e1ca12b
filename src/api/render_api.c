/* render_api.c - facet_render() and facet_renderer: resolves the desc, lets a renderer fill the film, and
 * develops it. */
#include "api/api.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/result.h"
#include "film/meter.h"
#include "render/part.h"
#include "render/render_gl.h"

struct facet_renderer {
    renderer_set set; /* without a scene: borrows a window's renderer */
};

/* An image whose passes the caller wants to see. */
typedef struct watched_image {
    const facet_render_desc *desc;
    facet_image *image;
} watched_image;

/* The next pass overwrites the film. */
static void show_pass(void *user, const facet_image *unknown, uint32_t samples)
{
    const watched_image *w = user;
    (void)unknown;
    film_develop(&w->image->film, w->desc);
    w->desc->path.pass(w->desc->path.pass_user, w->image, samples);
}

/* ---- one image ---- */

/* The film is left as the renderer made it. */
static facet_result render_part(renderer_set *set, const facet_render_desc *desc, facet_image *image,
                                facet_error *error)
{
    facet_render_desc part;
    film *f = &image->film;
    TRY(part_narrow(desc, &part, error));
    image->is_part = true;
    TRY(film_create(&desc->allocator, part.crop[2], part.crop[3], desc->aovs, f, error));
    f->keeps_sums = true;
    TRY(renderer_set_draw(set, &part, f, &image->stats, error));
    return part_describe(set, desc, &part, image->stats.dropped_samples, f, error);
}

static facet_result render(facet_renderer *renderer, const facet_render_desc *resolved, facet_image *image,
                           facet_error *error)
{
    renderer_set *set = &renderer->set;
    facet_render_desc desc = *resolved;
    facet_camera camera;
    watched_image watched = {.desc = &desc, .image = image};
    if (!desc.camera && (desc.sea || !renderer_get(desc.renderer)->poses_scene)) {
        TRY(renderer_set_camera(set, &desc, &camera, error));
        desc.camera = &camera;
    }
    if (desc.meters_exposure && (set->scene || desc.sea)) {
        double ev100;
        TRY(renderer_set_meter(set, &desc, &ev100, error));
        desc.exposure_ev += (float)meter_exposure_ev(ev100);
    }
    if (desc.part.count)
        return render_part(set, &desc, image, error);
    facet_render_desc drawn = desc;
    if (desc.path.pass) {
        drawn.path.pass = show_pass;
        drawn.path.pass_user = &watched;
    }
    TRY(film_create(&desc.allocator, desc.crop[2], desc.crop[3], desc.aovs, &image->film, error));
    TRY(renderer_set_draw(set, &drawn, &image->film, &image->stats, error));
    film_develop(&image->film, &desc);
    return FACET_OK;
}

static facet_result render_image(facet_renderer *renderer, const facet_render_desc *resolved,
                                 facet_image **image, facet_error *error)
{
    double start = clock_seconds();
    facet_image *made = mem_zalloc(&resolved->allocator, 1, sizeof *made);
    if (!made)
        return fail_memory(error, "image", sizeof *made);
    facet_result result = render(renderer, resolved, made, error);
    if (result != FACET_OK) {
        facet_image_destroy(made);
        return result;
    }
    made->stats.thread_count = resolved->thread_count;
    made->stats.total_s = clock_seconds() - start;
    *image = made;
    return FACET_OK;
}

/* desc (NULL: {0}) resolved, of a scene or a sea. */
static facet_result resolve(const facet_scene *scene, const facet_render_desc *desc, facet_render_desc *out,
                            facet_error *error)
{
    static const facet_render_desc default_desc = {0};
    TRY(render_desc_resolve(desc ? desc : &default_desc, out, error));
    if (!scene && !out->sea)
        return fail(error, FACET_ERROR_ARGUMENT, "nothing to draw: there is neither a scene nor a sea");
    return FACET_OK;
}

facet_result facet_render(const facet_scene *scene, const facet_render_desc *desc, facet_image **image,
                          facet_error *error)
{
    *image = NULL;
    facet_render_desc resolved;
    facet_renderer renderer;
    TRY(resolve(scene, desc, &resolved, error));
    renderer_set_init(&renderer.set, scene, &resolved.allocator);
    facet_result result = render_image(&renderer, &resolved, image, error);
    renderer_set_clear(&renderer.set);
    return result;
}

facet_result render_by_gl(gl_renderer *gl, const facet_render_desc *desc, facet_image **image,
                          facet_error *error)
{
    *image = NULL;
    facet_render_desc resolved;
    render_gl state = {.scenes = gl};
    facet_renderer borrowed = {.set.scene = NULL};
    TRY(render_desc_resolve(desc, &resolved, error));
    borrowed.set.states[desc->renderer] = &state;
    return render_image(&borrowed, &resolved, image, error);
}

/* ---- several images ---- */

facet_result facet_renderer_create(const facet_scene *scene, const facet_allocator *allocator,
                                   facet_renderer **renderer, facet_error *error)
{
    *renderer = mem_zalloc(allocator, 1, sizeof **renderer);
    if (!*renderer)
        return fail_memory(error, "renderer", sizeof **renderer);
    renderer_set_init(&(*renderer)->set, scene, allocator);
    return FACET_OK;
}

facet_result facet_renderer_render(facet_renderer *renderer, const facet_render_desc *desc,
                                   facet_image **image, facet_error *error)
{
    *image = NULL;
    facet_render_desc resolved;
    TRY(resolve(renderer->set.scene, desc, &resolved, error));
    return render_image(renderer, &resolved, image, error);
}

facet_result facet_renderer_meter(facet_renderer *renderer, const facet_render_desc *desc, double *ev100,
                                  facet_error *error)
{
    *ev100 = 0.0;
    facet_render_desc resolved;
    TRY(resolve(renderer->set.scene, desc, &resolved, error));
    return renderer_set_meter(&renderer->set, &resolved, ev100, error);
}

void facet_renderer_destroy(facet_renderer *renderer)
{
    if (!renderer)
        return;
    renderer_set_clear(&renderer->set);
    mem_free(renderer);
}

facet_render_stats facet_image_get_render_stats(const facet_image *image)
{
    return image->stats;
}
