/* sea_light.glsl - a sea is always lit by surroundings that were filtered: environment.glsl. */
#ifdef HAS_PICTURE
#define HAS_ENVIRONMENT
#endif
