/* prepared_fixture.c - see prepared_fixture.h. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "cpu/prepared_fixture.h"
#include "cpu/preview.h"

#include "cpu/preview.h"

facet_result prepared_try(const fixture *f, prepared_scene *p, film *rendered, facet_render_stats *stats,
                          facet_error *error)
{
    facet_render_desc desc = fixture_desc(f);
    facet_result result =
        film_create(&desc.allocator, desc.crop[2], desc.crop[3], desc.aovs, rendered, error);
    return result == FACET_OK ? preview_render_prepared(p, &desc, rendered, stats, error) : result;
}

/* Renders with the prepared scene, and separately. */
facet_render_stats prepared_compare(fixture *f, prepared_scene *p)
{
    film kept;
    facet_render_stats stats;
    facet_error error = {0};
    if (prepared_try(f, p, &kept, &stats, &error) != FACET_OK)
        fail_msg("%s", error.message);
    film fresh = fixture_render(f);
    fixture_assert_same(&kept, &fresh);
    film_destroy(&kept);
    film_destroy(&fresh);
    return stats;
}

/* ---- scenes ---- */

static uint32_t add_material(fixture *f, bool is_unlit, uint32_t seed)
{
    enum { SIZE = 256 };
    static unsigned char texels[4 * SIZE * SIZE];
    uint32_t textures[2];
    for (uint32_t k = 0; k < 2; k++) {
        for (uint32_t i = 0; i < SIZE * SIZE; i++) {
            uint32_t noise = (i * 2654435761u ^ (seed + k)) * 2246822519u;
            const unsigned char normal[4] = {(unsigned char)(100 + (noise >> 26)), 140, 240, 255};
            const unsigned char color[4] = {(unsigned char)(noise >> 24), (unsigned char)i,
                                            (unsigned char)(i >> 8), 255};
            memcpy(texels + 4 * i, k ? normal : color, 4);
        }
        textures[k] = fixture_add_texture(f, SIZE, SIZE, texels);
    }
    scene_material m = scene_material_default();
    m.extensions = is_unlit ? SCENE_UNLIT : 0;
    m.textures[SCENE_BASE_COLOR_TEXTURE].texture = textures[0];
    m.textures[SCENE_NORMAL_TEXTURE].texture = is_unlit ? SCENE_NONE : textures[1];
    m.perceptual_roughness = 0.3f;
    return fixture_add_material(f, m);
}

/* Textured spheres, lines, points, transparency. */
fixture prepared_still_scene(void)
{
    static const float places[12] = {-1, -1, 0.5f, 1, 1, 0.3f, -1, 1, 0.2f, 1, -1, 0.1f};
    fixture f = fixture_create();
    uint32_t ball = fixture_add_sphere(&f, 32, add_material(&f, false, 1));
    uint32_t wall = fixture_add_quad(&f, add_material(&f, true, 2));
    scene_material glass = scene_material_default();
    glass.alpha_mode = SCENE_ALPHA_BLEND;
    glass.base_color[3] = 0.5f;
    uint32_t pane = fixture_add_quad(&f, fixture_add_material(&f, glass));
    fixture_place(&f, ball, -0.3f, 0.2f, 0.0f, 0.5f);
    fixture_place(&f, ball, 0.5f, -0.2f, 0.1f, 0.3f);
    fixture_place(&f, wall, 0.0f, 0.0f, -0.7f, 0.9f);
    fixture_place(&f, pane, 0.3f, 0.3f, 0.7f, 0.4f);
    fixture_place(&f, fixture_add_sprites(&f, SCENE_LINES, places, 4, SCENE_NONE), 0, 0, 0, 0.8f);
    fixture_place(&f, fixture_add_sprites(&f, SCENE_POINTS, places, 4, SCENE_NONE), 0, 0, 0, 0.5f);
    scene_light light = {.type = SCENE_LIGHT_POINT, .color = {1, 0.5f, 0.2f}, .intensity = 20.0f};
    fixture_add_light(&f, light, 2, 2, 2);
    f.desc.aovs = FACET_AOV_DEPTH | FACET_AOV_NORMAL | FACET_AOV_ALBEDO;
    return f;
}

void prepared_orbit(fixture *f, float angle, float distance)
{
    f->camera.eye[0] = distance * sinf(angle);
    f->camera.eye[1] = 0.2f * distance;
    f->camera.eye[2] = distance * cosf(angle);
    f->camera.fov_y_rad = 0.5f;
}

/* ---- motion ---- */

static const float key_times[3] = {0.0f, 1.0f, 2.0f};
const float prepared_rotations[12] = {0, 0, 0, 1, 0, 0.6f, 0, 0.8f, 0, 0, 0.8f, 0.6f};
static const float key_weights[3] = {0.0f, 1.0f, 0.3f};
static const float key_colors[12] = {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1};
static const uint32_t first_animation = 0;

/* Rotates a node (or animates its weight, or the color of a material) by keys. */
void prepared_animate(fixture *f, scene_channel channel)
{
    scene_sampler *sampler = arena_zalloc(f->scene->arena, 1, sizeof *sampler);
    scene_channel *kept = arena_zalloc(f->scene->arena, 1, sizeof *kept);
    scene_animation *animation = arena_zalloc(f->scene->arena, 1, sizeof *animation);
    assert_true(sampler && kept && animation);
    *sampler = (scene_sampler){.interpolation = SCENE_LINEAR, .key_count = 3, .times = key_times};
    sampler->width = channel.kind == SCENE_TARGET_WEIGHTS ? 1 : 4;
    sampler->values = channel.kind == SCENE_TARGET_WEIGHTS    ? key_weights
                      : channel.kind == SCENE_TARGET_MATERIAL ? key_colors
                                                              : prepared_rotations;
    *kept = channel;
    kept->scale = 1.0f;
    *animation = (scene_animation){.name = "",
                                   .channel_count = 1,
                                   .sampler_count = 1,
                                   .channels = kept,
                                   .samplers = sampler,
                                   .end_s = 2.0f};
    f->scene->animations = animation;
    f->scene->animation_count = 1;
    f->desc.pose.animation_count = 1;
    f->desc.pose.animations = &first_animation;
}

scene_channel prepared_rotation_of(uint32_t node)
{
    return (scene_channel){.kind = SCENE_TARGET_NODE,
                           .index = node,
                           .offset = offsetof(scene_node, rotation),
                           .is_rotation = true};
}

/* Large enough that keeping the static part pays: a child rotates with its parent. */
fixture prepared_moving_scene(void)
{
    fixture f = fixture_create();
    uint32_t material = add_material(&f, false, 3);
    uint32_t balls[3];
    for (int i = 0; i < 3; i++)
        balls[i] = fixture_add_sphere(&f, 128, material);
    fixture_place(&f, balls[0], -0.5f, 0.0f, 0.0f, 0.5f);
    fixture_place(&f, balls[1], 0.5f, 0.3f, 0.0f, 0.4f);
    fixture_place(&f, balls[2], 1.0f, -0.5f, 0.4f, 0.5f);
    fixture_place(&f, fixture_add_quad(&f, material), 0.0f, 0.0f, -0.5f, 1.0f);
    uint32_t *child = arena_zalloc(f.scene->arena, 1, sizeof *child);
    assert_non_null(child);
    *child = 2;
    f.scene->nodes[1].child_count = 1;
    f.scene->nodes[1].children = child;
    f.scene->nodes[2].parent = 1;
    f.desc.aovs = FACET_AOV_DEPTH | FACET_AOV_NORMAL;
    return f;
}
