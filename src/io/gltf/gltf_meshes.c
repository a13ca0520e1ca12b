/* gltf_meshes.c - meshes and their primitives: which accessor is which attribute, the materials of
 * variants (KHR_materials_variants), morph targets (glTF 2.0 section 3.7.2.2), and what a primitive lacks.
 * Morph targets may also change texture coordinates and colors, which viewers need not draw: a warning
 * names them. */
#include <float.h>
#include <stdio.h>
#include <string.h>

#include "base/parallel.h"
#include "io/gltf/gltf_reader.h"

/* ---- variants ---- */

static const char NAME[] = "KHR_materials_variants";

void gltf_read_variants(io_reader *r, const json_place *root)
{
    json_place extension = io_get_extension(r, root, NAME);
    json_place array = io_get_array(r, &extension, "variants");
    size_t count = io_get_count(&array);
    if (extension.value && !array.value)
        io_note(r, &extension, "variants", "is missing");
    r->scene->variants = io_alloc(r, "variants", count, sizeof *r->scene->variants);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        if (!io_has_member(&at, "name"))
            io_note(r, &at, "name", "is missing");
        r->scene->variants[i] = io_get_name(r, &at);
        r->scene->variant_count = (uint32_t)(i + 1);
    }
}

/* One material for some of the variants. */
static void read_mapping(io_reader *r, const json_place *at, uint32_t *materials)
{
    uint32_t material = io_get_required_index(r, at, "material", r->scene->material_count, "material");
    if (io_is_ok(r) && material != SCENE_NONE && r->gltf->material_problems[material].message)
        io_fail_deferred(r, &r->gltf->material_problems[material]);
    json_place array = io_get_array(r, at, "variants");
    if (io_is_ok(r) && !array.value)
        io_note(r, at, "variants", "is missing");
    for (size_t i = 0; i < io_get_count(&array) && io_is_ok(r); i++) {
        json_place element = io_get_element(&array, i);
        uint32_t variant = io_get_index_value(r, &element, r->scene->variant_count, "variant");
        if (variant == SCENE_NONE)
            return;
        if (materials[variant] != SCENE_NONE)
            io_note(r, &element, NULL, "variant %u has a material already, which is kept", variant);
        else
            materials[variant] = material;
    }
}

/* The materials of a primitive, by variant; NULL: the same one in all of them, or an error is recorded. */
static const uint32_t *read_mappings(io_reader *r, const json_place *primitive)
{
    json_place extension = io_get_extension(r, primitive, NAME);
    json_place array = io_get_array(r, &extension, "mappings");
    uint32_t variant_count = r->scene->variant_count;
    if (extension.value && !array.value)
        io_note(r, &extension, "mappings", "is missing");
    if (io_get_count(&array) == 0 || !io_spend(r, &extension, variant_count))
        return NULL;
    uint32_t *materials = io_alloc_raw(r, "variants", variant_count, sizeof *materials);
    if (!materials)
        return NULL;
    memset(materials, 0xff, variant_count * sizeof *materials);
    for (size_t i = 0; i < io_get_count(&array) && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        read_mapping(r, &at, materials);
        io_leave_out(r, "the primitive keeps its material in that variant");
    }
    return materials;
}

/* ---- morph targets ---- */

static const struct {
    const char *name, *what;
    gltf_attribute attribute;
} DELTAS[3] = {
    {"POSITION", "displacements of positions", GLTF_POSITION_DELTA},
    {"NORMAL", "displacements of normals", GLTF_NORMAL_DELTA},
    {"TANGENT", "displacements of tangents", GLTF_TANGENT_DELTA},
};

/* Every accessor of a target must exist, and so must the attribute that it displaces. */
static void check_target(io_reader *r, const json_place *target, const json_place *attributes)
{
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)target->value, name, value)
    {
        bool is_read = false;
        for (int i = 0; i < 3; i++)
            is_read |= strcmp(name, DELTAS[i].name) == 0;
        if (!is_read) {
            gltf_get_accessor(r, target, name);
            io_leave_out(r, "nothing reads it");
        }
        if (!io_has_member(attributes, name))
            io_note(r, target, name, "is not among the attributes of the primitive");
        else if (strncmp(name, "TEXCOORD_", 9) == 0 || strncmp(name, "COLOR_", 6) == 0)
            io_warn(r, target, name, "is not morphed");
        else if (!is_read && name[0] != '_')
            io_note(r, target, name, "cannot be changed by a morph target");
    }
}

static bool read_target(io_reader *r, const json_place *target, const scene_primitive *p,
                        scene_morph_target *out)
{
    const float **const arrays[3] = {&out->positions, &out->normals, &out->tangents};
    const bool is_used[3] = {true, p->normals != NULL, p->tangents != NULL};
    for (int i = 0; i < 3; i++) {
        uint32_t accessor =
            gltf_get_attribute(r, target, DELTAS[i].name, DELTAS[i].attribute, p->vertex_count);
        if (accessor == SCENE_NONE || !is_used[i] || gltf_is_zero_accessor(r, accessor))
            continue; /* a displacement of 0 takes no memory */
        if (!gltf_has_accessor_source(r, accessor))
            io_warn(r, target, DELTAS[i].name, "is in a buffer without bytes and changes nothing");
        else
            *arrays[i] = gltf_get_finite(r, target, accessor, DELTAS[i].what);
    }
    return io_is_ok(r);
}

/* The morph targets of a primitive whose attributes are read. */
static bool read_targets(io_reader *r, const json_place *at, scene_primitive *p)
{
    json_place attributes = io_get_object(r, at, "attributes");
    json_place array = io_get_array(r, at, "targets");
    size_t count = io_get_count(&array);
    if (count == 0)
        return io_is_ok(r);
    scene_morph_target *targets = io_alloc(r, "morph targets", count, sizeof *targets);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place target = io_get_element_object(r, &array, i);
        check_target(r, &target, &attributes);
        if (io_is_ok(r))
            read_target(r, &target, p, &targets[i]);
        if (io_leave_out(r, "the morph target changes nothing"))
            targets[i] = (scene_morph_target){0};
    }
    p->targets = targets;
    p->target_count = (uint32_t)count;
    return io_is_ok(r);
}

const float *gltf_read_weights(io_reader *r, const json_place *object, uint32_t count)
{
    json_place array = io_get_array(r, object, "weights");
    if (!array.value)
        return NULL;
    size_t given = io_get_count(&array);
    if (given != count)
        io_warn(r, &array, NULL, "must be as many as there are morph targets, %u, but are %zu", count, given);
    if (count == 0 || !io_spend(r, &array, count))
        return NULL;
    float *all = mem_alloc(r->allocator, given, sizeof *all);
    float *out = io_alloc(r, "weights", count, sizeof *out);
    if (!all)
        io_fail_memory(r, "weights", given * sizeof *all);
    else if (out && io_get_floats(r, object, "weights", all, given))
        memcpy(out, all, (given < count ? given : count) * sizeof *out);
    mem_free(all);
    return out;
}

/* ---- attributes ---- */

enum { GRAIN = 1 << 15 };

/* Whether a texture of the material, or of one of its variants, reads a set of texture coordinates. */
static bool is_set_read(const io_reader *r, const json_place *at, const scene_primitive *p, uint32_t set)
{
    const scene_material *m = scene_get_material(r->scene, p->material);
    bool is_read = io_has_member(at, "extensions");
    for (int i = 0; i < SCENE_TEXTURE_SLOT_COUNT; i++)
        is_read |= m->textures[i].texture != SCENE_NONE && m->textures[i].texcoord == set;
    return is_read;
}

/* at: the primitive. */
static bool read_texcoords(io_reader *r, const json_place *at, const json_place *attributes,
                           scene_primitive *p)
{
    uint32_t count = gltf_count_sets(attributes, "TEXCOORD_");
    const float **sets = io_alloc(r, "texture coordinates", count, sizeof *sets);
    for (uint32_t i = 0; i < count && io_is_ok(r); i++) {
        char name[24];
        snprintf(name, sizeof name, "TEXCOORD_%u", i);
        uint32_t accessor = gltf_get_attribute(r, attributes, name, GLTF_TEXCOORD, p->vertex_count);
        if (accessor != SCENE_NONE)
            sets[i] = gltf_get_finite(r, attributes, accessor, "texture coordinates");
        if (!is_set_read(r, at, p, i) && io_leave_out(r, "no texture reads it"))
            sets[i] = io_alloc(r, "texture coordinates", p->vertex_count, 2 * sizeof **sets);
    }
    p->texcoords = sets;
    p->texcoord_count = count;
    return io_is_ok(r);
}

/* Whether joints are needed, because a skin moves the mesh, is known later. */
static bool read_joints(io_reader *r, const json_place *attributes, scene_primitive *p)
{
    if (!gltf_read_influences(r, attributes, p) && io_defer(r, &r->gltf->mesh->joints)) {
        p->influence_count = 0;
        p->joints = NULL;
        p->weights = NULL;
    }
    return io_is_ok(r);
}

/* Whether all data that the primitive reads has a source. Errors of an accessor are reported when it is
 * read. */
static bool has_sources(io_reader *r, const json_place *at, const json_place *attributes)
{
    const char *name;
    json_t *value;
    uint32_t indices = io_peek_index(at, "indices", r->gltf->accessor_count);
    bool has_all = indices == SCENE_NONE || gltf_has_accessor_source(r, indices);
    json_object_foreach((json_t *)(uintptr_t)attributes->value, name, value)
    {
        uint32_t accessor = gltf_is_read_attribute(name)
                                ? io_peek_index(attributes, name, r->gltf->accessor_count)
                                : SCENE_NONE;
        has_all = has_all && (accessor == SCENE_NONE || gltf_has_accessor_source(r, accessor));
    }
    return has_all;
}

static bool read_attributes(io_reader *r, const json_place *at, const json_place *attributes,
                            scene_primitive *p, const uint8_t **is_lost, bool *has_missing_normals)
{
    uint32_t position = gltf_get_accessor(r, attributes, "POSITION");
    if (position == SCENE_NONE)
        return false;
    p->vertex_count = r->gltf->accessors[position].count;
    uint32_t accessor = gltf_get_attribute(r, attributes, "POSITION", GLTF_POSITION, p->vertex_count);
    if (accessor == SCENE_NONE || !(p->positions = gltf_get_positions(r, attributes, accessor, is_lost)))
        return false;
    accessor = gltf_get_attribute(r, attributes, "NORMAL", GLTF_NORMAL, p->vertex_count);
    if (accessor != SCENE_NONE &&
        !(p->normals = gltf_get_normals(r, attributes, accessor, has_missing_normals)))
        return false;
    if (!io_is_ok(r))
        return false;
    accessor = gltf_get_attribute(r, attributes, "TANGENT", GLTF_TANGENT, p->vertex_count);
    if (accessor != SCENE_NONE && p->normals)
        p->tangents = gltf_get_tangents(r, attributes, accessor);
    if (io_leave_out(r, "tangents are computed"))
        p->tangents = NULL;
    accessor = gltf_get_attribute(r, attributes, "COLOR_0", GLTF_COLOR, p->vertex_count);
    if (accessor != SCENE_NONE && !(p->colors = gltf_get_colors(r, attributes, accessor)))
        return false;
    return io_is_ok(r) && read_texcoords(r, at, attributes, p) && read_joints(r, attributes, p);
}

/* ---- bounds ---- */

typedef struct bounds_job {
    const scene_primitive *primitive;
    float (*boxes)[6]; /* minimum and maximum per work item */
} bounds_job;

static void bound_range(void *context, size_t begin, size_t end)
{
    bounds_job *job = context;
    const scene_primitive *p = job->primitive;
    float box[6] = {FLT_MAX, FLT_MAX, FLT_MAX, -FLT_MAX, -FLT_MAX, -FLT_MAX};
    for (size_t i = begin; i < end; i++) {
        const float *position = p->positions + 3 * (size_t)p->indices[i];
        for (int k = 0; k < 3; k++) {
            box[k] = position[k] < box[k] ? position[k] : box[k];
            box[3 + k] = position[k] > box[3 + k] ? position[k] : box[3 + k];
        }
    }
    memcpy(job->boxes[begin / GRAIN], box, sizeof box);
}

static bool bound_primitive(io_reader *r, scene_primitive *p)
{
    if (p->index_count == 0)
        return true;
    size_t ranges = (p->index_count + (size_t)GRAIN - 1) / GRAIN;
    float small[6];
    bounds_job job = {.primitive = p,
                      .boxes = ranges > 1 ? mem_alloc(r->allocator, ranges, sizeof small) : &small};
    if (!job.boxes)
        return io_fail_memory(r, "bounds", ranges * sizeof small);
    parallel_for(r->thread_count, p->index_count, GRAIN, bound_range, &job);
    for (int k = 0; k < 3; k++) {
        p->bounds_min[k] = job.boxes[0][k];
        p->bounds_max[k] = job.boxes[0][3 + k];
        for (size_t i = 1; i < ranges; i++) {
            p->bounds_min[k] = job.boxes[i][k] < p->bounds_min[k] ? job.boxes[i][k] : p->bounds_min[k];
            p->bounds_max[k] =
                job.boxes[i][3 + k] > p->bounds_max[k] ? job.boxes[i][3 + k] : p->bounds_max[k];
        }
    }
    if (ranges > 1)
        mem_free(job.boxes);
    return true;
}

/* ---- primitives ---- */

bool gltf_complete_primitive(io_reader *r, const json_place *at, scene_primitive *p, bool has_missing_normals)
{
    if (p->mode == SCENE_TRIANGLES && !p->normals)
        gltf_make_flat(r, at, p);
    else if (has_missing_normals)
        gltf_fill_missing_normals(r, at, p);
    return io_is_ok(r) && bound_primitive(r, p);
}

/* An empty primitive keeps its index in the mesh. */
static void make_empty(scene_primitive *p)
{
    static const uint32_t no_index = 0;
    static const float no_position[3] = {0, 0, 0};
    *p = (scene_primitive){
        .mode = p->mode, .indices = &no_index, .positions = no_position, .material = p->material};
}

/* Reports sets of texture coordinates that the material reads and the primitive lacks. */
static void check_texcoords(io_reader *r, const json_place *at, const scene_primitive *p)
{
    if (p->material == SCENE_NONE)
        return;
    const scene_material *m = &r->scene->materials[p->material];
    for (int i = 0; i < SCENE_TEXTURE_SLOT_COUNT; i++)
        if (m->textures[i].texture != SCENE_NONE && m->textures[i].texcoord >= p->texcoord_count)
            io_warn(r, at, NULL, "has no TEXCOORD_%u, which material %u reads; it is taken as 0",
                    m->textures[i].texcoord, p->material);
}

static void read_primitive(io_reader *r, const json_place *at, scene_primitive *p)
{
    p->material = io_get_index(r, at, "material", r->scene->material_count, "material");
    if (p->material != SCENE_NONE && r->gltf->material_problems[p->material].message)
        io_fail_deferred(r, &r->gltf->material_problems[p->material]);
    json_place attributes = io_get_object(r, at, "attributes");
    if (!attributes.value) {
        io_fail(r, at, "attributes", FACET_ERROR_INVALID, "is missing");
        return;
    }
    if (json_object_size(attributes.value) == 0)
        io_note(r, &attributes, NULL, "is empty, which glTF does not allow");
    gltf_check_attribute_names(r, &attributes);
    if (!gltf_prepare_draco(r, at))
        return;
    if (!has_sources(r, at, &attributes)) {
        io_warn(r, at, NULL, "is in a buffer without bytes and is not drawn");
        make_empty(p);
        return;
    }
    uint32_t position = gltf_get_accessor(r, &attributes, "POSITION");
    if (!io_is_ok(r))
        return;
    if (position != SCENE_NONE && gltf_is_zero_accessor(r, position) && !io_has_member(at, "targets")) {
        io_warn(r, &attributes, "POSITION",
                "is without data, so that all vertices are at 0; it is not drawn");
        make_empty(p);
        return;
    }
    const uint8_t *is_lost = NULL;
    bool has_missing_normals = false;
    if (!read_attributes(r, at, &attributes, p, &is_lost, &has_missing_normals)) {
        if (io_is_ok(r))
            io_warn(r, at, NULL, "has no POSITION and is not drawn");
        make_empty(p);
        return;
    }
    if (!read_targets(r, at, p) || !gltf_read_primitive_indices(r, at, p, is_lost))
        return;
    if (p->index_count == 0) {
        make_empty(p);
        return;
    }
    check_texcoords(r, at, p);
    gltf_complete_primitive(r, at, p, has_missing_normals);
}

/* Positions relative to the origin of their accessor (of doubles that are far from 0) become relative to that of
 * the mesh, which its first primitive that is drawn sets. */
static void settle_positions(io_reader *r, const json_place *at, scene_mesh *mesh, scene_primitive *p)
{
    json_place attributes = io_get_object(r, at, "attributes");
    uint32_t position = io_peek_index(&attributes, "POSITION", r->gltf->accessor_count);
    const double zero[3] = {0.0, 0.0, 0.0};
    if (!io_is_ok(r) || position == SCENE_NONE || p->index_count == 0)
        return;
    const double *origin = r->gltf->accessors[position].origin;
    const scene_primitive *first = mesh->primitives;
    while (first->index_count == 0)
        first++;
    if (p == first)
        memcpy(mesh->origin, origin, sizeof mesh->origin);
    double shift[3];
    for (int k = 0; k < 3; k++)
        shift[k] = origin[k] - mesh->origin[k];
    if (memcmp(shift, zero, sizeof zero) == 0)
        return;
    float *moved = io_alloc_raw(r, "positions", 3 * (size_t)p->vertex_count, sizeof *moved);
    for (size_t i = 0; moved && i < 3 * (size_t)p->vertex_count; i++)
        moved[i] = (float)((double)p->positions[i] + shift[i % 3]);
    for (int k = 0; k < 3; k++) {
        p->bounds_min[k] = (float)((double)p->bounds_min[k] + shift[k]);
        p->bounds_max[k] = (float)((double)p->bounds_max[k] + shift[k]);
    }
    p->positions = moved ? moved : p->positions;
}

static void read_mesh(io_reader *r, const json_place *at, scene_mesh *mesh)
{
    mesh->name = io_get_name(r, at);
    json_place array = io_get_array(r, at, "primitives");
    if (io_is_ok(r) && !array.value)
        io_fail(r, at, "primitives", FACET_ERROR_INVALID, "is missing");
    size_t count = io_get_count(&array);
    mesh->primitives = io_alloc(r, "primitives", count, sizeof *mesh->primitives);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at_primitive = io_get_element_object(r, &array, i);
        scene_primitive *primitive = &mesh->primitives[i];
        read_primitive(r, &at_primitive, primitive);
        settle_positions(r, &at_primitive, mesh, primitive);
        primitive->variant_materials = read_mappings(r, &at_primitive);
        primitive->meta = gltf_get_meta(r, &at_primitive);
        json_place targets = io_get_array(r, &at_primitive, "targets");
        uint32_t target_count = (uint32_t)io_get_count(&targets);
        if (i > 0 && target_count != mesh->weight_count)
            io_warn(r, &targets, NULL, "must be as many as those of the other primitives of the mesh");
        mesh->weight_count = target_count > mesh->weight_count ? target_count : mesh->weight_count;
        mesh->primitive_count = (uint32_t)(i + 1);
    }
    if (!io_is_ok(r))
        return;
    mesh->weights = gltf_read_weights(r, at, mesh->weight_count);
    if (io_leave_out(r, "its morph targets are ignored"))
        mesh->weights = NULL;
    if (!mesh->weights && mesh->weight_count)
        mesh->weights = io_alloc(r, "weights", mesh->weight_count, sizeof *mesh->weights);
    mesh->meta = gltf_get_meta(r, at);
}

/* A mesh that cannot be read keeps its index; it may not be needed. */
static void read_or_defer_mesh(io_reader *r, const json_place *at, uint32_t index)
{
    scene_mesh *mesh = &r->scene->meshes[index];
    r->gltf->mesh = &r->gltf->meshes[index];
    read_mesh(r, at, mesh);
    if (!io_defer(r, &r->gltf->mesh->problem))
        return;
    *mesh = (scene_mesh){.name = mesh->name,
                         .primitives = io_alloc(r, "primitives", 1, sizeof *mesh->primitives),
                         .primitive_count = 1};
    if (mesh->primitives) {
        mesh->primitives->material = SCENE_NONE;
        make_empty(mesh->primitives);
    }
}

void gltf_read_meshes(io_reader *r, const json_place *root)
{
    json_place array = io_get_array(r, root, "meshes");
    size_t count = io_get_count(&array);
    r->scene->meshes = io_alloc(r, "meshes", count, sizeof *r->scene->meshes);
    r->gltf->meshes = io_alloc(r, "meshes", count, sizeof *r->gltf->meshes);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        read_or_defer_mesh(r, &at, (uint32_t)i);
        r->scene->mesh_count = (uint32_t)(i + 1);
    }
}
