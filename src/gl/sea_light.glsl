/* sea_light.glsl - a sea is always lit by surroundings that were filtered: environment.glsl. */
#define HAS_ENVIRONMENT
