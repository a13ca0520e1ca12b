/* convert_from_ogl1.c - glTF materials for all legacy ones of a scene: interpreted one by one, solved
 * together, built one by one. */
#include <math.h>
#include <string.h>

#include "base/result.h"
#include "legacy/convert_state.h"

static facet_result survey(conversion *c, facet_error *error)
{
    const facet_scene *scene = c->scene;
    bool *is_wanted = mem_zalloc(&scene->allocator, (size_t)scene->texture_count + 1, sizeof *is_wanted);
    if (!is_wanted)
        return fail_memory(error, "textures", scene->texture_count);
    for (uint32_t i = 0; i < scene->material_count; i++)
        for (int slot = 0; slot < LEGACY_MAP_COUNT; slot++) {
            uint32_t texture = scene->legacy->materials[i].maps[slot].ref.texture;
            bool is_read =
                slot != LEGACY_DISPLACEMENT_MAP && slot != LEGACY_DECAL_MAP && slot != LEGACY_REFLECTION_MAP;
            if (is_read && texture < scene->texture_count && !scene->legacy->materials[i].is_gltf_restored)
                is_wanted[texture] = true;
        }
    facet_result result = texture_baker_survey(c->baker, is_wanted, c->log, error);
    mem_free(is_wanted);
    return result;
}

static void prepare_item(const conversion *c, const legacy_reading *r, solve_item *item)
{
    memset(&item->input, 0, sizeof item->input);
    item->is_wanted = r->kind == READING_OGL1;
    if (!item->is_wanted)
        return;
    item->input.ogl1 = build_representative(c, r);
    item->input.is_closed =
        legacy_has_map(&r->m, LEGACY_SPECULAR_MAP) || legacy_has_map(&r->m, LEGACY_SHININESS_MAP) ? 1.0f
                                                                                                  : 0.0f;
}

static const char *profile_of(uint32_t extensions)
{
    return extensions & SCENE_UNLIT                    ? "unlit"
           : extensions & SCENE_TRANSMISSION           ? "transmission"
           : extensions & (SCENE_SPECULAR | SCENE_IOR) ? "specular+ior"
                                                       : "core";
}

static void report(const conversion *c, uint32_t material, const legacy_reading *r, const solve_item *item)
{
    material_conversion *out = &c->out->materials[material];
    out->legacy = c->scene->legacy->materials[material];
    out->pbr = c->materials[material];
    out->summary.name = out->pbr.name;
    out->summary.source = c->scene->legacy->is_rgl ? "ogl1" : "mtl";
    out->summary.profile = profile_of(out->pbr.extensions);
    if (item->is_wanted) {
        summary_solved(c, &out->summary, item);
        out->has_surfaces = true;
        out->ogl1_surface = item->input.ogl1;
        out->pbr_surface = item->pbr;
        out->summary.method =
            solve_is_closed(c, FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS, item) ? "closed" : "fit";
    } else if (r->has_roughness_from_shininess) {
        /* Glass has no counterpart in OpenGL 1 to compare with. */
        summary_exact(&out->summary, "closed");
        out->summary.grade = FACET_CONVERSION_GRADE_FAIR;
    } else {
        summary_exact(&out->summary, r->kind == READING_KEPT ? "source" : "exact");
    }
}

/* No screen shows an emission above 1: it is a radiance, chosen for path tracing. Files with one, such as the Cornell
 * box, mostly state reflectances, which are linear. */
static void note_radiance(conversion *c)
{
    const struct scene_legacy *legacy = c->scene->legacy;
    if (c->desc.colors != FACET_LEGACY_COLORS_DEFAULT || legacy->colors != FACET_LEGACY_COLORS_SRGB ||
        legacy->is_rgl)
        return;
    for (uint32_t i = 0; i < c->scene->material_count; i++) {
        const float *Ke = legacy->materials[i].emission;
        float most = fmaxf(Ke[0], fmaxf(Ke[1], Ke[2]));
        if (!(most > 1.0f))
            continue;
        note_add(
            &c->notes, i, NOTE_COLORS_MAY_BE_LINEAR,
            "Ke of %g is a light for path tracing; files with such lights, as the Cornell box, mostly state "
            "linear colors, which --mtl-colors linear reads",
            (double)most);
    }
}

static void note_file(conversion *c)
{
    const struct scene_legacy *legacy = c->scene->legacy;
    static const char *const dialects[] = {"",
                                           "",
                                           "Blender 2.7 and before",
                                           "Blender 2.8 and 2.9",
                                           "Blender 3 and later",
                                           "obj2gltf --metallicRoughness",
                                           "obj2gltf --specularGlossiness"};
    if (c->desc.colors == FACET_LEGACY_COLORS_DEFAULT)
        note_add(&c->notes, SCENE_NONE, NOTE_COLOR_SPACE_ASSUMED,
                 "the format does not say what its colors are; they are taken as %s",
                 legacy->colors == FACET_LEGACY_COLORS_LINEAR ? "linear light" : "sRGB");
    if (legacy->is_dialect_guessed && legacy->dialect > FACET_MTL_DIALECT_SPEC)
        note_add(&c->notes, SCENE_NONE, NOTE_DIALECT_GUESSED,
                 "by its first comment the file is one of %s, and is understood as such",
                 dialects[legacy->dialect]);
    if (legacy->fog.mode != LEGACY_FOG_NONE)
        note_add(&c->notes, SCENE_NONE, NOTE_FOG_DROPPED, "glTF has no fog; it is kept in extras");
}

static facet_result build_all(conversion *c, legacy_reading *readings, solve_item *items, facet_error *error)
{
    facet_scene *scene = c->scene;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        legacy_read(c, i, &readings[i]);
        prepare_item(c, &readings[i], &items[i]);
    }
    facet_result result =
        solve_all(c, FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS, items, scene->material_count, error);
    for (uint32_t i = 0; i < scene->material_count && result == FACET_OK; i++) {
        if (items[i].is_wanted)
            solve_note(c, i, &items[i]);
        if (readings[i].kind == READING_KEPT)
            c->materials[i] = scene->materials[i];
        else
            result = build_material(c, i, &readings[i], &items[i], &c->materials[i], error);
        report(c, i, &readings[i], &items[i]);
    }
    return result;
}

/* Marks materials of primitives with vertex colors. */
static void find_vertex_colors(const facet_scene *scene, bool *out)
{
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t j = 0; j < scene->meshes[i].primitive_count; j++) {
            const scene_primitive *p = &scene->meshes[i].primitives[j];
            if (p->colors && p->material < scene->material_count)
                out[p->material] = true;
        }
}

/* Whether everything drawn has opacity 0. In rgl's parameters that is intended: a scene may consist of hidden
 * parts. */
static bool hides_everything(const facet_scene *scene)
{
    bool has_primitive = false;
    for (uint32_t i = 0; i < scene->mesh_count && !scene->legacy->is_rgl; i++)
        for (uint32_t j = 0; j < scene->meshes[i].primitive_count; j++) {
            uint32_t material = scene->meshes[i].primitives[j].material;
            if (material >= scene->material_count || scene->legacy->materials[material].opacity > 0.0f)
                return false;
            has_primitive = true;
        }
    return has_primitive;
}

facet_result convert_from_ogl1(conversion *c, facet_error *error)
{
    facet_scene *scene = c->scene;
    size_t count = (size_t)scene->material_count + 1;
    if (c->desc.colors != FACET_LEGACY_COLORS_DEFAULT)
        scene->legacy->colors = c->desc.colors;
    if (c->desc.dialect != FACET_MTL_DIALECT_AUTO) {
        scene->legacy->dialect = c->desc.dialect;
        scene->legacy->is_dialect_guessed = false;
    }
    legacy_reading *readings = mem_zalloc(&scene->allocator, count, sizeof *readings);
    solve_item *items = mem_zalloc(&scene->allocator, count, sizeof *items);
    c->materials = arena_alloc(scene->arena, count, sizeof *c->materials);
    bool *has_vertex_colors = mem_zalloc(&scene->allocator, count, sizeof *has_vertex_colors);
    if (has_vertex_colors)
        find_vertex_colors(scene, has_vertex_colors);
    c->has_vertex_colors = has_vertex_colors;
    c->hides_everything = hides_everything(scene);
    facet_result result = readings && items && c->materials && has_vertex_colors
                              ? survey(c, error)
                              : fail_memory(error, "materials", count * sizeof *readings);
    if (result == FACET_OK)
        result = build_all(c, readings, items, error);
    if (result == FACET_OK) {
        note_radiance(c);
        note_file(c);
        result = lights_from_legacy(c, error);
    }
    c->has_vertex_colors = NULL;
    mem_free(has_vertex_colors);
    mem_free(readings);
    mem_free(items);
    return result;
}
