/* options_gl.c - the options that drawing with OpenGL alone reads. See options_table.h. */
#include "cli/options_table.h"

static const option gl_options[] = {
    {.id = OPT_SHADOWS,
     .name = "shadows",
     .kind = OPTION_FLAG,
     .help = "lights of the model and the sun cast shadows"},
    {.id = OPT_TRANSPARENCY,
     .name = "transparency",
     .kind = OPTION_CHOICE,
     .argument = "HOW",
     .default_text = "sorted",
     .help =
         "what is blended: sorted: triangles from back to front; peeled: in each pixel's own order, up to 8 "
         "layers; weighted: in no order, quick and approximate",
     .choices = WORDS("sorted", "peeled", "weighted")},
    {.id = OPT_BLOOM,
     .name = "bloom",
     .kind = OPTION_NUMBER,
     .argument = "X",
     .default_text = "0, none",
     .help = "share of the light that is spread around bright things, as by a lens; 0.04 is plenty",
     .minimum = 0,
     .maximum = 1},
    {.id = OPT_CHANNEL,
     .name = "channel",
     .kind = OPTION_CHOICE,
     .argument = "NAME",
     .default_text = "light, all of it",
     .help = "draw one thing only: a parameter of the surfaces (on black, not tone-mapped), the light of one "
             "lobe, "
             "or furnace: under light of 1 from everywhere, where what is below 1 has lost energy",
     .choices =
         WORDS("light", "normal", "base-color", "roughness", "metallic", "occlusion", "opacity", "ndotv",
               "diffuse", "specular", "clearcoat", "sheen", "transmission", "emission", "furnace")},
    {.id = OPT_BRDF,
     .name = "brdf",
     .kind = OPTION_CHOICE,
     .argument = "NAME",
     .default_text = "energy, as --energy has it",
     .help = "formulas of the specular lobe: schlick-ggx: separable masking, k = alpha / 2; multiscatter: "
             "with what is "
             "scattered several times",
     .choices = WORDS("energy", "schlick-ggx", "multiscatter")},
};

const option_group gl_group = {"OpenGL (--renderer gl)", gl_options, COUNT(gl_options)};
