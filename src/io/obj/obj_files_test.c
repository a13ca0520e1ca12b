/* The OBJ files of the shared test data. Counts were found by counting words of f lines with awk. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/obj/obj_test_support.h"

static size_t count_triangles(const facet_scene *scene)
{
    size_t count = 0;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++)
            if (scene->meshes[i].primitives[k].mode == SCENE_TRIANGLES)
                count += scene->meshes[i].primitives[k].index_count / 3;
    return count;
}

/* The signed volume between all triangles and the origin: that of a closed surface that is wound outwards. */
static double find_volume(const facet_scene *scene)
{
    double volume = 0.0;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t j = 0; j < scene->meshes[i].primitive_count; j++) {
            const scene_primitive *p = &scene->meshes[i].primitives[j];
            for (size_t k = 0; k < p->index_count; k += 3) {
                const float *a = obj_position(p, k);
                const float *b = obj_position(p, k + 1);
                const float *c = obj_position(p, k + 2);
                double x = (double)b[1] * (double)c[2] - (double)b[2] * (double)c[1];
                double y = (double)b[2] * (double)c[0] - (double)b[0] * (double)c[2];
                double z = (double)b[0] * (double)c[1] - (double)b[1] * (double)c[0];
                volume += ((double)a[0] * x + (double)a[1] * y + (double)a[2] * z) / 6.0;
            }
        }
    return volume;
}

static void element_counts_match_the_files(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        size_t triangles;
        uint32_t meshes;
        double volume; /* 0: the surface is not closed */
    } files[] = {
        {"c-ray/teapot.obj", 2464, 1, 0},
        {"c-ray/torus.obj", 1152, 1, 0},
        {"cornell/CornellBox-Glossy.obj", 1112, 8, 0},
        {"cornell/CornellBox-Mirror.obj", 36, 7, 0}, /* group tallBox comes behind its faces */
        {"cornell/CornellBox-Original.obj", 36, 7, 0},
        {"cornell/CornellBox-Sphere.obj", 2188, 8, 0},
        {"obj2gltf/box-complex-material-alpha/box-complex-material-alpha.obj", 12, 1, 8},
        {"obj2gltf/box-complex-material/box-complex-material.obj", 12, 1, 8},
        {"obj2gltf/box-groups/box-groups.obj", 36, 3, 24},
        {"obj2gltf/box-incomplete-attributes/box-incomplete-normals.obj", 12, 1, 8},
        {"obj2gltf/box-incomplete-attributes/box-incomplete-positions.obj", 0, 0, 0},
        {"obj2gltf/box-incomplete-attributes/box-incomplete-uvs.obj", 12, 1, 8},
        {"obj2gltf/box-missing-mtllib/box-missing-mtllib.obj", 12, 1, 8},
        {"obj2gltf/box-missing-texture/box-missing-texture.obj", 12, 1, 8},
        {"obj2gltf/box-missing-usemtl/box-missing-usemtl.obj", 12, 1, 8},
        {"obj2gltf/box-mixed-attributes/box-mixed-attributes.obj", 12, 1, 8},
        {"obj2gltf/box-mtllib-spaces/box mtllib.obj", 12, 1, 8},
        {"obj2gltf/box-mtllib/box-mtllib.obj", 12, 1, 8},
        {"obj2gltf/box-multiple-materials/box-multiple-materials.obj", 12, 1, 8},
        {"obj2gltf/box-negative-indices/box-negative-indices.obj", 12, 1, 8},
        {"obj2gltf/box-objects-groups-materials/box-objects-groups-materials.obj", 36, 1, 24},
        {"obj2gltf/box-positions-only/box-positions-only.obj", 12, 1, 8},
        {"obj2gltf/box-subdirectories/box-textured.obj", 12, 1, 8},
        {"obj2gltf/box-texture-options/box-texture-options.obj", 12, 1, 8},
        {"obj2gltf/box-textured/box-textured.obj", 12, 1, 8},
        {"obj2gltf/box-transparent/box-transparent.obj", 12, 1, 8},
        {"obj2gltf/box-triangles/box-triangles.obj", 12, 1, 8},
        {"obj2gltf/box-unnormalized/box-unnormalized.obj", 12, 1, 8},
        {"obj2gltf/box-windows-paths/box-windows-paths.obj", 12, 1, 8},
        {"obj2gltf/box-with-tabs/box-with-tabs.obj", 12, 1, 8},
        {"obj2gltf/box/box.obj", 12, 1, 8},
        {"obj2gltf/concave/concave.obj", 16, 1, (4.0 - 0.87836) * 0.727044},
        {"tinyobjloader/cornell_box.obj", 36, 8, 0},
        {"tinyobjloader/cornell_box_multimaterial.obj", 36, 8, 0},
        {"tinyobjloader/cube-vertexcol.obj", 12, 6, 8},
        {"tinyobjloader/issue-95.obj", 1, 1, 0},
        {"tinyobjloader/leading-decimal-dot-issue-201.obj", 1, 1, 0},
        {"tinyobjloader/line-prim.obj", 0, 1, 0},
        {"tinyobjloader/map-bump.obj", 400, 1, 0},
        {"tinyobjloader/pbr-mat-ext.obj", 2, 1, 0},
        {"tinyobjloader/points-prim.obj", 0, 1, 0},
        {"tinyobjloader/refl.obj", 12, 6, 8},
        {"tinyobjloader/smoothing-group-two-squares.obj", 3, 1, 0},
        {"tinyobjloader/texture-options-issue-85.obj", 1, 1, 0},
        {"tinyobjloader/tr-and-d-issue-43.obj", 400, 1, 0},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[256];
        snprintf(path, sizeof path, "obj/%s", files[i].path);
        facet_scene *scene = obj_load_shared(path);
        if (count_triangles(scene) != files[i].triangles || scene->mesh_count != files[i].meshes)
            fail_msg("%s: %zu triangles in %u meshes", path, count_triangles(scene), scene->mesh_count);
        if (files[i].volume > 0.0 && fabs(find_volume(scene) - files[i].volume) > 1e-5)
            fail_msg("%s: has a volume of %.9g", path, find_volume(scene));
        scene_destroy(scene);
    }
}

/* "Load or refuse, never crash": all of these load, with warnings about their flaws. */
static void malformed_files_load_with_warnings(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        size_t triangles;
        const char *warning; /* NULL: none but about materials */
    } files[] = {
        {"assimp-box_without_lineending", 12, NULL},
        {"assimp-malformed", 7,
         "line 23: an element refers to a vertex that does not exist; it is left out (2 times"},
        {"assimp-number_formats", 1,
         "line 11: a word is not a number; its numeric beginning is used (6 times"},
        {"assimp-regr_3429812", 4, NULL},
        {"draco-deg_faces", 3, "line 13: a face has fewer than 3 different corners"},
        {"draco-degenerate_mesh", 1, NULL},
        {"draco-empty_name", 1, NULL},
        {"tinyobjloader-invalid-face-definition", 0, "line 15: a face has fewer than 3 different corners"},
        {"tinyobjloader-invalid-relative-vertex-index", 0,
         "line 1: an element refers to a vertex that does not exist"},
        {"tinyobjloader-issue-140-zero-face-idx", 1,
         "line 16: an element refers to a vertex that does not exist"},
        {"tinyobjloader-issue-161-inconsistent-f", 12, "some corners of a material have texture coordinates"},
        {"tinyobjloader-issue-295-trianguation-failure", 28, NULL},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[256];
        snprintf(path, sizeof path, "malformed/obj/%s.obj", files[i].name);
        facet_scene *scene = obj_load_shared(path);
        if (count_triangles(scene) != files[i].triangles)
            fail_msg("%s: %zu triangles", path, count_triangles(scene));
        if (files[i].warning && !obj_has_warning(scene, files[i].warning))
            fail_msg("%s: has no warning \"%s\"", path, files[i].warning);
        scene_destroy(scene);
    }
}

static void mixed_attributes_are_read(void **state)
{
    (void)state;
    facet_scene *scene = obj_load_shared("obj/obj2gltf/box-mixed-attributes/box-mixed-attributes.obj");
    const scene_primitive *p = obj_only_primitive(scene);
    /* Three sides with all attributes, one with normals only: 4 vertices each; two without normals, flat
     * since s is off: 6 each. */
    assert_int_equal(p->vertex_count, 4 * 4 + 2 * 6);
    assert_true(obj_has_warning(scene, "get (0, 0) (12 times in all)"));
    for (size_t i = 0; i < p->index_count;
         i += 3) /* all sides point outwards: the box is around the origin */
        for (size_t k = 0; k < 3; k++) {
            const float *n = obj_normal(p, i + k);
            const float *at = obj_position(p, i + k);
            assert_near(n[0] * at[0] + n[1] * at[1] + n[2] * at[2], 1.0, 1e-6);
        }
    scene_destroy(scene);
}

/* Its upper and lower sides are squares of 2 x 2 with a notch of 2 x 0.87836 / 2: triangles across the
 * notch would make the area larger, and one of them point to the other side. */
static void concave_faces_keep_their_area(void **state)
{
    (void)state;
    facet_scene *scene = obj_load_shared("obj/obj2gltf/concave/concave.obj");
    const scene_primitive *p = obj_only_primitive(scene);
    double areas[2] = {0.0, 0.0};
    for (size_t i = 0; i < p->index_count; i += 3) {
        const float *a = obj_position(p, i);
        const float *b = obj_position(p, i + 1);
        const float *c = obj_position(p, i + 2);
        double y = (double)obj_normal(p, i)[1];
        double area = 0.5 * (((double)b[2] - (double)a[2]) * ((double)c[0] - (double)a[0]) -
                             ((double)b[0] - (double)a[0]) * ((double)c[2] - (double)a[2]));
        if (fabs(y) > 0.5) {
            assert_true(area * y > 0.0);
            areas[y > 0.0] += fabs(area);
        }
    }
    assert_near(areas[0], 4.0 - 0.87836, 1e-5);
    assert_near(areas[1], 4.0 - 0.87836, 1e-5);
    scene_destroy(scene);
}

static void the_cornell_box_is_read(void **state)
{
    (void)state;
    facet_scene *scene = obj_load_shared("obj/cornell/CornellBox-Original.obj");
    assert_int_equal(obj_find_mesh(scene, "floor")->primitives[0].index_count, 6);
    const scene_mesh *wall =
        obj_find_mesh(scene, "leftWall"); /* "g shortBox" comes behind its faces in this file */
    assert_int_equal(wall->primitive_count, 2);
    assert_string_equal(scene->materials[wall->primitives[0].material].name, "leftWall");
    assert_string_equal(scene->materials[wall->primitives[1].material].name, "shortBox");
    assert_string_equal(scene->generator, ""); /* its first comment is a sentence */
    assert_near(obj_area(&obj_find_mesh(scene, "light")->primitives[0]), 0.47 * 0.38, 1e-6);
    scene_destroy(scene);
}

static void vertex_colors_are_read(void **state)
{
    (void)state;
    facet_scene *scene = obj_load_shared("obj/tinyobjloader/cube-vertexcol.obj");
    const scene_primitive *front = &obj_find_mesh(scene, "front cube")->primitives[0];
    assert_non_null(front->colors);
    for (size_t i = 0; i < front->index_count; i++) { /* 0 and 1 only: the same in sRGB and linear */
        const float *color = front->colors + 4 * (size_t)front->indices[i];
        assert_true(color[3] == 1.0f && (color[0] == 0.0f || color[0] == 1.0f));
    }
    scene_destroy(scene);
}

static void points_and_lines_are_read(void **state)
{
    (void)state;
    facet_scene *scene = obj_load_shared("obj/tinyobjloader/points-prim.obj");
    assert_int_equal(obj_only_primitive(scene)->mode, SCENE_POINTS);
    assert_int_equal(obj_only_primitive(scene)->index_count, 8);
    scene_destroy(scene);
    scene = obj_load_shared("obj/tinyobjloader/line-prim.obj");
    assert_int_equal(obj_only_primitive(scene)->mode, SCENE_LINES);
    assert_int_equal(obj_only_primitive(scene)->index_count, 12);
    scene_destroy(scene);
}

/* Smooth ones have the normals that their shape has. */
static void shapes_have_their_normals(void **state)
{
    (void)state;
    facet_scene *scene = obj_load_shared("obj/c-ray/torus.obj"); /* around +Y, radii 1 and 0.25 */
    const scene_primitive *p = obj_only_primitive(scene);
    for (size_t i = 0; i < p->vertex_count; i++) {
        const float *at = p->positions + 3 * i;
        const float *n = p->normals + 3 * i;
        double ring = hypot((double)at[0], (double)at[2]);
        double x = (double)at[0] - (double)at[0] / ring;
        double z = (double)at[2] - (double)at[2] / ring;
        assert_near(hypot(hypot(x, z), (double)at[1]), 0.25, 1e-3);
        assert_true((x * (double)n[0] + (double)at[1] * (double)n[1] + z * (double)n[2]) / 0.25 > 0.95);
    }
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(element_counts_match_the_files),
        cmocka_unit_test(malformed_files_load_with_warnings),
        cmocka_unit_test(mixed_attributes_are_read),
        cmocka_unit_test(concave_faces_keep_their_area),
        cmocka_unit_test(the_cornell_box_is_read),
        cmocka_unit_test(vertex_colors_are_read),
        cmocka_unit_test(points_and_lines_are_read),
        cmocka_unit_test(shapes_have_their_normals),
    };
    return cmocka_run_group_tests_name("obj_files", tests, NULL, NULL);
}
