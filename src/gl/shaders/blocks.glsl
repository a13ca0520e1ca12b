/* blocks.glsl - uniform blocks as gl_blocks.h has them. */
layout(std140) uniform Frame
{
    mat4 view_projection; /* for points relative to the eye */
    vec4 eye;             /* m; w: 1 orthographic */
    vec4 right;           /* per +1 of gl_FragCoord.x at depth 1 m (orthographic: m) */
    vec4 up; /* the same of y; points down where rows run from the top */
    vec4 forward;    /* unit */
    /* width, height of the viewport, pixels; offset from gl_FragCoord to the position in it */
    vec4 frame_size;
    vec4 frame_light; /* scale of the environment, cos and sin of its rotation, number of punctual lights */
    float exposure;
    int energy;
    int channel;
    int has_coverage; /* 1: alpha masks set sample coverage */
    float background_blur;
    float far_depth;   /* gl_Position.z / w at infinity: 1, or 0 where depth is reversed */
    float pixel_scale; /* rendered pixels per pixel of the image, along a row */
    int is_draft; /* 1: one texture lookup for the footprint of a pixel */
    vec4 background; /* display-linear color behind the image, for a window; w: 0: none */
    /* what glass shows where nothing is behind it: w: 0 the environment, 1 nothing, 2 a color (cd/m^2) */
    vec4 backdrop;
};
