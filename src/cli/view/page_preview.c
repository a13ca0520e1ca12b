/* page_preview.c - see page_preview.h. */
#include "cli/view/page_preview.h"

#include "base/result.h"
#include "cli/render/sequence.h"
#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"

/* The environment of the image: that of --env, else the model's own, which is *own, else the studio. */
static facet_result choose_environment(verb_run *run, const render_options *o, page_light *light,
                                       const facet_scene *scene, const facet_pose_desc *pose,
                                       facet_environment **own, facet_environment **environment,
                                       facet_error *error)
{
    const facet_environment_desc desc = verb_run_environment_desc(run, o->environment_cache);
    *own = *environment = NULL;
    if (o->desc.shading == FACET_SHADING_OGL1) /* OpenGL 1 has no environment */
        return FACET_OK;
    if (render_is_lit_by_scene(o, scene, pose)) {
        facet_result result = facet_environment_create_from_scene(scene, pose, &desc, own, error);
        *environment = *own;
        return result;
    }
    if (!light->is_read) {
        facet_result result = environment_input_load(&o->environment, &desc, &light->environment, error);
        if (result != FACET_OK) {
            failure_complete(error, environment_input_name(&o->environment), run->limits.max_memory_bytes);
            return result;
        }
    }
    light->is_read = true;
    *environment = light->environment;
    return FACET_OK;
}

/* Whether only OpenGL draws what the options ask for. */
static bool needs_gl(const render_options *o)
{
    const facet_gl_desc *gl = &o->desc.gl;
    return o->desc.ground == FACET_GROUND_SHADOW || gl->has_shadows || gl->bloom > 0.0f || gl->channel != 0 ||
           gl->brdf != 0;
}

static facet_render_desc desc_of(verb_run *run, const render_options *o, bool is_gl)
{
    facet_render_desc desc = o->desc;
    desc.allocator = run->allocator;
    desc.log = messages_log(&run->messages);
    if (is_gl)
        return desc;
    desc.renderer = FACET_RENDERER_KIND_PREVIEW;
    desc.gl = (facet_gl_desc){0};
    desc.ground = FACET_GROUND_NONE;
    return desc;
}

static facet_result render(verb_run *run, const facet_scene *scene, const facet_render_desc *desc,
                           facet_image **image, facet_error *error)
{
    facet_renderer *renderer;
    TRY(facet_renderer_create(scene, &run->allocator, &renderer, error));
    facet_result result = facet_renderer_render(renderer, desc, image, error);
    facet_renderer_destroy(renderer);
    return result;
}

static facet_result encode(verb_run *run, const facet_image *image, unsigned char **png, size_t *size,
                           facet_error *error)
{
    const facet_image_save_desc desc = {.allocator = run->allocator,
                                        .thread_count = run->limits.thread_count,
                                        .format = FACET_IMAGE_FORMAT_PNG,
                                        .png_compression = 9};
    return facet_image_encode(image, &desc, png, size, error);
}

/* Renders by OpenGL if that is needed and there, else on the CPU. */
static facet_result draw(verb_run *run, const render_options *o, const facet_scene *scene,
                         const facet_render_desc *view, const char *name, facet_image **image,
                         facet_error *error)
{
    progress quiet = {.mode = PROGRESS_NONE, .subject = name, .start = interrupt_clock(), .share = 1.0};
    facet_result result = FACET_ERROR_UNSUPPORTED;
    for (int is_gl = needs_gl(o); is_gl >= 0 && result != FACET_OK && result != FACET_ERROR_CANCELLED;
         is_gl--) {
        facet_render_desc desc = desc_of(run, o, is_gl);
        desc.pose = view->pose;
        desc.camera = view->camera;
        desc.environment = view->environment;
        desc.progress = progress_callback(&quiet);
        interrupt_begin_polling(name, "drawing its preview", false);
        result = render(run, scene, &desc, image, error);
        interrupt_end();
    }
    return result;
}

facet_result page_preview_render(verb_run *run, const render_options *options, page_light *light,
                                 facet_scene *scene, const char *model, const char *name, unsigned char **png,
                                 size_t *size, facet_error *error)
{
    sequence s;
    facet_camera camera;
    facet_environment *own = NULL;
    facet_image *image = NULL;
    render_options o = *options;
    TRY(sequence_create(scene, input_name(model), &o, &s, error));
    facet_render_desc desc = {.pose = s.pose, .camera = &camera};
    o.orbit.log = messages_log(&run->messages);
    facet_result result = choose_environment(run, &o, light, scene, &s.pose, &own, &desc.environment, error);
    if (result == FACET_OK)
        result = render_camera(scene, &(render_view){.pose = &s.pose}, &o, &camera, error);
    if (result == FACET_OK)
        result = draw(run, &o, scene, &desc, name, &image, error);
    if (result == FACET_OK)
        result = encode(run, image, png, size, error);
    facet_image_destroy(image);
    facet_environment_destroy(own);
    sequence_destroy(&s);
    return result;
}
