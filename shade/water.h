/* water.h - the surface of a sea and the water under it: reflection at waves that are too small to be seen one by one, light that comes
 * up from the depth, what a bed adds, foam. The waves that are seen are the caller's, who brings a normal for them.
 *
 * SI units; radiance in cd/m^2, linear Rec.709. V: from the surface to the eye, L: to the sun, both unit; still water lies in the plane
 * y = 0. */
#ifndef SHADE_WATER_H
#define SHADE_WATER_H

/* How microfacets of the unresolved waves are distributed, and mask each other. */
#define WATER_BECKMANN 0 /* Gaussian slopes; which those of the sea nearly are */
#define WATER_GGX 1
#define WATER_SMITH 0         /* height-correlated, Heitz 2014 */
#define WATER_SCHLICK_KARIS 1 /* separable, k = (r + 1)^2 / 8, for comparison */

/* What does not change from place to place. */
STRUCT(Water)
{
    float ior;           /* of water over that of air */
    vec3 absorption;     /* 1/m */
    vec3 scattering;     /* 1/m */
    vec3 backscattering; /* 1/m, the part of scattering that goes backwards */
    vec3 reflectance;    /* of deep water just above its surface, pi R_rs: upward over downward irradiance */
    float pure_share;    /* of scattering (luminance) that is not strongly forward */
    float foam_albedo;
    int normals;    /* WATER_BECKMANN or WATER_GGX */
    int masking;    /* WATER_SMITH or WATER_SCHLICK_KARIS */
    int is_schlick; /* 1: Schlick's Fresnel in place of the exact one */
};

/* A place of the surface, as wide as a footprint. */
STRUCT(WaterPoint)
{
    vec3 N;          /* unit normal of the waves that are seen, N.y > 0 */
    vec3 covariance; /* xx, zz, xz of the slopes that are not, in world axes */
    float foam;      /* share of it that foam covers, [0, 1] */
};

/* Light that arrives. */
STRUCT(WaterLight)
{
    vec3 L;              /* to the sun */
    vec3 sun_irradiance; /* lx on a plane that faces it */
    vec3 sky_irradiance; /* lx on a horizontal plane, without the sun */
};

#endif
