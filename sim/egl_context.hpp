#pragma once

namespace hopscotch::sim {

/// An OpenGL context that draws into memory, current on the thread that makes it for as long as it
/// lives. Needs no display server: it uses Mesa's surfaceless platform.
class EglContext {
 public:
  /// @throws RendererUnavailable saying which step the machine refused.
  EglContext(int width, int height);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

 private:
  void create(int width, int height);
  void release();

  // EGL's own handle types are pointers to void; its header stays out of ours.
  void* display_ = nullptr;
  void* surface_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace hopscotch::sim
