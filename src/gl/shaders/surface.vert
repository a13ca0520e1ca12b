/* surface.vert - vertices of instances, relative to the eye; and outlines of sprites. */
in vec3 position;
in vec3 normal;
in vec4 color;
in vec2 texcoord0;
in vec2 texcoord1;
in vec4 world0; /* rows of the instance's matrix */
in vec4 world1;
in vec4 world2;
in vec4 instance; /* scale, sign of bitangents, index of the geometry, radius of sprites in pixels */
#ifdef IS_SPRITE
in vec3 position_end; /* of a line; that of a point equals its start */
in vec3 normal_end;
in vec4 color_end;
in vec2 texcoord0_end;
in vec2 texcoord1_end;
#else
in vec4 tangent; /* w: handedness */
in vec2 texcoord2;
in vec2 texcoord3;
in vec3 normal_matrix0; /* rows */
in vec3 normal_matrix1;
in vec3 normal_matrix2;
#endif

invariant gl_Position; /* the same in all programs */
out vec3 v_position; /* m, relative to the eye */
out vec3 v_normal;
out vec4 v_color;
out vec4 v_texcoord01;
out vec4 v_texcoord23;
#ifdef HAS_TANGENTS
out vec3 v_tangent;
flat out float v_handedness;
#endif
flat out vec4 v_instance;

vec3 turn(vec3 v)
{
    return vec3(dot(world0.xyz, v), dot(world1.xyz, v), dot(world2.xyz, v));
}

/* The instance's origin is made relative to the eye before the point is added, which keeps models far from the
 * origin steady. */
vec3 place(vec3 p)
{
    vec3 origin = vec3(world0.w - eye.x, world1.w - eye.y, world2.w - eye.z);
    return turn(p) + origin;
}

#ifdef IS_PHONG
/* OpenGL 1: colors in the values of the computation, and, where light is computed at vertices (Gouraud 1971), the lit
 * colors of both sides. A flat surface takes the light of its last corner, on the side that only fragments know. */
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
    color.xyz = phong_from_linear(phong_frame(), color.xyz);
#ifdef IS_AT_VERTICES
#ifdef IS_FLAT
    v_corner = at;
    v_corner_color = color;
#else
    vec3 N = normalize_or(to_eye_space(normal), vec3(0.0, 0.0, 1.0));
    PhongLit front = ogl1_light_at_corner(ogl1_host(at, N, color, true));
    PhongLit back = ogl1_light_at_corner(ogl1_host(at, N, color, false));
    v_front = front.color;
    v_front_highlight = front.highlight;
    v_back = back.color;
    v_back_highlight = back.highlight;
#endif
#endif
}
#endif

#ifdef IS_SPRITE

vec3 unit_or(vec3 v, vec3 otherwise)
{
    float length2 = dot(v, v);
    return length2 > 0.0 ? v * inversesqrt(length2) : otherwise;
}

/* The instance's matrix of normals: the cofactors, with the sign that keeps the normals of mirrored instances
 * outward. */
vec3 turn_normal(vec3 n)
{
    mat3 cofactors = mat3(cross(world1.xyz, world2.xyz), cross(world2.xyz, world0.xyz), cross(world0.xyz, world1.xyz));
    return vec3(dot(cofactors[0], n), dot(cofactors[1], n), dot(cofactors[2], n)) * instance.y;
}

/* Position of a vertex on the outline of a sprite: the set of rays that pass within a radius of the line between A
 * and B, as wide as a pixel at either end. Vertices run along the line, two by two, from the round end at A to
 * that at B, in steps of 30 degrees; the outline shows its front. */
vec3 outline(vec3 A, vec3 B, bool is_end)
{
    bool is_orthographic = eye.w > 0.5;
    vec3 middle = is_end ? B : A;
    vec3 ray = is_orthographic ? forward.xyz : unit_or(middle, forward.xyz);
    float pixel = length(up.xyz) * pixel_scale * (is_orthographic ? 1.0 : max(dot(middle, forward.xyz), 0.0));
    vec3 any_side = cross(ray, abs(ray.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0));
    vec3 side = unit_or(cross(B - A, ray), normalize(any_side));
    vec3 along = cross(ray, side);
    int column = gl_VertexID >> 1;
    float angle = float(is_end ? 7 - column : column) * (PI / 6.0);
    float left = (gl_VertexID & 1) == 0 ? instance.y : -instance.y;
    return middle + (side * (left * sin(angle)) + along * (is_end ? cos(angle) : -cos(angle))) * (instance.w * pixel);
}

void main()
{
    bool is_end = gl_VertexID >= 8;
    v_position = outline(place(position), place(position_end), is_end);
    v_normal = turn_normal(is_end ? normal_end : normal);
    v_color = is_end ? color_end : color;
#ifdef IS_PHONG
    light_vertex(v_color, place(is_end ? position_end : position), v_normal);
#endif
    v_texcoord01 = is_end ? vec4(texcoord0_end, texcoord1_end) : vec4(texcoord0, texcoord1);
    v_texcoord23 = vec4(0.0);
    v_instance = instance;
    gl_Position = view_projection * vec4(v_position, 1.0);
}

#else

void main()
{
    v_position = place(position);
    v_normal = vec3(dot(normal_matrix0, normal), dot(normal_matrix1, normal), dot(normal_matrix2, normal));
#ifdef HAS_TANGENTS
    v_tangent = turn(tangent.xyz) / instance.x;
    v_handedness = tangent.w * instance.y;
#endif
    v_color = color;
#ifdef IS_PHONG
    light_vertex(v_color, v_position, v_normal);
#endif
    v_texcoord01 = vec4(texcoord0, texcoord1);
    v_texcoord23 = vec4(texcoord2, texcoord3);
    v_instance = instance;
    gl_Position = view_projection * vec4(v_position, 1.0);
}

#endif
