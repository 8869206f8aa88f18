#include "apps/campaign/engine.hpp"

#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>

#include "apps/html.hpp"

namespace hopscotch::apps::campaign {

namespace {

constexpr double kLineEvery = 10.0;      // [s] where there is no terminal
constexpr double kTerminalEvery = 0.25;  // [s]
constexpr double kSaveEvery = 5.0;       // [s]

std::atomic<int> interrupt_count{0};  // set by the signal handler, hence at namespace scope

extern "C" void on_campaign_interrupt(int) {
  ++interrupt_count;
}

std::string duration_text(double seconds) {
  if (!std::isfinite(seconds)) return "unknown time";
  if (seconds < 100.0) return fixed(seconds, 0) + " s";
  if (seconds < 6000.0) return fixed(seconds / 60.0, 0) + " min";
  return fixed(seconds / 3600.0, 1) + " h";
}

}  // namespace

Interrupts::Interrupts() {
  interrupt_count = 0;
  struct sigaction action {};
  action.sa_handler = on_campaign_interrupt;  // without SA_RESTART: waiting ends early
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

Interrupts::~Interrupts() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

int Interrupts::count() {
  return interrupt_count;
}

Progress::Progress(const TrialQueue& queue)
    : at_start_(queue.finished_count()), terminal_(isatty(STDERR_FILENO) != 0) {}

std::string Progress::line(const TrialQueue& queue, const std::string& note) const {
  const double seconds = 1e-3 * watch_.milliseconds();
  const auto here = static_cast<double>(queue.finished_count() - at_start_);
  const double rate = here / seconds;
  const auto left = static_cast<double>(queue.wanted_count() - queue.finished_count());
  std::string text = std::to_string(queue.finished_count()) + " of " +
                     std::to_string(queue.wanted_count()) + " trials";
  if (here > 0.0) {
    text += ", " + fixed(60.0 * rate, 0) + " a minute, " + duration_text(left / rate) + " left";
  }
  return text + (note.empty() ? "" : ", " + note);
}

void Progress::show(const TrialQueue& queue, const std::string& note) {
  const double seconds = 1e-3 * watch_.milliseconds();
  if (seconds - shown_ < (terminal_ ? kTerminalEvery : kLineEvery)) return;
  shown_ = seconds;
  std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", line(queue, note).c_str());
  std::fflush(stderr);
}

void Progress::finish(const TrialQueue& queue) {
  std::fprintf(stderr, terminal_ ? "\r\033[K%s\n" : "%s\n", line(queue, "").c_str());
}

Stopclock::~Stopclock() {
  try {
    store_.add_elapsed(1e-3 * watch_.milliseconds() - saved_);
  } catch (const std::exception&) {  // a full disk has been reported where a row was lost
  }
}

void Stopclock::tick() {
  const double seconds = 1e-3 * watch_.milliseconds();
  if (seconds - saved_ < kSaveEvery) return;
  store_.add_elapsed(seconds - saved_);
  saved_ = seconds;
}

}  // namespace hopscotch::apps::campaign
