/* path_fixture.c - see path_fixture.h. */
#include "path/path_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "cpu/preview.h"
#include "ibl/cache.h"
#include "ibl/environment.h"
#include "path/path_render.h"

/* ---- scenes ---- */

fixture truth_create(void)
{
    fixture f = fixture_create();
    facet_environment_destroy(f.environment);
    f.environment = NULL;
    f.desc = (facet_render_desc){.width = 4,
                                 .height = 4,
                                 .samples = 64,
                                 .thread_count = 1,
                                 .renderer = FACET_RENDERER_KIND_PATH,
                                 .energy = FACET_ENERGY_CONSERVING,
                                 .background = FACET_BACKGROUND_ENVIRONMENT,
                                 .path = {.max_depth = 64, .filter = FACET_FILTER_BOX}};
    return f;
}

void truth_set_constant_sky(fixture *f, float r, float g, float b)
{
    facet_environment_destroy(f->environment);
    f->environment = NULL;
    float radiance[3] = {r, g, b};
    assert_int_equal(facet_environment_create_constant(radiance, NULL, &f->environment, NULL), FACET_OK);
}

void truth_set_sky(fixture *f, uint32_t rows, truth_sky *sky)
{
    facet_environment_destroy(f->environment);
    f->environment = NULL;
    facet_environment *e = NULL;
    assert_int_equal(environment_create(&(facet_environment_desc){0}, &e, NULL), FACET_OK);
    assert_int_equal(image_create(&e->allocator, 2 * rows, rows, 3, IMAGE_F32, &e->panorama, NULL), FACET_OK);
    float *texels = e->panorama.pixels;
    for (uint32_t y = 0; y < rows; y++)
        for (uint32_t x = 0; x < 2 * rows; x++) {
            double theta = TRUTH_PI * (y + 0.5) / rows;
            double phi = 2.0 * TRUTH_PI * ((x + 0.5) / (2.0 * rows) - 0.5);
            double d[3] = {sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi)};
            sky(d, texels + 3 * ((size_t)y * 2 * rows + x));
        }
    environment_limit(e, 1);
    cache_identify(e, texels, image_row_size(&e->panorama) * rows);
    f->environment = e;
}

void truth_sky_halves(const double d[3], float rgb[3])
{
    rgb[0] = d[1] > 0.0 ? 1.0f : 0.0f;
    rgb[1] = d[1] > 0.0 ? 0.0f : 1.0f;
    rgb[2] = 1.0f;
}

/* ---- materials ---- */

scene_material truth_lambert(float albedo)
{
    scene_material m = scene_material_default();
    m.extensions = SCENE_SPECULAR;
    m.specular = 0.0f;
    m.metallic = 0.0f;
    m.perceptual_roughness = 1.0f;
    for (int i = 0; i < 3; i++)
        m.base_color[i] = albedo;
    return m;
}

scene_material truth_metal(float r, float g, float b, float roughness)
{
    scene_material m = scene_material_default();
    m.metallic = 1.0f;
    m.perceptual_roughness = roughness;
    m.base_color[0] = r;
    m.base_color[1] = g;
    m.base_color[2] = b;
    return m;
}

scene_material truth_glass(float ior, float roughness)
{
    scene_material m = scene_material_default();
    m.extensions = SCENE_TRANSMISSION | SCENE_VOLUME | SCENE_IOR;
    m.metallic = 0.0f;
    m.perceptual_roughness = roughness;
    m.transmission = 1.0f;
    m.thickness = 1.0f;
    m.ior = ior;
    return m;
}

scene_material truth_emitter(float radiance)
{
    scene_material m = truth_lambert(0.0f);
    for (int i = 0; i < 3; i++)
        m.emissive[i] = 1.0f;
    m.emissive_strength = radiance;
    m.extensions |= SCENE_EMISSIVE_STRENGTH;
    return m;
}

/* ---- meshes ---- */

static void *take(fixture *f, size_t count, size_t size)
{
    void *memory = arena_zalloc(f->scene->arena, count, size);
    assert_non_null(memory);
    return memory;
}

/* Room for quads of four corners each. */
typedef struct quads {
    scene_primitive *primitive;
    float *positions, *normals, *texcoords;
    uint32_t *indices;
    uint32_t count;
} quads;

static quads quads_begin(fixture *f, uint32_t material, uint32_t capacity)
{
    facet_scene *s = f->scene;
    assert_true(s->mesh_count < FIXTURE_CAPACITY);
    quads q = {.primitive = take(f, 1, sizeof(scene_primitive)),
               .positions = take(f, (size_t)capacity * 4, 3 * sizeof(float)),
               .normals = take(f, (size_t)capacity * 4, 3 * sizeof(float)),
               .texcoords = take(f, (size_t)capacity * 4, 2 * sizeof(float)),
               .indices = take(f, (size_t)capacity * 6, sizeof(uint32_t))};
    const float **sets = take(f, 1, sizeof *sets);
    sets[0] = q.texcoords;
    *q.primitive = (scene_primitive){.mode = SCENE_TRIANGLES,
                                     .positions = q.positions,
                                     .normals = q.normals,
                                     .texcoord_count = 1,
                                     .texcoords = sets,
                                     .indices = q.indices,
                                     .material = material};
    s->meshes[s->mesh_count++] = (scene_mesh){.name = "", .primitive_count = 1, .primitives = q.primitive};
    return q;
}

/* Corners in the order of truth_add_panel(); the normal is that of the triangles. */
static void quads_add(quads *q, float corners[4][3])
{
    static const uint32_t order[6] = {0, 1, 2, 2, 1, 3};
    static const float texcoords[8] = {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 1.0f, 1.0f, 1.0f};
    double u[3], v[3];
    for (int i = 0; i < 3; i++) {
        /* The diagonals: right even where two corners are one, at the poles of a sphere. */
        u[i] = (double)corners[3][i] - (double)corners[0][i];
        v[i] = (double)corners[2][i] - (double)corners[1][i];
    }
    double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (uint32_t corner = 0; corner < 4; corner++)
        for (uint32_t i = 0; i < 3; i++) {
            q->positions[3 * (4 * q->count + corner) + i] = corners[corner][i];
            q->normals[3 * (4 * q->count + corner) + i] = (float)(n[i] / length);
        }
    memcpy(q->texcoords + 8 * q->count, texcoords, sizeof texcoords);
    for (uint32_t i = 0; i < 6; i++)
        q->indices[6 * q->count + i] = 4 * q->count + order[i];
    q->count++;
}

static uint32_t quads_end(fixture *f, quads *q)
{
    scene_primitive *p = q->primitive;
    p->vertex_count = 4 * q->count;
    p->index_count = 6 * q->count;
    for (uint32_t i = 0; i < 3; i++) {
        p->bounds_min[i] = INFINITY;
        p->bounds_max[i] = -INFINITY;
        for (uint32_t k = 0; k < p->vertex_count; k++) {
            p->bounds_min[i] = fminf(p->bounds_min[i], q->positions[3 * k + i]);
            p->bounds_max[i] = fmaxf(p->bounds_max[i], q->positions[3 * k + i]);
        }
    }
    uint32_t mesh = f->scene->mesh_count - 1;
    fixture_place(f, mesh, 0.0f, 0.0f, 0.0f, 1.0f);
    return mesh;
}

static void panel_corners(const float c[3], const float u[3], const float v[3], float corners[4][3])
{
    for (int corner = 0; corner < 4; corner++)
        for (int i = 0; i < 3; i++)
            corners[corner][i] = c[i] + (corner & 1 ? u[i] : -u[i]) + (corner & 2 ? v[i] : -v[i]);
}

uint32_t truth_add_panel(fixture *f, uint32_t material, const float c[3], const float u[3], const float v[3])
{
    float corners[4][3];
    panel_corners(c, u, v, corners);
    quads q = quads_begin(f, material, 1);
    quads_add(&q, corners);
    return quads_end(f, &q);
}

uint32_t truth_add_floor(fixture *f, uint32_t material, float y, float s)
{
    return truth_add_panel(f, material, (float[3]){0.0f, y, 0.0f}, (float[3]){s, 0.0f, 0.0f},
                           (float[3]){0.0f, 0.0f, -s});
}

uint32_t truth_add_ceiling(fixture *f, uint32_t material, float y, float s)
{
    return truth_add_panel(f, material, (float[3]){0.0f, y, 0.0f}, (float[3]){s, 0.0f, 0.0f},
                           (float[3]){0.0f, 0.0f, s});
}

uint32_t truth_add_box(fixture *f, uint32_t material, float y, float half_x, float half_y, float half_z)
{
    const float half[3] = {half_x, half_y, half_z};
    quads q = quads_begin(f, material, 6);
    for (int side = 0; side < 6; side++) {
        int axis = side / 2;
        float c[3] = {0.0f, y, 0.0f};
        float u[3] = {0};
        float v[3] = {0};
        c[axis] += side & 1 ? -half[axis] : half[axis];
        int a = (axis + 1) % 3;
        int b = (axis + 2) % 3;
        u[side & 1 ? b : a] = half[side & 1 ? b : a];
        v[side & 1 ? a : b] = half[side & 1 ? a : b];
        float corners[4][3];
        panel_corners(c, u, v, corners);
        quads_add(&q, corners);
    }
    return quads_end(f, &q);
}

uint32_t truth_add_flat_sphere(fixture *f, uint32_t material, uint32_t columns, float y, float radius)
{
    uint32_t rows = columns / 2;
    quads q = quads_begin(f, material, rows * columns);
    for (uint32_t row = 0; row < rows; row++)
        for (uint32_t column = 0; column < columns; column++) {
            float corners[4][3];
            for (uint32_t k = 0; k < 4; k++) {
                double theta = TRUTH_PI * (row + (k & 2 ? 0u : 1u)) / rows;
                double phi = 2.0 * TRUTH_PI * ((column + (k & 1)) % columns) / columns;
                double sine = row + (k & 2 ? 0u : 1u) == rows ? 0.0 : sin(theta);
                corners[k][0] = (float)((double)radius * sine * sin(phi));
                corners[k][1] = (float)((double)y + (double)radius * cos(theta));
                corners[k][2] = (float)((double)radius * sine * cos(phi));
            }
            quads_add(&q, corners);
        }
    return quads_end(f, &q);
}

void truth_set_camera(fixture *f, double polar_deg, float x, float y, float height)
{
    double polar = truth_radians(polar_deg);
    f->camera = (facet_camera){.eye = {x + (float)(10.0 * sin(polar)), y + (float)(10.0 * cos(polar)), 0.0f},
                               .target = {x, y, 0.0f},
                               .ortho_height = height};
}

/* ---- images ---- */

static facet_result try_prepared(fixture *f, prepared_scene *p, film *out, facet_render_stats *stats,
                                 facet_error *error)
{
    facet_render_desc desc = fixture_desc(f);
    facet_result result = film_create(&desc.allocator, desc.crop[2], desc.crop[3], desc.aovs, out, error);
    if (result != FACET_OK)
        return result;
    return desc.renderer == FACET_RENDERER_KIND_PATH ? path_render_prepared(p, &desc, NULL, out, stats, error)
                                                     : preview_render_prepared(p, &desc, out, stats, error);
}

facet_result truth_try_render(fixture *f, film *out, facet_render_stats *stats, facet_error *error)
{
    prepared_scene p;
    prepared_scene_init(&p, f->scene, &f->desc.allocator);
    facet_result result = try_prepared(f, &p, out, stats, error);
    prepared_scene_clear(&p);
    return result;
}

film truth_render(fixture *f, facet_render_stats *stats)
{
    film out;
    facet_render_stats own;
    facet_error error = {0};
    if (truth_try_render(f, &out, stats ? stats : &own, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return out;
}

/* Sums of values and their squares, around the first value: small variations keep their precision. */
typedef struct tally {
    double origin[4], sum[4], square[4];
    uint32_t count;
} tally;

static void tally_add(tally *t, const double value[4])
{
    if (t->count++ == 0)
        memcpy(t->origin, value, sizeof t->origin);
    for (int i = 0; i < 4; i++) {
        double d = value[i] - t->origin[i];
        t->sum[i] += d;
        t->square[i] += d * d;
    }
}

static truth_value tally_value(const tally *t)
{
    truth_value v = {.count = t->count};
    double n = t->count;
    for (int i = 0; i < 4; i++) {
        double mean = t->sum[i] / n;
        double variance = fmax(t->square[i] / n - mean * mean, 0.0) * n / (n - 1.0);
        v.mean[i] = t->origin[i] + mean;
        v.error[i] = sqrt(variance / n);
    }
    return v;
}

truth_value truth_measure_pixels(fixture *f)
{
    film picture = truth_render(f, NULL);
    tally t = {0};
    for (size_t i = 0; i < (size_t)picture.width * picture.height; i++) {
        const float *p = picture.layers[0].pixels + 4 * i;
        tally_add(&t, (double[4]){(double)p[0], (double)p[1], (double)p[2], (double)p[3]});
    }
    film_destroy(&picture);
    return tally_value(&t);
}

truth_value truth_measure(fixture *f, uint32_t count)
{
    prepared_scene prepared;
    prepared_scene_init(&prepared, f->scene, &f->desc.allocator);
    uint32_t seed = f->desc.path.seed;
    tally t = {0};
    for (uint32_t i = 1; i <= count; i++) {
        f->desc.path.seed = i;
        film picture;
        facet_render_stats stats;
        facet_error error = {0};
        if (try_prepared(f, &prepared, &picture, &stats, &error) != FACET_OK)
            fail_msg("%s", error.message);
        double mean[4] = {0};
        size_t pixels = (size_t)picture.width * picture.height;
        for (size_t k = 0; k < 4 * pixels; k++)
            mean[k & 3] += (double)picture.layers[0].pixels[k] / (double)pixels;
        tally_add(&t, mean);
        film_destroy(&picture);
    }
    f->desc.path.seed = seed;
    prepared_scene_clear(&prepared);
    return tally_value(&t);
}

/* ---- comparisons ---- */

static void check(bool is_right, const truth_value *v, int channel, double reference, const char *format,
                  va_list arguments)
{
    if (is_right)
        return;
    char what[256];
    vsnprintf(what, sizeof what, format, arguments);
    fail_msg("%s: channel %d is %.7g, standard error %.2g of %u values; expected %.7g, off by %.2g", what,
             channel, v->mean[channel], v->error[channel], v->count, reference, v->mean[channel] - reference);
}

static bool is_near(const truth_value *v, int channel, double reference)
{
    double allowed = TRUTH_SIGMAS * v->error[channel] + TRUTH_ROUNDING * fabs(reference) + 1e-7;
    return fabs(v->mean[channel] - reference) <= allowed;
}

void truth_assert_channel(const truth_value *v, int channel, double reference, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    check(is_near(v, channel, reference), v, channel, reference, format, arguments);
    va_end(arguments);
}

void truth_assert_grey(const truth_value *v, double reference, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    for (int i = 0; i < 3; i++)
        check(is_near(v, i, reference), v, i, reference, format, arguments);
    va_end(arguments);
}

void truth_assert_at_most(const truth_value *v, double bound, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    for (int i = 0; i < 3; i++)
        check(v->mean[i] <= bound * (1.0 + TRUTH_ROUNDING) + 3.0 * v->error[i], v, i, bound, format,
              arguments);
    va_end(arguments);
}

void truth_assert_same(const truth_value *a, const truth_value *b, double sigmas, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    for (int i = 0; i < 3; i++) {
        double error = hypot(a->error[i], b->error[i]);
        double difference = fabs(a->mean[i] - b->mean[i]);
        check(difference <= sigmas * error + TRUTH_ROUNDING * fabs(b->mean[i]), a, i, b->mean[i], format,
              arguments);
    }
    va_end(arguments);
}

/* ---- the white furnace ---- */

static truth_value furnace(fixture *f, double polar)
{
    f->desc.samples = 4096;
    f->desc.path.max_depth = 1000;
    truth_set_constant_sky(f, 1.0f, 1.0f, 1.0f);
    truth_set_camera(f, polar, 0.0f, 0.0f, 0.1f);
    truth_value v = truth_measure_pixels(f);
    fixture_destroy(f);
    return v;
}

truth_value truth_furnace(scene_material material, double polar, facet_energy energy)
{
    fixture f = truth_create();
    f.desc.energy = energy;
    material.is_double_sided = true;
    truth_add_floor(&f, fixture_add_material(&f, material), 0.0f, 10.0f);
    return furnace(&f, polar);
}

truth_value truth_furnace_volume(scene_material material, double polar)
{
    fixture f = truth_create();
    truth_add_box(&f, fixture_add_material(&f, material), 0.0f, 10.0f, 0.5f, 10.0f);
    return furnace(&f, polar);
}

void truth_assert_white(truth_value v, double tables, const char *what, double roughness, double polar)
{
    for (int c = 0; c < 3; c++)
        if (fabs(v.mean[c] - 1.0) > tables + TRUTH_SIGMAS * v.error[c] + TRUTH_ROUNDING)
            fail_msg("%s, roughness %g, %g degrees: channel %d is %.6f, standard error %.2g; expected 1",
                     what, roughness, polar, c, v.mean[c], v.error[c]);
    truth_assert_at_most(&v, 1.0 + tables, "%s, roughness %g, %g degrees", what, roughness, polar);
}

/* ---- references ---- */

double truth_refracted(double cosine, double n)
{
    double sin2 = (1.0 - cosine * cosine) / (n * n);
    return sin2 < 1.0 ? sqrt(1.0 - sin2) : 0.0;
}

double truth_fresnel(double cosine, double n)
{
    if ((1.0 - cosine * cosine) >= n * n)
        return 1.0;
    double t = truth_refracted(cosine, n);
    double s = (cosine - n * t) / (cosine + n * t);
    double p = (n * cosine - t) / (n * cosine + t);
    return 0.5 * (s * s + p * p);
}

double truth_schlick(double F0, double cosine)
{
    return F0 + (1.0 - F0) * pow(1.0 - cosine, 5.0);
}

double truth_polygon_irradiance(const double P[3], const double N[3], const double (*corners)[3], int count)
{
    double sum = 0.0;
    for (int k = 0; k < count; k++) {
        double a[3], b[3];
        double aa = 0.0, bb = 0.0, ab = 0.0;
        for (int i = 0; i < 3; i++) {
            a[i] = corners[k][i] - P[i];
            b[i] = corners[(k + 1) % count][i] - P[i];
            aa += a[i] * a[i];
            bb += b[i] * b[i];
            ab += a[i] * b[i];
        }
        double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        double length = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
        double angle = acos(ab / sqrt(aa * bb));
        sum += angle * (N[0] * c[0] + N[1] * c[1] + N[2] * c[2]) / length;
    }
    return 0.5 * fabs(sum);
}
