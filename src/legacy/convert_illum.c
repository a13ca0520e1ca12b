/* convert_illum.c - interprets the illumination model of a legacy material: what illum switches off, highlights
 * as wide as the surface, glass and mirrors of ray tracers. docs/legacy.md, "From OpenGL 1 to glTF". */
#include "legacy/convert_state.h"
#include "legacy/specular_glossiness.h"

#include <math.h>
#include <string.h>

static bool reflects_environment(int illum)
{
    return illum == 3 || illum == 5 || illum == 7 || illum == 8;
}

/* ---- light and highlights: illum 0 to 2 ---- */

static bool is_known_good(facet_mtl_dialect dialect)
{
    return dialect == FACET_MTL_DIALECT_BLENDER27 || dialect == FACET_MTL_DIALECT_BLENDER28 ||
           dialect == FACET_MTL_DIALECT_BLENDER3;
}

/* Exporters write illum 0 and 1 for shiny materials too, so these are honored only if nothing contradicts
 * them. */
static void read_lighting(conversion *c, uint32_t material, legacy_reading *r)
{
    legacy_material *m = &r->m;
    bool has_highlight = !is_black(r->surface.specular);
    if (m->illum == 10)
        note_add(&c->notes, material, NOTE_ILLUM_IGNORED,
                 "illum 10, which only catches shadows, has no counterpart in glTF");
    if (m->illum != 0 && m->illum != 1)
        return;
    bool is_honoured = c->desc.illum == FACET_MTL_ILLUM_HONOR ||
                       (c->desc.illum == FACET_MTL_ILLUM_AUTO &&
                        (!has_highlight || is_known_good(c->scene->legacy->dialect)));
    if (!is_honoured) {
        if (has_highlight || m->illum == 0)
            note_add(&c->notes, material, NOTE_ILLUM_IGNORED, "illum %d would %s, but %s: it is ignored",
                     m->illum, m->illum == 0 ? "switch light off" : "switch the highlight off",
                     has_highlight ? "Ks is not black" : "the setting of illum is to ignore it");
        return;
    }
    if (m->illum == 0) {
        m->is_lit = false;
        note_add(&c->notes, material, NOTE_ILLUM_HONOURED, "illum 0: the color is shown without light");
    } else if (has_highlight) {
        memset(r->surface.specular, 0, sizeof r->surface.specular);
        legacy_remove_map(&m->maps[LEGACY_SPECULAR_MAP]);
        legacy_remove_map(&m->maps[LEGACY_SHININESS_MAP]);
        note_add(&c->notes, material, NOTE_ILLUM_HONOURED, "illum 1: Ks and Ns do not count");
    }
}

/* ---- highlights as wide as the surface ---- */

/* At an exponent of 0 the highlight adds Ks to the whole surface. The format says so, also for a missing
 * Ns, but no author has seen it: exporters without highlights write 0, those with a range of [0, 1] write
 * fractions, and present readers take both as matte. With a mirror, Ks is its reflectance. rgl's
 * parameters were displayed as they are. */
#define MIN_EXPONENT 1.0f

static void read_widest_highlight(conversion *c, uint32_t material, legacy_reading *r)
{
    legacy_material *m = &r->m;
    bool is_mirror = c->desc.has_mirrors && reflects_environment(m->illum);
    if (r->kind != READING_OGL1 || c->scene->legacy->is_rgl || c->desc.dialect == FACET_MTL_DIALECT_SPEC ||
        is_mirror || m->shininess > MIN_EXPONENT || is_black(r->surface.specular))
        return;
    if (legacy_has(m, LEGACY_SHININESS))
        note_add(
            &c->notes, material, NOTE_HIGHLIGHT_IGNORED,
            "Ns %g spreads the highlight over the whole surface; it is left out (--dialect spec keeps it)",
            (double)m->shininess);
    else
        note_add(
            &c->notes, material, NOTE_HIGHLIGHT_IGNORED,
            "Ks without Ns is a highlight over the whole surface; it is left out (--dialect spec keeps it)");
    memset(r->surface.specular, 0, sizeof r->surface.specular);
    r->surface.shininess = 0.0f; /* rough in viewers without the extensions, too */
    legacy_remove_map(&m->maps[LEGACY_SPECULAR_MAP]);
    legacy_remove_map(&m->maps[LEGACY_SHININESS_MAP]);
}

/* ---- glass ---- */

/* illum 4 and 9: glass without refraction; 6 and 7: with refraction, tinted by Tf. */
static void read_glass(conversion *c, legacy_reading *r, facet_legacy_colors colors)
{
    const legacy_material *m = &r->m;
    bool is_glass = m->illum == 4 || m->illum == 6 || m->illum == 7 || m->illum == 9;
    float filter[3];
    legacy_color_to_linear(m->transmission_filter, colors, filter);
    bool has_filter = legacy_has(m, LEGACY_TRANSMISSION_FILTER) && !is_black(filter);
    if (!c->desc.has_glass || r->kind == READING_UNLIT || (!is_glass && r->opacity >= 1.0f))
        return;
    float transmission = 1.0f - r->opacity;
    r->is_refracting = m->illum == 6 || m->illum == 7;
    if (transmission == 0.0f && r->is_refracting && has_filter)
        transmission = unit_of(highest_of(filter));
    if (transmission == 0.0f)
        return;
    /* Transmission is tinted with the base color, which is that of the diffuse part too: they are mixed. */
    float most = highest_of(filter);
    for (int k = 0; k < 3; k++) {
        float tint = has_filter ? filter[k] / most : 1.0f;
        r->surface.diffuse[k] += transmission * (tint - r->surface.diffuse[k]);
    }
    r->transmission = transmission;
    r->opacity = 1.0f;
    r->ior = legacy_has(m, LEGACY_IOR) && m->ior > 1.0f && m->ior <= 10.0f ? m->ior : 1.5f;
    if (r->kind == READING_OGL1) {
        r->kind = READING_METALLIC;
        r->metallic = 0.0f;
        r->perceptual_roughness = perceptual_roughness_from_shininess(r->surface.shininess);
        if (is_black(r->surface.specular))
            r->perceptual_roughness = 0.0f; /* no roughness is stated: clear */
        r->has_roughness_from_shininess = true;
    }
}

/* ---- mirrors ---- */

/* A diffuse color (linear) that is invisible beside a mirror: the mirror is then a metal, also in viewers
 * without extensions. */
#define MIRROR_BLACK 0.02f

static void note_mirror(conversion *c, uint32_t material, const legacy_material *m)
{
    bool is_bright = legacy_has(m, LEGACY_SPECULAR) ? highest_of(m->specular) > 0.5f : true;
    /* illum 7 is primarily glass, whose mirror is dim. */
    note_add(
        &c->notes, material, is_bright && m->illum != 7 ? NOTE_MIRROR_IGNORED : NOTE_MIRROR_IGNORED_QUIETLY,
        "illum %d makes Ks a mirror of the environment; mirrors are not enabled, and only the highlight is "
        "converted",
        m->illum);
}

/* Ray tracers reflect the environment sharply whatever Ns, which belongs to the highlight; for large Ns
 * that is followed. Between 100, the highlight width of brushed metal, and 500 the two are interpolated. */
static float mirror_roughness(const legacy_material *m, float shininess)
{
    if (!legacy_has(m, LEGACY_SHININESS) || m->shininess <= MIN_EXPONENT)
        return 0.0f;
    return perceptual_roughness_from_shininess(shininess) * unit_of((500.0f - shininess) / 400.0f);
}

/* A metal of that color, whose maps become those of the base color. */
static void read_metal_mirror(legacy_reading *r)
{
    r->kind = READING_METALLIC;
    r->metallic = 1.0f;
    memcpy(r->surface.diffuse, r->surface.specular, sizeof r->surface.diffuse);
    r->m.maps[LEGACY_DIFFUSE_MAP] = r->m.maps[LEGACY_SPECULAR_MAP];
    r->has_diffuse_alpha = false;
}

/* Without extensions: a base color and a metallic whose mix approximates both colors; maps are replaced by
 * their means. */
static void read_core_mirror(conversion *c, uint32_t material, legacy_reading *r)
{
    ogl1_surface mean = build_representative(c, r);
    float base[3];
    r->kind = READING_METALLIC;
    core_from_glossiness(mean.diffuse, mean.specular, base, &r->metallic);
    for (int k = 0; k < 3; k++)
        r->surface.diffuse[k] =
            mean.diffuse[k] > 0.0f ? r->surface.diffuse[k] * base[k] / mean.diffuse[k] : base[k];
    if (legacy_has_map(&r->m, LEGACY_SPECULAR_MAP))
        note_add(&c->notes, material, NOTE_TEXTURE_AVERAGED,
                 "without extensions a mirror reflects the same everywhere; the mean of map_Ks is used");
}

/* Ks is a reflectance: the remainder is for Kd. glTF weights the base color with 1 - max(F0). */
static void read_mirror(conversion *c, uint32_t material, legacy_reading *r)
{
    legacy_material *m = &r->m;
    if (r->kind != READING_OGL1 || !reflects_environment(m->illum) || is_black(r->surface.specular))
        return;
    if (!c->desc.has_mirrors) {
        note_mirror(c, material, m);
        return;
    }
    for (int k = 0; k < 3; k++)
        r->surface.specular[k] = unit_of(r->surface.specular[k]);
    if (legacy_has_map(m, LEGACY_SHININESS_MAP))
        note_add(&c->notes, material, NOTE_MAP_DROPPED, "map_Ns does not count where illum %d is a mirror",
                 m->illum);
    legacy_remove_map(&m->maps[LEGACY_SHININESS_MAP]);
    r->has_roughness_from_shininess = true;
    r->perceptual_roughness = mirror_roughness(m, r->surface.shininess);
    r->glossiness = 1.0f - r->perceptual_roughness;
    bool has_map = legacy_has_map(m, LEGACY_DIFFUSE_MAP);
    if (!has_map && highest_of(r->surface.diffuse) <= MIRROR_BLACK) {
        read_metal_mirror(r);
        return;
    }
    float most = highest_of(r->surface.specular);
    float brightest = highest_of(r->surface.diffuse);
    float rest = fmaxf(1.0f - most, 0.05f); /* a base below a perfect mirror is invisible */
    if (brightest + most > 1.0f && !has_map) {
        rest = fmaxf(rest, brightest);
        note_add(
            &c->notes, material, NOTE_ENERGY_GAIN,
            "diffuse and specular color add up to more than 1, which no mirror returns; the diffuse color "
            "gives way");
    }
    for (int k = 0; k < 3; k++)
        r->surface.diffuse[k] /= rest;
    /* With Fresnel (illum 5 and 7) reflectance at grazing angles is 1; without, it is constant. */
    r->F90 = m->illum == 5 || m->illum == 7 ? 1.0f : most;
    r->kind = READING_GLOSSY;
    if (c->desc.profile == FACET_LEGACY_PROFILE_CORE)
        read_core_mirror(c, material, r);
}

void legacy_read_illum(conversion *c, uint32_t material, legacy_reading *r)
{
    read_lighting(c, material, r);
    if (!r->m.is_lit)
        r->kind = READING_UNLIT;
    read_widest_highlight(c, material, r);
    read_glass(c, r, c->scene->legacy->colors);
    read_mirror(c, material, r);
}
