/* facet/compare.h - metrics of the difference between two images. docs/compare.md has the formulas and
 * when to use which. */
#ifndef FACET_COMPARE_H
#define FACET_COMPARE_H

#include "base.h"
#include "image.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The color space in which images are compared. */
typedef enum facet_compare_space {
    FACET_COMPARE_SPACE_AUTO,   /* display, unless both images are linear and there is no tone mapping */
    FACET_COMPARE_SPACE_LINEAR, /* linear Rec.709 */
    FACET_COMPARE_SPACE_DISPLAY /* tone-mapped, clamped to [0, 1], sRGB-encoded */
} facet_compare_space;

typedef enum facet_compare_alpha {
    /* colors over black, and opacity as a fourth channel unless both images are opaque */
    FACET_COMPARE_ALPHA_CHANNEL,
    FACET_COMPARE_ALPHA_IGNORE,    /* colors over black only */
    FACET_COMPARE_ALPHA_BACKGROUND /* colors over facet_compare_desc.background */
} facet_compare_alpha;

/* Metrics that take time and can be skipped. */
typedef enum facet_metric { FACET_METRIC_SSIM = 1 << 0, FACET_METRIC_FLIP = 1 << 1 } facet_metric;

typedef enum facet_difference {
    FACET_DIFFERENCE_ABSOLUTE, /* |b - a| times gain, per channel; that of opacity is added to all three */
    /* FLIP, or, where it is skipped, the largest |b - a| times gain, as a color from black over red to
     * light yellow */
    FACET_DIFFERENCE_HEAT_MAP
} facet_difference;

/* {0}: whole images, all metrics. */
typedef struct facet_compare_desc {
    facet_allocator allocator;
    uint32_t thread_count;    /* 0: facet_thread_count(); results do not depend on it */
    uint32_t skipped_metrics; /* facet_metric, combined by or */
    facet_compare_space space;
    facet_tonemap tonemap; /* of linear images in display space; display-referred ones stay */
    float exposure_ev;     /* stops; linear images are scaled by 2^exposure_ev */
    facet_compare_alpha alpha;
    float background[3]; /* linear Rec.709, display-referred */
    uint32_t crop[4];    /* x, y, width, height of the part to compare; {0}: all */
    /* of the same size: pixels count where its luma is at least 0.5 (sRGB); NULL: all count */
    const facet_image *mask;
    /* FLIP: of the visual field, [1, 1000]; 0: 67, a 4k display of 0.7 m from 0.7 m */
    float pixels_per_degree;
    float relative_epsilon; /* mse_relative: added to a^2; 0: 0.01 */
    float peak;             /* PSNR, SSIM: the largest value; 0: 1, in linear space the largest of a */
    float threshold;        /* a pixel differs where the error of a channel exceeds this */
    double percentile;      /* (0, 100]: one beside 50, 95, 99 and 99.9; 0: none */
    facet_difference difference;
    float gain;    /* of the difference image; 0: 1 */
    bool is_sheet; /* the difference image shows a, b and the difference side by side */
} facet_compare_desc;

/* The difference of b from the reference a. NAN: not measured. Errors are per channel in units of the
 * space; means are over the channels of all finite pixels that count. */
typedef struct facet_comparison {
    uint32_t width, height;            /* of the compared part */
    facet_compare_space space;         /* LINEAR or DISPLAY */
    uint32_t channel_count;            /* 3; 4: with opacity */
    uint64_t pixel_count;              /* inside of the mask */
    bool is_equal;                     /* bit-equal as linear premultiplied floats */
    uint64_t nonfinite_a, nonfinite_b; /* pixels with NaN or infinity */
    /* pixels whose NaN or infinity differs: in no mean, but counted as differing, with infinite error and
     * FLIP 1 */
    uint64_t invalid_count;
    double mse, rmse;
    double mse_relative, rmse_relative; /* mean of (b - a)^2 / (a^2 + relative_epsilon), and its root */
    double nrmse;                       /* rmse over the root mean square of a */
    double mae, bias;                   /* mean of |b - a|, of b - a */
    double max_error;                   /* of a channel */
    uint32_t max_x, max_y;              /* its pixel in the whole image */
    /* of the pixels' largest |b - a| */
    double percentile_50, percentile_95, percentile_99, percentile_999, percentile;
    uint64_t differing_count;
    double differing_share; /* of pixel_count */
    double peak, psnr;      /* dB; INFINITY where mse is 0 */
    double ssim;            /* of luminance (display space: luma), 1: equal; NAN below 11 x 11 pixels */
    double ssim_channels;   /* mean over the channels */
    double flip, flip_max;  /* [0, 1], mean and maximum */
    bool is_flip_hdr;       /* HDR-FLIP, the maximum over exposures: in linear space */
    double flip_start_ev, flip_stop_ev;
    uint32_t flip_exposure_count;
} facet_comparison;

/* Compares layer 0 of b with the reference a. *difference (NULL: not wanted) is an image of the error; in
 * display space facet_image_save() writes its values unchanged to display-referred files. desc NULL: {0}.
 * FACET_ERROR_ARGUMENT: the sizes differ, the crop lies outside, or the mask excludes every pixel. */
FACET_API facet_result facet_compare(const facet_image *a, const facet_image *b,
                                     const facet_compare_desc *desc, facet_comparison *out,
                                     facet_image **difference, facet_error *error);

#ifdef __cplusplus
}
#endif

#endif
