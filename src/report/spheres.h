/* spheres.h - spheres of one material, rendered in both models. */
#ifndef REPORT_SPHERES_H
#define REPORT_SPHERES_H

#include "scene/legacy.h"

typedef enum sphere_style {
    SPHERE_OGL1_DISPLAY, /* as OpenGL 1 displayed it: light added in display values */
    SPHERE_OGL1_LINEAR,  /* the same with linear light: the target of conversions */
    SPHERE_PBR,
    SPHERE_STYLE_COUNT
} sphere_style;

/* A scene of one sphere under one light from the upper left, with the materials and textures of another
 * scene. */
typedef struct sphere_stage sphere_stage;
facet_result sphere_stage_create(const facet_scene *scene, sphere_stage **out, facet_error *error);
void sphere_stage_destroy(sphere_stage *stage); /* NULL is allowed */

/* A PNG file of size x size pixels, transparent around the sphere; a block of mem_alloc(). */
facet_result sphere_draw(sphere_stage *stage, uint32_t material, sphere_style style, uint32_t size,
                         unsigned char **bytes, size_t *byte_count, facet_error *error);

#endif
