/* blocks.glsl - uniform blocks as gl_blocks.h has them. */
layout(std140) uniform Frame
{
    mat4 view_projection; /* of points relative to the eye */
    vec4 eye;             /* m; w: 1 orthographic */
    vec4 right;           /* per +1 of gl_FragCoord.x at depth 1 m (orthographic: m) */
    vec4 up; /* the same of y; points down where rows run from the top */
    vec4 forward;    /* unit */
    vec4 frame_size; /* width, height of what is drawn, pixels; what gl_FragCoord lacks to be a place in it */
    vec4 frame_light; /* scale of the environment, cos and sin of its rotation, number of punctual lights */
    float exposure;
    int energy;
    int channel;
    int has_coverage; /* 1: samples are made of the alpha of masks */
    float background_blur;
    float tonemap_operator;
    float far_depth;   /* gl_Position.z / w of what is infinitely far away: 1, or 0 where depth is reversed */
    float pixel_scale; /* pixels that are drawn, in a row, for one of the picture */
    vec4 background; /* display-linear color that is laid behind for a window; w: 0: none */
};
