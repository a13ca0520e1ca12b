/* studio_draw.c - the panorama of the built-in studio.
 *
 * The studio is a photographer's set for a product that stands at the origin and faces +Z: a large key light
 * from the front, above and to the left, a dimmer fill from the right, two narrow strips behind for the rim,
 * a broad ceiling, all white, in a grey room, lighter above than below, so that metals reflect both bright
 * and dark parts. A soft box is a rectangle as seen from the origin whose edges fade over its softness. */
#include "ibl/studio_draw.h"

#include <math.h>

#include "base/parallel.h"
#include "base/result.h"
#include "base/simd.h"

enum { WIDTH = 512, HEIGHT = 256 };

/* A light at unit distance along its axis. */
typedef struct soft_box {
    float azimuth_deg;                       /* around +Y, 0: +Z, positive: towards +X */
    float elevation_deg;                     /* above the horizon */
    float half_width, half_height, softness; /* tangents of angles from the axis */
    float radiance;                          /* cd/m^2 before scaling to a mean of 1 */
} soft_box;

static const soft_box boxes[] = {
    {-38.0f, 36.0f, 0.34f, 0.27f, 0.07f, 16.0f},  /* key */
    {52.0f, 20.0f, 0.20f, 0.42f, 0.08f, 5.0f},    /* fill */
    {0.0f, 88.0f, 0.80f, 0.60f, 0.40f, 3.2f},     /* ceiling */
    {138.0f, 24.0f, 0.10f, 0.70f, 0.05f, 13.0f},  /* rim, right */
    {-140.0f, 20.0f, 0.10f, 0.70f, 0.05f, 10.0f}, /* rim, left */
    {-98.0f, 4.0f, 0.22f, 0.60f, 0.18f, 2.5f},    /* edge, left */
    {96.0f, 0.0f, 0.30f, 0.40f, 0.25f, 1.5f},     /* edge, right */
};
enum { BOX_COUNT = sizeof boxes / sizeof boxes[0] };

/* Mean radiance of room() and the boxes over the sphere; a test checks that the result is 1. */
#define STUDIO_MEAN 1.56775f

typedef struct placed_box {
    float axis[3], right[3], up[3];
    double lowest, highest; /* elevations between which it is seen, rad */
} placed_box;

typedef struct studio {
    placed_box placed[BOX_COUNT];
    float cosine[WIDTH], sine[WIDTH]; /* cosine and sine of the longitude */
    float *pixels;
} studio;

static void place(const soft_box *b, placed_box *p)
{
    double azimuth = (double)b->azimuth_deg * 0.017453292519943295;
    double elevation = (double)b->elevation_deg * 0.017453292519943295;
    /* of the corners from the axis, and more than rounding */
    double reach = atan(hypot((double)b->half_width, (double)b->half_height)) + 1e-3;
    double sa = sin(azimuth);
    double ca = cos(azimuth);
    double se = sin(elevation);
    double ce = cos(elevation);
    *p = (placed_box){{(float)(ce * sa), (float)se, (float)(ce * ca)},
                      {(float)ca, 0.0f, (float)-sa},
                      {(float)(-se * sa), (float)ce, (float)(-se * ca)},
                      elevation - reach,
                      elevation + reach};
}

static inline float fade(float low, float high, float x)
{
    float t = (x - low) / (high - low);
    t = t < 0.0f ? 0.0f : t > 1.0f ? 1.0f : t;
    return t * t * (3.0f - 2.0f * t);
}

/* Walls: light grey overhead, darkest just below the horizon, a slightly lit floor. y is that of the
 * direction. */
static inline float room(float y)
{
    return 0.34f + 0.46f * fade(-0.05f, 0.95f, y) + 0.34f * fade(0.02f, 0.75f, -y);
}

static inline float box_radiance(const soft_box *b, const placed_box *p, float x, float y, float z)
{
    float depth = x * p->axis[0] + y * p->axis[1] + z * p->axis[2];
    float q = 1.0f / (depth > 0.05f ? depth : 0.05f);
    float right = fabsf(x * p->right[0] + y * p->right[1] + z * p->right[2]) * q;
    float up = fabsf(x * p->up[0] + y * p->up[1] + z * p->up[2]) * q;
    float edge = fade(b->half_width, b->half_width - b->softness, right) *
                 fade(b->half_height, b->half_height - b->softness, up);
    return depth > 0.05f ? edge * b->radiance : 0.0f;
}

DISPATCH_AVX2 static void draw_rows(void *context, size_t begin, size_t end)
{
    const studio *s = context;
    for (size_t row = begin; row < end; row++) {
        double theta = 3.14159265358979323846 * ((double)row + 0.5) / HEIGHT;
        float across = (float)sin(theta);
        float y = (float)cos(theta);
        float radiance[WIDTH];
        for (int i = 0; i < WIDTH; i++)
            radiance[i] = room(y);
        double elevation = 0.5 * 3.14159265358979323846 - theta;
        for (int b = 0; b < BOX_COUNT; b++)
            for (int i = 0; i < WIDTH && elevation > s->placed[b].lowest && elevation < s->placed[b].highest;
                 i++)
                radiance[i] +=
                    box_radiance(&boxes[b], &s->placed[b], across * s->cosine[i], y, across * s->sine[i]);
        float *out = s->pixels + row * WIDTH * 3;
        for (int i = 0; i < WIDTH; i++)
            out[3 * i] = out[3 * i + 1] = out[3 * i + 2] = radiance[i] * (1.0f / STUDIO_MEAN);
    }
}

facet_result studio_draw(const facet_allocator *allocator, uint32_t thread_count, image *out,
                         facet_error *error)
{
    TRY(image_create(allocator, WIDTH, HEIGHT, 3, IMAGE_F32, out, error));
    studio s = {.pixels = out->pixels};
    for (int b = 0; b < BOX_COUNT; b++)
        place(&boxes[b], &s.placed[b]);
    for (int i = 0; i < WIDTH; i++) {
        double phi = 6.283185307179586 * ((i + 0.5) / WIDTH - 0.5);
        s.cosine[i] = (float)cos(phi);
        s.sine[i] = (float)sin(phi);
    }
    parallel_for(thread_count, HEIGHT, 16, draw_rows, &s);
    return FACET_OK;
}
