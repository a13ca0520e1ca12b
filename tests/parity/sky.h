/* sky.h - parity cases: the atmosphere. */

/* ---- sky.h ---- */

FN Atmosphere parity_air(vec2 u)
{
    Atmosphere a = atmosphere_earth(int(u[0] * 2.99f));
    return atmosphere_with_haze(a, haze_depth_from_turbidity(1.0f + 4.0f * u[1]), 0.6f, 0.9f, 0.7f);
}

FN vec3 case_preetham_sun(vec2 u)
{
    Atmosphere a = parity_air(u);
    float turbidity = 2.0f + 6.0f * u[1];
    PreethamSky s = preetham_sky(turbidity, 1.4f * u[0]);
    return preetham_sun(a, turbidity, 1.5f * u[0]) + preetham_radiance(s, 0.3f, 0.5f) * 1e-4f +
           preetham_F(s, 0.5f, u[1]) + rec709_from_Yxy(vec3(1.0f, 0.3f + 0.1f * u[0], 0.33f));
}

FN vec3 case_preetham_Yxy(vec2 u)
{
    float turbidity = 2.0f + 6.0f * u[1];
    PreethamSky s = preetham_sky(turbidity, 1.4f * u[0]);
    return preetham_Yxy(s, 0.05f + 0.9f * u[1], 0.9f - 1.8f * u[0]) * vec3(1e-4f, 1.0f, 1.0f) +
           preetham_zenith(turbidity, 1.4f * u[0]) * vec3(1e-4f, 1.0f, 1.0f);
}

FN vec3 case_air_transmittance(vec2 u)
{
    Atmosphere a = parity_air(u);
    return atmosphere_color(a, air_transmittance(a, vec3(20.0f, 3.0f, 30.0f) * u[0])) * 1e-5f +
           phase_rayleigh(u[1]) + 3.0f;
}

/* A place and directions in the air: height, mu, that of the sun. */
FN vec3 parity_place(vec2 u)
{
    return vec3(0.1f + 60.0f * u[0] * u[0], 2.0f * u[1] - 1.0f, 1.8f * fract(7.0f * u[0]) - 0.9f);
}

FN vec3 case_sky_rays(vec2 u)
{
    vec3 p = parity_place(u);
    float t = 5.0f + 30.0f * u[1];
    float there = ray_height(p[0], p[1], t);
    return vec3(there + ray_mu(p[0], p[1], t, there), ray_mu_sun(p[0], t, p[2], 0.3f, there) + 2.0f,
                horizon_mu(p[0]) + 2.0f) +
           vec3(ray_to_top(p[0], p[1]) * 0.01f + height_square(p[0]) * 1e-5f,
                ray_share(3.0f, 8.0f) + sun_visibility(p[0], horizon_mu(p[0]) + 0.01f * (u[1] - 0.5f)),
                sel(p[1] < horizon_mu(p[0]) - 0.01f, ray_to_ground(p[0], p[1]) * 0.01f, 0.0f));
}

FN vec3 case_sky_table_places(vec2 u)
{
    vec3 p = parity_place(u);
    vec2 column = column_table_place(p[0], p[1]);
    vec2 bounce = bounce_table_place(p[0], p[2]);
    return vec3(column[0], column[1], table_share(table_coordinate(u[0], 32.0f), 32.0f)) + 1.0f +
           vec3(bounce[0], bounce[1], 0.0f);
}

FN vec3 case_sky_table_rays(vec2 u)
{
    vec3 p = parity_place(u);
    vec2 ray = column_table_ray(u);
    vec2 sun = bounce_table_ray(u);
    float angle = sky_view_zenith_angle(p[0], 2.0f * u[1] - 1.0f);
    return air_column(ray[0], 0.05f + 0.95f * u[1], 8) * 0.01f +
           vec3(ray[0] * 0.01f, ray[1] + 2.0f, sun[0] * 0.01f) +
           vec3(sun[1], angle + sky_view_row(p[0], 0.1f + 2.9f * u[0]), 3.0f) +
           vec3(sky_turned(u[0])[0] + sky_turned(u[0])[1], sky_turn(u[0] - 0.5f, 0.01f + u[1]),
                sky_row(u[0]) + sky_rise(u[1]));
}

FN vec3 case_air_light(vec2 u)
{
    Atmosphere a = parity_air(u);
    vec3 p = parity_place(u);
    vec3 density = air_density(p[0] * 0.3f);
    vec3 sun = table_sun(a, vec3(10.0f, 2.0f, 20.0f) * u[1], p[0], p[2]);
    AirField field = air_field(vec3(0.1f, 0.2f, 0.3f), vec3(-0.05f * u[0]), vec3(0.02f), vec3(0.1f * u[1]));
    float sunward = sunward_part(p[1], p[2], 0.9f * u[0]);
    AirLight s = air_light_step(a, air_light_none(), density, 2.0f, sun, field, p[1], sunward);
    s = air_light_step(a, s, density, 20.0f * u[0], sun, field, p[1], 0.5f);
    return air_radiance(a, s, p[1]) + s.transmittance + air_field_rayleigh(field, p[1]) +
           air_field_haze(air_field_even(vec3(0.3f)), p[1], sunward, 0.7f) +
           air_path(air_extinction(a, density), 3.0f * u[1]) * 0.1f + air_path1(0.1f, u[0]) +
           haze_forward_share(a);
}

FN vec3 case_air_bounce(vec2 u)
{
    Atmosphere a = parity_air(u);
    vec3 p = parity_place(u);
    vec3 density = air_density(p[0] * 0.3f);
    vec3 sun = table_sun(a, vec3(10.0f, 2.0f, 20.0f) * u[1], p[0], p[2]);
    AirField field = air_field(vec3(0.1f, 0.2f, 0.3f), vec3(-0.05f * u[0]), vec3(0.02f), vec3(0.1f * u[1]));
    float sunward = sunward_part(p[1], p[2], 0.9f * u[0]);
    AirLight s = air_light_step(a, air_light_none(), density, 2.0f, sun, field, p[1], sunward);
    s = air_light_step(a, s, density, 20.0f * u[0], sun, field, p[1], 0.5f);
    AirBounce b = air_bounce_add(a, air_bounce_none(), s, p[1], sunward, p[2], sun, 0.5f);
    AirField all = air_bounce_field(b);
    return 1.0f + all.mean + all.P2 + all.up + all.sunward + legendre_P2(p[1]);
}
