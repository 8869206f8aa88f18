#include "planner/jump_library.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "planner/chain_layout.hpp"

namespace hopscotch::planner {

namespace {

static_assert(std::endian::native == std::endian::little, "library files are little-endian");

constexpr std::string_view kMagic = "hopscotch jumps 1\n";
constexpr std::uint32_t kJumpsMax = 10000;
constexpr std::uint32_t kStepsMax = 1000;

// What makes jumps unlike by 1.
constexpr double kDistanceScale = 0.05;  // [m]
constexpr double kHeightScale = 0.05;    // [m]
constexpr double kPitchScale = 0.10;     // of the links at the start [rad]
constexpr double kRateScale = 1.0;       // of the links at the start [rad/s]

/// Single precision without the lower half of its digits.
std::uint16_t shortened(double value) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  return static_cast<std::uint16_t>((bits + 0x8000U) >> 16U);
}

double lengthened(std::uint16_t value) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(value) << 16U);
}

class Writer {
 public:
  template <typename Value>
  void put(const Value& value) {
    const auto bytes = std::bit_cast<std::array<char, sizeof(Value)>>(value);
    bytes_.append(bytes.data(), bytes.size());
  }
  void put_text(std::string_view text) { bytes_.append(text); }
  void put_single(double value) { put(static_cast<float>(value)); }
  void put_links(const model::LinkArray<double>& links) {
    for (const double each : links) put_single(each);
  }
  void put_short(const Eigen::VectorXd& values) {
    for (const double each : values) put(shortened(each));
  }
  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <typename Value>
  Value get() {
    std::array<char, sizeof(Value)> raw{};
    const std::string_view from = get_text(raw.size());
    std::copy(from.begin(), from.end(), raw.begin());
    return std::bit_cast<Value>(raw);
  }
  std::string_view get_text(std::size_t size) {
    if (bytes_.size() < size) throw std::invalid_argument("ends too early");
    const std::string_view text = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return text;
  }
  double get_single() { return finite(static_cast<double>(get<float>())); }
  model::LinkArray<double> get_links() {
    model::LinkArray<double> links{};
    for (double& each : links) each = get_single();
    return links;
  }
  Eigen::VectorXd get_short(int size) {
    Eigen::VectorXd values(size);
    for (double& each : values) each = finite(lengthened(get<std::uint16_t>()));
    return values;
  }
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }

 private:
  static double finite(double value) {
    if (!std::isfinite(value)) throw std::invalid_argument("holds a number that is not finite");
    return value;
  }

  std::string_view bytes_;
};

void write_jump(const KnownJump& jump, Writer& out) {
  out.put_links(jump.start.pitch);
  out.put_links(jump.start.rate);
  out.put_single(jump.distance);
  out.put_single(jump.height);
  for (const double each : jump.solution.x) out.put_single(each);
  for (const StepCorrection& step : jump.correction) {
    out.put_links(step.turn);
    out.put_links(step.acceleration);
  }
  out.put_short(jump.solution.slot_multipliers);
  out.put_short(jump.solution.equality_multipliers);
}

KnownJump read_jump(const ChainLayout& layout, Reader& in) {
  KnownJump jump;
  jump.start.pitch = in.get_links();
  jump.start.rate = in.get_links();
  jump.distance = in.get_single();
  jump.height = in.get_single();
  jump.solution.x.resize(layout.variables());
  for (double& each : jump.solution.x) each = in.get_single();
  const StepCounts& steps = layout.steps();
  jump.correction.resize(static_cast<std::size_t>(steps.takeoff + steps.flight + steps.landing));
  for (StepCorrection& step : jump.correction) {
    step.turn = in.get_links();
    step.acceleration = in.get_links();
  }
  jump.solution.slot_multipliers = in.get_short(layout.slots());
  jump.solution.equality_multipliers = in.get_short(layout.equalities());
  return jump;
}

int read_steps(Reader& in) {
  const auto count = in.get<std::uint32_t>();
  if (count < 2 || count > kStepsMax) throw std::invalid_argument("has an impossible step count");
  return static_cast<int>(count);
}

}  // namespace

double unlikeness(const KnownJump& jump, const PlanarTask& task) {
  double pitch = 0.0;
  double rate = 0.0;
  for (std::size_t j = 0; j < model::kPlanarLinks; ++j) {
    pitch = std::max(pitch, std::abs(jump.start.pitch[j] - task.start.pitch[j]));
    rate = std::max(rate, std::abs(jump.start.rate[j] - task.start.rate[j]));
  }
  return std::hypot(std::hypot((jump.distance - task.distance) / kDistanceScale,
                               (jump.height - task.height) / kHeightScale),
                    std::hypot(pitch / kPitchScale, rate / kRateScale));
}

std::vector<const KnownJump*> JumpLibrary::nearest(const PlanarTask& task,
                                                   std::size_t count) const {
  constexpr double kTooFar = 2.0;
  std::vector<std::pair<double, const KnownJump*>> ranked;
  for (const KnownJump& jump : jumps_) {
    const double size = unlikeness(jump, task);
    if (size <= kTooFar) ranked.emplace_back(size, &jump);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const KnownJump*> out;
  for (std::size_t i = 0; i < std::min(count, ranked.size()); ++i) out.push_back(ranked[i].second);
  return out;
}

bool JumpLibrary::fits(const StepCounts& steps) const {
  return jumps_.empty() || (steps_.takeoff == steps.takeoff && steps_.flight == steps.flight &&
                            steps_.landing == steps.landing);
}

std::string JumpLibrary::bytes() const {
  Writer out;
  out.put_text(kMagic);
  out.put(static_cast<std::uint32_t>(robot_.size()));
  out.put_text(robot_);
  for (const int count : {steps_.takeoff, steps_.flight, steps_.landing}) {
    out.put(static_cast<std::uint32_t>(count));
  }
  out.put(static_cast<std::uint32_t>(jumps_.size()));
  for (const KnownJump& jump : jumps_) write_jump(jump, out);
  return out.take();
}

JumpLibrary JumpLibrary::from_bytes(std::string_view bytes) {
  if (bytes.substr(0, kMagic.size()) != kMagic) {
    throw std::invalid_argument("is no library of jumps");
  }
  Reader in(bytes.substr(kMagic.size()));
  const std::string robot(in.get_text(in.get<std::uint32_t>()));
  StepCounts steps;
  steps.takeoff = read_steps(in);
  steps.flight = read_steps(in);
  steps.landing = read_steps(in);
  const auto count = in.get<std::uint32_t>();
  if (count > kJumpsMax) throw std::invalid_argument("claims too many jumps");
  JumpLibrary library(robot, steps);
  const ChainLayout layout{DecisionLayout(steps)};
  for (std::uint32_t i = 0; i < count; ++i) library.add(read_jump(layout, in));
  if (!in.at_end()) throw std::invalid_argument("goes on after its last jump");
  return library;
}

}  // namespace hopscotch::planner
