/* gltf_image_lights.c - EXT_lights_image_based: cube maps that light a scene. What their images hold is looked at by
 * who lights with them. */
#include <float.h>

#include "io/gltf/gltf_reader.h"

static const char NAME[] = "EXT_lights_image_based";

/* Nine coefficients for each of red, green and blue. */
static void read_irradiance(reader *r, const json_place *light, scene_image_light *out)
{
    json_place array = get_array(r, light, "irradianceCoefficients");
    if (reader_is_ok(r) && get_count(&array) != 9)
        reader_fail(r, light, "irradianceCoefficients", FACET_ERROR_INVALID,
                    "must have 9 coefficients, but has %zu", get_count(&array));
    for (size_t i = 0; i < 9 && reader_is_ok(r); i++) {
        json_place element = get_element(&array, i);
        get_floats_value(r, &element, out->irradiance[i], 3);
    }
}

static void read_cube(reader *r, const json_place *light, scene_image_light *out)
{
    json_place array = get_array(r, light, "specularImages");
    size_t mip_count = get_count(&array);
    out->specular_size = (uint32_t)get_uint(r, light, "specularImageSize", UINT32_MAX, REQUIRED_UINT);
    if (reader_is_ok(r) && (mip_count == 0 || mip_count > 32))
        reader_fail(r, light, "specularImages", FACET_ERROR_INVALID, "must have 1 to 32 mips, but has %zu",
                    mip_count);
    uint32_t *images = reader_alloc(r, "lights", mip_count, 6 * sizeof *images);
    for (size_t mip = 0; mip < mip_count && reader_is_ok(r); mip++) {
        json_place faces = get_element(&array, mip);
        if (!json_is_array(faces.value) || get_count(&faces) != 6)
            reader_fail(r, &faces, NULL, FACET_ERROR_INVALID, "must be an array of 6 images");
        for (size_t face = 0; face < 6 && reader_is_ok(r); face++) {
            json_place element = get_element(&faces, face);
            images[6 * mip + face] = get_index_value(r, &element, r->scene->image_count, "image");
        }
    }
    out->images = images;
    out->mip_count = (uint32_t)mip_count;
}

void read_image_lights(reader *r, const json_place *root)
{
    json_place extension = get_extension(r, root, NAME);
    json_place array = get_array(r, &extension, "lights");
    size_t count = get_count(&array);
    if (reader_is_ok(r) && extension.value && !array.value)
        reader_note(r, &extension, "lights", "is missing");
    reader_leave_out(r, "there is no light of images");
    r->scene->image_lights = reader_alloc(r, "lights", count, sizeof *r->scene->image_lights);
    for (size_t i = 0; i < count && reader_is_ok(r); i++) {
        json_place at = get_element_object(r, &array, i);
        scene_image_light *out = &r->scene->image_lights[i];
        *out = (scene_image_light){.name = get_name(r, &at), .rotation = {0, 0, 0, 1}};
        if (get_floats(r, &at, "rotation", out->rotation, 4))
            normalise_rotation(out->rotation);
        out->intensity = get_float_in(r, &at, "intensity", 0.0f, FLT_MAX, 1.0f);
        read_irradiance(r, &at, out);
        read_cube(r, &at, out);
        if (reader_leave_out(r, "the light of images is left out"))
            *out = (scene_image_light){.name = get_name(r, &at), .rotation = {0, 0, 0, 1}};
        out->meta = get_meta(r, &at);
        r->scene->image_light_count = (uint32_t)(i + 1);
    }
}
