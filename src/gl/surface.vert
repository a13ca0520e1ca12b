/* surface.vert - vertices of instances, relative to the eye. */
in vec3 position;
in vec3 normal;
in vec4 tangent; /* w: handedness */
in vec4 color;
in vec2 texcoord0;
in vec2 texcoord1;
in vec2 texcoord2;
in vec2 texcoord3;
in vec4 world0; /* rows of the instance's matrix */
in vec4 world1;
in vec4 world2;
in vec3 normal_matrix0; /* rows */
in vec3 normal_matrix1;
in vec3 normal_matrix2;
in vec4 instance; /* scale, sign of bitangents, material id + 1 */

centroid out vec3 v_position; /* m, relative to the eye */
centroid out vec3 v_normal;
centroid out vec4 v_color;
centroid out vec4 v_texcoord01;
centroid out vec4 v_texcoord23;
#ifdef HAS_TANGENTS
centroid out vec3 v_tangent;
flat out float v_handedness;
#endif
flat out vec4 v_instance;

void main()
{
    vec4 p = vec4(position, 1.0);
    v_position = vec3(dot(world0, p), dot(world1, p), dot(world2, p));
    v_normal = vec3(dot(normal_matrix0, normal), dot(normal_matrix1, normal), dot(normal_matrix2, normal));
#ifdef HAS_TANGENTS
    v_tangent = vec3(dot(world0.xyz, tangent.xyz), dot(world1.xyz, tangent.xyz), dot(world2.xyz, tangent.xyz)) / instance.x;
    v_handedness = tangent.w * instance.y;
#endif
    v_color = color;
    v_texcoord01 = vec4(texcoord0, texcoord1);
    v_texcoord23 = vec4(texcoord2, texcoord3);
    v_instance = instance;
    gl_Position = view_projection * vec4(v_position, 1.0);
}
