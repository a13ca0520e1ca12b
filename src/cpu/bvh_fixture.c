/* bvh_fixture.c - see bvh_fixture.h. */
#include "cpu/bvh_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"

enum { COLUMNS = 96, ROWS = 48, SOUP = 20000, SPRITES = 3000, INSTANCES = 400 };

const char *bvh_fixture_name(int kind)
{
    static const char *const names[BVH_FIXTURES] = {"sphere", "soup", "slivers", "sprites", "instances"};
    return names[kind];
}

static float uniform(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) * (1.0f / 16777216.0f);
}

static void *keep(bvh_fixture *f, size_t count, size_t size)
{
    void *block = mem_zalloc(&f->allocator, count, size);
    assert_non_null(block);
    f->blocks[f->block_count++] = block;
    return block;
}

static void make_indices(bvh_fixture *f, scene_primitive *p, uint32_t count)
{
    uint32_t *indices = keep(f, count, sizeof *indices);
    for (uint32_t i = 0; i < count; i++)
        indices[i] = i;
    p->indices = indices;
    p->index_count = count;
    p->vertex_count = count;
}

static float *make_sphere(bvh_fixture *f, scene_primitive *p)
{
    const uint32_t ring = COLUMNS;
    p->vertex_count = ring * (ROWS - 1) + 2;
    float *v = keep(f, p->vertex_count + 1, 3 * sizeof *v);
    uint32_t *indices = keep(f, 6 * ring * (ROWS - 1), sizeof *indices);
    uint32_t count = 0;
    v[1] = 1.0f;
    v[3 * (size_t)(p->vertex_count - 1) + 1] = -1.0f;
    for (uint32_t row = 1; row < ROWS; row++)
        for (uint32_t column = 0; column < ring; column++) {
            const double theta = 3.14159265358979 * row / ROWS;
            const double phi = 2.0 * 3.14159265358979 * column / ring;
            float *out = v + 3 * (size_t)(1 + (row - 1) * ring + column);
            out[0] = (float)(sin(theta) * sin(phi));
            out[1] = (float)cos(theta);
            out[2] = (float)(sin(theta) * cos(phi));
        }
    for (uint32_t row = 0; row < ROWS; row++)
        for (uint32_t column = 0; column < ring; column++) {
            const uint32_t next = (column + 1) % ring;
            const uint32_t above = 1 + (row - 1) * ring, below = 1 + row * ring;
            const uint32_t last = p->vertex_count - 1;
            const uint32_t corners[2][3] = {{row ? above + column : 0,
                                             row == ROWS - 1 ? last : below + column,
                                             row == ROWS - 1 ? above + next : below + next},
                                            {above + column, below + next, above + next}};
            for (int i = 0; i < (row > 0 && row < ROWS - 1 ? 2 : 1); i++) {
                memcpy(indices + count, corners[i], sizeof corners[i]);
                count += 3;
            }
        }
    p->indices = indices;
    p->index_count = count;
    return v;
}

static float *make_soup(bvh_fixture *f, scene_primitive *p, uint32_t triangles, float longest, float width)
{
    uint32_t state = 7;
    float *v = keep(f, 3 * triangles + 1, 3 * sizeof *v);
    for (uint32_t i = 0; i < triangles; i++) {
        const float size = longest * powf(uniform(&state), 4.0f);
        float a[3], b[3];
        for (int k = 0; k < 3; k++) {
            v[9 * i + (uint32_t)k] = uniform(&state);
            a[k] = uniform(&state) - 0.5f;
            b[k] = uniform(&state) - 0.5f;
        }
        for (uint32_t k = 0; k < 3; k++) {
            v[9 * i + 3 + k] = v[9 * i + k] + size * a[k];
            v[9 * i + 6 + k] = v[9 * i + k] + size * (0.5f * a[k] + width * b[k]);
        }
    }
    make_indices(f, p, 3 * triangles);
    return v;
}

static float *make_sprites(bvh_fixture *f, scene_primitive *p, scene_mode mode)
{
    uint32_t state = 11 + (uint32_t)mode;
    const uint32_t count = SPRITES * (mode == SCENE_LINES ? 2 : 1);
    float *v = keep(f, count + 1, 4 * sizeof *v);
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < 3; k++)
            v[4 * i + k] = mode == SCENE_LINES && i % 2 ? v[4 * i - 4 + k] + 0.2f * (uniform(&state) - 0.5f)
                                                        : uniform(&state);
        v[4 * i + 3] = 0.002f + 0.004f * uniform(&state);
    }
    p->mode = mode;
    make_indices(f, p, count);
    return v;
}

static void add(bvh_fixture *f, uint32_t primitive, float *vertices)
{
    f->set.items[f->set.count++] = (render_geometry){
        .primitive = &f->primitives[primitive], .material = &f->material, .vertices = vertices};
}

/* Inverse transposed, as render_geometry.c has it, but for its scale. */
static void set_normal_matrix(render_geometry *g)
{
    const float *m = g->world->m;
    float determinant = 0.0f;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            const int r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (column + 1) % 3, c2 = (column + 2) % 3;
            g->normal_matrix[3 * row + column] =
                m[4 * c1 + r1] * m[4 * c2 + r2] - m[4 * c1 + r2] * m[4 * c2 + r1];
        }
    for (int row = 0; row < 3; row++)
        determinant += m[row] * g->normal_matrix[3 * row];
    g->is_mirrored = determinant < 0.0f;
    for (int i = 0; g->is_mirrored && i < 9; i++)
        g->normal_matrix[i] = -g->normal_matrix[i];
}

static void make_instances(bvh_fixture *f)
{
    uint32_t state = 13;
    float *sphere = make_sphere(f, &f->primitives[0]);
    f->set.shapes = keep(f, 1, sizeof *f->set.shapes);
    f->set.shape_count = 1;
    f->set.shapes[0] = (render_shape){
        .primitive = &f->primitives[0], .positions = f->primitives[0].positions, .vertices = sphere};
    f->worlds = keep(f, INSTANCES, sizeof *f->worlds);
    for (uint32_t i = 0; i < INSTANCES; i++) {
        float *m = f->worlds[i].m;
        for (uint32_t k = 0; k < 12; k++)
            m[k] = k % 4 == 3 ? 0.0f : 0.2f * (uniform(&state) - 0.5f);
        for (uint32_t k = 0; k < 3; k++)
            m[12 + k] = 4.0f * uniform(&state);
        m[15] = 1.0f;
        add(f, 0, sphere);
        render_geometry *g = &f->set.items[i];
        g->role = RENDER_INSTANCED;
        g->world = &f->worlds[i];
        set_normal_matrix(g);
    }
    add(f, 1, make_soup(f, &f->primitives[1], 1000, 1.0f, 1.0f));
}

void bvh_fixture_create(bvh_fixture *f, int kind, uint32_t thread_count)
{
    memset(f, 0, sizeof *f);
    f->material = scene_material_default();
    for (int i = 0; i < 3; i++)
        f->primitives[i].mode = SCENE_TRIANGLES;
    f->set.items = keep(f, INSTANCES + 3, sizeof *f->set.items);
    switch (kind) {
    case BVH_SPHERE:
        add(f, 0, make_sphere(f, &f->primitives[0]));
        break;
    case BVH_SOUP:
        add(f, 0, make_soup(f, &f->primitives[0], SOUP, 1.0f, 1.0f));
        add(f, 1, make_soup(f, &f->primitives[1], SOUP / 7, 0.2f, 1.0f));
        break;
    case BVH_SLIVERS:
        add(f, 0, make_soup(f, &f->primitives[0], SOUP, 1.0f, 1e-3f));
        break;
    case BVH_SPRITES:
        add(f, 0, make_soup(f, &f->primitives[0], SOUP / 20, 0.2f, 1.0f));
        add(f, 1, make_sprites(f, &f->primitives[1], SCENE_LINES));
        add(f, 2, make_sprites(f, &f->primitives[2], SCENE_POINTS));
        f->set.has_sprites = true;
        break;
    default:
        make_instances(f);
        break;
    }
    const ray_scene_desc desc = {.ray_count = UINT64_MAX, .thread_count = thread_count};
    f->own.tracer = &bvh_tracer;
    assert_int_equal(f->own.tracer->create(&f->set, &desc, &f->allocator, &f->own.bvh, NULL), FACET_OK);
    if (embree_find_tracer(&f->embree.tracer, NULL) == FACET_OK)
        assert_int_equal(f->embree.tracer->create(&f->set, &desc, &f->allocator, &f->embree.bvh, NULL),
                         FACET_OK);
}

void bvh_fixture_destroy(bvh_fixture *f)
{
    ray_scene_destroy(&f->own);
    ray_scene_destroy(&f->embree);
    for (int i = 0; i < f->block_count; i++)
        mem_free(f->blocks[i]);
}
