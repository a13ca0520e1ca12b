/* obj_write.h - what the files of the OBJ writer share. */
#ifndef IO_OBJ_WRITE_H
#define IO_OBJ_WRITE_H

#include "base/text.h"
#include "io/obj/obj.h"

typedef enum obj_list { OBJ_POSITIONS, OBJ_TEXCOORDS, OBJ_NORMALS, OBJ_LIST_COUNT } obj_list;

/* One of the lists of a piece: "v", "vt" or "vn". */
typedef struct obj_values {
    uint32_t width; /* floats per value; 0: the piece has none */
    float *values;  /* distinct values; block of mem_alloc() */
    uint32_t *map;  /* index of the value by vertex; block of mem_alloc() */
    size_t count;
    size_t first; /* number of the first value in the file, from 1 */
} obj_values;

/* An instance of a pose. */
typedef struct obj_piece {
    const scene_instance *instance;
    uint32_t texcoord_set; /* SCENE_NONE: none */
    obj_values lists[OBJ_LIST_COUNT];
} obj_piece;

/* obj_write_pieces.c: the distinct values of all pieces in world space, and their numbers in the file.
 * False: no memory. */
bool obj_pieces_fill(obj_piece *pieces, size_t count, const facet_scene *scene,
                     const facet_scene_save_desc *desc);
void obj_pieces_destroy(obj_piece *pieces, size_t count);

/* The statements of all pieces, each after its heading ("o ..", "usemtl .."), all after begin. Positions
 * are printed in the file's coordinates: origin is the scene's. A block of mem_alloc(), *size bytes; NULL:
 * no memory. */
char *obj_pieces_print(const obj_piece *pieces, const text *headings, size_t count, const text *begin,
                       const double origin[3], const facet_scene_save_desc *desc, size_t *size);

/* obj_write.c: file names for the images of materials, and which of them to write. */
typedef struct obj_images {
    const char **names; /* by image; NULL: unused, or not writable */
    bool *is_there;     /* by image: a file of that name already holds it */
    char *storage;
} obj_images;
/* False: no memory. path: of the OBJ file; stem: its name without the extension. */
bool obj_images_create(const facet_scene *scene, const char *path, const char *stem,
                       const facet_scene_save_desc *desc, obj_images *out);
void obj_images_destroy(obj_images *images);

#endif
