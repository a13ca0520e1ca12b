/* light_block.glsl - where the light of an image is in textures, as gl_light_block.h has it. */
#define LIGHT_LEVELS 16
#define LIGHT_IMAGES 4
#define LIGHT_STEPS 17
#define LIGHT_ROW 1024

layout(std140) uniform Lighting
{
    /* 1 / width, 1 / height; scale of the background's texels; GLASS_ROOT_MAX of dfg.h */
    vec4 light_atlas;
    ivec4 light_ranges;  /* first and last level of GGX, of Charlie */
    vec4 light_places[2 * LIGHT_LEVELS]; /* of the levels of GGX, then of Charlie: column, row, size, scale */
    vec4 light_irradiance;               /* the same */
    vec4 light_steps[LIGHT_LEVELS / 2];  /* roughness of the levels of GGX, four in each, then those of Charlie */
    vec4 light_slopes[LIGHT_LEVELS / 2]; /* 1 / difference to the next one; 0 outside of the range */
    vec4 light_images[LIGHT_IMAGES]; /* unfiltered, blurred ones: column, row, width, height */
    vec4 light_narrow_weights[LIGHT_STEPS];         /* of the images, with their scales */
    vec4 light_narrow_lobe[LIGHT_STEPS];            /* x: of level 1 of GGX */
    vec4 light_grid_origin;                         /* m, world */
    vec4 light_grid_cells;                          /* per m */
    ivec4 light_grid_size;                          /* per axis; 0: all lights are evaluated everywhere */
    /* size of a tile, texels; tiles per row; 1 / size of the map */
    vec4 light_shadow;
    /* x, z of the middle of its map, half of its size, height of the plane; m, world */
    vec4 light_ground;
    /* of the objects on it, m: the heights at both ends of the height map's range */
    vec4 light_ground_height;
    ivec4 light_lists; /* first texel of lists, of cells; number of lights that reach everywhere */
};
