/* texture_frame_test.c - normals and stretched highlights turn with their textures (KHR_texture_transform): a
 * transformed texture looks as it does with the transform in the texture coordinates. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "cpu/preview_fixture.h"

enum { EDGE = 32 };

/* A relief of waves: normals lean to both sides along x and along y, and differently so. As a texture of
 * anisotropy: directions all around, strength around 0.9. */
static uint32_t add_relief(fixture *f)
{
    static unsigned char rgba[4 * EDGE * EDGE];
    for (int i = 0; i < EDGE * EDGE; i++) {
        double x = (i % EDGE + 0.5) / EDGE, y = ((double)(i / EDGE) + 0.5) / EDGE;
        rgba[4 * i] = (unsigned char)lrint(127.5 + 60.0 * sin(6.2831853 * x + 0.5));
        rgba[4 * i + 1] = (unsigned char)lrint(127.5 + 50.0 * sin(12.566371 * y + 2.0 * x));
        rgba[4 * i + 2] = 230;
        rgba[4 * i + 3] = 255;
    }
    return fixture_add_texture(f, EDGE, EDGE, rgba);
}

static scene_material relief_material(scene_texture_slot slot)
{
    scene_material m = scene_material_default();
    m.perceptual_roughness = 0.4f;
    if (slot == SCENE_CLEARCOAT_NORMAL_TEXTURE) {
        m.extensions = SCENE_CLEARCOAT;
        m.metallic = m.base_color[0] = m.base_color[1] = m.base_color[2] = 0.0f;
        m.clearcoat = 1.0f;
        m.clearcoat_roughness = 0.3f;
    }
    if (slot == SCENE_ANISOTROPY_TEXTURE) {
        m.extensions = SCENE_ANISOTROPY;
        m.anisotropy = 0.9f;
        m.anisotropy_rotation = 0.3f;
    }
    return m;
}

typedef struct variant {
    scene_texture_slot slot;
    float rotation, scale[2];
    bool has_tangents; /* of the file, for the untransformed coordinates */
} variant;

/* The coordinates of the quad, transformed as by ref. */
static void transform_coordinates(const scene_primitive *p, const scene_texture_ref *ref, float out[8])
{
    for (uint32_t i = 0; i < 4; i++)
        for (int k = 0; k < 2; k++) {
            const float *row = ref->transform + 3 * k, *uv = p->texcoords[0] + 2 * (size_t)i;
            out[2 * i + (uint32_t)k] = row[0] * uv[0] + row[1] * uv[1] + row[2];
        }
}

/* Of a quad under a light from the upper right. in_coordinates: the transform is applied to the vertices, whose
 * tangents are generated. */
static film render_relief(const variant *v, bool in_coordinates)
{
    static const float tangents[16] = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
    fixture f = fixture_create();
    fixture_remove_environment(&f);
    scene_light light = {.name = "", .type = SCENE_LIGHT_POINT, .color = {1, 1, 1}, .intensity = 30.0f};
    fixture_add_light(&f, light, 3.0f, 1.0f, 3.0f);
    scene_material m = relief_material(v->slot);
    scene_texture_ref *ref = &m.textures[v->slot];
    ref->texture = add_relief(&f);
    ref->rotation_rad = v->rotation;
    ref->scale[0] = v->scale[0];
    ref->scale[1] = v->scale[1];
    ref->offset[0] = 0.2f;
    scene_texture_ref_update(ref);
    scene_texture_ref transformed = *ref;
    if (in_coordinates)
        *ref = (scene_texture_ref){.texture = ref->texture, .scale = {1.0f, 1.0f}};
    uint32_t mesh = fixture_add_quad(&f, fixture_add_material(&f, m));
    scene_primitive *p = fixture_primitive(&f, mesh);
    float uvs[8];
    const float *sets[1] = {uvs};
    transform_coordinates(p, &transformed, uvs);
    if (in_coordinates)
        p->texcoords = sets;
    else
        p->tangents = v->has_tangents ? tangents : NULL;
    fixture_place(&f, mesh, 0, 0, 0, 1.0f);
    film rendered = fixture_render(&f);
    fixture_destroy(&f);
    return rendered;
}

/* The largest difference of channels, over the largest channel. */
static double difference(const film *a, const film *b)
{
    double largest = 0.0, highest = 0.0;
    for (size_t i = 0; i < 4 * (size_t)a->width * a->height; i++) {
        double x = (double)a->layers[0].pixels[i], y = (double)b->layers[0].pixels[i];
        largest = fmax(largest, fabs(x - y));
        highest = fmax(highest, i % 4 < 3 ? x : 0.0);
    }
    assert_true(highest > 0.1);
    return largest / highest;
}

static void textures_turn_with_their_coordinates(void **state)
{
    (void)state;
    static const scene_texture_slot slots[] = {SCENE_NORMAL_TEXTURE, SCENE_CLEARCOAT_NORMAL_TEXTURE,
                                               SCENE_ANISOTROPY_TEXTURE};
    static const float transforms[][3] = {{1.5707963f, 1.0f, 1.0f}, {0.6f, 1.0f, 1.0f},
                                          {0.0f, -1.0f, 1.0f},      {0.0f, 1.0f, -1.0f},
                                          {-2.0f, -1.5f, 1.0f},     {3.1415927f, 1.0f, 2.0f}};
    for (int i = 0; i < 36; i++) {
        const float *t = transforms[i / 6];
        variant v = {slots[i % 3], t[0], {t[1], t[2]}, i % 6 < 3};
        film expected = render_relief(&v, true), found = render_relief(&v, false);
        double d = difference(&expected, &found);
        if (!(d < 1e-3))
            fail_msg("slot %d, rotation %g, scale %g %g, %s tangents: images differ by %g", (int)v.slot,
                     (double)t[0], (double)t[1], (double)t[2], v.has_tangents ? "supplied" : "generated", d);
        film_destroy(&expected);
        film_destroy(&found);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(textures_turn_with_their_coordinates)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
