/* convert.c - see convert.h. */
#include "legacy/convert.h"

facet_result legacy_convert(facet_scene *scene, facet_material_model to, const facet_legacy_desc *desc,
                            const facet_log *log, facet_error *error)
{
    (void)scene;
    (void)to;
    (void)desc;
    (void)log;
    (void)error;
    return FACET_OK;
}

void legacy_report_json(const facet_scene *scene, text *out)
{
    (void)scene;
    text_add(out, "{}");
}
