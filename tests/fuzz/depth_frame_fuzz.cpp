// Any depth frame and robot state: the mapper takes it in or refuses it with a status, a refused
// frame leaves the map as it was, what the map calls observed is finite, and there is no landing
// target unless a frame was taken in. Input: width, height, which numbers are hostile (4 bytes),
// those numbers (8 bytes each), then pixels (4 bytes each).
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <span>
#include <utility>
#include <vector>

#include "core/check.hpp"
#include "footstep/landing_selector.hpp"
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
  footstep::LandingSelector selector;
};

/// What was fed, told at the end.
struct Counts {
  long frames = 0;
  long full = 0;        ///< Of 160x120 pixels or more.
  long full_fused = 0;  ///< Of these taken into the map.
  long targets = 0;

  ~Counts() {
    std::cout << frames << " frames, " << full << " of 160x120 or more, " << full_fused
              << " of these fused; " << targets << " targets\n";
  }
};

const Setup& setup() {
  static const Setup kSetup = [] {
    const std::filesystem::path config = std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config";
    const core::ConfigReader tuning = core::ConfigReader::from_file(config / "hopscotch.yaml");
    const auto robot = model::RobotParameters::load(config / "robots" / "hector.yaml");
    return Setup{robot, perception::PerceptionConfig::load(tuning.section("perception")),
                 footstep::LandingSelector(
                     footstep::FootstepConfig::load(tuning.section("footstep")), robot)};
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

/// Between pixels of a small image: on a plane between four readings, else the nearest.
float between(const std::vector<float>& small, const core::CameraIntrinsics& lens, double u,
              double v) {
  const auto at = [&](int x, int y) {
    const int column = std::min(x, lens.width - 1);
    const int row = std::min(y, lens.height - 1);
    return small[static_cast<std::size_t>(row * lens.width + column)];
  };
  const int u0 = static_cast<int>(u);
  const int v0 = static_cast<int>(v);
  const float corners[] = {at(u0, v0), at(u0 + 1, v0), at(u0, v0 + 1), at(u0 + 1, v0 + 1)};
  const bool readings = std::all_of(std::begin(corners), std::end(corners),
                                    [](float z) { return std::isnormal(z) && z > 0.0F; });
  if (!readings) return corners[0];
  const double right = u - u0;
  const double down = v - v0;
  // On a plane the inverse of the depth is linear in the pixels.
  return static_cast<float>(1.0 /
                            ((1.0 - down) * ((1.0 - right) / corners[0] + right / corners[1]) +
                             down * ((1.0 - right) / corners[2] + right / corners[3])));
}

/// So many times as wide and high.
void enlarge(core::DepthFrame& frame, int times) {
  core::CameraIntrinsics& lens = frame.intrinsics;
  if (lens.width <= 0 || lens.height <= 0 || lens.width > 32 || lens.height > 24) return;
  std::vector<float> large;
  for (int v = 0; v < times * lens.height; ++v) {
    for (int u = 0; u < times * lens.width; ++u) {
      large.push_back(between(frame.depth, lens, 1.0 * u / times, 1.0 * v / times));
    }
  }
  frame.depth = std::move(large);
  lens.width *= times;
  lens.height *= times;
  for (double* const number : {&lens.fx, &lens.fy, &lens.cx, &lens.cy}) *number *= times;
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
  // To 160x120, or to the 320x240 that targets take.
  const bool to_full_size = (hostile >> 30U & 1U) != 0;
  const bool to_double_size = (hostile >> 29U & 1U) != 0;
  if (to_full_size && !wrong_size) enlarge(result.frame, to_double_size ? 10 : 5);
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

/// Places are told with a probability, and none at all when no frame could be used.
bool check_targets(const core::TerrainMap& map, const core::OneStepTerrain& terrain, bool fused) {
  const core::TargetChoice choice = setup().selector.choose({map, terrain}, standing(), {});
  HOPSCOTCH_CHECK(fused || !choice.target);
  for (std::size_t i = 0; i < choice.ranked_count; ++i) {
    const double probability = choice.ranked[i].safe_probability;
    HOPSCOTCH_CHECK(std::isfinite(choice.ranked[i].distance));
    HOPSCOTCH_CHECK(probability >= 0.0 && probability <= 1.0);
  }
  return choice.target.has_value();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  Case test = make_case(input);
  perception::TerrainMapper mapper(setup().config, setup().robot);
  HOPSCOTCH_CHECK(mapper.anchor_support(standing()) == perception::MapStatus::fused);
  static Counts counts;
  bool fused = false;
  constexpr int kFrames = 3;  // more than make a cell observed
  for (int i = 0; i < kFrames; ++i) {
    const core::TerrainMap before = mapper.map();
    test.frame.stamp = test.frame.stamp.after(0.033);
    const perception::MapStatus status = mapper.integrate(test.frame, test.state);
    if (status != perception::MapStatus::fused) HOPSCOTCH_CHECK(same_map(before, mapper.map()));
    fused = fused || status == perception::MapStatus::fused;
    const bool full = test.frame.depth.size() >= std::size_t{160 * 120};
    ++counts.frames;
    counts.full += full ? 1 : 0;
    counts.full_fused += full && status == perception::MapStatus::fused ? 1 : 0;
    check_map(mapper.map());
  }
  const perception::StancePose stance =
      perception::stance_pose(setup().config.one_step, setup().robot, standing());
  const core::OneStepTerrain terrain =
      perception::one_step_terrain(setup().config.one_step, mapper.map(), stance);
  HOPSCOTCH_CHECK(terrain.coverage >= 0.0 && terrain.coverage <= 1.0);
  HOPSCOTCH_CHECK(terrain.edge_count <= core::OneStepTerrain::kMaxFeatures);
  HOPSCOTCH_CHECK(terrain.gap_count <= core::OneStepTerrain::kMaxFeatures);
  counts.targets += check_targets(mapper.map(), terrain, fused) ? 1 : 0;
  return 0;
}
