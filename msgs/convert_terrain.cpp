#include <algorithm>
#include <iterator>

#include "hopscotch_msgs/target.hpp"
#include "hopscotch_msgs/terrain.hpp"
#include "msgs/convert.hpp"
#include "msgs/wire.hpp"
#include "msgs/wire_target.hpp"

namespace hopscotch::msgs {

static_assert(std::size(decltype(hopscotch_msgs::profile::lower){}) ==
              core::TerrainProfile::kSamples);
static_assert(hopscotch_msgs::terrain::MAX_FEATURES == core::OneStepTerrain::kMaxFeatures);
static_assert(hopscotch_msgs::target::MAX_CANDIDATES == core::TargetChoice::kMaxCandidates);

namespace wire {

void put(const core::TerrainProfile& from, hopscotch_msgs::profile& to) {
  std::copy(from.lower.begin(), from.lower.end(), to.lower);
  std::copy(from.mean.begin(), from.mean.end(), to.mean);
  std::copy(from.upper.begin(), from.upper.end(), to.upper);
  std::transform(from.state.begin(), from.state.end(), to.state, number_of<core::CellState>);
}

bool get(const hopscotch_msgs::profile& from, core::TerrainProfile& to) {
  std::copy(std::begin(from.lower), std::end(from.lower), to.lower.begin());
  std::copy(std::begin(from.mean), std::end(from.mean), to.mean.begin());
  std::copy(std::begin(from.upper), std::end(from.upper), to.upper.begin());
  for (std::size_t i = 0; i < to.state.size(); ++i) {
    if (!get_enum(from.state[i], core::CellState::observed, to.state[i])) return false;
  }
  return true;
}

void put(const core::LandingTarget& from, hopscotch_msgs::landing_target& to) {
  for (std::size_t leg = 0; leg < from.X_WF.size(); ++leg) {
    put(Eigen::Vector3d(from.X_WF[leg].translation()), to.p_WF[leg]);
    put(Eigen::Matrix3d(from.X_WF[leg].linear()), to.R_WF[leg]);
  }
  put(from.p_WS, to.p_WS);
  to.heading_rad = from.heading;
  to.distance = from.distance;
  to.height = from.height;
  to.margin = from.margin;
  to.safe_probability = from.safe_probability;
  to.source = number_of(from.source);
  put(from.profile, to.profile);
}

bool get(const hopscotch_msgs::landing_target& from, core::LandingTarget& to) {
  for (std::size_t leg = 0; leg < to.X_WF.size(); ++leg) {
    Eigen::Vector3d p;
    Eigen::Matrix3d R;
    get(from.p_WF[leg], p);
    get(from.R_WF[leg], R);
    to.X_WF[leg].translation() = p;
    to.X_WF[leg].linear() = R;
  }
  get(from.p_WS, to.p_WS);
  to.heading = from.heading_rad;
  to.distance = from.distance;
  to.height = from.height;
  to.margin = from.margin;
  to.safe_probability = from.safe_probability;
  return get_enum(from.source, core::TargetSource::operator_override, to.source) &&
         get(from.profile, to.profile);
}

}  // namespace wire

namespace {

void put_features(const core::OneStepTerrain& from, hopscotch_msgs::terrain& to) {
  to.edge_count = static_cast<std::int32_t>(from.edge_count);
  for (std::size_t i = 0; i < from.edges.size(); ++i) {
    to.edge_x[i] = from.edges[i].x;
    to.edge_sigma[i] = from.edges[i].sigma;
    to.edge_step[i] = from.edges[i].step;
    to.edge_kind[i] = wire::number_of(from.edges[i].kind);
  }
  to.gap_count = static_cast<std::int32_t>(from.gap_count);
  for (std::size_t i = 0; i < from.gaps.size(); ++i) {
    to.gap_near_x[i] = from.gaps[i].near_x;
    to.gap_far_x[i] = from.gaps[i].far_x;
    to.gap_sigma[i] = from.gaps[i].sigma;
  }
}

bool get_features(const hopscotch_msgs::terrain& from, core::OneStepTerrain& to) {
  if (!wire::get_count(from.edge_count, to.edges.size(), to.edge_count) ||
      !wire::get_count(from.gap_count, to.gaps.size(), to.gap_count)) {
    return false;
  }
  for (std::size_t i = 0; i < to.edge_count; ++i) {
    to.edges[i].x = from.edge_x[i];
    to.edges[i].sigma = from.edge_sigma[i];
    to.edges[i].step = from.edge_step[i];
    if (!wire::get_enum(from.edge_kind[i], core::EdgeKind::gap_far, to.edges[i].kind)) return false;
  }
  for (std::size_t i = 0; i < to.gap_count; ++i) {
    to.gaps[i] = {from.gap_near_x[i], from.gap_far_x[i], from.gap_sigma[i]};
  }
  return true;
}

void put_candidates(const core::TargetChoice& from, hopscotch_msgs::target& to) {
  to.ranked_count = static_cast<std::int32_t>(from.ranked_count);
  to.rejected_count = static_cast<std::int32_t>(from.rejected_count);
  for (std::size_t i = 0; i < core::TargetChoice::kMaxCandidates; ++i) {
    to.ranked_distance[i] = from.ranked[i].distance;
    to.ranked_height[i] = from.ranked[i].height;
    to.ranked_margin[i] = from.ranked[i].margin;
    to.ranked_tread[i] = from.ranked[i].tread;
    to.ranked_safe_probability[i] = from.ranked[i].safe_probability;
    to.rejected_distance[i] = from.rejected[i].distance;
    to.rejected_why[i] = wire::number_of(from.rejected[i].why);
  }
}

bool get_candidates(const hopscotch_msgs::target& from, core::TargetChoice& to) {
  if (!wire::get_count(from.ranked_count, to.ranked.size(), to.ranked_count) ||
      !wire::get_count(from.rejected_count, to.rejected.size(), to.rejected_count)) {
    return false;
  }
  for (std::size_t i = 0; i < to.ranked_count; ++i) {
    to.ranked[i] = {from.ranked_distance[i], from.ranked_height[i], from.ranked_margin[i],
                    from.ranked_tread[i], from.ranked_safe_probability[i]};
  }
  for (std::size_t i = 0; i < to.rejected_count; ++i) {
    to.rejected[i].distance = from.rejected_distance[i];
    if (!wire::get_enum(from.rejected_why[i], core::Reason::internal_error, to.rejected[i].why)) {
      return false;
    }
  }
  return true;
}

}  // namespace

Bytes encode(const core::OneStepTerrain& value, const Tag& tag) {
  hopscotch_msgs::terrain message{};
  wire::set_header(value.stamp, tag, message);
  wire::put(value.p_WS, message.p_WS);
  message.heading_rad = value.heading;
  message.coverage = value.coverage;
  wire::put(value.profile, message.profile);
  put_features(value, message);
  return wire::to_bytes(message);
}

template <>
std::optional<Tagged<core::OneStepTerrain>> decode(std::span<const std::uint8_t> bytes) {
  const auto message = wire::from_bytes<hopscotch_msgs::terrain>(bytes);
  if (!message) return std::nullopt;
  core::OneStepTerrain value;
  value.stamp = wire::stamp_of(*message);
  wire::get(message->p_WS, value.p_WS);
  value.heading = message->heading_rad;
  value.coverage = message->coverage;
  if (!wire::get(message->profile, value.profile) || !get_features(*message, value)) {
    return std::nullopt;
  }
  return Tagged<core::OneStepTerrain>{wire::tag_of(*message), value};
}

Bytes encode(const core::TargetChoice& value, const Tag& tag) {
  hopscotch_msgs::target message{};
  wire::set_header(value.stamp, tag, message);
  message.has_target = value.target.has_value();
  wire::put(value.target.value_or(core::LandingTarget{}), message.target);
  message.refusal_reason = wire::number_of(value.refusal.reason);
  message.refusal_sentence = value.refusal.sentence;
  put_candidates(value, message);
  return wire::to_bytes(message);
}

template <>
std::optional<Tagged<core::TargetChoice>> decode(std::span<const std::uint8_t> bytes) {
  const auto message = wire::from_bytes<hopscotch_msgs::target>(bytes);
  if (!message) return std::nullopt;
  core::TargetChoice value;
  value.stamp = wire::stamp_of(*message);
  core::LandingTarget target;
  if (!wire::get(message->target, target)) return std::nullopt;
  if (message->has_target != 0) value.target = target;
  value.refusal.sentence = wire::text_of(message->refusal_sentence);
  if (!wire::get_enum(message->refusal_reason, core::Reason::internal_error,
                      value.refusal.reason) ||
      !get_candidates(*message, value)) {
    return std::nullopt;
  }
  return Tagged<core::TargetChoice>{wire::tag_of(*message), value};
}

}  // namespace hopscotch::msgs
