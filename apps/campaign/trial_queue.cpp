#include "apps/campaign/trial_queue.hpp"

#include <algorithm>

#include "apps/campaign/statistics.hpp"

namespace hopscotch::apps::campaign {

TrialQueue::TrialQueue(const CampaignSpec& spec)
    : trials_(spec.trials),
      stop_(spec.stop),
      cells_(static_cast<std::size_t>(spec.cells())),
      states_(cells_.size() * static_cast<std::size_t>(spec.trials), State::open) {
  const std::int64_t first = stop_ ? std::min<std::int64_t>(stop_->at_least, trials_) : trials_;
  for (Cell& cell : cells_) cell.wanted = first;
  wanted_ = first * static_cast<std::int64_t>(cells_.size());
}

std::optional<std::int64_t> TrialQueue::next() {
  const auto cells = static_cast<std::int64_t>(cells_.size());
  const auto end = static_cast<std::int64_t>(states_.size());
  for (; cursor_ < end; ++cursor_) {
    const TrialPlace place = place_of(cursor_, cells);
    const bool wanted = place.repetition < cells_[static_cast<std::size_t>(place.cell)].wanted;
    State& state = states_[static_cast<std::size_t>(cursor_)];
    if (state == State::open && wanted) {
      state = State::running;
      return cursor_++;
    }
  }
  return std::nullopt;
}

void TrialQueue::finished(std::int64_t index, Verdict verdict) {
  const auto cells = static_cast<std::int64_t>(cells_.size());
  if (index < 0 || index >= static_cast<std::int64_t>(states_.size())) return;  // of more trials
  State& state = states_[static_cast<std::size_t>(index)];
  if (state == State::success || state == State::failure) return;
  state = verdict == Verdict::success ? State::success : State::failure;
  const TrialPlace place = place_of(index, cells);
  if (place.repetition >= cells_[static_cast<std::size_t>(place.cell)].wanted) return;
  count(place.cell, state);
  look_at(place.cell);
}

void TrialQueue::count(std::int64_t index, State state) {
  Cell& cell = cells_[static_cast<std::size_t>(index)];
  ++finished_;
  ++cell.finished;
  if (state == State::success) ++cell.successes;
}

/// Asks for another batch of a complete cell whose rate is not known well enough.
void TrialQueue::look_at(std::int64_t index) {
  Cell& cell = cells_[static_cast<std::size_t>(index)];
  while (stop_ && cell.finished == cell.wanted && cell.wanted < trials_) {
    if (wilson95(cell.successes, cell.finished).half_width() <= stop_->half_width) return;
    const std::int64_t before = cell.wanted;
    cell.wanted = std::min<std::int64_t>(before + stop_->at_least, trials_);
    wanted_ += cell.wanted - before;
    const auto cells = static_cast<std::int64_t>(cells_.size());
    cursor_ = std::min(cursor_, before * cells + index);
    for (std::int64_t k = before; k < cell.wanted; ++k) {
      const State state = states_[static_cast<std::size_t>(k * cells + index)];
      if (state == State::success || state == State::failure) count(index, state);
    }
  }
}

void TrialQueue::give_back(std::int64_t index) {
  states_[static_cast<std::size_t>(index)] = State::open;
  cursor_ = std::min(cursor_, index);
}

}  // namespace hopscotch::apps::campaign
