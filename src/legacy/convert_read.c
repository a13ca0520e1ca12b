/* convert_read.c - interprets a legacy material: its dialect, switches of rgl, mistakes of exporters; its
 * illum by convert_illum.c. docs/legacy.md, "From OpenGL 1 to glTF". Values and textures are converted
 * elsewhere. */
#include "legacy/convert_state.h"
#include "scene/legacy_extras.h"

#include <math.h>
#include <string.h>

/* ---- missing textures, and statements without counterpart ---- */

static bool is_surveyed(legacy_map_slot slot)
{
    return slot != LEGACY_DISPLACEMENT_MAP && slot != LEGACY_DECAL_MAP && slot != LEGACY_REFLECTION_MAP;
}

static void check_maps(conversion *c, uint32_t material, legacy_material *m)
{
    for (int slot = 0; slot < LEGACY_MAP_COUNT; slot++) {
        legacy_map *map = &m->maps[slot];
        const char *statement = legacy_map_keys[slot];
        if (!is_surveyed((legacy_map_slot)slot)) {
            if (map->path || map->ref.texture != SCENE_NONE)
                note_add(&c->notes, material, NOTE_MAP_DROPPED,
                         "%s has no counterpart in glTF; it is kept in extras", statement);
            legacy_remove_map(map);
            continue;
        }
        bool is_stated = map->path || map->ref.texture != SCENE_NONE;
        if (is_stated && !texture_baker_statistics(c->baker, map->ref.texture)) {
            note_add(&c->notes, material, NOTE_TEXTURE_MISSING,
                     "the image of %s, %s, cannot be read; the material is converted without it", statement,
                     map->path ? map->path : "of a texture");
            legacy_remove_map(map);
        }
        if (is_stated && map->dropped)
            note_add(&c->notes, material, NOTE_TEXTURE_OPTION_DROPPED,
                     "the options %s of %s have no counterpart in glTF; they are kept in extras",
                     map->dropped, statement);
    }
}

static void note_losses(conversion *c, uint32_t material, const legacy_material *m)
{
    if (legacy_has(m, LEGACY_SHARPNESS) && m->sharpness != 60.0f)
        note_add(&c->notes, material, NOTE_SHARPNESS_DROPPED,
                 "the sharpness of reflections has no counterpart in glTF; it is kept in extras");
    /* Everything before parameters that the format defines but a lit surface does not need. */
    size_t length = m->kept ? (size_t)(m->kept - m->unknown) : m->unknown ? strlen(m->unknown) : 0;
    if (length > 0) {
        size_t first = strcspn(m->unknown, "\n");
        note_add(&c->notes, material, NOTE_UNKNOWN_KEY, "unknown statements: %.*s%s",
                 (int)(first < 400 ? first : 400), m->unknown, first + 1 < length ? ", .." : "");
    }
    if (m->is_halo)
        note_add(&c->notes, material, NOTE_HALO_DROPPED,
                 "d -halo, which is opaque towards the silhouette, becomes the same opacity everywhere");
}

/* ---- factors that exporters leave black ----
 *
 * A map that cannot be read keeps the factors of diffuse color and opacity white, as missing images are in glTF. It adds no
 * highlights and no emission. */

static const float WHITE[3] = {1, 1, 1};

static void read_diffuse(conversion *c, uint32_t material, legacy_reading *r, facet_legacy_colors colors)
{
    legacy_material *m = &r->m;
    legacy_color_to_linear(m->diffuse, colors, r->surface.diffuse);
    bool yields = c->scene->legacy->is_rgl || !legacy_has(m, LEGACY_DIFFUSE);
    if (yields && c->has_vertex_colors[material]) /* they replace it */
        memcpy(r->surface.diffuse, WHITE, sizeof WHITE);
    bool has_map = legacy_has_map(m, LEGACY_DIFFUSE_MAP);
    if (!has_map && !m->maps[LEGACY_DIFFUSE_MAP].path)
        return;
    if (!legacy_has(m, LEGACY_DIFFUSE)) {
        memcpy(r->surface.diffuse, WHITE, sizeof WHITE);
    } else if (is_black(r->surface.diffuse)) {
        memcpy(r->surface.diffuse, WHITE, sizeof WHITE);
        note_add(&c->notes, material, NOTE_BLACK_KD_WITH_MAP,
                 has_map ? "a black Kd would make its map black; it counts as white"
                         : "a black Kd counts as white, as it does beside a map that can be read");
    }
}

static void read_specular(conversion *c, uint32_t material, legacy_reading *r, facet_legacy_colors colors)
{
    legacy_material *m = &r->m;
    legacy_color_to_linear(m->specular, colors, r->surface.specular);
    if (!legacy_has_map(m, LEGACY_SPECULAR_MAP))
        return;
    if (!legacy_has(m, LEGACY_SPECULAR))
        memcpy(r->surface.specular, WHITE, sizeof WHITE);
    if (!c->scene->legacy->is_rgl)
        note_add(&c->notes, material, NOTE_KS_MAP_USED_AS_SPECULAR,
                 "map_Ks is read as specular color, not as metallic");
}

static void read_emission(conversion *c, uint32_t material, legacy_reading *r, facet_legacy_colors colors)
{
    legacy_material *m = &r->m;
    legacy_color_to_linear(m->emission, colors, r->emission);
    if (!legacy_has_map(m, LEGACY_EMISSION_MAP) || !is_black(r->emission))
        return;
    memcpy(r->emission, WHITE, sizeof WHITE);
    if (legacy_has(m, LEGACY_EMISSION))
        note_add(&c->notes, material, NOTE_BLACK_KE_WITH_MAP,
                 "a black Ke would make its map black; it counts as white");
}

static void read_opacity(conversion *c, uint32_t material, legacy_reading *r)
{
    legacy_material *m = &r->m;
    r->opacity = unit_of(m->opacity);
    if (m->is_transparency_ambiguous)
        note_add(
            &c->notes, material, NOTE_TR_AMBIGUOUS,
            "Tr means transparency to most programs and opacity to some; it is read such that opacity is %g",
            (double)r->opacity);
    bool has_image = legacy_has_map(m, LEGACY_OPACITY_MAP) || legacy_has_map(m, LEGACY_DIFFUSE_MAP) ||
                     m->maps[LEGACY_OPACITY_MAP].path || m->maps[LEGACY_DIFFUSE_MAP].path;
    if (r->opacity == 0.0f && (has_image || c->hides_everything)) {
        r->opacity = 1.0f;
        note_add(&c->notes, material, NOTE_ZERO_ALPHA,
                 has_image
                     ? "an opacity of 0 would hide its texture; it counts as 1, as some exporters meant it"
                     : "an opacity of 0 in all materials would hide the whole model; it counts as 1, as "
                       "some exporters meant it");
    }
}

/* ---- ambient color ---- */

static bool is_same_color(const float a[3], const float b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static void read_ambient(conversion *c, uint32_t material, legacy_reading *r, facet_legacy_colors colors)
{
    legacy_material *m = &r->m;
    bool has_map = legacy_has_map(m, LEGACY_AMBIENT_MAP);
    float ambient[3];
    legacy_color_to_linear(m->ambient, colors, ambient);
    if (has_map && !legacy_has(m, LEGACY_AMBIENT))
        memcpy(ambient, WHITE, sizeof WHITE);
    if (c->desc.ambient == FACET_LEGACY_AMBIENT_OCCLUSION && has_map)
        return;
    if (is_black(ambient)) {
        legacy_remove_map(&m->maps[LEGACY_AMBIENT_MAP]);
        return;
    }
    if (c->desc.ambient == FACET_LEGACY_AMBIENT_EMISSIVE) {
        /* There is one emissive texture: the ambient map gets it if there is no emission map. */
        if (has_map && !legacy_has_map(m, LEGACY_EMISSION_MAP) && is_black(r->emission)) {
            m->maps[LEGACY_EMISSION_MAP] = m->maps[LEGACY_AMBIENT_MAP];
        } else if (has_map || legacy_has_map(m, LEGACY_EMISSION_MAP)) {
            note_add(&c->notes, material, NOTE_AMBIENT_DROPPED,
                     "Ka and Ke have maps of their own, of which glTF's emission holds one: Ka is dropped");
            legacy_remove_map(&m->maps[LEGACY_AMBIENT_MAP]);
            return;
        }
        for (int k = 0; k < 3; k++)
            r->emission[k] += ambient[k];
    } else if (!is_same_color(m->ambient, m->diffuse)) {
        note_add(
            &c->notes, material, NOTE_AMBIENT_DROPPED,
            "the ambient color has no counterpart in glTF, where ambient light is the scene's; it is kept "
            "in extras");
    }
    legacy_remove_map(&m->maps[LEGACY_AMBIENT_MAP]);
}

/* ---- rgl's kinds of textures and their modes (textype, texmode) ---- */

/* The texture of rgl affects highlight and emission too. */
static void lay_over_all(const conversion *c, legacy_reading *r)
{
    legacy_material *m = &r->m;
    if (!c->scene->legacy->is_rgl)
        return;
    if (!is_black(m->specular))
        m->maps[LEGACY_SPECULAR_MAP] = m->maps[LEGACY_DIFFUSE_MAP];
    if (!is_black(m->emission))
        m->maps[LEGACY_EMISSION_MAP] = m->maps[LEGACY_DIFFUSE_MAP];
}

/* Mode add: the texture becomes the emission, unless there is one. */
static void add_texture(conversion *c, uint32_t material, legacy_reading *r)
{
    legacy_material *m = &r->m;
    legacy_map *map = &m->maps[LEGACY_DIFFUSE_MAP];
    if (r->has_diffuse_alpha) {
        m->maps[LEGACY_OPACITY_MAP] = *map;
        m->maps[LEGACY_OPACITY_MAP].channel = 'm';
    }
    if (is_black(r->emission)) {
        m->maps[LEGACY_EMISSION_MAP] = *map;
        memcpy(r->emission, WHITE, sizeof WHITE);
    } else {
        note_add(&c->notes, material, NOTE_TEXTURE_MODE_DROPPED,
                 "a texture that is added, beside an emission, has no counterpart in glTF: it is dropped");
    }
    legacy_remove_map(map);
    r->has_diffuse_alpha = false;
}

static void read_texture_mode(conversion *c, uint32_t material, legacy_reading *r)
{
    legacy_material *m = &r->m;
    legacy_map *map = &m->maps[LEGACY_DIFFUSE_MAP];
    legacy_texture_type type = m->texture_type;
    if (map->ref.texture == SCENE_NONE)
        return;
    if (m->has_environment_map) {
        note_add(&c->notes, material, NOTE_MAP_DROPPED,
                 "a texture as environment map has no counterpart in glTF; it is kept in extras");
        legacy_remove_map(map);
        return;
    }
    if (type == LEGACY_ALPHA) { /* E.rgb, E.a lum in all modes */
        m->maps[LEGACY_OPACITY_MAP] = *map;
        m->maps[LEGACY_OPACITY_MAP].channel = 'l';
        legacy_remove_map(map);
        return;
    }
    if (type == LEGACY_LUMINANCE || type == LEGACY_LUMINANCE_ALPHA)
        map->channel = 'l';
    r->has_diffuse_alpha = type == LEGACY_RGBA || type == LEGACY_LUMINANCE_ALPHA;
    switch (m->texture_mode) {
    case LEGACY_MODULATE:
        lay_over_all(c, r);
        break;
    case LEGACY_DECAL:
        if (r->has_diffuse_alpha)
            note_add(
                &c->notes, material, NOTE_TEXTURE_MODE_DROPPED,
                "the texture mode decal, which mixes by alpha, has no counterpart in glTF: it is drawn as "
                "replace");
        r->has_diffuse_alpha = false;
        /* fall through */
    case LEGACY_REPLACE:
        m->is_lit = false;
        memcpy(r->surface.diffuse, WHITE, sizeof WHITE);
        break;
    case LEGACY_BLEND: /* (1 - T) E */
        map->base = 1.0f - map->base;
        map->gain = -map->gain;
        lay_over_all(c, r);
        break;
    case LEGACY_ADD: /* E + T */
        add_texture(c, material, r);
        break;
    }
}

/* ---- dialects ---- */

static void read_blender_principled(legacy_reading *r, facet_mtl_dialect dialect)
{
    const legacy_material *m = &r->m;
    float shininess = r->surface.shininess;
    r->kind = READING_METALLIC;
    r->perceptual_roughness = dialect == FACET_MTL_DIALECT_BLENDER28
                                  ? unit_of(1.0f - sqrtf(shininess) / 30.0f)
                                  : unit_of(1.0f - sqrtf(shininess / 1000.0f));
    /* Ka is metallic only if illum states a mirror; else it is 1 without meaning. */
    r->metallic = m->illum == 3 || m->illum == 6 || m->illum == 7 ? unit_of(m->ambient[0]) : 0.0f;
    /* Ks is the level of the principled shader: F0 = 0.08 level. */
    r->specular_level = legacy_has(m, LEGACY_SPECULAR) ? 2.0f * unit_of(m->specular[0]) : 1.0f;
}

static void read_dialect(legacy_reading *r, facet_mtl_dialect dialect)
{
    legacy_material *m = &r->m;
    switch (dialect) {
    case FACET_MTL_DIALECT_AUTO:
    case FACET_MTL_DIALECT_SPEC:
        break;
    case FACET_MTL_DIALECT_BLENDER27: /* the exponent is the hardness; Ns is 1.96078 times hardness minus 1 */
        if (legacy_has(m, LEGACY_SHININESS))
            r->surface.shininess = r->surface.shininess / 1.9607843f + 1.0f;
        break;
    case FACET_MTL_DIALECT_BLENDER28:
    case FACET_MTL_DIALECT_BLENDER3:
        read_blender_principled(r, dialect);
        break;
    case FACET_MTL_DIALECT_OBJ2GLTF_MR:
        r->kind = READING_METALLIC;
        r->metallic = unit_of(m->specular[0]);
        r->perceptual_roughness = unit_of(m->shininess);
        r->has_shininess_as_roughness = true;
        break;
    case FACET_MTL_DIALECT_OBJ2GLTF_SG:
        r->kind = READING_GLOSSY;
        r->glossiness = unit_of(m->shininess);
        r->has_shininess_as_roughness = true;
        break;
    }
    if (r->has_shininess_as_roughness && !legacy_has(m, LEGACY_SHININESS) &&
        legacy_has_map(m, LEGACY_SHININESS_MAP))
        r->glossiness = r->perceptual_roughness = 1.0f;
    if (dialect == FACET_MTL_DIALECT_OBJ2GLTF_MR && !legacy_has(m, LEGACY_SHININESS))
        r->perceptual_roughness = 1.0f; /* default of obj2gltf, where Ns is a roughness */
    if (dialect == FACET_MTL_DIALECT_OBJ2GLTF_MR && !legacy_has(m, LEGACY_SPECULAR) &&
        legacy_has_map(m, LEGACY_SPECULAR_MAP))
        r->metallic = 1.0f;
}

/* Pr and Pm override Ns and Ks. */
static void read_pbr_statements(legacy_reading *r)
{
    const legacy_material *m = &r->m;
    bool has_orm = legacy_has_map(m, LEGACY_ORM_MAP);
    bool has_roughness =
        has_orm || legacy_has(m, LEGACY_ROUGHNESS) || legacy_has_map(m, LEGACY_ROUGHNESS_MAP);
    bool has_metallic = has_orm || legacy_has(m, LEGACY_METALLIC) || legacy_has_map(m, LEGACY_METALLIC_MAP);
    if (!has_roughness && !has_metallic)
        return;
    if (r->kind != READING_METALLIC) {
        r->metallic = 0.0f;
        r->perceptual_roughness = perceptual_roughness_from_shininess(r->surface.shininess);
        r->specular_level = 1.0f;
    }
    r->kind = READING_METALLIC;
    r->has_shininess_as_roughness = false;
    /* A map without a factor has factor 1. */
    if (has_roughness)
        r->perceptual_roughness = legacy_has(m, LEGACY_ROUGHNESS) ? unit_of(m->roughness) : 1.0f;
    if (has_metallic)
        r->metallic = legacy_has(m, LEGACY_METALLIC) ? unit_of(m->metallic) : 1.0f;
}

void legacy_read(conversion *c, uint32_t material, legacy_reading *out)
{
    const struct scene_legacy *legacy = c->scene->legacy;
    facet_legacy_colors colors = legacy->colors;
    *out = (legacy_reading){.m = legacy->materials[material], .F90 = 1.0f, .specular_level = 1.0f};
    legacy_material *m = &out->m;
    if (m->is_gltf_restored) {
        out->kind = READING_KEPT;
        return;
    }
    check_maps(c, material, m);
    note_losses(c, material, m);
    read_diffuse(c, material, out, colors);
    read_emission(c, material, out, colors);
    read_texture_mode(c, material, out);
    read_opacity(c, material, out);
    out->surface.shininess = m->shininess > 0.0f && m->shininess < INFINITY ? m->shininess : 0.0f;
    read_dialect(out, legacy->dialect);
    read_pbr_statements(out);
    if (out->kind != READING_METALLIC)
        read_specular(c, material, out, colors);
    /* Ka is metallic in exporters of principled materials. */
    if (legacy->dialect != FACET_MTL_DIALECT_BLENDER28 && legacy->dialect != FACET_MTL_DIALECT_BLENDER3)
        read_ambient(c, material, out, colors);
    else
        legacy_remove_map(&m->maps[LEGACY_AMBIENT_MAP]);
    legacy_read_illum(c, material, out);
}
