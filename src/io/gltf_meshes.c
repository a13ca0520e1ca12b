/* gltf_meshes.c - meshes and their primitives: which accessor is which attribute, and what a primitive lacks. */
#include <float.h>
#include <stdio.h>
#include <string.h>

#include "base/parallel.h"
#include "io/gltf_reader.h"

enum { GRAIN = 1 << 15, MAX_TEXCOORDS = 64 };

/* ---- which formats an attribute may have (section 3.7.2.1, and KHR_mesh_quantization) ---- */

enum { /* or-ed: component types, each plain or normalised */
       F32 = 1,
       NORMALIZED_UNSIGNED = 2,
       NORMALIZED_SIGNED = 4,
       PLAIN_UNSIGNED = 8,
       PLAIN_SIGNED = 16,
       ANY_INTEGER = NORMALIZED_UNSIGNED | NORMALIZED_SIGNED | PLAIN_UNSIGNED | PLAIN_SIGNED
};

typedef struct attribute_rule {
    gltf_type type, other_type;
    unsigned formats, quantized_formats;
} attribute_rule;

static const attribute_rule POSITION = {GLTF_VEC3, GLTF_VEC3, F32, ANY_INTEGER};
static const attribute_rule NORMAL = {GLTF_VEC3, GLTF_VEC3, F32, NORMALIZED_SIGNED};
static const attribute_rule TANGENT = {GLTF_VEC4, GLTF_VEC4, F32, NORMALIZED_SIGNED};
static const attribute_rule TEXCOORD = {GLTF_VEC2, GLTF_VEC2, F32 | NORMALIZED_UNSIGNED, ANY_INTEGER};
static const attribute_rule COLOR = {GLTF_VEC3, GLTF_VEC4, F32 | NORMALIZED_UNSIGNED, 0};

static unsigned format_of(const gltf_accessor *a)
{
    switch (a->component) {
    case GLTF_F32:
        return F32;
    case GLTF_U8:
    case GLTF_U16:
        return a->is_normalized ? NORMALIZED_UNSIGNED : PLAIN_UNSIGNED;
    case GLTF_I8:
    case GLTF_I16:
        return a->is_normalized ? NORMALIZED_SIGNED : PLAIN_SIGNED;
    default:
        return 0;
    }
}

/* The accessor of an attribute, checked; SCENE_NONE: it has none, or an error is recorded. */
static uint32_t get_attribute(reader *r, const json_place *attributes, const char *name, attribute_rule rule,
                              uint32_t vertex_count)
{
    uint32_t index = get_index(r, attributes, name, r->accessor_count, "accessor");
    if (index == SCENE_NONE)
        return SCENE_NONE;
    gltf_accessor *a = &r->accessors[index];
    /* Colors as plain integers are a common slip; normalised is the only thing they can mean. */
    if (strncmp(name, "COLOR_", 6) == 0 && format_of(a) == PLAIN_UNSIGNED && !a->floats) {
        reader_warn(r, attributes, name, "accessor %u must be normalized; it is taken as if", index);
        a->is_normalized = true;
    }
    unsigned format = format_of(a);
    if ((a->type != rule.type && a->type != rule.other_type) ||
        !(format & (rule.formats | rule.quantized_formats))) {
        reader_fail(r, attributes, name, FACET_ERROR_INVALID,
                    "accessor %u has a type and componentType that %s cannot have", index, name);
        return SCENE_NONE;
    }
    if (!(format & rule.formats) && !r->has_quantization)
        reader_warn(
            r, attributes, name,
            "accessor %u has a componentType that needs KHR_mesh_quantization, which the file does not "
            "declare",
            index);
    if (a->count != vertex_count) {
        reader_fail(r, attributes, name, FACET_ERROR_INVALID,
                    "accessor %u has %u elements, but POSITION has %u", index, a->count, vertex_count);
        return SCENE_NONE;
    }
    return index;
}

static bool read_texcoords(reader *r, const json_place *attributes, scene_primitive *p)
{
    char name[24];
    uint32_t count = 0;
    while (count < MAX_TEXCOORDS) {
        snprintf(name, sizeof name, "TEXCOORD_%u", count);
        if (!has_member(attributes, name))
            break;
        count++;
    }
    const float **sets = reader_alloc(r, "texture coordinates", count, sizeof *sets);
    if (!sets)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        snprintf(name, sizeof name, "TEXCOORD_%u", i);
        uint32_t accessor = get_attribute(r, attributes, name, TEXCOORD, p->vertex_count);
        if (accessor == SCENE_NONE || !(sets[i] = get_texcoords(r, attributes, accessor)))
            return false;
    }
    p->texcoords = sets;
    p->texcoord_count = count;
    return true;
}

/* Names that glTF reserves must be ones it knows, without gaps in their numbers, and all must name accessors. */
static void check_names(reader *r, const json_place *attributes)
{
    static const char *const numbered[] = {"TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"};
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)attributes->value, name, value)
    {
        bool is_known = name[0] == '_' || strcmp(name, "POSITION") == 0 || strcmp(name, "NORMAL") == 0 ||
                        strcmp(name, "TANGENT") == 0;
        for (size_t i = 0; i < sizeof numbered / sizeof *numbered; i++) {
            size_t length = strlen(numbered[i]);
            if (strncmp(name, numbered[i], length) != 0)
                continue;
            unsigned number = 0;
            int used = 0;
            is_known = sscanf(name + length, "%3u%n", &number, &used) == 1 &&
                       name[length + (size_t)used] == 0 && (name[length] != '0' || used == 1);
            char previous[32];
            snprintf(previous, sizeof previous, "%s%u", numbered[i], number - 1);
            if (is_known && number > 0 && !has_member(attributes, previous))
                reader_warn(r, attributes, name, "is there without %s", previous);
        }
        if (!is_known)
            reader_warn(r, attributes, name, "is no attribute of glTF and is ignored");
        uint32_t accessor = get_index(r, attributes, name, r->accessor_count, "accessor");
        if (accessor != SCENE_NONE && r->accessors[accessor].component == GLTF_U32)
            reader_warn(r, attributes, name,
                        "accessor %u has componentType 5125, which attributes cannot have", accessor);
    }
}

/* Whether all that the primitive reads has bytes somewhere. */
static bool has_sources(reader *r, const json_place *at, const json_place *attributes)
{
    const char *name;
    json_t *value;
    uint32_t indices = get_index(r, at, "indices", r->accessor_count, "accessor");
    bool has_all = indices == SCENE_NONE || has_accessor_source(r, indices);
    json_object_foreach((json_t *)(uintptr_t)attributes->value, name, value)
    {
        uint32_t accessor = get_index(r, attributes, name, r->accessor_count, "accessor");
        has_all = has_all && (accessor == SCENE_NONE || has_accessor_source(r, accessor));
    }
    return has_all;
}

static bool read_attributes(reader *r, const json_place *attributes, scene_primitive *p,
                            const uint8_t **is_lost, bool *has_missing_normals)
{
    uint32_t position = get_index(r, attributes, "POSITION", r->accessor_count, "accessor");
    if (position == SCENE_NONE)
        return false;
    p->vertex_count = r->accessors[position].count;
    uint32_t accessor = get_attribute(r, attributes, "POSITION", POSITION, p->vertex_count);
    if (accessor == SCENE_NONE || !(p->positions = get_positions(r, attributes, accessor, is_lost)))
        return false;
    accessor = get_attribute(r, attributes, "NORMAL", NORMAL, p->vertex_count);
    if (accessor != SCENE_NONE && !(p->normals = get_normals(r, attributes, accessor, has_missing_normals)))
        return false;
    accessor = get_attribute(r, attributes, "TANGENT", TANGENT, p->vertex_count);
    if (accessor != SCENE_NONE && p->normals)
        p->tangents = get_tangents(r, attributes, accessor);
    accessor = get_attribute(r, attributes, "COLOR_0", COLOR, p->vertex_count);
    if (accessor != SCENE_NONE && !(p->colors = get_colors(r, attributes, accessor)))
        return false;
    return reader_is_ok(r) && read_texcoords(r, attributes, p);
}

/* ---- bounds ---- */

typedef struct bounds_job {
    const scene_primitive *primitive;
    float (*boxes)[6]; /* per GRAIN indices: minimum, maximum */
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

static bool bound_primitive(reader *r, scene_primitive *p)
{
    if (p->index_count == 0)
        return true;
    size_t ranges = (p->index_count + (size_t)GRAIN - 1) / GRAIN;
    float small[6];
    bounds_job job = {.primitive = p,
                      .boxes = ranges > 1 ? mem_alloc(r->allocator, ranges, sizeof small) : &small};
    if (!job.boxes)
        return reader_fail_memory(r, "bounds", ranges * sizeof small);
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

/* A primitive that draws nothing keeps its place in the mesh. */
static void make_empty(scene_primitive *p)
{
    static const uint32_t no_index = 0;
    static const float no_position[3] = {0, 0, 0};
    *p = (scene_primitive){
        .mode = p->mode, .indices = &no_index, .positions = no_position, .material = p->material};
}

/* Whether the texture coordinates that the material reads are there. */
static void check_texcoords(reader *r, const json_place *at, const scene_primitive *p)
{
    if (p->material == SCENE_NONE)
        return;
    const scene_material *m = &r->scene->materials[p->material];
    for (int i = 0; i < SCENE_TEXTURE_SLOT_COUNT; i++)
        if (m->textures[i].texture != SCENE_NONE && m->textures[i].texcoord >= p->texcoord_count)
            reader_warn(r, at, NULL, "has no TEXCOORD_%u, which material %u reads; it is taken as 0",
                        m->textures[i].texcoord, p->material);
}

static void read_primitive(reader *r, const json_place *at, scene_primitive *p)
{
    p->material = get_index(r, at, "material", r->scene->material_count, "material");
    json_place attributes = get_object(r, at, "attributes");
    if (!attributes.value) {
        reader_fail(r, at, "attributes", FACET_ERROR_INVALID, "is missing");
        return;
    }
    if (json_object_size(attributes.value) == 0)
        reader_warn(r, &attributes, NULL, "is empty, which glTF does not allow");
    check_names(r, &attributes);
    if (!prepare_draco(r, at))
        return;
    if (!has_sources(r, at, &attributes)) {
        reader_warn(r, at, NULL, "is in a buffer without bytes and is not drawn");
        make_empty(p);
        return;
    }
    const uint8_t *is_lost = NULL;
    bool has_missing_normals = false;
    if (!read_attributes(r, &attributes, p, &is_lost, &has_missing_normals)) {
        if (reader_is_ok(r))
            reader_warn(r, at, NULL, "has no POSITION and is not drawn");
        get_index(r, at, "indices", r->accessor_count, "accessor");
        make_empty(p);
        return;
    }
    if (!read_primitive_indices(r, at, p, is_lost))
        return;
    if (p->index_count == 0) {
        make_empty(p);
        return;
    }
    check_texcoords(r, at, p);
    if (p->mode == SCENE_TRIANGLES && !p->normals)
        make_flat(r, at, p);
    else if (has_missing_normals)
        fill_missing_normals(r, at, p);
    if (reader_is_ok(r))
        bound_primitive(r, p);
}

/* Shapes that blend are not drawn yet; that they hang together is checked all the same. */
static void check_targets(reader *r, const json_place *at)
{
    json_place targets = get_array(r, at, "targets");
    for (size_t i = 0; i < get_count(&targets) && reader_is_ok(r); i++) {
        json_place target = get_element_object(r, &targets, i);
        json_place attributes = get_object(r, at, "attributes");
        const char *name;
        json_t *value;
        json_object_foreach((json_t *)(uintptr_t)target.value, name, value)
        {
            uint32_t accessor = get_index(r, &target, name, r->accessor_count, "accessor");
            uint32_t base = get_index(r, &attributes, name, r->accessor_count, "accessor");
            if (accessor == SCENE_NONE)
                return;
            if (base == SCENE_NONE)
                reader_warn(r, &target, name, "is not among the attributes of the primitive");
            else if (r->accessors[accessor].count != r->accessors[base].count)
                reader_fail(r, &target, name, FACET_ERROR_INVALID,
                            "accessor %u has %u elements, but that of the primitive has %u", accessor,
                            r->accessors[accessor].count, r->accessors[base].count);
        }
    }
}

static void read_mesh(reader *r, const json_place *at, scene_mesh *mesh)
{
    mesh->name = get_name(r, at);
    json_place array = get_array(r, at, "primitives");
    if (!array.value) {
        reader_fail(r, at, "primitives", FACET_ERROR_INVALID, "is missing");
        return;
    }
    size_t count = get_count(&array);
    size_t target_count = 0;
    mesh->primitives = reader_alloc(r, "primitives", count, sizeof *mesh->primitives);
    for (size_t i = 0; i < count && reader_is_ok(r); i++) {
        json_place primitive = get_element_object(r, &array, i);
        read_primitive(r, &primitive, &mesh->primitives[i]);
        check_targets(r, &primitive);
        json_place targets = get_array(r, &primitive, "targets");
        if (i > 0 && get_count(&targets) != target_count)
            reader_warn(r, &targets, NULL, "must be as many as those of the other primitives of the mesh");
        target_count = get_count(&targets);
        mesh->primitive_count = (uint32_t)(i + 1);
    }
}

void read_meshes(reader *r, const json_place *root)
{
    json_place array = get_array(r, root, "meshes");
    size_t count = get_count(&array);
    r->scene->meshes = reader_alloc(r, "meshes", count, sizeof *r->scene->meshes);
    for (size_t i = 0; i < count && reader_is_ok(r); i++) {
        json_place at = get_element_object(r, &array, i);
        read_mesh(r, &at, &r->scene->meshes[i]);
        r->scene->mesh_count = (uint32_t)(i + 1);
    }
}
