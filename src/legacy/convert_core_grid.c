/* convert_core_grid.c - the core profile's search, made once on a grid for the texels of a material. */
#include <math.h>

#include "base/parallel.h"
#include "legacy/convert_surface.h"
#include "legacy/convert_texels.h"

static float color_node(int i)
{
    float t = (float)i / (float)(CORE_COLORS - 1);
    return t * t;
}

static void make_exponents(void *context, size_t begin, size_t end)
{
    core_grid *grid = context;
    for (size_t e = begin; e < end; e++) {
        float t = (float)e / (float)(CORE_EXPONENTS - 1);
        ogl1_surface in;
        in.shininess = expm1f(grid->exponents[0] + t * (grid->exponents[1] - grid->exponents[0]));
        for (int i = 0; i < CORE_COLORS; i++)
            for (int j = 0; j < CORE_COLORS; j++) {
                pbr_surface out;
                for (int k = 0; k < 3; k++) {
                    in.specular[k] = color_node(i);
                    in.diffuse[k] = color_node(j);
                }
                ogl1_to_pbr_core_closed(&in, &out);
                grid->base[e][i][j] = out.base_color[0];
                grid->metallic[e][i][j] = out.metallic;
                grid->perceptual_roughness[e][i][j] = out.perceptual_roughness;
            }
    }
}

void core_grid_make(core_grid *grid, float least_shininess, float most_shininess, uint32_t thread_count)
{
    grid->exponents[0] = log1pf(fmaxf(least_shininess, 0.0f));
    grid->exponents[1] = log1pf(fmaxf(most_shininess, 0.0f));
    bool is_single = grid->exponents[0] == grid->exponents[1];
    parallel_for(thread_count, is_single ? 1 : CORE_EXPONENTS, 1, make_exponents, grid);
}

/* A place between two nodes. */
typedef struct between {
    int low, high;
    float t;
} between;

static between place(float at, int count)
{
    float clamped = fminf(fmaxf(at, 0.0f), (float)(count - 1));
    int low = (int)clamped;
    return (between){.low = low, .high = low + 1 < count ? low + 1 : low, .t = clamped - (float)low};
}

static between place_color(float color)
{
    /* Linear between the nodes' values, which are squares. */
    between b = place(sqrtf(fmaxf(color, 0.0f)) * (float)(CORE_COLORS - 1), CORE_COLORS);
    float low = color_node(b.low);
    float high = color_node(b.high);
    b.t = high > low ? unit_of((color - low) / (high - low)) : 0.0f;
    return b;
}

static float look_up(const float grid[CORE_EXPONENTS][CORE_COLORS][CORE_COLORS], between e, between i,
                     between j)
{
    float layers[2];
    for (int layer = 0; layer < 2; layer++) {
        const float(*at)[CORE_COLORS] = grid[layer ? e.high : e.low];
        float first = at[i.low][j.low] + j.t * (at[i.low][j.high] - at[i.low][j.low]);
        float second = at[i.high][j.low] + j.t * (at[i.high][j.high] - at[i.high][j.low]);
        layers[layer] = first + i.t * (second - first);
    }
    return layers[0] + e.t * (layers[1] - layers[0]);
}

pbr_surface core_grid_look_up(const core_grid *grid, const ogl1_surface *in)
{
    pbr_surface s = pbr_surface_default();
    float range = grid->exponents[1] - grid->exponents[0];
    between e = place(
        range > 0.0f ? (log1pf(in->shininess) - grid->exponents[0]) / range * (CORE_EXPONENTS - 1) : 0.0f,
        range > 0.0f ? CORE_EXPONENTS : 1);
    float specular = 0;
    float diffuse = 0;
    for (int k = 0; k < 3; k++) {
        s.base_color[k] = look_up(grid->base, e, place_color(in->specular[k]), place_color(in->diffuse[k]));
        specular += in->specular[k] / 3.0f;
        diffuse += in->diffuse[k] / 3.0f;
    }
    between i = place_color(specular);
    between j = place_color(diffuse);
    s.metallic = look_up(grid->metallic, e, i, j);
    s.perceptual_roughness = look_up(grid->perceptual_roughness, e, i, j);
    return s;
}
