/* part_api.c - the functions of facet/part.h. */
#include "api/api.h"

#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/result.h"
#include "render/part.h"

facet_result facet_part_read_info(const char *path, facet_part_info *info, facet_error *error)
{
    *info = (facet_part_info){.count = 0};
    file_bytes file;
    part_header header;
    TRY(part_open(path, NULL, &file, error));
    facet_result result = part_header_read(file.data, file.size, path, &header, error);
    file_close(&file);
    if (result == FACET_OK)
        *info = header.info;
    return result;
}

facet_result facet_part_merge(const char *const *paths, size_t path_count, const facet_merge_desc *desc,
                              facet_image **image, facet_error *error)
{
    facet_merge_desc resolved = desc ? *desc : (facet_merge_desc){.thread_count = 0};
    double start = clock_seconds();
    *image = NULL;
    if (!resolved.thread_count)
        resolved.thread_count = facet_thread_count();
    facet_image *made = mem_zalloc(&resolved.allocator, 1, sizeof *made);
    if (!made)
        return fail_memory(error, "image", sizeof *made);
    facet_result result = part_merge(paths, path_count, &resolved, &made->film, &made->stats, error);
    made->stats.thread_count = resolved.thread_count;
    made->stats.total_s = clock_seconds() - start;
    if (result == FACET_OK)
        *image = made;
    else
        mem_free(made);
    return result;
}
