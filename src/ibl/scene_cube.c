/* scene_cube.c - see scene_cube.h. */
#include "ibl/scene_cube.h"

#include <stdio.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "image/image.h"

enum { FACE_COUNT = 6, DEFAULT_MAX_SIZE = 32768 };
static const char *const face_names[FACE_COUNT] = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};

typedef struct decoding {
    const facet_scene *scene;
    const scene_image_light *light;
    const facet_environment_desc *desc;
    const char *place; /* of the light in messages */
    image faces[FACE_COUNT];
    facet_result results[FACE_COUNT];
    facet_error errors[FACE_COUNT];
} decoding;

/* Linear RGBD to RGB, in place: RGBA becomes color over alpha. Alpha 0, of which no packer knows a color, is taken for
 * the least alpha of 8 bits. */
static void unpack_rgbd(image *i)
{
    float *p = i->pixels;
    for (size_t count = (size_t)i->width * i->height; count; count--, p += 4) {
        float d = p[3] > 1.0f / 255.0f ? p[3] : 1.0f / 255.0f;
        for (int k = 0; k < 3; k++)
            p[k] /= d;
    }
}

static facet_result decode_face(decoding *job, size_t face, facet_error *error)
{
    uint32_t index = job->light->images[face];
    const scene_image *source = index < job->scene->image_count ? &job->scene->images[index] : NULL;
    if (!source || !source->bytes)
        return fail(error, FACET_ERROR_READ, "%s: face %s: image %u cannot be read", job->place,
                    face_names[face], index);
    char name[512];
    snprintf(name, sizeof name, "%s: face %s", job->place, face_names[face]);
    image_decode_desc how = {.allocator = job->desc->allocator,
                             .max_size = job->desc->max_size ? job->desc->max_size : DEFAULT_MAX_SIZE};
    image decoded = {0};
    facet_result result = image_decode(source->bytes, source->size, name, &how, &decoded, error);
    if (result != FACET_OK)
        return result;
    if (decoded.width != decoded.height)
        result = fail(error, FACET_ERROR_INVALID, "%s: %u x %u texels: faces of a cube are square", name,
                      decoded.width, decoded.height);
    bool is_rgbd = image_codec_detect(source->bytes, source->size) == IMAGE_CODEC_PNG &&
                   (decoded.channel_count == 2 || decoded.channel_count == 4);
    if (result == FACET_OK)
        result =
            image_convert(&decoded, &job->desc->allocator, 1, 4, IMAGE_F32, false, &job->faces[face], error);
    if (result == FACET_OK && is_rgbd)
        unpack_rgbd(&job->faces[face]);
    image_destroy(&decoded);
    return result;
}

static void decode_faces(void *context, size_t begin, size_t end)
{
    decoding *job = context;
    for (size_t face = begin; face < end; face++)
        job->results[face] = decode_face(job, face, &job->errors[face]);
}

static facet_result check_faces(const decoding *job, facet_error *error)
{
    for (int face = 0; face < FACE_COUNT; face++)
        if (job->results[face] != FACET_OK)
            return fail(error, job->results[face], "%s", job->errors[face].message);
    uint32_t size = job->faces[0].width;
    for (int face = 1; face < FACE_COUNT; face++)
        if (job->faces[face].width != size)
            return fail(error, FACET_ERROR_INVALID, "%s: face %s has %u texels along an edge, face +X has %u",
                        job->place, face_names[face], job->faces[face].width, size);
    if (size != job->light->specular_size)
        log_warning(&job->desc->log,
                    "%s: specularImageSize is %u, but the faces have %u texels along an edge", job->place,
                    job->light->specular_size, size);
    return FACET_OK;
}

/* is_flipped: x runs the other way. */
static void fill_cube(const decoding *job, bool is_flipped, cube *c)
{
    int size = (int)c->size;
    for (uint32_t face = 0; face < FACE_COUNT; face++) {
        const float *p = job->faces[face].pixels;
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++, p += 4)
                *cube_texel(c, face, is_flipped ? size - 1 - x : x, y) = (rgbx){p[0], p[1], p[2], 0.0f};
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
    decoding job = {.scene = scene, .light = &scene->image_lights[index], .desc = desc, .place = place};
    facet_result result = FACET_OK;
    if (job.light->mip_count == 0)
        return fail(error, FACET_ERROR_INVALID, "%s: there are no images", place);
    parallel_for(desc->thread_count, FACE_COUNT, 1, decode_faces, &job);
    result = check_faces(&job, error);
    if (result == FACET_OK)
        result = cube_create(job.faces[0].width, &desc->allocator, &out->texels, error);
    if (result == FACET_OK) {
        fill_cube(&job, false, &out->texels);
        double as_they_are = scene_cube_seams(&out->texels);
        fill_cube(&job, true, &out->texels);
        double flipped = scene_cube_seams(&out->texels);
        out->is_mirrored = as_they_are < 0.5 * flipped;
        if (out->is_mirrored)
            fill_cube(&job, false, &out->texels);
    }
    for (int face = 0; face < FACE_COUNT; face++)
        image_destroy(&job.faces[face]);
    return result;
}

void scene_cube_destroy(scene_cube *c)
{
    cube_destroy(&c->texels);
    *c = (scene_cube){0};
}
