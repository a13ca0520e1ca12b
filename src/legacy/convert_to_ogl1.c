/* convert_to_ogl1.c - legacy materials for all glTF ones of a scene. The original of a converted material is
 * restored if it is known; others are fitted. */
#include <math.h>
#include <string.h>

#include "base/result.h"
#include "legacy/convert_state.h"
#include "scene/material_table.h"

/* ---- what is known already ---- */

/* The original values, and not those of an earlier conversion to OpenGL 1. */
static bool is_known(const conversion *c, uint32_t material)
{
    const facet_scene *scene = c->scene;
    const struct scene_conversion *last = scene->conversion;
    if (!scene->legacy || c->desc.ignores_source)
        return false;
    const legacy_material *m = &scene->legacy->materials[material];
    if (legacy_lacks_images(m))
        return false;
    if (scene->legacy->is_source)
        return !m->is_gltf_restored || m->fields != 0;
    if (last && last->to == FACET_MATERIAL_MODEL_OGL1 && material < last->material_count &&
        strcmp(last->materials[material].summary.method, "source") != 0)
        return false;
    return m->fields != 0;
}

static facet_result survey(conversion *c, facet_error *error)
{
    const facet_scene *scene = c->scene;
    bool *is_wanted = mem_zalloc(&scene->allocator, (size_t)scene->texture_count + 1, sizeof *is_wanted);
    if (!is_wanted)
        return fail_memory(error, "textures", scene->texture_count);
    for (uint32_t i = 0; i < scene->material_count; i++) {
        for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++) {
            uint32_t texture = scene->materials[i].textures[slot].texture;
            if (texture < scene->texture_count && ogl1_reads_slot((scene_texture_slot)slot))
                is_wanted[texture] = true;
        }
        for (int slot = 0; slot < LEGACY_MAP_COUNT && is_known(c, i); slot++) {
            uint32_t texture = scene->legacy->materials[i].maps[slot].ref.texture;
            if (texture < scene->texture_count && slot <= LEGACY_OPACITY_MAP)
                is_wanted[texture] = true;
        }
    }
    facet_result result = texture_baker_survey(c->baker, is_wanted, c->log, error);
    mem_free(is_wanted);
    return result;
}

static void prepare_item(conversion *c, uint32_t i, bool *known, solve_item *item)
{
    const scene_material *m = &c->scene->materials[i];
    memset(&item->input, 0, sizeof item->input);
    *known = is_known(c, i);
    item->is_wanted = !*known && !(m->extensions & SCENE_UNLIT);
    if (!item->is_wanted)
        return;
    item->input.pbr = ogl1_representative(c, m);
    item->input.is_closed = ogl1_needs_texels(c, m) ? 1.0f : 0.0f;
}

/* ---- factors ---- */

static void note_losses(conversion *c, uint32_t material, const scene_material *m)
{
    const uint32_t lost = SCENE_TRANSMISSION | SCENE_VOLUME | SCENE_IRIDESCENCE | SCENE_DISPERSION |
                          SCENE_DIFFUSE_TRANSMISSION | SCENE_VOLUME_SCATTER;
    char names[400] = "";
    size_t length = 0;
    for (int i = 0; i < MATERIAL_EXTENSION_COUNT; i++) {
        const material_extension *row = &material_extensions[i];
        size_t size = strlen(row->name);
        if (!(m->extensions & lost & row->bit) || length + size + 3 > sizeof names)
            continue;
        if (length > 0) {
            memcpy(names + length, ", ", 2);
            length += 2;
        }
        memcpy(names + length, row->name, size + 1);
        length += size;
    }
    if (length > 0)
        note_add(&c->notes, material, NOTE_EXTENSION_NOT_WRITTEN, "OpenGL 1 has no counterpart of %s", names);
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++) {
        const scene_texture_ref *ref = &m->textures[slot];
        if (ref->texture != SCENE_NONE && (ref->rotation_rad != 0.0f || ref->texcoord > 0)) {
            note_add(
                &c->notes, material, NOTE_TEXTURE_OPTION_DROPPED,
                "textures that are turned or read a second set of coordinates have no counterpart in MTL");
            break;
        }
    }
}

/* MTL's PBR extension, for programs that support it. */
static void set_pbr_statements(const scene_material *m, legacy_material *out)
{
    if (!(m->extensions & SCENE_SPECULAR_GLOSSINESS)) {
        out->fields |= LEGACY_ROUGHNESS | LEGACY_METALLIC;
        out->roughness = m->perceptual_roughness;
        out->metallic = m->metallic;
    }
    if (m->extensions & SCENE_SHEEN) {
        out->fields |= LEGACY_SHEEN;
        out->sheen = highest_of(m->sheen_color);
    }
    if (m->extensions & SCENE_CLEARCOAT) {
        out->fields |= LEGACY_CLEARCOAT | LEGACY_CLEARCOAT_ROUGHNESS;
        out->clearcoat = m->clearcoat;
        out->clearcoat_roughness = m->clearcoat_roughness;
    }
    if (m->extensions & SCENE_ANISOTROPY) {
        float turns = m->anisotropy_rotation / 6.2831853f;
        out->fields |= LEGACY_ANISOTROPY | LEGACY_ANISOTROPY_ROTATION;
        out->anisotropy = m->anisotropy;
        out->anisotropy_rotation = turns - floorf(turns);
    }
    if (m->extensions & SCENE_IOR && m->ior >= 1.0f) {
        out->fields |= LEGACY_IOR;
        out->ior = m->ior;
    }
    if (scene_material_has(m, SCENE_NORMAL_TEXTURE)) {
        out->maps[LEGACY_NORMAL_MAP].ref = m->textures[SCENE_NORMAL_TEXTURE];
        out->maps[LEGACY_NORMAL_MAP].bump_multiplier = m->normal_scale;
    }
}

static void set_opacity(const scene_material *m, legacy_material *out)
{
    if (m->alpha_mode == SCENE_ALPHA_BLEND)
        out->opacity = unit_of(m->base_color[3]);
    if (m->alpha_mode == SCENE_ALPHA_MASK && !scene_material_has(m, SCENE_BASE_COLOR_TEXTURE))
        out->opacity = m->base_color[3] >= m->alpha_cutoff ? 1.0f : 0.0f;
    /* Fully transmissive glass would be invisible as a blended surface. */
    if (m->extensions & SCENE_TRANSMISSION)
        out->opacity *= 1.0f - 0.9f * unit_of(m->transmission);
}

static void set_factors(const conversion *c, const scene_material *m, const solve_item *item,
                        legacy_material *out)
{
    facet_legacy_colors colors = c->legacy->colors;
    bool is_unlit = (m->extensions & SCENE_UNLIT) != 0;
    float emission[3];
    *out = legacy_material_default();
    out->name = m->name;
    out->fields = LEGACY_AMBIENT | LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_EMISSION | LEGACY_SHININESS |
                  LEGACY_OPACITY | LEGACY_ILLUM;
    out->is_culled = !m->is_double_sided;
    out->is_lit = !is_unlit;
    legacy_color_from_linear(is_unlit ? m->base_color : item->ogl1.diffuse, colors, out->diffuse);
    legacy_color_from_linear(item->ogl1.specular, colors, out->specular);
    out->shininess = item->ogl1.shininess;
    for (int k = 0; k < 3; k++)
        emission[k] = is_unlit ? 0.0f : m->emissive[k] * m->emissive_strength;
    legacy_color_from_linear(emission, colors, out->emission);
    if (!is_black(emission))
        out->maps[LEGACY_EMISSION_MAP].ref = m->textures[SCENE_EMISSIVE_TEXTURE];
    set_opacity(m, out);
    if (!is_unlit)
        set_pbr_statements(m, out);
    out->illum = is_unlit ? 0 : is_black(item->ogl1.specular) ? 1 : 2;
}

/* ---- all of them ---- */

static bool begin_legacy(conversion *c)
{
    facet_scene *scene = c->scene;
    c->legacy = arena_zalloc(scene->arena, 1, sizeof *c->legacy);
    legacy_material *materials =
        arena_alloc(scene->arena, (size_t)scene->material_count + 1, sizeof *materials);
    if (!c->legacy || !materials)
        return false;
    if (scene->legacy)
        *c->legacy = *scene->legacy;
    else
        *c->legacy = (struct scene_legacy){
            .fog = {.scale = 1.0f}, .colors = FACET_LEGACY_COLORS_SRGB, .dialect = FACET_MTL_DIALECT_SPEC};
    bool is_read = scene->legacy && scene->legacy->is_source;
    if (c->desc.colors != FACET_LEGACY_COLORS_DEFAULT && !is_read)
        c->legacy->colors = c->desc.colors;
    c->legacy->materials = materials;
    return true;
}

/* The original values in the requested encoding of colors. */
static void recode(const conversion *c, legacy_material *m)
{
    facet_legacy_colors from = c->scene->legacy->colors;
    float *colors[] = {m->ambient, m->diffuse, m->specular, m->emission};
    if (from == c->legacy->colors)
        return;
    for (size_t i = 0; i < sizeof colors / sizeof *colors; i++) {
        float linear[3];
        legacy_color_to_linear(colors[i], from, linear);
        legacy_color_from_linear(linear, c->legacy->colors, colors[i]);
    }
}

static facet_result make(conversion *c, uint32_t i, bool known, const solve_item *item, facet_error *error)
{
    const scene_material *m = &c->scene->materials[i];
    legacy_material *out = &c->legacy->materials[i];
    facet_result result = FACET_OK;
    if (known) {
        *out = c->scene->legacy->materials[i];
        recode(c, out);
    } else {
        set_factors(c, m, item, out);
        note_losses(c, i, m);
        if (item->is_wanted)
            solve_note(c, i, item);
        result = ogl1_build_maps(c, i, m, item, out, error);
        /* A glTF material in a file of legacy materials stays. */
        out->is_gltf_restored = c->legacy->is_source;
    }
    material_conversion *report = &c->out->materials[i];
    report->legacy = *out;
    report->pbr = *m;
    report->summary.name = m->name;
    report->summary.source =
        m->extensions & SCENE_SPECULAR_GLOSSINESS ? "specular-glossiness" : "metallic-roughness";
    report->summary.profile = "ogl1";
    if (item->is_wanted)
        summary_solved(c, &report->summary, item);
    else
        summary_exact(&report->summary, "exact");
    if (known)
        report->summary.method = "source";
    report->has_surfaces = item->is_wanted;
    report->ogl1_surface = item->ogl1;
    report->pbr_surface = item->input.pbr;
    if (item->is_wanted)
        report->summary.method = solve_is_closed(c, FACET_MATERIAL_MODEL_OGL1, item) ? "closed" : "fit";
    return result;
}

facet_result convert_to_ogl1(conversion *c, facet_error *error)
{
    facet_scene *scene = c->scene;
    size_t count = (size_t)scene->material_count + 1;
    solve_item *items = mem_zalloc(&scene->allocator, count, sizeof *items);
    bool *known = mem_zalloc(&scene->allocator, count, sizeof *known);
    facet_result result = items && known && begin_legacy(c)
                              ? survey(c, error)
                              : fail_memory(error, "materials", count * sizeof *items);
    for (uint32_t i = 0; i < scene->material_count && result == FACET_OK; i++)
        prepare_item(c, i, &known[i], &items[i]);
    if (result == FACET_OK)
        result = solve_all(c, FACET_MATERIAL_MODEL_OGL1, items, scene->material_count, error);
    for (uint32_t i = 0; i < scene->material_count && result == FACET_OK; i++)
        result = make(c, i, known[i], &items[i], error);
    if (result == FACET_OK)
        result = lights_to_legacy(c, error);
    mem_free(items);
    mem_free(known);
    return result;
}
