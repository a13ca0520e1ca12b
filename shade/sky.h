/* sky.h - clear skies: Preetham's model, and scattering in the Earth's atmosphere after Hillaire 2020. Ray
 * loops and LUTs stay outside: functions return LUT coordinates, take LUT values and march one step.
 *
 * Lengths in km, coefficients in 1/km. Elevations are given by mu, the cosine from the zenith. Sunlight is
 * computed at three wavelengths at a time, relative to that outside the atmosphere (radiance: 1/sr);
 * atmosphere_color() converts it to linear Rec.709 in lx or cd/m^2.
 *
 * Order of use: air_column() fills the LUT of optical columns; air_light_*() with table_sun() and a LUT of
 * air_bounce_*() marches along a ray from the eye; air_radiance() adds the terms up. src/ibl/sky_luts.c does
 * all of it in C. */
#ifndef SHADE_SKY_H
#define SHADE_SKY_H

#define EARTH_RADIUS_KM 6360.0f
#define ATMOSPHERE_HEIGHT_KM 100.0f

/* Angular radius of the sun in rad, 0.2666 degrees, and its solid angle in sr. */
#define SUN_RADIUS 0.00465305f
#define SUN_SOLID_ANGLE 6.80182e-5f

/* ---- Preetham ---- */

/* Coefficients of the formula for luminance Y and chromaticity x, y, and their scale. */
STRUCT(PreethamSky)
{
    vec3 A;
    vec3 B;
    vec3 C;
    vec3 D;
    vec3 E;
    vec3 scale; /* value at the zenith over F(0, sun_zenith) */
};

/* Perez et al. 1993: F = (1 + A e^(B / cos theta)) (1 + C e^(D gamma) + E cos^2 gamma), theta from the zenith
 * (its cosine clamped to 0.01), gamma from the sun. */
FN vec3 preetham_F(PreethamSky s, float cos_theta, float cos_gamma)
{
    float gamma = acos(clamp(cos_gamma, -1.0f, 1.0f));
    return (1.0f + s.A * exp(s.B * (1.0f / max(cos_theta, 0.01f)))) *
           (1.0f + s.C * exp(s.D * gamma) + s.E * (cos_gamma * cos_gamma));
}

/* Y in cd/m^2, x, y at the zenith; sun_zenith: zenith angle of the sun in [0, pi/2]. Preetham, Shirley and
 * Smits 1999, appendix A.2. */
FN vec3 preetham_zenith(float turbidity, float sun_zenith)
{
    float T = turbidity;
    float s = sun_zenith;
    float chi = (4.0f / 9.0f - T / 120.0f) * (PI - 2.0f * s);
    float Y = (4.0453f * T - 4.9710f) * tan(chi) - 0.2155f * T + 2.4192f;
    vec3 powers = vec3(T * T, T, 1.0f);
    vec3 x3 = vec3(0.00166f, -0.02903f, 0.11693f);
    vec3 x2 = vec3(-0.00375f, 0.06377f, -0.21196f);
    vec3 x1 = vec3(0.00209f, -0.03202f, 0.06052f);
    vec3 x0 = vec3(0.0f, 0.00394f, 0.25886f);
    vec3 y3 = vec3(0.00275f, -0.04214f, 0.15346f);
    vec3 y2 = vec3(-0.00610f, 0.08970f, -0.26756f);
    vec3 y1 = vec3(0.00317f, -0.04153f, 0.06670f);
    vec3 y0 = vec3(0.0f, 0.00516f, 0.26688f);
    return vec3(1000.0f * Y, dot(powers, ((x3 * s + x2) * s + x1) * s + x0),
                dot(powers, ((y3 * s + y2) * s + y1) * s + y0));
}

/* The sky for a turbidity in [1.7, 10] and a sun above the horizon. Same source. */
FN PreethamSky preetham_sky(float turbidity, float sun_zenith)
{
    PreethamSky s;
    s.A = vec3(0.1787f, -0.0193f, -0.0167f) * turbidity + vec3(-1.4630f, -0.2592f, -0.2608f);
    s.B = vec3(-0.3554f, -0.0665f, -0.0950f) * turbidity + vec3(0.4275f, 0.0008f, 0.0092f);
    s.C = vec3(-0.0227f, -0.0004f, -0.0079f) * turbidity + vec3(5.3251f, 0.2125f, 0.2102f);
    s.D = vec3(0.1206f, -0.0641f, -0.0441f) * turbidity + vec3(-2.5771f, -0.8989f, -1.6537f);
    s.E = vec3(-0.0670f, -0.0033f, -0.0109f) * turbidity + vec3(0.3703f, 0.0452f, 0.0529f);
    s.scale = vec3(1.0f);
    s.scale = preetham_zenith(turbidity, sun_zenith) / preetham_F(s, 1.0f, cos(sun_zenith));
    return s;
}

/* CIE xyY, Y in cd/m^2, as (Y, x, y). */
FN vec3 preetham_Yxy(PreethamSky s, float cos_theta, float cos_gamma)
{
    return s.scale * preetham_F(s, cos_theta, cos_gamma);
}

FN vec3 rec709_from_Yxy(vec3 c)
{
    float k = c[0] / c[2];
    return rec709_from_xyz(vec3(k * c[1], c[0], k * (1.0f - c[1] - c[2])));
}

/* Radiance in cd/m^2, linear Rec.709; negative channels (out of gamut) become 0. */
FN vec3 preetham_radiance(PreethamSky s, float cos_theta, float cos_gamma)
{
    return max(rec709_from_Yxy(preetham_Yxy(s, cos_theta, cos_gamma)), 0.0f);
}

/* ---- the atmosphere ---- */

/* Wavelengths of an Atmosphere. Six in two halves, whose colors are added, are as good as a spectrum of 10
 * nm steps: 0.01 % of luminance, for suns from 1 degree up, haze up to a depth of 0.5, direct and
 * scattered light. Three alone have an error of 0.9 % (rms; 5 % at most, for a sun 1 degree high). Found
 * by least squares over such light (solar spectrum ASTM G-173 from 380 to 720 nm, color matching functions
 * of Wyman, Sloan and Shirley 2013). */
#define SKY_BANDS_THREE 0  /* 624, 541, 448 nm */
#define SKY_BANDS_FIRST 1  /* 656, 574, 465 nm */
#define SKY_BANDS_SECOND 2 /* 612, 521, 427 nm */

STRUCT(Atmosphere)
{
    vec3 wavelength_nm;
    mat3 rec709;   /* columns: illuminance (lx) of extraterrestrial sunlight represented by a wavelength */
    vec3 rayleigh; /* scattering at the ground, 1/km */
    vec3 haze_scattering; /* at the ground, 1/km */
    vec3 haze_extinction;
    float haze_g; /* mean cosine of its phase function */
    vec3 ozone;   /* absorption at 25 km, 1/km */
    vec3 ground_albedo;
};

/* Haze of a vertical optical depth at 550 nm, proportional to wavelength^-angstrom. */
FN Atmosphere atmosphere_with_haze(Atmosphere a, float depth_550nm, float angstrom, float scattering_albedo,
                                   float g)
{
    a.haze_extinction = pow(a.wavelength_nm * (1.0f / 550.0f), vec3(-angstrom)) * (depth_550nm / 1.2f);
    a.haze_scattering = a.haze_extinction * scattering_albedo;
    a.haze_g = g;
    return a;
}

/* Turbidity is the vertical optical depth of molecules and haze over that of molecules alone, which is
 * 0.10846 at 550 nm: 1 for pure air, 1.55 for clear air over the sea, 2.5 for a clear day inland, 6 for a
 * hazy one (McCartney 1976). */
FN float haze_depth_from_turbidity(float turbidity)
{
    return (turbidity - 1.0f) * 0.10846f;
}

/* Color of transmitted or scattered sunlight in the bands of a: Rec.709 in lx (irradiance) or cd/m^2
 * (radiance). */
FN vec3 atmosphere_color(Atmosphere a, vec3 share)
{
    return mul(a.rec709, share);
}

/* The Earth's atmosphere over the sea: haze of depth 0.06, Angstrom exponent 0.6, albedo 0.98, g 0.76, ground
 * of albedo 0.06. Rayleigh scattering 1.24062e-3 / km (1 um / wavelength)^4 (Bruneton 2017), 300 DU of ozone. */
FN Atmosphere atmosphere_earth(int bands)
{
    Atmosphere a;
    if (bands == SKY_BANDS_THREE) {
        a.wavelength_nm = vec3(624.0f, 541.0f, 448.0f);
        a.ozone = vec3(0.00189702f, 0.00168308f, 0.00011657f);
        a.rec709 = mat3(vec3(157887.0f, -2994.8f, -3791.9f), vec3(-13699.1f, 137483.5f, -2670.6f),
                        vec3(-2663.5f, -5270.5f, 133784.8f));
    } else if (bands == SKY_BANDS_FIRST) {
        a.wavelength_nm = vec3(656.0f, 574.0f, 465.0f);
        a.ozone = vec3(0.00107824f, 0.00245183f, 0.00023089f);
        a.rec709 = mat3(vec3(28827.3f, -1181.7f, -434.1f), vec3(60531.8f, 64234.3f, -9434.0f),
                        vec3(-6785.8f, -537.1f, 89483.0f));
    } else {
        a.wavelength_nm = vec3(612.0f, 521.0f, 427.0f);
        a.ozone = vec3(0.00225278f, 0.00118260f, 0.00004069f);
        a.rec709 = mat3(vec3(109760.3f, -9551.9f, -1040.2f), vec3(-55623.6f, 83299.6f, -1377.9f),
                        vec3(8104.2f, -6732.5f, 49868.0f));
    }
    vec3 um = a.wavelength_nm * 0.001f;
    a.rayleigh = 1.24062e-3f / (um * um * um * um);
    a.ground_albedo = vec3(0.06f);
    return atmosphere_with_haze(a, 0.06f, 0.6f, 0.98f, 0.76f);
}

/* Transmittance of sunlight to the ground under Preetham's sky; zenith: zenith angle of the sun in [0, pi/2].
 * Air mass of Kasten 1965, Rayleigh 0.008735 wavelength^-4.08, haze (0.04608 T - 0.04586) wavelength^-1.3
 * (Angstrom), 350 DU of ozone; water vapor and mixed gases absorb hardly any visible light. Preetham, Shirley
 * and Smits 1999, appendix A.1. */
FN vec3 preetham_sun(Atmosphere a, float turbidity, float zenith)
{
    float air_mass = 1.0f / (cos(zenith) + 0.15f * pow(93.885f - zenith * (180.0f * INV_PI), -1.253f));
    vec3 um = a.wavelength_nm * 0.001f;
    vec3 depth = pow(um, vec3(-4.08f)) * 0.008735f +
                 pow(um, vec3(-1.3f)) * (0.04608f * turbidity - 0.04586f) +
                 a.ozone * (15.0f * 350.0f / 300.0f);
    return exp(depth * -air_mass);
}

/* Rayleigh's phase function, 1/sr: 3 (1 + cos^2) / (16 pi). That of haze is phase_HG(). */
FN float phase_rayleigh(float cos_angle)
{
    return 3.0f / (16.0f * PI) * (1.0f + cos_angle * cos_angle);
}

/* Densities of molecules, haze and ozone at a height, relative to their maxima: e^(-h / 8 km), e^(-h / 1.2
 * km), and a tent from 10 over 25 to 40 km. */
FN vec3 air_density(float height_km)
{
    return vec3(exp(height_km * (-1.0f / 8.0f)), exp(height_km * (-1.0f / 1.2f)),
                max(0.0f, 1.0f - abs(height_km - 25.0f) * (1.0f / 15.0f)));
}

/* Extinction in 1/km from densities; optical depth from columns (km). */
FN vec3 air_extinction(Atmosphere a, vec3 density)
{
    return a.rayleigh * density[0] + a.haze_extinction * density[1] + a.ozone * density[2];
}

/* Transmittance of a column. */
FN vec3 air_transmittance(Atmosphere a, vec3 column_km)
{
    return exp(-air_extinction(a, column_km));
}

/* ---- rays through a sphere of air ---- */

/* r^2 - R^2 for a height, without cancellation. */
FN float height_square(float height_km)
{
    return height_km * (2.0f * EARTH_RADIUS_KM + height_km);
}

/* Height at the distance t km along a ray from a height. */
FN float ray_height(float height_km, float mu, float t)
{
    float q = height_square(height_km) + t * (2.0f * (EARTH_RADIUS_KM + height_km) * mu + t);
    return max(q / (sqrt(EARTH_RADIUS_KM * EARTH_RADIUS_KM + q) + EARTH_RADIUS_KM), 0.0f);
}

/* mu of the ray at that point. */
FN float ray_mu(float height_km, float mu, float t, float height_there_km)
{
    return clamp(((EARTH_RADIUS_KM + height_km) * mu + t) / (EARTH_RADIUS_KM + height_there_km), -1.0f, 1.0f);
}

/* mu at that point of another direction, which has mu_sun at the start of the ray and cos_angle to the ray. */
FN float ray_mu_sun(float height_km, float t, float mu_sun, float cos_angle, float height_there_km)
{
    return clamp(((EARTH_RADIUS_KM + height_km) * mu_sun + t * cos_angle) /
                     (EARTH_RADIUS_KM + height_there_km),
                 -1.0f, 1.0f);
}

/* mu of the horizon seen from a height. */
FN float horizon_mu(float height_km)
{
    return -sqrt(height_square(height_km)) / (EARTH_RADIUS_KM + height_km);
}

/* Distance in km to the top of the atmosphere, ignoring the ground. */
FN float ray_to_top(float height_km, float mu)
{
    float b = (EARTH_RADIUS_KM + height_km) * mu;
    float c =
        (ATMOSPHERE_HEIGHT_KM - height_km) * (2.0f * EARTH_RADIUS_KM + ATMOSPHERE_HEIGHT_KM + height_km);
    float root = sqrt(b * b + max(c, 0.0f));
    return sel(b > 0.0f, c / max(b + root, 1e-20f), root - b);
}

/* Distance in km to the ground; -1: no hit. */
FN float ray_to_ground(float height_km, float mu)
{
    float b = (EARTH_RADIUS_KM + height_km) * mu;
    float q = height_square(height_km);
    float d = b * b - q;
    return sel(b <= 0.0f && d >= 0.0f, q / max(sqrt(max(d, 0.0f)) - b, 1e-20f), -1.0f);
}

/* Position of step i of count as a fraction of the ray, denser near its start. */
FN float ray_share(float i, float count)
{
    float s = i / count;
    return s * s;
}

/* Fraction of the sun's disc above the horizon, from a height. */
FN float sun_visibility(float height_km, float mu_sun)
{
    float horizon = horizon_mu(height_km);
    float width = SUN_RADIUS * sqrt(1.0f - horizon * horizon);
    return smoothstep(-width, width, mu_sun - horizon);
}

/* ---- columns: the LUT of transmittance to space ---- */

/* Texture coordinate that maps 0 and 1 to the centers of the first and the last of count texels. */
FN float table_coordinate(float share, float count)
{
    return 0.5f / count + clamp(share, 0.0f, 1.0f) * (1.0f - 1.0f / count);
}
FN float table_share(float coordinate, float count)
{
    return clamp((coordinate - 0.5f / count) / (1.0f - 1.0f / count), 0.0f, 1.0f);
}

#define COLUMN_TABLE_WIDTH 256
#define COLUMN_TABLE_HEIGHT 64

/* LUT coordinates in [0, 1]^2 of the column from a height to the top of the atmosphere; directions below the
 * horizon map to the horizon. Linear in the distances to the top (x) and to the horizon (y): Bruneton and
 * Neyret 2008. */
FN vec2 column_table_place(float height_km, float mu)
{
    float top = sqrt(height_square(ATMOSPHERE_HEIGHT_KM));
    float rho = sqrt(height_square(clamp(height_km, 0.0f, ATMOSPHERE_HEIGHT_KM)));
    float nearest = ATMOSPHERE_HEIGHT_KM - height_km;
    float x = (ray_to_top(height_km, mu) - nearest) / max(rho + top - nearest, 1e-20f);
    return vec2(table_coordinate(x, float(COLUMN_TABLE_WIDTH)),
                table_coordinate(rho / top, float(COLUMN_TABLE_HEIGHT)));
}
/* The inverse: height and mu. */
FN vec2 column_table_ray(vec2 place)
{
    float top = sqrt(height_square(ATMOSPHERE_HEIGHT_KM));
    float rho = top * table_share(place[1], float(COLUMN_TABLE_HEIGHT));
    float height = rho * rho / (sqrt(rho * rho + EARTH_RADIUS_KM * EARTH_RADIUS_KM) + EARTH_RADIUS_KM);
    float nearest = ATMOSPHERE_HEIGHT_KM - height;
    float t = nearest + table_share(place[0], float(COLUMN_TABLE_WIDTH)) * (rho + top - nearest);
    float mu = (top * top - rho * rho - t * t) / max(2.0f * (EARTH_RADIUS_KM + height) * t, 1e-20f);
    return vec2(height, sel(t > 1e-6f, clamp(mu, -1.0f, 1.0f), 1.0f));
}

/* Columns of molecules, haze and ozone along a ray that misses the ground: integrals of air_density(), km, by
 * the midpoint rule with count steps. Independent of the amounts of haze and ozone. */
FN vec3 air_column(float height_km, float mu, int count)
{
    float length_km = ray_to_top(height_km, mu);
    vec3 sum = vec3(0.0f);
    for (int i = 0; i < count; i++) {
        float begin = ray_share(float(i), float(count)) * length_km;
        float end = ray_share(float(i + 1), float(count)) * length_km;
        sum = sum + air_density(ray_height(height_km, mu, 0.5f * (begin + end))) * (end - begin);
    }
    return sum;
}

/* Transmittance of sunlight to a height, from its column in the LUT. */
FN vec3 table_sun(Atmosphere a, vec3 column_km, float height_km, float mu_sun)
{
    return air_transmittance(a, column_km) * sun_visibility(height_km, mu_sun);
}

/* ---- light along a ray ---- */

/* Light scattered towards the eye along a ray: single scattering by molecules and by haze, without their
 * phase functions; multiple scattering; and the transmittance of the ray. */
STRUCT(AirLight)
{
    vec3 rayleigh;
    vec3 haze;
    vec3 multiple;
    vec3 transmittance;
};

FN AirLight air_light_none(void)
{
    AirLight s;
    s.rayleigh = vec3(0.0f);
    s.haze = vec3(0.0f);
    s.multiple = vec3(0.0f);
    s.transmittance = vec3(1.0f);
    return s;
}

/* (1 - e^(-depth)) / extinction over a length, without cancellation for thin air. */
FN float air_path1(float extinction, float length_km)
{
    float x = extinction * length_km;
    return length_km *
           sel(x < 0.01f, 1.0f - x * (0.5f - x * (1.0f / 6.0f)), (1.0f - exp(-x)) / max(x, 0.01f));
}
FN vec3 air_path(vec3 extinction, float length_km)
{
    return vec3(air_path1(extinction[0], length_km), air_path1(extinction[1], length_km),
                air_path1(extinction[2], length_km));
}

/* Incident multiply scattered light at a point: means over directions of its radiance, of its radiance times
 * the Legendre polynomial P2 = (3 mu^2 - 1) / 2 of its direction of origin, and times the upward and the
 * horizontal sunward components of that direction. */
STRUCT(AirField)
{
    vec3 mean;
    vec3 P2;
    vec3 up;
    vec3 sunward;
};

FN AirField air_field(vec3 mean, vec3 P2, vec3 up, vec3 sunward)
{
    AirField f;
    f.mean = mean;
    f.P2 = P2;
    f.up = up;
    f.sunward = sunward;
    return f;
}
FN AirField air_field_even(vec3 mean)
{
    return air_field(mean, vec3(0.0f), vec3(0.0f), vec3(0.0f));
}

FN float legendre_P2(float mu)
{
    return 1.5f * mu * mu - 0.5f;
}

/* Horizontal sunward component of a direction, from its mu, that of the sun, and the cosine between them. */
FN float sunward_part(float mu, float mu_sun, float cos_angle)
{
    float level = sqrt(max(1.0f - mu_sun * mu_sun, 1e-6f));
    return clamp((cos_angle - mu * mu_sun) / level, -1.0f, 1.0f);
}

/* In-scattered radiance, per albedo, by molecules and by haze, for a view direction of mu. A phase
 * function of moments w1, w2 turns the field into mean + 3 w1 (up, sunward) . direction + 5 w2 P2(mu) P2
 * .. (Chandrasekhar 1960, chapter 6). Rayleigh has 0 and 1 / 10: more at the horizon, from where most
 * light comes, and less at the zenith. Haze has g: more on the sun's side, and less from the ground. Half
 * of both is taken, since light loses its direction with each scattering. Hillaire 2020 has the mean only. */
FN vec3 air_field_rayleigh(AirField f, float mu)
{
    return max(f.mean + f.P2 * (0.5f * legendre_P2(mu)), 0.0f);
}
FN vec3 air_field_haze(AirField f, float mu, float sunward, float g)
{
    return max(f.mean + f.P2 * (0.5f * legendre_P2(mu)) + (f.up * mu + f.sunward * sunward) * (1.5f * g),
               0.0f);
}

/* Fraction of haze scattering that counts as unscattered along the view ray: most of it is nearly forward,
 * and the neighboring sky replaces the loss. g^2 would be the fraction of Joseph, Wiscombe and Weinman
 * 1976 (delta-Eddington) for a sky without edges; the horizon is one. The 0.15 is fitted. With it and the
 * moments above all luminances of the reference (all orders by Monte Carlo, src/ibl/sky_test.c) are met to
 * 7 %, with the mean alone to 12 %; for haze of a depth of 0.16 to 20 % by day, and in twilight the glow
 * at the horizon is a third too dark. */
FN float haze_forward_share(Atmosphere a)
{
    return 0.15f * a.haze_g * a.haze_g;
}

/* One step of length_km through air of a density, away from the eye. sun: table_sun() at the step; field:
 * its air_bounce_field(); mu, sunward: components of the ray there. Hillaire 2020, section 4; the integral
 * over the step as in Hillaire 2015. */
FN AirLight air_light_step(Atmosphere a, AirLight s, vec3 density, float length_km, vec3 sun, AirField field,
                           float mu, float sunward)
{
    float forward = haze_forward_share(a);
    vec3 extinction = air_extinction(a, density) - a.haze_scattering * (forward * density[1]);
    vec3 path = s.transmittance * air_path(extinction, length_km);
    vec3 rayleigh = a.rayleigh * density[0];
    vec3 haze = a.haze_scattering * density[1];
    s.rayleigh = s.rayleigh + path * rayleigh * sun;
    s.haze = s.haze + path * haze * sun;
    s.multiple = s.multiple + path * (rayleigh * air_field_rayleigh(field, mu) +
                                      haze * (1.0f - forward) * air_field_haze(field, mu, sunward, a.haze_g));
    s.transmittance = s.transmittance * exp(-extinction * length_km);
    return s;
}

/* Radiance towards the eye, 1/sr; cos_angle: between ray and sun. */
FN vec3 air_radiance(Atmosphere a, AirLight s, float cos_angle)
{
    return s.rayleigh * phase_rayleigh(cos_angle) + s.haze * phase_HG(cos_angle, a.haze_g) + s.multiple;
}

/* ---- multiple scattering ---- */

#define BOUNCE_TABLE_SIZE 32

/* LUT coordinates of multiple scattering for a height and a sun; densest at the ground and at sunset. */
FN vec2 bounce_table_place(float height_km, float mu_sun)
{
    float size = float(BOUNCE_TABLE_SIZE);
    return vec2(table_coordinate(0.5f + 0.5f * sign(mu_sun) * sqrt(abs(mu_sun)), size),
                table_coordinate(sqrt(clamp(height_km / ATMOSPHERE_HEIGHT_KM, 0.0f, 1.0f)), size));
}
/* The inverse: height and mu of the sun. */
FN vec2 bounce_table_ray(vec2 place)
{
    float x = 2.0f * table_share(place[0], float(BOUNCE_TABLE_SIZE)) - 1.0f;
    float y = table_share(place[1], float(BOUNCE_TABLE_SIZE));
    return vec2(y * y * ATMOSPHERE_HEIGHT_KM, x * abs(x));
}

/* Incident singly scattered light (1/sr), and the fraction of isotropic incident light that is scattered
 * again; means over directions. */
STRUCT(AirBounce)
{
    AirField once;
    vec3 again;
};

FN AirBounce air_bounce_none(void)
{
    AirBounce b;
    b.once = air_field_even(vec3(0.0f));
    b.again = vec3(0.0f);
    return b;
}

/* Adds a ray of direction mu that represents a fraction of the sphere. light: along it, marched in a field of
 * mean 1; ground: illuminance of the ground at its end; 0: it ends in space. */
FN AirBounce air_bounce_add(Atmosphere a, AirBounce b, AirLight light, float mu, float sunward,
                            float cos_angle, vec3 ground, float share)
{
    vec3 L = (light.rayleigh * phase_rayleigh(cos_angle) + light.haze * phase_HG(cos_angle, a.haze_g) +
              light.transmittance * a.ground_albedo * ground * INV_PI) *
             share;
    b.once = air_field(b.once.mean + L, b.once.P2 + L * legendre_P2(mu), b.once.up + L * mu,
                       b.once.sunward + L * sunward);
    b.again = b.again + light.multiple * share;
    return b;
}

/* Incident light of all scattering orders: the mean is the series once (1 + again + again^2 ..) of Hillaire
 * 2020, equations 9 and 10; higher orders are isotropic. */
FN AirField air_bounce_field(AirBounce b)
{
    return air_field(b.once.mean / (1.0f - min(b.again, 0.999f)), b.once.P2, b.once.up, b.once.sunward);
}

/* ---- rows of a sky-view LUT ---- */

/* Zenith angle, rad, of a row v in [-1, 1]: -1 nadir, 0 the horizon, 1 zenith; rows are densest at the
 * horizon. The square is that of Hillaire 2020, section 5.3. */
FN float sky_view_zenith_angle(float height_km, float v)
{
    float horizon = acos(horizon_mu(height_km));
    return sel(v >= 0.0f, horizon * (1.0f - v * v), horizon + (PI - horizon) * v * v);
}
FN float sky_view_row(float height_km, float zenith_angle)
{
    float horizon = acos(horizon_mu(height_km));
    float up = sqrt(clamp(1.0f - zenith_angle / horizon, 0.0f, 1.0f));
    float down = -sqrt(clamp((zenith_angle - horizon) / (PI - horizon), 0.0f, 1.0f));
    return sel(zenith_angle <= horizon, up, down);
}

/* ---- maps of half of the sky, for the GPU ---- */

/* Column of a direction in [0, 1], once around from +X towards +Z: the fraction of the perimeter of a
 * square standing on a corner. It needs one division, and its resolution is never below 0.8 of that of
 * equal angles. x = z = 0: any. */
FN float sky_turn(float x, float z)
{
    float along = x / max(abs(x) + abs(z), 1e-30f);
    return sel(z < 0.0f, 0.75f + 0.25f * along, 0.25f - 0.25f * along);
}

/* The horizontal unit direction (x, z) of a column. */
FN vec2 sky_turned(float turn)
{
    float along = sel(turn < 0.5f, 1.0f - 4.0f * turn, 4.0f * turn - 3.0f);
    float aside = sel(turn < 0.5f, 1.0f - abs(along), abs(along) - 1.0f);
    return vec2(along, aside) * inversesqrt(along * along + aside * aside);
}

/* Row in [0, 1] of a direction whose sine of elevation is at the fraction h between that of the horizon,
 * 0, and of the zenith (or nadir), 1: the square of the row is proportional to the angle at both ends, so
 * that rows are densest at the horizon. And its inverse. */
FN float sky_row(float h)
{
    float share = clamp(h, 0.0f, 1.0f);
    return sqrt(share / (1.0f + sqrt(1.0f - share)));
}
FN float sky_rise(float row)
{
    float angle = row * row;
    return angle * (2.0f - angle);
}

#endif
