/* ogl1_fixture.c - see ogl1_fixture.h. */
#include "cpu/ogl1_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "film/film_image.h"

scene_legacy *ogl1_fixture_legacy(fixture *f)
{
    scene_legacy *legacy = arena_zalloc(f->scene->arena, 1, sizeof *legacy);
    assert_non_null(legacy);
    legacy->materials = arena_zalloc(f->scene->arena, FIXTURE_CAPACITY, sizeof *legacy->materials);
    legacy->lights = arena_zalloc(f->scene->arena, 8, sizeof *legacy->lights);
    assert_non_null(legacy->materials);
    assert_non_null(legacy->lights);
    for (int i = 0; i < FIXTURE_CAPACITY; i++)
        legacy->materials[i] = legacy_material_default();
    legacy->fog.scale = 1.0f;
    legacy->colors = FACET_LEGACY_COLORS_SRGB;
    legacy->dialect = FACET_MTL_DIALECT_SPEC;
    f->scene->legacy = legacy;
    return legacy;
}

void ogl1_fixture_camera(fixture *f)
{
    facet_environment_destroy(f->environment);
    f->environment = NULL;
    f->camera = (facet_camera){.eye = {1.5f, 1.0f, 3.0f}, .fov_y_rad = 0.7f};
    f->desc.samples = 1;
    f->desc.shading = FACET_SHADING_OGL1;
}

fixture ogl1_fixture_head_on(scene_legacy **legacy)
{
    fixture f = fixture_create();
    ogl1_fixture_camera(&f);
    f.camera = (facet_camera){.eye = {0.0f, 0.0f, 10.0f}, .ortho_height = 2.0f};
    f.desc.width = f.desc.height = 8;
    *legacy = ogl1_fixture_legacy(&f);
    (*legacy)->light_count = 1;
    (*legacy)->lights[0] = (legacy_light){.is_viewpoint_relative = true,
                                          .position = {0, 0, 1},
                                          .ambient = {1, 1, 1},
                                          .diffuse = {1, 1, 1},
                                          .specular = {1, 1, 1}};
    return f;
}

/* ---- vectors ---- */

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static void normalize3(double a[3])
{
    double length = sqrt(dot3(a, a));
    for (int i = 0; i < 3; i++)
        a[i] /= length;
}
static void cross3(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

double ogl1_decode(double x)
{
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}
double ogl1_encode(double x)
{
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
}

/* ---- the camera ---- */

typedef struct view {
    double eye[3], axis[3][3]; /* right, up, backward */
} view;

static view view_of(const facet_camera *c)
{
    view v;
    double up[3] = {0.0, 1.0, 0.0};
    for (int i = 0; i < 3; i++) {
        v.eye[i] = (double)c->eye[i];
        v.axis[2][i] = (double)c->eye[i] - (double)c->target[i];
    }
    normalize3(v.axis[2]);
    cross3(up, v.axis[2], v.axis[0]);
    normalize3(v.axis[0]);
    cross3(v.axis[2], v.axis[0], v.axis[1]);
    return v;
}

static void to_eye(const view *v, const double p[3], double w, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = dot3(v->axis[i], p) - w * dot3(v->axis[i], v->eye);
}

/* ---- light ---- */

/* Color of a point in eye space with its normal, by one of the pipelines. */
static void light_point(const ogl1_quad *q, const view *v, const double P[3], const double normal[3],
                        const double diffuse[3], bool is_front, double rgb[3])
{
    bool is_fixed = q->variant == FACET_OGL1_VARIANT_FIXED || q->variant == FACET_OGL1_VARIANT_RGL_DESKTOP;
    double V[3] = {-P[0], -P[1], -P[2]};
    normalize3(V);
    double N[3] = {normal[0], normal[1], normal[2]};
    normalize3(N);
    bool turns = (q->variant == FACET_OGL1_VARIANT_VIGNETTE && dot3(N, V) < 0.0) ||
                 (q->variant == FACET_OGL1_VARIANT_WEBGL && N[2] < 0.0) ||
                 (q->variant == FACET_OGL1_VARIANT_RGL_DESKTOP && !is_front);
    for (int i = 0; i < 3; i++)
        N[i] = turns ? -N[i] : N[i];
    for (int c = 0; c < 3; c++)
        rgb[c] = q->emission[c] + q->global_ambient * q->ambient[c];
    for (uint32_t k = 0; k < q->light_count; k++) {
        const legacy_light *l = &q->lights[k];
        double position[3] = {(double)l->position[0], (double)l->position[1], (double)l->position[2]};
        double L[3] = {position[0], position[1], position[2]};
        if (!l->is_viewpoint_relative)
            to_eye(v, position, l->is_point ? 1.0 : q->direction_w, L);
        if (l->is_point) {
            for (int i = 0; i < 3; i++)
                L[i] -= P[i];
            normalize3(L);
        }
        double H[3];
        for (int i = 0; i < 3; i++)
            H[i] = L[i] + (q->variant == FACET_OGL1_VARIANT_FIXED ? (i == 2) : V[i]);
        normalize3(H);
        double NL = dot3(N, L);
        double lobe = pow(fmax(dot3(N, H), 0.0), q->shininess);
        if (is_fixed && NL <= 0.0)
            lobe = 0.0;
        for (int c = 0; c < 3; c++)
            rgb[c] += q->ambient[c] * (double)l->ambient[c] +
                      fmax(NL, 0.0) * diffuse[c] * (double)l->diffuse[c] +
                      lobe * q->specular[c] * (double)l->specular[c];
    }
}

static double fog_share(const ogl1_quad *q, double d)
{
    double scale = (double)q->fog.scale;
    double c = (d - q->near_m) / (q->far_m - q->near_m);
    double c2 = q->fog_w * (1.0 - c) + c;
    if (q->variant >= FACET_OGL1_VARIANT_FIXED)
        c2 = d / q->far_m;
    double f = scale * c;
    if (q->fog.mode == LEGACY_FOG_EXP)
        f = 1.0 - exp(-scale * c2);
    if (q->fog.mode == LEGACY_FOG_EXP2)
        f = 1.0 - exp(-pow(scale * c2, 2.0));
    return q->fog.mode == LEGACY_FOG_NONE ? 0.0 : fmin(fmax(f, 0.0), 1.0);
}

/* ---- the quad ---- */

static const double corners[4][3] = {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}};

/* Intersection of a pixel's ray with z = 0: vertices of the triangle, and weights. */
static bool hit(const ogl1_quad *q, const view *v, uint32_t x, uint32_t y, int vertex[3], double weight[3])
{
    double pixel = 2.0 * tan(0.5 * (double)q->camera.fov_y_rad) / q->size;
    double X = ((double)x + 0.5 - 0.5 * q->size) * pixel;
    double Y = -((double)y + 0.5 - 0.5 * q->size) * pixel;
    double d[3];
    for (int i = 0; i < 3; i++)
        d[i] = v->axis[0][i] * X + v->axis[1][i] * Y - v->axis[2][i];
    double t = -v->eye[2] / d[2];
    double px = v->eye[0] + t * d[0];
    double py = v->eye[1] + t * d[1];
    if (!(t > 0.0) || fabs(px) >= 0.999 || fabs(py) >= 0.999)
        return false;
    bool is_first = px + py < 0.0;
    static const int triangles[2][3] = {{0, 1, 2}, {2, 1, 3}};
    memcpy(vertex, triangles[!is_first], sizeof triangles[0]);
    if (is_first) {
        weight[1] = 0.5 * (px + 1.0);
        weight[2] = 0.5 * (py + 1.0);
    } else {
        weight[1] = 0.5 * (1.0 - py);
        weight[2] = 0.5 * (px + py);
    }
    weight[0] = 1.0 - weight[1] - weight[2];
    return true;
}

static void interpolate(const double values[4][3], const int vertex[3], const double weight[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = values[vertex[0]][i] * weight[0] + values[vertex[1]][i] * weight[1] +
                 values[vertex[2]][i] * weight[2];
}

static double clamp_unit(double x)
{
    return fmin(fmax(x, 0.0), 1.0);
}

/* The whole pipeline at weights of a triangle, up to fog. */
static void shade(const ogl1_quad *q, const view *v, const int vertex[3], const double weight[3],
                  double rgb[3])
{
    static const double face[3] = {0.0, 0.0, 1.0};
    double p[3], n[3], P[3], N[3], c[3];
    interpolate(corners, vertex, weight, p);
    interpolate(q->normals, vertex, weight, n);
    interpolate(q->colors, vertex, weight, c);
    to_eye(v, p, 1.0, P);
    to_eye(v, q->is_flat ? face : n, 0.0, N);
    light_point(q, v, P, N, q->has_colors ? c : q->diffuse, v->eye[2] > 0.0, rgb);
}

bool ogl1_quad_color(const ogl1_quad *q, uint32_t x, uint32_t y, double rgb[3])
{
    view v = view_of(&q->camera);
    int vertex[3];
    double weight[3];
    if (!hit(q, &v, x, y, vertex, weight))
        return false;
    if (q->variant < FACET_OGL1_VARIANT_FIXED) {
        shade(q, &v, vertex, weight, rgb);
    } else {
        rgb[0] = rgb[1] = rgb[2] = 0.0;
        for (int k = 0; k < 3; k++) {
            const double one[3] = {k == 0, k == 1, k == 2};
            double at_corner[3];
            shade(q, &v, vertex, one, at_corner);
            double share = q->is_flat ? (double)(k == 2) : weight[k];
            for (int c = 0; c < 3; c++)
                rgb[c] += share * (q->is_linear ? at_corner[c] : clamp_unit(at_corner[c]));
        }
    }
    double p[3], P[3];
    interpolate(corners, vertex, weight, p);
    to_eye(&v, p, 1.0, P);
    double f = fog_share(q, -P[2]);
    for (int c = 0; c < 3; c++) {
        rgb[c] += ((double)q->fog.color[c] - rgb[c]) * f;
        rgb[c] = q->is_linear ? rgb[c] : clamp_unit(rgb[c]);
    }
    return true;
}

/* ---- comparison ---- */

/* Whether the nearest of 255 codes is ambiguous within the error of floats. */
static bool is_between_codes(double value)
{
    double part = value * 255.0 - floor(value * 255.0);
    return fabs(part - 0.5) < 255.0 * 2e-5;
}

void ogl1_quad_check(fixture *f, const ogl1_quad *q, uint32_t least, const char *what)
{
    film rendered = fixture_render(f);
    image codes;
    assert_int_equal(film_to_display_image(&rendered, IMAGE_U8, true, NULL, 1, &codes, NULL), FACET_OK);
    uint32_t count = 0;
    for (uint32_t y = 0; y < q->size; y++)
        for (uint32_t x = 0; x < q->size; x++) {
            double rgb[3];
            const float *pixel = fixture_pixel(&rendered, "", x, y);
            if (!ogl1_quad_color(q, x, y, rgb))
                continue;
            count++;
            assert_true(pixel[3] == 1.0f);
            for (int c = 0; c < 3; c++) {
                double value = q->is_linear ? (double)pixel[c] : ogl1_encode((double)pixel[c]);
                if (!(fabs(value - rgb[c]) <= 2e-5 * fmax(1.0, rgb[c])))
                    fail_msg("%s: pixel (%u, %u), channel %d: %.8g instead of %.8g", what, x, y, c, value,
                             rgb[c]);
                const unsigned char *code =
                    (const unsigned char *)codes.pixels + codes.channel_count * ((size_t)y * q->size + x);
                double shown = q->is_linear ? ogl1_encode(clamp_unit(rgb[c])) : rgb[c];
                if (!is_between_codes(shown))
                    assert_int_equal(code[c], (int)floor(shown * 255.0 + 0.5));
            }
        }
    assert_true(count >= least);
    image_destroy(&codes);
    film_destroy(&rendered);
}
