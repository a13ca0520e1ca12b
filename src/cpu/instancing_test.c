/* Tests of instances in the BVH: which geometries are instanced, and that the image is that of flat ones. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "cpu/instancing.h"
#include "cpu/preview_fixture.h"

/* 64 * 32 * 2 = 4096 triangles: 9 of them save as many as the smallest image requires. */
enum { COLUMNS = 64, SPHERE_TRIANGLES = 4096, ENOUGH = 9 };

typedef struct chosen {
    scene_pose pose;
    render_geometry_set set;
} chosen;

static chosen choose(fixture *f, uint64_t ray_count)
{
    chosen c;
    facet_allocator allocator = {0};
    camera_rays camera;
    assert_int_equal(scene_pose_create(f->scene, &f->desc.pose, &allocator, 1, &c.pose, NULL), FACET_OK);
    assert_int_equal(camera_rays_create(&f->camera, 64, 64, &camera, NULL), FACET_OK);
    assert_int_equal(render_geometry_create(f->scene, &c.pose, &allocator, &c.set, NULL), FACET_OK);
    instancing_desc desc = {.pose = &f->desc.pose,
                            .ray_count = ray_count,
                            .is_within_reach = instancing_is_within_reach(&c.pose, &camera)};
    assert_int_equal(instancing_choose(f->scene, &c.pose, &desc, &allocator, &c.set, NULL), FACET_OK);
    assert_int_equal(render_geometry_transform(&c.set, &c.pose, &camera, &allocator, 1, NULL), FACET_OK);
    return c;
}

static void release(chosen *c)
{
    render_geometry_destroy(&c->set);
    scene_pose_destroy(&c->pose);
}

static uint32_t count_role(fixture *f, uint64_t ray_count, render_role role)
{
    chosen c = choose(f, ray_count);
    uint32_t count = 0;
    for (uint32_t i = 0; i < c.set.count; i++)
        count += c.set.items[i].role == role;
    release(&c);
    return count;
}

/* ---- instanced geometries ---- */

static void few_uses_stay_flat(void **state)
{
    (void)state;
    fixture f = fixture_create();
    uint32_t mesh = fixture_add_sphere(&f, COLUMNS, SCENE_NONE);
    for (int i = 0; i < ENOUGH; i++) {
        assert_int_equal(count_role(&f, 0, RENDER_INSTANCED), 0);
        fixture_place(&f, mesh, 0.1f * (float)i, 0.0f, 0.0f, 0.1f);
    }
    assert_int_equal(count_role(&f, 0, RENDER_INSTANCED), ENOUGH);
    /* More rays than the triangles that are saved are worth. */
    assert_int_equal(count_role(&f, 16 * 8 * SPHERE_TRIANGLES, RENDER_INSTANCED), ENOUGH);
    assert_int_equal(count_role(&f, 16 * 8 * SPHERE_TRIANGLES + 16, RENDER_INSTANCED), 0);
    fixture_destroy(&f);
}

/* Each shape once, in the order of first use; shapes with one use stay flat. */
static void uses_share_a_shape(void **state)
{
    (void)state;
    fixture f = fixture_create();
    uint32_t meshes[3];
    for (int i = 0; i < 3; i++)
        meshes[i] = fixture_add_sphere(&f, COLUMNS, SCENE_NONE);
    fixture_place(&f, meshes[1], 0, 0, 0, 1.0f);
    for (int i = 0; i < ENOUGH; i++)
        for (int k = 0; k < 3; k += 2)
            fixture_place(&f, meshes[k], (float)i, (float)k, 0, 1.0f);
    chosen c = choose(&f, 0);
    assert_int_equal(c.set.shape_count, 2);
    assert_int_equal(c.set.items[0].role, RENDER_FLAT);
    for (uint32_t i = 1; i < c.set.count; i++) {
        const render_geometry *g = &c.set.items[i];
        assert_int_equal(g->role, RENDER_INSTANCED);
        assert_int_equal(g->shape, (i - 1) % 2);
        assert_ptr_equal(c.set.shapes[g->shape].primitive, g->primitive);
        assert_int_equal(c.set.shapes[g->shape].use_count, ENOUGH);
        float corner[3];
        float expected[3];
        render_geometry_corner(g, 70, corner);
        mat4_transform_point(&c.pose.instances[i].world, g->primitive->positions + 3 * 70, expected);
        assert_memory_equal(corner, expected, sizeof corner);
    }
    release(&c);
    fixture_destroy(&f);
}

/* Geometries that cannot be instanced, or with too large rounding errors. */
static void wild_instances_stay_flat(void **state)
{
    (void)state;
    static const float scales[5][3] = {
        {1e-8f, 1e-8f, 1e-8f}, {1, 1, 1e-9f}, {1e8f, 1, 1}, {-1, 1, 1}, {3, -0.001f, 100}};
    static const bool is_instanced[5] = {false, false, false, true, true};
    for (int i = 0; i < 5; i++) {
        fixture f = fixture_create();
        uint32_t mesh = fixture_add_sphere(&f, COLUMNS, SCENE_NONE);
        for (int k = 0; k < ENOUGH; k++)
            memcpy(fixture_place(&f, mesh, 0, 0, 0, 1.0f)->scale, scales[i], sizeof scales[i]);
        assert_int_equal(count_role(&f, 0, RENDER_INSTANCED), is_instanced[i] ? ENOUGH : 0);
        fixture_destroy(&f);
    }
}

static void a_mesh_far_from_its_origin_stays_flat(void **state)
{
    (void)state;
    fixture f = fixture_create();
    uint32_t mesh = fixture_add_sphere(&f, COLUMNS, SCENE_NONE);
    for (int k = 0; k < ENOUGH; k++)
        fixture_place(&f, mesh, 0, 0, 0, 1.0f);
    scene_primitive *p = fixture_primitive(&f, mesh);
    for (uint32_t i = 0; i < p->vertex_count; i++)
        ((float *)(uintptr_t)p->positions)[3 * i] += 1000.0f;
    p->bounds_min[0] += 1000.0f;
    p->bounds_max[0] += 1000.0f;
    assert_int_equal(count_role(&f, 0, RENDER_INSTANCED), 0);
    fixture_destroy(&f);
}

/* A distant mesh, or a distant camera, makes rays that do not fit into the space of instances. */
static void add_far_thing(fixture *f)
{
    fixture_place(f, fixture_add_quad(f, SCENE_NONE), 2e10f, 0.0f, 2e10f, 1.0f);
}

static void beyond_reach_all_is_flat(void **state)
{
    (void)state;
    fixture f = fixture_create();
    uint32_t mesh = fixture_add_sphere(&f, COLUMNS, SCENE_NONE);
    for (int k = 0; k < ENOUGH; k++)
        fixture_place(&f, mesh, 0, 0, 0, 1.0f);
    assert_int_equal(count_role(&f, 0, RENDER_INSTANCED), ENOUGH);
    f.camera.eye[2] = 1e12f;
    assert_int_equal(count_role(&f, 0, RENDER_INSTANCED), 0);
    f.camera.eye[2] = 10.0f;
    add_far_thing(&f);
    assert_int_equal(count_role(&f, 0, RENDER_INSTANCED), 0);
    fixture_destroy(&f);
}

/* ---- images ---- */

/* A quaternion that rotates by angle around an axis that is not a coordinate axis. */
static void set_turn(scene_node *node, float angle)
{
    const float axis[3] = {0.48f, 0.6f, 0.64f};
    for (int i = 0; i < 3; i++)
        node->rotation[i] = axis[i] * sinf(0.5f * angle);
    node->rotation[3] = cosf(0.5f * angle);
}

/* Bumps and colors in a texture: red waves along u, a normal that leans. */
static uint32_t add_textured_material(fixture *f, scene_alpha_mode alpha_mode)
{
    enum { SIZE = 64 };
    unsigned char colors[4 * SIZE * SIZE];
    unsigned char normals[4 * SIZE * SIZE];
    for (int i = 0; i < SIZE * SIZE; i++) {
        int x = i % SIZE;
        int y = i / SIZE;
        const unsigned char color[4] = {(unsigned char)(128 + 100 * ((x / 8) % 2)), (unsigned char)(4 * y),
                                        90, (unsigned char)(x / 16 % 2 ? 255 : 110)};
        const unsigned char normal[4] = {(unsigned char)(x / 8 % 2 ? 180 : 90), 150, 230, 255};
        memcpy(colors + 4 * i, color, 4);
        memcpy(normals + 4 * i, normal, 4);
    }
    scene_material m = scene_material_default();
    m.textures[SCENE_BASE_COLOR_TEXTURE].texture = fixture_add_texture(f, SIZE, SIZE, colors);
    m.textures[SCENE_NORMAL_TEXTURE].texture = fixture_add_texture(f, SIZE, SIZE, normals);
    m.perceptual_roughness = 0.4f;
    m.metallic = 0.0f;
    m.alpha_mode = alpha_mode;
    return fixture_add_material(f, m);
}

/* Rotating spheres, some mirrored, all scaled differently along each axis. */
static fixture grid_scene(scene_alpha_mode alpha_mode)
{
    fixture f = fixture_create();
    uint32_t mesh = fixture_add_sphere(&f, COLUMNS, add_textured_material(&f, alpha_mode));
    for (int i = 0; i < 16; i++) {
        scene_node *node = fixture_place(&f, mesh, 0.5f * (float)(i % 4) - 0.75f,
                                         0.5f * (float)(i / 4) - 0.75f, 0.1f * (float)(i % 3), 1.0f);
        node->scale[0] = i % 2 ? 0.2f : -0.27f;
        node->scale[1] = 0.1f + 0.01f * (float)i;
        node->scale[2] = i % 5 == 0 ? -0.15f : 0.3f;
        set_turn(node, 0.9f * (float)i);
    }
    scene_light light = {.type = SCENE_LIGHT_DIRECTIONAL, .color = {1, 1, 1}, .intensity = 2.0f};
    fixture_add_light(&f, light, 0, 0, 0);
    f.camera.eye[0] = 3.0f;
    f.camera.eye[1] = 4.0f;
    f.desc.aovs = FACET_AOV_NORMAL | FACET_AOV_DEPTH | FACET_AOV_UV | FACET_AOV_ALBEDO;
    return f;
}

/* Renders instanced and, with a distant mesh, flat. */
static void render_both(fixture *f, film films[2])
{
    assert_true(count_role(f, 64 * 64 * 4, RENDER_INSTANCED) > 0);
    films[0] = fixture_render(f);
    add_far_thing(f);
    assert_int_equal(count_role(f, 64 * 64 * 4, RENDER_INSTANCED), 0);
    films[1] = fixture_render(f);
}

/* Rays intersect an instance in its own space, so weights and distances differ by rounding, and at the
 * silhouette a sample may differ: 2 pixels of a layer at most. */
static void assert_alike(const film *a, const film *b, const char *layer, float tolerance)
{
    uint32_t others = 0;
    uint32_t covered = 0;
    for (uint32_t y = 0; y < a->height; y++)
        for (uint32_t x = 0; x < a->width; x++) {
            const film_layer *l = film_find((film *)(uintptr_t)a, layer);
            const float *p = fixture_pixel(a, layer, x, y);
            const float *q = fixture_pixel(b, layer, x, y);
            bool is_other = false;
            for (uint32_t i = 0; i < l->channel_count; i++) {
                is_other = is_other || (p[i] != q[i] && !(fabsf(p[i] - q[i]) <= tolerance));
                covered += p[i] != 0.0f && isfinite(p[i]);
            }
            others += is_other;
        }
    assert_true(covered > 100);
    if (others > 2)
        fail_msg("layer \"%s\": %u pixels differ", layer, others);
}

static void instances_are_seen_as_flat_ones(void **state)
{
    (void)state;
    static const scene_alpha_mode modes[3] = {SCENE_ALPHA_OPAQUE, SCENE_ALPHA_MASK, SCENE_ALPHA_BLEND};
    for (int i = 0; i < 6; i++) {
        fixture f = grid_scene(modes[i % 3]);
        f.camera.fov_y_rad = i < 3 ? 0.0f : 0.2f;
        f.scene->materials[0].is_double_sided = i % 2;
        film films[2];
        render_both(&f, films);
        assert_alike(&films[0], &films[1], "", 1.0f / 255.0f);
        assert_alike(&films[0], &films[1], "normal", 1e-3f);
        assert_alike(&films[0], &films[1], "albedo", 2e-3f);
        assert_alike(&films[0], &films[1], "uv", 1e-4f);
        assert_alike(&films[0], &films[1], "depth", 1e-4f);
        film_destroy(&films[0]);
        film_destroy(&films[1]);
        fixture_destroy(&f);
    }
}

/* Independently of the flat image, which might be as wrong: the normals of a scaled, mirrored, rotated
 * sphere in closed form. A point p = M q with |q| = 1 has the normal M^-T q. */
static void normals_of_instances_are_those_of_ellipsoids(void **state)
{
    (void)state;
    fixture f = grid_scene(SCENE_ALPHA_OPAQUE);
    f.scene->materials[0].textures[SCENE_NORMAL_TEXTURE].texture = SCENE_NONE;
    f.camera = (facet_camera){.eye = {0.0f, 0.0f, 10.0f}, .ortho_height = 2.2f};
    f.desc.width = f.desc.height = 128;
    chosen c = choose(&f, 128 * 128 * 4);
    assert_int_equal(c.set.items[0].role, RENDER_INSTANCED);
    film rendered = fixture_render(&f);
    uint32_t checked = 0;
    for (uint32_t y = 0; y < 128; y++)
        for (uint32_t x = 0; x < 128; x++) {
            float depth = *fixture_pixel(&rendered, "depth", x, y);
            const float *n = fixture_pixel(&rendered, "normal", x, y);
            if (!isfinite(depth))
                continue;
            const double p[3] = {(x + 0.5 - 64.0) / 128.0 * 2.2, (64.0 - y - 0.5) / 128.0 * 2.2,
                                 10.0 - (double)depth};
            double best = 1e9;
            double normal[3] = {0, 0, 0};
            for (uint32_t i = 0; i < c.set.count; i++) {
                /* columns of M are turned axes a_k times s_k: q_k = a_k.(p - T) / s_k, normal = sum a_k
                 * q_k / s_k */
                const mat4 *m = &c.pose.instances[i].world;
                double q[3];
                double s2[3];
                for (int k = 0; k < 3; k++) {
                    const float *column = m->m + 4 * k;
                    s2[k] = 0.0;
                    q[k] = 0.0;
                    for (int r = 0; r < 3; r++) {
                        s2[k] += (double)column[r] * (double)column[r];
                        q[k] += (double)column[r] * (p[r] - (double)m->m[12 + r]);
                    }
                    q[k] /= s2[k];
                }
                double off = fabs(sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]) - 1.0);
                if (off >= best)
                    continue;
                best = off;
                double length = 0.0;
                for (int r = 0; r < 3; r++) {
                    normal[r] = 0.0;
                    for (int k = 0; k < 3; k++)
                        normal[r] += (double)m->m[4 * k + r] * q[k] / s2[k];
                    length += normal[r] * normal[r];
                }
                for (int r = 0; r < 3; r++)
                    normal[r] /= sqrt(length);
            }
            if (best > 0.01 ||
                normal[2] < 0.2) /* where triangles at the silhouette deviate from the ellipsoid */
                continue;
            checked++;
            double cosine = 0.0;
            for (int r = 0; r < 3; r++)
                cosine += normal[r] * (double)n[r];
            assert_true(cosine > 0.999);
        }
    assert_true(checked > 1500);
    film_destroy(&rendered);
    release(&c);
    fixture_destroy(&f);
}

static void instances_do_not_depend_on_threads(void **state)
{
    (void)state;
    fixture f = grid_scene(SCENE_ALPHA_BLEND);
    /* Coincident copies: which of them is hit must not depend on the threads. */
    for (int i = 0; i < 16; i++)
        *fixture_place(&f, f.scene->nodes[i].mesh, 0, 0, 0, 1.0f) = f.scene->nodes[i];
    f.desc.width = f.desc.height = 100;
    film films[3];
    for (uint32_t i = 0; i < 3; i++) {
        f.desc.thread_count = i * i + 1;
        films[i] = fixture_render(&f);
        for (uint32_t l = 0; l < films[i].layer_count; l++)
            assert_memory_equal(films[i].layers[l].pixels, films[0].layers[l].pixels,
                                (size_t)10000 * films[i].layers[l].channel_count * sizeof(float));
    }
    for (int i = 0; i < 3; i++)
        film_destroy(&films[i]);
    fixture_destroy(&f);
}

/* ---- many copies ---- */

static void set_copies(fixture *f, scene_node *node, uint32_t side, float spacing)
{
    scene_instancing *instancing = arena_zalloc(f->scene->arena, 1, sizeof *instancing);
    float *translations = arena_zalloc(f->scene->arena, (size_t)side * side, 3 * sizeof *translations);
    assert_true(instancing && translations);
    for (uint32_t i = 0; i < side * side; i++) {
        translations[3 * i] = spacing * ((float)(i % side) - 0.5f * (float)(side - 1));
        translations[3 * i + 1] = spacing * ((float)(i / side) - 0.5f * (float)(side - 1));
    }
    *instancing = (scene_instancing){.count = side * side, .translations = translations};
    node->instancing = instancing;
}

/* 10 000 spheres of 1152 triangles would be 1 GB of BVH. */
static void many_copies_are_cheap(void **state)
{
    (void)state;
    fixture f = fixture_create();
    set_copies(&f, fixture_place(&f, fixture_add_sphere(&f, 34, SCENE_NONE), 0, 0, 0, 0.005f), 100, 4.0f);
    f.desc.width = f.desc.height = 100;
    f.desc.samples = 16;
    facet_budget *budget;
    assert_int_equal(facet_budget_create(32 << 20, &budget, NULL), FACET_OK);
    f.desc.allocator = facet_budget_allocator(budget);
    film rendered = fixture_render(&f);
    /* Each pixel has one sphere of radius 1 in 4 x 4, here 0.02 m wide. */
    double disc = 3.14159265 / 16.0;
    for (uint32_t y = 5; y < 100; y += 9)
        for (uint32_t x = 5; x < 100; x += 9)
            assert_true(fabs((double)fixture_pixel(&rendered, "", x, y)[3] - disc) < 0.1);
    film_destroy(&rendered);
    assert_int_equal(facet_budget_used_bytes(budget), 0);
    facet_budget_destroy(budget);
    fixture_destroy(&f);
}

/* The copies that determine mips are the nearest in the image, as a full sort finds them. */
static void near_copies_are_those_that_are_seen_largest(void **state)
{
    (void)state;
    fixture f = fixture_create();
    scene_node *node = fixture_place(&f, fixture_add_sphere(&f, COLUMNS, SCENE_NONE), 0, 0, 0, 0.1f);
    set_copies(&f, node, 20, 4.0f);
    node->rotation[0] = sinf(0.785398f); /* a floor */
    node->rotation[3] = cosf(0.785398f);
    f.camera = (facet_camera){.eye = {0.0f, 0.5f, 0.0f}, .target = {0.0f, 0.5f, -1.0f}, .fov_y_rad = 1.0f};
    chosen c = choose(&f, 0);
    camera_rays camera;
    facet_allocator allocator = {0};
    assert_int_equal(camera_rays_create(&f.camera, 64, 64, &camera, NULL), FACET_OK);
    assert_int_equal(nearest_copies_choose(&c.set, &camera, 64, 64, &allocator, NULL), FACET_OK);
    uint32_t near_count = 0;
    float farthest_near = 0.0f;
    float nearest_far = INFINITY;
    for (uint32_t i = 0; i < c.set.count; i++) {
        const float *p = c.pose.instances[i].world.m + 12;
        bool is_in_picture = p[2] < -0.5f && fabsf(p[0]) < -0.5f * p[2];
        near_count += !c.set.items[i].is_far_copy;
        if (!c.set.items[i].is_far_copy)
            farthest_near = fmaxf(farthest_near, -p[2]);
        else if (is_in_picture)
            nearest_far = fminf(nearest_far, -p[2]);
        if (p[2] > 0.2f)
            assert_true(c.set.items[i].is_far_copy);
    }
    assert_true(near_count >= NEAREST_COPIES && near_count < NEAREST_COPIES + 20); /* rows are equally far */
    assert_true(nearest_far >= farthest_near - 0.01f);
    /* Where none is in the image, one still determines the textures. */
    f.camera.target[2] = 1.0f;
    f.camera.target[1] = f.camera.eye[1] = 100.0f;
    assert_int_equal(camera_rays_create(&f.camera, 64, 64, &camera, NULL), FACET_OK);
    assert_int_equal(nearest_copies_choose(&c.set, &camera, 64, 64, &allocator, NULL), FACET_OK);
    near_count = 0;
    for (uint32_t i = 0; i < c.set.count; i++)
        near_count += !c.set.items[i].is_far_copy;
    assert_int_equal(near_count, 1);
    release(&c);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_uses_stay_flat),
        cmocka_unit_test(uses_share_a_shape),
        cmocka_unit_test(wild_instances_stay_flat),
        cmocka_unit_test(a_mesh_far_from_its_origin_stays_flat),
        cmocka_unit_test(beyond_reach_all_is_flat),
        cmocka_unit_test(instances_are_seen_as_flat_ones),
        cmocka_unit_test(normals_of_instances_are_those_of_ellipsoids),
        cmocka_unit_test(instances_do_not_depend_on_threads),
        cmocka_unit_test(many_copies_are_cheap),
        cmocka_unit_test(near_copies_are_those_that_are_seen_largest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
