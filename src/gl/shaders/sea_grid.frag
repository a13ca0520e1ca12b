/* sea_grid.frag - nodes of the mesh: positions relative to the eye, as it sees them over a round Earth, and the
 * resting positions of their water. */
layout(location = 0) out highp vec4 fragment;
layout(location = 1) out highp vec4 fragment_rest;

/* The resting position of a node's water. Near the eye, where displacements exceed the distance, the fan is wider
 * than the image. */
vec2 sea_grid_rest(ivec2 node)
{
    float waves = sea_fan_ends.y;
    float row = float(node.y);
    float r = sea_fan.z * sinh(sea_fan.w * min(row, sea_fan_level.x));
    r *= pow(sea_fan_ends.w, max(row - waves, 0.0)) / max(1.0 - sea_fan.w * max(min(row, waves) - sea_fan_level.x, 0.0), 0.5 * sea_fan.w);
    float wider = asin(min(1.2 * sea_shift.z / max(r, 1e-6), 1.0));
    float azimuth = sea_fan.x + (2.0 * float(node.x) / (sea_fan_ends.x - 1.0) - 1.0) * min(sea_fan.y + wider, PI);
    return sea_shift.xy + r * vec2(cos(azimuth), sin(azimuth));
}

void main()
{
    vec2 rest = sea_grid_rest(ivec2(gl_FragCoord.xy));
    float r = max(length(rest), 1e-3);
    vec3 D = sea_heave(rest, sea_shift.w * length(vec2(r, sea_eye.x)));
    vec2 at = rest + D.xz;
    fragment = vec4(at.x, D.y - sea_eye.x - dot(at, at) * sea_eye.y, at.y, 1.0);
    fragment_rest = vec4(rest, 0.0, 1.0);
}
