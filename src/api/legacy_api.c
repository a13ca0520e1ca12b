/* legacy_api.c - the parts of facet.h about materials of OpenGL 1 and their conversion. */
#include "base/result.h"
#include "legacy/convert.h"
#include "report/report.h"

facet_result facet_scene_convert_materials(facet_scene *scene, facet_material_model to,
                                           const facet_legacy_desc *desc, const facet_log *log,
                                           facet_error *error)
{
    const facet_legacy_desc defaults = {0};
    const facet_log silent = {0};
    return legacy_convert(scene, to, desc ? desc : &defaults, log ? log : &silent, error);
}

bool facet_scene_has_legacy_materials(const facet_scene *scene)
{
    return scene_has_legacy_materials(scene);
}

uint32_t facet_scene_get_conversion_count(const facet_scene *scene)
{
    return scene->conversion ? scene->conversion->material_count : 0;
}

facet_conversion facet_scene_get_conversion(const facet_scene *scene, uint32_t index)
{
    if (index >= facet_scene_get_conversion_count(scene))
        return (facet_conversion){0};
    return scene->conversion->materials[index].summary;
}

facet_result facet_scene_report_conversion(const facet_scene *scene, facet_report_format format, char **out,
                                           facet_error *error)
{
    *out = NULL;
    text t = {.allocator = scene->allocator};
    facet_result result = FACET_OK;
    if (format == FACET_REPORT_FORMAT_HTML)
        result = report_html(scene, &t, error);
    else
        legacy_report_json(scene, &t);
    if (result == FACET_OK && t.has_failed)
        result = fail_memory(error, "report", t.capacity);
    if (result != FACET_OK) {
        text_destroy(&t);
        return result;
    }
    *out = t.data;
    return FACET_OK;
}
