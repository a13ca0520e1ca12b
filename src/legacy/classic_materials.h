/* classic_materials.h - public materials of OpenGL 1 and MTL for tests and benchmarks: the teapots of the
 * OpenGL Programming Guide ("red book"; shininess is 128 times the number listed there), rgl's defaults,
 * and typical output of MTL exporters; with the errors of four conversions. */
#ifndef LEGACY_CLASSIC_MATERIALS_H
#define LEGACY_CLASSIC_MATERIALS_H

#include "legacy/fit.h"

typedef struct classic_material {
    const char *name;
    ogl1_surface surface;
    double naive, closed, core, fit; /* E; light times pi */
} classic_material;

enum {
    CLASSIC_COUNT = 29,
    CLASSIC_USUAL = 27 /* the last two have extreme exponents and are excluded from means */
};

#define GREY(x)                                                                                              \
    {                                                                                                        \
        x, x, x                                                                                              \
    }
static const classic_material classic_materials[CLASSIC_COUNT] = {
    {"emerald", {{.07568f, .61424f, .07568f}, {.633f, .727811f, .633f}, 76.8f}, .214, .111, .179, .107},
    {"jade", {{.54f, .89f, .63f}, GREY(.316228f), 12.8f}, .193, .069, .072, .066},
    {"obsidian", {{.18275f, .17f, .22525f}, {.332741f, .328634f, .346435f}, 38.4f}, .233, .119, .167, .115},
    {"pearl", {{1.0f, .829f, .829f}, GREY(.296648f), 11.264f}, .166, .109, .101, .099},
    {"ruby", {{.61424f, .04136f, .04136f}, {.727811f, .626959f, .626959f}, 76.8f}, .216, .112, .183, .108},
    {"turquoise", {{.396f, .74151f, .69102f}, {.297254f, .30829f, .306678f}, 12.8f}, .201, .058, .065, .057},
    {"brass",
     {{.780392f, .568627f, .113725f}, {.992157f, .941176f, .807843f}, 27.8974f},
     .395,
     .126,
     .154,
     .124},
    {"bronze", {{.714f, .4284f, .18144f}, {.393548f, .271906f, .166721f}, 25.6f}, .155, .059, .073, .057},
    {"chrome", {GREY(.4f), GREY(.774597f), 76.8f}, .227, .111, .153, .107},
    {"copper", {{.7038f, .27048f, .0828f}, {.256777f, .137622f, .086014f}, 12.8f}, .157, .050, .057, .049},
    {"gold", {{.75164f, .60648f, .22648f}, {.628281f, .555802f, .366065f}, 51.2f}, .160, .070, .093, .068},
    {"silver", {GREY(.50754f), GREY(.508273f), 51.2f}, .161, .074, .101, .072},
    {"black plastic", {GREY(.01f), GREY(.5f), 32.0f}, .647, .264, .316, .256},
    {"cyan plastic", {{0.0f, .50980392f, .50980392f}, GREY(.50196078f), 32.0f}, .259, .099, .148, .097},
    {"red plastic", {{.5f, 0.0f, 0.0f}, {.7f, .6f, .6f}, 32.0f}, .417, .152, .244, .148},
    {"white plastic", {GREY(.55f), GREY(.7f), 32.0f}, .295, .100, .110, .097},
    {"black rubber", {GREY(.01f), GREY(.4f), 10.0f}, .822, .239, .247, .236},
    {"cyan rubber", {{.4f, .5f, .5f}, {.04f, .7f, .7f}, 10.0f}, .450, .117, .136, .116},
    {"red rubber", {{.5f, .4f, .4f}, {.7f, .04f, .04f}, 10.0f}, .397, .104, .150, .102},
    {"white rubber", {GREY(.5f), GREY(.7f), 10.0f}, .473, .123, .123, .121},
    {"rgl steelblue default", {{.2745f, .5098f, .7059f}, GREY(1.0f), 50.0f}, .333, .121, .155, .117},
    {"rgl white default", {GREY(1.0f), GREY(1.0f), 50.0f}, .215, .145, .151, .145},
    {"rgl gray10 specular", {GREY(.8f), GREY(.102f), 50.0f}, .087, .011, .025, .011},
    {"MTL Blender 2.7 default", {GREY(.64f), GREY(.5f), 96.078431f}, .113, .048, .086, .047},
    {"MTL Blender 2.8 default", {GREY(.8f), GREY(.5f), 225.0f}, .195, .027, .072, .027},
    {"MTL matte", {GREY(.8f), GREY(0.0f), 10.0f}, .034, .001, .002, .000},
    {"MTL low-poly pack", {{.5f, .6f, .3f}, GREY(.33f), 10.0f}, .287, .079, .086, .078},
    {"MTL Ns 0, Ks 1", {{.5176f, .4196f, .3333f}, GREY(1.0f), 0.0f}, .779, .828, .492, .489},
    {"MTL Ns 1000, Ks 1", {GREY(.2f), GREY(1.0f), 1000.0f}, 1.87, .098, .321, .096}};
#undef GREY

#endif
