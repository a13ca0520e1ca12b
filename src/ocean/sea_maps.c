/* sea_maps.c - see sea_maps.h. */
#include "ocean/sea_maps.h"

#include <string.h>

/* That of everything, less this one's share by its spectrum. */
float sea_others_variance(const facet_sea *sea, uint32_t tile)
{
    const waves *w = &sea->waves;
    const wave_tile *t = &w->tiles[tile];
    double own = sea_state_moments(&w->state, t->k_from, t->k_to).convergence * w->choppiness * w->choppiness;
    double all = (double)sea->foam.sigma * (double)sea->foam.sigma;
    return own < all ? (float)(all - own) : 0.0f;
}

sea_texel sea_texel_of(const facet_sea *sea, uint32_t tile, float others_variance, uint32_t column,
                       uint32_t row)
{
    const wave_tile *t = &sea->waves.tiles[tile];
    const float *f = t->levels[0] + ((size_t)row * t->size + column) * WAVE_FIELDS;
    const wave_point p = {.displacement = {f[WAVE_DX], f[WAVE_DZ]},
                          .height_m = f[WAVE_ETA],
                          .slope = {f[WAVE_ETA_X], f[WAVE_ETA_Z]},
                          .Dxx = f[WAVE_DXX],
                          .Dzz = f[WAVE_DZZ],
                          .Dxz = f[WAVE_DXZ]};
    wave_shape shape = wave_shape_of(&p);
    sea_texel out = {.displacement = {f[WAVE_DX], f[WAVE_ETA], f[WAVE_DZ]},
                     .slope = {f[WAVE_ETA_X], f[WAVE_ETA_Z]},
                     .jacobian = shape.jacobian,
                     .foam =
                         foam_coverage(&sea->foam, shape.convergence, others_variance, sea->foam.threshold)};
    memcpy(out.normal, shape.normal, sizeof out.normal);
    return out;
}
