/* facet/scene.h - models: loading (glTF; OBJ with MTL, STL, PLY, rgl's parameters), inspecting, posing,
 * saving. */
#ifndef FACET_SCENE_H
#define FACET_SCENE_H

#include "base.h"
#include "legacy.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- loading ---- */

/* Vertex normals of an OBJ, STL or PLY file that has none. */
typedef enum facet_obj_normals {
    /* by smoothing groups; without them, smooth across edges of less than 45 degrees */
    FACET_OBJ_NORMALS_AUTO,
    FACET_OBJ_NORMALS_FLAT,  /* one per face */
    FACET_OBJ_NORMALS_SMOOTH /* smooth across all edges */
} facet_obj_normals;

/* Files that the caller supplies in place of the file system: those of a pack file, an archive, a network, a
 * browser. Paths are written with "/", without a leading one, "." and "..", and are below one topmost folder. Calls
 * come from the thread that reads the model; close() also from the one that destroys the scene. */
typedef struct facet_file_source {
    void *user;
    /* The bytes of the file at exactly that path. False: there is none. They stay valid and unchanged until
     * close(), which is called once for each open() that was true, at the latest when the scene is destroyed:
     * scenes point into the bytes of their files. NULL: the file system is used. */
    bool (*open)(void *user, const char *path, const void **bytes, size_t *size);
    void (*close)(void *user, const void *bytes, size_t size); /* NULL: nothing is to be released */
    /* The path of file number index, from 0; NULL behind the last one. A name for which there is no file is
     * looked for among them: a path that differs in case or in Unicode normalization is read instead, with a
     * warning. NULL: only exact names are found. */
    const char *(*list)(void *user, size_t index);
} facet_file_source;

/* {0}: malloc, silent, all threads, files of the model's folder only. */
typedef struct facet_scene_desc {
    facet_allocator allocator;
    facet_log log;
    uint32_t thread_count;     /* 0: facet_thread_count() */
    const char *root;          /* folder that URIs of the model may reach; NULL: the folder of the model */
    uint64_t max_file_bytes;   /* larger files are refused; 0: 4 GiB */
    uint32_t max_texture_size; /* texels along an edge; larger images are refused; 0: 16384 */
    facet_legacy_desc legacy;  /* how materials of OBJ, MTL and rgl are interpreted and converted */
    facet_obj_normals obj_normals;
    bool has_flipped_texcoords; /* OBJ: v points down (the format says up) */
    /* JSON file of rgl's material parameters that replace the model's; NULL: none */
    const char *parameters;
    /* where facet_scene_load() finds the model and all files that it refers to; {0}: the file system */
    facet_file_source files;
} facet_scene_desc;

/* Reads a .glb, .gltf, .obj (with its .mtl files), .stl or .ply file, or a .json file of rgl's material
 * and light parameters (one sphere per material); the content decides, not the name. Legacy materials are
 * converted as desc->legacy says and kept beside the result. Textures are decoded when a renderer needs
 * them. */
FACET_API facet_result facet_scene_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                                        facet_error *error);
/* The same from memory, which may be released afterwards. Messages use name for the file; external files need
 * desc->root. */
FACET_API facet_result facet_scene_load_memory(const void *bytes, size_t size, const char *name,
                                               const facet_scene_desc *desc, facet_scene **scene,
                                               facet_error *error);
/* The built-in scene: spheres over roughness and metallic, and a few instructive materials. */
FACET_API facet_result facet_scene_create_builtin(const facet_scene_desc *desc, facet_scene **scene,
                                                  facet_error *error);
FACET_API void facet_scene_destroy(facet_scene *scene);

/* Whether path, under any of its names, is one of the files that the scene was read from: writing there would
 * replace an input. */
FACET_API bool facet_scene_has_file(const facet_scene *scene, const char *path);

/* The path, as it was opened, of a file that the scene was read from: the model, its buffers, images and
 * materials, in no particular order. NULL past the end. A scene from memory or a pipe has none. Lives as long
 * as the scene. */
FACET_API const char *facet_scene_get_file(const facet_scene *scene, uint32_t index);

/* A decoder that files of the scene need and that pages fetch when it is needed, by index: "draco", "webp", "avif", "exr", "zstd".
 * NULL past the end. */
FACET_API const char *facet_scene_get_decoder(const facet_scene *scene, uint32_t index);

/* ---- inspecting ---- */

typedef struct facet_scene_counts {
    uint32_t scenes, nodes, meshes, primitives, materials, textures, images, cameras, lights, skins,
        animations, variants, image_lights;
    uint32_t instances; /* drawn primitives of the default scene; a mesh under two nodes counts twice */
    uint64_t vertices, triangles, lines, points; /* as stored, without instances */
    uint64_t drawn_triangles;                    /* of the default scene, with instances */
} facet_scene_counts;
FACET_API facet_scene_counts facet_scene_get_counts(const facet_scene *scene);

/* Describes the model as a JSON object (UTF-8): asset, counts, bounds, scenes, nodes, meshes, materials
 * with their parameters, textures, images, cameras, lights, extensions with their state, warnings of
 * reading. docs/inspect.md lists the members. Release *text with facet_text_destroy(). */
FACET_API facet_result facet_scene_describe_json(const facet_scene *scene, char **text, facet_error *error);

/* The index of the first scene, camera, animation or material variant (KHR_materials_variants) of that name.
 * Without an exact match a name that differs in case is taken, then a decimal number as the index.
 * FACET_ERROR_ARGUMENT lists the names that exist. */
FACET_API facet_result facet_scene_find_scene(const facet_scene *scene, const char *name, uint32_t *index,
                                              facet_error *error);
FACET_API facet_result facet_scene_find_camera(const facet_scene *scene, const char *name, uint32_t *index,
                                               facet_error *error);
FACET_API facet_result facet_scene_find_animation(const facet_scene *scene, const char *name, uint32_t *index,
                                                  facet_error *error);
FACET_API facet_result facet_scene_find_variant(const facet_scene *scene, const char *name, uint32_t *index,
                                                facet_error *error);

typedef struct facet_animation {
    const char *name;      /* "": unnamed; lives as long as the scene */
    double begin_s, end_s; /* first and last keyframe */
    bool is_external;      /* of an external asset (glTF 2.1), which plays with the file's own animation */
} facet_animation;
/* {0} past the end. */
FACET_API facet_animation facet_scene_get_animation(const facet_scene *scene, uint32_t index);

/* ---- poses and places ---- */

/* What of a scene is shown, and at what time. {0}: the default scene with the file's materials, at rest
 * (nodes as they are stored). */
typedef struct facet_pose_desc {
    bool has_scene_index; /* false: the default scene of the file */
    uint32_t scene_index;
    bool has_variant; /* false: the materials of the file */
    uint32_t variant;
    uint32_t animation_count; /* played together; later ones win where two move the same property */
    const uint32_t *animations;
    double time_s; /* of the animations, which hold their first and last keyframe outside of their range */
} facet_pose_desc;

/* The origin of world space, m, in the coordinates of the file. It is {0, 0, 0}, or a point near a model
 * that is so far from the file's origin (as in map coordinates) that floats would not resolve its shape.
 * All positions that the library takes and returns as floats (cameras, orbits, bounds) are relative to it;
 * add it, or subtract it, in double. Loading the same file gives the same origin. */
FACET_API void facet_scene_get_origin(const facet_scene *scene, double origin[3]);

/* Chooses the origin by another pose than that of loading (the default scene at rest): for animations or
 * scenes of the file that take the model elsewhere. No other thread may use the scene meanwhile.
 * FACET_ERROR_ARGUMENT: there is no such pose; FACET_ERROR_MEMORY. */
FACET_API facet_result facet_scene_choose_origin(facet_scene *scene, const facet_pose_desc *pose,
                                                 facet_error *error);

/* Axis-aligned bounds in world space, m, of what is drawn and can be seen; pose NULL: {0}. False: there is
 * nothing, and both are 0. */
FACET_API bool facet_scene_get_bounds(const facet_scene *scene, const facet_pose_desc *pose, float minimum[3],
                                      float maximum[3]);

/* Moves the default scene, skins included: puts a node with that matrix above its roots, or changes the
 * matrix of the node that an earlier call has put there. Columns as in glTF; the last row is 0 0 0 1. The
 * matrix maps from the world space before the first call; from then on the origin of that space is the
 * origin of the file, and facet_scene_get_origin() is 0. No other thread may use the scene meanwhile.
 * Scenes that were appended stay. FACET_ERROR_ARGUMENT: no such matrix, or the scene belongs to another;
 * FACET_ERROR_MEMORY: the scene is unchanged. */
FACET_API facet_result facet_scene_place(facet_scene *scene, const float matrix[16], facet_error *error);

/* Appends all of another scene, which from then on belongs to `scene` and is destroyed with it: a fleet, a
 * room with its furniture. The default scene of `other` becomes one more part of the default scene; each
 * part is placed by itself, from where it was. Meshes, materials, textures, nodes, cameras, lights, skins and
 * animations of `other` follow those of `scene`, whose indices stay; material variants of the same name are
 * one. Left out are the metadata packets of `other` (KHR_xmp_json_ld), and its image-based light if `scene`
 * has one. Legacy materials stay if both scenes have them in the same color encoding and by the same rules
 * (rgl's, or MTL's). No other thread may use the scenes meanwhile. FACET_ERROR_MEMORY: both are unchanged;
 * FACET_ERROR_ARGUMENT: both are the same scene, or one of them belongs to another already. */
FACET_API facet_result facet_scene_append(facet_scene *scene, facet_scene *other, facet_error *error);

/* facet_scene_place() of one part: 0 is what the scene had of itself, then the appended scenes in their order.
 * FACET_ERROR_ARGUMENT also if there is no such part. */
FACET_API facet_result facet_scene_place_part(facet_scene *scene, uint32_t part, const float matrix[16],
                                              facet_error *error);

/* ---- saving ---- */

typedef struct facet_scene_save_desc {
    facet_allocator allocator;
    facet_log log;
    /* Stage "write": called before a file is begun and before all files are renamed into place. Nothing is
     * on the disk before the first call. */
    facet_progress progress;
    uint32_t thread_count; /* 0: facet_thread_count() */
    bool is_glb;           /* writes .glb whatever the name: for /dev/stdout */
    /* fails with FACET_ERROR_ARGUMENT rather than replace a file that the scene was read from */
    bool keeps_inputs;
    bool has_flipped_texcoords; /* OBJ: v points down as in glTF (the format says up) */
    /* MTL: only what Wavefront defined; no Pr, Pm, .. and no comment with the glTF values */
    bool omits_mtl_pbr;
    float mtl_shininess_scale; /* MTL: Ns is the shininess times this; 0: 1 */
} facet_scene_save_desc;

/* Writes the whole scene; the extension of path decides:
 *   .glb   glTF 2.0 in one file
 *   .gltf  glTF 2.0 with a .bin and the images beside it. Both hold everything that facet reads: loading again gives an
 *          equal scene
 *   .obj   the scene at rest, with a .mtl and the images beside it
 *   .json  rgl's parameters of materials and lights
 * .obj and .json need legacy materials (facet_scene_convert_materials()), else FACET_ERROR_ARGUMENT. All
 * files are written or none. desc NULL: {0}. */
FACET_API facet_result facet_scene_save(const facet_scene *scene, const char *path,
                                        const facet_scene_save_desc *desc, facet_error *error);

#ifdef __cplusplus
}
#endif

#endif
