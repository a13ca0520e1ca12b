/* renderer.c - see renderer.h: the table of renderers. A build without Embree (FACET_WITHOUT_EMBREE: a browser's)
 * consists of this file and render_desc.c; its caller draws with gl_renderer.h. */
#include "render/renderer.h"

#include "base/result.h"
#include "gl/gl_entry.h"

#ifdef FACET_WITHOUT_EMBREE
#define NO_EMBREE "Embree"
#define RENDERER_OF_CPU(...)
#else
#include "render/render_cpu.h"
#include "render/render_gl.h"
#define NO_EMBREE NULL
#define RENDERER_OF_CPU(...) __VA_ARGS__, .create = render_cpu_create, .destroy = render_cpu_destroy
#endif

/* Channels other than light are shown without exposure and tone mapping, over black. */
static facet_result resolve_gl(facet_render_desc *d, facet_error *error)
{
    const facet_gl_desc *gl = &d->gl;
    if ((unsigned)gl->channel >= FACET_CHANNEL_COUNT || (unsigned)gl->brdf > FACET_BRDF_MULTISCATTER ||
        (unsigned)gl->transparency > FACET_TRANSPARENCY_WEIGHTED)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "channel %d, brdf %d, transparency %d: at least one is no constant of its type",
                    (int)gl->channel, (int)gl->brdf, (int)gl->transparency);
    if (!(gl->bloom >= 0.0f && gl->bloom <= 1.0f))
        return fail(error, FACET_ERROR_ARGUMENT, "bloom: %g; it is a share of the light, 0 to 1",
                    (double)gl->bloom);
    if (gl_channel_is_light(gl->channel))
        return FACET_OK;
    d->tonemap = FACET_TONEMAP_NONE;
    d->exposure_ev = 0.0f;
    d->background = FACET_BACKGROUND_COLOR;
    for (int i = 0; i < 3; i++)
        d->background_color[i] = 0.0f;
    return FACET_OK;
}

enum {
    SURFACE_AOVS = FACET_AOV_DEPTH | FACET_AOV_NORMAL | FACET_AOV_ALBEDO | FACET_AOV_MATERIAL_ID |
                   FACET_AOV_UV | FACET_AOV_OCCLUSION | FACET_AOV_OBJECT_ID | FACET_AOV_INSTANCE_ID |
                   FACET_AOV_CRYPTOMATTE,
    STATISTICS_AOVS = FACET_AOV_VARIANCE | FACET_AOV_SAMPLES /* of samples */
};

const renderer_row *renderer_get(facet_renderer_kind kind)
{
    static const renderer_row preview = {
        .title = "the preview",
        .info = {.name = "preview",
                 .features = FACET_RENDERER_FEATURE_GROUND | FACET_RENDERER_FEATURE_OGL1 |
                             FACET_RENDERER_FEATURE_SPECULAR_AA | FACET_RENDERER_FEATURE_SEA_STYLES |
                             FACET_RENDERER_FEATURE_AMBIENT_OCCLUSION,
                 .samples = {4, 1, 16},
                 .max_samples = 4096,
                 .aovs = SURFACE_AOVS},
        .lacks = NO_EMBREE,
        RENDERER_OF_CPU(.draw = render_preview_draw)};
    static const renderer_row path = {
        .title = "path tracing",
        .info = {.name = "path",
                 .features = FACET_RENDERER_FEATURE_PATH | FACET_RENDERER_FEATURE_GROUND |
                             FACET_RENDERER_FEATURE_VIEW | FACET_RENDERER_FEATURE_AMBIENT_OCCLUSION,
                 .samples = {64, 16, 512},
                 .max_samples = 1 << 24,
                 .aovs = SURFACE_AOVS | STATISTICS_AOVS},
        .lacks = NO_EMBREE,
        RENDERER_OF_CPU(.resolve = render_path_resolve, .draw = render_path_draw)};
    static const renderer_row gl = {
        .title = "OpenGL",
        .info = {.name = "gl",
                 .features = FACET_RENDERER_FEATURE_GL | FACET_RENDERER_FEATURE_GROUND |
                             FACET_RENDERER_FEATURE_OGL1 | FACET_RENDERER_FEATURE_SPECULAR_AA |
                             FACET_RENDERER_FEATURE_SEA_STYLES | FACET_RENDERER_FEATURE_VIEW,
                 .samples = {4, 1, 16},
                 .max_samples = 4096,
                 .aovs = SURFACE_AOVS},
        .poses_scene = true,
        .resolve = resolve_gl,
#ifndef FACET_WITHOUT_EMBREE
        .create = render_gl_create,
        .draw = render_gl_draw,
        .destroy = render_gl_destroy,
#endif
    };
    static const renderer_row *const table[RENDERER_COUNT] = {
        [FACET_RENDERER_KIND_PREVIEW] = &preview,
        [FACET_RENDERER_KIND_PATH] = &path,
        [FACET_RENDERER_KIND_GL] = &gl,
    };
    return (unsigned)kind < RENDERER_COUNT ? table[kind] : NULL;
}

facet_renderer_info facet_renderer_get_info(facet_renderer_kind kind)
{
    const renderer_row *r = renderer_get(kind);
    return r ? r->info : (facet_renderer_info){.name = NULL};
}
