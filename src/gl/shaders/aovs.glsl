/* aovs.glsl - what a surface is rather than what it looks like: the layers that gl_film.c reads. */
#ifdef AOVS
layout(location = 0) out vec4 aov_normal_depth;    /* world; m along the camera's axis */
layout(location = 1) out vec4 aov_color_occlusion; /* linear base color; 1: open */
layout(location = 2) out vec4 aov_number_texcoord; /* of the geometry; TEXCOORD_0; opacity, 0: nothing is there */

/* Of what is seen at all: the nearest surface that light does not pass altogether. */
void put_aovs(vec3 N, vec3 color, float occlusion, float opacity)
{
    if (opacity <= 0.0)
        discard;
    aov_normal_depth = vec4(N, dot(v_position, forward.xyz));
    aov_color_occlusion = vec4(color, occlusion);
    aov_number_texcoord = vec4(v_instance.z, texcoord_of_set(0), opacity);
}
#endif
