/* wave_place.c - what a place of the surface looks like, by the shader library. */
#include "ocean/foam_plane.h"

#include "shade/shade.h"

wave_shape wave_shape_of(const wave_point *p)
{
    vec3 D = vec3(p->Dxx, p->Dzz, p->Dxz);
    vec3 N = wave_normal(vec2(p->slope[0], p->slope[1]), D);
    return (wave_shape){{N[0], N[1], N[2]}, wave_jacobian(D), -(p->Dxx + p->Dzz)};
}

float foam_coverage(const foam_rule *r, float mean, float variance, float threshold)
{
    (void)r;
    return threshold < INFINITY ? foam_share(mean, variance, threshold) : 0.0f;
}

float wave_foam_lace(float share, float mean, float variance)
{
    return foam_lace(share, mean, variance);
}

float wave_inverse_normal(float u)
{
    return inverse_normal(u);
}
