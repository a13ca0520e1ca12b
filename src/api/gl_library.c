/* gl_library.c - see gl_library.h. */
#define _GNU_SOURCE /* dladdr */
#include "api/gl_library.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/result.h"
#include "gl/gl_build.h"

static const char name[] = "facet_gl.so";

/* Beside what holds this code (libfacet.so, or a program that has it inside): installed, and where facet was built. */
static const char *const folders[] = {"facet", "../" FACET_LIBDIR_NAME "/facet", "../gl", "."};

static const gl_host host = {.renderer_create = facet_renderer_create,
                             .renderer_render = facet_renderer_render,
                             .renderer_destroy = facet_renderer_destroy,
                             .image_get_layer_count = facet_image_get_layer_count,
                             .image_get_layer = facet_image_get_layer,
                             .image_save = facet_image_save,
                             .image_destroy = facet_image_destroy,
                             .image_create = facet_image_create,
                             .scene_destroy = facet_scene_destroy,
                             .environment_destroy = facet_environment_destroy,
                             .camera_from_scene = facet_camera_from_scene};

static pthread_once_t once = PTHREAD_ONCE_INIT;
static const gl_entry *opened;
static char why[256]; /* it could not be opened */

static void *open_module(void)
{
    Dl_info self;
    char path[4096];
    const char *slash;
    if (!dladdr((const void *)&once, &self) || !self.dli_fname || !(slash = strrchr(self.dli_fname, '/')))
        slash = self.dli_fname = "./";
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        int length = snprintf(path, sizeof path, "%.*s/%s/%s", (int)(slash - self.dli_fname), self.dli_fname,
                              folders[i], name);
        if (length >= (int)sizeof path || access(path, F_OK) != 0)
            continue;
        void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
        if (!handle)
            snprintf(why, sizeof why, "%.200s", dlerror());
        return handle;
    }
    return dlopen(FACET_MODULE_FOLDER "/facet_gl.so", RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
}

static void open_once(void)
{
    void *handle = open_module();
    gl_entry_function *enter = NULL;
    if (handle)
        *(void **)&enter = dlsym(handle, "facet_gl_entry");
    if (enter)
        opened = enter(GL_ENTRY_BUILD, &host);
    if (enter && !opened)
        snprintf(why, sizeof why, "it belongs to another build of facet");
}

facet_result gl_library_open(const gl_entry **entry, facet_error *error)
{
    pthread_once(&once, open_once);
    *entry = opened;
    if (opened)
        return FACET_OK;
    return fail(error, FACET_ERROR_ENVIRONMENT, "OpenGL: facet's module %s cannot be opened%s%s%s", name,
                why[0] ? " (" : ": it is not installed", why, why[0] ? ")" : "");
}

const gl_host *gl_library_host(void)
{
    return &host;
}
