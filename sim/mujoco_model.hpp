#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

namespace hopscotch::sim {

struct ModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using ModelPointer = std::unique_ptr<mjModel, ModelDeleter>;
using DataPointer = std::unique_ptr<mjData, DataDeleter>;

/// Compiles an MJCF document from memory. From then on MuJoCo's warnings write no log file; they
/// are counted in `mjData::warning` only.
/// @throws std::runtime_error with MuJoCo's words.
[[nodiscard]] ModelPointer compile_model(const std::string& mjcf);

/// @throws std::runtime_error when there is no memory.
[[nodiscard]] DataPointer make_data(const mjModel& model);

/// Number of a named element; the name must exist.
[[nodiscard]] int element_id(const mjModel& model, mjtObj kind, const std::string& name);

}  // namespace hopscotch::sim
