/* gl_mesh_order.c - in which order the batches of a picture are drawn, and which of them are not in it. */
#include "gl/scene/gl_material.h"
#include "gl/scene/gl_mesh_set.h"

#include <math.h>
#include <stdlib.h>

/* Whether the box is beyond one side of the picture. Sprites reach a pixel farther. */
bool gl_mesh_is_outside(const gl_batch *b, const gl_frame_block *frame)
{
    const float *m = frame->view_projection;
    const float margin = 1.0f + 0.01f; /* of half the picture: a pixel of 200 */
    for (int side = 0; side < 4; side++) {
        int row = side >> 1;
        float sign = side & 1 ? -1.0f : 1.0f, most = margin * m[15] + sign * m[12 + row];
        for (int k = 0; k < 3; k++) {
            float n = margin * m[4 * k + 3] + sign * m[4 * k + row];
            float farthest = n > 0.0f ? b->bounds_max[k] : b->bounds_min[k];
            most += n * (farthest - frame->eye[k]);
        }
        if (most < 0.0f)
            return true;
    }
    return false;
}

static float depth_of(const gl_batch *b, const gl_frame_block *frame)
{
    float depth = 0.0f;
    for (int k = 0; k < 3; k++)
        depth += frame->forward[k] * (0.5f * (b->bounds_min[k] + b->bounds_max[k]) - frame->eye[k]);
    return depth;
}

static int by_geometry(const gl_batch *a, const gl_batch *b)
{
    return (a->geometry > b->geometry) - (a->geometry < b->geometry);
}

/* Changing the program costs more than what a hidden pixel saves. */
static int by_program(const void *x, const void *y)
{
    const gl_batch *a = x, *b = y;
    if (a->features != b->features)
        return a->features < b->features ? -1 : 1;
    if (a->depth < b->depth || a->depth > b->depth)
        return a->depth < b->depth ? -1 : 1;
    return by_geometry(a, b);
}

void gl_mesh_order(gl_mesh_set *set, const gl_frame_block *frame, const gl_material_set *materials)
{
    for (uint32_t i = 0; i < set->count; i++) {
        gl_batch *b = &set->batches[i];
        b->features = gl_material_features(materials, b) | gl_mesh_features(set, b);
        b->depth = depth_of(b, frame);
        b->is_outside = gl_mesh_is_outside(b, frame);
    }
    for (int pass = 0; pass < GL_PASS_BLENDED; pass++) {
        uint32_t count = set->first[pass + 1] - set->first[pass];
        if (count > 1)
            qsort(set->batches + set->first[pass], count, sizeof *set->batches, by_program);
    }
}
