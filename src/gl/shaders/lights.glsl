/* lights.glsl - punctual lights (and the sun) that may reach a point. A loop over them:
 *     int count = light_count(P);
 *     for (int i = 0; i < count; i++)
 *         ... light_at(i) ...
 * P and the lights' positions are relative to the eye (m). With HAS_SHADOWS their intensity is what arrives at P. */
#ifdef HAS_LIGHTS
uniform highp usampler2D u_lights; /* four texels per light, then lists of indices: gl_light.c */

/* Of the point: its cell's list (light_grid.h), and its position. */
int light_near_first = 0;
#ifdef HAS_SHADOWS
vec3 light_P = vec3(0.0);
vec3 light_face = vec3(0.0); /* unit, normal of the face; on either side */
#endif

uvec4 light_texel(int i)
{
    return texelFetch(u_lights, ivec2(i & (LIGHT_ROW - 1), i / LIGHT_ROW), 0);
}

int light_number(int i)
{
    return int(light_texel(light_lists.x + i / 4)[i & 3]);
}

/* First and end of the list of the cell that contains P (m, world). */
ivec2 light_cell(vec3 P)
{
    vec3 x = (P - light_grid_origin.xyz) * light_grid_cells.xyz;
    ivec3 size = light_grid_size.xyz;
    if (!(all(greaterThanEqual(x, vec3(-1.0))) && all(lessThanEqual(x, vec3(size) + 1.0))))
        return ivec2(0);
    ivec3 at = min(ivec3(max(x, 0.0)), size - 1);
    int cell = (at.z * size.y + at.y) * size.x + at.x;
    uvec4 two = light_texel(light_lists.y + cell / 2);
    return ivec2((cell & 1) == 0 ? two.xy : two.zw);
}

#ifdef HAS_SHADOWS
ShadowRecord shadow_record(int first)
{
    ShadowRecord r;
    r.origin = uintBitsToFloat(light_texel(first));
    r.right = uintBitsToFloat(light_texel(first + 1));
    r.up = uintBitsToFloat(light_texel(first + 2));
    r.forward = uintBitsToFloat(light_texel(first + 3));
    r.depth = uintBitsToFloat(light_texel(first + 4)).xy;
    r.origin.xyz -= eye.xyz;
    return r;
}

/* first: texel of the light's shadow record; 0: it has none. */
Light with_shadow(Light l, int first)
{
    if (first > 0 && max3(light_illuminate(l, light_P).E) > 0.0)
        l.intensity *= shadow_share(shadow_record(first), light_P, light_face);
    return l;
}
#endif

int light_count(vec3 P)
{
#ifdef HAS_SHADOWS
    vec3 face = cross(dFdx(P), dFdy(P));
    light_P = P;
    light_face = face * inversesqrt(max(dot(face, face), 1e-36));
#endif
    int count = light_lists.z;
    if (light_grid_size.x > 0) {
        ivec2 near = light_cell(P + eye.xyz);
        light_near_first = near.x;
        count += near.y - near.x;
    }
    return count;
}

/* The i-th light, unoccluded; rest: the rest of its texels. Call light_count() first. */
Light light_open_at(int i, out uvec4 rest)
{
    /* Those that reach everywhere have a list of their own, before the others. */
    int number = i;
    if (light_grid_size.x > 0)
        number = light_number(i < light_lists.z ? i : light_near_first + i - light_lists.z);
    vec4 place = uintBitsToFloat(light_texel(4 * number));
    vec4 spot = uintBitsToFloat(light_texel(4 * number + 1));
    vec4 intensity = uintBitsToFloat(light_texel(4 * number + 2));
    Light l;
    rest = light_texel(4 * number + 3);
    l.directional = rest.x != 0u;
    l.position = l.directional ? place.xyz : place.xyz - eye.xyz;
    l.range = place.w;
    l.spot_direction = spot.xyz;
    l.spot_scale = spot.w;
    l.intensity = intensity.xyz;
    l.spot_offset = intensity.w;
    return l;
}

/* The same, with its intensity scaled by its visibility. */
Light light_at(int i)
{
    uvec4 rest;
    Light l = light_open_at(i, rest);
#ifdef HAS_SHADOWS
    l = with_shadow(l, int(rest.y));
#endif
    return l;
}
#else
int light_count(vec3 P)
{
    return 0;
}

Light light_at(int i)
{
    return light_point(vec3(0.0), vec3(0.0), 0.0);
}
#endif
