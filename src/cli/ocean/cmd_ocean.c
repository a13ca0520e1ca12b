/* cmd_ocean.c - facet ocean: images, maps and meshes of a sea. */
#include "cli/shared/options.h"

#include "cli/ocean/ocean_run.h"
#include "cli/render/render_output.h"
#include "cli/render/video.h"
#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/output.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- names ---- */

/* The pattern of maps; its only number is the tile's. */
static bool find_pattern(const ocean_options *o, uint32_t frame, char *pattern, size_t size)
{
    const char *maps = o->maps;
    size_t length = strlen(maps);
    if (output_name_has_frame(maps))
        return (size_t)snprintf(pattern, size, "%s", maps) < size;
    const char *slash = length && maps[length - 1] == '/' ? "" : "/";
    int used = o->render.is_sequence ? snprintf(pattern, size, "%s%stile_##_%04u.exr", maps, slash, frame)
                                     : snprintf(pattern, size, "%s%stile_##.exr", maps, slash);
    return used > 0 && (size_t)used < size;
}

static facet_result ocean_map_name(const ocean_options *o, uint32_t tile, uint32_t frame, char *name,
                                   size_t size, facet_error *error)
{
    char pattern[RENDER_NAME_SIZE];
    return find_pattern(o, frame, pattern, sizeof pattern) &&
                   output_name_expand(pattern, &(model_name){.path = "sea"}, &tile, name, size)
               ? FACET_OK
               : fail(error, FACET_ERROR_ARGUMENT, "--maps: the names are too long");
}

static facet_result ocean_check_name(const ocean_run *run, const char *name, facet_error *error)
{
    const render_options *p = &run->options.render;
    bool is_of_model = run->model && facet_scene_has_file(run->model, name);
    if (is_of_model || render_name_is_input(run->base.line, p, NULL, name))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: this input would be overwritten; name another output",
                    name);
    return output_check(name, error);
}

static facet_result ocean_check_maps(const ocean_run *run, const char *name, uint32_t frame,
                                     facet_error *error)
{
    uint32_t count = run->options.maps ? facet_sea_get_info(run->sea).tile_count : 0;
    for (uint32_t tile = 0; tile < count; tile++) {
        char map[RENDER_NAME_SIZE];
        facet_result result = ocean_map_name(&run->options, tile, frame, map, sizeof map, error);
        if (result != FACET_OK)
            return result;
        if (input_is_same_file(name, map))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "--output: %s is also a file of --maps; name another output", name);
    }
    return FACET_OK;
}

const verb ocean_verb = {
    .name = "ocean",
    .summary = "render the sea, or write it as maps and meshes",
    .arguments = "",
    .output_types = "png jpg jpeg webp exr hdr pfm y4m glb gltf obj",
    .description =
        "Renders a sea from its physics: a wave spectrum from wind and fetch, the optical properties "
        "of the water, under a sky or an environment, exposed by a light meter. --preset starts from "
        "a predefined sea; all other options change it. Azimuths are degrees from +Z towards +X; "
        "those of wind and waves are where they travel to.\n\n"
        "An output of .glb, .gltf or .obj holds the surface as a mesh with the water's material; "
        "--maps writes the wave tiles for other renderers; --info and --json print the properties of "
        "the sea.",
    .examples =
        (const example[]){
            {"facet ocean -o sea.png", "a fresh breeze, the sun at the right"},
            {"facet ocean --preset gale --sun 12 -o gale.jpg --size 1920x1080", "a gale at low sun"},
            {"facet ocean --preset lagoon --height-of-eye 20 -o lagoon.png", "sand below clear water"},
            {"facet ocean --wind 7,45 --swell 2,12,90 --chl 1 -o 'sea_####.png' --loop 24", "a loop of 24 s"},
            {"facet ocean --before-after -o compare.png", "legacy style and now"},
            {"facet ocean --sweep roughness=0.01:0.1:5,ior=1.3:1.4:5 -s 320x180 -o sweep.png",
             "a sheet of 25"},
            {"facet ocean --preset harbour --info", "wave heights, periods, colors"},
            {"facet ocean --with ship.glb@0,40 --with boat.glb@8,20,90 --camera Bridge -o fleet.png",
             "two models, seen by a camera of one"},
            {"facet ocean --wind 8 -o sea.glb --maps maps", "a mesh, and maps in a folder that exists"},
            {NULL, NULL}},
    .basics = OPTION_IDS(OPT_OUTPUT, OPT_SIZE, OPT_PRESET, OPT_WIND, OPT_WATER, OPT_DEPTH, OPT_SUN,
                         OPT_HEADING, OPT_EYE_HEIGHT, OPT_FRAMES, OPT_LOOP, OPT_EXPOSURE, OPT_RENDERER,
                         OPT_WITH, OPT_MAPS, OPT_JSON),
    .groups =
        (const option_group *const[]){
            OPTION_GROUP("Output", OPT_OUTPUT, OPT_NO_CLOBBER, OPT_FORMAT, OPT_SIZE, OPT_CROP, OPT_AOV,
                         OPT_INFO, OPT_MAPS, OPT_MESH_SIZE, OPT_MESH_SAMPLES, OPT_JPEG_QUALITY),
            OPTION_GROUP("Waves", OPT_PRESET, OPT_WIND, OPT_FETCH, OPT_SWELL, OPT_SPECTRUM, OPT_SPREADING,
                         OPT_CHOPPINESS, OPT_SEED, OPT_TILE_SAMPLES, OPT_CASCADES),
            OPTION_GROUP("Water and bed", OPT_WATER, OPT_CHLOROPHYLL, OPT_ABSORPTION, OPT_SALINITY,
                         OPT_TEMPERATURE, OPT_IOR, OPT_DEPTH, OPT_BED_SLOPE, OPT_BED_COLOR),
            OPTION_GROUP("Light and exposure", OPT_SUN, OPT_TURBIDITY, OPT_ENV, OPT_EXPOSURE, OPT_EV100,
                         OPT_TONE_MAPPING),
            &environment_group,
            OPTION_GROUP("Camera", OPT_EYE_HEIGHT, OPT_HEADING, OPT_EYE, OPT_TARGET, OPT_FOV, OPT_CAMERA),
            OPTION_GROUP("Shading", OPT_BEFORE, OPT_BEFORE_AFTER, OPT_STAGE, OPT_ROUGHNESS, OPT_NORMALS,
                         OPT_MASKING, OPT_FRESNEL, OPT_NO_GLINTS, OPT_NO_FOAM, OPT_NO_CAUSTICS, OPT_CLAMP,
                         OPT_SWEEP),
            OPTION_GROUP("Models", OPT_WITH, OPT_SHADING, OPT_OGL1_VARIANT, OPT_OGL1_SPACE, OPT_FOG),
            OPTION_GROUP("Quality", OPT_QUALITY, OPT_SAMPLES, OPT_RENDERER, OPT_DENOISE),
            OPTION_GROUP("Motion", OPT_TIME, OPT_FRAMES, OPT_FPS, OPT_LOOP),
            OPTION_GROUP("Several machines", OPT_SHARD, OPT_SHARD_BY), &limits_group, &messages_group,
            OPTION_GROUP("Running", OPT_PROGRESS, OPT_CONFIG), NULL},
};

/* Reports an output that is not an image: its name only. */
static void report_file(ocean_run *run, const char *name)
{
    if (run->outputs)
        json_array_append_new(run->outputs, json_pack("{s:o}", "output", report_string_json(name)));
}

static void report_output(ocean_run *run, const image_report *report)
{
    report_image(&run->base.messages, report, false);
    if (run->outputs)
        json_array_append_new(run->outputs, report->is_kept ? report_image_json(report)
                                                            : ocean_report_image_json(run, report));
}

/* Whether --no-clobber keeps the file name, which is then reported. */
static bool is_kept(ocean_run *run, const char *name)
{
    const render_options *p = &run->options.render;
    if (!p->keeps_existing || run->video || p->is_stdout || !output_exists(name))
        return false;
    report_output(run, &(image_report){.model = "sea", .output = name, .is_kept = true});
    return true;
}

/* ---- images ---- */

static facet_result make_image(ocean_run *run, uint32_t index, const char *name, facet_error *error)
{
    const ocean_options *options = &run->options;
    double start = interrupt_clock();
    facet_image *image = NULL;
    ocean_step step = {name, index, options->render.frames.frame_count};
    facet_result result = options->sweep ? ocean_sweep(run, name, &image, error)
                                         : ocean_run_draw(run, options, step, &image, error);
    double drawn = interrupt_clock();
    if (result == FACET_OK)
        result = render_write(&options->render, image, name, &run->base.allocator, run->video, error);
    if (result == FACET_OK) {
        facet_image_view view = facet_image_get_layer(image, 0);
        const facet_render_desc *d = &options->render.desc;
        image_report report = {.model = "sea",
                               .output = name,
                               .width = view.width,
                               .height = view.height,
                               .samples =
                                   d->samples ? d->samples : options->render.renderer.samples[d->quality],
                               .stats = facet_image_get_render_stats(image),
                               .save_s = interrupt_clock() - drawn,
                               .total_s = interrupt_clock() - start};
        report_partial(&run->base.messages, &report, NULL);
        report_output(run, &report);
        run->base.is_interrupted = report.stats.is_partial && interrupt_signal();
    }
    facet_image_destroy(image);
    return result;
}

/* ---- meshes ---- */

/* Whether the mesh has glTF materials; else those of OpenGL 1. */
static bool is_gltf(const char *name)
{
    const char *dot = strrchr(name, '.');
    return !dot || strcasecmp(dot, ".obj") != 0;
}

static facet_result make_mesh(ocean_run *run, const char *name, facet_error *error)
{
    facet_sea_mesh_desc desc = run->options.mesh;
    desc.allocator = run->base.allocator;
    facet_scene *scene = NULL;
    facet_result result = interrupt_check(name, error);
    if (result != FACET_OK)
        return result;
    const facet_scene_save_desc save = {.allocator = run->base.allocator,
                                        .log = messages_log(&run->base.messages)};
    interrupt_begin(name, "making it", false);
    result = facet_sea_create_mesh(run->sea, &desc, &scene, error);
    if (result == FACET_OK && !is_gltf(name))
        result = facet_scene_convert_materials(scene, FACET_MATERIAL_MODEL_OGL1, NULL, &save.log, error);
    interrupt_end();
    if (result == FACET_OK)
        result = interrupt_check(name, error);
    if (result == FACET_OK)
        result = output_write_scene(scene, name, save, error);
    if (result == FACET_OK) {
        message_at(&run->base.messages, VERBOSITY_DETAILS, "%s: written", name);
        report_file(run, name);
    }
    facet_scene_destroy(scene);
    return result;
}

/* ---- maps ---- */

static facet_result make_map(ocean_run *run, uint32_t tile, const char *name, facet_error *error)
{
    facet_image *image = NULL;
    snprintf(run->name, sizeof run->name, "%s", name);
    facet_result result = ocean_check_name(run, name, error);
    if (result == FACET_OK)
        result = interrupt_check(name, error);
    if (result == FACET_OK)
        result = facet_sea_create_maps(run->sea, tile, &run->base.allocator, &image, error);
    const facet_image_save_desc save = {.allocator = run->base.allocator,
                                        .format = FACET_IMAGE_FORMAT_EXR_FLOAT,
                                        .thread_count = run->options.render.limits.thread_count};
    if (result == FACET_OK)
        result = output_write(image, name, &save, error);
    if (result == FACET_OK)
        report_file(run, name);
    facet_image_destroy(image);
    return result;
}

static facet_result make_maps(ocean_run *run, uint32_t frame, facet_error *error)
{
    facet_result result = FACET_OK;
    uint32_t count = facet_sea_get_info(run->sea).tile_count;
    if (!count)
        message_at(&run->base.messages, VERBOSITY_NORMAL, "--maps: the sea is flat and has none");
    for (uint32_t tile = 0; tile < count && result == FACET_OK; tile++) {
        char name[RENDER_NAME_SIZE];
        result = ocean_map_name(&run->options, tile, frame, name, sizeof name, error);
        if (result == FACET_OK && !is_kept(run, name))
            result = make_map(run, tile, name, error);
    }
    return result;
}

/* ---- the run ---- */

static facet_result set_moment(ocean_run *run, uint32_t number, facet_error *error)
{
    const render_options *p = &run->options.render;
    double time = p->has_time ? p->time_s : ((double)number - 1.0) / p->fps;
    run->time_s = time;
    facet_result result = facet_sea_set_time(run->sea, time, error);
    return result == FACET_OK && run->model ? ocean_float_place(run, error) : result;
}

static facet_result make_frame(ocean_run *run, uint32_t index, uint32_t number, const char *name,
                               facet_error *error)
{
    TRY(interrupt_check(*name ? name : "maps", error));
    TRY(set_moment(run, number, error));
    if (run->options.maps)
        TRY(make_maps(run, number, error));
    if (!*name)
        return FACET_OK;
    snprintf(run->name, sizeof run->name, "%s", run->options.render.is_stdout ? "stdout" : name);
    if (!run->video && !run->options.render.is_stdout) {
        TRY(ocean_check_name(run, name, error));
        TRY(ocean_check_maps(run, name, number, error));
    }
    return run->options.has_mesh ? make_mesh(run, name, error) : make_image(run, index, name, error);
}

/* --no-clobber skips frames whose output exists. */
static facet_result make_frames(ocean_run *run, facet_error *error)
{
    const render_options *p = &run->options.render;
    facet_result result = FACET_OK;
    for (uint32_t i = 0; i < p->frames.frame_count && result == FACET_OK && !run->base.is_interrupted; i++) {
        if (!part_options_has_frame(p, i))
            continue;
        uint32_t number = frame_list_at(&p->frames, i);
        char name[RENDER_NAME_SIZE] = "";
        if (p->output)
            result = render_name(p, &(model_name){.path = "sea"}, number, name, sizeof name, error);
        if (result != FACET_OK)
            return result;
        if (*name && is_kept(run, name)) {
            if (!run->options.maps)
                continue;
            *name = 0;
        }
        result = make_frame(run, i, number, name, error);
        messages_flush(&run->base.messages);
    }
    return result;
}

/* Warns of a --loop shorter than the peak period, which speeds waves up, and of one that is not a whole
 * number of frames, which jumps. */
static void warn_of_loop(ocean_run *run)
{
    const render_options *p = &run->options.render;
    double loop = run->options.sea.loop_s, frames = loop * p->fps;
    facet_log log = messages_log(&run->base.messages);
    double longest = facet_sea_get_info(run->sea).peak_period_s;
    char text[256] = "";
    if (loop > 0.0 && loop < longest)
        snprintf(text, sizeof text,
                 "--loop: %g s are less than the peak period of %.3g s; the highest waves run faster", loop,
                 longest);
    else if (loop > 0.0 && p->is_sequence && fabs(frames - round(frames)) > 1e-6 * frames)
        snprintf(text, sizeof text, "--loop: %g s are %g frames, not a whole number; the loop jumps", loop,
                 frames);
    if (*text)
        log_warning(&log, "%s", text);
}

/* Writes all outputs. --info describes the sea at the first frame's time. */
static facet_result make_all(ocean_run *run, facet_error *error)
{
    const ocean_options *options = &run->options;
    const render_options *p = &options->render;
    facet_result result = set_moment(run, p->has_frames ? frame_list_at(&p->frames, 0) : 1, error);
    if (result == FACET_OK && options->has_info && !is_given(run->base.line, OPT_JSON))
        ocean_report_print(run);
    warn_of_loop(run);
    if (result != FACET_OK || (!p->output && !options->maps))
        return result;
    if (p->output && p->video) {
        if (!p->is_stdout)
            result = ocean_check_name(run, p->output, error);
        if (result == FACET_OK)
            result = video_open(p->output, p->video, p->fps, &run->video, error);
    }
    if (result == FACET_OK)
        result = make_frames(run, error);
    facet_result closed = video_close(run->video, result == FACET_OK, error);
    return result == FACET_OK ? closed : result;
}

static facet_result load_environment(ocean_run *run, facet_error *error)
{
    const render_options *p = &run->options.render;
    environment_input input = p->environment;
    if (!p->has_environment)
        return FACET_OK;
    if (input.kind == ENVIRONMENT_NONE) /* a NULL environment would be the sky */
        TRY(environment_input_parse("--env", "constant:0", 0, &input, error));
    const facet_environment_desc desc = verb_run_environment_desc(&run->base, p->environment_cache);
    return environment_input_load(&input, &desc, &run->environment, error);
}

/* Warns of an environment that the sun outshines: an image without units is black beside a sun in lux. */
static void warn_of_sun(ocean_run *run)
{
    const facet_render_desc *d = &run->options.render.desc;
    facet_environment_info info;
    if (!run->environment || facet_environment_get_info(run->environment, &info, NULL) != FACET_OK)
        return;
    double radiance = 0.2126 * info.mean[0] + 0.7152 * info.mean[1] + 0.0722 * info.mean[2];
    double lux = 3.141592653589793 * radiance * exp2((double)d->environment_ev);
    double times = (double)d->sun.illuminance_lux[1] / lux;
    if (!(lux > 0.0) || times < 1000.0)
        return;
    facet_log log = messages_log(&run->base.messages);
    log_warning(&log,
                "--sun: it has %.2g times the illuminance of the environment, %.2g lx, which will look "
                "black; --env-intensity scales the environment",
                times, lux);
}

static facet_result check_names(const command_line *c, const ocean_options *o, facet_error *error)
{
    model_name sea = {.number = 1, .count = 1};
    size_t no_clash = MODEL_NO_CLASH;
    model_list one = {.models = &sea, .count = 1, .clashes = &no_clash};
    return render_names_check(c, &o->render, &one, error);
}

static facet_result read_line(verb_run *base, facet_error *error)
{
    ocean_options *o = &((ocean_run *)base)->options;
    TRY(ocean_options_read(base->line, o, error));
    base->limits = o->render.limits;
    return o->render.output && !o->render.has_frames ? check_names(base->line, o, error) : FACET_OK;
}

static facet_result make(ocean_run *run, facet_error *error)
{
    const ocean_options *o = &run->options;
    if (o->has_image)
        TRY(load_environment(run, error));
    warn_of_sun(run);
    TRY(ocean_float_load(run, error));
    interrupt_begin("sea", "creating its waves and metering its light", false);
    TRY(ocean_run_set_sea(run, o, error));
    if (o->has_image && !o->sweep)
        TRY(ocean_run_meter(run, o, error));
    interrupt_end();
    return make_all(run, error);
}

static facet_result work(verb_run *base, facet_error *error)
{
    ocean_run *run = (ocean_run *)base;
    run->outputs = is_given(base->line, OPT_JSON) ? json_array() : NULL;
    facet_result result = make(run, error);
    if (result != FACET_OK)
        failure_complete(error, *run->name ? run->name : "sea", base->limits.max_memory_bytes);
    return result;
}

static void add_json(const verb_run *base, json_t *root)
{
    const ocean_run *run = (const ocean_run *)base;
    json_object_set_new(root, "sea", run->sea ? ocean_report_json(run) : json_null());
    json_object_set(root, "outputs", run->outputs);
}

static void destroy(verb_run *base)
{
    ocean_run *run = (ocean_run *)base;
    json_decref(run->outputs);
    facet_renderer_destroy(run->renderer);
    facet_sea_destroy(run->sea);
    facet_scene_destroy(run->model);
    free(run->models);
    facet_environment_destroy(run->environment);
}

int cmd_ocean(command_line *c)
{
    static const verb_work parts = {read_line, work, add_json, destroy};
    ocean_run run = {.sea = NULL};
    return verb_run_all(&run.base, c, &parts);
}
