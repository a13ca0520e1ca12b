/* fit_gram.h - the nodes of the LUT that fit_table_generate.c computes when facet is built and
 * fit_closed.c reads: roughness by equal factors from that of ALPHA_MIRROR to 1, shininess by equal steps
 * of log(1 + s). */
#ifndef LEGACY_FIT_GRAM_H
#define LEGACY_FIT_GRAM_H

enum { GRAM_R = 49, GRAM_S = 76 };
#define GRAM_LOG_R (-4.605170186) /* of the first roughness, 0.01 */
#define GRAM_STEP_R (4.605170186 / (GRAM_R - 1))
#define GRAM_STEP_S 0.25

#endif
