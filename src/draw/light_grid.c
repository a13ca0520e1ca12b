/* light_grid.c - see light_grid.h. */
#include "draw/light_grid.h"

#include <math.h>

#include "base/memory.h"
#include "base/result.h"

#include "shade/shade.h"

enum {
    CELLS_PER_AXIS = 128,
    CELLS_PER_LIGHT = 64,  /* of the whole grid */
    ENTRIES_PER_LIGHT = 64 /* average number of cells per light */
};

/* The cells that a light's sphere touches, and some at its corners. */
typedef struct cell_box {
    uint32_t first[3], last[3];
} cell_box;

static uint32_t cell_of(const light_grid *grid, int axis, float x)
{
    float cell = (x - grid->origin[axis]) * grid->cells_per_m[axis];
    float last = (float)(grid->cell_count[axis] - 1);
    return (uint32_t)clamp(cell, 0.0f, last);
}

/* A range beyond everything drawn counts as none: the sums here stay finite. */
static bool has_range(const Light *light)
{
    return !light->directional && light->range > 0.0f && light->range < 1e18f;
}

/* The range, with a margin for rounding. */
static float reach(const Light *light)
{
    vec3 p = abs(light->position);
    return light->range * 1.00001f + 1e-6f * (p[0] + p[1] + p[2]);
}

static cell_box box_of(const light_grid *grid, const Light *light)
{
    cell_box box;
    for (int axis = 0; axis < 3; axis++) {
        box.first[axis] = cell_of(grid, axis, light->position[axis] - reach(light));
        box.last[axis] = cell_of(grid, axis, light->position[axis] + reach(light));
    }
    return box;
}

static uint64_t count_entries(const light_grid *grid, const Light *lights, uint32_t count)
{
    uint64_t entries = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!has_range(&lights[i]))
            continue;
        cell_box box = box_of(grid, &lights[i]);
        uint64_t cells = 1;
        for (int axis = 0; axis < 3; axis++)
            cells *= box.last[axis] - box.first[axis] + 1;
        entries += cells;
    }
    return entries;
}

/* Cubes, `longest` of them along the longest side of the box. */
static void divide(light_grid *grid, const float extent[3], uint32_t longest)
{
    float edge = max(max(extent[0], extent[1]), extent[2]) / (float)longest;
    for (int axis = 0; axis < 3; axis++) {
        uint32_t cells = edge > 0.0f ? (uint32_t)ceilf(extent[axis] / edge) : 1;
        grid->cell_count[axis] = cells < 1 ? 1 : cells > longest ? longest : cells;
        grid->cells_per_m[axis] = extent[axis] > 0.0f ? (float)grid->cell_count[axis] / extent[axis] : 0.0f;
    }
}

/* Puts each light into its cells; is_counting: only adds to first[cell + 1]. */
static void fill_cells(light_grid *grid, const Light *lights, uint32_t count, bool is_counting)
{
    for (uint32_t i = 0; i < count; i++) {
        if (!has_range(&lights[i]))
            continue;
        cell_box box = box_of(grid, &lights[i]);
        for (uint32_t z = box.first[2]; z <= box.last[2]; z++)
            for (uint32_t y = box.first[1]; y <= box.last[1]; y++)
                for (uint32_t x = box.first[0]; x <= box.last[0]; x++) {
                    size_t cell = ((size_t)z * grid->cell_count[1] + y) * grid->cell_count[0] + x;
                    if (is_counting)
                        grid->first[cell + 1]++;
                    else
                        grid->lights[grid->first[cell]++] = i;
                }
    }
}

static facet_result make_cells(light_grid *grid, const Light *lights, uint32_t count, const float extent[3],
                               const facet_allocator *allocator, facet_error *error)
{
    uint32_t longest = CELLS_PER_AXIS;
    uint64_t entries;
    size_t cells;
    for (;; longest /= 2) { /* terminates: one cell has as many entries as there are lights */
        divide(grid, extent, longest);
        cells = (size_t)grid->cell_count[0] * grid->cell_count[1] * grid->cell_count[2];
        entries = count_entries(grid, lights, count);
        if (cells <= (size_t)count * CELLS_PER_LIGHT && entries <= (uint64_t)count * ENTRIES_PER_LIGHT)
            break;
    }
    grid->first = mem_zalloc(allocator, cells + 1, sizeof *grid->first);
    grid->lights = mem_alloc(allocator, (size_t)entries, sizeof *grid->lights);
    if (!grid->first || !grid->lights) {
        light_grid_destroy(grid);
        return fail_memory(error, "lights", (cells + (size_t)entries) * sizeof *grid->lights);
    }
    fill_cells(grid, lights, count, true);
    for (size_t i = 0; i < cells; i++)
        grid->first[i + 1] += grid->first[i];
    fill_cells(grid, lights, count, false);
    for (size_t i = cells; i > 0; i--) /* each has advanced to the next one's */
        grid->first[i] = grid->first[i - 1];
    grid->first[0] = 0;
    return FACET_OK;
}

facet_result light_grid_create(const Light *lights, uint32_t count, const facet_allocator *allocator,
                               light_grid *out, facet_error *error)
{
    *out = (light_grid){0};
    if (count == 0)
        return FACET_OK;
    out->everywhere = mem_alloc(allocator, count, sizeof *out->everywhere);
    if (!out->everywhere)
        return fail_memory(error, "lights", count * sizeof *out->everywhere);
    float most[3];
    float extent[3];
    for (int axis = 0; axis < 3; axis++) {
        out->origin[axis] = INFINITY;
        most[axis] = -INFINITY;
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!has_range(&lights[i])) {
            out->everywhere[out->everywhere_count++] = i;
            continue;
        }
        for (int axis = 0; axis < 3; axis++) {
            out->origin[axis] = min(out->origin[axis], lights[i].position[axis] - reach(&lights[i]));
            most[axis] = max(most[axis], lights[i].position[axis] + reach(&lights[i]));
        }
    }
    if (out->everywhere_count == count)
        return FACET_OK;
    for (int axis = 0; axis < 3; axis++)
        extent[axis] = most[axis] - out->origin[axis];
    return make_cells(out, lights, count, extent, allocator, error);
}

void light_grid_destroy(light_grid *grid)
{
    mem_free(grid->first);
    mem_free(grid->lights);
    mem_free(grid->everywhere);
    *grid = (light_grid){0};
}

light_cursor light_grid_at(const light_grid *grid, const float P[3])
{
    light_cursor c = {.everywhere = grid->everywhere};
    size_t cell = 0;
    if (grid->everywhere) /* C does not define NULL + 0 */
        c.everywhere_end = grid->everywhere + grid->everywhere_count;
    if (!grid->first)
        return c;
    for (int axis = 2; axis >= 0; axis--) {
        float x = (P[axis] - grid->origin[axis]) * grid->cells_per_m[axis];
        /* A little beyond the box counts as the cell at its border, as in cell_of(); NaN is in no cell. */
        if (!(x >= -1.0f && x <= (float)grid->cell_count[axis] + 1.0f))
            return c;
        cell = cell * grid->cell_count[axis] + cell_of(grid, axis, P[axis]);
    }
    c.near = grid->lights + grid->first[cell];
    c.near_end = grid->lights + grid->first[cell + 1];
    return c;
}
