/* footprint.h - the footprint of a pixel in a texture, and the anisotropic lookups that cover it. */
#ifndef SHADE_FOOTPRINT_H
#define SHADE_FOOTPRINT_H

#define FOOTPRINT_MAX_PROBES 16

/* An ellipse. Lengths in texels of mip 0, squared. */
STRUCT(Footprint)
{
    float longest2; /* of the derivatives along x and y: rho of OpenGL */
    float major2;   /* of the axes */
    float minor2;
    float axis_u; /* along the major axis, of any length, in texels */
    float axis_v;
};

/* Trilinear lookups in a row along the major axis, around the center. */
STRUCT(ProbeRow)
{
    int count;
    float width2; /* texels, squared: lod log2(width) */
    float step_u; /* from one to the next */
    float step_v;
};

/* From the derivatives of texture coordinates by pixel, for an image of size texels. The squared axes are the
 * eigenvalues of J J^T of J = (ux uy; vx vy). */
FN Footprint footprint_from_derivatives(vec2 size, vec2 duv_dx, vec2 duv_dy)
{
    float ux = duv_dx[0] * size[0];
    float vx = duv_dx[1] * size[1];
    float uy = duv_dy[0] * size[0];
    float vy = duv_dy[1] * size[1];
    float a = ux * ux + uy * uy;
    float b = ux * vx + uy * vy;
    float c = vx * vx + vy * vy;
    float mean = 0.5f * (a + c);
    float half_difference = 0.5f * (a - c);
    float spread = sqrt(half_difference * half_difference + b * b);
    Footprint f;
    f.major2 = mean + spread;
    f.minor2 = mean - spread;
    f.longest2 = max(ux * ux + vx * vx, uy * uy + vy * vy);
    /* The eigenvector of major2, by the row of the matrix that is farther from 0. */
    f.axis_u = sel(half_difference > 0.0f, half_difference + spread, b);
    f.axis_v = sel(half_difference > 0.0f, b, spread - half_difference);
    return f;
}

/* Whether its area is finite; false for NaN. */
FN bool footprint_is_finite(Footprint f)
{
    return f.major2 + f.minor2 < 2e18f;
}

/* Covers the footprint with probes (after McCormack et al. 1999, "Feline"). finest: texel width of the finest
 * mip that is resident, in texels of mip 0, whose size is 1 / texel_size.
 *
 * There are as many probes as the ratio of the axes requires, up to a limit that widens the minor axis of longer
 * footprints: blurred, but without aliasing. Each is as wide as the minor axis. Up
 * to a ratio of 1.5 one probe as wide as the major axis suffices; from there to 2 two probes move apart
 * while their width shrinks to the minor axis. n probes of width w at a distance s have the second moment
 * (w^2 + (n^2 - 1) s^2) / 12; s makes it major^2 / 12, that of the footprint, so that the result hardly
 * jumps where the count changes. */
FN ProbeRow footprint_probes_up_to(int limit, Footprint f, float finest, vec2 texel_size)
{
    ProbeRow p;
    p.count = 1;
    p.width2 = f.major2;
    p.step_u = 0.0f;
    p.step_v = 0.0f;
    float minor2 = max(f.minor2, finest * finest);
    if (limit < 2 || f.major2 <= 2.25f * minor2)
        return p;
    float most = float(limit * limit);
    if (f.major2 > most * minor2)
        minor2 = f.major2 / most;
    float ratio = sqrt(f.major2 / minor2);
    p.count = 2;
    p.width2 = minor2;
    if (ratio > 2.0f)
        p.count = int(ratio + 0.75f); /* one more than ratio - 1.25, rounded down: they overlap enough */
    else
        p.width2 *= (3.0f - ratio) * (3.0f - ratio);
    if (p.count > limit)
        p.count = limit;
    float axis2 = f.axis_u * f.axis_u + f.axis_v * f.axis_v;
    float scale = sqrt((f.major2 - p.width2) / (axis2 * float(p.count * p.count - 1)));
    p.step_u = f.axis_u * scale * texel_size[0];
    p.step_v = f.axis_v * scale * texel_size[1];
    return p;
}

FN ProbeRow footprint_probes(Footprint f, float finest, vec2 texel_size)
{
    return footprint_probes_up_to(FOOTPRINT_MAX_PROBES, f, finest, texel_size);
}

#endif
