/* scene_light.c - environments that a model brings along: EXT_lights_image_based.
 *
 * The picture is mip 0 of the file's cube map. The lower mips, which hold it filtered for GGX, are not used: facet's
 * own filter (prefilter.h) is exact where a chain of 8-bit images has few and small levels, and background, reflections
 * of any roughness, refraction, sheen and a path tracer then see one and the same surroundings. Diffuse light is what
 * the file's coefficients of irradiance say, also where they come from brighter surroundings than 8 bits hold. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "ibl/environment_source.h"
#include "ibl/scene_cube.h"
#include "ibl/sh.h"
#include "scene/scene.h"

/* Where a direction of the model is in the frame of the light: d_light = rows d. */
typedef struct light_frame {
    float rows[3][3];
} light_frame;

/* The rotation (a unit quaternion) turns the light in the model, so directions are turned back. */
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

/* Coefficients of irradiance / pi in the frame of the light. */
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

/* has_phase: the basis functions of odd m have the sign (-1)^m of Condon and Shortley, as Babylon.js takes them;
 * those of the papers that the extension refers to (Ramamoorthi and Hanrahan 2001) do not. */
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

/* Correlation over directions, in [-1, 1], of what the file says with the irradiance of its picture: 0 where one of
 * them is uniform. Sizes do not count: the picture may hold less than there was. */
static double correlate(const light_irradiance *said, const float picture[SH_COUNT][3])
{
    double a1 = 0.0, b1 = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
    for (uint32_t i = 0; i < PROBE_COUNT; i++) {
        float N[3], p[3], q[3];
        probe_direction(i, 8, N);
        evaluate(said, N, p);
        sh_evaluate(picture, N, q);
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

/* The file's irradiance as its writer meant it: of the four readings (mirrored or not, signs with or without phase)
 * the first, which is the extension's own and in the frame of the cube, unless another is clearly more like the
 * picture's own irradiance. */
static light_irradiance choose_irradiance(const scene_image_light *light, bool is_mirrored,
                                          const float picture[SH_COUNT][3])
{
    light_irradiance best = read_irradiance(light, is_mirrored, false);
    double best_correlation = correlate(&best, picture) + 0.1;
    for (int k = 1; k < 4; k++) {
        light_irradiance other = read_irradiance(light, is_mirrored != (k >= 2), k & 1);
        double correlation = correlate(&other, picture);
        if (correlation > best_correlation) {
            best = other;
            best_correlation = correlation;
        }
    }
    return best;
}

/* Lookup in a cube map as everywhere else, rather than sums of polynomials. */
static facet_result keep_irradiance(facet_environment *e, const scene_cube *c, const scene_image_light *light,
                                    uint32_t thread_count, facet_error *error)
{
    double radiance[SH_COUNT][3], irradiance[SH_COUNT][3];
    float picture[SH_COUNT][3];
    facet_result result = sh_project(&e->picture, &e->allocator, thread_count, radiance, error);
    if (result == FACET_OK)
        result = cube_create(IRRADIANCE_SIZE, &e->allocator, &e->irradiance_over_pi, error);
    if (result != FACET_OK)
        return result;
    sh_irradiance((const double(*)[3])radiance, irradiance);
    sh_fold_over_pi((const double(*)[3])irradiance, picture);
    light_irradiance said = choose_irradiance(light, c->is_mirrored, (const float(*)[3])picture);
    const uint32_t n = IRRADIANCE_SIZE;
    for (uint32_t i = 0; i < 6 * n * n; i++) {
        float N[3], out[3];
        probe_direction(i, n, N);
        evaluate(&said, N, out);
        *cube_texel(&e->irradiance_over_pi, i / (n * n), (int)(i % n), (int)(i / n % n)) =
            (rgbx){fminf(out[0], ENVIRONMENT_MAX_RADIANCE), fminf(out[1], ENVIRONMENT_MAX_RADIANCE),
                   fminf(out[2], ENVIRONMENT_MAX_RADIANCE), 0.0f};
    }
    cube_fill_borders(&e->irradiance_over_pi);
    return FACET_OK;
}

/* ---- the picture ---- */

/* Its faces are not kept: they are turned and mirrored. */
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

/* SCENE_NONE: the pose's scene has none. */
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
        return fail(error, FACET_ERROR_ARGUMENT, "%s: the scene brings no light of its own", scene->source);
    const scene_image_light *light = &scene->image_lights[index];
    facet_environment *e = NULL;
    scene_cube c = {0};
    facet_result result = environment_create(desc, &e, error);
    if (result != FACET_OK)
        return result;
    result = scene_cube_decode(scene, index, desc, &c, error);
    if (result == FACET_OK)
        result = take_cube(e, &c, light, scene->source, desc->thread_count, error);
    if (result == FACET_OK)
        result = keep_irradiance(e, &c, light, desc->thread_count, error);
    scene_cube_destroy(&c);
    if (result != FACET_OK) {
        environment_release(e);
        return result;
    }
    environment_identify(e, e->picture.pixels, e->picture.height * image_row_size(&e->picture));
    *environment = e;
    return FACET_OK;
}
