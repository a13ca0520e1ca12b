/* gl_fixture_test.h - scenes built by hand (cpu/preview_fixture.h), drawn by OpenGL and by the preview. */
#ifndef GL_GL_FIXTURE_TEST_H
#define GL_GL_FIXTURE_TEST_H

#include "cpu/preview_fixture.h"
#include "gl/scene/gl_renderer.h"

/* Times the tolerance of a desktop driver. Headless browsers draw with SwiftShader, whose pow() and bilinear
 * weights have 11 and 8 bits, which is all that OpenGL ES asks for. */
#ifdef __EMSCRIPTEN__
enum { GL_FIXTURE_SLACK = 8 };
#else
enum { GL_FIXTURE_SLACK = 1 };
#endif

/* The available contexts; 0: none, which is printed, and the test should exit with 77. */
enum { GL_FIXTURE_APIS = 2 };
typedef struct gl_fixture_contexts {
    int count;
    gl_context items[GL_FIXTURE_APIS]; /* OpenGL, OpenGL ES */
} gl_fixture_contexts;
int gl_fixture_open(gl_fixture_contexts *contexts);
void gl_fixture_close(gl_fixture_contexts *contexts);

/* A renderer of the fixture's scene. Failures abort the test. */
gl_renderer *gl_fixture_renderer(const fixture *f, gl_context *context);
film gl_fixture_draw(const fixture *f, gl_renderer *renderer);
/* Draws and discards an image without layers, and returns the result of drawing. */
facet_result gl_fixture_try_draw(const fixture *f, gl_renderer *renderer, facet_error *error);
/* The image with a renderer of its own. */
film gl_fixture_render(const fixture *f, gl_context *context);

/* Difference of two images of the same size: mean absolute difference, and share of the pixels in which a
 * channel differs by more than `most`, among the pixels that are not empty in both. */
typedef struct image_difference {
    double mean, share;
} image_difference;
image_difference gl_fixture_compare(const film *a, const film *b, float most);
/* Fails where a channel of the pixel is farther from rgba than tolerance. */
void gl_fixture_assert_pixel(const film *image, uint32_t x, uint32_t y, const float rgba[4], float tolerance);

/* Fails where two images differ in any bit. */
void gl_fixture_assert_same(const film *a, const film *b);

/* A rough sphere in front of a tilted textured quad, and half a blended quad on the right; 96 x 64. */
fixture gl_fixture_scene(void);

/* Rotates a node without rotation or parent by a unit quaternion. */
void gl_fixture_turn(scene_node *node, float x, float y, float z, float w);
/* Unlit, of one color; alpha below 1 is blended. */
scene_material gl_fixture_unlit(float r, float g, float b, float alpha);

#endif
