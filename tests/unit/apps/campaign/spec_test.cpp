#include "apps/campaign/spec.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "apps/campaign/scenario_text.hpp"
#include "apps/campaign/trial_setup.hpp"
#include "apps/installation.hpp"
#include "apps/program_config.hpp"
#include "core/config_reader.hpp"

namespace hopscotch::apps::campaign {
namespace {

using ::testing::HasSubstr;

CampaignSpec spec_of(const std::string& text) {
  return CampaignSpec::from_text(text, "campaign.yaml");
}

std::string error_of(const std::string& text) {
  try {
    (void)TrialMaker(spec_of(text));
  } catch (const core::ConfigError& error) {
    return error.what();
  }
  return "";
}

const std::string kHead = "name: test\nstate: truth\ntrials: 10\n";

TEST(CampaignSpec, ReadsTheDocumentedExample) {
  const CampaignSpec spec = spec_of(
      "name: perturbation\n"
      "scenario: {family: steps-and-gaps, gap_m: [0.05, 0.20], step_m: [-0.05, 0.05], "
      "tread_m: [0.30, 0.45], treads: 6}\n"
      "perception: camera\n"
      "state: estimate\n"
      "trials: 200\n"
      "seed: 1\n"
      "vary:\n"
      "  friction: [0.4, 0.8]\n"
      "  plant.mass_scale: [0.95, 1.05]\n"
      "  surprise_height_m: [-0.02, 0.02]\n"
      "  push: {phase: takeoff, axis: x, impulse_Ns: {grid: [0.0, 2.0, 4.0]}}\n"
      "ablation: none\n");
  EXPECT_EQ(spec.cells(), 3);
  EXPECT_EQ(spec.trials, 200);
  EXPECT_EQ(spec.family.treads, 6);
  EXPECT_EQ(spec.eyes, Eyes::camera);
  EXPECT_EQ(spec.state, StateSource::estimate);
}

/// Else the robot would choose a shorter jump and succeed.
TEST(CampaignSpec, JumpsThatAreNeverChosenAreRefused) {
  const ProgramConfig shipped = ProgramConfig::load(config_directory() / "hopscotch.yaml");
  const std::vector<double>& reach = shipped.footstep.reach.distance_max;
  const double farthest = *std::max_element(reach.begin(), reach.end());
  const auto leap = [](double distance) {
    return kHead + "scenario: {family: leap, jump_m: " + std::to_string(distance) + "}\n";
  };
  EXPECT_EQ(error_of(leap(farthest)), "");
  EXPECT_THAT(error_of(leap(farthest + 0.01)), HasSubstr("jump_m"));
}

TEST(CampaignSpec, ErrorsNameFileLineKeyValueAndRule) {
  const std::string range =
      error_of(kHead + "scenario: {family: flat}\nvary:\n  friction: [0.8, 0.4]\n");
  EXPECT_THAT(range, HasSubstr("campaign.yaml:6"));
  EXPECT_THAT(range, HasSubstr("friction"));
  EXPECT_THAT(range, HasSubstr("0.8, 0.4"));
  EXPECT_THAT(range, HasSubstr("must rise"));
  EXPECT_THAT(error_of(kHead + "scenario: {family: flat}\nvary: {gravity: [1, 2]}\n"),
              HasSubstr("is no factor"));
  EXPECT_THAT(error_of(kHead + "scenario: {family: flat, gap_m: 0.1}\n"), HasSubstr("gap_m"));
  EXPECT_THAT(error_of(kHead + "scenario: {family: flta}\n"), HasSubstr("steps-and-gaps"));
  EXPECT_THAT(error_of(kHead + "scenario: {family: flat}\nvary: {friction: [0.5, 3.0]}\n"),
              HasSubstr("x <= 2"));
  EXPECT_THAT(error_of(kHead + "scenario: {family: flat}\nvary: {friction: {grid: [0.5, 0.5]}}\n"),
              HasSubstr("twice"));
  EXPECT_THAT(error_of(kHead + "scenario: {family: flat}\nvary: {plant.latency_ms: [0.5, 2]}\n"),
              HasSubstr("whole multiple"));
  EXPECT_THAT(error_of("trials: 1\nname: ../x\nscenario: {family: flat}\n"),
              HasSubstr("campaign.yaml:2: name = ../x"));
  EXPECT_THAT(
      error_of(kHead + "scenario: {family: flat}\nvary: {surprise_height_m: [-0.1, 0.1]}\n"),
      HasSubstr("one slab only"));
  EXPECT_THAT(
      error_of(kHead + "scenario: {family: flat}\nvary: {push: {axis: x, impulse_Ns: 1}}\n"),
      HasSubstr("phase"));
  EXPECT_THAT(error_of("name: test\nscenario: {family: flat}\ntrials: 0\n"), HasSubstr("1 <= x"));
  EXPECT_THAT(error_of(kHead + "scenario: nowhere.yaml\n"), HasSubstr("nowhere.yaml"));
}

TEST(CampaignSpec, CellsSpanAllGridsAndTheLastChangesFastest) {
  const CampaignSpec spec = spec_of(
      kHead +
      "scenario: {family: gaps, treads: 1, gap_m: {grid: [0.1, 0.2]}}\n"
      "vary:\n  push: {phase: {grid: [takeoff, flight, landing]}, axis: x, impulse_Ns: 1.0}\n");
  EXPECT_EQ(spec.cells(), 6);
  const TrialMaker maker(spec);
  EXPECT_EQ(maker.setup(0).scenario.pushes.at(0).phase, core::JumpPhase::takeoff);
  EXPECT_EQ(maker.setup(1).scenario.pushes.at(0).phase, core::JumpPhase::flight);
  EXPECT_NEAR(maker.setup(2).scenario.seen.slabs.at(1).centre.x() -
                  maker.setup(3).scenario.seen.slabs.at(1).centre.x(),
              -0.1, 1e-9);
}

const std::string kMixture =
    "scenario: {family: random-mixture, gap_m: [0.05, 0.15], step_m: [-0.05, 0.05]}\n";

TEST(Draws, AreTheSameInAllCellsOfARepetition) {
  const TrialMaker maker(
      spec_of(kHead + kMixture +
              "vary:\n  friction: [0.4, 0.8]\n  plant.mass_scale: {grid: [0.9, 1.1]}\n"));
  for (const std::int64_t repetition : {0, 3}) {
    const TrialSetup a = maker.setup(2 * repetition);
    const TrialSetup b = maker.setup(2 * repetition + 1);
    EXPECT_EQ(a.seed, b.seed);
    EXPECT_EQ(a.scenario.friction, b.scenario.friction);
    ASSERT_EQ(a.scenario.seen.slabs.size(), b.scenario.seen.slabs.size());
    EXPECT_EQ(a.scenario.seen.slabs[2].top, b.scenario.seen.slabs[2].top);
    EXPECT_EQ(a.scenario.plant.mass_scale, 0.9);
    EXPECT_EQ(b.scenario.plant.mass_scale, 1.1);
  }
}

TEST(Draws, DoNotShiftWhenAFactorIsAdded) {
  const TrialMaker few(spec_of(kHead + kMixture + "vary: {friction: [0.4, 0.8]}\n"));
  const TrialMaker more(
      spec_of(kHead + kMixture + "vary: {plant.mass_scale: [0.9, 1.1], friction: [0.4, 0.8]}\n"));
  EXPECT_EQ(few.setup(5).scenario.friction, more.setup(5).scenario.friction);
  EXPECT_EQ(few.setup(5).seed, more.setup(5).seed);
  EXPECT_NE(few.identity(), more.identity());
}

TEST(Draws, FillTheRangeEvenly) {
  int low = 0;
  constexpr int kDraws = 4000;
  std::set<double> seen;
  for (int k = 0; k < kDraws; ++k) {
    const double draw = common_draw(1, "friction", k, 0);
    ASSERT_GE(draw, 0.0);
    ASSERT_LT(draw, 1.0);
    low += draw < 0.25 ? 1 : 0;
    seen.insert(draw);
  }
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(kDraws));
  EXPECT_NEAR(low, 0.25 * kDraws, 4.0 * std::sqrt(kDraws * 0.25 * 0.75));  // four sigmas
}

TEST(Draws, MoreTrialsKeepTheIdentityAndOtherMeaningsChangeIt) {
  const std::string tail = "scenario: {family: gaps}\n";
  const TrialMaker ten(spec_of("name: a\ntrials: 10\n" + tail));
  const TrialMaker many(spec_of("name: b\ntrials: 99\n" + tail));
  const TrialMaker seeded(spec_of("name: a\ntrials: 10\nseed: 2\n" + tail));
  const TrialMaker ablated(spec_of("name: a\ntrials: 10\nablation: srbd-only\n" + tail));
  EXPECT_EQ(ten.identity(), many.identity());
  EXPECT_NE(ten.identity(), seeded.identity());
  EXPECT_NE(ten.identity(), ablated.identity());
  EXPECT_EQ(ten.spec().pairing(), ablated.spec().pairing());
}

TEST(Draws, AblationsAreCellsThatShareAllDraws) {
  const TrialMaker maker(
      spec_of(kHead +
              "scenario: {family: leap, step_m: [0.1, 0.2]}\n"
              "vary:\n  ablation: {grid: [none, paper-takeoff]}\n  friction: [0.4, 0.8]\n"));
  ASSERT_EQ(maker.spec().cells(), 2);
  const TrialSetup whole = maker.setup(6);
  const TrialSetup less = maker.setup(7);
  EXPECT_EQ(maker.request(whole, Eyes::truth).ablation, core::Ablation::none);
  EXPECT_EQ(maker.request(less, Eyes::truth).ablation, core::Ablation::paper_takeoff);
  EXPECT_EQ(whole.seed, less.seed);
  EXPECT_EQ(whole.scenario_text, less.scenario_text);
  EXPECT_THAT(error_of(kHead + "scenario: {family: leap}\nablation: srbd-only\n"
                               "vary:\n  ablation: no-landing-plan\n"),
              HasSubstr("vary.ablation"));
}

TEST(Draws, TheCampaignsAblationIsThatOfItsRuns) {
  const TrialMaker maker(spec_of(kHead + "scenario: {family: leap}\nablation: no-landing-plan\n"));
  EXPECT_EQ(maker.request(maker.setup(0), Eyes::truth).ablation, core::Ablation::no_landing_plan);
}

TEST(Families, ALeapIsAsLongAndAsHighAsAsked) {
  const TrialMaker maker(
      spec_of(kHead + "scenario: {family: leap, jump_m: 0.4, edge_m: 0.28, step_m: 0.2}\n"));
  const TrialSetup setup = maker.setup(0);
  ASSERT_EQ(setup.scenario.seen.slabs.size(), 2U);
  EXPECT_NEAR(setup.scenario.seen.slabs[1].lowest(), 0.2, 1e-9);
  EXPECT_EQ(setup.scenario.goal.jumps, 1);
  EXPECT_EQ(maker.request(setup, Eyes::truth).config.footstep.preference.nominal_distance, 0.4);
}

TEST(Families, AllMakeScenariosThatReadBack) {
  for (const char* family :
       {"flat", "leap", "steps", "gaps", "stones", "stairs", "rising-boxes", "slopes",
        "side-slopes", "steps-and-gaps", "random-mixture", "jump-down", "drops"}) {
    const TrialMaker maker(spec_of(kHead + "scenario: {family: " + family + "}\n"));
    for (std::int64_t i = 0; i < 10; ++i) {
      const TrialSetup setup = maker.setup(i);
      EXPECT_EQ(scenario_text(setup.scenario), setup.scenario_text) << family;
      EXPECT_GE(setup.scenario.seen.slabs.size(), 1U) << family;
    }
  }
}

TEST(Families, SideSlopesRiseToOneSideBehindAGapAndKeepTheirMiddleLevel) {
  const TrialMaker maker(spec_of(
      kHead +
      "scenario: {family: side-slopes, edge_m: 0.2, gap_m: 0.05, slope_rad: 0.1, treads: 2}\n"));
  const auto& slabs = maker.setup(0).scenario.seen.slabs;
  ASSERT_EQ(slabs.size(), 3U);
  EXPECT_NEAR(slabs[1].height({0.55, 0.0}), 0.0, 1e-9);
  EXPECT_NEAR(slabs[1].height({0.55, 0.1}), 0.1 * std::tan(0.1), 1e-9);
  EXPECT_NEAR(slabs[1].height({0.30, -0.1}), -0.1 * std::tan(0.1), 1e-9);
  EXPECT_FALSE(slabs[1].contains({0.24, 0.0}));
  EXPECT_TRUE(slabs[1].contains({0.26, 0.0}));
  EXPECT_EQ(slabs[2].slope, 0.0);
}

TEST(Families, StairsRiseByOneRiseAndStonesStayAboutTheGround) {
  const TrialMaker stairs(
      spec_of(kHead + "scenario: {family: stairs, rise_m: [0.05, 0.15], treads: 3}\n"));
  const auto& steps = stairs.setup(1).scenario.seen.slabs;
  EXPECT_NEAR(steps[1].top - steps[0].top, steps[3].top - steps[2].top, 1e-9);
  const TrialMaker stones(
      spec_of(kHead + "scenario: {family: stones, step_m: [-0.05, 0.05], treads: 30}\n"));
  for (const sim::Slab& slab : stones.setup(2).scenario.seen.slabs) {
    EXPECT_LE(std::abs(slab.top), 0.05 + 1e-9);
  }
}

TEST(Surprises, LieUnderEverySlabButTheFirst) {
  const TrialMaker maker(spec_of(kHead + "scenario: {family: stones, treads: 2}\n"
                                         "vary: {surprise_height_m: [-0.05, 0.05]}\n"));
  const TrialSetup setup = maker.setup(0);
  ASSERT_EQ(setup.scenario.height_surprises.size(), 2U);
  EXPECT_EQ(setup.scenario.height_surprises[0].slab, 1U);
  EXPECT_NE(setup.scenario.height_surprises[0].rise, setup.scenario.height_surprises[1].rise);
}

}  // namespace
}  // namespace hopscotch::apps::campaign
