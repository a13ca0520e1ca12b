/* convert_ogl1_grid.c - see convert_ogl1_grid.h. A texel's channels do not depend on each other but for the Fresnel term
 * that shades the diffuse part, which for gray nodes is their own. */
#include "legacy/convert_ogl1_grid.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "legacy/convert_surface.h"

static float square_node(int i, int count)
{
    float t = (float)i / (float)(count - 1);
    return t * t;
}

typedef struct grid_work {
    ogl1_grid *grid;
    const fit_metric *metric;
    facet_legacy_target target;
} grid_work;

static void fit_node(const grid_work *work, int r, int second, int base)
{
    ogl1_grid *grid = work->grid;
    pbr_surface in = grid->factors;
    ogl1_surface out;
    in.perceptual_roughness = (float)r / (float)(OGL1_GRID_ROUGHNESS - 1);
    in.metallic = grid->is_glossy ? 0.0f : (float)second / (float)(OGL1_GRID_SECOND - 1);
    for (int k = 0; k < 3; k++) {
        in.base_color[k] = square_node(base, OGL1_GRID_BASE);
        if (grid->is_glossy)
            in.specular_color[k] = square_node(second, OGL1_GRID_SECOND);
    }
    pbr_to_ogl1_fit_at(work->metric, &in, work->target, grid->shininess, &out);
    grid->diffuse[r][second][base] = sqrtf(out.diffuse[0]);
    grid->specular[r][second][base] = sqrtf(out.specular[0]);
}

static void fit_rows(void *context, size_t begin, size_t end)
{
    for (size_t i = begin; i < end; i++)
        for (int base = 0; base < OGL1_GRID_BASE; base++)
            fit_node(context, (int)i / OGL1_GRID_SECOND, (int)i % OGL1_GRID_SECOND, base);
}

facet_result ogl1_grid_make(const facet_allocator *allocator, uint32_t thread_count,
                            const pbr_surface *factors, float shininess, bool is_glossy,
                            facet_legacy_target target, ogl1_grid **out, facet_error *error)
{
    fit_metric *metric = NULL;
    ogl1_grid *grid = mem_alloc(allocator, 1, sizeof *grid);
    facet_result result = grid ? fit_metric_create(allocator, PBR_CORRELATED, &metric, error)
                               : fail_memory(error, "textures", sizeof *grid);
    if (result == FACET_OK) {
        grid->factors = *factors;
        grid->shininess = shininess;
        grid->is_glossy = is_glossy;
        grid_work work = {.grid = grid, .metric = metric, .target = target};
        parallel_for(thread_count, OGL1_GRID_ROUGHNESS * OGL1_GRID_SECOND, 1, fit_rows, &work);
        *out = grid;
        grid = NULL;
    }
    fit_metric_destroy(metric);
    mem_free(grid);
    return result;
}

void ogl1_grid_destroy(ogl1_grid *grid)
{
    mem_free(grid);
}

/* ---- looking up ---- */

/* A place between two neighbouring nodes. */
typedef struct between {
    int low;
    float t;
} between;

static between place_even(float at, int count)
{
    float x = unit_of(at) * (float)(count - 1);
    int low = (int)x < count - 2 ? (int)x : count - 2;
    return (between){.low = low, .t = x - (float)low};
}

/* Colors are nearly proportional to the base color, and so are their roots to its root, in which nodes lie evenly. */
static float blend(const float grid[OGL1_GRID_ROUGHNESS][OGL1_GRID_SECOND][OGL1_GRID_BASE], between r,
                   between second, between base)
{
    float sum = 0.0f;
    for (int corner = 0; corner < 8; corner++) {
        int i = corner & 1;
        int j = corner >> 1 & 1;
        int l = corner >> 2;
        float weight =
            (i ? r.t : 1.0f - r.t) * (j ? second.t : 1.0f - second.t) * (l ? base.t : 1.0f - base.t);
        sum += weight * grid[r.low + i][second.low + j][base.low + l];
    }
    return sum * sum;
}

void ogl1_grid_look_up(const ogl1_grid *grid, const pbr_surface *in, ogl1_surface *out)
{
    between r = place_even(in->perceptual_roughness, OGL1_GRID_ROUGHNESS);
    out->shininess = grid->shininess;
    for (int k = 0; k < 3; k++) {
        between base = place_even(sqrtf(unit_of(in->base_color[k])), OGL1_GRID_BASE);
        between second = grid->is_glossy ? place_even(sqrtf(unit_of(in->specular_color[k])), OGL1_GRID_SECOND)
                                         : place_even(in->metallic, OGL1_GRID_SECOND);
        out->diffuse[k] = blend(grid->diffuse, r, second, base);
        out->specular[k] = blend(grid->specular, r, second, base);
    }
}
