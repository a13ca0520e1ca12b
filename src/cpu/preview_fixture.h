/* preview_fixture.h - scenes built by hand, for the tests of the preview renderer. */
#ifndef CPU_PREVIEW_FIXTURE_H
#define CPU_PREVIEW_FIXTURE_H

#include "film/film.h"
#include "scene/scene.h"

enum { FIXTURE_CAPACITY = 64 };

/* A scene with room for FIXTURE_CAPACITY of everything. Functions abort the test where they fail. */
typedef struct fixture {
    facet_scene *scene;
    facet_environment *environment; /* of radiance 1 unless replaced */
    facet_camera camera;
    facet_render_desc desc; /* 64 x 64, 4 samples; may be changed before fixture_render() */
} fixture;

/* camera: at (0, 0, 10), looks at the origin, orthographic, 2 m high. */
fixture fixture_create(void);
void fixture_destroy(fixture *f);
void fixture_remove_environment(fixture *f);
/* Index of the new material, image and texture (RGBA, 8 bits), mesh. */
uint32_t fixture_add_material(fixture *f, scene_material material);
uint32_t fixture_add_texture(fixture *f, uint32_t width, uint32_t height, const unsigned char *rgba);
/* From (-1, -1, 0) to (1, 1, 0), facing +Z; texture coordinates (0, 0) at the top left. */
uint32_t fixture_add_quad(fixture *f, uint32_t material);
/* Radius 1 around the origin, smooth, columns * columns / 2 * 2 triangles. */
uint32_t fixture_add_sphere(fixture *f, uint32_t columns, uint32_t material);
/* Points or lines through count positions, without normals. */
uint32_t fixture_add_sprites(fixture *f, scene_mode mode, const float *positions, uint32_t count,
                             uint32_t material);
scene_primitive *fixture_primitive(fixture *f, uint32_t mesh);
/* Adds a node with the mesh to the scene. */
scene_node *fixture_place(fixture *f, uint32_t mesh, float x, float y, float z, float scale);
void fixture_add_light(fixture *f, scene_light light, float x, float y, float z);

/* f->desc with camera, environment and crop filled in. */
facet_render_desc fixture_desc(const fixture *f);
/* Renders; the film is released with film_destroy(). */
film fixture_render(fixture *f);
/* The same; returns the result. */
facet_result fixture_try_render(fixture *f, film *out, facet_render_stats *stats, facet_error *error);
const float *fixture_pixel(const film *rendered, const char *layer, uint32_t x, uint32_t y);
/* Aborts the test unless all layers are the same, bit for bit. */
void fixture_assert_same(const film *a, const film *b);
/* The same unless part is what crop (x, y, width, height) cuts out of the image. */
void fixture_assert_crop(const film *whole, const film *part, const uint32_t crop[4]);

#endif
