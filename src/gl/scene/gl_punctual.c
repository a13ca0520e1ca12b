/* gl_punctual.c - see gl_punctual.h. */
#include "gl/scene/gl_punctual.h"

#include <epoxy/gl.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "gl/scene/gl_shadow.h"

#include "shade/shade.h"

enum {
    LIGHT_TEXELS = 4,
    WORDS = 4,
    RECORD_TEXELS = sizeof(gl_shadow_record) / 16
}; /* a texel has four words */

/* Where what begins, in texels. */
typedef struct layout {
    size_t records, lists, cells, end, number_count, cell_count;
} layout;

/* Without a grid where none is, or where it is too large for the texture. */
static layout plan(const light_setup *setup, uint32_t record_count, bool has_grid)
{
    const light_grid *grid = &setup->grid;
    layout l = {.records = LIGHT_TEXELS * (size_t)setup->punctual_count};
    l.lists = l.records + RECORD_TEXELS * (size_t)record_count;
    if (has_grid) {
        l.cell_count = (size_t)grid->cell_count[0] * grid->cell_count[1] * grid->cell_count[2];
        l.number_count = grid->everywhere_count + grid->first[l.cell_count];
    }
    l.cells = l.lists + (l.number_count + WORDS - 1) / WORDS;
    l.end = l.cells + (l.cell_count + 1) / 2;
    return l;
}

/* record: first texel of its shadow's record; 0: none. */
static void store_light(const Light *light, size_t record, uint32_t *out)
{
    float rows[3][4] = {
        {light->position[0], light->position[1], light->position[2], light->range},
        {light->spot_direction[0], light->spot_direction[1], light->spot_direction[2], light->spot_scale},
        {light->intensity[0], light->intensity[1], light->intensity[2], light->spot_offset}};
    memcpy(out, rows, sizeof rows);
    out[12] = light->directional;
    out[13] = (uint32_t)record;
}

static void store_grid(const light_grid *grid, const layout *l, uint32_t *words)
{
    uint32_t *numbers = words + WORDS * l->lists;
    uint32_t *cells = words + WORDS * l->cells;
    size_t near_count = grid->first[l->cell_count];
    if (grid->everywhere_count)
        memcpy(numbers, grid->everywhere, grid->everywhere_count * sizeof *numbers);
    memcpy(numbers + grid->everywhere_count, grid->lights, near_count * sizeof *numbers);
    for (size_t i = 0; i < l->cell_count; i++) {
        cells[2 * i] = grid->everywhere_count + grid->first[i];
        cells[2 * i + 1] = grid->everywhere_count + grid->first[i + 1];
    }
}

static void upload(gl_punctual *p, uint32_t rows)
{
    glActiveTexture(GL_TEXTURE0);
    if (!p->texture)
        glGenTextures(1, &p->texture);
    glBindTexture(GL_TEXTURE_2D, p->texture);
    if (rows != p->rows) {
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32UI, GL_LIGHT_ROW, (GLsizei)rows, 0, GL_RGBA_INTEGER,
                     GL_UNSIGNED_INT, NULL);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        p->rows = rows;
    }
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, GL_LIGHT_ROW, (GLsizei)rows, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                    p->words);
}

static void describe(const light_setup *setup, const layout *l, gl_light_block *block)
{
    const light_grid *grid = &setup->grid;
    for (int axis = 0; axis < 3; axis++) {
        block->grid_origin[axis] = grid->origin[axis];
        block->grid_cells[axis] = grid->cells_per_m[axis];
        block->grid_size[axis] = l->cell_count ? (int32_t)grid->cell_count[axis] : 0;
    }
    block->lists[0] = (int32_t)l->lists;
    block->lists[1] = (int32_t)l->cells;
    block->lists[2] = (int32_t)(l->cell_count ? grid->everywhere_count : setup->punctual_count);
}

facet_result gl_punctual_update(gl_punctual *p, gl_context *context, const facet_allocator *allocator,
                                const light_setup *setup, const gl_shadow *shadow, gl_light_block *block,
                                facet_error *error)
{
    uint32_t record_count;
    const gl_shadow_record *records = gl_shadow_records(shadow, &record_count);
    size_t most = (size_t)context->max_texture_size * GL_LIGHT_ROW;
    layout l = plan(setup, record_count, setup->grid.first != NULL);
    if (l.end > most)
        l = plan(setup, record_count, false);
    if (l.end > most)
        return fail(error, FACET_ERROR_LIMIT, "OpenGL (%s): %u lights; the most are %zu", context->name,
                    setup->punctual_count, most / LIGHT_TEXELS);
    describe(setup, &l, block);
    if (setup->punctual_count == 0)
        return FACET_OK;
    size_t rows = (l.end + GL_LIGHT_ROW - 1) / GL_LIGHT_ROW;
    uint32_t *words = mem_zalloc(allocator, rows * GL_LIGHT_ROW, WORDS * sizeof *words);
    if (!words)
        return fail_memory(error, "lights", rows * GL_LIGHT_ROW * WORDS * sizeof *words);
    for (uint32_t i = 0; i < setup->punctual_count; i++) {
        uint32_t record = gl_shadow_of_light(shadow, i);
        store_light(&setup->punctual[i], record ? l.records + RECORD_TEXELS * (record - 1) : 0,
                    words + (size_t)i * LIGHT_TEXELS * WORDS);
    }
    if (record_count)
        memcpy(words + l.records * WORDS, records, record_count * sizeof *records);
    if (l.cell_count)
        store_grid(&setup->grid, &l, words);
    bool is_same =
        p->words && mem_size(p->words) == mem_size(words) && memcmp(p->words, words, mem_size(words)) == 0;
    mem_free(p->words);
    p->words = words;
    if (!is_same)
        upload(p, (uint32_t)rows);
    return gl_context_check(context, "lights", error);
}

void gl_punctual_destroy(gl_punctual *p)
{
    glDeleteTextures(1, &p->texture);
    mem_free(p->words);
    *p = (gl_punctual){0};
}
