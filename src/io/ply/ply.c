/* ply.c - see ply.h: the elements of the file one after the other, and the scene made of them. */
#include "io/ply/ply.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "io/obj/mtl_parts.h"
#include "io/ply/ply_reader.h"

bool ply_fail(ply_reader *r, facet_result result, const char *format, ...)
{
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    if (r->result == FACET_OK)
        r->result = fail(r->error, result, "%s: %s", r->scene->source, message);
    return false;
}

bool ply_fail_memory(ply_reader *r, const char *what)
{
    if (r->result == FACET_OK)
        r->result = fail_memory(r->error, what, (size_t)(r->end - r->begin));
    return false;
}

bool ply_detect(const void *bytes, size_t size)
{
    const char *p = bytes;
    return size >= 4 && memcmp(p, "ply", 3) == 0 && (p[3] == '\n' || p[3] == '\r' || p[3] == ' ');
}

/* ---- the parts of a scene ---- */

/* Vertices that no face uses are points. */
static bool make_cloud(ply_reader *r)
{
    obj_soup *s = &r->soup;
    s->is_cloud = true;
    s->v = mem_alloc(&r->desc->allocator, s->place_count, sizeof *s->v);
    if (!s->v)
        return ply_fail_memory(r, "points");
    if (s->place_count >= UINT32_MAX)
        return ply_fail(r, FACET_ERROR_LIMIT, "has more points than can be numbered");
    for (size_t i = 0; i < s->place_count; i++)
        s->v[i] = (uint32_t)i;
    s->corner_count = s->place_count;
    return true;
}

/* Faces without texture coordinates beside some that have them. */
static void fill_texcoords(obj_soup *s)
{
    if (s->t && s->texcoord_count == 0) {
        mem_free(s->t);
        s->t = NULL;
    }
}

/* The image that the header names, as base color. */
static void find_texture(ply_reader *r, const char *folder)
{
    if (!r->texture_file || r->soup.texcoord_count == 0)
        return;
    mtl_files files = {
        .scope = {.scene = r->scene,
                  .allocator = &r->desc->allocator,
                  .log = &r->desc->log,
                  .folder = folder,
                  .root = r->desc->root,
                  .max_file_bytes = r->desc->max_file_bytes ? r->desc->max_file_bytes : (uint64_t)1 << 32}};
    mtl_parser p = {.arena = r->scene->arena,
                    .allocator = &r->desc->allocator,
                    .scene = r->scene,
                    .log = &r->desc->log,
                    .file = r->scene->source,
                    .line = r->texture_line};
    uint32_t image = mtl_files_image(&files, &p, "", r->texture_file);
    if (image != SCENE_NONE)
        r->soup.base_color.texture = mtl_files_texture(&files, &(scene_texture){.name = "", .image = image});
    if (files.has_failed || p.has_failed || !mtl_files_finish(&files))
        ply_fail_memory(r, "texture");
    mtl_files_destroy(&files);
}

static bool add_part(ply_reader *r)
{
    if (!mem_reserve(&r->desc->allocator, (void **)&r->soup.parts, &r->soup.part_capacity, 1,
                     sizeof *r->soup.parts))
        return ply_fail_memory(r, "parts");
    r->soup.parts[r->soup.part_count++] = (obj_soup_part){.name = ""};
    return true;
}

static void read_elements(ply_reader *r)
{
    for (size_t i = 0; i < r->element_count && r->result == FACET_OK; i++) {
        const ply_element *e = &r->elements[i];
        if (strcmp(e->name, "vertex") == 0)
            ply_read_vertices(r, e);
        else if (strcmp(e->name, "face") == 0)
            ply_read_faces(r, e, false);
        else if (strcmp(e->name, "tristrips") == 0)
            ply_read_faces(r, e, true);
        else
            ply_skip_element(r, e);
    }
    if (r->result == FACET_OK && !r->soup.places)
        ply_fail(r, FACET_ERROR_INVALID, "has no element \"vertex\"");
}

static void read_all(ply_reader *r, const char *folder)
{
    if (ply_read_header(r))
        read_elements(r);
    if (r->result != FACET_OK || !add_part(r))
        return;
    fill_texcoords(&r->soup);
    if (r->soup.corner_count == 0 && !make_cloud(r))
        return;
    find_texture(r, folder);
    if (r->result == FACET_OK)
        r->result = obj_soup_finish(&r->soup, r->error);
    if (r->result == FACET_OK)
        scene_note(r->scene, &r->desc->log,
                   "%s: PLY names no unit and no upward axis; numbers are read as metres, with y up (--up z)",
                   r->scene->source);
}

static void release(ply_reader *r)
{
    for (size_t i = 0; i < r->element_count; i++)
        mem_free(r->elements[i].properties);
    mem_free(r->elements);
    obj_soup_release(&r->soup);
}

facet_result ply_load_memory(const void *bytes, size_t size, const char *name, const char *folder,
                             const facet_scene_desc *desc, facet_scene **scene, facet_error *error)
{
    const facet_scene_desc defaults = {0};
    ply_reader r = {.desc = desc ? desc : &defaults,
                    .error = error,
                    .begin = bytes,
                    .at = bytes,
                    .end = (const unsigned char *)bytes + size};
    *scene = NULL;
    r.result = scene_create(&r.desc->allocator, name, &r.scene, error);
    if (r.result != FACET_OK)
        return r.result;
    r.scene->max_texture_size = r.desc->max_texture_size;
    r.scene->thread_count = r.desc->thread_count;
    r.soup = obj_soup_begin(r.scene, r.desc);
    read_all(&r, folder);
    release(&r);
    if (r.result == FACET_OK)
        *scene = r.scene;
    else
        scene_destroy(r.scene);
    return r.result;
}
