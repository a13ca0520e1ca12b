/* render_gl.c - see render_gl.h. */
#define _GNU_SOURCE /* dladdr */
#include "render/render_gl.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <sys/auxv.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/result.h"
#include "gl/gl_build.h"
#include "water/water_frame.h"

static const char name[] = "facet_gl.so";

/* ---- the module ---- */

/* Folders searched, relative to the binary that holds this code (libfacet.so, or a program linked
 * statically): installed, and in the build tree. */
static const char *const folders[] = {"facet", "../" FACET_LIBDIR_NAME "/facet", "../gl", "../src/gl", "."};

static pthread_once_t once = PTHREAD_ONCE_INIT;
static const gl_entry *opened;
static char why[256]; /* reason why it could not be opened */

/* The folder of the binary that holds this code, with a trailing /; "": unknown. A program's name as its
 * caller gives it may be relative to a former working directory; a module found there could be anybody's,
 * so it is not searched. */
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

/* NULL: not found, or why is set to the reason why it could not be opened. */
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
        opened = enter(GL_ENTRY_BUILD);
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

/* ---- the renderer ---- */

facet_result render_gl_create(renderer_set *set, void **state, facet_error *error)
{
    render_gl *r = mem_zalloc(&set->allocator, 1, sizeof *r);
    if (!r)
        return fail_memory(error, "renderer", sizeof *r);
    r->set = set;
    *state = r;
    return FACET_OK;
}

void render_gl_destroy(void *state)
{
    render_gl *r = state;
    const gl_entry *gl;
    if ((r->scenes || r->seas) && gl_library_open(&gl, NULL) == FACET_OK) {
        gl->destroy(r->scenes);
        gl->destroy_sea(r->seas);
    }
    mem_free(r);
}

static facet_result draw_sea(render_gl *r, const gl_entry *gl, const facet_render_desc *desc, film *target,
                             facet_render_stats *stats, facet_error *error)
{
    water_frame *image;
    if (!r->seas)
        TRY(gl->create_sea(&r->set->allocator, &r->seas, error));
    TRY(water_frame_create(&r->set->water, r->set->scene, desc, &image, stats, error));
    facet_result result = gl->draw_sea(r->seas, image, target, stats, error);
    water_frame_destroy(image);
    return result;
}

facet_result render_gl_draw(void *state, const facet_render_desc *desc, film *target,
                            facet_render_stats *stats, facet_error *error)
{
    render_gl *r = state;
    const gl_entry *gl;
    TRY(gl_library_open(&gl, error));
    if (desc->sea)
        return draw_sea(r, gl, desc, target, stats, error);
    if (!r->scenes)
        TRY(gl->create(r->set->scene, &r->set->allocator, &r->scenes, error));
    return gl->render(r->scenes, desc, target, stats, error);
}
