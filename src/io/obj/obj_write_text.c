/* obj_write_text.c - the statements of an OBJ file, printed by all threads: the text is cut into blocks of lines, each
 * block is printed on its own, and then copied to where it belongs. */
#include <string.h>

#include "base/parallel.h"
#include "io/obj/obj_write.h"

/* Lines of one list of one piece, or (list OBJ_LIST_COUNT) its elements. */
typedef struct block {
    const obj_piece *piece;
    const text *heading; /* that comes before; NULL: none */
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

/* origin: of the first three values; NULL: they are no place. */
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
