/* make_scenes.c - writes the scenes of bench/convergence.sh into a folder, each with its own camera:
 *     interior.glb    a closed room of glossy surfaces with two luminous panels
 *     sky.glb         blocks and spheres on a plane, for a sun and sky.hdr
 *     glass.glb       clear, rough and colored glass on a checkered floor, for studio.hdr
 *     lights.glb      10 000 emissive triangles over a few objects
 *     volume.glb      scattering volumes under a panel
 *     sky.hdr         256 x 128, a clear sky without the sun
 *     studio.hdr      512 x 256, two soft boxes
 * usage: make_scenes FOLDER */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/image.h"

/* A model under construction. The JSON of each array is complete except for its brackets. */
typedef struct model {
    text bin, views, accessors, meshes, nodes, roots, materials;
    text positions, normals, indices; /* of the current mesh */
    uint32_t accessor_count, mesh_count, material_count, vertex_count;
} model;

static const float PI_F = 3.14159265f;

static void stop(const facet_error *error)
{
    fprintf(stderr, "make_scenes: %s\n", error->message);
    exit(1);
}

static void separate(text *t)
{
    if (t->length)
        text_add(t, ",");
}

static const char *string_of(const text *t)
{
    return t->data ? t->data : "";
}

static uint32_t add_array(model *m, const text *values, uint32_t width, const float bounds[6])
{
    separate(&m->views);
    text_addf(&m->views, "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", m->bin.length,
              values->length);
    text_add_bytes(&m->bin, values->data, values->length);
    separate(&m->accessors);
    text_addf(&m->accessors, "{\"bufferView\":%u,\"componentType\":%d,\"count\":%zu,\"type\":\"%s\"",
              m->accessor_count, width == 3 ? 5126 : 5125, values->length / 4 / width,
              width == 3 ? "VEC3" : "SCALAR");
    if (bounds)
        text_addf(&m->accessors, ",\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]", (double)bounds[0],
                  (double)bounds[1], (double)bounds[2], (double)bounds[3], (double)bounds[4],
                  (double)bounds[5]);
    text_add(&m->accessors, "}");
    return m->accessor_count++;
}

/* ---- shapes ---- */

static uint32_t add_vertex(model *m, const float position[3], const float normal[3])
{
    text_add_bytes(&m->positions, position, 12);
    text_add_bytes(&m->normals, normal, 12);
    return m->vertex_count++;
}

static void add_quad_indices(model *m, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    const uint32_t quad[6] = {a, b, c, a, c, d};
    text_add_bytes(&m->indices, quad, sizeof quad);
}

/* The parallelogram around c with half sides u and v, facing u x v. */
static void add_panel(model *m, const float c[3], const float u[3], const float v[3])
{
    static const float signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    float n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    uint32_t first = m->vertex_count;
    for (int k = 0; k < 3; k++)
        n[k] /= length;
    for (int i = 0; i < 4; i++) {
        float p[3];
        for (int k = 0; k < 3; k++)
            p[k] = c[k] + signs[i][0] * u[k] + signs[i][1] * v[k];
        add_vertex(m, p, n);
    }
    add_quad_indices(m, first, first + 1, first + 2, first + 3);
}

/* A box; side -1 turns it inside out. */
static void add_box(model *m, float x, float y, float z, float half_x, float half_y, float half_z, float side)
{
    const float half[3] = {half_x, half_y, half_z};
    for (int axis = 0; axis < 3; axis++)
        for (int sign = -1; sign <= 1; sign += 2) {
            float c[3] = {x, y, z};
            float u[3] = {0};
            float v[3] = {0};
            c[axis] += (float)sign * half[axis];
            u[(axis + 1) % 3] = half[(axis + 1) % 3] * (float)sign * side;
            v[(axis + 2) % 3] = half[(axis + 2) % 3];
            add_panel(m, c, u, v);
        }
}

static void add_ball(model *m, float x, float y, float z, float radius)
{
    enum { COLUMNS = 96, ROWS = 48 };
    uint32_t first = m->vertex_count;
    for (uint32_t row = 0; row <= ROWS; row++)
        for (uint32_t column = 0; column <= COLUMNS; column++) {
            float theta = PI_F * (float)row / (float)ROWS;
            float phi = 2.0f * PI_F * (float)(column % COLUMNS) / (float)COLUMNS;
            float ring = row % ROWS ? sinf(theta) : 0.0f;
            const float n[3] = {ring * sinf(phi), cosf(theta), ring * cosf(phi)};
            const float p[3] = {x + radius * n[0], y + radius * n[1], z + radius * n[2]};
            add_vertex(m, p, n);
            if (row == ROWS || column == COLUMNS)
                continue;
            uint32_t i = first + row * (COLUMNS + 1) + column;
            add_quad_indices(m, i, i + COLUMNS + 1, i + COLUMNS + 2, i + 1);
        }
}

/* Turns the geometry added since the last call into a mesh of one material. */
static void end_mesh(model *m, uint32_t material)
{
    float bounds[6] = {1e9f, 1e9f, 1e9f, -1e9f, -1e9f, -1e9f};
    const float *p = (const float *)(const void *)m->positions.data;
    for (uint32_t i = 0; i < 3 * m->vertex_count; i++) {
        bounds[i % 3] = fminf(bounds[i % 3], p[i]);
        bounds[3 + i % 3] = fmaxf(bounds[3 + i % 3], p[i]);
    }
    uint32_t position = add_array(m, &m->positions, 3, bounds);
    uint32_t normal = add_array(m, &m->normals, 3, NULL);
    uint32_t index = add_array(m, &m->indices, 1, NULL);
    separate(&m->meshes);
    text_addf(&m->meshes,
              "{\"primitives\":[{\"attributes\":{\"POSITION\":%u,\"NORMAL\":%u},\"indices\":%u,\"material\":%"
              "u}]}",
              position, normal, index, material);
    separate(&m->nodes);
    separate(&m->roots);
    text_addf(&m->nodes, "{\"mesh\":%u}", m->mesh_count);
    text_addf(&m->roots, "%u", m->mesh_count++);
    text_destroy(&m->positions);
    text_destroy(&m->normals);
    text_destroy(&m->indices);
    m->positions = m->normals = m->indices = (text){0};
    m->vertex_count = 0;
}

/* ---- materials ---- */

static uint32_t add_material(model *m, float r, float g, float b, float metallic, float roughness,
                             const char *more)
{
    separate(&m->materials);
    text_addf(&m->materials,
              "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[%.6g,%.6g,%.6g,1],\"metallicFactor\":%.6g,"
              "\"roughnessFactor\":%.6g}%s}",
              (double)r, (double)g, (double)b, (double)metallic, (double)roughness, more);
    return m->material_count++;
}

/* Emission only: black, without a specular lobe. */
static uint32_t add_light(model *m, float r, float g, float b, float radiance)
{
    char more[256];
    snprintf(more, sizeof more,
             ",\"emissiveFactor\":[%.6g,%.6g,%.6g],\"extensions\":{\"KHR_materials_emissive_strength\":{"
             "\"emissiveStrength\":%.6g},\"KHR_materials_specular\":{\"specularFactor\":0}}",
             (double)r, (double)g, (double)b, (double)radiance);
    return add_material(m, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, more);
}

static uint32_t add_glass(model *m, float roughness, const char *volume, const char *scatter)
{
    char more[512];
    snprintf(
        more, sizeof more,
        ",\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1},\"KHR_materials_ior\":{"
        "\"ior\":1.5},\"KHR_materials_volume\":{\"thicknessFactor\":1%s}%s}",
        volume, scatter);
    return add_material(m, 1.0f, 1.0f, 1.0f, 0.0f, roughness, more);
}

/* ---- camera and file ---- */

/* The last node: a camera at eye looking at target, +Y up. */
static void add_camera(model *m, const float eye[3], const float target[3])
{
    float z[3];
    float length = 0.0f;
    for (int k = 0; k < 3; k++) {
        z[k] = eye[k] - target[k];
        length += z[k] * z[k];
    }
    for (int k = 0; k < 3; k++)
        z[k] /= sqrtf(length);
    float ring = sqrtf(z[0] * z[0] + z[2] * z[2]);
    const float x[3] = {z[2] / ring, 0.0f, -z[0] / ring};
    const float y[3] = {z[1] * x[2], z[2] * x[0] - z[0] * x[2], -z[1] * x[0]};
    separate(&m->nodes);
    separate(&m->roots);
    text_add(&m->nodes, "{\"camera\":0,\"matrix\":[");
    const float *const columns[4] = {x, y, z, eye};
    for (int c = 0; c < 4; c++)
        text_addf(&m->nodes, "%s%.9g,%.9g,%.9g,%d", c ? "," : "", (double)columns[c][0],
                  (double)columns[c][1], (double)columns[c][2], c == 3);
    text_add(&m->nodes, "]}");
    text_addf(&m->roots, "%u", m->mesh_count);
}

static void add_u32(text *t, uint32_t value)
{
    const unsigned char bytes[4] = {(unsigned char)value, (unsigned char)(value >> 8),
                                    (unsigned char)(value >> 16), (unsigned char)(value >> 24)};
    text_add_bytes(t, bytes, sizeof bytes);
}

static void write_model(model *m, const char *folder, const char *name)
{
    text json = {0};
    text_addf(&json,
              "{\"asset\":{\"version\":\"2.0\",\"generator\":\"facet bench\"},\"extensionsUsed\":[\"KHR_"
              "materials_emissive_strength\",\"KHR_materials_specular\",\"KHR_materials_transmission\",\"KHR_"
              "materials_ior\",\"KHR_materials_volume\",\"KHR_materials_volume_scatter\"],"
              "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.7,\"aspectRatio\":1,"
              "\"znear\":0.01}}],\"scene\":0,\"scenes\":[{\"nodes\":[%s]}],",
              string_of(&m->roots));
    text_addf(&json, "\"nodes\":[%s],\"meshes\":[%s],\"materials\":[%s],", string_of(&m->nodes),
              string_of(&m->meshes), string_of(&m->materials));
    text_addf(&json, "\"accessors\":[%s],\"bufferViews\":[%s],\"buffers\":[{\"byteLength\":%zu}]}",
              string_of(&m->accessors), string_of(&m->views), m->bin.length);
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
    if (!path || glb.has_failed || file_write(path, glb.data, glb.length, &error) != FACET_OK)
        stop(&error);
    printf("%s: %.1f MB\n", path, (double)glb.length * 1e-6);
    mem_free(path);
    text *const texts[] = {&json,      &glb,      &m->bin,   &m->views,    &m->accessors,
                           &m->meshes, &m->nodes, &m->roots, &m->materials};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        text_destroy(texts[i]);
    *m = (model){0};
}

/* ---- the scenes ---- */

static void write_interior(const char *folder)
{
    model m = {0};
    uint32_t plaster = add_material(&m, 0.75f, 0.73f, 0.7f, 0.0f, 0.6f, "");
    uint32_t red = add_material(&m, 0.6f, 0.08f, 0.06f, 0.0f, 0.4f, "");
    uint32_t parquet = add_material(&m, 0.25f, 0.14f, 0.07f, 0.0f, 0.12f, "");
    uint32_t gold = add_material(&m, 1.0f, 0.76f, 0.33f, 1.0f, 0.25f, "");
    uint32_t steel = add_material(&m, 0.8f, 0.82f, 0.85f, 1.0f, 0.2f, "");
    uint32_t glaze = add_material(&m, 0.1f, 0.25f, 0.6f, 0.0f, 0.12f, "");
    uint32_t light = add_light(&m, 1.0f, 0.9f, 0.75f, 18.0f);
    add_panel(&m, (float[]){0, 3, 0}, (float[]){3, 0, 0}, (float[]){0, 0, 3.5f});
    add_panel(&m, (float[]){0, 1.5f, -3.5f}, (float[]){3, 0, 0}, (float[]){0, 1.5f, 0});
    add_panel(&m, (float[]){0, 1.5f, 3.5f}, (float[]){-3, 0, 0}, (float[]){0, 1.5f, 0});
    add_panel(&m, (float[]){3, 1.5f, 0}, (float[]){0, 0, 3.5f}, (float[]){0, 1.5f, 0});
    end_mesh(&m, plaster);
    add_panel(&m, (float[]){-3, 1.5f, 0}, (float[]){0, 0, -3.5f}, (float[]){0, 1.5f, 0});
    end_mesh(&m, red);
    add_panel(&m, (float[]){0, 0, 0}, (float[]){3, 0, 0}, (float[]){0, 0, -3.5f});
    end_mesh(&m, parquet);
    add_panel(&m, (float[]){-1.2f, 2.95f, -0.8f}, (float[]){0.25f, 0, 0}, (float[]){0, 0, 0.8f});
    add_panel(&m, (float[]){1.2f, 2.95f, -0.8f}, (float[]){0.25f, 0, 0}, (float[]){0, 0, 0.8f});
    end_mesh(&m, light);
    add_ball(&m, -1.1f, 0.6f, -1.2f, 0.6f);
    end_mesh(&m, gold);
    add_ball(&m, 0.5f, 0.4f, -0.2f, 0.4f);
    end_mesh(&m, glaze);
    add_box(&m, 1.3f, 0.8f, -1.8f, 0.5f, 0.8f, 0.5f, 1.0f);
    end_mesh(&m, steel);
    add_camera(&m, (float[]){0.3f, 1.5f, 3.3f}, (float[]){0.0f, 0.95f, -1.0f});
    write_model(&m, folder, "interior.glb");
}

static void write_sky(const char *folder)
{
    model m = {0};
    uint32_t plain = add_material(&m, 0.35f, 0.32f, 0.27f, 0.0f, 0.8f, "");
    uint32_t brick = add_material(&m, 0.55f, 0.22f, 0.14f, 0.0f, 0.7f, "");
    uint32_t paint = add_material(&m, 0.7f, 0.7f, 0.68f, 0.0f, 0.3f, "");
    uint32_t copper = add_material(&m, 0.95f, 0.64f, 0.54f, 1.0f, 0.3f, "");
    add_panel(&m, (float[]){0, 0, 0}, (float[]){40, 0, 0}, (float[]){0, 0, -40});
    end_mesh(&m, plain);
    for (int i = 0; i < 12; i++) {
        float x = 1.6f * (float)(i % 4) - 2.4f;
        float z = -2.0f * (float)(i / 4);
        float half = 0.4f + 0.35f * (float)(i * 7 % 5);
        add_box(&m, x, half, z, 0.45f, half, 0.45f, 1.0f);
        if (i % 4 == 3)
            end_mesh(&m, i == 7 ? brick : paint);
    }
    for (int i = 0; i < 4; i++)
        add_ball(&m, 1.4f * (float)i - 2.1f, 0.35f, 1.6f, 0.35f);
    end_mesh(&m, copper);
    add_camera(&m, (float[]){2.5f, 2.6f, 7.5f}, (float[]){0.0f, 0.9f, -1.0f});
    write_model(&m, folder, "sky.glb");
}

static void add_chequers(model *m, float side, int count, uint32_t dark, uint32_t bright)
{
    for (int parity = 0; parity < 2; parity++) {
        for (int i = 0; i < count * count; i++) {
            int x = i % count;
            int z = i / count;
            if ((x + z) % 2 != parity)
                continue;
            const float c[3] = {side * ((float)x - 0.5f * (float)(count - 1)), 0.0f,
                                side * ((float)z - 0.5f * (float)(count - 1))};
            add_panel(m, c, (float[]){0.5f * side, 0, 0}, (float[]){0, 0, -0.5f * side});
        }
        end_mesh(m, parity ? dark : bright);
    }
}

static void write_glass(const char *folder)
{
    model m = {0};
    uint32_t dark = add_material(&m, 0.08f, 0.08f, 0.1f, 0.0f, 0.5f, "");
    uint32_t bright = add_material(&m, 0.7f, 0.68f, 0.65f, 0.0f, 0.5f, "");
    uint32_t clear = add_glass(&m, 0.0f, "", "");
    uint32_t rough = add_glass(&m, 0.3f, "", "");
    uint32_t green =
        add_glass(&m, 0.0f, ",\"attenuationDistance\":0.5,\"attenuationColor\":[0.2,0.8,0.35]", "");
    add_chequers(&m, 0.5f, 20, dark, bright);
    add_ball(&m, -0.95f, 0.62f, 0.2f, 0.6f);
    end_mesh(&m, clear);
    add_ball(&m, 0.35f, 0.42f, 0.8f, 0.4f);
    end_mesh(&m, rough);
    add_box(&m, 0.9f, 0.72f, -0.7f, 0.45f, 0.7f, 0.45f, 1.0f);
    end_mesh(&m, green);
    add_camera(&m, (float[]){0.6f, 1.8f, 4.2f}, (float[]){0.0f, 0.55f, 0.0f});
    write_model(&m, folder, "glass.glb");
}

static void write_lights(const char *folder)
{
    enum { COLUMNS = 100, ROWS = 50, COLORS = 8 }; /* two triangles each */
    model m = {0};
    uint32_t plaster = add_material(&m, 0.6f, 0.6f, 0.6f, 0.0f, 0.7f, "");
    uint32_t silver = add_material(&m, 0.9f, 0.9f, 0.88f, 1.0f, 0.3f, "");
    uint32_t clay = add_material(&m, 0.5f, 0.35f, 0.25f, 0.0f, 0.5f, "");
    add_panel(&m, (float[]){0, 0, 0}, (float[]){12, 0, 0}, (float[]){0, 0, -8});
    add_panel(&m, (float[]){0, 3, -6}, (float[]){12, 0, 0}, (float[]){0, 3, 0});
    end_mesh(&m, plaster);
    for (uint32_t color = 0; color < COLORS; color++) {
        float hue = 2.0f * PI_F * (float)color / COLORS;
        uint32_t light =
            add_light(&m, 0.55f + 0.45f * sinf(hue), 0.55f + 0.45f * sinf(hue + 2.09f),
                      0.55f + 0.45f * sinf(hue + 4.19f), 60.0f * powf(1.8f, (float)(color * 5 % COLORS)));
        for (uint32_t i = 0; i < COLUMNS * ROWS; i++) {
            uint32_t h = i * 0x9E3779B1u;
            h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
            h ^= h >> 13;
            if (h % COLORS != color)
                continue;
            float x = ((float)(i % COLUMNS) + 0.5f) * (20.0f / COLUMNS) - 10.0f;
            float z = ((float)(i / COLUMNS) + 0.5f) * (10.0f / ROWS) - 6.0f;
            const float c[3] = {x, 3.6f + 1.4f * (float)(h >> 8 & 0xffff) / 65535.0f, z};
            float angle = 0.001f * (float)(h >> 12 & 0xfff);
            add_panel(&m, c, (float[]){0.012f * cosf(angle), 0.012f * sinf(angle), 0},
                      (float[]){0, 0, 0.012f});
        }
        end_mesh(&m, light);
    }
    for (int i = 0; i < 5; i++)
        add_ball(&m, 1.8f * (float)i - 3.6f, 0.5f, (float)(i % 2) - 1.0f, 0.5f);
    end_mesh(&m, silver);
    for (int i = 0; i < 4; i++)
        add_box(&m, 1.8f * (float)i - 2.7f, 0.4f, -2.5f + 0.8f * (float)(i % 2), 0.4f, 0.4f, 0.4f, 1.0f);
    end_mesh(&m, clay);
    add_camera(&m, (float[]){0.0f, 3.5f, 6.5f}, (float[]){0.0f, 0.0f, -1.0f});
    write_model(&m, folder, "lights.glb");
}

static void write_volume(const char *folder)
{
    model m = {0};
    uint32_t floor = add_material(&m, 0.4f, 0.4f, 0.42f, 0.0f, 0.6f, "");
    uint32_t milk = add_glass(
        &m, 0.0f, ",\"attenuationDistance\":0.25,\"attenuationColor\":[0.7,0.5,0.4]",
        ",\"KHR_materials_volume_scatter\":{\"multiscatterColor\":[0.9,0.75,0.6],\"scatterAnisotropy\":0}");
    uint32_t jade = add_glass(
        &m, 0.35f, ",\"attenuationDistance\":0.12,\"attenuationColor\":[0.3,0.6,0.4]",
        ",\"KHR_materials_volume_scatter\":{\"multiscatterColor\":[0.3,0.7,0.5],\"scatterAnisotropy\":0.5}");
    uint32_t light = add_light(&m, 1.0f, 0.95f, 0.9f, 12.0f);
    add_panel(&m, (float[]){0, 0, 0}, (float[]){8, 0, 0}, (float[]){0, 0, -8});
    end_mesh(&m, floor);
    add_ball(&m, -0.7f, 0.62f, 0.0f, 0.6f);
    end_mesh(&m, milk);
    add_box(&m, 0.75f, 0.52f, -0.1f, 0.4f, 0.5f, 0.4f, 1.0f);
    end_mesh(&m, jade);
    add_panel(&m, (float[]){0.0f, 3.0f, 0.5f}, (float[]){1.0f, 0, 0}, (float[]){0, 0, 1.0f});
    end_mesh(&m, light);
    add_camera(&m, (float[]){0.4f, 1.5f, 4.0f}, (float[]){0.0f, 0.5f, 0.0f});
    write_model(&m, folder, "volume.glb");
}

/* ---- light ---- */

/* Radiance at (u, v): u around from the left edge of -Z, v from the zenith down, both in [0, 1]. */
typedef void light_at(float u, float v, float out[3]);

static void sky_at(float u, float v, float out[3])
{
    (void)u;
    float up = 1.0f - 2.0f * v;
    float haze = up > 0.0f ? expf(-6.0f * up) : 0.0f;
    out[0] = up > 0.0f ? 0.22f + 0.55f * haze : 0.1f;
    out[1] = up > 0.0f ? 0.42f + 0.45f * haze : 0.1f;
    out[2] = up > 0.0f ? 0.95f + 0.05f * haze : 0.1f;
}

static void studio_at(float u, float v, float out[3])
{
    float left = fabsf(u - 0.3f) < 0.06f && fabsf(v - 0.3f) < 0.12f ? 9.0f : 0.0f;
    float right = fabsf(u - 0.8f) < 0.09f && fabsf(v - 0.22f) < 0.09f ? 5.0f : 0.0f;
    float room = 0.15f + 0.25f * (1.0f - v);
    out[0] = room + left + 0.9f * right;
    out[1] = room + 0.93f * left + 0.95f * right;
    out[2] = room + 0.85f * left + right;
}

static void write_light(const char *folder, const char *name, uint32_t rows, light_at *at)
{
    facet_error error;
    image panorama;
    if (image_create(NULL, 2 * rows, rows, 3, IMAGE_F32, &panorama, &error) != FACET_OK)
        stop(&error);
    float *pixels = panorama.pixels;
    for (uint32_t i = 0; i < 2 * rows * rows; i++)
        at(((float)(i % (2 * rows)) + 0.5f) / (float)(2 * rows),
           ((float)(i / (2 * rows)) + 0.5f) / (float)rows, pixels + 3 * i);
    unsigned char *bytes = NULL;
    size_t size = 0;
    char *path = path_join(NULL, folder, name);
    if (!path ||
        image_encode(&panorama, IMAGE_CODEC_HDR, &(image_encode_desc){0}, &bytes, &size, &error) !=
            FACET_OK ||
        file_write(path, bytes, size, &error) != FACET_OK)
        stop(&error);
    printf("%s: %.1f MB\n", path, (double)size * 1e-6);
    mem_free(bytes);
    mem_free(path);
    image_destroy(&panorama);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: make_scenes FOLDER\n");
        return 2;
    }
    write_interior(argv[1]);
    write_sky(argv[1]);
    write_glass(argv[1]);
    write_lights(argv[1]);
    write_volume(argv[1]);
    write_light(argv[1], "sky.hdr", 128, sky_at);
    write_light(argv[1], "studio.hdr", 256, studio_at);
    return 0;
}
