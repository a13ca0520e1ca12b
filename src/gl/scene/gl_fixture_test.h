/* gl_fixture_test.h - scenes built by hand (cpu/preview_fixture.h), drawn by OpenGL and by the preview. */
#ifndef GL_GL_FIXTURE_TEST_H
#define GL_GL_FIXTURE_TEST_H

#include "cpu/preview_fixture.h"
#include "gl/scene/gl_renderer.h"

/* The kinds of contexts that there are; 0: none, which is told, and the test is to exit with 77. */
enum { GL_FIXTURE_APIS = 2 };
typedef struct gl_fixture_contexts {
    int count;
    gl_context items[GL_FIXTURE_APIS]; /* OpenGL, OpenGL ES */
} gl_fixture_contexts;
int gl_fixture_open(gl_fixture_contexts *contexts);
void gl_fixture_close(gl_fixture_contexts *contexts);

/* A renderer of the fixture's scene. It and what it draws abort the test where they fail. */
gl_renderer *gl_fixture_renderer(const fixture *f, gl_context *context);
film gl_fixture_draw(const fixture *f, gl_renderer *renderer);
/* The same with a renderer of its own. */
film gl_fixture_render(const fixture *f, gl_context *context);

/* How two pictures of the same size differ: mean absolute difference and share of the pixels that differ by more than
 * `most` in some channel; of all pixels in which either shows something. */
typedef struct image_difference {
    double mean, share;
} image_difference;
image_difference gl_fixture_compare(const film *a, const film *b, float most);
/* Fails where a channel of a pixel is farther from rgba than tolerance. */
void gl_fixture_assert_pixel(const film *picture, uint32_t x, uint32_t y, const float rgba[4],
                             float tolerance);

/* Fails where two pictures are not the same to the last bit. */
void gl_fixture_assert_same(const film *a, const film *b);

/* A rough sphere before a tilted quad with a texture, and half a quad that is blended, on the right; 96 x 64. */
fixture gl_fixture_scene(void);

/* A node without rotation or parent is turned by a unit quaternion. */
void gl_fixture_turn(scene_node *node, float x, float y, float z, float w);
/* Unlit, of one color; alpha below 1 is blended. */
scene_material gl_fixture_unlit(float r, float g, float b, float alpha);

#endif
