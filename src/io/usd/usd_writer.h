/* usd_writer.h - what the files of the USD writer share. */
#ifndef IO_USD_WRITER_H
#define IO_USD_WRITER_H

#include "base/text.h"
#include "scene/scene.h"

/* Contents that are lost; or-ed. */
typedef enum usd_loss {
    USD_LOST_SKINS = 1 << 0,
    USD_LOST_MORPHS = 1 << 1,
    USD_LOST_LINES = 1 << 2,
    USD_LOST_CAMERAS = 1 << 3,
    USD_LOST_LIGHTS = 1 << 4,
    USD_LOST_VARIANTS = 1 << 5,
    USD_LOST_MOTION = 1 << 6, /* of anything but nodes, and of all but the first animation */
    USD_LOST_LAYERS = 1 << 7, /* materials' layers that UsdPreviewSurface lacks */
    USD_LOST_COLORS = 1 << 8
} usd_loss;

enum { USD_FPS = 24 }; /* time codes per second */

/* How the writer has come along with a node. */
typedef struct usd_node {
    const scene_sampler *translation, *rotation, *scale; /* of the first animation; NULL: at rest */
    uint32_t children_begun;
} usd_node;

typedef struct usd_writer {
    const facet_scene *scene;
    const char *const *images; /* by image: its path in the archive; NULL: it cannot be read */
    usd_node *nodes;           /* per node of the scene; usd_nodes_create() */
    text out;
    unsigned losses;
} usd_writer;

void usd_float(usd_writer *w, float value);
/* "(1, 2, 3)" */
void usd_tuple(usd_writer *w, const float *values, size_t count);
/* A name as USD allows it: letters, digits and _, and a number that makes it unique. */
void usd_identifier(usd_writer *w, const char *name, uint32_t number);

/* usd_materials.c: the scope "/Root/Materials" with Material_0, Material_1, .. */
void usd_write_materials(usd_writer *w);
/* usd_scene.c: a block of mem_alloc(); NULL: no memory. */
usd_node *usd_nodes_create(const facet_scene *scene);
/* A root node with all below it. */
void usd_write_node(usd_writer *w, uint32_t node);

#endif
