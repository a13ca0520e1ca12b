/* Tests of light on surfaces: furnaces, closed forms, textures, normal maps, opacity. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "cpu/preview_fixture.h"

static void assert_color(const float *color, float r, float g, float b, float tolerance)
{
    if (fabsf(color[0] - r) > tolerance || fabsf(color[1] - g) > tolerance || fabsf(color[2] - b) > tolerance)
        fail_msg("(%g %g %g) instead of (%g %g %g)", (double)color[0], (double)color[1], (double)color[2],
                 (double)r, (double)g, (double)b);
}

static void set_environment(fixture *f, float r, float g, float b)
{
    float radiance[3] = {r, g, b};
    facet_environment_destroy(f->environment);
    assert_int_equal(facet_environment_create_constant(radiance, NULL, &f->environment, NULL), FACET_OK);
}

/* A quad that fills the image. */
static film render_quad(fixture *f, scene_material material)
{
    fixture_place(f, fixture_add_quad(f, fixture_add_material(f, material)), 0, 0, 0, 1.0f);
    return fixture_render(f);
}

/* ---- furnaces ---- */

static void a_white_mirror_shows_its_environment(void **state)
{
    (void)state;
    for (int energy = 0; energy < 2; energy++) {
        fixture f = fixture_create();
        set_environment(&f, 0.5f, 1.0f, 2.0f);
        f.desc.energy = energy ? FACET_ENERGY_CONSERVING : FACET_ENERGY_GLTF;
        f.desc.environment_ev = 1.0f;
        f.desc.exposure_ev = -2.0f;
        scene_material material = scene_material_default();
        material.perceptual_roughness = 0.0f;
        film rendered = render_quad(&f, material);
        assert_color(fixture_pixel(&rendered, "", 30, 30), 0.25f, 0.5f, 1.0f, 2e-3f);
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

/* In the conserving mode a white sphere vanishes in a white room, for every material. */
static void white_vanishes_in_white(void **state)
{
    (void)state;
    for (int i = 0; i < 10; i++) {
        fixture f = fixture_create();
        f.desc.energy = FACET_ENERGY_CONSERVING;
        f.desc.background = FACET_BACKGROUND_ENVIRONMENT;
        scene_material material = scene_material_default();
        material.metallic = (float)(i / 5);
        material.perceptual_roughness = 0.25f * (float)(i % 5);
        fixture_place(&f, fixture_add_sphere(&f, 64, fixture_add_material(&f, material)), 0, 0, 0, 0.9f);
        film rendered = fixture_render(&f);
        for (uint32_t p = 0; p < 64 * 64; p++)
            assert_color(rendered.layers[0].pixels + 4 * p, 1.0f, 1.0f, 1.0f, 1.0f / 255.0f);
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

/* A gltf surface may return more than its irradiance, but boundedly. */
static void the_gltf_mode_stays_near_white(void **state)
{
    (void)state;
    fixture f = fixture_create();
    f.desc.background = FACET_BACKGROUND_ENVIRONMENT;
    scene_material material = scene_material_default();
    material.metallic = 0.0f;
    fixture_place(&f, fixture_add_sphere(&f, 64, fixture_add_material(&f, material)), 0, 0, 0, 0.9f);
    film rendered = fixture_render(&f);
    for (uint32_t p = 0; p < 64 * 64; p++)
        assert_color(rendered.layers[0].pixels + 4 * p, 1.0f, 1.0f, 1.0f, 0.1f);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* ---- lights ---- */

static scene_material lambert(void)
{
    scene_material material = scene_material_default();
    material.metallic = 0.0f;
    material.specular = 0.0f; /* F0 = F90 = 0 */
    return material;
}

static void a_directional_light_on_lambert(void **state)
{
    (void)state;
    fixture f = fixture_create();
    fixture_remove_environment(&f);
    scene_light light = {
        .name = "", .type = SCENE_LIGHT_DIRECTIONAL, .color = {1.0f, 0.5f, 0.25f}, .intensity = 2.0f};
    fixture_add_light(&f, light, 0, 0, 0); /* emits along -Z */
    f.scene->nodes[0].rotation[1] = sinf(0.5f);
    f.scene->nodes[0].rotation[3] = cosf(0.5f); /* 1 rad off */
    film rendered = render_quad(&f, lambert());
    float E = 2.0f * cosf(1.0f) / 3.14159265f;
    assert_color(fixture_pixel(&rendered, "", 10, 50), E, 0.5f * E, 0.25f * E, 1e-5f);
    film_destroy(&rendered);
    f.desc.ignores_scene_lights = true;
    rendered = fixture_render(&f);
    assert_color(fixture_pixel(&rendered, "", 10, 50), 0, 0, 0, 0.0f);
    assert_true(fixture_pixel(&rendered, "", 10, 50)[3] == 1.0f);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

static void a_point_light_falls_off(void **state)
{
    (void)state;
    fixture f = fixture_create();
    fixture_remove_environment(&f);
    scene_light light = {.name = "", .type = SCENE_LIGHT_POINT, .color = {1, 1, 1}, .intensity = 10.0f};
    fixture_add_light(&f, light, 0, 0, 2.0f);
    f.desc.width = f.desc.height = 65; /* a pixel in the middle */
    film rendered = render_quad(&f, lambert());
    float E = 10.0f / 4.0f / 3.14159265f;
    assert_color(fixture_pixel(&rendered, "", 32, 32), E, E, E, 1e-4f);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* ---- textures ---- */

static const unsigned char CHECKER[4 * 4] = {255, 0, 0,   255, 0,   255, 0,   255,
                                             0,   0, 255, 255, 255, 255, 255, 255};

static void an_unlit_surface_is_its_texture(void **state)
{
    (void)state;
    fixture f = fixture_create();
    scene_material material = scene_material_default();
    material.extensions = SCENE_UNLIT;
    material.emissive[0] = 5.0f; /* not used */
    material.base_color[1] = 0.5f;
    material.textures[SCENE_BASE_COLOR_TEXTURE].texture = fixture_add_texture(&f, 2, 2, CHECKER);
    f.scene->textures[0].mag_filter = SCENE_FILTER_NEAREST;
    film rendered = render_quad(&f, material);
    assert_color(fixture_pixel(&rendered, "", 10, 10), 1, 0, 0, 1e-6f);
    assert_color(fixture_pixel(&rendered, "", 50, 10), 0, 0.5f, 0, 1e-6f);
    assert_color(fixture_pixel(&rendered, "", 10, 50), 0, 0, 1, 1e-6f);
    assert_color(fixture_pixel(&rendered, "", 50, 50), 1, 0.5f, 1, 1e-6f);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

static void texture_coordinates_are_transformed(void **state)
{
    (void)state;
    fixture f = fixture_create();
    scene_material material = scene_material_default();
    material.extensions = SCENE_UNLIT;
    material.textures[SCENE_BASE_COLOR_TEXTURE].texture = fixture_add_texture(&f, 2, 2, CHECKER);
    material.textures[SCENE_BASE_COLOR_TEXTURE].has_transform = true;
    memcpy(material.textures[SCENE_BASE_COLOR_TEXTURE].transform, (float[6]){0, 1, 0, 1, 0, 0},
           6 * sizeof(float)); /* u and v swapped */
    f.scene->textures[0].mag_filter = SCENE_FILTER_NEAREST;
    film rendered = render_quad(&f, material);
    assert_color(fixture_pixel(&rendered, "", 50, 10), 0, 0, 1, 1e-6f);
    assert_color(fixture_pixel(&rendered, "", 10, 50), 0, 1, 0, 1e-6f);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

static void vertex_colors_multiply(void **state)
{
    (void)state;
    fixture f = fixture_create();
    scene_material material = scene_material_default();
    material.extensions = SCENE_UNLIT;
    material.base_color[0] = 0.5f;
    uint32_t mesh = fixture_add_quad(&f, fixture_add_material(&f, material));
    static const float colors[16] = {1, 0, 0, 1, 1, 0, 0, 1,
                                     1, 1, 0, 1, 1, 1, 0, 1}; /* green from bottom to top */
    fixture_primitive(&f, mesh)->colors = colors;
    fixture_place(&f, mesh, 0, 0, 0, 1.0f);
    film rendered = fixture_render(&f);
    assert_color(fixture_pixel(&rendered, "", 20, 31), 0.5f, 0.5f + 0.5f / 64.0f, 0, 1e-5f);
    assert_color(fixture_pixel(&rendered, "", 50, 63), 0.5f, 0.5f / 64.0f, 0, 1e-5f);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* A texture far away is its mean: reduced decoding must not be visible. */
static void distant_textures_are_averaged(void **state)
{
    (void)state;
    static unsigned char texels[4 * 256 * 256];
    for (uint32_t i = 0; i < 256 * 256; i++)
        memset(texels + 4 * i, (i % 256 / 4 + i / 256 / 4) % 2 ? 255 : 0, 4);
    for (uint32_t i = 3; i < sizeof texels; i += 4)
        texels[i] = 255;
    fixture f = fixture_create();
    f.camera.ortho_height = 20.0f; /* the quad is 6.4 pixels wide */
    f.desc.aovs = FACET_AOV_ALBEDO;
    scene_material material = scene_material_default();
    material.extensions = SCENE_UNLIT;
    material.textures[SCENE_BASE_COLOR_TEXTURE].texture = fixture_add_texture(&f, 256, 256, texels);
    film rendered = render_quad(&f, material);
    assert_color(fixture_pixel(&rendered, "albedo", 31, 32), 0.5f, 0.5f, 0.5f, 0.01f);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

static void emission_is_added_and_occlusion_dims_the_environment_only(void **state)
{
    (void)state;
    static const unsigned char grey[4] = {128, 128, 128, 255};
    for (int is_occluded = 0; is_occluded < 2; is_occluded++) {
        fixture f = fixture_create();
        f.desc.aovs = FACET_AOV_OCCLUSION;
        scene_light light = {
            .name = "", .type = SCENE_LIGHT_DIRECTIONAL, .color = {1, 1, 1}, .intensity = 3.14159265f};
        fixture_add_light(&f, light, 0, 0, 0);
        scene_material material = lambert();
        material.emissive[2] = 10.0f;
        uint32_t texture = fixture_add_texture(&f, 1, 1, grey);
        if (is_occluded)
            material.textures[SCENE_OCCLUSION_TEXTURE].texture = texture;
        film rendered = render_quad(&f, material);
        float open = is_occluded ? 128.0f / 255.0f : 1.0f;
        assert_color(fixture_pixel(&rendered, "", 5, 5), 1.0f + open, 1.0f + open, 11.0f + open, 5e-3f);
        assert_true(fabsf(*fixture_pixel(&rendered, "occlusion", 5, 5) - open) < 1e-5f);
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

/* ---- normal maps ---- */

static void map_normals(fixture *f, uint32_t mesh, const unsigned char texel[4])
{
    static const float tangents[16] = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
    scene_primitive *p = fixture_primitive(f, mesh);
    p->tangents = tangents;
    f->scene->materials[p->material].textures[SCENE_NORMAL_TEXTURE].texture =
        fixture_add_texture(f, 1, 1, texel);
}

/* N for a texel of (x, y, z), of a quad that is mirrored or seen from behind or neither. */
static void mapped_normal(const unsigned char texel[4], bool is_mirrored, bool from_behind, float N[3])
{
    fixture f = fixture_create();
    scene_material material = scene_material_default();
    material.is_double_sided = true;
    uint32_t mesh = fixture_add_quad(&f, fixture_add_material(&f, material));
    map_normals(&f, mesh, texel);
    scene_node *node = fixture_place(&f, mesh, 0, 0, 0, 1.0f);
    if (is_mirrored)
        node->scale[0] = -1.0f;
    if (from_behind)
        f.camera.eye[2] = -10.0f;
    f.desc.aovs = FACET_AOV_NORMAL;
    film rendered = fixture_render(&f);
    memcpy(N, fixture_pixel(&rendered, "normal", 30, 30), 3 * sizeof(float));
    film_destroy(&rendered);
    fixture_destroy(&f);
}

static void normal_maps_tilt_the_normal(void **state)
{
    (void)state;
    /* 218 and 37 stand for +-0.7: 45 degrees with z = 0.7. */
    static const unsigned char flat[4] = {128, 128, 255, 255};
    static const unsigned char right[4] = {218, 128, 218, 255};
    static const unsigned char up[4] = {128, 218, 218, 255};
    const float d = 0.70711f;
    float N[3];
    mapped_normal(flat, false, false, N);
    assert_color(N, 0, 0, 1, 6e-3f);
    mapped_normal(right, false, false, N);
    assert_color(N, d, 0, d, 6e-3f);
    mapped_normal(up, false, false, N);
    assert_color(N, 0, d, d, 6e-3f);
    /* Mirrored at x: the image's right points to -X, its top still to +Y. */
    mapped_normal(right, true, false, N);
    assert_color(N, -d, 0, d, 6e-3f);
    mapped_normal(up, true, false, N);
    assert_color(N, 0, d, d, 6e-3f);
    /* From behind T, B and N are turned (glTF 2.0, 3.9.6 by the reference renderer). */
    mapped_normal(right, false, true, N);
    assert_color(N, -d, 0, -d, 6e-3f);
    mapped_normal(up, false, true, N);
    assert_color(N, 0, -d, -d, 6e-3f);
}

static void generated_tangents_follow_the_texture(void **state)
{
    (void)state;
    static const unsigned char up[4] = {128, 218, 218, 255};
    fixture f = fixture_create();
    uint32_t mesh = fixture_add_quad(&f, fixture_add_material(&f, scene_material_default()));
    map_normals(&f, mesh, up);
    fixture_primitive(&f, mesh)->tangents = NULL;
    fixture_place(&f, mesh, 0, 0, 0, 1.0f);
    fixture_place(&f, mesh, 0, 0, -1.0f, 1.0f); /* shared by two instances */
    f.desc.aovs = FACET_AOV_NORMAL;
    film rendered = fixture_render(&f);
    assert_color(fixture_pixel(&rendered, "normal", 30, 30), 0, 0.70711f, 0.70711f, 6e-3f);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* ---- opacity ---- */

static void layers_blend_in_any_order(void **state)
{
    (void)state;
    static const int orders[3][3] = {{0, 1, 2}, {2, 1, 0}, {1, 2, 0}};
    for (int i = 0; i < 3; i++) {
        fixture f = fixture_create();
        uint32_t meshes[3];
        for (int k = 0; k < 3; k++) {
            scene_material material = scene_material_default();
            material.extensions = SCENE_UNLIT;
            material.alpha_mode = SCENE_ALPHA_BLEND;
            for (int c = 0; c < 3; c++)
                material.base_color[c] = c == k ? 1.0f : 0.0f;
            material.base_color[3] = 0.25f * (float)(k + 1);
            meshes[k] = fixture_add_quad(&f, fixture_add_material(&f, material));
        }
        for (int k = 0; k < 3; k++) /* mesh 2 is nearest */
            fixture_place(&f, meshes[orders[i][k]], 0, 0, (float)orders[i][k], 1.0f);
        film rendered = fixture_render(&f);
        /* front to back: blue 0.75, green 0.5 of 0.25, red 0.25 of 0.125 */
        for (uint32_t p = 0; p < 64; p++) { /* including the diagonal, where two triangles meet */
            const float *pixel = fixture_pixel(&rendered, "", p, p);
            assert_color(pixel, 0.03125f, 0.125f, 0.75f, 1e-6f);
            assert_true(fabsf(pixel[3] - 0.90625f) < 1e-6f);
            assert_color(fixture_pixel(&rendered, "", p, 63 - p), 0.03125f, 0.125f, 0.75f, 1e-6f);
        }
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

static void coincident_layers_all_count(void **state)
{
    (void)state;
    for (int count = 1; count <= 80; count += 13) {
        fixture f = fixture_create();
        scene_material material = scene_material_default();
        material.extensions = SCENE_UNLIT;
        material.alpha_mode = SCENE_ALPHA_BLEND;
        material.base_color[3] = 0.01f;
        uint32_t mesh = fixture_add_quad(&f, fixture_add_material(&f, material));
        for (int i = 0; i < count && i < FIXTURE_CAPACITY; i++)
            fixture_place(&f, mesh, 0, 0, 0, 1.0f);
        film rendered = fixture_render(&f);
        int layers = count < FIXTURE_CAPACITY ? count : FIXTURE_CAPACITY;
        float expected = 1.0f - powf(0.99f, (float)layers);
        assert_true(fabsf(fixture_pixel(&rendered, "", 31, 31)[3] - expected) < 1e-5f);
        film_destroy(&rendered);
        fixture_destroy(&f);
        if (count >= FIXTURE_CAPACITY)
            break;
    }
}

static void an_opaque_surface_hides_layers_behind_it(void **state)
{
    (void)state;
    for (int is_behind = 0; is_behind < 2; is_behind++) {
        fixture f = fixture_create();
        scene_material glass = scene_material_default();
        glass.extensions = SCENE_UNLIT;
        glass.alpha_mode = SCENE_ALPHA_BLEND;
        glass.base_color[0] = 0.0f;
        glass.base_color[3] = 0.5f;
        scene_material wall = scene_material_default();
        wall.extensions = SCENE_UNLIT;
        wall.base_color[3] = 0.1f; /* of no meaning */
        fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, glass)), 0, 0,
                      is_behind ? -1.0f : 1.0f, 1.0f);
        fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, wall)), 0, 0, 0, 1.0f);
        film rendered = fixture_render(&f);
        const float *pixel = fixture_pixel(&rendered, "", 12, 40);
        assert_color(pixel, is_behind ? 1.0f : 0.5f, 1.0f, 1.0f, 1e-6f);
        assert_true(pixel[3] == 1.0f);
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

/* Alpha grows from 0 to 1 over the width: left of the cutoff there is no surface. */
static void masks_cut_at_the_cutoff(void **state)
{
    (void)state;
    static const float colors[16] = {1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 0, 1, 1, 1, 1};
    static const float cutoffs[] = {0.25f, 0.5f, 0.8f};
    for (int i = 0; i < 3; i++) {
        fixture f = fixture_create();
        f.desc.samples = 16;
        scene_material material = scene_material_default();
        material.alpha_mode = SCENE_ALPHA_MASK;
        material.alpha_cutoff = cutoffs[i];
        uint32_t mesh = fixture_add_quad(&f, fixture_add_material(&f, material));
        fixture_primitive(&f, mesh)->colors = colors;
        fixture_place(&f, mesh, 0, 0, 0, 1.0f);
        film rendered = fixture_render(&f);
        float row = 0.0f;
        for (uint32_t x = 0; x < 64; x++)
            row += fixture_pixel(&rendered, "", x, 20)[3];
        assert_true(fabsf(row - 64.0f * (1.0f - cutoffs[i])) < 0.1f);
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

/* Over nothing, every pixel is its surface's color times its alpha: no fringe. */
static void edges_are_premultiplied(void **state)
{
    (void)state;
    fixture f = fixture_create();
    scene_material material = scene_material_default();
    material.extensions = SCENE_UNLIT;
    material.base_color[1] = 0.5f;
    material.base_color[2] = 0.125f;
    fixture_place(&f, fixture_add_sphere(&f, 100, fixture_add_material(&f, material)), 0, 0, 0, 0.9f);
    film rendered = fixture_render(&f);
    int edges = 0;
    for (uint32_t p = 0; p < 64 * 64; p++) {
        const float *pixel = rendered.layers[0].pixels + 4 * p;
        assert_color(pixel, pixel[3], 0.5f * pixel[3], 0.125f * pixel[3], 1e-6f);
        edges += pixel[3] > 0.0f && pixel[3] < 1.0f;
    }
    assert_true(edges > 100);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_white_mirror_shows_its_environment),
        cmocka_unit_test(white_vanishes_in_white),
        cmocka_unit_test(the_gltf_mode_stays_near_white),
        cmocka_unit_test(a_directional_light_on_lambert),
        cmocka_unit_test(a_point_light_falls_off),
        cmocka_unit_test(an_unlit_surface_is_its_texture),
        cmocka_unit_test(texture_coordinates_are_transformed),
        cmocka_unit_test(vertex_colors_multiply),
        cmocka_unit_test(distant_textures_are_averaged),
        cmocka_unit_test(emission_is_added_and_occlusion_dims_the_environment_only),
        cmocka_unit_test(normal_maps_tilt_the_normal),
        cmocka_unit_test(generated_tangents_follow_the_texture),
        cmocka_unit_test(layers_blend_in_any_order),
        cmocka_unit_test(coincident_layers_all_count),
        cmocka_unit_test(an_opaque_surface_hides_layers_behind_it),
        cmocka_unit_test(masks_cut_at_the_cutoff),
        cmocka_unit_test(edges_are_premultiplied),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
