/* gl_sea_model_none.c - see gl_sea_model.h: a build without Embree has seas without models (water_model_none.c), and
 * needs nothing of gl/scene to draw them. */
#include "gl/sea/gl_sea_model.h"

#include "base/memory.h"
#include "base/result.h"

facet_result gl_sea_model_begin(gl_sea_model *m, gl_context *context, const water_frame *frame,
                                const camera_rays *camera, gl_sea_block *block, facet_render_stats *stats,
                                facet_error *error)
{
    (void)m, (void)context, (void)frame, (void)camera, (void)block, (void)stats;
    return fail(error, FACET_ERROR_UNSUPPORTED, "sea: this facet was built without models in a sea");
}

facet_result gl_sea_model_identify(const gl_sea_model *m, const water_frame *frame, scene_identity **out,
                                   uint32_t *count, facet_error *error)
{
    (void)m, (void)frame, (void)error;
    *out = NULL;
    *count = 0;
    return FACET_OK;
}

facet_result gl_sea_model_draw(gl_sea_model *m, const water_frame *frame, const camera_rays *camera,
                               const gl_view *view, gl_sea_block *block, facet_error *error)
{
    (void)m, (void)frame, (void)camera, (void)view, (void)block, (void)error;
    return FACET_OK;
}

void gl_sea_model_bind(const gl_sea_model *m)
{
    (void)m;
}

facet_result gl_sea_model_draw_layers(gl_sea_model *m, const water_frame *frame, const camera_rays *camera,
                                      const gl_view *view, facet_error *error)
{
    (void)m, (void)frame, (void)camera, (void)view, (void)error;
    return FACET_OK;
}

void gl_sea_model_bind_layers(const gl_sea_model *m)
{
    (void)m;
}

void gl_sea_model_end(gl_sea_model *m)
{
    (void)m;
}
