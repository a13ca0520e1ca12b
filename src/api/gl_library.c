/* gl_library.c - see gl_library.h. */
#define _GNU_SOURCE /* dladdr */
#include "api/gl_library.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <sys/auxv.h>
#include <unistd.h>

#include "api/api.h"
#include "base/result.h"
#include "gl/gl_build.h"

static const char name[] = "facet_gl.so";

/* Beside what holds this code (libfacet.so, or a program that has it inside): installed, and where facet was built. */
static const char *const folders[] = {"facet", "../" FACET_LIBDIR_NAME "/facet", "../gl", "../src/gl", "."};

static const gl_host host = {.renderer_create = facet_renderer_create,
                             .renderer_render = facet_renderer_render,
                             .renderer_destroy = facet_renderer_destroy,
                             .render_gl = render_by_gl,
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

/* The folder of what holds this code, with a / behind; "": it cannot be told for sure. A program's own name is what its
 * caller says, and may be relative to a folder that is another one by now: what is found there is nobody's module. */
static void find_own_folder(char *folder, size_t size)
{
    Dl_info self, program;
    ssize_t length = -1;
    *folder = 0;
    if (!dladdr((const void *)&once, &self) || !self.dli_fname)
        return;
    if (dladdr((const void *)getauxval(AT_PHDR), &program) && program.dli_fbase == self.dli_fbase)
        length = readlink("/proc/self/exe", folder, size - 1);
    else if (*self.dli_fname == '/')
        length = snprintf(folder, size, "%s", self.dli_fname);
    if (length < 0 || (size_t)length >= size)
        length = 0;
    folder[length] = 0;
    char *slash = strrchr(folder, '/');
    folder[slash ? slash + 1 - folder : 0] = 0;
}

/* NULL: it is not there. Where it is and cannot be opened, why says so. */
static void *open_at(const char *path)
{
    if (access(path, F_OK) != 0)
        return NULL;
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!handle)
        snprintf(why, sizeof why, "%.200s", dlerror());
    return handle;
}

static void *open_module(void)
{
    char folder[4096], path[4096];
    find_own_folder(folder, sizeof folder);
    for (size_t i = 0; *folder && i < sizeof folders / sizeof *folders; i++) {
        int length = snprintf(path, sizeof path, "%s%s/%s", folder, folders[i], name);
        void *handle = length < (int)sizeof path ? open_at(path) : NULL;
        if (handle || why[0])
            return handle;
    }
    return open_at(FACET_MODULE_FOLDER "/facet_gl.so");
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
    if (!FACET_HAS_GL && !why[0])
        return fail(error, FACET_ERROR_SYSTEM, "OpenGL: this facet was built without it (libepoxy)");
    return fail(error, FACET_ERROR_SYSTEM, "OpenGL: facet's module %s cannot be opened%s%s%s", name,
                why[0] ? " (" : ": it is not installed", why, why[0] ? ")" : "");
}

const gl_host *gl_library_host(void)
{
    return &host;
}
