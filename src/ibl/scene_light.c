/* scene_light.c - image-based lights of models: EXT_lights_image_based.
 *
 * The panorama comes from mip 0 of the file's cube map. The lower mips, filtered for GGX, are not used:
 * facet's own filter (prefilter.h) is exact, while a chain of 8-bit images has few and small levels; and
 * background, reflections of any roughness, refraction, sheen and the path tracer all see the same
 * environment. Diffuse light comes from the file's irradiance coefficients, even if they stem from brighter
 * radiance than 8 bits can hold. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "ibl/cache.h"
#include "ibl/environment_source.h"
#include "ibl/sh.h"
#include "scene/scene.h"

/* ---- the cube map ---- */

/* The file holds six images of mip 0, +X -X +Y -Y +Z -Z, "standard orientations", "each saved image must be
 * flipped about its vertical axis". Taken literally, texel (x, y) of face i is the radiance from the
 * direction of (n - 1 - x, y) on face i of cube.h. Babylon.js, for which the extension was made, looks up the
 * images unflipped with the model's X mirrored, which is the same except that +X and -X are swapped. Only one
 * of the two readings is without seams along the edges of the cube, which identifies it.
 *
 * Texels: JPEG and PNG without alpha are sRGB, like all colors in such files in glTF. PNG with alpha is RGBD:
 * linear color is the decoded one over alpha. Formats of floats are linear. */
typedef struct scene_cube {
    cube texels;                 /* faces as in cube.h, in the light's frame, without intensity */
    environment_repairs repairs; /* positions as in the files */
    bool is_mirrored;            /* its X is the model's -X, as in Babylon.js */
} scene_cube;

enum { FACE_COUNT = 6 };

/* RGBD to linear RGB: color over alpha, with alpha at least 1 / 255. */
static facet_result unpack_rgbd(image *i, const facet_allocator *allocator, facet_error *error)
{
    image linear = {0};
    TRY(image_convert(i, allocator, 1, 4, IMAGE_F32, false, &linear, error));
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
            return fail(error, FACET_ERROR_READ, "%s: image %u cannot be read", names->names[face],
                        scene_get_address(scene, SCENE_ITEM_IMAGE, index).number);
        faces[face] = (cube_face){.bytes = source->bytes, .size = source->size, .name = names->names[face]};
    }
    return FACET_OK;
}

static facet_result decode_faces(cube_face faces[FACE_COUNT], const facet_environment_desc *desc,
                                 facet_error *error)
{
    facet_result result = cube_faces_decode(faces, desc, error);
    for (int face = 0; face < FACE_COUNT && result == FACET_OK; face++) {
        image *p = &faces[face].image;
        if (image_codec_detect(faces[face].bytes, faces[face].size) == IMAGE_CODEC_PNG &&
            (p->channel_count == 2 || p->channel_count == 4))
            result = unpack_rgbd(p, &desc->allocator, error);
    }
    return result;
}

/* Flips all faces horizontally. */
static void flip_faces(cube *c)
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

static facet_result scene_cube_decode(const facet_scene *scene, uint32_t index,
                                      const facet_environment_desc *desc, scene_cube *out, facet_error *error)
{
    *out = (scene_cube){0};
    char place[400];
    const scene_address at = scene_get_address(scene, SCENE_ITEM_IMAGE_LIGHT, index);
    snprintf(place, sizeof place, "%.300s: EXT_lights_image_based: light %u", at.source, at.number);
    const scene_image_light *light = &scene->image_lights[index];
    if (light->mip_count == 0)
        return fail(error, FACET_ERROR_INVALID, "%s: there are no images", place);
    cube_face faces[FACE_COUNT] = {0};
    face_names names;
    facet_result result = find_faces(scene, light, place, &names, faces, error);
    if (result == FACET_OK)
        result = decode_faces(faces, desc, error);
    if (result == FACET_OK && faces[0].image.width != light->specular_size)
        log_warning(&desc->log, "%s: specularImageSize is %u, but the faces have %u texels along an edge",
                    place, light->specular_size, faces[0].image.width);
    out->repairs = (environment_repairs){.first = UINT64_MAX};
    if (result == FACET_OK)
        result = cube_faces_assemble(faces, &desc->allocator, desc->thread_count, &out->texels, &out->repairs,
                                     error);
    if (result == FACET_OK) {
        cube_fill_borders(&out->texels);
        double unflipped = scene_cube_seams(&out->texels);
        flip_faces(&out->texels);
        out->is_mirrored = unflipped < 0.5 * scene_cube_seams(&out->texels);
        if (out->is_mirrored)
            flip_faces(&out->texels);
    }
    cube_faces_destroy(faces);
    return result;
}

static void scene_cube_destroy(scene_cube *c)
{
    cube_destroy(&c->texels);
    *c = (scene_cube){0};
}

/* Rotation from the model to the light's frame: d_light = rows d. */
typedef struct light_frame {
    float rows[3][3];
} light_frame;

/* q (a unit quaternion) rotates the light in the model; directions need the inverse. */
static light_frame make_frame(const float q[4], bool is_mirrored)
{
    float x = q[0];
    float y = q[1];
    float z = q[2];
    float w = q[3];
    light_frame f = {{{1.0f - 2.0f * (y * y + z * z), 2.0f * (x * y + z * w), 2.0f * (x * z - y * w)},
                      {2.0f * (x * y - z * w), 1.0f - 2.0f * (x * x + z * z), 2.0f * (y * z + x * w)},
                      {2.0f * (x * z + y * w), 2.0f * (y * z - x * w), 1.0f - 2.0f * (x * x + y * y)}}};
    for (int i = 0; i < 3; i++)
        f.rows[0][i] = is_mirrored ? -f.rows[0][i] : f.rows[0][i];
    return f;
}

static void to_light(const light_frame *f, const float d[3], float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = f->rows[i][0] * d[0] + f->rows[i][1] * d[1] + f->rows[i][2] * d[2];
}

/* ---- irradiance ---- */

enum { IRRADIANCE_SIZE = 32, PROBE_COUNT = 6 * 8 * 8 };

/* Coefficients of irradiance / pi in the light's frame. */
typedef struct light_irradiance {
    light_frame frame;
    float c[SH_COUNT][3];
} light_irradiance;

static void evaluate(const light_irradiance *i, const float N[3], float out[3])
{
    float d[3];
    to_light(&i->frame, N, d);
    sh_evaluate(i->c, d, out);
}

/* has_phase: basis functions of odd m include the Condon-Shortley phase (-1)^m, as in Babylon.js; in the
 * extension's reference (Ramamoorthi and Hanrahan 2001) they do not. */
static light_irradiance read_irradiance(const scene_image_light *light, bool is_mirrored, bool has_phase)
{
    light_irradiance out = {.frame = make_frame(light->rotation, is_mirrored)};
    double irradiance[SH_COUNT][3];
    for (int k = 0; k < SH_COUNT; k++) {
        bool is_odd = k == 1 || k == 3 || k == 5 || k == 7;
        for (int i = 0; i < 3; i++)
            irradiance[k][i] = (has_phase && is_odd ? -1.0 : 1.0) * (double)light->intensity *
                               (double)light->irradiance[k][i];
    }
    sh_fold_over_pi((const double(*)[3])irradiance, out.c);
    return out;
}

static void probe_direction(uint32_t i, uint32_t size, float N[3])
{
    double d[3];
    cube_direction(i / (size * size), (2.0 * (i % size) + 1.0) / size - 1.0,
                   (2.0 * (i / size % size) + 1.0) / size - 1.0, d);
    double scale = 1.0 / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int k = 0; k < 3; k++)
        N[k] = (float)(d[k] * scale);
}

/* Correlation over directions, in [-1, 1], between the stated irradiance and the one measured in the image; 0 if one of
 * them is uniform. Scale does not matter: the image may hold less than the original radiance. */
static double correlate(const light_irradiance *stated, const float measured[SH_COUNT][3])
{
    double a1 = 0.0, b1 = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
    for (uint32_t i = 0; i < PROBE_COUNT; i++) {
        float N[3], p[3], q[3];
        probe_direction(i, 8, N);
        evaluate(stated, N, p);
        sh_evaluate(measured, N, q);
        double a = (double)p[0] + (double)p[1] + (double)p[2];
        double b = (double)q[0] + (double)q[1] + (double)q[2];
        a1 += a / PROBE_COUNT;
        b1 += b / PROBE_COUNT;
        aa += a * a / PROBE_COUNT;
        bb += b * b / PROBE_COUNT;
        ab += a * b / PROBE_COUNT;
    }
    double variance = (aa - a1 * a1) * (bb - b1 * b1);
    return variance > 1e-12 * aa * bb ? (ab - a1 * b1) / sqrt(variance) : 0.0;
}

/* The most plausible of four readings of the file's irradiance (mirrored or not, with or without phase): the
 * first, which is the extension's own in the frame of the cube, unless another correlates clearly better with
 * the irradiance of the image. */
static light_irradiance choose_irradiance(const scene_image_light *light, bool is_mirrored,
                                          const float measured[SH_COUNT][3])
{
    light_irradiance best = read_irradiance(light, is_mirrored, false);
    double best_correlation = correlate(&best, measured) + 0.1;
    for (int k = 1; k < 4; k++) {
        light_irradiance other = read_irradiance(light, is_mirrored != (k >= 2), k & 1);
        double correlation = correlate(&other, measured);
        if (correlation > best_correlation) {
            best = other;
            best_correlation = correlation;
        }
    }
    return best;
}

/* Stores irradiance as a cube map, the form of all other lookups. */
static facet_result keep_irradiance(facet_environment *e, const scene_cube *c, const scene_image_light *light,
                                    uint32_t thread_count, facet_error *error)
{
    double radiance[SH_COUNT][3], irradiance[SH_COUNT][3];
    float measured[SH_COUNT][3];
    TRY(sh_project(&e->panorama, &e->allocator, thread_count, radiance, error));
    TRY(cube_create(IRRADIANCE_SIZE, &e->allocator, &e->irradiance_over_pi, error));
    sh_irradiance((const double(*)[3])radiance, irradiance);
    sh_fold_over_pi((const double(*)[3])irradiance, measured);
    light_irradiance stated = choose_irradiance(light, c->is_mirrored, (const float(*)[3])measured);
    const uint32_t n = IRRADIANCE_SIZE;
    for (uint32_t i = 0; i < 6 * n * n; i++) {
        float N[3], out[3];
        probe_direction(i, n, N);
        evaluate(&stated, N, out);
        *cube_texel(&e->irradiance_over_pi, i / (n * n), (int)(i % n), (int)(i / n % n)) =
            (rgbx){fminf(out[0], ENVIRONMENT_MAX_RADIANCE), fminf(out[1], ENVIRONMENT_MAX_RADIANCE),
                   fminf(out[2], ENVIRONMENT_MAX_RADIANCE), 0.0f};
    }
    cube_fill_borders(&e->irradiance_over_pi);
    return FACET_OK;
}

/* ---- the image ---- */

/* The faces are not kept, since they are rotated and mirrored. */
static facet_result take_cube(facet_environment *e, const scene_cube *c, const scene_image_light *light,
                              const char *name, uint32_t thread_count, facet_error *error)
{
    uint32_t face, x, y;
    char place[16];
    cube_faces_place(&c->texels, c->repairs.count ? c->repairs.first : 0, &face, &x, &y);
    snprintf(place, sizeof place, "face %s", cube_face_names[face]);
    environment_report(e, &c->repairs, name, place, x, y);
    e->layout = FACET_LAYOUT_FACES;
    e->source_width = e->source_height = c->texels.size;
    light_frame frame = make_frame(light->rotation, c->is_mirrored);
    sphere_turn turn = {.is_turned = true, .scale = light->intensity};
    memcpy(turn.rows, frame.rows, sizeof turn.rows);
    return environment_unroll(e, &c->texels, &turn, thread_count, error);
}

/* ---- the functions of facet.h ---- */

/* SCENE_NONE: the pose's scene has no image-based light. */
static uint32_t find_light(const facet_scene *scene, const facet_pose_desc *pose)
{
    uint32_t index = scene->default_scene == SCENE_NONE ? 0 : scene->default_scene;
    if (pose && pose->has_scene_index)
        index = pose->scene_index;
    if (index >= scene->scene_count || scene->scenes[index].image_light >= scene->image_light_count)
        return SCENE_NONE;
    return scene->scenes[index].image_light;
}

bool facet_scene_has_environment(const facet_scene *scene, const facet_pose_desc *pose)
{
    return find_light(scene, pose) != SCENE_NONE;
}

facet_result facet_environment_create_from_scene(const facet_scene *scene, const facet_pose_desc *pose,
                                                 const facet_environment_desc *desc,
                                                 facet_environment **environment, facet_error *error)
{
    static const facet_environment_desc default_desc;
    *environment = NULL;
    desc = desc ? desc : &default_desc;
    uint32_t index = find_light(scene, pose);
    if (index == SCENE_NONE)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: the scene has no image-based light", scene->source);
    const scene_image_light *light = &scene->image_lights[index];
    facet_environment *e = NULL;
    scene_cube c = {0};
    TRY(environment_create(desc, &e, error));
    facet_result result = scene_cube_decode(scene, index, desc, &c, error);
    if (result == FACET_OK)
        result = take_cube(e, &c, light, scene->source, desc->thread_count, error);
    if (result == FACET_OK)
        result = keep_irradiance(e, &c, light, desc->thread_count, error);
    scene_cube_destroy(&c);
    return cache_finish(result, e, environment);
}
