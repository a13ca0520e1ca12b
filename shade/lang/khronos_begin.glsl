/* khronos_begin.glsl - renames facet's functions whose names Khronos' Sample Viewer gives to its own. */
#define D_Charlie facet_D_Charlie
#define max3 facet_max3
