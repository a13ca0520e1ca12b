/* bake_sh.c - an environment as nine spherical harmonics, in the forms that engines take (facet_sh_form). */
#include <assert.h>
#include <math.h>

#include "bake/bake.h"

#include "base/result.h"
#include "ibl/environment.h"
#include "ibl/sh_window.h"

static const facet_sh_desc default_desc;

facet_result facet_environment_project_sh(const facet_environment *environment, const facet_sh_desc *desc,
                                          float coefficients[9][3], facet_error *error)
{
    assert(environment && coefficients);
    desc = desc ? desc : &default_desc;
    if ((uint32_t)desc->form > FACET_SH_FORM_FOLDED)
        return fail(error, FACET_ERROR_ARGUMENT, "harmonics: form %u: 0 to %d were expected",
                    (uint32_t)desc->form, FACET_SH_FORM_FOLDED);
    if (!isfinite(desc->rotation_rad) || !isfinite(desc->ev) || !isfinite(desc->clamp) || desc->clamp < 0.0f)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "harmonics: rotation %g, ev %g, clamp %g: finite numbers, and 0 or more to clamp at, "
                    "were expected",
                    (double)desc->rotation_rad, (double)desc->ev, (double)desc->clamp);
    double radiance[SH_COUNT][3];
    facet_result result =
        sh_project_limited(&environment->picture, desc->clamp > 0.0f ? desc->clamp : INFINITY,
                           &desc->allocator, desc->thread_count, radiance, error);
    if (result != FACET_OK)
        return result;
    sh_rotate(radiance, (double)desc->rotation_rad);
    double scale = exp2((double)desc->ev);
    for (int k = 0; k < SH_COUNT; k++)
        for (int i = 0; i < 3; i++)
            radiance[k][i] *= scale;
    if (desc->is_windowed)
        sh_dering(radiance);
    double irradiance[SH_COUNT][3];
    sh_irradiance((const double(*)[3])radiance, irradiance);
    if (desc->form == FACET_SH_FORM_FOLDED) {
        sh_fold_over_pi((const double(*)[3])irradiance, coefficients);
        return FACET_OK;
    }
    for (int k = 0; k < SH_COUNT; k++)
        for (int i = 0; i < 3; i++)
            coefficients[k][i] =
                (float)(desc->form == FACET_SH_FORM_IRRADIANCE ? irradiance[k][i] : radiance[k][i]);
    return FACET_OK;
}
