/* plot_material.h - the materials of facet plot: parameters, model files, measured BRDFs. */
#ifndef CLI_PLOT_MATERIAL_H
#define CLI_PLOT_MATERIAL_H

#include "cli/shared/command_line.h"
#include "facet/facet.h"

/* Materials, and the storage of their labels. {0} initially. */
typedef struct plot_materials {
    facet_plot_material items[FACET_PLOT_MAX_MATERIALS];
    uint32_t count;
    facet_scene *scenes[FACET_PLOT_MAX_MATERIALS]; /* storage of labels */
    uint32_t scene_count;
} plot_materials;

/* Appends the material of text: "roughness=0.3,metallic=1", "ogl1,shininess=20", "model.glb#Leather",
 * "paint.binary". Fails with FACET_ERROR_ARGUMENT, and as facet_scene_load(). text must stay valid. */
facet_result plot_materials_add(plot_materials *m, const char *text, const facet_scene_desc *desc,
                                facet_error *error);
/* Whether text is a list of parameters instead of a file: "ggx", "roughness=0.3", "ogl1,shininess=20". */
bool plot_material_is_parameters(const char *text);
/* Appends the materials of --roughness, --metallic and --base-color. */
facet_result plot_materials_add_options(plot_materials *m, const command_line *c, facet_error *error);
/* Writes m as text for plot_materials_add(), without parameters that have their default; PBR or OpenGL 1,
 * without angles. */
void plot_material_write(const facet_plot_material *m, char *text, size_t size);
void plot_materials_destroy(plot_materials *m);

#endif
