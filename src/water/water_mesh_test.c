/* water_mesh_test.c - the sea as triangles: slopes that they show and those that they say they hide are
 * Cox and Munk's at all distances, foam covers what the wind says, the horizon falls away, a hull keeps
 * the water out. */
#include "water/water_fixture.h"

#include "base/clock.h"
#include "base/memory.h"
#include "cpu/preview_fixture.h"

#include "water/water_mesh.h"
#include "water/water_place.h"

typedef struct made {
    facet_sea *sea;
    shot shot;
    water_setup setup;
    arena *memory;
    water_mesh_lattice lattice;
    scene_primitive surface;
} made;

static void make(made *m, const facet_sea_desc *desc, const facet_scene *scene, float eye_m, uint32_t most)
{
    facet_error error;
    facet_render_stats stats = {0};
    const facet_allocator plain = {0};
    m->sea = make_sea(desc);
    make_shot(&m->shot, 160, 90, eye_m, 0.1f);
    m->shot.desc.camera = &m->shot.camera;
    if (water_setup_create(shot_in(m->sea, &m->shot), scene, &m->shot.desc, 0, &m->setup, &stats, &error) !=
        FACET_OK)
        fail_msg("%s", error.message);
    m->memory = arena_create(&plain);
    assert_true(water_mesh_lattice_create(&m->setup, most, m->memory, &m->lattice));
    assert_true(water_mesh_surface(&m->setup, &m->lattice, NULL, m->memory, &m->surface));
}

static void end(made *m)
{
    arena_destroy(m->memory);
    water_setup_destroy(&m->setup);
    water_cache_clear(&m->shot.cache);
    sea_destroy(m->sea);
}

/* ---- triangles ---- */

typedef struct mean {
    double area, resolved[2], hidden[2], foam;
} mean;

static const float *corner(const float *values, uint32_t width, uint32_t index)
{
    return values + (size_t)width * index;
}

/* Seen from above; the middles of edges integrate squares of what is linear exactly, and slopes nearly are. */
static void add_triangle(const scene_primitive *p, const uint32_t *i, mean *to)
{
    const float *a = corner(p->positions, 3, i[0]), *b = corner(p->positions, 3, i[1]),
                *c = corner(p->positions, 3, i[2]);
    double area = 0.5 * fabs(((double)b[0] - (double)a[0]) * ((double)c[2] - (double)a[2]) -
                             ((double)b[2] - (double)a[2]) * ((double)c[0] - (double)a[0]));
    to->area += area;
    for (int e = 0; e < 3; e++) {
        const float *m = corner(p->normals, 3, i[e]), *n = corner(p->normals, 3, i[(e + 1) % 3]);
        const float *v = corner(p->water, SCENE_WATER_VALUES, i[e]);
        double N[3];
        for (int k = 0; k < 3; k++)
            N[k] = (double)m[k] + (double)n[k];
        to->resolved[0] += area / 3.0 * N[0] * N[0] / (N[1] * N[1]);
        to->resolved[1] += area / 3.0 * N[2] * N[2] / (N[1] * N[1]);
        to->hidden[0] += area / 3.0 * (double)v[0];
        to->hidden[1] += area / 3.0 * (double)v[1];
        to->foam += area / 3.0 * (double)v[3];
    }
}

/* Of the visible triangles: others are larger. */
static mean mean_between(const made *m, double from, double to)
{
    mean sum = {.area = 0.0};
    const scene_primitive *p = &m->surface;
    for (uint32_t i = 0; i < p->index_count; i += 3) {
        const float *a = corner(p->positions, 3, p->indices[i]);
        double r = hypot((double)a[0] - m->lattice.center[0], (double)a[2] - m->lattice.center[1]);
        double x = ((double)a[0] - m->lattice.center[0]) / r, z = ((double)a[2] - m->lattice.center[1]) / r;
        if (r >= from && r < to && z < -0.85 && fabs(x) < 0.5)
            add_triangle(p, p->indices + i, &sum);
    }
    for (int k = 0; k < 2; k++) {
        sum.resolved[k] /= sum.area;
        sum.hidden[k] /= sum.area;
    }
    sum.foam /= sum.area;
    return sum;
}

static facet_sea_desc trade_wind(void)
{
    facet_sea_desc d = sea_default();
    d.wind_mps = 10.0f;
    d.resolution = 128;
    return d;
}

/* What is lost between vertices, where normals are linear, is 1.5 % of Cox and Munk's at most. */
static void vertices_and_covariances_add_up_to_all_slopes(void **state)
{
    (void)state;
    static const double edges[] = {30.0, 120.0, 500.0, 2000.0, 9000.0};
    double sums[4][2] = {{0.0}}, resolved[4] = {0.0};
    enum { SEEDS = 3 };
    slope_covariance total = {0};
    for (uint32_t seed = 0; seed < SEEDS; seed++) {
        facet_sea_desc d = trade_wind();
        d.seed = 17 + seed;
        made m;
        make(&m, &d, NULL, 5.0f, 150000);
        total = m.sea->slopes.total;
        for (int i = 0; i < 4; i++) {
            mean a = mean_between(&m, edges[i], edges[i + 1]);
            for (int k = 0; k < 2; k++)
                sums[i][k] += (a.resolved[k] + a.hidden[k]) / SEEDS;
            resolved[i] += (a.resolved[0] + a.resolved[1]) / SEEDS;
        }
        end(&m);
    }
    for (int i = 0; i < 4; i++) {
        assert_true(fabs(sums[i][0] / (double)total.xx - 1.0) < 0.03);
        assert_true(fabs(sums[i][1] / (double)total.zz - 1.0) < 0.03);
    }
    assert_true(resolved[0] > 2.0 * resolved[3]); /* what is far is left to roughness */
}

/* Of the visible water, at rest positions, each weighted by its displaced area. */
static double foam_of_preview(const made *m, double from, double to)
{
    const float footprint = 0.5f;
    double foam = 0.0, area = 0.0;
    for (int i = 0; i < 20000; i++) {
        double r = sqrt(from * from + (to * to - from * from) * (i % 200 + 0.5) / 200.0);
        double angle = -1.5707963 + 0.5 * ((i / 200 + 0.5) / 100.0 - 0.5);
        const double rest[2] = {r * cos(angle), r * sin(angle)};
        wave_point p = waves_at(&m->sea->waves, rest[0], rest[1], footprint);
        wave_shape shape = wave_shape_of(&p);
        float share = water_foam_at(&m->setup, rest, footprint);
        foam += (double)(share * shape.jacobian);
        area += (double)shape.jacobian;
    }
    return foam / area;
}

/* At 15 m/s: as much as the preview has, and between a tenth of what the wind covers and all of it. */
static void foam_has_the_coverage_of_the_sea(void **state)
{
    (void)state;
    double covered = 0.0, expected = 0.0, most = 0.0;
    for (uint32_t seed = 0; seed < 2; seed++) {
        facet_sea_desc d = trade_wind();
        d.wind_mps = 15.0f;
        d.seed = 5 + seed;
        made m;
        make(&m, &d, NULL, 8.0f, 150000);
        covered += mean_between(&m, 100.0, 1500.0).foam / 2.0;
        expected += foam_of_preview(&m, 100.0, 1500.0) / 2.0;
        most = (double)m.sea->foam.coverage;
        end(&m);
    }
    if (!(fabs(covered / expected - 1.0) < 0.15) || !(covered > 0.1 * most && covered < most))
        fail_msg("%g of %g, covered %g", covered, expected, most);
}

/* Without waves: all around, on the sphere, to beyond the horizon; the circle is closed. */
static void the_mesh_extends_beyond_the_horizon(void **state)
{
    (void)state;
    facet_sea_desc d = sea_default();
    d.wind_mps = 0.0f;
    made m;
    make(&m, &d, NULL, 20.0f, 150000);
    const water_mesh_lattice *l = &m.lattice;
    double far_m = l->radii[l->row_count - 1];
    assert_true(far_m > sqrt(20.0 / m.setup.march.fall));
    assert_true((size_t)l->column_count * l->row_count <= 150000);
    for (uint32_t i = 0; i < m.surface.vertex_count; i++) {
        const float *P = corner(m.surface.positions, 3, i);
        double r = hypot((double)P[0] - l->center[0], (double)P[2] - l->center[1]);
        assert_true(fabs((double)P[1] + m.setup.march.fall * r * r) < 1e-3 + 1e-6 * r);
        assert_true(corner(m.surface.normals, 3, i)[1] == 1.0f);
    }
    for (uint32_t row = 0; row < l->row_count; row++) {
        const float *first = corner(m.surface.positions, 3, row * l->column_count);
        assert_memory_equal(first, first + 3 * ((size_t)l->column_count - 1), 3 * sizeof(float));
    }
    mean all = {.area = 0.0};
    for (uint32_t i = 0; i < m.surface.index_count; i += 3)
        add_triangle(&m.surface, m.surface.indices + i, &all);
    /* no triangle is there twice, and none is missing */
    assert_true(fabs(all.area / (3.14159265358979 * far_m * far_m) - 1.0) < 5e-3);
    end(&m);
}

/* A sphere of radius 1 that lies half in still water leaves a hole of radius 1, round to a hundredth. */
static void there_is_no_water_in_a_dry_hull(void **state)
{
    (void)state;
    fixture f = fixture_create();
    fixture_place(&f, fixture_add_sphere(&f, 96, fixture_add_material(&f, scene_material_default())), 0.0f,
                  0.0f, -6.0f, 1.0f);
    facet_sea_desc d = sea_default();
    d.wind_mps = 0.0f;
    made m, without;
    make(&m, &d, f.scene, 3.0f, 60000);
    make(&without, &d, NULL, 3.0f, 60000);
    for (uint32_t i = 0; i < m.surface.index_count; i += 3) {
        const uint32_t *t = m.surface.indices + i;
        double nearest = HUGE_VAL;
        for (int k = 0; k < 3; k++) {
            const float *P = corner(m.surface.positions, 3, t[k]);
            nearest = fmin(nearest, hypot((double)P[0], (double)P[2] + 6.0));
        }
        assert_true(nearest > 0.98);
    }
    double hole = mean_between(&without, 0.0, 60.0).area - mean_between(&m, 0.0, 60.0).area;
    if (!(fabs(hole / 3.14159265 - 1.0) < 0.02))
        fail_msg("the hole is %g m^2", hole);
    end(&m);
    end(&without);
    fixture_destroy(&f);
}

/* Past the time limit, and where the caller's progress says no, there is no scene. */
static bool refuse(void *user, const char *stage, double fraction)
{
    (void)user;
    (void)stage;
    (void)fraction;
    return false;
}

static void limits_and_cancelling_end_it(void **state)
{
    (void)state;
    facet_sea_desc d = sea_default();
    d.resolution = 64;
    made m;
    make(&m, &d, NULL, 3.0f, 60000);
    facet_scene *scene;
    facet_error error;
    assert_int_equal(water_mesh_scene(&m.setup, NULL, clock_seconds() - 1.0, &scene, &error),
                     FACET_ERROR_LIMIT);
    assert_null(scene);
    m.shot.desc.progress.report = refuse;
    assert_int_equal(water_mesh_scene(&m.setup, NULL, 0.0, &scene, &error), FACET_ERROR_CANCELLED);
    assert_null(scene);
    end(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(vertices_and_covariances_add_up_to_all_slopes),
                                       cmocka_unit_test(foam_has_the_coverage_of_the_sea),
                                       cmocka_unit_test(the_mesh_extends_beyond_the_horizon),
                                       cmocka_unit_test(there_is_no_water_in_a_dry_hull),
                                       cmocka_unit_test(limits_and_cancelling_end_it)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
