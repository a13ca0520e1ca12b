/* libraries.c - the libraries that facet uses, their licenses, and whether this machine has them. */
#include "facet/facet.h"

#include <stdio.h>

#include "base/library.h"
#include "build_config.h"
#include "cpu/embree_version.h"

/* A library; version() of one that is opened when it is needed returns text. */
typedef struct library_row {
    const char *name, *license, *built_version, *file, *version_function;
} library_row;

/* OpenEXR brings Imath, and Embree TBB: what they link is theirs. libepoxy and GLFW are those of the OpenGL module. */
static const library_row rows[] = {
    {"Draco", "Apache-2.0", FACET_DRACO_VERSION, NULL, NULL},
    {"Embree", "Apache-2.0", NULL, FACET_EMBREE_FILE, NULL}, /* its versions: embree_version.h */
    {"OpenEXR", "BSD-3-Clause", FACET_OPENEXR_VERSION, NULL, NULL},
    {"Zstandard", "BSD-3-Clause OR GPL-2.0-only", FACET_ZSTD_VERSION, NULL, NULL},
    {"astcenc", "Apache-2.0", FACET_ASTC_VERSION, NULL, NULL},
    {"jansson", "MIT", FACET_JANSSON_VERSION, NULL, NULL},
    {"kissfft", "BSD-3-Clause", FACET_KISSFFT_VERSION, NULL, NULL},
    {"libdeflate", "MIT", FACET_LIBDEFLATE_VERSION, NULL, NULL},
    {"libepoxy", "MIT", FACET_EPOXY_VERSION, NULL, NULL},
    {"libjpeg-turbo", "IJG AND BSD-3-Clause AND Zlib", FACET_TURBOJPEG_VERSION, NULL, NULL},
    {"libspng", "BSD-2-Clause", FACET_SPNG_VERSION, NULL, NULL},
    {"libwebp", "BSD-3-Clause", FACET_WEBP_VERSION, NULL, NULL},
    {"zlib", "Zlib", FACET_ZLIB_VERSION, NULL, NULL},
    {"GLFW", "Zlib", FACET_GLFW_VERSION, FACET_GLFW_FILE, "glfwGetVersionString"},
    {"cairo", "LGPL-2.1-only OR MPL-1.1", FACET_CAIRO_VERSION, FACET_CAIRO_FILE, "cairo_version_string"},
    {"libavif", "BSD-2-Clause", FACET_AVIF_VERSION, FACET_AVIF_FILE, "avifVersion"},
    {"libmicrohttpd", "LGPL-2.1-or-later", FACET_MICROHTTPD_VERSION, FACET_MICROHTTPD_FILE,
     "MHD_get_version"},
};

uint32_t facet_get_library_count(void)
{
    return sizeof rows / sizeof *rows;
}

facet_library_info facet_get_library(uint32_t index)
{
    const library_row *row = &rows[index];
    facet_library_info info = {.name = row->name,
                               .license = row->license,
                               .built_version =
                                   row->built_version ? row->built_version : embree_scene_version()};
    if (!*info.built_version)
        return info;
    info.file = row->file;
    if (row->file && !row->version_function)
        embree_find_version(info.found_version, sizeof info.found_version);
    else if (row->file)
        library_find_version(row->file, row->version_function, info.found_version, sizeof info.found_version);
    else
        snprintf(info.found_version, sizeof info.found_version, "%s", info.built_version);
    return info;
}
