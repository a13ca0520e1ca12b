/* convert_texels.c - what bakes do with one texel: closed forms, and grids of fits that are too slow per
 * texel. See convert_texels.h. Closed form (docs/legacy.md):
 *   sf = min(1, max(Cs) g(s)),  color of F0 = Cs / max(Cs),  base = min(1, Cd / (1 - sf)),  r(s) */
#include "legacy/convert_texels.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "legacy/convert_surface.h"

/* ---- the core profile: its search on a grid ---- */

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

/* A position between two nodes. */
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

/* Metallic and roughness of the mean channel, base color per channel. */
static pbr_surface core_grid_look_up(const core_grid *grid, const ogl1_surface *in)
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

/* ---- texels ---- */

uint8_t texel_code(float value)
{
    return (uint8_t)(unit_of(value) * 255.0f + 0.5f);
}

/* The base is weighted with 1 - F, and F is the same at all angles. */
static float under_highlight(float diffuse, float strength)
{
    float rest = 1.0f - strength;
    return diffuse < rest ? diffuse / rest : diffuse > 0.0f ? 1.0f : 0.0f;
}

static const uint8_t *texel_of(const uint8_t *const *in, int input, uint32_t x)
{
    return in[input] ? in[input] + (size_t)x * 4 : NULL;
}

pbr_surface texel_surface(const ogl1_surface *in)
{
    pbr_surface s = pbr_surface_default();
    float most = highest_of(in->specular);
    s.perceptual_roughness = perceptual_roughness_from_shininess(in->shininess);
    s.ior = 0.0f;
    s.specular = unit_of(most * reflectance_share_from_shininess(in->shininess));
    for (int k = 0; k < 3; k++) {
        s.specular_color[k] = most > 0.0f ? in->specular[k] / most : 1.0f;
        s.base_color[k] = under_highlight(in->diffuse[k], s.specular);
    }
    return s;
}

static float strength_of(const texel_parameters *p, const float specular[3], const uint8_t *shininess)
{
    return unit_of(highest_of(specular) * lut_scalar(&p->share, shininess));
}

static pbr_surface core_of(const texel_parameters *p, const uint8_t *const *in, uint32_t x)
{
    ogl1_surface s;
    lut_color(&p->diffuse, texel_of(in, TEXEL_DIFFUSE, x), s.diffuse);
    lut_color(&p->specular, texel_of(in, TEXEL_SPECULAR, x), s.specular);
    s.shininess = lut_scalar(&p->shininess, texel_of(in, TEXEL_SHININESS, x));
    return core_grid_look_up(p->core, &s);
}

static void base_of(const texel_parameters *p, const uint8_t *const *in, uint32_t x, float base[3])
{
    if (p->is_core) {
        pbr_surface core = core_of(p, in, x);
        memcpy(base, core.base_color, sizeof core.base_color);
        return;
    }
    float specular[3];
    lut_color(&p->specular, texel_of(in, TEXEL_SPECULAR, x), specular);
    lut_color(&p->diffuse, texel_of(in, TEXEL_DIFFUSE, x), base);
    float strength = strength_of(p, specular, texel_of(in, TEXEL_SHININESS, x));
    for (int k = 0; k < 3; k++)
        base[k] = under_highlight(base[k], strength);
}

void texel_base_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out)
{
    const texel_parameters *p = parameters;
    for (uint32_t x = 0; x < width; x++, out += p->channel_count) {
        float base[3];
        base_of(p, in, x, base);
        for (int k = 0; k < 3; k++)
            out[k] = srgb_encode_u8(p->srgb, base[k] / p->base_scale[k]);
        if (p->channel_count == 4)
            out[3] = texel_code(lut_scalar(&p->opacity, texel_of(in, TEXEL_OPACITY, x)));
    }
}

void texel_specular_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out)
{
    const texel_parameters *p = parameters;
    for (uint32_t x = 0; x < width; x++, out += 4) {
        float specular[3];
        lut_color(&p->specular, texel_of(in, TEXEL_SPECULAR, x), specular);
        float most = highest_of(specular);
        for (int k = 0; k < 3; k++)
            out[k] = most > 0.0f ? srgb_encode_u8(p->srgb, specular[k] / most) : 255;
        out[3] = texel_code(strength_of(p, specular, texel_of(in, TEXEL_SHININESS, x)) / p->specular_scale);
    }
}

void texel_roughness_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out)
{
    const texel_parameters *p = parameters;
    for (uint32_t x = 0; x < width; x++, out += 3) {
        out[0] = 255;
        out[1] = texel_code(lut_scalar(&p->roughness, texel_of(in, TEXEL_SHININESS, x)));
        out[2] = 0;
        if (p->is_core) {
            pbr_surface core = core_of(p, in, x);
            out[1] = texel_code(core.perceptual_roughness);
            out[2] = texel_code(core.metallic);
        }
    }
}

void texel_packed_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out)
{
    const packed_parameters *p = parameters;
    for (uint32_t x = 0; x < width; x++, out += 3) {
        out[0] = texel_code(lut_scalar(&p->occlusion, texel_of(in, 0, x)));
        out[1] = texel_code(lut_scalar(&p->roughness, texel_of(in, 0, x)));
        out[2] = texel_code(lut_scalar(&p->metallic, texel_of(in, 1, x)));
    }
}

/* ---- the fit to OpenGL 1 at one shininess on a grid ----
 *
 * Channels are independent except for the Fresnel term that shades the diffuse part, which for gray nodes is their own. */

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

/* A position between two neighboring nodes. */
typedef struct grid_place {
    int low;
    float t;
} grid_place;

static grid_place place_even(float at, int count)
{
    float x = unit_of(at) * (float)(count - 1);
    int low = (int)x < count - 2 ? (int)x : count - 2;
    return (grid_place){.low = low, .t = x - (float)low};
}

/* Colors are nearly proportional to the base color, and so are their square roots to its root, in which
 * nodes are even. */
static float blend(const float grid[OGL1_GRID_ROUGHNESS][OGL1_GRID_SECOND][OGL1_GRID_BASE], grid_place r,
                   grid_place second, grid_place base)
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
    grid_place r = place_even(in->perceptual_roughness, OGL1_GRID_ROUGHNESS);
    out->shininess = grid->shininess;
    for (int k = 0; k < 3; k++) {
        grid_place base = place_even(sqrtf(unit_of(in->base_color[k])), OGL1_GRID_BASE);
        grid_place second = grid->is_glossy
                                ? place_even(sqrtf(unit_of(in->specular_color[k])), OGL1_GRID_SECOND)
                                : place_even(in->metallic, OGL1_GRID_SECOND);
        out->diffuse[k] = blend(grid->diffuse, r, second, base);
        out->specular[k] = blend(grid->specular, r, second, base);
    }
}
