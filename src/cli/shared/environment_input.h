/* environment_input.h - the words that name an environment, the same for --env of render and INPUT of bake:
 *
 *   FILE                                  an image, or a KTX2 cube map
 *   -                                     standard input, where the caller allows it
 *   NAME{face}.hdr                        six files, px nx py ny pz nz (or posx negx .., right left top bottom front back) for {face}
 *   faces:A,B,C,D,E,F                     six files, +X -X +Y -Y +Z -Z
 *   neutral, studio, white, #rrggbb, none
 *   constant:COLOR                        the same from everywhere; COLOR is a CSS color, one number, or R/G/B (here also R,G,B)
 *   gradient:ZENITH,HORIZON[,NADIR]       COLORs
 *   sun:EL[,AZ[,TURBIDITY]][,WORD..]      a clear sky and its sun, degrees above the horizon and from +Z towards +X
 *   preetham:EL[,AZ[,TURBIDITY]][,WORD..] the same by Preetham's formula; docs/environments.md has the words
 *
 * ./NAME is always a file. Numbers are radiance, 1 is white. Skies are exposed so that white turned to the
 * light is 1, as in the studio, unless the word lux asks for cd/m^2. */
#ifndef CLI_ENVIRONMENT_INPUT_H
#define CLI_ENVIRONMENT_INPUT_H

#include "facet/facet.h"

typedef enum environment_kind {
    ENVIRONMENT_STUDIO,
    ENVIRONMENT_NONE,
    ENVIRONMENT_CONSTANT,
    ENVIRONMENT_GRADIENT,
    ENVIRONMENT_SKY,
    ENVIRONMENT_FILE, /* or standard input */
    ENVIRONMENT_FACES
} environment_kind;

/* Flags of the other inputs that a caller accepts. */
enum { ENVIRONMENT_TAKES_STDIN = 1 << 0, ENVIRONMENT_TAKES_NONE = 1 << 1 };

typedef struct environment_input {
    environment_kind kind;
    const char *path;     /* FILE: it, or "-"; FACES: the pattern with {face}, or the list */
    float radiance[3][3]; /* CONSTANT: [0]; GRADIENT: zenith, horizon, nadir */
    facet_sky_desc sky;
} environment_input;

/* Parses text, which stays with the caller; no file is read. place begins messages: "--env", "INPUT".
 * Fails with FACET_ERROR_ARGUMENT. */
facet_result environment_input_parse(const char *place, const char *text, unsigned takes,
                                     environment_input *out, facet_error *error);

/* Creates an environment that is read from no file. *environment is NULL for the kinds _NONE, _FILE and _FACES. */
facet_result environment_input_create(const environment_input *input, const facet_environment_desc *desc,
                                      facet_environment **environment, facet_error *error);

/* Loads or creates the environment, or takes a shared one (environment_share.h); a signal or the time limit ends the process meanwhile (interrupt.h).
 * desc->allocator must be set for standard input. *environment is NULL for ENVIRONMENT_NONE. */
facet_result environment_input_load(const environment_input *input, const facet_environment_desc *desc,
                                    facet_environment **environment, facet_error *error);

/* Name in messages and names of outputs: the path, "stdin", or the kind, as "studio" and "sky". */
const char *environment_input_name(const environment_input *input);

/* Writes the path of file index (0 or, of a cube map in six files, 0 to 5) that the environment is read from. False: there
 * is none. */
enum { ENVIRONMENT_PATH_SIZE = 4096 };
bool environment_input_get_file(const environment_input *input, int index, char path[ENVIRONMENT_PATH_SIZE]);

/* Whether the environment is read from the file path. */
bool environment_input_is_file(const environment_input *input, const char *path);

#endif
