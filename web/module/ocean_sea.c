/* ocean_sea.c - what an image needs of the options: the sea, at its time, and the exposure that facet ocean meters. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/result.h"
#include "ocean.h"

static void note_warning(void *user, facet_log_level level, const char *line)
{
    (void)user;
    if (level == FACET_LOG_LEVEL_WARNING)
        snprintf(ocean.message, sizeof ocean.message, "%s", line);
}

/* Whether both make the same waves and water. What messages and threads are is the same here. */
static bool is_same_sea(const facet_sea_desc *a, const facet_sea_desc *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

facet_result ocean_update_sea(facet_error *error)
{
    ocean_run *run = &ocean.settings.run;
    facet_sea_desc desc;
    memcpy(&desc, &run->options.sea, sizeof desc);
    desc.log = (facet_log){.message = note_warning};
    if (run->sea && is_same_sea(&desc, &ocean.sea_desc))
        return FACET_OK;
    facet_sea *made;
    TRY(facet_sea_create(&desc, &made, error));
    ocean_forget_frames();
    facet_sea_destroy(run->sea);
    run->sea = made;
    memcpy(&ocean.sea_desc, &desc, sizeof desc);
    ocean.metered_width = 0;
    return FACET_OK;
}

facet_result ocean_describe_side(ocean_side *side, const ocean_half *half, uint32_t width, uint32_t height,
                                 facet_error *error)
{
    const ocean_options *o = &ocean.settings.run.options;
    facet_render_desc d = o->render.desc;
    side->camera = ocean_run_camera(&ocean.settings.run, o);
    d.sea = ocean.settings.run.sea;
    d.sky = o->sky;
    d.sea_shading = half->shading;
    d.tonemap = half->tonemap;
    d.camera = &side->camera;
    d.width = width;
    d.height = height;
    d.log = (facet_log){.message = note_warning};
    d.exposure_ev = facet_exposure_from_ev100(ocean.ev100);
    return render_desc_resolve(&d, &side->desc, error);
}

/* Whether the exposure holds for a view: while the sea moves, also for nearly the same proportions, as the page adapts the
 * size of images to the machine. */
static bool is_metered(uint32_t width, uint32_t height, bool is_moving)
{
    double w = ocean.metered_width, h = ocean.metered_height;
    if (!is_moving)
        return w == width && h == height;
    return fabs(w * height - h * width) < 0.02 * w * height;
}

/* As the command: the sea at its beginning, so that all frames have one exposure. */
static facet_result meter(uint32_t width, uint32_t height, bool is_moving, facet_error *error)
{
    const ocean_options *o = &ocean.settings.run.options;
    const ocean_half half = {o->shading, o->render.desc.tonemap};
    ocean_side side = {.frame = NULL};
    if (is_metered(width, height, is_moving))
        return FACET_OK;
    ocean.ev100 = o->ev100;
    if (!o->has_ev100) {
        TRY(facet_sea_set_time(ocean.settings.run.sea, 0.0, error));
        TRY(ocean_describe_side(&side, &half, width, height, error));
        TRY(water_meter(&ocean.cache, &side.desc, &ocean.ev100, error));
    }
    ocean.ev100 -= (double)o->render.desc.exposure_ev;
    ocean.metered_width = width;
    ocean.metered_height = height;
    return FACET_OK;
}

facet_result ocean_prepare(uint32_t width, uint32_t height, bool is_moving, facet_error *error)
{
    TRY(ocean_update_sea(error));
    TRY(meter(width, height, is_moving, error));
    return facet_sea_set_time(ocean.settings.run.sea, ocean.time_s, error);
}
