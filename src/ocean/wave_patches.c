/* wave_patches.c - see wave_patches.h. */
#include "ocean/wave_patches.h"

#include "shade/shade.h"

uint32_t wave_patches_at(const waves *w, uint32_t tile, double x, double z, wave_patch out[WAVES_MAX_PATCHES])
{
    const wave_tile *t = &w->tiles[tile];
    if (!t->is_patched) {
        out[0] = (wave_patch){1.0f, 0, 0};
        return 1;
    }
    wave_rhombus at = wave_rhombus_at(t, x, z);
    vec3 weights = wave_patch_weights(vec2(at.a, at.b));
    int64_t upper = at.a + at.b > 1.0f; /* of the two triangles of a rhombus */
    int64_t corners[WAVES_MAX_PATCHES][2] = {
        {at.i + upper, at.j + upper}, {at.i, at.j + 1}, {at.i + 1, at.j}};
    uint32_t count = 0;
    for (int c = 0; c < WAVES_MAX_PATCHES; c++) {
        if (weights[c] <= 0.0f)
            continue;
        uint64_t hash = wave_patch_hash(w->seed + tile, corners[c][0], corners[c][1]);
        out[count++] = (wave_patch){weights[c], (uint32_t)hash & (t->size - 1u),
                                    (uint32_t)(hash >> 32) & (t->size - 1u)};
    }
    return count;
}
