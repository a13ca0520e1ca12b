/* spheres.c - see spheres.h. The stage is a scene of its own that shares materials, textures and images
 * with the converted scene, so that spheres style as in a render of it. */
#include "report/spheres.h"

#include <math.h>
#include <string.h>

#include "base/result.h"
#include "cpu/preview.h"
#include "film/film_image.h"
#include "scene/sphere.h"

/* Unit, from the sphere to the light: from the upper left, in front. */
static const float TO_LIGHT[3] = {-0.5153882f, 0.6184658f, 0.5933908f};

struct sphere_stage {
    facet_scene *scene;
    scene_primitive *ball;
    scene_legacy legacy;
    legacy_light light;
};

/* The rotation from -Z, the direction of punctual lights, to d. */
static void rotation_to(const float d[3], float out[4])
{
    /* half of it: axis (0, 0, -1) x d, cosine -d.z */
    float w = 1.0f - d[2];
    const float q[4] = {d[1], -d[0], 0.0f, w};
    float length = sqrtf(q[0] * q[0] + q[1] * q[1] + q[3] * q[3]);
    for (int i = 0; i < 4; i++)
        out[i] = q[i] / length;
}

/* Creates sphere and light. False: out of memory. */
static bool fill_scene(sphere_stage *stage)
{
    facet_scene *s = stage->scene;
    uint32_t *roots = arena_alloc(s->arena, 2, sizeof *roots);
    stage->ball = arena_zalloc(s->arena, 1, sizeof *stage->ball);
    s->meshes = arena_zalloc(s->arena, 1, sizeof *s->meshes);
    s->nodes = arena_zalloc(s->arena, 2, sizeof *s->nodes);
    s->lights = arena_zalloc(s->arena, 1, sizeof *s->lights);
    s->scenes = arena_zalloc(s->arena, 1, sizeof *s->scenes);
    if (!roots || !stage->ball || !s->meshes || !s->nodes || !s->lights || !s->scenes ||
        !scene_make_sphere(s->arena, 96, 48, stage->ball))
        return false;
    const float shines[3] = {-TO_LIGHT[0], -TO_LIGHT[1], -TO_LIGHT[2]};
    s->meshes[0] = (scene_mesh){.name = "", .primitive_count = 1, .primitives = stage->ball};
    s->lights[0] = (scene_light){.name = "",
                                 .type = SCENE_LIGHT_DIRECTIONAL,
                                 .color = {1, 1, 1},
                                 .intensity = 3.14159265f}; /* makes PBR as bright as OpenGL 1 */
    s->nodes[0] = s->nodes[1] = scene_node_default("");
    s->nodes[0].mesh = 0;
    s->nodes[1].light = 0;
    rotation_to(shines, s->nodes[1].rotation);
    roots[0] = 0;
    roots[1] = 1;
    s->scenes[0] = (scene_root){.name = "", .node_count = 2, .nodes = roots, .image_light = SCENE_NONE};
    s->mesh_count = s->light_count = s->scene_count = 1;
    s->node_count = 2;
    s->default_scene = 0;
    return true;
}

/* Images of the source materials that the conversion dropped are restored. */
static void share_source(const facet_scene *scene, facet_scene *s)
{
    const scene_conversion_source *source = scene->conversion ? scene->conversion->source : NULL;
    if (!source)
        return;
    s->materials = source->materials;
    s->texture_count = source->texture_count;
    s->textures = source->textures;
    s->image_count = source->image_count;
    s->images = source->images;
}

facet_result sphere_stage_create(const facet_scene *scene, sphere_stage **out, facet_error *error)
{
    *out = NULL;
    sphere_stage *stage = mem_zalloc(&scene->allocator, 1, sizeof *stage);
    if (!stage)
        return fail_memory(error, "report", sizeof *stage);
    facet_result result = scene_create(&scene->allocator, scene->source, &stage->scene, error);
    if (result == FACET_OK && !fill_scene(stage))
        result = fail_memory(error, "report", 0);
    if (result != FACET_OK) {
        sphere_stage_destroy(stage);
        return result;
    }
    facet_scene *s = stage->scene;
    s->material_count = scene->material_count;
    s->materials = scene->materials;
    s->texture_count = scene->texture_count;
    s->textures = scene->textures;
    s->image_count = scene->image_count;
    s->images = scene->images;
    share_source(scene, s);
    s->max_texture_size = scene->max_texture_size;
    s->thread_count = scene->thread_count;
    if (scene->legacy) {
        stage->legacy = *scene->legacy;
        stage->light = (legacy_light){.diffuse = {1, 1, 1}, .specular = {1, 1, 1}};
        memcpy(stage->light.position, TO_LIGHT, sizeof TO_LIGHT);
        stage->legacy.lights = &stage->light;
        stage->legacy.light_count = 1;
        stage->legacy.fog = (legacy_fog){0};
        if (scene->conversion && scene->conversion->source)
            stage->legacy.materials = scene->conversion->source->legacy;
        s->legacy = &stage->legacy;
    }
    *out = stage;
    return FACET_OK;
}

void sphere_stage_destroy(sphere_stage *stage)
{
    if (!stage)
        return;
    scene_destroy(stage->scene);
    mem_free(stage);
}

static facet_result encode(const film *f, const facet_scene *scene, unsigned char **bytes, size_t *byte_count,
                           facet_error *error)
{
    image display = {0};
    const image_encode_desc desc = {.allocator = scene->allocator, .compression = 9};
    facet_result result =
        film_to_display_image(f, IMAGE_U8, true, &scene->allocator, scene->thread_count, &display, error);
    if (result == FACET_OK)
        result = image_encode(&display, IMAGE_CODEC_PNG, &desc, bytes, byte_count, error);
    image_destroy(&display);
    return result;
}

facet_result sphere_draw(sphere_stage *stage, uint32_t material, sphere_style style, uint32_t size,
                         unsigned char **bytes, size_t *byte_count, facet_error *error)
{
    facet_scene *scene = stage->scene;
    const facet_camera camera = {.eye = {0, 0, 4}, .ortho_height = 2.06f};
    const facet_render_desc desc = {.allocator = scene->allocator,
                                    .thread_count =
                                        scene->thread_count ? scene->thread_count : facet_thread_count(),
                                    .width = size,
                                    .height = size,
                                    .crop = {0, 0, size, size},
                                    .camera = &camera,
                                    .samples = 8,
                                    .shading = style == SPHERE_PBR ? FACET_SHADING_GLTF : FACET_SHADING_OGL1,
                                    .ogl1 = {.is_linear = style == SPHERE_OGL1_LINEAR}};
    film drawn = {0};
    facet_render_stats stats = {0};
    *bytes = NULL;
    *byte_count = 0;
    stage->ball->material = material;
    facet_result result = film_create(&scene->allocator, size, size, 0, &drawn, error);
    if (result == FACET_OK)
        result = preview_render(scene, &desc, &drawn, &stats, error);
    if (result == FACET_OK)
        film_tone_map(&drawn, FACET_TONEMAP_NONE, NULL, desc.thread_count);
    if (result == FACET_OK)
        result = encode(&drawn, scene, bytes, byte_count, error);
    film_destroy(&drawn);
    return result;
}
