/* meshopt.c - which modes, filters and strides go together, and the way through a stream's decoder and filter. */
#include "io/gltf/meshopt.h"

enum { MIN_STRIDE = 4, MAX_STRIDE = 256 };

static const char *check_filter(meshopt_filter filter, size_t stride)
{
    switch (filter) {
    case MESHOPT_OCTAHEDRAL:
    case MESHOPT_COLOR:
        return stride == 4 || stride == 8 ? NULL : "byteStride must be 4 or 8 with this filter";
    case MESHOPT_QUATERNION:
        return stride == 8 ? NULL : "byteStride must be 8 with this filter";
    default:
        return NULL;
    }
}

const char *meshopt_check(const meshopt_stream *s)
{
    if (s->mode == MESHOPT_ATTRIBUTES) {
        if (s->stride < MIN_STRIDE || s->stride > MAX_STRIDE || s->stride % 4)
            return "byteStride must be one of 4, 8, .. 256 in this mode";
        return check_filter(s->filter, s->stride);
    }
    if (s->stride != 2 && s->stride != 4)
        return "byteStride must be 2 or 4 in this mode";
    if (s->filter != MESHOPT_NONE)
        return "there can be no filter in this mode";
    return s->mode == MESHOPT_TRIANGLES && s->count % 3 ? "count must be a multiple of 3 in this mode" : NULL;
}

const char *meshopt_decode(const meshopt_stream *s, uint8_t *out)
{
    if (s->mode == MESHOPT_TRIANGLES)
        return meshopt_decode_triangles(s, out);
    if (s->mode == MESHOPT_INDICES)
        return meshopt_decode_indices(s, out);
    const char *problem = meshopt_decode_attributes(s, out);
    if (!problem)
        meshopt_apply_filter(s->filter, out, s->count, s->stride);
    return problem;
}
