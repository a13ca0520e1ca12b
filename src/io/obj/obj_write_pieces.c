/* obj_write_pieces.c - the statements of an OBJ file: positions, texture coordinates and normals of a pose
 * in world space, each value once per piece, without unused vertices; and their text, which is printed in
 * parallel: in blocks of lines that are then copied to their place. */
#include <math.h>
#include <string.h>

#include "base/index_table.h"
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
    /* Vertex colors in the encoding of the file's materials. */
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
    /* Vectors that are unit to float precision are kept to the bit, so that repeated reading and writing
     * does not drift. */
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

static uint32_t hash_bits(const float *values, uint32_t width)
{
    uint64_t hash = 0;
    for (uint32_t i = 0; i < width; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return (uint32_t)(hash >> 32);
}

/* The context of all lists. */
typedef struct fill_job {
    obj_piece *pieces;
    const facet_scene *scene;
    const facet_scene_save_desc *desc;
} fill_job;

/* Fills a list with the values of used vertices, each once. False: no memory. */
static bool fill_list(const fill_job *job, obj_piece *piece, obj_list list)
{
    obj_values *out = &piece->lists[list];
    const scene_primitive *p = piece->instance->primitive;
    const facet_allocator *allocator = &job->desc->allocator;
    const uint32_t unused = UINT32_MAX;
    index_table by_value = {0};
    out->map = mem_alloc(allocator, p->vertex_count, sizeof *out->map);
    out->values = mem_alloc(allocator, p->vertex_count, out->width * sizeof *out->values);
    bool is_done = out->map && out->values && index_table_reserve(&by_value, allocator, p->vertex_count);
    if (is_done) {
        memset(out->map, 0xff, p->vertex_count * sizeof *out->map);
        for (size_t i = 0; i < p->index_count; i++)
            out->map[p->indices[i]] = 0;
    }
    for (size_t i = 0; is_done && i < p->vertex_count; i++) {
        if (out->map[i] == unused)
            continue;
        float *value = out->values + out->count * out->width;
        put_value(piece, job->scene, list, job->desc->has_flipped_texcoords, i, value);
        uint32_t hash = hash_bits(value, out->width);
        size_t cursor = 0;
        uint32_t found;
        do
            found = index_table_next(&by_value, hash, &cursor);
        while (found != INDEX_TABLE_NONE &&
               memcmp(out->values + (size_t)found * out->width, value, out->width * sizeof *value) != 0);
        if (found == INDEX_TABLE_NONE) {
            found = (uint32_t)out->count++;
            is_done = index_table_add(&by_value, allocator, hash, found);
        }
        out->map[i] = found;
    }
    index_table_release(&by_value);
    return is_done;
}

static void fill_range(void *context, size_t begin, size_t end)
{
    const fill_job *job = context;
    for (size_t i = begin; i < end; i++) {
        obj_piece *piece = &job->pieces[i / OBJ_LIST_COUNT];
        obj_list list = (obj_list)(i % OBJ_LIST_COUNT);
        if (piece->lists[list].width > 0 && !fill_list(job, piece, list))
            piece->lists[list].width = UINT32_MAX; /* reported below: items write separate members */
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

/* Lines of one list of one piece, or (list OBJ_LIST_COUNT) its elements. */
typedef struct block {
    const obj_piece *piece;
    const text *heading; /* text before it; NULL: none */
    uint32_t list;
    size_t begin, end; /* values, or elements */
    char *data;        /* block of mem_alloc(); NULL: no memory */
    size_t size;
    size_t offset; /* in the file */
} block;

enum {
    BLOCK_LINES = 8192,
    FLOAT_ROOM = 16, /* " -1.23456789e-10" */
    PLACE_ROOM = 1 + TEXT_FLOAT_SIZE,
    INDEX_ROOM = 21, /* " 18446744073709551615" */
    CORNER_ROOM = 3 * INDEX_ROOM
};

/* ---- lines ---- */

static char *put_index(char *out, size_t index)
{
    char digits[INDEX_ROOM];
    int count = 0;
    do {
        digits[count++] = (char)('0' + index % 10);
        index /= 10;
    } while (index);
    while (count)
        *out++ = digits[--count];
    return out;
}

/* origin: added to the first three values; NULL: they are not a position. */
static char *put_values(char *out, const char *keyword, const float *values, uint32_t width,
                        const double *origin)
{
    size_t length = strlen(keyword);
    memcpy(out, keyword, length);
    out += length;
    for (uint32_t i = 0; i < width; i++) {
        char digits[TEXT_FLOAT_SIZE];
        text_shortest_place(values[i], origin && i < 3 ? origin[i] : 0.0, digits);
        length = strlen(digits);
        *out++ = ' ';
        memcpy(out, digits, length);
        out += length;
    }
    *out++ = '\n';
    return out;
}

/* " v", " v/vt", " v//vn" or " v/vt/vn". */
static char *put_corner(char *out, const obj_piece *piece, uint32_t vertex, bool is_position_only)
{
    const obj_values *lists = piece->lists;
    bool has_normal = lists[OBJ_NORMALS].width > 0 && !is_position_only;
    bool has_texcoord = lists[OBJ_TEXCOORDS].width > 0 && !is_position_only;
    *out++ = ' ';
    out = put_index(out, lists[OBJ_POSITIONS].first + lists[OBJ_POSITIONS].map[vertex]);
    if (has_texcoord || has_normal)
        *out++ = '/';
    if (has_texcoord)
        out = put_index(out, lists[OBJ_TEXCOORDS].first + lists[OBJ_TEXCOORDS].map[vertex]);
    if (has_normal) {
        *out++ = '/';
        out = put_index(out, lists[OBJ_NORMALS].first + lists[OBJ_NORMALS].map[vertex]);
    }
    return out;
}

/* Points and lines have no normals in OBJ, points no texture coordinates either: "p v", "l v/vt v/vt". */
static char *put_element(char *out, const obj_piece *piece, size_t element)
{
    const scene_primitive *p = piece->instance->primitive;
    static const char keywords[] = {'p', 'l', 'f'};
    const uint32_t corners = p->mode == SCENE_POINTS ? 1 : p->mode == SCENE_LINES ? 2 : 3;
    bool is_reversed = corners == 3 && piece->instance->is_mirrored;
    *out++ = keywords[corners - 1];
    for (uint32_t i = 0; i < corners; i++) {
        uint32_t corner = is_reversed && i > 0 ? 3 - i : i;
        out = put_corner(out, piece, p->indices[element * corners + corner], corners < 3);
    }
    *out++ = '\n';
    return out;
}

/* ---- blocks ---- */

static size_t line_room(const block *b)
{
    return b->list == OBJ_LIST_COUNT ? 2 + 3 * CORNER_ROOM : 4 + 3 * PLACE_ROOM + 3 * FLOAT_ROOM;
}

typedef struct print_job {
    block *blocks;
    const facet_allocator *allocator;
    const double *origin; /* of positions */
    char *file;
} print_job;

static void print_block(const print_job *job, block *b)
{
    static const char *const keywords[] = {"v", "vt", "vn"};
    size_t heading = b->heading ? b->heading->length : 0;
    char *data = mem_alloc(job->allocator, heading + (b->end - b->begin) * line_room(b), 1);
    if (!data)
        return;
    char *out = data;
    if (heading)
        memcpy(out, b->heading->data, heading);
    out += heading;
    for (size_t i = b->begin; i < b->end; i++) {
        if (b->list == OBJ_LIST_COUNT) {
            out = put_element(out, b->piece, i);
        } else {
            const obj_values *values = &b->piece->lists[b->list];
            out = put_values(out, keywords[b->list], values->values + i * values->width, values->width,
                             b->list == OBJ_POSITIONS ? job->origin : NULL);
        }
    }
    b->size = (size_t)(out - data);
    b->data = mem_resize(data, b->size, 1);
    if (!b->data)
        mem_free(data);
}

static void print_range(void *context, size_t begin, size_t end)
{
    const print_job *job = context;
    for (size_t i = begin; i < end; i++)
        print_block(job, &job->blocks[i]);
}

static void copy_range(void *context, size_t begin, size_t end)
{
    const print_job *job = context;
    for (size_t i = begin; i < end; i++) {
        memcpy(job->file + job->blocks[i].offset, job->blocks[i].data, job->blocks[i].size);
        mem_free(job->blocks[i].data);
        job->blocks[i].data = NULL;
    }
}

/* Lines of a list, or elements. */
static size_t count_lines(const obj_piece *piece, uint32_t list)
{
    const scene_primitive *p = piece->instance->primitive;
    uint32_t corners = p->mode == SCENE_POINTS ? 1 : p->mode == SCENE_LINES ? 2 : 3;
    return list < OBJ_LIST_COUNT ? piece->lists[list].count : p->index_count / corners;
}

/* Cuts pieces into blocks; blocks NULL: counts them only. */
static size_t cut_blocks(const obj_piece *pieces, const text *headings, size_t count, block *blocks)
{
    size_t block_count = 0;
    for (size_t i = 0; i < count; i++) {
        const text *heading = headings[i].length ? &headings[i] : NULL;
        for (uint32_t list = 0; list <= OBJ_LIST_COUNT; list++) {
            size_t lines = count_lines(&pieces[i], list);
            for (size_t begin = 0; begin < lines; begin += BLOCK_LINES) {
                size_t end = lines - begin < BLOCK_LINES ? lines : begin + BLOCK_LINES;
                if (blocks)
                    blocks[block_count] = (block){
                        .piece = &pieces[i], .heading = heading, .list = list, .begin = begin, .end = end};
                heading = NULL;
                block_count++;
            }
        }
    }
    return block_count;
}

char *obj_pieces_print(const obj_piece *pieces, const text *headings, size_t count, const text *begin,
                       const double origin[3], const facet_scene_save_desc *desc, size_t *size)
{
    size_t block_count = cut_blocks(pieces, headings, count, NULL);
    print_job job = {.allocator = &desc->allocator, .origin = origin};
    job.blocks = mem_alloc(&desc->allocator, block_count, sizeof *job.blocks);
    if (!job.blocks)
        return NULL;
    cut_blocks(pieces, headings, count, job.blocks);
    parallel_for(desc->thread_count, block_count, 1, print_range, &job);
    bool is_printed = true;
    *size = begin->length;
    for (size_t i = 0; i < block_count; i++) {
        is_printed = is_printed && job.blocks[i].data;
        job.blocks[i].offset = *size;
        *size += job.blocks[i].size;
    }
    job.file = is_printed ? mem_alloc(&desc->allocator, *size, 1) : NULL;
    if (job.file) {
        memcpy(job.file, begin->data, begin->length);
        parallel_for(desc->thread_count, block_count, 1, copy_range, &job);
    }
    for (size_t i = 0; i < block_count; i++)
        mem_free(job.blocks[i].data);
    mem_free(job.blocks);
    return job.file;
}
