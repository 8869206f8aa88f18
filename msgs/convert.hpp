#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/joint_command.hpp"
#include "core/jump_plan.hpp"
#include "core/landing_target.hpp"
#include "core/one_step_terrain.hpp"
#include "core/robot_state.hpp"
#include "core/sensor_readings.hpp"
#include "msgs/messages.hpp"

/// Between values and the bytes of LCM messages, both ways. One overload of `encode` and one
/// specialisation of `decode` per message of `msgs/*.lcm`. What a replay computes from or is
/// compared with comes back to the bit; measurements and motions travel as 32-bit numbers. Lists
/// are bounded, so hostile bytes can neither overrun nor allocate more than they are long.
namespace hopscotch::msgs {

using Bytes = std::vector<std::uint8_t>;

/// A value as it came over a channel.
template <typename Value>
struct Tagged {
  Tag tag;
  Value value;
};

/// The message's stamp is that of the value.
[[nodiscard]] Bytes encode(const core::SensorReadings& value, const Tag& tag);
[[nodiscard]] Bytes encode(const core::RobotState& value, const Tag& tag);
[[nodiscard]] Bytes encode(const core::JointCommand& value, const Tag& tag);
/// The entries of the certificate stay behind: they belong to the solver, not to the motion.
[[nodiscard]] Bytes encode(const core::JumpPlan& value, const Tag& tag);
[[nodiscard]] Bytes encode(const core::OneStepTerrain& value, const Tag& tag);
[[nodiscard]] Bytes encode(const MapView& value, const Tag& tag);
[[nodiscard]] Bytes encode(const core::TargetChoice& value, const Tag& tag);
/// Aborts unless the image has the size that its intrinsics state.
[[nodiscard]] Bytes encode(const DepthRecord& value, const Tag& tag);
[[nodiscard]] Bytes encode(const AnchorRecord& value, const Tag& tag);
[[nodiscard]] Bytes encode(const EstimatorPrior& value, const Tag& tag);
[[nodiscard]] Bytes encode(const TargetQuestion& value, const Tag& tag);
[[nodiscard]] Bytes encode(const TargetCommand& value, const Tag& tag);
[[nodiscard]] Bytes encode(const ModeCommand& value, const Tag& tag);
[[nodiscard]] Bytes encode(const Ack& value, const Tag& tag);
[[nodiscard]] Bytes encode(const Status& value, const Tag& tag);
[[nodiscard]] Bytes encode(const Truth& value, const Tag& tag);
[[nodiscard]] Bytes encode(const Scene& value, const Tag& tag);

/// Nothing if the bytes are no message of this type and version, are cut short, or hold a count or
/// an enumerator out of its range. Numbers may be NaN: it means "not known" in many places.
template <typename Value>
[[nodiscard]] std::optional<Tagged<Value>> decode(std::span<const std::uint8_t> bytes);

template <>
std::optional<Tagged<core::SensorReadings>> decode(std::span<const std::uint8_t> bytes);
template <>
std::optional<Tagged<core::RobotState>> decode(std::span<const std::uint8_t> bytes);
template <>
std::optional<Tagged<core::JointCommand>> decode(std::span<const std::uint8_t> bytes);
template <>
std::optional<Tagged<core::JumpPlan>> decode(std::span<const std::uint8_t> bytes);
template <>
std::optional<Tagged<core::OneStepTerrain>> decode(std::span<const std::uint8_t> bytes);
template <>
std::optional<Tagged<MapView>> decode(std::span<const std::uint8_t> bytes);
template <>
std::optional<Tagged<core::TargetChoice>> decode(std::span<const std::uint8_t> bytes);
template <>
std::optional<Tagged<DepthRecord>> decode(std::span<const std::uint8_t> bytes);
template <>
std::optional<Tagged<AnchorRecord>> decode(std::span<const std::uint8_t> bytes);
template <>
std::optional<Tagged<EstimatorPrior>> decode(std::span<const std::uint8_t> bytes);
template <>
std::optional<Tagged<TargetQuestion>> decode(std::span<const std::uint8_t> bytes);
template <>
std::optional<Tagged<TargetCommand>> decode(std::span<const std::uint8_t> bytes);
template <>
std::optional<Tagged<ModeCommand>> decode(std::span<const std::uint8_t> bytes);
template <>
std::optional<Tagged<Ack>> decode(std::span<const std::uint8_t> bytes);
template <>
std::optional<Tagged<Status>> decode(std::span<const std::uint8_t> bytes);
template <>
std::optional<Tagged<Truth>> decode(std::span<const std::uint8_t> bytes);
template <>
std::optional<Tagged<Scene>> decode(std::span<const std::uint8_t> bytes);

}  // namespace hopscotch::msgs
