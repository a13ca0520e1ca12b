/* convert_build_maps.c - textures of the surface of a glTF material: base color with opacity, specular,
 * roughness. An image that needs a factor only stays the same file; others are converted texel by texel.
 * Maps of one material with different lookups cannot be combined into one texture: the first of diffuse,
 * specular, shininess, opacity keeps its texels, the others are replaced by their means. */
#include <string.h>

#include "base/result.h"
#include "legacy/convert_state.h"
#include "legacy/convert_texels.h"

static bool has_map(const legacy_reading *r, legacy_map_slot slot)
{
    return legacy_has_map(&r->m, slot);
}

static void set_mean(conversion *c, uint32_t material, const char *statement, legacy_map *map)
{
    note_add(&c->notes, material, NOTE_TEXTURE_AVERAGED,
             "%s is placed otherwise than the maps that it would have to be combined with; its mean is used",
             statement);
    map->ref.texture = SCENE_NONE;
}

/* ---- opacity ---- */

/* The source of the alpha of the base color. */
typedef struct opacity_source {
    legacy_map map; /* texture SCENE_NONE: only the factor */
    scalar_lut table;
} opacity_source;

static bool is_cut_out(const texture_baker *baker, const opacity_source *o)
{
    const texture_statistics *s = texture_baker_statistics(baker, o->map.ref.texture);
    for (int code = 0; s && code < 256; code++)
        if (s->histogram[o->table.channel][code] > 0 && o->table.values[code] > 0.0f &&
            o->table.values[code] < 1.0f)
            return false;
    return s != NULL;
}

static opacity_source read_opacity(const conversion *c, const legacy_reading *r, scene_material *out)
{
    opacity_source o = {.map = r->m.maps[LEGACY_OPACITY_MAP]};
    if (o.map.ref.texture == SCENE_NONE && r->has_diffuse_alpha) {
        o.map = r->m.maps[LEGACY_DIFFUSE_MAP];
        o.map.channel = 'm';
        o.map.base = 0.0f;
        o.map.gain = 1.0f;
    }
    if (o.map.ref.texture == SCENE_NONE) {
        out->alpha_mode = r->opacity < 1.0f ? SCENE_ALPHA_BLEND : SCENE_ALPHA_OPAQUE;
        out->base_color[3] = r->opacity;
        return o;
    }
    int channel = map_opacity_channel(c->baker, &o.map);
    o.table = scalar_lut_make(c->baker, &o.map, r->opacity, channel);
    if (scalar_lut_lowest(&o.table, c->baker, &o.map) >= 1.0f) {
        o.map.ref.texture = SCENE_NONE;
        out->base_color[3] = 1.0f;
        return o;
    }
    out->alpha_mode = is_cut_out(c->baker, &o) ? SCENE_ALPHA_MASK : SCENE_ALPHA_BLEND;
    out->base_color[3] = r->opacity;
    return o;
}

/* ---- base color ---- */

typedef struct surface_job {
    conversion *c;
    uint32_t material;
    const legacy_reading *r;
    const solve_item *item; /* NULL: the diffuse color is the base color */
    opacity_source opacity;
    legacy_map specular, shininess; /* of Blinn-Phong; texture SCENE_NONE: constant */
    texel_parameters p;
    scene_material *out;
} surface_job;

static bool is_varying(const surface_job *job)
{
    return job->specular.ref.texture != SCENE_NONE || job->shininess.ref.texture != SCENE_NONE;
}

/* Base color over diffuse color if specular color and shininess are constant: that of the fit of the mean,
 * or, if that is nearly black or clamped, of the closed form. */
static void base_factors(const surface_job *job, float out[3])
{
    const solve_item *item = job->item;
    for (int k = 0; k < 3; k++) {
        out[k] = job->r->surface.diffuse[k];
        if (!item)
            continue;
        float mean = item->input.ogl1.diffuse[k];
        float rest = 1.0f - (item->pbr.ior == 0.0f ? item->pbr.specular : 0.04f);
        if (job->r->m.maps[LEGACY_DIFFUSE_MAP].ref.texture == SCENE_NONE)
            out[k] = item->pbr.base_color[k];
        else if (mean > 0.02f && item->pbr.base_color[k] < 1.0f)
            out[k] *= item->pbr.base_color[k] / mean;
        else
            out[k] /= rest > 1e-3f ? rest : 1e-3f;
    }
}

/* Whether the image of the diffuse map can be used unchanged. */
static bool is_reusable(const surface_job *job, const float factors[3])
{
    const legacy_map *diffuse = &job->r->m.maps[LEGACY_DIFFUSE_MAP];
    const legacy_map *opacity = &job->opacity.map;
    const texture_statistics *s = texture_baker_statistics(job->c->baker, diffuse->ref.texture);
    if (is_varying(job) || !map_is_plain(diffuse) || highest_of(factors) > 1.0f)
        return false;
    if (job->out->alpha_mode == SCENE_ALPHA_OPAQUE)
        return true;
    if (opacity->ref.texture == SCENE_NONE)
        return !s->has_alpha;
    return opacity->ref.texture == diffuse->ref.texture && job->opacity.table.channel == TEXTURE_ALPHA &&
           opacity->base == 0.0f && opacity->gain == 1.0f;
}

/* The largest possible base color, which keeps the loss to 8 bits small. */
static void base_scale(surface_job *job)
{
    const legacy_map *diffuse = &job->r->m.maps[LEGACY_DIFFUSE_MAP];
    float most[3];
    color_lut_highest(&job->p.diffuse, job->c->baker, diffuse, most);
    for (int k = 0; k < 3; k++) {
        float highest = is_varying(job) ? 1.0f : unit_of(most[k]);
        job->p.base_scale[k] = highest > 0.0f ? highest : 1.0f;
        job->out->base_color[k] = highest;
    }
}

static texture_bake bake_of(surface_job *job, const char *purpose, uint32_t channel_count, texture_row *row)
{
    const uint32_t inputs[TEXEL_INPUTS] = {[TEXEL_DIFFUSE] = job->r->m.maps[LEGACY_DIFFUSE_MAP].ref.texture,
                                           [TEXEL_SPECULAR] = job->specular.ref.texture,
                                           [TEXEL_SHININESS] = job->shininess.ref.texture,
                                           [TEXEL_OPACITY] = job->opacity.map.ref.texture};
    texture_bake bake = {.input_count = TEXEL_INPUTS,
                         .channel_count = channel_count,
                         .row = row,
                         .parameters = &job->p,
                         .parameter_size = TEXEL_KEY_SIZE};
    uint32_t first = SCENE_NONE;
    for (int i = 0; i < TEXEL_INPUTS; i++) {
        bake.inputs[i] = inputs[i];
        first = first == SCENE_NONE ? inputs[i] : first;
    }
    bake.name = made_name(job->c, first, purpose);
    return bake;
}

/* The lookup that the inputs of a bake share. */
static scene_texture_ref shared_ref(const surface_job *job)
{
    const legacy_map *maps[] = {&job->r->m.maps[LEGACY_DIFFUSE_MAP], &job->specular, &job->shininess,
                                &job->opacity.map};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
        if (maps[i]->ref.texture != SCENE_NONE)
            return maps[i]->ref;
    return maps[0]->ref;
}

static facet_result build_base(surface_job *job, facet_error *error)
{
    const legacy_map *diffuse = &job->r->m.maps[LEGACY_DIFFUSE_MAP];
    scene_material *out = job->out;
    bool is_transparent = job->opacity.map.ref.texture != SCENE_NONE;
    float factors[3];
    base_factors(job, factors);
    bool has_texels = diffuse->ref.texture != SCENE_NONE || is_transparent || is_varying(job);
    if (!has_texels || (diffuse->ref.texture != SCENE_NONE && is_reusable(job, factors))) {
        for (int k = 0; k < 3; k++)
            out->base_color[k] = unit_of(factors[k]);
        out->textures[SCENE_BASE_COLOR_TEXTURE] = diffuse->ref;
        return FACET_OK;
    }
    if (!is_varying(job)) {
        /* The LUT holds base colors already, without a specular color. */
        job->p.diffuse = color_lut_make(job->c->baker, diffuse, factors);
        memset(job->p.specular.values, 0, sizeof job->p.specular.values);
        job->p.is_core = 0;
    }
    base_scale(job);
    job->p.opacity = job->opacity.table;
    for (int code = 0; code < 256; code++) /* the factor is not baked */
        job->p.opacity.values[code] =
            out->base_color[3] > 0.0f ? job->p.opacity.values[code] / out->base_color[3] : 0.0f;
    job->p.channel_count = is_transparent ? 4 : 3;
    texture_bake bake = bake_of(job, "base", is_transparent ? 4 : 3, texel_base_row);
    if (!is_varying(job))
        bake.inputs[TEXEL_SPECULAR] = bake.inputs[TEXEL_SHININESS] = SCENE_NONE;
    scene_texture_ref *ref = &out->textures[SCENE_BASE_COLOR_TEXTURE];
    *ref = shared_ref(job);
    return texture_baker_bake(job->c->baker, &bake, &ref->texture, error);
}

/* ---- specular and roughness of Blinn-Phong maps ---- */

static facet_result build_specular(surface_job *job, facet_error *error)
{
    scene_material *out = job->out;
    texel_parameters *p = &job->p;
    float highest[3];
    color_lut_highest(&p->specular, job->c->baker, &job->specular, highest);
    p->specular_scale =
        unit_of(highest_of(highest) * scalar_lut_highest(&p->share, job->c->baker, &job->shininess));
    out->specular = p->specular_scale;
    for (int k = 0; k < 3; k++)
        out->specular_color[k] = 1.0f;
    if (p->specular_scale <= 0.0f)
        return FACET_OK;
    bool has_color = job->specular.ref.texture != SCENE_NONE;
    texture_bake bake = bake_of(job, "specular", 4, texel_specular_row);
    bake.inputs[TEXEL_DIFFUSE] = bake.inputs[TEXEL_OPACITY] = SCENE_NONE;
    scene_texture_ref ref = shared_ref(job);
    facet_result result = texture_baker_bake(job->c->baker, &bake, &ref.texture, error);
    out->textures[SCENE_SPECULAR_TEXTURE] = ref;
    if (has_color)
        out->textures[SCENE_SPECULAR_COLOR_TEXTURE] = ref;
    for (int k = 0; k < 3 && !has_color; k++)
        out->specular_color[k] = p->specular.values[k][255] / highest_of(highest);
    return result;
}

static facet_result build_roughness(surface_job *job, facet_error *error)
{
    scene_material *out = job->out;
    bool is_wanted = job->shininess.ref.texture != SCENE_NONE || job->p.is_core;
    if (!is_wanted)
        return FACET_OK;
    texture_bake bake = bake_of(job, "roughness", 3, texel_roughness_row);
    if (!job->p.is_core)
        bake.inputs[TEXEL_DIFFUSE] = bake.inputs[TEXEL_SPECULAR] = SCENE_NONE;
    bake.inputs[TEXEL_OPACITY] = SCENE_NONE;
    out->perceptual_roughness = 1.0f;
    out->metallic = job->p.is_core ? 1.0f : 0.0f;
    scene_texture_ref *ref = &out->textures[SCENE_METALLIC_ROUGHNESS_TEXTURE];
    *ref = shared_ref(job);
    return texture_baker_bake(job->c->baker, &bake, &ref->texture, error);
}

/* Replaces the maps whose lookup differs from that of the first by their means. */
static void align(surface_job *job, legacy_reading *r)
{
    const texture_baker *baker = job->c->baker;
    struct {
        legacy_map *map;
        const char *statement;
    } maps[] = {{&r->m.maps[LEGACY_DIFFUSE_MAP], "map_Kd"},
                {&job->specular, "map_Ks"},
                {&job->shininess, "map_Ns"},
                {&job->opacity.map, "map_d"}};
    const scene_texture_ref *first = NULL;
    for (int i = 0; i < TEXEL_INPUTS; i++) {
        legacy_map *map = maps[i].map;
        if (map->ref.texture == SCENE_NONE)
            continue;
        first = first ? first : &map->ref;
        if (map_refs_agree(job->c->scene, first, &map->ref))
            continue;
        if (i == TEXEL_SPECULAR) {
            color_lut t = color_lut_make(baker, map, r->surface.specular);
            color_lut_mean(&t, baker, map, r->surface.specular);
        } else if (i == TEXEL_SHININESS) {
            scalar_lut t = scalar_lut_make(baker, map, r->surface.shininess, TEXTURE_GREY);
            r->surface.shininess = scalar_lut_mean(&t, baker, map);
        } else {
            r->opacity = scalar_lut_mean(&job->opacity.table, baker, map);
            job->out->base_color[3] = r->opacity;
            job->out->alpha_mode = r->opacity < 1.0f ? SCENE_ALPHA_BLEND : SCENE_ALPHA_OPAQUE;
        }
        set_mean(job->c, job->material, maps[i].statement, map);
        if (i == TEXEL_OPACITY)
            job->opacity.table = scalar_lut_make(baker, map, r->opacity, TEXTURE_GREY);
    }
}

static void make_tables(surface_job *job)
{
    const texture_baker *baker = job->c->baker;
    texel_parameters *p = &job->p;
    const ogl1_surface *s = &job->r->surface;
    p->srgb = texture_baker_srgb(baker);
    p->is_core = is_varying(job) && job->c->desc.profile == FACET_LEGACY_PROFILE_CORE;
    p->diffuse = color_lut_make(baker, &job->r->m.maps[LEGACY_DIFFUSE_MAP], s->diffuse);
    p->specular = color_lut_make(baker, &job->specular, s->specular);
    p->shininess = scalar_lut_make(baker, &job->shininess, s->shininess, TEXTURE_GREY);
    p->roughness.channel = p->share.channel = p->shininess.channel;
    for (int code = 0; code < 256; code++) {
        p->roughness.values[code] = perceptual_roughness_from_shininess(p->shininess.values[code]);
        p->share.values[code] = reflectance_share_from_shininess(p->shininess.values[code]);
    }
}

/* ---- roughness and metallic that are stated ---- */

static bool is_channel(const legacy_map *map, char letter)
{
    return map->ref.texture != SCENE_NONE && map->channel == letter && map->base == 0.0f && map->gain == 1.0f;
}

/* Maps of a material that states roughness and metallic. */
typedef struct stated_maps {
    legacy_map roughness, metallic;
    bool is_gloss; /* roughness is 1 minus the map, a glossiness */
    bool is_rma;   /* both are channels of one map, whose third one is occlusion */
} stated_maps;

static facet_result build_packed(conversion *c, uint32_t material, const stated_maps *maps,
                                 scene_material *out, facet_error *error)
{
    const legacy_map roughness = maps->roughness;
    legacy_map metallic = maps->metallic;
    scene_texture_ref *ref = &out->textures[SCENE_METALLIC_ROUGHNESS_TEXTURE];
    bool is_rough = roughness.ref.texture != SCENE_NONE;
    bool is_metal = metallic.ref.texture != SCENE_NONE;
    if (!is_rough && !is_metal)
        return FACET_OK;
    packed_parameters p;
    memset(&p, 0, sizeof p);
    if (is_rough && is_metal && !map_refs_agree(c->scene, &roughness.ref, &metallic.ref)) {
        scalar_lut t = scalar_lut_make(c->baker, &metallic, out->metallic, TEXTURE_GREY);
        out->metallic = scalar_lut_mean(&t, c->baker, &metallic);
        set_mean(c, material, "map_Pm", &metallic);
        is_metal = false;
    }
    *ref = is_rough ? roughness.ref : metallic.ref;
    if (!maps->is_gloss && is_rough && is_metal && roughness.ref.texture == metallic.ref.texture &&
        is_channel(&roughness, 'g') && is_channel(&metallic, 'b'))
        return FACET_OK;
    p.roughness = scalar_lut_make(c->baker, &roughness, 1.0f, TEXTURE_GREY);
    p.metallic = scalar_lut_make(c->baker, &metallic, 1.0f, TEXTURE_GREY);
    legacy_map occlusion = maps->is_rma ? roughness : legacy_map_default();
    occlusion.channel = 'b';
    p.occlusion = scalar_lut_make(c->baker, &occlusion, 1.0f, TEXTURE_BLUE);
    if (maps->is_gloss) { /* roughness = 1 - factor gloss: the factor is baked */
        for (int code = 0; code < 256; code++)
            p.roughness.values[code] = 1.0f - (1.0f - out->perceptual_roughness) * p.roughness.values[code];
        out->perceptual_roughness = 1.0f;
    }
    texture_bake bake = {.name = made_name(c, ref->texture, "roughness"),
                         .inputs = {roughness.ref.texture, metallic.ref.texture},
                         .input_count = 2,
                         .channel_count = 3,
                         .row = texel_packed_row,
                         .parameters = &p,
                         .parameter_size = sizeof p};
    return texture_baker_bake(c->baker, &bake, &ref->texture, error);
}

static facet_result build_orm(conversion *c, const legacy_reading *r, scene_material *out, facet_error *error)
{
    const legacy_map *orm = &r->m.maps[LEGACY_ORM_MAP];
    stated_maps maps = {.roughness = *orm, .metallic = *orm, .is_rma = r->m.is_rma};
    maps.roughness.channel = r->m.is_rma ? 'r' : 'g';
    maps.metallic.channel = r->m.is_rma ? 'g' : 'b';
    facet_result result = build_packed(c, SCENE_NONE, &maps, out, error);
    out->textures[SCENE_OCCLUSION_TEXTURE] = out->textures[SCENE_METALLIC_ROUGHNESS_TEXTURE];
    return result;
}

static facet_result build_stated(conversion *c, uint32_t material, const legacy_reading *r,
                                 scene_material *out, facet_error *error)
{
    const legacy_map *maps = r->m.maps;
    stated_maps stated = {.roughness = maps[LEGACY_ROUGHNESS_MAP], .metallic = maps[LEGACY_METALLIC_MAP]};
    if (r->kind == READING_GLOSSY) {
        /* Specular colors are sRGB in both: the image is used unchanged. */
        out->textures[SCENE_SPECULAR_COLOR_TEXTURE] = maps[LEGACY_SPECULAR_MAP].ref;
        stated = (stated_maps){
            .roughness = maps[LEGACY_SHININESS_MAP], .metallic = legacy_map_default(), .is_gloss = true};
    } else if (r->has_shininess_as_roughness) {
        stated =
            (stated_maps){.roughness = maps[LEGACY_SHININESS_MAP], .metallic = maps[LEGACY_SPECULAR_MAP]};
    } else if (has_map(r, LEGACY_ORM_MAP)) {
        return build_orm(c, r, out, error);
    }
    return build_packed(c, material, &stated, out, error);
}

facet_result build_surface_maps(conversion *c, uint32_t material, legacy_reading *r, const solve_item *item,
                                scene_material *out, facet_error *error)
{
    bool is_fitted = r->kind == READING_OGL1;
    const legacy_map none = legacy_map_default();
    surface_job job = {.c = c,
                       .material = material,
                       .r = r,
                       .item = is_fitted ? item : NULL,
                       .specular = is_fitted ? r->m.maps[LEGACY_SPECULAR_MAP] : none,
                       .shininess = is_fitted ? r->m.maps[LEGACY_SHININESS_MAP] : none,
                       .out = out};
    memset(&job.p, 0, sizeof job.p); /* its padding is part of the key */
    job.opacity = read_opacity(c, r, out);
    align(&job, r);
    if (has_map(r, LEGACY_DIFFUSE_MAP) || is_varying(&job) || job.opacity.map.ref.texture != SCENE_NONE)
        make_tables(&job);
    core_grid *core = NULL;
    if (job.p.is_core) {
        core = mem_alloc(&c->scene->allocator, 1, sizeof *core);
        if (!core)
            return fail_memory(error, "textures", sizeof *core);
        core_grid_make(core, scalar_lut_lowest(&job.p.shininess, c->baker, &job.shininess),
                       scalar_lut_highest(&job.p.shininess, c->baker, &job.shininess),
                       c->scene->thread_count);
        job.p.core = core;
    }
    facet_result result = build_base(&job, error);
    if (result == FACET_OK && !is_fitted && r->kind != READING_UNLIT)
        result = build_stated(c, material, r, out, error);
    if (result == FACET_OK && is_fitted && is_varying(&job) && !job.p.is_core)
        result = build_specular(&job, error);
    if (result == FACET_OK && is_fitted && is_varying(&job))
        result = build_roughness(&job, error);
    mem_free(core);
    return result;
}
