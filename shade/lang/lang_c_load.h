/* lang_c_load.h - between vec3 and arrays of three floats, for C sources around the shader library. */
#ifndef LANG_C_LOAD_H
#define LANG_C_LOAD_H

#include "shade/shade.h"

static inline vec3 load3(const float *v)
{
    return vec3(v[0], v[1], v[2]);
}

static inline void store3(vec3 v, float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = v[i];
}

#endif
