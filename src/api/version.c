/* version.c - what this build is and what it runs on. */
#include "base/text.h"

#include <stdio.h>
#include <string.h>

#include "build_config.h"
#include "cpu/embree_scene.h"
#include "render/render_gl.h"
#include "render/renderer.h"

const char *facet_version(void)
{
    return FACET_VERSION;
}

static void add_cpu(text *t)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_cpu_init();
    text_addf(t, "cpu       x86-64%s%s%s%s\n", __builtin_cpu_supports("sse4.2") ? " sse4.2" : "",
              __builtin_cpu_supports("avx") ? " avx" : "", __builtin_cpu_supports("avx2") ? " avx2" : "",
              __builtin_cpu_supports("avx512f") ? " avx512f" : "");
#elif defined(__aarch64__)
    text_add(t, "cpu       aarch64\n");
#else
    text_add(t, "cpu       other\n");
#endif
}

static void add_opengl(text *t)
{
    const gl_entry *gl;
    facet_error error = {0};
    char line[256];
    if (gl_library_open(&gl, &error) == FACET_OK)
        gl->report(line, sizeof line);
    else
        snprintf(line, sizeof line, "%.250s", error.message);
    const char *subject = "OpenGL: ";
    bool names_itself = strncmp(line, subject, strlen(subject)) == 0;
    text_addf(t, "opengl    %s\n", names_itself ? line + strlen(subject) : line);
}

size_t facet_build_report(char *out, size_t size)
{
    text t = {0};
    text_addf(&t, "facet     %s\n", FACET_VERSION);
#if defined(__clang__)
    text_addf(&t, "compiler  clang %s, %s\n", __clang_version__, FACET_BUILD_TYPE);
#else
    text_addf(&t, "compiler  gcc %s, %s\n", __VERSION__, FACET_BUILD_TYPE);
#endif
    add_cpu(&t);
    text_addf(&t, "threads   %u\n", facet_thread_count());
    for (int i = 0; i < RENDERER_COUNT; i++)
        text_addf(&t, "%s%s", i ? ", " : "renderers ", renderer_get((facet_renderer_kind)i)->info.name);
    text_addf(&t, "\n");
    text_addf(&t, "embree    %s\n", embree_scene_version());
    text_addf(&t, "images    png (spng %s), jpeg (turbojpeg %s), webp (%s), exr (%s), hdr, pfm\n",
              FACET_SPNG_VERSION, FACET_TURBOJPEG_VERSION, FACET_WEBP_VERSION, FACET_OPENEXR_VERSION);
    text_addf(&t, "textures  ktx2 (%s, %s), avif (%s)\n", FACET_ZSTD_VERSION, FACET_ASTC_VERSION,
              FACET_AVIF_VERSION);
    text_addf(&t, "geometry  meshopt, draco (%s)\n", FACET_DRACO_VERSION);
    text_addf(&t, "json      jansson %s\n", FACET_JANSSON_VERSION);
    text_addf(&t, "plots     csv, json, svg, pdf, png (%s)\n", FACET_CAIRO_VERSION);
    text_addf(&t, "http      %s\n", FACET_MICROHTTPD_VERSION);
    add_opengl(&t);
    size_t length = t.length;
    if (size) {
        size_t copied = length < size ? length : size - 1;
        if (t.data)
            memcpy(out, t.data, copied);
        out[copied] = 0;
    }
    text_destroy(&t);
    return length;
}
