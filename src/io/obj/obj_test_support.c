/* obj_test_support.c - see obj_test_support.h. */
#include "io/obj/obj_test_support.h"
#include "tests/support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

facet_scene *obj_load_text(const char *bytes, const facet_scene_desc *desc)
{
    facet_scene *scene = NULL;
    facet_error error = {0};
    /* A block of the exact size, so that sanitizers see one byte too many. */
    size_t size = strlen(bytes);
    char *copy = malloc(size ? size : 1);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    if (obj_load_memory(copy, size, "test.obj", desc, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    free(copy);
    obj_check_scene(scene);
    return scene;
}

facet_scene *obj_load_shared(const char *path)
{
    char whole[1024];
    const char *folder = test_data();
    snprintf(whole, sizeof whole, "%s/%s", folder, path);
    facet_scene *scene = NULL;
    facet_error error = {0};
    if (obj_load(whole, NULL, &scene, &error) != FACET_OK)
        fail_msg("%s", error.message);
    obj_check_scene(scene);
    return scene;
}

bool obj_has_warning(const facet_scene *scene, const char *text)
{
    for (uint32_t i = 0; i < scene->warning_count; i++)
        if (strstr(scene->warnings[i], text))
            return true;
    return false;
}

const scene_mesh *obj_find_mesh(const facet_scene *scene, const char *name)
{
    const scene_mesh *found = NULL;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        if (strcmp(scene->meshes[i].name, name) == 0) {
            assert_null(found);
            found = &scene->meshes[i];
        }
    if (!found)
        fail_msg("there is no mesh \"%s\"", name);
    return found;
}

const scene_primitive *obj_only_primitive(const facet_scene *scene)
{
    assert_int_equal(scene->mesh_count, 1);
    assert_int_equal(scene->meshes[0].primitive_count, 1);
    return &scene->meshes[0].primitives[0];
}

const float *obj_position(const scene_primitive *p, size_t i)
{
    return p->positions + 3 * (size_t)p->indices[i];
}

const float *obj_normal(const scene_primitive *p, size_t i)
{
    return p->normals + 3 * (size_t)p->indices[i];
}

const float *obj_texcoord(const scene_primitive *p, size_t i)
{
    return p->texcoords[0] + 2 * (size_t)p->indices[i];
}

double obj_area(const scene_primitive *p)
{
    double sum = 0.0;
    for (size_t i = 0; i < p->index_count; i += 3) {
        double u[3];
        double v[3];
        for (int k = 0; k < 3; k++) {
            u[k] = (double)obj_position(p, i + 1)[k] - (double)obj_position(p, i)[k];
            v[k] = (double)obj_position(p, i + 2)[k] - (double)obj_position(p, i)[k];
        }
        double x = u[1] * v[2] - u[2] * v[1];
        double y = u[2] * v[0] - u[0] * v[2];
        double z = u[0] * v[1] - u[1] * v[0];
        sum += 0.5 * sqrt(x * x + y * y + z * z);
    }
    return sum;
}

static void check_primitive(const facet_scene *scene, const scene_primitive *p)
{
    static const uint32_t per[] = {1, 2, 3};
    assert_true(p->vertex_count > 0 && p->index_count > 0);
    assert_int_equal(p->index_count % per[p->mode], 0);
    assert_true(p->material == SCENE_NONE || p->material < scene->material_count);
    assert_true((p->normals != NULL) == (p->mode == SCENE_TRIANGLES));
    assert_true(!p->has_flat_normals || (p->mode == SCENE_TRIANGLES && p->vertex_count == p->index_count));
    float low[3] = {INFINITY, INFINITY, INFINITY};
    float high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < p->index_count; i++) {
        assert_true(p->indices[i] < p->vertex_count);
        for (int k = 0; k < 3; k++) {
            low[k] = fminf(low[k], obj_position(p, i)[k]);
            high[k] = fmaxf(high[k], obj_position(p, i)[k]);
        }
    }
    assert_memory_equal(low, p->bounds_min, sizeof low);
    assert_memory_equal(high, p->bounds_max, sizeof high);
    for (size_t i = 0; i < p->vertex_count; i++) {
        for (size_t k = 0; k < 3; k++)
            assert_true(fabsf(p->positions[3 * i + k]) <= SCENE_FARTHEST);
        if (p->normals) {
            const float *n = p->normals + 3 * i;
            assert_near(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1.0f, 1e-5f);
        }
        for (size_t k = 0; p->texcoord_count && k < 2; k++)
            assert_true(fabsf(p->texcoords[0][2 * i + k]) < INFINITY);
        for (size_t k = 0; p->colors && k < 4; k++)
            assert_true(p->colors[4 * i + k] >= 0.0f && p->colors[4 * i + k] <= 1.0f);
    }
}

void obj_check_scene(const facet_scene *scene)
{
    assert_non_null(scene->legacy);
    assert_int_equal(scene->default_scene, 0);
    assert_int_equal(scene->scene_count, 1);
    assert_int_equal(scene->scenes[0].node_count, scene->mesh_count);
    assert_int_equal(scene->node_count, scene->mesh_count);
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        assert_int_equal(scene->scenes[0].nodes[i], i);
        assert_int_equal(scene->nodes[i].mesh, i);
        assert_non_null(scene->meshes[i].name);
        assert_true(scene->meshes[i].primitive_count > 0);
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++)
            check_primitive(scene, &scene->meshes[i].primitives[k]);
    }
}

static void assert_same_floats(const float *a, const float *b, size_t count)
{
    assert_true((a != NULL) == (b != NULL));
    if (a)
        assert_memory_equal(a, b, count * sizeof *a);
}

static void assert_same_primitive(const scene_primitive *a, const scene_primitive *b)
{
    size_t count = a->vertex_count;
    assert_int_equal(a->mode, b->mode);
    assert_int_equal(a->material, b->material);
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->index_count, b->index_count);
    assert_int_equal(a->texcoord_count, b->texcoord_count);
    assert_int_equal(a->has_flat_normals, b->has_flat_normals);
    assert_memory_equal(a->indices, b->indices, a->index_count * sizeof *a->indices);
    assert_same_floats(a->positions, b->positions, 3 * count);
    assert_same_floats(a->normals, b->normals, 3 * count);
    assert_same_floats(a->colors, b->colors, 4 * count);
    if (a->texcoord_count)
        assert_same_floats(a->texcoords[0], b->texcoords[0], 2 * count);
    assert_same_floats(a->bounds_min, b->bounds_min, 3);
    assert_same_floats(a->bounds_max, b->bounds_max, 3);
}

void obj_assert_equal(const facet_scene *a, const facet_scene *b)
{
    assert_int_equal(a->mesh_count, b->mesh_count);
    assert_int_equal(a->warning_count, b->warning_count);
    for (uint32_t i = 0; i < a->warning_count; i++)
        assert_string_equal(a->warnings[i], b->warnings[i]);
    for (uint32_t i = 0; i < a->mesh_count; i++) {
        assert_string_equal(a->meshes[i].name, b->meshes[i].name);
        assert_int_equal(a->meshes[i].primitive_count, b->meshes[i].primitive_count);
        for (uint32_t k = 0; k < a->meshes[i].primitive_count; k++)
            assert_same_primitive(&a->meshes[i].primitives[k], &b->meshes[i].primitives[k]);
    }
}
