/* fuzz_meshopt.c - meshopt bitstreams: the first bytes are the parameters of the buffer view, the others the
 * stream. */
#include "fuzz_support.h"

#include "io/gltf/meshopt.h"

typedef struct header {
    uint8_t mode, filter, stride;
    uint8_t count[2];
} header;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    header h;
    fuzz_take(&data, &size, &h, sizeof h);
    meshopt_stream stream = {.bytes = data,
                             .size = size,
                             .mode = (meshopt_mode)(h.mode % 3),
                             .filter = (meshopt_filter)(h.filter % 5),
                             .count = (size_t)h.count[0] | (size_t)h.count[1] << 8,
                             .stride = h.stride};
    if (meshopt_check(&stream) || meshopt_smallest_size(&stream) > size)
        return 0;
    size_t bytes = stream.count * stream.stride;
    uint8_t *out = aligned_alloc(16, (bytes + 15) / 16 * 16 + 16);
    if (out)
        meshopt_decode(&stream, out);
    free(out);
    return 0;
}
