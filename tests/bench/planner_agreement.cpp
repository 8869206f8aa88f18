/// Solves random targets by the chain solver and by Ipopt, on the same laws and from the same
/// guess, and compares the optimal costs: planner_agreement [COUNT [SEED]], default 200 targets,
/// seed 1. Both stop at the shipped tolerance. Targets that either does not solve are counted and
/// left out. Where one finds a clearly better jump, both have ended in local minima; those are
/// listed.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <vector>

#include "planner/chain_solver.hpp"
#include "tests/bench/grid_target.hpp"

namespace {

using namespace hopscotch;           // NOLINT: a program of one file
using namespace hopscotch::planner;  // NOLINT

constexpr double kAgreement = 1e-4;  // of costs, relative

class Comparison {
 public:
  explicit Comparison(const std::filesystem::path& config_folder)
      : problems_(config_folder), chain_(problems_.layout) {}

  void compare(const GridTarget& target) {
    const core::Result<PlanarTask> task = problems_.task_of(target);
    if (!task) return;
    const auto& [robot, root, posture, model, layout] = problems_;
    const Eigen::VectorXd guess = kinematic_guess(model, *task, layout);
    const ChainProblem problem(model, *task, layout);
    const ChainOutcome chain = chain_.solve(problem, guess, problems_.options());
    note(target, chain, problems_.by_ipopt(*task, guess));
  }

  void print() {
    std::sort(difference_.begin(), difference_.end());
    const auto count = difference_.size();
    std::printf("solved by both %zu, by the chain solver only %d, by Ipopt only %d\n", count,
                only_chain_, only_ipopt_);
    if (count == 0) return;
    const auto within =
        std::lower_bound(difference_.begin(), difference_.end(), kAgreement) - difference_.begin();
    std::printf(
        "relative difference of costs: median %.1e, 95 %% %.1e, largest %.1e; "
        "within %.0e: %td of %zu\n",
        difference_[count / 2], difference_[count * 95 / 100], difference_.back(), kAgreement,
        within, count);
    std::printf(
        "beyond that the chain solver's jump was the better one %d times, Ipopt's %d times\n",
        chain_better_, ipopt_better_);
  }

 private:
  void note(const GridTarget& target, const ChainOutcome& chain, const SolveOutcome& ipopt) {
    const bool by_chain = chain.status == SolveStatus::solved;
    const bool by_ipopt = ipopt.status == SolveStatus::solved;
    if (by_chain && !by_ipopt) ++only_chain_;
    if (by_ipopt && !by_chain) ++only_ipopt_;
    if (!by_chain || !by_ipopt) return;
    const double relative = (chain.cost - ipopt.cost) / ipopt.cost;
    difference_.push_back(std::abs(relative));
    if (std::abs(relative) <= kAgreement) return;
    ++(relative < 0.0 ? chain_better_ : ipopt_better_);
    std::printf("%.3f m, %+.3f m, %s: chain %.3f, Ipopt %.3f (%+.1e)\n", target.distance,
                target.height, std::string(start_kind_name(target.start)).c_str(), chain.cost,
                ipopt.cost, relative);
  }

  GridProblems problems_;
  ChainSolver chain_;
  std::vector<double> difference_;
  int only_chain_ = 0;
  int only_ipopt_ = 0;
  int chain_better_ = 0;
  int ipopt_better_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 200;
  std::mt19937 generator(argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1U);
  std::uniform_real_distribution<double> distance(0.15, 0.60);
  std::uniform_real_distribution<double> height(-0.30, 0.25);
  std::uniform_int_distribution<std::size_t> start(0, 2);
  constexpr std::array<StartKind, 3> kStarts{StartKind::stand, StartKind::low, StartKind::moving};
  Comparison comparison(std::filesystem::path(HOPSCOTCH_SOURCE_DIR) / "config");
  for (int i = 0; i < count; ++i) {
    const double ahead = distance(generator);
    const double up = height(generator);
    comparison.compare({ahead, up, kStarts[start(generator)]});
  }
  comparison.print();
  return EXIT_SUCCESS;
}
