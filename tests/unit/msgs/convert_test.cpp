#include "msgs/convert.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string_view>

#include "tests/unit/msgs/samples.hpp"

namespace hopscotch::msgs {
namespace {

constexpr Tag kTag{17, 0xFEDCBA9876543210U};  // the run id uses its highest bit

/// There and back; fails the test if the bytes are not understood.
template <typename Value>
Value round_trip(const Value& value) {
  const auto result = decode<Value>(encode(value, kTag));
  EXPECT_TRUE(result.has_value());
  if (!result) return Value{};
  EXPECT_EQ(result->tag.sequence, kTag.sequence);
  EXPECT_EQ(result->tag.run_id, kTag.run_id);
  return result->value;
}

bool same_bits(double a, double b) {
  return std::memcmp(&a, &b, sizeof(double)) == 0;
}

void expect_equal(const core::ContactWrenches& a, const core::ContactWrenches& b) {
  for (std::size_t leg = 0; leg < a.size(); ++leg) {
    EXPECT_EQ(a[leg].force, b[leg].force);
    EXPECT_EQ(a[leg].moment, b[leg].moment);
  }
}

void expect_equal(const core::RobotState& a, const core::RobotState& b) {
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_EQ(a.p_WB, b.p_WB);
  EXPECT_EQ(a.R_WB, b.R_WB);
  EXPECT_EQ(a.v_WB, b.v_WB);
  EXPECT_EQ(a.w_WB, b.w_WB);
  EXPECT_EQ(a.q, b.q);
  EXPECT_EQ(a.dq, b.dq);
  EXPECT_EQ(a.contact, b.contact);
}

void expect_equal(const core::TerrainProfile& a, const core::TerrainProfile& b) {
  EXPECT_EQ(a.lower, b.lower);
  EXPECT_EQ(a.mean, b.mean);
  EXPECT_EQ(a.upper, b.upper);
  EXPECT_EQ(a.state, b.state);
}

void expect_equal(const core::LandingTarget& a, const core::LandingTarget& b) {
  for (std::size_t leg = 0; leg < a.X_WF.size(); ++leg) {
    EXPECT_EQ(a.X_WF[leg].matrix(), b.X_WF[leg].matrix());
  }
  EXPECT_EQ(a.p_WS, b.p_WS);
  EXPECT_EQ(a.heading, b.heading);
  EXPECT_EQ(a.distance, b.distance);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.margin, b.margin);
  EXPECT_EQ(a.safe_probability, b.safe_probability);
  EXPECT_EQ(a.source, b.source);
  expect_equal(a.profile, b.profile);
}

void expect_equal(const core::JumpKnot& a, const core::JumpKnot& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.dt, b.dt);
  EXPECT_EQ(a.phase, b.phase);
  EXPECT_EQ(a.contact, b.contact);
  EXPECT_EQ(a.p_WB, b.p_WB);
  EXPECT_EQ(a.rpy, b.rpy);
  EXPECT_EQ(a.v_WB, b.v_WB);
  EXPECT_EQ(a.w_WB, b.w_WB);
  EXPECT_EQ(a.p_WG, b.p_WG);
  EXPECT_EQ(a.v_WG, b.v_WG);
  EXPECT_EQ(a.q, b.q);
  EXPECT_EQ(a.dq, b.dq);
  EXPECT_EQ(a.tau, b.tau);
  expect_equal(a.wrenches, b.wrenches);
}

TEST(Convert, SensorReadingsSurviveTheWire) {
  const core::SensorReadings sent = samples::sensors();
  const core::SensorReadings got = round_trip(sent);
  EXPECT_EQ(got.stamp, sent.stamp);
  EXPECT_EQ(got.q, sent.q);
  EXPECT_EQ(got.dq, sent.dq);
  EXPECT_EQ(got.tau, sent.tau);
  EXPECT_EQ(got.w_WB_B, sent.w_WB_B);
  EXPECT_EQ(got.f_B, sent.f_B);
}

TEST(Convert, RobotStateSurvivesTheWire) {
  expect_equal(round_trip(samples::state()), samples::state());
}

TEST(Convert, UnknownNumbersStayUnknownBitByBit) {
  const core::RobotState got = round_trip(core::RobotState{});
  EXPECT_TRUE(same_bits(got.p_WB.x(), core::RobotState{}.p_WB.x()));
  EXPECT_TRUE(got.q.array().isNaN().all());
}

TEST(Convert, JointCommandSurvivesTheWire) {
  const core::JointCommand sent = samples::command();
  const core::JointCommand got = round_trip(sent);
  EXPECT_EQ(got.stamp, sent.stamp);
  EXPECT_EQ(got.mode, sent.mode);
  EXPECT_EQ(got.q, sent.q);
  EXPECT_EQ(got.dq, sent.dq);
  EXPECT_EQ(got.kp, sent.kp);
  EXPECT_EQ(got.kd, sent.kd);
  EXPECT_EQ(got.tau, sent.tau);
}

TEST(Convert, FullPlanSurvivesTheWire) {
  const core::JumpPlan sent = samples::plan();
  const core::JumpPlan got = round_trip(sent);
  EXPECT_EQ(got.id, sent.id);
  EXPECT_EQ(got.stamp, sent.stamp);
  expect_equal(got.target, sent.target);
  ASSERT_EQ(got.knot_count, sent.knot_count);
  for (std::size_t i = 0; i < sent.knot_count; ++i) expect_equal(got.knots[i], sent.knots[i]);
  EXPECT_EQ(got.liftoff_time, sent.liftoff_time);
  EXPECT_EQ(got.touchdown_time, sent.touchdown_time);
  EXPECT_EQ(got.duration, sent.duration);
  EXPECT_EQ(got.status, sent.status);
  EXPECT_EQ(got.iterations, sent.iterations);
  EXPECT_EQ(got.warm, sent.warm);
  EXPECT_EQ(got.peaks.torque_ratio, sent.peaks.torque_ratio);
  EXPECT_EQ(got.peaks.speed_ratio, sent.peaks.speed_ratio);
  EXPECT_EQ(got.peaks.power_ratio, sent.peaks.power_ratio);
  EXPECT_EQ(got.peaks.normal_force, sent.peaks.normal_force);
  EXPECT_EQ(got.certificate.max_violation, sent.certificate.max_violation);
  EXPECT_EQ(got.certificate.dense_max_violation, sent.certificate.dense_max_violation);
}

TEST(Convert, OneStepTerrainSurvivesTheWire) {
  const core::OneStepTerrain sent = samples::terrain();
  const core::OneStepTerrain got = round_trip(sent);
  EXPECT_EQ(got.stamp, sent.stamp);
  EXPECT_EQ(got.p_WS, sent.p_WS);
  EXPECT_EQ(got.heading, sent.heading);
  EXPECT_EQ(got.coverage, sent.coverage);
  expect_equal(got.profile, sent.profile);
  ASSERT_EQ(got.edge_count, sent.edge_count);
  for (std::size_t i = 0; i < sent.edge_count; ++i) {
    EXPECT_EQ(got.edges[i].x, sent.edges[i].x);
    EXPECT_EQ(got.edges[i].sigma, sent.edges[i].sigma);
    EXPECT_EQ(got.edges[i].step, sent.edges[i].step);
    EXPECT_EQ(got.edges[i].kind, sent.edges[i].kind);
  }
  ASSERT_EQ(got.gap_count, sent.gap_count);
  EXPECT_EQ(got.gaps[0].near_x, sent.gaps[0].near_x);
  EXPECT_EQ(got.gaps[0].far_x, sent.gaps[0].far_x);
  EXPECT_EQ(got.gaps[0].sigma, sent.gaps[0].sigma);
}

TEST(Convert, TargetChoiceSurvivesTheWireWithItsReasons) {
  const core::TargetChoice sent = samples::choice();
  const core::TargetChoice got = round_trip(sent);
  ASSERT_TRUE(got.target.has_value());
  expect_equal(*got.target, *sent.target);
  ASSERT_EQ(got.ranked_count, sent.ranked_count);
  for (std::size_t i = 0; i < sent.ranked_count; ++i) {
    EXPECT_EQ(got.ranked[i].distance, sent.ranked[i].distance);
    EXPECT_EQ(got.ranked[i].height, sent.ranked[i].height);
    EXPECT_EQ(got.ranked[i].margin, sent.ranked[i].margin);
    EXPECT_EQ(got.ranked[i].tread, sent.ranked[i].tread);
    EXPECT_EQ(got.ranked[i].safe_probability, sent.ranked[i].safe_probability);
  }
  ASSERT_EQ(got.rejected_count, sent.rejected_count);
  EXPECT_EQ(got.rejected[0].distance, sent.rejected[0].distance);
  EXPECT_EQ(got.rejected[0].why, sent.rejected[0].why);
}

TEST(Convert, RefusalKeepsItsReasonAndSentence) {
  core::TargetChoice sent;
  sent.refusal = {core::Reason::gap_too_wide, "the gap of 0.90 m is wider than 0.55 m"};
  const core::TargetChoice got = round_trip(sent);
  EXPECT_FALSE(got.target.has_value());
  EXPECT_EQ(got.refusal.text(), sent.refusal.text());
}

TEST(Convert, OperatorMessagesSurviveTheWire) {
  const TargetCommand target =
      round_trip(TargetCommand{{5}, core::TargetOverride{0.4, 0.1, -0.02, 0.3}});
  ASSERT_TRUE(target.target.has_value());
  EXPECT_EQ(target.target->distance, 0.4);
  EXPECT_EQ(target.target->height, 0.1);
  EXPECT_EQ(target.target->lateral, -0.02);
  EXPECT_EQ(target.target->yaw, 0.3);
  EXPECT_FALSE(round_trip(TargetCommand{}).target.has_value());

  const ModeCommand mode = round_trip(ModeCommand{{6}, core::ModeRequest::clear_fault, 2.5});
  EXPECT_EQ(mode.mode, core::ModeRequest::clear_fault);
  EXPECT_EQ(mode.goal_x, 2.5);

  const Ack ack = round_trip(Ack{
      {7}, "HOP_TARGET_CMD", 12, false, {core::Reason::out_of_reach, "0.90 m is too far"}, 0.25});
  EXPECT_EQ(ack.channel, "HOP_TARGET_CMD");
  EXPECT_EQ(ack.command_sequence, 12U);
  EXPECT_FALSE(ack.accepted);
  EXPECT_EQ(ack.refusal.text(), "out_of_reach: 0.90 m is too far");
  EXPECT_EQ(ack.start_in, 0.25);
}

TEST(Convert, TextWithANulInsideCanBeSentOn) {
  const Bytes bytes =
      encode(Ack{{7}, "HOP_TARGET_CMD", 12, false, {core::Reason::not_now, "why"}}, {});
  Bytes hostile = bytes;
  const std::string_view word = "TARGET";
  const auto at = std::search(hostile.begin(), hostile.end(), word.begin(), word.end());
  ASSERT_NE(at, hostile.end());
  *at = 0;
  const auto message = decode<Ack>(hostile);
  ASSERT_TRUE(message.has_value());
  EXPECT_EQ(message->value.channel, "HOP_");
  EXPECT_TRUE(decode<Ack>(encode(message->value, message->tag)).has_value());
}

TEST(Convert, MapViewSurvivesTheWireAndItsSizesAreChecked) {
  MapView sent;
  sent.stamp = {8};
  sent.origin_x = -0.3;
  sent.origin_y = 0.7;
  sent.resolution = 0.015;
  sent.size_x = 3;
  sent.size_y = 2;
  sent.height_mm = {1, -2, 3, 4, 5, -600};
  sent.state[4] = core::CellState::observed;
  const MapView got = round_trip(sent);
  EXPECT_EQ(got.stamp, sent.stamp);
  EXPECT_EQ(got.origin_x, sent.origin_x);
  EXPECT_EQ(got.origin_y, sent.origin_y);
  EXPECT_EQ(got.resolution, sent.resolution);
  EXPECT_EQ(got.size_x, 3);
  EXPECT_EQ(got.size_y, 2);
  EXPECT_EQ(got.height_mm, sent.height_mm);
  EXPECT_EQ(got.state, sent.state);

  for (const int size : {-1, MapView::kMaxSide + 1, 1 << 30}) {
    MapView bad = sent;
    bad.size_y = size;
    EXPECT_FALSE(decode<MapView>(encode(bad, {1, 1}))) << size;
  }
}

TEST(Convert, StatusSurvivesTheWire) {
  const Status sent = samples::status();
  const Status got = round_trip(sent);
  EXPECT_EQ(got.control.stamp, sent.control.stamp);
  EXPECT_EQ(got.control.phase, sent.control.phase);
  EXPECT_EQ(got.control.fault, sent.control.fault);
  EXPECT_EQ(got.control.plan_id, sent.control.plan_id);
  EXPECT_EQ(got.control.plan_time, sent.control.plan_time);
  expect_equal(got.control.wrenches, sent.control.wrenches);
  EXPECT_EQ(got.jump, sent.jump);
  EXPECT_EQ(got.deadline_misses, sent.deadline_misses);
  EXPECT_EQ(got.times.tick_ms, sent.times.tick_ms);
  EXPECT_EQ(got.times.mpc_ms, sent.times.mpc_ms);
  EXPECT_TRUE(std::isnan(got.times.plan_ms));
  EXPECT_EQ(got.times.perception_ms, sent.times.perception_ms);
  EXPECT_EQ(got.times.estimator_ms, sent.times.estimator_ms);
}

TEST(Convert, TruthSurvivesTheWire) {
  const Truth sent = samples::truth();
  const Truth got = round_trip(sent);
  EXPECT_EQ(got.stamp, sent.stamp);
  expect_equal(got.state, sent.state);
  expect_equal(got.ground, sent.ground);
  EXPECT_EQ(got.tau, sent.tau);
}

TEST(Convert, FullSceneSurvivesTheWire) {
  const Scene sent = samples::scene();
  const Scene got = round_trip(sent);
  EXPECT_EQ(got.robot, sent.robot);
  EXPECT_EQ(got.goal_x, sent.goal_x);
  EXPECT_EQ(got.pit_z, sent.pit_z);
  ASSERT_EQ(got.slab_count, sent.slab_count);
  for (std::size_t i = 0; i < sent.slab_count; ++i) {
    EXPECT_EQ(got.slabs[i].top, sent.slabs[i].top);
    EXPECT_EQ(got.slabs[i].seen_rise, sent.slabs[i].seen_rise);
  }
}

// Layout of a message: 8 bytes of type hash, 24 of header, then its members, big-endian.
constexpr std::size_t kBody = 32;

TEST(Convert, EveryTruncationIsRefused) {
  const Bytes bytes = encode(samples::choice(), kTag);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(decode<core::TargetChoice>({bytes.data(), size})) << size;
  }
}

TEST(Convert, BytesAfterTheMessageAreRefused) {
  Bytes bytes = encode(samples::command(), kTag);
  bytes.push_back(0);
  EXPECT_FALSE(decode<core::JointCommand>(bytes));
}

TEST(Convert, MessageOfAnotherTypeIsRefused) {
  const Bytes bytes = encode(samples::command(), kTag);
  EXPECT_FALSE(decode<core::SensorReadings>(bytes));
}

TEST(Convert, CountsOutOfRangeAreRefused) {
  const std::size_t profile = 121 * (3 * sizeof(double) + 1);
  const std::size_t edge_count = kBody + 5 * sizeof(double) + profile;
  for (const std::uint8_t highest_byte : {std::uint8_t{0x7F}, std::uint8_t{0xFF}}) {
    Bytes bytes = encode(samples::terrain(), kTag);
    ASSERT_EQ(bytes[edge_count + 3], 2) << "the count is not where this test takes it to be";
    bytes[edge_count] = highest_byte;
    EXPECT_FALSE(decode<core::OneStepTerrain>(bytes));
  }
  Bytes one_too_many = encode(samples::terrain(), kTag);
  one_too_many[edge_count + 3] = core::OneStepTerrain::kMaxFeatures + 1;
  EXPECT_FALSE(decode<core::OneStepTerrain>(one_too_many));
}

TEST(Convert, EnumeratorsOutOfRangeAreRefused) {
  Bytes bytes = encode(samples::command(), kTag);
  ASSERT_EQ(bytes[kBody], static_cast<std::uint8_t>(core::DriveMode::active));
  bytes[kBody] = static_cast<std::uint8_t>(core::DriveMode::active) + 1;
  EXPECT_FALSE(decode<core::JointCommand>(bytes));
}

TEST(Convert, AbsurdStringLengthsAreRefused) {
  for (const std::uint8_t byte : {std::uint8_t{0x00}, std::uint8_t{0x7F}, std::uint8_t{0xFF}}) {
    Bytes bytes = encode(samples::scene(), kTag);
    for (std::size_t i = 0; i < 4; ++i) bytes[kBody + i] = byte;
    EXPECT_FALSE(decode<Scene>(bytes)) << int{byte};
  }
}

TEST(Convert, DamagedBytesNeverDoHarm) {
  constexpr unsigned kSeed = 20240501;
  std::mt19937 random(kSeed);
  const Bytes intact = encode(samples::choice(), kTag);
  std::size_t refused = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Bytes bytes = intact;
    for (int k = 0; k < 4; ++k)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    const auto result = decode<core::TargetChoice>(bytes);
    if (!result) {
      ++refused;
      continue;
    }
    EXPECT_LE(result->value.ranked_count, core::TargetChoice::kMaxCandidates) << "seed " << kSeed;
    EXPECT_LE(result->value.rejected_count, core::TargetChoice::kMaxCandidates) << "seed " << kSeed;
  }
  EXPECT_GT(refused, 0U) << "the damage never reached anything that is checked";
}

DepthRecord depth_record() {
  DepthRecord record;
  record.at_exposure = samples::state();
  record.frame.stamp = {1'000'000'007};
  record.frame.intrinsics = {16, 12, 385.0, 384.0, 8.5, 6.5};
  record.frame.X_BC.translation() << 0.09, 0.0, 0.08;
  for (int i = 0; i < 16 * 12; ++i) {
    record.frame.depth.push_back(i % 7 == 0 ? 0.0F : 0.001F * static_cast<float>(400 + 97 * i));
  }
  return record;
}

TEST(ConvertDepth, WholeMillimetresComeBackBitByBit) {
  const DepthRecord sent = depth_record();
  const auto got = decode<DepthRecord>(encode(sent, {3, 4}));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->tag.sequence, 3U);
  EXPECT_EQ(got->value.frame.depth, sent.frame.depth);
  EXPECT_EQ(got->value.frame.stamp, sent.frame.stamp);
  EXPECT_EQ(got->value.frame.intrinsics.cy, 6.5);
  EXPECT_EQ(got->value.frame.X_BC.matrix(), sent.frame.X_BC.matrix());
  EXPECT_EQ(got->value.at_exposure.q, sent.at_exposure.q);
}

TEST(ConvertDepth, OtherReadingsComeBackToATenthOfAMillimetreAndNonsenseAsNothing) {
  DepthRecord sent = depth_record();
  sent.frame.depth[1] = 0.71234F;
  sent.frame.depth[2] = std::numeric_limits<float>::quiet_NaN();
  sent.frame.depth[3] = -1.0F;
  sent.frame.depth[4] = 1e9F;
  const auto got = decode<DepthRecord>(encode(sent, {}));
  ASSERT_TRUE(got);
  EXPECT_NEAR(got->value.frame.depth[1], 0.71234F, 5.1e-5F);
  for (const std::size_t i : {2U, 3U, 4U}) EXPECT_EQ(got->value.frame.depth[i], 0.0F);
}

TEST(ConvertDepth, DamagedImagesAreNotDecoded) {
  const Bytes whole = encode(depth_record(), {});
  for (std::size_t length = 0; length < whole.size(); length += 13) {
    EXPECT_FALSE(decode<DepthRecord>({whole.data(), length}));
  }
  Bytes damaged = whole;
  std::fill(damaged.end() - 20, damaged.end(), std::uint8_t{0xA5});
  (void)decode<DepthRecord>(damaged);  // an image or nothing, but no crash
}

TEST(ConvertPrior, ComesBackAsItWas) {
  const EstimatorPrior sent{.stamp = {7},
                            .start = EstimatorPrior::Start{{0.1, -0.2, 0.3}, 0.4},
                            .expected = 3,
                            .height = 0.123456789012};
  const EstimatorPrior got = round_trip(sent);
  EXPECT_EQ(got.stamp, sent.stamp);
  ASSERT_TRUE(got.start);
  EXPECT_EQ(got.start->p_WS, sent.start->p_WS);
  EXPECT_EQ(got.start->yaw, sent.start->yaw);
  EXPECT_EQ(got.expected, sent.expected);
  EXPECT_EQ(got.height, sent.height);
  EXPECT_FALSE(round_trip(EstimatorPrior{}).start);
}

TEST(Convert, ListsLongerThanTheMessageAreRefusedBeforeTheyAreMade) {
  constexpr std::size_t kLength = 32;
  Bytes bytes = encode(samples::plan(), kTag);
  bytes[kLength] = 0x7F;  // two thousand million knots
  EXPECT_FALSE(decode<core::JumpPlan>(bytes));
}

TEST(ConvertQuestion, ComesBackAsItWas) {
  TargetQuestion sent{.stamp = {5}, .rest = samples::state(), .goal_x = 1.9, .goal_heading = 0.3};
  sent.target = core::TargetOverride{.distance = 0.3, .yaw = 0.1};
  const auto got = decode<TargetQuestion>(encode(sent, {}));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->value.goal_x, 1.9);
  EXPECT_EQ(got->value.rest.p_WB, sent.rest.p_WB);
  ASSERT_TRUE(got->value.target);
  EXPECT_EQ(got->value.target->yaw, 0.1);
}

}  // namespace
}  // namespace hopscotch::msgs
