/* meter_test.c - the light meter inside of rooms, where the renderers differ: paths see what walls block and reflect. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"

enum { FACES = 7, WHITE = 0, RED, GREEN, LAMP };

/* A room after Cornell's (Goral et al. 1984), 2 m wide, with a lamp below the ceiling; the last face closes it. */
static facet_scene *make_room(float lamp, bool is_closed)
{
    /* corner, two edges; walls face inwards */
    static const float faces[FACES][9] = {
        {-1, -1, 1, 2, 0, 0, 0, 0, -2},             /* floor */
        {-1, 1, -1, 2, 0, 0, 0, 0, 2},              /* ceiling */
        {-1, -1, -1, 2, 0, 0, 0, 2, 0},             /* back */
        {-1, -1, 1, 0, 0, -2, 0, 2, 0},             /* left */
        {1, -1, -1, 0, 0, 2, 0, 2, 0},              /* right */
        {-.25f, .98f, -.25f, .5f, 0, 0, 0, 0, .5f}, /* lamp */
        {1, -1, 1, -2, 0, 0, 0, 2, 0},              /* front, behind the camera */
    };
    static const uint32_t materials_of[FACES] = {WHITE, WHITE, WHITE, RED, GREEN, LAMP, WHITE};
    static const float colors[3][3] = {{.73f, .73f, .73f}, {.63f, .06f, .05f}, {.15f, .48f, .09f}};
    float positions[FACES][6][3];
    facet_primitive_desc walls[FACES];
    facet_material materials[4];
    for (int f = 0; f < FACES; f++) {
        for (int i = 0; i < 6; i++)
            for (int k = 0; k < 3; k++) {
                const float *face = faces[f];
                bool has_first = i == 1 || i == 2 || i == 4;
                bool has_second = i == 2 || i == 4 || i == 5;
                positions[f][i][k] =
                    face[k] + (has_first ? face[3 + k] : 0.0f) + (has_second ? face[6 + k] : 0.0f);
            }
        walls[f] = (facet_primitive_desc){.vertex_count = 6,
                                          .positions = positions[f][0],
                                          .has_material = true,
                                          .material = materials_of[f]};
    }
    for (int m = 0; m < 4; m++) {
        materials[m] = facet_material_default();
        materials[m].metallic = 0.0f;
        for (int k = 0; k < 3; k++) {
            materials[m].base_color[k] = m == LAMP ? 0.0f : colors[m][k];
            materials[m].emissive[k] = m == LAMP ? 1.0f : 0.0f;
        }
    }
    materials[LAMP].emissive_strength = lamp;
    const facet_mesh_desc mesh = {"room", is_closed ? FACES : FACES - 1, walls};
    const facet_arrays_desc arrays = {
        .material_count = 4, .materials = materials, .mesh_count = 1, .meshes = &mesh};
    facet_scene *scene;
    assert_int_equal(facet_scene_create(&arrays, NULL, &scene, NULL), FACET_OK);
    return scene;
}

static const facet_camera INSIDE = {.eye = {0, 0, .95f},
                                    .target = {0, 0, 0},
                                    .up = {0, 1, 0},
                                    .fov_y_rad = 1.4f,
                                    .near_m = .01f,
                                    .far_m = 10};

static double meter(const facet_scene *scene, const facet_render_desc *desc)
{
    facet_renderer *renderer;
    facet_error error = {0};
    double ev100;
    assert_int_equal(facet_renderer_create(scene, NULL, &renderer, NULL), FACET_OK);
    if (facet_renderer_meter(renderer, desc, &ev100, &error) != FACET_OK)
        fail_msg("%s", error.message);
    facet_renderer_destroy(renderer);
    return ev100;
}

/* exp of the mean of ln(luminance). */
static double log_average(const facet_scene *scene, const facet_render_desc *desc)
{
    facet_image *image;
    facet_error error = {0};
    double sum = 0.0;
    if (facet_render(scene, desc, &image, &error) != FACET_OK)
        fail_msg("%s", error.message);
    const facet_image_view view = facet_image_get_layer(image, 0);
    for (uint32_t y = 0; y < view.height; y++) {
        const float *p = (const float *)(const void *)((const char *)view.pixels + y * view.row_stride_bytes);
        for (uint32_t x = 0; x < view.width; x++, p += 4)
            sum += log(fmax(0.2126 * (double)p[0] + 0.7152 * (double)p[1] + 0.0722 * (double)p[2], 1e-4));
    }
    facet_image_destroy(image);
    return exp(sum / ((double)view.width * view.height));
}

/* Within a sixth of a stop of the key, however strong the lamp is and wherever the front is. The preview, which has no light of
 * the lamp on the walls, would leave the strong lamp's walls beyond white. */
static void rooms_are_exposed_for_their_own_light(void **state)
{
    (void)state;
    facet_environment *studio;
    assert_int_equal(facet_environment_create_studio(NULL, &studio, NULL), FACET_OK);
    for (int i = 0; i < 4; i++) {
        const bool is_strong = i / 2;
        facet_scene *room = make_room(is_strong ? 4000.0f : 40.0f, i % 2);
        facet_render_desc desc = {.width = 96,
                                  .height = 96,
                                  .camera = &INSIDE,
                                  .environment = studio,
                                  .renderer = FACET_RENDERER_KIND_PATH,
                                  .samples = IS_SLOW ? 32 : 128,
                                  .meters_exposure = true};
        desc.path.denoises = true;
        assert_near(log2(log_average(room, &desc) / 0.22), 0.0, 1.0 / 6.0);
        const double by_paths = meter(room, &desc);
        desc.renderer = FACET_RENDERER_KIND_PREVIEW;
        desc.samples = 0;
        if (is_strong)
            assert_true(by_paths > meter(room, &desc) + 3.0);
        facet_scene_destroy(room);
    }
    facet_environment_destroy(studio);
}

/* No light of the environment comes into a closed room. */
static void a_closed_room_does_not_meter_the_environment(void **state)
{
    (void)state;
    facet_environment *studio;
    facet_scene *room = make_room(40.0f, true);
    assert_int_equal(facet_environment_create_studio(NULL, &studio, NULL), FACET_OK);
    facet_render_desc desc = {.camera = &INSIDE, .renderer = FACET_RENDERER_KIND_PATH};
    double without = meter(room, &desc);
    desc.environment = studio;
    desc.environment_ev = 6.0f;
    assert_near(meter(room, &desc), without, 0.1);
    facet_environment_destroy(studio);
    facet_scene_destroy(room);
}

/* Threads, seed, samples, crop and part of an image do not change its exposure. */
static void one_view_has_one_exposure(void **state)
{
    (void)state;
    facet_scene *room = make_room(40.0f, false);
    facet_render_desc desc = {.camera = &INSIDE, .renderer = FACET_RENDERER_KIND_PATH, .thread_count = 1};
    double first = meter(room, &desc);
    desc.thread_count = 5;
    desc.samples = 3;
    desc.path.seed = 7;
    desc.path.noise = 0.5f;
    desc.path.shutter_s = 1.0f;
    desc.part = (facet_part_desc){.count = 2, .index = 1, .split = FACET_PART_SPLIT_SAMPLES};
    const uint32_t crop[4] = {10, 20, 30, 40};
    memcpy(desc.crop, crop, sizeof crop);
    double second = meter(room, &desc);
    assert_memory_equal(&first, &second, sizeof first);
    facet_scene_destroy(room);
}

/* The preview's meter has the ambient occlusion of the image: a room is darker with it. */
static void the_preview_meters_its_ambient_occlusion(void **state)
{
    (void)state;
    facet_environment *studio;
    facet_scene *room = make_room(0.0f, true);
    assert_int_equal(facet_environment_create_studio(NULL, &studio, NULL), FACET_OK);
    facet_render_desc desc = {.camera = &INSIDE, .environment = studio};
    double open = meter(room, &desc);
    desc.ambient_occlusion = FACET_AMBIENT_OCCLUSION_ON;
    assert_true(meter(room, &desc) < open - 0.5);
    facet_environment_destroy(studio);
    facet_scene_destroy(room);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rooms_are_exposed_for_their_own_light),
        cmocka_unit_test(a_closed_room_does_not_meter_the_environment),
        cmocka_unit_test(one_view_has_one_exposure),
        cmocka_unit_test(the_preview_meters_its_ambient_occlusion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
