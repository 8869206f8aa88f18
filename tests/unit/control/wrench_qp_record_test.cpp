#include "control/wrench_qp_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace hopscotch::control {
namespace {

/// The recorded set is no part of the repository: it is looked for beside it, or where
/// HOPSCOTCH_QPS says.
std::filesystem::path recorded_set() {
  const char* place = std::getenv("HOPSCOTCH_QPS");
  if (place != nullptr) return place;
  return std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / ".." / "shared" / "qps" / "qps.bin";
}

std::vector<char> bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(WrenchQpRecord, RejectsWhatIsNoSuchFile) {
  EXPECT_FALSE(decode_wrench_qps({}).has_value());
  const std::string text = "JMPCQP01 but then only words, which are no header of any records";
  EXPECT_FALSE(decode_wrench_qps(std::as_bytes(std::span(text))).has_value());
  const std::string other(4096, 'x');
  EXPECT_FALSE(decode_wrench_qps(std::as_bytes(std::span(other))).has_value());
}

class RecordedQps : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(recorded_set())) GTEST_SKIP() << "no recorded set";
    const std::vector<char> bytes = bytes_of(recorded_set());
    const auto decoded = decode_wrench_qps(std::as_bytes(std::span(bytes)));
    ASSERT_TRUE(decoded.has_value());
    records_ = *decoded;
    ASSERT_FALSE(records_.empty());
  }

  std::vector<WrenchQpRecord> records_;
};

constexpr QpTolerances kTolerances{.iteration_cap = 25, .gap = 1e-8, .stationarity = 1e-6};
constexpr double kObjectiveError = 1e-6;  // relative to 1 + objective; a hundred gap tolerances
constexpr double kForceError = 0.5;       // what that objective error allows in a flat cost [N]

TEST_F(RecordedQps, ColdSolutionsReachTheReferenceObjective) {
  QpSolver solver(kTolerances);
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const WrenchQpRecord& record = records_[i];
    ASSERT_EQ(solver.solve_cold(record.qp), QpStatus::solved) << "problem " << i;
    EXPECT_NEAR(solver.objective(), record.objective, kObjectiveError * (1.0 + record.objective))
        << "problem " << i;
    for (const core::Leg leg : core::kAllLegs) {
      const Eigen::Vector3d reference = record.inputs[0].segment<3>(3 * static_cast<int>(leg));
      const FootInput u = solver.input(0, leg);
      const Eigen::Vector3d force(u(kForceX), u(kForceY), u(kForceZ));
      EXPECT_LE((force - reference).cwiseAbs().maxCoeff(), kForceError) << "problem " << i;
    }
  }
}

TEST_F(RecordedQps, WarmSolutionsReachTheReferenceObjective) {
  QpSolver solver(kTolerances);
  int previous_sequence = -1;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const WrenchQpRecord& record = records_[i];
    const bool continued = record.position > 0 && record.sequence == previous_sequence;
    previous_sequence = record.sequence;
    ASSERT_EQ(continued ? solver.solve_warm(record.qp, record.map) : solver.solve_cold(record.qp),
              QpStatus::solved)
        << "problem " << i;
    EXPECT_NEAR(solver.objective(), record.objective, kObjectiveError * (1.0 + record.objective))
        << "problem " << i;
  }
}

}  // namespace
}  // namespace hopscotch::control
