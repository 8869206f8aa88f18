#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/config_reader.hpp"
#include "core/time.hpp"

namespace hopscotch::apps {

class EmulatedRobot;

/// One thing that goes wrong in the emulation: an entry of `emulation.faults`.
struct ScriptedFault {
  enum class Kind : std::uint8_t {
    lost_replies,      ///< `count` answers vanish on `bus`.
    silent,            ///< The drive of `joint` is dead.
    over_temperature,  ///< The drive of `joint` trips.
    swapped_replies,   ///< The drives of `joint` and of the next one answer with each other's
                       ///< identifier.
    wrong_range,       ///< The drive of `joint` is set to a third of its torque range.
    bus_off,           ///< The host's controller leaves `bus`.
    cut_bus,           ///< Nobody acknowledges on `bus`.
    full_queue,        ///< The host's interface takes no more frames for `bus`.
    stuck_encoder,     ///< Of `joint`.
    imu_loss,
  };
  /// When it happens.
  enum class Moment : std::uint8_t { at_time, in_stance, in_flight };

  Kind kind = Kind::silent;
  Moment moment = Moment::at_time;
  double after = 0.0;  ///< Since the start, the release from the harness, or the lift-off [s].
  int joint = 0;
  int bus = 0;
  int count = 1;

  static ScriptedFault load(const core::ConfigReader& section);
};

/// Lets the faults of a list happen, each once.
class FaultScript {
 public:
  explicit FaultScript(std::vector<ScriptedFault> faults) : faults_(std::move(faults)) {}

  /// To be called every tick.
  void play(EmulatedRobot& robot);

 private:
  [[nodiscard]] bool due(const ScriptedFault& fault, const EmulatedRobot& robot) const;
  std::vector<ScriptedFault> faults_;
  std::optional<core::Stamp> released_;
  std::optional<core::Stamp> lifted_;
};

}  // namespace hopscotch::apps
