/* obj_soup.c - see obj_soup.h. */
#include "io/obj/obj_soup.h"

#include <math.h>
#include <string.h>

#include "base/result.h"
#include "io/obj/obj_reader.h"
#include "scene/origin.h"

obj_soup obj_soup_begin(facet_scene *scene, const facet_scene_desc *desc)
{
    obj_soup soup = {.scene = scene, .desc = desc};
    soup.base_color = scene_material_default().textures[SCENE_BASE_COLOR_TEXTURE];
    return soup;
}

void obj_soup_release(obj_soup *soup)
{
    mem_free(soup->places);
    mem_free(soup->normals);
    mem_free(soup->colors);
    mem_free(soup->texcoords);
    mem_free(soup->v);
    mem_free(soup->t);
    mem_free(soup->parts);
    *soup = (obj_soup){0};
}

/* ---- corners ---- */

static bool is_near(const float *p)
{
    return fabsf(p[0]) <= SCENE_FARTHEST && fabsf(p[1]) <= SCENE_FARTHEST && fabsf(p[2]) <= SCENE_FARTHEST;
}

/* Whether a triangle or point is kept; *lost counts those with invalid positions. */
static bool is_kept(const obj_reader *r, const uint32_t *v, size_t count, size_t *lost)
{
    for (size_t i = 0; i < count; i++)
        if (!is_near(r->positions + 3 * (size_t)v[i])) {
            (*lost)++;
            return false;
        }
    return count == 1 || (v[0] != v[1] && v[1] != v[2] && v[2] != v[0]);
}

static bool has_direction(const float *n)
{
    float sum = fabsf(n[0]) + fabsf(n[1]) + fabsf(n[2]);
    return sum > 0.0f && sum <= 1e37f;
}

/* The file's normals are used if all corners of a triangle have one. */
static void set_normals(obj_reader *r, size_t corner)
{
    bool has_all = r->normals != NULL;
    for (size_t i = corner; i < corner + 3 && has_all; i++)
        has_all = has_direction(r->normals + 3 * (size_t)r->v[i]);
    for (size_t i = corner; i < corner + 3; i++)
        r->n[i] = has_all ? r->v[i] : OBJ_ABSENT;
}

/* Moves the kept corners to the front, part by part. */
static void keep_corners(obj_reader *r, obj_soup *soup)
{
    size_t step = soup->is_cloud ? 1 : 3;
    size_t lost = 0;
    size_t part = 0;
    for (size_t i = 0; i + step <= soup->corner_count; i += step) {
        while (part < soup->part_count && soup->parts[part].begin <= i)
            r->primitives[part++].begin = r->corner_count;
        if (!is_kept(r, r->v + i, step, &lost))
            continue;
        memmove(r->v + r->corner_count, r->v + i, step * sizeof *r->v);
        if (r->t)
            memmove(r->t + r->corner_count, r->t + i, step * sizeof *r->t);
        if (r->n)
            set_normals(r, r->corner_count);
        r->corner_count += step;
    }
    while (part < soup->part_count)
        r->primitives[part++].begin = r->corner_count;
    r->triangle_corner_count = soup->is_cloud ? 0 : r->corner_count;
    if (lost)
        scene_warn(r->scene, &r->desc->log,
                   "%s: %zu %s a place that is not finite, or farther out than 1e17; left out",
                   r->scene->source, lost, soup->is_cloud ? "points have" : "triangles have");
}

/* The non-empty parts become primitives. */
static bool fill_primitives(obj_reader *r, const obj_soup *soup)
{
    size_t count = 0;
    for (size_t i = 0; i < soup->part_count; i++) {
        obj_primitive p = {.material = SCENE_NONE, .begin = r->primitives[i].begin, .v_minimum = UINT32_MAX};
        size_t end = i + 1 < soup->part_count ? r->primitives[i + 1].begin : r->corner_count;
        bool is_new;
        if (p.begin == end)
            continue;
        p.mode = soup->is_cloud ? SCENE_POINTS : SCENE_TRIANGLES;
        p.count = end - p.begin;
        p.object = obj_names_add(&r->objects, soup->parts[i].name, soup->parts[i].name_size, &is_new);
        if (p.object == UINT32_MAX)
            return obj_fail_memory(r, "names", soup->parts[i].name_size);
        for (size_t k = p.begin; k < end; k++) {
            p.v_minimum = r->v[k] < p.v_minimum ? r->v[k] : p.v_minimum;
            p.v_maximum = r->v[k] > p.v_maximum ? r->v[k] : p.v_maximum;
        }
        r->primitives[count++] = p;
    }
    r->primitive_count = (uint32_t)count;
    return true;
}

/* ---- the scene ---- */

/* A neutral two-sided surface; vertex colors and a texture appear unchanged. */
static bool make_material(obj_reader *r, const obj_soup *soup)
{
    facet_scene *scene = r->scene;
    scene->materials = arena_alloc(scene->arena, 1, sizeof *scene->materials);
    if (!scene->materials)
        return obj_fail_memory(r, "material", sizeof *scene->materials);
    scene_material m = scene_material_default();
    bool is_colored = soup->colors || soup->base_color.texture != SCENE_NONE;
    for (int k = 0; k < 3 && !is_colored; k++)
        m.base_color[k] = 0.6f;
    m.metallic = 0.0f;
    m.perceptual_roughness = 0.6f;
    m.is_double_sided = true;
    if (soup->base_color.texture != SCENE_NONE)
        m.textures[SCENE_BASE_COLOR_TEXTURE] = soup->base_color;
    for (size_t i = 0; soup->colors && i < soup->place_count; i++)
        if (soup->colors[4 * i + 3] < 1.0f)
            m.alpha_mode = SCENE_ALPHA_BLEND;
    scene->materials[0] = m;
    scene->material_count = 1;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++)
            scene->meshes[i].primitives[k].material = 0;
    return true;
}

static void round_places(obj_reader *r, const obj_soup *soup)
{
    for (size_t i = 0; i < 3 * soup->place_count; i++)
        r->positions[i] = (float)(soup->places[i] - r->origin[i % 3]);
}

/* Positions as floats, relative to an origin near them if they are far from that of the file. */
static bool set_positions(obj_reader *r, const obj_soup *soup)
{
    r->position_count = soup->place_count;
    r->positions = mem_alloc(r->allocator, soup->place_count, 3 * sizeof *r->positions);
    if (!r->positions)
        return obj_fail_memory(r, "positions", soup->place_count * 3 * sizeof *r->positions);
    round_places(r, soup);
    if (scene_find_origin(r->positions, r->position_count, r->allocator, r->origin))
        round_places(r, soup);
    return true;
}

static void make_scene(obj_reader *r, obj_soup *soup)
{
    bool needs_normals = !soup->is_cloud && (soup->normals || r->desc->obj_normals != FACET_OBJ_NORMALS_FLAT);
    if (soup->corner_count >= UINT32_MAX || soup->place_count > OBJ_MAX) {
        obj_fail_limit(r, "vertices");
        return;
    }
    r->primitives = mem_zalloc(r->allocator, soup->part_count + 1, sizeof *r->primitives);
    r->n = needs_normals ? mem_alloc(r->allocator, soup->corner_count, sizeof *r->n) : NULL;
    r->indices = arena_alloc(r->scene->arena, soup->corner_count, sizeof *r->indices);
    if (!r->primitives || (needs_normals && !r->n) || !r->indices) {
        obj_fail_memory(r, "corners", soup->corner_count * sizeof *r->n);
        return;
    }
    if (!set_positions(r, soup))
        return;
    keep_corners(r, soup);
    if (fill_primitives(r, soup))
        obj_make_normals(r);
    if (obj_is_ok(r))
        obj_make_vertices(r);
    if (obj_is_ok(r))
        obj_make_scene(r);
    if (obj_is_ok(r))
        make_material(r, soup);
    if (obj_is_ok(r) && r->primitive_count == 0)
        scene_warn(r->scene, &r->desc->log, "%s: has no triangle or point that can be drawn",
                   r->scene->source);
}

facet_result obj_soup_finish(obj_soup *soup, facet_error *error)
{
    obj_reader r = {.desc = soup->desc,
                    .allocator = &soup->desc->allocator,
                    .scene = soup->scene,
                    .error = error,
                    .thread_count = soup->desc->thread_count,
                    .objects.allocator = soup->desc->allocator,
                    .normals = soup->normals,
                    .normal_count = soup->normals ? soup->place_count : 0,
                    .colors = soup->colors,
                    .texcoords = soup->texcoords,
                    .texcoord_count = soup->texcoord_count,
                    .v = soup->v,
                    .t = soup->texcoord_count ? soup->t ? soup->t : soup->v : NULL};
    bool owns_t = r.t != r.v;
    if (!owns_t && r.t) { /* corner indices and texture coordinates move together */
        r.t = mem_alloc(r.allocator, soup->corner_count, sizeof *r.t);
        if (r.t && soup->corner_count)
            memcpy(r.t, soup->v, soup->corner_count * sizeof *r.t);
        if (!r.t)
            obj_fail_memory(&r, "corners", soup->corner_count * sizeof *r.t);
    }
    if (obj_is_ok(&r))
        make_scene(&r, soup);
    if (!owns_t)
        mem_free(r.t);
    mem_free(r.positions);
    mem_free(r.primitives);
    mem_free(r.n);
    mem_free(r.more_normals);
    obj_names_release(&r.objects);
    return r.result;
}
