#pragma once

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "apps/real_time.hpp"
#include "apps/stopwatch.hpp"
#include "core/check.hpp"
#include "core/time.hpp"

namespace hopscotch::apps {

/// How one stage runs.
struct StageSetup {
  std::string name;       ///< For people.
  double latency = 0.0;   ///< Declared: an answer counts that long after its question [s].
  bool threaded = false;  ///< On a thread of its own, or in lock-step with the asking one.
  ThreadSetup thread;     ///< Of that thread.
};

/// One expensive stage of the brain: a question goes in, an answer comes out after the declared
/// latency, one at a time. In lock-step the work is done at once and its answer held back, so that
/// a simulated robot pays for compute time as a real one does. On a thread of its own the asking
/// thread never waits; an answer that takes longer than declared comes when it is there, and counts
/// as late. Whoever asks sees no other difference.
///
/// All calls from one thread, the asking one. They do not lock, and allocate no more than moving a
/// question or an answer does.
template <typename Question, typename Answer>
class Stage {
 public:
  /// @param work Its time and its memory belong to the stage's thread; must not throw.
  using Work = std::function<void(Question&, Answer&)>;

  Stage(StageSetup setup, Work work) : setup_(std::move(setup)), work_(std::move(work)) {
    if (setup_.threaded) thread_ = std::jthread([this] { serve(); });
  }
  ~Stage() {
    if (!thread_.joinable()) return;
    hand_over(State::closing);
    thread_.join();
  }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// No question is on its way.
  [[nodiscard]] bool vacant() const { return !pending_; }
  /// To be filled before ask(). @pre vacant()
  [[nodiscard]] Question& question() {
    HOPSCOTCH_CHECK(vacant());
    return question_;
  }
  /// @pre vacant()
  void ask(core::Stamp now) {
    HOPSCOTCH_CHECK(vacant());
    pending_ = true;
    dropped_ = false;
    shown_ = false;
    due_ = now.after(setup_.latency);
    if (thread_.joinable()) {
      hand_over(State::asked);
    } else {
      work();
    }
  }

  /// The answer as soon as it has been made, once: for records. @return null: nothing new.
  [[nodiscard]] const Answer* made() {
    if (!pending_ || shown_ || state_.load(std::memory_order_acquire) != State::made) {
      return nullptr;
    }
    shown_ = true;
    return &answer_;
  }
  /// The answer once it counts and made() has shown it, which makes the stage vacant; the caller
  /// may move from it. Valid until the next ask(). @return null: not yet, or dropped.
  [[nodiscard]] Answer* take(core::Stamp now) {
    if (!pending_ || state_.load(std::memory_order_acquire) != State::made) return nullptr;
    if (dropped_) {
      pending_ = false;
      return nullptr;
    }
    if (!shown_ || now < due_) return nullptr;
    if (thread_.joinable() && now.since(due_) > kTick) ++late_;
    pending_ = false;
    return &answer_;
  }
  /// The answer on its way is no longer wanted.
  void drop() {
    dropped_ = true;
    if (!thread_.joinable()) pending_ = false;
  }

  /// Wall time of the work behind the answer that made() gave last [ms].
  [[nodiscard]] double work_ms() const { return work_ms_; }
  /// Answers that came later than declared. None in lock-step.
  [[nodiscard]] std::uint64_t late() const { return late_; }

 private:
  enum class State : std::uint8_t { idle, asked, made, closing };
  static constexpr double kTick = 0.0015;  // answers are looked for once a millisecond [s]

  void hand_over(State state) {
    state_.store(state, std::memory_order_release);
    state_.notify_one();
  }

  void work() {
    const Stopwatch watch;
    work_(question_, answer_);
    work_ms_ = watch.milliseconds();
    // A closing that came meanwhile stays.
    State asked = state_.load(std::memory_order_relaxed);
    while (asked != State::closing &&
           !state_.compare_exchange_weak(asked, State::made, std::memory_order_release)) {
    }
  }

  void serve() {
    const std::string refused = schedule_this_thread(setup_.thread);
    if (!refused.empty()) {
      std::fprintf(stderr, "hopscotch: warning: %s: %s\n", setup_.name.c_str(), refused.c_str());
    }
    while (true) {
      const State state = state_.load(std::memory_order_acquire);
      if (state == State::closing) return;
      if (state == State::asked) {
        work();
      } else {
        state_.wait(state, std::memory_order_acquire);
      }
    }
  }

  StageSetup setup_;
  Work work_;
  Question question_{};
  Answer answer_{};
  double work_ms_ = 0.0;
  std::atomic<State> state_{State::idle};  // hands question and answer over

  bool pending_ = false;  // asked and not taken
  bool dropped_ = false;
  bool shown_ = false;
  core::Stamp due_;
  std::uint64_t late_ = 0;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace hopscotch::apps
