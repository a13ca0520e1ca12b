/* scene_cube.c - see scene_cube.h. */
#include "ibl/scene_cube.h"

#include <stdio.h>

#include "base/result.h"

enum { FACE_COUNT = 6 };

/* Linear RGBD to RGB: RGBA becomes color over alpha. Alpha 0, of which no packer knows a color, is taken for the least alpha
 * of 8 bits. */
static facet_result unpack_rgbd(image *i, const facet_allocator *allocator, facet_error *error)
{
    image linear = {0};
    facet_result result = image_convert(i, allocator, 1, 4, IMAGE_F32, false, &linear, error);
    if (result != FACET_OK)
        return result;
    float *p = linear.pixels;
    for (size_t count = (size_t)linear.width * linear.height; count; count--, p += 4) {
        float d = p[3] > 1.0f / 255.0f ? p[3] : 1.0f / 255.0f;
        for (int k = 0; k < 3; k++)
            p[k] /= d;
    }
    image_destroy(i);
    *i = linear;
    return FACET_OK;
}

/* Names of faces in messages. */
typedef struct face_names {
    char names[FACE_COUNT][512];
} face_names;

static facet_result find_faces(const facet_scene *scene, const scene_image_light *light, const char *place,
                               face_names *names, cube_face faces[FACE_COUNT], facet_error *error)
{
    for (int face = 0; face < FACE_COUNT; face++) {
        uint32_t index = light->images[face];
        const scene_image *source = index < scene->image_count ? &scene->images[index] : NULL;
        snprintf(names->names[face], sizeof names->names[face], "%s: face %s", place, cube_face_names[face]);
        if (!source || !source->bytes)
            return fail(error, FACET_ERROR_READ, "%s: image %u cannot be read", names->names[face], index);
        faces[face] = (cube_face){.bytes = source->bytes, .size = source->size, .name = names->names[face]};
    }
    return FACET_OK;
}

static facet_result decode_faces(cube_face faces[FACE_COUNT], const facet_environment_desc *desc,
                                 facet_error *error)
{
    facet_result result = cube_faces_decode(faces, desc, error);
    for (int face = 0; face < FACE_COUNT && result == FACET_OK; face++) {
        image *p = &faces[face].picture;
        if (image_codec_detect(faces[face].bytes, faces[face].size) == IMAGE_CODEC_PNG &&
            (p->channel_count == 2 || p->channel_count == 4))
            result = unpack_rgbd(p, &desc->allocator, error);
    }
    return result;
}

/* x runs the other way in all faces. */
static void flip(cube *c)
{
    int last = (int)c->size - 1;
    for (uint32_t face = 0; face < FACE_COUNT; face++)
        for (int y = 0; y <= last; y++)
            for (int x = 0; x < last - x; x++) {
                rgbx *a = cube_texel(c, face, x, y);
                rgbx *b = cube_texel(c, face, last - x, y);
                rgbx t = *a;
                *a = *b;
                *b = t;
            }
    cube_fill_borders(c);
}

double scene_cube_seams(const cube *c)
{
    int n = (int)c->size;
    double sum = 0.0;
    for (uint32_t face = 0; face < FACE_COUNT; face++)
        for (int i = 0; i < n; i++) {
            const rgbx pairs[4][2] = {{*cube_texel(c, face, 0, i), *cube_texel(c, face, -1, i)},
                                      {*cube_texel(c, face, n - 1, i), *cube_texel(c, face, n, i)},
                                      {*cube_texel(c, face, i, 0), *cube_texel(c, face, i, -1)},
                                      {*cube_texel(c, face, i, n - 1), *cube_texel(c, face, i, n)}};
            for (int k = 0; k < 4; k++)
                for (int channel = 0; channel < 3; channel++) {
                    double a = (double)pairs[k][0][channel];
                    double b = (double)pairs[k][1][channel];
                    sum += a + b > 0.0 ? fabs(a - b) / (a + b) : 0.0;
                }
        }
    return sum / (FACE_COUNT * 4.0 * 3.0 * n);
}

facet_result scene_cube_decode(const facet_scene *scene, uint32_t index, const facet_environment_desc *desc,
                               scene_cube *out, facet_error *error)
{
    *out = (scene_cube){0};
    char place[400];
    snprintf(place, sizeof place, "%.300s: EXT_lights_image_based: light %u", scene->source, index);
    const scene_image_light *light = &scene->image_lights[index];
    if (light->mip_count == 0)
        return fail(error, FACET_ERROR_INVALID, "%s: there are no images", place);
    cube_face faces[FACE_COUNT] = {0};
    face_names names;
    facet_result result = find_faces(scene, light, place, &names, faces, error);
    if (result == FACET_OK)
        result = decode_faces(faces, desc, error);
    if (result == FACET_OK && faces[0].picture.width != light->specular_size)
        log_warning(&desc->log, "%s: specularImageSize is %u, but the faces have %u texels along an edge",
                    place, light->specular_size, faces[0].picture.width);
    out->repairs = (environment_repairs){.first = UINT64_MAX};
    if (result == FACET_OK)
        result = cube_faces_assemble(faces, &desc->allocator, desc->thread_count, &out->texels, &out->repairs,
                                     error);
    if (result == FACET_OK) {
        cube_fill_borders(&out->texels);
        double as_they_are = scene_cube_seams(&out->texels);
        flip(&out->texels);
        out->is_mirrored = as_they_are < 0.5 * scene_cube_seams(&out->texels);
        if (out->is_mirrored)
            flip(&out->texels);
    }
    cube_faces_destroy(faces);
    return result;
}

void scene_cube_destroy(scene_cube *c)
{
    cube_destroy(&c->texels);
    *c = (scene_cube){0};
}
