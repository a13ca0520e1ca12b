/* bake_range.c - see bake_range.h. */
#include "cli/bake/bake_range.h"

#include <math.h>

float bake_file_limit(const bake_file *file)
{
    static const float largest[] = {[FACET_TEXEL_FORMAT_RGBA16F] = 65504.0f,
                                    [FACET_TEXEL_FORMAT_RGB9E5] = 65408.0f,
                                    [FACET_TEXEL_FORMAT_B10G11R11] = 64512.0f,
                                    [FACET_TEXEL_FORMAT_RGBA32F] = 0.0f};
    if (file->container == CONTAINER_KTX2)
        return file->texels < sizeof largest / sizeof *largest ? largest[file->texels]
                                                               : 0.0f; /* r, rg: tables */
    return file->container == CONTAINER_KTX1 ? 64512.0f : file->container == CONTAINER_EXR ? 65504.0f : 0.0f;
}

double bake_cut_share(const facet_cube *cube, uint32_t level, float limit)
{
    double whole = 0.0, cut = 0.0;
    const uint32_t size = facet_cube_get_size(cube, level);
    for (uint32_t face = 0; face < 6; face++) {
        const facet_image_view view = facet_cube_get_face(cube, level, face);
        for (uint32_t i = 0; i < size * size; i++) {
            const float *texel =
                (const float *)((const char *)view.pixels + i / size * view.row_stride_bytes) +
                (size_t)(i % size) * view.channel_count;
            const double s = (2.0 * (i % size) + 1.0) / size - 1.0, t = (2.0 * (i / size) + 1.0) / size - 1.0;
            const double weight = pow(1.0 + s * s + t * t, -1.5);
            for (int k = 0; k < 3; k++) {
                whole += weight * (double)texel[k];
                cut += texel[k] > limit ? weight * (double)(texel[k] - limit) : 0.0;
            }
        }
    }
    return whole > 0.0 ? cut / whole : 0.0;
}
