/* embree.h - Embree, opened when the first BVH is built, and one interface to Embree 3.13 and Embree 4 for the calls that
 * differ. Linking it would add 1.6 ms to every start of a program, and most previews cast no ray. */
#ifndef CPU_EMBREE_H
#define CPU_EMBREE_H

#if FACET_EMBREE >= 4 /* by the build: facet_dependencies.cmake */
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <stdbool.h>

#include "base/library.h"

/* clang-format off */
#define EMBREE_FUNCTIONS(F, out) \
    F(out, rtcNewDevice, NewDevice) F(out, rtcReleaseDevice, ReleaseDevice) \
    F(out, rtcGetDeviceError, GetDeviceError) F(out, rtcGetDeviceProperty, GetDeviceProperty) \
    F(out, rtcSetDeviceMemoryMonitorFunction, SetDeviceMemoryMonitorFunction) \
    F(out, rtcNewScene, NewScene) F(out, rtcReleaseScene, ReleaseScene) \
    F(out, rtcCommitScene, CommitScene) F(out, rtcSetSceneFlags, SetSceneFlags) \
    F(out, rtcSetSceneBuildQuality, SetSceneBuildQuality) F(out, rtcGetSceneBounds, GetSceneBounds) \
    F(out, rtcNewGeometry, NewGeometry) F(out, rtcReleaseGeometry, ReleaseGeometry) \
    F(out, rtcCommitGeometry, CommitGeometry) F(out, rtcAttachGeometryByID, AttachGeometryByID) \
    F(out, rtcSetGeometryBuildQuality, SetGeometryBuildQuality) \
    F(out, rtcSetGeometryInstancedScene, SetGeometryInstancedScene) \
    F(out, rtcSetGeometryTransform, SetGeometryTransform) \
    F(out, rtcSetSharedGeometryBuffer, SetSharedGeometryBuffer) \
    F(out, rtcSetNewGeometryBuffer, SetNewGeometryBuffer) \
    F(out, rtcIntersect1, Intersect1) F(out, rtcIntersect4, Intersect4) F(out, rtcIntersect8, Intersect8) \
    F(out, rtcIntersect16, Intersect16) F(out, rtcOccluded1, Occluded1)
/* clang-format on */

/* Functions of Embree; members have their names without "rtc". */
typedef struct embree_library {
    EMBREE_FUNCTIONS(LIBRARY_MEMBER, )
} embree_library;

/* Set by embree_open() and constant from then on. */
extern embree_library embree;

/* Opens Embree for this process, which keeps it: its threads end with the process. Calls after the first that has
 * succeeded do nothing. FACET_ERROR_SYSTEM: it is not installed; FACET_ERROR_MEMORY. */
facet_result embree_open(facet_error *error);

/* A hit of which nothing is known yet. Embree 4.1 and later may have arrays of instances, whose index is left unset without. */
static inline struct RTCHit embree_no_hit(void)
{
    struct RTCHit hit = {.geomID = RTC_INVALID_GEOMETRY_ID, .instID = {RTC_INVALID_GEOMETRY_ID}};
#if defined(RTC_GEOMETRY_INSTANCE_ARRAY)
    hit.instPrimID[0] = RTC_INVALID_GEOMETRY_ID;
#endif
    return hit;
}

#if RTC_VERSION >= 40000

typedef struct RTCRayQueryContext embree_context;
#define EMBREE_SCENE_FLAG_FILTER RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS

/* Nearest hits of the lanes with valid[i] == -1 of a packet of coherent rays; tfar shortens, geomID is
 * set. */
#define EMBREE_DEFINE_INTERSECT(N)                                                                           \
    static inline void embree_intersect##N(const int *valid, RTCScene scene, struct RTCRayHit##N *rays)      \
    {                                                                                                        \
        struct RTCIntersectArguments arguments;                                                              \
        rtcInitIntersectArguments(&arguments);                                                               \
        arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;                                                       \
        embree.Intersect##N(valid, scene, rays, &arguments);                                                 \
    }

/* One ray; Embree calls filter for every candidate with context, which starts with an embree_context. */
static inline void embree_intersect1_filtered(RTCScene scene, struct RTCRayHit *ray, embree_context *context,
                                              RTCFilterFunctionN filter)
{
    struct RTCIntersectArguments arguments;
    rtcInitRayQueryContext(context);
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    arguments.context = context;
    arguments.filter = filter;
    embree.Intersect1(scene, ray, &arguments);
}

/* Whether one ray is occluded. */
static inline bool embree_occluded1(RTCScene scene, struct RTCRay *ray)
{
    embree.Occluded1(scene, ray, NULL);
    return ray->tfar < 0.0f;
}

/* The same, with a filter as above: the ray passes candidates that it rejects. */
static inline bool embree_occluded1_filtered(RTCScene scene, struct RTCRay *ray, embree_context *context,
                                             RTCFilterFunctionN filter)
{
    struct RTCOccludedArguments arguments;
    rtcInitRayQueryContext(context);
    rtcInitOccludedArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    arguments.context = context;
    arguments.filter = filter;
    embree.Occluded1(scene, ray, &arguments);
    return ray->tfar < 0.0f;
}

/* The nearest hit of one ray. */
static inline void embree_intersect1(RTCScene scene, struct RTCRayHit *ray)
{
    embree.Intersect1(scene, ray, NULL);
}

#else

typedef struct RTCIntersectContext embree_context;
#define EMBREE_SCENE_FLAG_FILTER RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION

/* Nearest hits of the lanes with valid[i] == -1 of a packet of coherent rays; tfar shortens, geomID is
 * set. */
#define EMBREE_DEFINE_INTERSECT(N)                                                                           \
    static inline void embree_intersect##N(const int *valid, RTCScene scene, struct RTCRayHit##N *rays)      \
    {                                                                                                        \
        struct RTCIntersectContext context;                                                                  \
        rtcInitIntersectContext(&context);                                                                   \
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;                                                 \
        embree.Intersect##N(valid, scene, &context, rays);                                                   \
    }

/* One ray; Embree calls filter for every candidate with context, which starts with an embree_context. */
static inline void embree_intersect1_filtered(RTCScene scene, struct RTCRayHit *ray, embree_context *context,
                                              RTCFilterFunctionN filter)
{
    rtcInitIntersectContext(context);
    context->filter = filter;
    embree.Intersect1(scene, context, ray);
}

/* Whether one ray is occluded. */
static inline bool embree_occluded1(RTCScene scene, struct RTCRay *ray)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    embree.Occluded1(scene, &context, ray);
    return ray->tfar < 0.0f;
}

/* The same, with a filter as above: the ray passes candidates that it rejects. */
static inline bool embree_occluded1_filtered(RTCScene scene, struct RTCRay *ray, embree_context *context,
                                             RTCFilterFunctionN filter)
{
    rtcInitIntersectContext(context);
    context->filter = filter;
    embree.Occluded1(scene, context, ray);
    return ray->tfar < 0.0f;
}

/* The nearest hit of one ray. */
static inline void embree_intersect1(RTCScene scene, struct RTCRayHit *ray)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    embree.Intersect1(scene, &context, ray);
}

#endif

EMBREE_DEFINE_INTERSECT(4)
EMBREE_DEFINE_INTERSECT(8)
EMBREE_DEFINE_INTERSECT(16)

#endif
