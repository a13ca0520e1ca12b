/* tangents_test.c - tangents: unit, perpendicular, signed, independent of order; equal to those of
 * surfaces with a formula, and to MikkTSpace in other tools. */
#include "scene/scene_test_support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A grid of quads over (s, t) in [0, 1]^2. */
enum { SIZE = 12, VERTICES = (SIZE + 1) * (SIZE + 1), INDICES = 6 * SIZE * SIZE };

typedef struct grid {
    float positions[3 * VERTICES], normals[3 * VERTICES], uvs[2 * VERTICES];
    const float *sets[1];
    uint32_t indices[INDICES];
    scene_primitive primitive;
    float tangents[4 * INDICES];
} grid;

static grid *make_grid(void (*shape)(float s, float t, float position[3], float normal[3], float uv[2]))
{
    grid *g = calloc(1, sizeof *g);
    assert_non_null(g);
    for (uint32_t row = 0; row <= SIZE; row++)
        for (uint32_t column = 0; column <= SIZE; column++) {
            uint32_t i = row * (SIZE + 1) + column;
            shape((float)column / SIZE, (float)row / SIZE, g->positions + 3 * i, g->normals + 3 * i,
                  g->uvs + 2 * i);
        }
    uint32_t count = 0;
    for (uint32_t row = 0; row < SIZE; row++)
        for (uint32_t column = 0; column < SIZE; column++) {
            uint32_t a = row * (SIZE + 1) + column;
            const uint32_t quad[6] = {a, a + 1, a + SIZE + 2, a, a + SIZE + 2, a + SIZE + 1};
            for (int k = 0; k < 6; k++)
                g->indices[count++] = quad[k];
        }
    g->sets[0] = g->uvs;
    g->primitive = (scene_primitive){.mode = SCENE_TRIANGLES,
                                     .vertex_count = VERTICES,
                                     .index_count = INDICES,
                                     .indices = g->indices,
                                     .positions = g->positions,
                                     .normals = g->normals,
                                     .texcoord_count = 1,
                                     .texcoords = g->sets};
    return g;
}

static void generate(grid *g)
{
    assert_int_equal(scene_generate_tangents(&g->primitive, 0, NULL, g->tangents, NULL), FACET_OK);
    for (size_t i = 0; i < g->primitive.index_count; i++) {
        const float *t = g->tangents + 4 * i;
        const float *n = g->normals + 3 * (size_t)g->indices[i];
        assert_near(t[0] * t[0] + t[1] * t[1] + t[2] * t[2], 1, 1e-5);
        assert_near(t[0] * n[0] + t[1] * n[1] + t[2] * n[2], 0, 1e-5);
        assert_true(t[3] == 1.0f || t[3] == -1.0f);
    }
}

/* The plane z = 0 with an upright image: v grows downwards. */
static void plane(float s, float t, float position[3], float normal[3], float uv[2])
{
    memcpy(position, (const float[3]){3 * s, 2 * t, 0}, 3 * sizeof *position);
    memcpy(normal, (const float[3]){0, 0, 1}, 3 * sizeof *normal);
    memcpy(uv, (const float[2]){s, 1 - t}, 2 * sizeof *uv);
}

/* A cylinder around +Y, u around it to the right as seen from outside. */
static void cylinder(float s, float t, float position[3], float normal[3], float uv[2])
{
    float angle = 5.0f * s;
    memcpy(normal, (const float[3]){sinf(angle), 0, cosf(angle)}, 3 * sizeof *normal);
    memcpy(position, (const float[3]){normal[0], 2 * t, normal[2]}, 3 * sizeof *position);
    memcpy(uv, (const float[2]){4 * s, 1 - t}, 2 * sizeof *uv);
}

/* The plane with its image mirrored on the right half. */
static void mirrored_plane(float s, float t, float position[3], float normal[3], float uv[2])
{
    plane(s, t, position, normal, uv);
    uv[0] = s > 0.5f ? 1.0f - s : s;
}

static void the_tangent_of_a_plane_is_its_u(void **state)
{
    (void)state;
    grid *g = make_grid(plane);
    generate(g);
    for (size_t i = 0; i < INDICES; i++) {
        assert_near(g->tangents[4 * i], 1, 1e-6);
        /* B = w cross(N, T) = +Y, up in the image. */
        assert_near(g->tangents[4 * i + 3], 1, 0);
    }
    free(g);
}

static void the_tangent_of_a_cylinder_goes_around(void **state)
{
    (void)state;
    grid *g = make_grid(cylinder);
    generate(g);
    for (size_t i = 0; i < INDICES; i++) {
        const float *n = g->normals + 3 * (size_t)g->indices[i];
        assert_near(g->tangents[4 * i], n[2], 1e-5);
        assert_near(g->tangents[4 * i + 1], 0, 1e-5);
        assert_near(g->tangents[4 * i + 2], -n[0], 1e-5);
        assert_near(g->tangents[4 * i + 3], 1, 0);
    }
    free(g);
}

static void mirrored_halves_keep_their_own_tangents(void **state)
{
    (void)state;
    grid *g = make_grid(mirrored_plane);
    generate(g);
    for (size_t i = 0; i < INDICES; i++) {
        /* By triangle, not by vertex: vertices on the seam are split by orientation. */
        size_t triangle = i / 3;
        bool is_mirrored = triangle / 2 % SIZE >= SIZE / 2;
        assert_near(g->tangents[4 * i], is_mirrored ? -1 : 1, 1e-6);
        assert_near(g->tangents[4 * i + 3], is_mirrored ? -1 : 1, 0);
    }
    free(g);
}

static void unwelded_vertices_give_the_same(void **state)
{
    (void)state;
    grid *g = make_grid(cylinder);
    generate(g);
    /* Each corner a vertex of its own. */
    float *split = malloc(8 * sizeof *split * INDICES);
    uint32_t *indices = malloc(sizeof *indices * INDICES);
    float *tangents = malloc(4 * sizeof *tangents * INDICES);
    assert_true(split && indices && tangents);
    float *positions = split;
    float *normals = split + 3 * INDICES;
    float *uvs = split + 6 * INDICES;
    for (uint32_t i = 0; i < INDICES; i++) {
        indices[i] = i;
        memcpy(positions + 3 * i, g->positions + 3 * g->indices[i], 3 * sizeof *split);
        memcpy(normals + 3 * i, g->normals + 3 * g->indices[i], 3 * sizeof *split);
        memcpy(uvs + 2 * i, g->uvs + 2 * g->indices[i], 2 * sizeof *split);
    }
    const float *sets[1] = {uvs};
    scene_primitive p = g->primitive;
    p.vertex_count = INDICES;
    p.indices = indices;
    p.positions = positions;
    p.normals = normals;
    p.texcoords = sets;
    assert_int_equal(scene_generate_tangents(&p, 0, NULL, tangents, NULL), FACET_OK);
    assert_memory_equal(tangents, g->tangents, sizeof g->tangents);
    free(split);
    free(indices);
    free(tangents);
    free(g);
}

static void the_order_of_triangles_does_not_matter(void **state)
{
    (void)state;
    grid *g = make_grid(mirrored_plane);
    for (size_t i = 0; i < VERTICES; i++) /* a hill, so that angles and sums are not trivial */
        g->positions[3 * i + 2] = 0.3f * sinf(2.0f * g->positions[3 * i]) * g->positions[3 * i + 1];
    generate(g);
    float *before = malloc(sizeof g->tangents);
    assert_non_null(before);
    memcpy(before, g->tangents, sizeof g->tangents);
    enum { TRIANGLES = INDICES / 3, STEP = 101 }; /* without common divisor */
    uint32_t *indices = malloc(sizeof g->indices);
    assert_non_null(indices);
    memcpy(indices, g->indices, sizeof g->indices);
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        const uint32_t *from = indices + 3 * (i * STEP % TRIANGLES);
        /* Turned, too: another corner first. */
        for (uint32_t k = 0; k < 3; k++)
            g->indices[3 * i + k] = from[(k + i) % 3];
    }
    generate(g);
    for (uint32_t i = 0; i < TRIANGLES; i++)
        for (uint32_t k = 0; k < 3; k++) {
            const float *a = g->tangents + 4 * (3 * i + k);
            const float *b = before + 4 * (3 * (i * STEP % TRIANGLES) + (k + i) % 3);
            for (int c = 0; c < 4; c++)
                assert_near(a[c], b[c], 1e-5); /* sums in another order */
        }
    free(before);
    free(indices);
    free(g);
}

static void degenerate_input_gives_unit_tangents(void **state)
{
    (void)state;
    grid *g = make_grid(plane);
    /* No area in the texture on the left, none in space at the bottom, finite nonsense at the right. */
    for (uint32_t i = 0; i < VERTICES; i++) {
        if (g->positions[3 * i] < 1.0f)
            memset(g->uvs + 2 * i, 0, 2 * sizeof *g->uvs);
        if (g->positions[3 * i + 1] < 0.5f)
            g->positions[3 * i] = 0.0f;
        if (g->positions[3 * i] > 2.5f)
            g->positions[3 * i + 1] = 1e17f;
    }
    generate(g);
    memset(g->uvs, 0, sizeof g->uvs);
    generate(g);
    memset(g->positions, 0, sizeof g->positions);
    generate(g);
    g->primitive.index_count = 0;
    generate(g);
    free(g);
}

static void many_triangles_at_one_vertex_are_quick(void **state)
{
    (void)state;
    /* A fan, and thousands of triangles on the same edge: neither may take quadratic time. */
    enum { FAN = 60000 };
    float *positions = calloc(3 * (FAN + 2), sizeof *positions);
    float *normals = calloc(3 * (FAN + 2), sizeof *normals);
    float *uvs = calloc(2 * (FAN + 2), sizeof *uvs);
    uint32_t *indices = calloc(3 * FAN, sizeof *indices);
    float *tangents = calloc(12 * FAN, sizeof *tangents);
    assert_true(positions && normals && uvs && indices && tangents);
    const float *sets[1] = {uvs};
    for (uint32_t i = 0; i < FAN + 2; i++) {
        float angle = (float)i * 1e-4f;
        positions[3 * i] = uvs[2 * i] = i ? cosf(angle) : 0.0f;
        positions[3 * i + 1] = uvs[2 * i + 1] = i ? sinf(angle) : 0.0f;
        normals[3 * i + 2] = 1.0f;
    }
    scene_primitive p = {.mode = SCENE_TRIANGLES,
                         .vertex_count = FAN + 2,
                         .index_count = 3 * FAN,
                         .indices = indices,
                         .positions = positions,
                         .normals = normals,
                         .texcoord_count = 1,
                         .texcoords = sets};
    for (int same_edge = 0; same_edge < 2; same_edge++) {
        for (uint32_t i = 0; i < FAN; i++) {
            indices[3 * i] = 0;
            indices[3 * i + 1] = same_edge ? 1 : i + 1;
            indices[3 * i + 2] = i + 2;
        }
        assert_int_equal(scene_generate_tangents(&p, 0, NULL, tangents, NULL), FACET_OK);
        assert_near(tangents[0], 1, 1e-3);
    }
    free(positions);
    free(normals);
    free(uvs);
    free(indices);
    free(tangents);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_tangent_of_a_plane_is_its_u),
        cmocka_unit_test(the_tangent_of_a_cylinder_goes_around),
        cmocka_unit_test(mirrored_halves_keep_their_own_tangents),
        cmocka_unit_test(unwelded_vertices_give_the_same),
        cmocka_unit_test(the_order_of_triangles_does_not_matter),
        cmocka_unit_test(degenerate_input_gives_unit_tangents),
        cmocka_unit_test(many_triangles_at_one_vertex_are_quick),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
