/* sea_surface.frag - which water a pixel shows. Triangles are small: expensive work is done once per pixel, by
 * sea.frag. */
in highp vec3 v_at;
in highp vec2 v_rest;
in highp float v_closing;

layout(location = 0) out highp vec4 fragment;

void main()
{
    float depth = dot(v_at, forward.xyz);
    if (depth < sea_clip.x || depth > sea_clip.y)
        discard;
    fragment = vec4(v_rest, length(v_at), max(abs(v_closing), 1e-3));
}
