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

/* The desc of options that ask for OpenGL, for the renderer on the CPU. */
static facet_render_desc cpu_desc(verb_run *run, const render_options *o)
{
    facet_render_desc desc = o->desc;
    desc.allocator = run->allocator;
    desc.log = messages_log(&run->messages);
    desc.renderer = FACET_RENDERER_KIND_PREVIEW;
    desc.gl = (facet_gl_desc){0};
    return desc;
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
    facet_render_desc desc = cpu_desc(run, &o);
    desc.pose = s.pose;
    desc.camera = &camera;
    o.orbit.log = desc.log;
    facet_result result = choose_environment(run, &o, light, scene, &s.pose, &own, &desc.environment, error);
    if (result == FACET_OK)
        result = render_camera(scene, &(render_view){.pose = &s.pose}, &o, &camera, error);
    progress quiet = {.mode = PROGRESS_NONE, .subject = name, .start = interrupt_clock(), .share = 1.0};
    desc.progress = progress_callback(&quiet);
    interrupt_begin_polling(name, "drawing its preview", false);
    facet_renderer *renderer = NULL;
    if (result == FACET_OK)
        result = facet_renderer_create(scene, &run->allocator, &renderer, error);
    if (result == FACET_OK)
        result = facet_renderer_render(renderer, &desc, &image, error);
    facet_renderer_destroy(renderer);
    interrupt_end();
    if (result == FACET_OK)
        result = encode(run, image, png, size, error);
    facet_image_destroy(image);
    facet_environment_destroy(own);
    sequence_destroy(&s);
    return result;
}
