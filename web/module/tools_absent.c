/* tools_absent.c - what tools.wasm lacks, renderers and a window: the functions of facet.h that need them fail with
 * FACET_ERROR_UNSUPPORTED and a sentence. Counterpart of src/api/render_api.c, part_api.c, view_api.c, version.c and of
 * src/report/spheres.c. */
#include <stdio.h>

#include "api/api.h"
#include "base/result.h"
#include "report/spheres.h"

/* ---- renderers ---- */

static facet_result fail_to_render(facet_error *error)
{
    return fail(
        error, FACET_ERROR_UNSUPPORTED,
        "render: WebAssembly has no renderer for the CPU, which needs Embree; a page draws with WebGL 2 "
        "(facet-viewer), and facet built for the machine renders images");
}

facet_result facet_renderer_create(const facet_scene *scene, const facet_allocator *allocator,
                                   facet_renderer **renderer, facet_error *error)
{
    (void)scene, (void)allocator;
    *renderer = NULL;
    return fail_to_render(error);
}

facet_result facet_renderer_render(facet_renderer *renderer, const facet_render_desc *desc,
                                   facet_image **image, facet_error *error)
{
    (void)renderer, (void)desc;
    *image = NULL;
    return fail_to_render(error);
}

facet_result facet_renderer_meter(facet_renderer *renderer, const facet_render_desc *desc, double *ev100,
                                  facet_error *error)
{
    (void)renderer, (void)desc;
    *ev100 = 0.0;
    return fail_to_render(error);
}

void facet_renderer_destroy(facet_renderer *renderer)
{
    (void)renderer;
}

facet_result facet_part_read_info(const char *path, facet_part_info *info, facet_error *error)
{
    (void)path;
    *info = (facet_part_info){.count = 0};
    return fail_to_render(error);
}

facet_result facet_part_merge(const char *const *paths, size_t path_count, const facet_merge_desc *desc,
                              facet_image **image, facet_error *error)
{
    (void)paths, (void)path_count, (void)desc;
    *image = NULL;
    return fail_to_render(error);
}

facet_render_stats facet_image_get_render_stats(const facet_image *image)
{
    return image->stats;
}

facet_result facet_view(const facet_view_desc *desc, facet_error *error)
{
    (void)desc;
    return fail(error, FACET_ERROR_UNSUPPORTED,
                "view: WebAssembly has no window; a page shows models with facet-viewer");
}

/* ---- spheres of a conversion's report ---- */

facet_result sphere_stage_create(const facet_scene *scene, sphere_stage **out, facet_error *error)
{
    (void)scene;
    *out = NULL;
    return fail(
        error, FACET_ERROR_UNSUPPORTED,
        "report: the spheres of a page need a renderer for the CPU, which WebAssembly lacks; a report as "
        ".json has the numbers");
}

void sphere_stage_destroy(sphere_stage *stage)
{
    (void)stage;
}

facet_result sphere_draw(sphere_stage *stage, uint32_t material, sphere_style style, uint32_t size,
                         unsigned char **bytes, size_t *byte_count, facet_error *error)
{
    (void)stage, (void)material, (void)style, (void)size;
    *bytes = NULL;
    *byte_count = 0;
    return fail_to_render(error);
}

/* ---- the build ---- */

const char *facet_version(void)
{
    return FACET_VERSION;
}

uint32_t facet_get_library_count(void)
{
    return 0;
}

facet_library_info facet_get_library(uint32_t index)
{
    (void)index;
    return (facet_library_info){.name = "", .license = "", .built_version = ""};
}

size_t facet_build_report(char *out, size_t size)
{
    int length = snprintf(out, size,
                          "facet     %s\n"
                          "compiler  clang %s, WebAssembly with SIMD\n"
                          "threads   %u\n"
                          "renderers none: images are drawn with WebGL 2 by facet-viewer\n"
                          "images    png, jpeg, hdr, pfm; webp, exr by decoders of their own\n"
                          "textures  ktx2\n"
                          "geometry  meshopt; draco by a decoder of its own\n"
                          "plots     csv, json, svg\n",
                          FACET_VERSION, __clang_version__, facet_thread_count());
    return length > 0 ? (size_t)length : 0;
}
