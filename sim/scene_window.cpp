#include "sim/scene_window.hpp"

#include <GLFW/glfw3.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "sim/scene_stage.hpp"

namespace hopscotch::sim {

namespace {

constexpr int kWidth = 1280;
constexpr int kHeight = 720;

/// The library for as long as a window lives, then the window.
struct GlfwWindow {
  explicit GlfwWindow(const std::string& title) {
    if (glfwInit() != GLFW_TRUE) fail();
    glfwWindowHint(GLFW_SAMPLES, 4);
    handle = glfwCreateWindow(kWidth, kHeight, title.c_str(), nullptr, nullptr);
    if (handle == nullptr) {
      const char* reason = nullptr;
      glfwGetError(&reason);
      const std::string text = reason == nullptr ? "" : reason;
      glfwTerminate();
      throw RendererUnavailable("no window: " + text);
    }
    glfwMakeContextCurrent(handle);
    glfwSwapInterval(0);  // the run keeps its own pace
  }
  ~GlfwWindow() {
    glfwDestroyWindow(handle);
    glfwTerminate();
  }
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;

  [[noreturn]] static void fail() {
    const char* reason = nullptr;
    glfwGetError(&reason);
    throw RendererUnavailable(std::string("no window (is there a display?): ") +
                              (reason == nullptr ? "unknown reason" : reason));
  }

  GLFWwindow* handle = nullptr;
};

}  // namespace

struct SceneWindow::Window {
  Window(const std::string& mjcf, const std::string& title)
      : glfw(title), stage(mjcf, {0, 0, kWidth, kHeight}, mjFB_WINDOW, Quality::film) {
    glfwSetWindowUserPointer(glfw.handle, this);
    glfwSetScrollCallback(glfw.handle, [](GLFWwindow* handle, double, double steps) {
      static_cast<Window*>(glfwGetWindowUserPointer(handle))->on_wheel(steps);
    });
  }

  void on_wheel(double steps) {
    constexpr double kZoomPerStep = 0.1;
    zoom = std::clamp(zoom * std::exp(-kZoomPerStep * steps), 0.2, 5.0);
  }

  void follow_mouse() {
    constexpr double kTurnPerPixel = 0.006;  // [rad]
    Eigen::Vector2d now;
    glfwGetCursorPos(glfw.handle, &now.x(), &now.y());
    if (glfwGetMouseButton(glfw.handle, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
      turn -= kTurnPerPixel * (now - mouse);
    }
    mouse = now;
  }

  GlfwWindow glfw;
  SceneStage stage;
  Eigen::Vector2d mouse = Eigen::Vector2d::Zero();  // [pixel]
  Eigen::Vector2d turn = Eigen::Vector2d::Zero();   // added to azimuth and elevation [rad]
  double zoom = 1.0;                                // of the distance
};

SceneWindow::SceneWindow(const std::string& mjcf, const std::string& title)
    : window_(std::make_unique<Window>(mjcf, title)) {}
SceneWindow::~SceneWindow() = default;

void SceneWindow::show(const core::RobotState& state, const View& view) {
  constexpr double kSteepest = 1.5;  // [rad]
  glfwPollEvents();
  window_->follow_mouse();
  View turned = view;
  turned.azimuth += window_->turn.x();
  turned.elevation = std::clamp(turned.elevation + window_->turn.y(), -kSteepest, kSteepest);
  turned.distance *= window_->zoom;
  mjrRect whole{0, 0, 0, 0};
  glfwGetFramebufferSize(window_->glfw.handle, &whole.width, &whole.height);
  window_->stage.draw(state, turned, whole);
  glfwSwapBuffers(window_->glfw.handle);
}

bool SceneWindow::closed() const {
  return glfwWindowShouldClose(window_->glfw.handle) == GLFW_TRUE;
}

}  // namespace hopscotch::sim
