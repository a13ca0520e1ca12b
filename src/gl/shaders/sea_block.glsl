/* sea_block.glsl - the sea of an image, as in gl_sea_block.h. Positions are relative to the eye: X, Z in the world
 * minus the eye's. */
#ifdef HAS_IMAGE
#define HAS_ENVIRONMENT /* environment.glsl: an environment instead of the atmosphere */
#endif

#define SEA_TILES 4
#define SEA_FOOTPRINTS 64
#define SEA_LEVELS 11
#define SEA_CLASS_STEP 8 /* gl_sea.c */
#define SEA_CLASSES 512
#define SEA_CAUSTIC_LAYERS 3
#define SEA_FOAM_READINGS 4
#define SEA_CUTS 2 /* gl_sea_block.h */
#define SEA_BALLS 4

layout(std140) uniform Sea
{
    /* cos, sin of a tile's rotation; samples per m; 1: it is read through patches */
    vec4 sea_axes[SEA_TILES];
    vec4 sea_places[SEA_TILES];    /* of the eye: in samples; in its rhombus of patches */
    vec4 sea_lengths[SEA_TILES];   /* 1 / length, 1/m; first row of its patches; row of the foam's planes */
    ivec4 sea_counts;              /* tiles, levels, samples per axis */
    /* height over still water, fall (1/m), standard deviation, mean level of waves; m */
    vec4 sea_eye;
    /* height of a pixel at depth 1, share of it that a sample covers; near, far; m */
    vec4 sea_ray;
    vec4 sea_clip;                 /* clipping distances along the camera's axis, m */
    /* of the grid: first and half azimuth, scale of the sinh, m, and its step */
    vec4 sea_fan;
    vec4 sea_fan_ends;             /* columns, last row with waves, rows; ratio of distances beyond */
    vec4 sea_fan_level;            /* row from which 1 / distance falls evenly, its distance, m */
    /* x, z of the grid's middle at rest; largest displacement of water, m; width of samples, rad */
    vec4 sea_shift;
    vec4 sea_residual[SEA_FOOTPRINTS]; /* unresolved slope variances of a footprint: xx, zz, xz */
    vec4 sea_moments[SEA_FOOTPRINTS];  /* k4 of the unresolved waves, mean omega */
    /* variances of all slopes; w: 1: sea_rough stands for waves finer than all tiles */
    vec4 sea_total;
    vec4 sea_rough;                /* slope variances */
    vec4 sea_foam_axes[SEA_FOAM_READINGS];   /* rows, columns of a pattern along x, z: samples per m */
    /* of the eye in it, samples; log2 of samples per m of footprints; weight */
    vec4 sea_foam_places[SEA_FOAM_READINGS];
    /* variance below the resolution of a level, of each pattern, after the share */
    vec4 sea_foam_hidden[SEA_LEVELS];
    /* w: ior, foam's albedo, normals, masking */
    vec4 sea_absorption, sea_scattering, sea_backscattering, sea_reflectance;
    vec4 sea_pure_share;           /* w: 1: Schlick's formula */
    vec4 sea_sun;                  /* unit vector towards it; w: its Fresnel reflectance */
    vec4 sea_sun_irradiance;       /* lx; w: reflectance for light from the whole sky */
    vec4 sea_sky_irradiance;       /* w: time, s */
    vec4 sea_downwelling;          /* w: exposure time, s */
    vec4 sea_beam, sea_sunward;    /* w: radius of the disc; unused */
    vec4 sea_crest_beam, sea_crest_sunward; /* w: wave number, 1/m, and amplitude, m, of a sine */
    vec4 sea_bed;                  /* albedo; depth under the eye, m */
    vec4 sea_bed_slope;            /* slope along x, z; perceptual roughness of stages; clamp */
    /* sine of the elevation of the visible horizon; distance scale of transmittance, km */
    vec4 sea_sky_at;
    vec4 sea_caustic_axis;         /* of layers of sunlight on the bed; z: 1: there are some */
    vec4 sea_caustics[SEA_CAUSTIC_LAYERS]; /* middle from the eye, 2 / width, width of a texel */
    ivec4 sea_style;                /* stage, legacy variant; 1: foam, legacy sparkles */
    /* of a model; positions from the eye */
    mat4 sea_cut[SEA_CUTS];       /* for positions relative to the viewpoint of a cut */
    vec4 sea_cut_axis[SEA_CUTS];  /* unit; w: 1: depth is reversed, rows run from the top */
    /* nearness per height at its depth, < 0: below the water; plane, and height of the eye over it, m */
    vec4 sea_cut_plane[SEA_CUTS];
    vec4 sea_model_depth;  /* a, b of depth in clip space, a + b / depth; w: as in sea_cut_axis */
    vec4 sea_model_middle; /* of its bounds; w: number of balls */
    vec4 sea_model_half;   /* half of its size, m */
    vec4 sea_model_balls[SEA_BALLS]; /* bounding spheres of its parts: center, radius */
    vec4 sea_contact;      /* of the rectangle: x, z from the eye, 1 / lengths, 1/m */
    vec4 sea_shadow;       /* the same for the shadow on the bed; 0: there is none */
};
