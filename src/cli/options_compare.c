/* options_compare.c - facet compare. See options_table.h. */
#include "cli/options_table.h"

static const option metric_options[] = {
    {.id = OPT_METRIC,
     .name = "metric",
     .kind = OPTION_CHOICES,
     .argument = "LIST",
     .default_text = "a table of the main ones",
     .help = "what to measure and print",
     .choices = WORDS("flip", "flip-max", "ssim", "ssim-channels", "psnr", "mse", "rmse", "mse-relative",
                      "rmse-relative", "nrmse", "mae", "bias", "max", "p50", "p95", "p99", "p99.9",
                      "percentile", "differing", "differing-share")},
    {.id = OPT_MAX,
     .name = "max",
     .kind = OPTION_TEXT,
     .argument = "LIMITS",
     .help = "exit 1 where a metric is larger: flip=0.02,max=0.1, or a number for the one of --metric"},
    {.id = OPT_MIN,
     .name = "min",
     .kind = OPTION_TEXT,
     .argument = "LIMITS",
     .help = "exit 1 where a metric is smaller, of those that grow with likeness: psnr=40,ssim=0.98"},
    {.id = OPT_PERCENTILE,
     .name = "percentile",
     .kind = OPTION_NUMBER,
     .argument = "P",
     .help = "measure the error that P % of the pixels do not exceed",
     .minimum = 0.001,
     .maximum = 100},
    {.id = OPT_THRESHOLD,
     .name = "threshold",
     .kind = OPTION_NUMBER,
     .argument = "X",
     .default_text = "0",
     .help = "a pixel differs where a channel is farther apart than this",
     .minimum = 0,
     .maximum = 1e30},
    {.id = OPT_PIXELS_PER_DEGREE,
     .name = "pixels-per-degree",
     .kind = OPTION_NUMBER,
     .argument = "N",
     .default_text = "67, a 4k display of 0.7 m from 0.7 m",
     .help = "how FLIP's observer sees: distance times pixels over width, times 0.01745",
     .minimum = 1,
     .maximum = 1000},
    {.id = OPT_PEAK,
     .name = "peak",
     .kind = OPTION_NUMBER,
     .argument = "X",
     .default_text = "1; the largest value of A in linear space",
     .help = "the largest value, for psnr and ssim",
     .minimum = 1e-30,
     .maximum = 1e30},
    {.id = OPT_EPSILON,
     .name = "epsilon",
     .kind = OPTION_NUMBER,
     .argument = "X",
     .default_text = "0.01",
     .help = "what mse-relative adds to the squared reference",
     .minimum = 1e-30,
     .maximum = 1e30},
};

static const option picture_options[] = {
    {.id = OPT_SPACE,
     .name = "space",
     .kind = OPTION_CHOICE,
     .argument = "SPACE",
     .default_text = "linear where both are exr, hdr or pfm; else display",
     .help = "compare light, or what a display gets: tone-mapped, clamped, sRGB",
     .choices = WORDS("auto", "linear", "display")},
    {.id = OPT_TONE_MAPPING,
     .name = "tone-mapping",
     .kind = OPTION_CHOICE,
     .argument = "OPERATOR",
     .default_text = "none",
     .help = "how light of exr, hdr and pfm files becomes display color before it is compared",
     .choices =
         WORDS("neutral", "aces", "aces-narkowicz", "agx", "reinhard", "reinhard-extended", "hable", "none")},
    {.id = OPT_EXPOSURE,
     .name = "exposure",
     .kind = OPTION_TEXT,
     .argument = "EV",
     .default_text = "0",
     .help = "brighten the light of such files by stops (+0.5), or by a factor (2x)"},
    {.id = OPT_ALPHA,
     .name = "alpha",
     .kind = OPTION_CHOICE,
     .argument = "HOW",
     .default_text = "channel",
     .help = "channel: opacity counts, colors over black; ignore: these colors only; background: colors over "
             "--background only",
     .choices = WORDS("channel", "ignore", "background")},
    {.id = OPT_BACKGROUND,
     .name = "background",
     .kind = OPTION_TEXT,
     .argument = "COLOR",
     .help = "#rrggbb or a CSS name to lay both over"},
    {.id = OPT_LAYER,
     .name = "layer",
     .kind = OPTION_TEXT,
     .argument = "NAME",
     .help = "compare a layer of OpenEXR files: albedo, normal, depth, uv, .. or a channel"},
    {.id = OPT_MASK,
     .name = "mask",
     .kind = OPTION_FILE,
     .argument = "FILE",
     .help = "a picture of the same size: only pixels that are white in it count"},
    {.id = OPT_CROP,
     .name = "crop",
     .kind = OPTION_TEXT,
     .argument = "X,Y,W,H",
     .help = "compare only this part, in pixels from the top left"},
};

static const option difference_options[] = {
    {.id = OPT_OUTPUT,
     .name = "output",
     .letter = 'o',
     .kind = OPTION_FILE,
     .argument = "FILE",
     .help = "write a picture of the difference: .png .jpg .webp .exr .hdr .pfm; - for standard output"},
    {.id = OPT_NO_CLOBBER,
     .name = "no-clobber",
     .kind = OPTION_FLAG,
     .help = "keep such a picture that exists already, and say so"},
    {.id = OPT_FORMAT,
     .name = "format",
     .kind = OPTION_CHOICE,
     .argument = "FORMAT",
     .default_text = "by the name of the output",
     .help = "of that picture",
     .choices = WORDS("png", "png16", "jpg", "webp", "exr", "exr32", "hdr", "pfm")},
    {.id = OPT_HEAT_MAP,
     .name = "heat-map",
     .kind = OPTION_FLAG,
     .help = "false color from black to light yellow: FLIP, or the largest error of a pixel where --metric "
             "has no "
             "FLIP"},
    {.id = OPT_GAIN,
     .name = "gain",
     .kind = OPTION_NUMBER,
     .argument = "X",
     .default_text = "1",
     .help = "multiply the difference that is shown (not FLIP)",
     .minimum = 1e-6,
     .maximum = 1e9},
    {.id = OPT_SHEET, .name = "sheet", .kind = OPTION_FLAG, .help = "A, B and the difference side by side"},
};

static const option_group metric_group = {"Metrics", metric_options, COUNT(metric_options)};
static const option_group picture_group = {"Pictures", picture_options, COUNT(picture_options)};
static const option_group difference_group = {"Picture of the difference", difference_options,
                                              COUNT(difference_options)};

const verb compare_verb = {
    .name = "compare",
    .summary = "measure how far two pictures are apart",
    .arguments = "A B",
    .max_arguments = 2,
    .file_types = "png jpg jpeg webp avif tga bmp gif dds exr hdr pfm ktx2",
    .output_types = "png jpg jpeg webp exr hdr pfm",
    .description =
        "A is the reference, B what is compared with it; both are .png .jpg .webp .avif .tga .bmp .gif "
        ".dds .exr .hdr .pfm .ktx2, told apart by content; - is standard input, once. They have to be of the "
        "same size.\n\n"
        "Without limits the exit code is 0, however different they are. With --max or --min it is 1 where "
        "one is "
        "exceeded, and one line says by what; then numbers are printed only with --metric or -v.\n\n"
        "Files of light (exr, hdr, pfm, ktx2 with linear texels) are compared as light, all others as "
        "displays "
        "show them; of two that are not of a kind, the light is tone-mapped (--tone-mapping) and clamped. "
        "FLIP of light is the largest over "
        "a range "
        "of exposures.\n\n"
        "Pixels that are not a number, or infinite, in one picture and not the same in the other are in no "
        "mean, "
        "but they differ, infinitely far; with such pixels no limit holds.",
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
    .basics =
        (const option_id[]){OPT_METRIC, OPT_MAX, OPT_MIN, OPT_OUTPUT, OPT_HEAT_MAP, OPT_GAIN, OPT_MASK,
                            OPT_LAYER, OPT_SPACE, OPT_EXPOSURE, OPT_TONE_MAPPING, OPT_JSON, OPTION_ID_COUNT},
    .groups = (const option_group *const[]){&metric_group, &picture_group, &difference_group, &machine_group,
                                            &message_group, NULL},
};
