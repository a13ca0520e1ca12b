/* convert.c - glTF materials as OBJ with MTL, and the error of each: convert MODEL.glb MODEL.obj */
#include <facet/facet.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    facet_error error;
    facet_scene *scene = NULL;
    char *report = NULL;

    facet_result result = facet_scene_load(argc > 1 ? argv[1] : "model.glb", NULL, &scene, &error);
    if (result == FACET_OK)
        result = facet_scene_convert_materials(scene, FACET_MATERIAL_MODEL_OGL1, NULL, NULL, &error);
    if (result == FACET_OK) {
        for (uint32_t i = 0; i < facet_scene_get_conversion_count(scene); i++) {
            facet_conversion c = facet_scene_get_conversion(scene, i);
            printf("%s: %s, error %.3f\n", c.name, c.method, c.error_graded);
        }
        result = facet_scene_save(scene, argc > 2 ? argv[2] : "model.obj", NULL, &error);
    }
    if (result == FACET_OK)
        result = facet_scene_report_conversion(scene, FACET_REPORT_FORMAT_JSON, &report, &error);
    if (result == FACET_OK)
        puts(report);
    else
        fprintf(stderr, "%s\n", error.message);

    facet_text_destroy(report);
    facet_scene_destroy(scene);
    return result == FACET_OK ? 0 : 1;
}
