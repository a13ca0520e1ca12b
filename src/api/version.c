/* version.c - what this build is and what it runs on. */
#include "base/text.h"

#include <stdio.h>
#include <string.h>

#include "build_config.h"
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

/* Adds a library: its version; that of its build and the file that is missing; or that the build does without. */
static void add_library(text *t, const char *name)
{
    for (uint32_t i = 0; i < facet_get_library_count(); i++) {
        const facet_library_info info = facet_get_library(i);
        if (strcmp(info.name, name) != 0)
            continue;
        text_addf(t, "%s ", name);
        if (!*info.built_version)
            text_add(t, "not built in");
        else if (*info.found_version)
            text_add(t, info.found_version);
        else
            text_addf(t, "missing: %s is not installed", info.file);
    }
}

/* Adds a line: text in which %NAME% stands for a library. */
static void add_line(text *t, const char *line)
{
    for (const char *mark = strchr(line, '%'); mark; mark = strchr(line, '%')) {
        char name[32];
        text_addf(t, "%.*s", (int)(mark - line), line);
        snprintf(name, sizeof name, "%.*s", (int)strcspn(mark + 1, "%"), mark + 1);
        add_library(t, name);
        line = mark + strlen(name) + 2;
    }
    text_addf(t, "%s\n", line);
}

size_t facet_build_report(char *out, size_t size)
{
    text t = {0};
    text_addf(&t, "facet     %s%s%s\n", FACET_VERSION, *FACET_BUILD_ID ? ", build " : "", FACET_BUILD_ID);
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
    add_line(&t, "rays      %Embree%");
    add_line(&t, "images    png (%libspng%, %libdeflate%), jpeg (%libjpeg-turbo%), webp (%libwebp%), exr "
                 "(%OpenEXR%), hdr, pfm");
    add_line(&t, "textures  ktx2 (%Zstandard%, %astcenc%), avif (%libavif%)");
    add_line(&t, "geometry  meshopt, draco (%Draco%)");
    add_line(&t, "waves     %kissfft%");
    add_line(&t, "json      %jansson%");
    add_line(&t, "plots     csv, json, svg, pdf and png (%cairo%)");
    add_line(&t, "http      %libmicrohttpd%");
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
