/* material_test.c - glTF's rules for factors and texels: neutral texels change nothing, channels are correct,
 * frames follow their side. */
#include "testing/test_support.h"

static const vec3 white = {1.0f, 1.0f, 1.0f};

static void expect_vec(vec3 v, double x, double y, double z, const char *what)
{
    expect_near((double)v[0], x, 1e-6, "%s, x", what);
    expect_near((double)v[1], y, 1e-6, "%s, y", what);
    expect_near((double)v[2], z, 1e-6, "%s, z", what);
}

static Layers plain(float metallic)
{
    return layers_from_surface(
        surface_from_metallic_roughness(vec3(0.0f, 0.0f, 1.0f), vec3(0.5f), metallic, 0.4f));
}

static void test_coverage(void **state)
{
    (void)state;
    assert_true(material_coverage(ALPHA_MODE_OPAQUE, 0.2f, 0.5f) == 1.0f);
    assert_true(material_coverage(ALPHA_MODE_MASK, 0.5f, 0.5f) == 1.0f); /* "greater than or equal" */
    assert_true(material_coverage(ALPHA_MODE_MASK, 0.499f, 0.5f) == 0.0f);
    assert_true(material_coverage(ALPHA_MODE_BLEND, 0.3f, 0.5f) == 0.3f);
    assert_true(material_coverage(ALPHA_MODE_BLEND, 1.5f, 0.5f) == 1.0f);
}

/* The matrix of KHR_texture_transform's example: offset, rotation by 90 degrees, scale. */
static void test_texcoords(void **state)
{
    (void)state;
    vec2 uv = texcoord_transform(vec2(0.25f, 0.5f), vec3(0.0f, 3.0f, 0.1f), vec3(-2.0f, 0.0f, 0.2f));
    expect_near((double)uv[0], 1.6, 1e-6, "u");
    expect_near((double)uv[1], -0.3, 1e-6, "v");
}

/* Green roughness, blue metallic, red occlusion with its strength, alpha specular, RGB specular color and
 * emissive. */
static void test_surface_channels(void **state)
{
    (void)state;
    MaterialFactors f = {.metallic = 0.5f,
                         .perceptual_roughness = 0.8f,
                         .ior = 1.5f,
                         .specular = 0.6f,
                         .specular_color = vec3(1.0f, 0.5f, 0.25f),
                         .glossiness = 0.7f,
                         .occlusion_strength = 0.5f,
                         .emissive = vec3(2.0f, 4.0f, 6.0f)};
    vec3 N = vec3(0.0f, 0.0f, 1.0f);
    Surface s = material_surface(f, N, vec3(0.3f), vec3(9.0f, 0.5f, 0.2f), 0.4f, vec3(0.5f, 0.25f, 0.0f),
                                 0.5f, vec3(0.2f, 0.4f, 0.8f));
    expect_near((double)s.perceptual_roughness, 0.4, 1e-6, "roughness");
    expect_near((double)s.metallic, 0.1, 1e-6, "metallic");
    expect_near((double)s.occlusion, 0.7, 1e-6, "occlusion");
    expect_near((double)s.F90, 0.3, 1e-6, "specular");
    expect_vec(s.F0, 0.04 * 0.2 * 0.3, 0.04 * 0.2 * 0.3, 0.04 * 0.2 * 0.3, "F0");
    expect_vec(s.emissive, 1.0, 1.0, 0.0, "emissive");
    s = material_surface_glossy(f, N, vec3(0.3f), vec3(0.5f), 0.5f, 1.0f, white);
    expect_near((double)s.perceptual_roughness, 0.65, 1e-6, "glossiness");
    expect_vec(s.F0, 0.5, 0.25, 0.125, "specular color");
    assert_true(s.metallic == 0.0f && s.occlusion == 1.0f);
}

/* Factors of 0 enable no layer, whatever the texel; nor do texels of 0. Metals do not transmit. */
static void test_layers_are_there_or_not(void **state)
{
    (void)state;
    for (int i = 0; i < 3; ++i) {
        float factor = i == 0 ? 0.0f : 0.5f;
        vec3 texel = i == 1 ? vec3(0.0f) : white;
        uint none = i < 2 ? 0u : 0xffffffffu;
        Layers m = with_clearcoat(plain(0.0f), factor, 0.3f, texel, white);
        assert_int_equal(m.layers, LAYER_CLEARCOAT & none);
        assert_int_equal(with_sheen(plain(0.0f), vec3(factor), 0.5f, texel, 1.0f).layers, LAYER_SHEEN & none);
        m = with_iridescence(plain(0.0f), factor, 1.3f, 100.0f, 400.0f, texel, white);
        assert_int_equal(m.layers, LAYER_IRIDESCENCE & none);
        assert_int_equal(with_transmission(plain(0.0f), factor, texel).layers, LAYER_TRANSMISSION & none);
        m = with_diffuse_transmission(plain(0.0f), factor, white, texel[0], white);
        assert_int_equal(m.layers, LAYER_DIFFUSE_TRANSMISSION & none);
        assert_int_equal(with_transmission(plain(1.0f), factor, texel).layers, 0);
        assert_int_equal(with_diffuse_transmission(plain(1.0f), factor, white, 1.0f, white).layers, 0);
    }
    Layers opaque = with_volume(plain(0.0f), 1.0f, white, white, 1.0f, 0.5f);
    assert_int_equal(opaque.layers, 0); /* no transmission */
    Layers glass = with_ior(with_transmission(plain(0.0f), 1.0f, white), 1.5f, true);
    expect_near((double)glass.eta, 1.0 / 1.5, 1e-6, "seen from inside");
    glass = with_volume(glass, 0.2f, vec3(0.0f, 0.5f, 0.0f), vec3(0.9f), 2.0f, 0.5f);
    assert_int_equal(glass.layers, LAYER_TRANSMISSION | LAYER_VOLUME | LAYER_DISPERSION);
    expect_near((double)glass.thickness, 0.1, 1e-6, "thickness: green");
    assert_int_equal(with_scatter(glass, vec3(0.0f), 0.1f).layers, glass.layers);
    assert_int_equal(with_scatter(glass, vec3(0.3f), 0.1f).layers, glass.layers | LAYER_SCATTER);
    assert_int_equal(with_scatter(plain(0.0f), vec3(0.3f), 0.1f).layers, 0);
}

static void test_layer_channels(void **state)
{
    (void)state;
    vec3 texel = vec3(0.2f, 0.4f, 0.8f);
    Layers m = with_clearcoat(plain(0.0f), 0.5f, 0.5f, texel, texel);
    expect_near((double)m.clearcoat, 0.1, 1e-6, "clearcoat: red");
    expect_near((double)m.clearcoat_roughness, 0.2, 1e-6, "its roughness: green");
    m = with_iridescence(plain(0.0f), 0.5f, 0.7f, 100.0f, 600.0f, texel, texel);
    expect_near((double)m.iridescence, 0.1, 1e-6, "iridescence: red");
    expect_near((double)m.iridescence_thickness_nm, 300.0, 1e-3, "thickness: green");
    expect_near((double)m.iridescence_ior, 1.0, 1e-6, "ior at least 1");
    expect_near((double)anisotropy_strength(0.5f, texel), 0.4, 1e-6, "anisotropy: blue");
    vec2 d = anisotropy_texel_direction(vec3(0.5f, 1.0f, 0.0f));
    expect_near((double)d[0], 0.0, 1e-6, "red");
    expect_near((double)d[1], 1.0, 1e-6, "green");
    d = anisotropy_texel_direction(white);
    assert_true(d[0] == 1.0f && d[1] == 0.0f);
    d = anisotropy_texel_direction(vec3(0.5f));
    assert_true(d[0] == 1.0f && d[1] == 0.0f);
}

/* u to the right, v down in an upright image facing +Z: T right, B up, and mirrored with the side. */
static void test_frames(void **state)
{
    (void)state;
    vec3 N = vec3(0.0f, 0.0f, 1.0f), e1 = vec3(2.0f, 0.0f, 0.0f), e2 = vec3(0.0f, 3.0f, 0.0f);
    ShadingFrame f = frame_from_texcoord(N, e1, e2, vec2(1.0f, 0.0f), vec2(0.0f, -1.0f), 1.0f);
    assert_true(frame_has_tangent(f));
    expect_vec(f.T, 1.0, 0.0, 0.0, "T");
    expect_vec(f.B, 0.0, 1.0, 0.0, "B");
    ShadingFrame same = frame_from_tangent(N, vec3(1.0f, 0.0f, 0.0f), 1.0f, 1.0f);
    expect_vec(same.B - f.B, 0.0, 0.0, 0.0, "the same frame");
    ShadingFrame back = frame_from_texcoord(-N, e1, e2, vec2(1.0f, 0.0f), vec2(0.0f, -1.0f), -1.0f);
    expect_vec(back.T, -1.0, 0.0, 0.0, "T of the back");
    expect_vec(back.B, 0.0, -1.0, 0.0, "B of the back");
    back = frame_from_tangent(-N, vec3(1.0f, 0.0f, 0.0f), 1.0f, -1.0f);
    expect_vec(back.T, -1.0, 0.0, 0.0, "tangent of the back");
    expect_vec(back.B, 0.0, -1.0, 0.0, "bitangent of the back");
    ShadingFrame mirrored = frame_from_texcoord(N, e1, e2, vec2(-1.0f, 0.0f), vec2(0.0f, -1.0f), 1.0f);
    expect_vec(mirrored.T, -1.0, 0.0, 0.0, "T of a mirrored picture");
    expect_vec(mirrored.B, 0.0, 1.0, 0.0, "B of a mirrored picture");
    vec2 line = vec2(0.5f, 0.5f);
    assert_false(frame_has_tangent(frame_from_texcoord(N, e1, e2, line, line, 1.0f)));
}

/* Rotations and scales of KHR_texture_transform; T and B in the frame of the untransformed coordinates of a
 * square, which faces +Z with u to the right and v down: computed in double from the gradients of the
 * transformed coordinates. */
static const struct {
    const char *what;
    double rotation, scale[2], T[2], B[2];
} turned_frames[] = {
    {"unchanged", 0.0, {1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}},
    {"90 degrees", 1.57079632679, {1.0, 1.0}, {0.0, -1.0}, {1.0, 0.0}},
    {"180 degrees", 3.14159265359, {1.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}},
    {"45 degrees",
     0.785398163397,
     {1.0, 1.0},
     {0.707106781187, -0.707106781187},
     {0.707106781187, 0.707106781187}},
    {"30 degrees, twice as dense along u",
     0.523598775598,
     {2.0, 1.0},
     {0.654653670708, -0.755928946018},
     {0.755928946018, 0.654653670708}},
    {"mirrored u", 0.0, {-1.0, 1.0}, {-1.0, 0.0}, {0.0, 1.0}},
    {"mirrored v", 0.0, {1.0, -2.0}, {1.0, 0.0}, {0.0, -1.0}},
    {"90 degrees, mirrored u", 1.57079632679, {-1.0, 1.0}, {0.0, -1.0}, {-1.0, 0.0}},
    {"singular", 1.57079632679, {0.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}},
};

/* Frames turn with the textures: by the closed form, and like the frame of the transformed coordinates. */
static void test_frames_of_transformed_textures(void **state)
{
    (void)state;
    vec3 N = vec3(0.0f, 0.0f, 1.0f), e1 = vec3(1.0f, 0.0f, 0.0f), e2 = vec3(0.3f, -1.0f, 0.0f);
    vec2 uv1 = vec2(1.0f, 0.0f), uv2 = vec2(0.3f, 1.0f);
    for (size_t i = 0; i < sizeof turned_frames / sizeof *turned_frames; ++i) {
        double c = cos(turned_frames[i].rotation), s = sin(turned_frames[i].rotation);
        const double *scale = turned_frames[i].scale, *T = turned_frames[i].T, *B = turned_frames[i].B;
        vec3 row_u = vec3((float)(c * scale[0]), (float)(s * scale[1]), 0.3f);
        vec3 row_v = vec3((float)(-s * scale[0]), (float)(c * scale[1]), 0.2f);
        for (int side = -1; side <= 1; side += 2) {
            ShadingFrame f = frame_from_texcoord(N * (float)side, e1, e2, uv1, uv2, (float)side);
            ShadingFrame turned = frame_transformed(f, row_u, row_v);
            expect_vec(turned.T, side * T[0], side * T[1], 0.0, turned_frames[i].what);
            expect_vec(turned.B, side * B[0], side * B[1], 0.0, turned_frames[i].what);
            assert_true(turned.N[2] == (float)side);
            if (scale[0] == 0.0)
                continue;
            vec3 no_offset = vec3(1.0f, 1.0f, 0.0f);
            vec2 changes[2] = {texcoord_transform(uv1, row_u * no_offset, row_v * no_offset),
                               texcoord_transform(uv2, row_u * no_offset, row_v * no_offset)};
            f = frame_from_texcoord(N * (float)side, e1, e2, changes[0], changes[1], (float)side);
            expect_vec(f.T, side * T[0], side * T[1], 0.0, turned_frames[i].what);
            expect_vec(f.B, side * B[0], side * B[1], 0.0, turned_frames[i].what);
        }
    }
}

/* A rotation by 90 degrees of a texel that leans to the right: the normal leans down. */
static void test_a_turned_normal_texture(void **state)
{
    (void)state;
    ShadingFrame f = frame_from_tangent(vec3(0.0f, 0.0f, 1.0f), vec3(1.0f, 0.0f, 0.0f), 1.0f, 1.0f);
    f = frame_transformed(f, vec3(0.0f, 1.0f, 0.0f), vec3(-1.0f, 0.0f, 1.0f));
    vec3 n = normal_from_texel(vec3(0.8f, 0.5f, 0.9f), 1.0f);
    expect_vec(frame_normal(f, n, vec3(0.0f)), 0.0, -0.6, 0.8, "shading normal");
}

static void test_normals(void **state)
{
    (void)state;
    ShadingFrame f = frame_from_tangent(vec3(0.0f, 0.0f, 2.0f), vec3(1.0f, 0.0f, 0.0f), 1.0f, 1.0f);
    f.B = vec3(0.0f, 1.0f, 0.0f);
    f.N = vec3(0.0f, 0.0f, 1.0f);
    vec3 fallback = vec3(1.0f, 0.0f, 0.0f);
    expect_vec(frame_normal(f, normal_from_texel(vec3(0.5f, 0.5f, 1.0f), 3.0f), fallback), 0.0, 0.0, 1.0,
               "flat");
    vec3 n = normal_from_texel(vec3(0.8f, 0.5f, 0.9f), 0.5f);
    expect_vec(n, 0.3, 0.0, 0.8, "scaled in the plane only");
    expect_vec(normal_from_texel(white, 1.0f), 0.0, 0.0, 0.0, "no normal");
    expect_vec(frame_normal(f, vec3(0.0f), fallback), 1.0, 0.0, 0.0, "otherwise");
    expect_vec(normalize_or(vec3(0.0f, 3.0f, 4.0f), fallback), 0.0, 0.6, 0.8, "unit");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_coverage),
                                       cmocka_unit_test(test_texcoords),
                                       cmocka_unit_test(test_surface_channels),
                                       cmocka_unit_test(test_layers_are_there_or_not),
                                       cmocka_unit_test(test_layer_channels),
                                       cmocka_unit_test(test_frames),
                                       cmocka_unit_test(test_frames_of_transformed_textures),
                                       cmocka_unit_test(test_a_turned_normal_texture),
                                       cmocka_unit_test(test_normals)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
