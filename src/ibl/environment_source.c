/* environment_source.c - see environment_source.h. */
#include "ibl/environment_source.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ibl/cache.h"
#include "ibl/cube_layout.h"

static const facet_environment_desc default_desc;
enum { DEFAULT_MAX_SIZE = 32768 };

/* Decoding of sources: values that are not finite are kept, to be counted. *largest:
 * image_decode_desc.largest. */
static image_decode_desc decode_desc(const facet_environment_desc *desc, float *largest)
{
    return (image_decode_desc){.allocator = desc->allocator,
                               .thread_count = desc->thread_count ? desc->thread_count : facet_thread_count(),
                               .max_size = desc->max_size ? desc->max_size : DEFAULT_MAX_SIZE,
                               .keeps_nonfinite = true,
                               .clips_gamut = true,
                               .largest = largest};
}

/* ---- repairs ---- */

typedef struct repairing {
    image *panorama;
    float largest;
    uint64_t first_place;
    _Atomic uint64_t count, first;
} repairing;

/* Clamps to [0, ENVIRONMENT_MAX_RADIANCE]; false: the value was negative or not finite. */
static inline bool repair(float *x, float largest)
{
    bool is_good = *x >= 0.0f && *x <= 0x1.fffffep127f;
    float y = is_good ? *x : *x > 0.0f ? largest : 0.0f; /* NaN is not above 0 */
    *x = y < ENVIRONMENT_MAX_RADIANCE ? y : ENVIRONMENT_MAX_RADIANCE;
    return is_good;
}

static void repair_rows(void *context, size_t begin, size_t end)
{
    repairing *r = context;
    uint64_t count = 0, first = UINT64_MAX;
    float *p = (float *)r->panorama->pixels + 3 * begin * r->panorama->width;
    for (size_t i = begin * r->panorama->width; i < end * r->panorama->width; i++, p += 3) {
        bool is_good = repair(p, r->largest);
        is_good &= repair(p + 1, r->largest);
        is_good &= repair(p + 2, r->largest);
        if (is_good)
            continue;
        first = count++ ? first : r->first_place + i;
    }
    atomic_fetch_add(&r->count, count);
    uint64_t known = atomic_load(&r->first);
    while (first < known && !atomic_compare_exchange_weak(&r->first, &known, first))
        ;
}

/* Converts decoded, which is released, to F32 RGB in [0, ENVIRONMENT_MAX_RADIANCE]; repairs and counts texels
 * that are negative or not finite. largest replaces infinity; first_place is the position of the first texel.
 * FACET_ERROR_MEMORY. */
static facet_result repair_image(image *decoded, float largest, uint64_t first_place,
                                 const facet_allocator *allocator, uint32_t thread_count, image *out,
                                 environment_repairs *repairs, facet_error *error)
{
    facet_result result = FACET_OK;
    if (decoded->type == IMAGE_F32 && decoded->channel_count == 3 && !decoded->is_srgb) {
        *out = *decoded;
        *decoded = (image){0};
    } else {
        result = image_convert(decoded, allocator, thread_count, 3, IMAGE_F32, false, out, error);
        image_destroy(decoded);
    }
    if (result != FACET_OK)
        return result;
    repairing r = {.panorama = out, .largest = largest, .first_place = first_place};
    atomic_init(&r.count, 0);
    atomic_init(&r.first, UINT64_MAX);
    parallel_for(thread_count, out->height, 16, repair_rows, &r);
    uint64_t first = atomic_load(&r.first);
    repairs->count += atomic_load(&r.count);
    repairs->first = first < repairs->first ? first : repairs->first;
    return FACET_OK;
}

void environment_report(facet_environment *e, const environment_repairs *repairs, const char *name,
                        const char *place, uint32_t x, uint32_t y)
{
    e->repaired_texels = repairs->count;
    if (repairs->count)
        log_warning(&e->log,
                    "%s: %" PRIu64
                    " texel%s NaN, infinity or less than 0, the first at (%u, %u)%s%s: taken as 0, "
                    "infinity as the largest number that its format has, at most 1e12",
                    name, repairs->count, repairs->count == 1 ? " is" : "s are", x, y, place ? " of " : "",
                    place ? place : "");
}

/* ---- layouts ---- */

/* Rows of resampled panoramas. */
enum { MIN_ROWS = 64, MAX_ROWS = 8192 };

/* Rows of 1.57 / n rad: texels of a cube are 2 / n wide in the center of a face, 1.45 / n on average and 0.94
 * / n at its corners. That makes 8 n^2 texels from 6 n^2, two lookups per texel in each direction. Small
 * cubes get more rows, since radiance between their texels is linear in the cube, not in the panorama. */
facet_result environment_unroll(facet_environment *e, const cube *c, const sphere_turn *turn,
                                uint32_t thread_count, facet_error *error)
{
    uint32_t rows = c->size > MAX_ROWS / 2 ? MAX_ROWS : 2 * c->size;
    rows = rows < MIN_ROWS ? MIN_ROWS : rows;
    TRY(image_create(&e->allocator, 2 * rows, rows, 3, IMAGE_F32, &e->panorama, error));
    cube from = *c;
    sphere source = sphere_of_cube(&from);
    sphere target = sphere_of_image(SPHERE_EQUIRECT, &e->panorama);
    sphere_turn quick = turn ? *turn : (sphere_turn){.scale = 1.0f};
    quick.parts = rows == 2 * c->size ? 2 : 0;
    facet_result result = sphere_resample(&source, &quick, &e->allocator, thread_count, &target, error);
    environment_limit(e, thread_count);
    return result;
}

/* As many rows as the octahedral image, whose texels are not smaller. */
static facet_result take_octahedron(facet_environment *e, const image *panorama, uint32_t thread_count,
                                    facet_error *error)
{
    uint32_t rows = panorama->height < MAX_ROWS ? panorama->height : MAX_ROWS;
    TRY(image_create(&e->allocator, 2 * rows, rows, 3, IMAGE_F32, &e->panorama, error));
    sphere source = sphere_of_image(SPHERE_OCTAHEDRON, panorama);
    sphere target = sphere_of_image(SPHERE_EQUIRECT, &e->panorama);
    facet_result result = sphere_resample(&source, NULL, &e->allocator, thread_count, &target, error);
    environment_limit(e, thread_count);
    return result;
}

/* Takes a repaired image, which is released, in any layout but AUTO and FACES; its size fits the layout. */
static facet_result take_image(facet_environment *e, image *panorama, facet_layout layout, const char *name,
                               uint32_t thread_count, facet_error *error)
{
    facet_result result = FACET_OK;
    e->layout = layout;
    e->source_width = panorama->width;
    e->source_height = panorama->height;
    if (layout_is_faces(layout)) {
        result = layout_read(panorama, layout, name, &e->allocator, thread_count, &e->faces, error);
        image_destroy(panorama);
        e->source_width = e->source_height = e->faces.size;
        if (result == FACET_OK)
            result = environment_unroll(e, &e->faces, NULL, thread_count, error);
    } else if (layout == FACET_LAYOUT_OCTAHEDRAL) {
        result = take_octahedron(e, panorama, thread_count, error);
    } else {
        e->panorama = *panorama;
        *panorama = (image){0};
    }
    image_destroy(panorama);
    return result;
}

/* ---- six faces ---- */

const char *const cube_face_names[6] = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};

typedef struct face_decoding {
    cube_face *faces;
    const facet_environment_desc *desc;
} face_decoding;

static void decode_faces(void *context, size_t begin, size_t end)
{
    const face_decoding *job = context;
    for (size_t i = begin; i < end; i++) {
        cube_face *f = &job->faces[i];
        image_decode_desc decoding = decode_desc(job->desc, &f->largest);
        decoding.thread_count = 1;
        decoding.note = &f->note;
        f->result = image_decode(f->bytes, f->size, f->name, &decoding, &f->image, &f->error);
        if (f->result == FACET_OK && f->image.width != f->image.height)
            f->result = fail(&f->error, FACET_ERROR_INVALID, "%s: %u x %u texels: faces of a cube are square",
                             f->name, f->image.width, f->image.height);
    }
}

facet_result cube_faces_decode(cube_face faces[6], const facet_environment_desc *desc, facet_error *error)
{
    face_decoding job = {faces, desc};
    parallel_for(desc->thread_count, 6, 1, decode_faces, &job);
    facet_result result = FACET_OK;
    for (int i = 0; i < 6 && result == FACET_OK; i++) {
        if (faces[i].result != FACET_OK)
            result = fail(error, faces[i].result, "%s", faces[i].error.message);
        else if (faces[i].image.width != faces[0].image.width)
            result = fail(error, FACET_ERROR_INVALID, "%s has %u texels along an edge, face +X has %u",
                          faces[i].name, faces[i].image.width, faces[0].image.width);
        else if (i == 0 || strcmp(faces[i].note.text, faces[0].note.text) != 0)
            image_note_log(&faces[i].note, faces[i].name, &desc->log); /* identical notes once */
    }
    if (result != FACET_OK)
        cube_faces_destroy(faces);
    return result;
}

void cube_faces_destroy(cube_face faces[6])
{
    for (int i = 0; i < 6; i++)
        image_destroy(&faces[i].image);
}

static void fill_face(cube *c, uint32_t face, const float *p)
{
    for (int y = 0; y < (int)c->size; y++)
        for (int x = 0; x < (int)c->size; x++, p += 3)
            *cube_texel(c, face, x, y) = (rgbx){p[0], p[1], p[2], 0.0f};
}

facet_result cube_faces_assemble(cube_face faces[6], const facet_allocator *allocator, uint32_t thread_count,
                                 cube *out, environment_repairs *repairs, facet_error *error)
{
    uint64_t face_texels = (uint64_t)faces[0].image.width * faces[0].image.width;
    facet_result result = cube_create(faces[0].image.width, allocator, out, error);
    for (uint32_t i = 0; i < 6 && result == FACET_OK; i++) {
        image rgb = {0};
        result = repair_image(&faces[i].image, faces[i].largest, i * face_texels, allocator, thread_count,
                              &rgb, repairs, error);
        if (result == FACET_OK)
            fill_face(out, i, rgb.pixels);
        image_destroy(&rgb);
    }
    if (result != FACET_OK)
        cube_destroy(out);
    return result;
}

void cube_faces_place(const cube *c, uint64_t place, uint32_t *face, uint32_t *x, uint32_t *y)
{
    *x = (uint32_t)(place % c->size);
    *y = (uint32_t)(place / c->size % c->size);
    *face = (uint32_t)(place / c->size / c->size);
}

/* ---- cube maps ---- */

/* Takes six decoded faces. */
static facet_result take_faces(facet_environment *e, cube_face faces[6], const char *name,
                               const char *const places[6], uint32_t thread_count, facet_error *error)
{
    environment_repairs repairs = {.first = UINT64_MAX};
    TRY(cube_faces_assemble(faces, &e->allocator, thread_count, &e->faces, &repairs, error));
    uint32_t face, x, y;
    cube_faces_place(&e->faces, repairs.count ? repairs.first : 0, &face, &x, &y);
    environment_report(e, &repairs, name, places[face], x, y);
    cube_fill_borders(&e->faces);
    e->layout = FACET_LAYOUT_FACES;
    e->source_width = e->source_height = e->faces.size;
    return environment_unroll(e, &e->faces, NULL, thread_count, error);
}

/* ---- KTX2 ---- */

/* Takes level 0 of a KTX2 cube map. FACET_ERROR_LIMIT, and the errors of ktx2_load_level() and ktx2_decode(). */
static facet_result load_cube_ktx2(facet_environment *e, const ktx2 *k, const facet_environment_desc *desc,
                                   facet_error *error)
{
    static const char *const places[6] = {"face +X", "face -X", "face +Y", "face -Y", "face +Z", "face -Z"};
    cube_face faces[6] = {0};
    ktx2_data data = {0};
    image_decode_desc decoding = decode_desc(desc, NULL);
    if (k->width > decoding.max_size)
        return fail(error, FACET_ERROR_LIMIT, "%s: %u x %u texels, more than %u along an edge", k->name,
                    k->width, k->height, decoding.max_size);
    facet_result result = ktx2_load_level(k, 0, &desc->allocator, &data, error);
    for (uint32_t i = 0; i < 6 && result == FACET_OK; i++) {
        decoding.largest = &faces[i].largest;
        result = ktx2_decode(k, &data, 0, 0, i, &decoding, &faces[i].image, error);
    }
    ktx2_data_destroy(&data);
    if (result == FACET_OK)
        result = take_faces(e, faces, k->name, places, desc->thread_count, error);
    cube_faces_destroy(faces);
    return result;
}

/* ---- six files ---- */

static facet_result load_faces(facet_environment *e, const char *const paths[6],
                               const facet_environment_desc *desc, facet_error *error)
{
    file_bytes files[6] = {{0}};
    cube_face faces[6] = {0};
    facet_result result = FACET_OK;
    for (int i = 0; i < 6 && result == FACET_OK; i++) {
        result = file_open(paths[i], file_limit(desc->max_file_bytes), &desc->allocator, &files[i], error);
        faces[i].bytes = files[i].data;
        faces[i].size = files[i].size;
        faces[i].name = paths[i];
    }
    if (result == FACET_OK)
        result = cube_faces_decode(faces, desc, error);
    if (result == FACET_OK)
        result = take_faces(e, faces, "faces", paths, desc->thread_count, error);
    for (int i = 0; i < 6 && result == FACET_OK; i++)
        cache_identify(e, files[i].data, files[i].size);
    cube_faces_destroy(faces);
    for (int i = 0; i < 6; i++)
        file_close(&files[i]);
    return result;
}

facet_result facet_environment_load_faces(const char *const paths[6], const facet_environment_desc *desc,
                                          facet_environment **environment, facet_error *error)
{
    assert(paths && environment);
    *environment = NULL;
    desc = desc ? desc : &default_desc;
    facet_environment *e = NULL;
    TRY(environment_create(desc, &e, error));
    facet_result result = load_faces(e, paths, desc, error);
    if (result == FACET_OK)
        *environment = e;
    else
        environment_release(e);
    return result;
}

/* ---- one file ---- */

/* The layout of an image: by desc, by the attribute of an OpenEXR file, or by its size. */
static facet_result choose_layout(const facet_environment_desc *desc, image_envmap envmap,
                                  const image *panorama, const char *name, facet_layout *layout,
                                  facet_error *error)
{
    uint32_t width = panorama->width, height = panorama->height;
    *layout = desc->layout                     ? desc->layout
              : envmap == IMAGE_ENVMAP_LATLONG ? FACET_LAYOUT_EQUIRECTANGULAR
                                               : layout_detect(width, height); /* also for a cube: 1:6 */
    if (*layout == FACET_LAYOUT_FACES)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: the layout of six faces needs six images; this is one",
                    name);
    double ratio = width / (2.0 * height);
    if (*layout == FACET_LAYOUT_AUTO && fabs(ratio - 1.0) > 0.05)
        return fail(
            error, FACET_ERROR_INVALID,
            "%s: %u x %u texels: an environment is 2:1 (equirectangular), 4:3 or 3:4 (cross), 6:1 or 1:6 "
            "(strip of faces), or six files NAME{face}.EXT; for any other shape, or an octahedral map, name "
            "the "
            "layout (facet_environment_desc.layout; facet bake --input-layout)",
            name, width, height);
    if (*layout == FACET_LAYOUT_AUTO)
        *layout = FACET_LAYOUT_EQUIRECTANGULAR;
    if (*layout == FACET_LAYOUT_EQUIRECTANGULAR && width != 2 * (uint64_t)height)
        log_warning(&desc->log,
                    "%s: %u x %u texels: an equirectangular image is twice as wide as high; this one is "
                    "stretched over the sphere",
                    name, width, height);
    return layout_check(*layout, width, height, name, error);
}

/* Loads an image of any layout. */
static facet_result load_image(facet_environment *e, const void *bytes, size_t size, const char *name,
                               const facet_environment_desc *desc, facet_error *error)
{
    float largest;
    image_note note;
    image header, decoded = {0}, rgb = {0};
    environment_repairs repairs = {.first = UINT64_MAX};
    facet_layout layout;
    const image_envmap envmap = image_get_envmap(bytes, size);
    image_decode_desc decoding = decode_desc(desc, &largest);
    decoding.note = &note;
    facet_result result = image_probe(bytes, size, name, &header, NULL, error);
    if (result == FACET_OK) /* before memory is allocated */
        result = choose_layout(desc, envmap, &header, name, &layout, error);
    if (result == FACET_OK)
        result = image_decode(bytes, size, name, &decoding, &decoded, error);
    if (result == FACET_OK) {
        image_note_log(&note, name, &e->log);
        result = repair_image(&decoded, largest, 0, &e->allocator, desc->thread_count, &rgb, &repairs, error);
    }
    if (result == FACET_OK) {
        environment_report(e, &repairs, name, NULL, (uint32_t)(repairs.first % rgb.width),
                           (uint32_t)(repairs.first / rgb.width));
        if (envmap == IMAGE_ENVMAP_CUBE && layout == FACET_LAYOUT_STRIP_VERTICAL)
            layout_flip_inside_faces(&rgb);
        result = take_image(e, &rgb, layout, name, desc->thread_count, error);
    }
    image_destroy(&decoded);
    return result;
}

/* Loads KTX2: a cube map or an image. */
static facet_result load_ktx2(facet_environment *e, const void *bytes, size_t size, const char *name,
                              const facet_environment_desc *desc, facet_error *error)
{
    ktx2 k;
    TRY(ktx2_open(bytes, size, name, &k, error));
    if (k.layer_count > 1)
        return fail(error, FACET_ERROR_UNSUPPORTED,
                    "%s: KTX2: an array of %u textures: one cube map or one image was expected", name,
                    k.layer_count);
    return k.is_cube ? load_cube_ktx2(e, &k, desc, error) : load_image(e, bytes, size, name, desc, error);
}

facet_result facet_environment_load_memory(const void *bytes, size_t size, const char *name,
                                           const facet_environment_desc *desc,
                                           facet_environment **environment, facet_error *error)
{
    assert(environment && (bytes || size == 0));
    *environment = NULL;
    desc = desc ? desc : &default_desc;
    name = name ? name : "environment";
    uint64_t max_bytes = file_limit(desc->max_file_bytes);
    if (size > max_bytes)
        return fail(error, FACET_ERROR_LIMIT, "%s: %zu bytes: at most %llu are read", name, size,
                    (unsigned long long)max_bytes);
    facet_environment *e = NULL;
    TRY(environment_create(desc, &e, error));
    bool is_ktx2 = image_codec_detect(bytes, size) == IMAGE_CODEC_KTX2;
    facet_result result = (is_ktx2 ? load_ktx2 : load_image)(e, bytes, size, name, desc, error);
    if (result != FACET_OK) {
        environment_release(e);
        return result;
    }
    cache_identify(e, bytes, size);
    *environment = e;
    return FACET_OK;
}

facet_result facet_environment_load(const char *path, const facet_environment_desc *desc,
                                    facet_environment **environment, facet_error *error)
{
    assert(path && environment);
    *environment = NULL;
    desc = desc ? desc : &default_desc;
    file_bytes file = {0};
    TRY(file_open(path, file_limit(desc->max_file_bytes), &desc->allocator, &file, error));
    facet_result result = facet_environment_load_memory(file.data, file.size, path, desc, environment, error);
    file_close(&file);
    return result;
}
