#include "apps/replay.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "apps/pose_file.hpp"
#include "apps/scene_terrain.hpp"
#include "core/config_reader.hpp"
#include "footstep/landing_selector.hpp"
#include "msgs/run_log.hpp"
#include "perception/occupancy.hpp"
#include "perception/one_step.hpp"
#include "perception/plane_segmentation.hpp"
#include "perception/terrain_mapper.hpp"

namespace hopscotch::apps {

namespace {

namespace fs = std::filesystem;

constexpr double kSurveyAhead = 1.5;  // what one jump and its look-ahead need [m]

std::vector<ReportedPlane> planes_of(const perception::LineSurvey& survey, double base) {
  std::vector<ReportedPlane> planes;
  for (const perception::SurveyedTread& tread : survey.treads) {
    planes.push_back({base + tread.height, std::abs(tread.slope), tread.slices});
  }
  return planes;
}

/// Perception and target choice as they run on the robot.
struct Stages {
  Stages(const ProgramConfig& program, const model::RobotParameters& hector)
      : config(program),
        robot(hector),
        mapper(program.perception, hector),
        volume(program.perception.occupancy),
        selector(program.footstep, hector) {}

  /// @param where  The robot's state at exposure, or the pose of a camera that no robot carries.
  template <typename Where>
  perception::MapStatus integrate(const core::DepthFrame& frame, const Where& where) {
    const perception::MapStatus status = mapper.integrate(frame, where);
    const bool fused = status == perception::MapStatus::fused;
    if (fused && volume.insert(*mapper.image(), frame.stamp)) hanging = volume.hanging();
    return status;
  }

  TerrainReport look(const core::TerrainMap& map, std::span<const Eigen::Vector3f> overhead,
                     const core::RobotState& rest, const footstep::LandingTask& task) const {
    const perception::OneStepConfig& one_step = config.perception.one_step;
    const perception::StancePose stance = perception::stance_pose(one_step, robot, rest);
    TerrainReport report;
    report.terrain = perception::one_step_terrain(one_step, map, stance);
    report.survey = perception::survey_line(one_step, map, stance, kSurveyAhead);
    report.planes = planes_of(report.survey, stance.p_WS.z());
    report.choice = selector.choose({map, report.terrain, overhead}, rest, task);
    return report;
  }

  const ProgramConfig& config;
  const model::RobotParameters& robot;
  perception::TerrainMapper mapper;
  perception::OccupancyMemory volume;
  std::vector<Eigen::Vector3f> hanging;
  footstep::LandingSelector selector;
};

Eigen::Isometry3d camera_pose(const msgs::DepthRecord& record) {
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.linear() = record.at_exposure.R_WB;
  X_WB.translation() = record.at_exposure.p_WB;
  return X_WB * record.frame.X_BC;
}

/// What the robot knew of its surroundings.
struct SeenThings {
  core::TerrainMap map;
  std::vector<Eigen::Vector3f> hanging;
};

/// Perception and target choice of a recorded run. Takes the messages of a log in their order.
class LogReplay {
 public:
  LogReplay(const ProgramConfig& config, const model::RobotParameters& robot,
            const LookObserver& observe)
      : stages_(config, robot), observe_(observe) {}

  void anchor(const msgs::AnchorRecord& record) {
    // Each anchor begins a map: at the start, and once more after a fall.
    stages_.mapper = perception::TerrainMapper(stages_.config.perception, stages_.robot);
    stages_.volume = perception::OccupancyMemory(stages_.config.perception.occupancy);
    (void)stages_.mapper.anchor_support(record.state);
    remember_map();
  }

  void depth(const msgs::DepthRecord& record) {
    status_ = stages_.integrate(record.frame, record.at_exposure);
    fused_ = fused_ || status_ == perception::MapStatus::fused;
    remember_map();
    newest_ = record.frame;
    X_WC_ = camera_pose(record);
    ++summary_.frames;
  }

  void question(core::Stamp now, const msgs::TargetQuestion& asked) {
    finish_look();
    const SeenThings* const seen = seen_at(asked.map_stamp);
    if (seen == nullptr) return;  // of the true terrain, or a log that lost its beginning
    const footstep::LandingTask task{.goal_x = asked.goal_x,
                                     .goal_heading = asked.goal_heading,
                                     .source = asked.source,
                                     .target = asked.target,
                                     .height_doubt = asked.height_doubt};
    pending_.emplace(
        ReplayedLook{.report = stages_.look(seen->map, seen->hanging, asked.rest, task),
                     .map = seen->map,
                     .frame = newest_ ? &*newest_ : nullptr,
                     .X_WC = X_WC_});
    TerrainReport& report = pending_->report;
    core::TargetChoice& choice = report.choice;
    if (choice.target && !asked.for_operator) choice.target->source = task.source;
    report.stamp = now;
    report.latency_ms = 1e3 * now.since(seen->map.stamp);
    if (!fused_) report.status = newest_ ? std::string(map_status_name(status_)) : "no_frame";
    fused_ = false;
  }

  void terrain(const core::OneStepTerrain& recorded) {
    if (!pending_) return;
    pending_->terrain_equal =
        msgs::encode(recorded, {}) == msgs::encode(pending_->report.terrain, {});
    if (!*pending_->terrain_equal) ++summary_.terrains_differing;
  }

  void target(const core::TargetChoice& recorded) {
    if (!pending_) return;
    pending_->target_equal =
        msgs::encode(recorded, {}) == msgs::encode(pending_->report.choice, {});
    if (!*pending_->target_equal) ++summary_.targets_differing;
    finish_look();
  }

  void finish_look() {
    if (!pending_) return;
    ++summary_.looks;
    if (observe_) observe_(*pending_);
    pending_.reset();
  }

  /// The stages work side by side: a decision is about a map some frames old.
  void remember_map() {
    constexpr std::size_t kMaps = 8;
    seen_.push_back({stages_.mapper.map(), stages_.hanging});
    if (seen_.size() <= kMaps) return;
    if (pending_ && &pending_->map == &seen_.front().map) finish_look();
    seen_.pop_front();
  }

  [[nodiscard]] const SeenThings* seen_at(core::Stamp stamp) const {
    const auto found = std::find_if(seen_.rbegin(), seen_.rend(), [stamp](const SeenThings& seen) {
      return seen.map.stamp == stamp;
    });
    return found == seen_.rend() ? nullptr : &*found;
  }

  [[nodiscard]] const ReplaySummary& summary() const { return summary_; }

 private:
  Stages stages_;
  const LookObserver& observe_;
  std::deque<SeenThings> seen_;  ///< After each frame, the newest last.
  std::optional<ReplayedLook> pending_;
  std::optional<core::DepthFrame> newest_;
  Eigen::Isometry3d X_WC_ = Eigen::Isometry3d::Identity();
  perception::MapStatus status_ = perception::MapStatus::blind;
  bool fused_ = false;  ///< A frame since the last look.
  ReplaySummary summary_;
};

void check_log(const fs::path& log, const msgs::RunLogSummary& read, const ReplaySummary& replay) {
  const auto reject = [&](const std::string& why) {
    throw core::ConfigError(log.string() + ": " + why);
  };
  const std::string until = " after " + std::to_string(read.events) + " messages";
  if (read.events == 0) reject("is no LCM log: it holds no message");
  if (read.cut_short) reject("is cut short or damaged" + until);
  if (read.malformed > 0) {
    reject(std::to_string(read.malformed) + " messages of known channels cannot be decoded");
  }
  if (replay.frames + replay.states.compared + replay.plans.compared == 0) {
    reject(std::string("holds nothing that could be run again: no depth frames, no plans, ") +
           (replay.homeless_readings > 0
                ? "and readings without where the estimator began (a black box begins in mid-run)"
                : "no readings"));
  }
}

/// A number at the end of a name counts by its value: 2 before 10.
bool comes_before(const fs::path& a, const fs::path& b) {
  const auto parts = [](const fs::path& image) {
    const std::string stem = image.stem().string();
    const std::size_t last = stem.find_last_not_of("0123456789");
    const std::size_t digits = last == std::string::npos ? 0 : last + 1;
    const std::size_t first = std::min(stem.find_first_not_of('0', digits), stem.size());
    return std::tuple(stem.substr(0, digits), stem.size() - first, stem.substr(first), image);
  };
  return parts(a) < parts(b);
}

std::vector<fs::path> depth_images(const fs::path& folder) {
  std::vector<fs::path> images;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!entry.is_regular_file() || !is_image_file(entry.path())) continue;
    const std::string name = entry.path().filename().string();
    if (name.find("color") == std::string::npos && name.find("rgb") == std::string::npos) {
      images.push_back(entry.path());
    }
  }
  if (images.empty()) {
    throw core::ConfigError(folder.string() + ": holds no depth image (PNG, PGM or TIFF)");
  }
  std::sort(images.begin(), images.end(), comes_before);
  return images;
}

/// First camera's pose in the world of its floor.
Eigen::Isometry3d first_pose(const fs::path& file, const core::DepthFrame& frame,
                             const ProgramConfig& config) {
  const auto planes =
      perception::segment_planes(config.perception.planes, cloud_of(frame, config.perception));
  const auto ground = perception::find_ground_frame(planes, {.optical_frame = true});
  if (!ground) throw core::ConfigError(file.string() + ": " + ground.error().sentence);
  return ground->X_WR;
}

/// The robot below a camera, on ground of height zero.
Eigen::Isometry3d stance_below(const Eigen::Isometry3d& X_WC) {
  const Eigen::Vector3d axis = X_WC.linear().col(2);
  Eigen::Isometry3d X_WS = Eigen::Isometry3d::Identity();
  X_WS.linear() =
      Eigen::AngleAxisd(std::atan2(axis.y(), axis.x()), Eigen::Vector3d::UnitZ()).matrix();
  X_WS.translation() << X_WC.translation().x(), X_WC.translation().y(), 0.0;
  return X_WS;
}

}  // namespace

ReplaySummary replay_log(const fs::path& log, const ProgramConfig& config,
                         const model::RobotParameters& robot, const LookObserver& observe) {
  if (!fs::is_regular_file(log)) throw core::ConfigError(log.string() + ": is no file");
  LogReplay replay(config, robot, observe);
  MotionReplay motion(config, robot);
  msgs::RunLogHandlers on;
  on.prior = [&](core::Stamp, const auto& message) { motion.prior(message.value); };
  on.sensors = [&](core::Stamp, const auto& message) { motion.sensors(message.value); };
  on.state = [&](core::Stamp, const auto& message) { motion.state(message.value); };
  on.plan = [&](core::Stamp, const auto& message) { motion.plan(message.value); };
  on.anchor = [&](core::Stamp, const auto& message) { replay.anchor(message.value); };
  on.depth = [&](core::Stamp, const auto& message) { replay.depth(message.value); };
  on.question = [&](core::Stamp now, const auto& message) {
    replay.question(now, message.value);
    motion.question(message.value);
  };
  on.terrain = [&](core::Stamp, const auto& message) { replay.terrain(message.value); };
  on.target = [&](core::Stamp, const auto& message) { replay.target(message.value); };
  const msgs::RunLogSummary read = msgs::read_run_log(log, on);
  replay.finish_look();
  ReplaySummary summary = replay.summary();
  summary.homeless_readings = motion.homeless_readings();
  summary.states = motion.states();
  summary.plans = motion.plans();
  check_log(log, read, summary);
  return summary;
}

ReplaySummary replay_folder(const fs::path& folder, const DepthScaling& scaling,
                            const ProgramConfig& config, const model::RobotParameters& robot,
                            const LookObserver& observe) {
  const std::vector<fs::path> images = depth_images(folder);
  const std::vector<CameraPose> poses = poses_of_images(folder, images);
  Stages stages(config, robot);
  ReplaySummary summary;
  Eigen::Isometry3d X_WV = Eigen::Isometry3d::Identity();  // V: world of the pose file
  for (std::size_t i = 0; i < images.size(); ++i) {
    core::DepthFrame frame = depth_frame_of(images[i], read_depth_image(images[i]), scaling);
    frame.stamp = poses[i].stamp;
    if (i == 0) X_WV = first_pose(images[0], frame, config) * poses[0].X_VC.inverse();
    const Eigen::Isometry3d X_WC = X_WV * poses[i].X_VC;
    const perception::MapStatus status = stages.integrate(frame, X_WC);
    const core::RobotState state = standing_at(config, robot, stance_below(X_WC));
    ReplayedLook look{.report = stages.look(stages.mapper.map(), stages.hanging, state, {}),
                      .map = stages.mapper.map(),
                      .frame = &frame,
                      .X_WC = X_WC};
    look.report.stamp = frame.stamp;
    if (status != perception::MapStatus::fused) look.report.status = map_status_name(status);
    ++summary.frames;
    ++summary.looks;
    if (observe) observe(look);
  }
  return summary;
}

}  // namespace hopscotch::apps
