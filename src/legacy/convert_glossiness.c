/* convert_glossiness.c - all materials of a scene from specular-glossiness to metallic-roughness and back,
 * with their textures; specular_glossiness.c has the formulas. */
#include <math.h>
#include <string.h>

#include "base/result.h"
#include "legacy/convert_state.h"
#include "legacy/convert_texels.h"
#include "legacy/specular_glossiness.h"
#include "scene/material_table.h"

/* ---- texels ---- */

/* Inputs of a bake. */
enum { GLOSS_BASE, GLOSS_SECOND, GLOSS_SPECULAR, GLOSS_SPECULAR_COLOR };

typedef enum gloss_output {
    GLOSS_TO_BASE,      /* RGBA: base color and opacity */
    GLOSS_TO_ROUGHNESS, /* RGB: 1, roughness, metallic */
    GLOSS_TO_DIFFUSE,   /* RGBA */
    GLOSS_TO_SPECULAR   /* RGBA: specular color and glossiness */
} gloss_output;

/* Part of the key of a bake. Factors are baked. */
typedef struct gloss_parameters {
    pbr_surface factors; /* as of legacy_surface_of_pbr() */
    int is_glossy;       /* the source */
    int is_core;         /* to core glTF: metallic is solved for */
    int output;          /* gloss_output */
    int channel_count;
    const srgb_tables *srgb;
} gloss_parameters;

static pbr_surface surface_of(const gloss_parameters *p, const uint8_t *const *in, size_t at)
{
    pbr_surface s = p->factors;
    const float *decoded = p->srgb->decoded;
    for (int k = 0; k < 3; k++) {
        if (in[GLOSS_BASE])
            s.base_color[k] *= decoded[in[GLOSS_BASE][at + (size_t)k]];
        if (p->is_glossy && in[GLOSS_SECOND])
            s.specular_color[k] *= decoded[in[GLOSS_SECOND][at + (size_t)k]];
        if (in[GLOSS_SPECULAR_COLOR])
            s.specular_color[k] *= decoded[in[GLOSS_SPECULAR_COLOR][at + (size_t)k]];
    }
    if (in[GLOSS_SECOND] && p->is_glossy) {
        s.perceptual_roughness =
            1.0f - (1.0f - s.perceptual_roughness) * (float)in[GLOSS_SECOND][at + 3] / 255.0f;
    } else if (in[GLOSS_SECOND]) {
        s.perceptual_roughness *= (float)in[GLOSS_SECOND][at + 1] / 255.0f;
        s.metallic *= (float)in[GLOSS_SECOND][at + 2] / 255.0f;
    }
    if (in[GLOSS_SPECULAR])
        s.specular *= (float)in[GLOSS_SPECULAR][at + 3] / 255.0f;
    return s;
}

static void put_color(const gloss_parameters *p, const float color[3], uint8_t *out)
{
    for (int k = 0; k < 3; k++)
        out[k] = srgb_encode_u8(p->srgb, color[k]);
}

static void gloss_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out)
{
    const gloss_parameters *p = parameters;
    for (uint32_t x = 0; x < width; x++, out += p->channel_count) {
        size_t at = (size_t)x * 4;
        pbr_surface s = surface_of(p, in, at);
        float colors[2][3];
        float metallic = s.metallic;
        uint8_t opacity = in[GLOSS_BASE] ? in[GLOSS_BASE][at + 3] : 255;
        switch ((gloss_output)p->output) {
        case GLOSS_TO_BASE:
            core_from_glossiness(s.base_color, s.specular_color, colors[0], &metallic);
            put_color(p, colors[0], out);
            break;
        case GLOSS_TO_ROUGHNESS:
            if (p->is_core)
                core_from_glossiness(s.base_color, s.specular_color, colors[0], &metallic);
            out[0] = 255;
            out[1] = texel_code(s.perceptual_roughness);
            out[2] = p->is_core ? texel_code(metallic) : 0;
            break;
        case GLOSS_TO_DIFFUSE:
            glossiness_from_surface(&s, colors[0], colors[1]);
            put_color(p, colors[0], out);
            break;
        case GLOSS_TO_SPECULAR:
            glossiness_from_surface(&s, colors[0], colors[1]);
            put_color(p, colors[1], out);
            opacity = texel_code(1.0f - s.perceptual_roughness);
            break;
        }
        if (p->channel_count == 4)
            out[3] = opacity;
    }
}

/* ---- one material ---- */

typedef struct gloss_job {
    conversion *c;
    uint32_t material;
    const scene_material *in;
    scene_material *out;
    gloss_parameters p;
    uint32_t inputs[TEXTURE_INPUTS];
    scene_texture_ref ref;
} gloss_job;

static bool is_readable(const conversion *c, const scene_material *m, scene_texture_slot slot)
{
    return texture_baker_statistics(c->baker, m->textures[slot].texture) != NULL;
}

static void take(gloss_job *job, int input, scene_texture_slot slot)
{
    const scene_texture_ref *ref = &job->in->textures[slot];
    if (!is_readable(job->c, job->in, slot))
        return;
    if (job->ref.texture == SCENE_NONE)
        job->ref = *ref;
    if (map_refs_agree(job->c->scene, &job->ref, ref))
        job->inputs[input] = ref->texture;
    else
        note_add(&job->c->notes, job->material, NOTE_TEXTURE_AVERAGED,
                 "textures are placed otherwise than the base color; they are left out");
}

static gloss_job begin(conversion *c, uint32_t material, scene_material *out)
{
    const scene_material *in = &c->scene->materials[material];
    gloss_job job = {.c = c, .material = material, .in = in, .out = out, .ref = {.texture = SCENE_NONE}};
    memset(&job.p, 0, sizeof job.p);
    for (int i = 0; i < TEXTURE_INPUTS; i++)
        job.inputs[i] = SCENE_NONE;
    *out = *in;
    legacy_surface_of_pbr(in, &job.p.factors);
    job.p.is_glossy = (in->extensions & SCENE_SPECULAR_GLOSSINESS) != 0;
    job.p.is_core = c->desc.profile == FACET_LEGACY_PROFILE_CORE;
    job.p.srgb = texture_baker_srgb(c->baker);
    take(&job, GLOSS_BASE, SCENE_BASE_COLOR_TEXTURE);
    take(&job, GLOSS_SECOND,
         job.p.is_glossy ? SCENE_SPECULAR_GLOSSINESS_TEXTURE : SCENE_METALLIC_ROUGHNESS_TEXTURE);
    if (!job.p.is_glossy) {
        take(&job, GLOSS_SPECULAR, SCENE_SPECULAR_TEXTURE);
        take(&job, GLOSS_SPECULAR_COLOR, SCENE_SPECULAR_COLOR_TEXTURE);
    }
    return job;
}

static facet_result bake(gloss_job *job, gloss_output output, const char *purpose, scene_texture_slot slot,
                         facet_error *error)
{
    job->p.output = (int)output;
    const texture_statistics *s = job->inputs[GLOSS_BASE] != SCENE_NONE
                                      ? texture_baker_statistics(job->c->baker, job->inputs[GLOSS_BASE])
                                      : NULL;
    bool has_opacity = job->in->alpha_mode != SCENE_ALPHA_OPAQUE && s && s->has_alpha;
    job->p.channel_count =
        output == GLOSS_TO_SPECULAR || (output != GLOSS_TO_ROUGHNESS && has_opacity) ? 4 : 3;
    texture_bake task = {.name = made_name(job->c, job->ref.texture, purpose),
                         .input_count = TEXTURE_INPUTS,
                         .channel_count = (uint32_t)job->p.channel_count,
                         .row = gloss_row,
                         .parameters = &job->p,
                         .parameter_size = sizeof job->p};
    memcpy(task.inputs, job->inputs, sizeof task.inputs);
    job->out->textures[slot] = job->ref;
    return texture_baker_bake(job->c->baker, &task, &job->out->textures[slot].texture, error);
}

static void remove_texture(scene_material *m, scene_texture_slot slot)
{
    m->textures[slot] = scene_material_default().textures[slot];
}

/* KHR_materials_specular, section "Conversions": ior 0 makes F0 the specular color, and nothing is lost. */
static facet_result to_specular(gloss_job *job, facet_error *error)
{
    scene_material *out = job->out;
    out->extensions |= SCENE_SPECULAR | SCENE_IOR;
    out->ior = 0.0f;
    out->specular = 1.0f;
    out->metallic = 0.0f;
    out->perceptual_roughness = 1.0f - job->in->glossiness;
    out->textures[SCENE_SPECULAR_COLOR_TEXTURE] = job->in->textures[SCENE_SPECULAR_GLOSSINESS_TEXTURE];
    if (!is_readable(job->c, job->in, SCENE_SPECULAR_GLOSSINESS_TEXTURE))
        return FACET_OK;
    out->perceptual_roughness = 1.0f;
    /* Roughness has a texture of its own, so lookups may differ. */
    job->inputs[GLOSS_BASE] = SCENE_NONE;
    job->inputs[GLOSS_SECOND] = job->in->textures[SCENE_SPECULAR_GLOSSINESS_TEXTURE].texture;
    job->ref = job->in->textures[SCENE_SPECULAR_GLOSSINESS_TEXTURE];
    job->p.is_core = 0;
    return bake(job, GLOSS_TO_ROUGHNESS, "roughness", SCENE_METALLIC_ROUGHNESS_TEXTURE, error);
}

static facet_result to_core(gloss_job *job, facet_error *error)
{
    scene_material *out = job->out;
    core_from_glossiness(job->p.factors.base_color, job->p.factors.specular_color, out->base_color,
                         &out->metallic);
    out->perceptual_roughness = job->p.factors.perceptual_roughness;
    for (int k = 0; k < 3; k++)
        out->specular_color[k] = 1.0f;
    if (job->ref.texture == SCENE_NONE)
        return FACET_OK;
    for (int k = 0; k < 3; k++)
        out->base_color[k] = 1.0f;
    facet_result result = bake(job, GLOSS_TO_BASE, "base", SCENE_BASE_COLOR_TEXTURE, error);
    if (result == FACET_OK)
        result = bake(job, GLOSS_TO_ROUGHNESS, "roughness", SCENE_METALLIC_ROUGHNESS_TEXTURE, error);
    out->metallic = out->perceptual_roughness = 1.0f;
    return result;
}

/* The error between the two surfaces with white textures; for core glTF, which is lossy, also its own. */
static void report(conversion *c, uint32_t material, bool is_exact, const char *profile)
{
    material_conversion *report = &c->out->materials[material];
    const scene_material *in = &c->scene->materials[material];
    report->pbr = c->materials[material];
    report->source = in;
    report->legacy = legacy_material_default();
    report->legacy.name = in->name;
    report->summary.name = in->name;
    report->summary.source =
        in->extensions & SCENE_SPECULAR_GLOSSINESS ? "specular-glossiness" : "metallic-roughness";
    report->summary.profile = profile;
    if (is_exact) {
        summary_exact(&report->summary, "exact");
        return;
    }
    summary_exact(&report->summary, "closed");
}

static void measure(conversion *c, uint32_t material, const pbr_surface *before, const pbr_surface *after)
{
    facet_conversion *summary = &c->out->materials[material].summary;
    fit_error error = compare_pbr(before, after);
    summary->error = error.E;
    summary->error_display = summary->error_graded = error.E_display;
    summary->error_drawn = (double)NAN; /* neither is a model of OpenGL 1 */
    memcpy(summary->error_views, error.views, sizeof summary->error_views);
    summary->grade = summary->grade_drawn = grade_of(error.E_display);
}

static void keep(conversion *c, uint32_t material)
{
    material_conversion *report = &c->out->materials[material];
    c->materials[material] = c->scene->materials[material];
    report->pbr = c->materials[material];
    report->source = &c->scene->materials[material];
    report->legacy = c->scene->legacy ? c->scene->legacy->materials[material] : legacy_material_default();
    report->summary.name = report->pbr.name;
    report->summary.source =
        report->pbr.extensions & SCENE_SPECULAR_GLOSSINESS ? "specular-glossiness" : "metallic-roughness";
    report->summary.profile = "core";
    summary_exact(&report->summary, "none");
}

static facet_result survey(conversion *c, bool is_glossy, facet_error *error)
{
    const facet_scene *scene = c->scene;
    const scene_texture_slot slots[] = {SCENE_BASE_COLOR_TEXTURE, SCENE_METALLIC_ROUGHNESS_TEXTURE,
                                        SCENE_SPECULAR_TEXTURE, SCENE_SPECULAR_COLOR_TEXTURE,
                                        SCENE_SPECULAR_GLOSSINESS_TEXTURE};
    bool *is_wanted = mem_zalloc(&scene->allocator, (size_t)scene->texture_count + 1, sizeof *is_wanted);
    c->materials = arena_alloc(scene->arena, (size_t)scene->material_count + 1, sizeof *c->materials);
    if (!is_wanted || !c->materials) {
        mem_free(is_wanted);
        return fail_memory(error, "materials", scene->material_count * sizeof *c->materials);
    }
    for (uint32_t i = 0; i < scene->material_count; i++)
        for (size_t s = 0; s < sizeof slots / sizeof *slots; s++) {
            const scene_material *m = &scene->materials[i];
            uint32_t texture = m->textures[slots[s]].texture;
            if (texture < scene->texture_count &&
                ((m->extensions & SCENE_SPECULAR_GLOSSINESS) != 0) == is_glossy)
                is_wanted[texture] = true;
        }
    facet_result result = texture_baker_survey(c->baker, is_wanted, c->log, error);
    mem_free(is_wanted);
    return result;
}

/* Factors with textures at their means. */
static pbr_surface mean_surface(const conversion *c, const scene_material *m)
{
    pbr_surface s;
    legacy_surface_of_pbr(m, &s);
    const scene_texture_slot colors[] = {SCENE_BASE_COLOR_TEXTURE, SCENE_SPECULAR_GLOSSINESS_TEXTURE};
    float *factors[] = {s.base_color, s.specular_color};
    for (int i = 0; i < 2; i++) {
        const texture_statistics *t = texture_baker_statistics(c->baker, m->textures[colors[i]].texture);
        for (int k = 0; k < 3 && t; k++)
            factors[i][k] *= (float)texture_mean(t, k, texture_baker_srgb(c->baker)->decoded);
    }
    return s;
}

facet_result convert_from_glossiness(conversion *c, facet_error *error)
{
    facet_scene *scene = c->scene;
    bool is_core = c->desc.profile == FACET_LEGACY_PROFILE_CORE;
    facet_result result = survey(c, true, error);
    for (uint32_t i = 0; i < scene->material_count && result == FACET_OK; i++) {
        const scene_material *in = &scene->materials[i];
        if (!(in->extensions & SCENE_SPECULAR_GLOSSINESS)) {
            keep(c, i);
            continue;
        }
        scene_material *out = &c->materials[i];
        gloss_job job = begin(c, i, out);
        out->extensions &= ~(uint32_t)SCENE_SPECULAR_GLOSSINESS;
        out->glossiness = 1.0f;
        remove_texture(out, SCENE_SPECULAR_GLOSSINESS_TEXTURE);
        remove_texture(out, SCENE_METALLIC_ROUGHNESS_TEXTURE);
        result = is_core ? to_core(&job, error) : to_specular(&job, error);
        report(c, i, !is_core, is_core ? "core" : "specular+ior");
        if (!is_core)
            continue;
        pbr_surface before = mean_surface(c, in);
        pbr_surface after = pbr_surface_default();
        core_from_glossiness(before.base_color, before.specular_color, after.base_color, &after.metallic);
        after.perceptual_roughness = before.perceptual_roughness;
        measure(c, i, &before, &after);
    }
    return result;
}

/* ---- to specular-glossiness ---- */

static facet_result to_glossy(gloss_job *job, bool *is_exact, facet_error *error)
{
    scene_material *out = job->out;
    *is_exact = glossiness_from_surface(&job->p.factors, out->base_color, out->specular_color);
    out->glossiness = 1.0f - job->p.factors.perceptual_roughness;
    bool is_scaled = job->in->metallic == 0.0f;
    for (int i = GLOSS_SECOND; i < TEXTURE_INPUTS; i++)
        is_scaled &= job->inputs[i] == SCENE_NONE;
    if (is_scaled) /* a dielectric: the base color is the diffuse color, including its texture */
        return FACET_OK;
    if (job->ref.texture == SCENE_NONE)
        return FACET_OK;
    for (int k = 0; k < 3; k++)
        out->base_color[k] = out->specular_color[k] = 1.0f;
    out->glossiness = 1.0f;
    facet_result result = bake(job, GLOSS_TO_DIFFUSE, "diffuse", SCENE_BASE_COLOR_TEXTURE, error);
    return result == FACET_OK
               ? bake(job, GLOSS_TO_SPECULAR, "specular", SCENE_SPECULAR_GLOSSINESS_TEXTURE, error)
               : result;
}

static void note_dropped(conversion *c, uint32_t material, uint32_t extensions)
{
    for (int i = 0; i < MATERIAL_EXTENSION_COUNT; i++)
        if (extensions & material_extensions[i].bit)
            note_add(&c->notes, material, NOTE_EXTENSION_NOT_WRITTEN,
                     "%s cannot stand beside specular-glossiness and is dropped",
                     material_extensions[i].name);
}

facet_result convert_to_glossiness(conversion *c, facet_error *error)
{
    facet_scene *scene = c->scene;
    facet_result result = survey(c, false, error);
    for (uint32_t i = 0; i < scene->material_count && result == FACET_OK; i++) {
        const scene_material *in = &scene->materials[i];
        if (in->extensions & (SCENE_SPECULAR_GLOSSINESS | SCENE_UNLIT)) {
            keep(c, i);
            continue;
        }
        scene_material *out = &c->materials[i];
        bool is_exact;
        gloss_job job = begin(c, i, out);
        const uint32_t folded = SCENE_SPECULAR | SCENE_IOR; /* folded into the specular color */
        note_dropped(c, i, in->extensions & ~(folded | (uint32_t)SCENE_EMISSIVE_STRENGTH));
        out->extensions = SCENE_SPECULAR_GLOSSINESS | (in->extensions & (uint32_t)SCENE_EMISSIVE_STRENGTH);
        out->ior = 1.5f;
        out->specular = 1.0f;
        out->metallic = out->perceptual_roughness = 1.0f;
        remove_texture(out, SCENE_METALLIC_ROUGHNESS_TEXTURE);
        remove_texture(out, SCENE_SPECULAR_TEXTURE);
        remove_texture(out, SCENE_SPECULAR_COLOR_TEXTURE);
        result = to_glossy(&job, &is_exact, error);
        report(c, i, is_exact, "specular-glossiness");
        if (is_exact)
            continue;
        pbr_surface after = job.p.factors;
        glossiness_from_surface(&job.p.factors, after.base_color, after.specular_color);
        after.metallic = after.ior = 0.0f;
        after.specular = 1.0f;
        measure(c, i, &job.p.factors, &after);
    }
    return result;
}
