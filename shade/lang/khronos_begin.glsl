/* Names that Khronos' Sample Viewer gives to functions of its own: facet's get another one. */
#define D_Charlie facet_D_Charlie
#define max3 facet_max3
