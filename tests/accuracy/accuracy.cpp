#include "tests/accuracy/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <random>

#include "footstep/foothold_score.hpp"
#include "footstep/landing_selector.hpp"
#include "model/stand_posture.hpp"
#include "perception/line_survey.hpp"
#include "perception/one_step.hpp"
#include "perception/terrain_mapper.hpp"
#include "planner/step_target.hpp"
#include "sim/camera_noise.hpp"
#include "sim/depth_scene.hpp"
#include "tests/accuracy/random_world.hpp"

namespace hopscotch::accuracy {

namespace {

constexpr int kFrames = 8;
constexpr double kSoleHalfLength = 0.075;
constexpr double kNearEnd = 0.8;
constexpr double kFarEnd = 1.2;
constexpr double kFarthest = 1.5;      // the jump after the next one lands before it
constexpr double kFirstInView = 0.27;  // ground nearer than this is below the image

struct Setup {
  perception::PerceptionConfig perception;
  footstep::FootstepConfig footstep;
  model::RobotParameters robot;
  core::RobotState standing;
  sim::CameraSettings camera;

  static Setup load() {
    const std::string root = HOPSCOTCH_SOURCE_DIR;
    const core::ConfigReader tuning =
        core::ConfigReader::from_file(root + "/config/hopscotch.yaml");
    Setup setup{.perception = perception::PerceptionConfig::load(tuning.section("perception")),
                .footstep = footstep::FootstepConfig::load(tuning.section("footstep")),
                .robot = model::RobotParameters::load(root + "/config/robots/hector.yaml"),
                .standing = {},
                .camera = {}};
    const auto posture =
        model::StandPosture::load(tuning.section("model").section("stand_posture"));
    setup.standing = planner::standing_state(model::stand_pose(setup.robot, posture).value());
    return setup;
  }
};

Eigen::Isometry3d trunk_pose(const core::RobotState& state) {
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.linear() = state.R_WB;
  X_WB.translation() = state.p_WB;
  return X_WB;
}

/// Crouching before a jump: the trunk sinks and leans a little while frames come in.
core::RobotState crouching(const Setup& setup, int frame) {
  core::RobotState state = setup.standing;
  const double share = static_cast<double>(frame) / kFrames;
  state.stamp = core::Stamp::from_seconds(frame / 30.0);
  state.p_WB += Eigen::Vector3d(0.02 * share, 0.0, -0.04 * share);
  state.v_WB = Eigen::Vector3d(0.075, 0.0, -0.15);
  state.R_WB = state.R_WB * Eigen::AngleAxisd(0.05 * share, Eigen::Vector3d::UnitY());
  state.w_WB = Eigen::Vector3d(0.0, 0.19, 0.0);
  return state;
}

/// What perception believes of a frame that was taken at `truth`.
core::RobotState believed(const core::RobotState& truth, const Faults& faults) {
  core::RobotState state = truth;
  state.p_WB -= faults.time_error * truth.v_WB;
  state.R_WB =
      state.R_WB * Eigen::AngleAxisd(-faults.time_error * truth.w_WB.y(), Eigen::Vector3d::UnitY());
  state.q.array() += faults.leg_error;
  return state;
}

class Look {
 public:
  Look(const Setup& setup, const RandomWorld& world, const Faults& faults, std::uint64_t seed)
      : setup_(setup), world_(world), mapper_(setup.perception, setup.robot) {
    const sim::Terrain terrain = world.terrain();
    const std::vector<sim::Face> faces = sim::terrain_faces(terrain);
    const core::CameraIntrinsics lens = sim::camera_intrinsics(setup.camera);
    sim::DepthRenderer renderer(lens, {});
    sim::DepthNoise noise({}, lens, {}, seed);
    std::mt19937_64 random(seed);
    // What all frames share, as large as perception is told that it is.
    std::normal_distribution<double> normal;
    const double tilt = setup.perception.noise.tilt * normal(random);
    const double rise = setup.perception.noise.floor * normal(random);
    const Eigen::Isometry3d X_BC = sim::camera_mounting(setup.camera);
    core::RobotState on_soles = setup.standing;
    on_soles.p_WB.z() += setup.perception.mapper.support_sigma * normal(random);
    (void)mapper_.anchor_support(on_soles);
    std::vector<float> exact;
    for (int i = 0; i < kFrames; ++i) {
      const core::RobotState truth = crouching(setup, i);
      renderer.render(faces, sim::leg_capsules(setup.robot, truth), trunk_pose(truth) * X_BC,
                      exact);
      core::DepthFrame frame;
      frame.stamp = truth.stamp;
      frame.intrinsics = lens;
      frame.X_BC = X_BC;
      frame.X_BC.linear() =
          Eigen::AngleAxisd(faults.pitch_error + tilt, Eigen::Vector3d::UnitY()) * X_BC.linear();
      noise.apply(static_cast<std::uint64_t>(i), exact, frame.depth);
      std::bernoulli_distribution lost(faults.dropout);
      if (faults.dropout > 0.0) {
        for (float& z : frame.depth) z = lost(random) ? 0.0F : z;
      }
      core::RobotState state = believed(truth, faults);
      state.p_WB.z() += rise;
      (void)mapper_.integrate(frame, state);
    }
    camera_ = (trunk_pose(setup.standing) * X_BC).translation();
    const perception::OneStepConfig& one_step = setup.perception.one_step;
    const auto stance = perception::stance_pose(one_step, setup.robot, setup.standing);
    terrain_ = perception::one_step_terrain(one_step, mapper_.map(), stance);
    step_sigmas_ = perception::survey_line(one_step, mapper_.map(), stance, 1.5).step_sigmas;
  }

  void judge(Figures& figures) const {
    ++figures.worlds;
    judge_heights(figures);
    judge_edges(figures);
    judge_gaps(figures);
    judge_targets(figures);
    judge_footholds(figures);
  }

 private:
  void judge_heights(Figures& figures) const {
    constexpr double kTrack = 0.15;
    constexpr double kClear = 0.02;  // of edges, where cells are judged as edges
    const core::TerrainMap& map = mapper_.map();
    for (int iy = 0; iy < map.size_y; ++iy) {
      const double y = map.origin_y + (iy + 0.5) * map.resolution;
      if (std::abs(y) > kTrack) continue;
      for (int ix = 0; ix < map.size_x; ++ix) {
        const double x = map.origin_x + (ix + 0.5) * map.resolution;
        const core::TerrainCell& cell = map.at(ix, iy);
        if (x < kFirstInView || x > kFarthest || world_.spare(x - kClear, x + kClear) < 0.0)
          continue;
        if (!world_.is_visible({camera_.x(), camera_.z()}, x)) continue;
        const bool seen = cell.state == core::CellState::observed;
        Share& share = x < kFarEnd ? figures.near_cells : figures.far_cells;
        share.add(seen);
        if (!seen || x > kFarEnd) continue;
        const TrueTread* tread = world_.at(x);
        if (tread == nullptr) continue;
        const double error = static_cast<double>(cell.height) - tread->top;
        Errors& errors = x < kNearEnd ? figures.near_height : figures.far_height;
        errors.add(error, std::sqrt(static_cast<double>(cell.variance)));
      }
    }
  }

  [[nodiscard]] bool in_sight(const TrueEdge& edge) const {
    if (edge.x < kFirstInView) return false;
    const double inside = edge.far_side || edge.step > 0.0 ? 0.005 : -0.005;
    return world_.is_visible({camera_.x(), camera_.z()}, edge.x + inside);
  }

  /// Steps below the least one count as no edge, gaps always.
  [[nodiscard]] static bool counts(const TrueEdge& edge) {
    return edge.width > 0.0 || std::abs(edge.step) >= 0.035;
  }

  void judge_edges(Figures& figures) const {
    constexpr double kMatch = 0.04;
    const std::vector<TrueEdge> truth = world_.edges();
    std::vector<bool> used(terrain_.edge_count, false);
    for (const TrueEdge& edge : truth) {
      if (edge.x < 0.1 || edge.x > kFarEnd || !counts(edge) || !in_sight(edge)) continue;
      std::optional<std::size_t> best;
      for (std::size_t i = 0; i < terrain_.edge_count; ++i) {
        const double distance = std::abs(terrain_.edges[i].x - edge.x);
        const bool side = (terrain_.edges[i].kind == core::EdgeKind::gap_far) == edge.far_side;
        if (used[i] || distance > kMatch || (edge.width >= 0.06 && !side)) continue;
        if (!best || distance < std::abs(terrain_.edges[*best].x - edge.x)) best = i;
      }
      if (!best) {
        ++figures.edges_missed;
        continue;
      }
      used[*best] = true;
      const core::TerrainEdge& found = terrain_.edges[*best];
      figures.edge.add(found.x - edge.x, found.sigma);
      // What is hidden beside a step may be a gap; its other side is then another tread.
      const bool is_gap =
          found.kind == core::EdgeKind::gap_near || found.kind == core::EdgeKind::gap_far;
      const bool once = edge.far_side || (edge.width == 0.0 && !is_gap);
      if (once && std::isfinite(found.step) && std::abs(edge.step) >= 0.03) {
        figures.step.add(found.step - edge.step, step_sigmas_[*best]);
      }
    }
    for (std::size_t i = 0; i < terrain_.edge_count; ++i) {
      const double x = terrain_.edges[i].x;
      // The far end of what a step down hides is where the sight ends, not an edge.
      if (terrain_.edges[i].kind == core::EdgeKind::gap_far && terrain_.edges[i].step < 0.0)
        continue;
      const bool real = std::any_of(truth.begin(), truth.end(), [x](const TrueEdge& edge) {
        return std::abs(edge.x - x) < 2.0 * kMatch;
      });
      if (x > kFirstInView && x < kFarEnd && !real) ++figures.edges_invented;
    }
  }

  void judge_gaps(Figures& figures) const {
    for (std::size_t i = 0; i < terrain_.gap_count; ++i) {
      const core::TerrainGap& gap = terrain_.gaps[i];
      const double middle = 0.5 * (gap.near_x + gap.far_x);
      for (const TrueEdge& edge : world_.edges()) {
        const bool here =
            edge.width >= 0.05 && edge.far_side && middle > edge.x - edge.width && middle < edge.x;
        const bool near_in_sight = edge.x - edge.width > kFirstInView;
        if (here && near_in_sight && edge.x < kFarEnd && in_sight(edge)) {
          // Either end is told a standard deviation of an edge outwards.
          const double margin = std::numbers::sqrt2 * gap.sigma;
          figures.gap_width.add(gap.far_x - gap.near_x - edge.width, gap.sigma, margin);
        }
      }
    }
  }

  [[nodiscard]] bool is_safe(double x) const {
    constexpr double kInflated = 0.01;
    return world_.spare(x - kSoleHalfLength - kInflated, x + kSoleHalfLength + kInflated) >= 0.0;
  }

  void judge_targets(Figures& figures) const {
    const footstep::LandingSelector selector(setup_.footstep, setup_.robot);
    const core::TargetChoice choice =
        selector.choose({mapper_.map(), terrain_}, setup_.standing, {});
    for (std::size_t i = 0; i < choice.ranked_count; ++i) {
      ++figures.accepted;
      if (!is_safe(choice.ranked[i].distance)) ++figures.false_safe;
    }
    if (!choice.target) return;
    ++figures.chosen;
    if (!is_safe(choice.target->distance)) ++figures.chosen_unsafe;
  }

  void judge_footholds(Figures& figures) const {
    constexpr double kRoom = 0.06;
    const footstep::StanceOnMap stance{.map = mapper_.map(),
                                       .p_WS = terrain_.p_WS,
                                       .heading = terrain_.heading,
                                       .half_stance = 0.098,
                                       .half_length = kSoleHalfLength,
                                       .half_width = 0.01};
    for (double x = 0.25; x <= 0.80; x += 0.03) {
      const double from = x - kSoleHalfLength - kRoom;
      const double to = x + kSoleHalfLength + kRoom;
      if (world_.spare(from, to) < 0.0) continue;
      const Eigen::Vector2d camera(camera_.x(), camera_.z());
      if (!world_.is_visible(camera, from) || from < kFirstInView) continue;
      ++figures.roomy;
      const auto foothold = score_foothold(setup_.footstep.foothold, stance, {.x = x});
      if (foothold.why != core::Reason::none) ++figures.false_reject;
    }
  }

  const Setup& setup_;
  const RandomWorld& world_;
  perception::TerrainMapper mapper_;
  Eigen::Vector3d camera_;
  core::OneStepTerrain terrain_;
  std::vector<double> step_sigmas_;
};

void append(const Errors& from, Errors& to) {
  to.values.insert(to.values.end(), from.values.begin(), from.values.end());
  to.normalised.insert(to.normalised.end(), from.normalised.begin(), from.normalised.end());
}

double mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

std::string line(const char* name, const Errors& errors) {
  char text[200];
  std::snprintf(text, sizeof text,
                "%-18s n %8zu  rms %5.1f  bias %+5.1f  p95 %5.1f  p99 %5.1f mm  NEES %.2f\n", name,
                errors.values.size(), 1e3 * errors.rms(), 1e3 * errors.bias(),
                1e3 * errors.quantile(0.95), 1e3 * errors.quantile(0.99), errors.nees());
  return text;
}

}  // namespace

double Errors::rms() const {
  return std::sqrt(mean_square(values));
}

double Errors::bias() const {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double Errors::nees() const {
  return mean_square(normalised);
}

double Errors::quantile(double share) const {
  if (values.empty()) return 0.0;
  std::vector<double> sorted;
  for (const double value : values) sorted.push_back(std::abs(value));
  std::sort(sorted.begin(), sorted.end());
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

double Errors::share_below(double limit) const {
  const auto below =
      std::count_if(values.begin(), values.end(), [limit](double value) { return value < limit; });
  return values.empty() ? 0.0 : static_cast<double>(below) / static_cast<double>(values.size());
}

void Figures::add(const Figures& other) {
  worlds += other.worlds;
  append(other.near_height, near_height);
  append(other.far_height, far_height);
  append(other.edge, edge);
  append(other.step, step);
  append(other.gap_width, gap_width);
  near_cells.add(other.near_cells);
  far_cells.add(other.far_cells);
  edges_missed += other.edges_missed;
  edges_invented += other.edges_invented;
  accepted += other.accepted;
  false_safe += other.false_safe;
  chosen += other.chosen;
  chosen_unsafe += other.chosen_unsafe;
  roomy += other.roomy;
  false_reject += other.false_reject;
}

std::string Figures::text() const {
  char text[500];
  std::snprintf(text, sizeof text,
                "cells in sight that are observed: %.1f %% to 1.2 m, %.1f %% from there to 1.5 m\n"
                "gaps under-estimated by over 5 mm: %.2f %%\n"
                "edges missed %d, invented %d\n"
                "targets: %d of %d false-safe; chosen: %d of %d\n"
                "places with 6 cm to spare: %d of %d rejected\n",
                100.0 * near_cells.value(), 100.0 * far_cells.value(),
                100.0 * gap_width.share_below(-0.005), edges_missed, edges_invented, false_safe,
                accepted, chosen_unsafe, chosen, false_reject, roomy);
  return std::to_string(worlds) + " worlds\n" + line("height to 0.8 m", near_height) +
         line("height to 1.2 m", far_height) + line("edge", edge) + line("step", step) +
         line("gap width", gap_width) + text;
}

Figures measure(std::uint64_t first, int worlds, const Faults& faults) {
  const Setup setup = Setup::load();
  Figures figures;
  for (int i = 0; i < worlds; ++i) {
    const std::uint64_t seed = first + static_cast<std::uint64_t>(i);
    const RandomWorld world(seed);
    Look(setup, world, faults, seed).judge(figures);
  }
  return figures;
}

}  // namespace hopscotch::accuracy
