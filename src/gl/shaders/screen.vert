/* screen.vert - one triangle that covers the viewport. */
out vec2 v_place; /* [0, 1], from the lower left corner */

void main()
{
    v_place = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0;
    gl_Position = vec4(v_place * 2.0 - 1.0, far_depth, 1.0);
}
