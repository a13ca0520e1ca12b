/* plot_convert.c - materials in the other model, beside themselves. See plot_build.h. */
#include <stdio.h>

#include "base/result.h"
#include "plot/plot_build.h"

const fit_metric *plot_metric(plot *p)
{
    if (!p->metric && !p->has_failed) {
        pbr_masking masking = p->desc->has_separable_smith ? PBR_SEPARABLE : PBR_CORRELATED;
        /* the vignette's own material is seen with its own formula */
        if (p->desc->kind == FACET_PLOT_KIND_LEGACY && p->has_default_materials)
            masking = PBR_SEPARABLE;
        if (fit_metric_create(&p->desc->allocator, masking, &p->metric, NULL) != FACET_OK)
            p->has_failed = true;
    }
    return p->metric;
}

static void convert_pbr(const fit_metric *metric, const material *source, bool is_fit, plot_conversion *out)
{
    pbr_surface pbr = material_pbr_surface(&source->parameters);
    ogl1_surface ogl1;
    if (is_fit)
        pbr_to_ogl1_fit(metric, &pbr, FACET_LEGACY_TARGET_LINEAR, FIT_DISPLAYABLE, &ogl1);
    else
        pbr_to_ogl1_closed(&pbr, &ogl1);
    out->material.parameters = material_from_ogl1(&ogl1);
    out->has_error = true;
    out->error = fit_compare(metric, &ogl1, &pbr, FIT_FROM_PBR);
}

static void convert_ogl1(const fit_metric *metric, const material *source, bool is_fit, plot_conversion *out)
{
    ogl1_surface ogl1 = material_ogl1_surface(&source->parameters);
    pbr_surface pbr;
    if (is_fit)
        ogl1_to_pbr_fit(metric, &ogl1, FACET_LEGACY_TARGET_LINEAR, &pbr);
    else
        ogl1_to_pbr_closed(&ogl1, &pbr);
    out->material.parameters = material_from_pbr(&pbr);
    out->has_error = true;
    out->error = fit_compare(metric, &ogl1, &pbr, FIT_FROM_OGL1);
}

facet_result plot_convert(plot *p, const material *source, facet_plot_model to, bool is_fit,
                          plot_conversion *out)
{
    *out = (plot_conversion){.material = *source};
    out->material.measured = NULL;
    if (source->measured) {
        facet_result result =
            material_fit(source, to, &p->desc->allocator, &out->material.parameters, &out->rms, p->error);
        if (result != FACET_OK)
            return result;
    } else {
        const fit_metric *metric = plot_metric(p);
        if (!metric)
            return fail_memory(p->error, "directions of a fit", 0);
        if (source->parameters.model == FACET_PLOT_MODEL_PBR)
            convert_pbr(metric, source, is_fit, out);
        else
            convert_ogl1(metric, source, is_fit, out);
    }
    const char *what = material_describe(&out->material.parameters, &p->desc->allocator, p->memory);
    if (!what)
        return fail_memory(p->error, "plot", 0);
    out->what = what;
    double error = out->has_error ? out->error.E : out->rms;
    out->material.label = plot_text(p, "%s (%s %.3f): %s", is_fit || source->measured ? "fit" : "converted",
                                    out->has_error ? "E" : "RMS of logarithms", error, what);
    return FACET_OK;
}

void plot_report_fit(const plot *p, uint32_t number, const material *source, const plot_conversion *fit)
{
    facet_plot_fit *out = p->desc->fits ? &p->desc->fits[number] : NULL;
    if (!out)
        return;
    *out = (facet_plot_fit){.is_found = true,
                            .fitted = fit->material.parameters,
                            .is_of_measured = !fit->has_error,
                            .E = (float)fit->error.E,
                            .E_display = (float)fit->error.E_display,
                            .E_drawn = (float)fit->error.E_drawn,
                            .log_rms = (float)fit->rms};
    out->fitted.label = NULL;
    snprintf(out->name, sizeof out->name, "%s", source->label);
    snprintf(out->description, sizeof out->description, "%s", fit->what);
}
