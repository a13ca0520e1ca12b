/* gltf_image_lights.c - EXT_lights_image_based: cube maps that light a scene. What their images hold is looked at by
 * who lights with them. */
#include <float.h>

#include "io/gltf/gltf_reader.h"

static const char NAME[] = "EXT_lights_image_based";

/* Nine coefficients for each of red, green and blue. */
static void read_irradiance(io_reader *r, const json_place *light, scene_image_light *out)
{
    json_place array = io_get_array(r, light, "irradianceCoefficients");
    if (io_is_ok(r) && io_get_count(&array) != 9)
        io_fail(r, light, "irradianceCoefficients", FACET_ERROR_INVALID,
                "must have 9 coefficients, but has %zu", io_get_count(&array));
    for (size_t i = 0; i < 9 && io_is_ok(r); i++) {
        json_place element = io_get_element(&array, i);
        io_get_floats_value(r, &element, out->irradiance[i], 3);
    }
}

static void read_cube(io_reader *r, const json_place *light, scene_image_light *out)
{
    json_place array = io_get_array(r, light, "specularImages");
    size_t mip_count = io_get_count(&array);
    out->specular_size = (uint32_t)io_get_uint(r, light, "specularImageSize", UINT32_MAX, IO_REQUIRED_UINT);
    if (io_is_ok(r) && (mip_count == 0 || mip_count > 32))
        io_fail(r, light, "specularImages", FACET_ERROR_INVALID, "must have 1 to 32 mips, but has %zu",
                mip_count);
    uint32_t *images = io_alloc(r, "lights", mip_count, 6 * sizeof *images);
    for (size_t mip = 0; mip < mip_count && io_is_ok(r); mip++) {
        json_place faces = io_get_element(&array, mip);
        if (!json_is_array(faces.value) || io_get_count(&faces) != 6)
            io_fail(r, &faces, NULL, FACET_ERROR_INVALID, "must be an array of 6 images");
        for (size_t face = 0; face < 6 && io_is_ok(r); face++) {
            json_place element = io_get_element(&faces, face);
            images[6 * mip + face] = io_get_index_value(r, &element, r->scene->image_count, "image");
        }
    }
    out->images = images;
    out->mip_count = (uint32_t)mip_count;
}

void gltf_read_image_lights(io_reader *r, const json_place *root)
{
    json_place extension = io_get_extension(r, root, NAME);
    json_place array = io_get_array(r, &extension, "lights");
    size_t count = io_get_count(&array);
    if (io_is_ok(r) && extension.value && !array.value)
        io_note(r, &extension, "lights", "is missing");
    io_leave_out(r, "there is no light of images");
    r->scene->image_lights = io_alloc(r, "lights", count, sizeof *r->scene->image_lights);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        scene_image_light *out = &r->scene->image_lights[i];
        *out = (scene_image_light){.name = io_get_name(r, &at), .rotation = {0, 0, 0, 1}};
        if (io_get_floats(r, &at, "rotation", out->rotation, 4))
            gltf_normalize_rotation(out->rotation);
        out->intensity = io_get_float_in(r, &at, "intensity", 0.0f, FLT_MAX, 1.0f);
        read_irradiance(r, &at, out);
        read_cube(r, &at, out);
        if (io_leave_out(r, "the light of images is left out"))
            *out = (scene_image_light){.name = io_get_name(r, &at), .rotation = {0, 0, 0, 1}};
        out->meta = gltf_get_meta(r, &at);
        r->scene->image_light_count = (uint32_t)(i + 1);
    }
}
