/* part_key.c - what an image depends on, as a hash: parts of different ones are not merged. */
#include "base/result.h"
#include "base/text.h"
#include "cpu/ray_scene.h"
#include "ibl/cache.h"
#include "ibl/environment.h"
#include "path/path_key.h"
#include "render/part.h"

#include <stdio.h>
#include <string.h>

#if defined(__x86_64__)
#include <cpuid.h>
#endif

/* ---- the settings as text ---- */

static void add_number(text *t, double x)
{
    text_addf(t, "%a ", x);
}

static void add_floats(text *t, const float *x, size_t count)
{
    for (size_t i = 0; i < count; i++)
        add_number(t, (double)x[i]);
}

static void add_numbers(text *t, const double *x, size_t count)
{
    for (size_t i = 0; i < count; i++)
        add_number(t, x[i]);
}

#define ADD(t, ...)                                                                                          \
    add_numbers(t, (const double[]){__VA_ARGS__}, sizeof((const double[]){__VA_ARGS__}) / sizeof(double))

static void add_image(text *t, const facet_render_desc *d)
{
    ADD(t, d->renderer, d->width, d->height, d->samples, d->quality, d->aovs, d->energy, d->shading,
        d->ogl1.variant, d->ogl1.is_linear, d->ogl1.ignores_fog, d->ogl1.translates_directions,
        d->has_specular_antialiasing, d->ambient_occlusion, d->decodes_whole_textures, (double)d->exposure_ev,
        d->background, (double)d->background_blur, d->tonemap, d->part.has_display_tonemap, d->part.split,
        d->part.count, d->ground, d->path.denoises);
    add_floats(t, d->background_color, 3);
    for (int i = 0; i < 4; i++)
        add_number(t, d->crop[i]);
}

/* The key of a scene has these, too; a sea may have no scene. */
static void add_view(text *t, const facet_render_desc *d)
{
    const facet_camera *c = d->camera;
    const facet_path_desc *p = &d->path;
    add_floats(t, c->eye, 3);
    add_floats(t, c->target, 3);
    add_floats(t, c->up, 3);
    const float lens[] = {c->fov_y_rad, c->ortho_height,  c->aspect, c->near_m,
                          c->far_m,     c->lens_radius_m, c->focus_m};
    add_floats(t, lens, sizeof lens / sizeof *lens);
    add_floats(t, d->sun.illuminance_lux, 3);
    const float light[] = {d->sun.azimuth_rad,  d->sun.elevation_rad,
                           d->sun.diameter_rad, d->environment_rotation_rad,
                           d->environment_ev,   p->clamp,
                           p->shutter_s};
    add_floats(t, light, sizeof light / sizeof *light);
    ADD(t, p->max_depth, p->seed, p->filter, p->light_sampling, p->has_straight_shadows,
        d->ignores_scene_lights, d->pose.time_s);
}

static void add_sky(text *t, const facet_sky_desc *s)
{
    ADD(t, s->model, (double)s->sun_elevation_rad, (double)s->sun_azimuth_rad, (double)s->turbidity,
        (double)s->altitude_m, s->omits_disc, s->height, (double)s->illuminance_lux);
    add_floats(t, s->ground_albedo, 3);
}

static void add_water(text *t, const facet_water *w)
{
    ADD(t, w->kind, (double)w->chlorophyll_mg_m3, (double)w->salinity, (double)w->temperature_C,
        (double)w->ior, (double)w->foam_albedo);
    add_floats(t, w->absorption, 3);
    add_floats(t, w->scattering, 3);
    add_floats(t, w->backscattering, 3);
}

static void add_sea(text *t, const facet_sea *sea)
{
    const facet_sea_desc *s = &sea->desc;
    const float numbers[] = {
        s->wind_mps,         s->wind_direction_rad, s->fetch_m,       s->peakedness,
        s->swell.height_m,   s->swell.period_s,     s->choppiness,    s->swell.direction_rad,
        s->swell.peakedness, s->swell.elongation,   s->bed.depth_m,   s->bed.slope,
        s->bed.albedo[0],    s->bed.albedo[1],      s->bed.albedo[2], s->bed.direction_rad};
    add_floats(t, numbers, sizeof numbers / sizeof *numbers);
    ADD(t, s->spectrum, s->spreading, s->loop_s, s->resolution, s->cascade_count, sea->waves.time_s);
    text_addf(t, "%llu ", (unsigned long long)s->seed);
    add_water(t, &s->water);
}

static void add_sea_shading(text *t, const facet_sea_shading *s)
{
    ADD(t, s->style, s->normals, s->masking, s->has_schlick_fresnel, (double)s->perceptual_roughness,
        s->omits_glints, s->omits_foam, s->omits_caustics, s->stage, (double)s->clamp);
}

static void add_all(text *t, const facet_render_desc *d)
{
    char machine[64];
    text_add(t, FACET_VERSION " ");
    part_describe_machine(d, machine, sizeof machine);
    text_add_bytes(t, machine, strcspn(machine, ","));
    add_image(t, d);
    add_view(t, d);
    if (d->environment) {
        const image *panorama = &d->environment->panorama;
        uint64_t hash =
            cache_hash(panorama->width, panorama->pixels, image_row_size(panorama) * panorama->height);
        text_addf(t, "%llu ", (unsigned long long)hash);
    }
    if (!d->sea)
        return;
    add_sea(t, d->sea);
    add_sky(t, &d->sky);
    add_sea_shading(t, &d->sea_shading);
}

facet_result part_key_create(renderer_set *set, const facet_render_desc *whole, char hex[65],
                             facet_error *error)
{
    text t = {.allocator = whole->allocator};
    path_key scene = {.hex = ""};
    facet_render_desc undivided = *whole;
    undivided.part = (facet_part_desc){.count = 0};
    if (set->scene)
        TRY(path_key_create(&set->prepared, &undivided, &scene, error));
    text_addf(&t, "%s ", scene.hex);
    add_all(&t, whole);
    for (uint64_t i = 0; i < 4 && !t.has_failed; i++)
        snprintf(hex + 16 * i, 17, "%016llx", (unsigned long long)cache_hash(i + 1, t.data, t.length));
    bool has_memory = !t.has_failed;
    text_destroy(&t);
    return has_memory ? FACET_OK : fail_memory(error, "settings", 0);
}

/* ---- the machine ---- */

#if defined(__x86_64__)

/* Without fused multiply-adds all sets give the same bytes; those with them may each round differently. */
static const char *isa_name(facet_isa isa)
{
    bool is_native = isa == FACET_ISA_NATIVE;
    if (isa == FACET_ISA_AVX512 || (is_native && __builtin_cpu_supports("avx512vl")))
        return "avx512";
    if (isa == FACET_ISA_AVX2 || (is_native && __builtin_cpu_supports("avx2")))
        return "avx2";
    return "portable";
}

static void describe_embree(facet_isa isa, char *out, size_t size)
{
    unsigned highest, vendor[3] = {0};
    __cpuid(0, highest, vendor[0], vendor[2], vendor[1]);
    (void)highest;
    snprintf(out, size, "%s, %.12s", isa_name(isa), (const char *)vendor);
}

#else

static void describe_embree(facet_isa isa, char *out, size_t size)
{
    (void)isa;
    snprintf(out, size, "one instruction set, not x86-64");
}

#endif

void part_describe_machine(const facet_render_desc *desc, char *out, size_t size)
{
    const ray_tracer *tracer = NULL;
    if (ray_tracer_choose(FACET_BVH_AUTO, &tracer, NULL) == FACET_OK && tracer == &bvh_tracer)
        snprintf(out, size, "own BVH");
    else
        describe_embree(desc->isa, out, size);
}
