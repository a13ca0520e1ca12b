/* view_api.c - facet_view(): what the caller leaves to the library, and the module that has the window. */
#include <math.h>

#include "api/api.h"
#include "base/result.h"
#include "render/render_gl.h"

enum { DEFAULT_PATH_SAMPLES = 4096 };

static facet_result load_model(void *user, const char *path, facet_view_model *model, facet_error *error)
{
    const facet_view_desc *view = user;
    const facet_scene_desc desc = {
        .allocator = view->allocator, .log = view->log, .thread_count = view->render.thread_count};
    *model = (facet_view_model){.orbit = facet_orbit_default()};
    return path ? facet_scene_load(path, &desc, &model->scene, error)
                : facet_scene_create_builtin(&desc, &model->scene, error);
}

static facet_result load_environment(void *user, const char *name, const facet_view_model *model,
                                     facet_environment **environment, facet_error *error)
{
    const facet_view_desc *view = user;
    const facet_environment_desc desc = {
        .allocator = view->allocator, .log = view->log, .thread_count = view->render.thread_count};
    if (name)
        return facet_environment_load(name, &desc, environment, error);
    if (facet_scene_has_environment(model->scene, &model->pose))
        return facet_environment_create_from_scene(model->scene, &model->pose, &desc, environment, error);
    return facet_environment_create_studio(&desc, environment, error);
}

static char *describe(void *user, const facet_view_image *image)
{
    (void)user;
    (void)image;
    return NULL;
}

static void print(void *user, const char *text)
{
    (void)user;
    (void)text;
}

static facet_result check(const facet_view_desc *d, facet_error *error)
{
    const facet_render_desc *r = &d->render;
    if (r->width > 16384 || r->height > 16384)
        return fail(error, FACET_ERROR_ARGUMENT, "window: %u x %u pixels; each side must be 1 to 16384",
                    r->width, r->height);
    if (!(facet_renderer_get_info(r->renderer).features & FACET_RENDERER_FEATURE_VIEW))
        return fail(error, FACET_ERROR_ARGUMENT, "window: renderer %d; OpenGL or path tracing was expected",
                    (int)r->renderer);
    if (!isfinite(r->exposure_ev) || !isfinite(r->environment_ev) || !isfinite(r->environment_rotation_rad))
        return fail(error, FACET_ERROR_ARGUMENT, "exposure, light: a value is not a finite number");
    return FACET_OK;
}

/* The functions of libfacet that the module uses for its window; it has copies of all others. */
static const gl_host host = {.renderer_create = facet_renderer_create,
                             .renderer_render = facet_renderer_render,
                             .renderer_destroy = facet_renderer_destroy,
                             .render_gl = render_by_gl,
                             .image_get_layer_count = facet_image_get_layer_count,
                             .image_get_layer = facet_image_get_layer,
                             .image_save = facet_image_save,
                             .image_destroy = facet_image_destroy,
                             .image_create = facet_image_create,
                             .scene_destroy = facet_scene_destroy,
                             .environment_destroy = facet_environment_destroy,
                             .camera_from_scene = facet_camera_from_scene};

facet_result facet_view(const facet_view_desc *desc, facet_error *error)
{
    static const facet_view_desc default_desc = {.render = {.renderer = FACET_RENDERER_KIND_GL}};
    facet_view_desc d = desc ? *desc : default_desc;
    const gl_entry *gl;
    facet_result result = check(&d, error);
    if (result == FACET_OK)
        result = gl_library_open(&gl, error);
    if (result != FACET_OK)
        return result;
    if (!d.render.width || !d.render.height) {
        d.render.width = 1024;
        d.render.height = 768;
    }
    if (!d.render.thread_count)
        d.render.thread_count = facet_thread_count();
    if (!d.render.samples)
        d.render.samples = 4;
    if (!d.path_samples)
        d.path_samples = DEFAULT_PATH_SAMPLES;
    facet_view_source *s = &d.source;
    if (!s->load_model || !s->load_environment) /* the two belong together */
        *s = (facet_view_source){.user = &d, .load_model = load_model, .load_environment = load_environment};
    s->describe = s->describe ? s->describe : describe;
    s->print = s->print ? s->print : print;
    return gl->view(&host, &d, error);
}
