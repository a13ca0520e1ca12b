/* convert_ogl1_maps.c - textures of glTF materials as maps of legacy ones. A legacy material has one
 * exponent, that of its mean; each texel takes the colors that approximate it best with that exponent. */
#include "legacy/convert_state.h"

#include <math.h>
#include <string.h>

#include "legacy/convert_texels.h"

/* ---- texels as surfaces ---- */

/* Inputs of a bake. */
enum { PBR_BASE, PBR_METALLIC_ROUGHNESS, PBR_SPECULAR, PBR_SPECULAR_COLOR, PBR_INPUTS };

/* Part of the key of a bake. */
typedef struct pbr_parameters {
    pbr_surface factors;
    float shininess;          /* of the material */
    int is_glossy;            /* input 1 is a specular-glossiness texture */
    int is_specular;          /* the result is the specular color, else the diffuse one */
    float occlusion_strength; /* strength of the occlusion texture in input 2; 0: none */
    int target;               /* facet_legacy_target */
    const srgb_tables *srgb;
    /* last: determined by the members above, and no part of the key; NULL: closed form */
    const ogl1_grid *grid;
} pbr_parameters;

bool ogl1_reads_slot(scene_texture_slot slot)
{
    return slot == SCENE_BASE_COLOR_TEXTURE || slot == SCENE_METALLIC_ROUGHNESS_TEXTURE ||
           slot == SCENE_SPECULAR_TEXTURE || slot == SCENE_SPECULAR_COLOR_TEXTURE ||
           slot == SCENE_SPECULAR_GLOSSINESS_TEXTURE || slot == SCENE_OCCLUSION_TEXTURE;
}

/* The surface of a texel; texels NULL: white. */
static pbr_surface surface_of(const pbr_parameters *p, const uint8_t *const texels[PBR_INPUTS])
{
    pbr_surface s = p->factors;
    const float *decoded = p->srgb->decoded;
    const uint8_t *second = texels[PBR_METALLIC_ROUGHNESS];
    for (int k = 0; k < 3; k++) {
        if (texels[PBR_BASE])
            s.base_color[k] *= decoded[texels[PBR_BASE][k]];
        if (p->is_glossy && second)
            s.specular_color[k] *= decoded[second[k]];
        if (texels[PBR_SPECULAR_COLOR])
            s.specular_color[k] *= decoded[texels[PBR_SPECULAR_COLOR][k]];
    }
    if (second && p->is_glossy) {
        s.perceptual_roughness = 1.0f - (1.0f - s.perceptual_roughness) * (float)second[3] / 255.0f;
    } else if (second) {
        s.perceptual_roughness *= (float)second[1] / 255.0f;
        s.metallic *= (float)second[2] / 255.0f;
    }
    if (texels[PBR_SPECULAR] && p->occlusion_strength == 0.0f)
        s.specular *= (float)texels[PBR_SPECULAR][3] / 255.0f;
    return s;
}

static void pbr_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out)
{
    const pbr_parameters *p = parameters;
    pbr_surface last = {.ior = -1.0f};
    ogl1_surface answer = {.shininess = 0.0f};
    for (uint32_t x = 0; x < width; x++, out += 3) {
        const uint8_t *texels[PBR_INPUTS];
        for (int i = 0; i < PBR_INPUTS; i++)
            texels[i] = in[i] ? in[i] + (size_t)x * 4 : NULL;
        pbr_surface s = surface_of(p, texels);
        if (memcmp(&s, &last, sizeof s) != 0) { /* neighbours are often equal */
            last = s;
            if (p->grid)
                ogl1_grid_look_up(p->grid, &s, &answer);
            else
                pbr_to_ogl1_closed_at(&s, p->shininess, &answer);
        }
        float scale = 1.0f;
        if (!p->is_specular && p->occlusion_strength > 0.0f && texels[PBR_SPECULAR])
            scale = 1.0f + p->occlusion_strength * ((float)texels[PBR_SPECULAR][0] / 255.0f - 1.0f);
        const float *color = p->is_specular ? answer.specular : answer.diffuse;
        for (int k = 0; k < 3; k++)
            out[k] = srgb_encode_u8(p->srgb, color[k] * scale);
    }
}

/* ---- which textures take part ---- */

static bool is_readable(const conversion *c, const scene_material *m, scene_texture_slot slot)
{
    return texture_baker_statistics(c->baker, m->textures[slot].texture) != NULL;
}

static scene_texture_slot second_slot(const scene_material *m)
{
    return m->extensions & SCENE_SPECULAR_GLOSSINESS ? SCENE_SPECULAR_GLOSSINESS_TEXTURE
                                                     : SCENE_METALLIC_ROUGHNESS_TEXTURE;
}

static double mean_of(const conversion *c, const scene_texture_ref *ref, int channel, bool is_color)
{
    const texture_statistics *s = texture_baker_statistics(c->baker, ref->texture);
    float values[256];
    if (!s)
        return 1.0;
    for (int code = 0; code < 256; code++)
        values[code] = is_color ? texture_baker_srgb(c->baker)->decoded[code] : (float)code / 255.0f;
    return texture_mean(s, channel, values);
}

pbr_surface ogl1_representative(const conversion *c, const scene_material *m)
{
    pbr_surface s;
    legacy_surface_of_pbr(m, &s);
    const scene_texture_ref *t = m->textures;
    bool is_glossy = (m->extensions & SCENE_SPECULAR_GLOSSINESS) != 0;
    const scene_texture_ref *gloss = &t[SCENE_SPECULAR_GLOSSINESS_TEXTURE];
    for (int k = 0; k < 3; k++) {
        s.base_color[k] *= (float)mean_of(c, &t[SCENE_BASE_COLOR_TEXTURE], k, true);
        s.specular_color[k] *=
            (float)mean_of(c, is_glossy ? gloss : &t[SCENE_SPECULAR_COLOR_TEXTURE], k, true);
    }
    if (is_glossy) {
        s.perceptual_roughness = 1.0f - m->glossiness * (float)mean_of(c, gloss, TEXTURE_ALPHA, false);
    } else {
        const scene_texture_ref *rough = &t[SCENE_METALLIC_ROUGHNESS_TEXTURE];
        s.perceptual_roughness *= (float)mean_of(c, rough, TEXTURE_GREEN, false);
        s.metallic *= (float)mean_of(c, rough, TEXTURE_BLUE, false);
        s.specular *= (float)mean_of(c, &t[SCENE_SPECULAR_TEXTURE], TEXTURE_ALPHA, false);
    }
    return s;
}

static bool bakes_occlusion(const conversion *c, const scene_material *m)
{
    return c->desc.bakes_occlusion && is_readable(c, m, SCENE_OCCLUSION_TEXTURE) &&
           m->occlusion_strength > 0.0f;
}

bool ogl1_needs_texels(const conversion *c, const scene_material *m)
{
    bool is_glossy = (m->extensions & SCENE_SPECULAR_GLOSSINESS) != 0;
    if (is_readable(c, m, second_slot(m)) || bakes_occlusion(c, m))
        return true;
    if (is_glossy)
        return false;
    return is_readable(c, m, SCENE_SPECULAR_TEXTURE) || is_readable(c, m, SCENE_SPECULAR_COLOR_TEXTURE) ||
           (m->metallic > 0.0f && is_readable(c, m, SCENE_BASE_COLOR_TEXTURE));
}

/* ---- diffuse and specular ---- */

typedef struct pbr_job {
    conversion *c;
    uint32_t material;
    const scene_material *m;
    legacy_material *out;
    pbr_parameters p;
    uint32_t inputs[PBR_INPUTS];
    scene_texture_ref ref; /* shared by the inputs; texture SCENE_NONE: there are none */
} pbr_job;

/* Adds a texture as an input if it can be read and has the same lookup as the others. */
static bool take(pbr_job *job, int input, scene_texture_slot slot)
{
    const scene_texture_ref *ref = &job->m->textures[slot];
    if (!is_readable(job->c, job->m, slot))
        return false;
    if (job->ref.texture == SCENE_NONE)
        job->ref = *ref;
    if (!map_refs_agree(job->c->scene, &job->ref, ref)) {
        note_add(&job->c->notes, job->material, NOTE_TEXTURE_AVERAGED,
                 "textures are placed otherwise than the base color; their means are used");
        return false;
    }
    job->inputs[input] = ref->texture;
    return true;
}

static void take_inputs(pbr_job *job)
{
    const pbr_surface mean = ogl1_representative(job->c, job->m);
    pbr_surface *factors = &job->p.factors;
    const bool is_glossy = (job->m->extensions & SCENE_SPECULAR_GLOSSINESS) != 0;
    job->p.is_glossy = is_glossy;
    if (!take(job, PBR_BASE, SCENE_BASE_COLOR_TEXTURE))
        memcpy(factors->base_color, mean.base_color, sizeof factors->base_color);
    if (!take(job, PBR_METALLIC_ROUGHNESS, second_slot(job->m))) {
        factors->perceptual_roughness = mean.perceptual_roughness;
        factors->metallic = mean.metallic;
        if (is_glossy)
            memcpy(factors->specular_color, mean.specular_color, sizeof factors->specular_color);
    }
    if (is_glossy)
        return;
    if (!take(job, PBR_SPECULAR, SCENE_SPECULAR_TEXTURE))
        factors->specular = mean.specular;
    if (!take(job, PBR_SPECULAR_COLOR, SCENE_SPECULAR_COLOR_TEXTURE))
        memcpy(factors->specular_color, mean.specular_color, sizeof factors->specular_color);
}

static facet_result bake_color(pbr_job *job, bool is_specular, facet_error *error)
{
    legacy_material *out = job->out;
    legacy_map *map = &out->maps[is_specular ? LEGACY_SPECULAR_MAP : LEGACY_DIFFUSE_MAP];
    float *factor = is_specular ? out->specular : out->diffuse;
    job->p.is_specular = is_specular;
    texture_bake bake = {.name = made_name(job->c, job->ref.texture, is_specular ? "specular" : "diffuse"),
                         .input_count = PBR_INPUTS,
                         .channel_count = 3,
                         .row = pbr_row,
                         .parameters = &job->p,
                         .parameter_size = offsetof(pbr_parameters, grid)};
    memcpy(bake.inputs, job->inputs, sizeof bake.inputs);
    if (!is_specular && bakes_occlusion(job->c, job->m) && bake.inputs[PBR_SPECULAR] == SCENE_NONE &&
        take(job, PBR_SPECULAR, SCENE_OCCLUSION_TEXTURE)) {
        bake.inputs[PBR_SPECULAR] = job->inputs[PBR_SPECULAR];
        job->inputs[PBR_SPECULAR] = SCENE_NONE;
        job->p.occlusion_strength = job->m->occlusion_strength;
    }
    map->ref = job->ref;
    facet_result result = texture_baker_bake(job->c->baker, &bake, &map->ref.texture, error);
    job->p.occlusion_strength = 0.0f;
    for (int k = 0; k < 3 && map->ref.texture != SCENE_NONE; k++)
        factor[k] = 1.0f;
    return result;
}

/* The exponents of the roughest and the smoothest tenth of the texels. */
static void note_spread(const pbr_job *job, float shininess)
{
    scene_texture_slot slot = second_slot(job->m);
    bool is_glossy = slot == SCENE_SPECULAR_GLOSSINESS_TEXTURE;
    const texture_statistics *s = texture_baker_statistics(job->c->baker, job->m->textures[slot].texture);
    float found[2];
    if (!s)
        return;
    for (int i = 0; i < 2; i++) {
        pbr_surface surface = ogl1_representative(job->c, job->m);
        ogl1_surface out;
        float value = (float)texture_percentile(s, is_glossy ? TEXTURE_ALPHA : TEXTURE_GREEN,
                                                (i == 0) != is_glossy ? 0.9 : 0.1) /
                      255.0f;
        surface.perceptual_roughness =
            is_glossy ? 1.0f - job->m->glossiness * value : job->m->perceptual_roughness * value;
        pbr_to_ogl1_closed(&surface, &out);
        found[i] = out.shininess;
    }
    if (fabsf(found[1] - found[0]) > 0.1f * shininess)
        note_add(&job->c->notes, job->material, NOTE_SHININESS_SPREAD,
                 "one shininess, %.3g, replaces those from %.3g to %.3g", (double)shininess, (double)found[0],
                 (double)found[1]);
}

/* An image that is only scaled stays the same: the diffuse color is proportional to the base color of a
 * dielectric. */
static void reuse_base(const conversion *c, const scene_material *m, const solve_item *item,
                       legacy_material *out)
{
    if (!is_readable(c, m, SCENE_BASE_COLOR_TEXTURE))
        return;
    float diffuse[3];
    for (int k = 0; k < 3; k++) {
        float mean = item->input.pbr.base_color[k];
        diffuse[k] =
            unit_of(mean > 0.0f ? m->base_color[k] * item->ogl1.diffuse[k] / mean : m->base_color[k]);
    }
    legacy_color_from_linear(diffuse, c->legacy->colors, out->diffuse);
    out->maps[LEGACY_DIFFUSE_MAP].ref = m->textures[SCENE_BASE_COLOR_TEXTURE];
}

/* ---- single channels: roughness, metallic, alpha tests ---- */

typedef struct channel_parameters {
    scalar_lut table;
} channel_parameters;

static void channel_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out)
{
    const channel_parameters *p = parameters;
    for (uint32_t x = 0; x < width; x++)
        out[x] = texel_code(lut_scalar(&p->table, in[0] + (size_t)x * 4));
}

static facet_result bake_channel(conversion *c, const scene_texture_ref *ref, const scalar_lut *table,
                                 const char *purpose, legacy_map *out, facet_error *error)
{
    channel_parameters p;
    memset(&p, 0, sizeof p);
    p.table = *table;
    texture_bake bake = {.name = made_name(c, ref->texture, purpose),
                         .inputs = {ref->texture},
                         .input_count = 1,
                         .channel_count = 1,
                         .row = channel_row,
                         .parameters = &p,
                         .parameter_size = sizeof p};
    out->ref = *ref;
    return texture_baker_bake(c->baker, &bake, &out->ref.texture, error);
}

static scalar_lut channel_table(int channel)
{
    scalar_lut t;
    t.channel = channel;
    for (int code = 0; code < 256; code++)
        t.values[code] = (float)code / 255.0f;
    return t;
}

static facet_result build_opacity(conversion *c, const scene_material *m, legacy_material *out,
                                  facet_error *error)
{
    const scene_texture_ref *ref = &m->textures[SCENE_BASE_COLOR_TEXTURE];
    const texture_statistics *s = texture_baker_statistics(c->baker, ref->texture);
    if (!s || m->alpha_mode == SCENE_ALPHA_OPAQUE)
        return FACET_OK;
    if (m->alpha_mode == SCENE_ALPHA_BLEND && !s->has_alpha)
        return FACET_OK;
    scalar_lut t = channel_table(TEXTURE_ALPHA);
    for (int code = 0; code < 256 && m->alpha_mode == SCENE_ALPHA_MASK; code++)
        t.values[code] = m->base_color[3] * t.values[code] >= m->alpha_cutoff ? 1.0f : 0.0f;
    return bake_channel(c, ref, &t, "opacity", &out->maps[LEGACY_OPACITY_MAP], error);
}

static facet_result build_split(conversion *c, const scene_material *m, legacy_material *out,
                                facet_error *error)
{
    const scene_texture_ref *ref = &m->textures[SCENE_METALLIC_ROUGHNESS_TEXTURE];
    if (m->extensions & SCENE_SPECULAR_GLOSSINESS || !is_readable(c, m, SCENE_METALLIC_ROUGHNESS_TEXTURE))
        return FACET_OK;
    scalar_lut green = channel_table(TEXTURE_GREEN);
    scalar_lut blue = channel_table(TEXTURE_BLUE);
    facet_result result = bake_channel(c, ref, &green, "roughness", &out->maps[LEGACY_ROUGHNESS_MAP], error);
    if (result == FACET_OK)
        result = bake_channel(c, ref, &blue, "metallic", &out->maps[LEGACY_METALLIC_MAP], error);
    return result;
}

/* A grid if the target is not linear radiance and texels vary in its axes only. */
static facet_result make_grid(pbr_job *job, ogl1_grid **grid, facet_error *error)
{
    const pbr_surface *f = &job->p.factors;
    bool is_gray =
        f->specular_color[0] == f->specular_color[1] && f->specular_color[1] == f->specular_color[2];
    bool has_specular_texels =
        job->inputs[PBR_SPECULAR] != SCENE_NONE || job->inputs[PBR_SPECULAR_COLOR] != SCENE_NONE;
    job->p.target = (int)job->c->target;
    if (job->c->target == FACET_LEGACY_TARGET_LINEAR || has_specular_texels ||
        (!job->p.is_glossy && !is_gray))
        return FACET_OK;
    return ogl1_grid_make(&job->c->scene->allocator, job->c->scene->thread_count, f, job->p.shininess,
                          job->p.is_glossy, job->c->target, grid, error);
}

facet_result ogl1_build_maps(conversion *c, uint32_t material, const scene_material *m,
                             const solve_item *item, legacy_material *out, facet_error *error)
{
    facet_result result = build_opacity(c, m, out, error);
    if (result != FACET_OK)
        return result;
    if (m->extensions & SCENE_UNLIT) {
        out->maps[LEGACY_DIFFUSE_MAP].ref = m->textures[SCENE_BASE_COLOR_TEXTURE];
        return FACET_OK;
    }
    if (is_readable(c, m, SCENE_OCCLUSION_TEXTURE) && !c->desc.bakes_occlusion)
        note_add(
            &c->notes, material, NOTE_MAP_DROPPED,
            "the occlusion texture has no counterpart in OpenGL 1; it can be baked into the diffuse one");
    if (!ogl1_needs_texels(c, m)) {
        reuse_base(c, m, item, out);
        return FACET_OK;
    }
    pbr_job job = {.c = c, .material = material, .m = m, .out = out, .ref = {.texture = SCENE_NONE}};
    memset(&job.p, 0, sizeof job.p);
    for (int i = 0; i < PBR_INPUTS; i++)
        job.inputs[i] = SCENE_NONE;
    legacy_surface_of_pbr(m, &job.p.factors);
    job.p.shininess = item->ogl1.shininess;
    job.p.srgb = texture_baker_srgb(c->baker);
    take_inputs(&job);
    note_spread(&job, item->ogl1.shininess);
    ogl1_grid *grid = NULL;
    result = make_grid(&job, &grid, error);
    job.p.grid = grid;
    if (result == FACET_OK)
        result = bake_color(&job, false, error);
    /* The base color affects the highlight of metals only. */
    bool is_varying = m->metallic > 0.0f && !job.p.is_glossy && job.inputs[PBR_BASE] != SCENE_NONE;
    for (int i = PBR_METALLIC_ROUGHNESS; i < PBR_INPUTS; i++)
        is_varying |= job.inputs[i] != SCENE_NONE;
    if (result == FACET_OK && is_varying && !is_black(item->ogl1.specular))
        result = bake_color(&job, true, error);
    ogl1_grid_destroy(grid);
    return result == FACET_OK ? build_split(c, m, out, error) : result;
}
