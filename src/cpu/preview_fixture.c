/* preview_fixture.c - see preview_fixture.h. */
#include "cpu/preview_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "cpu/preview.h"
#include "image/image.h"

static const double PI_DOUBLE = 3.14159265358979323846;

static void *take(fixture *f, size_t count, size_t size)
{
    void *memory = arena_zalloc(f->scene->arena, count, size);
    assert_non_null(memory);
    return memory;
}

fixture fixture_create(void)
{
    fixture f = {0};
    assert_int_equal(scene_create(NULL, "fixture", &f.scene, NULL), FACET_OK);
    facet_scene *s = f.scene;
    s->meshes = take(&f, FIXTURE_CAPACITY, sizeof *s->meshes);
    s->materials = take(&f, FIXTURE_CAPACITY, sizeof *s->materials);
    s->textures = take(&f, FIXTURE_CAPACITY, sizeof *s->textures);
    s->images = take(&f, FIXTURE_CAPACITY, sizeof *s->images);
    s->nodes = take(&f, FIXTURE_CAPACITY, sizeof *s->nodes);
    s->lights = take(&f, FIXTURE_CAPACITY, sizeof *s->lights);
    s->max_texture_size = 16384;
    float radiance[3] = {1.0f, 1.0f, 1.0f};
    assert_int_equal(facet_environment_create_constant(radiance, NULL, &f.environment, NULL), FACET_OK);
    f.camera = (facet_camera){.eye = {0.0f, 0.0f, 10.0f}, .ortho_height = 2.0f};
    f.desc = (facet_render_desc){.width = 64, .height = 64, .samples = 4, .thread_count = 2};
    return f;
}

void fixture_destroy(fixture *f)
{
    facet_environment_destroy(f->environment);
    scene_destroy(f->scene);
}

uint32_t fixture_add_material(fixture *f, scene_material material)
{
    assert_true(f->scene->material_count < FIXTURE_CAPACITY);
    f->scene->materials[f->scene->material_count] = material;
    return f->scene->material_count++;
}

uint32_t fixture_add_texture(fixture *f, uint32_t width, uint32_t height, const unsigned char *rgba)
{
    facet_scene *s = f->scene;
    assert_true(s->texture_count < FIXTURE_CAPACITY);
    image texture;
    assert_int_equal(image_create(NULL, width, height, 4, IMAGE_U8, &texture, NULL), FACET_OK);
    memcpy(texture.pixels, rgba, (size_t)width * height * 4);
    texture.is_srgb = true;
    unsigned char *encoded;
    size_t size;
    assert_int_equal(image_encode(&texture, IMAGE_CODEC_PNG, &(image_encode_desc){0}, &encoded, &size, NULL),
                     FACET_OK);
    unsigned char *bytes = take(f, size, 1);
    memcpy(bytes, encoded, size);
    mem_free(encoded);
    image_destroy(&texture);
    uint32_t index = s->texture_count++;
    s->images[s->image_count++] = (scene_image){
        .name = "", .mime_type = "image/png", .bytes = bytes, .size = size, .width = width, .height = height};
    s->textures[index] = (scene_texture){.name = "", .image = index};
    return index;
}

/* ---- meshes ---- */

static scene_primitive *new_primitive(fixture *f, scene_mode mode, uint32_t vertex_count,
                                      uint32_t index_count, uint32_t material)
{
    facet_scene *s = f->scene;
    assert_true(s->mesh_count < FIXTURE_CAPACITY);
    scene_mesh *mesh = &s->meshes[s->mesh_count++];
    *mesh =
        (scene_mesh){.name = "", .primitive_count = 1, .primitives = take(f, 1, sizeof *mesh->primitives)};
    scene_primitive *p = mesh->primitives;
    *p = (scene_primitive){.mode = mode,
                           .vertex_count = vertex_count,
                           .index_count = index_count,
                           .indices = take(f, index_count, sizeof *p->indices),
                           .positions = take(f, vertex_count, 3 * sizeof(float)),
                           .material = material};
    if (mode == SCENE_TRIANGLES) {
        const float **texcoords = take(f, 1, sizeof *texcoords);
        texcoords[0] = take(f, vertex_count, 2 * sizeof(float));
        p->normals = take(f, vertex_count, 3 * sizeof(float));
        p->texcoord_count = 1;
        p->texcoords = texcoords;
    }
    return p;
}

static void set_vertex(scene_primitive *p, uint32_t i, const float position[3], const float normal[3],
                       float u, float v)
{
    memcpy((float *)p->positions + 3 * i, position, 3 * sizeof(float));
    memcpy((float *)p->normals + 3 * i, normal, 3 * sizeof(float));
    ((float *)p->texcoords[0])[2 * i] = u;
    ((float *)p->texcoords[0])[2 * i + 1] = v;
}

static void set_bounds(scene_primitive *p)
{
    for (int axis = 0; axis < 3; axis++) {
        p->bounds_min[axis] = INFINITY;
        p->bounds_max[axis] = -INFINITY;
        for (uint32_t i = 0; i < p->vertex_count; i++) {
            p->bounds_min[axis] = fminf(p->bounds_min[axis], p->positions[3 * i + (uint32_t)axis]);
            p->bounds_max[axis] = fmaxf(p->bounds_max[axis], p->positions[3 * i + (uint32_t)axis]);
        }
    }
}

uint32_t fixture_add_quad(fixture *f, uint32_t material)
{
    static const uint32_t indices[6] = {0, 1, 2, 2, 1, 3};
    scene_primitive *p = new_primitive(f, SCENE_TRIANGLES, 4, 6, material);
    for (uint32_t i = 0; i < 4; i++) {
        float u = (float)(i & 1);
        float v = (float)(1 - i / 2);
        set_vertex(p, i, (float[3]){2.0f * u - 1.0f, 1.0f - 2.0f * v, 0.0f}, (float[3]){0.0f, 0.0f, 1.0f}, u,
                   v);
    }
    memcpy((uint32_t *)p->indices, indices, sizeof indices);
    set_bounds(p);
    return f->scene->mesh_count - 1;
}

uint32_t fixture_add_sphere(fixture *f, uint32_t columns, uint32_t material)
{
    uint32_t rows = columns / 2;
    scene_primitive *p =
        new_primitive(f, SCENE_TRIANGLES, (columns + 1) * (rows + 1), 6 * columns * rows, material);
    uint32_t *index = (uint32_t *)p->indices;
    for (uint32_t row = 0; row <= rows; row++)
        for (uint32_t column = 0; column <= columns; column++) {
            double theta = PI_DOUBLE * row / rows;
            double phi = 2.0 * PI_DOUBLE * column / columns;
            float n[3] = {(float)(sin(theta) * sin(phi)), (float)cos(theta), (float)(sin(theta) * cos(phi))};
            set_vertex(p, row * (columns + 1) + column, n, n, (float)column / (float)columns,
                       (float)row / (float)rows);
            if (row == rows || column == columns)
                continue;
            uint32_t a = row * (columns + 1) + column;
            uint32_t b = a + columns + 1;
            uint32_t corners[6] = {a, b, a + 1, a + 1, b, b + 1};
            memcpy(index, corners, sizeof corners);
            index += 6;
        }
    set_bounds(p);
    return f->scene->mesh_count - 1;
}

uint32_t fixture_add_sprites(fixture *f, scene_mode mode, const float *positions, uint32_t count,
                             uint32_t material)
{
    scene_primitive *p = new_primitive(f, mode, count, count, material);
    memcpy((float *)p->positions, positions, 3 * count * sizeof(float));
    for (uint32_t i = 0; i < count; i++)
        ((uint32_t *)p->indices)[i] = i;
    set_bounds(p);
    return f->scene->mesh_count - 1;
}

scene_primitive *fixture_primitive(fixture *f, uint32_t mesh)
{
    return f->scene->meshes[mesh].primitives;
}

/* ---- nodes ---- */

scene_node *fixture_place(fixture *f, uint32_t mesh, float x, float y, float z, float scale)
{
    assert_true(f->scene->node_count < FIXTURE_CAPACITY);
    scene_node *node = &f->scene->nodes[f->scene->node_count++];
    const double place[3] = {(double)x, (double)y, (double)z};
    *node = scene_node_default("");
    node->mesh = mesh;
    for (int k = 0; k < 3; k++) {
        node->translation[k] = place[k];
        node->scale[k] = scale;
    }
    return node;
}

void fixture_add_light(fixture *f, scene_light light, float x, float y, float z)
{
    assert_true(f->scene->light_count < FIXTURE_CAPACITY);
    f->scene->lights[f->scene->light_count] = light;
    fixture_place(f, SCENE_NONE, x, y, z, 1.0f)->light = f->scene->light_count++;
}

/* ---- images ---- */

facet_render_desc fixture_desc(const fixture *f)
{
    facet_render_desc desc = f->desc;
    desc.camera = &f->camera;
    desc.environment = f->environment;
    if (!desc.crop[2]) {
        desc.crop[2] = desc.width;
        desc.crop[3] = desc.height;
    }
    return desc;
}

facet_result fixture_try_render(fixture *f, film *out, facet_render_stats *stats, facet_error *error)
{
    facet_render_desc desc = fixture_desc(f);
    facet_result result = film_create(&desc.allocator, desc.crop[2], desc.crop[3], desc.aovs, out, error);
    if (result == FACET_OK)
        result = preview_render(f->scene, &desc, out, stats, error);
    return result;
}

film fixture_render(fixture *f)
{
    film out;
    facet_render_stats stats;
    facet_error error = {0};
    if (fixture_try_render(f, &out, &stats, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return out;
}

const float *fixture_pixel(const film *rendered, const char *layer, uint32_t x, uint32_t y)
{
    const film_layer *l = film_find((film *)(uintptr_t)rendered, layer);
    assert_non_null(l);
    return l->pixels + ((size_t)y * rendered->width + x) * l->channel_count;
}

void fixture_assert_crop(const film *whole, const film *part, const uint32_t crop[4])
{
    assert_int_equal(part->width, crop[2]);
    assert_int_equal(part->height, crop[3]);
    for (uint32_t y = 0; y < crop[3]; y++)
        assert_memory_equal(fixture_pixel(part, "", 0, y), fixture_pixel(whole, "", crop[0], crop[1] + y),
                            crop[2] * 4 * sizeof(float));
}

void fixture_assert_same(const film *a, const film *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->layer_count, b->layer_count);
    for (uint32_t i = 0; i < a->layer_count; i++)
        assert_memory_equal(a->layers[i].pixels, b->layers[i].pixels,
                            (size_t)a->width * a->height * a->layers[i].channel_count * sizeof(float));
}

void fixture_remove_environment(fixture *f)
{
    facet_environment_destroy(f->environment);
    f->environment = NULL;
}
