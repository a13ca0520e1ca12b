/* usd_scene.c - nodes as transforms, with their animation, and triangles as meshes. */
#include <ctype.h>
#include <stddef.h>
#include <string.h>

#include "base/memory.h"
#include "io/usd/usd_writer.h"

/* ---- values ---- */

void usd_float(usd_writer *w, float value)
{
    char digits[TEXT_FLOAT_SIZE];
    text_shortest_float(value, digits);
    text_add(&w->out, digits);
}

void usd_tuple(usd_writer *w, const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        text_add(&w->out, i ? ", " : "(");
        usd_float(w, values[i]);
    }
    text_add(&w->out, ")");
}

void usd_identifier(usd_writer *w, const char *name, uint32_t number)
{
    char clean[64];
    size_t length = 0;
    for (; name[length] && length + 1 < sizeof clean; length++)
        clean[length] =
            isalnum((unsigned char)name[length]) && (unsigned char)name[length] < 128 ? name[length] : '_';
    clean[length] = 0;
    text_addf(&w->out, "%s%s_%u",
              length == 0                        ? "Node"
              : isdigit((unsigned char)clean[0]) ? "_"
                                                 : "",
              clean, number);
}

/* ---- meshes ---- */

static void write_array(usd_writer *w, const char *declaration, const float *values, size_t count,
                        size_t width)
{
    text_addf(&w->out, "%s = [", declaration);
    for (size_t i = 0; i < count; i++) {
        text_add(&w->out, i ? ", " : "");
        usd_tuple(w, values + width * i, width);
    }
    text_add(&w->out, "]");
}

/* (u, v) with v down as (u, 1 - v) with v up. */
static void write_texcoords(usd_writer *w, const scene_primitive *p, uint32_t set)
{
    text_add(&w->out, "texCoord2f[] primvars:st");
    if (set)
        text_addf(&w->out, "%u", set);
    text_add(&w->out, " = [");
    for (size_t i = 0; i < p->vertex_count; i++) {
        const float st[2] = {p->texcoords[set][2 * i], 1.0f - p->texcoords[set][2 * i + 1]};
        text_add(&w->out, i ? ", " : "");
        usd_tuple(w, st, 2);
    }
    text_add(&w->out, "] (\n    interpolation = \"vertex\"\n)\n");
}

static void write_primitive(usd_writer *w, const scene_mesh *mesh, uint32_t index)
{
    const scene_primitive *p = &mesh->primitives[index];
    text *t = &w->out;
    text_addf(t, "def Mesh \"Primitive_%u\" (\n    prepend apiSchemas = [\"MaterialBindingAPI\"]\n)\n{\n",
              index);
    if (p->material != SCENE_NONE)
        text_addf(t, "rel material:binding = </Root/Materials/Material_%u>\n", p->material);
    text_addf(t, "uniform bool doubleSided = %d\nuniform token subdivisionScheme = \"none\"\n",
              scene_get_material(w->scene, p->material)->is_double_sided);
    if (mesh->origin[0] != 0.0 || mesh->origin[1] != 0.0 || mesh->origin[2] != 0.0)
        text_addf(t,
                  "double3 xformOp:translate = (%.17g, %.17g, %.17g)\n"
                  "uniform token[] xformOpOrder = [\"xformOp:translate\"]\n",
                  mesh->origin[0], mesh->origin[1], mesh->origin[2]);
    text_add(t, "int[] faceVertexCounts = [");
    for (uint32_t i = 0; i < p->index_count; i += 3)
        text_add(t, i ? ", 3" : "3");
    text_add(t, "]\nint[] faceVertexIndices = [");
    for (uint32_t i = 0; i < p->index_count; i++)
        text_addf(t, "%s%u", i ? ", " : "", p->indices[i]);
    text_add(t, "]\n");
    write_array(w, "point3f[] points", p->positions, p->vertex_count, 3);
    text_add(t, "\n");
    if (p->normals) {
        write_array(w, "normal3f[] normals", p->normals, p->vertex_count, 3);
        text_add(t, " (\n    interpolation = \"vertex\"\n)\n");
    }
    for (uint32_t set = 0; set < p->texcoord_count; set++)
        write_texcoords(w, p, set);
    w->losses |= p->influence_count ? USD_LOST_SKINS : 0u;
    w->losses |= p->target_count ? USD_LOST_MORPHS : 0u;
    w->losses |= p->colors ? USD_LOST_COLORS : 0u;
    text_add(t, "}\n");
}

static void write_mesh(usd_writer *w, uint32_t index)
{
    const scene_mesh *mesh = &w->scene->meshes[index];
    for (uint32_t i = 0; i < mesh->primitive_count; i++)
        if (mesh->primitives[i].mode != SCENE_TRIANGLES)
            w->losses |= USD_LOST_LINES;
        else if (mesh->primitives[i].index_count)
            write_primitive(w, mesh, i);
}

/* ---- transforms ---- */

usd_node *usd_nodes_create(const facet_scene *scene)
{
    usd_node *nodes = mem_zalloc(&scene->allocator, (size_t)scene->node_count + 1, sizeof *nodes);
    const scene_animation *a = scene->animations;
    for (uint32_t i = 0; nodes && scene->animation_count && i < a->channel_count; i++) {
        const scene_channel *c = &a->channels[i];
        const scene_sampler *sampler = &a->samplers[c->sampler];
        if (c->kind != SCENE_TARGET_NODE)
            continue;
        if (c->offset == offsetof(scene_node, translation))
            nodes[c->index].translation = sampler;
        else if (c->offset == offsetof(scene_node, rotation))
            nodes[c->index].rotation = sampler;
        else if (c->offset == offsetof(scene_node, scale))
            nodes[c->index].scale = sampler;
    }
    return nodes;
}

/* glTF has x y z w, USD the real part first. */
static void write_value(usd_writer *w, const float *value, size_t width)
{
    const float quaternion[4] = {value[width - 1], value[0], value[1], value[width > 2 ? 2 : 0]};
    usd_tuple(w, width == 4 ? quaternion : value, width);
}

/* An operation at rest, or as keys, between which USD interpolates linearly. */
static void write_operation(usd_writer *w, const char *declaration, const float *rest, size_t width,
                            const scene_sampler *motion)
{
    text_add(&w->out, declaration);
    if (!motion || motion->width != width) {
        text_add(&w->out, " = ");
        write_value(w, rest, width);
        text_add(&w->out, "\n");
        return;
    }
    const size_t stride = motion->interpolation == SCENE_CUBIC_SPLINE ? 3 * width : width;
    const float *values = motion->values + (stride > width ? width : 0);
    if (motion->interpolation != SCENE_LINEAR)
        w->losses |= USD_LOST_MOTION;
    text_add(&w->out, ".timeSamples = {\n");
    for (uint32_t i = 0; i < motion->key_count; i++) {
        usd_float(w, motion->times[i] * USD_FPS);
        text_add(&w->out, ": ");
        write_value(w, values + stride * i, width);
        text_add(&w->out, ",\n");
    }
    text_add(&w->out, "}\n");
}

/* A row of USD's matrices, which multiply row vectors, is a column of glTF's. */
static void write_matrix(usd_writer *w, const dmat4 *m)
{
    text_add(&w->out, "matrix4d xformOp:transform = (");
    for (int row = 0; row < 4; row++)
        text_addf(&w->out, "%s(%.17g, %.17g, %.17g, %.17g)", row ? ", " : "", m->m[4 * row],
                  m->m[4 * row + 1], m->m[4 * row + 2], m->m[4 * row + 3]);
    text_add(&w->out, ")\nuniform token[] xformOpOrder = [\"xformOp:transform\"]\n");
}

static void write_transform(usd_writer *w, uint32_t index)
{
    const scene_node *n = &w->scene->nodes[index];
    if (n->has_matrix) {
        write_matrix(w, &n->matrix);
        return;
    }
    const float translation[3] = {(float)n->translation[0], (float)n->translation[1],
                                  (float)n->translation[2]};
    const usd_node *motion = &w->nodes[index];
    if (motion->translation)
        write_operation(w, "double3 xformOp:translate", translation, 3, motion->translation);
    else
        text_addf(&w->out, "double3 xformOp:translate = (%.17g, %.17g, %.17g)\n", n->translation[0],
                  n->translation[1], n->translation[2]);
    write_operation(w, "quatf xformOp:orient", n->rotation, 4, motion->rotation);
    write_operation(w, "float3 xformOp:scale", n->scale, 3, motion->scale);
    text_add(&w->out, "uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\", "
                      "\"xformOp:scale\"]\n");
}

/* Copies of the mesh (EXT_mesh_gpu_instancing). */
static void write_copies(usd_writer *w, const scene_node *n)
{
    static const float none[3] = {0, 0, 0}, identity[4] = {0, 0, 0, 1}, one[3] = {1, 1, 1};
    const scene_instancing *c = n->instancing;
    for (size_t i = 0; i < c->count; i++) {
        text_addf(&w->out, "def Xform \"Copy_%zu\"\n{\n", i);
        write_operation(w, "double3 xformOp:translate", c->translations ? c->translations + 3 * i : none, 3,
                        NULL);
        write_operation(w, "quatf xformOp:orient", c->rotations ? c->rotations + 4 * i : identity, 4, NULL);
        write_operation(w, "float3 xformOp:scale", c->scales ? c->scales + 3 * i : one, 3, NULL);
        text_add(&w->out, "uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\", "
                          "\"xformOp:scale\"]\n");
        write_mesh(w, n->mesh);
        text_add(&w->out, "}\n");
    }
}

/* ---- nodes ---- */

static void begin_node(usd_writer *w, uint32_t index)
{
    const scene_node *n = &w->scene->nodes[index];
    text_add(&w->out, "def Xform \"");
    usd_identifier(w, n->name, index);
    text_add(&w->out, "\"\n{\n");
    write_transform(w, index);
    if (n->is_hidden)
        text_add(&w->out, "token visibility = \"invisible\"\n");
    w->losses |= n->camera != SCENE_NONE ? USD_LOST_CAMERAS : 0u;
    w->losses |= n->light != SCENE_NONE ? USD_LOST_LIGHTS : 0u;
    if (n->mesh != SCENE_NONE && n->instancing)
        write_copies(w, n);
    else if (n->mesh != SCENE_NONE)
        write_mesh(w, n->mesh);
}

void usd_write_node(usd_writer *w, uint32_t root)
{
    begin_node(w, root);
    for (uint32_t node = root;;) { /* nodes may nest too deep for recursion */
        const scene_node *n = &w->scene->nodes[node];
        if (w->nodes[node].children_begun < n->child_count) {
            node = n->children[w->nodes[node].children_begun++];
            begin_node(w, node);
            continue;
        }
        text_add(&w->out, "}\n");
        if (node == root)
            return;
        node = n->parent;
    }
}
