/* ocean_names.c - see ocean_names.h. */
#include "cli/ocean/ocean_names.h"

#include <stdio.h>
#include <string.h>

#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/output.h"
#include "cli/shared/output_name.h"
#include "cli/render/render_names.h"

/* Their pattern, whose only place for a number is the tile's. */
static bool find_pattern(const ocean_options *o, uint32_t frame, char *pattern, size_t size)
{
    const char *maps = o->maps;
    size_t length = strlen(maps);
    if (output_name_has_frame(maps))
        return (size_t)snprintf(pattern, size, "%s", maps) < size;
    const char *slash = length && maps[length - 1] == '/' ? "" : "/";
    int used = o->picture.is_sequence ? snprintf(pattern, size, "%s%stile_##_%04u.exr", maps, slash, frame)
                                      : snprintf(pattern, size, "%s%stile_##.exr", maps, slash);
    return used > 0 && (size_t)used < size;
}

facet_result ocean_map_name(const ocean_options *o, uint32_t tile, uint32_t frame, char *name, size_t size,
                            facet_error *error)
{
    char pattern[RENDER_NAME_SIZE];
    return find_pattern(o, frame, pattern, sizeof pattern) &&
                   output_name_expand(pattern, &(model_name){.path = "sea"}, &tile, name, size)
               ? FACET_OK
               : fail(error, FACET_ERROR_ARGUMENT, "--maps: the names are too long");
}

facet_result ocean_check_name(const ocean_run *run, const char *name, facet_error *error)
{
    const render_options *p = &run->options.picture;
    bool is_of_model = run->model && facet_scene_has_file(run->model, name);
    if (is_of_model || render_name_is_input(run->base.line, p, NULL, name))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: it is an input, too, and would be overwritten; name another output", name);
    return output_check(name, error);
}

facet_result ocean_check_maps(const ocean_run *run, const char *name, uint32_t frame, facet_error *error)
{
    uint32_t count = run->options.maps ? facet_sea_get_info(run->sea).tile_count : 0;
    for (uint32_t tile = 0; tile < count; tile++) {
        char map[RENDER_NAME_SIZE];
        facet_result result = ocean_map_name(&run->options, tile, frame, map, sizeof map, error);
        if (result != FACET_OK)
            return result;
        if (input_is_same_file(name, map))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "--output: %s is one of the files of --maps; name another", name);
    }
    return FACET_OK;
}
