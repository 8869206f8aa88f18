#pragma once

#include <string_view>

/// Names of the LCM channels; part of the contract with other programs.
namespace hopscotch::msgs {

inline constexpr std::string_view kDefaultUrl =
    "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

inline constexpr std::string_view kSensorsChannel = "HOP_SENSORS";
inline constexpr std::string_view kStateChannel = "HOP_STATE";
inline constexpr std::string_view kTerrainChannel = "HOP_TERRAIN";
inline constexpr std::string_view kMapChannel = "HOP_MAP";
inline constexpr std::string_view kTargetChannel = "HOP_TARGET";
inline constexpr std::string_view kTargetCommandChannel = "HOP_TARGET_CMD";
inline constexpr std::string_view kModeCommandChannel = "HOP_COMMAND_CMD";
inline constexpr std::string_view kAckChannel = "HOP_ACK";
inline constexpr std::string_view kPlanChannel = "HOP_PLAN";
inline constexpr std::string_view kCommandChannel = "HOP_COMMAND";
inline constexpr std::string_view kStatusChannel = "HOP_STATUS";
/// With `--log-depth` only: all that perception and target choice were given, in that order.
inline constexpr std::string_view kDepthChannel = "HOP_DEPTH";
inline constexpr std::string_view kAnchorChannel = "HOP_ANCHOR";
inline constexpr std::string_view kPriorChannel = "HOP_PRIOR";
inline constexpr std::string_view kQuestionChannel = "HOP_QUESTION";
/// Simulation only, in logs only: nothing that controls may listen to these two.
inline constexpr std::string_view kTruthChannel = "HOP_TRUTH";
inline constexpr std::string_view kSceneChannel = "HOP_SCENE";

}  // namespace hopscotch::msgs
