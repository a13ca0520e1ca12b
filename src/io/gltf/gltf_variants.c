/* gltf_variants.c - KHR_materials_variants: the names, and which material a primitive has in each. */
#include <string.h>

#include "io/gltf/gltf_reader.h"

static const char NAME[] = "KHR_materials_variants";

void gltf_read_variants(io_reader *r, const json_place *root)
{
    json_place extension = io_get_extension(r, root, NAME);
    json_place array = io_get_array(r, &extension, "variants");
    size_t count = io_get_count(&array);
    if (extension.value && !array.value)
        io_note(r, &extension, "variants", "is missing");
    r->scene->variants = io_alloc(r, "variants", count, sizeof *r->scene->variants);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        if (!io_has_member(&at, "name"))
            io_note(r, &at, "name", "is missing");
        r->scene->variants[i] = io_get_name(r, &at);
        r->scene->variant_count = (uint32_t)(i + 1);
    }
}

/* One material for some of the variants. */
static void read_mapping(io_reader *r, const json_place *at, uint32_t *materials)
{
    uint32_t material = io_get_required_index(r, at, "material", r->scene->material_count, "material");
    if (io_is_ok(r) && material != SCENE_NONE && r->gltf->material_problems[material].message)
        io_fail_deferred(r, &r->gltf->material_problems[material]);
    json_place array = io_get_array(r, at, "variants");
    if (io_is_ok(r) && !array.value)
        io_note(r, at, "variants", "is missing");
    for (size_t i = 0; i < io_get_count(&array) && io_is_ok(r); i++) {
        json_place element = io_get_element(&array, i);
        uint32_t variant = io_get_index_value(r, &element, r->scene->variant_count, "variant");
        if (variant == SCENE_NONE)
            return;
        if (materials[variant] != SCENE_NONE)
            io_note(r, &element, NULL, "variant %u has a material already, which is kept", variant);
        else
            materials[variant] = material;
    }
}

const uint32_t *gltf_read_mappings(io_reader *r, const json_place *primitive)
{
    json_place extension = io_get_extension(r, primitive, NAME);
    json_place array = io_get_array(r, &extension, "mappings");
    uint32_t variant_count = r->scene->variant_count;
    if (extension.value && !array.value)
        io_note(r, &extension, "mappings", "is missing");
    if (io_get_count(&array) == 0 || !io_spend(r, &extension, variant_count))
        return NULL;
    uint32_t *materials = io_alloc_raw(r, "variants", variant_count, sizeof *materials);
    if (!materials)
        return NULL;
    memset(materials, 0xff, variant_count * sizeof *materials);
    for (size_t i = 0; i < io_get_count(&array) && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        read_mapping(r, &at, materials);
        io_leave_out(r, "the primitive keeps its material in that variant");
    }
    return materials;
}
