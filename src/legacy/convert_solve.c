/* convert_solve.c - converts the values of all materials: distinct inputs in parallel, their results
 * copied to equal ones. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"
#include "legacy/convert_state.h"
#include "legacy/convert_texels.h"

typedef struct solve_input solve_input;

/* An input, and a material that has it. */
typedef struct solve_request {
    const solve_input *input;
    uint32_t item;
} solve_request;

static int by_input(const void *a, const void *b)
{
    const solve_request *x = a;
    const solve_request *y = b;
    int order = memcmp(x->input, y->input, sizeof *x->input);
    return order ? order : (x->item > y->item) - (x->item < y->item);
}

typedef struct solver {
    const conversion *c;
    const facet_legacy_desc *desc;
    const fit_metric *metric;
    facet_material_model to;
    solve_item *items;
    const solve_request *distinct;
} solver;

/* With linear colors programs add light. */
static facet_legacy_target target_of(const conversion *c, facet_material_model to)
{
    const struct scene_legacy *legacy = to == FACET_MATERIAL_MODEL_OGL1 ? c->legacy : c->scene->legacy;
    facet_legacy_target target = c->desc.target;
    if (target == FACET_LEGACY_TARGET_AUTO)
        target = to == FACET_MATERIAL_MODEL_OGL1 || legacy->is_rgl ? FACET_LEGACY_TARGET_DRAWN
                                                                   : FACET_LEGACY_TARGET_LINEAR;
    if (target == FACET_LEGACY_TARGET_DRAWN && legacy->colors == FACET_LEGACY_COLORS_LINEAR)
        target = FACET_LEGACY_TARGET_DISPLAY;
    return target;
}

bool solve_is_closed(const conversion *c, facet_material_model to, const solve_item *item)
{
    bool is_linear = c->target == FACET_LEGACY_TARGET_LINEAR;
    if (to == FACET_MATERIAL_MODEL_OGL1)
        return item->input.is_closed > 0.0f && is_linear;
    return item->input.is_closed > 0.0f || (c->desc.method == FACET_LEGACY_METHOD_CLOSED && is_linear);
}

static void solve_from_ogl1(const solver *s, solve_item *item)
{
    const ogl1_surface *in = &item->input.ogl1;
    bool is_closed = solve_is_closed(s->c, s->to, item);
    bool is_core = s->desc->profile == FACET_LEGACY_PROFILE_CORE;
    if (is_closed)
        item->remarks =
            is_core ? ogl1_to_pbr_core_closed(in, &item->pbr) : ogl1_to_pbr_closed(in, &item->pbr);
    else
        item->remarks = is_core ? ogl1_to_pbr_core_fit(s->metric, in, s->c->target, &item->pbr)
                                : ogl1_to_pbr_fit(s->metric, in, s->c->target, &item->pbr);
    if (item->input.is_closed > 0.0f && !is_core)
        item->pbr = texel_surface(in); /* as for its textures */
    item->ogl1 = *in;
    item->hue_error = fit_compare(s->metric, in, &item->pbr, FIT_FROM_OGL1);
    item->is_hue_kept = s->desc->keeps_hue && item->input.is_closed == 0.0f &&
                        fit_keep_hue(s->metric, in, s->c->target, &item->pbr);
    item->error = item->is_hue_kept ? fit_compare(s->metric, in, &item->pbr, FIT_FROM_OGL1) : item->hue_error;
    item->hue_share = fit_hue_share(in, &item->pbr);
    pbr_surface naive;
    ogl1_to_pbr_naive(in, &naive);
    item->naive = fit_compare(s->metric, in, &naive, FIT_FROM_OGL1).E;
    /* Viewers without the extensions use the core values with the dielectric of glTF. */
    pbr_surface core = pbr_surface_default();
    memcpy(core.base_color, item->pbr.base_color, sizeof core.base_color);
    core.metallic = item->pbr.metallic;
    core.perceptual_roughness = item->pbr.perceptual_roughness;
    item->core = is_core ? item->error.E : fit_compare(s->metric, in, &core, FIT_FROM_OGL1).E;
}

static void solve_to_ogl1(const solver *s, solve_item *item)
{
    const pbr_surface *in = &item->input.pbr;
    item->pbr = *in;
    if (solve_is_closed(s->c, s->to, item))
        item->remarks = pbr_to_ogl1_closed(in, &item->ogl1);
    else
        item->remarks = pbr_to_ogl1_fit(s->metric, in, s->c->target, FIT_DISPLAYABLE, &item->ogl1);
    item->error = fit_compare(s->metric, &item->ogl1, in, FIT_FROM_PBR);
    ogl1_surface naive;
    pbr_to_ogl1_naive(in, &naive);
    item->naive = fit_compare(s->metric, &naive, in, FIT_FROM_PBR).E;
    item->core = (double)NAN;
    item->hue_share = 1.0;
    item->is_hue_kept = false;
}

static void solve_range(void *context, size_t begin, size_t end)
{
    const solver *s = context;
    for (size_t i = begin; i < end; i++) {
        solve_item *item = &s->items[s->distinct[i].item];
        if (s->to == FACET_MATERIAL_MODEL_OGL1)
            solve_to_ogl1(s, item);
        else
            solve_from_ogl1(s, item);
    }
}

/* Moves the first of equal requests to the front, in order, and notes which item each result is copied
 * from. */
static size_t merge_equal(solve_request *all, size_t count, uint32_t *solved_by)
{
    qsort(all, count, sizeof *all, by_input);
    size_t distinct = 0;
    for (size_t i = 0; i < count; i++) {
        if (distinct == 0 || memcmp(all[i].input, all[distinct - 1].input, sizeof *all->input) != 0)
            all[distinct++] = all[i];
        solved_by[all[i].item] = all[distinct - 1].item;
    }
    return distinct;
}

facet_result solve_all(conversion *c, facet_material_model to, solve_item *items, uint32_t count,
                       facet_error *error)
{
    const facet_allocator *allocator = &c->scene->allocator;
    fit_metric *metric = NULL;
    facet_result result = FACET_OK;
    solve_request *all = mem_alloc(allocator, (size_t)count + 1, sizeof *all);
    uint32_t *solved_by = mem_alloc(allocator, (size_t)count + 1, sizeof *solved_by);
    size_t wanted_count = 0;
    c->target = target_of(c, to);
    if (!all || !solved_by)
        result = fail_memory(error, "materials", count * sizeof *all);
    for (uint32_t i = 0; i < count && result == FACET_OK; i++)
        if (items[i].is_wanted)
            all[wanted_count++] = (solve_request){.input = &items[i].input, .item = i};
    if (result == FACET_OK && wanted_count > 0)
        result = fit_metric_create(allocator, PBR_CORRELATED, &metric, error);
    if (result == FACET_OK && wanted_count > 0) {
        size_t distinct = merge_equal(all, wanted_count, solved_by);
        solver s = {.c = c, .desc = &c->desc, .metric = metric, .to = to, .items = items, .distinct = all};
        parallel_for(c->scene->thread_count, distinct, 1, solve_range, &s);
        for (uint32_t i = 0; i < count; i++)
            if (items[i].is_wanted)
                items[i] = items[solved_by[i]];
    }
    mem_free(all);
    mem_free(solved_by);
    fit_metric_destroy(metric);
    return result;
}

void solve_note(conversion *c, uint32_t material, const solve_item *item)
{
    note_list *notes = &c->notes;
    const ogl1_surface *s = &item->ogl1;
    if (item->remarks & FIT_BASE_CLAMPED)
        note_add(notes, material, NOTE_BASE_CLAMPED, "a base color above 1 would be needed; it is clamped");
    if (item->remarks & FIT_SPECULAR_CLAMPED)
        note_add(notes, material, NOTE_SPECULAR_CLAMPED,
                 "a specular color above 1 would be needed; it is clamped");
    if (item->remarks & FIT_SHININESS_CLAMPED)
        note_add(notes, material, NOTE_SHININESS_CLAMPED,
                 "a shininess above 128 would be needed; it is clamped");
    if (item->remarks & FIT_LOW_EXPONENT)
        note_add(notes, material, NOTE_LOW_EXPONENT,
                 "a shininess of %g is no highlight but a second diffuse term", (double)s->shininess);
    if (item->is_hue_kept)
        note_add(notes, material, NOTE_HUE_KEPT,
                 "the hue of the diffuse color is kept: E is %.3f instead of %.3f, on a screen %.3f instead "
                 "of %.3f, "
                 "as drawn %.3f instead of %.3f",
                 item->error.E, item->hue_error.E, item->error.E_display, item->hue_error.E_display,
                 item->error.E_drawn, item->hue_error.E_drawn);
    else if (item->hue_share < 0.25 && item->input.is_closed == 0.0f)
        note_add(
            notes, material, NOTE_HUE_LOST,
            "its highlight of shininess %g is so broad that %.0f %% of the hue of its diffuse color is left; "
            "--keep-hue keeps it",
            (double)s->shininess, 100.0 * fmax(item->hue_share, 0.0));
    if (item->remarks & FIT_ENERGY_GAIN) {
        double most = 0;
        for (int k = 0; k < 3; k++)
            most = fmax(most, (double)s->diffuse[k] + (double)s->specular[k]);
        note_add(notes, material, NOTE_ENERGY_GAIN,
                 "diffuse and specular color add up to %.3g: the material returns more light than it gets",
                 most);
    }
    if (item->remarks & FIT_METAL_WITH_DIFFUSE)
        note_add(notes, material, NOTE_METAL_WITHOUT_DIFFUSE,
                 "a metal has no diffuse part; it gets one that represents the wide part of its highlight");
}

facet_conversion_grade grade_of(double error)
{
    return error < 0.05   ? FACET_CONVERSION_GRADE_GOOD
           : error < 0.12 ? FACET_CONVERSION_GRADE_FAIR
           : error < 0.30 ? FACET_CONVERSION_GRADE_POOR
                          : FACET_CONVERSION_GRADE_BAD;
}

void summary_solved(const conversion *c, facet_conversion *summary, const solve_item *item)
{
    const struct scene_legacy *legacy = c->legacy ? c->legacy : c->scene->legacy;
    bool is_light = legacy->colors == FACET_LEGACY_COLORS_LINEAR;
    bool is_drawn = c->target == FACET_LEGACY_TARGET_DRAWN;
    summary->error = item->error.E;
    summary->error_display = item->error.E_display;
    summary->error_drawn = is_light ? item->error.E_display : item->error.E_drawn;
    summary->is_graded_as_drawn = is_drawn;
    summary->error_graded = is_drawn ? summary->error_drawn : summary->error_display;
    summary->error_naive = item->naive;
    summary->error_core = item->core;
    for (int i = 0; i < 3; i++)
        summary->error_views[i] = item->error.views[i];
    summary->grade = grade_of(summary->error_graded);
    summary->grade_drawn = grade_of(summary->error_drawn);
}

void summary_exact(facet_conversion *summary, const char *method)
{
    double error = strcmp(method, "exact") == 0 ? 0.0 : (double)NAN;
    summary->method = method;
    summary->error = summary->error_display = summary->error_drawn = summary->error_graded = error;
    summary->error_naive = summary->error_core = (double)NAN;
    for (int i = 0; i < 3; i++)
        summary->error_views[i] = error;
    summary->grade = summary->grade_drawn = FACET_CONVERSION_GRADE_GOOD;
}
