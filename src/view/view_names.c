/* view_names.c - see view_names.h. */
#include "view/view_names.h"

const char *view_tonemap_name(facet_tonemap tonemap)
{
    static const char *const names[] = {[FACET_TONEMAP_NONE] = "none",
                                        [FACET_TONEMAP_NEUTRAL] = "Khronos PBR Neutral",
                                        [FACET_TONEMAP_ACES] = "ACES (Hill)",
                                        [FACET_TONEMAP_ACES_NARKOWICZ] = "ACES (Narkowicz)",
                                        [FACET_TONEMAP_AGX] = "AgX",
                                        [FACET_TONEMAP_REINHARD] = "Reinhard",
                                        [FACET_TONEMAP_REINHARD_EXTENDED] = "Reinhard, extended",
                                        [FACET_TONEMAP_HABLE] = "Hable"};
    return names[tonemap];
}

const char *view_channel_name(facet_channel channel)
{
    static const char *const names[FACET_CHANNEL_COUNT] = {[FACET_CHANNEL_LIGHT] = "all light",
                                                           [FACET_CHANNEL_NORMAL] = "normal",
                                                           [FACET_CHANNEL_BASE_COLOR] = "base color",
                                                           [FACET_CHANNEL_ROUGHNESS] = "roughness",
                                                           [FACET_CHANNEL_METALLIC] = "metallic",
                                                           [FACET_CHANNEL_OCCLUSION] = "occlusion",
                                                           [FACET_CHANNEL_OPACITY] = "opacity",
                                                           [FACET_CHANNEL_NDOTV] = "N.V",
                                                           [FACET_CHANNEL_DIFFUSE] = "diffuse light",
                                                           [FACET_CHANNEL_SPECULAR] = "specular light",
                                                           [FACET_CHANNEL_CLEARCOAT] = "clearcoat",
                                                           [FACET_CHANNEL_SHEEN] = "sheen",
                                                           [FACET_CHANNEL_TRANSMISSION] = "transmission",
                                                           [FACET_CHANNEL_EMISSION] = "emission",
                                                           [FACET_CHANNEL_FURNACE] = "furnace"};
    return names[channel];
}

const char *view_brdf_name(facet_brdf brdf)
{
    static const char *const names[] = {[FACET_BRDF_ENERGY] = "Smith, height-correlated",
                                        [FACET_BRDF_SCHLICK_GGX] = "Schlick-GGX, separable",
                                        [FACET_BRDF_MULTISCATTER] = "Smith, with multiple scattering"};
    return names[brdf];
}

const char *view_energy_name(facet_energy energy)
{
    return energy == FACET_ENERGY_CONSERVING ? "conserving" : "as glTF has it";
}

const char *view_transparency_name(facet_transparency transparency)
{
    static const char *const names[] = {[FACET_TRANSPARENCY_SORTED] = "sorted",
                                        [FACET_TRANSPARENCY_PEELED] = "depth peeling",
                                        [FACET_TRANSPARENCY_WEIGHTED] = "weighted"};
    return names[transparency];
}

const char *view_background_name(facet_background background)
{
    static const char *const names[] = {[FACET_BACKGROUND_TRANSPARENT] = "transparent",
                                        [FACET_BACKGROUND_COLOR] = "color",
                                        [FACET_BACKGROUND_ENVIRONMENT] = "environment"};
    return names[background];
}
