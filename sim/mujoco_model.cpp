#include "sim/mujoco_model.hpp"

#include <array>
#include <cstring>
#include <stdexcept>

#include "core/check.hpp"

namespace hopscotch::sim {
namespace {

/// MuJoCo's own handler would append to a file in the working directory.
void count_only(const char* /*message*/) {}

void silence_warnings() {
  static const bool done = [] {
    mju_user_warning = count_only;
    return true;
  }();
  static_cast<void>(done);
}

}  // namespace

ModelPointer compile_model(const std::string& mjcf) {
  constexpr const char* kName = "scene.xml";
  silence_warnings();
  const auto files = std::make_unique<mjVFS>();  // 2 MB: too large for a stack
  mj_defaultVFS(files.get());
  if (mj_makeEmptyFileVFS(files.get(), kName, static_cast<int>(mjcf.size())) != 0) {
    throw std::runtime_error("MuJoCo has no memory for its scene file");
  }
  std::memcpy(files->filedata[0], mjcf.data(), mjcf.size());
  std::array<char, 1000> error{};
  ModelPointer model(mj_loadXML(kName, files.get(), error.data(), static_cast<int>(error.size())));
  mj_deleteVFS(files.get());
  if (!model) throw std::runtime_error(std::string("MuJoCo refuses the scene: ") + error.data());
  return model;
}

DataPointer make_data(const mjModel& model) {
  DataPointer data(mj_makeData(&model));
  if (!data) throw std::runtime_error("MuJoCo has no memory for its state");
  return data;
}

int element_id(const mjModel& model, mjtObj kind, const std::string& name) {
  const int id = mj_name2id(&model, kind, name.c_str());
  HOPSCOTCH_CHECK(id >= 0);
  return id;
}

}  // namespace hopscotch::sim
