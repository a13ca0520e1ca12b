/* ply_faces.c - faces of a PLY file as triangles: lists of corners, polygons of any size, with texture
 * coordinates per corner if the file has them, and strips, in which -1 restarts. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "io/obj/obj_triangulate.h"
#include "io/ply/ply_reader.h"

/* The lists of a face that are used, and the triangles made from them. */
typedef struct faces {
    ply_reader *r;
    const ply_property *corners, *texcoords; /* NULL: none */
    double *list, *uvs;                      /* of the current face; blocks of mem_alloc() */
    size_t list_count, list_capacity, uv_count, uv_capacity;
    obj_polygon polygon;
    uint32_t *triangles;
    size_t triangle_capacity;
    size_t wrong_count, rough_count;
} faces;

static bool is_corner_list(const ply_property *p)
{
    return p->count_type != PLY_NONE &&
           (strcmp(p->name, "vertex_indices") == 0 || strcmp(p->name, "vertex_index") == 0 ||
            strcmp(p->name, "vertices") == 0);
}

static bool is_texcoord_list(const ply_property *p)
{
    return p->count_type != PLY_NONE &&
           (strcmp(p->name, "texcoord") == 0 || strcmp(p->name, "texcoords") == 0);
}

/* Reads the values of a property, those of a list into *list. False: the file ends before, or no memory. */
static bool read_list(faces *f, const ply_property *p, double **list, size_t *count, size_t *capacity)
{
    double number;
    *count = 0;
    if (!ply_read_value(f->r, p->count_type, &number))
        return false;
    for (double i = 0; i < number; i++) { /* memory grows with the data that is present */
        if (!mem_reserve(&f->r->desc->allocator, (void **)list, capacity, *count + 1, sizeof **list))
            return ply_fail_memory(f->r, "faces");
        if (!ply_read_value(f->r, p->type, *list + *count))
            return false;
        (*count)++;
    }
    return true;
}

static bool skip_property(ply_reader *r, const ply_property *p)
{
    double number;
    double item;
    if (!ply_read_value(r, p->count_type != PLY_NONE ? p->count_type : p->type, &number))
        return false;
    for (double i = 0; p->count_type != PLY_NONE && i < number; i++)
        if (!ply_read_value(r, p->type, &item))
            return false;
    return true;
}

static bool read_face(faces *f, const ply_element *e)
{
    f->list_count = f->uv_count = 0;
    for (size_t k = 0; k < e->property_count; k++) {
        const ply_property *p = &e->properties[k];
        bool is_ok = p == f->corners     ? read_list(f, p, &f->list, &f->list_count, &f->list_capacity)
                     : p == f->texcoords ? read_list(f, p, &f->uvs, &f->uv_count, &f->uv_capacity)
                                         : skip_property(f->r, p);
        if (!is_ok)
            return false;
    }
    return true;
}

/* ---- triangles ---- */

/* Appends corner i of the face. */
static bool put_corner(faces *f, size_t i)
{
    obj_soup *s = &f->r->soup;
    const facet_allocator *allocator = &f->r->desc->allocator;
    bool has_t = f->texcoords || s->t;
    if (!mem_reserve(allocator, (void **)&s->v, &s->corner_capacity, s->corner_count + 1, sizeof *s->v) ||
        (has_t && !mem_reserve(allocator, (void **)&s->t, &s->t_capacity, s->corner_count + 1, sizeof *s->t)))
        return ply_fail_memory(f->r, "faces");
    s->v[s->corner_count] = (uint32_t)f->list[i];
    if (has_t)
        s->t[s->corner_count] = f->texcoords && f->uv_count >= 2 * f->list_count
                                    ? (uint32_t)(s->texcoord_count - f->list_count + i)
                                    : OBJ_SOUP_NONE;
    s->corner_count++;
    return true;
}

/* Appends the texture coordinates of the face. */
static bool put_texcoords(faces *f)
{
    obj_soup *s = &f->r->soup;
    if (!f->texcoords || f->uv_count < 2 * f->list_count)
        return true;
    if (!mem_reserve(&f->r->desc->allocator, (void **)&s->texcoords, &s->texcoord_capacity,
                     s->texcoord_count + f->list_count, 2 * sizeof *s->texcoords))
        return ply_fail_memory(f->r, "texture coordinates");
    for (size_t i = 0; i < 2 * f->list_count; i++)
        s->texcoords[2 * s->texcoord_count + i] = fabs(f->uvs[i]) <= 1e30 ? (float)f->uvs[i] : 0.0f;
    s->texcoord_count += f->list_count;
    return true;
}

static bool is_place(const faces *f, double index)
{
    return index >= 0 && index < (double)f->r->soup.place_count && index == floor(index);
}

static bool put_polygon(faces *f)
{
    uint32_t count = (uint32_t)f->list_count;
    size_t needed = 3 * ((size_t)count - 2);
    if (!mem_reserve(&f->r->desc->allocator, (void **)&f->triangles, &f->triangle_capacity, needed,
                     sizeof *f->triangles) ||
        !obj_polygon_reserve(&f->polygon, count))
        return ply_fail_memory(f->r, "faces");
    for (uint32_t i = 0; i < count; i++)
        for (size_t k = 0; k < 3; k++) {
            double x =
                f->r->soup.places[3 * (size_t)f->list[i] + k] - f->r->soup.places[3 * (size_t)f->list[0] + k];
            f->polygon.points[3 * (size_t)i + k] = fabs(x) <= (double)SCENE_FARTHEST ? (float)x : 0.0f;
        }
    obj_triangulate(&f->polygon, count, f->triangles);
    f->rough_count += f->polygon.is_rough;
    for (size_t i = 0; i < needed; i++)
        if (!put_corner(f, f->triangles[i]))
            return false;
    return true;
}

static bool put_face(faces *f)
{
    for (size_t i = 0; i < f->list_count; i++)
        if (!is_place(f, f->list[i])) {
            f->wrong_count++;
            return true;
        }
    if (f->list_count < 3 || f->list_count >= UINT32_MAX / 4)
        return true;
    if (!put_texcoords(f))
        return false;
    return f->list_count > 3 ? put_polygon(f) : put_corner(f, 0) && put_corner(f, 1) && put_corner(f, 2);
}

/* Every corner of a strip from the third on completes a triangle; every second one is reversed. */
static bool put_strip(faces *f)
{
    size_t begin = 0;
    for (size_t i = 0; i < f->list_count; i++) {
        if (!is_place(f, f->list[i])) {
            f->wrong_count += f->list[i] != -1.0;
            begin = i + 1;
            continue;
        }
        if (i < begin + 2)
            continue;
        bool is_turned = (i - begin) % 2 == 1;
        if (!put_corner(f, i - 2 + is_turned) || !put_corner(f, i - 1 - is_turned) || !put_corner(f, i))
            return false;
    }
    return true;
}

/* ---- the elements ---- */

static void find_lists(faces *f, const ply_element *e, bool are_strips)
{
    for (size_t k = 0; k < e->property_count; k++) {
        const ply_property *p = &e->properties[k];
        if (!f->corners && is_corner_list(p))
            f->corners = p;
        if (!f->texcoords && !are_strips && is_texcoord_list(p) && f->r->soup.corner_count == 0)
            f->texcoords = p;
    }
    if (!f->texcoords)
        return;
    mem_free(f->r->soup.texcoords); /* coordinates of corners take precedence over those of vertices */
    f->r->soup.texcoords = NULL;
    f->r->soup.texcoord_count = 0;
}

static void warn_faces(faces *f, uint64_t announced, uint64_t count)
{
    ply_reader *r = f->r;
    if (count < announced)
        scene_warn(r->scene, &r->desc->log, "%s: is cut off: %llu faces were declared, %llu are there",
                   r->scene->source, (unsigned long long)announced, (unsigned long long)count);
    if (f->wrong_count)
        scene_warn(r->scene, &r->desc->log,
                   "%s: %zu faces refer to a vertex that does not exist; they are left out", r->scene->source,
                   f->wrong_count);
    if (f->rough_count)
        scene_warn(r->scene, &r->desc->log,
                   "%s: %zu polygons are so large that they were triangulated only roughly", r->scene->source,
                   f->rough_count);
}

static void warn_face_colors(const ply_reader *r, const ply_element *e)
{
    for (size_t k = 0; k < e->property_count && !r->soup.colors; k++)
        if (strcmp(e->properties[k].name, "red") == 0)
            scene_warn(r->scene, &r->desc->log,
                       "%s: colors of faces are not supported, only those of vertices", r->scene->source);
}

bool ply_read_faces(ply_reader *r, const ply_element *e, bool are_strips)
{
    faces f = {.r = r, .polygon.allocator = r->desc->allocator};
    uint64_t most = ply_max_elements(r, e);
    uint64_t count = 0;
    find_lists(&f, e, are_strips);
    bool is_ok =
        f.corners || e->count == 0 ||
        ply_fail(r, FACET_ERROR_INVALID,
                 "element \"%s\" has no list of corners; property list uchar int vertex_indices was expected",
                 e->name);
    while (is_ok && count < e->count && count < most && read_face(&f, e)) {
        is_ok = are_strips ? put_strip(&f) : put_face(&f);
        count++;
    }
    is_ok = is_ok && r->result == FACET_OK;
    if (is_ok) {
        warn_faces(&f, e->count, count);
        warn_face_colors(r, e);
    }
    mem_free(f.list);
    mem_free(f.uvs);
    mem_free(f.triangles);
    obj_polygon_release(&f.polygon);
    return is_ok;
}

bool ply_skip_element(ply_reader *r, const ply_element *e)
{
    uint64_t most = ply_max_elements(r, e);
    for (uint64_t i = 0; i < e->count && i < most; i++)
        for (size_t k = 0; k < e->property_count; k++)
            if (!skip_property(r, &e->properties[k]))
                return true; /* so that later elements find no data */
    return true;
}
