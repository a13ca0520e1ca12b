/* gl_entry.c - see gl_entry.h. */
#include "gl/gl_entry.h"

#include <stdio.h>
#include <string.h>

#include "gl/gl_build.h"
#include "gl/scene/gl_renderer.h"
#include "gl/sea/gl_sea.h"

static facet_result create(const facet_scene *scene, const facet_allocator *allocator, gl_renderer **out,
                           facet_error *error)
{
    return gl_renderer_create(scene, NULL, allocator, out, error);
}

static void report(char *out, size_t size)
{
    gl_context context;
    facet_error error = {0};
    if (gl_context_create(&context, &error) != FACET_OK) {
        snprintf(out, size, "%s", error.message);
        return;
    }
    snprintf(out, size, "%s", context.name);
    gl_context_destroy(&context);
}

const gl_entry *facet_gl_entry(const char *build)
{
    static const gl_entry entry = {.create = create,
                                   .render = gl_renderer_render,
                                   .destroy = gl_renderer_destroy,
                                   .create_sea = gl_sea_create,
                                   .draw_sea = gl_sea_draw,
                                   .destroy_sea = gl_sea_destroy,
                                   .report = report,
                                   .view = view_run};
    return strcmp(build, GL_ENTRY_BUILD) == 0 ? &entry : NULL;
}
