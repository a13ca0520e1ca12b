/* model_kind.c - see model_kind.h. */
#include "io/model_kind.h"

#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/result.h"
#include "image/image.h"
#include "io/obj/obj.h"
#include "io/ogl1/ogl1_json.h"
#include "io/ply/ply.h"
#include "io/stl/stl.h"

/* ---- what facet does not read ---- */

#define WITH_BLENDER "import it in Blender and export it as glTF 2.0"
#define WITH_ASSIMP WITH_BLENDER ", or run: assimp export MODEL model.glb"

typedef struct foreign_kind {
    const char *extensions[4]; /* extensions, the likely ones first; NULL: none */
    const char *magic;         /* at the start of the file, after white space; NULL: any */
    const char *name, *advice;
} foreign_kind;

static const foreign_kind FOREIGN[] = {
    {{NULL}, "version https://git-lfs", "Git LFS pointer", "fetch the file that it stands for: git lfs pull"},
    {{NULL},
     "<!doctype html",
     "web page",
     "save the model itself, by its download link, not the page that shows it"},
    {{NULL}, "<html", "web page", "save the model itself, by its download link, not the page that shows it"},
    {{"fbx"}, "Kaydara FBX", "FBX", WITH_ASSIMP},
    {{"fbx"}, "; FBX", "FBX", WITH_ASSIMP},
    {{"usdz"}, "PK\x03\x04", "USDZ", WITH_BLENDER},
    {{"3mf"}, "PK\x03\x04", "3MF", "export it as STL from the slicer or CAD program, or " WITH_BLENDER},
    {{"usd", "usdc"}, "PXR-USDC", "USD", WITH_BLENDER},
    {{"usd", "usda"}, "#usda", "USD", WITH_BLENDER},
    {{"step", "stp"}, "ISO-10303-21", "STEP", "open it in FreeCAD and export it as glTF or STL"},
    {{"igs", "iges"}, NULL, "IGES", "open it in FreeCAD and export it as glTF or STL"},
    {{"blend"},
     "BLENDER",
     "Blender",
     "run: blender -b MODEL.blend --python-expr \"import bpy; "
     "bpy.ops.export_scene.gltf(filepath='model.glb')\""},
    {{"dae"}, "<COLLADA", "COLLADA", WITH_ASSIMP},
    {{"x3d", "x3dv"}, "<X3D", "X3D", WITH_BLENDER},
    {{"wrl", "vrml"}, "#VRML", "VRML", WITH_BLENDER},
    {{"3ds"}, "MM", "3DS", WITH_ASSIMP},
    {{"max"}, NULL, "3ds Max", "export it as glTF or OBJ from 3ds Max"},
    {{"ma", "mb"}, NULL, "Maya", "export it as OBJ or FBX from Maya and " WITH_BLENDER},
    {{"c4d"}, NULL, "Cinema 4D", "export it as glTF from Cinema 4D"},
    {{"skp"}, NULL, "SketchUp", "export it as glTF or OBJ from SketchUp"},
    {{"lwo", "lws"}, NULL, "LightWave", WITH_ASSIMP},
    {{"abc"}, "Ogawa", "Alembic", WITH_BLENDER},
    {{"off"}, "OFF", "OFF", "convert it with MeshLab to PLY or OBJ"},
    {{"vox"}, "VOX ", "MagicaVoxel", "export it as OBJ or PLY from MagicaVoxel"},
    {{"b3dm"}, "b3dm", "3D Tiles", "run: npx 3d-tiles-tools b3dmToGlb -i MODEL -o model.glb"},
    {{"drc"}, "DRACO", "Draco", "run: draco_decoder -i MODEL -o model.ply"},
    {{"las", "laz"}, "LASF", "LAS", "run: pdal translate MODEL model.ply"},
    {{"vtk"}, "# vtk", "VTK", "open it in ParaView and export it as PLY or glTF"},
    {{"zip", "kmz"}, "PK\x03\x04", "zip", "unpack it first: unzip MODEL"},
    {{"gz", "tgz"}, "\x1f\x8b", "gzip", "unpack it first: gunzip MODEL"},
    {{"7z"}, "7z\xbc\xaf", "7z", "unpack it first: 7z x MODEL"},
    {{"rar"}, "Rar!", "RAR", "unpack it first: unrar x MODEL"},
    {{"xz"},
     "\xfd"
     "7zXZ",
     "xz",
     "unpack it first: xz -d MODEL"},
    {{"zst"}, "\x28\xb5\x2f\xfd", "Zstandard", "unpack it first: zstd -d MODEL"},
};
enum { FOREIGN_COUNT = sizeof FOREIGN / sizeof *FOREIGN };

static bool has_extension(const foreign_kind *kind, const char *name)
{
    for (int i = 0; i < 4 && kind->extensions[i]; i++)
        if (strcasecmp(path_extension(name), kind->extensions[i]) == 0)
            return true;
    return false;
}

/* The position after a byte order mark and white space. */
static size_t find_start(const char *bytes, size_t size)
{
    size_t i = size >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    while (i < size && (bytes[i] == ' ' || bytes[i] == '\t' || bytes[i] == '\n' || bytes[i] == '\r'))
        i++;
    return i;
}

static bool begins_with(const char *bytes, size_t size, const char *magic)
{
    size_t start = find_start(bytes, size);
    size_t length = strlen(magic);
    return size - start >= length && strncasecmp(bytes + start, magic, length) == 0;
}

/* COLLADA and X3D follow an XML declaration. */
static bool names_root(const char *bytes, size_t size, const char *magic)
{
    enum { HEADING = 1024 };
    size_t length = strlen(magic);
    if (magic[0] != '<' || !begins_with(bytes, size, "<?xml"))
        return false;
    for (size_t i = 0; i + length <= size && i < HEADING; i++)
        if (memcmp(bytes + i, magic, length) == 0)
            return true;
    return false;
}

/* By extension and content, by magic bytes, by extension; NULL: unknown. A magic of two letters also needs
 * the extension. */
static const foreign_kind *find_foreign(const char *bytes, size_t size, const char *name)
{
    const foreign_kind *found = NULL;
    for (int pass = 0; pass < 3 && !found; pass++)
        for (int i = 0; i < FOREIGN_COUNT && !found; i++) {
            const foreign_kind *kind = &FOREIGN[i];
            bool is_named = has_extension(kind, name);
            bool is_alike = kind->magic &&
                            (begins_with(bytes, size, kind->magic) || names_root(bytes, size, kind->magic));
            bool is_sure = is_alike && strlen(kind->magic) > 3;
            bool is_found = pass == 0 ? is_named && is_alike : pass == 1 ? is_sure : is_named;
            found = is_found ? kind : NULL;
        }
    /* Other archives are recognized by their extension only. */
    if (found && strcmp(found->magic ? found->magic : "", "PK\x03\x04") == 0 && !has_extension(found, name))
        for (int i = 0; i < FOREIGN_COUNT; i++)
            if (strcmp(FOREIGN[i].name, "zip") == 0)
                return &FOREIGN[i];
    return found;
}

/* ---- detection ---- */

static bool is_gltf(const char *bytes, size_t size)
{
    return (size >= 4 && memcmp(bytes, "glTF", 4) == 0) || begins_with(bytes, size, "{");
}

model_kind model_kind_detect(const void *bytes, size_t size, const char *name)
{
    const char *extension = path_extension(name);
    if (ogl1_json_detect(bytes, size))
        return MODEL_PARAMETERS;
    if (is_gltf(bytes, size))
        return MODEL_GLTF;
    if (ply_detect(bytes, size))
        return MODEL_PLY;
    if (stl_detect(bytes, size))
        return MODEL_STL;
    bool is_obj = strcasecmp(extension, "obj") == 0 && obj_has_faces(bytes, size);
    if (is_obj || obj_detect(bytes, size))
        return MODEL_OBJ;
    if (find_foreign(bytes, size, name))
        return MODEL_FOREIGN;
    if (obj_has_faces(bytes, size))
        return MODEL_OBJ;
    return strcasecmp(extension, "stl") == 0   ? MODEL_STL
           : strcasecmp(extension, "ply") == 0 ? MODEL_PLY
                                               : MODEL_UNKNOWN;
}

facet_result model_kind_refuse(const void *bytes, size_t size, const char *name, facet_error *error)
{
    const foreign_kind *kind = find_foreign(bytes, size, name);
    if (kind && !kind->extensions[0])
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: is a %s, not a model; %s", name, kind->name,
                    kind->advice);
    if (kind)
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: %s files are not read; %s", name, kind->name,
                    kind->advice);
    image_codec codec = image_codec_detect(bytes, size);
    if (codec != IMAGE_CODEC_UNKNOWN && codec != IMAGE_CODEC_TGA) /* which begins with arbitrary text */
        return fail(error, FACET_ERROR_UNSUPPORTED,
                    "%s: is an image (%s), not a model; facet render --env and facet bake take it as an "
                    "environment, facet compare as an image",
                    name, image_codec_name(codec));
    return fail(
        error, FACET_ERROR_INVALID,
        "%s: is neither a .glb file nor the JSON of a .gltf file, nor an .obj, .stl or .ply file nor rgl's "
        "parameters",
        name);
}
