/* gltf_write_test.c - written files read back equal. */
#define _DEFAULT_SOURCE
#include "io/gltf/gltf.h"
#include "io/gltf/gltf_test_support.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/support.h"
#include "base/file.h"
#include "scene/material_table.h"
#include "scene/origin.h"

/* ---- equality; the first difference fails the test with its name ---- */

static char model[1024]; /* for messages */

static void set_model(const char *name)
{
    snprintf(model, sizeof model, "%.1000s", name);
}

static void same(bool is_same, const char *what, uint32_t index)
{
    if (!is_same)
        fail_msg("%s: %s %u differs after it was written and read", model, what, index);
}

static void same_floats(const float *a, const float *b, size_t count, const char *what, uint32_t index)
{
    same((a != NULL) == (b != NULL), what, index);
    for (size_t i = 0; a && i < count; i++)
        if (!(fabsf(a[i] - b[i]) <= 1e-6f * fmaxf(1.0f, fabsf(a[i]))) && a[i] != b[i])
            fail_msg("%s: %s %u: value %zu was %.9g and is %.9g", model, what, index, i, (double)a[i],
                     (double)b[i]);
}

/* Numbers of the JSON are written with 15 digits, those below 4096 that are floats as floats. */
static void same_doubles(const double *a, const double *b, size_t count, const char *what, uint32_t index)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabs(a[i] - b[i]) <= (fabs(a[i]) < 4096.0 ? 1e-7 : 2e-15) * fmax(1.0, fabs(a[i]))))
            fail_msg("%s: %s %u: value %zu was %.17g and is %.17g", model, what, index, i, a[i], b[i]);
}

static void same_text(const char *a, const char *b, const char *what, uint32_t index)
{
    same((a != NULL) == (b != NULL) && (!a || strcmp(a, b) == 0), what, index);
}

static void same_meta(const scene_meta *a, const scene_meta *b, const char *what, uint32_t index)
{
    same_text(a->extras, b->extras, what, index);
    same_text(a->extensions, b->extensions, what, index);
}

static void same_primitive(const scene_primitive *a, const scene_primitive *b, uint32_t variants,
                           uint32_t mesh)
{
    if (a->index_count == 0) {
        same(b->index_count <= 3, "empty primitive of mesh", mesh);
        return;
    }
    size_t n = a->vertex_count;
    same(a->mode == b->mode && a->vertex_count == b->vertex_count && a->index_count == b->index_count,
         "shape of mesh", mesh);
    same(memcmp(a->indices, b->indices, a->index_count * sizeof *a->indices) == 0, "indices of mesh", mesh);
    same_floats(a->positions, b->positions, 3 * n, "positions of mesh", mesh);
    same_floats(a->normals, b->normals, 3 * n, "normals of mesh", mesh);
    same_floats(a->tangents, b->tangents, 4 * n, "tangents of mesh", mesh);
    same_floats(a->colors, b->colors, 4 * n, "colors of mesh", mesh);
    same(a->texcoord_count == b->texcoord_count && a->has_flat_normals == b->has_flat_normals,
         "attributes of mesh", mesh);
    for (uint32_t i = 0; i < a->texcoord_count; i++)
        same_floats(a->texcoords[i], b->texcoords[i], 2 * n, "texture coordinates of mesh", mesh);
    same(a->influence_count == b->influence_count && a->target_count == b->target_count &&
             a->material == b->material,
         "skin, morph targets or material of mesh", mesh);
    for (size_t i = 0; i < a->influence_count * n; i++)
        same(a->joints[i] == b->joints[i], "joints of mesh", mesh);
    same_floats(a->weights, b->weights, a->influence_count * n, "weights of mesh", mesh);
    for (uint32_t i = 0; i < a->target_count; i++) {
        same_floats(a->targets[i].positions, b->targets[i].positions, 3 * n, "morph target of mesh", mesh);
        same_floats(a->targets[i].normals, b->targets[i].normals, 3 * n, "morphed normals of mesh", mesh);
        same_floats(a->targets[i].tangents, b->targets[i].tangents, 3 * n, "morphed tangents of mesh", mesh);
    }
    same((a->variant_materials != NULL) == (b->variant_materials != NULL), "variants of mesh", mesh);
    for (uint32_t i = 0; a->variant_materials && i < variants; i++)
        same(a->variant_materials[i] == b->variant_materials[i], "variants of mesh", mesh);
    same_meta(&a->meta, &b->meta, "metadata of a primitive of mesh", mesh);
}

static void same_meshes(const facet_scene *a, const facet_scene *b)
{
    same(a->mesh_count == b->mesh_count, "number of meshes", a->mesh_count);
    for (uint32_t i = 0; i < a->mesh_count; i++) {
        const scene_mesh *m = &a->meshes[i];
        const scene_mesh *n = &b->meshes[i];
        same_text(m->name, n->name, "name of mesh", i);
        same(m->primitive_count == n->primitive_count && m->weight_count == n->weight_count, "mesh", i);
        if (m->weight_count)
            same_floats(m->weights, n->weights, m->weight_count, "weights of mesh", i);
        for (uint32_t k = 0; k < m->primitive_count; k++)
            same_primitive(&m->primitives[k], &n->primitives[k], a->variant_count, i);
        same_meta(&m->meta, &n->meta, "metadata of mesh", i);
    }
}

static void same_materials(const facet_scene *a, const facet_scene *b)
{
    same(a->material_count == b->material_count, "number of materials", a->material_count);
    for (uint32_t i = 0; i < a->material_count; i++) {
        const scene_material *m = &a->materials[i];
        const scene_material *n = &b->materials[i];
        same_text(m->name, n->name, "name of material", i);
        same(m->extensions == n->extensions, "extensions of material", i);
        same(m->alpha_mode == n->alpha_mode && m->is_double_sided == n->is_double_sided, "material", i);
        for (int k = 0; k < MATERIAL_PARAMETER_COUNT; k++) {
            const material_parameter *row = &material_parameters[k];
            bool is_moot = row->texture || (m->alpha_mode != SCENE_ALPHA_MASK &&
                                            row->offset == offsetof(scene_material, alpha_cutoff));
            if (!is_moot)
                same_floats(material_floats_const(m, row), material_floats_const(n, row), row->count,
                            row->key, i);
        }
        for (int k = 0; k < SCENE_TEXTURE_SLOT_COUNT; k++) {
            const scene_texture_ref *r = &m->textures[k];
            const scene_texture_ref *s = &n->textures[k];
            same(r->texture == s->texture && r->texcoord == s->texcoord, material_textures[k].key, i);
            same_floats(r->transform, s->transform, 6, material_textures[k].key, i);
        }
        same(m->normal_scale == n->normal_scale || !scene_material_has(m, SCENE_NORMAL_TEXTURE),
             "normal scale of material", i);
        same(m->occlusion_strength == n->occlusion_strength ||
                 !scene_material_has(m, SCENE_OCCLUSION_TEXTURE),
             "occlusion strength of material", i);
        same_meta(&m->meta, &n->meta, "metadata of material", i);
    }
}

static void same_textures(const facet_scene *a, const facet_scene *b)
{
    same(a->texture_count == b->texture_count && a->image_count == b->image_count, "number of textures", 0);
    for (uint32_t i = 0; i < a->texture_count; i++) {
        const scene_texture *t = &a->textures[i];
        const scene_texture *u = &b->textures[i];
        same_text(t->name, u->name, "name of texture", i);
        same(t->image == u->image && t->wrap_u == u->wrap_u && t->wrap_v == u->wrap_v &&
                 t->mag_filter == u->mag_filter && t->min_filter == u->min_filter &&
                 t->mip_filter == u->mip_filter,
             "texture", i);
        same_meta(&t->meta, &u->meta, "metadata of texture", i);
    }
    for (uint32_t i = 0; i < a->image_count; i++) {
        const scene_image *m = &a->images[i];
        const scene_image *n = &b->images[i];
        if (m->bytes)
            same(n->bytes && m->size == n->size && memcmp(m->bytes, n->bytes, m->size) == 0, "image", i);
        same_text(m->mime_type, n->mime_type, "type of image", i);
        same_meta(&m->meta, &n->meta, "metadata of image", i);
    }
}

static void same_nodes(const facet_scene *a, const facet_scene *b)
{
    same(a->node_count == b->node_count, "number of nodes", a->node_count);
    for (uint32_t i = 0; i < a->node_count; i++) {
        const scene_node *m = &a->nodes[i];
        const scene_node *n = &b->nodes[i];
        same_text(m->name, n->name, "name of node", i);
        same(m->parent == n->parent && m->child_count == n->child_count && m->is_hidden == n->is_hidden &&
                 m->has_matrix == n->has_matrix && m->mesh == n->mesh && m->camera == n->camera &&
                 m->light == n->light && m->skin == n->skin,
             "node", i);
        for (uint32_t k = 0; k < m->child_count; k++)
            same(m->children[k] == n->children[k], "children of node", i);
        if (m->has_matrix) {
            same_doubles(m->matrix.m, n->matrix.m, 16, "matrix of node", i);
        } else {
            same_doubles(m->translation, n->translation, 3, "translation of node", i);
            same_floats(m->rotation, n->rotation, 4, "rotation of node", i);
            same_floats(m->scale, n->scale, 3, "scale of node", i);
        }
        if (m->mesh != SCENE_NONE)
            same_floats(m->weights, n->weights, a->meshes[m->mesh].weight_count, "weights of node", i);
        same((m->instancing != NULL) == (n->instancing != NULL), "instances of node", i);
        if (m->instancing) {
            size_t count = m->instancing->count;
            same(count == n->instancing->count, "instances of node", i);
            same_floats(m->instancing->translations, n->instancing->translations, 3 * count,
                        "instances of node", i);
            same_floats(m->instancing->rotations, n->instancing->rotations, 4 * count, "instances of node",
                        i);
            same_floats(m->instancing->scales, n->instancing->scales, 3 * count, "instances of node", i);
        }
        same_meta(&m->meta, &n->meta, "metadata of node", i);
    }
}

static void same_scenes(const facet_scene *a, const facet_scene *b)
{
    same(a->scene_count == b->scene_count && a->default_scene == b->default_scene, "scenes", a->scene_count);
    for (uint32_t i = 0; i < a->scene_count; i++) {
        same_text(a->scenes[i].name, b->scenes[i].name, "name of scene", i);
        same(a->scenes[i].node_count == b->scenes[i].node_count &&
                 a->scenes[i].image_light == b->scenes[i].image_light,
             "scene", i);
        for (uint32_t k = 0; k < a->scenes[i].node_count; k++)
            same(a->scenes[i].nodes[k] == b->scenes[i].nodes[k], "nodes of scene", i);
        same_meta(&a->scenes[i].meta, &b->scenes[i].meta, "metadata of scene", i);
    }
}

static void same_cameras_and_lights(const facet_scene *a, const facet_scene *b)
{
    same(a->camera_count == b->camera_count && a->light_count == b->light_count, "cameras or lights", 0);
    for (uint32_t i = 0; i < a->camera_count; i++) {
        const scene_camera *c = &a->cameras[i];
        const scene_camera *d = &b->cameras[i];
        const float x[] = {c->fov_y_rad, c->aspect, c->ortho_height, c->ortho_width, c->near_m, c->far_m};
        const float y[] = {d->fov_y_rad, d->aspect, d->ortho_height, d->ortho_width, d->near_m, d->far_m};
        same(c->is_orthographic == d->is_orthographic, "camera", i);
        same_floats(x, y, 6, "camera", i);
        same_meta(&c->meta, &d->meta, "metadata of camera", i);
    }
    for (uint32_t i = 0; i < a->light_count; i++) {
        const scene_light *l = &a->lights[i];
        const scene_light *m = &b->lights[i];
        same(l->type == m->type, "light", i);
        same_floats(l->color, m->color, 3, "color of light", i);
        const float x[] = {l->intensity, l->range, l->inner_cone_rad, l->outer_cone_rad};
        const float y[] = {m->intensity, m->range, m->inner_cone_rad, m->outer_cone_rad};
        same_floats(x, y, l->type == SCENE_LIGHT_SPOT ? 4 : 2, "light", i);
        same_meta(&l->meta, &m->meta, "metadata of light", i);
    }
    same(a->image_light_count == b->image_light_count, "image based lights", 0);
    for (uint32_t i = 0; i < a->image_light_count; i++) {
        const scene_image_light *l = &a->image_lights[i];
        const scene_image_light *m = &b->image_lights[i];
        same(l->mip_count == m->mip_count && l->specular_size == m->specular_size, "image based light", i);
        same_floats(l->rotation, m->rotation, 4, "image based light", i);
        same_floats(&l->irradiance[0][0], &m->irradiance[0][0], 27, "image based light", i);
        same_floats(&l->intensity, &m->intensity, 1, "image based light", i);
        same(memcmp(l->images, m->images, 6 * l->mip_count * sizeof *l->images) == 0, "image based light", i);
    }
}

static void same_motion(const facet_scene *a, const facet_scene *b)
{
    same(a->skin_count == b->skin_count && a->animation_count == b->animation_count, "skins or animations",
         0);
    for (uint32_t i = 0; i < a->skin_count; i++) {
        const scene_skin *s = &a->skins[i];
        const scene_skin *t = &b->skins[i];
        same(s->joint_count == t->joint_count && s->skeleton == t->skeleton &&
                 (s->inverse_bind != NULL) == (t->inverse_bind != NULL) &&
                 memcmp(s->joints, t->joints, s->joint_count * sizeof *s->joints) == 0,
             "skin", i);
        if (s->inverse_bind)
            same_floats(s->inverse_bind->m, t->inverse_bind->m, 16 * s->joint_count, "skin", i);
    }
    for (uint32_t i = 0; i < a->animation_count; i++) {
        const scene_animation *m = &a->animations[i];
        const scene_animation *n = &b->animations[i];
        same_text(m->name, n->name, "name of animation", i);
        same(m->channel_count == n->channel_count && m->sampler_count == n->sampler_count &&
                 m->begin_s == n->begin_s && m->end_s == n->end_s,
             "animation", i);
        for (uint32_t k = 0; k < m->channel_count; k++) {
            const scene_channel *c = &m->channels[k];
            const scene_channel *d = &n->channels[k];
            same(c->kind == d->kind && c->index == d->index && c->offset == d->offset &&
                     c->scale == d->scale && c->is_rotation == d->is_rotation && c->sampler == d->sampler,
                 "channel of animation", i);
            same_text(c->pointer, d->pointer, "pointer of animation", i);
        }
        for (uint32_t k = 0; k < m->sampler_count; k++) {
            const scene_sampler *s = &m->samplers[k];
            const scene_sampler *t = &n->samplers[k];
            same(s->interpolation == t->interpolation && s->key_count == t->key_count && s->width == t->width,
                 "sampler of animation", i);
            same_floats(s->times, t->times, s->key_count, "times of animation", i);
            size_t values =
                (size_t)s->key_count * s->width * (s->interpolation == SCENE_CUBIC_SPLINE ? 3 : 1);
            same_floats(s->values, t->values, values, "values of animation", i);
        }
    }
}

static void assert_same_scene(const facet_scene *a, const facet_scene *b)
{
    same(a->variant_count == b->variant_count, "number of variants", a->variant_count);
    for (uint32_t i = 0; i < a->variant_count; i++)
        same_text(a->variants[i], b->variants[i], "variant", i);
    same_meta(&a->meta, &b->meta, "metadata of the file", 0);
    same_meta(&a->asset_meta, &b->asset_meta, "metadata of the asset", 0);
    same_text(a->copyright, b->copyright, "copyright", 0);
    same_nodes(a, b);
    same_scenes(a, b);
    same_meshes(a, b);
    same_materials(a, b);
    same_textures(a, b);
    same_cameras_and_lights(a, b);
    same_motion(a, b);
}

/* ---- round trips ---- */

static temporary_folder folder;

static int make_folder(void **state)
{
    (void)state;
    temporary_folder_create(&folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    temporary_folder_remove(&folder);
    return 0;
}

static void empty_folder(void)
{
    temporary_folder_remove(&folder);
    assert_int_equal(mkdir(folder.path, 0700), 0);
}

/* Writes scene under a name, reads that, and compares; all without a warning that the first reading did
 * not give. */
static void assert_round_trip(const facet_scene *scene, const char *name)
{
    char path[256];
    facet_error error = {0};
    facet_scene *again = NULL;
    snprintf(path, sizeof path, "%s/%s", folder.path, name);
    if (gltf_save(scene, path, "a test", NULL, &error) != FACET_OK ||
        gltf_load(path, NULL, &again, &error) != FACET_OK)
        fail_msg("%s: %s", model, error.message);
    for (uint32_t i = 0; i < again->warning_count; i++) {
        const char *text = strchr(again->warnings[i], ':');
        bool is_known = false;
        for (uint32_t k = 0; k < scene->warning_count; k++)
            is_known |=
                text && strchr(scene->warnings[k], ':') && strcmp(strchr(scene->warnings[k], ':'), text) == 0;
        if (!is_known)
            fail_msg("%s: what was written is warned about: %s", model, again->warnings[i]);
    }
    assert_same_scene(scene, again);
    scene_destroy(again);
    empty_folder();
}

static void small_scenes_round_trip(void **state)
{
    (void)state;
    static const char *const documents[] = {
        "'scenes':[{'nodes':[0]}],'nodes':[{'translation':[4526331.337,-100000000.0625,0.1],'children':[1]},"
        "{'matrix':[1,0,0,0,0,1,0,0,0,0,1,0,-4526331.0001,1e-9,123456789.123456,1]}]",
        "'scenes':[{'name':'a','nodes':[0],'extras':{'x':0.1,'y':0.12345678901234567,'z':[1,true,null,'"
        "\\u00e9']}},{}],"
        "'scene':1,'nodes':[{'name':'top','children':[1],'translation':[0.1,2,3e-7],'rotation':[0,0.6,0,0.8]}"
        ","
        "{'matrix':[1,0,0,0,0,2,0,0,0,0,3,0,4,5,6,1],'camera':0}],'cameras':[{'type':'orthographic',"
        "'orthographic':{'xmag':3,'ymag':2,'znear':0.1,'zfar':100}}]",
        "'extensionsUsed':['KHR_materials_clearcoat','KHR_materials_volume','KHR_materials_"
        "pbrSpecularGlossiness',"
        "'KHR_materials_unlit'],'materials':[{'name':'c','extensions':{'KHR_materials_clearcoat':{'"
        "clearcoatFactor':0.3},"
        "'KHR_materials_volume':{}}},{'extensions':{'KHR_materials_pbrSpecularGlossiness':{'diffuseFactor':["
        "0.1,0.2,0.3,"
        "0.5],'glossinessFactor':0.25}},'alphaMode':'MASK','alphaCutoff':0.3,'doubleSided':true},"
        "{'extensions':{'KHR_materials_unlit':{}},'alphaMode':'BLEND'}]",
    };
    for (size_t i = 0; i < sizeof documents / sizeof *documents; i++) {
        facet_scene *scene = load(documents[i], NULL);
        set_model(documents[i]);
        assert_round_trip(scene, "a.glb");
        assert_round_trip(scene, "b.gltf");
        scene_destroy(scene);
    }
}

/* Loads "{'asset':..., BODY}" of a model with one triangle as accessor 0, and writes and reads it; the
 * second scene. */
static facet_scene *rewrite(const char *body, const char *name)
{
    static const float triangle[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    test_model m = {0};
    char path[256];
    facet_error error = {0};
    facet_scene *again = NULL;
    model_add_floats(&m, triangle, 3, "VEC3");
    facet_scene *scene = model_load(&m, "%s", body);
    snprintf(path, sizeof path, "%s/%s", folder.path, name);
    if (gltf_save(scene, path, "a test", NULL, &error) != FACET_OK ||
        gltf_load(path, NULL, &again, &error) != FACET_OK)
        fail_msg("%s: %s", body, error.message);
    scene_destroy(scene);
    empty_folder();
    return again;
}

static void values_that_glTF_forbids_are_not_written(void **state)
{
    (void)state;
    facet_scene *s =
        rewrite("'extensionsUsed':['KHR_lights_punctual'],'extensions':{'KHR_lights_punctual':{'lights':["
                "{'type':'spot','spot':{'innerConeAngle':0.7,'outerConeAngle':0.5}},"
                "{'type':'spot','spot':{'outerConeAngle':0}}]}},'cameras':["
                "{'type':'orthographic','orthographic':{'xmag':1,'ymag':1,'znear':1,'zfar':1}},"
                "{'type':'perspective','perspective':{'yfov':1,'znear':0}}]",
                "a.glb");
    assert_int_equal(s->warning_count, 0);
    assert_near(s->lights[0].inner_cone_rad, 0.5f, 1e-6f);
    assert_true(s->lights[1].outer_cone_rad > 0.0f);
    assert_true(s->cameras[0].far_m > 1e30f);
    assert_true(s->cameras[1].near_m > 0.0f && s->cameras[1].near_m < 1e-30f);
    scene_destroy(s);
}

static void empty_targets_keep_their_index(void **state)
{
    (void)state;
    /* The first primitive has no texture coordinates to be changed, the second no index that it could
     * draw. */
    facet_scene *s =
        rewrite("'meshes':[{'primitives':[{'attributes':{'POSITION':0},'targets':[{'_X':0},{'POSITION':0}]},"
                "{'attributes':{},'targets':[{},{}]}]}]",
                "a.glb");
    const scene_mesh *mesh = &s->meshes[0];
    assert_int_equal(mesh->primitive_count, 2);
    assert_int_equal(mesh->primitives[0].target_count, 2);
    assert_int_equal(mesh->primitives[1].target_count, 2);
    assert_null(mesh->primitives[0].targets[0].positions);
    assert_non_null(mesh->primitives[0].targets[1].positions);
    assert_null(mesh->primitives[1].targets[1].positions);
    scene_destroy(s);
}

/* Vertices return to the floats that they had before the scene got an origin near it. */
static void distant_vertices_round_trip(void **state)
{
    (void)state;
    static const float triangle[] = {1048576.0f, 0.0f,         0.125f, 1048577.5f, 0.1f,
                                     -2.0f,      1048578.125f, 1.0f,   0.3f};
    test_model m = {0};
    char path[256];
    facet_scene *again = NULL;
    model_add_floats(&m, triangle, 3, "VEC3");
    facet_scene *scene = model_load(&m, "%s",
                                    "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],'nodes':[{'"
                                    "mesh':0}],'scenes':[{'nodes':[0]}]");
    assert_int_equal(scene_settle_origin(scene, NULL, NULL, NULL), FACET_OK);
    assert_true(scene->meshes[0].origin[0] > 1e6);
    assert_true(fabsf(scene->meshes[0].primitives[0].positions[0]) < 16.0f);
    snprintf(path, sizeof path, "%s/a.glb", folder.path);
    assert_int_equal(gltf_save(scene, path, "a test", NULL, NULL), FACET_OK);
    assert_int_equal(gltf_load(path, NULL, &again, NULL), FACET_OK);
    assert_memory_equal(again->meshes[0].primitives[0].positions, triangle, sizeof triangle);
    scene_destroy(again);
    scene_destroy(scene);
    empty_folder();
}

/* Positions in double, which no floats hold, are written in double. */
static void distant_doubles_round_trip(void **state)
{
    (void)state;
    static const double triangle[] = {6378137.125, 0.25, -3, 6378137.25, 0.5, -2, 6378138.0, 1, -1};
    test_model m = {0};
    char path[256];
    facet_scene *again = NULL;
    model_add(&m, triangle, 3, "VEC3", 5130, "");
    facet_scene *scene =
        model_load(&m, "%s",
                   "'extensionsUsed':['KHR_accessor_float64'],'extensionsRequired':['KHR_accessor_float64'],"
                   "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],'nodes':[{'mesh':0}],"
                   "'scenes':[{'nodes':[0]}]");
    assert_int_equal(scene_settle_origin(scene, NULL, NULL, NULL), FACET_OK);
    snprintf(path, sizeof path, "%s/a.glb", folder.path);
    assert_int_equal(gltf_save(scene, path, "a test", NULL, NULL), FACET_OK);
    assert_int_equal(gltf_load(path, NULL, &again, NULL), FACET_OK);
    assert_int_equal(again->note_count, 0);
    assert_int_equal(again->extension_count, 1);
    assert_true(again->extensions[0].is_required);
    for (int i = 0; i < 9; i++)
        assert_true(again->meshes[0].origin[i % 3] + (double)again->meshes[0].primitives[0].positions[i] ==
                    triangle[i]);
    scene_destroy(again);
    scene_destroy(scene);
    empty_folder();
}

static void characters_0_in_extras_survive(void **state)
{
    (void)state;
    facet_scene *s = rewrite("'extras':'a\\u0000b'", "a.gltf");
    assert_string_equal(s->meta.extras, "\"a\\u0000b\"");
    scene_destroy(s);
}

static void names_need_not_be_UTF_8(void **state)
{
    (void)state;
    facet_scene *s = rewrite("'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}]", "\xff \xc3.gltf");
    assert_int_equal(first_primitive(s)->vertex_count, 3);
    scene_destroy(s);
}

/* If one of the files cannot be written, existing files stay unchanged. */
static void all_files_are_written_or_none(void **state)
{
    (void)state;
    static const float triangle[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    test_model m = {0};
    char bin[256], path[256];
    facet_error error = {0};
    file_bytes old;
    model_add_floats(&m, triangle, 3, "VEC3");
    facet_scene *scene = model_load(&m, "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}]");
    snprintf(bin, sizeof bin, "%s/a.bin", folder.path);
    snprintf(path, sizeof path, "%s/a.gltf", folder.path);
    assert_int_equal(file_write(bin, "old", 3, NULL), FACET_OK);
    assert_int_equal(mkdir(path, 0777), 0);
    assert_int_equal(gltf_save(scene, path, "a test", NULL, &error), FACET_ERROR_WRITE);
    assert_int_equal(rmdir(path), 0);
    assert_int_equal(file_open(bin, 0, NULL, &old, NULL), FACET_OK);
    assert_int_equal(old.size, 3);
    file_close(&old);
    unlink(bin);
    assert_int_equal(rmdir(folder.path), 0); /* no temporary is left */
    assert_int_equal(mkdir(folder.path, 0700), 0);
    scene_destroy(scene);
}

static void the_builtin_scene_round_trips(void **state)
{
    (void)state;
    facet_scene *scene = NULL;
    const facet_scene_desc desc = {0};
    assert_int_equal(scene_create_builtin(&desc, &scene, NULL), FACET_OK);
    set_model("the built-in scene");
    assert_round_trip(scene, "a.glb");
    assert_round_trip(scene, "name with spaces & %.gltf");
    scene_destroy(scene);
}

static void failed_writes_are_reported(void **state)
{
    (void)state;
    facet_scene *scene = load("'nodes':[{}]", NULL);
    facet_error error = {0};
    assert_int_equal(gltf_save(scene, "/tmp/a.obj", "", NULL, &error), FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "does not end in .glb or .gltf"));
    assert_int_equal(gltf_save(scene, "/nowhere/at/all/a.glb", "", NULL, &error), FACET_ERROR_WRITE);
    scene_destroy(scene);
}

/* For both kinds of file: if any allocation fails, the error has its size if it is known, and no memory
 * leaks. */
static void memory_that_runs_out_is_reported(void **state)
{
    (void)state;
    facet_scene *scene = NULL;
    size_t sized = 0;
    assert_int_equal(scene_create_builtin(&(facet_scene_desc){0}, &scene, NULL), FACET_OK);
    for (int kind = 0; kind < 2; kind++) {
        char path[256];
        facet_result result = FACET_ERROR_MEMORY;
        snprintf(path, sizeof path, "%s/%s", folder.path, kind ? "m.gltf" : "m.glb");
        for (long at = 0; result != FACET_OK; at++) {
            failing_allocator memory = {.fail_at = at};
            const facet_scene_save_desc desc = {.allocator = failing_allocator_get(&memory)};
            facet_error error = {0};
            size_t size = 0;
            result = gltf_save(scene, path, "a test", &desc, &error);
            assert_int_equal(memory.blocks, 0);
            if (result == FACET_OK)
                break;
            assert_int_equal(result, FACET_ERROR_MEMORY);
            if (sscanf(error.message, "out of memory: glTF (%zu bytes)", &size) == 1
                    ? size == 0
                    : !strstr(error.message, path))
                fail_msg("call %ld: %s", at, error.message);
            sized += size > 0;
        }
    }
    assert_true(sized >= 8);
    empty_folder();
    scene_destroy(scene);
}

/* Every model of a folder, and of those in it. */
static size_t check_models(const char *path)
{
    DIR *d = opendir(path);
    struct dirent *entry;
    size_t count = 0;
    while (d && (entry = readdir(d))) {
        char file[1024];
        facet_scene *scene = NULL;
        const char *dot = strrchr(entry->d_name, '.');
        if (entry->d_name[0] == '.' || strcmp(entry->d_name, "gltf1") == 0)
            continue;
        snprintf(file, sizeof file, "%s/%s", path, entry->d_name);
        if (!dot || (strcmp(dot, ".glb") != 0 && strcmp(dot, ".gltf") != 0)) {
            count += check_models(file);
            continue;
        }
        facet_error error = {0};
        facet_result result = gltf_load(file, NULL, &scene, &error);
        set_model(file);
        if (result == FACET_ERROR_UNSUPPORTED) /* this build lacks a codec */
            continue;
        if (result != FACET_OK)
            fail_msg("%s", error.message);
        assert_round_trip(scene, "a.glb");
        if (count % 4 == 0)
            assert_round_trip(scene, "b.gltf");
        scene_destroy(scene);
        count++;
    }
    if (d)
        closedir(d);
    return count;
}

static void real_models_round_trip(void **state)
{
    (void)state;
    const char *data = test_data();
    char path[1024];
    snprintf(path, sizeof path, "%s/models", data);
    assert_true(check_models(path) > 50);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_scenes_round_trip),
        cmocka_unit_test(values_that_glTF_forbids_are_not_written),
        cmocka_unit_test(empty_targets_keep_their_index),
        cmocka_unit_test(distant_vertices_round_trip),
        cmocka_unit_test(distant_doubles_round_trip),
        cmocka_unit_test(characters_0_in_extras_survive),
        cmocka_unit_test(names_need_not_be_UTF_8),
        cmocka_unit_test(all_files_are_written_or_none),
        cmocka_unit_test(the_builtin_scene_round_trips),
        cmocka_unit_test(failed_writes_are_reported),
        cmocka_unit_test(memory_that_runs_out_is_reported),
        cmocka_unit_test(real_models_round_trip),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
