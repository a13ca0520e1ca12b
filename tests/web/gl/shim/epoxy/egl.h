/* egl.h - libepoxy's header for tests in browsers, which have no EGL: the pointer that a test replaces. Such tests do not
 * run in browsers. */
#ifndef WEB_GL_EPOXY_EGL_H
#define WEB_GL_EPOXY_EGL_H

#include <EGL/egl.h>

extern EGLBoolean (*epoxy_eglMakeCurrent)(EGLDisplay, EGLSurface, EGLSurface, EGLContext);

#endif
