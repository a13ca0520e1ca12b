/* deform_test.c - skins and morph targets against an independent computation in double. */
#include "scene/motion_test_support.h"

#include <float.h>

enum { JOINTS = 5, VERTICES = 9000 /* several parts of the loop over vertices */ };

/* ---- the independent computation: matrices as rows of double, nothing shared with the tested code ---- */

typedef struct matrix {
    double a[4][4]; /* row, column */
} matrix;

static matrix multiply(matrix x, matrix y)
{
    matrix out = {{{0}}};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            for (int k = 0; k < 4; k++)
                out.a[i][j] += x.a[i][k] * y.a[k][j];
    return out;
}

static matrix from_mat4(const mat4 *m)
{
    matrix out;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            out.a[i][j] = (double)m->m[4 * j + i];
    return out;
}

/* Gauss and Jordan, with pivots. */
static matrix inverse(matrix m)
{
    matrix out = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    for (int c = 0; c < 4; c++) {
        int pivot = c;
        for (int r = c; r < 4; r++)
            if (fabs(m.a[r][c]) > fabs(m.a[pivot][c]))
                pivot = r;
        for (int k = 0; k < 4; k++) {
            double t = m.a[c][k];
            m.a[c][k] = m.a[pivot][k];
            m.a[pivot][k] = t;
            t = out.a[c][k];
            out.a[c][k] = out.a[pivot][k];
            out.a[pivot][k] = t;
        }
        double scale = 1.0 / m.a[c][c];
        for (int k = 0; k < 4; k++) {
            m.a[c][k] *= scale;
            out.a[c][k] *= scale;
        }
        for (int r = 0; r < 4; r++) {
            double factor = m.a[r][c];
            for (int k = 0; k < 4 && r != c; k++) {
                m.a[r][k] -= factor * m.a[c][k];
                out.a[r][k] -= factor * out.a[c][k];
            }
        }
    }
    return out;
}

static mat4 to_mat4(matrix m)
{
    mat4 out;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            out.m[4 * j + i] = (float)m.a[i][j];
    return out;
}

static matrix world_of(const facet_scene *scene, uint32_t node)
{
    const scene_node *n = &scene->nodes[node];
    dmat4 wide = dmat4_from_trs(n->translation, n->rotation, n->scale);
    mat4 local = mat4_from_double(&wide);
    matrix m = from_mat4(&local);
    return n->parent == SCENE_NONE ? m : multiply(world_of(scene, n->parent), m);
}

static void unit(double v[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

/* One vertex: morphed by the scene's weights of node 0, skinned by its skin. */
static void expect_vertex(const facet_scene *scene, const scene_primitive *p, uint32_t i, double position[3],
                          double normal[3], double tangent[3])
{
    for (uint32_t k = 0; k < 3; k++) {
        position[k] = (double)p->positions[3 * i + k];
        normal[k] = (double)p->normals[3 * i + k];
        tangent[k] = (double)p->tangents[4 * i + k];
        for (uint32_t t = 0; t < p->target_count; t++) {
            double w = (double)scene->meshes[0].weights[t];
            if (p->targets[t].positions)
                position[k] += w * (double)p->targets[t].positions[3 * i + k];
            if (p->targets[t].normals)
                normal[k] += w * (double)p->targets[t].normals[3 * i + k];
            if (p->targets[t].tangents)
                tangent[k] += w * (double)p->targets[t].tangents[3 * i + k];
        }
    }
    if (scene->nodes[0].skin != SCENE_NONE) {
        const scene_skin *skin = &scene->skins[scene->nodes[0].skin];
        matrix sum = {{{0}}};
        for (uint32_t k = 0; k < p->influence_count; k++) {
            uint32_t joint = p->joints[p->influence_count * i + k];
            matrix m = multiply(world_of(scene, skin->joints[joint]), from_mat4(&skin->inverse_bind[joint]));
            for (int r = 0; r < 16; r++)
                sum.a[r / 4][r % 4] += (double)p->weights[p->influence_count * i + k] * m.a[r / 4][r % 4];
        }
        matrix inverted = inverse(sum);
        double x[3], n[3], t[3];
        for (int r = 0; r < 3; r++) {
            x[r] = sum.a[r][3];
            n[r] = t[r] = 0.0;
            for (int c = 0; c < 3; c++) {
                x[r] += sum.a[r][c] * position[c];
                t[r] += sum.a[r][c] * tangent[c];
                n[r] += inverted.a[c][r] * normal[c]; /* the transpose */
            }
        }
        memcpy(position, x, sizeof x);
        memcpy(normal, n, sizeof n);
        memcpy(tangent, t, sizeof t);
    }
    unit(normal);
    unit(tangent);
}

/* ---- scenes ---- */

/* Node 0 has the mesh, 1 .. JOINTS are joints in a tree that hangs below node 1. Rotations, scales and
 * weights at random; inverse bind matrices of some other pose. */
static facet_scene *make_skinned(uint32_t vertex_count, uint32_t influence_count)
{
    static const uint32_t parents[JOINTS + 1] = {SCENE_NONE, SCENE_NONE, 1, 1, 3, 4};
    uint32_t random = 99;
    facet_scene *scene = test_scene(JOINTS + 1);
    test_tree(scene, parents);
    scene->nodes[0].mesh = 0;
    scene->nodes[0].skin = 0;
    scene_primitive *p = &scene->meshes[0].primitives[0];
    test_fill_primitive(scene, p, vertex_count);

    uint32_t *joints = arena_alloc(scene->arena, JOINTS, sizeof *joints);
    mat4 *binds = arena_alloc(scene->arena, JOINTS, sizeof *binds);
    scene->skins = arena_zalloc(scene->arena, 1, sizeof *scene->skins);
    scene->skin_count = 1;
    for (uint32_t i = 0; i < JOINTS; i++) {
        scene_node *n = &scene->nodes[i + 1];
        float away[3], rotation[4];
        for (int k = 0; k < 3; k++) {
            n->translation[k] = (double)test_random(&random);
            n->scale[k] = 1.0f + 0.4f * test_random(&random);
            away[k] = test_random(&random);
        }
        test_random_rotation(&random, n->rotation);
        test_random_rotation(&random, rotation);
        joints[i] = JOINTS - i; /* not in the order of the nodes */
        binds[i] = mat4_from_trs(away, rotation, n->scale);
    }
    scene->skins[0] = (scene_skin){
        .name = "", .joint_count = JOINTS, .joints = joints, .inverse_bind = binds, .skeleton = 1};

    p->influence_count = influence_count;
    uint16_t *numbers = arena_alloc(scene->arena, vertex_count, influence_count * sizeof *numbers);
    float *weights = arena_alloc(scene->arena, vertex_count, influence_count * sizeof *weights);
    for (uint32_t i = 0; i < vertex_count; i++) {
        float sum = 0.0f;
        for (uint32_t k = 0; k < influence_count; k++) {
            numbers[influence_count * i + k] = (uint16_t)((i + k) % JOINTS);
            /* Most of one joint, so that no blend of rotations is nearly singular. */
            float w = k == i % influence_count ? 3.0f : 0.3f * fabsf(test_random(&random));
            weights[influence_count * i + k] = w;
            sum += w;
        }
        for (uint32_t k = 0; k < influence_count; k++)
            weights[influence_count * i + k] /= sum;
    }
    p->joints = numbers;
    p->weights = weights;
    return scene;
}

/* Eight targets on the mesh of node 0, some without some attribute, some with weight 0. */
static void add_targets(facet_scene *scene)
{
    enum { TARGETS = 8 };
    uint32_t random = 5;
    scene_primitive *p = &scene->meshes[0].primitives[0];
    scene_morph_target *targets = arena_zalloc(scene->arena, TARGETS, sizeof *targets);
    float *weights = arena_alloc(scene->arena, TARGETS, sizeof *weights);
    for (uint32_t t = 0; t < TARGETS; t++) {
        float *changes = arena_alloc(scene->arena, 9 * (size_t)p->vertex_count, sizeof *changes);
        for (size_t i = 0; i < 9 * (size_t)p->vertex_count; i++)
            changes[i] = 0.2f * test_random(&random);
        targets[t].positions = t % 4 == 3 ? NULL : changes;
        targets[t].normals = t % 3 == 2 ? NULL : changes + 3 * (size_t)p->vertex_count;
        targets[t].tangents = t % 3 == 1 ? NULL : changes + 6 * (size_t)p->vertex_count;
        weights[t] = t == 4 ? 0.0f : 0.6f * test_random(&random);
    }
    p->target_count = TARGETS;
    p->targets = targets;
    scene->meshes[0].weight_count = TARGETS;
    scene->meshes[0].weights = weights;
}

static void assert_as_expected(const facet_scene *scene, const scene_instance *instance, double tolerance)
{
    const scene_primitive *p = instance->primitive;
    for (uint32_t i = 0; i < p->vertex_count; i += 7) {
        double position[3], normal[3], tangent[3];
        expect_vertex(scene, p, i, position, normal, tangent);
        for (uint32_t k = 0; k < 3; k++) {
            assert_near(instance->positions[3 * i + k], position[k], tolerance);
            assert_near(instance->normals[3 * i + k], normal[k], tolerance);
            assert_near(instance->tangents[4 * i + k], tangent[k], tolerance);
        }
        assert_near(instance->tangents[4 * i + 3], p->tangents[4 * i + 3], 0);
    }
}

static scene_pose rest(const facet_scene *scene)
{
    return test_pose_at(scene, 0, 0.0, 2);
}

/* ---- skins ---- */

static void skins_blend_any_number_of_joints(void **state)
{
    (void)state;
    for (uint32_t influences = 4; influences <= 12; influences += 4) {
        facet_scene *scene = make_skinned(VERTICES, influences);
        scene_pose pose = rest(scene);
        assert_int_equal(pose.instance_count, 1);
        assert_true(pose.instances[0].is_deformed);
        assert_as_expected(scene, &pose.instances[0], 2e-5);
        scene_pose_destroy(&pose);
        scene_destroy(scene);
    }
}

static void the_bind_pose_gives_the_mesh(void **state)
{
    (void)state;
    facet_scene *scene = make_skinned(VERTICES, 4);
    mat4 *binds = (mat4 *)(uintptr_t)scene->skins[0].inverse_bind;
    for (uint32_t i = 0; i < JOINTS; i++)
        binds[i] = to_mat4(inverse(world_of(scene, scene->skins[0].joints[i])));
    scene_pose pose = rest(scene);
    const scene_instance *instance = &pose.instances[0];
    for (uint32_t i = 0; i < 3 * VERTICES; i++) {
        assert_near(instance->positions[i], instance->primitive->positions[i], 1e-6);
        assert_near(instance->normals[i], instance->primitive->normals[i], 1e-6);
    }
    scene_pose_destroy(&pose);

    /* Joints at rest keep vertices to the last bit, however the sum of weights is rounded. */
    for (uint32_t i = 0; i <= JOINTS; i++)
        scene->nodes[i] = (scene_node){.name = "",
                                       .parent = scene->nodes[i].parent,
                                       .child_count = scene->nodes[i].child_count,
                                       .children = scene->nodes[i].children,
                                       .rotation = {0, 0, 0, 1},
                                       .scale = {1, 1, 1},
                                       .mesh = i ? SCENE_NONE : 0,
                                       .skin = i ? SCENE_NONE : 0,
                                       .camera = SCENE_NONE,
                                       .light = SCENE_NONE};
    scene->skins[0].inverse_bind = NULL;
    pose = rest(scene);
    assert_memory_equal(pose.instances[0].positions, scene->meshes[0].primitives[0].positions,
                        3 * VERTICES * sizeof(float));
    assert_near(pose.bounds_max[1], scene->meshes[0].primitives[0].bounds_max[1], 0);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void the_node_of_a_skinned_mesh_does_not_matter(void **state)
{
    (void)state;
    facet_scene *scene = make_skinned(30, 4);
    scene_pose before = rest(scene);
    scene->nodes[0].translation[0] = 100;
    scene->nodes[0].scale[1] = 0; /* singular: not drawn */
    scene_pose after = rest(scene);
    assert_int_equal(after.instance_count, 1);
    assert_memory_equal(before.instances[0].positions, after.instances[0].positions, 90 * sizeof(float));
    const mat4 identity = mat4_identity();
    assert_memory_equal(&after.instances[0].world, &identity, sizeof identity);
    scene_pose_destroy(&before);
    scene_pose_destroy(&after);
    scene_destroy(scene);
}

static void joints_move_vertices_if_hidden_or_outside_the_scene(void **state)
{
    (void)state;
    facet_scene *scene = make_skinned(30, 4);
    scene->nodes[1].is_hidden = true;
    scene_pose pose = rest(scene);
    assert_as_expected(scene, &pose.instances[0], 1e-5);
    scene_pose_destroy(&pose);
    scene->nodes[1].is_hidden = false;
    scene->scenes[0].node_count = 1; /* node 0: the joints are in no scene */
    pose = rest(scene);
    assert_as_expected(scene, &pose.instances[0], 1e-5);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void mirrored_skins_are_mirrored_instances(void **state)
{
    (void)state;
    facet_scene *scene = make_skinned(300, 4);
    scene->nodes[1].scale[2] *= -1.0f; /* above all joints */
    scene_pose pose = rest(scene);
    const scene_instance *instance = &pose.instances[0];
    assert_true(instance->is_mirrored);
    for (uint32_t i = 0; i < 300; i++) {
        double position[3], normal[3], tangent[3], length = 0.0, n[3];
        float p[3], t[3];
        expect_vertex(scene, instance->primitive, i, position, normal, tangent);
        mat4_transform_point(&instance->world, instance->positions + 3 * i, p);
        mat4_transform_vector(&instance->world, instance->tangents + 4 * i, t);
        for (int k = 0; k < 3; k++) {
            n[k] = 0.0;
            for (int j = 0; j < 3; j++)
                n[k] += (double)instance->normal_matrix[3 * k + j] *
                        (double)instance->normals[3 * i + (uint32_t)j];
            length += n[k] * n[k];
        }
        for (int k = 0; k < 3; k++) {
            assert_near(p[k], position[k], 1e-5);
            assert_near(n[k] / sqrt(length), normal[k],
                        1e-5); /* outward: the inverse transpose keeps the side */
            assert_near(t[k], tangent[k], 1e-5);
        }
    }
    /* The bounds are those in the world. */
    for (int k = 0; k < 3; k++) {
        float low = FLT_MAX, high = -FLT_MAX;
        for (uint32_t i = 0; i < 300; i++) {
            float p[3];
            mat4_transform_point(&instance->world, instance->positions + 3 * i, p);
            low = fminf(low, p[k]);
            high = fmaxf(high, p[k]);
        }
        assert_near(pose.bounds_min[k], low, 0);
        assert_near(pose.bounds_max[k], high, 0);
    }
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void assert_unit(const float *v)
{
    assert_near(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], 1.0, 1e-5);
}

static void joints_without_volume_keep_directions_unit(void **state)
{
    (void)state;
    static const float scales[3][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
    for (int s = 0; s < 3; s++) {
        facet_scene *scene = make_skinned(60, 4);
        memcpy(scene->nodes[1].scale, scales[s], sizeof scales[s]);
        scene_pose pose = rest(scene);
        assert_int_equal(pose.instance_count, 1);
        for (uint32_t i = 0; i < 60; i++) {
            assert_unit(pose.instances[0].normals + 3 * i);
            assert_unit(pose.instances[0].tangents + 4 * i);
        }
        scene_pose_destroy(&pose);
        scene_destroy(scene);
    }
}

static void tiny_and_huge_joints_keep_the_direction_of_normals(void **state)
{
    (void)state;
    for (int s = 0; s < 2; s++) {
        facet_scene *scene = make_skinned(60, 4);
        scene_pose usual = rest(scene);
        for (int k = 0; k < 3; k++)
            scene->nodes[1].scale[k] *= s ? 1e14f : 1e-18f;
        scene_pose scaled = rest(scene);
        assert_int_equal(scaled.instance_count, 1);
        for (uint32_t i = 0; i < 180; i++)
            assert_near(scaled.instances[0].normals[i], usual.instances[0].normals[i], 1e-5);
        scene_pose_destroy(&usual);
        scene_pose_destroy(&scaled);
        scene_destroy(scene);
    }
}

static void joints_beyond_the_limit_exclude_their_primitive(void **state)
{
    (void)state;
    static const float far_out[4] = {2e17f, 3e38f, INFINITY, NAN};
    for (int i = 0; i < 4; i++) {
        facet_scene *scene = make_skinned(30, 4);
        scene->nodes[5].translation[0] = (double)far_out[i];
        scene_pose pose = rest(scene);
        assert_int_equal(pose.instance_count, 0);
        assert_false(pose.has_bounds);
        scene_pose_destroy(&pose);
        /* Node 5 is joint 0 and moves no vertex, so that nothing is lost. */
        float *weights = (float *)(uintptr_t)scene->meshes[0].primitives[0].weights;
        const uint16_t *joints = scene->meshes[0].primitives[0].joints;
        for (uint32_t k = 0; k < 120; k++)
            weights[k] = joints[k] == 0 ? 0.0f : 0.25f;
        pose = rest(scene);
        assert_int_equal(pose.instance_count, 1);
        assert_true(pose.has_bounds && pose.bounds_max[0] < 100.0f);
        scene_pose_destroy(&pose);
        scene_destroy(scene);
    }
}

static void missing_joints_have_no_effect(void **state)
{
    (void)state;
    facet_scene *scene = make_skinned(30, 4);
    uint16_t *joints = (uint16_t *)(uintptr_t)scene->meshes[0].primitives[0].joints;
    for (uint32_t k = 0; k < 4; k++)
        joints[k] = (uint16_t)(k == 0 ? 65535 : JOINTS + k);
    scene_pose pose = rest(scene);
    for (int k = 0; k < 3; k++)
        assert_near(pose.instances[0].positions[k], scene->meshes[0].primitives[0].positions[k], 1e-6);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

/* ---- morph targets ---- */

static facet_scene *make_morphed(uint32_t vertex_count)
{
    facet_scene *scene = test_scene(2);
    test_fill_primitive(scene, &scene->meshes[0].primitives[0], vertex_count);
    scene->nodes[1].mesh = 0;
    add_targets(scene);
    return scene;
}

static void targets_add_to_positions_normals_and_tangents(void **state)
{
    (void)state;
    facet_scene *scene = make_morphed(VERTICES);
    scene->nodes[1].translation[0] = 3;
    scene_pose pose = rest(scene);
    assert_int_equal(pose.instance_count, 2);
    assert_as_expected(scene, &pose.instances[0], 2e-6);
    assert_ptr_equal(pose.instances[0].positions,
                     pose.instances[1].positions); /* shared: all that differs is world */
    assert_near(pose.instances[1].world.m[12], 3, 0);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void weights_of_a_node_are_its_own(void **state)
{
    (void)state;
    static const float only_first[8] = {1, 0, 0, 0, 0, 0, 0, 0};
    facet_scene *scene = make_morphed(30);
    scene->nodes[1].weights = only_first;
    scene_pose pose = rest(scene);
    const scene_primitive *p = pose.instances[0].primitive;
    assert_as_expected(scene, &pose.instances[0], 1e-6);
    for (uint32_t i = 0; i < 90; i++)
        assert_near(pose.instances[1].positions[i], p->positions[i] + p->targets[0].positions[i], 1e-6);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void only_displaced_attributes_are_new_arrays(void **state)
{
    (void)state;
    static float weights[8];
    facet_scene *scene = make_morphed(30);
    scene->meshes[0].weights = weights;
    scene_primitive *p = &scene->meshes[0].primitives[0];
    for (int i = 0; i < 3; i++) {
        memset(weights, 0, sizeof weights);
        weights[7] = i ? 1.0f : 0.0f;      /* target 7: no positions, no tangents */
        weights[2] = i == 2 ? 1.0f : 0.0f; /* target 2: no normals */
        scene_pose pose = rest(scene);
        const scene_instance *instance = &pose.instances[0];
        assert_int_equal(instance->is_deformed, i > 0);
        assert_int_equal(instance->positions == p->positions, i < 2);
        assert_int_equal(instance->normals == p->normals, i < 1);
        assert_int_equal(instance->tangents == p->tangents, i < 2);
        scene_pose_destroy(&pose);
    }
    scene_destroy(scene);
}

static void skins_move_morphed_vertices(void **state)
{
    (void)state;
    facet_scene *scene = make_skinned(VERTICES, 4);
    add_targets(scene);
    scene_pose pose = rest(scene);
    assert_as_expected(scene, &pose.instances[0], 3e-5);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void huge_weights_exclude_the_primitive(void **state)
{
    (void)state;
    static float weights[8];
    static const float huge[3] = {1e18f, 1e30f, FLT_MAX};
    facet_scene *scene = make_morphed(30);
    scene->meshes[0].weights = weights;
    for (int i = 0; i < 3; i++) {
        weights[0] = weights[1] = huge[i];
        weights[2] = -huge[i];
        scene_pose pose = rest(scene);
        assert_int_equal(pose.instance_count, 0);
        scene_pose_destroy(&pose);
    }
    /* The same normals with unchanged positions: directions are unit in any case. */
    memset(weights, 0, sizeof weights);
    weights[7] = FLT_MAX;
    weights[3] = -FLT_MAX;
    scene_pose pose = rest(scene);
    assert_int_equal(pose.instance_count, 2);
    for (uint32_t i = 0; i < 30; i++)
        assert_unit(pose.instances[0].normals + 3 * i);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void one_non_finite_vertex_excludes_the_primitive(void **state)
{
    (void)state;
    /* Both displacements are infinite at one vertex, and their sum is NaN, which a comparison of bounds
     * would miss. */
    enum { COUNT = 9 };
    static float up[3 * COUNT], down[3 * COUNT];
    static const float weights[2] = {FLT_MAX, FLT_MAX};
    up[12] = 10;
    down[12] = -10;
    const scene_morph_target targets[2] = {{.positions = up}, {.positions = down}};
    facet_scene *scene = test_scene(1);
    scene_primitive *p = &scene->meshes[0].primitives[0];
    test_fill_primitive(scene, p, COUNT);
    p->targets = targets;
    p->target_count = scene->meshes[0].weight_count = 2;
    scene->meshes[0].weights = weights;
    scene_pose pose = rest(scene);
    assert_int_equal(pose.instance_count, 0);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
    scene = make_skinned(30, 4);
    float *w = (float *)(uintptr_t)scene->meshes[0].primitives[0].weights;
    float *x = (float *)(uintptr_t)scene->meshes[0].primitives[0].positions;
    w[0] = w[1] = INFINITY; /* readers reject such values */
    x[0] = 1;
    pose = rest(scene);
    assert_int_equal(pose.instance_count, 0);
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

/* ---- flat normals, bounds, threads, memory ---- */

static void flat_normals_follow_their_triangles(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        facet_scene *scene = kind == 2 ? make_skinned(VERTICES, 4) : make_morphed(VERTICES);
        scene_primitive *p = &scene->meshes[0].primitives[0];
        for (uint32_t t = 0; t < p->target_count && kind == 1; t++) /* positions alone */
            ((scene_morph_target *)(uintptr_t)p->targets)[t].normals = NULL;
        p->has_flat_normals = true;
        p->tangents = NULL;
        scene_pose pose = rest(scene);
        const scene_instance *instance = &pose.instances[0];
        assert_null(instance->tangents);
        for (uint32_t i = 0; i < VERTICES; i += 3) {
            const float *x = instance->positions + 3 * i;
            double u[3], v[3], n[3];
            for (int k = 0; k < 3; k++) {
                u[k] = (double)x[3 + k] - (double)x[k];
                v[k] = (double)x[6 + k] - (double)x[k];
            }
            for (int k = 0; k < 3; k++)
                n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
            unit(n);
            for (int k = 0; k < 9; k++)
                assert_near(instance->normals[3 * i + (uint32_t)k], n[k % 3], 1e-6);
        }
        scene_pose_destroy(&pose);
        scene_destroy(scene);
    }
}

static void bounds_enclose_moved_vertices(void **state)
{
    (void)state;
    facet_scene *scene = make_morphed(VERTICES);
    scene->meshes[0].primitives[0].index_count = VERTICES - 3; /* the last three are not drawn */
    test_random_rotation(&(uint32_t){3}, scene->nodes[1].rotation);
    scene->scenes[0].node_count = 2;
    scene_pose pose = rest(scene);
    for (int axis = 0; axis < 3; axis++) {
        float low = FLT_MAX, high = -FLT_MAX;
        for (uint32_t n = 0; n < 2; n++)
            for (uint32_t i = 0; i < VERTICES - 3; i++) {
                float p[3];
                mat4_transform_point(&pose.instances[n].world, pose.instances[n].positions + 3 * i, p);
                low = fminf(low, p[axis]);
                high = fmaxf(high, p[axis]);
            }
        assert_near(pose.bounds_min[axis], low, 0);
        assert_near(pose.bounds_max[axis], high, 0);
    }
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void results_do_not_depend_on_threads(void **state)
{
    (void)state;
    facet_scene *scene = make_skinned(VERTICES, 8);
    add_targets(scene);
    scene_pose one = test_pose_at(scene, 0, 0.0, 1);
    for (uint32_t threads = 2; threads <= 5; threads++) {
        scene_pose more = test_pose_at(scene, 0, 0.0, threads);
        assert_memory_equal(one.instances[0].positions, more.instances[0].positions,
                            3 * VERTICES * sizeof(float));
        assert_memory_equal(one.instances[0].normals, more.instances[0].normals,
                            3 * VERTICES * sizeof(float));
        assert_memory_equal(one.instances[0].tangents, more.instances[0].tangents,
                            4 * VERTICES * sizeof(float));
        assert_memory_equal(one.bounds_min, more.bounds_min, sizeof one.bounds_min);
        scene_pose_destroy(&more);
    }
    scene_pose_destroy(&one);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(skins_blend_any_number_of_joints),
        cmocka_unit_test(the_bind_pose_gives_the_mesh),
        cmocka_unit_test(the_node_of_a_skinned_mesh_does_not_matter),
        cmocka_unit_test(joints_move_vertices_if_hidden_or_outside_the_scene),
        cmocka_unit_test(mirrored_skins_are_mirrored_instances),
        cmocka_unit_test(joints_without_volume_keep_directions_unit),
        cmocka_unit_test(tiny_and_huge_joints_keep_the_direction_of_normals),
        cmocka_unit_test(joints_beyond_the_limit_exclude_their_primitive),
        cmocka_unit_test(missing_joints_have_no_effect),
        cmocka_unit_test(targets_add_to_positions_normals_and_tangents),
        cmocka_unit_test(weights_of_a_node_are_its_own),
        cmocka_unit_test(only_displaced_attributes_are_new_arrays),
        cmocka_unit_test(skins_move_morphed_vertices),
        cmocka_unit_test(huge_weights_exclude_the_primitive),
        cmocka_unit_test(one_non_finite_vertex_excludes_the_primitive),
        cmocka_unit_test(flat_normals_follow_their_triangles),
        cmocka_unit_test(bounds_enclose_moved_vertices),
        cmocka_unit_test(results_do_not_depend_on_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
