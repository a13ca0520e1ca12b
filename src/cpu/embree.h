/* embree.h - one interface to Embree 3.13 and Embree 4, for the calls that differ. */
#ifndef CPU_EMBREE_H
#define CPU_EMBREE_H

#if FACET_EMBREE >= 4 /* by the build: facet_dependencies.cmake */
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <stdbool.h>

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
        rtcIntersect##N(valid, scene, rays, &arguments);                                                     \
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
    rtcIntersect1(scene, ray, &arguments);
}

/* Whether one ray is occluded. */
static inline bool embree_occluded1(RTCScene scene, struct RTCRay *ray)
{
    rtcOccluded1(scene, ray, NULL);
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
    rtcOccluded1(scene, ray, &arguments);
    return ray->tfar < 0.0f;
}

/* The nearest hit of one ray. */
static inline void embree_intersect1(RTCScene scene, struct RTCRayHit *ray)
{
    rtcIntersect1(scene, ray, NULL);
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
        rtcIntersect##N(valid, scene, &context, rays);                                                       \
    }

/* One ray; Embree calls filter for every candidate with context, which starts with an embree_context. */
static inline void embree_intersect1_filtered(RTCScene scene, struct RTCRayHit *ray, embree_context *context,
                                              RTCFilterFunctionN filter)
{
    rtcInitIntersectContext(context);
    context->filter = filter;
    rtcIntersect1(scene, context, ray);
}

/* Whether one ray is occluded. */
static inline bool embree_occluded1(RTCScene scene, struct RTCRay *ray)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, ray);
    return ray->tfar < 0.0f;
}

/* The same, with a filter as above: the ray passes candidates that it rejects. */
static inline bool embree_occluded1_filtered(RTCScene scene, struct RTCRay *ray, embree_context *context,
                                             RTCFilterFunctionN filter)
{
    rtcInitIntersectContext(context);
    context->filter = filter;
    rtcOccluded1(scene, context, ray);
    return ray->tfar < 0.0f;
}

/* The nearest hit of one ray. */
static inline void embree_intersect1(RTCScene scene, struct RTCRayHit *ray)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, ray);
}

#endif

EMBREE_DEFINE_INTERSECT(4)
EMBREE_DEFINE_INTERSECT(8)
EMBREE_DEFINE_INTERSECT(16)

#endif
