/* compare_verb.c - facet compare: its arguments, options and help. */
#include "cli/shared/commands.h"

const verb compare_verb = {
    .name = "compare",
    .summary = "measure how far two pictures are apart",
    .arguments = "A B",
    .max_arguments = 2,
    .file_types = "png jpg jpeg webp avif tga bmp gif dds exr hdr pfm ktx2",
    .output_types = "png jpg jpeg webp exr hdr pfm",
    .description =
        "A is the reference, B what is compared with it; both are .png .jpg .webp .avif .tga .bmp "
        ".gif .dds .exr .hdr .pfm .ktx2, told apart by content; - is standard input, once. They have "
        "to be of the same size.\n\n"
        "Without limits the exit code is 0, however different they are. With --max or --min it is 1 "
        "where one is exceeded, and one line says by what; then numbers are printed only with "
        "--metric or -v.\n\n"
        "Files of light (exr, hdr, pfm, ktx2 with linear texels) are compared as light, all others "
        "as displays show them; of two that are not of a kind, the light is tone-mapped "
        "(--tone-mapping) and clamped. FLIP of light is the largest over a range of exposures.\n\n"
        "Pixels that are not a number, or infinite, in one picture and not the same in the other are "
        "in no mean, but they differ, infinitely far; with such pixels no limit holds.",
    .examples =
        (const example[]){
            {"facet compare reference.png render.png", "a table"},
            {"facet compare golden.exr new.exr --max flip=0.02,nrmse=0.01", "a test: exit 1 where it fails"},
            {"facet compare a.png b.png -o diff.png --heat-map --sheet", "to look at"},
            {"facet compare a.png b.png --metric psnr --min 40 -q", "only the exit code"},
            {"facet compare light.exr shot.png --tone-mapping neutral --json | jq .metrics.flip",
             "light and what a display shows"},
            {"facet render shoe.glb -o - --format png | facet compare golden.png - --max differing=0",
             "every bit that a file holds"},
            {NULL, NULL}},
    .basics = OPTION_IDS(OPT_METRIC, OPT_MAX, OPT_MIN, OPT_OUTPUT, OPT_HEAT_MAP, OPT_GAIN, OPT_MASK,
                         OPT_LAYER, OPT_SPACE, OPT_EXPOSURE, OPT_TONE_MAPPING, OPT_JSON),
    .groups =
        (const option_group *const[]){OPTION_GROUP("Metrics", OPT_METRIC, OPT_MAX, OPT_MIN, OPT_PERCENTILE,
                                                   OPT_THRESHOLD, OPT_PIXELS_PER_DEGREE, OPT_PEAK,
                                                   OPT_EPSILON),
                                      OPTION_GROUP("Pictures", OPT_SPACE, OPT_TONE_MAPPING, OPT_EXPOSURE,
                                                   OPT_ALPHA, OPT_BACKGROUND, OPT_LAYER, OPT_MASK, OPT_CROP),
                                      OPTION_GROUP("Picture of the difference", OPT_OUTPUT, OPT_NO_CLOBBER,
                                                   OPT_FORMAT, OPT_HEAT_MAP, OPT_GAIN, OPT_SHEET),
                                      &limits_group, &messages_group, NULL},
};
