/* scene_test.c - the object itself, the built-in scene, counts and the description. */
#include "scene/scene_test_support.h"

#include <stdlib.h>
#include <string.h>

#include "base/text.h"

static void count_message(void *user, facet_log_level level, const char *message)
{
    (void)message;
    assert_int_equal(level, FACET_LOG_LEVEL_WARNING);
    ++*(int *)user;
}

static void warnings_are_kept_once_and_limited(void **state)
{
    (void)state;
    int messages = 0;
    const facet_log log = {.user = &messages, .message = count_message};
    facet_scene *scene = test_scene(1);
    scene_warn(scene, &log, "a %d", 1);
    scene_warn(scene, &log, "a %d", 1);
    scene_warn(scene, &log, "a %d", 2);
    assert_int_equal(scene->warning_count, 2);
    assert_int_equal(messages, 2);
    assert_string_equal(scene->warnings[1], "a 2");
    for (int i = 0; i < 5000; i++)
        scene_warn(scene, &log, "b %d", i);
    assert_int_equal(scene->warning_count, 1000);
    assert_non_null(strstr(scene->warnings[999], "the last one"));
    scene_destroy(scene);
    scene_destroy(NULL);
}

static facet_scene *make_builtin(void)
{
    const facet_scene_desc desc = {.thread_count = 3};
    facet_scene *scene = NULL;
    assert_int_equal(scene_create_builtin(&desc, &scene, NULL), FACET_OK);
    assert_int_equal(scene->thread_count, 3); /* questions about it keep to that */
    return scene;
}

static void the_builtin_scene_is_sound(void **state)
{
    (void)state;
    facet_scene *scene = make_builtin();
    facet_scene_counts counts = scene_count(scene);
    assert_int_equal(counts.instances, 6 * 4 + 7 + 1);
    assert_int_equal(counts.lines + counts.points + counts.textures, 0);
    assert_true(counts.drawn_triangles > 50000 && counts.drawn_triangles < 300000);
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        const scene_primitive *p = &scene->meshes[i].primitives[0];
        assert_true(p->material < scene->material_count);
        for (uint32_t k = 0; k < p->index_count; k += 3) {
            float face[3];
            const float *c[3];
            for (uint32_t corner = 0; corner < 3; corner++) {
                assert_true(p->indices[k + corner] < p->vertex_count);
                c[corner] = p->positions + 3 * (size_t)p->indices[k + corner];
                const float *n = p->normals + 3 * (size_t)p->indices[k + corner];
                assert_near(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-5);
            }
            /* Counter-clockwise seen from where the normal points. */
            double along = 0.0;
            double area = 0.0;
            for (int axis = 0; axis < 3; axis++) {
                int y = (axis + 1) % 3;
                int z = (axis + 2) % 3;
                face[axis] =
                    (c[1][y] - c[0][y]) * (c[2][z] - c[0][z]) - (c[1][z] - c[0][z]) * (c[2][y] - c[0][y]);
                along += (double)(face[axis] * p->normals[3 * (size_t)p->indices[k] + (size_t)axis]);
                area += (double)(face[axis] * face[axis]);
            }
            assert_true(area > 0.0 && along > 0.0);
        }
    }
    scene_destroy(scene);
}

static void the_builtin_scene_stands_on_its_plate(void **state)
{
    (void)state;
    facet_scene *scene = make_builtin();
    scene_pose pose;
    assert_int_equal(scene_pose_create(scene, NULL, NULL, 1, &pose, NULL), FACET_OK);
    assert_true(pose.bounds_min[1] < 0.0f && pose.bounds_min[1] > -1.0f);
    for (uint32_t i = 0; i + 1 < pose.instance_count; i++) { /* the plate is the last one */
        float lowest[3];
        mat4_transform_point(&pose.instances[i].world, (const float[3]){0, -1, 0}, lowest);
        assert_true(lowest[1] > -1e-5f);
    }
    scene_pose_destroy(&pose);
    scene_destroy(scene);
}

static void the_description_names_everything(void **state)
{
    (void)state;
    facet_scene *scene = make_builtin();
    text t = {0};
    scene_describe_json(scene, &t);
    assert_false(t.has_failed);
    static const char *const members[] = {
        "\"source\":\"built-in scene\"",
        "\"asset\":{\"version\":\"2.0\",\"generator\":\"facet\",\"copyright\":\"\"}",
        "\"counts\":{\"scenes\":1,",
        "\"bounds\":{\"min\":[",
        "\"default_scene\":0",
        "\"nodes\":[{\"name\":\"metallic 0.00 roughness 0.0\"",
        "\"attributes\":[\"POSITION\",\"NORMAL\",\"TEXCOORD_0\"]",
        "\"name\":\"gold\",\"base_color\":[1,0.766,0.336,1],\"metallic\":1",
        "\"alpha_mode\":\"OPAQUE\"",
        "\"textures\":[],\"images\":[],\"cameras\":[],\"lights\":[]",
        "\"extensions\":[],\"warnings\":[]"};
    for (size_t i = 0; i < sizeof members / sizeof *members; i++)
        if (!strstr(t.data, members[i]))
            fail_msg("no %s in %.2000s", members[i], t.data);
    text_destroy(&t);
    scene_destroy(scene);
}

/* Extras of a file may nest as deep as it likes; programs that read descriptions do not. */
static void descriptions_limit_their_nesting(void **state)
{
    (void)state;
    enum { LEVELS = 500 };
    facet_scene *scene = make_builtin();
    char extras[16 * LEVELS] = "{\"kept\":\"[[[[\\\"\",\"deep\":";
    for (int i = 0; i < LEVELS; i++)
        strcat(extras, i % 2 ? "{\"a\":" : "[");
    strcat(extras, "\"}]\\\\\"");
    for (int i = LEVELS; i-- > 0;)
        strcat(extras, i % 2 ? "}" : "]");
    strcat(extras, ",\"last\":1}");
    scene->nodes[0].meta.extras = extras;
    text t = {0};
    scene_describe_json(scene, &t);
    assert_false(t.has_failed);
    int depth = 0, deepest = 0;
    bool is_in_string = false;
    for (const char *c = t.data; *c; c++) {
        if (is_in_string && *c == '\\')
            c++;
        else if (*c == '"')
            is_in_string = !is_in_string;
        else if (!is_in_string)
            depth += (*c == '[' || *c == '{') - (*c == ']' || *c == '}');
        deepest = depth > deepest ? depth : deepest;
    }
    assert_int_equal(depth, 0);
    assert_true(deepest > 32 && deepest <= 40);
    assert_non_null(strstr(t.data, "\"extras\":{\"kept\":\"[[[[\\\"\",\"deep\":[{\"a\":["));
    assert_non_null(strstr(t.data, "[\"(nested too deep to show)\"]}"));
    assert_non_null(strstr(t.data, "}],\"last\":1}"));
    text_destroy(&t);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(warnings_are_kept_once_and_limited),
        cmocka_unit_test(the_builtin_scene_is_sound),
        cmocka_unit_test(the_builtin_scene_stands_on_its_plate),
        cmocka_unit_test(the_description_names_everything),
        cmocka_unit_test(descriptions_limit_their_nesting),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
