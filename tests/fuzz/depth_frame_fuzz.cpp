// Any depth frame and robot state: the mapper takes it in or refuses it with a status, a refused
// frame leaves the map as it was, and what the map calls observed is finite. Input: width, height,
// which numbers are hostile (4 bytes), those numbers (8 bytes each), then pixels (4 bytes each).
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include "core/check.hpp"
#include "model/robot_parameters.hpp"
#include "perception/one_step.hpp"
#include "perception/terrain_mapper.hpp"

namespace {

using namespace hopscotch;

/// Reads numbers off the input; zeros when it is used up.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}

  template <typename T>
  T take() {
    T value{};
    const std::size_t size = std::min(sizeof(T), rest_.size());
    std::memcpy(&value, rest_.data(), size);
    rest_ = rest_.subspan(size);
    return value;
  }
  [[nodiscard]] bool empty() const { return rest_.empty(); }

 private:
  std::span<const std::uint8_t> rest_;
};

struct Setup {
  model::RobotParameters robot;
  perception::PerceptionConfig config;
};

const Setup& setup() {
  static const Setup kSetup = [] {
    const std::filesystem::path config = std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config";
    const core::ConfigReader tuning = core::ConfigReader::from_file(config / "hopscotch.yaml");
    return Setup{model::RobotParameters::load(config / "robots" / "hector.yaml"),
                 perception::PerceptionConfig::load(tuning.section("perception"))};
  }();
  return kSetup;
}

core::RobotState standing() {
  core::RobotState state;
  state.p_WB = Eigen::Vector3d(0.0, 0.0, 0.55);
  state.R_WB.setIdentity();
  state.v_WB.setZero();
  state.w_WB.setZero();
  state.q << 0, 0, 0.7, -1.4, 0.7, 0, 0, 0.7, -1.4, 0.7;
  state.dq.setZero();
  state.contact = {true, true};
  return state;
}

struct Case {
  core::DepthFrame frame;
  core::RobotState state = standing();
};

/// Five times as wide and high, up to 160x120: each pixel becomes a square.
void enlarge(core::DepthFrame& frame) {
  constexpr int kTimes = 5;
  core::CameraIntrinsics& lens = frame.intrinsics;
  if (lens.width <= 0 || lens.height <= 0 || lens.width > 32 || lens.height > 24) return;
  const std::vector<float> small = std::move(frame.depth);
  const int small_width = lens.width;
  lens.width *= kTimes;
  lens.height *= kTimes;
  for (double* const number : {&lens.fx, &lens.fy, &lens.cx, &lens.cy}) *number *= kTimes;
  frame.depth.clear();
  for (int v = 0; v < lens.height; ++v) {
    for (int u = 0; u < lens.width; ++u) {
      const int at = v / kTimes * small_width + u / kTimes;
      frame.depth.push_back(small[static_cast<std::size_t>(at)]);
    }
  }
}

Case make_case(Input& input) {
  Case result;
  core::CameraIntrinsics& lens = result.frame.intrinsics;
  lens = {.width = input.take<std::int8_t>(),
          .height = input.take<std::int8_t>(),
          .fx = 20.0,
          .fy = 20.0,
          .cx = 16.0,
          .cy = 12.0};
  const auto hostile = input.take<std::uint32_t>();
  Eigen::Isometry3d& X_BC = result.frame.X_BC;
  X_BC.translation() = Eigen::Vector3d(0.09, 0.0, 0.08);
  // Looks ahead and down.
  X_BC.linear() = (Eigen::Matrix3d() << 0, -0.56, 0.83, -1, 0, 0, 0, -0.83, -0.56).finished();
  double* const numbers[] = {&lens.fx,
                             &lens.fy,
                             &lens.cx,
                             &lens.cy,
                             &X_BC.translation().x(),
                             &X_BC.linear()(0, 1),
                             &X_BC.linear()(2, 2),
                             &result.state.p_WB.x(),
                             &result.state.p_WB.z(),
                             &result.state.R_WB(0, 0),
                             &result.state.R_WB(1, 2),
                             &result.state.v_WB.y(),
                             &result.state.w_WB.z(),
                             &result.state.q(3)};
  for (std::size_t i = 0; i < std::size(numbers); ++i) {
    if ((hostile >> i & 1U) != 0) *numbers[i] = input.take<double>();
  }
  result.frame.stamp.nanoseconds = 1'000'000;
  const bool wrong_size = (hostile >> 31U & 1U) != 0;
  while (!input.empty()) result.frame.depth.push_back(input.take<float>());
  const int pixels = std::max(0, lens.width) * std::max(0, lens.height);
  if (!wrong_size) result.frame.depth.resize(static_cast<std::size_t>(pixels), 0.8F);
  const bool to_full_size = (hostile >> 30U & 1U) != 0;
  if (to_full_size && !wrong_size) enlarge(result.frame);
  return result;
}

bool same_map(const core::TerrainMap& a, const core::TerrainMap& b) {
  return a.stamp == b.stamp && a.frames == b.frames && a.origin_x == b.origin_x &&
         a.origin_y == b.origin_y &&
         std::equal(a.cells.begin(), a.cells.end(), b.cells.begin(), b.cells.end(),
                    [](const core::TerrainCell& x, const core::TerrainCell& y) {
                      return x.state == y.state && std::bit_cast<std::uint32_t>(x.height) ==
                                                       std::bit_cast<std::uint32_t>(y.height);
                    });
}

void check_map(const core::TerrainMap& map) {
  HOPSCOTCH_CHECK(map.cells.size() ==
                  static_cast<std::size_t>(map.size_x) * static_cast<std::size_t>(map.size_y));
  HOPSCOTCH_CHECK(std::isfinite(map.origin_x) && std::isfinite(map.origin_y));
  for (const core::TerrainCell& cell : map.cells) {
    if (cell.state != core::CellState::observed) continue;
    HOPSCOTCH_CHECK(std::isfinite(cell.height) && std::isfinite(cell.variance));
    HOPSCOTCH_CHECK(cell.variance >= 0.0F);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  Case test = make_case(input);
  perception::TerrainMapper mapper(setup().config, setup().robot);
  HOPSCOTCH_CHECK(mapper.anchor_support(standing()) == perception::MapStatus::fused);
  constexpr int kFrames = 3;  // more than make a cell observed
  for (int i = 0; i < kFrames; ++i) {
    const core::TerrainMap before = mapper.map();
    test.frame.stamp = test.frame.stamp.after(0.033);
    const perception::MapStatus status = mapper.integrate(test.frame, test.state);
    if (status != perception::MapStatus::fused) HOPSCOTCH_CHECK(same_map(before, mapper.map()));
    check_map(mapper.map());
  }
  const perception::StancePose stance =
      perception::stance_pose(setup().config.one_step, setup().robot, standing());
  const core::OneStepTerrain terrain =
      perception::one_step_terrain(setup().config.one_step, mapper.map(), stance);
  HOPSCOTCH_CHECK(terrain.coverage >= 0.0 && terrain.coverage <= 1.0);
  HOPSCOTCH_CHECK(terrain.edge_count <= core::OneStepTerrain::kMaxFeatures);
  HOPSCOTCH_CHECK(terrain.gap_count <= core::OneStepTerrain::kMaxFeatures);
  return 0;
}
