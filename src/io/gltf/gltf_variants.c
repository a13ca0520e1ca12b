/* gltf_variants.c - KHR_materials_variants: the names, and which material a primitive has in each. */
#include <string.h>

#include "io/gltf/gltf_reader.h"

static const char NAME[] = "KHR_materials_variants";

void read_variants(reader *r, const json_place *root)
{
    json_place extension = get_extension(r, root, NAME);
    json_place array = get_array(r, &extension, "variants");
    size_t count = get_count(&array);
    if (extension.value && !array.value)
        reader_note(r, &extension, "variants", "is missing");
    r->scene->variants = reader_alloc(r, "variants", count, sizeof *r->scene->variants);
    for (size_t i = 0; i < count && reader_is_ok(r); i++) {
        json_place at = get_element_object(r, &array, i);
        if (!has_member(&at, "name"))
            reader_note(r, &at, "name", "is missing");
        r->scene->variants[i] = get_name(r, &at);
        r->scene->variant_count = (uint32_t)(i + 1);
    }
}

/* One material for some of the variants. */
static void read_mapping(reader *r, const json_place *at, uint32_t *materials)
{
    uint32_t material = get_required_index(r, at, "material", r->scene->material_count, "material");
    if (reader_is_ok(r) && material != SCENE_NONE && r->material_problems[material].message)
        reader_fail_deferred(r, &r->material_problems[material]);
    json_place array = get_array(r, at, "variants");
    if (reader_is_ok(r) && !array.value)
        reader_note(r, at, "variants", "is missing");
    for (size_t i = 0; i < get_count(&array) && reader_is_ok(r); i++) {
        json_place element = get_element(&array, i);
        uint32_t variant = get_index_value(r, &element, r->scene->variant_count, "variant");
        if (variant == SCENE_NONE)
            return;
        if (materials[variant] != SCENE_NONE)
            reader_note(r, &element, NULL, "variant %u has a material already, which is kept", variant);
        else
            materials[variant] = material;
    }
}

const uint32_t *read_mappings(reader *r, const json_place *primitive)
{
    json_place extension = get_extension(r, primitive, NAME);
    json_place array = get_array(r, &extension, "mappings");
    uint32_t variant_count = r->scene->variant_count;
    if (extension.value && !array.value)
        reader_note(r, &extension, "mappings", "is missing");
    if (get_count(&array) == 0 || !reader_spend(r, &extension, variant_count))
        return NULL;
    uint32_t *materials = reader_alloc_raw(r, "variants", variant_count, sizeof *materials);
    if (!materials)
        return NULL;
    memset(materials, 0xff, variant_count * sizeof *materials);
    for (size_t i = 0; i < get_count(&array) && reader_is_ok(r); i++) {
        json_place at = get_element_object(r, &array, i);
        read_mapping(r, &at, materials);
        reader_leave_out(r, "the primitive keeps its material in that variant");
    }
    return materials;
}
