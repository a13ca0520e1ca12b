/* report_json.c - the report of a conversion as JSON; docs/legacy.md, "The report".
 *
 * {"to": "metallic-roughness" | "specular-glossiness" | "ogl1", "light_scale": 3.14..,
 *  "materials": [ worst first: by the graded error, those without an error last, then in the order of the scene
 *    {"material": name, "index": of the scene, "source", "method", "profile": as in facet_conversion,
 *     "in": the values of the source, "out": those of the result (see below),
 *     "error": {"E", "E_disp", "E_drawn", "naive_E", "core_E": number or null, "views": [0, 30, 60 degrees]},
 *     "graded": "E_disp" | "E_drawn", "grade": "good" | "fair" | "poor" | "bad" | null if nothing was compared,
 *     "grade_drawn": that of E_drawn, whichever is graded,
 *     "light_scale": as above, "warnings": [{"code", "text"}]}],
 *  "warnings": of the scene, the same,
 *  "summary": {"materials": count, "grades": {"good", "fair", "poor", "bad", "none"}, "mean_E": null or number,
 *    "worst": {"material", "index", "E", "E_disp", "E_drawn"} or null}}
 *
 * Values of OpenGL 1: Kd Ks Ke as in the file, Ns, d, illum, and the maps by their statements; "colors"
 * and "dialect" if they are the source. Of glTF: baseColor metallic roughness, ior specularFactor
 * specularColor with those extensions, emissive, alphaMode, extensions, and the textures by their slots.
 * Of specular-glossiness: diffuse specular glossiness. Members with default values are omitted. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "legacy/convert.h"
#include "legacy/convert_surface.h"
#include "scene/legacy_extras.h"
#include "scene/material_table.h"

static const char *const GRADES[] = {"good", "fair", "poor", "bad"};
enum { GRADE_COUNT = 4 };

static void add_double(text *t, const char *key, double value)
{
    text_json_float(t, key, (float)value); /* NAN becomes null */
}

/* ---- values ---- */

static void add_legacy(const scene_legacy *legacy, const legacy_material *m, bool is_source, text *t)
{
    text_json_floats(t, "Kd", m->diffuse, 3);
    text_json_floats(t, "Ks", m->specular, 3);
    text_json_float(t, "Ns", m->shininess);
    if (legacy_has(m, LEGACY_AMBIENT) && !is_black(m->ambient))
        text_json_floats(t, "Ka", m->ambient, 3);
    if (!is_black(m->emission))
        text_json_floats(t, "Ke", m->emission, 3);
    text_json_float(t, "d", m->opacity);
    if (m->illum >= 0)
        text_json_integer(t, "illum", m->illum);
    if (!m->is_lit)
        text_json_bool(t, "lit", false);
    for (int slot = 0; slot < LEGACY_MAP_COUNT; slot++)
        if (m->maps[slot].path)
            text_json_string(t, legacy_map_keys[slot], m->maps[slot].path);
        else if (m->maps[slot].ref.texture != SCENE_NONE)
            text_json_integer(t, legacy_map_keys[slot], m->maps[slot].ref.texture);
    if (is_source && legacy)
        text_json_string(t, "dialect", legacy_dialect_names[legacy->dialect]);
    if (legacy)
        text_json_string(t, "colors", legacy_color_names[legacy->colors]);
}

static void add_textures(const scene_material *m, text *t)
{
    text_json_begin_object(t, "textures");
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
        if (m->textures[slot].texture != SCENE_NONE)
            text_json_integer(t,
                              slot == SCENE_BASE_COLOR_TEXTURE && m->extensions & SCENE_SPECULAR_GLOSSINESS
                                  ? "diffuseTexture"
                                  : material_textures[slot].key,
                              m->textures[slot].texture);
    text_json_end_object(t);
}

static void add_pbr(const scene_material *m, text *t)
{
    static const char *const alpha_modes[] = {"OPAQUE", "MASK", "BLEND"};
    if (m->extensions & SCENE_SPECULAR_GLOSSINESS) {
        text_json_floats(t, "diffuse", m->base_color, 4);
        text_json_floats(t, "specular", m->specular_color, 3);
        text_json_float(t, "glossiness", m->glossiness);
    } else {
        text_json_floats(t, "baseColor", m->base_color, 4);
        text_json_float(t, "metallic", m->metallic);
        text_json_float(t, "roughness", m->perceptual_roughness);
        if (m->extensions & SCENE_SPECULAR) {
            text_json_float(t, "specularFactor", m->specular);
            text_json_floats(t, "specularColor", m->specular_color, 3);
        }
        if (m->extensions & SCENE_IOR)
            text_json_float(t, "ior", m->ior);
    }
    if (!is_black(m->emissive)) {
        text_json_floats(t, "emissive", m->emissive, 3);
        text_json_float(t, "emissiveStrength", m->emissive_strength);
    }
    text_json_string(t, "alphaMode", alpha_modes[m->alpha_mode]);
    text_json_begin_array(t, "extensions");
    for (int i = 0; i < MATERIAL_EXTENSION_COUNT; i++)
        if (m->extensions & material_extensions[i].bit)
            text_json_string(t, NULL, material_extensions[i].name);
    text_json_end_array(t);
    add_textures(m, t);
}

/* ---- materials ---- */

static void add_warnings(const conversion_warning *warnings, uint32_t count, text *t)
{
    text_json_begin_array(t, "warnings");
    for (uint32_t i = 0; i < count; i++) {
        text_json_begin_object(t, NULL);
        text_json_string(t, "code", warnings[i].code);
        text_json_string(t, "text", warnings[i].text);
        text_json_end_object(t);
    }
    text_json_end_array(t);
}

static bool has_error(const facet_conversion *s)
{
    return s->error_graded == s->error_graded;
}

static void add_error(const facet_conversion *s, text *t)
{
    text_json_begin_object(t, "error");
    add_double(t, "E", s->error);
    add_double(t, "E_disp", s->error_display);
    add_double(t, "E_drawn", s->error_drawn);
    add_double(t, "naive_E", s->error_naive);
    add_double(t, "core_E", s->error_core);
    text_json_begin_array(t, "views");
    for (int i = 0; i < 3; i++)
        add_double(t, NULL, s->error_views[i]);
    text_json_end_array(t);
    text_json_end_object(t);
}

/* The source material; the report keeps one of each model. */
static void add_values(const facet_scene *scene, const material_conversion *m, text *t)
{
    const scene_conversion *c = scene->conversion;
    bool is_from_legacy = strcmp(m->summary.source, "mtl") == 0 || strcmp(m->summary.source, "ogl1") == 0;
    bool is_to_legacy = c->to == FACET_MATERIAL_MODEL_OGL1;
    text_json_begin_object(t, "in");
    if (is_from_legacy)
        add_legacy(scene->legacy, &m->legacy, true, t);
    else if (m->source || is_to_legacy)
        add_pbr(m->source ? m->source : &m->pbr, t);
    text_json_end_object(t);
    text_json_begin_object(t, "out");
    if (is_to_legacy)
        add_legacy(scene->legacy, &m->legacy, false, t);
    else
        add_pbr(&m->pbr, t);
    text_json_end_object(t);
}

static void add_material(const facet_scene *scene, uint32_t index, text *t)
{
    const material_conversion *m = &scene->conversion->materials[index];
    text_json_begin_object(t, NULL);
    text_json_string(t, "material", m->summary.name);
    text_json_integer(t, "index", index);
    text_json_string(t, "source", m->summary.source);
    text_json_string(t, "method", m->summary.method);
    text_json_string(t, "profile", m->summary.profile);
    add_values(scene, m, t);
    add_error(&m->summary, t);
    bool has_drawn = has_error(&m->summary) && m->summary.error_drawn == m->summary.error_drawn;
    text_json_string(t, "graded", m->summary.is_graded_as_drawn ? "E_drawn" : "E_disp");
    text_json_string(t, "grade", has_error(&m->summary) ? GRADES[m->summary.grade] : NULL);
    text_json_string(t, "grade_drawn", has_drawn ? GRADES[m->summary.grade_drawn] : NULL);
    add_double(t, "light_scale", scene->conversion->light_scale);
    add_warnings(m->warnings, m->warning_count, t);
    text_json_end_object(t);
}

/* ---- all ---- */

typedef struct ranked {
    double error; /* negative: none */
    uint32_t index;
} ranked;

static int by_error(const void *a, const void *b)
{
    const ranked *x = a;
    const ranked *y = b;
    if (x->error != y->error)
        return x->error < y->error ? 1 : -1;
    return (x->index > y->index) - (x->index < y->index);
}

static void add_summary(const scene_conversion *c, const ranked *order, text *t)
{
    uint32_t counts[GRADE_COUNT + 1] = {0};
    uint32_t compared = 0;
    double sum = 0;
    for (uint32_t i = 0; i < c->material_count; i++) {
        const facet_conversion *s = &c->materials[i].summary;
        counts[has_error(s) ? (int)s->grade : GRADE_COUNT]++;
        compared += has_error(s);
        sum += has_error(s) ? s->error : 0.0;
    }
    text_json_begin_object(t, "summary");
    text_json_integer(t, "materials", c->material_count);
    text_json_begin_object(t, "grades");
    for (int i = 0; i < GRADE_COUNT; i++)
        text_json_integer(t, GRADES[i], counts[i]);
    text_json_integer(t, "none", counts[GRADE_COUNT]);
    text_json_end_object(t);
    add_double(t, "mean_E", compared ? sum / compared : (double)NAN);
    if (compared) {
        const facet_conversion *worst = &c->materials[order[0].index].summary;
        text_json_begin_object(t, "worst");
        text_json_string(t, "material", worst->name);
        text_json_integer(t, "index", order[0].index);
        add_double(t, "E", worst->error);
        add_double(t, "E_disp", worst->error_display);
        add_double(t, "E_drawn", worst->error_drawn);
        text_json_end_object(t);
    } else {
        text_json_string(t, "worst", NULL);
    }
    text_json_end_object(t);
}

void legacy_report_json(const facet_scene *scene, text *out)
{
    static const char *const models[] = {"metallic-roughness", "specular-glossiness", "ogl1"};
    static const scene_conversion none = {.light_scale = 1.0};
    const scene_conversion *c = scene->conversion ? scene->conversion : &none;
    ranked *order = mem_alloc(&scene->allocator, (size_t)c->material_count + 1, sizeof *order);
    if (!order) {
        out->has_failed = true;
        return;
    }
    for (uint32_t i = 0; i < c->material_count; i++) {
        const facet_conversion *s = &c->materials[i].summary;
        order[i] = (ranked){.error = has_error(s) ? s->error_graded : -1.0, .index = i};
    }
    qsort(order, c->material_count, sizeof *order, by_error);
    text_json_begin_object(out, NULL);
    text_json_string(out, "model", scene->source);
    text_json_string(out, "to", models[c->to]);
    add_double(out, "light_scale", c->light_scale);
    text_json_begin_array(out, "materials");
    for (uint32_t i = 0; i < c->material_count; i++)
        add_material(scene, order[i].index, out);
    text_json_end_array(out);
    add_warnings(c->warnings, c->warning_count, out);
    add_summary(c, order, out);
    text_json_end_object(out);
    mem_free(order);
}
