/* gl_api.h - OpenGL's functions: on desktops through libepoxy, in a browser WebGL 2, which is OpenGL ES 3.0
 * with fewer functions. What the two spell differently has one name here. */
#ifndef GL_GL_API_H
#define GL_GL_API_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __EMSCRIPTEN__

#include <GLES3/gl3.h>

#include <GLES2/gl2ext.h>

#define GL_CONTEXT_LOST 0x0507
#define GL_COMPLETION_STATUS_KHR 0x91B1
#define GL_SAMPLE_ALPHA_TO_ONE 0x809F /* never enabled there: gl_material_has_coverage() */
#define GL_UPPER_LEFT GL_UPPER_LEFT_EXT
#define GL_LOWER_LEFT GL_LOWER_LEFT_EXT
#define GL_ZERO_TO_ONE GL_ZERO_TO_ONE_EXT
#define GL_NEGATIVE_ONE_TO_ONE GL_NEGATIVE_ONE_TO_ONE_EXT
#define GL_TIME_ELAPSED GL_TIME_ELAPSED_EXT

/* In gl_context_web.c. */
bool gl_api_has_extension(const char *name); /* with its prefix, GL_ */
void gl_api_clip_control(unsigned origin, unsigned depth);

static inline bool gl_api_is_es(void)
{
    return true;
}

static inline int gl_api_version(void)
{
    return 30;
}

static inline void gl_api_clear_depth(bool is_es, double depth)
{
    (void)is_es;
    glClearDepthf((GLfloat)depth);
}

static inline void gl_api_depth_range(bool is_es, double nearest, double farthest)
{
    (void)is_es;
    glDepthRangef((GLfloat)nearest, (GLfloat)farthest);
}

/* Browsers compile in parallel without being asked. */
static inline void gl_api_compile_in_parallel(void)
{
}

/* Whether a query has a result before the frame ends. In browsers that is only so in the next task of the page's
 * event loop; until then it reads as 0. */
static inline bool gl_api_has_query_results(void)
{
    return false;
}

/* Timer queries are not used in browsers: gl_context.has_timer_query is false. */
static inline uint64_t gl_api_query_ns(bool is_es, unsigned query)
{
    (void)is_es;
    (void)query;
    return 0;
}

#else

#include <epoxy/gl.h>

static inline bool gl_api_has_extension(const char *name)
{
    return epoxy_has_gl_extension(name);
}

static inline void gl_api_clip_control(unsigned origin, unsigned depth)
{
    glClipControl(origin, depth);
}

static inline bool gl_api_is_es(void)
{
    return !epoxy_is_desktop_gl();
}

static inline int gl_api_version(void)
{
    return epoxy_gl_version();
}

static inline void gl_api_clear_depth(bool is_es, double depth)
{
    if (is_es)
        glClearDepthf((GLfloat)depth);
    else
        glClearDepth(depth);
}

/* Maps the depths of triangles to this range. */
static inline void gl_api_depth_range(bool is_es, double nearest, double farthest)
{
    if (is_es)
        glDepthRangef((GLfloat)nearest, (GLfloat)farthest);
    else
        glDepthRange(nearest, farthest);
}

/* With as many threads as the driver allows. */
static inline void gl_api_compile_in_parallel(void)
{
    glMaxShaderCompilerThreadsKHR(0xffffffff);
}

static inline bool gl_api_has_query_results(void)
{
    return true;
}

/* The result of a timer query, waiting for it. */
static inline uint64_t gl_api_query_ns(bool is_es, unsigned query)
{
    GLuint64 ns = 0;
    if (is_es)
        glGetQueryObjectui64vEXT(query, GL_QUERY_RESULT, &ns);
    else
        glGetQueryObjectui64v(query, GL_QUERY_RESULT, &ns);
    return ns;
}

#endif
#endif
