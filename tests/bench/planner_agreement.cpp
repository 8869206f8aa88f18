/// Solves random targets by the chain solver and by Ipopt, on the same laws, and compares the
/// optimal costs: planner_agreement [COUNT [SEED]], default 200 targets that both solve, seed 1.
/// The program has several local minima: the chain solver starts from the closed-form guess and
/// from the nearest jumps of the library, and its cheapest counts; Ipopt starts from the same
/// guess. Where one finds a clearly better jump it is listed. Fails if that is ever Ipopt.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "planner/chain_solver.hpp"
#include "planner/jump_library.hpp"
#include "tests/bench/grid_target.hpp"

namespace {

using namespace hopscotch;           // NOLINT: a program of one file
using namespace hopscotch::planner;  // NOLINT

constexpr double kAgreement = 1e-4;  // of costs, relative
/// Both stop so close to the optimum that what is left of it does not count.
constexpr double kTolerance = 1e-5;
/// Jumps of the library that the chain solver starts from. Most come in pairs, from two starts that
/// are alike and lead to the same minimum.
constexpr std::size_t kNeighbours = 24;

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Comparison {
 public:
  explicit Comparison(const std::filesystem::path& config_folder)
      : problems_(config_folder),
        library_(JumpLibrary::from_bytes(bytes_of(config_folder / "jumps" / "hector.jumps"))),
        chain_(problems_.layout) {}

  void compare(const GridTarget& target) {
    const core::Result<PlanarTask> task = problems_.task_of(target);
    if (!task) return;
    const auto& [robot, root, posture, model, layout] = problems_;
    const Eigen::VectorXd guess = kinematic_guess(model, *task, layout);
    const ChainProblem problem(model, *task, layout);
    note(target, by_chain(*task, problem, guess), problems_.by_ipopt(*task, guess, options()));
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

  [[nodiscard]] int compared() const { return static_cast<int>(difference_.size()); }
  [[nodiscard]] bool ipopt_was_better() const { return ipopt_better_ > 0; }

 private:
  [[nodiscard]] SolveOptions options() const {
    return {problems_.model.config.iterations_max, kTolerance};
  }

  /// The cheapest of several local minima.
  [[nodiscard]] ChainOutcome by_chain(const PlanarTask& task, const ChainProblem& problem,
                                      const Eigen::VectorXd& guess) {
    ChainOutcome best = chain_.solve(problem, guess, options());
    for (const KnownJump* near : library_.nearest(task, kNeighbours)) {
      const ChainOutcome outcome = chain_.solve_near(problem, near->solution, options());
      if (outcome.status != SolveStatus::solved) continue;
      if (best.status != SolveStatus::solved || outcome.cost < best.cost) best = outcome;
    }
    return best;
  }

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
  JumpLibrary library_;
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
  while (comparison.compared() < count) {
    const double ahead = distance(generator);
    const double up = height(generator);
    comparison.compare({ahead, up, kStarts[start(generator)]});
  }
  comparison.print();
  return comparison.ipopt_was_better() ? EXIT_FAILURE : EXIT_SUCCESS;
}
