/* facet.h - the public interface of libfacet: read a model (glTF; OBJ with MTL), light it, render it on the CPU, convert
 * its materials between OpenGL 1 and PBR, plot reflectance.
 *
 * Conventions
 *   Units      m, rad, s, cd, lx, cd/m^2; +Y up, right-handed, cameras look along -Z, as in glTF
 *   Color      linear Rec.709 unless a name says _srgb
 *   Images     texel (0, 0) is the top left one; rows from top to bottom
 *   Descs      {0} is valid for every desc struct and means the defaults that the comments give, and so does NULL in the
 *              place of a desc
 *   Failure    a function that can fail returns a facet_result and writes one sentence to *error (NULL: not
 *              wanted); its outputs are NULL then and nothing leaks
 *   Threads    different objects may be used from different threads, one object may be read from several;
 *              results are equal to the last bit for every thread count
 *   State      the library never prints, exits, reads the environment or keeps global state */
#ifndef FACET_FACET_H
#define FACET_FACET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define FACET_API
#else
#define FACET_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- results, memory, messages ---- */

/* What a call came to. */
typedef enum facet_result {
    FACET_OK = 0,
    FACET_ERROR_ARGUMENT,    /* a desc or an argument asks for what cannot be */
    FACET_ERROR_READ,        /* an input cannot be read: missing, no permission, I/O */
    FACET_ERROR_INVALID,     /* an input was read and is not valid */
    FACET_ERROR_UNSUPPORTED, /* an input needs a feature that facet or this build lacks */
    FACET_ERROR_WRITE,       /* an output cannot be written */
    FACET_ERROR_LIMIT,       /* a limit that the caller set is reached: memory, texture size, time */
    FACET_ERROR_MEMORY,      /* out of memory */
    FACET_ERROR_SYSTEM,      /* the machine lacks something: a display, a library */
    FACET_ERROR_CANCELLED,   /* the progress callback asked to stop */
    FACET_ERROR_BUG          /* facet contradicted itself; please report */
} facet_result;

/* One sentence that names the thing, the place and what was expected. */
typedef struct facet_error {
    facet_result result;
    char message[1024]; /* UTF-8, ends with 0, without newline */
} facet_error;

/* Where memory comes from. {0}: malloc. allocate returns NULL when there is none; release gets the size
 * that was asked for. Both are called from several threads at once. */
typedef struct facet_allocator {
    void *user;
    void *(*allocate)(void *user, size_t size);
    void (*release)(void *user, void *memory, size_t size);
} facet_allocator;

/* A limit on memory that several calls share: an allocator that counts. */
typedef struct facet_budget facet_budget;
FACET_API facet_result facet_budget_create(uint64_t limit_bytes /* 0: none, only count */,
                                           facet_budget **budget, facet_error *error);
FACET_API void
facet_budget_destroy(facet_budget *budget); /* NULL is allowed; after all that it gave is released */
FACET_API facet_allocator facet_budget_allocator(facet_budget *budget);
FACET_API uint64_t facet_budget_used_bytes(const facet_budget *budget);
FACET_API uint64_t facet_budget_peak_bytes(const facet_budget *budget);

typedef enum facet_log_level {
    FACET_LOG_LEVEL_WARNING,
    FACET_LOG_LEVEL_DETAIL /* on request: the driver that draws, rules that a file breaks without harm */
} facet_log_level;         /* others may come */

/* Receives messages about what is lost but survivable. {0}: silent. May be called from any thread, one call at
 * a time per operation. */
typedef struct facet_log {
    void *user;
    void (*message)(void *user, facet_log_level level, const char *text);
} facet_log;

/* Told how far an operation is; returns false to cancel it. {0}: nobody. stage is a static string. */
typedef struct facet_progress {
    void *user;
    bool (*report)(void *user, const char *stage, double fraction);
} facet_progress;

/* ---- version and machine ---- */

FACET_API const char *facet_version(void); /* "0.1.0" */
/* One line each, ending with a newline: version, compiler, libraries with their versions, CPU, threads.
 * Writes at most size bytes with the closing 0; returns the length that the whole text has. */
FACET_API size_t facet_build_report(char *text, size_t size);
/* CPUs that this process may use: affinity and cgroup quota counted in; at least 1. */
FACET_API uint32_t facet_thread_count(void);

/* ---- scenes ---- */

typedef struct facet_scene facet_scene;

/* What the materials of a model are made of. */
typedef enum facet_material_model {
    FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS,  /* glTF 2.0, with its extensions */
    FACET_MATERIAL_MODEL_SPECULAR_GLOSSINESS, /* KHR_materials_pbrSpecularGlossiness */
    FACET_MATERIAL_MODEL_OGL1 /* OpenGL 1: Blinn-Phong as fixed-function programs, MTL and rgl have it */
} facet_material_model;

typedef enum facet_legacy_method {
    FACET_LEGACY_METHOD_CLOSED, /* tables and formulas where the target is linear radiance, else a search */
    FACET_LEGACY_METHOD_FIT     /* searched for the smallest error */
} facet_legacy_method;

typedef enum facet_legacy_profile {
    FACET_LEGACY_PROFILE_SPECULAR_IOR, /* with KHR_materials_specular and KHR_materials_ior: nearest to the old look */
    FACET_LEGACY_PROFILE_CORE          /* base color, metallic and roughness only */
} facet_legacy_profile;

/* Which difference between the two models a conversion minimises (docs/legacy.md, "The error"). */
typedef enum facet_legacy_target {
    /* _DRAWN to OpenGL 1 and from rgl's parameters, whose programs add light in display numbers; _LINEAR from MTL,
     * whose readers today add light as light */
    FACET_LEGACY_TARGET_AUTO,
    FACET_LEGACY_TARGET_LINEAR,  /* of radiance */
    FACET_LEGACY_TARGET_DISPLAY, /* of radiance clamped to [0, 1] */
    FACET_LEGACY_TARGET_DRAWN    /* of what an OpenGL 1 program draws: sums of display numbers, clamped */
} facet_legacy_target;

/* What the colors of MTL and rgl files are. */
typedef enum facet_legacy_colors {
    FACET_LEGACY_COLORS_DEFAULT, /* sRGB */
    FACET_LEGACY_COLORS_SRGB,
    FACET_LEGACY_COLORS_LINEAR
} facet_legacy_colors;

/* Programs that wrote MTL files in ways of their own. */
typedef enum facet_mtl_dialect {
    FACET_MTL_DIALECT_AUTO,        /* by the file's first comment; else SPEC */
    FACET_MTL_DIALECT_SPEC,        /* as Wavefront has it, to the letter: Ns 0 is a highlight everywhere */
    FACET_MTL_DIALECT_BLENDER27,   /* Ns = 1.96078 (hardness - 1) */
    FACET_MTL_DIALECT_BLENDER28,   /* Ns = (30 (1 - r))^2 */
    FACET_MTL_DIALECT_BLENDER3,    /* Ns = 1000 (1 - r)^2, metallic in Ka */
    FACET_MTL_DIALECT_OBJ2GLTF_MR, /* obj2gltf --metallicRoughness: metallic in Ks, roughness in Ns */
    FACET_MTL_DIALECT_OBJ2GLTF_SG  /* obj2gltf --specularGlossiness: glossiness in Ns */
} facet_mtl_dialect;

typedef enum facet_mtl_illum {
    FACET_MTL_ILLUM_AUTO,  /* 0 and 1 count only where Ks is black or the program is known to mean them */
    FACET_MTL_ILLUM_HONOR, /* always */
    FACET_MTL_ILLUM_IGNORE /* never */
} facet_mtl_illum;

typedef enum facet_legacy_ambient {
    FACET_LEGACY_AMBIENT_DROP,     /* ambient light is the scene's, not the material's */
    FACET_LEGACY_AMBIENT_EMISSIVE, /* added to the emission, as under ambient light of 1 */
    FACET_LEGACY_AMBIENT_OCCLUSION /* its map becomes the occlusion texture */
} facet_legacy_ambient;

/* Vertex normals of an OBJ, STL or PLY file that has none. */
typedef enum facet_obj_normals {
    FACET_OBJ_NORMALS_AUTO, /* by its smoothing groups; where it has none either, across edges of less than 45 degrees */
    FACET_OBJ_NORMALS_FLAT,  /* one per face */
    FACET_OBJ_NORMALS_SMOOTH /* across all edges */
} facet_obj_normals;

/* How materials of OpenGL 1 become glTF's, and back; docs/legacy.md. {0}: closed form, specular and ior, least error of
 * radiance, sRGB colors, lights times pi. */
typedef struct facet_legacy_desc {
    facet_legacy_method method;
    facet_legacy_profile profile;
    facet_legacy_target target;
    facet_legacy_colors colors;
    facet_mtl_dialect dialect;
    facet_mtl_illum illum;
    facet_legacy_ambient ambient;
    /* from OGL1: where a broad white highlight would make the material white, the hue of the diffuse color is kept, at the
     * price of a larger error, which the report states */
    bool keeps_hue;
    /* of reading: legacy materials are not converted, glTF's are defaults: for OpenGL 1 only */
    bool keeps_materials;
    bool has_glass; /* Ni, Tf and illum 4, 6, 7, 9 become transmission; false: opacity becomes alpha */
    /* illum 3, 5, 7, 8: Ks is a reflectance, and the surroundings are reflected; false: a highlight */
    bool has_mirrors;
    /* Textures that only the old materials use leave the scene; the way back is then fitted for them. Once some have
     * left, FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS leaves the materials as they are. */
    bool drops_sources;
    /* legacy lights keep their numbers; false: times pi, which makes the two models agree */
    bool keeps_light;
    bool bakes_occlusion; /* to OGL1: the occlusion texture darkens the diffuse one */
    /* to OGL1: fits anew even where a material still is what a conversion made of known values */
    bool ignores_source;
} facet_legacy_desc;

/* How a model is read. {0}: with malloc, silently, all threads, files only from the model's folder. */
typedef struct facet_scene_desc {
    facet_allocator allocator;
    facet_log log;
    uint32_t thread_count;     /* 0: facet_thread_count() */
    const char *root;          /* folder that URIs in the model may reach; NULL: the folder of the model */
    uint64_t max_file_bytes;   /* 0: 4 GiB; larger files are refused */
    uint32_t max_texture_size; /* texels along an edge; 0: 16384; larger images are refused */
    facet_legacy_desc legacy;  /* OBJ, MTL, rgl's parameters: how they are understood and converted */
    facet_obj_normals obj_normals;
    bool has_flipped_texcoords; /* OBJ: v points down already (the format says up) */
    /* a JSON file of rgl's material parameters that take the place of the model's; NULL: none */
    const char *parameters;
} facet_scene_desc;

/* Reads a .glb or .gltf file, an .obj file with its .mtl files, a .stl or .ply file, or a .json file of rgl's material and
 * light parameters (one ball per material then); told apart by content. Legacy materials are converted as desc->legacy says, and kept
 * beside. Texels are decoded when a renderer asks for them. */
FACET_API facet_result facet_scene_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                                        facet_error *error);
/* The same from memory, which may go afterwards. name stands for the file in messages; external files need
 * desc->root. */
FACET_API facet_result facet_scene_load_memory(const void *bytes, size_t size, const char *name,
                                               const facet_scene_desc *desc, facet_scene **scene,
                                               facet_error *error);
/* The built-in scene: spheres over roughness and metallic, and a few instructive materials. */
FACET_API facet_result facet_scene_create_builtin(const facet_scene_desc *desc, facet_scene **scene,
                                                  facet_error *error);
FACET_API void facet_scene_destroy(facet_scene *scene); /* NULL is allowed */

/* Whether path is one of the files that the scene was read from, under whatever name: writing there would replace an
 * input. */
FACET_API bool facet_scene_has_file(const facet_scene *scene, const char *path);

/* How many of each there are. */
typedef struct facet_scene_counts {
    uint32_t scenes, nodes, meshes, primitives, materials, textures, images, cameras, lights, skins,
        animations, variants, image_lights;
    uint32_t instances; /* primitives as drawn in the default scene, a mesh under two nodes counted twice */
    uint64_t vertices, triangles, lines, points; /* as stored, instances not counted */
    uint64_t drawn_triangles;                    /* in the default scene, instances counted */
} facet_scene_counts;
FACET_API facet_scene_counts facet_scene_get_counts(const facet_scene *scene);

/* Text that describes the model: a JSON object (UTF-8) with asset, counts, bounds, scenes, nodes, meshes,
 * materials with their parameters, textures, images, cameras, lights, extensions with their state and the
 * warnings of reading. docs/inspect.md lists the members. *text is released with facet_text_destroy(). */
FACET_API facet_result facet_scene_describe_json(const facet_scene *scene, char **text, facet_error *error);
FACET_API void facet_text_destroy(char *text);

/* ---- materials of OpenGL 1 and of glTF ---- */

/* Of error_graded. */
typedef enum facet_conversion_grade {
    FACET_CONVERSION_GRADE_GOOD, /* < 0.05 */
    FACET_CONVERSION_GRADE_FAIR, /* < 0.12 */
    FACET_CONVERSION_GRADE_POOR, /* < 0.30 */
    FACET_CONVERSION_GRADE_BAD
} facet_conversion_grade;

/* How one material was converted. Errors are relative RMS of radiance over lights from the hemisphere and views at 0, 30
 * and 60 degrees (docs/legacy.md, "The error"); NAN where there is none to tell. */
typedef struct facet_conversion {
    const char *name;   /* of the material; as long as the scene lives, as all here */
    const char *source; /* "mtl", "ogl1", "metallic-roughness", "specular-glossiness" */
    /* "closed", "fit", "exact" (nothing is lost), "source" (known from where it came), "none" */
    const char *method;
    const char *profile;   /* "specular+ior", "core", "ogl1", .. */
    double error;          /* E */
    double error_display;  /* E of radiance clamped to [0, 1] */
    double error_drawn;    /* the same with OpenGL 1 adding display numbers, as its programs did */
    double error_graded;   /* error_drawn where the target is FACET_LEGACY_TARGET_DRAWN, else error_display */
    double error_naive;    /* E of the formula that most converters use */
    double error_core;     /* E of what viewers without the extensions show */
    double error_views[3]; /* E of each view alone */
    facet_conversion_grade grade;
    facet_conversion_grade grade_drawn; /* of error_drawn */
    bool is_graded_as_drawn;            /* which of the two error_graded is */
    uint32_t warning_count;
} facet_conversion;

/* Converts all materials of a scene that nothing else uses meanwhile. To FACET_MATERIAL_MODEL_OGL1 the glTF materials stay
 * and their counterparts are put beside them, for facet_scene_save() and FACET_SHADING_OGL1. Fails with _MEMORY; what
 * is lost goes to log and into the report. */
FACET_API facet_result facet_scene_convert_materials(facet_scene *scene, facet_material_model to,
                                                     const facet_legacy_desc *desc /* NULL: {0} */,
                                                     const facet_log *log /* NULL: {0} */,
                                                     facet_error *error);
FACET_API bool facet_scene_has_legacy_materials(const facet_scene *scene);
/* What the last conversion did, that of reading counted in: one per material, in their order. 0: there was none. */
FACET_API uint32_t facet_scene_get_conversion_count(const facet_scene *scene);
FACET_API facet_conversion facet_scene_get_conversion(const facet_scene *scene,
                                                      uint32_t index); /* {0}: no such */

typedef enum facet_report_format { FACET_REPORT_FORMAT_JSON, FACET_REPORT_FORMAT_HTML } facet_report_format;
/* The last conversion as text: values before and after, errors, warnings. HTML is one file without others, with a pair of
 * spheres and the curves of both models for each material. *text is released with facet_text_destroy(). */
FACET_API facet_result facet_scene_report_conversion(const facet_scene *scene, facet_report_format format,
                                                     char **text, facet_error *error);

/* Number of the first scene, camera of that name; FACET_ERROR_ARGUMENT names those there are. Where no name
 * matches, one that differs in the case of letters does, or a decimal number as the index. */
FACET_API facet_result facet_scene_find_scene(const facet_scene *scene, const char *name, uint32_t *index,
                                              facet_error *error);
FACET_API facet_result facet_scene_find_camera(const facet_scene *scene, const char *name, uint32_t *index,
                                               facet_error *error);

/* The same for animations, and variants of materials (KHR_materials_variants). */
FACET_API facet_result facet_scene_find_animation(const facet_scene *scene, const char *name, uint32_t *index,
                                                  facet_error *error);
FACET_API facet_result facet_scene_find_variant(const facet_scene *scene, const char *name, uint32_t *index,
                                                facet_error *error);

/* One animation of a scene. */
typedef struct facet_animation {
    const char *name;      /* "" where it has none; as long as the scene lives */
    double begin_s, end_s; /* first and last key */
} facet_animation;
FACET_API facet_animation facet_scene_get_animation(const facet_scene *scene,
                                                    uint32_t index); /* {0}: no such */

/* What of a scene is shown, and when. {0}: the default scene with the materials that the file gives, at rest: as the
 * nodes stand. */
typedef struct facet_pose_desc {
    bool has_scene_index; /* false: the file's default scene */
    uint32_t scene_index;
    bool has_variant;
    uint32_t variant;
    uint32_t animation_count; /* played together; later ones win where two move the same */
    const uint32_t *animations;
    double time_s; /* of the animations; they rest before their first and after their last key */
} facet_pose_desc;

/* What world space is relative to, m, in the coordinates of the file: {0, 0, 0}, or a point near a model that is so far
 * from the file's origin, as on a map, that floats would not hold its shape. All places that the library takes and
 * gives as floats (cameras, orbits, bounds) are relative to it: add it for coordinates of the file, subtract it from
 * those, in double. It is the same whenever the file is read. */
FACET_API void facet_scene_get_origin(const facet_scene *scene, double origin[3]);
/* When a file is read, the origin is chosen by what its default scene shows at rest. This chooses it by another pose, where
 * an animation or another scene of the file takes the model elsewhere. Not while others use the scene.
 * FACET_ERROR_ARGUMENT: there is no such pose; _MEMORY. */
FACET_API facet_result facet_scene_choose_origin(facet_scene *scene, const facet_pose_desc *pose,
                                                 facet_error *error);

/* Axis-aligned bounds in world space of what is drawn and can be seen, m; pose NULL: {0}. False: nothing, both are 0. */
FACET_API bool facet_scene_get_bounds(const facet_scene *scene, const facet_pose_desc *pose, float minimum[3],
                                      float maximum[3]);

/* Moves what the default scene draws: puts a node above its roots with that matrix (columns, as in glTF; the last row is 0 0 0 1),
 * or changes that of the node that an earlier call has put there. The matrix is from the world space that there was before the
 * first call, whose origin becomes that of the file: facet_scene_get_origin() is 0 from then on. Skins go along. Not while others use the scene.
 * FACET_ERROR_ARGUMENT: not such a matrix; _MEMORY: the scene is as it was. */
FACET_API facet_result facet_scene_place(facet_scene *scene, const float matrix[16], facet_error *error);

/* How a model is written. {0}. */
typedef struct facet_scene_save_desc {
    facet_allocator allocator;
    facet_log log;
    /* Stage "write": asked before a file is begun, and before all are put in their places. Not before the first one is
     * anything on the disk. */
    facet_progress progress;
    uint32_t thread_count; /* 0: facet_thread_count() */
    bool is_glb;           /* a .glb file whatever the name is: for /dev/stdout and the like */
    bool keeps_inputs;     /* fails with _ARGUMENT rather than replace a file that the scene was read from */
    bool has_flipped_texcoords; /* OBJ: v stays as in glTF, pointing down (the format says up) */
    bool omits_mtl_pbr;         /* MTL: only what Wavefront defined, no Pr, Pm, .. and no glTF comment */
    float mtl_shininess_scale;  /* MTL: Ns is shininess times this; 0: 1 */
} facet_scene_save_desc;
/* Writes the whole scene, by the end of the name:
 *   .glb   glTF 2.0 in one file          .gltf  with a .bin and the images beside it. All that facet reads is written;
 *                                               reading it again gives an equal scene
 *   .obj   what the scene shows at rest, with a .mtl and the images beside it
 *   .json  rgl's parameters of materials and lights
 * The latter two need a scene with legacy materials (facet_scene_convert_materials()); FACET_ERROR_ARGUMENT without.
 * Whole or nothing. */
FACET_API facet_result facet_scene_save(const facet_scene *scene, const char *path,
                                        const facet_scene_save_desc *desc, facet_error *error);

/* ---- cameras ---- */

/* A camera in world space, which facet_scene_get_origin() is the origin of. */
typedef struct facet_camera {
    float eye[3];        /* m */
    float target[3];     /* m; any point in front along the axis */
    float up[3];         /* not parallel to the axis; {0}: +Y, or -Z for a camera that looks along Y */
    float fov_y_rad;     /* vertical; 0: orthographic with ortho_height */
    float ortho_height;  /* m, the full height of the picture at any distance */
    float aspect;        /* width / height for which the camera was made; 0: the picture's */
    float near_m, far_m; /* clipping distances along the axis; 0: none */
    float lens_radius_m; /* of a thin lens, FACET_RENDERER_KIND_PATH only; 0: a pinhole, all is sharp */
    float focus_m;       /* distance along the axis that is sharp; 0: that of target */
} facet_camera;

/* A camera on a sphere around a target, in the convention of <model-viewer>. Start from
 * facet_orbit_default(). */
typedef struct facet_orbit {
    float azimuth_rad;  /* around +Y; 0: from +Z, positive: towards +X */
    float polar_rad;    /* from +Y: 0 looks straight down, pi/2 is level */
    float radius;       /* m; 0: radius_scale times what frames the model */
    float radius_scale; /* 1 touches the border of the picture */
    float target[3];    /* m, where has_target */
    bool has_target;    /* false: the middle of the bounds */
    bool is_orthographic;
    float fov_y_rad;
    bool is_z_up;           /* the model has +Z up; the camera rises along it */
    bool fits_all_azimuths; /* radius 0: frames the model from every azimuth at once, for turntables that keep
                               the model's size */
    /* frames (and aims at the middle of) all that the pose's animations move through, not only time_s */
    bool fits_all_times;
    /* true: few parts that lie so far away that the rest would be a dot count for the middle and the distance, too; false:
     * they are left out, and log gets a warning */
    bool includes_far_parts;
    facet_log log;
} facet_orbit;
FACET_API facet_orbit facet_orbit_default(void); /* azimuth 0, polar 75 deg, 105 %, fov 30 deg */

/* The camera that orbit describes, such that the whole of what pose (NULL: {0}) shows is in an image of that aspect
 * (width / height): every vertex counts, not only the corners of the bounds, except those that no camera sees (of triangles
 * without area, of opacity 0 throughout). */
FACET_API facet_result facet_camera_from_orbit(const facet_scene *scene, const facet_pose_desc *pose,
                                               const facet_orbit *orbit, float aspect, facet_camera *camera,
                                               facet_error *error);
/* Camera number index of the file, where its first node of the pose's scene puts it. */
FACET_API facet_result facet_camera_from_scene(const facet_scene *scene, const facet_pose_desc *pose,
                                               uint32_t index, facet_camera *camera, facet_error *error);

/* ---- environments ---- */

typedef struct facet_environment facet_environment;

/* How a picture holds the sphere of directions. Faces are those of cube maps in Direct3D and OpenGL, +X -X +Y -Y +Z -Z, their
 * pictures as seen from inside with +Y up, except where said. */
typedef enum facet_layout {
    FACET_LAYOUT_AUTO,             /* by the ratio of the edges: 2:1, 4:3, 3:4, 6:1, 1:6 */
    FACET_LAYOUT_EQUIRECTANGULAR,  /* 2:1, as facet_environment_load() says */
    FACET_LAYOUT_CROSS_HORIZONTAL, /* 4:3, +Y above and -Y below the second of -X +Z +X -Z */
    FACET_LAYOUT_CROSS_VERTICAL,   /* 3:4, +Y, then -X +Z +X, then -Y, then -Z turned by half a turn */
    FACET_LAYOUT_STRIP_HORIZONTAL, /* 6:1, the faces from the left */
    FACET_LAYOUT_STRIP_VERTICAL,   /* 1:6, the faces from the top */
    FACET_LAYOUT_OCTAHEDRAL,       /* 1:1; +Y in the middle, -Y in the corners (Cigolle et al. 2014) */
    FACET_LAYOUT_FACES             /* six pictures; only where a cube map is written */
} facet_layout;

/* How an environment is read. {0}: with malloc, silently. */
typedef struct facet_environment_desc {
    facet_allocator allocator;
    facet_log log;
    uint32_t thread_count;    /* 0: facet_thread_count() */
    uint64_t max_file_bytes;  /* 0: 4 GiB */
    uint32_t max_size;        /* texels along an edge; 0: 32768 */
    const char *cache_folder; /* keep prepared lights there; NULL: no cache */
    uint64_t cache_bytes;     /* the most that the cache may hold; 0: 256 MiB */
    facet_layout layout; /* of the picture; {0}: found out. Files of cube maps (KTX2) say it themselves */
} facet_environment_desc;

/* Reads a picture (.hdr, .exr, or an 8-bit format, decoded from sRGB) in any of the layouts, or a cube map (.ktx2, level 0).
 * Equirectangular: the direction d (unit, +Y up) is at u = 0.5 + atan2(d.z, d.x) / 2pi from the left and v = acos(d.y) / pi
 * from the top, before rotation. Texels are cd/m^2. FACET_ERROR_INVALID: edges that are no layout; nearly 2:1 (to 5 %) is
 * stretched, with a warning. */
FACET_API facet_result facet_environment_load(const char *path, const facet_environment_desc *desc,
                                              facet_environment **environment, facet_error *error);
FACET_API facet_result facet_environment_load_memory(const void *bytes, size_t size, const char *name,
                                                     const facet_environment_desc *desc,
                                                     facet_environment **environment, facet_error *error);
/* The built-in neutral studio: soft boxes in a grey room, white on average. */
FACET_API facet_result facet_environment_create_studio(const facet_environment_desc *desc,
                                                       facet_environment **environment, facet_error *error);
/* The same radiance (cd/m^2, linear Rec.709) from everywhere. */
FACET_API facet_result facet_environment_create_constant(const float radiance[3],
                                                         const facet_environment_desc *desc,
                                                         facet_environment **environment, facet_error *error);
/* The light that the model brings for the pose's scene (EXT_lights_image_based). FACET_ERROR_ARGUMENT: it brings none;
 * see facet_scene_has_environment(). */
FACET_API facet_result facet_environment_create_from_scene(const facet_scene *scene,
                                                           const facet_pose_desc *pose,
                                                           const facet_environment_desc *desc,
                                                           facet_environment **environment,
                                                           facet_error *error);
FACET_API bool facet_scene_has_environment(const facet_scene *scene, const facet_pose_desc *pose);

/* Six pictures, faces +X -X +Y -Y +Z -Z. FACET_ERROR_INVALID: not square, or not of one size. */
FACET_API facet_result facet_environment_load_faces(const char *const paths[6],
                                                    const facet_environment_desc *desc,
                                                    facet_environment **environment, facet_error *error);
/* Radiance (cd/m^2, linear Rec.709) from zenith, horizon and nadir; between them linear in the height d.y of a direction. */
FACET_API facet_result facet_environment_create_gradient(const float zenith[3], const float horizon[3],
                                                         const float nadir[3],
                                                         const facet_environment_desc *desc,
                                                         facet_environment **environment, facet_error *error);

typedef enum facet_sky_model {
    FACET_SKY_MODEL_ATMOSPHERE, /* scattering of the Earth's atmosphere, all orders (Hillaire 2020) */
    FACET_SKY_MODEL_PREETHAM    /* the formula of Preetham, Shirley and Smits (1999) */
} facet_sky_model;

/* A clear sky by day. {0}: sun on the horizon towards +Z, standard air. */
typedef struct facet_sky_desc {
    facet_sky_model model;
    float
        sun_elevation_rad;  /* [-pi/2, pi/2]; Preetham's has no sun below the horizon: FACET_ERROR_ARGUMENT */
    float sun_azimuth_rad;  /* from +Z towards +X, as facet_orbit has it */
    float turbidity;        /* [1.7, 10], of the atmosphere from 1, no haze; 0: 2.5 */
    float ground_albedo[3]; /* [0, 1], seen below the horizon and, by the atmosphere, in the sky */
    float altitude_m;       /* of the eye above the ground, [0, 50 000]; the atmosphere only */
    bool omits_disc;        /* leaves the sun's disc out, not its light in the air */
    uint32_t height;        /* texels; 0: 512 */
    /* to which all is scaled, of the surface that gets most; less than 1 lx counts as 1. 0: units stay physical. pi:
     * white in this light has 1 cd/m^2 */
    float illuminance_lux;
} facet_sky_desc;

/* Texels are cd/m^2: some 10^4 for a blue sky, 10^9 for the sun. The disc's energy is that of the sun, spread over the
 * texels that it touches. */
FACET_API facet_result facet_environment_create_sky(const facet_sky_desc *sky,
                                                    const facet_environment_desc *desc,
                                                    facet_environment **environment, facet_error *error);

/* What an environment was made of. */
typedef struct facet_environment_info {
    facet_layout layout;
    uint32_t width, height; /* of the picture, or of a face where the layout is one of cube maps */
    /* that held NaN, infinity or less than 0: taken as 0, infinity as the largest number */
    uint64_t repaired_texels;
    double mean[3];     /* radiance over the sphere, cd/m^2 */
    float max_radiance; /* of any channel */
} facet_environment_info;
FACET_API facet_result facet_environment_get_info(const facet_environment *environment,
                                                  facet_environment_info *info, facet_error *error);

FACET_API void facet_environment_destroy(facet_environment *environment); /* NULL is allowed */

/* ---- rendering ---- */

typedef struct facet_image facet_image; /* what is drawn, and what files hold; see below */

typedef enum facet_quality { FACET_QUALITY_NORMAL, FACET_QUALITY_DRAFT, FACET_QUALITY_FINAL } facet_quality;

typedef enum facet_tonemap {
    FACET_TONEMAP_NONE, /* linear Rec.709; clamped when written to an 8- or 16-bit file */
    FACET_TONEMAP_NEUTRAL,
    FACET_TONEMAP_ACES,           /* Hill's fit of RRT and ODT */
    FACET_TONEMAP_ACES_NARKOWICZ, /* Narkowicz's curve */
    FACET_TONEMAP_AGX,
    FACET_TONEMAP_REINHARD,
    FACET_TONEMAP_REINHARD_EXTENDED, /* white point 4 */
    FACET_TONEMAP_HABLE
} facet_tonemap;

typedef enum facet_energy {
    FACET_ENERGY_GLTF,      /* the formulas of the glTF specification, comparable with Khronos' renderer */
    FACET_ENERGY_CONSERVING /* multiple scattering compensated, no surface returns more than it received */
} facet_energy;

/* The model of light and surfaces that a picture follows. */
typedef enum facet_shading {
    FACET_SHADING_GLTF, /* physically based, as glTF defines it */
    FACET_SHADING_OGL1 /* as OpenGL 1 did: the scene's legacy materials under its lights, without an environment */
} facet_shading;

/* Variants of FACET_SHADING_OGL1; docs/shading-model.md, "OpenGL 1". */
typedef enum facet_ogl1_variant {
    FACET_OGL1_VARIANT_VIGNETTE, /* per pixel, normals turned towards the eye, highlights without a gate */
    FACET_OGL1_VARIANT_WEBGL, /* rgl's present WebGL shader: normals turned where they point away from the view plane */
    FACET_OGL1_VARIANT_FIXED, /* fixed-function OpenGL 1: light at the vertices, on the side that the normals show, infinite
                            viewer, highlight only where light falls, global ambient light of 0.2 */
    FACET_OGL1_VARIANT_RGL_DESKTOP /* the same as rgl's windows set it up: both sides, local viewer, no global ambient light */
} facet_ogl1_variant;

/* {0}: vignette, as the display's numbers. */
typedef struct facet_ogl1_desc {
    facet_ogl1_variant variant;
    /* light is computed and surfaces are blended as linear light, without clamping; false: with the display's encoded
     * numbers, as then */
    bool is_linear;
    bool ignores_fog;
    /* FACET_OGL1_VARIANT_VIGNETTE: directional lights of the world are transformed as the vignette prints it, with w = 1,
     * which adds the camera's position; false: as is meant */
    bool translates_directions;
} facet_ogl1_desc;

/* How light is carried to the camera. */
typedef enum facet_renderer_kind {
    FACET_RENDERER_KIND_PREVIEW, /* one bounce of prefiltered light, no shadows: what real-time viewers show */
    FACET_RENDERER_KIND_PATH,    /* path tracing: unbiased but for what facet_path_desc says is not */
    FACET_RENDERER_KIND_GL /* as the preview, drawn with OpenGL; FACET_ERROR_SYSTEM where there is none */
} facet_renderer_kind;

/* Reconstruction filter of a pixel, sampled by importance: a sample belongs to one pixel. */
typedef enum facet_filter {
    FACET_FILTER_BLACKMAN_HARRIS, /* radius 1.5 px */
    FACET_FILTER_BOX,             /* 1 px wide: pixels share no samples */
    FACET_FILTER_MITCHELL         /* B = C = 1/3, radius 2 px; has negative lobes */
} facet_filter;

/* Which of the two ways to find light are taken; both are right alone, and noisy in different places. */
typedef enum facet_light_sampling {
    FACET_LIGHT_SAMPLING_MIS,  /* both, weighted by multiple importance sampling */
    FACET_LIGHT_SAMPLING_BSDF, /* light is met by chance; lights without size are never met and stay sampled */
    FACET_LIGHT_SAMPLING_LIGHTS /* light is aimed at, but for what mirrors show, which cannot be */
} facet_light_sampling;

/* What stands below the model. */
typedef enum facet_ground {
    FACET_GROUND_NONE,
    FACET_GROUND_SHADOW /* an unseen plane under the lowest point, of which only what the model takes from its light is
                           drawn: dark with opacity over what is behind. FACET_RENDERER_KIND_PREVIEW has none; that of
                           FACET_RENDERER_KIND_GL is a soft contact shadow */
} facet_ground;

/* A disc of uniform radiance at infinite distance. {0}: none. */
typedef struct facet_sun {
    float azimuth_rad;        /* around +Y; 0: from +Z, positive: towards +X, as facet_orbit's */
    float elevation_rad;      /* above the horizon */
    float illuminance_lux[3]; /* on a surface that faces it, linear Rec.709; 0: no sun */
    float diameter_rad;       /* 0: 0.53 deg, the real one's */
} facet_sun;

/* What FACET_RENDERER_KIND_PATH reads beside facet_render_desc. {0}: unbiased. */
typedef struct facet_path_desc {
    /* surfaces and scattering events that a path may have; 1: direct light only; 0: 64. What a longer path would
     * bring is missing */
    uint32_t max_depth;
    uint32_t seed; /* another one gives other noise */
    facet_filter filter;
    facet_light_sampling light_sampling;
    /* adaptive: a region is done when its standard error, relative to what a display shows of it, is below this;
     * samples is then the most. 0: all get as many */
    float noise;
    float clamp; /* biased: no indirect contribution to a sample above this (cd/m^2); 0: none */
    /* biased: light that is aimed at passes transmissive surfaces straight on, tinted; else only real paths find
     * light through them */
    bool has_straight_shadows;
    bool denoises;   /* biased: noise is filtered out under guidance of albedo and normal */
    float shutter_s; /* the picture is the mean over pose.time_s to time_s + shutter_s; 0: an instant */
    /* an .exr: what is drawn so far is kept there every checkpoint_interval_s, at the time limit, when cancelled, at
     * the end; where it cannot be written there is a warning, and has_lost_checkpoint. NULL: none. FACET_ERROR_ARGUMENT: one is there already, and resumes is false */
    const char *checkpoint_path;
    double checkpoint_interval_s; /* 0: 60 */
    /* goes on with the checkpoint, which has to be of the same picture (FACET_ERROR_ARGUMENT); where there is none it
     * starts */
    bool resumes;
    /* what is cancelled gives the image so far where each pixel has a sample (facet_render_stats.is_partial), as the
     * time limit does; false: FACET_ERROR_CANCELLED */
    bool keeps_cancelled;
    /* Told after passes, while there are more to come: the picture so far, which is gone when it returns, as it is with that
     * many samples; denoised ones, but for the shadow on the ground, at 2, 4, 8 .. samples. From a thread of the
     * renderer's. NULL: nobody */
    void (*pass)(void *pass_user, const facet_image *image, uint32_t samples);
    void *pass_user;
} facet_path_desc;

/* What of a surface is drawn. Those that are not light are not tone-mapped, and drawn over black. */
typedef enum facet_channel {
    FACET_CHANNEL_LIGHT,      /* all of it */
    FACET_CHANNEL_NORMAL,     /* unit shading normal in world space, (N + 1) / 2 */
    FACET_CHANNEL_BASE_COLOR, /* linear */
    FACET_CHANNEL_ROUGHNESS,  /* perceptual */
    FACET_CHANNEL_METALLIC,
    FACET_CHANNEL_OCCLUSION,
    FACET_CHANNEL_OPACITY,
    FACET_CHANNEL_NDOTV,
    FACET_CHANNEL_DIFFUSE, /* light of one lobe alone, as it is in the whole */
    FACET_CHANNEL_SPECULAR,
    FACET_CHANNEL_CLEARCOAT,
    FACET_CHANNEL_SHEEN,
    FACET_CHANNEL_TRANSMISSION, /* diffuse transmission too */
    FACET_CHANNEL_EMISSION,
    FACET_CHANNEL_FURNACE, /* light of 1 from everywhere in place of all other: 1 where no energy is lost or made */
    FACET_CHANNEL_COUNT
} facet_channel;

/* Formulas of the specular lobe, and of what is below it. */
typedef enum facet_brdf {
    FACET_BRDF_ENERGY,      /* as facet_energy has it: height-correlated Smith */
    FACET_BRDF_SCHLICK_GGX, /* separable masking, k = alpha / 2 (Karis 2013) */
    FACET_BRDF_MULTISCATTER /* height-correlated, with what is scattered several times, for FACET_ENERGY_GLTF too */
} facet_brdf;

/* In which order what light passes is laid over each other (Porter and Duff 1984). */
typedef enum facet_transparency {
    FACET_TRANSPARENCY_SORTED, /* triangles from back to front; wrong only where they cut through each other */
    FACET_TRANSPARENCY_PEELED,  /* each pixel's own order, up to 8 layers (Everitt 2001) */
    FACET_TRANSPARENCY_WEIGHTED /* no order (McGuire and Bavoil 2013): approximate, quickest */
} facet_transparency;

/* What FACET_RENDERER_KIND_GL reads beside facet_render_desc. {0}: as the preview. */
typedef struct facet_gl_desc {
    facet_channel channel;
    facet_brdf brdf;
    facet_transparency transparency;
    bool has_shadows; /* of punctual lights and the sun, by shadow maps; the preview has none */
    float bloom;      /* share of the light that is spread as by a lens, [0, 1]; 0: none */
} facet_gl_desc;

typedef enum facet_background {
    FACET_BACKGROUND_TRANSPARENT,
    FACET_BACKGROUND_COLOR,      /* background_color, as display-linear color behind the tone-mapped model */
    FACET_BACKGROUND_ENVIRONMENT /* the environment itself, tone-mapped with the model */
} facet_background;

/* Arbitrary output variables: layers beside the picture; or them. Each is that of the nearest surface under
 * the pixel's middle, not filtered; 0 where there is none (depth: infinity). With FACET_RENDERER_KIND_PATH normal and albedo
 * are the means over the pixel's samples, as denoisers want them: of what is behind mirrors and clear glass. */
typedef enum facet_aov {
    FACET_AOV_DEPTH = 1u << 0,       /* m along the camera's axis; 1 channel "Z" */
    FACET_AOV_NORMAL = 1u << 1,      /* unit shading normal in world space; 3 channels "normal.X" .. */
    FACET_AOV_ALBEDO = 1u << 2,      /* base color, linear; 3 channels "albedo.R" .. */
    FACET_AOV_MATERIAL_ID = 1u << 3, /* index of the material plus 1; 1 channel "material.id" */
    FACET_AOV_UV = 1u << 4,          /* TEXCOORD_0; 2 channels "uv.U", "uv.V" */
    FACET_AOV_OCCLUSION = 1u << 5,   /* occlusion texture, 1: open; 1 channel "occlusion.A" */
    /* FACET_RENDERER_KIND_PATH only: */
    /* of the mean that a pixel is, estimated per channel, in the picture's unit squared; 3 channels "variance.R" .. */
    FACET_AOV_VARIANCE = 1u << 6,
    FACET_AOV_SAMPLES = 1u << 7, /* light samples in the pixel; 1 channel "samples.N" */
    /* Every renderer: */
    FACET_AOV_OBJECT_ID = 1u << 8, /* index of the node plus 1; 1 channel "object.id" */
    /* number of the copy, from 1, among all copies of all nodes with a mesh (EXT_mesh_gpu_instancing draws several of a
     * node); 1 channel "instance.id" */
    FACET_AOV_INSTANCE_ID = 1u << 9,
    /* Cryptomatte 1.2.0, of the names of nodes, of materials, of instances ("NODE#NUMBER"): the six IDs that cover most of a
     * pixel, each with its share of the pixel, in 3 layers "CryptoObject00" .. "02" of 4 channels, ID, share, ID, share. The
     * shares add up to the image's opacity (OpenGL: of the nearest surfaces of 16 samples). The manifest and what else
     * Cryptomatte needs is in the metadata of an .exr. FACET_RENDERER_KIND_PATH: not together with path.resumes, and complete
     * in the final image only */
    FACET_AOV_CRYPTO_OBJECT = 1u << 10,
    FACET_AOV_CRYPTO_MATERIAL = 1u << 11,
    FACET_AOV_CRYPTO_INSTANCE = 1u << 12,
    FACET_AOV_CRYPTOMATTE = FACET_AOV_CRYPTO_OBJECT | FACET_AOV_CRYPTO_MATERIAL | FACET_AOV_CRYPTO_INSTANCE
} facet_aov;

/* Instruction set of the kernels that intersect rays with triangles, on x86-64; elsewhere there is one. Those of AVX2 and
 * AVX-512 use fused multiply-adds, which round otherwise: a few pixels of an image differ by a code. Fails with
 * FACET_ERROR_SYSTEM where the processor lacks the one that is named. */
typedef enum facet_isa {
    FACET_ISA_PORTABLE, /* the widest without fused multiply-adds: SSE2, SSE4.2 and AVX give the same bytes */
    FACET_ISA_NATIVE,   /* the widest of this processor: previews take 7 to 19 % less time */
    FACET_ISA_SSE2,
    FACET_ISA_SSE4_2,
    FACET_ISA_AVX,
    FACET_ISA_AVX2,
    FACET_ISA_AVX512
} facet_isa;

/* How facet_render() draws. {0}: 1024 x 768, the whole model in its own lights only, transparent, linear. */
typedef struct facet_render_desc {
    facet_allocator allocator;
    facet_log log;
    facet_progress progress;
    uint32_t thread_count;          /* 0: facet_thread_count(); the picture does not depend on it */
    uint32_t width, height;         /* pixels; 0: 1024 x 768 */
    uint32_t crop[4];               /* x, y, width, height of the part to draw; {0}: all */
    facet_pose_desc pose;           /* what of the scene, and when */
    const facet_camera *camera;     /* NULL: facet_orbit_default() */
    facet_environment *environment; /* NULL: none, black */
    float environment_rotation_rad; /* around +Y, positive turns the light from +Z towards +X */
    float environment_ev;           /* stops; the environment is scaled by 2^environment_ev */
    bool ignores_scene_lights;      /* true: no KHR_lights_punctual, nor lights of legacy materials' files */
    facet_background background;
    float background_color[3]; /* linear Rec.709, [0, 1] */
    float background_blur;     /* perceptual roughness of the environment seen as background, [0, 1] */
    facet_sun sun;
    facet_ground ground;
    facet_renderer_kind renderer;
    facet_path_desc path;
    facet_gl_desc gl;
    facet_quality quality;
    /* per pixel; 0: as quality has it. Preview: of visibility, draft 1, normal 4, final 16, at most 4096. Path: of
     * light, draft 16, normal 64, final 512, at most 2^24 */
    uint32_t samples;
    facet_energy energy;
    /* FACET_SHADING_OGL1: FACET_ERROR_ARGUMENT without legacy materials, and for the environment as background; its
     * picture is made for FACET_TONEMAP_NONE */
    facet_shading shading;
    facet_ogl1_desc ogl1;
    /* widen highlights by how much normals turn within a pixel (Kaplanyan and Tokuyoshi 2019): fewer sparkles, and no
     * longer what real-time viewers show */
    bool has_specular_antialiasing;
    /* decode textures in full where a part of their texels would do: the mips of a JPEG that is decoded at half size
     * are not quite those of the whole. Slower; path tracing and OpenGL do it always */
    bool decodes_whole_textures;
    facet_isa isa;
    float exposure_ev; /* stops; radiance is scaled by 2^exposure_ev before tone mapping */
    /* facet_render() and facet_renderer_render(): exposure_ev is added to what facet_renderer_meter() reads of this image */
    bool meters_exposure;
    facet_tonemap tonemap;
    uint32_t aovs; /* facet_aov or-ed */
    /* 0: none; past it FACET_ERROR_LIMIT. FACET_RENDERER_KIND_PATH gives what it has, unless that is not a sample for
     * each pixel */
    double time_limit_s;
} facet_render_desc;

/* Renders on the CPU with prefiltered light: what real-time viewers show. The image has the layer "" (RGBA,
 * float, linear, premultiplied) and one layer per AOV. */
FACET_API facet_result facet_render(const facet_scene *scene, const facet_render_desc *desc,
                                    facet_image **image, facet_error *error);

/* Renders several pictures of one scene: frames, views. What stays the same from one to the next (textures, tangents,
 * hierarchies of what does not move) is kept. Each picture is that of facet_render(), to the last bit. The scene must
 * outlive the renderer; one picture at a time. */
typedef struct facet_renderer facet_renderer;
FACET_API facet_result facet_renderer_create(const facet_scene *scene,
                                             const facet_allocator *allocator /* NULL: {0} */,
                                             facet_renderer **renderer, facet_error *error);
/* desc->allocator serves the picture only. */
FACET_API facet_result facet_renderer_render(facet_renderer *renderer, const facet_render_desc *desc,
                                             facet_image **image, facet_error *error);
FACET_API void facet_renderer_destroy(facet_renderer *renderer); /* NULL is allowed */

/* What a camera's light meter reads of that image, whatever renderer desc has: EV at ISO 100 that brings the log-average of the
 * luminance of what is seen (the model, and the environment where it is the background) to 0.22 of white, as facet_sea_meter() does;
 * facet_exposure_from_ev100() makes an exposure_ev of it. A small preview is metered, without shadows and light between surfaces,
 * so that all renderers have the same exposure. Sequences are best metered once, as their frames would flicker. Where nothing is
 * seen, or all is black, the exposure is 0 and desc's log gets a warning. Fails as facet_render(); FACET_ERROR_ARGUMENT for
 * FACET_SHADING_OGL1, whose numbers are a display's. */
FACET_API facet_result facet_renderer_meter(facet_renderer *renderer,
                                            const facet_render_desc *desc /* NULL: {0} */, double *ev100,
                                            facet_error *error);

/* Seconds that the stages of the facet_render() that made an image took, and the work done. */
typedef struct facet_render_stats {
    double textures_s, geometry_s, light_s, shade_s, total_s; /* geometry: tangents and BVH; stages overlap */
    uint64_t rays, shades, decoded_texels;
    uint32_t thread_count;
    /* FACET_RENDERER_KIND_PATH: */
    uint64_t samples;         /* light samples that the picture is the mean of, over all pixels */
    uint64_t dropped_samples; /* not finite, counted as black: a NaN in the model, or a fault */
    bool has_lost_checkpoint; /* the checkpoint that was wanted at the end could not be written */
    bool is_partial; /* the time limit, or keeps_cancelled, came before the samples or the noise asked for */
    double denoise_s;
} facet_render_stats;
FACET_API facet_render_stats facet_image_get_render_stats(const facet_image *image);

/* ---- images ---- */

/* A layer of an image, as long as the image lives. */
typedef struct facet_image_view {
    const char *name; /* "": the picture itself */
    uint32_t width, height, channel_count;
    const float *pixels; /* channel_count floats per texel */
    size_t row_stride_bytes;
} facet_image_view;

FACET_API uint32_t facet_image_get_layer_count(const facet_image *image);
FACET_API facet_image_view facet_image_get_layer(const facet_image *image, uint32_t layer);
FACET_API void facet_image_destroy(facet_image *image); /* NULL is allowed */

/* Developed pictures of one size side by side, row by row, as they are for a display. {0}: as square as it goes, no labels. */
typedef struct facet_contact_sheet_desc {
    facet_allocator allocator;
    facet_log log;
    uint32_t column_count; /* 0: as many as make it square */
    uint32_t gap;          /* pixels between pictures; 0: 4 */
    const char *const *
        labels; /* UTF-8, one per picture, below it; NULL: none. Without cairo they are left out, with a warning */
} facet_contact_sheet_desc;
/* FACET_ERROR_ARGUMENT: sizes differ, or the sheet is larger than 65536 pixels; _MEMORY. */
FACET_API facet_result facet_image_create_sheet(const facet_image *const *images, uint32_t count,
                                                const facet_contact_sheet_desc *desc /* NULL: {0} */,
                                                facet_image **sheet, facet_error *error);

/* How a picture is read from a file. {0}: with malloc, all threads. */
typedef struct facet_image_load_desc {
    facet_allocator allocator;
    uint32_t thread_count;   /* 0: facet_thread_count() */
    uint64_t max_file_bytes; /* 0: 4 GiB; larger files are refused */
    uint32_t max_size;       /* pixels along an edge; 0: 16384; larger pictures are refused */
    /* of an OpenEXR file: "albedo", "normal", "depth" ..; its channels become R, G, B, opacity, one all three, of two
     * the third is 0. NULL: the picture */
    const char *layer;
    facet_log log; /* what the file asks for and does not get; conversions of color */
} facet_image_load_desc;

/* Reads a PNG, JPEG, WebP, AVIF, KTX2, TGA, BMP, GIF, DDS, Radiance HDR, OpenEXR or PFM file, told apart by content, into
 * layer "" as facet_render() makes it: RGBA, float, linear Rec.709, premultiplied, rows from the top. Numbers of files for
 * displays are decoded from sRGB (profiles are ignored) and multiplied by alpha; those of HDR, EXR, PFM and float KTX2 files
 * stay, NaN and infinity among them; those of an EXR or HDR file with other primaries are converted to Rec.709. Alpha that
 * a file lacks is 1. */
FACET_API facet_result facet_image_load(const char *path, const facet_image_load_desc *desc /* NULL: {0} */,
                                        facet_image **image, facet_error *error);
/* The same from memory, which may go afterwards. name stands for the file in messages. */
FACET_API facet_result facet_image_load_memory(const void *bytes, size_t size, const char *name,
                                               const facet_image_load_desc *desc, facet_image **image,
                                               facet_error *error);
/* A picture from pixels of one's own, which are copied: linear Rec.709, RGBA premultiplied, or RGB, or grey; row stride 0:
 * rows without padding. The view's name is ignored. */
FACET_API facet_result facet_image_create(const facet_image_view *pixels,
                                          const facet_allocator *allocator /* NULL: {0} */,
                                          facet_image **image, facet_error *error);
/* A layer of IDs ("object", "material" or "instance") of a rendered image in false color: in an 8-bit RGB file the color is
 * 0x3779b1 times the number, modulo 2^24, as 0xRRGGBB, which is another one for each number. Transparent where nothing is.
 * FACET_ERROR_ARGUMENT: the image lacks that layer, or "instance", which tells where something is. */
FACET_API facet_result facet_image_create_id_colors(const facet_image *image, const char *layer,
                                                    const facet_allocator *allocator /* NULL: {0} */,
                                                    facet_image **colors, facet_error *error);
/* Whether the picture was read from a file for displays (integers, sRGB): its colors are those of a screen, [0, 1], rather
 * than light. */
FACET_API bool facet_image_is_for_display(const facet_image *image);

/* One channel of a color as files and style sheets write it (sRGB, [0, 1]) to linear light: IEC 61966-2-1. */
FACET_API float facet_linear_from_srgb(float encoded);

typedef enum facet_image_format {
    FACET_IMAGE_FORMAT_FROM_NAME, /* by the extension of the path */
    FACET_IMAGE_FORMAT_PNG,       /* 8 bits, sRGB, straight alpha */
    FACET_IMAGE_FORMAT_PNG16,
    FACET_IMAGE_FORMAT_JPEG, /* no alpha: over white */
    FACET_IMAGE_FORMAT_WEBP,
    FACET_IMAGE_FORMAT_EXR, /* half; all layers, premultiplied alpha */
    FACET_IMAGE_FORMAT_EXR_FLOAT,
    FACET_IMAGE_FORMAT_HDR, /* Radiance RGBE; no alpha: over black, as in PFM */
    FACET_IMAGE_FORMAT_PFM,
    FACET_IMAGE_FORMAT_RAW /* bare RGBA of 8 bits, sRGB, straight alpha: rows from the top, no header */
} facet_image_format;

typedef struct facet_image_save_desc {
    facet_allocator allocator;
    uint32_t thread_count; /* 0: facet_thread_count() */
    facet_image_format format;
    uint32_t jpeg_quality;    /* 1 to 100; 0: 92; also for WebP, where 100 is lossless */
    uint32_t png_compression; /* 1 (fast) to 9 (small); 0: 4 */
} facet_image_save_desc;

/* Writes the whole file or nothing: to a temporary beside it, then renamed. */
FACET_API facet_result facet_image_save(const facet_image *image, const char *path,
                                        const facet_image_save_desc *desc, facet_error *error);
/* The bytes that facet_image_save() would write, for a format that is named. Release with
 * facet_bytes_destroy(). */
FACET_API facet_result facet_image_encode(const facet_image *image, const facet_image_save_desc *desc,
                                          unsigned char **bytes, size_t *size, facet_error *error);
FACET_API void facet_bytes_destroy(unsigned char *bytes);
/* Writes bytes to path as facet_image_save() does: the whole file or nothing. */
FACET_API facet_result facet_bytes_save(const void *bytes, size_t size, const char *path, facet_error *error);

/* ---- baking: environments filtered for real-time renderers ---- */

typedef enum facet_lobe {
    FACET_LOBE_GGX,     /* reflections: the environment convolved with D N.l for N = V = R (Karis 2013) */
    FACET_LOBE_CHARLIE, /* the same for sheen (Estevez and Kulla 2017) */
    FACET_LOBE_LAMBERT, /* irradiance / pi: what a white diffuse surface sends out; one level */
    FACET_LOBE_NONE     /* the environment itself; levels are means over texels */
} facet_lobe;

/* Which perceptual roughness level k of n is for. */
typedef enum facet_roughness_mapping {
    FACET_ROUGHNESS_MAPPING_LINEAR,  /* k / (n - 1): Khronos' viewer */
    FACET_ROUGHNESS_MAPPING_FILAMENT /* 1 - sqrt(1 - k / (n - 1)), so that k = (n - 1) r (2 - r): Filament */
} facet_roughness_mapping;

typedef enum facet_bake_method {
    FACET_BAKE_METHOD_AUTO, /* harmonics where the lobe is wide enough for them, sampling where it is narrower */
    FACET_BAKE_METHOD_SAMPLING, /* filtered importance sampling (Krivanek and Colbert 2008) */
    FACET_BAKE_METHOD_REFERENCE /* every texel of the environment weighted, which is slow: what the others are measured against */
} facet_bake_method;

enum { FACET_CUBE_MAX_LEVELS = 14 };

/* {0}: GGX, 256 texels, levels down to 16 texels. */
typedef struct facet_bake_desc {
    facet_allocator allocator;
    facet_progress progress;
    uint32_t thread_count; /* 0: facet_thread_count(); the texels do not depend on it */
    facet_lobe lobe;
    uint32_t size; /* texels along an edge of level 0, [1, 8192], a power of two; 0: 256; Lambert 64 */
    /* 0: down to 16 texels, but five where there are as many; Lambert: 1. At most log2(size) + 1 */
    uint32_t level_count;
    facet_roughness_mapping mapping;
    facet_bake_method method;
    uint32_t samples;   /* per texel, of sampling; 0: 1024 */
    float rotation_rad; /* of the environment around +Y, as facet_render_desc.environment_rotation_rad */
    float ev;           /* stops: radiance is scaled by 2^ev */
    /* radiance (before ev) is cut off here, which loses light: facet_bake_stats tells how much. 0: not */
    float clamp;
} facet_bake_desc;

typedef struct facet_bake_stats {
    double total_s;
    uint64_t samples;     /* light looked up, all levels together */
    double clamped_share; /* of the environment's mean radiance that desc->clamp took, [0, 1] */
} facet_bake_stats;

/* A cube map with levels: linear Rec.709 radiance, F32. */
typedef struct facet_cube facet_cube;

/* FACET_ERROR_ARGUMENT, _MEMORY, _LIMIT, _CANCELLED. */
FACET_API facet_result facet_cube_bake(facet_environment *environment,
                                       const facet_bake_desc *desc /* NULL: {0} */, facet_cube **cube,
                                       facet_error *error);
FACET_API void facet_cube_destroy(facet_cube *cube); /* NULL is allowed */
FACET_API uint32_t facet_cube_get_level_count(const facet_cube *cube);
FACET_API uint32_t facet_cube_get_size(const facet_cube *cube, uint32_t level);
FACET_API float facet_cube_get_roughness(const facet_cube *cube,
                                         uint32_t level); /* perceptual; Lambert 1, none 0 */
/* RGBX: 4 floats per texel, the last one undefined. face: +X -X +Y -Y +Z -Z. */
FACET_API facet_image_view facet_cube_get_face(const facet_cube *cube, uint32_t level, uint32_t face);
FACET_API facet_bake_stats facet_cube_get_stats(const facet_cube *cube);

/* How far a level is from the reference, over the texels that were looked at and their channels. */
typedef struct facet_cube_error {
    double rms, max; /* of |texel - reference|; relative to the root mean square of the reference */
    double energy;   /* mean radiance of the level over that of the environment; 1 where nothing is lost */
    uint32_t texels; /* that were looked at: all of small levels, a fixed choice of large ones */
} facet_cube_error;
/* errors: one per level. desc: as the cube was baked. */
FACET_API facet_result facet_cube_verify(const facet_cube *cube, facet_environment *environment,
                                         const facet_bake_desc *desc, facet_cube_error *errors,
                                         facet_error *error);

/* A level as one picture of RGBA with opacity 1, transparent where a cross has no face; not FACET_LAYOUT_FACES. height: of
 * equirectangular and octahedral pictures; 0: twice the level's size. */
FACET_API facet_result facet_cube_unfold(const facet_cube *cube, uint32_t level, facet_layout layout,
                                         uint32_t height, const facet_allocator *allocator /* NULL: {0} */,
                                         facet_image **image, facet_error *error);
/* One face as a picture. */
FACET_API facet_result facet_cube_copy_face(const facet_cube *cube, uint32_t level, uint32_t face,
                                            const facet_allocator *allocator /* NULL: {0} */,
                                            facet_image **image, facet_error *error);

/* Texels of KTX2 files, by the names of Vulkan's formats. */
typedef enum facet_texel_format {
    FACET_TEXEL_FORMAT_RGBA16F,
    FACET_TEXEL_FORMAT_RGBA32F,
    FACET_TEXEL_FORMAT_RGB9E5,    /* E5B9G9R9_UFLOAT_PACK32 */
    FACET_TEXEL_FORMAT_B10G11R11, /* B10G11R11_UFLOAT_PACK32 */
    FACET_TEXEL_FORMAT_RG16F,
    FACET_TEXEL_FORMAT_RG32F,
    FACET_TEXEL_FORMAT_R16F,
    FACET_TEXEL_FORMAT_R32F
} facet_texel_format;

typedef struct facet_ktx2_desc {
    facet_allocator allocator;
    uint32_t thread_count; /* 0: facet_thread_count(); the bytes do not depend on it */
    facet_texel_format format;
    /* supercompression: 1 to 19; 0: none. FACET_ERROR_UNSUPPORTED where facet was built without Zstandard */
    uint32_t zstd_level;
} facet_ktx2_desc;

/* A KTX 2.0 file; facet_bytes_destroy(). What a format cannot hold becomes its largest number. */
FACET_API facet_result facet_cube_encode_ktx2(const facet_cube *cube, const facet_ktx2_desc *desc,
                                              unsigned char **bytes, size_t *size, facet_error *error);
typedef struct facet_ktx1_desc {
    facet_allocator allocator;
    uint32_t thread_count; /* 0: facet_thread_count(); the bytes do not depend on it */
    const float (
        *harmonics)[3]; /* nine of FACET_SH_FORM_FOLDED, kept as text under the key "sh"; NULL: none */
} facet_ktx1_desc;

/* A KTX 1 file with texels R11F_G11F_B10F, as Filament's cmgen writes and its loaders of light want them; facet_bytes_destroy(). */
FACET_API facet_result facet_cube_encode_ktx1(const facet_cube *cube, const facet_ktx1_desc *desc,
                                              unsigned char **bytes, size_t *size, facet_error *error);
/* The same with x turned around: what is at (x, y, z) is at (-x, y, z), where three.js looks up the cube maps that it did not
 * render itself. */
FACET_API facet_result facet_cube_create_mirrored(const facet_cube *cube,
                                                  const facet_allocator *allocator /* NULL: {0} */,
                                                  facet_cube **mirrored, facet_error *error);
/* Layer "" of a picture as a 2D texture of one level. */
FACET_API facet_result facet_image_encode_ktx2(const facet_image *image, const facet_ktx2_desc *desc,
                                               unsigned char **bytes, size_t *size, facet_error *error);
/* Radiance in 8 bits: RGB = value / (M range), M = alpha = ceil(255 max / range) / 255, straight, no transfer function (RGBM;
 * Karis 2009; three.js' RGBMToLinear()). A PNG file: facet_image_save() would apply sRGB, so this encodes by itself. range: the
 * largest value, above 0; what is above becomes range. FACET_ERROR_ARGUMENT, _MEMORY. */
FACET_API facet_result facet_image_encode_rgbm(const facet_image *image, float range,
                                               const facet_image_save_desc *desc, unsigned char **bytes,
                                               size_t *size, facet_error *error);

/* Tables of reflectance over N.V (x) and perceptual roughness (y), both at texel middles (i + 0.5) / size, rows from
 * roughness 0. */
typedef enum facet_dfg_kind {
    FACET_DFG_KIND_SCHLICK, /* R, G: scale and bias of F0, Schlick's masking with k = alpha / 2 (Karis 2013) */
    FACET_DFG_KIND_CORRELATED, /* R, G: the same, height-correlated Smith (Heitz 2014) */
    FACET_DFG_KIND_MULTISCATTER, /* R: integral of Fc, G: of 1, height-correlated: Filament's layout for energy compensation */
    FACET_DFG_KIND_CHARLIE, /* R: albedo of sheen, Charlie with its own masking (Estevez and Kulla 2017) */
    FACET_DFG_KIND_CHARLIE_NEUBELT, /* R: the same with Neubelt's masking, which Filament and Khronos' lookup have */
    FACET_DFG_KIND_GGX_AVERAGE, /* R: albedo of GGX averaged over the cosine, of roughness alone: every column is the same */
    FACET_DFG_KIND_FILAMENT /* R, G: as MULTISCATTER, B: as CHARLIE_NEUBELT: what Filament loads */
} facet_dfg_kind;

typedef struct facet_dfg_desc {
    facet_allocator allocator;
    facet_progress progress;
    uint32_t thread_count; /* 0: facet_thread_count() */
    facet_dfg_kind kind;
    uint32_t size; /* [16, 1024]; 0: 128 */
} facet_dfg_desc;

/* Layer "": RGBA, what the kind does not have is 0, alpha 1. By quadrature: errors below 1e-5, and below
 * 1e-4 of values above 4, which smooth sheen has at grazing angles. */
FACET_API facet_result facet_dfg_bake(const facet_dfg_desc *desc, facet_image **image, facet_error *error);
/* Channels that the kind has: 1, 2 or 3. */
FACET_API uint32_t facet_dfg_get_channel_count(facet_dfg_kind kind);

/* What nine spherical harmonics of an environment stand for; order 00, 1-1, 10, 11, 2-2, 2-1, 20, 21, 22 of the real basis
 *   Y = 0.282095, 0.488603 (y, z, x), 1.092548 (x y, y z), 0.315392 (3 z^2 - 1), 1.092548 x z, 0.546274 (x^2 - y^2)
 * without Condon and Shortley's sign; x, y, z of the direction in the world, right-handed, +Y up. Engines take them so:
 *   three.js   RADIANCE as LightProbe.sh.coefficients: same basis, order, axes; its shaders apply A_l. An equirectangular
 *              picture lies on the world as in scene.environment: no rotation. (Its LightProbeGenerator makes the same numbers.)
 *   Filament   FOLDED as IndirectLight::Builder::irradiance(3, sh), which are what cmgen --sh-shader and --deploy print and
 *              write. IndirectLight::Builder::radiance() and cmgen --sh without --sh-shader have Condon and Shortley's sign:
 *              RADIANCE and IRRADIANCE with 1-1, 11, 2-1, 21 negated. cmgen puts a picture's middle column at +Z: rotation_rad
 *              -pi / 2 gives its numbers. It windows unless told --sh-window no.
 *   Khronos    IRRADIANCE as irradianceCoefficients of EXT_lights_image_based (Babylon.js reads 1-1, 11, 2-1, 21 negated).
 *              Khronos' viewer takes no harmonics but a cube map: FACET_LOBE_LAMBERT. */
typedef enum facet_sh_form {
    FACET_SH_FORM_RADIANCE,   /* L_lm = integral of L Y_lm */
    FACET_SH_FORM_IRRADIANCE, /* E_lm = A_l L_lm, A = pi, 2 pi / 3, pi / 4 (Ramamoorthi and Hanrahan 2001) */
    FACET_SH_FORM_FOLDED /* irradiance / pi, the basis' constants folded in: sum of c times 1, y, z, x, xy, yz, 3z^2 - 1, zx,
                       x^2 - y^2: Filament's "pre-scaled" */
} facet_sh_form;

typedef struct facet_sh_desc {
    facet_allocator allocator;
    uint32_t thread_count;
    facet_sh_form form;
    float rotation_rad, ev, clamp; /* as facet_bake_desc */
    /* lowers bands 1 and 2, all channels alike, as little as leaves the irradiance nowhere below 0 (Sloan 2017):
     * rings around a sun go */
    bool is_windowed;
} facet_sh_desc;
/* desc NULL: {0}. FACET_ERROR_ARGUMENT, _MEMORY. */
FACET_API facet_result facet_environment_project_sh(const facet_environment *environment,
                                                    const facet_sh_desc *desc, float coefficients[9][3],
                                                    facet_error *error);

/* A sheet to look at: levels unfolded, spheres of eight roughnesses lit by the cube beside the same lit by the reference, and the
 * diffuse sphere by nine harmonics beside the exact one; tone-mapped, opaque. */
typedef struct facet_sheet_desc {
    facet_allocator allocator;
    facet_progress progress;
    uint32_t thread_count;
    facet_bake_desc bake; /* as the cube was baked */
    facet_tonemap tonemap;
    float exposure_ev;
} facet_sheet_desc;
FACET_API facet_result facet_cube_draw_sheet(const facet_cube *cube, facet_environment *environment,
                                             const facet_sheet_desc *desc, facet_image **image,
                                             facet_error *error);

/* ---- the shading text ---- */

/* Names of functions in GLSL. */
typedef enum facet_shader_names {
    FACET_SHADER_NAMES_FACET,
    /* beside them those of Khronos' Sample Viewer, with its arguments: V_GGX, BRDF_lambertian, Schlick_to_F0, ..; they come
     * with the parts that they use. D_Charlie is the viewer's then */
    FACET_SHADER_NAMES_KHRONOS
} facet_shader_names;

/* GLSL of the functions that facet itself shades with (shade/): what other renderers put before their own shaders. */
typedef struct facet_shader_desc {
    facet_allocator allocator;
    /* a line "#version ..": "300 es" to "320 es", "330" to "460", also "330 core"; NULL: no such line */
    const char *version;
    const char *const *parts; /* facet_shader_get_part_name()s; they come with all that they use */
    /* 0: all parts; with FACET_SHADER_NAMES_KHRONOS those that these names use */
    uint32_t part_count;
    facet_shader_names names;
} facet_shader_desc;

/* Functions, structures and macros without main(); one unit of text that any stage may begin with. Release with
 * facet_bytes_destroy(); the 0 behind the bytes is not counted. FACET_ERROR_ARGUMENT, _MEMORY. */
FACET_API facet_result facet_shader_text(const facet_shader_desc *desc /* NULL: {0} */, unsigned char **bytes,
                                         size_t *size, facet_error *error);
FACET_API uint32_t facet_shader_get_part_count(void);
FACET_API const char *facet_shader_get_part_name(uint32_t index); /* "fresnel"; NULL: there is none */

/* ---- plots ---- */

typedef enum facet_plot_kind {
    FACET_PLOT_KIND_LEGACY, /* PBR and OpenGL 1 over the angle of the light, the best fit, their difference (Murdoch's
                              vignette "Shininess in OpenGL 1 versus glTF PBR", and what it lacked) */
    FACET_PLOT_KIND_BRDF,       /* the lobes in the plane of incidence, as polar slices */
    FACET_PLOT_KIND_SLICE,      /* the same over the angle of the light, as curves */
    FACET_PLOT_KIND_HEMISPHERE, /* over all directions of the light, in false color */
    FACET_PLOT_KIND_LOBE,       /* over all directions, as a surface in space */
    FACET_PLOT_KIND_TERMS,      /* D, V and F over their cosines */
    FACET_PLOT_KIND_ALBEDO,     /* directional albedo over the angle of the view */
    FACET_PLOT_KIND_FURNACE,    /* what a surface returns of light from everywhere, over roughness */
    FACET_PLOT_KIND_DFG,        /* the tables of split-sum light */
    FACET_PLOT_KIND_TONE,       /* tone mapping: display over scene light */
    FACET_PLOT_KIND_FRESNEL,    /* of water and other media over the angle, exact beside Schlick's */
    FACET_PLOT_KIND_ERROR       /* error of the fits between the models over roughness */
} facet_plot_kind;

typedef enum facet_plot_model {
    FACET_PLOT_MODEL_PBR,
    FACET_PLOT_MODEL_OGL1,
    FACET_PLOT_MODEL_MERL
} facet_plot_model;

/* A material to plot; start from facet_plot_material_default(). Colors linear, [0, 1]. */
typedef struct facet_plot_material {
    const char *label; /* NULL: made of what it is */
    facet_plot_model model;
    /* FACET_PLOT_MODEL_PBR, the parameters of glTF */
    float base_color[3], metallic, perceptual_roughness;          /* 1; 0; 0.5 */
    float ior, specular, specular_color[3];                       /* 1.5; 1; 1 */
    float clearcoat, clearcoat_roughness;                         /* 0 */
    float sheen_color[3], sheen_roughness;                        /* 0 */
    float anisotropy, anisotropy_rotation_rad;                    /* 0 */
    float iridescence, iridescence_ior, iridescence_thickness_nm; /* 0; 1.3; 400 */
    /* FACET_PLOT_MODEL_OGL1 */
    float diffuse[3], ogl1_specular[3], shininess; /* 0.8; 1; 50 */
    const char *path; /* FACET_PLOT_MODEL_MERL: a measured BRDF in the format of Matusik et al. 2003 */
} facet_plot_material;
FACET_API facet_plot_material facet_plot_material_default(void);
/* A material of a scene, as far as it is one number for the whole surface: its factors, without textures. The legacy
 * one where model is FACET_PLOT_MODEL_OGL1. */
FACET_API facet_result facet_plot_material_from_scene(const facet_scene *scene, uint32_t material,
                                                      facet_plot_model model, facet_plot_material *out,
                                                      facet_error *error);

typedef enum facet_plot_format {
    FACET_PLOT_FORMAT_SVG,
    FACET_PLOT_FORMAT_PDF,
    FACET_PLOT_FORMAT_PNG,
    FACET_PLOT_FORMAT_CSV /* the numbers that are drawn; needs no graphics library */
} facet_plot_format;

enum { FACET_PLOT_MAX_MATERIALS = 16, FACET_PLOT_MAX_ANGLES = 8 };

/* What the fit beside a material is. */
typedef struct facet_plot_fit {
    bool is_found;              /* false: there is no such material, or the kind shows no fits */
    char name[96];              /* of the material, as it is drawn */
    char description[160];      /* of the fit: "metal (1, 0.77, 0.34), diffuse 0.02, roughness 0.3" */
    facet_plot_material fitted; /* label: NULL */
    bool is_of_measured;        /* log_rms is its error; else the three below */
    /* over all directions, relative to the RMS of the material, as conversions report them (docs/legacy.md) */
    float E, E_display, E_drawn;
    float log_rms; /* RMS of the difference of log(1 + f cos) over that of the measured values */
} facet_plot_fit;

/* What is plotted, and how. {0}: the vignette with its own values. */
typedef struct facet_plot_desc {
    facet_allocator allocator;
    uint32_t thread_count; /* 0: facet_thread_count() */
    facet_plot_kind kind;
    uint32_t material_count; /* at most FACET_PLOT_MAX_MATERIALS; 0: what suits the kind */
    const facet_plot_material *materials;
    /* of the view; at most FACET_PLOT_MAX_ANGLES; 0: 30 degrees, or what suits the kind */
    uint32_t angle_count;
    const float *angles_rad; /* from the normal, [0, pi/2) */
    bool has_heaviside_ramp; /* FACET_PLOT_KIND_LEGACY: the vignette's max(x, 0) where glTF has a step */
    /* masking and shadowing independent, as the vignette has it; false: height-correlated */
    bool has_separable_smith;
    bool has_fit; /* the best fit of the other model beside each material; MERL: of PBR */
    facet_plot_fit *
        fits; /* has_fit: FACET_PLOT_MAX_MATERIALS of them, filled by number of the material; NULL: not wanted */
    bool is_logarithmic; /* the axis of values */
    bool has_cosine;     /* BRDF times the light's cosine, where a kind shows a BRDF */
    bool
        has_shared_scale; /* FACET_PLOT_KIND_BRDF: one scale for all lobes of all views; false: each over its own peak */
    facet_energy energy;
    const char *title;      /* NULL: of the kind; "": none */
    uint32_t width, height; /* pixels, or 1/96 inch; 0: 960 x 640 or what suits the kind */
    bool is_dark;           /* light lines on dark */
} facet_plot_desc;

/* The file's bytes; facet_bytes_destroy(). FACET_ERROR_SYSTEM: the graphics library is not there (CSV does without).
 * FACET_ERROR_READ, _INVALID: of a measured BRDF. */
FACET_API facet_result facet_plot_encode(const facet_plot_desc *desc, facet_plot_format format,
                                         unsigned char **bytes, size_t *size, facet_error *error);

/* ---- the sea ----
 *
 * Axes as everywhere: +Y up, still water at y = 0. Directions in the plane are angles from +X towards +Z, and say where wind or
 * waves go to. docs/ocean.md has the formulas and their sources. */

typedef enum facet_sea_spectrum {
    FACET_SEA_SPECTRUM_JONSWAP, /* Hasselmann et al. 1973, growth ending where the sea is fully developed; in shallow water with the
                          factor of Bouws et al. 1985 (TMA) */
    FACET_SEA_SPECTRUM_PIERSON_MOSKOWITZ, /* fully developed, whatever the fetch (1964) */
    FACET_SEA_SPECTRUM_ELFOUHAILY         /* et al. 1997: one spectrum down to capillary waves */
} facet_sea_spectrum;

typedef enum facet_sea_spreading {
    FACET_SEA_SPREADING_HASSELMANN,     /* et al. 1980 */
    FACET_SEA_SPREADING_DONELAN_BANNER, /* Donelan, Hamilton and Hui 1985; Banner 1990 */
    FACET_SEA_SPREADING_COSINE          /* 2 / pi cos^2, down the wind only */
} facet_sea_spreading;

/* Waves from far away, beside those of the wind. {0}: none. */
typedef struct facet_swell {
    float height_m; /* significant height, [0, 30], at most 0.142 of the peak's length over deep water */
    float period_s; /* of the peak, (0, 40] */
    float direction_rad;
    float peakedness; /* JONSWAP's gamma, [1, 20]; 0: 7 */
    float elongation; /* [0, 1], 1: crests as long as Horvath 2015 has them */
} facet_swell;

/* What the water is, by Jerlov's types or by what is in it. */
typedef enum facet_water_kind {
    FACET_WATER_KIND_CHLOROPHYLL, /* of the open ocean: Morel 1988; a content of 0 is pure sea water */
    FACET_WATER_KIND_JERLOV_I,
    FACET_WATER_KIND_JERLOV_IA,
    FACET_WATER_KIND_JERLOV_IB,
    FACET_WATER_KIND_JERLOV_II,
    FACET_WATER_KIND_JERLOV_III,
    FACET_WATER_KIND_JERLOV_1C,
    FACET_WATER_KIND_JERLOV_3C,
    FACET_WATER_KIND_JERLOV_5C,
    FACET_WATER_KIND_JERLOV_7C,
    FACET_WATER_KIND_JERLOV_9C,
    FACET_WATER_KIND_COEFFICIENTS /* absorption, scattering and backscattering as they are given */
} facet_water_kind;

typedef struct facet_water {
    facet_water_kind kind;
    float chlorophyll_mg_m3; /* [0, 30] */
    float absorption[3], scattering[3],
        backscattering[3]; /* 1/m, linear Rec.709; FACET_WATER_KIND_COEFFICIENTS only */
    float salinity;        /* g of salt per kg, [0, 40] */
    float temperature_C;
    float ior;         /* [1, 2]; 0: by salinity and temperature at 550 nm (Quan and Fry 1995) */
    float foam_albedo; /* of fresh foam, [0, 1] */
} facet_water;

/* The ground below. It is a plane. */
typedef struct facet_sea_bed {
    float depth_m; /* under the origin, (0, inf); 0: there is none */
    float slope;   /* m of rise per m, [0, 1], towards direction_rad */
    float direction_rad;
    float albedo[3]; /* [0, 1] */
} facet_sea_bed;

/* {0} is still, fresh, pure water without a bed; facet_sea_default() is a sea. */
typedef struct facet_sea_desc {
    facet_allocator allocator;
    facet_log log;
    uint32_t thread_count; /* 0: facet_thread_count(); waves do not depend on it */
    float wind_mps;        /* mean at 10 m above the water, [0, 40] */
    float wind_direction_rad;
    float fetch_m; /* over which it blows, at least 100; INFINITY, or 0: without limit */
    facet_sea_spectrum spectrum;
    facet_sea_spreading spreading;
    float peakedness; /* JONSWAP's gamma, [1, 20]; 0: 3.3 */
    facet_swell swell;
    float choppiness;    /* how far water moves to and fro, over what physics has it, [0, 2]: 1 is physical */
    double loop_s;       /* after which waves repeat, [0.1, 1e6]; 0: never */
    uint32_t resolution; /* samples along the edge of a tile of waves, a power of two, [32, 1024]; 0: 256 */
    uint32_t cascade_count; /* tiles of different length, [1, 4]; 0: 3 */
    uint64_t seed;          /* another one: another sea of the same kind */
    facet_water water;
    facet_sea_bed bed; /* its depth is what waves feel, too */
} facet_sea_desc;

/* A fresh breeze of 10 m/s along +X without limit of fetch, chlorophyll 0.2 mg/m^3, salinity 35, 20 C, deep; tiles of 256. */
FACET_API facet_sea_desc facet_sea_default(void);

/* Seas that have names: "glass", "breeze", "trade-wind", "gale", "lagoon", "harbour". */
FACET_API uint32_t facet_sea_get_preset_count(void);
FACET_API const char *facet_sea_get_preset_name(uint32_t index); /* NULL: there is none */
/* FACET_ERROR_ARGUMENT: no such name. */
FACET_API facet_result facet_sea_preset(const char *name, facet_sea_desc *desc, facet_error *error);

typedef struct facet_sea facet_sea;

/* The sea at time 0. FACET_ERROR_ARGUMENT: a number outside of its range, or a bed that reaches out of the water at the
 * origin; _MEMORY. */
FACET_API facet_result facet_sea_create(const facet_sea_desc *desc, facet_sea **sea, facet_error *error);
FACET_API void facet_sea_destroy(facet_sea *sea); /* NULL is allowed */

/* Seconds, any finite number, forwards or backwards. Not while others use the sea. FACET_ERROR_ARGUMENT: not finite. */
FACET_API facet_result facet_sea_set_time(facet_sea *sea, double time_s, facet_error *error);

/* What is known of a sea beforehand, by its spectrum. */
typedef struct facet_sea_info {
    double height_m;                     /* significant: 4 standard deviations */
    double peak_period_s, peak_length_m; /* of the wind's waves or the swell, whichever is higher; 0: flat */
    double slope_variance[2];            /* of all waves, along the wind and across (Cox and Munk 1954) */
    double resolved_slope_variance[2];   /* of those in the tiles */
    double foam_coverage; /* share of the area, from above (Monahan and O'Muircheartaigh 1980) */
    double ior;
    double absorption[3], scattering[3], backscattering[3]; /* 1/m */
    double reflectance[3]; /* diffuse, of deep water just above the surface: pi R_rs */
    uint32_t tile_count;   /* 0: flat */
    double tile_length_m[4];
    double tile_turn_rad[4]; /* of a tile's axes, from +X towards +Z */
} facet_sea_info;
FACET_API facet_sea_info facet_sea_get_info(const facet_sea *sea);

/* A place of the surface. */
typedef struct facet_sea_point {
    float height_m;
    float normal[3];
    float velocity_mps; /* upwards, of the water there, which also moves to and fro */
    float jacobian;     /* area over that of the water at rest; below 0 it is folded */
} facet_sea_point;
/* The surface above or below (x, z), count times: positions are pairs. For what floats. Some 50 us each, on the sea's threads. */
FACET_API void facet_sea_get_points(const facet_sea *sea, const double *positions, size_t count,
                                    facet_sea_point *points);

/* What a tile of waves holds, as it is read by real-time programs that sum tiles by themselves: they repeat, every
 * tile_length_m, in axes that are turned by tile_turn_rad. Layers: "" RGBA, displacement along the tile's x, upwards and along its
 * z, m, and 1; "normal" (3, unit, of the displaced surface, were the tile alone); "slope" (2, of the height); "jacobian" (1);
 * "foam" (1, the share of the area under foam that is to be expected there, [0, 1]). Rows go along the tile's z, from its origin;
 * a texel lies at its index times length / size. FACET_ERROR_ARGUMENT: no such tile; _MEMORY. */
FACET_API facet_result facet_sea_create_maps(const facet_sea *sea, uint32_t tile,
                                             const facet_allocator *allocator /* NULL: {0} */,
                                             facet_image **image, facet_error *error);

/* The surface as a mesh: a square of water around center, and the bed where there is one, with materials of the same
 * coefficients: water has KHR_materials_ior, _transmission and _volume (absorption and backscattering, which is what glTF has
 * for a color of the depth). FACET_ERROR_ARGUMENT, _MEMORY. */
typedef struct facet_sea_mesh_desc {
    facet_allocator allocator;
    float size_m;       /* at rest; 0: the longest tile, 100 m where it is flat */
    uint32_t samples;   /* vertices along an edge, [2, 4096]; 0: 512 */
    double center_m[2]; /* along X and Z */
    float refinement;   /* how much closer vertices are at the center than evenly, [1, 1000]; 0: 1, evenly */
    bool omits_bed;
} facet_sea_mesh_desc;
FACET_API facet_result facet_sea_create_mesh(const facet_sea *sea,
                                             const facet_sea_mesh_desc *desc /* NULL: {0} */,
                                             facet_scene **scene, facet_error *error);

typedef enum facet_sea_normals {
    FACET_SEA_NORMALS_BECKMANN, /* slopes are Gaussian, which those of the sea nearly are */
    FACET_SEA_NORMALS_GGX       /* the same width, with longer tails */
} facet_sea_normals;
typedef enum facet_sea_masking {
    FACET_SEA_MASKING_SCALES, /* waves of all lengths on each other, whichever of them a pixel shows; GGX has Smith's */
    FACET_SEA_MASKING_SMITH,        /* height-correlated, of facets that do not know their neighbours */
    FACET_SEA_MASKING_SCHLICK_KARIS /* separable, k = (r + 1)^2 / 8: too dark at grazing angles, for comparison */
} facet_sea_masking;

/* Looks of before, without physics. docs/ocean.md, "Before". */
typedef enum facet_sea_style {
    FACET_SEA_STYLE_PHYSICAL,
    FACET_SEA_STYLE_LEGACY_WRITTEN, /* A: the formulas as they were written */
    FACET_SEA_STYLE_LEGACY_INTENDED /* B: with the signs that they were meant to have */
} facet_sea_style;

/* How the surface is shaded. {0}: physically. */
typedef struct facet_sea_shading {
    facet_sea_style style;
    facet_sea_normals normals;
    facet_sea_masking masking;
    bool has_schlick_fresnel;   /* in place of the exact formula */
    float perceptual_roughness; /* of the finest waves, [0.001, 1]; 0: by their slopes */
    bool omits_glints, omits_foam;
    bool omits_caustics; /* the bed is lit evenly, as if waves focused no light */
    uint32_t stage;      /* 1 to 5: only so much of the way from before to now; 0: all */
    float clamp;         /* radiance times exposure is cut off here; 0: not */
} facet_sea_shading;

/* Draws the sea, and a model in it. render: as for facet_render(), of which size, crop, camera, exposure, tone mapping, quality,
 * samples, environment, sun, threads, progress and time limit are followed. environment NULL: the sky of `sky`, with its sun.
 * camera NULL: facet_sea_camera(); at most 50 km high under the atmosphere's sky. scene NULL: nothing but water; its
 * pose is followed, its cameras and lights are not.
 *
 * renderer FACET_RENDERER_KIND_PREVIEW draws the endless sea. _PATH traces paths through the waves as triangles, out to the horizon, with
 * foam and scene, whose lamps it follows; of looks it knows omits_foam, has_schlick_fresnel and perceptual_roughness. _GL draws what
 * _PREVIEW does, for cameras with a field of view; the sea keeps OpenGL's programs for its next picture. */
typedef struct facet_sea_render_desc {
    facet_render_desc render;
    facet_sky_desc sky;
    facet_sea_shading shading;
} facet_sea_render_desc;
FACET_API facet_result facet_sea_render(const facet_sea *sea, const facet_scene *scene,
                                        const facet_sea_render_desc *desc, facet_image **image,
                                        facet_error *error);

/* Someone's view of the sea: from above the origin, height_m above the still water (0: 3 m, more in high seas; below 0: under
 * water), and at least a metre above the water that is there; towards azimuth_rad (from +Z towards +X, as the sky has its sun) and
 * just below the horizon. */
FACET_API facet_camera facet_sea_camera(const facet_sea *sea, float height_m, float azimuth_rad);

/* What a camera's light meter reads of that picture of the sea as it is: EV at ISO 100 that brings the log-average of the radiance to 0.22 of
 * white (Reinhard et al. 2002); and the exposure_ev that a camera set so has (ISO 12232, Lagarde and de Rousiers 2014). Sequences are best
 * metered once. Where there is hardly any light, desc's log gets a warning. Fails as facet_sea_render(). */
FACET_API facet_result facet_sea_meter(const facet_sea *sea, const facet_sea_render_desc *desc, double *ev100,
                                       facet_error *error);
FACET_API float facet_exposure_from_ev100(double ev100);

/* ---- the viewer ---- */

/* A model as a window begins to show it. */
typedef struct facet_view_model {
    facet_scene *scene;                        /* the window's from now on */
    facet_pose_desc pose;                      /* without animations: */
    uint32_t first_animation, animation_count; /* those that are played together */
    bool is_playing;
    facet_orbit orbit; /* from where it is seen, unless has_camera or has_eye */
    bool has_camera;   /* from a camera of the file */
    uint32_t camera;
    bool has_eye; /* from any other camera, apart from its roll */
    facet_camera eye;
} facet_view_model;

/* What a window shows, as facet_render() is asked for the same picture. */
typedef struct facet_view_image {
    const char *model;               /* its path; NULL: the built-in scene */
    const char *environment;         /* as load_environment() got it */
    const facet_render_desc *render; /* complete */
    const facet_orbit *orbit;        /* with radius and target; NULL: a camera of the file */
    uint32_t camera;                 /* of the file */
    double origin[3];                /* facet_scene_get_origin() of the model */
} facet_view_image;

/* What a window asks of who opened it, which makes it show what they would render. load_model and load_environment are
 * called from a thread of their own, one at a time, the others from that of facet_view(). NULL: what the library does
 * by itself. */
typedef struct facet_view_source {
    void *user;
    /* path NULL: the built-in scene */
    facet_result (*load_model)(void *user, const char *path, facet_view_model *model, facet_error *error);
    /* name NULL: the one that was asked for at the start, or the model's own. *environment NULL: there is no light */
    facet_result (*load_environment)(void *user, const char *name, const facet_view_model *model,
                                     facet_environment **environment, facet_error *error);
    /* The command line that renders the picture; a block of malloc(), NULL: there is none */
    char *(*describe)(void *user, const facet_view_image *picture);
    /* What was asked for to be printed: a line. */
    void (*print)(void *user, const char *text);
} facet_view_source;

/* How a window opens. {0}: the built-in scene. */
typedef struct facet_view_desc {
    facet_allocator allocator;
    facet_log log;
    facet_view_source source;
    const char *const *paths; /* models, and folders with some */
    uint32_t path_count;
    const char *const *environments; /* names to choose from beside those in a named file's folder */
    uint32_t environment_count;
    const char *environment; /* which is shown at first; NULL: as load_environment() has it */
    /* As the window begins: size (0: 1024 x 768), background, exposure, .. Its renderer is _GL or _PATH; allocator, log,
     * progress, pose, camera, environment and crop are not read. */
    facet_render_desc render;
    uint32_t path_samples; /* per pixel, at which path tracing ends; 0: 4096 */
    /* a file of input that is played with a clock of its own (docs/view.md); NULL: none */
    const char *script;
} facet_view_desc;

/* A window that shows models until it is closed. On the process' first thread. Fails with FACET_ERROR_SYSTEM: there is
 * no display, GLFW or OpenGL; FACET_ERROR_ARGUMENT: the script; or as the first model does. */
FACET_API facet_result facet_view(const facet_view_desc *desc /* NULL: {0} */, facet_error *error);

/* ---- comparison ---- */

/* What the numbers of pictures are when they are compared. */
typedef enum facet_compare_space {
    FACET_COMPARE_SPACE_AUTO,   /* display, unless both pictures are linear and there is no tone mapping */
    FACET_COMPARE_SPACE_LINEAR, /* linear Rec.709 */
    FACET_COMPARE_SPACE_DISPLAY /* tone-mapped, clamped to [0, 1], sRGB-encoded */
} facet_compare_space;

typedef enum facet_compare_alpha {
    FACET_COMPARE_ALPHA_CHANNEL, /* colors over black, and opacity as a fourth channel unless all of both is opaque */
    FACET_COMPARE_ALPHA_IGNORE,    /* colors over black alone */
    FACET_COMPARE_ALPHA_BACKGROUND /* colors over background */
} facet_compare_alpha;

/* Metrics that take time; the others are always there. */
typedef enum facet_metric { FACET_METRIC_SSIM = 1 << 0, FACET_METRIC_FLIP = 1 << 1 } facet_metric;

typedef enum facet_difference {
    FACET_DIFFERENCE_ABSOLUTE, /* |b - a| times gain, per channel; opacity's added to all three */
    FACET_DIFFERENCE_HEAT_MAP, /* FLIP, or where it is skipped the largest |b - a| times gain: [0, 1] from black over red
                                  to light yellow */
} facet_difference;

/* How pictures are compared; docs/compare.md has the formulas and when to use which. {0}: all of both, every metric. */
typedef struct facet_compare_desc {
    facet_allocator allocator;
    uint32_t thread_count;    /* 0: facet_thread_count(); no number depends on it */
    uint32_t skipped_metrics; /* FACET_METRIC_* or-ed */
    facet_compare_space space;
    facet_tonemap tonemap; /* of linear pictures, for the display; those of a display are left as they are */
    float exposure_ev;     /* stops; linear pictures are scaled by 2^exposure_ev */
    facet_compare_alpha alpha;
    float background[3]; /* linear Rec.709, as a display shows it */
    uint32_t crop[4];    /* x, y, width, height of the part that is compared; {0}: all */
    /* of the same size; pixels count where it is at least half as bright as white is for an eye (sRGB 0.5). NULL: all
     * */
    const facet_image *mask;
    float
        pixels_per_degree;  /* FLIP: of the eye's field, [1, 1000]; 0: 67, a 4k display of 0.7 m from 0.7 m */
    float relative_epsilon; /* mse_relative: added to a^2; 0: 0.01 */
    float peak;             /* PSNR, SSIM: the largest value; 0: 1, in linear space the largest of a */
    float threshold;        /* a pixel differs where a channel is farther apart than this */
    double percentile;      /* (0, 100]: one of your own beside 50, 95, 99 and 99.9; 0: none */
    facet_difference difference;
    float gain;    /* of the difference picture; 0: 1 */
    bool is_sheet; /* the difference picture shows a, b and the difference side by side */
} facet_compare_desc;

/* How far b is from the reference a. NAN: not measured. Errors are of channels, in the space's unit; means are over the
 * channels of all pixels that count and are finite. */
typedef struct facet_comparison {
    uint32_t width, height;            /* of the part that was compared */
    facet_compare_space space;         /* LINEAR or DISPLAY */
    uint32_t channel_count;            /* 3; 4: with opacity */
    uint64_t pixel_count;              /* that the mask lets count */
    bool is_equal;                     /* to the last bit, as linear premultiplied floats */
    uint64_t nonfinite_a, nonfinite_b; /* pixels with NaN or infinity */
    /* pixels whose NaN or infinity is not the same in both: in no mean, but among those that differ, infinitely far,
     * and with a FLIP of 1 */
    uint64_t invalid_count;
    double mse, rmse;
    double mse_relative, rmse_relative; /* mean of (b - a)^2 / (a^2 + relative_epsilon), and its root */
    double nrmse;                       /* rmse over the root mean square of a */
    double mae, bias;                   /* mean of |b - a|, of b - a */
    double max_error;                   /* of a channel */
    uint32_t max_x, max_y;              /* where, in pixels of the whole picture */
    double percentile_50, percentile_95, percentile_99, percentile_999,
        percentile; /* of pixels' largest |b - a| */
    uint64_t differing_count;
    double differing_share; /* of pixel_count */
    double peak, psnr;      /* dB; INFINITY where mse is 0 */
    double ssim; /* of luminance (in display space luma), 1: the same; NAN also below 11 x 11 pixels */
    double ssim_channels;  /* mean over the channels */
    double flip, flip_max; /* [0, 1], mean and largest */
    bool is_flip_hdr;      /* the largest over exposures: in linear space */
    double flip_start_ev, flip_stop_ev;
    uint32_t flip_exposure_count;
} facet_comparison;

/* Compares the pictures (layer 0) of a, the reference, and b. *difference (NULL: not wanted) shows where they differ: in
 * display space with values that facet_image_save() writes as they are to files for displays. FACET_ERROR_ARGUMENT: sizes
 * differ, the crop lies outside, the mask leaves nothing. */
FACET_API facet_result facet_compare(const facet_image *a, const facet_image *b,
                                     const facet_compare_desc *desc /* NULL: {0} */, facet_comparison *out,
                                     facet_image **difference, facet_error *error);

#ifdef __cplusplus
}
#endif

#endif
