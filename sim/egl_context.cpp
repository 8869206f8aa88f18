#include "sim/egl_context.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <sstream>
#include <string>

#include "sim/scene_renderer.hpp"

namespace hopscotch::sim {

namespace {

[[noreturn]] void unavailable(const std::string& step) {
  std::ostringstream text;
  text << "no off-screen rendering: " << step << " failed (EGL error 0x" << std::hex
       << eglGetError() << ")";
  throw RendererUnavailable(text.str());
}

EGLDisplay surfaceless_display() {
  // A function of an extension: it has to be asked for by name.
  const auto get_platform_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (get_platform_display == nullptr) unavailable("eglGetPlatformDisplayEXT");
  const EGLDisplay display =
      get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE) {
    unavailable("a surfaceless display (package libgl1-mesa-dri)");
  }
  return display;
}

}  // namespace

EglContext::EglContext(int width, int height) {
  try {
    create(width, height);
  } catch (...) {
    release();
    throw;
  }
}

EglContext::~EglContext() {
  release();
}

void EglContext::create(int width, int height) {
  display_ = surfaceless_display();
  if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) unavailable("OpenGL");
  constexpr std::array kWanted{EGL_SURFACE_TYPE,
                               EGL_PBUFFER_BIT,
                               EGL_RED_SIZE,
                               8,
                               EGL_GREEN_SIZE,
                               8,
                               EGL_BLUE_SIZE,
                               8,
                               EGL_DEPTH_SIZE,
                               24,
                               EGL_STENCIL_SIZE,
                               8,
                               EGL_RENDERABLE_TYPE,
                               EGL_OPENGL_BIT,
                               EGL_NONE};
  EGLConfig config = nullptr;
  EGLint found = 0;
  if (eglChooseConfig(display_, kWanted.data(), &config, 1, &found) == EGL_FALSE || found == 0) {
    unavailable("a colour buffer with depth");
  }
  const std::array<EGLint, 5> size{EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
  surface_ = eglCreatePbufferSurface(display_, config, size.data());
  if (surface_ == EGL_NO_SURFACE) unavailable("a buffer to draw into");
  context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, nullptr);
  if (context_ == EGL_NO_CONTEXT) unavailable("an OpenGL context");
  if (eglMakeCurrent(display_, surface_, surface_, context_) == EGL_FALSE) {
    unavailable("making the context current");
  }
}

void EglContext::release() {
  if (display_ == nullptr) return;
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (context_ != nullptr) eglDestroyContext(display_, context_);
  if (surface_ != nullptr) eglDestroySurface(display_, surface_);
  // The display itself stays initialised: other contexts of the process share it.
  display_ = nullptr;
}

}  // namespace hopscotch::sim
