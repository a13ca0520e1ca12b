/* obj_write_geometry.c - positions, texture coordinates and normals of a pose as lists of OBJ: in world space, each value
 * once per piece, vertices that nothing uses left out. */
#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "image/srgb.h"
#include "io/obj/obj_write.h"

/* ---- values of one vertex ---- */

static void put_position(const obj_piece *piece, const facet_scene *scene, size_t vertex, float *out)
{
    const scene_instance *i = piece->instance;
    mat4_transform_point(&i->world, i->positions + 3 * vertex, out);
    if (piece->lists[OBJ_POSITIONS].width < 6)
        return;
    /* Colors of the file are those of its materials. */
    bool is_srgb = scene->legacy->colors != FACET_LEGACY_COLORS_LINEAR;
    for (int k = 0; k < 3; k++) {
        float linear = i->primitive->colors[4 * vertex + (size_t)k];
        out[3 + k] = is_srgb ? (float)srgb_encode((double)linear) : linear;
    }
}

static void put_normal(const obj_piece *piece, size_t vertex, float *out)
{
    const float *n = piece->instance->normals + 3 * vertex;
    const float *m = piece->instance->normal_matrix;
    double turned[3];
    double square = 0.0;
    for (int k = 0; k < 3; k++) {
        turned[k] = (double)m[3 * k] * (double)n[0] + (double)m[3 * k + 1] * (double)n[1] +
                    (double)m[3 * k + 2] * (double)n[2];
        square += turned[k] * turned[k];
    }
    /* What is unit to a float's precision stays to the bit, so that files read and written again do not drift. */
    double scale = fabs(square - 1.0) < 1e-6 || !(square > 0.0) ? 1.0 : 1.0 / sqrt(square);
    for (int k = 0; k < 3; k++)
        out[k] = (float)(turned[k] * scale);
}

static void put_value(const obj_piece *piece, const facet_scene *scene, obj_list list, bool is_flipped,
                      size_t vertex, float *out)
{
    if (list == OBJ_POSITIONS) {
        put_position(piece, scene, vertex, out);
    } else if (list == OBJ_NORMALS) {
        put_normal(piece, vertex, out);
    } else {
        const float *uv = piece->instance->primitive->texcoords[piece->texcoord_set] + 2 * vertex;
        out[0] = uv[0];
        out[1] = is_flipped ? uv[1] : 1.0f - uv[1];
    }
    for (uint32_t k = 0; k < piece->lists[list].width; k++)
        out[k] += 0.0f; /* -0 is 0 */
}

/* ---- one list ---- */

static size_t hash_bits(const float *values, uint32_t width)
{
    uint64_t hash = 0;
    for (uint32_t i = 0; i < width; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return (size_t)hash;
}

/* What is being done for all lists. */
typedef struct fill_job {
    obj_piece *pieces;
    const facet_scene *scene;
    const facet_scene_save_desc *desc;
} fill_job;

/* Fills a list by way of a hash table of its values. False: no memory. */
static bool fill_list(const fill_job *job, obj_piece *piece, obj_list list)
{
    obj_values *out = &piece->lists[list];
    const scene_primitive *p = piece->instance->primitive;
    size_t table_size = 16;
    while (table_size < 2 * (size_t)p->vertex_count)
        table_size *= 2;
    const uint32_t unused = UINT32_MAX;
    const uint32_t used = UINT32_MAX - 1;
    uint32_t *table = mem_alloc(&job->desc->allocator, table_size, sizeof *table);
    out->map = mem_alloc(&job->desc->allocator, p->vertex_count, sizeof *out->map);
    out->values = mem_alloc(&job->desc->allocator, p->vertex_count, out->width * sizeof *out->values);
    bool is_done = table && out->map && out->values;
    if (is_done) {
        memset(table, 0xff, table_size * sizeof *table);
        memset(out->map, 0xff, p->vertex_count * sizeof *out->map);
        for (size_t i = 0; i < p->index_count; i++)
            out->map[p->indices[i]] = used;
    }
    for (size_t i = 0; is_done && i < p->vertex_count; i++) {
        if (out->map[i] == unused)
            continue;
        float *value = out->values + out->count * out->width;
        put_value(piece, job->scene, list, job->desc->has_flipped_texcoords, i, value);
        size_t at = hash_bits(value, out->width) & (table_size - 1);
        while (table[at] != unused &&
               memcmp(out->values + (size_t)table[at] * out->width, value, out->width * sizeof *value) != 0)
            at = (at + 1) & (table_size - 1);
        if (table[at] == unused)
            table[at] = (uint32_t)out->count++;
        out->map[i] = table[at];
    }
    mem_free(table);
    return is_done;
}

static void fill_range(void *context, size_t begin, size_t end)
{
    const fill_job *job = context;
    for (size_t i = begin; i < end; i++) {
        obj_piece *piece = &job->pieces[i / OBJ_LIST_COUNT];
        obj_list list = (obj_list)(i % OBJ_LIST_COUNT);
        if (piece->lists[list].width > 0 && !fill_list(job, piece, list))
            piece->lists[list].width = UINT32_MAX; /* told below: no two items write the same member */
    }
}

bool obj_pieces_fill(obj_piece *pieces, size_t count, const facet_scene *scene,
                     const facet_scene_save_desc *desc)
{
    fill_job job = {.pieces = pieces, .scene = scene, .desc = desc};
    for (size_t i = 0; i < count; i++) {
        const scene_instance *instance = pieces[i].instance;
        pieces[i].lists[OBJ_POSITIONS].width = instance->primitive->colors ? 6 : 3;
        pieces[i].lists[OBJ_TEXCOORDS].width = pieces[i].texcoord_set == SCENE_NONE ? 0 : 2;
        pieces[i].lists[OBJ_NORMALS].width = instance->normals ? 3 : 0;
    }
    parallel_for(desc->thread_count, count * OBJ_LIST_COUNT, 1, fill_range, &job);
    size_t next[OBJ_LIST_COUNT] = {1, 1, 1};
    for (size_t i = 0; i < count; i++)
        for (int list = 0; list < OBJ_LIST_COUNT; list++) {
            obj_values *values = &pieces[i].lists[list];
            if (values->width == UINT32_MAX)
                return false;
            values->first = next[list];
            next[list] += values->count;
        }
    return true;
}

void obj_pieces_destroy(obj_piece *pieces, size_t count)
{
    for (size_t i = 0; pieces && i < count; i++)
        for (int list = 0; list < OBJ_LIST_COUNT; list++) {
            mem_free(pieces[i].lists[list].values);
            mem_free(pieces[i].lists[list].map);
        }
    mem_free(pieces);
}
