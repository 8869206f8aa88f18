#include "control/wrench_qp_record.hpp"

#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace hopscotch::control {

namespace {

static_assert(std::endian::native == std::endian::little, "the file is read without swapping");

constexpr std::string_view kMagic = "JMPCQP01";
constexpr int kSteps = 10;
constexpr int kStates = 15;  // the paper's 12 and the vector of gravity
constexpr int kInputs = 12;
constexpr int kRows = 16;
constexpr std::size_t kHeaderBytes = 24;

/// Takes the fields of a record one after the other.
class Cursor {
 public:
  explicit Cursor(const double* at) : at_(at) {}
  double number() { return *at_++; }
  const double* skip(int count) {
    const double* here = at_;
    at_ += count;
    return here;
  }

 private:
  const double* at_;
};

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// The fields of a record that the physical form of the QP needs.
struct Fields {
  const double* dt;
  const double* contact;
  const double* xref;
  const double* inertia_inverse;
  const double* rpy_rate;
  const double* p_GF;
  const double* R_foot;
  Eigen::Vector3d gravity;
};

WrenchQpStage stage_of(const Fields& fields, int k) {
  WrenchQpStage stage;
  stage.dt = fields.dt[k];
  stage.rpy_rate = Eigen::Map<const RowMajor3>(fields.rpy_rate + 9 * k);
  stage.inertia_inverse = Eigen::Map<const RowMajor3>(fields.inertia_inverse + 9 * k);
  stage.velocity_gain.head<3>() = stage.dt * fields.gravity;
  stage.target = Eigen::Map<const BodyState>(fields.xref + kStates * k);
  for (int foot = 0; foot < core::kLegs; ++foot) {
    const int i = core::kLegs * k + foot;
    WrenchQpFoot& out = stage.feet[static_cast<std::size_t>(foot)];
    out.contact = fields.contact[i] > 0.5;
    out.p_GF = Eigen::Map<const Eigen::Vector3d>(fields.p_GF + 3 * i);
    out.R_moment = Eigen::Map<const RowMajor3>(fields.R_foot + 9 * i);
  }
  return stage;
}

WrenchQpRecord decode(const double* data) {
  WrenchQpRecord record;
  Cursor cursor(data);
  record.problem_class = static_cast<int>(cursor.number());
  record.sequence = static_cast<int>(cursor.number());
  record.position = static_cast<int>(cursor.number());
  cursor.number();  // whether there is one QP per step of the plan
  const double friction = cursor.number();
  const double moment_upper = cursor.number();
  const double moment_lower = cursor.number();
  record.qp.cone.upper << friction, friction, moment_upper, WrenchCone::kFree;
  record.qp.cone.lower << friction, friction, moment_lower, WrenchCone::kFree;
  record.qp.cone.max_normal_force = cursor.number();
  record.qp.mass = cursor.number();
  cursor.skip(kSteps + 1);  // times of the knots
  Fields fields{};
  fields.dt = cursor.skip(kSteps);
  fields.contact = cursor.skip(kSteps * core::kLegs);
  record.map.fill(-1);
  const double* map = cursor.skip(kSteps);
  for (std::size_t k = 0; k < kSteps; ++k) record.map[k] = static_cast<int>(map[k]);
  const double* x0 = cursor.skip(kStates);
  fields.xref = cursor.skip(kSteps * kStates);
  const double* state_weight = cursor.skip(kStates);
  const double* input_weight = cursor.skip(kInputs);
  // A, B, C and the bounds say the same as the physical data that follow.
  cursor.skip(kSteps * (kStates * kStates + kStates * kInputs + kRows * kInputs + 2 * kRows));
  fields.inertia_inverse = cursor.skip(kSteps * 9);
  fields.rpy_rate = cursor.skip(kSteps * 9);
  fields.p_GF = cursor.skip(kSteps * core::kLegs * 3);
  fields.R_foot = cursor.skip(kSteps * core::kLegs * 9);
  const double* inputs = cursor.skip(kSteps * kInputs);
  cursor.skip(kSteps * kStates);
  record.objective = cursor.number();

  record.qp.horizon = kSteps;
  record.qp.rule = StepRule::euler;
  record.qp.x0 = Eigen::Map<const BodyState>(x0);
  record.qp.state_weight = Eigen::Map<const BodyState>(state_weight);
  // Both feet have the same weights in these sets: [F_left F_right M_left M_right].
  record.qp.input_weight << input_weight[0], input_weight[1], input_weight[7], input_weight[8],
      input_weight[2];
  fields.gravity = Eigen::Map<const Eigen::Vector3d>(x0 + 12);
  for (int k = 0; k < kSteps; ++k) {
    const std::size_t i = static_cast<std::size_t>(k);
    record.qp.stages[i] = stage_of(fields, k);
    record.inputs[i] = Eigen::Map<const Eigen::Vector<double, kInputs>>(inputs + kInputs * k);
  }
  return record;
}

constexpr std::size_t kRecordDoubles = 9 + 11 + 10 + 20 + 10 + 15 + 150 + 15 + 12 + 2250 + 1800 +
                                       1920 + 160 + 160 + 90 + 90 + 60 + 180 + 120 + 150 + 3;

}  // namespace

std::optional<std::vector<WrenchQpRecord>> decode_wrench_qps(std::span<const std::byte> bytes) {
  if (bytes.size() < kHeaderBytes || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0) {
    return std::nullopt;
  }
  std::array<std::int64_t, 2> header{};  // count, doubles per record
  std::memcpy(header.data(), bytes.data() + kMagic.size(), sizeof(header));
  constexpr std::size_t kRecordBytes = kRecordDoubles * sizeof(double);
  const std::size_t count = (bytes.size() - kHeaderBytes) / kRecordBytes;
  if (header[1] != static_cast<std::int64_t>(kRecordDoubles) ||
      header[0] != static_cast<std::int64_t>(count) ||
      bytes.size() != kHeaderBytes + count * kRecordBytes) {
    return std::nullopt;
  }
  std::vector<WrenchQpRecord> records;
  records.reserve(count);
  std::vector<double> record(kRecordDoubles);  // aligned copy
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(record.data(), bytes.data() + kHeaderBytes + i * kRecordBytes, kRecordBytes);
    records.push_back(decode(record.data()));
  }
  return records;
}

}  // namespace hopscotch::control
