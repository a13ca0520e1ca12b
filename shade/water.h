/* water.h - the optics of a sea: reflection and refraction at its surface, light from the depth or from a
 * bed, the view from below, and foam. The caller supplies the normal of the resolved waves and the slope
 * covariance of the unresolved ones (water_surface.h); sun glints on the latter are in glint.h.
 *
 * SI units; radiance in cd/m^2, linear Rec.709. V: from the surface to the eye, L: to the sun, both unit;
 * still water lies in the plane y = 0. No color is painted: light is reflected, or enters the water and is
 * absorbed and scattered there.
 *
 * Order of use. Once per image: water_downwelling(). At a point of the surface: sigma_towards() and
 * water_table_place() give the coordinates in the LUT of means, water_specular() the lookup in the sky;
 * water_from_deep(), or water_from_bed() with the irradiance of water_interreflected(), gives the upwelling
 * radiance; water_parts() combines them, water_radiance() adds them up with foam on top. */
#ifndef SHADE_WATER_H
#define SHADE_WATER_H

/* Mean cosine of downwelling light: see water_K_d(). Mobley 1994, section 3.9, for the open ocean. */
#define WATER_MEAN_COSINE 0.86f
/* Lee et al. 2002, equation 4: R_rs = 0.52 r_rs / (1 - 1.7 r_rs), both interfaces of a sea seen from above. */
#define WATER_RRS_SHARE 0.52f
/* From the same equation: internal reflection of upwelling light, 1.7 sr / Q of Gordon et al. 1988. */
#define WATER_RRS_INTERNAL 0.48f
/* Mean cosine of scattering by particles, for phase_HG(). */
#define WATER_PARTICLE_G 0.92f

/* Properties that are constant over the sea. */
STRUCT(Water)
{
    float ior;           /* of water over that of air */
    vec3 absorption;     /* a, 1/m */
    vec3 scattering;     /* b, 1/m */
    vec3 backscattering; /* b_b, 1/m, the backward part of scattering */
    vec3 reflectance;    /* of deep water just above its surface, pi R_rs: upward over downward irradiance */
    vec3 pure_share;     /* fraction of scattering by the water itself, not strongly forward, [0, 1] */
    /* of the surface for sky light: 2 int F mu dmu, with the slopes of the whole sea */
    float sky_reflectance;
    float foam_albedo;
    int normals;    /* WATER_BECKMANN or WATER_GGX */
    int masking;    /* WATER_SCALES, WATER_SMITH or WATER_SCHLICK_KARIS */
    int is_schlick; /* 1: Schlick's Fresnel in place of the exact one */
};

/* A point of the surface, averaged over a footprint. */
STRUCT(WaterPoint)
{
    vec3 N; /* unit normal of the resolved waves, N.y > 0 */
    /* xx, zz, xz of the unresolved slopes, in world axes, with SLOPE_VARIANCE_MIN on xx and zz */
    vec3 covariance;
    float foam; /* fraction covered by foam, [0, 1] */
};

/* Incident light. */
STRUCT(WaterLight)
{
    vec3 L;              /* to the sun */
    vec3 sun_irradiance; /* lx on a plane facing it; 0 below the horizon */
    vec3 sky_irradiance; /* lx on a horizontal plane, without the sun */
    vec3 downwelling;    /* lx on a horizontal plane just below the surface: water_downwelling() */
    /* fraction of sunlight reflected by the whole sea: its mean reflectance from L */
    float sun_fresnel;
};

/* ---- the interface ---- */

/* Reflectance for unpolarised light from the air, c the cosine on that side. */
FN float water_fresnel(Water w, float c)
{
    return sel(w.is_schlick == 1, F_Schlick1(F0_from_ior(w.ior), 1.0f, c), F_dielectric(c, w.ior));
}

/* From below, c on the water's side: 1 beyond the critical angle. Schlick's formula takes the cosine on the
 * air's side. */
FN float water_fresnel_inside(Water w, float c)
{
    float sin2 = (1.0f - c * c) * w.ior * w.ior;
    float schlick = F_Schlick1(F0_from_ior(w.ior), 1.0f, sqrt(max(1.0f - sin2, 0.0f)));
    return sel(w.is_schlick == 1, sel(sin2 >= 1.0f, 1.0f, schlick), F_dielectric(c, 1.0f / w.ior));
}

/* Cosine of the critical angle of total internal reflection from below, > 0. */
FN float water_critical_cosine(Water w)
{
    return sqrt(max(1.0f - 1.0f / (w.ior * w.ior), 1e-6f));
}

/* Refraction of a ray with the unit direction d (down) at a surface of normal N (up). Snell. */
FN vec3 water_refracted(Water w, vec3 d, vec3 N)
{
    return refract(d, N, 1.0f / w.ior);
}

/* Values of the LUT of water_means.h, see integrate_water_means(), and the lookup in the sky. */
STRUCT(WaterSpecular)
{
    float fresnel;              /* mean reflectance of the visible facets */
    float escape;               /* fraction of the reflected light that comes from the sky */
    vec3 R;                     /* unit direction of the sky lookup; after water_specular_masked() R.y >= 0 */
    float perceptual_roughness; /* of its prefiltering */
    float deviation;            /* rad, standard deviation of elevations within it */
};

/* From the fresnel, escape, lift and spread of the LUT at water_table_place(N.V, sigma_towards(..)). */
FN WaterSpecular water_specular(Water w, WaterPoint p, vec3 V, float fresnel, float escape, float lift,
                                float spread)
{
    WaterSpecular r;
    float NdotV = clamp(dot(p.N, V), 1e-4f, 1.0f);
    r.fresnel = min(fresnel * water_fresnel(w, NdotV), 1.0f);
    r.escape = escape;
    r.R = raised_reflection(p.N, V, lift);
    r.perceptual_roughness = roughness_from_spread(spread);
    /* a slope along V turns the reflection by twice its angle, one across by N.V of that */
    r.deviation = sqrt(2.0f * spread / (1.0f + NdotV * NdotV));
    return r;
}

/* Radiance (cd/m^2) of the sun reflected by the facets: F D G E / (4 N.V). */
FN vec3 water_sun(Water w, WaterPoint p, WaterLight light, vec3 V)
{
    float reflected = glitter(w.normals, w.masking, p.covariance, p.N, light.L, V, 1.0f);
    if (reflected <= 0.0f)
        return vec3(0.0f);
    float VdotH = dot(V, normalize(V + light.L));
    return light.sun_irradiance * (water_fresnel(w, clamp(VdotH, 0.0f, 1.0f)) * reflected);
}

/* ---- light in the water ---- */

/* Irradiance (lx) on a horizontal plane just below the surface:
 *   E_d(0-) = (1 - F_sun) E_n L.y + (1 - R_sky) E_sky */
FN vec3 water_downwelling(Water w, WaterLight light)
{
    float sun = (1.0f - light.sun_fresnel) * max(light.L[1], 0.0f);
    return light.sun_irradiance * sun + light.sky_irradiance * (1.0f - w.sky_reflectance);
}

/* Upward over downward irradiance below the surface of deep water, R in [0, 1]. R_rs includes internal
 * reflection:
 *   pi R_rs = 0.52 R / (1 - 0.48 R) */
FN vec3 water_deep_reflectance(Water w)
{
    vec3 x = w.reflectance * (1.0f / WATER_RRS_SHARE);
    return x / (1.0f + WATER_RRS_INTERNAL * x);
}

/* Attenuation in 1/m: of the image of an object, c = a + b; of diffuse light along a ray, a + b_b, as most
 * scattering is nearly forward (Gordon 1973); and of irradiance with depth, K_d = (a + b_b (1 - R)) /
 * 0.86, as upwelling light is scattered down again (Schuster 1905): water without absorption is equally
 * bright at any depth. In seas the last term is below 0.5 %. */
FN vec3 water_beam(Water w)
{
    return w.absorption + w.scattering;
}
FN vec3 water_diffuse(Water w)
{
    return w.absorption + w.backscattering;
}
FN vec3 water_K_d(Water w)
{
    vec3 returned = w.backscattering * water_deep_reflectance(w);
    return (water_diffuse(w) - returned) * (1.0f / WATER_MEAN_COSINE);
}

/* Transmittance over x m, per channel. Beer-Lambert. */
FN vec3 water_transmittance(vec3 attenuation, float x)
{
    return exp(-attenuation * x);
}

/* Phase function in 1/sr: of pure sea water, 1 + 0.835 cos^2 (Morel 1974), and of particles,
 * Henyey-Greenstein. cos_angle between the directions of propagation. */
FN float water_phase_pure(float cos_angle)
{
    return (1.0f + 0.835f * cos_angle * cos_angle) * (0.25f * INV_PI / (1.0f + 0.835f / 3.0f));
}
FN vec3 water_phase(Water w, float cos_angle)
{
    return mix(vec3(phase_HG(cos_angle, WATER_PARTICLE_G)), vec3(water_phase_pure(cos_angle)), w.pure_share);
}

/* ---- between the surface and the light below ---- */

/* Internal reflectance of the surface for diffuse light from below, 0.48 for sea water:
 *   R_int = 1 - (1 - R_sky) / n^2
 * Exact by reciprocity: light of a uniform sky leaves again through 1 / n^2 of the directions. Judd 1942. */
FN float water_internal_reflectance(Water w)
{
    return 1.0f - (1.0f - w.sky_reflectance) / (w.ior * w.ior);
}

/* Transmittance of a layer of the optical thickness t >= 0 for diffuse light, 2 E_3(t). A fit between its
 * bounds e^-t / (t + 3) < E_3(t) < e^-t / (t + 2) (Abramowitz and Stegun 1964, 5.1.19), exact at both ends,
 * within 0.004. */
FN vec3 water_slab(vec3 t)
{
    return 2.0f * exp(-t) / (t + 3.0f - 1.0f / (1.0f + 0.68f * t));
}

/* Upward over downward irradiance below the surface of water over a bed, `depth` m deep. Diffuse light on its
 * way down, up and down again is attenuated like most of the light that the surface reflects: beyond the
 * critical angle, whose cosine is mu_c = sqrt(1 - 1 / n^2),
 *   R + (albedo - R) 2 E_3(2 (a + b_b) H / mu_c)
 * The part that returns to the bed, R_int times that, is within 0.012 of the integral over all directions. */
FN vec3 water_bed_reflectance(Water w, vec3 albedo, float depth)
{
    vec3 R = water_deep_reflectance(w);
    float critical = water_critical_cosine(w);
    return R + (albedo - R) * water_slab(water_diffuse(w) * (2.0f * depth / critical));
}

/* Irradiance (lx) on a horizontal plane just below the surface: `downwelling`, the transmitted light, and all
 * interreflections between the surface and a reflectance R below.
 *   E_d(0-) / (1 - R_int R)
 * A white bed below clear water is as bright as the sky. Lee et al. 1998, equation 2; for wet ground
 * Lekner and Dorf 1988. */
FN vec3 water_interreflected(Water w, vec3 downwelling, vec3 R)
{
    return downwelling / (1.0f - water_internal_reflectance(w) * R);
}

/* Upwelling radiance (cd/m^2) below the surface of deep water, isotropic: R / pi of the irradiance there.
 * Gordon et al. 1988; Lee et al. 2002. */
FN vec3 water_from_deep(Water w, vec3 downwelling)
{
    vec3 R = water_deep_reflectance(w);
    return R * water_interreflected(w, downwelling, R) * INV_PI;
}

/* The bed where the refracted ray meets it. */
STRUCT(WaterBed)
{
    vec3 albedo;       /* there */
    vec3 mean_albedo;  /* around it, over a quarter of the path length */
    float depth;       /* m of water above it, >= 0 */
    float path_length; /* m, of the ray in the water, >= depth */
};

/* Upwelling radiance (cd/m^2) below the surface: the bed, sharp by unscattered and blurred by forward
 * scattered light, and the water in front of it. light: water_interreflected() with
 * water_bed_reflectance(), E.
 *   E_bed = E e^(-K_d H)
 *   E_bed / pi (albedo e^(-c l) + mean (e^(-(a + b_b) l) - e^(-c l))) + R E / pi (1 - e^(-K_d H - (a + b_b) l))
 * Approaches water_from_deep() with increasing depth, and the bed itself with decreasing depth. Lee et al.
 * 1998. */
FN vec3 water_from_bed(Water w, vec3 light, WaterBed bed)
{
    vec3 sharp = water_transmittance(water_beam(w), bed.path_length);
    vec3 blurred = water_transmittance(water_diffuse(w), bed.path_length);
    vec3 down = water_transmittance(water_K_d(w), bed.depth);
    vec3 ground = down * (bed.albedo * sharp + bed.mean_albedo * (blurred - sharp));
    return light * INV_PI * (ground + water_deep_reflectance(w) * (1.0f - down * blurred));
}

/* Radiance (cd/m^2) of singly scattered sunlight below the surface, in water of the depth H: eye and sun
 * at the cosines mu_v, mu_s below the surface, beam: irradiance (lx) across the sun's beam there.
 *   E b p / (c (1 + mu_v / mu_s)) (1 - e^(-c H (1 / mu_s + 1 / mu_v)))
 * Chandrasekhar 1960, section 68. */
FN vec3 water_single_scattering(Water w, vec3 beam, float cos_angle, float mu_s, float mu_v, float depth)
{
    vec3 c = water_beam(w);
    vec3 left = exp(-c * (depth * (1.0f / mu_s + 1.0f / mu_v)));
    return beam * w.scattering * water_phase(w, cos_angle) * (1.0f - left) / (c * (1.0f + mu_v / mu_s));
}

/* ---- the view from below ---- */

/* Reflection and refraction of the surface seen from below: d unit, up to it; N its normal, up. */
STRUCT(WaterWindow)
{
    float fresnel;  /* reflectance, 1 outside of Snell's window */
    vec3 reflected; /* unit direction of the reflected water */
    vec3 outside;   /* unit direction of the refracted sky; 0 if there is none */
    float gain;     /* of transmitted radiance: n^2 (1 - F) */
};
FN WaterWindow water_window(Water w, vec3 d, vec3 N)
{
    WaterWindow r;
    r.fresnel = water_fresnel_inside(w, clamp(dot(d, N), 0.0f, 1.0f));
    r.reflected = reflect(d, N);
    r.outside = refract(d, -N, w.ior);
    r.gain = w.ior * w.ior * (1.0f - r.fresnel);
    return r;
}

/* Radiance (cd/m^2) of the sun refracted by the facets to an eye below, along d (unit, up): n^2 (1 - F) times
 * its disc where the water is flat. */
FN vec3 water_sun_below(Water w, WaterPoint p, WaterLight light, vec3 d)
{
    float through = glitter_below(w.normals, p.covariance, p.N, light.L, d, w.ior);
    if (through <= 0.0f)
        return vec3(0.0f);
    float LdotM = dot(light.L, normalize(d * w.ior - light.L));
    return light.sun_irradiance * ((1.0f - water_fresnel(w, clamp(LdotM, 0.0f, 1.0f))) * through);
}

/* Mean transmittance e^-t over an optical depth t from `first` to `last`, of any sign. */
FN float water_mean_transmittance1(float first, float last)
{
    float t = 0.5f * (last - first);
    float middle = exp(-0.5f * (first + last)) * (1.0f + t * t * (1.0f / 6.0f)); /* where both ends cancel */
    return sel(abs(t) < 0.05f, middle, 0.5f * (exp(-first) - exp(-last)) / sel(t == 0.0f, 1.0f, t));
}
FN vec3 water_mean_transmittance(vec3 first, vec3 last)
{
    return vec3(water_mean_transmittance1(first[0], last[0]), water_mean_transmittance1(first[1], last[1]),
                water_mean_transmittance1(first[2], last[2]));
}

/* In-scattered radiance (cd/m^2) along a ray of x m below the surface, from an eye at the depth z (m) in
 * the unit direction d. The diffuse source is such that deep water seen from above has its radiance: at
 * the depth h L_deep (K_d + a + b_b) e^(-K_d h). Looking up, it increases faster than the ray attenuates
 * it; so both form one exponent, never above 0. */
FN vec3 water_inscatter(Water w, vec3 downwelling, float z, vec3 d, float x)
{
    vec3 K = water_K_d(w);
    vec3 along = water_diffuse(w);
    vec3 last = K * max(z - x * d[1], 0.0f) + along * x;
    return water_from_deep(w, downwelling) * (K + along) * water_mean_transmittance(K * z, last) * x;
}

/* Phase function (1/sr) of light scattered out of the sun's beam over an optical depth t of scattering, by
 * particles except for pure_share. Of that light,
 *   t e^-t / (1 - e^-t)
 * was scattered once, and the rest m times, which leaves the mean of t / (1 - e^-t). The convolution of
 * Henyey-Greenstein functions of g is one of g^m (their Legendre moments are g^l). */
FN float water_inscatter_phase1(float t, float pure_share, float cos_angle)
{
    float x = max(t, 1e-3f);
    float out_of_beam = 1.0f - exp(-x);
    float once = x * exp(-x) / out_of_beam;
    float times = (x / out_of_beam - once) / (1.0f - once);
    float often = phase_HG(cos_angle, exp(log(WATER_PARTICLE_G) * times));
    float particles = mix(often, phase_HG(cos_angle, WATER_PARTICLE_G), once);
    return mix(particles, water_phase_pure(cos_angle), pure_share);
}

/* In-scattered radiance of the sun's beam, by forward scattering, around the sun. Light leaves the
 * beam by c on the way down, turned slightly, and is attenuated by a + b_b from there on like all diffuse
 * light; beam and in-scattering add up to Gordon's quasi-single scattering,
 *   beam e^(-c x) + in-scattering = beam e^(-(a + b_b) x) along the beam
 * Within 4 % of a photon count up to 1.1 scatterings, 11 % up to 2.3; 7 to 35 degrees from the sun 27 % up to
 * 4.6, where single scattering alone has 0.1 to 0.01. Sideways and backward scattering belong to the diffuse
 * light. sunward: unit direction to the sun below the surface; beam: irradiance (lx) across it just below. */
FN vec3 water_sun_inscatter(Water w, vec3 beam, vec3 sunward, float z, vec3 d, float x)
{
    float forward = dot(sunward, d);
    if (forward <= 0.0f) /* as for all reflections by the surface: most rays of an eye below */
        return vec3(0.0f);
    float mu = max(sunward[1], 1e-3f);
    vec3 first = water_beam(w) * (z / mu); /* scattered here, and at the other end */
    vec3 last = water_beam(w) * (max(z - x * d[1], 0.0f) / mu) + water_diffuse(w) * x;
    vec3 t = w.scattering * (z / mu);
    vec3 inscatter = vec3(0.0f);
    for (int k = 0; k < 3; ++k) {
        float more = water_inscatter_phase1(t[k], w.pure_share[k], forward) -
                     water_inscatter_phase1(t[k], w.pure_share[k], 0.0f);
        inscatter[k] = max(more, 0.0f) * water_mean_transmittance1(first[k], last[k]);
    }
    return beam * w.scattering * inscatter * x;
}

/* Fraction of the quasi-single scattering transmittance e^(-(a + b_b) x) in the unscattered beam; the rest is
 * in-scattering around it. */
FN vec3 water_unscattered(Water w, float x)
{
    return exp((w.backscattering - w.scattering) * x);
}

/* Irradiance (lx) across the beam of the sun just below flat water: E (1 - F) L.y / mu', mu' its cosine
 * there. */
FN vec3 water_beam_below(Water w, WaterLight light)
{
    float c = clamp(light.L[1], 0.0f, 1.0f);
    float mu = sqrt(1.0f - (1.0f - c * c) / (w.ior * w.ior));
    return light.sun_irradiance * ((1.0f - light.sun_fresnel) * c / max(mu, 1e-6f)); /* n = 1: 0 / 0 */
}

/* ---- sum ---- */

/* Radiance (cd/m^2) by source; their sum reaches the eye. */
STRUCT(WaterParts)
{
    vec3 reflection;   /* of the sky */
    vec3 sun;          /* in the facets */
    vec3 transmission; /* from below */
    vec3 between;      /* from the sky or from below, over a second facet */
    vec3 foam;
};

/* Foam is Lambertian and opaque: foam_albedo / pi (E_n N.L + E_sky). */
FN vec3 water_foam(Water w, WaterLight light, vec3 N)
{
    float NdotL = max(dot(N, light.L), 0.0f);
    return (light.sun_irradiance * NdotL + light.sky_irradiance) * (w.foam_albedo * INV_PI);
}

/* Foam from below, lit by `upwelling` (lx, just below the surface) and from above: foam absorbs nothing, so
 * that with n^2 below a uniform sky of 1 its radiance is n^2.
 *   (1 - albedo) / pi (E_n L.y + E_sky) + (1 - (1 - albedo) / n^2) / pi E_u */
FN vec3 water_foam_below(Water w, WaterLight light, vec3 upwelling)
{
    float through = 1.0f - w.foam_albedo;
    vec3 from_above = light.sun_irradiance * max(light.L[1], 0.0f) + light.sky_irradiance;
    return (from_above * through + upwelling * (1.0f - through / (w.ior * w.ior))) * INV_PI;
}

/* sky: radiance of the lookup at m.R; sun: water_sun() times its glints; below: upwelling radiance just below
 * the surface. Facets reflected in other facets show the sky again, or light from below:
 *   F e L_sky + (1 - F) L_below / n^2 + F (1 - e) (F L_sky + (1 - F) L_below / n^2) + L_sun
 * In a closed box, L_below = n^2 L_sky, the sum is L_sky. */
FN WaterParts water_parts(Water w, WaterPoint p, WaterLight light, WaterSpecular m, vec3 sky, vec3 sun,
                          vec3 below)
{
    vec3 out_of_water = below * (1.0f / (w.ior * w.ior));
    float open = 1.0f - p.foam;
    WaterParts r;
    r.reflection = sky * (m.fresnel * m.escape * open);
    r.sun = sun * open;
    r.transmission = out_of_water * ((1.0f - m.fresnel) * open);
    r.between = mix(out_of_water, sky, m.fresnel) * (m.fresnel * (1.0f - m.escape) * open);
    r.foam = water_foam(w, light, p.N) * p.foam;
    return r;
}
FN vec3 water_radiance(WaterParts p)
{
    return p.reflection + p.sun + p.transmission + p.between + p.foam;
}

#endif
