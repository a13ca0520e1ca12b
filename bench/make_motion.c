/* make_motion.c - writes the inputs of bench/frames beside those of bench/make_models into a folder:
 *     many.glb        100 000 instances of a mesh of 1000 triangles (EXT_mesh_gpu_instancing)
 *     parts.glb       200 different parts of 5000 triangles; every fourth rotates
 *     waves.glb       100 000 triangles deformed by a morph target, in front of 400 000 static ones
 * usage: make_motion FOLDER */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"

/* A model under construction. The JSON of each array is complete except for its brackets. */
typedef struct model {
    text bin, views, accessors, meshes, nodes, roots, animations;
    uint32_t accessor_count, mesh_count, node_count;
} model;

static void separate(text *t)
{
    if (t->length)
        text_add(t, ",");
}

static const char *string_of(const text *t)
{
    return t->data ? t->data : "";
}

/* Appends floats (or indices, width 0) as a new accessor; returns its number. */
static uint32_t add_array(model *m, const void *values, uint32_t count, uint32_t width)
{
    static const char *const types[5] = {"SCALAR", "SCALAR", "VEC2", "VEC3", "VEC4"};
    size_t size = (size_t)count * (width ? width : 1) * 4;
    separate(&m->views);
    text_addf(&m->views, "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", m->bin.length, size);
    text_add_bytes(&m->bin, values, size);
    separate(&m->accessors);
    text_addf(&m->accessors, "{\"bufferView\":%u,\"componentType\":%d,\"count\":%u,\"type\":\"%s\"",
              m->accessor_count, width ? 5126 : 5125, count, types[width]);
    if (width == 3) /* positions require bounds, other arrays may have them */
        text_add(&m->accessors, ",\"min\":[-2,-2,-2],\"max\":[2,2,2]");
    text_add(&m->accessors, "}");
    return m->accessor_count++;
}

/* A bumpy sphere of radius 1; has_wave: with a morph target. Returns the mesh's number. */
static uint32_t add_sphere(model *m, uint32_t columns, uint32_t rows, float phase, bool has_wave)
{
    uint32_t vertex_count = (columns + 1) * (rows + 1);
    float *positions = mem_alloc(NULL, vertex_count, 3 * sizeof *positions);
    float *normals = mem_alloc(NULL, vertex_count, 3 * sizeof *normals);
    float *moves = mem_alloc(NULL, vertex_count, 3 * sizeof *moves);
    uint32_t *indices = mem_alloc(NULL, (size_t)columns * rows, 6 * sizeof *indices);
    if (!positions || !normals || !moves || !indices)
        exit(1);
    uint32_t index_count = 0;
    for (uint32_t row = 0; row <= rows; row++)
        for (uint32_t column = 0; column <= columns; column++) {
            uint32_t i = row * (columns + 1) + column;
            float theta = 3.14159265f * (float)row / (float)rows;
            float phi = 6.2831853f * (float)column / (float)columns;
            float radius = 1.0f + 0.15f * sinf(5.0f * phi + phase) * sinf(theta) * sinf(4.0f * theta);
            const float n[3] = {sinf(theta) * sinf(phi), cosf(theta), sinf(theta) * cosf(phi)};
            for (uint32_t k = 0; k < 3; k++) {
                normals[3 * i + k] = n[k];
                positions[3 * i + k] = radius * n[k];
                moves[3 * i + k] = 0.3f * n[k] * sinf(9.0f * theta);
            }
            if (row == rows || column == columns)
                continue;
            const uint32_t quad[6] = {i, i + columns + 1, i + 1, i + 1, i + columns + 1, i + columns + 2};
            for (int k = 0; k < 6; k++)
                indices[index_count++] = quad[k];
        }
    uint32_t position = add_array(m, positions, vertex_count, 3);
    uint32_t normal = add_array(m, normals, vertex_count, 3);
    uint32_t index = add_array(m, indices, index_count, 0);
    separate(&m->meshes);
    text_addf(
        &m->meshes,
        "{\"primitives\":[{\"attributes\":{\"POSITION\":%u,\"NORMAL\":%u},\"indices\":%u,\"material\":0",
        position, normal, index);
    if (has_wave)
        text_addf(&m->meshes, ",\"targets\":[{\"POSITION\":%u}]", add_array(m, moves, vertex_count, 3));
    text_add(&m->meshes, "}]}");
    mem_free(positions);
    mem_free(normals);
    mem_free(moves);
    mem_free(indices);
    return m->mesh_count++;
}

static uint32_t add_node(model *m, uint32_t mesh, float x, float y, float z, float scale)
{
    separate(&m->nodes);
    separate(&m->roots);
    text_addf(&m->roots, "%u", m->node_count);
    text_addf(&m->nodes, "{\"mesh\":%u,\"translation\":[%.6g,%.6g,%.6g],\"scale\":[%.6g,%.6g,%.6g]}", mesh,
              (double)x, (double)y, (double)z, (double)scale, (double)scale, (double)scale);
    return m->node_count++;
}

static void add_u32(text *t, uint32_t value)
{
    const unsigned char bytes[4] = {(unsigned char)value, (unsigned char)(value >> 8),
                                    (unsigned char)(value >> 16), (unsigned char)(value >> 24)};
    text_add_bytes(t, bytes, sizeof bytes);
}

static void write_model(model *m, const char *folder, const char *name, const char *extensions)
{
    text json = {0};
    text_addf(&json, "{\"asset\":{\"version\":\"2.0\"},%s\"scenes\":[{\"nodes\":[%s]}],", extensions,
              string_of(&m->roots));
    text_addf(&json, "\"nodes\":[%s],\"meshes\":[%s],", string_of(&m->nodes), string_of(&m->meshes));
    text_addf(&json, "\"accessors\":[%s],\"bufferViews\":[%s],", string_of(&m->accessors),
              string_of(&m->views));
    if (m->animations.length)
        text_addf(&json, "\"animations\":[%s],", string_of(&m->animations));
    text_addf(&json,
              "\"materials\":[{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.4}}],"
              "\"buffers\":[{\"byteLength\":%zu}]}",
              m->bin.length);
    while (json.length % 4)
        text_add(&json, " ");
    text glb = {0};
    text_add(&glb, "glTF");
    add_u32(&glb, 2);
    add_u32(&glb, (uint32_t)(12 + 8 + json.length + 8 + m->bin.length));
    add_u32(&glb, (uint32_t)json.length);
    add_u32(&glb, 0x4E4F534Au);
    text_add_bytes(&glb, json.data, json.length);
    add_u32(&glb, (uint32_t)m->bin.length);
    add_u32(&glb, 0x004E4942u);
    text_add_bytes(&glb, m->bin.data, m->bin.length);
    char *path = path_join(NULL, folder, name);
    facet_error error = {0};
    if (!path || glb.has_failed || file_write(path, glb.data, glb.length, &error) != FACET_OK) {
        fprintf(stderr, "make_motion: %s\n", error.message);
        exit(1);
    }
    printf("%s: %.1f MB\n", path, (double)glb.length * 1e-6);
    mem_free(path);
    text *const texts[] = {&json,      &glb,      &m->bin,   &m->views,     &m->accessors,
                           &m->meshes, &m->nodes, &m->roots, &m->animations};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        text_destroy(texts[i]);
    *m = (model){0};
}

/* ---- the models ---- */

static void write_many(const char *folder)
{
    enum { SIDE = 316, COUNT = SIDE * SIDE };
    model m = {0};
    uint32_t mesh = add_sphere(&m, 25, 20, 0.0f, false);
    float *translations = mem_alloc(NULL, COUNT, 3 * sizeof *translations);
    float *rotations = mem_alloc(NULL, COUNT, 4 * sizeof *rotations);
    float *scales = mem_alloc(NULL, COUNT, 3 * sizeof *scales);
    if (!translations || !rotations || !scales)
        exit(1);
    for (uint32_t i = 0; i < COUNT; i++) {
        float x = (float)(i % SIDE);
        float z = (float)(i / SIDE);
        float angle = 0.7f * (float)i;
        const float t[3] = {3.0f * x + sinf(angle), 2.0f * sinf(0.05f * x) * cosf(0.07f * z), 3.0f * z};
        const float r[4] = {0.0f, sinf(0.5f * angle), 0.0f, cosf(0.5f * angle)};
        for (uint32_t k = 0; k < 4; k++)
            rotations[4 * i + k] = r[k];
        for (uint32_t k = 0; k < 3; k++) {
            translations[3 * i + k] = t[k];
            scales[3 * i + k] = 1.0f + 0.8f * sinf(1.7f * (float)i + (float)k);
        }
    }
    uint32_t t = add_array(&m, translations, COUNT, 3);
    uint32_t r = add_array(&m, rotations, COUNT, 4);
    uint32_t s = add_array(&m, scales, COUNT, 3);
    text_addf(&m.nodes,
              "{\"mesh\":%u,\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":%u,"
              "\"ROTATION\":%u,\"SCALE\":%u}}}}",
              mesh, t, r, s);
    text_add(&m.roots, "0");
    write_model(&m, folder, "many.glb", "\"extensionsUsed\":[\"EXT_mesh_gpu_instancing\"],");
    mem_free(translations);
    mem_free(rotations);
    mem_free(scales);
}

static const float key_times[3] = {0.0f, 1.0f, 2.0f};

static void write_parts(const char *folder)
{
    enum { COUNT = 200, COLUMNS = 20 };
    static const float turns[12] = {0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, -1};
    model m = {0};
    uint32_t times = add_array(&m, key_times, 3, 1);
    uint32_t rotations = add_array(&m, turns, 3, 4);
    text channels = {0};
    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t mesh = add_sphere(&m, 100, 25, (float)i, false);
        uint32_t node =
            add_node(&m, mesh, 1.5f * (float)(i % COLUMNS), 1.5f * (float)(i / COLUMNS), 0.0f, 0.9f);
        if (i % 4)
            continue;
        separate(&channels);
        text_addf(&channels, "{\"sampler\":0,\"target\":{\"node\":%u,\"path\":\"rotation\"}}", node);
    }
    text_addf(&m.animations, "{\"channels\":[%s],\"samplers\":[{\"input\":%u,\"output\":%u}]}",
              string_of(&channels), times, rotations);
    text_destroy(&channels);
    write_model(&m, folder, "parts.glb", "");
}

static void write_waves(const char *folder)
{
    static const float weights[3] = {0.0f, 1.0f, 0.0f};
    model m = {0};
    uint32_t times = add_array(&m, key_times, 3, 1);
    uint32_t values = add_array(&m, weights, 3, 1);
    uint32_t node = add_node(&m, add_sphere(&m, 400, 125, 0.0f, true), 0.0f, 0.0f, 0.0f, 1.0f);
    uint32_t still = add_sphere(&m, 400, 125, 1.0f, false);
    for (int i = 0; i < 4; i++)
        add_node(&m, i % 2 ? still : add_sphere(&m, 400, 125, 2.0f + (float)i, false),
                 2.2f * (float)(i % 2 * 2 - 1), 2.2f * (float)(i / 2 * 2 - 1), -1.0f, 1.0f);
    text_addf(&m.animations,
              "{\"channels\":[{\"sampler\":0,\"target\":{\"node\":%u,\"path\":\"weights\"}}],\"samplers\":[{"
              "\"input\":%u,\"output\":%u}]}",
              node, times, values);
    write_model(&m, folder, "waves.glb", "");
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: make_motion FOLDER\n");
        return 2;
    }
    write_many(argv[1]);
    write_parts(argv[1]);
    write_waves(argv[1]);
    return 0;
}
