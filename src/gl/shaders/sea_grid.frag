/* sea_grid.frag - nodes of the mesh: places relative to the eye, as it sees them over a round Earth, and where their water rests. */
layout(location = 0) out highp vec4 fragment;
layout(location = 1) out highp vec4 fragment_rest;

void main()
{
    vec2 rest = sea_grid_rest(ivec2(gl_FragCoord.xy));
    float r = max(length(rest), 1e-3);
    vec3 D = sea_heave(rest, sea_shift.w * length(vec2(r, sea_eye.x)));
    vec2 at = rest + D.xz;
    fragment = vec4(at.x, D.y - sea_eye.x - dot(at, at) * sea_eye.y, at.y, 1.0);
    fragment_rest = vec4(rest, 0.0, 1.0);
}
