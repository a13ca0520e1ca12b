/* area_light.h - sphere and tube lights without sampling: exact diffuse irradiance, and highlights by the
 * representative point of Karis 2013 or by a widened lobe.
 *
 * The representative point is an approximation: 5 to 11 % too dark on axis while the light is narrow
 * compared with the lobe, mostly within 30 %, and up to twice too bright where radius / distance exceeds
 * alpha (compared with the exact integral in area_light_test.c). */
#ifndef SHADE_AREA_LIGHT_H
#define SHADE_AREA_LIGHT_H

/* The point of a light that represents all of it in one reflection. */
STRUCT(RepresentativePoint)
{
    vec3 L;              /* unit, towards it */
    float normalisation; /* factor on the specular lobe at L, in (0, 1] */
};

/* Alpha of a lobe convolved with a light: saturate(alpha + radius / (spread distance)), lengths in m.
 * spread 3: Karis 2013 (v2), equation 10; 2: the form of the slides and of older code. */
FN float widened_alpha(float alpha, float radius, float distance_m, float spread)
{
    return clamp(alpha + radius / (spread * distance_m), 0.0f, 1.0f);
}

/* ---- irradiance ---- */

/* Irradiance per radiance (sr, at most pi) of a sphere of radius a whose center is at the distance d and at
 * cos_angle from N, possibly partly below the horizon; sin_sigma = a / d < 1. Above the horizon it is pi
 * sin_sigma^2 cos_angle. Snyder 1996, "Area light sources for real-time graphics". */
FN float sphere_irradiance(float cos_angle, float sin_sigma)
{
    float s2 = sin_sigma * sin_sigma;
    float c = clamp(cos_angle, -1.0f, 1.0f);
    if (c * c > s2)
        return PI * s2 * max(c, 0.0f);
    float sin_angle = sqrt(max(1.0f - c * c, 1e-12f));
    float x = sqrt(max(1.0f / s2 - 1.0f, 0.0f));
    float y = clamp(-x * c / sin_angle, -1.0f, 1.0f);
    float w = sqrt((1.0f - y) * (1.0f + y));
    float q = sin_angle * w;
    return max((c * atan(w, y) - x * q) * s2 + atan(q, x), 0.0f); /* atan(w, y) = acos(y), precise near +-1 */
}

/* Irradiance per intensity (1/m^2) of a thin line between end0 and end1 (from the shaded point, m), all of it
 * above the horizon, whose intensity is uniform along it and in all directions: the mean of N.p / |p|^3 over
 * it,
 *   (N.L0 / |L0| + N.L1 / |L1|) / (|L0| |L1| + L0.L1)
 * Approaches N.L / d^2, a point light, as the line gets shorter. Karis 2013, tube lights. */
FN float line_irradiance(vec3 N, vec3 end0, vec3 end1)
{
    float d0 = length(end0);
    float d1 = length(end1);
    return (dot(N, end0) / d0 + dot(N, end1) / d1) / (d0 * d1 + dot(end0, end1));
}

/* ---- the representative point ---- */

/* Sphere: its point closest to the ray along R = reflect(-V, N). center: from the shaded point, m. The factor
 * (alpha / alpha')^2 compensates the widening of D. Karis 2013, equation 11 and the normalisation after it. */
FN RepresentativePoint representative_point_sphere(vec3 center, vec3 R, float radius, float alpha)
{
    vec3 off_ray = R * dot(center, R) - center;
    float miss = max(length(off_ray), 1e-12f);
    RepresentativePoint p;
    p.L = normalize(center + off_ray * min(radius / miss, 1.0f));
    float ratio = alpha / widened_alpha(alpha, radius, length(center), 3.0f);
    p.normalisation = ratio * ratio;
    return p;
}

/* Tube (capsule) between end0 and end1 (from the shaded point, m): the point of the segment closest to the
 * ray, then the sphere step. A line widens the lobe along one axis only: alpha / alpha'. Karis 2013, tube
 * lights. */
FN RepresentativePoint representative_point_tube(vec3 end0, vec3 end1, vec3 R, float radius, float alpha)
{
    vec3 axis = end1 - end0;
    float R_axis = dot(R, axis);
    float axis2 = dot(axis, axis);
    float t = (dot(R, end0) * R_axis - dot(end0, axis)) / max(axis2 - R_axis * R_axis, 1e-12f);
    vec3 nearest = end0 + axis * clamp(t, 0.0f, 1.0f);
    RepresentativePoint p = representative_point_sphere(nearest, R, radius, alpha);
    p.normalisation *= alpha / widened_alpha(alpha, 0.5f * sqrt(axis2), length(nearest), 3.0f);
    return p;
}

/* ---- lighting ---- */

/* Radiance (cd/m^2 per channel) reflected at P (m) towards V from a sphere light; intensity in cd per channel
 * (radiance pi radius^2), center and radius in m, P outside. The diffuse part is exact. energy and dfg as in
 * surface_lobes_cos(). Approaches a point light for radius -> 0. */
FN vec3 shade_sphere(Surface s, vec3 P, vec3 V, vec3 center, float radius, vec3 intensity, int energy,
                     vec2 dfg)
{
    vec3 to_center = center - P;
    float d2 = max(dot(to_center, to_center), MIN_DISTANCE2);
    float sin_sigma = clamp(radius * inversesqrt(d2), 1e-6f, 0.999999f);
    vec3 L = to_center * inversesqrt(d2);
    s.alpha = max(s.alpha, ALPHA_MIN);

    RepresentativePoint p = representative_point_sphere(to_center, reflect(-V, s.N), radius, s.alpha);
    vec3 specular = surface_lobes_cos(s, V, p.L, energy, dfg).specular * p.normalisation;

    /* The whole sphere lights the base: E sphere_irradiance / (pi sin^2) in place of E N.L. A light whose
     * center is just below the horizon takes the base's weight at the horizon. */
    float NdotL = dot(s.N, L);
    float cos_mean = sphere_irradiance(NdotL, sin_sigma) / (PI * sin_sigma * sin_sigma);
    vec3 L_above = normalize(L + s.N * max(1e-3f - NdotL, 0.0f));
    vec3 diffuse = surface_lobes_cos(s, V, L_above, energy, dfg).diffuse * (cos_mean / dot(s.N, L_above));
    return (specular + diffuse) * (intensity * (1.0f / d2));
}

/* The same with the lobe itself widened to alpha': normalised without a factor, but glossy surfaces look
 * rough, for which Karis abandoned it ("Specular D modification"). Diffuse as a point light. */
FN vec3 shade_sphere_widened(Surface s, vec3 P, vec3 V, vec3 center, float radius, vec3 intensity, int energy,
                             vec2 dfg)
{
    vec3 to_center = center - P;
    float d2 = max(dot(to_center, to_center), MIN_DISTANCE2);
    s.alpha = widened_alpha(max(s.alpha, ALPHA_MIN), radius, sqrt(d2), 2.0f);
    return surface_brdf_cos_energy(s, V, to_center * inversesqrt(d2), energy, dfg) *
           (intensity * (1.0f / d2));
}

#endif
