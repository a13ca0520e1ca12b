/* externals_none.c - the viewer without external assets of glTF 2.1, which it leaves out for its size. */
#include "io/gltf/gltf_reader.h"

bool gltf_load_uri(io_reader *r, const char *uri, uri_bytes *out)
{
    return io_load_uri(r, uri, out);
}

void gltf_read_externals(io_reader *r, const json_place *root)
{
    if (io_has_member(root, "externalAssets"))
        io_warn(r, root, "externalAssets",
                "are not read in pages; \"facet convert\" makes one file of the model and its assets");
}
