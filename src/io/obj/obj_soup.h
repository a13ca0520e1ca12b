/* obj_soup.h - triangles or points of formats without objects and materials, made a scene by the last
 * steps of the OBJ reader: normals if there are none, shared vertices, one neutral material. */
#ifndef IO_OBJ_SOUP_H
#define IO_OBJ_SOUP_H

#include "scene/scene.h"

#define OBJ_SOUP_NONE UINT32_MAX /* a corner without texture coordinates */

/* Corners from begin on, up to those of the next part. */
typedef struct obj_soup_part {
    const char *name; /* not terminated */
    size_t name_size, begin;
} obj_soup_part;

/* All arrays are blocks of mem_alloc(), which obj_soup_release() frees. */
typedef struct obj_soup {
    const facet_scene_desc *desc;
    facet_scene *scene;
    double *places; /* 3 each */
    size_t place_count, place_capacity;
    float *normals;   /* 3 per place, of any length; NULL: none */
    float *colors;    /* 4 per place, linear; NULL: none */
    float *texcoords; /* 2 each, v up as in OBJ */
    size_t texcoord_count, texcoord_capacity;
    bool is_cloud; /* points, not triangles */
    uint32_t *v;   /* per corner, below place_count */
    uint32_t *t;   /* per corner; NULL: as v, if there are texture coordinates */
    size_t corner_count, corner_capacity, t_capacity;
    obj_soup_part *parts; /* at least one */
    size_t part_count, part_capacity;
    scene_texture_ref base_color; /* of the material; .texture SCENE_NONE: none */
} obj_soup;

obj_soup obj_soup_begin(facet_scene *scene, const facet_scene_desc *desc);
/* Fills the scene except for its images and textures. Triangles without area and those with positions that
 * are not finite are left out, the latter with a warning. */
facet_result obj_soup_finish(obj_soup *soup, facet_error *error);
void obj_soup_release(obj_soup *soup);

#endif
