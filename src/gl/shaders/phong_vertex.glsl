/* phong_vertex.glsl - additional vertex outputs of OpenGL 1: colors in the values of the computation, and, where
 * light is computed at vertices (Gouraud 1971), the lit colors of both sides. A flat surface takes the light of
 * its last corner, on the side that only fragments know. */
#ifdef IS_AT_VERTICES
#ifdef IS_FLAT
flat out vec3 v_corner; /* the last corner, m, relative to the eye */
flat out vec4 v_corner_color;
#else
out vec3 v_front;
out vec3 v_front_highlight;
out vec3 v_back;
out vec3 v_back_highlight;
#endif
#endif

void light_vertex(inout vec4 color, vec3 at, vec3 normal)
{
    color.xyz = ogl1_from_linear(color.xyz);
#ifdef IS_AT_VERTICES
#ifdef IS_FLAT
    v_corner = at;
    v_corner_color = color;
#else
    vec3 N = normalize_or(to_eye_space(normal), vec3(0.0, 0.0, 1.0));
    PhongLit front = light_at_corner(color, at, N, true);
    PhongLit back = light_at_corner(color, at, N, false);
    v_front = front.color;
    v_front_highlight = front.highlight;
    v_back = back.color;
    v_back_highlight = back.highlight;
#endif
#endif
}
