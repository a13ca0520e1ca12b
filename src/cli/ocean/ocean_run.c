/* ocean_run.c - see ocean_run.h. */
#include "cli/ocean/ocean_run.h"

#include <string.h>

#include "cli/shared/failure.h"
#include "cli/shared/interrupt.h"

static const float BLACK_EV = -200.0f; /* 2 to this power is 0 */

facet_result ocean_run_set_sea(ocean_run *run, const ocean_options *options, facet_error *error)
{
    facet_sea_desc desc = options->sea;
    desc.allocator = run->base.allocator;
    desc.log = messages_log(&run->base.messages);
    facet_sea_destroy(run->sea);
    return facet_sea_create(&desc, &run->sea, error);
}

facet_camera ocean_run_camera(const ocean_run *run, const ocean_options *o)
{
    facet_camera camera = facet_sea_camera(run->sea, o->eye_height_m, o->heading_rad);
    for (int i = 0; i < 3 && o->picture.has_eye; i++) {
        camera.target[i] += (float)o->picture.eye[i] - camera.eye[i];
        camera.eye[i] = (float)o->picture.eye[i];
    }
    if (o->has_target)
        memcpy(camera.target, o->target, sizeof camera.target);
    if (o->fov_y_rad > 0.0f)
        camera.fov_y_rad = o->fov_y_rad;
    return camera;
}

/* But for exposure and camera. */
static facet_sea_render_desc desc_of(ocean_run *run, const ocean_options *o, const facet_sea_shading *look)
{
    facet_sea_render_desc d = {.render = o->picture.desc, .sky = o->sky, .shading = *look};
    d.render.allocator = run->base.allocator;
    d.render.log = messages_log(&run->base.messages);
    d.render.environment = run->environment;
    if (o->picture.environment.kind == ENVIRONMENT_NONE) /* a cell of --sweep without the others' light */
        d.render.environment_ev = BLACK_EV;
    return d;
}

facet_result ocean_run_meter(ocean_run *run, const ocean_options *o, facet_error *error)
{
    const facet_camera camera = ocean_run_camera(run, o);
    facet_sea_render_desc d = desc_of(run, o, &o->shading);
    d.render.camera = &camera;
    run->ev100 = o->ev100;
    facet_result result = o->has_ev100 ? FACET_OK : facet_sea_meter(run->sea, &d, &run->ev100, error);
    run->ev100 -= (double)d.render.exposure_ev;
    return result;
}

/* images_left: with this one; path tracing takes all the time that it gets, so they share it evenly. */
static facet_result draw(ocean_run *run, const ocean_options *o, const facet_sea_shading *look,
                         facet_tonemap tonemap, uint32_t images_left, progress *shown, facet_image **image,
                         facet_error *error)
{
    const facet_camera camera = ocean_run_camera(run, o);
    double left = interrupt_seconds_left();
    facet_result result = interrupt_check(shown->subject, error);
    if (result != FACET_OK)
        return result;
    facet_sea_render_desc d = desc_of(run, o, look);
    d.render.camera = &camera;
    d.render.progress = progress_callback(shown);
    d.render.tonemap = tonemap;
    bool is_path = d.render.renderer == FACET_RENDERER_KIND_PATH;
    d.render.time_limit_s = left > 1e29 ? 0.0 : is_path ? left / images_left : left;
    d.render.path.keeps_cancelled = true;
    d.render.exposure_ev = facet_exposure_from_ev100(run->ev100);
    interrupt_begin_polling(shown->subject, "drawing", shown->mode == PROGRESS_BAR);
    result = facet_sea_render(run->sea, run->model, &d, image, error);
    interrupt_end();
    progress_clear();
    return result;
}

/* Both halves, side by side; the look of before is for a display as it is. */
static facet_result draw_both(ocean_run *run, const ocean_options *o, progress *shown, facet_image **image,
                              facet_error *error)
{
    facet_image *halves[2] = {NULL, NULL};
    static const char *const labels[] = {"before", "now"};
    facet_sea_shading before = o->shading, now = o->shading;
    now.style = FACET_SEA_STYLE_PHYSICAL;
    if (!before.style)
        before.style = FACET_SEA_STYLE_LEGACY_INTENDED;
    before.stage = 0;
    facet_result result = draw(run, o, &before, FACET_TONEMAP_NONE, 1, shown, &halves[0], error);
    facet_tonemap tonemap = o->shading.style && !is_given(run->base.line, OPT_TONE_MAPPING)
                                ? FACET_TONEMAP_AGX
                                : o->picture.desc.tonemap;
    if (result == FACET_OK)
        result = draw(run, o, &now, tonemap, 1, shown, &halves[1], error);
    const facet_contact_sheet_desc sheet = {.allocator = run->base.allocator,
                                            .log = messages_log(&run->base.messages),
                                            .column_count = 2,
                                            .gap = 2,
                                            .labels = labels};
    if (result == FACET_OK)
        result = facet_image_create_sheet((const facet_image *const *)halves, 2, &sheet, image, error);
    facet_image_destroy(halves[0]);
    facet_image_destroy(halves[1]);
    return result;
}

facet_result ocean_run_draw(ocean_run *run, const ocean_options *o, ocean_step step, facet_image **image,
                            facet_error *error)
{
    progress shown = {.mode = run->base.progress,
                      .subject = step.output,
                      .start = interrupt_clock(),
                      .done_before = (double)step.index / step.count,
                      .share = 1.0 / step.count,
                      .last_percent = -10};
    return o->is_before_after ? draw_both(run, o, &shown, image, error)
                              : draw(run, o, &o->shading, o->picture.desc.tonemap, step.count - step.index,
                                     &shown, image, error);
}
