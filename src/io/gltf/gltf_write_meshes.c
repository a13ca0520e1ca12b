/* gltf_write_meshes.c - meshes with morph targets, skin attributes and variants of materials. */
#include <string.h>

#include "io/gltf/gltf_writer.h"

static const int modes[] = {[SCENE_POINTS] = 0, [SCENE_LINES] = 1, [SCENE_TRIANGLES] = 4};

static void put_attribute(gltf_writer *w, json_t *attributes, const char *name, uint32_t set,
                          uint32_t accessor)
{
    char key[32];
    snprintf(key, sizeof key, name, set);
    gltf_put(w, attributes, key, json_integer(accessor));
}

static void put_floats_attribute(gltf_writer *w, json_t *attributes, const char *name, uint32_t set,
                                 const float *values, size_t count, write_type type)
{
    if (values)
        put_attribute(
            w, attributes, name, set,
            gltf_write_floats(w, values, count, type, WRITE_VERTICES, strcmp(name, "POSITION") == 0));
}

/* A morph target that changes nothing: glTF wants it to name an attribute. */
static void add_still_target(gltf_writer *w, json_t *targets, size_t vertex_count)
{
    json_t *target = json_object();
    put_attribute(w, target, "POSITION", 0, gltf_write_zeros(w, vertex_count, WRITE_VEC3));
    gltf_append(w, targets, target);
}

/* A primitive that draws nothing keeps its place in the mesh: a triangle without area, with as many morph targets as
 * the others have. */
static void write_empty(gltf_writer *w, json_t *out, uint32_t target_count)
{
    static const float positions[9] = {0};
    static const uint32_t indices[3] = {0, 1, 2};
    json_t *attributes = gltf_put_object(w, out, "attributes");
    put_floats_attribute(w, attributes, "POSITION", 0, positions, 3, WRITE_VEC3);
    gltf_put(w, out, "indices", json_integer(gltf_write_indices(w, indices, 3)));
    for (uint32_t i = 0; i < target_count; i++)
        add_still_target(w, gltf_put_array(w, out, "targets"), 3);
}

/* Normals that facet made are made again by whoever reads the file. */
static void write_attributes(gltf_writer *w, json_t *out, const scene_mesh *mesh, const scene_primitive *p)
{
    json_t *attributes = gltf_put_object(w, out, "attributes");
    size_t n = p->vertex_count;
    put_attribute(w, attributes, "POSITION", 0, gltf_write_positions(w, p->positions, n, mesh->origin));
    if (!p->has_flat_normals) {
        put_floats_attribute(w, attributes, "NORMAL", 0, p->normals, n, WRITE_VEC3);
        put_floats_attribute(w, attributes, "TANGENT", 0, p->tangents, n, WRITE_VEC4);
    }
    for (uint32_t i = 0; i < p->texcoord_count; i++)
        put_floats_attribute(w, attributes, "TEXCOORD_%u", i, p->texcoords[i], n, WRITE_VEC2);
    put_floats_attribute(w, attributes, "COLOR_0", 0, p->colors, n, WRITE_VEC4);
    for (uint32_t i = 0; 4 * i < p->influence_count; i++) {
        put_attribute(w, attributes, "JOINTS_%u", i,
                      gltf_write_joints(w, p->joints + 4 * i, n, p->influence_count));
        put_attribute(w, attributes, "WEIGHTS_%u", i,
                      gltf_write_weights(w, p->weights + 4 * i, n, p->influence_count));
    }
}

static void write_targets(gltf_writer *w, json_t *out, const scene_primitive *p)
{
    size_t n = p->vertex_count;
    for (uint32_t i = 0; i < p->target_count; i++) {
        const scene_morph_target *t = &p->targets[i];
        json_t *target = json_object();
        put_floats_attribute(w, target, "POSITION", 0, t->positions, n, WRITE_VEC3);
        if (!p->has_flat_normals) {
            put_floats_attribute(w, target, "NORMAL", 0, t->normals, n, WRITE_VEC3);
            if (p->tangents)
                put_floats_attribute(w, target, "TANGENT", 0, t->tangents, n, WRITE_VEC3);
        }
        if (json_object_size(target)) {
            gltf_append(w, gltf_put_array(w, out, "targets"), target);
        } else {
            json_decref(target);
            add_still_target(w, gltf_put_array(w, out, "targets"), n);
        }
    }
}

/* The variants that have a material of their own, by material. */
static void write_variants(gltf_writer *w, json_t *out, const scene_primitive *p)
{
    for (uint32_t i = 0; p->variant_materials && i < w->scene->variant_count; i++) {
        uint32_t material = p->variant_materials[i];
        if (material == SCENE_NONE)
            continue;
        json_t *mappings =
            gltf_put_array(w, gltf_put_extension(w, out, "KHR_materials_variants"), "mappings");
        json_t *mapping = NULL;
        for (size_t k = 0; k < json_array_size(mappings) && !mapping; k++)
            if (json_integer_value(json_object_get(json_array_get(mappings, k), "material")) == material)
                mapping = json_array_get(mappings, k);
        if (!mapping) {
            gltf_append(w, mappings, json_object());
            mapping = json_array_get(mappings, json_array_size(mappings) - 1);
            gltf_put_index(w, mapping, "material", material);
        }
        gltf_append(w, gltf_put_array(w, mapping, "variants"), json_integer(i));
    }
}

static void write_primitive(gltf_writer *w, json_t *primitives, const scene_mesh *mesh,
                            const scene_primitive *p, uint32_t target_count)
{
    json_t *out = json_object();
    if (p->index_count == 0) {
        write_empty(w, out, target_count);
    } else {
        write_attributes(w, out, mesh, p);
        gltf_put(w, out, "indices", json_integer(gltf_write_indices(w, p->indices, p->index_count)));
        if (p->mode != SCENE_TRIANGLES)
            gltf_put(w, out, "mode", json_integer(modes[p->mode]));
        write_targets(w, out, p);
    }
    gltf_put_index(w, out, "material", p->material);
    write_variants(w, out, p);
    gltf_put_meta(w, out, &p->meta);
    gltf_append(w, primitives, out);
}

void gltf_write_meshes(gltf_writer *w)
{
    for (uint32_t i = 0; i < w->scene->mesh_count && gltf_writer_is_ok(w); i++) {
        const scene_mesh *mesh = &w->scene->meshes[i];
        json_t *out = json_object();
        gltf_put_name(w, out, mesh->name);
        json_t *primitives = gltf_put_array(w, out, "primitives");
        for (uint32_t k = 0; k < mesh->primitive_count; k++)
            write_primitive(w, primitives, mesh, &mesh->primitives[k], mesh->weight_count);
        if (mesh->weight_count && mesh->weights)
            gltf_put(w, out, "weights", gltf_json_floats(mesh->weights, mesh->weight_count));
        gltf_put_meta(w, out, &mesh->meta);
        gltf_append(w, gltf_put_array(w, w->root, "meshes"), out);
    }
}
