/* layers.c - nanoseconds per shade of each material layer: a sphere in the studio, one thread, 512 x 512
 * pixels, one sample. The cost of the plain sphere's image without shading is in the first line, and
 * subtracted from the others.
 *
 *     layers [RUNS]     default: 9; prints minima */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "cpu/preview.h"
#include "scene/scene.h"

enum { COLUMNS = 128, ROWS = 64, VERTICES = (COLUMNS + 1) * (ROWS + 1), SIZE = 512 };

/* ---- the sphere ---- */

typedef struct ball {
    float positions[3 * VERTICES], tangents[4 * VERTICES], texcoords[2 * VERTICES];
    uint32_t indices[6 * COLUMNS * ROWS];
    const float *sets[1];
    scene_primitive primitive;
    scene_mesh mesh;
} ball;

static void make_ball(ball *b)
{
    uint32_t count = 0;
    for (uint32_t row = 0; row <= ROWS; row++)
        for (uint32_t column = 0; column <= COLUMNS; column++) {
            double theta = 3.14159265358979 * row / ROWS;
            double phi = 2.0 * 3.14159265358979 * column / COLUMNS;
            uint32_t i = row * (COLUMNS + 1) + column;
            float p[3] = {(float)(sin(theta) * sin(phi)), (float)cos(theta), (float)(sin(theta) * cos(phi))};
            float t[4] = {(float)cos(phi), 0.0f, (float)-sin(phi), 1.0f};
            memcpy(b->positions + 3 * i, p, sizeof p);
            memcpy(b->tangents + 4 * i, t, sizeof t);
            b->texcoords[2 * i] = (float)column / COLUMNS;
            b->texcoords[2 * i + 1] = (float)row / ROWS;
            if (row == ROWS || column == COLUMNS)
                continue;
            uint32_t corners[6] = {i, i + COLUMNS + 1, i + 1, i + 1, i + COLUMNS + 1, i + COLUMNS + 2};
            memcpy(b->indices + count, corners, sizeof corners);
            count += 6;
        }
    b->sets[0] = b->texcoords;
    b->primitive = (scene_primitive){.mode = SCENE_TRIANGLES,
                                     .vertex_count = VERTICES,
                                     .index_count = count,
                                     .indices = b->indices,
                                     .positions = b->positions,
                                     .normals = b->positions,
                                     .tangents = b->tangents,
                                     .texcoord_count = 1,
                                     .texcoords = b->sets,
                                     .material = 0,
                                     .bounds_min = {-1, -1, -1},
                                     .bounds_max = {1, 1, 1}};
    b->mesh = (scene_mesh){.name = "", .primitive_count = 1, .primitives = &b->primitive};
}

/* ---- materials ---- */

static scene_material plain(void)
{
    scene_material m = scene_material_default();
    m.metallic = 0.0f;
    m.perceptual_roughness = 0.4f;
    return m;
}

static scene_material with(uint32_t extensions, float roughness)
{
    scene_material m = plain();
    m.extensions = extensions;
    m.perceptual_roughness = roughness;
    m.clearcoat = extensions & SCENE_CLEARCOAT ? 1.0f : 0.0f;
    m.sheen_color[0] = m.sheen_color[1] = m.sheen_color[2] = extensions & SCENE_SHEEN ? 0.8f : 0.0f;
    m.sheen_roughness = 0.5f;
    m.iridescence = extensions & SCENE_IRIDESCENCE ? 1.0f : 0.0f;
    m.anisotropy = extensions & SCENE_ANISOTROPY ? 0.7f : 0.0f;
    m.transmission = extensions & SCENE_TRANSMISSION ? 1.0f : 0.0f;
    m.diffuse_transmission = extensions & SCENE_DIFFUSE_TRANSMISSION ? 0.5f : 0.0f;
    m.thickness = extensions & SCENE_VOLUME ? 1.0f : 0.0f;
    m.attenuation_distance = 1.0f;
    m.attenuation_color[0] = 0.5f;
    m.dispersion = extensions & SCENE_DISPERSION ? 1.0f : 0.0f;
    return m;
}

/* ---- measuring ---- */

static void die(const facet_error *error)
{
    fprintf(stderr, "layers: %s\n", error->message);
    exit(1);
}

/* Minimum seconds of rendering over runs. */
static double draw(facet_scene *scene, const facet_render_desc *desc, int runs, facet_render_stats *stats)
{
    double least = HUGE_VAL;
    facet_error error;
    for (int i = 0; i < runs; i++) {
        film drawn;
        if (film_create(&desc->allocator, SIZE, SIZE, 0, &drawn, &error) != FACET_OK ||
            preview_render(scene, desc, &drawn, stats, &error) != FACET_OK)
            die(&error);
        least = fmin(least, stats->shade_s);
        film_destroy(&drawn);
    }
    return least;
}

int main(int argc, char **argv)
{
    int runs = argc > 1 ? atoi(argv[1]) : 9;
    static ball b;
    make_ball(&b);
    facet_error error;
    facet_scene *scene;
    facet_environment *studio = NULL;
    if (scene_create(NULL, "ball", &scene, &error) != FACET_OK ||
        facet_environment_create_studio(NULL, &studio, &error) != FACET_OK)
        die(&error);
    scene_node node = {.name = "",
                       .parent = SCENE_NONE,
                       .rotation = {0, 0, 0, 1},
                       .scale = {1, 1, 1},
                       .camera = SCENE_NONE,
                       .light = SCENE_NONE,
                       .skin = SCENE_NONE};
    scene_material material;
    scene->meshes = &b.mesh;
    scene->nodes = &node;
    scene->materials = &material;
    scene->mesh_count = scene->node_count = scene->material_count = 1;
    facet_camera camera = {.eye = {0, 0, 10}, .ortho_height = 2.1f};
    facet_render_desc desc = {.thread_count = 1,
                              .width = SIZE,
                              .height = SIZE,
                              .crop = {0, 0, SIZE, SIZE},
                              .samples = 1,
                              .camera = &camera,
                              .environment = studio};
    facet_render_stats stats;

    material = plain();
    material.extensions = SCENE_UNLIT;
    double least = draw(scene, &desc, runs, &stats);
    double shades = (double)stats.shades;
    printf("%-44s %7.0f ns per shade\n", "unlit: rays, hits, composition", 1e9 * least / shades);

    static const struct {
        const char *name;
        uint32_t extensions;
        float roughness;
    } rows[] = {{"plain", 0, 0.4f},
                {"clearcoat", SCENE_CLEARCOAT, 0.4f},
                {"sheen", SCENE_SHEEN, 0.4f},
                {"iridescence", SCENE_IRIDESCENCE, 0.4f},
                {"anisotropy", SCENE_ANISOTROPY, 0.4f},
                {"diffuse transmission", SCENE_DIFFUSE_TRANSMISSION, 0.4f},
                {"diffuse transmission, volume", SCENE_DIFFUSE_TRANSMISSION | SCENE_VOLUME, 0.4f},
                {"transmission, thin, smooth", SCENE_TRANSMISSION, 0.0f},
                {"transmission, thin, rough", SCENE_TRANSMISSION, 0.4f},
                {"transmission, volume, smooth", SCENE_TRANSMISSION | SCENE_VOLUME, 0.0f},
                {"transmission, volume, rough", SCENE_TRANSMISSION | SCENE_VOLUME, 0.4f},
                {"dispersion, smooth", SCENE_TRANSMISSION | SCENE_VOLUME | SCENE_DISPERSION, 0.0f},
                {"dispersion, rough", SCENE_TRANSMISSION | SCENE_VOLUME | SCENE_DISPERSION, 0.4f}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        material = with(rows[i].extensions, rows[i].roughness);
        double seconds = draw(scene, &desc, runs, &stats);
        printf("%-44s %7.0f ns per shade, %5.1f rays\n", rows[i].name, 1e9 * (seconds - least) / shades,
               ((double)stats.rays - (double)SIZE * SIZE) / shades);
    }
    material = plain();
    desc.has_specular_antialiasing = true;
    printf("%-44s %7.0f ns per shade\n", "plain, specular anti-aliasing",
           1e9 * (draw(scene, &desc, runs, &stats) - least) / shades);

    scene->mesh_count = scene->node_count = scene->material_count = 0;
    facet_environment_destroy(studio);
    scene_destroy(scene);
    return 0;
}
