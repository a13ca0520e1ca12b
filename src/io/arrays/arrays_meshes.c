/* arrays_meshes.c - meshes: checked copies of the arrays. Unit normals and tangents, flat normals and bounds are the glTF
 * reader's. */
#include <math.h>
#include <stdio.h>

#include "io/arrays/arrays_reader.h"
#include "io/gltf/gltf_reader.h"

static const unsigned CORNERS[] = {3, 2, 1}; /* of an element, by facet_primitive_mode */
static const scene_mode MODES[] = {SCENE_TRIANGLES, SCENE_LINES, SCENE_POINTS};
static const char *const ELEMENTS[] = {"triangles", "lines", "points"};

/* ---- attributes ---- */

/* Presents floats as an accessor, as which the glTF reader takes vectors. A type of integers has no exact unit vectors, so that
 * the reader does not remark on their lengths. */
static gltf_accessor as_accessor(const float *floats, uint32_t count, gltf_type type)
{
    return (gltf_accessor){.floats = floats, .count = count, .type = type, .component = GLTF_I8};
}

static bool read_normals(io_reader *r, const json_place *at, const facet_primitive_desc *in,
                         scene_primitive *p, bool *has_missing)
{
    const size_t count = in->vertex_count;
    *has_missing = false;
    if (!in->normals)
        return true;
    gltf_accessor normals = as_accessor(arrays_copy_floats(r, at, "normals", in->normals, 3 * count),
                                        in->vertex_count, GLTF_VEC3);
    r->gltf->accessors = &normals;
    if (normals.floats)
        p->normals = gltf_get_normals(r, at, 0, has_missing);
    if (in->tangents && io_is_ok(r)) {
        gltf_accessor tangents = as_accessor(arrays_copy_floats(r, at, "tangents", in->tangents, 4 * count),
                                             in->vertex_count, GLTF_VEC4);
        r->gltf->accessors = &tangents;
        if (tangents.floats)
            p->tangents = gltf_get_tangents(r, at, 0);
    }
    r->gltf->accessors = NULL;
    return io_is_ok(r);
}

static bool read_texcoords(io_reader *r, const json_place *at, const facet_primitive_desc *in,
                           scene_primitive *p)
{
    while (p->texcoord_count < FACET_MAX_TEXCOORDS && in->texcoords[p->texcoord_count])
        p->texcoord_count++;
    const float **sets = io_alloc(r, "texture coordinates", p->texcoord_count, sizeof *sets);
    for (uint32_t i = 0; i < p->texcoord_count && io_is_ok(r); i++) {
        ARRAYS_PLACE(array, set, at, "texcoords", i);
        sets[i] = arrays_copy_floats(r, &set, NULL, in->texcoords[i], 2 * (size_t)in->vertex_count);
    }
    p->texcoords = sets;
    return io_is_ok(r);
}

static bool read_colors(io_reader *r, const json_place *at, const facet_primitive_desc *in,
                        scene_primitive *p)
{
    size_t count = 4 * (size_t)in->vertex_count;
    if (!in->colors)
        return true;
    if (!arrays_check_floats(r, at, "colors", in->colors, count))
        return false;
    float *colors = arrays_copy(r, "colors", in->colors, count, sizeof *colors);
    for (size_t i = 0; i < count && colors; i++)
        colors[i] = fminf(fmaxf(colors[i], 0.0f), 1.0f);
    p->colors = colors;
    return io_is_ok(r);
}

/* ---- indices ---- */

static bool read_indices(io_reader *r, const json_place *at, const facet_primitive_desc *in,
                         scene_primitive *p)
{
    const uint32_t count = in->indices ? in->index_count : in->vertex_count;
    const unsigned corners = CORNERS[in->mode];
    if (!in->indices && in->index_count)
        return io_fail(r, at, "indices", FACET_ERROR_ARGUMENT, "is NULL, but index_count is %u",
                       in->index_count);
    if (count % corners)
        return io_fail(r, at, in->indices ? "index_count" : "vertex_count", FACET_ERROR_ARGUMENT,
                       "is %u, but %s need a multiple of %u", count, ELEMENTS[in->mode], corners);
    for (uint32_t i = 0; i < count && in->indices; i++)
        if (in->indices[i] >= in->vertex_count)
            return io_fail(r, at, "indices", FACET_ERROR_ARGUMENT,
                           "number %u is %u, but there are %u vertices", i, in->indices[i], in->vertex_count);
    uint32_t *indices = io_alloc_raw(r, "indices", count, sizeof *indices);
    for (uint32_t i = 0; i < count && indices; i++)
        indices[i] = in->indices ? in->indices[i] : i;
    p->indices = indices;
    p->index_count = count;
    return io_is_ok(r);
}

/* ---- materials ---- */

static bool read_material(io_reader *r, const json_place *at, const facet_arrays_desc *arrays,
                          const facet_primitive_desc *in, scene_primitive *p)
{
    p->material = SCENE_NONE;
    if (in->has_material &&
        arrays_check_index(r, at, "material", in->material, arrays->material_count, "materials"))
        p->material = in->material;
    if (!in->variant_materials)
        return io_is_ok(r);
    for (uint32_t i = 0; i < arrays->variant_count && io_is_ok(r); i++)
        if (in->variant_materials[i] != SCENE_NONE)
            arrays_check_index(r, at, "variant_materials", in->variant_materials[i], arrays->material_count,
                               "materials");
    p->variant_materials = arrays_copy(r, "variants", in->variant_materials, arrays->variant_count,
                                       sizeof *in->variant_materials);
    return io_is_ok(r);
}

/* Warns about sets of texture coordinates that the material reads and the primitive lacks. */
static void check_texcoords(io_reader *r, const json_place *at, const scene_primitive *p)
{
    const scene_material *m = scene_get_material(r->scene, p->material);
    for (int i = 0; i < SCENE_TEXTURE_SLOT_COUNT; i++)
        if (m->textures[i].texture != SCENE_NONE && m->textures[i].texcoord >= p->texcoord_count)
            io_warn(r, at, NULL, "has no texcoords[%u], which material %u reads; it is taken as 0",
                    m->textures[i].texcoord, p->material);
}

/* ---- primitives ---- */

static void read_primitive(io_reader *r, const json_place *at, const facet_arrays_desc *arrays,
                           const facet_primitive_desc *in, scene_primitive *p)
{
    bool has_missing_normals = false;
    if ((unsigned)in->mode >= sizeof MODES / sizeof *MODES) {
        io_fail(r, at, "mode", FACET_ERROR_ARGUMENT, "is %d, which is no facet_primitive_mode",
                (int)in->mode);
        return;
    }
    if (!in->positions || in->vertex_count == 0) {
        io_fail(r, at, "positions", FACET_ERROR_ARGUMENT, "is NULL or empty");
        return;
    }
    *p = (scene_primitive){.mode = MODES[in->mode], .vertex_count = in->vertex_count};
    p->positions = arrays_copy_floats(r, at, "positions", in->positions, 3 * (size_t)in->vertex_count);
    if (!p->positions || !read_normals(r, at, in, p, &has_missing_normals) || !read_texcoords(r, at, in, p) ||
        !read_colors(r, at, in, p) || !read_indices(r, at, in, p) || !read_material(r, at, arrays, in, p))
        return;
    if (p->index_count == 0) {
        io_fail(r, at, "indices", FACET_ERROR_ARGUMENT, "is empty");
        return;
    }
    check_texcoords(r, at, p);
    gltf_complete_primitive(r, at, p, has_missing_normals);
}

void arrays_read_meshes(io_reader *r, const facet_arrays_desc *in)
{
    if (!arrays_check_array(r, NULL, "meshes", in->meshes, in->mesh_count))
        return;
    r->scene->meshes = io_alloc(r, "meshes", in->mesh_count, sizeof *r->scene->meshes);
    for (uint32_t i = 0; i < in->mesh_count && io_is_ok(r); i++) {
        ARRAYS_PLACE(meshes, mesh, NULL, "meshes", i);
        const facet_mesh_desc *desc = &in->meshes[i];
        scene_mesh *out = &r->scene->meshes[i];
        out->name = arrays_copy_text(r, desc->name);
        if (!arrays_check_array(r, &mesh, "primitives", desc->primitives, desc->primitive_count))
            return;
        out->primitives = io_alloc(r, "primitives", desc->primitive_count, sizeof *out->primitives);
        for (uint32_t k = 0; k < desc->primitive_count && io_is_ok(r); k++) {
            ARRAYS_PLACE(primitives, at, &mesh, "primitives", k);
            read_primitive(r, &at, in, &desc->primitives[k], &out->primitives[k]);
            out->primitive_count = k + 1;
        }
        r->scene->mesh_count = i + 1;
    }
}
