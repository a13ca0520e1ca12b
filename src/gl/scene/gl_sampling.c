/* gl_sampling.c - see gl_sampling.h. */
#include "gl/scene/gl_sampling.h"

#include <math.h>

#include "draw/sample_pattern.h"

enum { MOST_SAMPLES = 8 }; /* in a drawn pixel: more take memory, and passes do the same */

gl_sampling gl_sampling_plan(uint32_t samples, facet_quality quality, uint32_t max_samples)
{
    gl_sampling plan = {.scale = quality == FACET_QUALITY_FINAL && samples >= 4 ? 2 : 1};
    uint32_t quarter = plan.scale * plan.scale;
    uint32_t wanted = (samples + quarter - 1) / quarter;
    uint32_t most = max_samples < MOST_SAMPLES ? max_samples : MOST_SAMPLES;
    plan.samples = 1;
    while (2 * plan.samples <= most && 2 * plan.samples <= wanted)
        plan.samples *= 2;
    plan.passes = (wanted + plan.samples - 1) / plan.samples;
    return plan;
}

/* A pass's samples are about 1 / sqrt(samples) apart: so far, with a sample in the middle, the others are spread. */
void gl_sampling_jitter(const gl_sampling *sampling, float *jitter)
{
    float gap = 1.0f / sqrtf((float)sampling->samples);
    sample_pattern(sampling->passes, jitter);
    for (uint32_t i = 0; i < 2 * sampling->passes; i++)
        jitter[i] = gap * (jitter[i] - 0.5f);
}
